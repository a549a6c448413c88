#!/usr/bin/env bash
# Runs COMMAND as root in a guest of QEMU: Debian's own kernel over this machine's files, read-only, with CAN, uhid and
# I2C that the machine itself may lack.  run.sh [--own-clock] FOLDER SECONDS COMMAND...; FOLDER as prepare.sh left it
#
#   Exit code  COMMAND's, 0 to 123; 124: it did not end within SECONDS; 125: the guest did not get as far as COMMAND
#              (no boot, a module missing), and says why
#   No way in  no network device, no standard input; what COMMAND writes is thrown away, but for what it says
#   Speed      QEMU translates (no KVM: a host may offer it and still boot no stock kernel): 2 s to boot; whole
#              numbers at nearly the machine's speed, floats 26 to 50 times slower. One core: with two, one round
#              trip of a HID report takes 6.5 ms on a busy host in place of 0.1 ms
#   SECONDS    of this machine's time; with its own clock of QEMU's processor time, for on a busy machine it may get a tenth
#              of a processor, and then ten times as long is given up
#   Own clock  the guest's time is its instructions, 2 ns each, and leaps to the next timer when it has nothing to do:
#              a busy machine makes it slow and never late, and waiting costs nothing. It leaps also while it waits for
#              a file of this machine: who times something there keeps it busy meanwhile (standin_run.sh)
set -euo pipefail
clock=() of_processor=
if [[ $1 == --own-clock ]]; then
  clock=(-icount shift=1,sleep=off) of_processor=1
  shift
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(cd "$1" && pwd)
seconds=$2
shift 2
run=$(mktemp -d "$folder/run.XXXXXX")
trap 'rm -rf "$run"' EXIT
mkdir "$run/report"
mkfifo "$run/output"
printf '%q ' exec "$@" >"$run/report/job"
modules=$(awk '$1 == "then" { sub(/=/, " ", $2); printf "%s ", $2 }' "$here/modules.txt")
printf '%s=%q\n' folder "$folder" checkout "$PWD" modules "$modules" own_clock "${clock:+1}" >"$run/report/settings"

# Reads on when nobody listens any more, for QEMU would wait for ever.
tee --output-error=warn "$folder/output.txt" <"$run/output" &
listener=$!
status=0 most=$seconds
if [[ $of_processor ]]; then
  most=$((10 * seconds))
  ulimit -S -t "$seconds"
fi
timeout -k 5 "$most" qemu-system-x86_64 -accel tcg,tb-size=256 "${clock[@]}" -M q35 -cpu max -smp 1 -m 1024 \
  -nodefaults -no-user-config -display none -no-reboot \
  -kernel "$folder/kernel.elf" -initrd "$folder/first.cpio" \
  -append "console=ttyS0 quiet panic=-1 reboot=t mitigations=off random.trust_cpu=on cryptomgr.notests audit=0 apparmor=0" \
  -serial "file:$run/console" \
  -fsdev local,id=machine,path=/,security_model=none,readonly=on,multidevs=remap \
  -device virtio-9p-pci,fsdev=machine,mount_tag=machine \
  -fsdev local,id=report,path="$run/report",security_model=none \
  -device virtio-9p-pci,fsdev=report,mount_tag=report \
  -object can-bus,id=copper -device kvaser_pci,canbus=copper -device kvaser_pci,canbus=copper \
  -chardev file,id=output,path="$run/output",append=on \
  -device virtio-serial-pci -device virtserialport,chardev=output,name=whirl.output \
  </dev/null 2>"$run/qemu" 9>&- || status=$?
: <>"$run/output"  # ends the listener also where QEMU has never opened it
wait "$listener" || true

if [[ -s $run/report/exit_code ]]; then exit "$(cat "$run/report/exit_code")"; fi
if [[ $of_processor && $status == 152 ]]; then status=124; fi  # SIGXCPU
if [[ -e $run/report/started && $status == 124 ]]; then
  echo "guest: not ended within $seconds s${of_processor:+ of a processor, or ten times as long}" >&2
  exit 124
fi
if ((status == 124)); then reason="it did not come up within $seconds s"; else reason="QEMU ended with $status"; fi
echo "guest: nothing was run: $reason. Its console, and QEMU:" >&2
tail -qn 20 "$run/console" "$run/qemu" >&2 2>/dev/null || true
exit 125
