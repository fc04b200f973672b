#!/usr/bin/env python3
"""How far a run is off by the metric that holds between two solves of the mechanics, and what it costs.

    bench/feedback_time.py EXECUTABLE [--repetitions 5]

EXECUTABLE is the `myowave` command. The contracting sheet of 251 x 251 nodes from a broken front, b = 0.11, for
100 t.u.: the relative L2 difference of V at t = 20, 50 and 100 from interval 5 quadratic, for each interval and
feedback.time. Then the wall times of runs that write no fields, held and
quadratic in turns: medians. Needs h5py.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

import h5py
import numpy

TIMES = ("held", "linear", "quadratic")
INTERVALS = (10, 20, 40, 80, 160)  # steps
LOOKS = (20, 50, 100)  # t.u.
EVERY = 10  # t.u.
SCENE = f"""\
[grid]
n = 251
[time]
t_end = 100.0
[excitation]
b = 0.11
[mechanics]
[initial]
type = "broken_front"
[output]
every = {EVERY}.0
"""


class Runs:
    def __init__(self, executable, folder):
        self.executable, self.folder = executable, folder
        (folder / "scene.toml").write_text(SCENE)

    def summary(self, **values):
        """Of a run with these values, keys as section_key."""
        sets = [f"--set={key.replace('_', '.', 1)}={str(value).lower()}" for key, value in values.items()]
        subprocess.run([self.executable, "run", "scene.toml", "--quiet", "--force", "--out", "out", *sets],
                       cwd=self.folder, check=True)
        return json.loads((self.folder / "out" / "summary.json").read_text())

    def V(self, **values):
        self.summary(output_fields=True, **values)
        with h5py.File(self.folder / "out" / "fields.h5") as file:
            return [file["V"][t // EVERY].astype(float) for t in LOOKS]


def shown_errors(V, exact):
    return " / ".join(f"{numpy.linalg.norm(a - b) / numpy.linalg.norm(b):.2g}" for a, b in zip(V, exact))


def show_errors(runs, exact):
    print(f"| interval | {' | '.join(TIMES)} |\n|---|---|---|---|")
    for interval in INTERVALS:
        cells = []
        for time in TIMES:
            V = runs.V(mechanics_interval=interval, feedback_time=time)
            cells.append(shown_errors(V, exact))
        print(f"| {interval} | {' | '.join(cells)} |", flush=True)
    print()


def show_costs(runs, repetitions):
    print("| interval | held, s | quadratic, s | ratio |\n|---|---|---|---|")
    for interval in (10, 40):
        walls = {"held": [], "quadratic": []}
        for _ in range(repetitions):
            for time, seconds in walls.items():
                seconds.append(runs.summary(mechanics_interval=interval, feedback_time=time)["wall_s"])
        held, quadratic = walls.values()
        ratios = [b / a for a, b in zip(held, quadratic)]
        print(f"| {interval} | {statistics.median(held):.2f} | {statistics.median(quadratic):.2f} | "
              f"{statistics.median(ratios):.3f} ({min(ratios):.3f} to {max(ratios):.3f}) |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=lambda text: str(pathlib.Path(text).resolve()))
    parser.add_argument("--repetitions", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        runs = Runs(options.executable, pathlib.Path(name))
        exact = runs.V(mechanics_interval=5, feedback_time="quadratic")
        show_errors(runs, exact)
        show_costs(runs, options.repetitions)


if __name__ == "__main__":
    main()
