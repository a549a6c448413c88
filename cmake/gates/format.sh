#!/usr/bin/env bash
# Every C++ file as clang-format lays it out.  format.sh ROOT; prints what differs; exit 1 if any.
set -euo pipefail
root=$1
cd "$root"
mapfile -t files < <(find harness plant io_bridges firmware results cmake -type f \
  \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.c' \) 2>/dev/null | sort)
if ((${#files[@]} == 0)); then
  echo "no files under $root: nothing was checked" >&2
  exit 1
fi
clang-format-14 --style=file --dry-run -Werror "${files[@]}"
echo "${#files[@]} files formatted"
