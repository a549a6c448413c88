#!/usr/bin/env bash
# A flight's log as programs of other people read it: log_readers.sh WHIRL ROOT.
#
#   Flies test_plans/flight/flight_log.lua's first plan, then: fsck.fat calls the card's volume clean, mtools
#   takes the log out of it, Foxglove's reader (npm, @foxglove/ulog) reads it and agrees with run.json and
#   with truth.csv. npm brings it by its lock file
set -euo pipefail
whirl=$1 root=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
PATH=$PATH:/sbin:/usr/sbin
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$whirl" run "$root/test_plans/flight/flight_log.lua" --only 'a flight is logged whole' --out "$scratch/results"
run=$(realpath "$scratch/results/runs/latest")

# The partition begins at 1 MiB; holes stay holes.
dd if="$run/card.img" of="$scratch/volume.img" bs=1M skip=1 conv=sparse status=none
fsck.fat -n "$scratch/volume.img"
mcopy -n -i "$run/card.img@@1M" ::LOG00001.ULG "$scratch/log.ulg"
cmp "$scratch/log.ulg" "$run/flight.ulg"

for tool in node npm; do
  command -v "$tool" >/dev/null || { echo "$tool is not there: ./whirl test installs it (nodejs, npm)" >&2; exit 1; }
done
cd "$scratch"
cp "$here/package.json" "$here/package-lock.json" .
if ! timeout 120 npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >npm.txt 2>&1; then
  cat npm.txt >&2
  echo "log_readers: npm did not get @foxglove/ulog, is its registry reachable? The log was not read by it" >&2
  exit 1
fi
cp "$here/read_ulog.js" .
node read_ulog.js log.ulg "$run"

# It would notice: a hundred bytes of the log's middle, spoiled.
cp log.ulg spoiled.ulg
printf 'x%.0s' {1..100} | dd of=spoiled.ulg bs=1 seek=$(($(stat -c %s log.ulg) / 2)) conv=notrunc status=none
if node read_ulog.js spoiled.ulg "$run" >/dev/null 2>&1; then
  echo 'log_readers: a spoiled log passes too' >&2
  exit 1
fi
