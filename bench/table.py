#!/usr/bin/env python3
"""Prints a benchmark run as one Markdown table, each row beside its yardstick.

    bench/table.py RUN.json                       print the table
    bench/table.py RUN.json --reduce SMALL.json   keep only what the table needs (SMALL may be RUN itself)
    bench/table.py RUN.json --write README.md     put the table between the markers of README.md
    bench/table.py RUN.json --check README.md     exit with 1 if the table there is another one

RUN.json comes from ./dev bench --repetitions 5 --json RUN.json. Numbers are medians over the repetitions; the
spread is the largest less the smallest value, in percent of the median. "Times as fast" compares with the row's
yardstick: the hand-written loop, Newton with a new factor in every iteration, or the same run with nothing left out.
"""

import argparse
import json
import pathlib
import re
import statistics
import sys

BEGIN, END = "<!-- table: begin -->", "<!-- table: end -->"

# Of the context and of each repetition, what the table shows and compare.py compares.
CONTEXT = ("date", "myowave", "git_hash", "git_dirty", "compiler", "compiler_flags", "kokkos", "backend", "threads",
           "cpu", "triad_bytes_per_s", "float64_flops_per_s", "float32_flops_per_s")
RESULT = ("run_name", "run_type", "repetitions", "repetition_index", "iterations", "real_time", "time_unit",
          "cell_steps_per_s", "bytes_per_s", "percent_of_triad", "error_occurred", "error_message")

# Rows of the table in their order, by the first word of their names; a yardstick has no row of its own.
KINDS = ("stream", "step", "tiled", "newton", "coupled", "ensemble", "pruning", "startup", "checkpoint")


def row_name(name):
    """The name without what Google Benchmark adds.

    >>> row_name("step/identity/float64/121/members:8/real_time")
    'step/identity/float64/121/members:8'
    """
    return name.removesuffix("/real_time")


def yardstick(name):
    """The row that a row is compared with, or None.

    Every metric is compared with the hand-written loop that loads its weights.

    >>> yardstick("tiled/identity_split/float32/251")
    'plain/identity/float32/251'
    >>> yardstick("step/expanded/float64/121/members:8")
    'plain/conservative_loaded/float64/121'
    >>> yardstick("newton/solve/25"), yardstick("pruning/feedback/251/pruned")
    ('newton/plain/25', 'pruning/feedback/251/full')
    >>> yardstick("coupled/float64/251/interval:80") is None
    True
    """
    parts = name.split("/")
    if parts[0] in ("step", "tiled"):
        form = "identity" if parts[1].startswith("identity") else "conservative_loaded"
        return "/".join(["plain", form, *parts[2:4]])
    if parts[:2] == ["newton", "solve"]:
        return "/".join(["newton", "plain", *parts[2:]])
    if parts[0] == "pruning" and parts[-1] == "pruned":
        return "/".join([*parts[:-1], "full"])
    return None


def repetitions(results):
    """Results of each row's repetitions without error, by row, with the time of an iteration in ms.

    >>> repetitions([{"run_name": "a/real_time", "run_type": "iteration", "real_time": 2, "time_unit": "us"},
    ...              {"run_name": "a/real_time", "run_type": "aggregate", "real_time": 9, "time_unit": "us"},
    ...              {"run_name": "b", "run_type": "iteration", "error_occurred": True}])["a"][0]["ms"]
    0.002
    """
    ms = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    rows = {}
    for result in results:
        if result["run_type"] == "iteration" and not result.get("error_occurred"):
            row = rows.setdefault(row_name(result["run_name"]), [])
            row.append(dict(result, ms=result["real_time"] * ms[result["time_unit"]]))
    return rows


def measured(row):
    """Counter that a row is judged by, the factor to the unit shown, and that unit.

    >>> measured([{"ms": 1.0, "cell_steps_per_s": 2e6, "bytes_per_s": 5.0}])
    ('cell_steps_per_s', 1e-06, 'Mcell-steps/s')
    >>> measured([{"ms": 1.0}])
    ('ms', 1.0, 'ms')
    """
    if "cell_steps_per_s" in row[0]:
        return "cell_steps_per_s", 1e-6, "Mcell-steps/s"
    return "ms", 1.0, "ms"


def median(row, counter):
    return statistics.median(result[counter] for result in row)


def digits(value):
    """Three digits, or all before the point.

    >>> digits(2168.4), digits(11.04), digits(0.13)
    ('2168', '11.0', '0.130')
    """
    return f"{value:.0f}" if value >= 100 else f"{value:#.3g}"


def line(name, row, base):
    """A row of the table; base: the repetitions of its yardstick, or None.

    >>> fast = [{"ms": 1.0, "cell_steps_per_s": rate, "percent_of_triad": 50} for rate in (3e8, 2e8, 4e8)]
    >>> line("step/identity/float64/121", fast, [{"ms": 1.0, "cell_steps_per_s": 2e8}])
    '| `step/identity/float64/121` | 300 Mcell-steps/s | 67 | 200 | 1.50 | 50 |'
    >>> line("newton/solve/25", [{"ms": 1.0}], [{"ms": 11.0}])
    '| `newton/solve/25` | 1.00 ms |  | 11.0 | 11.0 |  |'
    """
    counter, factor, unit = measured(row)
    value = median(row, counter)
    values = [result[counter] for result in row]
    spread = f"{100 * (max(values) - min(values)) / value:.0f}" if len(values) > 1 else ""
    cells = [f"`{name}`", f"{digits(factor * value)} {unit}", spread]
    if base:
        other = median(base, counter)
        gain = other / value if counter == "ms" else value / other
        cells += [digits(factor * other), digits(gain)]
    else:
        cells += ["", ""]
    cells.append(f"{median(row, 'percent_of_triad'):.0f}" if "percent_of_triad" in row[0] else "")
    return "| " + " | ".join(cells) + " |"


def wanted(name, rows):
    """Whether a row stands in the table: of a known kind, and no other row's yardstick."""
    return name.partition("/")[0] in KINDS and name not in {yardstick(other) for other in rows}


def table(run):
    """The lines of the table and the one above it that says where it was made."""
    context, rows = run["context"], repetitions(run["benchmarks"])
    counts = " or ".join(map(str, sorted({len(row) for row in rows.values()})))
    changed = " with changes" if context["git_dirty"] == "true" else ""
    yield (f"Processor: {context['cpu']}; threads: {context['threads']}; compiler: {context['compiler']}; Kokkos "
           f"{context['kokkos']}, {context['backend']}; revision {context['git_hash']}{changed}; date: "
           f"{context['date'][:10]}; triad at the start: {float(context['triad_bytes_per_s']) / 1e9:.1f} GB/s; "
           f"repetitions: {counts}.")
    yield ""
    yield "| row | median | spread, % | yardstick | times as fast | % of triad |"
    yield "|---|---|---|---|---|---|"
    for name in sorted((name for name in rows if wanted(name, rows)), key=order):
        yield line(name, rows[name], rows.get(yardstick(name)))


def order(name):
    """Sorts by kind, then by name with numbers as numbers.

    >>> sorted(["tiled/a/121", "step/a/4096", "step/a/251"], key=order)
    ['step/a/251', 'step/a/4096', 'tiled/a/121']
    """
    parts = re.split(r"(\d+)", name)
    return KINDS.index(name.partition("/")[0]), [int(part) if part.isdigit() else part for part in parts]


def reduced(run):
    """The run without the context and counters that neither the table nor compare.py reads.

    >>> small = reduced({"context": {"cpu": "x", "load_avg": [1]},
    ...                  "benchmarks": [{"run_name": "a", "run_type": "iteration", "cpu_time": 1},
    ...                                 {"run_name": "a", "run_type": "aggregate"}]})
    >>> small["context"], small["benchmarks"]
    ({'cpu': 'x'}, [{'run_name': 'a', 'run_type': 'iteration'}])
    """
    return {"context": {key: run["context"][key] for key in CONTEXT if key in run["context"]},
            "benchmarks": [{key: result[key] for key in RESULT if key in result}
                           for result in run["benchmarks"] if result["run_type"] == "iteration"]}


def as_text(run):
    """JSON with one line a repetition, so that a new run is a readable change."""
    context = json.dumps(run["context"], indent=2)
    lines = ",\n".join(json.dumps(result) for result in run["benchmarks"])
    return f'{{"context": {context},\n"benchmarks": [\n{lines}\n]}}\n'


def replaced(text, lines):
    """A text with these lines between its markers.

    >>> print(replaced("a\\n<!-- table: begin -->\\nold\\n<!-- table: end -->\\nb", ["new"]))
    a
    <!-- table: begin -->
    new
    <!-- table: end -->
    b
    """
    head, found, rest = text.partition(BEGIN + "\n")
    _, ended, tail = rest.partition(END)
    if not found or not ended:
        sys.exit(f"no lines {BEGIN} and {END}")
    return head + found + "\n".join(lines) + "\n" + ended + tail


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--reduce", type=pathlib.Path, metavar="FILE")
    action.add_argument("--write", type=pathlib.Path, metavar="FILE")
    action.add_argument("--check", type=pathlib.Path, metavar="FILE")
    arguments = parser.parse_args()
    run = json.loads(arguments.run.read_text())
    if arguments.reduce:
        arguments.reduce.write_text(as_text(reduced(run)))
        return 0
    lines = list(table(run))
    readme = arguments.write or arguments.check
    if not readme:
        print("\n".join(lines))
        return 0
    old = readme.read_text()
    new = replaced(old, lines)
    if arguments.write:
        readme.write_text(new)
    elif old != new:
        print(f"{readme} does not show {arguments.run}: bench/table.py {arguments.run} --write {readme}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
