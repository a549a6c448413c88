#!/usr/bin/env bash
# Who may include whom (see the house rules in README).  layers.sh ROOT; prints each offence; exit 1 if any.
#
#   Each folder lists what its files may include of this project; the longest matching folder wins.
#   No folder may include itself by way of others: what is on a circle cannot be understood, or tested,
#   one after the other. Files under a tests/ or bench/ folder may look anywhere. A folder that no line names is an offence,
#   and so is an include that hides what it means: <...> for a file of ours, "..", a macro.
set -euo pipefail
root=$(cd "$1" && pwd)

rules() {
  cat <<'END'
base                     base/
plant                    base/ plant/
plant/base               base/ plant/base/
plant/air                base/ plant/air/ plant/base/
plant/airframe           base/ plant/air/ plant/airframe/ plant/base/
plant/battery            base/ plant/base/ plant/battery/
plant/motor              base/ plant/base/ plant/motor/
plant/parts              base/ plant/parts/
plant/rotor              base/ plant/rotor/
plant/sensors            base/ plant/base/ plant/sensors/
io_bridges/board_description base/ io_bridges/board_description/
io_bridges/messages      base/ io_bridges/messages/ io_bridges/protocols/can_frame.hpp
io_bridges/protocols     base/ io_bridges/protocols/ io_bridges/devices/core/
io_bridges/devices       base/ io_bridges/protocols/ io_bridges/devices/
io_bridges/devices/core  io_bridges/devices/core/
io_bridges/copper        base/ io_bridges/copper/ io_bridges/messages/
io_bridges/sigrok        base/ io_bridges/copper/edge.hpp io_bridges/copper/edge_sink.hpp io_bridges/sigrok/
io_bridges/openocd       base/ io_bridges/openocd/
io_bridges/hid           base/ io_bridges/hid/
io_bridges/hid/emulated  base/ io_bridges/devices/ io_bridges/hid/hid_port.hpp io_bridges/hid/emulated/
io_bridges/link          base/ io_bridges/link/
io_bridges/serial        base/ io_bridges/serial/
io_bridges/socketcan     base/ io_bridges/protocols/ io_bridges/socketcan/
io_bridges/rack          base/ io_bridges/board_description/ io_bridges/devices/ io_bridges/messages/ io_bridges/rack/
io_bridges/rack/models   base/ io_bridges/devices/ io_bridges/messages/ io_bridges/rack/models/ plant/
io_bridges/rack/devices  base/ io_bridges/board_description/ io_bridges/devices/ io_bridges/messages/ io_bridges/protocols/ io_bridges/rack/ plant/
io_bridges/qemu/cycles   io_bridges/qemu/cycles/
io_bridges/qemu/stm32    base/ io_bridges/protocols/ io_bridges/devices/ io_bridges/qemu/stm32/ io_bridges/qemu/cycles/flash_timing.hpp
io_bridges/qemu/plugin   base/ io_bridges/
io_bridges/qemu/board    base/ io_bridges/ plant/
results                  base/ io_bridges/messages/ results/
results/messages         base/ io_bridges/messages/ results/messages/
results/flight_log       base/ results/flight_log/
results/spread           base/ io_bridges/messages/ results/
results/sinks            base/ io_bridges/copper/wire_drawing.hpp io_bridges/copper/edge.hpp io_bridges/messages/ results/messages/ results/sinks/
harness                  base/ harness/cli/ harness/composition/ harness/target/bench/
harness/composition      base/ harness/board/ harness/catalogue/ harness/cli/composition.hpp harness/cli/console.hpp harness/cli/find_board.hpp harness/cli/find_file.hpp harness/cli/stand_in_request.hpp harness/composition/ harness/flight/ harness/pacing/ harness/plan/needs.hpp harness/stand/ harness/standin/ harness/target/ io_bridges/board_description/ io_bridges/hid/emulated/ io_bridges/protocols/ io_bridges/rack/devices/pod_faults.hpp io_bridges/rack/devices/table.hpp
harness/job              base/ harness/job/
harness/lua              base/ harness/lua/
harness/pacing           base/ harness/pacing/
harness/metrics          harness/metrics/
harness/world            base/ harness/world/ io_bridges/messages/
harness/board            base/ harness/board/ io_bridges/board_description/
harness/target           base/ harness/target/ io_bridges/
harness/target/bench     base/ harness/pacing/ harness/target/ io_bridges/
harness/lockstep         base/ harness/lockstep/ harness/target/target.hpp harness/world/ io_bridges/messages/
harness/plan             base/ harness/board/ harness/lua/ harness/metrics/ harness/plan/ harness/target/offers.hpp harness/world/ io_bridges/board_description/bus_name.hpp io_bridges/board_description/bus_kind.hpp results/
harness/executive        base/ harness/board/ harness/executive/ harness/lockstep/ harness/metrics/ harness/plan/ harness/target/ harness/world/ io_bridges/devices/faults.hpp io_bridges/messages/ results/
harness/catalogue        base/ harness/calibrate/setup.hpp harness/catalogue/ harness/flight/ harness/lua/ harness/stand/ harness/target/bench/bench_description.hpp harness/world/drawn_part.hpp io_bridges/board_description/ io_bridges/copper/channel_name.hpp io_bridges/protocols/ io_bridges/rack/ plant/ firmware/esc/core/
harness/flight           base/ harness/flight/ harness/world/ io_bridges/board_description/ io_bridges/messages/ io_bridges/protocols/ plant/ firmware/esc/core/
harness/standin          base/ harness/board/ harness/lockstep/ harness/pacing/ harness/standin/ harness/target/ harness/world/ io_bridges/board_description/ io_bridges/devices/core/receiver.hpp io_bridges/link/ io_bridges/messages/ io_bridges/protocols/ io_bridges/serial/ io_bridges/socketcan/
harness/stand            base/ harness/stand/ harness/world/ io_bridges/board_description/ io_bridges/messages/ io_bridges/protocols/ plant/
harness/inflow_bound     base/ harness/inflow_bound/ plant/ results/
harness/sweep            base/ harness/flight/controllers.hpp harness/flight/flight_params.hpp harness/regression/ harness/sweep/ plant/ results/
harness/timing           base/ harness/target/ harness/timing/
harness/regression       base/ harness/regression/
harness/calibrate        base/ harness/calibrate/ harness/lockstep/ harness/regression/ harness/target/ harness/world/ io_bridges/protocols/ results/ firmware/esc/core/
harness/live             base/ harness/executive/companion.hpp harness/live/ harness/lua/ harness/pacing/ harness/world/ io_bridges/hid/ io_bridges/messages/
harness/cli              base/ harness/board/ harness/calibrate/ harness/catalogue/ harness/cli/ harness/executive/ harness/inflow_bound/ harness/job/ harness/live/ harness/pacing/ harness/plan/ harness/sweep/ harness/target/ harness/timing/ harness/world/ io_bridges/board_description/ io_bridges/copper/decoding.hpp io_bridges/hid/hid_device.hpp io_bridges/openocd/ io_bridges/protocols/esc_codec.hpp io_bridges/qemu/board/image.hpp io_bridges/sigrok/capture.hpp io_bridges/rack/ plant/validation/ results/
harness/fuzz             base/ harness/calibrate/ harness/catalogue/ harness/fuzz/ harness/plan/ io_bridges/ plant/ results/
cmake                    cmake/
cmake/mutate             cmake/mutate/
firmware                 firmware/
firmware/esc/core        firmware/esc/core/
firmware/pod             firmware/ io_bridges/devices/core/
END
}

cd "$(dirname "${BASH_SOURCE[0]}")"
files=$(./code_files.sh "$root")
cd "$root"

# "file<TAB>the rest of the line" for every include, however it is written.
includes() {
  tr '\n' '\0' <<<"$files" |
    xargs -0 grep -HE '^[[:space:]]*(#|%:)[[:space:]]*(include|include_next|import)([^a-z_]|$)' |
    sed -E 's/^([^:]+):[[:space:]]*(#|%:)[[:space:]]*(include_next|include|import)[[:space:]]*/\1\t/'
}

{
  sed 's/^/file\t/' <<<"$files"
  includes | sed 's/^/include\t/'
} | awk -F '\t' -v rules="$(rules)" '
  BEGIN {
    n = split(rules, lines, "\n")
    for (i = 1; i <= n; ++i) {
      folder = lines[i]; sub(/ .*/, "", folder)
      allowed[folder] = lines[i]; sub(/^[^ ]+ +/, "", allowed[folder])
      top[substr(folder, 1, index(folder "/", "/") - 1)] = 1
    }
  }
  function offence(text) { print $2 ": " text; ++offences }
  function folder_of(file, folder, best) {
    best = ""
    for (folder in allowed)
      if (index(file, folder "/") == 1 && length(folder) > length(best)) best = folder
    return best
  }
  function parent(path) { sub(/\/[^\/]*$/, "", path); return path }
  function add_edge(file, name, from, to) {
    from = parent(file); to = parent(name)
    if (from != to && !((from, to) in edge)) uses[from] = uses[from] " " to
    edge[from, to]
  }
  # Depth first from here: a folder that is met while it is still open lies on a circle.
  function walk(folder, way, i, m, next_ones) {
    if (state[folder] == "done") return
    if (state[folder] == "open") {
      way = substr(way, index(way, folder))
      print way folder ": these folders include each other"
      ++offences
      return
    }
    state[folder] = "open"
    m = split(uses[folder], next_ones, " ")
    for (i = 1; i <= m; ++i) walk(next_ones[i], way folder " -> ")
    state[folder] = "done"
  }
  $1 == "file" {
    known = $2 ~ /\/(tests|bench)\// ? substr($2, 1, index($2, "/") - 1) in top : folder_of($2) != ""
    if (!known) offence("no rule names its folder")
    if ($2 !~ /\.(hpp|cpp|h|c)$/) offence("code ends in .hpp or .cpp (of C: .h, .c)")
    next
  }
  $2 ~ /(^|\/)(tests|bench)\// { next }
  {
    ++seen
    if (match($3, /^<[^>]+>/)) {
      name = substr($3, 2, RLENGTH - 2)
      if (name ~ /(^|\/)\.\.?\// || (index(name, "/") && substr(name, 1, index(name, "/") - 1) in top))
        offence("includes <" name "> of this project: write \"...\", by its path from the root")
      next
    }
    if (!match($3, /^"[^"]+"/)) { offence("includes what cannot be read: " $3); next }
    name = substr($3, 2, RLENGTH - 2)
    if (index(name, "/") == 0 || name ~ /(^|\/)\.\.?\//) {
      offence("includes \"" name "\": name it by its path from the root")
      next
    }
    best = folder_of($2)
    add_edge($2, name)
    ok = 0
    m = split(allowed[best], prefixes, " ")
    for (i = 1; i <= m; ++i) if (index(name, prefixes[i]) == 1) ok = 1
    if (!ok) offence("may not include \"" name "\" (allowed: " allowed[best] ")")
  }
  END {
    if (seen == 0) { print "no include seen: nothing was checked"; exit 1 }
    m = 0
    for (folder in uses) starts[++m] = folder
    for (i = 1; i <= m; ++i) walk(starts[i], "")
    if (offences > 0) exit 1
    print seen " includes respect the layers"
  }'
