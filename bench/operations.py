#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times and memory of the operations on 4D contours, with one thread and with two.

    bench/operations.py [--build DIR] [--repetitions N] [--turns N] [--only TEXT] [--kept FILE] FILE ISO [FILE ISO ...]

Runs the program `operations` of the build in turns, with each number of threads in each turn, and keeps the least times.
What was to be reached is relative to `extract` on one thread, in the same run. Prints the table, and writes the figures
to FILE (bench/results/operations.json), from which bench/tables.py makes the pages. The files are not in the repository:
examples/data/README.md.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess

import machine
import tables

KEPT = machine.ROOT / "bench/results/operations.json"
THREADS = (1, 2)
EXTRACT = "`extract`"

# By operation: what was to be reached with one thread and with two, in extractions on one thread or, with a unit, in s.
MARKS = {
    "`check`": ((9, 5), ""),
    "`slice` at one time": ((0.5, 0.3), ""),
    "`components`": ((5, 3), ""),
    "`measure`": ((5, 3), ""),
    "`measure_cuts`, 1000 times": ((12, 7), ""),
    "`track`": ((10, 6), ""),
    "`simplify` to a fifth, `quadric`, with its bound": ((4, 2.5), " s"),
    "`deviation` from the `quadric` one (`simplify`), and back": ((3, None), " s"),
}


def number(text: str) -> float:
    return float(text.split()[0])


def parse(text: str) -> list[dict]:
    """The tables that `operations` prints, one for each file."""
    files = []
    for line in text.splitlines():
        heading = re.fullmatch(r"### (.*) at (\S+)", line)
        if heading:
            files.append({"file": heading[1], "isovalue": float(heading[2]), "operations": {}})
        elif line.endswith(" MB") and "tetrahedra, " in line:
            files[-1]["contour"] = line
        elif line.startswith(("| `", "| the same ")):
            name, time, worked, memory, result = (cell.strip() for cell in line.strip("|").split(" | "))
            files[-1]["operations"][name] = {"ms": number(time), "processor_ms": number(worked), "mb": number(memory),
                                             "result": result}
    return files


def run(options, threads: int) -> list[dict]:
    command = [options.build / "bench/operations", "--threads", str(threads), "--repetitions", str(options.repetitions)]
    if options.only:
        command += ["--only", options.only]
    done = subprocess.run([*command, *options.files], check=True, stdout=subprocess.PIPE, text=True)
    return parse(done.stdout)


def merge(files: list[dict], found: list[dict], threads: int) -> None:
    """Adds what a run found: the least times, the largest memory."""
    for file, of_run in zip(files, found, strict=True):
        for name, row in of_run["operations"].items():
            sides = file["operations"].setdefault(name, {"result": row["result"], "threads": {}})["threads"]
            before = sides.get(str(threads), row)
            sides[str(threads)] = {"ms": min(row["ms"], before["ms"]),
                                   "processor_ms": min(row["processor_ms"], before["processor_ms"]),
                                   "mb": max(row["mb"], before["mb"])}


def verdicts(file: dict) -> list[dict]:
    extract = file["operations"].get(EXTRACT)
    found = []
    for name, (wanted, unit) in MARKS.items():
        for threads, most in zip(THREADS, wanted):
            row = file["operations"].get(name, {"threads": {}})["threads"].get(str(threads))
            if row is None or most is None or (not unit and extract is None):
                continue
            reached = row["ms"] / (1e3 if unit else extract["threads"]["1"]["ms"])
            found.append({"operation": name, "threads": threads, "reached": reached, "wanted": most, "unit": unit,
                          "met": reached <= most})
    return found


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=machine.ROOT / "build/release")
    parser.add_argument("--repetitions", type=int, default=5, metavar="N", help="of each operation in a turn (default: 5)")
    parser.add_argument("--turns", type=int, default=2, metavar="N", help="(default: 2)")
    parser.add_argument("--only", default="", metavar="TEXT", help="only operations whose name has TEXT; without --kept, none is kept")
    parser.add_argument("--kept", type=pathlib.Path, help="the figures (default: bench/results/operations.json)")
    parser.add_argument("files", nargs="+", metavar="FILE ISO", help="4D images, each with an isovalue")
    options = parser.parse_args()
    if len(options.files) % 2 != 0 or options.repetitions < 1 or options.turns < 1:
        parser.error(f"an isovalue after each file, and positive numbers of repetitions and turns; found {options.files}, "
                     f"{options.repetitions} and {options.turns}")
    return options


def main() -> None:
    options = parse_arguments()
    os.environ.setdefault("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1")  # as in the side-by-side comparison
    result = {"machine": machine.describe(options.build), "files": []}
    for turn in range(options.turns):
        for threads in THREADS:
            found = run(options, threads)
            if not result["files"]:
                result["files"] = [{**file, "operations": {}} for file in found]
            merge(result["files"], found, threads)
            print(f"turn {turn + 1} of {options.turns}, {threads} thread(s): done", flush=True)
    for file in result["files"]:
        file["verdicts"] = verdicts(file)
    print("\n".join(["", *machine.lines(result["machine"]), "", *tables.operations(result)]))
    kept = options.kept or (None if options.only else KEPT)
    if kept is None:
        return
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
