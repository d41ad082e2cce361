#!/usr/bin/env bash
# Runs static programs on an emulated processor with AVX-512 (Bochs's Skylake-X; qemu has none), below a Debian kernel.
#   run_in_bochs.sh WORK COMMAND [FILE...]
# COMMAND is a line of shell for the guest, which finds the FILEs at their own paths. Its output goes to stdout, its exit code is ours.
# Needs bochs bochs-term bochsbios vgabios isolinux syslinux-common genisoimage cpio; the kernel and busybox are unpacked, not installed.
set -euo pipefail

work=$1 command=$2
shift 2
files=("$@")
deadline_s=${HALFLIT_BOCHS_SECONDS:-3600}

mkdir -p "$work/packages"
cd "$work"

unpack() {
    [ -e "packages/$1.unpacked" ] && return
    (cd packages && apt-get download -qq "$1" 2>/dev/null && dpkg-deb -x "$1"_*.deb "$work/root" && rm "$1"_*.deb && touch "$1.unpacked")
}
kernel=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: //p' | head -1)
unpack "$kernel"
unpack busybox-static

# The memory disk: busybox, the files, and a first process that runs the command and switches the machine off.
rm -rf disk iso serial.txt
mkdir -p disk/bin disk/dev disk/proc disk/tmp iso
cp root/bin/busybox disk/bin/
for name in sh mount poweroff sleep echo tail; do ln -s busybox "disk/bin/$name"; done
for file in ${files[@]+"${files[@]}"}; do
    mkdir -p "disk$(dirname "$file")"
    cp "$file" "disk$file"
done
# Words reach the serial line through the kernel's log, which writes it byte by byte: Bochs loses the interrupts that a terminal waits for.
cat >disk/init <<TEXT
#!/bin/sh
mount -t proc proc /proc
mount -t devtmpfs dev /dev
say() { while read -r line; do echo "<3>halflit: \$line" >/dev/kmsg; done; }
echo "guest begins" | say
( $command ) >/tmp/log 2>&1
status=\$?
tail -n 200 /tmp/log | say
echo "guest ends with \$status" | say
sleep 2
poweroff -f
TEXT
chmod +x disk/init
(cd disk && find . | cpio -o -H newc --quiet | gzip -1) >iso/disk.gz
cp "root/boot/vmlinuz-${kernel#linux-image-}" iso/vmlinuz
cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 iso/
# Bochs 2.7 fails at two of the instructions that it announces: 321 is XSAVEC, 323 XSAVES.
cat >iso/isolinux.cfg <<'TEXT'
default linux
label linux
kernel vmlinuz
append initrd=disk.gz console=ttyS0,115200 quiet printk.devkmsg=on clearcpuid=321,323 panic=-1
TEXT
genisoimage -quiet -o boot.iso -b isolinux.bin -c boot.cat -no-emul-boot -boot-load-size 4 -boot-info-table iso

cat >bochsrc <<'TEXT'
display_library: term
config_interface: textconfig
megs: 512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/vgabios/vgabios.bin
cpu: model=corei7_skylake_x, ips=100000000, reset_on_triple_fault=0
ata0-master: type=cdrom, path=boot.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=serial.txt
sound: waveoutdrv=dummy
speaker: enabled=0
log: bochs.log
panic: action=fatal
TEXT
echo continue >debugger.rc # Debian's Bochs stops in its debugger first
TERM=xterm bochs -q -f bochsrc -rc debugger.rc </dev/null >screen.txt 2>&1 &
bochs=$!
trap 'kill "$bochs" 2>/dev/null || true' EXIT
while kill -0 "$bochs" 2>/dev/null && ! grep -qs "halflit: guest ends with [0-9]" serial.txt && [ "$SECONDS" -lt "$deadline_s" ]; do sleep 1; done

touch serial.txt
tr -d '\r' <serial.txt | sed -n 's/^.*halflit: //p'
status=$(sed -n 's/.*halflit: guest ends with \([0-9]*\).*/\1/p' serial.txt)
if [ -z "$status" ]; then
    tail -n 20 bochs.log >&2
    echo "run_in_bochs: the guest did not end within $deadline_s s" >&2
    exit 1
fi
exit "$status"
