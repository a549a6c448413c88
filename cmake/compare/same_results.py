#!/usr/bin/python3
"""Are the results of two builds the same, byte for byte?

same_results.py BEFORE AFTER [--digests]: two results folders (whirl run --out FOLDER), each with all plans flown.
For each plan the newest run counts: its verdict, truth.csv, bus.csv, telemetry.tlog or serial.txt must be equal,
and with --digests the digest of all messages too. Prints what differs; exit 1 if anything does, 2 if nothing
was compared.
"""
import hashlib
import json
import pathlib
import sys

FILES = ("truth.csv", "bus.csv", "telemetry.tlog", "serial.txt")


def runs_of(folder):
    runs = {}
    for path in sorted(pathlib.Path(folder).glob("runs/*/run.json")):
        if path.parent.is_symlink():
            continue
        run = json.loads(path.read_text())
        runs[run["plan"], run["seed"]] = (path.parent, run)
    return runs


def hash_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else "not there"


def differences(before, after, digests):
    (old, old_run), (new, new_run) = before, after
    keys = ["verdict"] + (["digest"] if digests else [])
    found = [f"{key} {old_run[key]} -> {new_run[key]}" for key in keys if old_run[key] != new_run[key]]
    found += [name for name in FILES if hash_of(old / name) != hash_of(new / name)]
    return found


def main(words):
    folders = [w for w in words if not w.startswith("--")]
    if len(folders) != 2:
        print(__doc__)
        return 2
    before, after = map(runs_of, folders)
    wrong = 0
    for key in sorted(before.keys() | after.keys()):
        if key not in before or key not in after:
            found = ["only " + ("before" if key in before else "after")]
        else:
            found = differences(before[key], after[key], "--digests" in words)
        if found:
            wrong += 1
            print(f"{key[0]} (seed {key[1]}): " + "; ".join(found))
    compared = len(before.keys() & after.keys())
    print(f"{compared} plans compared, {wrong} differ")
    return 2 if compared == 0 else 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
