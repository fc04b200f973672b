#!/usr/bin/env python3
"""Lists the rows of a benchmark run that became slower or faster than in another run.

    bench/compare.py OLD.json NEW.json [--least PERCENT]

Both files come from ./dev bench --repetitions 5 --json FILE. A row counts as changed if the times of its
repetitions do not overlap and their medians differ by more than 5 percent. Exits with 1 if a row became
slower. A row with fewer than three repetitions has no spread; it is listed and not counted.
"""

import argparse
import json
import statistics
import sys

LEAST_REPETITIONS = 3
MACHINE = ("cpu", "threads", "compiler", "compiler_flags", "backend")


def times_by_row(results):
    """Seconds an iteration of each repetition, by row.

    >>> times_by_row([{"run_name": "a", "run_type": "iteration", "real_time": 2, "time_unit": "us"},
    ...               {"run_name": "a", "run_type": "aggregate", "real_time": 9, "time_unit": "us"}])
    {'a': [2e-06]}
    """
    unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    rows = {}
    for result in results:
        if result["run_type"] == "iteration" and not result.get("error_occurred"):
            rows.setdefault(result["run_name"], []).append(result["real_time"] * unit[result["time_unit"]])
    return rows


def verdict(old, new, least):
    """'slower', 'faster', 'same', or 'unknown' if there are too few repetitions for a spread.

    >>> verdict([1.0, 1.1, 1.2], [1.3, 1.4, 1.5], 5)
    'slower'
    >>> verdict([1.0, 1.1, 1.2], [1.15, 1.4, 1.5], 5)
    'same'
    >>> verdict([1.0, 1.001, 1.002], [1.01, 1.011, 1.012], 5)
    'same'
    >>> verdict([1.0, 1.1, 1.2], [0.7, 0.8, 0.9], 5)
    'faster'
    >>> verdict([1.0], [2.0], 5)
    'unknown'
    """
    if min(len(old), len(new)) < LEAST_REPETITIONS:
        return "unknown"
    change = 100 * (statistics.median(new) / statistics.median(old) - 1)
    if min(new) > max(old) and change > least:
        return "slower"
    if max(new) < min(old) and -change > least:
        return "faster"
    return "same"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--least", type=float, default=5, help="change of the medians that counts, percent")
    arguments = parser.parse_args()
    with open(arguments.old) as file:
        old = json.load(file)
    with open(arguments.new) as file:
        new = json.load(file)
    for key in MACHINE:
        if old["context"].get(key) != new["context"].get(key):
            print(f"note: {key} differs: {old['context'].get(key)} / {new['context'].get(key)}")

    old_rows, new_rows = times_by_row(old["benchmarks"]), times_by_row(new["benchmarks"])
    count = {"slower": 0, "faster": 0, "same": 0, "unknown": 0}
    for name in sorted(old_rows.keys() & new_rows.keys()):
        before, after = old_rows[name], new_rows[name]
        result = verdict(before, after, arguments.least)
        count[result] += 1
        if result != "same":
            ratio = statistics.median(after) / statistics.median(before)
            print(f"{result:8} {name:52} {statistics.median(before):.4g} s -> {statistics.median(after):.4g} s "
                  f"({100 * (ratio - 1):+.1f} %)")
    for name in sorted(old_rows.keys() - new_rows.keys()):
        print(f"gone     {name}")
    for name in sorted(new_rows.keys() - old_rows.keys()):
        print(f"new      {name}")
    print(", ".join(f"{number} {kind}" for kind, number in count.items()))
    return 1 if count["slower"] else 0


if __name__ == "__main__":
    sys.exit(main())
