"""reached_sources.py ROOT COMMIT: prints the C++ sources that a change since COMMIT reaches, one a line.

These are the sources that changed and those that include, directly or through others, a header that did. All sources,
if a file changed that decides how they are compiled or linted.
"""
import re
import subprocess
import sys
from pathlib import Path

DECIDES_FOR_ALL = {".clang-tidy", "CMakePresets.json", "cmake/Targets.cmake", "cmake/Kokkos.cmake"}


def git(root, command, *arguments):
    """The names that a command of git prints."""
    output = subprocess.run(["git", "-C", root, command, "-z", *arguments], check=True, capture_output=True, text=True).stdout
    return set(filter(None, output.split("\0")))


def includers(root, files):
    """Maps each header to the files that include it. All are named by their path from the root."""
    result = {}
    for file in files:
        for name in re.findall(r'^\s*#\s*include\s+"([^"]+)"', (Path(root) / file).read_text(), re.M):
            result.setdefault(name, set()).add(file)
    return result


def reached(root, commit):
    changed = git(root, "diff", "--name-only", commit) | git(root, "ls-files", "--others", "--exclude-standard")
    files = git(root, "ls-files", "--cached", "--others", "--exclude-standard", "--", "*.cpp", "*.hpp")
    files = {file for file in files if (Path(root) / file).is_file()}
    if changed & DECIDES_FOR_ALL:
        changed = files
    included_by = includers(root, files)
    found, new = set(), changed
    while new:
        found |= new
        new = set().union(*(included_by.get(file, set()) for file in new)) - found
    return sorted(file for file in found & files if file.endswith(".cpp"))


if __name__ == "__main__":
    print(*reached(sys.argv[1], sys.argv[2]), sep="\n")
