#!/usr/bin/env python3
"""Compares the time of a sweep with that of the same runs, sequentially.

    bench/sweeps.py EXECUTABLE [--runs 64] [--duration 100] [--repetitions 3]

EXECUTABLE is the `myowave` command. For rigid and for contracting sheets of 121 x 121 nodes: `myowave sweep` of
--runs values of mu1, and `myowave run` of each with all threads, as a loop in a shell would do it. The two are
interleaved. Prints medians, their ratio and the cell-steps a second of the sweep. The runs share no initial state.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

SCENE = """\
[grid]
n = 121
[time]
t_end = {duration}
[excitation]
mu1 = {mu1}
[mechanics]
on = {contracts}
[initial]
type = "broken_front"
offset = [-5, 40]
[output]
every = 20.0
"""
AXIS = """\
[[axis]]
key = "excitation.mu1"
min = 0.0975
max = 0.1175
num = {runs}
"""


def sections(text, parent):
    """The text of a scene as tables below `parent` of another file.

    >>> sections("[grid]\\nn = 5\\n", "scene")
    '[scene.grid]\\nn = 5\\n'
    """
    return re.sub(r"^\[", f"[{parent}.", text, flags=re.MULTILINE)


def seconds(command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def time_sweep(executable, folder, name):
    return seconds([executable, "sweep", "sweep.toml", "--out", name], folder)


def time_runs(executable, folder, runs, name):
    total = 0
    for n in range(runs):
        scene = str(folder / f"scene_{n}.toml")
        total += seconds([executable, "run", scene, "--quiet", "--out", f"{name}/{n}"], folder)
    return total


def compare(executable, contracts, options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        values = {"duration": float(options.duration), "contracts": str(contracts).lower()}
        (folder / "sweep.toml").write_text(
            sections(SCENE.format(mu1=0.1, **values), "scene") + AXIS.format(runs=options.runs))
        for n in range(options.runs):
            mu1 = 0.0975 + 0.02 * n / (options.runs - 1)
            (folder / f"scene_{n}.toml").write_text(SCENE.format(mu1=mu1, **values))
        sweep, runs = [], []
        for repetition in range(options.repetitions):
            sweep.append(time_sweep(executable, folder, f"sweep_{repetition}"))
            runs.append(time_runs(executable, folder, options.runs, f"runs_{repetition}"))
    return sweep, runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("executable", type=lambda text: str(pathlib.Path(text).resolve()))
    parser.add_argument("--runs", type=int, default=64)
    parser.add_argument("--duration", type=float, default=100, help="t.u.")
    parser.add_argument("--repetitions", type=int, default=3)
    options = parser.parse_args()
    dt = 0.02  # t.u., the default of a scene
    print("| sheets | sweep, s | sequential runs, s | ratio | sweep, Mcell-steps/s |\n|---|---|---|---|---|")
    for contracts in (False, True):
        sweep, runs = compare(options.executable, contracts, options)
        a, b = statistics.median(sweep), statistics.median(runs)
        ratios = [y / x for x, y in zip(sweep, runs)]
        rate = 121 * 121 * options.duration / dt * options.runs / a / 1e6
        print(f"| {'contracting' if contracts else 'rigid'} | {a:.2f} | {b:.2f} | {b / a:.2f} "
              f"({min(ratios):.2f} to {max(ratios):.2f}) | {rate:.0f} |")


if __name__ == "__main__":
    main()
