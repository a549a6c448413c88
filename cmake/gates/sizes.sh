#!/usr/bin/env bash
# No file of code beyond 400 lines (register tables under a name ending in _table or _registers are
# exempt).  sizes.sh ROOT; exit 1 if any.
set -euo pipefail
cd "$1"
long=$(find $(ls -d harness plant io_bridges firmware results 2>/dev/null) -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.c' -o -name '*.h' \) |
  xargs -r wc -l | awk '$2 != "total" && $2 !~ /_(table|registers)\./ && $1 > 400 { print $2 ": " $1 " lines" }')
if [[ -n $long ]]; then
  printf '%s\n' "$long"
  exit 1
fi
echo "no file beyond 400 lines"
