from spack_repo.builtin.build_systems.cmake import CMakePackage
from spack_repo.builtin.build_systems.cuda import CudaPackage
from spack_repo.builtin.build_systems.rocm import ROCmPackage

from spack.package import *


class Myowave(CMakePackage, CudaPackage, ROCmPackage):
    """Reaction-diffusion-mechanics of excitable tissue on Kokkos: electrical waves in a sheet of
    heart tissue, and the contraction that they cause and that acts back on them."""

    license("BSD-3-Clause")

    # The recipe has no URL of the sources: `develop` in the environments points to them.
    version("main")

    # The excitation runs on Kokkos' default backend, the first of these that it has.
    backends = {
        "cuda": "CUDA",
        "rocm": "HIP",
        "openmp": "OPENMP",
        "threads": "THREADS",
        "serial": "SERIAL",
    }

    variant("openmp", default=True, description="Run on all cores of a host by OpenMP")
    variant("threads", default=False, description="Run on all cores of a host by C++ threads")
    variant("serial", default=False, description="Run on one core of a host")
    variant("native", default=False, description="Add -march=native to Spack's target flags")
    variant("apps", default=True, description="Build the myowave command")
    variant("tests", default=False, description="Build the tests")
    variant("bench", default=False, description="Build the benchmarks")

    conflicts("+cuda", when="+rocm", msg="Kokkos has one device backend")
    conflicts("cuda_arch=none", when="+cuda", msg="name the GPU: cuda_arch=90")
    conflicts("+openmp", when="+threads", msg="Kokkos has one parallel host backend")
    conflicts("~apps", when="+tests", msg="many tests run the command")
    conflicts("%gcc@:11", msg="C++20 as g++ 12 has it")
    requires(
        "+openmp",
        "+threads",
        "+serial",
        policy="any_of",
        msg="Kokkos needs a host backend",
    )

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")

    depends_on("kokkos@4.6:")
    # A Kokkos with more backends than these would run on another one by default. Serial is the last.
    for backend in ("cuda", "rocm", "openmp", "threads"):
        depends_on(f"kokkos+{backend}", when=f"+{backend}")
        depends_on(f"kokkos~{backend}", when=f"~{backend}")
    depends_on("kokkos+serial", when="+serial")
    depends_on("kokkos~sycl~hpx")
    for arch in CudaPackage.cuda_arch_values:
        depends_on(f"kokkos+cuda cuda_arch={arch}", when=f"+cuda cuda_arch={arch}")
    for arch in ROCmPackage.amdgpu_targets:
        depends_on(f"kokkos+rocm amdgpu_target={arch}", when=f"+rocm amdgpu_target={arch}")
    with when("+cuda"):
        # C++20 in device code.
        depends_on("cuda@12:")
        # The sources are C++ to CMake, so their compiler is nvcc_wrapper.
        depends_on("kokkos+wrapper")
        requires("^kokkos+cuda_lambda", when="^kokkos@:4")
        conflicts("^cuda@13:", when="^kokkos@:4.6", msg="Kokkos 4.6 calls what CUDA 13 no longer has")
    depends_on("kokkos~cmake_lang", when="+rocm")

    depends_on("suite-sparse@5.12:~cuda~openmp")
    depends_on("fmt@9:")
    depends_on("xxhash@0.8:")
    with when("+apps"):
        depends_on("tomlplusplus@3.3:")
        depends_on("cli11@2.1:")
        depends_on("nlohmann-json@3.11:")
        depends_on("hdf5@1.10:1~mpi")
        depends_on("libpng@1.6:")
        depends_on("cairo@1.16:+svg+png+ft+fc")

    with when("+tests"):
        depends_on("googletest@1.12:+gmock", type="build")
        depends_on("python@3.11:", type="build")
        depends_on("py-numpy", type="build")
        depends_on("py-h5py~mpi", type="build")
    depends_on("benchmark@1.7:", type="build", when="+bench")
    for part in ("tests", "bench"):
        depends_on("eigen@3.4:", type="build", when=f"+{part}")

    def cmake_args(self):
        spec = self.spec
        backend = next(b for v, b in self.backends.items() if spec.satisfies(f"+{v}"))
        args = [
            self.define("Kokkos_ROOT", spec["kokkos"].prefix),
            self.define("MYOWAVE_BACKEND", backend),
            self.define_from_variant("MYOWAVE_NATIVE", "native"),
            self.define_from_variant("MYOWAVE_APPS", "apps"),
            self.define_from_variant("MYOWAVE_TESTS", "tests"),
            self.define_from_variant("MYOWAVE_BENCH", "bench"),
        ]
        if spec.satisfies("+cuda"):
            args.append(self.define("CMAKE_CXX_COMPILER", self["kokkos"].kokkos_cxx))
        if spec.satisfies("+rocm"):
            args.append(self.define("CMAKE_CXX_COMPILER", spec["hip"].hipcc))
        return args

    # Each test computes with one thread unless it asks for more, and ctest runs several at once.
    def setup_build_environment(self, env: EnvironmentModifications) -> None:
        if self.run_tests:
            env.set("OMP_NUM_THREADS", "1")
            env.set("OMP_PROC_BIND", "false")

    def check(self):
        if self.spec.satisfies("+tests"):
            with working_dir(self.build_directory):
                ctest("--output-on-failure", "--label-regex", "unit|faults|physics")
