#!/usr/bin/env python3
"""Prints a benchmark run as Markdown tables: the yardstick, the product, their ratio.

    bench/table.py FILE.json

FILE comes from ./dev bench --repetitions 5 --json FILE. Medians over the repetitions.
"""

import json
import statistics
import sys


def medians(results, counter):
    """Median of a counter over the repetitions, by row.

    >>> row = {"run_name": "plain/identity/float64/121", "run_type": "iteration"}
    >>> medians([dict(row, rate=1.0), dict(row, rate=4.0), dict(row, rate=2.0)], "rate")
    {'plain/identity/float64/121': 2.0}
    """
    values = {}
    for result in results:
        if result["run_type"] == "iteration" and counter in result and not result.get("error_occurred"):
            values.setdefault(result["run_name"], []).append(result[counter])
    return {name: statistics.median(all_) for name, all_ in values.items()}


def row_name(name):
    """Without what Google Benchmark adds.

    >>> row_name("step/identity/float64/121/members:8/real_time")
    'step/identity/float64/121/members:8'
    """
    return name.removesuffix("/real_time")


def split(name):
    """Kind and the rest of a step's row; None for another row.

    >>> split("step/identity/float64/121")
    ('step', 'identity/float64/121')
    >>> split("newton/plain/25") is None
    True
    """
    kind, _, rest = name.partition("/")
    return (kind, rest) if kind in ("step", "tiled", "plain", "plain_serial") else None


def yardstick(rest):
    """Row of the yardstick for a product's row: every metric form is held against the loaded one.

    >>> yardstick("expanded/float64/251")
    'conservative_loaded/float64/251'
    >>> yardstick("identity/float64/121/members:8")
    'identity/float64/121'
    """
    form, precision, n = rest.split("/")[:3]
    return "/".join(["identity" if form == "identity" else "conservative_loaded", precision, n])


def step_table(rates, triad):
    lines = ["| row | plain_serial | plain | step | step / plain | tiled | tiled / plain | step, % of triad |",
             "|---|---|---|---|---|---|---|---|"]
    kinds = {}
    for name, rate in rates.items():
        if split(name):
            kind, rest = split(name)
            kinds.setdefault(kind, {})[rest] = rate
    plain = kinds.get("plain", {})
    rests = dict.fromkeys(rest for name in rates if split(name) for rest in [split(name)[1]])
    mega = lambda rate: f"{rate / 1e6:.0f}" if rate else ""
    for rest in rests:
        base = plain.get(yardstick(rest))
        cells = [rest, mega(kinds.get("plain_serial", {}).get(rest)), mega(plain.get(rest))]
        for kind in ("step", "tiled"):
            rate = kinds.get(kind, {}).get(rest)
            cells += [mega(rate), f"{rate / base:.2f}" if rate and base else ""]
        percent = triad.get("step/" + rest)
        cells.append(f"{percent:.0f}" if percent else "")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def newton_table(times):
    lines = ["| elements a side | plain, ms | solve, ms | solve / plain |", "|---|---|---|---|"]
    for name, plain in times.items():
        if not name.startswith("newton/plain/"):
            continue
        size = name.rsplit("/", 1)[1]
        ours = times.get("newton/solve/" + size)
        cells = [size, f"{plain:.3g}", f"{ours:.3g}" if ours else "", f"{ours / plain:.2f}" if ours else ""]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def coupled_table(rates, mechanics):
    lines = ["| row | Mcell-steps/s | mechanics, % of the time |", "|---|---|---|"]
    for name, rate in rates.items():
        if name.startswith("coupled/"):
            lines.append(f"| {name} | {rate / 1e6:.0f} | {mechanics[name]:.0f} |")
    return lines


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        run = json.load(file)
    context, results = run["context"], run["benchmarks"]
    scale = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}
    for result in results:
        result["run_name"] = row_name(result["run_name"])
        if result["run_type"] == "iteration" and "real_time" in result:
            result["ms"] = result["real_time"] * scale[result["time_unit"]]
    rates = medians(results, "cell_steps_per_s")
    print(f"{context['cpu']}, {context['threads']} threads, {context['compiler']}, Kokkos {context['kokkos']}, "
          f"revision {context['git_hash']}{' with changes' if context['git_dirty'] == 'true' else ''}; "
          f"triad {float(context['triad_bytes_per_s']) / 1e9:.1f} GB/s. Mcell-steps/s, medians.\n")
    print("\n".join(step_table(rates, medians(results, "percent_of_triad"))), "\n")
    print("\n".join(newton_table(medians(results, "ms"))), "\n")
    print("\n".join(coupled_table(rates, medians(results, "percent_mechanics"))))


if __name__ == "__main__":
    main()
