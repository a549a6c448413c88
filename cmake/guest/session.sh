#!/run/whirl_guest/busybox sh
# The guest once it sees files: loads modules, sets up virtual CAN, runs the job and leaves its exit code.
# /run/whirl_guest exists nowhere else: by it a guest test knows where it runs.
home=/run/whirl_guest
b=$home/busybox
report=$home/report
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb
give_up() {
  echo "guest: $*" >/dev/console
  $b reboot -f
}
$b mount -t 9p -o trans=virtio,version=9p2000.L,rw,cache=none,msize=524288 report $report ||
  give_up "no folder for the report"
. $report/settings  # folder: of prepare.sh; checkout; modules; own_clock
export WHIRL_OWN_CLOCK=$own_clock
$b mkdir -p /dev/pts /dev/shm
$b mount -t devpts -o gid=5,mode=620,ptmxmode=666 devpts /dev/pts
$b mount -t tmpfs shm /dev/shm
$b ln -sf /proc/self/fd /dev/fd
$b mount --bind "$home/machine$folder/kernel/lib/modules" /lib/modules || give_up "no modules in $folder"
for module in $modules; do
  modprobe $module || give_up "module $module is missing or cannot be loaded"
done
$b ip link set lo up
for bus in vcan0 vcan1; do
  $b ip link add dev $bus type vcan && $b ip link set $bus up || give_up "$bus cannot be made"
done
for port in /sys/class/virtio-ports/*; do
  [ "$(cat $port/name)" = whirl.output ] && output=/dev/${port##*/}
done
[ "$output" ] || give_up "no way out for what the tests say"
export PATH=$folder/tools/usr/sbin:$folder/tools/usr/bin:$PATH
export LD_LIBRARY_PATH=$folder/tools/usr/lib/x86_64-linux-gnu
echo started >$report/started
cd "$checkout" || give_up "no $checkout"
$b setsid /bin/bash $report/job </dev/null >$output 2>&1
echo $? >$report/exit_code
$b sync
$b reboot -f
