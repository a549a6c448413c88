#!/usr/bin/env bash
# No file of code beyond 400 lines (register tables under a name ending in _table or _registers are
# exempt).  sizes.sh ROOT; exit 1 if any.
set -euo pipefail
files=$("$(dirname "${BASH_SOURCE[0]}")/code_files.sh" "$1")
cd "$1"
long=$(tr '\n' '\0' <<<"$files" | xargs -0 wc -l |
  awk '$2 != "total" && $2 !~ /_(table|registers)\./ && $1 > 400 { print $2 ": " $1 " lines" }')
if [[ -n $long ]]; then
  printf '%s\n' "$long"
  exit 1
fi
echo "no file of $(wc -l <<<"$files") beyond 400 lines"
