"""Tells how many mutants of the judging code the unit tests kill.

    run.py --build BUILD [--seed N] [--count 300] [--jobs N] [--only NUMBER] [--in PATH]

  Killed     a test fails, crashes or runs into its host-side limit under WHIRL_MUTANT=number
  Survivors  are listed with their place and what was changed. Those of equivalent.txt are proven to
             change nothing that can be seen, and count for neither side
  Exit code  0: at least 90 % of the others are killed; 1: fewer; 2: no such thing to run
"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).parent
WANTED = 0.9

# In order of their cost. A test runs for the mutants of the folders that it can reach.
JUDGING = ("harness/", "results/")
TESTS = [
    (("harness/metrics/",), ["harness/metrics/metrics_test"]),
    (("io_bridges/qemu/",), ["io_bridges/qemu/board/watch_unit_test"]),
    (("io_bridges/board_description/",), ["io_bridges/board_description/board_text_test"]),
    (("results/",), ["results/results_test"]),
    (("harness/board/",), ["harness/board/node_test"]),
    (("harness/catalogue/", "io_bridges/board_description/"), ["harness/catalogue/catalogue_test"]),
    (("harness/lockstep/",), ["harness/lockstep/lockstep_test"]),
    (("harness/world/",), ["harness/world/world_test"]),
    (("harness/plan/",), ["harness/plan/signal_rows_test"]),
    (("harness/plan/requests",), ["harness/stand/stand_test"]),
    (("harness/plan/requests",), ["harness/flight/flight_test"]),
    (("harness/executive/",), ["harness/executive/executive_test"]),
    (JUDGING, ["harness/tests/oracle/judging_test"]),
    (JUDGING, ["harness/tests/oracle/plan_oracle", "--count", "400"]),
    (JUDGING, ["harness/program_test", "--gtest_filter=-ParserFuzzers*"]),
    (JUDGING, ["harness/hostile_test"]),
]
# Of one run of a test, on a host that also does other things: so often what it takes without a mutant.
LIMIT_TIMES, LEAST_LIMIT_S = 10, 5


def mutants_of(build):
    found = []
    for path in sorted(build.glob("mutated/**/*.mutants")):
        for line in path.read_text().splitlines():
            number, place, change, source = line.split("\t")
            found.append((int(number), place, change, source))
    return found


# Lines "PATH | CHANGE | SOURCE LINE | reason".
def equivalents():
    known = {}
    for line in (HERE / "equivalent.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        path, change, source, reason = line.split(" | ")
        known[path, change, source] = reason
    return known


# Gives the exit code, or "time".
def run_test(build, command, number, limit_s=None):
    environment = {**os.environ, "WHIRL_MUTANT": str(number)}
    if command[0].endswith("_test"):
        command = [*command, "--gtest_brief=1", "--gtest_fail_fast=1"]
    try:
        return subprocess.run([str(build / command[0]), *command[1:]], env=environment, timeout=limit_s,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode
    except subprocess.TimeoutExpired:
        return "time"


def killer_of(build, mutant, limits_s):
    number, place, _, _ = mutant
    for (folders, command), limit_s in zip(TESTS, limits_s):
        if place.startswith(folders) and run_test(build, command, number, limit_s) != 0:
            return command[0]
    return None


def report(options, everything, chosen, killers):
    known = equivalents()
    killed, equivalent, survivors = {}, 0, []
    for mutant, killer in zip(chosen, killers):
        number, place, change, source = mutant
        if killer is not None:
            killed[killer] = killed.get(killer, 0) + 1
        elif (place.rsplit(":", 1)[0], change, source) in known:
            equivalent += 1
        else:
            survivors.append(mutant)
    for number, place, change, source in sorted(survivors):
        print(f"survived {number}  {place}: {change}\n    {source}")
    for test, count in killed.items():
        print(f"{count} killed by {test}")
    total = len(chosen) - equivalent
    share = sum(killed.values()) / total if total else 1.0
    print(f"seed {options.seed}: {len(chosen)} of {len(everything)} mutants, {equivalent} equivalent, "
          f"{len(survivors)} survived: {100 * share:.1f} % killed, wanted {100 * WANTED:.0f} %")
    return 0 if share >= WANTED else 1


def main():
    parser = argparse.ArgumentParser(prog="whirl mutate")
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", type=int)
    parser.add_argument("--in", dest="folder", default="")
    options = parser.parse_args()
    stale = equivalents().keys() - {(p.rsplit(":", 1)[0], c, s) for _, p, c, s in mutants_of(options.build)}
    for mutant in sorted(stale):
        print("equivalent.txt: no such mutant: " + " | ".join(mutant))
    if stale:
        return 2
    everything = [m for m in mutants_of(options.build) if m[1].startswith(options.folder)]
    if options.only is not None:
        everything = [m for m in everything if m[0] == options.only]
    if not everything:
        print("no mutant there")
        return 2
    limits_s = []
    for _, command in TESTS:
        began_s = time.monotonic()
        if run_test(options.build, command, 0) != 0:
            print(f"{command[0]} fails without any mutant: nothing can be told")
            return 2
        limits_s.append(LEAST_LIMIT_S + LIMIT_TIMES * (time.monotonic() - began_s))
    chosen = random.Random(options.seed).sample(everything, min(options.count, len(everything)))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        killers = list(pool.map(lambda m: killer_of(options.build, m, limits_s), chosen))
    return report(options, everything, chosen, killers)


sys.exit(main())
