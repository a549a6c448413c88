#!/usr/bin/env bash
# Who may include whom (see the house rules in README).  layers.sh ROOT; prints each offence; exit 1 if any.
#
#   Each folder lists what its files may include of this project; the longest matching folder wins.
#   Files under a tests/ or bench/ folder may look anywhere. A folder that no line names is an offence,
#   and so is an include that hides what it means: <...> for a file of ours, "..", a macro.
set -euo pipefail
root=$(cd "$1" && pwd)

rules() {
  cat <<'END'
harness/base             harness/base/
plant                    harness/base/ plant/
io_bridges/protocols     harness/base/ io_bridges/protocols/ io_bridges/devices/
io_bridges/devices       harness/base/ io_bridges/protocols/ io_bridges/devices/
io_bridges/link          harness/base/ io_bridges/link/
io_bridges/qemu/cycles   io_bridges/qemu/cycles/
io_bridges/qemu/stm32    harness/base/ io_bridges/protocols/ io_bridges/devices/ io_bridges/qemu/stm32/ io_bridges/qemu/cycles/flash_timing.hpp
io_bridges/qemu/plugin   harness/base/ io_bridges/
io_bridges/qemu/board    harness/base/ io_bridges/ plant/
results                  harness/base/ io_bridges/link/ io_bridges/protocols/ results/
harness                  harness/ io_bridges/protocols/ io_bridges/link/ io_bridges/devices/faults.hpp plant/ results/ firmware/esc/core/
harness/target           harness/ io_bridges/
harness/fuzz             harness/ io_bridges/ plant/ results/
harness/flight           harness/ io_bridges/ plant/ results/ firmware/esc/core/
harness/stand            harness/ io_bridges/ plant/ results/ firmware/esc/core/
cmake/mutate             cmake/mutate/
firmware                 firmware/
firmware/esc/core        firmware/esc/core/
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
    ok = 0
    m = split(allowed[best], prefixes, " ")
    for (i = 1; i <= m; ++i) if (index(name, prefixes[i]) == 1) ok = 1
    if (!ok) offence("may not include \"" name "\" (allowed: " allowed[best] ")")
  }
  END {
    if (seen == 0) { print "no include seen: nothing was checked"; exit 1 }
    if (offences > 0) exit 1
    print seen " includes respect the layers"
  }'
