#!/usr/bin/env bash
# Each header compiles alone; with MYOWAVE_WERROR=ON or -Werror among the flags, without a warning.
#
#   tests/build/headers.sh COMPILER [FLAG]... -- HEADER...
set -euo pipefail

compiler=()
while [ "$1" != -- ]; do
  compiler+=("$1")
  shift
done
shift
[ "${MYOWAVE_WERROR:-OFF}" != ON ] || compiler+=(-Werror)
[ $# -gt 0 ] || { echo "no headers"; exit 1; }

compile_alone() {
  local header=${!#}
  "${@:1:$#-1}" -fsyntax-only -Wall -Wextra -Wshadow -include "$header" -x c++ /dev/null ||
    { echo "does not compile alone: $header"; return 1; }
}
export -f compile_alone
# nproc respects OMP_NUM_THREADS, which ./dev test sets.
cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)
printf '%s\0' "$@" | xargs -0 -n 1 -P "$cores" bash -c 'compile_alone "$@"' headers "${compiler[@]}"
