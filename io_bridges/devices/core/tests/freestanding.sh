#!/usr/bin/env bash
# The parts compile for the pod's core, alone: without a hosted library, exceptions, run-time type
# information or floating point, and need nothing but each other and memset, memcpy.  freestanding.sh ROOT FOLDER
set -euo pipefail
root=$1 folder=$2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
sources=("$root/$folder"/*.cpp)
[ -e "${sources[0]}" ] || { echo "no sources in $folder: nothing was checked"; exit 1; }
for source in "${sources[@]}"; do
  arm-none-eabi-g++ -std=c++20 -ffreestanding -mcpu=cortex-m4 -mthumb -O2 -fno-exceptions -fno-rtti \
    -fno-threadsafe-statics -Wall -Wextra -Wpedantic -Wshadow -Wdouble-promotion -Wfloat-conversion -Werror \
    -I"$root" -c "$source" -o "$out/$(basename "$source").o"
done
arm-none-eabi-ld -r "$out"/*.o -o "$out/all.o"
if others=$(arm-none-eabi-nm --undefined-only "$out/all.o" | grep -vE ' U (memset|memcpy)$'); then
  echo "the parts of $folder need more than each other:"
  echo "$others"
  exit 1
fi
echo "${#sources[@]} files stand by themselves"
