#!/usr/bin/env bash
# Compiles translation units to a GPU's machine code on a machine without that GPU and without a Kokkos built for
# it, and lists and checks the resources of each kernel (kernel_resources.sh). It is a compile check: it does not
# run the code.
#
#   cmake/device_compile.sh cuda|hip ARCHITECTURE KOKKOS_INCLUDE WORK [-FLAG]... SOURCE...
#
# ARCHITECTURE is sm_80 or sm_90 of CUDA, gfx90a or gfx942 of HIP. HIP's headers and device libraries are those of
# $ROCM_PATH if it is set, else of /opt/rocm, of fetch_hip.sh, or of the system.
#
# Kokkos installs the headers of every backend, and a few generated headers choose among them. Copies of these, edited
# for the backend, go to WORK, first on the include path. Objects and reports stay in WORK. A source is compiled again
# only if it or an included file changed. Reports of what compiled are also saved in
# ${XDG_CACHE_HOME:-~/.cache}/myowave/device, under a hash of the preprocessed source, the flags and the compiler's
# version: another build folder takes them from there. An empty list of sources is an error. Exits with 77 if the
# compiler or its libraries are missing.
set -euo pipefail

backend=$1 architecture=$2 kokkos=$3 work=$4
shift 4
own_flags=()
while [[ ${1-} == -* ]]; do
  own_flags+=("$1")
  shift
done
project=$(realpath "$(dirname "$0")/..")
overlay=$work/overlay
cache=${XDG_CACHE_HOME:-${HOME:-$work}/.cache}/myowave/device
[ $# -gt 0 ] || { echo "no sources to compile"; exit 1; }

skip() { echo "skipped: $*"; exit 77; }

case $backend/$architecture in
  cuda/sm_80) defines=(KOKKOS_ARCH_AMPERE KOKKOS_ARCH_AMPERE80) ;;
  cuda/sm_90) defines=(KOKKOS_ARCH_HOPPER KOKKOS_ARCH_HOPPER90) ;;
  hip/gfx90a | hip/gfx942) defines=("KOKKOS_ARCH_AMD_GPU \"$architecture\"" "KOKKOS_ARCH_AMD_${architecture^^}") ;;
  *) echo "no macros of Kokkos are known here for $backend $architecture"; exit 2 ;;
esac

find_cuda() {
  compiler=$(PATH=$PATH:${CUDA_HOME:-/usr/local/cuda}/bin command -v nvcc) || skip "no nvcc on PATH or in /usr/local/cuda"
  defines+=(KOKKOS_ENABLE_CUDA KOKKOS_ENABLE_CUDA_LAMBDA)
  # For nvcc a host function called from a kernel may be only a warning. FMT: see Targets.cmake. -cubin: leaves out the
  # host's half of the object, to save time; the host compiler compiles it anyway.
  flags=(-x cu -cubin -arch="$architecture" --extended-lambda --expt-relaxed-constexpr -Xptxas -v
    -Werror cross-execution-space-call -DFMT_USE_CONSTEXPR=1)
}

find_hip() {
  local rocm bitcode='' prefixes=(/opt/rocm "$project/.deps/hip/usr" /usr)
  [ -z "${ROCM_PATH:-}" ] || prefixes=("$ROCM_PATH")
  for rocm in "${prefixes[@]}"; do
    [ ! -f "$rocm/include/hip/hip_runtime.h" ] ||
      bitcode=$(find "$rocm/" -type d -name bitcode -path '*amdgcn*' -print -quit 2>/dev/null) || true
    [ -z "$bitcode" ] || break
  done
  [ -n "$bitcode" ] || skip "no HIP headers and device libraries in ${prefixes[*]} (ROCM_PATH names another place)"
  # The device libraries of a ROCm work with its own compiler.
  compiler=$(command -v "$rocm/bin/amdclang++" clang++-19 amdclang++ | head -n 1) ||
    skip "no clang++-19 or amdclang++ on PATH"
  defines+=(KOKKOS_ENABLE_HIP)
  flags=(-x hip -c --offload-arch="$architecture" --cuda-device-only --no-gpu-bundle-output)
  # The compiler also links the device code, which needs lld.
  "$compiler" "${flags[@]}" -nogpuinc -nogpulib /dev/null -o /dev/null 2>/dev/null ||
    skip "$compiler makes no $architecture code (Debian: lld-19 links it)"
  flags+=(--rocm-path="$rocm" --rocm-device-lib-path="$bitcode" -Rpass-analysis=kernel-resource-usage)
}

# Writes the headers that choose the backends, as Kokkos' own CMake does.
write_overlay() {
  local name=${backend^^} header
  [ "$overlay/KokkosCore_config.h" -nt "$0" ] && [ "$overlay/KokkosCore_config.h" -nt "$kokkos/KokkosCore_config.h" ] && return
  mkdir -p "$overlay/desul/atomics"
  for header in Setup Fwd Declare; do
    { case $header in
        Setup) echo "#include <setup/Kokkos_Setup_${name/CUDA/Cuda}.hpp>" ;;
        Fwd) printf '#include <fwd/Kokkos_Fwd_%s.hpp>\n' SERIAL "$name" ;;
        Declare) printf '#include <decl/Kokkos_Declare_%s.hpp>\n' SERIAL "$name" ;;
      esac; } | sed '1i #pragma once' >"$overlay/KokkosCore_Config_${header}Backend.hpp"
  done
  { sed '/DESUL_ATOMICS_ENABLE_/d' "$kokkos/desul/atomics/Config.hpp"
    echo "#define DESUL_ATOMICS_ENABLE_$name"; } >"$overlay/desul/atomics/Config.hpp"
  { sed -E '/KOKKOS_(ENABLE_(SERIAL|OPENMP|THREADS|HPX|CUDA|HIP|SYCL|OPENACC)|ARCH_)/d' "$kokkos/KokkosCore_config.h"
    printf '#define %s\n' KOKKOS_ENABLE_SERIAL "${defines[@]}"; } >"$overlay/KokkosCore_config.h"
}

# True if the object is newer than every file that it was compiled from.
is_fresh() {
  local files
  [ -f "$1" ] && [ "$1" -nt "$overlay/KokkosCore_config.h" ] || return
  mapfile -t files <"$1.files"
  [ -z "$(find "${files[@]}" -newer "$1" 2>&1)" ]
}

# What identifies a compilation: comments, line numbers and the place of the project do not matter.
# The files that the source includes are named by the lines that begin with #.
key_of() {
  local source=$1 object=$2
  "${command[@]}" -E "$source" >"$object.ii" 2>"$object.log" || return 1
  sed -n 's/^# [0-9]* "\([^"<]*[^"/<]\)".*/\1/p' "$object.ii" | sort -u >"$object.files"
  { printf '%s\n' "$compiler_version" "${command[@]:1}"; grep -v '^# [0-9]' "$object.ii" | tr -s '\n'; } |
    sed -e "s#$work/##g" -e "s#$project/##g" | sha256sum | cut -d ' ' -f 1 || return 1
  rm "$object.ii"
}

# Writes the time of the compilation to the object's .time.
compile() {
  local source=$1 object=$2 key TIMEFORMAT='%U s'
  key=$(key_of "$source" "$object") || return 1
  if cp "$cache/$key.log" "$object.log" 2>/dev/null; then
    touch "$cache/$key.log"
    : >"$object"
    echo "compiled before" >"$object.time"
    return
  fi
  { time "${command[@]}" "$source" -o "$object.new" >"$object.log" 2>&1; } 2>"$object.time" || return 1
  mv "$object.new" "$object"
  # A cache that cannot be written costs time only.
  { cp "$object.log" "$cache/$key.$$" && mv "$cache/$key.$$" "$cache/$key.log"; } 2>/dev/null || true
}

"find_$backend"
write_overlay
command=("$compiler" "${flags[@]}" -std=c++20 -O3 -DNDEBUG -I"$project" -isystem "$overlay" -isystem "$kokkos" "${own_flags[@]}")
# HIP's device libraries are linked and are no part of the preprocessed source.
compiler_version=$("$compiler" --version; cat "${rocm:-/nowhere}/../versions" 2>/dev/null || true)
mkdir -p "$cache" 2>/dev/null || true
find "$cache" -name '*.log' -mtime +60 -delete 2>/dev/null || true
# Folders may have files of the same name.
object_of() {
  local name=${1#"$project"/}
  name=${name%.cpp}
  echo "$work/${name//\//_}.o"
}

# One compilation a core, because these take longer than all other tests. nproc respects OMP_NUM_THREADS, which
# ./dev test sets.
cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)
for source in "$@"; do
  object=$(object_of "$source")
  rm -f "$object.failed"
  echo "unchanged" >"$object.time"
  while [ "$(jobs -rp | wc -l)" -ge "$cores" ]; do wait -n || true; done
  { is_fresh "$object" || compile "$source" "$object" || touch "$object.failed"; } &
done
wait
failed=0 compiled=()
for source in "$@"; do
  object=$(object_of "$source")
  echo "$architecture: ${source#"$project"/}  $(<"$object.time")"
  if [ -e "$object.failed" ]; then
    cat "$object.log"
    failed=1
  else
    compiled+=("$source")
  fi
done
for source in "${compiled[@]}"; do
  echo "source: ${source#"$project"/}"
  cat "$(object_of "$source").log"
done | "$project/cmake/kernel_resources.sh" || failed=1
exit $failed
