#!/usr/bin/env bash
# A host that is kept busy on purpose makes a paced run inconclusive, and says by how much.  pace_overload.sh WHIRL
# The threads that take it away are in step: none of the cores is free while they burn.
set -euo pipefail
whirl=$1
said=$(mktemp)
trap 'rm -f "$said"' EXIT

status=0
"$whirl" bench pace --seconds 2 --overload $((4 * $(nproc))) >"$said" || status=$?
cat "$said"
((status == 3)) || { echo "exit code $status, not 3 (inconclusive)"; exit 1; }
share=$(sed -n 's/.*inconclusive: the host was late: .*(\([0-9.]*\) %) later.*/\1/p' "$said")
[[ $share ]] || { echo "it does not say that the host was late"; exit 1; }
# They burn 3 ms of each 10. What is less than a third of that is no overload.
awk -v share="$share" 'BEGIN { exit !(share >= 10) }' || { echo "only $share % late"; exit 1; }
