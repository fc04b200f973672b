#!/usr/bin/env python3
"""Runs the suite with 1, 2, ... threads and prints how cost grows with threads and with size.

    bench/scaling.py EXECUTABLE [OPTION]...        the options are Google Benchmark's

For every row: time of an iteration with each number of threads, and the speed-up. For every family of rows
that differ only in size: the exponent of time against the number of nodes or elements, between neighbouring
sizes (1: time is proportional to size).
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile

# Rows whose time depends on size or threads; --benchmark_filter in the options replaces it.
DEFAULT_FILTER = "^(step|newton|elastic|factorize/[0-9]+|coupled)/"


def family(name):
    """A row's name with * for its size, and the size.

    >>> family("step/identity/float64/251/members:8")
    ('step/identity/float64/*/members:8', 251)
    >>> family("newton/solve/25")
    ('newton/solve/*', 25)
    >>> family("stream/triad/float64")
    ('stream/triad/float64', None)
    """
    found = re.search(r"/(\d+)(?=/|$)", name)
    if not found:
        return name, None
    return name[:found.start(1)] + "*" + name[found.end(1):], int(found.group(1))


def exponents(times):
    """Exponents of time against size squared, between neighbouring sizes; times: {size: seconds}.

    >>> exponents({10: 1.0, 20: 4.0, 40: 32.0})
    [(10, 20, 1.0), (20, 40, 1.5)]
    """
    sizes = sorted(times)
    return [(a, b, math.log(times[b] / times[a]) / math.log((b / a) ** 2)) for a, b in zip(sizes, sizes[1:])]


def times_with(executable, threads, options):
    """Seconds of an iteration, by row."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [executable, *options, f"--benchmark_out={file.name}", "--benchmark_out_format=json"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, OMP_NUM_THREADS=str(threads)))
        results = json.load(file)["benchmarks"]
    unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    # With repetitions: their median.
    return {result["run_name"].removesuffix("/real_time"): result["real_time"] * unit[result["time_unit"]]
            for result in results
            if not result.get("error_occurred") and result.get("aggregate_name", "median") == "median"}


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    executable, options = sys.argv[1], sys.argv[2:]
    if not any(option.startswith("--benchmark_filter") for option in options):
        options.append("--benchmark_filter=" + DEFAULT_FILTER)
    runs = {}
    for threads in range(1, len(os.sched_getaffinity(0)) + 1):
        print(f"{threads} thread{'s' if threads > 1 else ''} ...", file=sys.stderr)
        runs[threads] = times_with(executable, threads, options)

    print(f"{'row':52}" + "".join(f"{f'{n} thr., s':>14}" for n in runs) + f"{'speed-up':>10}")
    for name, serial in runs[1].items():
        times = [run.get(name, math.nan) for run in runs.values()]
        print(f"{name:52}" + "".join(f"{time:14.4g}" for time in times) + f"{serial / times[-1]:10.2f}")

    threads = max(runs)
    families = {}
    for name, time in runs[threads].items():
        group, size = family(name)
        if size:
            families.setdefault(group, {})[size] = time
    print(f"\nExponent of time against nodes or elements, {threads} threads")
    for group, times in families.items():
        if len(times) > 1:
            steps = "  ".join(f"{a}-{b}: {exponent:.2f}" for a, b, exponent in exponents(times))
            print(f"{group:52}{steps}")


if __name__ == "__main__":
    main()
