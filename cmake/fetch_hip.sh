#!/usr/bin/env bash
# Unpacks what is needed to compile HIP code for an AMD GPU, besides clang++-19 and lld-19, into PREFIX, without changing
# the system: HIP's headers of Debian sid, because those of Debian 12 are too old for Kokkos, and the device libraries
# for this clang. Needs no root: private_apt.sh. Only the tests device_hip_* use it, to compile.
#
#   cmake/fetch_hip.sh PREFIX      -> PREFIX/usr         headers and device libraries
#                                     PREFIX/versions    the packages they are from
set -euo pipefail

prefix=$(realpath -m "${1:?usage: fetch_hip.sh PREFIX}")
[ -f "$prefix/versions" ] && exit 0

say() { printf 'hip: %s\n' "$*"; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

source "$(dirname "$0")/private_apt.sh"
# Short time-outs, because only a test needs it.
private_apt_options+=(-o Acquire::Retries=0 -o Acquire::http::Timeout=15 -o APT::Update::Error-Mode=any)
archive=$(private_apt_archive) || { say "apt knows no Debian archive: ROCM_PATH may name a ROCm"; exit 1; }
say "unpacking the headers of Debian sid and the device libraries of trixie into $prefix"
mkdir "$work/debs"
{ private_apt_open "$work/apt" "$archive" sid trixie &&
  private_apt_download "$work/debs" libamdhip64-dev/sid libhsa-runtime-dev/sid rocm-device-libs-17/trixie; } ||
  { say "the archive gave no packages"; exit 1; }

rm -rf "$prefix"
mkdir -p "$prefix"
for deb in "$work"/debs/*.deb; do dpkg -x "$deb" "$prefix"; done
# Written last: it marks a complete folder.
for deb in "$work"/debs/*.deb; do dpkg-deb --show "$deb"; done >"$prefix/versions"
say "done"
