# cmake -DCHECK=<kernel_resources.sh> -DWORK=<scratch folder> -P kernel_resources_cases.cmake: the check
# passes a step without stack and spills, and fails one with them, or a log without any step.
cmake_minimum_required(VERSION 3.25)

set(step_name "_ZN6Kokkos4Impl33cuda_parallel_launch_local_memoryINS0_11ParallelForIN7myowave6tissue14MonodomainStepINS_4CudaENS4_21ConservativeDiffusionIdNS_9CudaSpaceEEENS4_15MonodomainModelINS3_4cell13AlievPanfilovIdEENSB_13ActiveTensionIdEEEEEENS_10TeamPolicyIJS6_EEES6_EEEEvT_")
string(REPLACE "14MonodomainStep" "9TiledStep" tiled_name "${step_name}")
string(REPLACE "14MonodomainStep" "9OtherStep" other_name "${step_name}")
string(REPLACE "N7myowave6tissue14MonodomainStep" "N6Kokkos4Impl8ViewFill" kokkos_name "${step_name}")
string(REPLACE "33cuda_parallel_launch" "32hip_parallel_launch" hip_name "${step_name}")
string(REPLACE "4Cuda" "3HIP" hip_name "${hip_name}")
string(REPLACE "9CudaSpace" "8HIPSpace" hip_name "${hip_name}")

# A kernel in the output of ptxas -v, and in clang's remarks.
function(ptxas result name registers stack stores loads)
  set(${result} "ptxas info    : Compiling entry function '${name}' for 'sm_90'
ptxas info    : Function properties for ${name}
    ${stack} bytes stack frame, ${stores} bytes spill stores, ${loads} bytes spill loads
ptxas info    : Used ${registers} registers, used 1 barriers, 16 bytes smem
" PARENT_SCOPE)
endfunction()
function(remarks result name registers scratch dynamic scalar_spilled spilled)
  set(${result} "a.hpp:46:1: remark: Function Name: ${name} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     SGPRs: 30 [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     VGPRs: ${registers} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     AGPRs: 2 [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     ScratchSize [bytes/lane]: ${scratch} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     Dynamic Stack: ${dynamic} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     Occupancy [waves/SIMD]: 6 [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     SGPRs Spill: ${scalar_spilled} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     VGPRs Spill: ${spilled} [-Rpass-analysis=kernel-resource-usage]
a.hpp:46:1: remark:     LDS Size [bytes/block]: 8 [-Rpass-analysis=kernel-resource-usage]
" PARENT_SCOPE)
endfunction()

# Runs the check on a log: its status and one expected part of what it prints.
function(expect wanted_status wanted log)
  file(WRITE ${WORK}/log "source: a.cpp\n${log}")
  execute_process(COMMAND ${CHECK} INPUT_FILE ${WORK}/log RESULT_VARIABLE status
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(FIND "${output}" "${wanted}" position)
  if(NOT status EQUAL wanted_status OR position EQUAL -1)
    message(SEND_ERROR "expected ${wanted_status} and `${wanted}`, got ${status} and `${output}` from\n${log}")
  endif()
endfunction()

set(step "tissue::MonodomainStep<tissue::ConservativeDiffusion<double>>")
ptxas(good ${step_name} 74 0 0 0)
expect(0 "a.cpp\n  registers  stack B  spill B  kernel\n         74        0        0  ${step}\n" "${good}")
ptxas(spill ${step_name} 255 0 8 4)
expect(1 "FAILED: ${step}: 0 B stack, 12 spill B" "${spill}")
ptxas(stack ${step_name} 40 136 0 0)
expect(1 "FAILED: ${step}: 136 B stack, 0 spill B" "${good}${stack}")
ptxas(tiled ${tiled_name} 255 0 4 0)
expect(1 "FAILED: tissue::TiledStep<" "${good}${tiled}")

# Other kernels are listed and not judged; they do not count as the step.
ptxas(other ${other_name} 64 136 4 4)
expect(0 "64      136        8  tissue::OtherStep<" "${good}${other}")
expect(1 "FAILED: no kernel of the excitation step" "${other}")
ptxas(kokkos ${kokkos_name} 10 0 0 0)
expect(1 "FAILED: no kernel of the excitation step" "${kokkos}")
expect(1 "FAILED: no kernel of the excitation step" "")

# Scalar registers spill to lanes of vector registers, which is accepted.
remarks(good_hip ${hip_name} 74 0 False 19 0)
expect(0 "a.cpp
  registers  stack B  spilled  AGPRs  SGPRs  spilled  waves  kernel
         74        0        0      2     30       19      6  ${step}\n" "${good_hip}")
remarks(spill_hip ${hip_name} 256 0 False 0 3)
expect(1 "FAILED: ${step}: 0 B stack, 3 spilled" "${spill_hip}")
remarks(scratch_hip ${hip_name} 74 48 False 0 0)
expect(1 "FAILED: ${step}: 48 B stack, 0 spilled" "${scratch_hip}")
remarks(dynamic_hip ${hip_name} 74 0 True 0 0)
expect(1 "FAILED: ${step}: 0 B stack and more at run time, 0 spilled" "${dynamic_hip}")
