#!/usr/bin/env bash
# Twenty runs of a flight of five images have one digest, whatever the host does meanwhile: alone, beside processes
# that compute without end, on one core, on two. Takes some minutes, so nobody runs it but by hand and by night.
#   chain_digests.sh PROGRAM PLAN_FILE PLAN [RUNS_OF_EACH]
set -euo pipefail
program=$1 plan=$2 name=$3 runs=${4:-5}
scratch=$(mktemp -d)
busy=()
leave() {
  ((${#busy[@]} == 0)) || kill "${busy[@]}" 2>/dev/null || true
  rm -rf "$scratch"
}
trap leave EXIT

# fly WAY COMMAND...: so many times, by way of that command.
fly() {
  local way=$1 k
  shift
  for ((k = 0; k < runs; ++k)); do
    "$@" "$program" run --out "$scratch/out" "$plan" --only "$name" >"$scratch/told" || {
      cat "$scratch/told"
      exit 1
    }
    sed -n "s/^PASS.* \([0-9.]*x\), seed .*, digest \([0-9a-f]*\)$/\2 $way \1/p" "$scratch/told" | tee -a "$scratch/digests"
    rm -rf "$scratch/out"
  done
}

fly alone env
fly one_core taskset -c 0
fly two_cores taskset -c 0,1
for _ in 1 2; do
  while :; do :; done &
  busy+=($!)
done
fly beside_two_busy_processes env
found=$(cut -d' ' -f1 "$scratch/digests" | sort -u)
[[ $(wc -l <"$scratch/digests") -eq $((4 * runs)) && $(wc -l <<<"$found") -eq 1 ]] || {
  echo "digests differ, or are too few: ${found//$'\n'/ }"
  exit 1
}
echo "$((4 * runs)) of $((4 * runs)) equal: $found"
