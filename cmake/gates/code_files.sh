#!/usr/bin/env bash
# Every file of C and C++ in the tree, by whatever ending and in whatever folder, one a line.
# code_files.sh ROOT; exit 1 where there is none: a gate that saw nothing has shown nothing.
set -euo pipefail
cd "$1"
files=$(find . \( -name .git -o -path ./build -o -path ./results/runs \) -prune -o -type f \
  -regextype posix-extended -iregex '.*\.(c|cc|cpp|cxx|c\+\+|cppm|ixx|h|hh|hpp|hxx|h\+\+|inc|inl|ipp|tpp)' -print |
  sed 's|^\./||' | LC_ALL=C sort)
if [[ -z $files ]]; then
  echo "no code under $1: nothing was checked" >&2
  exit 1
fi
printf '%s\n' "$files"
