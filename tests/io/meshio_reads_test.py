#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
#
# meshio_reads_test.py WRITER FOLDER: lets WRITER write samples into FOLDER and compares what meshio makes of the STL and
# OBJ files with what it makes of the PLY file of the same contour.

import collections
import pathlib
import subprocess
import sys

import meshio
import numpy as np


def triangles(name):
    """#S x 3 corners x 3 coordinates."""
    mesh = meshio.read(folder / name)
    return mesh.points[mesh.cells_dict["triangle"]]


def volume(corners):
    """What a closed surface encloses: positive where its triangles run counter-clockwise seen from outside."""
    return np.einsum("si,si->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


def expect(name, holds, actual):
    if not holds:
        sys.exit(f"{name}: {actual}")


writer, folder = sys.argv[1], pathlib.Path(sys.argv[2])
subprocess.run([writer, folder], check=True)

whole = triangles("noise.ply")
expect("triangles", len(whole) > 3000, len(whole))
expect("volume of high samples", volume(whole) > 100, volume(whole))

obj = meshio.read(folder / "noise.obj")
ply = meshio.read(folder / "noise.ply")
expect("points of OBJ", np.array_equal(obj.points, ply.points), abs(obj.points - ply.points).max())
expect("triangles of OBJ", np.array_equal(obj.cells_dict["triangle"], ply.cells_dict["triangle"]), "others than of PLY")
normals = np.stack([ply.point_data[name] for name in ("nx", "ny", "nz")], axis=1)
expect("normals of OBJ", np.array_equal(obj.point_data["obj:vn"], normals), "others than of PLY")

stl = triangles("noise.stl")
expect("triangles of STL", np.array_equal(stl, whole.astype(np.float32)), "others than of PLY, as float")
expect("volume of STL", abs(volume(stl) / volume(whole) - 1) < 1e-6, (volume(stl), volume(whole)))
expect("size of STL", (folder / "noise.stl").stat().st_size == 84 + 50 * len(whole), (folder / "noise.stl").stat().st_size)
edges = collections.Counter()
for triangle in map(lambda corners: [tuple(corner) for corner in corners], stl.tolist()):
    edges.update(zip(triangle, triangle[1:] + triangle[:1]))
expect("edges of STL", all(edges[a, b] == edges[b, a] for a, b in edges), "one is not in as many triangles each way")
# The record of a triangle: normal, corners, two bytes. Read as the format says, not by meshio, which drops the normals.
record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("zero", "<u2")])
data = (folder / "noise.stl").read_bytes()
expect("beginning of STL", not data.startswith(b"solid"), data[:80])
records = np.frombuffer(data[84:], record)
expect("count of STL", int.from_bytes(data[80:84], "little") == len(records), data[80:84])
corners = records["corners"].astype(float)
across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
across /= np.linalg.norm(across, axis=1)[:, None]
expect("normals of STL", abs(records["normal"] - across).max() < 1e-6, abs(records["normal"] - across).max())
expect("end of each triangle", not records["zero"].any(), records["zero"].max())
expect("size of the empty STL", (folder / "empty.stl").stat().st_size == 84, (folder / "empty.stl").stat().st_size)

lines = [line.split() for line in (folder / "lines.obj").read_text().splitlines() if not line.startswith("#")]
expect("lines of OBJ", lines == [["v", "0", "0", "0"], ["v", "1", "0.1", "0"], ["v", "2", "3", "0"], ["l", "1", "2"],
                                 ["l", "2", "3"]], lines)
print(f"{len(whole)} triangles in PLY, STL and OBJ")
