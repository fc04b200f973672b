#!/bin/sh
# clang_instead.sh COMPILER CLANG COMMAND...: runs CMake's command line with Clang instead of the compiler.
compiler=$1 clang=$2
until [ "$3" = "$compiler" ]; do shift; done
shift 3
exec "$clang" "$@"
