#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The time of ambiguous faces resolved from the data, relative to `low`: runs the cases of extract_bench that differ only
in the rule side by side, and keeps their figures in bench/results/resolved.json.

All rules of an image run in one process, in random order and many times, so that what disturbs the machine meets all of
them. Which pages of memory a process gets changes the times of large contours by a tenth and more, so this is repeated
in several processes. Times are processor time on one thread, real time on several. Reported are the median and the least
of the runs, and ratios of either; a target counts as reached where the ratio of the least times reaches it, each rule at
its best.
bench/tables.py makes tables of the figures.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

import machine
import tables

KEPT = machine.ROOT / "bench/results/resolved.json"
RULES = ("low", "mean", "saddle", "squares", "decider")
STARTS = 41  # processes of each rule
PROCESSES = 4  # of each image


@dataclasses.dataclass
class Case:
    """Benchmarks of one image, by rule, and what is to be reached."""

    name: str
    benchmarks: str  # name in extract_bench without rule and threads
    simd: str = ""  # instead of the processor's best instruction set, one of Highway's names
    ratio: dict = dataclasses.field(default_factory=dict)  # rule -> at most so many times the time of low
    ms_per_tile: dict = dataclasses.field(default_factory=dict)  # rule -> at most so many ms for an active tile
    tiles_per_second: dict = dataclasses.field(default_factory=dict)  # rule -> at least so many active tiles


CASES = [
    Case("gyroid, 4096²", "extract/gyroid/4096^2", ratio={"mean": 1.15, "saddle": 1.15}),
    Case("uniform noise, 4096²", "extract/noise/4096^2"),
    Case("gyroid, 256³", "extract/gyroid/256^3", ratio={"mean": 1.15, "saddle": 1.15}),
    Case("uniform noise, 128³", "extract/noise/128^3", ratio={"mean": 2, "saddle": 2}),
    Case("two merging balls, 64⁴", "extract/balls/64^4", ratio={"mean": 1.15, "saddle": 1.15}),
    Case("uniform noise, 16⁴", "extract/noise/16^4", ratio={"mean": 3.5, "saddle": 3.5}),
    Case("uniform noise, 32⁴", "extract/noise/32^4", ratio={"mean": 3.5, "saddle": 3.5}),
    Case("uniform noise, 16⁴", "extract/noise/16^4", simd="AVX2", ratio={"mean": 3.5, "saddle": 3.5}),
    Case("uniform noise, 32⁴", "extract/noise/32^4", simd="AVX2", ratio={"mean": 3.5, "saddle": 3.5}),
    Case("sphere, 24⁴, barycentric", "barycentric/sphere/24^4/barycentric"),
    Case("uniform noise, 8⁴, barycentric", "barycentric/noise/8^4/barycentric"),
    Case("uniform noise, 4⁵", "extract/noise/4^5", ms_per_tile={"low": 0.25, "mean": 0.25, "saddle": 0.25}),
    Case("sphere, 12⁵", "extract/sphere/12^5", tiles_per_second={"low": 150_000}),
]


def run_benchmarks(case: Case, threads: int, options) -> list[dict]:
    """All repetitions of all rules in one process."""
    names = f"^{re.escape(case.benchmarks)}(/({'|'.join(RULES[1:])}))?/threads:{threads}/"
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([options.build / "bench/extract_bench", *([f"--simd={case.simd}"] if case.simd else []),
                        f"--benchmark_filter={names}",
                        f"--benchmark_repetitions={options.repetitions}", "--benchmark_enable_random_interleaving=true",
                        f"--benchmark_min_time={options.min_time}", f"--benchmark_out={out}",
                        "--benchmark_out_format=json"], check=True, stdout=subprocess.DEVNULL)
        found = json.loads(out.read_text())["benchmarks"]
    return [run for run in found if run.get("run_type") == "iteration"]


def rule_of(case: Case, run: dict) -> str:
    rule = run["run_name"].removeprefix(case.benchmarks).split("/threads:")[0].removeprefix("/")
    return rule or "low"


def measure(case: Case, threads: int, options) -> dict:
    runs = {}
    for _ in range(PROCESSES):
        for run in run_benchmarks(case, threads, options):
            runs.setdefault(rule_of(case, run), []).append(run)
    if "low" not in runs or (len(runs) < 2 and not case.tiles_per_second):
        raise RuntimeError(f"extract_bench has no rules for {case.benchmarks} with {threads} threads; found {sorted(runs)}")
    sides = {}
    for rule in (rule for rule in RULES if rule in runs):
        ms = [run["cpu_time" if threads == 1 else "real_time"] for run in runs[rule]]
        first = runs[rule][0]
        sides[rule] = {"median_ms": statistics.median(ms), "least_ms": min(ms), "runs": len(ms),
                       "active_tiles": int(first["active_tiles"]), "simplices": int(first["simplices"])}
    for side in sides.values():
        side["ratio"] = side["median_ms"] / sides["low"]["median_ms"]
        side["ratio_of_least"] = side["least_ms"] / sides["low"]["least_ms"]
    name = f"{case.name}, {case.simd}" if case.simd else case.name
    return {"name": name, "threads": threads, "sides": sides, "verdicts": verdicts(case, sides)}


def verdicts(case: Case, sides: dict) -> list[dict]:
    found = [{"rule": rule, "ratio": sides[rule]["ratio_of_least"], "wanted": f"≤ {wanted}×",
              "met": sides[rule]["ratio_of_least"] <= wanted} for rule, wanted in case.ratio.items()]
    for rule, wanted in case.ms_per_tile.items():
        ms = sides[rule]["least_ms"] / sides[rule]["active_tiles"]
        found.append({"rule": rule, "ms_per_tile": ms, "wanted": f"≤ {wanted} ms a tile", "met": ms <= wanted})
    for rule, wanted in case.tiles_per_second.items():
        tiles = 1e3 * sides[rule]["active_tiles"] / sides[rule]["least_ms"]
        found.append({"rule": rule, "tiles_per_second": tiles, "wanted": f"≥ {wanted:,} tiles/s".replace(",", " "),
                      "met": tiles >= wanted})
    return found


def measure_start(options) -> dict:
    """The first contour of a process, and the least of later ones: medians of many processes."""
    times = {rule: [] for rule in RULES}
    for _ in range(STARTS):
        for rule in RULES:
            text = subprocess.run([options.build / "bench/first_contour", rule], check=True, capture_output=True, text=True)
            times[rule].append([float(ms) for ms in text.stdout.split()])
    return {rule: {"first_ms": statistics.median(run[0] for run in runs), "later_ms": statistics.median(run[1] for run in runs),
                   "runs": len(runs)} for rule, runs in times.items()}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=machine.ROOT / "build/release")
    parser.add_argument("--repetitions", type=int, default=5, metavar="N",
                        help=f"of each rule in each of {PROCESSES} processes (default: 5)")
    parser.add_argument("--min-time", type=float, default=0.05, metavar="S", help="seconds of a repetition (default: 0.05)")
    parser.add_argument("--threads", default="1", metavar="LIST", help="numbers of threads, of 1 and 4 (default: 1)")
    parser.add_argument("--only", default="", metavar="TEXT", help="only images whose name has TEXT, such as 16⁴")
    parser.add_argument("--kept", type=pathlib.Path, default=KEPT, help="the figures (default: bench/results/resolved.json)")
    options = parser.parse_args()
    options.threads = [int(count) for count in options.threads.split(",")]
    if options.repetitions < 1 or options.min_time <= 0 or not set(options.threads) <= {1, 4}:
        parser.error("repetitions and the time are positive; extract_bench has these cases on 1 and on 4 threads")
    return options


def main() -> None:
    options = parse_arguments()
    for program in ("extract_bench", "first_contour"):
        if not (options.build / "bench" / program).exists():
            raise SystemExit(f"resolved.py: no {options.build / 'bench' / program}; build it first")
    os.environ["GLIBC_TUNABLES"] = "glibc.malloc.hugetlb=1"  # as in the side-by-side comparison
    result = {"machine": machine.describe(options.build), "rows": []}
    for case in CASES:
        if options.only not in case.name:
            continue
        if case.simd and result["machine"]["processor"]["simd"] != "avx512f":
            continue  # the same as without, or not possible
        for threads in options.threads:
            if threads == 4 and case.benchmarks.startswith("barycentric"):
                continue  # extract_bench has these on one thread
            row = measure(case, threads, options)
            result["rows"].append(row)
            print(f"{row['name']}, {threads}: " + ", ".join(f"{rule} {side['median_ms']:.2f} ms ({side['ratio']:.2f}×)"
                                                            for rule, side in row["sides"].items()), flush=True)
    if not options.only:
        result["start"] = measure_start(options)
    print("\n".join(["", *machine.lines(result["machine"]), "", *tables.resolved(result)]))
    options.kept.parent.mkdir(parents=True, exist_ok=True)
    options.kept.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
