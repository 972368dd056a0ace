# What the programs of tools/ share: messages, Debian packages, configure and build. Sourced, not run.
# shellcheck shell=bash

ETENDUE_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
ETENDUE_JOBS=${ETENDUE_JOBS:-$(nproc)}
ETENDUE_PACKAGES_FILE=$ETENDUE_ROOT/third_party_config/apt-packages.txt

say() { printf '==> %s\n' "$*"; }

# die MESSAGE...: one line per argument on stderr, then exit 1.
die() {
    printf '%s: %s\n' "${0##*/}" "$1" >&2
    shift
    [[ $# -eq 0 ]] || printf '    %s\n' "$@" >&2
    exit 1
}

# The names listed in the sections of apt-packages.txt that are given, one per line.
packages_of() {
    awk -v wanted=" $* " '
        /^[[:space:]]*(#|$)/ { next }
        /^\[.*\]/ { section = substr($1, 2, length($1) - 2); next }
        index(wanted, " " section " ") { print $1 }' "$ETENDUE_PACKAGES_FILE"
}

# Those of the packages on standard input that are not installed.
missing_packages() {
    local package
    while read -r package; do
        # dpkg-query fails for a package that it has never heard of, and prints another state for one that was removed.
        # The first letter is what is wanted: one that is held ('hi') is there, too.
        [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null) == ?i* ]] || printf '%s\n' "$package"
    done
}

# as_root COMMAND...: runs it as root, through sudo where needed.
as_root() {
    if [[ $EUID -eq 0 ]]; then
        "$@"
    else
        sudo "$@"
    fi
}

# install_packages SECTION...: installs what is missing of these sections of apt-packages.txt; silent if nothing is.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "this is no Debian system; the packages of apt-packages.txt have to be there already"
        return
    fi
    local missing
    mapfile -t missing < <(packages_of "$@" | missing_packages)
    [[ ${#missing[@]} -gt 0 ]] || return 0

    if [[ $EUID -ne 0 ]] && ! command -v sudo >/dev/null; then
        die "${#missing[@]} Debian packages are missing, and installing them needs root or sudo. Run as root:" \
            "apt-get install ${missing[*]}"
    fi
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    # A failing update is no reason to stop: the lists that are there may be good enough.
    as_root apt-get -qq -o DPkg::Lock::Timeout=300 update ||
        printf 'apt-get update failed; trying with the package lists that are there\n' >&2
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 \
        install --yes --no-install-recommends "${missing[@]}" >/dev/null ||
        die "apt-get could not install: ${missing[*]}" "Its messages are above. See that this works, then try again:" \
            "apt-get update && apt-get install ${missing[*]}"
}

# Checkouts in other folders share what they compile alike. The sloppiness is what ccache asks for where headers are
# compiled ahead.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$ETENDUE_ROOT} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}

# configure_preset PRESET: the build folder is build/PRESET. ccache is used where it is installed.
configure_preset() {
    local launcher=${CMAKE_CXX_COMPILER_LAUNCHER:-$(command -v ccache || true)}
    (cd "$ETENDUE_ROOT" && cmake --preset "$1" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher") ||
        die "configuring the preset '$1' failed; the reason is above"
}

# build_preset PRESET [TARGET...]: configures, then builds the targets, or everything; one at a time for each preset.
build_preset() {
    local preset=$1
    shift
    mkdir -p "$ETENDUE_ROOT/build"
    exec 9>"$ETENDUE_ROOT/build/.$preset.lock"
    flock 9
    configure_preset "$preset"
    local targets=()
    [[ $# -eq 0 ]] || targets=(--target "$@")
    (cd "$ETENDUE_ROOT" && cmake --build --preset "$preset" --parallel "$ETENDUE_JOBS" "${targets[@]}") ||
        die "building the preset '$preset' failed; the compiler's messages are above"
    exec 9>&-
}
