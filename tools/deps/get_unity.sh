#!/bin/sh
# get_unity.sh [DEST]: puts unity.c, unity.h and unity_internals.h into DEST (build/unity), verified by SHA-256.
#
# Unity is in no package of its own. It is taken, without root and without touching the system's apt configuration, from
#   1. the package cmock (Debian 13 and later, Ubuntu), which carries Unity 2.5.4;
#   2. the source package ntpsec of the running release, which carries Unity 2.5.1 (Debian 12).
# Archive address and keyring are those that this machine's own apt uses.
set -eu

dest=${1:-build/unity}
files='unity.c unity.h unity_internals.h'
sums_2_5_4='653ab633ae34151407c0e17f364e72ba3f527fc28be0e642d35421ce209b5e63  unity.c
9df6d5e545d4e622a382bbc105671e60c87d152daa5fac9bc9cc6068416ec6c5  unity.h
0f319e9fe9e4090fd59c799135d97802ed0da1426d287388fa8dd6c18d510d49  unity_internals.h'
sums_2_5_1='2e3a0610268455520a5796345b503d00c34a47fe97ed3750349cbd4b2b1990f3  unity.c
681ac98a63ac11effb11e59d580f6ca82abca1bd34069465c38e3b15344256c0  unity.h
adfd612c217e59468c5ebe978640e77e5f539e820ffc0c195a98c5a36f0ac868  unity_internals.h'

fail() {
    echo "get_unity: cannot get Unity ($1): set UNITY_DIR to a folder with $files" >&2
    exit 1
}

# verified FOLDER: do the files there have the checksums of one of the two known versions?
verified() {
    [ -f "$1/unity.c" ] && [ -f "$1/unity.h" ] && [ -f "$1/unity_internals.h" ] || return 1
    for sums in "$sums_2_5_4" "$sums_2_5_1"; do
        if (cd "$1" && printf '%s\n' "$sums" | sha256sum -c --status 2>/dev/null); then
            return 0
        fi
    done
    return 1
}

# configured KEY SED: first value in the distribution's apt sources, deb822 format (KEY) or one-line format (SED)
configured() {
    {
        sed -n "s/^$1: *\([^ ]*\).*/\1/p" /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list.d/ubuntu.sources || true
        sed -n "$2" /etc/apt/sources.list || true
    } 2>/dev/null | head -n 1
}

prepare_private_apt() {
    mkdir -p "$tmp/lists/partial" "$tmp/cache/archives/partial" "$tmp/parts" "$tmp/work"
    cat > "$tmp/apt.conf" <<EOF
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$tmp/parts";
Dir::State::lists "$tmp/lists";
Dir::Cache "$tmp/cache";
APT::Sandbox::User "root";
APT::Update::Error-Mode "any";
Acquire::Languages "none";
Acquire::Retries "2";
Acquire::http::Timeout "20";
Acquire::https::Timeout "20";
EOF
    export APT_CONFIG="$tmp/apt.conf"
}

# use_source TYPE SUITE: the only line that the private apt sees
use_source() {
    rm -rf "$tmp/work"/* "$tmp/lists"/*
    mkdir -p "$tmp/lists/partial"
    echo "$1 ${keyring:+[signed-by=$keyring] }$archive $2 $components" > "$tmp/parts/unity.list"
    apt-get -qq update
}

take_from_cmock() {
    use_source deb "$1" && (cd "$tmp/work" && apt-get -qq download cmock) || return 1
    dpkg -x "$tmp"/work/cmock_*.deb "$tmp/work/root" || return 1
    cp "$tmp"/work/root/usr/share/cmock/vendor/unity/src/unity*.[ch] "$tmp/work/" || return 1
    verified "$tmp/work" || echo "Unity in cmock of $1 has unknown checksums"
}

take_from_ntpsec() {
    use_source deb-src "$1" && (cd "$tmp/work" && apt-get -qq source --download-only ntpsec) || return 1
    (cd "$tmp/work" && tar -xf ntpsec_*.orig.tar.* --strip-components=3 --wildcards '*/tests/unity/unity*.[ch]') ||
        return 1
    verified "$tmp/work" || echo "Unity in ntpsec of $1 has unknown checksums"
}

if verified "$dest"; then
    exit 0
fi
command -v sha256sum > /dev/null || fail "no sha256sum here"
command -v apt-get > /dev/null || fail "no apt-get here"

distribution=$(. /etc/os-release && echo "${ID:-}")
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
archive=$(configured URIs 's/^deb *\(\[[^]]*\] *\)\{0,1\}\([^ ]*\).*/\2/p')
keyring=$(configured Signed-By 's/^deb *\[.*signed-by=\([^] ]*\).*/\1/p')
[ -n "$archive" ] && [ -n "$release" ] || fail "no Debian or Ubuntu archive in this machine's apt sources"
components=main
suites="$release trixie"
if [ "$distribution" = ubuntu ]; then
    components='main universe'
    suites=$release
elif [ "$release" = bookworm ]; then
    suites=trixie
fi
if [ -z "$keyring" ] && [ -f "/usr/share/keyrings/$distribution-archive-keyring.gpg" ]; then
    keyring=/usr/share/keyrings/$distribution-archive-keyring.gpg
fi

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 130' INT TERM
chmod 755 "$tmp"
prepare_private_apt
for suite in $suites; do
    verified "$tmp/work" || take_from_cmock "$suite" >> "$tmp/log" 2>&1 || true
done
verified "$tmp/work" || take_from_ntpsec "$release" >> "$tmp/log" 2>&1 || true
verified "$tmp/work" || fail "$(grep -E '^(E:|Unity )' "$tmp/log" | head -n 1 | sed 's/^E: //')"

mkdir -p "$dest"
for file in $files; do
    cp "$tmp/work/$file" "$dest/"
done
echo "get_unity: Unity is in $dest, checksums verified"
