#!/usr/bin/env bash
# What can-utils make, we understand, and they understand ours; python-can reads our log; DroneCAN's golden frames
# among them.  tools.sh CANDUMP_ROUND
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$*"; exit 1; }

candump -L -n 8 -T 20000 vcan0 >"$folder/seen" &
seen=$!
"$1" vcan0 "$folder/our.log" 4 >"$folder/says" &
ours=$!
for _ in $(seq 50); do grep -q ready "$folder/says" && break; sleep 0.1; done
for frame in 1801552A#0403020158CDABC5 123#DEADBEEF 7FE#R4 00000010#; do cansend vcan0 $frame; sleep 0.05; done
wait $ours || fail "we did not take all of cansend's frames"
wait $seen || fail "candump did not see all frames"

for frame in 1801552A#0403020158CDABC5 1801552B#0403020158CDABC5 123#DEADBEEF 124#DEADBEEF 7FE#R4 7FF#R4 00000010# 00000011#; do
  grep -q " vcan0 $frame\$" "$folder/seen" || fail "candump has not seen $frame: $(cat "$folder/seen")"
  grep -q " vcan0 $frame\$" "$folder/our.log" || fail "our log has no $frame: $(cat "$folder/our.log")"
done

python3 - "$folder/our.log" <<'PYTHON'
import sys
import can
frames = list(can.LogReader(sys.argv[1]))
assert len(frames) == 8, frames
first, remote = frames[0], frames[4]
assert first.arbitration_id == 0x1801552A and first.is_extended_id, first
assert bytes(first.data) == bytes.fromhex("0403020158CDABC5"), first
assert remote.is_remote_frame and remote.dlc == 4 and not remote.is_extended_id, remote
assert frames[6].arbitration_id == 0x10 and frames[6].is_extended_id and frames[6].dlc == 0, frames[6]
assert all(a.timestamp <= b.timestamp for a, b in zip(frames, frames[1:]))
print("figure: python-can", can.__version__, "read", len(frames), "frames of our log")
PYTHON
