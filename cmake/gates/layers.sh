#!/usr/bin/env bash
# Who may include whom (see the house rules in README).  layers.sh ROOT; prints each offence; exit 1 if any.
#
#   Each folder lists what its files may include of this project; the longest matching folder wins.
#   Files under a tests/ or bench/ folder may look anywhere. A folder that no line names is an offence.
set -euo pipefail
root=$1

rules() {
  cat <<'END'
harness/base             harness/base/
plant                    harness/base/ plant/
io_bridges/protocols     harness/base/ io_bridges/protocols/ io_bridges/devices/
io_bridges/devices       harness/base/ io_bridges/protocols/ io_bridges/devices/
io_bridges/link          harness/base/ io_bridges/link/
io_bridges/qemu/stm32    harness/base/ io_bridges/protocols/ io_bridges/devices/ io_bridges/qemu/stm32/
io_bridges/qemu/plugin   harness/base/ io_bridges/
io_bridges/qemu/board    harness/base/ io_bridges/ plant/
results                  harness/base/ io_bridges/link/ io_bridges/protocols/ results/
harness                  harness/ io_bridges/protocols/ io_bridges/link/ io_bridges/devices/faults.hpp plant/ results/ firmware/esc/core/
harness/target           harness/ io_bridges/
harness/flight           harness/ io_bridges/ plant/ results/ firmware/esc/core/
harness/stand            harness/ io_bridges/ plant/ results/ firmware/esc/core/
firmware                 firmware/
firmware/esc/core        firmware/esc/core/
END
}

# Emits "file<TAB>included" for every include of this project outside of tests.
includes() {
  find $(ls -d harness plant io_bridges firmware results 2>/dev/null) -type f \
    \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.c' \) |
    grep -vE '/(tests|bench)/' | sort |
    xargs -r grep -HoE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]+"' |
    sed -E 's/^([^:]+):.*"([^"]+)".*/\1\t\2/'
}

cd "$root"
includes | awk -F '\t' -v rules="$(rules)" '
  BEGIN {
    n = split(rules, lines, "\n")
    for (i = 1; i <= n; ++i) {
      folder = lines[i]; sub(/ .*/, "", folder)
      allowed[folder] = lines[i]; sub(/^[^ ]+ +/, "", allowed[folder])
    }
  }
  {
    best = ""
    for (folder in allowed)
      if (index($1, folder "/") == 1 && length(folder) > length(best)) best = folder
    ok = 0
    m = split(allowed[best], prefixes, " ")
    for (i = 1; i <= m; ++i) if (index($2, prefixes[i]) == 1) ok = 1
    if (index($2, "/") == 0) {
      printf "%s includes \"%s\": name it by its path from the root\n", $1, $2; ++offences
    } else if (!ok) {
      printf "%s may not include \"%s\" (allowed: %s)\n", $1, $2, allowed[best]; ++offences
    }
    ++seen
  }
  END {
    if (seen == 0) { print "no include seen: nothing was checked"; exit 1 }
    if (offences > 0) exit 1
    print seen " includes respect the layers"
  }'
