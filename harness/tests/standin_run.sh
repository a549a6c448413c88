#!/usr/bin/env bash
# A bench's plan against `whirl standin`, a real image in a process of its own, over this kernel's interfaces:
# standin_run.sh WHIRL i2c|can|hover PACE [LOCKSTEP]
#   i2c    the thrust rise: an ESC behind an MCP2221A that uhid plays, by hidapi and I2C
#   can    the same on vcan1, by DroneCAN
#   hover  a flight controller on vcan1: the bench is its vehicle
# LOCKSTEP: the folder of the virtual board's run of the same plan. What the plan is about (thrust and its rise, supply
# current; the motors' currents of a hover) is within 5 % of that one's; all else is told. When it stands is another
# question on a bench, which has the ESC's word for its speed.
# Who is late, bench or stand-in, has shown nothing. In a guest with its own clock nobody may be; else it must be said.
set -euo pipefail
whirl=$1 kind=$2 pace=$3 lockstep=${4:-}
folder=$(mktemp -d)
export WHIRL_RESULTS=$folder/results
metal= busy=
# A guest's own clock leaps while a file is awaited. As long as programs and plans are read, something is to be done.
keep_busy() { if [[ ${WHIRL_OWN_CLOCK:-} ]]; then chrt --idle 0 bash -c 'while :; do :; done' & busy=$!; fi; }
rest() { if [[ $busy ]]; then kill "$busy"; fi; busy=; }
trap 'rest; [[ $metal ]] && kill "$metal" 2>/dev/null; wait; rm -rf "$folder"' EXIT
case $kind in
  i2c) plan=test_plans/bench/rise.lua stands=(esc32v2 --serial GUEST1) ;;
  can) plan=test_plans/bench/rise_can.lua stands=(esc32v2_can --can vcan1) ;;
  hover) plan=test_plans/flight/bench_hover.lua stands=(px4fmu_v1_all_can --can vcan1) ;;
  *) echo "standin_run.sh: '$kind' is none of i2c, can, hover" >&2 && exit 2 ;;
esac

keep_busy
"$whirl" standin "${stands[@]}" --pace "$pace" --folder "$folder/metal" >"$folder/standin" 2>&1 &
metal=$!
until grep -q 'stands in' "$folder/standin"; do
  kill -0 $metal || break
  sleep 0.2
done
begin=$SECONDS status=0
"$whirl" run "$plan" --target "bench/$folder/metal/bench.lua" --arm "nothing turns" >"$folder/run" 2>&1 &
run=$!
sleep 6  # its first steps have read what there is to read
rest
wait $run || status=$?
keep_busy
echo "figure: $kind: the run took $((SECONDS - begin)) s at pace $pace"
kill $metal || true
wait $metal || true
metal=
cat "$folder/run" "$folder/standin"
late=$(grep -o 'the host was late.*' "$folder/run" || true)
if ! grep -q ' 0.00 s given up' "$folder/standin"; then late="the stand-in was late, $(tail -n 1 "$folder/standin")"; fi
if [[ $late ]]; then
  echo "figure: $kind: not judged, $late"
  [[ ! ${WHIRL_OWN_CLOCK:-} ]]
  exit
fi
if ((status != 0)); then exit "$status"; fi
[[ $lockstep ]] || exit 0
"$whirl" parity "$lockstep" "$folder/results/runs/latest"
python3 - "$lockstep/run.json" "$folder/results/runs/latest/run.json" <<'PYTHON'
import json, sys
virtual, bench = ({e["name"]: e for e in json.load(open(f))["expectations"]} for f in sys.argv[1:])
far = []
for name, e in bench.items():
    want = virtual[name]["measured"]
    off = abs(e["measured"] - want) / abs(want) if want else 0.0
    print("figure: %s: %.4g, in lockstep %.4g, apart by %.1f %%" %
          (name, e["measured"], virtual[name]["measured"], 100 * off))
    asked = name.startswith(("steady at", "thrust rise", "supply current", "bus current"))
    if asked and off > 0.05: far.append(name)
sys.exit("further than 5 % from lockstep: " + ", ".join(far) if far else 0)
PYTHON
