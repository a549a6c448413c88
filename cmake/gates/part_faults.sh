#!/usr/bin/env bash
# Every fault of every part of the flight boards is flown, refused, or owned up to: each kind that the part's header names under
# "Faults", and each of the wire that it hangs on, stands in a flight plan, on one line with the part's device (a wire's: or with its
# bus); of a kind that has an axis, once for each group of axes (accel, gyro, field, place, velocity, pressure, temperature). What is not
# stands in part_faults.txt, with why; and nothing stands there that is flown or that no part has.
#   part_faults.sh ROOT; exit 1 if one does not.
set -euo pipefail
cd "$1"
plans=test_plans/flight list=cmake/gates/part_faults.txt
# Device as plans name it (or a pattern), header of its own faults, kind of its wire, its bus, and the plans in which it hangs there.
parts='imu mpu6000 spi spi1 *
baro ms5611 i2c i2c2 *
mag hmc5883l i2c i2c2 *
gps ublox uart usart6 *
m8 ublox uart usart6 *
card sd_card spi spi3 *
rc cppm - - *
sbus sbus uart usart1 *
battery battery_sense - - *
current current_sense - - *
eeprom eeprom_24xx i2c - *
esc[1-4] - i2c i2c3 *
radio - uart usart2 *
esc[1-4] - can can2 dronecan_faults*
imu - can can2 all_can_faults*
baro - can can2 all_can_faults*
mag - can can2 all_can_faults*
gps - can can2 all_can_faults*
battery - can can2 all_can_faults*'
# Of a kind that is one fault or another by its value: each.
values='card sensor_wrong_identity value = 0
card sensor_wrong_identity value = [1-9]'
by_axis='sensor_offset sensor_drift sensor_scale sensor_saturated gnss_spoofed'

header_of() {  # PART
  local file
  for file in io_bridges/devices/"$1".hpp io_bridges/rack/devices/"$1".cpp; do
    if [[ -e $file ]]; then echo "$file" && return; fi
  done
}
own_faults() {  # PART
  local file
  file=$(header_of "$1")
  [[ -n $file ]] || return 0
  sed -n '/^\/\/   Faults\? /,/^\/\/   [A-Z][a-z]* \{2,\}[^F]\|^#/p' "$file" |
    { grep -oE '\b(sensor|gnss|memory|rc)_[a-z]+(_[a-z]+)*' || true; } | sort -u
}
wire_faults() {  # WIRE
  { grep -oE "^  ${1}_[a-z0-9_]+" io_bridges/devices/faults.hpp 2>/dev/null || true; } | tr -d ' '
}
group() { sed -E 's/velocity_.*/velocity/; s/^(north|east|down)$/place/; s/_[xyz]$//'; }
axes_of() {  # PART: its groups, or nothing
  local file=io_bridges/rack/devices/$1.cpp
  [[ -e $file ]] || return 0
  { grep -oE '"((accel|gyro|field)_[xyz]|(velocity_)?(north|east|down)|pressure|temperature)"' "$file" || true; } |
    tr -d '"' | group | sort -u
}
flown_lines() {  # PLANS: the faults of its files, without notes
  find $plans -name "$1" -name '*.lua' -exec cat {} + 2>/dev/null | sed 's/^ *--.*//' | grep -F 'kind = "' || true
}
is_flown() {  # KIND AXIS(or -) DEVICE BUS: by the lines on standard input
  local of="device = \"$3\""
  [[ $4 == - ]] || of="($of|bus = \"$4\")"
  grep -E "kind = \"$1\", $of" | { [[ $2 == - ]] && cat || grep -oE 'axis = "[a-z_]+"' | cut -d'"' -f2 | group | grep -x "$2"; } |
    grep -q .
}

flown=0 missing='' found='' stale=''
listed=$({ sed -E 's/ *#.*//; /^$/d' $list 2>/dev/null || true; } | awk '{print $1, $2}')
judge() {  # DEVICE KIND AXIS BUS LINES
  local name="${1//\[1-4\]/} $2"
  [[ $3 == - ]] || name+=":$3"
  found+=$name$'\n'
  if is_flown "$2" "$3" "$1" "$4" <<<"$5"; then
    flown=$((flown + 1))
    if grep -qxF "$name" <<<"$listed"; then stale+=" ${name// /:}"; fi
  elif ! grep -qxF "$name" <<<"$listed"; then
    missing+=" ${name// /:}"
  fi
}
while read -r device part wire bus where; do
  lines=$(flown_lines "$where")
  axes=$(axes_of "$part")
  for kind in $(own_faults "$part"); do
    if [[ -n $axes && " $by_axis " == *" $kind "* ]]; then
      for axis in $axes; do judge "$device" "$kind" "$axis" - "$lines"; done
    else
      judge "$device" "$kind" - - "$lines"
    fi
  done
  [[ $wire == - ]] || for kind in $(wire_faults "$wire"); do judge "$device" "$kind" - "$bus" "$lines"; done
done <<<"$parts"
if [[ -e io_bridges/devices/sd_card.hpp ]]; then
  all=$(flown_lines '*')
  while read -r device kind value; do
    grep -qE "kind = \"$kind\", device = \"$device\", $value\\b" <<<"$all" || missing+=" $device:$kind:${value// /}"
  done <<<"$values"
fi

status=0
if [[ -n $missing ]]; then echo "no flight plan flies$missing" && status=1; fi
if [[ -n $stale ]]; then echo "$list lists as not flown what a plan flies:$stale" && status=1; fi
strange=$(comm -13 <(sort -u <<<"$found") <(sort -u <<<"$listed") | sed 's/ /:/' | tr '\n' ' ')
if [[ -n ${strange// /} && $flown -gt 0 ]]; then echo "$list lists what no part has: $strange" && status=1; fi
# A part of a board that flies, and one that has faults, stands in the table above.
types=$(cat test_plans/boards/px4fmu_v1*.lua 2>/dev/null | grep -oE 'type = "[a-z0-9_]+"' | cut -d'"' -f2 | sort -u || true)
for type in $types; do
  case ${type%_dronecan} in
    m8 | ublox_* | battery | esc | esc_i2c | mavlink_link) continue ;;
  esac
  grep -q " ${type%_dronecan} " <<<"$parts" || { echo "no row of the table is a $type" && status=1; }
done
((status == 0)) || exit 1
if ((flown == 0)); then
  echo "no part has faults: nothing was checked"
  exit 1
fi
total=$(grep -c . <<<"$found")
echo "$total faults of parts: $flown are flown, $((total - flown)) stand with their reasons in $list"
