#!/usr/bin/env bash
# The tools that judge us are there and run: a frame sent by one is seen by the other.
set -euo pipefail
for tool in candump cansend i2cdetect i2cget i2ctransfer setpriv; do
  command -v "$tool" >/dev/null || { echo "$tool is not there (cmake/guest/packages.txt)"; exit 1; }
done
python3 -c 'import importlib.util, sys; sys.exit(importlib.util.find_spec("can") is None)' || { echo "python3-can is not there"; exit 1; }
candump -n 1 -T 5000 vcan0 >/tmp/seen &
sleep 0.3
cansend vcan0 123#DEADBEEF
wait $!
grep -q '123 .*DE AD BE EF' /tmp/seen
