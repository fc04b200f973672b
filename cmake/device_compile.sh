#!/usr/bin/env bash
# Compiles translation units to a GPU's machine code on a machine without that GPU and without a
# Kokkos built for it, and prints and judges what each kernel needs (kernel_resources.sh). It is a
# compile check; it proves no run.
#
#   cmake/device_compile.sh cuda|hip KOKKOS_INCLUDE WORK SOURCE...
#
# Kokkos installs the headers of every backend. A few generated ones choose among them: copies of
# these, edited for the wanted backend, go into WORK and first on the include path. Objects and
# reports stay in WORK; a source none of whose files changed is not compiled again.
# Exits 77 where the compiler is missing.
set -euo pipefail

backend=$1 kokkos=$2 work=$3
shift 3
project=$(realpath "$(dirname "$0")/..")
overlay=$work/overlay

find_cuda() {
  compiler=$(PATH=$PATH:${CUDA_HOME:-/usr/local/cuda}/bin command -v nvcc) ||
    { echo "skipped: no nvcc on PATH or in /usr/local/cuda"; exit 77; }
  defines=(KOKKOS_ENABLE_CUDA KOKKOS_ENABLE_CUDA_LAMBDA KOKKOS_ARCH_HOPPER KOKKOS_ARCH_HOPPER90 'KOKKOS_ARCH_NVIDIA_GPU 90')
  # A host function called from a kernel may be a mere warning to nvcc. FMT: see Targets.cmake. -cubin: without the
  # host's half of the object, which the host's own compiler makes anyway: a third of the time.
  flags=(-x cu -cubin -arch=sm_90 --extended-lambda --expt-relaxed-constexpr -Xptxas -v -Werror cross-execution-space-call
    -DFMT_USE_CONSTEXPR=1)
}

find_hip() {
  local rocm=${ROCM_PATH:-/usr} bitcode
  compiler=$(command -v clang++-19 || command -v amdclang++) || { echo "skipped: no clang++-19 or amdclang++ on PATH"; exit 77; }
  bitcode=$(find "$rocm" -type d -name bitcode -path '*amdgcn*' -print -quit 2>/dev/null)
  [ -f "$rocm/include/hip/hip_runtime.h" ] && [ -n "$bitcode" ] ||
    { echo "skipped: no HIP headers and device libraries in $rocm (ROCM_PATH names another place)"; exit 77; }
  defines=(KOKKOS_ENABLE_HIP 'KOKKOS_ARCH_AMD_GPU "gfx90a"' KOKKOS_ARCH_AMD_GFX90A)
  flags=(-x hip -c --offload-arch=gfx90a --rocm-path="$rocm" --rocm-device-lib-path="$bitcode" --cuda-device-only
    --no-gpu-bundle-output -Rpass-analysis=kernel-resource-usage)
}

# The headers that choose the backends, as Kokkos' own CMake would write them.
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

# True if the object is newer than every file it was made from.
is_fresh() {
  local files
  [ -f "$1" ] && [ "$1" -nt "$overlay/KokkosCore_config.h" ] || return
  read -r -d '' -a files < <(sed -e 's/^[^:]*: //' -e 's/\\$//' "$1.d" && printf '\0')
  [ -z "$(find "${files[@]}" -newer "$1" 2>&1)" ]
}

compile() {
  local source=$1 object=$2
  "$compiler" "${flags[@]}" -std=c++20 -O3 -DNDEBUG -I"$project" -isystem "$overlay" -isystem "$kokkos" \
    -MD -MF "$object.d" "$source" -o "$object.new" >"$object.log" 2>&1 || return 1
  mv "$object.new" "$object"
}

"find_$backend"
write_overlay
object_of() { echo "$work/$(basename "${1%.cpp}").o"; }

# As many at once as there are cores: together they take longer than all other tests.
for source in "$@"; do
  object=$(object_of "$source")
  rm -f "$object.failed"
  while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
  { is_fresh "$object" || compile "$source" "$object" || touch "$object.failed"; } &
done
wait
failed=0 compiled=()
for source in "$@"; do
  object=$(object_of "$source")
  echo "$backend: ${source#"$project"/}"
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
