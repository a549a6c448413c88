#!/bin/sh
# Judges an image by what it contains: check_image.sh ELF FLASH_KIB RAM_KIB. Prints its sizes.
# Fails on heap, exceptions, run-time type information, double arithmetic, and beyond the budget.
set -eu
elf=$1 flash_kib=$2 ram_kib=$3
[ -s "$elf" ] || { echo "check_image: $elf: missing or empty; build the firmware preset" >&2; exit 1; }
symbols=$(arm-none-eabi-nm "$elf")
[ -n "$symbols" ] || { echo "check_image: $elf: no symbols, nothing to judge" >&2; exit 1; }
forbidden='(malloc|_malloc_r|free|_free_r|calloc|realloc|_?sbrk|_sbrk_r|_Zn[wa]j.*|_Zd[la]Pv.*|__cxa_.*|_Unwind_.*|__gxx_personality.*|__aeabi_(d|i2d|ui2d|l2d|ul2d|f2d|h2d|cd).*|__ieee754_(sin|cos|sqrt|atan2|pow|exp|log)|printf|_printf_.*|abort)'
if found=$(printf '%s\n' "$symbols" | grep -E " [A-Za-z] $forbidden\$"); then
  echo "check_image: $elf contains what firmware may not:" >&2
  printf '%s\n' "$found" >&2
  exit 1
fi
# Berkeley columns: text (code and constants), data (in both), bss (stack included).
set -- $(arm-none-eabi-size "$elf" | tail -n 1)
stack=$(arm-none-eabi-size -A "$elf" | awk '$1 == ".stack" { print $2 }')
flash=$(($1 + $2)) ram=$(($2 + $3 - stack))
printf '%s: flash %d B of %d KiB, RAM %d B of %d KiB, stack %d B\n' \
  "$(basename "$elf")" "$flash" "$flash_kib" "$ram" "$ram_kib" "$stack"
[ "$flash" -le $((flash_kib * 1024)) ] || { echo "check_image: $elf: flash over budget" >&2; exit 1; }
[ "$ram" -le $((ram_kib * 1024)) ] || { echo "check_image: $elf: RAM over budget" >&2; exit 1; }
