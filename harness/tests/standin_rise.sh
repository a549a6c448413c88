#!/usr/bin/env bash
# The bench's thrust rise against `whirl standin`, the ESC's real image in a process of its own: behind an MCP2221A that
# this kernel's uhid plays, by hidapi and I2C; and on vcan1, by DroneCAN.  standin_rise.sh WHIRL [PACE [i2c|can]]
# A host that is late makes a run inconclusive; that it was so must then be said.
set -euo pipefail
whirl=$1
pace=${2:-0.05}
folder=$(mktemp -d)
export WHIRL_RESULTS=$folder/results
metal=
trap '[[ $metal ]] && kill $metal 2>/dev/null; wait; rm -rf "$folder"' EXIT

# rise NAME PLAN OPTIONS-OF-STANDIN...
rise() {
  local name=$1 plan=$2 status=0
  shift 2
  "$whirl" standin "$@" --pace "$pace" --folder "$folder/$name" >"$folder/standin" 2>&1 &
  metal=$!
  for _ in $(seq 100); do grep -q 'stands in' "$folder/standin" && break; sleep 0.2; done
  "$whirl" run "test_plans/bench/$plan" --target "bench/$folder/$name/bench.lua" --arm "nothing turns" \
    >"$folder/run" 2>&1 || status=$?
  kill $metal
  wait $metal || true
  metal=
  cat "$folder/run" "$folder/standin"
  python3 - "$name" "$folder/results/runs/latest/run.json" <<'PYTHON'
import json, sys
for e in json.load(open(sys.argv[2]))["expectations"]:
    if e["name"] == "thrust rise, 10 to 90 %":
        print("figure: rise on the stand-in, over %s: %.2f ms" % (sys.argv[1], e["measured"]))
PYTHON
  if ((status == 3)); then grep -q 'the host was late' "$folder/run"; return 0; fi
  return $status
}

if [[ ${3:-i2c} == i2c ]]; then rise i2c rise.lua esc32v2 --serial GUEST1; fi
if [[ ${3:-can} == can ]]; then rise can rise_can.lua esc32v2_can --can vcan1; fi
