#!/bin/sh
# deps.sh GROUP...: installs what a group of make targets needs and this machine lacks; prints nothing if nothing is missing.
# Groups: firmware sim test check flash flashtest arduino bench piocheck papers design tilt live fuzz coverage proof second demo. Packages come by
# apt-get, numpy and matplotlib (check: lizard, design: scipy, flash: pyserial, tilt: tools/pyproject.toml) by pip into build/venv, Unity by tools/deps/get_unity.sh into build/unity
# (UNITY_DIR=folder: use that one), avr8js by npm into build/second and esbuild into build/web. Uses sudo only when not root.
# Ends with 1 on failure; with 3 if only the group second or demo is requested and Node, avr8js or esbuild is absent, too old, or npm has no network.
set -eu

cd "$(dirname "$0")/.."
venv=build/venv
log=build/deps.log
missing=''
want_venv=no
want_lizard=no
want_scipy=no
want_tilt=no
want_serial=no
want_unity=no
want_pio=no
want_avr8js=no
want_esbuild=no
node_for='' # the folder whose package.json states the oldest sufficient Node
pio_requirements='platformio==6.2.0 scons==4.11.1' # the versions that mk/scripts/pio_standins.py stands in for
pio_venv=build/venv-pio
fail_status=1 # 3 if what is missing is a reason to skip, not a failure

fail() {
    echo "deps: $1" >&2
    exit $fail_status
}

has() {
    command -v "$1" > /dev/null 2>&1
}

# has_header FILE PKG_CONFIG_NAME
has_header() {
    [ -f "/usr/include/$1" ] || pkg-config --exists "$2" 2> /dev/null
}

has_avr_libc() {
    [ -f /usr/lib/avr/include/avr/io.h ] ||
        echo '#include <avr/io.h>' | avr-gcc -mmcu=atmega328p -E -x c - > /dev/null 2>&1
}

has_venv_module() {
    python3 -c 'import ensurepip, venv' > /dev/null 2>&1
}

has_certificates() {
    [ -e /etc/ssl/certs/ca-certificates.crt ] || [ -e /etc/pki/tls/certs/ca-bundle.crt ] || [ -e /etc/ssl/cert.pem ]
}

# Packages are complete if the stamp written after pip equals the requirements.
has_plot_packages() {
    [ -x "$venv/bin/python" ] && cmp -s tools/deps/requirements.txt "$venv/requirements.installed"
}

# the command tilt runs from tools/; what it imports is installed
has_tilt() {
    [ -x "$venv/bin/tilt" ] && cmp -s tools/pyproject.toml "$venv/pyproject.installed" && "$venv/bin/tilt" --help > /dev/null 2>&1
}

has_serial() {
    [ -x "$venv/bin/python" ] && "$venv/bin/python" -c 'import serial' > /dev/null 2>&1
}

has_lizard() {
    [ -x "$venv/bin/python" ] && "$venv/bin/python" -c 'import lizard' > /dev/null 2>&1
}

has_scipy() {
    [ -x "$venv/bin/python" ] && "$venv/bin/python" -c 'import scipy' > /dev/null 2>&1
}

# clang-query of the same version as the installed clang-tidy
has_clang_query() {
    has clang-tidy && { [ -x "$(dirname "$(readlink -f "$(command -v clang-tidy)")")/clang-query" ] || has clang-query; }
}

# the browser in which the tests of `tilt live` run
has_chromium() {
    has chromium || has chromium-browser || has google-chrome || has chrome
}

# need PACKAGE TEST...: note the package as missing unless the test holds
need() {
    package=$1
    shift
    case " $missing " in
        *" $package "*) return ;;
    esac
    "$@" || missing="$missing $package"
}

need_avr() {
    need gcc-avr has avr-gcc
    need binutils-avr has avr-objcopy
    need avr-libc has_avr_libc
}

has_optiboot() {
    [ -f "${OPTIBOOT_DIR:-/usr/share/arduino/hardware/arduino/avr/bootloaders/optiboot}/optiboot.c" ]
}

has_arduino_core() {
    [ -f "${ARDUINO_DIR:-/usr/share/arduino/hardware/arduino/avr}/cores/arduino/Arduino.h" ]
}

need_host_compiler() {
    need gcc has gcc
    need libc6-dev test -f /usr/include/stdio.h
}

need_simulator() {
    need_avr
    need_host_compiler
    need pkg-config has pkg-config
    need simavr has simavr
    need libsimavr-dev has_header simavr/sim_avr.h simavr
    need libelf-dev has_header libelf.h libelf
}

need_plots() {
    want_venv=yes
    has_plot_packages && return
    need python3-venv has_venv_module
    need ca-certificates has_certificates
}

need_serial() {
    want_serial=yes
    need python3 has python3
    has_serial && return
    need python3-venv has_venv_module
    need ca-certificates has_certificates
}

need_lizard() {
    want_lizard=yes
    has_lizard && return
    need python3-venv has_venv_module
    need ca-certificates has_certificates
}

need_scipy() {
    need_plots
    want_scipy=yes
}

need_tilt() {
    want_tilt=yes
    has_tilt && return
    need python3-venv has_venv_module
    need ca-certificates has_certificates
}

need_unity() {
    want_unity=yes
    need g++ has g++
    need libeigen3-dev has_header eigen3/Eigen/Core eigen3
}

collect() {
    missing=''
    for group in "$@"; do
        case $group in
            firmware) need_avr; need python3 has python3 ;;
            sim) need_simulator; need_plots ;;
            bench) need_simulator; need python3 has python3 ;;
            test) need_simulator; need_plots; need_unity ;;
            papers) need_host_compiler; need_plots; need g++ has g++; need python3 has python3; need libeigen3-dev has_header eigen3/Eigen/Core eigen3 ;;
            check) need_simulator; need_unity; need_lizard; need python3 has python3
                need g++ has g++; need libeigen3-dev has_header eigen3/Eigen/Core eigen3
                need clang-tidy has clang-tidy
                need clang-tools has_clang_query
                need clang-format has clang-format
                need cppcheck has cppcheck ;;
            design) need_scipy ;;
            tilt) need_tilt ;;
            live) need_tilt; need chromium has_chromium ;;
            flash) need_avr; need avrdude has avrdude; need_serial ;;
            piocheck) need_avr; need_host_compiler; want_pio=yes; need python3-venv has_venv_module; need ca-certificates has_certificates ;;
            flashtest) need_simulator; need avrdude has avrdude; need arduino-core-avr has_optiboot; need_serial ;;
            arduino) need_simulator; need g++ has g++; need python3 has python3; need arduino-core-avr has_arduino_core ;;
            fuzz) need_host_compiler; need python3 has python3; need binutils has objcopy ;;
            coverage) need_simulator; need_plots; need_unity; need gcovr has gcovr ;;
            second) want_avr8js=yes; node_for=second; need nodejs has node; need npm has npm ;;
            demo) want_avr8js=yes; want_esbuild=yes; node_for=${node_for:-web}; need nodejs has node; need npm has npm; need python3 has python3 ;;
            proof) need python3 has python3; need frama-c-base has frama-c ;;
            *) fail "unknown group '$group': use firmware, sim, test, check, flash, flashtest, arduino, bench, piocheck, papers, design, tilt, live, fuzz, coverage, proof, second or demo" ;;
        esac
    done
    missing=${missing# }
}

# how_to_supply PACKAGE...: what to install by hand
how_to_supply() {
    hints=''
    for package in "$@"; do
        case $package in
            gcc-avr | binutils-avr | avr-libc) hint='an AVR GCC toolchain with avr-libc and put avr-gcc on PATH' ;;
            simavr | libsimavr-dev) hint='simavr 1.6 or later with headers and pkg-config file' ;;
            gcc | g++ | libc6-dev) hint='GCC for C and C++ with the C library headers' ;;
            libelf-dev) hint='the libelf headers' ;;
            libeigen3-dev) hint='Eigen 3 in /usr/include/eigen3' ;;
            python3-venv) hint='Python 3 with its venv module' ;;
            *) hint=$package ;;
        esac
        case $hints in
            *"$hint"*) ;;
            *) hints="$hints${hints:+; }$hint" ;;
        esac
    done
    echo "install $hints"
}

# first_error: why the last command failed, in one line
first_error() {
    grep -E '^(E:|ERROR:|sudo:)' "$log" | head -n 1 | sed 's/^E: //; s/^ERROR: //'
}

install_packages() {
    has apt-get || fail "cannot install $missing (no apt-get here): $(how_to_supply $missing)"
    as_root=''
    if [ "$(id -u)" != 0 ]; then
        has sudo || fail "cannot install $missing (not root and no sudo): run as root: apt-get install $missing"
        as_root=sudo
    fi
    echo "deps: installing with ${as_root:+sudo }apt-get: $missing"
    # continue if the index cannot be refreshed: the present one may do, and the installation reports what is missing
    $as_root apt-get -qq update > "$log" 2>&1 || true
    set -- -qq -y --no-install-recommends install $missing
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get "$@" >> "$log" 2>&1 ||
        fail "cannot install $missing ($(first_error)): check the network and apt's sources, or\
 $(how_to_supply $missing); log in $log"
}

# install_one PACKAGE PIP_WORD...
install_one() {
    package=$1
    shift
    echo "deps: installing with pip into $venv: $package"
    if [ ! -x "$venv/bin/python" ]; then
        python3 -m venv "$venv" > "$log" 2>&1 ||
            fail "cannot make $venv ($(tail -n 1 "$log")): $(how_to_supply python3-venv)"
    fi
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-input --retries 2 --timeout 20 "$@" > "$log" 2>&1 ||
        fail "cannot install $package ($(first_error)): check the network and pip's index, or install it into $venv; log in $log"
}

install_tilt() {
    echo "deps: installing with pip into $venv: the command tilt and its packages"
    if [ ! -x "$venv/bin/python" ]; then
        python3 -m venv "$venv" > "$log" 2>&1 ||
            fail "cannot make $venv ($(tail -n 1 "$log")): $(how_to_supply python3-venv)"
    fi
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-input --retries 2 --timeout 20 -e tools > "$log" 2>&1 ||
        fail "cannot install the command tilt ($(first_error)): check the network and pip's index; log in $log"
    cp tools/pyproject.toml "$venv/pyproject.installed"
}

install_plot_packages() {
    if [ -x "$venv/bin/python" ] && "$venv/bin/python" -c 'import numpy, matplotlib' > /dev/null 2>&1; then
        cp tools/deps/requirements.txt "$venv/requirements.installed"
        return
    fi
    echo "deps: installing with pip into $venv: numpy matplotlib"
    python3 -m venv "$venv" > "$log" 2>&1 ||
        fail "cannot make $venv ($(tail -n 1 "$log")): $(how_to_supply python3-venv)"
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-input --retries 2 --timeout 20 \
        -r tools/deps/requirements.txt > "$log" 2>&1 ||
        fail "cannot install numpy matplotlib ($(first_error)): check the network and pip's index, or install both\
 for the system's Python and run python3 -m venv --system-site-packages $venv; log in $log"
    cp tools/deps/requirements.txt "$venv/requirements.installed"
}

has_pio() {
    [ -x "$pio_venv/bin/pio" ] && [ "$(cat "$pio_venv/requirements.installed" 2> /dev/null)" = "$pio_requirements" ]
}

install_pio() {
    echo "deps: installing with pip into $pio_venv: $pio_requirements"
    python3 -m venv "$pio_venv" > "$log" 2>&1 ||
        fail "cannot make $pio_venv ($(tail -n 1 "$log")): $(how_to_supply python3-venv)"
    # shellcheck disable=SC2086
    "$pio_venv/bin/python" -m pip install --disable-pip-version-check --no-input --retries 2 --timeout 20 $pio_requirements > "$log" 2>&1 ||
        fail "cannot install $pio_requirements ($(first_error)): check the network and pip's index; log in $log"
    echo "$pio_requirements" > "$pio_venv/requirements.installed"
}

# the oldest sufficient Node: second runs avr8js and its own modules in it, web only esbuild
node_needed() {
    sed -n 's/.*"node": ">= *\([0-9.]*\)".*/\1/p' "$node_for/package.json"
}

has_node_of_age() {
    printf '%s\n' "$(node_needed)" "$(node --version | sed 's/^v//')" | sort -C -V
}

# has_npm FOLDER PACKAGE: exactly what the lock file names
has_npm() {
    [ -d "build/$1/node_modules/$2" ] && cmp -s "$1/package-lock.json" "build/$1/package-lock.installed"
}

# esbuild's program is an optional package: npm succeeds where it cannot fetch it
has_esbuild() {
    has_npm web esbuild && build/web/node_modules/.bin/esbuild --version > /dev/null 2>&1
}

npm_out_of_reach='ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|ERR_SOCKET_TIMEOUT|E403|E407|E50[0-9]'

# install_npm FOLDER PACKAGE
install_npm() {
    echo "deps: installing with npm into build/$1: $2"
    mkdir -p "build/$1"
    cp "$1/package.json" "$1/package-lock.json" "build/$1/"
    if ! (cd "build/$1" && npm ci --ignore-scripts --no-audit --no-fund) > "$log" 2>&1; then
        # only an unreachable registry is a reason to skip: what npm rejects (EINTEGRITY: not what the lock file names) is a failure
        grep -Eq 'EINTEGRITY|EUSAGE' "$log" || ! grep -Eq "$npm_out_of_reach" "$log" && fail_status=1
        fail "cannot install $2 ($(grep -i 'npm err' "$log" | head -n 1)): check the network and npm's registry, and\
 $1/package-lock.json; log in $log"
    fi
    cp "$1/package-lock.json" "build/$1/package-lock.installed"
}

install_unity() {
    if [ -n "${UNITY_DIR:-}" ]; then
        [ -f "$UNITY_DIR/unity.c" ] && [ -f "$UNITY_DIR/unity.h" ] && [ -f "$UNITY_DIR/unity_internals.h" ] ||
            fail "UNITY_DIR=$UNITY_DIR lacks unity.c, unity.h or unity_internals.h"
        return
    fi
    [ -f build/unity/unity.c ] || echo "deps: fetching Unity from the distribution's archive into build/unity"
    tools/deps/get_unity.sh build/unity
}

[ $# -gt 0 ] || fail "usage: tools/deps.sh GROUP... (firmware, sim, test, check, flash, flashtest, arduino, bench, piocheck, papers, design, tilt, live, fuzz, coverage, proof, second, demo)"
collect "$@"
mkdir -p build
if [ "$*" = second ] || [ "$*" = demo ]; then
    fail_status=3
fi
if [ -n "$missing" ]; then
    install_packages
    collect "$@"
    [ -z "$missing" ] || fail "installed, but still not found: $missing; $(how_to_supply $missing)"
fi
if [ $want_venv = yes ] && ! has_plot_packages; then
    install_plot_packages
fi
if [ $want_scipy = yes ] && ! has_scipy; then
    install_one scipy -r tools/deps/requirements-design.txt
fi
if [ $want_tilt = yes ] && ! has_tilt; then
    install_tilt
fi
if [ $want_serial = yes ] && ! has_serial; then
    install_one pyserial 'pyserial>=3.5'
fi
if [ $want_pio = yes ] && ! has_pio; then
    install_pio
fi
if [ $want_lizard = yes ] && ! has_lizard; then
    install_one lizard -r tools/deps/requirements-check.txt
fi
if [ $want_unity = yes ]; then
    install_unity
fi
if [ -n "$node_for" ] && ! has_node_of_age; then
    fail "Node $(node --version) is too old, $(node_needed) or later is needed ($node_for/package.json): install a newer nodejs"
fi
if [ $want_avr8js = yes ] && ! has_npm second avr8js; then
    install_npm second avr8js
fi
if [ $want_esbuild = yes ] && ! has_esbuild; then
    install_npm web esbuild
    if ! has_esbuild; then
        rm -rf build/web/node_modules
        fail "npm left out esbuild's program, an optional package: check the network and npm's registry; log in $log"
    fi
fi
