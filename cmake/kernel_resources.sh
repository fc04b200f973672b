#!/usr/bin/env bash
# Lists the registers, stack and spills a thread of each of myowave's kernels.
#
#   cmake/kernel_resources.sh <LOG
#
# LOG is the output of nvcc -Xptxas -v or clang++ -Rpass-analysis=kernel-resource-usage; a line `source: NAME` is the
# heading of the rows after it. Fails if a kernel of the excitation step has a stack frame (AMD: scratch) or spills:
# the step is bound by memory bandwidth, and both are extra traffic. Fails also if there is no such kernel, because
# then nothing was checked.
#
# AMD: registers are VGPRs, one value a thread; AGPRs are used beside them; SGPRs hold one value for a whole wave.
# Spilled SGPRs go to lanes of VGPRs, not to memory (that would be scratch), so they are listed and not judged. Waves:
# how many fit on a SIMD.
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
