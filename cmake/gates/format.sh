#!/usr/bin/env bash
# Every C++ file as clang-format lays it out.  format.sh ROOT; prints what differs; exit 1 if any.
set -euo pipefail
files=$("$(dirname "${BASH_SOURCE[0]}")/code_files.sh" "$1")
cd "$1"
tr '\n' '\0' <<<"$files" | xargs -0 clang-format-14 --style=file --dry-run -Werror
echo "$(wc -l <<<"$files") files formatted"
