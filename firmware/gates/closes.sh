#!/bin/sh
# Proves that check_image.sh closes: builds one small image per thing it must refuse, and one it must
# let pass. Usage: closes.sh FIRMWARE_FOLDER
set -u
firmware=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

build() {  # name, body of a function that runs
  cat > "$work/$1.cpp" <<END
#include <cstdlib>
volatile int sink;
int* volatile kept;
volatile double real = 1.5;
extern "C" void fw_main() { $2 }
extern "C" void reset_handler() { fw_main(); for (;;) {} }
extern "C" { void* __dso_handle; }
END
  arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -Os -nostartfiles \
    --specs=nano.specs --specs=nosys.specs -Wl,--gc-sections -Wl,-e,reset_handler "$work/$1.cpp" -o "$work/$1.elf" \
    2> "$work/$1.log" || { echo "closes: $1 does not build"; cat "$work/$1.log"; failed=1; }
}

refuses() {  # name, word that the message must hold
  if sh "$firmware/gates/check_image.sh" "$work/$1.elf" 128 16 > "$work/out" 2>&1; then
    echo "closes: $1 was let pass"
    failed=1
  elif ! grep -q "$2" "$work/out"; then
    echo "closes: $1 was refused for another reason:"
    cat "$work/out"
    failed=1
  fi
}

build heap 'kept = static_cast<int*>(malloc(4));'
build operator_new 'kept = new int(3);'
build double_arithmetic 'real = real * 1.1 + sink;'
build exception 'if (sink) throw 1;'
build large 'static volatile char block[40000]; block[sink] = 1;'
refuses heap malloc
refuses operator_new _Zn
refuses double_arithmetic __aeabi_d
refuses exception __cxa
refuses large 'RAM over budget'
refuses absent 'missing'
: > "$work/empty.elf"
refuses empty 'missing or empty'

build fit 'sink = sink + 1;'
if ! sh "$firmware/gates/check_image.sh" "$work/fit.elf" 128 16 > "$work/out" 2>&1; then
  echo "closes: a fit image was refused:"
  cat "$work/out"
  failed=1
fi
exit $failed
