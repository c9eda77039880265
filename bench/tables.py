# SPDX-License-Identifier: BSD-3-Clause
"""The figures of bench/results/*.json as tables for readers: writes bench/results/README.md, the table of missed marks in
bench/README.md, the tables of resolved ambiguities, of operations and of curved and periodic grids in docs/cost.md, and
those of tilings in docs/other-tilings.md and docs/meshes.md."""

import json
import re

import machine

RESULTS = machine.ROOT / "bench/results"
MISSED = machine.ROOT / "bench/README.md"
COST = machine.ROOT / "docs/cost.md"
TILINGS = machine.ROOT / "docs/other-tilings.md"
MESHES = machine.ROOT / "docs/meshes.md"

# What bounds a case beside memory, by field and dimension: written by hand, explained in bench/README.md.
BOUNDS = {
    ("metaballs", 3): "instructions for rows with two or three edges",
    ("gyroid", 3): "instructions for each tile, fresh memory",
    ("noise", 3): "instructions for each tile, fresh memory",
    ("metaballs", 2): "reading of samples from memory; threads synchronise twice in each batch",
    ("gyroid", 2): "reading of samples from memory; threads synchronise twice in each batch",
    ("noise", 2): "instructions for each tile, fresh memory",
    ("balls", 4): "instructions for each row; threads synchronise twice in each batch",
    ("sphere", 4): "instructions for each tile; threads synchronise twice in each batch",
    ("noise", 4): "instructions for each tile, fresh memory",
}
NORMALS_BOUND = "samples around both ends of each edge, loaded for each vertex"


def ms(seconds: float) -> str:
    return f"{1e3 * seconds:.1f}"


def verdict_text(verdict: dict) -> str:
    text = ""
    if "ratio" in verdict:
        text = f"{verdict['ratio']:.1f}× {verdict['peer']} (medians: {verdict['ratio_of_medians']:.1f}×), "
    elif "tiles_per_second" in verdict:
        text = f"{verdict['tiles_per_second'] / 1e6:.0f} M tiles/s, "
    elif "memory" in verdict:
        text = f"memory {100 * verdict['memory']:.1f} % of the input, "
    elif "seconds" in verdict:
        text = f"{ms(verdict['seconds'])} ms, "
    return f"{text}{verdict['wanted']}: {'met' if verdict['met'] else 'not met'}"


def counts_text(row: dict) -> str:
    """The number of simplices, and whether VTK made as many vertices and simplices."""
    sides = {name: side for name, side in row["sides"].items() if name.split("/")[0] in ("tegl", "VTK")}
    if len({(side["vertices"], side["simplices"]) for side in sides.values()}) > 1:
        return "DIFFERENT: " + ", ".join(f"{name} {side['simplices']:,}" for name, side in sides.items())
    count = f"{next(iter(sides.values()))['simplices']:,}"
    return count + (" (VTK: the same)" if any(name.startswith("VTK") for name in sides) else "")


def side_rows(row: dict) -> list[str]:
    text = []
    for i, (name, side) in enumerate(row["sides"].items()):
        stages = ", ".join(ms(side["stages"][s]) for s in ("classify", "find", "generate")) if name.startswith("tegl") else ""
        own = row["sides"].get("tegl/" + name.split("/")[1])
        ratio = f"{side['least'] / own['least']:.1f}×" if own and own is not side else ""
        floor = ms(side["floor"]) if "floor" in side else ""
        extra = f"{100 * side['extra_bytes'] / row['input_bytes']:.1f} %" if "extra_bytes" in side else ""
        faults = f"{side['page_faults']:.0f}" if "page_faults" in side else ""
        text.append(f"| {row['name'] if i == 0 else ''} | {counts_text(row) if i == 0 else ''} | {name.replace('/', ', ')} | "
                    f"{ms(side['median'])} | {ms(side['least'])} | {ratio} | {stages} | {floor} | {faults} | {extra} |")
    return text


def side_by_side(result: dict) -> list[str]:
    """All figures, then the targets."""
    text = ["| field | simplices | side, threads | median ms | minimum ms | relative to tegl | stages: classify, find, generate | memory floor, "
            "ms | page faults | memory beside input and output, share of the input |", "|---|---|---|---|---|---|---|---|---|---|"]
    for row in result["rows"]:
        text += side_rows(row)
    if any(row["verdicts"] for row in result["rows"]):
        text += ["", "| field | threads | result |", "|---|---|---|"]
    for row in result["rows"]:
        text += [f"| {row['name']} | {v['threads']} | {verdict_text(v)} |" for v in row["verdicts"]]
    rates = ", ".join(f"{threads} thread{'s' * (int(threads) > 1)}: read {rate['read'] / 1e9:.0f}, fresh memory written "
                      f"{rate['fresh_write'] / 1e9:.0f} GB/s" for threads, rate in result["memory"].items())
    return text + ["", f"Memory, {rates} (huge pages). *Memory floor*: the samples read once and the output written once at "
                   "these rates."]


def stages(result: dict) -> list[str]:
    text = ["| benchmark | ms | classify | find | generate | close | M samples/s | M active tiles/s | M simplices/s |",
            "|---|---|---|---|---|---|---|---|---|"]
    for run in result["benchmarks"]:
        name = run["name"].removesuffix("/real_time").removesuffix("_median")
        parts = " | ".join(f"{run[stage + '_ms']:.2f}" for stage in ("classify", "find", "generate", "close"))
        rates = " | ".join(f"{run[rate] / 1e6:.1f}" for rate in ("samples/s", "tiles/s", "items_per_second"))
        text.append(f"| {name.removesuffix('/real_time')} | {run['real_time']:.2f} | {parts} | {rates} |")
    return text


def scaling(result: dict) -> list[str]:
    threads = sorted({point["threads"] for point in result["points"]})
    text = ["| field | size | active tiles | " + " | ".join(f"{t} thread{'s' * (t > 1)}, ms" for t in threads) + " |",
            "|---|---|---|" + "---|" * len(threads)]
    lines = {}
    for point in result["points"]:
        lines.setdefault((point["field"], point["samples"], point["dim"]), {})[point["threads"]] = point
    for (field, samples, dim), by_threads in lines.items():
        power = {2: "²", 3: "³", 4: "⁴"}[dim]
        times = " | ".join(f"{by_threads[t]['ms']:.2f}" if t in by_threads else "" for t in threads)
        text.append(f"| {field} | {samples}{power} | {next(iter(by_threads.values()))['active_tiles']:,} | {times} |")
    return text + cost(result)


def fit(points: list[dict]) -> tuple[float, float]:
    """ns per sample and per active tile: the least squares of relative deviations."""
    rows = [(p["samples"] ** p["dim"] / p["ms"], p["active_tiles"] / p["ms"]) for p in points]
    s11, s12, s22 = (sum(r[i] * r[j] for r in rows) for i, j in ((0, 0), (0, 1), (1, 1)))
    b1, b2 = (sum(r[i] for r in rows) for i in (0, 1))
    determinant = s11 * s22 - s12 * s12
    return 1e6 * (b1 * s22 - b2 * s12) / determinant, 1e6 * (b2 * s11 - b1 * s12) / determinant


def cost(result: dict) -> list[str]:
    """What a sample and an active tile cost, by dimension and threads."""
    text = ["", "Time per sample and per active tile, fitted to the smooth fields of at least 64³ or 32⁴ samples. The last column is the time per "
            "active tile of the largest noise, samples included:", "",
            "| dimension | threads | ns per sample | ns per active tile | ns per active tile of noise |", "|---|---|---|---|---|"]
    for dim in (3, 4):
        for threads in sorted({p["threads"] for p in result["points"]}):
            points = [p for p in result["points"] if p["dim"] == dim and p["threads"] == threads]
            noise = max((p for p in points if p["field"] == "noise"), key=lambda p: p["samples"])
            smooth = [p for p in points if p["field"] != "noise" and p["samples"] >= (64 if dim == 3 else 32)]
            text.append(f"| {dim} | {threads} | " + " | ".join(f"{value:.2f}" for value in fit(smooth)) +
                        f" | {1e6 * noise['ms'] / noise['active_tiles']:.1f} |")
    return text


def instructions(result: dict) -> list[str]:
    text = ["| image | instructions, millions | per sample | per active tile | per simplex |", "|---|---|---|---|---|"]
    for case in result["cases"]:
        count = case["instructions"]
        each = " | ".join(f"{count / case[what]:.1f}" for what in ("samples", "active", "simplices"))
        text.append(f"| {case['name']} | {count / 1e6:.1f} | {each} |")
    return text


def instructions_text(cases: list[dict], row: dict) -> str:
    """Of the case that is like the row, but smaller: what an active tile takes, with its share of the samples."""
    for case in cases:
        name, size, *normals = case["name"].split()
        if (name, int(size[-1]), bool(normals)) == (row["field"], row["dim"], row["normals"]):
            return f"{case['instructions'] / case['active']:.0f} ({size})"
    return ""


def missed(result: dict, cases: list[dict]) -> list[str]:
    """The marks for speed that are not met, and what bounds each."""
    text = ["| image | threads | reached | target | time of memory traffic, of the whole | page faults | instructions per active tile | "
            "limited by |", "|---|---|---|---|---|---|---|---|"]
    for row in result["rows"]:
        for verdict in row["verdicts"]:
            if verdict["met"] or "memory" in verdict:
                continue
            side = row["sides"][f"tegl/{verdict['threads']}"]
            reached = (f"{verdict['ratio']:.2f}× {verdict['peer']}" if "ratio" in verdict else
                       f"{verdict['tiles_per_second'] / 1e6:.0f} M tiles/s" if "tiles_per_second" in verdict else
                       f"{ms(verdict['seconds'])} ms")
            bound = NORMALS_BOUND if row["normals"] else BOUNDS[row["field"], row["dim"]]
            text.append(f"| {row['name']} | {verdict['threads']} | {reached} | {verdict['wanted']} | "
                        f"{ms(side['floor'])} of {ms(side['least'])} ms | {side['page_faults']:.0f} | {instructions_text(cases, row)} | {bound} |")
    return text if len(text) > 2 else ["All marks for speed are met."]


def resolved_verdict(verdict: dict) -> str:
    if "ratio" in verdict:
        reached = f"{verdict['ratio']:.2f}×"
    elif "ms_per_tile" in verdict:
        reached = f"{verdict['ms_per_tile']:.3f} ms a tile"
    else:
        reached = f"{verdict['tiles_per_second']:,.0f} tiles/s".replace(",", " ")
    return f"{verdict['rule']} {reached} ({verdict['wanted']}: {'met' if verdict['met'] else 'not met'})"


def resolved(result: dict) -> list[str]:
    """Times relative to `low`, by medians and by least times, the ratio of the numbers of simplices, and what was to be
    reached."""
    rules = list(dict.fromkeys(rule for row in result["rows"] for rule in row["sides"]))
    others = [rule for rule in rules if rule != "low"]
    text = ["| image | threads | `low`, median ms | ns per active tile | " + " | ".join(f"`{rule}`" for rule in others) + " | result |",
            "|---|---|---|---|" + "---|" * len(others) + "---|"]
    for row in result["rows"]:
        low = row["sides"]["low"]
        ratios = []
        for rule in others:
            side = row["sides"].get(rule)
            ratios.append(f"{side['ratio']:.2f}×, {side['ratio_of_least']:.2f}× ({side['simplices'] / low['simplices']:.2f})"
                          if side else "")
        text.append(f"| {row['name']} | {row['threads']} | {low['median_ms']:.2f} | {1e6 * low['median_ms'] / low['active_tiles']:.1f}"
                    f" | {' | '.join(ratios)} | {'; '.join(map(resolved_verdict, row['verdicts']))} |")
    if "start" in result:
        text += ["", "The first contour of a process, of noise in 6⁴ samples, and the least of the next 20 (medians of processes, one thread):", "",
                 "| rule | first, ms | later, ms | difference, ms |", "|---|---|---|---|"]
        text += [f"| `{rule}` | {side['first_ms']:.2f} | {side['later_ms']:.2f} | {side['first_ms'] - side['later_ms']:.2f} |"
                 for rule, side in result["start"].items()]
    return text


def duration(milliseconds: float) -> str:
    """With three digits."""
    if milliseconds >= 1000:
        return f"{milliseconds / 1000:.2f} s"
    digits = 0 if milliseconds >= 100 else 1 if milliseconds >= 10 else 2
    return f"{milliseconds:.{digits}f} ms"


def operations_verdict(verdicts: list[dict]) -> str:
    return "; ".join(f"{v['reached']:.{1 if v['reached'] >= 1 else 2}f}{v['unit']} (≤ {v['wanted']}{v['unit']}: "
                     f"{'met' if v['met'] else 'not met'})" for v in verdicts)


def operations_on(file: dict, has_verdicts: bool) -> list[str]:
    """Times, in extractions on one thread, too, and the memory on one thread. The last column: what was to be reached,
    in extractions or seconds, with one thread and with two."""
    text = [f"*{file['file']}* at {file['isovalue']:g}: {file['contour']}.", "",
            "| operation | 1 thread | in extractions | 2 threads | in extractions | memory |" + " 1 thread; 2 threads |" * has_verdicts,
            "|---|---|---|---|---|---|" + "---|" * has_verdicts]
    extract = file["operations"].get("`extract`", {}).get("threads", {}).get("1", {}).get("ms")
    for name, row in file["operations"].items():
        cells = []
        for threads in ("1", "2"):
            ms = row["threads"][threads]["ms"]
            cells += [duration(ms), f"{ms / extract:.{0 if ms >= 9.95 * extract else 1}f}" if extract else ""]
        reached = operations_verdict([v for v in file["verdicts"] if v["operation"] == name])
        text.append(f"| {name} | {' | '.join(cells)} | {row['threads']['1']['mb']:.1f} MB |" + f" {reached} |" * has_verdicts)
    return text


def operations(result: dict) -> list[str]:
    """The marks are for the first file."""
    text = []
    for i, file in enumerate(result["files"]):
        text += [""] * (i > 0) + operations_on(file, i == 0)
    return text


def put_between(path, first: str, table: list[str]) -> None:
    """Puts a table between its marks in a page."""
    first, last = f"<!-- {first}: made by bench/tables.py -->\n", "<!-- end -->"
    before, rest = path.read_text().split(first)
    path.write_text(before + first + "\n" + "\n".join(table) + "\n\n" + last + rest.split(last, 1)[1])


def write_missed(path) -> None:
    result = json.loads((RESULTS / "side_by_side.json").read_text())
    cases = json.loads((RESULTS / "instructions.json").read_text())["cases"]
    put_between(path, "missed marks", missed(result, cases))


def write_resolved(path) -> None:
    kept = RESULTS / "resolved.json"
    if kept.exists():
        put_between(path, "resolved ambiguities", resolved(json.loads(kept.read_text())))


def write_operations(path) -> None:
    kept = RESULTS / "operations.json"
    if kept.exists():
        put_between(path, "operations", operations(json.loads(kept.read_text())))


# The rows of lattice_bench, as the pages name them.
LATTICES = {"cubic": "cubic", "fcc": "fcc", "bcc": "bcc", "fcc, complex": "fcc, cells stored"}
CURVED = {
    "plain": "plain",
    "two coordinates in 2D arrays": "[curved](other-tilings.md#curved-grids), two coordinates in 2D arrays",
    "two, by points (float)": "the same, stored sample by sample (`by_points`)",
    "three coordinates in 3D arrays": "curved, three coordinates in 3D arrays",
    "three coordinates in 3D arrays (float)": "the same, arrays of `float`",
    "three, by points (float)": "the same, stored sample by sample as `float`",
    "three, by points (double)": "the same, stored sample by sample as `double`",
    "three, in place, 12 bytes a sample": "the same, points of the caller in place (`CurvedPoints::in_place`), 12 bytes a sample",
    "three, in place, 24 bytes a sample": "the same, 24 bytes a sample",
    "reading the lines of the three arrays once": "only reading the coordinates of the three arrays",
    "reading the lines of the points (float) once": "only reading the coordinates stored as `float`",
    "reading the lines of the points (double) once": "only reading the coordinates stored as `double`",
    "last axis periodic": "last axis [periodic](other-tilings.md#periodic-axes)",
    "first axis periodic": "first axis periodic",
    "all axes periodic": "all axes periodic",
}
MESH_SIDES = {
    "tegl": "tegl",
    "tegl, edges known": "tegl, edges known",
    "tegl, finding edges": "tegl, finding all edges",
    "vtkContour3DLinearGrid": "`vtkContour3DLinearGrid`, points merged",
    "vtkContour3DLinearGrid, points not merged": "`vtkContour3DLinearGrid`, points not merged (its default)",
    "vtkContourFilter": "`vtkContourFilter`",
}


def spaced(number) -> str:
    return f"{int(number):,}".replace(",", " ")


def by_name(rows: list[dict]) -> dict:
    """Rows of a table by their first column."""
    return {next(iter(row.values())): row for row in rows}


def lattices(result: dict) -> list[str]:
    rows = by_name(result["lattices"])
    text = ["| samples | active cells | ms | comparison, ns per sample | ns per active cell |", "|---|---|---|---|---|"]
    for name, label in LATTICES.items():
        row = rows[name]
        text.append(f"| {label} | {spaced(row['active cells'])} | {row['ms']} | {float(row['classify, ns per sample']):.2f} | "
                    f"{row['ns per active cell']} |")
    times = float(rows["fcc"]["ns per active cell"]) / float(rows["cubic"]["ns per active cell"])
    return text + ["", f"An active cell of fcc takes {times:.1f} times the time of a cube: it has up to 12 edges, which lie in more "
                   "rows of samples than those of a cube."]


def lattices_4d(result: dict) -> list[str]:
    rows = by_name(result["lattices in 4D"])
    text = ["| samples | active cells | ms | comparison, ns per sample | ns per sample | ns per active cell | memory, bytes per sample |",
            "|---|---|---|---|---|---|---|"]
    for name, row in rows.items():
        label = name.replace("complex", "cells stored")
        text.append(f"| {label} | {spaced(row['active cells'])} | {row['ms']} | {float(row['classify, ns per sample']):.2f} | "
                    f"{float(row['ns per sample']):.2f} | {row['ns per active cell']} | {row['working memory, bytes per sample']} |")
    times = [[float(rows[f"{field}, {lattice}"]["ns per active cell"]) / float(rows[f"{field}, cubic"]["ns per active cell"])
              for lattice in ("d4", "fcc_in_time")] for field in ("waves", "noise")]
    return text + ["", f"An active cell of d4 takes {times[0][0]:.1f} times the time of a tesseract (noise: {times[1][0]:.1f}), of fcc_in_time "
                   f"{times[0][1]:.1f} times (noise: {times[1][1]:.1f})."]


def curved(result: dict) -> list[str]:
    rows = by_name(result["curved and periodic grids"])
    return ["| grid | ms | relative to the plain contour |", "|---|---|---|"] + [
        f"| {label} | {rows[name]['median, ms']} | {rows[name]['median by the plain one']} |" for name, label in CURVED.items()]


def periodic(result: dict) -> list[str]:
    """A sentence."""
    rows = by_name(result["curved and periodic grids"])
    last, first, all_axes = (rows[f"{which} periodic"]["median by the plain one"]
                             for which in ("last axis", "first axis", "all axes"))
    return [f"The last axis periodic takes {last} times the time of the plain contour, the first one {first} times, all three "
            f"{all_axes} times: [cost](cost.md#curved-grids-and-periodic-axes)."]


def meshes(result: dict) -> list[str]:
    times = [{side["side"]: side["ms"] for side in mesh["sides"]} for mesh in result["meshes"]]
    text = ["| | " + " | ".join(f"{mesh['field']}, {spaced(mesh['sides'][0]['triangles'])} triangles" for mesh in result["meshes"]) +
            " |", "|---|" + "---|" * len(times)]
    for name, label in MESH_SIDES.items():
        text.append(f"| {label} | " + " | ".join(duration(of[name]).removesuffix(" ms") for of in times) + " |")

    def as_long(side: str, own: str) -> str:
        return " and ".join(f"{of[side] / of[own]:.1f}" for of in times)

    return text + ["", "So " + "; ".join(f"`{side}`{how} takes {as_long(side, 'tegl')} times as long as tegl, and {as_long(side, 'tegl, edges known')} "
                                         "times as long with known edges" for side, how in
                                         (("vtkContour3DLinearGrid", " with merged points"), ("vtkContourFilter", ""))) + "."]


def types_of_cells(result: dict) -> list[str]:
    text = ["| cells | triangles per active cell | ns per cell | with edges known |", "|---|---|---|---|"]
    rows = by_name(result["types of cells"])
    for name, row in rows.items():
        label = "all four, mixed" if name == "mixed" else name
        text.append(f"| {label} | {int(row['triangles']) / int(row['active']):.1f} | {row['ns per cell']} | "
                    f"{row['ns per cell, edges known']} |")
    as_long = [float(rows["mixed"][column]) / float(rows["tetrahedra"][column]) for column in ("ns per cell", "ns per cell, edges known")]
    return text + ["", f"A cell of the mixed mesh takes {as_long[0]:.1f} times as long as one of the tetrahedra, and {as_long[1]:.1f} "
                   "times with known edges."]


def write_tilings() -> None:
    kept = RESULTS / "tilings.json"
    if not kept.exists():
        return
    result = json.loads(kept.read_text())
    put_between(COST, "curved and periodic grids", curved(result))
    put_between(TILINGS, "periodic axes", periodic(result))
    put_between(TILINGS, "lattices", lattices(result))
    put_between(TILINGS, "lattices in 4D", lattices_4d(result))
    put_between(MESHES, "meshes", meshes(result))
    put_between(MESHES, "types of cells", types_of_cells(result))


def page(name: str, title: str, how: str, table) -> list[str]:
    """One section, if its file is there."""
    path = RESULTS / f"{name}.json"
    if not path.exists():
        return []
    result = json.loads(path.read_text())
    return ["", f"## {title}", "", how, "", *machine.lines(result["machine"]), "", *table(result)]


def main() -> None:
    text = ["# Results", "", "Made by `bench/record`. The page on [cost](../../docs/cost.md) explains the figures. All times are "
            "from one machine: compare ratios, not times."]
    text += page("side_by_side", "Side by side", "`bench/side_by_side`: all programs on the same samples, in turn, in one process.",
                 side_by_side)
    text += page("resolved", "Resolved ambiguities", "`bench/resolved.py`: the rules of an image in one process, in random order, and several such processes. Processor "
                 "time on one thread, real time on several, relative to `low`: medians, least times, in brackets the numbers of simplices.", resolved)
    text += page("operations", "Operations", "`bench/operations.py`: least times of several turns, with one thread and with two in each. In extractions: "
                 "divided by the time of `extract` on one thread.", operations)
    text += page("scaling", "Scaling", "`bench/scaling`: the minimum of three runs of each.", scaling)
    text += page("stages", "Stages", "`extract_bench --benchmark_filter='^(extract|types)/'`: means over the iterations, ms.",
                 stages)
    text += page("instructions", "Instructions", "`bench/instructions --large`: instructions of one extraction by one thread, counted by callgrind, "
                 "which supports AVX2 at most.", instructions)
    (RESULTS / "README.md").write_text(re.sub(r"\n{3,}", "\n\n", "\n".join(text)) + "\n")
    write_missed(MISSED)
    write_resolved(COST)
    write_operations(COST)
    write_tilings()


if __name__ == "__main__":
    main()
