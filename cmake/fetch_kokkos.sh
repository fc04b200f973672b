#!/usr/bin/env bash
# Unpacks Debian's Kokkos (OpenMP backend) into PREFIX without changing the system, for machines without a package
# of Kokkos >= 4.6. Needs no root: private_apt.sh.
#
#   cmake/fetch_kokkos.sh PREFIX      -> PREFIX/usr        headers, libraries, CMake package
#                                        PREFIX/runtime    the libc, libstdc++, libgomp they need
#                                        PREFIX/toolchain.cmake
set -euo pipefail

prefix=$(realpath -m "${1:?usage: fetch_kokkos.sh PREFIX}")
[ -f "$prefix/toolchain.cmake" ] && exit 0

say() { printf 'kokkos: %s\n' "$*"; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

source "$(dirname "$0")/private_apt.sh"
archive=$(private_apt_archive) ||
  { say "apt knows no Debian archive; run 'apt-get update', or give a Kokkos with -DKokkos_ROOT"; exit 1; }
say "reading the package index of Debian sid (kept apart from this system's)"
private_apt_open "$work/apt" "$archive" sid
runtime_library=$(private_apt_cache depends libkokkos-dev | awk '/Depends: libkokkos[0-9]/ { print $2; exit }')
say "unpacking libkokkos-dev and $runtime_library into $prefix"
mkdir "$work/debs"
private_apt_download "$work/debs" libkokkos-dev/sid "$runtime_library/sid" libc6/sid libstdc++6/sid libgomp1/sid libgcc-s1/sid

rm -rf "$prefix"
mkdir -p "$prefix/runtime"
for deb in "$work"/debs/*kokkos*.deb; do dpkg -x "$deb" "$prefix"; done
mkdir -p "$work/root"
for deb in "$work"/debs/*.deb; do
  case "$deb" in *kokkos*) ;; *) dpkg -x "$deb" "$work/root" ;; esac
done
find "$work/root" \( -path '*lib/*-linux-gnu/*.so*' -o -name 'ld-linux*.so*' \) \( -type f -o -type l \) \
  -not -path '*/gconv/*' -exec cp -Pn {} "$prefix/runtime/" \;

# The package's CMake files name two archives that it does not ship (both libraries are header-only), and the
# absolute path of the system's include folder.
targets=$(find "$prefix/usr" -name KokkosTargets.cmake)
libdir=$(dirname "$(find "$prefix/usr" -name 'libkokkoscore.so' | head -n 1)")
for missing in libkokkosalgorithms.a libkokkossimd.a; do
  [ -e "$libdir/$missing" ] || ar rc "$libdir/$missing"
done
sed -i 's#/usr/include/kokkos#${_IMPORT_PREFIX}/include/kokkos#g' "$targets"

loader=$(basename "$(find "$prefix/runtime" -name 'ld-linux*.so*' | head -n 1)")
cat >"$prefix/toolchain.cmake" <<TOOLCHAIN
# Written by fetch_kokkos.sh. The libraries need a newer libc than this system's, so executables load the libc in
# runtime/. RPATH instead of RUNPATH, so that libm and libstdc++ come from there too.
set(Kokkos_ROOT "$prefix/usr" CACHE PATH "Kokkos installation")
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-Wl,--allow-shlib-undefined,--disable-new-dtags,-rpath,$prefix/runtime,--dynamic-linker=$prefix/runtime/$loader")
TOOLCHAIN
say "done"
