"""packaging.py SOURCE: libraries, versions, options and paths in cmake/packaging agree with the build."""
import ast
import re
import sys
from pathlib import Path

source = Path(sys.argv[1])
packaging = source / "cmake/packaging"
recipe = packaging / "spack/repo/spack_repo/myowave/packages/myowave/package.py"
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def text(path):
    return (source / path).read_text()


# Name in cmake/Dependencies.cmake: in the table of cmake/README.md, and in Spack.
libraries = {
    "Kokkos": ("Kokkos", "kokkos"),
    "CHOLMOD": ("CHOLMOD (SuiteSparse)", "suite-sparse"),
    "fmt": ("fmt", "fmt"),
    "PkgConfig": ("pkg-config", "pkgconfig"),
    "xxhash": ("xxHash", "xxhash"),
    "CLI11": ("CLI11", "cli11"),
    "tomlplusplus": ("toml++", "tomlplusplus"),
    "nlohmann_json": ("nlohmann-json", "nlohmann-json"),
    "HDF5": ("HDF5 (C)", "hdf5"),
    "PNG": ("libpng", "libpng"),
    "cairo": ("cairo, DejaVu Sans", "cairo"),
    "GTest": ("GoogleTest", "googletest"),
    "benchmark": ("Google Benchmark", "benchmark"),
    "Eigen3": ("Eigen", "eigen"),
}

# Package and lowest version of every depends_on.
calls = [node for node in ast.walk(ast.parse(recipe.read_text())) if isinstance(node, ast.Call)]
dependencies = {}
for call in calls:
    if getattr(call.func, "id", "") == "depends_on" and isinstance(call.args[0], ast.Constant):
        package, low = re.match(r"([a-z0-9-]+)(?:@([0-9.]+):)?", call.args[0].value).groups()
        dependencies[package] = low or dependencies.get(package)

found = re.findall(r"(?:find_package|pkg_check_modules)\((\w+)", text("cmake/Dependencies.cmake"))
for name in found + ["Kokkos"]:
    expect(name in libraries, f"{name} is new in Dependencies.cmake: cmake/packaging must bring it, too")
least = dict(re.findall(r"^\| ([^|]+?) \| ([0-9.]+|-) \|", text("cmake/README.md"), re.M))
for row, package in libraries.values():
    expect(package in dependencies, f"package.py does not depend on {package}")
    expect((dependencies.get(package) or "-") == least.get(row),
           f"{package}: package.py wants {dependencies.get(package)}, cmake/README.md {least.get(row)}")
# The versions that CMake requires.
asked = dict(re.findall(r"at_least\((\w+) ([0-9.]+) ", text("cmake/Dependencies.cmake")))
asked.update(re.findall(r"(cairo)>=([0-9.]+)", text("cmake/Dependencies.cmake")))
asked.update(re.findall(r"find_package\((Kokkos) ([0-9.]+)", text("cmake/Kokkos.cmake")))
for name, (row, _) in libraries.items():
    expect(asked.get(name, "-") == least.get(row),
           f"{name}: cmake/README.md says {least.get(row)}, CMake asks for {asked.get(name)}")
cmake = re.search(r"cmake_minimum_required\(VERSION ([0-9.]+)\)", text("CMakeLists.txt")).group(1)
expect(dependencies.get("cmake") == cmake, f"cmake: package.py wants {dependencies.get('cmake')}, CMakeLists.txt {cmake}")

# Options that the recipe and the container files set. The recipe has them all, but for these: its compiler flags are
# Spack's, and its Kokkos is built for the same GPU.
options = re.findall(r"^(?:option|set)\((MYOWAVE_[A-Z_]+)", text("CMakeLists.txt") + text("cmake/Kokkos.cmake"), re.M)
for option in set(options) - {"MYOWAVE_SANITIZE", "MYOWAVE_GPU"}:
    expect(f'"{option}"' in recipe.read_text(), f"package.py does not set {option}")
for path in [recipe, packaging / "Containerfile", packaging / "myowave.def", packaging / "README.md"]:
    for option in re.findall(r"MYOWAVE_\w+", path.read_text()):
        expect(option in options, f"{path.name}: no option {option}")

# Relative paths in the environments.
environments = sorted(packaging.glob("spack/*/spack.yaml"))
expect(len(environments) == 3, f"{len(environments)} environments")
for path in environments:
    yaml = path.read_text()
    sources = re.search(r"path: (\S+)", yaml).group(1)
    repository = re.search(r"repos:\n +myowave: (\S+)", yaml).group(1)
    expect((path.parent / sources).resolve() == source.resolve(), f"{path}: {sources} is not the project")
    expect((path.parent / repository / "repo.yaml").is_file(), f"{path}: no repository in {repository}")

# The container file copies exactly what .dockerignore lets through.
copied = re.findall(r"^COPY (?!--from)(.*) \S+$", text("cmake/packaging/Containerfile"), re.M)
copied = sorted(path for paths in copied for path in paths.split())
sent = sorted(line[1:] for line in text(".dockerignore").splitlines() if line.startswith("!"))
expect(copied and copied == sent, f"Containerfile copies {copied}, .dockerignore lets pass {sent}")

# Both images have the same libraries at run time.
images = [re.findall(r"install -y --no-install-recommends (fonts[^&]*?)(?:&&|rm )", (packaging / name).read_text())
          for name in ("Containerfile", "myowave.def")]
images = [[package for package in re.split(r"[\s\\]+", found[0]) if package] for found in images]
expect(images[0] == images[1] and images[0], f"Containerfile and myowave.def install other packages: {images}")

sys.exit("\n".join(failures) or 0)
