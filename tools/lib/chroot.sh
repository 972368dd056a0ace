# Bare Debian systems that debootstrap makes, for the programs that try Etendue in one. Sourced after setup.sh.
# shellcheck shell=bash

ETENDUE_CHROOTS=${ETENDUE_CHROOT_CACHE:-/var/cache/etendue}
ETENDUE_MIRROR=${ETENDUE_DEBIAN_MIRROR:-http://deb.debian.org/debian}

# What the machine's apt needs to reach a mirror (proxies, retries, clock checks) holds for the chroot too; its sources,
# which belong to a suite, do not.
host_apt_settings() {
    apt-config dump | grep -iE '^Acquire::((http|https)(::|[[:space:]])|Check-|Retries|ForceIPv)' |
        grep -v 'Proxy-Auto-Detect' || true
}

# require_chroot COMMAND: says what is missing to make one.
require_chroot() {
    [[ $EUID -eq 0 ]] || die "chroot and mount need root" "sudo $1"
    command -v debootstrap >/dev/null || die "debootstrap is not installed" "apt-get install debootstrap"
}

# open_root NAME SUITE REBUILD: a fresh copy of the bare system of SUITE in $root, made unless it is there or REBUILD is
# yes. Only one of this name at a time.
open_root() {
    local base=$ETENDUE_CHROOTS/base-$2
    root=$ETENDUE_CHROOTS/$1-$2 archives=$ETENDUE_CHROOTS/archives-$2
    mkdir -p "$archives"
    exec 9>"$ETENDUE_CHROOTS/lock-$1-$2"
    flock --nonblock 9 || die "another run for $2 is going on in $ETENDUE_CHROOTS"
    if [[ $3 == yes || ! -d $base ]]; then
        say "making a bare $2 in $base"
        rm -rf --one-file-system "$base" "$base.new"
        debootstrap --variant=minbase "$2" "$base.new" "$ETENDUE_MIRROR" >"$ETENDUE_CHROOTS/debootstrap-$2.log" 2>&1 ||
            die "debootstrap failed; its messages are in $ETENDUE_CHROOTS/debootstrap-$2.log"
        mv "$base.new" "$base"
    fi
    rm -rf --one-file-system "$root"
    cp -a --reflink=auto "$base" "$root"
    host_apt_settings >"$root/etc/apt/apt.conf.d/99host"
    cp -L /etc/resolv.conf "$root/etc/resolv.conf"
    # The system is thrown away, so it need not survive a power cut: installing is several times faster.
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
}

# in_root DIRECTORY COMMAND...: runs it there in $root with an environment as on a fresh machine. Mounts and processes
# live in namespaces of their own, so that they end with the command, however it ends. Each of $root_binds, FROM:TO, is
# a folder of this system that is there, too.
running='' root_binds=()
in_root() {
    local environment=(HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
    local name directory=$1
    shift
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY TERM CI ETENDUE_JOBS; do
        [[ -z ${!name:-} ]] || environment+=("$name=${!name}")
    done
    # In the background, because bash runs its traps at once in `wait`, but not while it runs a command in the foreground.
    # shellcheck disable=SC2016  # expanded by the inner shell
    unshare --mount --pid --fork --kill-child --propagation private bash -euc '
        root=$1 archives=$2 binds=$3
        shift 3
        mount -t proc proc "$root/proc"
        mount -t sysfs -o ro sysfs "$root/sys"
        mkdir -p "$root/dev/shm"
        mount -t tmpfs tmpfs "$root/dev/shm"
        mount --bind "$archives" "$root/var/cache/apt/archives"
        while IFS=: read -r from to; do
            [[ -n $from ]] || continue
            mkdir -p "$root$to"
            mount --bind "$from" "$root$to"
        done <<<"$binds"
        exec chroot "$root" env -i "$@"' \
        in_root "$root" "$archives" "$(printf '%s\n' "${root_binds[@]}")" \
        "${environment[@]}" bash -c "cd $directory && exec \"\$@\"" in_directory "$@" &
    running=$!
    local outcome=0
    wait "$running" || outcome=$?
    running=''
    return "$outcome"
}

# close_root KEEP: removes $root unless KEEP is yes.
close_root() {
    # All that runs in the chroot ends with the process that made its namespaces.
    if [[ -n $running ]]; then
        kill -KILL "$running" || true
        wait "$running" || true
    fi 2>/dev/null
    if [[ $1 == yes && -d $root ]]; then
        say "kept; look around with: chroot $root"
    else
        rm -rf --one-file-system "$root"
    fi
}
