"""The files of the project, for the checks in this folder."""
import os
import subprocess
from pathlib import Path

LEFT_OUT = {"build", "out"}  # not sources, as are folders that start with a dot


def project_files(root):
    """Paths of all files relative to `root`: those that git tracks or would track; without git, all in the folders."""
    if (root / ".git").exists():
        listing = subprocess.run(["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-z", "--cached", "--others",
                                  "--exclude-standard"], capture_output=True, text=True)
        if listing.returncode == 0:
            return sorted({name for name in listing.stdout.split("\0") if name and (root / name).exists()})
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [one for one in folders if one not in LEFT_OUT and not one.startswith(".")]
        found += [(Path(folder) / name).relative_to(root).as_posix() for name in names]
    return sorted(found)
