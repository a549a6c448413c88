#!/usr/bin/env bash
# The IMU's traffic of a run as the device pod_replay does it again.  record.sh RUN_FOLDER SECONDS > traffic.txt
#
#   Format  io_bridges/rack/devices/spi_traffic.hpp. Bus 1, device "imu", the run's first SECONDS
set -euo pipefail
run=$1 seconds=$2
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$root"/build/host/harness/whirl export "$run" --csv --out "$out" >/dev/null
awk -v most="$seconds" '
  function ns(text, parts) { split(text, parts, "."); return sprintf("%.0f", parts[1] * 1000000000 + parts[2]) }
  function field(name, parts) { split($0, parts, name "="); sub(/[;"].*/, "", parts[2]); return parts[2] }
  { split($0, column, ",") }
  column[1] + 0 > most { exit }
  column[4] == "data_ready" && column[6] == "\"imu\"" { ready = "R " ns(column[1]) "\n" }
  column[4] == "spi_transaction" && column[6] == "\"imu\"" {
    n = split(field("passed_ns"), passed, " ")
    start = field("start_ns")
    byte = n > 1 ? int((passed[n] - passed[1]) / (n - 1) + 0.5) : 12190
    bytes = field("bytes")
    if (bytes ~ /^BB/) printf "%s", ready  # a rise that no burst followed was nobody's business
    ready = ""
    printf "T %.0f %.0f %.0f %.0f %s\n", start, passed[1] - byte, byte, ns(column[1]) - start - passed[n], bytes
  }' "$out/messages.csv"
