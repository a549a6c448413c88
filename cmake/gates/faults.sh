#!/usr/bin/env bash
# Every kind of fault is flown: its word stands in a plan.  faults.sh ROOT; exit 1 if one does not.
set -euo pipefail
cd "$1"
table=io_bridges/devices/faults.cpp
kinds=$(sed -n 's/^ *{FaultKind::[a-z0-9_]*, "\([a-z0-9_]*\)"},$/\1/p' $table 2>/dev/null || true)
if [[ -z $kinds ]]; then
  echo "$table names no kind of fault: nothing was checked"
  exit 1
fi
declared=$(sed -n '/^enum class FaultKind/,/^}/p' io_bridges/devices/faults.hpp | grep -cE '^ +[a-z0-9_]+( = [0-9]+)?,')
if [[ $(wc -l <<<"$kinds") -ne $declared ]]; then
  echo "$(wc -l <<<"$kinds") kinds of fault have a word, $declared are declared"
  exit 1
fi
missing=$(while read -r kind; do
  grep -rqF --include='*.lua' "\"$kind\"" test_plans || echo "$kind"
done <<<"$kinds")
if [[ -n $missing ]]; then
  echo "no plan flies" $missing
  exit 1
fi
echo "$declared kinds of fault are flown"
