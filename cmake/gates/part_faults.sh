#!/usr/bin/env bash
# Every fault of every part of the flight board is flown: each kind that the part's header names under "Faults"
# stands in a flight plan, on one line with the part's device.  part_faults.sh ROOT; exit 1 if one does not.
set -euo pipefail
cd "$1"
parts='mpu6000 imu
ms5611 baro
hmc5883l mag
ublox gps
sd_card card
cppm rc
sbus sbus
ublox m8
battery_sense battery
current_sense current'
# The image never asks a receiver which make it is: that fault finds nothing to act on, and the run is an error. The
# PX4FMU v1 measures no current, and the image takes it from its ESCs: nothing reads what that part shows.
refused='current sensor_frozen
current sensor_offset
current sensor_drift
current sensor_saturated
gps sensor_wrong_identity
m8 sensor_wrong_identity'

faults_of() {  # FILE
  sed -n '/^\/\/   Faults\? /,/^\/\/   [A-Z][a-z]* \{2,\}[^F]\|^#/p' "$1" |
    grep -oE '\b(sensor|gnss|memory|rc)_[a-z]+(_[a-z]+)*' | sort -u
}
flown=0 missing=
while read -r part device; do
  file=io_bridges/devices/$part.hpp
  [[ -e $file ]] || file=io_bridges/rack/devices/$part.cpp
  kinds=$(faults_of "$file" 2>/dev/null || true)
  for kind in $kinds; do
    grep -qxF "$device $kind" <<<"$refused" && continue
    if grep -rqE "kind = \"$kind\", device = \"$device\"" --include='*.lua' test_plans/flight; then
      flown=$((flown + 1))
    else
      missing+=" $device:$kind"
    fi
  done
done <<<"$parts"
if [[ -n $missing ]]; then
  echo "no flight plan flies$missing"
  exit 1
fi
if ((flown == 0)); then
  echo "no part has faults: nothing was checked"
  exit 1
fi
echo "$flown faults of parts are flown"
