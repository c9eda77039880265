#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Contours of tetrahedral meshes: tegl against VTK's vtkContour3DLinearGrid and vtkContourFilter; with --polyhedra of
truncated octahedra that fill space, against vtkContourFilter.

    bench/mesh_contours.py [--program PROGRAM] [--cubes N | --polyhedra N] [--turns N] [--threads N] [--json FILE]

All sides get the same mesh (N^3 cubes of 6 tetrahedra each, points moved at random; or 2 N^3 truncated octahedra) with
the same float values, and take turns, so that what disturbs the machine meets all. tegl runs as a child process
(mesh_contours.cpp) and measures itself.
Prints medians of milliseconds as a table in Markdown: with one thread milliseconds of processor time, which other
programs hardly influence. VTK: points merged, no normals, as tegl's vertices are shared, too;
and with points not merged, its default. One thread: sequential processing; more: VTK's own number. With --json, also
runs lattice_bench (of lattices, also in 4D, and of curved and periodic grids) and mixed_meshes beside PROGRAM, and writes all
figures to FILE.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import numpy as np

import machine

ROOT = pathlib.Path(__file__).resolve().parent.parent


def kuhn(cubes: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points in [-1, 1]^3, moved by up to 0.15 steps, and 6 tetrahedra for each cube."""
    n = cubes + 1
    axis = np.linspace(-1.0, 1.0, n)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    points = np.stack([x, y, z], axis=-1)
    move = np.random.default_rng(seed).uniform(-0.3 / cubes, 0.3 / cubes, points.shape)
    points[1:-1, 1:-1, 1:-1] += move[1:-1, 1:-1, 1:-1]
    k, j, i = np.meshgrid(*[np.arange(cubes)] * 3, indexing="ij")
    base = (i + n * (j + n * k)).ravel()
    step = [1, n, n * n]
    cells = []
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
        p = base + step[a]
        q = p + step[b]
        corners = [base, p, q, q + step[c]]
        if (a, b, c) in ((0, 2, 1), (2, 1, 0), (1, 0, 2)):
            corners[2], corners[3] = corners[3], corners[2]
        cells.append(np.stack(corners, axis=-1))
    return points.reshape(-1, 3), np.stack(cells, axis=1).reshape(-1, 4).astype(np.uint32)


def truncated_octahedra(count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points in [-1, 1]^3, moved by up to 0.1 edges, and of each cell its faces in one row, as VTK wants them."""
    signs = [(s, t, u) for s in (1, -1) for t in (1, -1) for u in (1, -1)]
    ring = [(0, 1, 2), (1, 0, 2), (2, 0, 1), (2, 1, 0), (1, 2, 0), (0, 2, 1)]
    faces = [np.array(ring) * sign for sign in signs]
    square = np.array([(0, 1), (1, 0), (0, -1), (-1, 0)])
    for axis in range(3):
        faces += [np.insert(square, axis, side, axis=1) for side in (2, -2)]
    i, j, k = np.meshgrid(*[np.arange(2 * count)] * 3, indexing="ij")
    same = (i % 2 == j % 2) & (i % 2 == k % 2)
    centres = 2 * np.stack([i[same], j[same], k[same]], axis=-1)
    corners = (centres[:, None] + np.concatenate(faces)[None]).reshape(-1, 3)
    places, numbers = np.unique(corners, axis=0, return_inverse=True)
    numbers = numbers.reshape(len(centres), -1)
    columns, at = [np.full((len(centres), 1), len(faces))], 0
    for face in faces:
        columns += [np.full((len(centres), 1), len(face)), numbers[:, at:at + len(face)]]
        at += len(face)
    points = (places - (2 * count - 1)) + np.random.default_rng(seed).uniform(-0.1, 0.1, places.shape)
    return points / (2 * count + 1), np.hstack(columns).astype(np.uint32)


FIELDS = {
    "sphere": lambda p: 0.7 - np.linalg.norm(p, axis=1),
    "gyroid": lambda p: sum(np.sin(12 * p[:, i]) * np.cos(12 * p[:, (i + 1) % 3]) for i in range(3)),
}


def vtk_grid(points: np.ndarray, cells: np.ndarray, values: np.ndarray):
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
    grid = vtkUnstructuredGrid()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
    grid.SetPoints(coordinates)
    if cells.shape[1] > 4:
        from vtkmodules.vtkCommonCore import vtkIdList
        from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON
        grid.Allocate(len(cells))
        stream = vtkIdList()
        stream.SetNumberOfIds(cells.shape[1])
        for cell in cells.tolist():
            for place, number in enumerate(cell):
                stream.SetId(place, number)
            grid.InsertNextCell(VTK_POLYHEDRON, stream)
        return with_scalars(grid, values)
    array = vtkCellArray()
    offsets = numpy_to_vtkIdTypeArray(np.arange(0, 4 * len(cells) + 1, 4, dtype=np.int64), deep=True)
    array.SetData(offsets, numpy_to_vtkIdTypeArray(cells.astype(np.int64).ravel(), deep=True))
    grid.SetCells(VTK_TETRA, array)
    return with_scalars(grid, values)


def with_scalars(grid, values: np.ndarray):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    scalars = numpy_to_vtk(values, deep=True)
    scalars.SetName("f")
    grid.GetPointData().SetScalars(scalars)
    return grid


def vtk_sides(grid, threads: int, has_polyhedra: bool) -> dict:
    from vtkmodules.vtkFiltersCore import vtkContour3DLinearGrid, vtkContourFilter

    def linear(merge: bool):
        contour = vtkContour3DLinearGrid()
        contour.SetInputData(grid)
        contour.SetValue(0, 0.0)
        contour.SetMergePoints(merge)
        contour.SetComputeNormals(False)
        contour.SetInterpolateAttributes(False)
        contour.SetSequentialProcessing(threads == 1)
        return contour

    plain = vtkContourFilter()
    plain.SetInputData(grid)
    plain.SetValue(0, 0.0)
    plain.ComputeNormalsOff()
    plain.ComputeScalarsOff()
    if has_polyhedra:
        return {"vtkContourFilter": plain}
    return {"vtkContour3DLinearGrid": linear(True), "vtkContour3DLinearGrid, points not merged": linear(False),
            "vtkContourFilter": plain}


def run_vtk(contour, threads: int) -> tuple[float, int, int]:
    clock = time.process_time if threads == 1 else time.perf_counter
    contour.Modified()
    start = clock()
    contour.Update()
    elapsed = 1e3 * (clock() - start)
    out = contour.GetOutput()
    return elapsed, out.GetNumberOfPoints(), out.GetNumberOfCells()


class Tegl:
    """The child process."""

    def __init__(self, program: str, points: np.ndarray, cells: np.ndarray, values: np.ndarray, threads: int):
        with tempfile.NamedTemporaryFile(delete=False) as file:
            has_polyhedra = cells.shape[1] > 4
            np.array([len(points), len(cells), cells.size if has_polyhedra else 0], dtype=np.uint64).tofile(file)
            points.astype(np.float32).astype(np.float64).tofile(file)
            cells.tofile(file)
            values.tofile(file)
            self.path = file.name
        self.process = subprocess.Popen([program, self.path, str(threads)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)

    def run(self, command: str) -> tuple[float, int, int]:
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        elapsed, vertices, simplices = self.process.stdout.readline().split()
        return float(elapsed), int(vertices), int(simplices)

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        os.unlink(self.path)


def measure(options: argparse.Namespace, name: str, points: np.ndarray, cells: np.ndarray) -> dict:
    values = FIELDS[name](points).astype(np.float32)
    tegl = Tegl(options.program, points, cells, values, options.threads)
    vtk = vtk_sides(vtk_grid(points, cells, values), options.threads, cells.shape[1] > 4)
    sides = {label: lambda command=command: tegl.run(command)
             for label, command in (("tegl", "plain"), ("tegl, edges known", "known"), ("tegl, finding edges", "edges"))}
    sides |= {label: lambda contour=contour: run_vtk(contour, options.threads) for label, contour in vtk.items()}
    times = {label: [] for label in sides}
    sizes = {}
    for turn in range(options.turns + 1):  # the first is a rehearsal
        for label, run in sides.items():
            elapsed, vertices, simplices = run()
            sizes[label] = vertices, simplices
            if turn > 0:
                times[label].append(elapsed)
    tegl.close()
    median = {label: statistics.median(of) for label, of in times.items()}
    kind = "polyhedra" if cells.shape[1] > 4 else "tetrahedra"
    print(f"\n{name}: {len(cells)} {kind}, {options.threads} thread(s), medians of {options.turns}\n")
    print("| side | ms | quartiles | vertices | triangles | tegl is as fast | with edges known |\n|---|---|---|---|---|---|---|")
    for label, of in times.items():
        low, _, high = statistics.quantiles(of, n=4)
        print(f"| {label} | {median[label]:.2f} | {low:.2f} – {high:.2f} | {sizes[label][0]} | {sizes[label][1]} | "
              f"{median[label] / median['tegl']:.1f}x | {median[label] / median['tegl, edges known']:.1f}x |")
    return {"field": name, kind: len(cells), "threads": options.threads, "turns": options.turns,
            "sides": [{"side": label, "ms": round(median[label], 3), "vertices": sizes[label][0],
                       "triangles": sizes[label][1]} for label in sides]}


def rows_of(program: pathlib.Path, *arguments: str) -> list:
    """The table in Markdown that a program prints, as a list of rows by column."""
    lines = subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout.splitlines()
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return [dict(zip(table[0], row)) for row in table[2:]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bench/mesh_contours"))
    parser.add_argument("--cubes", type=int, default=60)
    parser.add_argument("--polyhedra", type=int)
    parser.add_argument("--turns", type=int, default=11)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    points, cells = truncated_octahedra(options.polyhedra) if options.polyhedra else kuhn(options.cubes)
    from vtkmodules.vtkCommonCore import vtkVersion
    print(f"VTK {vtkVersion.GetVTKVersion()}")
    meshes = [measure(options, name, points, cells) for name in FIELDS]
    if options.json is None:
        return
    folder = pathlib.Path(options.program).resolve().parent
    result = {"machine": machine.describe(folder.parent), "vtk": vtkVersion.GetVTKVersion(), "meshes": meshes,
              "lattices": rows_of(folder / "lattice_bench", "160"),
              "lattices in 4D": rows_of(folder / "lattice_bench", "4d"),
              "curved and periodic grids": rows_of(folder / "lattice_bench", "curved"),
              "types of cells": rows_of(folder / "mixed_meshes")}
    options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
