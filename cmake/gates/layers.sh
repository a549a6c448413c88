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
harness/flight           harness/ io_bridges/ plant/ results/ firmware/esc/core/
harness/stand            harness/ io_bridges/ plant/ results/ firmware/esc/core/
firmware                 firmware/
firmware/esc/core        firmware/esc/core/
END
}

allowed_for() {  # the rule of the longest folder that holds FILE
  rules | awk -v file="$1" '
    index(file, $1 "/") == 1 && length($1) > best { best = length($1); $1 = ""; line = $0 }
    END { print line }'
}

# Emits "file<TAB>included" for every include of this project, in tests or not.
includes() {
  cd "$root"
  find harness plant io_bridges firmware results -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.c' \) 2>/dev/null |
    grep -vE '/(tests|bench)/' | sort |
    xargs -r grep -HoE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]+"' |
    sed -E 's/^([^:]+):.*"([^"]+)".*/\1\t\2/'
}

offences=0
while IFS=$'\t' read -r file included; do
  allowed=$(allowed_for "$file")
  if [[ $included != */* ]]; then
    printf '%s includes "%s": name it by its path from the root\n' "$file" "$included"
    offences=$((offences + 1))
    continue
  fi
  ok=no
  for prefix in $allowed; do
    if [[ $included == "$prefix"* ]]; then ok=yes; fi
  done
  if [[ $ok == no ]]; then
    printf '%s may not include "%s" (allowed:%s)\n' "$file" "$included" "$allowed"
    offences=$((offences + 1))
  fi
done < <(includes)
if ((offences > 0)); then
  exit 1
fi
echo "layers respected"
