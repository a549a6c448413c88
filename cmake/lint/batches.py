#!/usr/bin/env python3
"""Puts source files together for clang-tidy, which spends most of a file's time in the headers that all include.

batches.py BUILD OUT FILE...: lists the files of each batch in OUT/N, its compiler options, a line each, in
OUT/N.options; prints the batches' lists, the longest batch first.  A name that a file defines for itself only
(unnamed namespace, static, macro) is not defined by another file of its batch, and a constant's not used by one.
"""
import functools
import json
import pathlib
import re
import shlex
import shutil
import sys

LINES = 4000  # of source in one batch; with more, the last batch would keep one core busy alone
NAMES = (re.compile(r"^(?:struct|class|enum class|enum|union|using) (\w+)"),
         re.compile(r"[ *&](\w+)\("),  # a function
         re.compile(r"[ *&](\w+)(?:\[[^\]]*\])*(?: =|\{|;|$)"))  # constants, several in one line too
MACRO = re.compile(r"^#define (\w+)")
TEST = re.compile(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)")
CONSTANT = re.compile(r"\b(?:k[A-Z]\w*|[A-Z][A-Z0-9_]+)\b")
INCLUDE = re.compile(r'^#include "(.+)"$', re.M)
INTERNAL = ("static ", "constexpr ", "const ", "int main(")
ENUM = re.compile(r"^enum(?: \w+)?(?: : [\w:]+)? \{")


def own_names(text):
    """What a file defines for itself only, as the house's format shows it: such lines begin in column 0."""
    names, inside, enumerators = set(), False, False
    for line in text.splitlines():
        if line == "namespace {":
            inside = True
        elif line == "}  // namespace":
            inside = False
        elif line.startswith("using namespace ") and "std::" not in line:
            names.add("using namespace")  # one file with another's names is enough
        elif found := MACRO.match(line):
            names.add(found[1])
        elif found := TEST.match(line):
            names.add(f"{found[1]}_{found[2]}")
        elif enumerators or ENUM.match(line):
            names.update(re.findall(r"\b[A-Za-z]\w+", line.split("//")[0]))
            enumerators = "}" not in line
        elif line[:1].isalpha() and (inside or line.startswith(INTERNAL)):
            for name in NAMES:
                names.update(name.findall(line))
    return names


@functools.cache
def read(path):
    """(constants, headers of the house) that one file speaks of."""
    text = path.read_text()
    return set(CONSTANT.findall(text)), [header for name in INCLUDE.findall(text)
                                         if (header := pathlib.Path(name)).exists()]


def constants(file):
    """The constants that a file and all headers of the house that it sees speak of."""
    seen, to_read, found = set(), [file], set()
    while to_read:
        path = to_read.pop()
        if path not in seen:
            seen.add(path)
            found |= read(path)[0]
            to_read += read(path)[1]
    return found


def options(command):
    """What of a compiler's command decides what it sees: (definitions, all else)."""
    words, defined, kept = iter(shlex.split(command)[1:]), {}, {}
    for word in words:
        if word in ("-o", "-c"):
            next(words)
        elif word == "-isystem":
            kept[f"-isystem{next(words)}"] = None
        elif word.startswith("-D"):
            name, _, value = word.partition("=")
            defined[name] = value
        elif word.startswith(("-I", "-std=")):
            kept[word] = None
    return defined, kept


class Batch:
    """Files that go together, what they define for themselves, the constants they use and their options."""

    def __init__(self):
        self.lines, self.names, self.used, self.defined, self.kept, self.files = 0, set(), set(), {}, {}, []

    def takes(self, lines, names, used, defined):
        return (self.lines + lines <= LINES and not names & (self.names | self.used) and not used & self.names
                and all(self.defined.get(name, value) == value for name, value in defined.items()))

    def add(self, file, lines, names, used, defined, kept):
        self.lines += lines
        self.names |= names
        self.used |= used
        self.defined |= defined
        self.kept |= kept
        self.files.append(file)

    def options(self):
        return [*self.kept, *(f"{name}={value}" if value else name for name, value in self.defined.items())]


def main(build, out, *files):
    out = pathlib.Path(out).resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    wanted = {str(pathlib.Path(file).resolve()) for file in files}
    batches = []
    for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text()):
        if entry["file"] not in wanted:
            continue
        file = entry["file"]
        wanted.remove(file)
        text = pathlib.Path(file).read_text()
        lines, names, used = text.count("\n"), own_names(text), constants(pathlib.Path(file))
        defined, kept = options(entry["command"])
        for batch in batches:
            if batch.takes(lines, names, used, defined):
                break
        else:
            batch = Batch()
            batches.append(batch)
        batch.add(file, lines, names, used, defined, kept)
    if wanted:
        sys.exit(f"batches: not in {build}: {sorted(wanted)}")
    for number, batch in enumerate(sorted(batches, key=lambda batch: -batch.lines)):
        path = out / str(number)
        path.write_text("".join(f"{file}\n" for file in batch.files))
        pathlib.Path(f"{path}.options").write_text("".join(f"{option}\n" for option in batch.options()))
        print(path)


main(*sys.argv[1:])
