#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fewer triangles: tegl against VTK's vtkQuadricDecimation and vtkDecimatePro, and against meshoptimizer.

    bench/peers/simplify.py PROGRAM [--samples N] [--ratio R] [--turns N]

PROGRAM is `tegl`. All sides get the same triangles (contours of fields of N^3 samples) and the same target, one thread,
and take turns, so that other work on the machine disturbs all of them. tegl measures itself (`seconds` of its report);
the others run in this process. Needs python3-vtk9 and libmeshoptimizer. Prints a table in Markdown: least seconds,
triangles left, and the number of edges that are not in exactly two triangles.
"""

import argparse
import ctypes
import ctypes.util
import json
import pathlib
import subprocess
import tempfile
import time

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkQuadricDecimation
from vtkmodules.vtkIOPLY import vtkPLYReader


def gyroid(x, y, z):
    a, b, c = 9 * x, 9 * y, 9 * z
    return np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a) + 3.0 * (x * x + y * y + z * z > 1)


def rough(x, y, z):
    waves = np.random.default_rng(1)
    result = 1.2 - 2.0 * np.sqrt(x * x + y * y + z * z)
    for _ in range(40):
        a, b, c, shift = waves.uniform(-25, 25, 4)
        result = result + 0.08 * np.sin(a * x + b * y + c * z + shift)
    return result


FIELDS = {"gyroid": gyroid, "rough ball": rough}


def write_image(path, field, samples):
    z, y, x = np.meshgrid(*[np.linspace(-1.0, 1.0, samples)] * 3, indexing="ij")
    header = f"NRRD0004\ntype: float\ndimension: 3\nsizes: {samples} {samples} {samples}\nendian: little\nencoding: raw\n\n"
    path.write_bytes(header.encode() + field(x, y, z).astype("<f4").tobytes())


def read_triangles(path):
    reader = vtkPLYReader()
    reader.SetFileName(str(path))
    reader.Update()
    mesh = reader.GetOutput()
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return vtk_to_numpy(mesh.GetPoints().GetData()).astype(np.float32), triangles.astype(np.uint32)


def bad_edges(triangles):
    """Number of edges that are not in exactly two triangles."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64))
    return int(np.count_nonzero(np.unique(edges[:, 0] << 32 | edges[:, 1], return_counts=True)[1] != 2))


def by_vtk(make):
    def run(points, triangles, count):
        data = vtkPolyData()
        at = vtkPoints()
        at.SetData(numpy_to_vtk(points, deep=True))
        data.SetPoints(at)
        cells = vtkCellArray()
        offsets = numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64), deep=True)
        cells.SetData(offsets, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
        data.SetPolys(cells)
        decimation = make()
        decimation.SetInputData(data)
        decimation.SetTargetReduction(1.0 - count / len(triangles))
        start = time.perf_counter()
        decimation.Update()
        seconds = time.perf_counter() - start
        return seconds, vtk_to_numpy(decimation.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return run


def decimate_pro():
    decimation = vtkDecimatePro()
    decimation.PreserveTopologyOn()
    return decimation


def by_meshoptimizer(points, triangles, count):
    library = ctypes.CDLL(ctypes.util.find_library("meshoptimizer") or "libmeshoptimizer.so")
    simplify = library.meshopt_simplify
    simplify.restype = ctypes.c_size_t
    size, pointer = ctypes.c_size_t, ctypes.c_void_p
    simplify.argtypes = [pointer, pointer, size, pointer, size, size, size, ctypes.c_float, ctypes.c_uint, pointer]
    points, result = np.ascontiguousarray(points), np.empty(triangles.size, np.uint32)
    start = time.perf_counter()
    left = simplify(result.ctypes.data, triangles.ctypes.data, triangles.size, points.ctypes.data, len(points), 12,
                    3 * count, 1e9, 0, None)
    return time.perf_counter() - start, result[:left].reshape(-1, 3)


def by_tegl(program, mesh, ratio, folder, *options):
    def run(_points, _triangles, _count):
        report = subprocess.run([program, "simplify", mesh, "--ratio", str(ratio), "--threads", "1", "--no-check", *options,
                                 "--json", "-o", folder / "small.ply"], check=True, capture_output=True, text=True)
        seconds = json.loads(report.stdout)["seconds"]
        return seconds["simplify"] + seconds["bound"], read_triangles(folder / "small.ply")[1]
    return run


def compare(name, args, folder):
    write_image(folder / "image.nrrd", FIELDS[name], args.samples)
    mesh = folder / "mesh.ply"
    subprocess.run([args.program, "contour", folder / "image.nrrd", "--iso", "0", "--close", "--quiet", "-o", mesh],
                   check=True)
    points, triangles = read_triangles(mesh)
    count = int(args.ratio * len(triangles))
    sides = {"tegl, `--no-bound`": by_tegl(args.program, mesh, args.ratio, folder, "--no-bound"),
             "tegl, with bound": by_tegl(args.program, mesh, args.ratio, folder),
             "vtkQuadricDecimation": by_vtk(vtkQuadricDecimation),
             "vtkDecimatePro, topology kept": by_vtk(decimate_pro),
             "meshoptimizer": by_meshoptimizer}
    least, left = dict.fromkeys(sides, float("inf")), {}
    for _ in range(args.turns):
        for side, run in sides.items():
            seconds, result = run(points, triangles, count)
            least[side] = min(least[side], seconds)
            left[side] = (len(result), bad_edges(result))
    first = least["tegl, `--no-bound`"]
    for side in sides:
        print(f"| {name}, {len(triangles)} | {side} | {least[side]:.2f} | {least[side] / first:.2f} | {left[side][0]} | "
              f"{left[side][1]} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="tegl")
    parser.add_argument("--samples", type=int, default=160)
    parser.add_argument("--ratio", type=float, default=0.2)
    parser.add_argument("--turns", type=int, default=3)
    args = parser.parse_args()
    print("| contour, triangles | side | seconds | times tegl's | triangles left | bad edges |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in FIELDS:
            compare(name, args, pathlib.Path(folder))


if __name__ == "__main__":
    main()
