#!/usr/bin/env bash
# What the guest is made of, below FOLDER: Debian's own kernel, its modules, its first programs, tools of which nothing
# is installed here.  prepare.sh FOLDER; does only what is missing; exit 1 with one line when it cannot.
#
#   FOLDER/kernel.elf, FOLDER/first.cpio    what QEMU starts
#   FOLDER/kernel/lib/modules, FOLDER/tools what the guest finds, as files of this machine
#   FOLDER/release                          the kernel's release, which is in no file of ours
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
give_up() { echo "guest: $*" >&2; exit 1; }

listed() { awk -v kind="$1" '$1 == kind { print $2 }' "$2"; }

# The package that a name without a number stands for today.
today() {
  if [[ $1 != linux-image-amd64 ]]; then echo "$1"; return; fi
  apt-cache depends linux-image-amd64 | awk '$1 == "Depends:" && $2 ~ /^linux-image-[0-9]/ { print $2; exit }'
}

# unpack PACKAGE TARGET: once for each version.
unpack() {
  local package=$1 target=$2 version
  version=$(awk -v package="$package" '$1 == "Package:" { of = $2 } $1 == "Version:" && of == package { print $2 }' \
    <<<"$index")
  [[ $version ]] || give_up "Debian's index has no package '$package' (apt-get update)"
  grep -qsxF "$version" "$folder/$package.unpacked" && return
  (cd "$folder" && apt-get -o APT::Sandbox::User=root download -q "$package=$version") >"$folder/download.log" 2>&1 ||
    { tail -n 3 "$folder/download.log" >&2; give_up "cannot fetch $package"; }
  dpkg-deb -x "$folder/$package"_*.deb "$target"
  rm "$folder/$package"_*.deb
  echo "$version" >"$folder/$package.unpacked"
  rm -f "$folder/first.cpio"
}

# QEMU enters an ELF at its PVH note: the guest need not decompress itself, which halves its start.
kernel_elf() {
  python3 - "$1" "$2" <<'PYTHON' || give_up "$1 holds no kernel that can be unpacked here"
import lzma, struct, sys
image = open(sys.argv[1], "rb").read()
# Documentation/x86/boot.rst: setup_sects at 0x1f1, payload_offset and payload_length at 0x248.
offset, length = struct.unpack_from("<II", image, 0x248)
begin = (image[0x1F1] + 1) * 512 + offset
elf = lzma.LZMADecompressor().decompress(image[begin:begin + length])
assert elf[:4] == b"\x7fELF"
open(sys.argv[2], "wb").write(elf)
PYTHON
}

# The files of the first modules and of what they need, each once, in the order of loading.
first_modules() {
  local module
  for module in $(listed first "$here/modules.txt"); do
    /sbin/modprobe -d "$folder/kernel" -S "$release" --show-depends "$module" ||
      give_up "the kernel $release has no module '$module'"
  done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }'
}

first_programs() {
  local tree file
  tree=$(mktemp -d)
  mkdir "$tree/modules"
  install -m 755 /bin/busybox "$tree/busybox"
  install -m 755 "$here/init.sh" "$tree/init"
  install -m 755 "$here/session.sh" "$tree/session.sh"
  first_modules >"$tree/files"
  while read -r file; do
    strip --strip-debug -o "$tree/modules/${file##*/}" "$file"
    echo "${file##*/}" >>"$tree/modules/list"
  done <"$tree/files"
  (cd "$tree" && find . -print0 | cpio -0 -o -H newc --quiet -R 0:0) >"$folder/first.cpio.new"
  rm -r "$tree"
  mv "$folder/first.cpio.new" "$folder/first.cpio"
}

names=()
for package in $(listed unpack "$here/packages.txt"); do
  names+=("$(today "$package")")
  [[ ${names[-1]} ]] || give_up "Debian's index has no $package (apt-get update)"
done
index=$(apt-cache show --no-all-versions "${names[@]}" 2>/dev/null || true)
for named in "${names[@]}"; do
  if [[ $named != linux-image-* ]]; then unpack "$named" "$folder/tools"; continue; fi
  release=${named#linux-image-}
  if [[ $(cat "$folder/release" 2>/dev/null) != "$release" ]]; then rm -rf "$folder/kernel" "$folder"/linux-image-*; fi
  unpack "$named" "$folder/kernel"
done
if [[ ! -e $folder/first.cpio || -n $(find "$here" -newer "$folder/first.cpio" -type f) ]]; then
  /sbin/depmod -b "$folder/kernel" "$release"
  kernel_elf "$folder/kernel/boot/vmlinuz-$release" "$folder/kernel.elf"
  first_programs
  echo "$release" >"$folder/release"
fi
