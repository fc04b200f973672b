#!/usr/bin/env bash
# What the device compiler gave each kernel of ours: registers, stack and spills a thread.
#
#   cmake/kernel_resources.sh <LOG
#
# LOG is what nvcc -Xptxas -v and clang++ -Rpass-analysis=kernel-resource-usage print; its lines
# `source: NAME` head the rows that follow. Fails where a kernel of the excitation step has a stack
# frame or spills: the step is bound by memory bandwidth, and both are traffic that the model does
# not ask for. Fails also where there is no such kernel, for then nothing was checked.
set -euo pipefail

c++filt | awk '
  # The functor or the launching function with the template arguments that tell variants apart.
  # Kernels of Kokkos itself (fills, copies) have none of ours.
  function kernel(line,   depth, end, character) {
    if (!match(line, /(Parallel|Combined)[A-Za-z]*<myowave::/)) return ""
    line = substr(line, RSTART + RLENGTH)
    for (end = 1; end <= length(line); ++end) {
      character = substr(line, end, 1)
      if (depth == 0 && character ~ /[>(,]/) break
      depth += (character == "<") - (character == ">")
    }
    line = substr(line, 1, end - 1)
    gsub(/Kokkos::|myowave::|Experimental::/, "", line)
    gsub(/(Cuda|HIP), |, (Cuda|HIP|Host)Space|<(Cuda|HIP)>/, "", line)
    gsub(/, tissue::MonodomainModel<cell::[A-Za-z]+<[a-z]+>, cell::[A-Za-z]+<[a-z]+> >/, "", line)
    gsub(/> >/, ">>", line)
    return line
  }
  function number(line, before) { sub(".*" before, "", line); return line + 0 }
  function row(registers) {
    if (name == "") return
    if (heading != "") print heading "\n  registers  stack B  " spill_unit "  kernel"
    heading = ""
    printf "  %9d  %7d  %7d  %s\n", registers, stack, spill, name
    if (name !~ /MonodomainStep|TiledStep/) return
    ++steps
    if (stack + spill > 0)
      failures = failures "FAILED: " name ": " stack " B stack, " spill " " spill_unit ": the step must live in registers\n"
  }
  /^source: / { heading = substr($0, 9); next }
  # ptxas -v
  /Compiling entry function/ { name = kernel($0); spill_unit = "spill B" }
  /bytes stack frame/ { stack = $1; spill = $5 + $9 }
  /Used [0-9]+ registers/ { row(number($0, "Used ")) }
  # clang -Rpass-analysis=kernel-resource-usage
  /Function Name: / { name = kernel($0); spill_unit = "spilled" }
  / VGPRs: / { registers = number($0, " VGPRs: ") }
  /ScratchSize / { stack = number($0, "]: ") }
  /VGPRs Spill: / { spill = number($0, "Spill: "); row(registers) }
  END {
    if (!steps) failures = "FAILED: no kernel of the excitation step (MonodomainStep, TiledStep) in the log\n"
    printf "%s", failures
    exit failures != ""
  }'
