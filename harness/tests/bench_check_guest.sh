#!/usr/bin/env bash
# `whirl bench check` against a kernel that has CAN: one line for what is wrong with an interface, and exit code 2.
# bench_check_guest.sh WHIRL
set -euo pipefail
whirl=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"; ip link set can0 down' EXIT

# expect INTERFACE WORDS
expect() {
  cat >"$folder/b.lua" <<LUA
return { bench = "b", board = "esc32v2_can", links = { { name = "bus", bus = "can1", interface = "$1" } },
         instruments = {}, safety = { phrase = "clear", longest = "60 s" } }
LUA
  local status=0
  "$whirl" bench check "$folder/b.lua" --seconds 0.1 >"$folder/said" 2>&1 || status=$?
  if ((status != 2)) || [[ $(grep -c MISSING "$folder/said") != 1 ]] || ! grep -q "^  bus  *MISSING: $1: $2" "$folder/said"; then
    echo "$1: exit code $status, and not one line 'MISSING: $1: $2':"
    cat "$folder/said"
    exit 1
  fi
}

expect vcan9 'no such CAN interface'
expect lo 'is no CAN interface'
expect can0 'is down'
ip link set can0 up type can bitrate 500000
expect can0 'runs at 500000 bit/s, and 1000000 are wanted'
expect vcan0 'no DroneCAN node tells of itself'
echo "figure: bench check: five lines of what is missing"
