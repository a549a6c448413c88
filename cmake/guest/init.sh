#!/busybox sh
# The guest's first process: from memory to the file system of the machine that runs it, read-only below a layer that is
# thrown away. What it says goes to the console.
b=/busybox
$b mkdir -p /proc /sys /dev /below /layer /root
$b mount -t proc proc /proc
$b mount -t sysfs sys /sys
$b mount -t devtmpfs dev /dev
give_up() {
  echo "guest: $*" >/dev/console
  $b reboot -f
}
while read -r module; do
  $b insmod /modules/$module || give_up "module $module cannot be loaded"
done </modules/list
# The machine's files do not change while the guest runs, so it may keep what it has read.
$b mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=524288 machine /below ||
  give_up "the machine's files cannot be mounted"
$b mount -t tmpfs -o size=75% layer /layer
$b mkdir /layer/upper /layer/work
# Files over 9p have no lasting handles, which an index would need.
$b mount -t overlay -o lowerdir=/below,upperdir=/layer/upper,workdir=/layer/work,index=off,xino=off over /root ||
  give_up "the layer over them cannot be mounted"
$b mkdir -p /root/run /root/lib/modules
$b mount -t tmpfs -o mode=755 run /root/run
$b mkdir -p /root/run/whirl_guest/machine /root/run/whirl_guest/report
$b cp /busybox /session.sh /root/run/whirl_guest
$b mount --bind /below /root/run/whirl_guest/machine
for folder in proc sys dev; do $b mount --move /$folder /root/$folder; done
exec $b switch_root /root /run/whirl_guest/busybox sh /run/whirl_guest/session.sh
