# SPDX-License-Identifier: BSD-3-Clause
"""tegl against VTK, contourpy and scikit-image: the same samples, in one process, turn by turn.

Every repetition gives each side one turn, so that what disturbs the machine meets all of them. In its turn a side runs
three times, and the fastest run counts: a virtual machine hands memory that was free for a moment back to its host, and
fetches it at a fraction of the speed of memory that it still has, which would be measured instead. Reported are the median
and the least over the turns, and ratios of either; a mark counts as met where the ratio of the least times meets it, each
side at its best. The counts of vertices and simplices are compared too: a faster answer to another question would not
count.
"""

import argparse
import ctypes
import dataclasses
import json
import pathlib
import statistics
import time

import contourpy
import numpy as np
import skimage.measure

import machine
import tables


class SideResult(ctypes.Structure):
    """side_by_side.hpp: SideResult."""

    _fields_ = [("seconds", ctypes.c_double), ("vertices", ctypes.c_uint64), ("simplices", ctypes.c_uint64),
                ("active_tiles", ctypes.c_uint64), ("output_bytes", ctypes.c_uint64), ("extra_bytes", ctypes.c_uint64),
                ("page_faults", ctypes.c_uint64),
                ("stage_seconds", ctypes.c_double * 4)]


RUNS_IN_A_TURN = 3
STAGES = ("classify", "find", "generate", "close")


@dataclasses.dataclass
class Case:
    """A row of the table: a field, and what is to be reached. Ratios are against the fastest peer."""

    name: str
    field: str
    dim: int
    samples: int
    ratio: dict = dataclasses.field(default_factory=dict)  # threads -> times as fast as the peer
    tiles_per_second: dict = dataclasses.field(default_factory=dict)  # threads -> tiles, active or not, in a second
    seconds: dict = dataclasses.field(default_factory=dict)  # threads -> at most so many seconds
    normals: bool = False
    skimage: bool = True  # whether scikit-image is done in a minute


CASES = [
    Case("200 metaballs, 512³", "metaballs", 3, 512, ratio={1: 6, 4: 4}),
    Case("gyroid, 512³", "gyroid", 3, 512, ratio={1: 5, 4: 3}),
    Case("uniform noise, 256³", "noise", 3, 256, ratio={1: 4.5, 4: 3}),
    Case("200 metaballs, 512³, normals", "metaballs", 3, 512, ratio={1: 5, 4: 4}, normals=True),
    Case("gyroid, 512³, normals", "gyroid", 3, 512, ratio={1: 5, 4: 3}, normals=True),
    Case("uniform noise, 256³, normals", "noise", 3, 256, ratio={1: 5, 4: 3}, normals=True),
    Case("metaballs, 8192²", "metaballs", 2, 8192, ratio={1: 5, 4: 4}),
    Case("gyroid, 8192²", "gyroid", 2, 8192, ratio={1: 5, 4: 4}),
    Case("uniform noise, 8192²", "noise", 2, 8192, ratio={1: 4, 4: 4}, skimage=False),
    Case("two merging balls, 64⁴", "balls", 4, 64, tiles_per_second={1: 500e6, 4: 1500e6}),
    Case("sphere, 64⁴", "sphere", 4, 64, seconds={1: 0.060, 4: 0.020}),
    Case("uniform noise, 48⁴", "noise", 4, 48, seconds={1: 1.0, 4: 0.35}),
]


class Core:
    """The module side_by_side: tegl, VTK and the fields."""

    def __init__(self, build: pathlib.Path):
        self.library = ctypes.CDLL(str(build / "bench" / "libside_by_side.so"))
        self.library.side_error.restype = ctypes.c_char_p
        self.library.side_vtk_version.restype = ctypes.c_char_p

    def check(self, status: int) -> None:
        if status != 0:
            raise RuntimeError(self.library.side_error().decode())

    def memory_rates(self, threads: int) -> dict:
        read, fresh_write = ctypes.c_double(), ctypes.c_double()
        self.check(self.library.side_memory_rates(threads, ctypes.byref(read), ctypes.byref(fresh_write)))
        return {"read": read.value, "fresh_write": fresh_write.value}

    def field(self, case: Case, samples: int) -> np.ndarray:
        values = np.empty((samples,) * case.dim, np.float32)
        self.check(self.library.side_field(case.field.encode(), case.dim, ctypes.c_size_t(samples),
                                           values.ctypes.data_as(ctypes.c_void_p)))
        return values

    def contour(self, side: str, values: np.ndarray, threads: int, normals: bool) -> dict:
        result = SideResult()
        self.check(getattr(self.library, f"side_{side}")(
            values.ndim, values.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(values.shape[0]), ctypes.c_double(0),
            threads, int(normals), ctypes.byref(result)))
        return {name: getattr(result, name) for name, _ in SideResult._fields_ if name != "stage_seconds"} | {
            "stages": dict(zip(STAGES, result.stage_seconds))}


def contourpy_lines(generator) -> dict:
    """One run of contourpy; its lines have one more point than segments, or as many where closed (last = first)."""
    start = time.perf_counter()
    points, offsets = generator.lines(0.0)
    seconds = time.perf_counter() - start
    count = sum(len(p) for p in points if p is not None)
    lines = sum(len(o) - 1 for o in offsets if o is not None)
    return {"seconds": seconds, "vertices": count, "simplices": count - lines}


def skimage_run(values: np.ndarray) -> dict:
    start = time.perf_counter()
    if values.ndim == 2:
        lines = skimage.measure.find_contours(values, 0.0)
        vertices, simplices = sum(map(len, lines)), sum(len(line) - 1 for line in lines)
    else:
        points, faces, _, _ = skimage.measure.marching_cubes(values, 0.0, method="lorensen")
        vertices, simplices = len(points), len(faces)
    return {"seconds": time.perf_counter() - start, "vertices": vertices, "simplices": simplices}


def make_sides(core: Core, case: Case, values: np.ndarray, threads: list[int], options) -> dict:
    """Name of side -> function that runs it once. Names end in the number of threads."""
    sides = {}
    if case.dim == 2:
        # contourpy computes in float64: its conversion and what it sets up once per image are not counted against it.
        doubles = values.astype(np.float64)
    for count in threads:
        sides[f"tegl/{count}"] = lambda count=count: core.contour("tegl", values, count, case.normals)
        if case.dim < 4:
            sides[f"VTK/{count}"] = lambda count=count: core.contour("vtk", values, count, case.normals)
        if case.dim == 2:
            parallel = {"name": "serial"} if count == 1 else {
                "name": "threaded", "thread_count": count, "total_chunk_count": 4 * count}
            generator = contourpy.contour_generator(
                z=doubles, line_type=contourpy.LineType.ChunkCombinedOffset, **parallel)
            sides[f"contourpy/{count}"] = lambda generator=generator: contourpy_lines(generator)
    if case.skimage and not options.no_skimage and case.dim < 4 and not case.normals and 1 in threads:
        sides["scikit-image/1"] = lambda: skimage_run(values)
    return sides


def summarise(runs: list[dict]) -> dict:
    """Median and least seconds; stages and memory of tegl as medians; counts, which must not vary."""
    seconds = [run["seconds"] for run in runs]
    for key in ("vertices", "simplices"):
        assert len({run[key] for run in runs}) == 1, f"the number of {key} varies from run to run"
    result = {"median": statistics.median(seconds), "least": min(seconds), "runs": len(runs)} | {
        key: runs[0][key] for key in ("vertices", "simplices", "active_tiles", "output_bytes") if key in runs[0]}
    if "stages" in runs[0]:
        result["stages"] = {stage: statistics.median(run["stages"][stage] for run in runs) for stage in STAGES}
    if "extra_bytes" in runs[0]:
        result["extra_bytes"] = statistics.median(run["extra_bytes"] for run in runs)
        result["page_faults"] = statistics.median(run["page_faults"] for run in runs)
    return result


def measure(core: Core, case: Case, options) -> dict:
    samples = max(2, round(case.samples / options.divide))
    values = core.field(case, samples)
    sides = make_sides(core, case, values, options.threads, options)
    runs = {name: [] for name in sides}
    for repetition in range(options.repetitions):
        for name, run in sides.items():
            # scikit-image is an order of magnitude behind: once is enough.
            if not name.startswith("scikit"):
                runs[name].append(min((run() for _ in range(RUNS_IN_A_TURN)), key=lambda result: result["seconds"]))
            elif repetition == 0:
                runs[name].append(run())
    name = case.name if samples == case.samples else f"{case.name}, here {samples}"
    return {"name": name, "field": case.field, "dim": case.dim, "samples": samples, "normals": case.normals,
            "input_bytes": values.nbytes, "sides": {name: summarise(list_) for name, list_ in runs.items()}}


def set_floor(row: dict, threads: int, rates: dict) -> None:
    """The time of memory accesses only: each sample read once, each byte of the output written once."""
    if own := row["sides"].get(f"tegl/{threads}"):
        own["floor"] = row["input_bytes"] / rates["read"] + own["output_bytes"] / rates["fresh_write"]


def verdicts(case: Case, row: dict) -> list[dict]:
    """The targets, and the results."""
    found = []
    sides = row["sides"]
    for threads, wanted in case.ratio.items():
        own = sides.get(f"tegl/{threads}")
        peers = {name: side for name, side in sides.items() if name.endswith(f"/{threads}") and not name.startswith("tegl")}
        if own is None or not peers:
            continue
        name, peer = min(peers.items(), key=lambda item: item[1]["least"])
        ratio = peer["least"] / own["least"]
        found.append({"threads": threads, "peer": name.split("/")[0], "ratio": ratio,
                      "ratio_of_medians": min(p["median"] for p in peers.values()) / own["median"],
                      "wanted": f"≥ {wanted}×", "met": ratio >= wanted})
    for threads, wanted in case.tiles_per_second.items():
        if own := sides.get(f"tegl/{threads}"):
            rate = (row["samples"] - 1) ** case.dim / own["least"]
            found.append({"threads": threads, "tiles_per_second": rate, "wanted": f"≥ {wanted / 1e6:.0f} M tiles/s",
                          "met": rate >= wanted})
    for threads, wanted in case.seconds.items():
        if own := sides.get(f"tegl/{threads}"):
            found.append({"threads": threads, "seconds": own["least"], "wanted": f"≤ {wanted * 1e3:.0f} ms",
                          "met": own["least"] <= wanted})
    for name, side in sides.items():
        if name.startswith("tegl"):
            share = side["extra_bytes"] / row["input_bytes"]
            found.append({"threads": int(name.split("/")[1]), "memory": share, "wanted": "≤ 1/16", "met": share <= 1 / 16})
    return found


def parse_arguments():
    parser = argparse.ArgumentParser(prog="bench/side_by_side", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=machine.ROOT / "build/release", help=argparse.SUPPRESS)
    parser.add_argument("--repetitions", type=int, default=5, metavar="N", help="turns of each side (default: 5)")
    parser.add_argument("--threads", default="1,4", metavar="LIST", help="numbers of threads (default: 1,4)")
    parser.add_argument("--only", default="", metavar="TEXT", help="only fields whose name has TEXT, such as 512³")
    parser.add_argument("--divide", type=float, default=1, metavar="X", help="samples along each axis, divided by X")
    parser.add_argument("--no-skimage", action="store_true", help="without scikit-image, which is slow")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write all figures to FILE")
    options = parser.parse_args()
    options.threads = [int(count) for count in options.threads.split(",")]
    if options.repetitions < 1 or min(options.threads) < 1 or options.divide <= 0:
        parser.error("repetitions, threads and the divisor are positive")
    return options


def main() -> None:
    options = parse_arguments()
    core = Core(options.build)
    result = {"machine": machine.describe(options.build), "vtk": core.library.side_vtk_version().decode(),
              "contourpy": contourpy.__version__, "skimage": skimage.__version__,
              "memory": {threads: core.memory_rates(threads) for threads in options.threads}, "rows": []}
    for case in CASES:
        if options.only not in case.name:
            continue
        row = measure(core, case, options)
        for threads, rates in result["memory"].items():
            set_floor(row, threads, rates)
        row["verdicts"] = verdicts(case, row) if options.divide == 1 else []
        result["rows"].append(row)
        print(f"{case.name}: " + ", ".join(f"{name} {1e3 * side['median']:.1f} ms" for name, side in row["sides"].items()),
              flush=True)
    print("\n".join(["", *machine.lines(result["machine"]), "", *tables.side_by_side(result)]))
    if options.json:
        options.json.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
