#!/bin/sh
# clang_instead.sh COMPILER CLANG... -- COMMAND...: runs CMake's command line with Clang, and ccache before it where
# CLANG names that, in the compiler's place.
compiler=$1
shift
clang=
while [ "$1" != -- ]; do
  clang="$clang $1"
  shift
done
until [ "$1" = "$compiler" ]; do shift; done
shift
# shellcheck disable=SC2086  # words of a command
exec $clang "$@"
