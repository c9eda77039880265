#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The measured tables of docs/seed-sets.md and docs/active-tiles.md, anew: runs seeds_bench and active_tiles_bench of a
release build, one process for each image, and writes what they print between the tables' marks. Some 15 minutes on a
machine that does nothing else; tables can be made one by one.

  bench/index_tables.py [--build DIR] [--data DIR] [--runs N] [TABLE...]

--data: a folder with classic/, the data sets that the repository does not have. --runs: seeds are found so many times,
the least time counts."""

import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEEDS = ROOT / "docs/seed-sets.md"
TILES = ROOT / "docs/active-tiles.md"

CLASSIC = {
    "fuel 64³": "fuel_64x64x64",
    "neghip 64³": "neghip_64x64x64",
    "silicium 98 × 34 × 34": "silicium_98x34x34",
    "hydrogen atom 128³": "hydrogen_atom_128x128x128",
    "aneurism 256³": "aneurism_256x256x256",
}
COSTLY = ["cover", "whole1", "whole2", "volume-thinning", "sweeping", "climbing"]
FIELDS = ["metaballs", "gyroid", "sines", "noise", "smooth-noise", "plateaus"]
SIZES = [f"{field}:{n}" for field in FIELDS for n in (64, 128, 256)] + [
    "metaballs:256@uint8", "noise:256@uint8", "smooth-noise:256@uint16",
    *(f"{field}:4096^2" for field in ("metaballs", "sines", "noise", "smooth-noise")),
    *(f"{field}:64^4" for field in ("metaballs", "sines", "noise")),
]
RAISED = {"2": "²", "3": "³", "4": "⁴"}


def cells(program: pathlib.Path, *arguments: str) -> list[list[str]]:
    """The rows of the tables that a program prints, headers and rules left out."""
    print(program.name, *arguments, file=sys.stderr, flush=True)
    text = subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout
    lines = [line for line in text.splitlines() if line.startswith("|")]
    rules = [i for i, line in enumerate(lines) if line.startswith("|--")]
    return [[cell.strip(" `") for cell in line.strip("|").split("|")]
            for i, line in enumerate(lines) if i not in rules and i + 1 not in rules]


def count(digits: str) -> str:
    return f"{int(digits):,}".replace(",", " ")


def table(head: list[str], rows: list[list[str]]) -> list[str]:
    return [f"| {' | '.join(head)} |", "|" + "---|" * len(head), *(f"| {' | '.join(row)} |" for row in rows)]


class Tables:
    def __init__(self, build: pathlib.Path, data: pathlib.Path, runs: int):
        self.runs = str(runs)
        self.seeds = build / "bench/seeds_bench"
        self.tiles = build / "bench/active_tiles_bench"
        self.classic = data / "classic"

    def classic_cost(self) -> list[str]:
        """Seconds of every method."""
        rows = []
        for name, file in CLASSIC.items():
            seconds = {row[1]: row[4] for row in cells(self.seeds, "--methods", ",".join(COSTLY), "--runs", self.runs,
                                                       str(self.classic / f"{file}_uint8.nhdr"))}
            rows.append([name, *(seconds[method] for method in COSTLY)])
        return table(["image", *(f"`{method}`" for method in COSTLY)], rows)

    def fields(self) -> list[str]:
        """How time and sets grow with the image."""
        rows = []
        for image in SIZES:
            found = {row[1]: row for row in cells(self.seeds, "--scaling", "--methods", "cover", "--neighbourhoods",
                                                  "faces,all", "--runs", self.runs, image)}
            field, _, rest = image.partition(":")
            size, _, kind = rest.partition("@")
            samples, _, dim = size.partition("^")
            rows.append([f"`{field}`", kind or "float", samples + RAISED[dim or "3"]] +
                        [text for row in (found["faces"], found["all"]) for text in (count(row[4]), row[5], row[6])] +
                        [found["faces"][7]])
        return table(["field", "type", "samples", "F: seeds", "seconds", "µs per tile", "F+E+V: seeds", "seconds", "µs per tile",
                      "bytes per tile while found, F"], rows)

    def bounds(self) -> list[str]:
        """Covers of faces and their bounds."""
        rows = []
        for field in FIELDS:
            row = [f"`{field}`"]
            for samples in (64, 128, 256):
                found = cells(self.seeds, "--methods", "cover", "--neighbourhoods", "faces", f"{field}:{samples}")[0]
                row.append(f"{count(found[2])}, {count(found[3].split(',')[0] or '0')}")
            rows.append(row)
        return table(["field of float", "64³: seeds, bound", "128³", "256³"], rows)

    def active(self, image: str, queries: int) -> list[str]:
        """What the indexes of an image cost, and their queries."""
        rows = []
        for row in cells(self.tiles, "--queries", str(queries), image):
            megabytes = float(row[2].split()[0])
            index = "0" if row[0] == "full-scan" else row[2] if megabytes >= 0.01 else "< 10 kB"
            rows.append([f"`{row[0]}`", "< 1 ms" if float(row[1]) < 0.001 else f"{row[1]} s", index, row[6], row[7],
                         f"{1000 * float(row[8]):.0f} ms", row[9]])
        return table(["method", "built in", "index", "query", "explained", "all contours", "of those without an index"], rows)

    def all(self) -> dict:
        aneurism, hydrogen = (str(self.classic / f"{CLASSIC[name]}_uint8.nhdr") for name in ("aneurism 256³", "hydrogen atom 128³"))
        return {
            "classic-cost": (SEEDS, self.classic_cost),
            "fields": (SEEDS, self.fields),
            "bounds": (SEEDS, self.bounds),
            "balls": (TILES, lambda: self.active("balls:256", 8)),
            "aneurism": (TILES, lambda: self.active(aneurism, 24)),
            "hydrogen": (TILES, lambda: self.active(hydrogen, 256)),
            "ocean": (TILES, lambda: self.active(str(ROOT / "examples/data/ocean_temperature.nc"), 16)),
        }


def write(path: pathlib.Path, name: str, lines: list[str]) -> None:
    """Puts a table between its marks."""
    first, last = f"<!-- {name}: made by bench/index_tables.py -->\n", "<!-- end -->"
    before, rest = path.read_text().split(first)
    path.write_text(before + first + "\n" + "\n".join(lines) + "\n\n" + last + rest.split(last, 1)[1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("tables", nargs="*", metavar="TABLE")
    arguments = parser.parse_args()
    tables = Tables(arguments.build, arguments.data, arguments.runs).all()
    for name in arguments.tables or tables:
        if name not in tables:
            parser.error(f"'{name}'; expected some of {', '.join(tables)}")
    for name in arguments.tables or tables:
        path, make = tables[name]
        write(path, name, make())


if __name__ == "__main__":
    main()
