#!/usr/bin/env bash
# What the device compiler gave each kernel of ours: registers, stack and spills a thread.
#
#   cmake/kernel_resources.sh <LOG
#
# LOG is what nvcc -Xptxas -v and clang++ -Rpass-analysis=kernel-resource-usage print; its lines
# `source: NAME` head the rows that follow. Fails where a kernel of the excitation step has a stack
# frame (AMD: scratch) or spills: the step is bound by memory bandwidth, and both are traffic that
# the model does not ask for. Fails also where there is no such kernel, for then nothing was checked.
#
# AMD: registers are VGPRs, a number a thread; AGPRs are those used beside them; SGPRs hold what is
# one value for a whole wave, and the spilled ones live in lanes of VGPRs, not in memory (where they
# did, there would be scratch), so they are told and not judged; waves are those that fit on a SIMD.
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
  function row(titles, cells) {
    if (name == "") return
    if (heading != "") print heading "\n  registers  stack B  " spill_unit "  " titles "kernel"
    heading = ""
    printf "  %9d  %7d  %7d  %s%s\n", registers, stack, spill, cells, name
    if (name !~ /MonodomainStep|TiledStep/) return
    ++steps
    if (stack + spill > 0 || dynamic)
      failures = failures "FAILED: " name ": " stack " B stack" (dynamic ? " and more at run time" : "") ", " spill " " \
                 spill_unit ": the step must live in registers\n"
  }
  /^source: / { heading = substr($0, 9); next }
  # ptxas -v
  /Compiling entry function/ { name = kernel($0); spill_unit = "spill B" }
  /bytes stack frame/ { stack = $1; spill = $5 + $9 }
  /Used [0-9]+ registers/ { registers = number($0, "Used "); row("", "") }
  # clang -Rpass-analysis=kernel-resource-usage
  /Function Name: / { name = kernel($0); spill_unit = "spilled" }
  / (Total)?SGPRs: / { scalars = number($0, "SGPRs: ") }
  / VGPRs: / { registers = number($0, " VGPRs: ") }
  / AGPRs: / { accumulators = number($0, " AGPRs: ") }
  /ScratchSize / { stack = number($0, "]: ") }
  /Dynamic Stack: / { dynamic = /: True/ }
  /Occupancy / { waves = number($0, "]: ") }
  /SGPRs Spill: / { scalar_spill = number($0, "Spill: ") }
  /VGPRs Spill: / {
    spill = number($0, "Spill: ")
    row("AGPRs  SGPRs  spilled  waves  ", sprintf("%5d  %5d  %7d  %5d  ", accumulators, scalars, scalar_spill, waves))
  }
  END {
    if (!steps) failures = "FAILED: no kernel of the excitation step (MonodomainStep, TiledStep) in the log\n"
    printf "%s", failures
    exit failures != ""
  }'
