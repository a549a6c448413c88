#!/usr/bin/env bash
# Reals are compared by near() with a tolerance that states its reason (base/near.hpp), or are exactly equal: no
# test uses GoogleTest's own approximations, or bounds an absolute difference by a bare number.
# reals.sh ROOT; prints each offence; exit 1 if any.
set -euo pipefail
files=$("$(dirname "${BASH_SOURCE[0]}")/code_files.sh" "$1")
cd "$1"
near='(EXPECT|ASSERT)_(NEAR|DOUBLE_EQ|FLOAT_EQ)|(Double|Float)(Near|Eq|LE)\>'
bound='(EXPECT|ASSERT)_L[TE]\((std::)?f?abs\(.* - '
if tr '\n' '\0' <<<"$files" | xargs -0 grep -HnE "$near|$bound"; then
  echo 'compare reals by near(got, want, tolerance)'
  exit 1
fi
echo "$(wc -l <<<"$files") files compare reals by a tolerance with a reason, or exactly"
