#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
#
# vtk_reads_test.py WRITER FOLDER: lets WRITER write samples into FOLDER and compares what VTK's own readers make of
# them with what was written.

import pathlib
import subprocess
import sys

from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLUnstructuredGridReader


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def cells(grid):
    return [[grid.GetCell(i).GetPointId(k) for k in range(grid.GetCell(i).GetNumberOfPoints())]
            for i in range(grid.GetNumberOfCells())]


def expect(name, actual, expected):
    if actual != expected:
        sys.exit(f"{name}: {actual}; expected {expected}")


writer, folder = sys.argv[1], pathlib.Path(sys.argv[2])
subprocess.run([writer, folder], check=True)

lines = read(vtkHDFReader(), folder / "lines.vtkhdf")
expect("cells of lines", cells(lines), [[0, 1], [1, 2]])
expect("point of lines", lines.GetPoint(1), (1.0, 0.1, 0.0))
expect("type of lines", lines.GetCellType(0), 3)

surface = read(vtkHDFReader(), folder / "surface.vtkhdf")
expect("cells of surface", cells(surface), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
expect("point of surface", surface.GetPoint(3), (0.0, 0.0, 0.1))
expect("type of surface", surface.GetCellType(3), 5)
expect("normals of surface", surface.GetPointData().GetArray("Normals").GetTuple(1), (1.0, 0.0, 0.0))

contour4 = read(vtkHDFReader(), folder / "contour4.vtkhdf")
expect("cells of contour4", cells(contour4), [[0, 1, 2, 3]])
expect("type of contour4", contour4.GetCellType(0), 10)
t = contour4.GetPointData().GetArray("t")
expect("times of contour4", [t.GetValue(i) for i in range(4)], [7.0, 7.5, 8.0, 9.0])
expect("normals of contour4", contour4.GetPointData().GetArray("Normals").GetTuple(3), (0.6, 0.0, 0.0))
expect("time of normals of contour4", contour4.GetPointData().GetArray("normal_t").GetValue(3), -0.8)

temperature = surface.GetPointData().GetArray("temperature")
expect("temperatures of surface", [temperature.GetValue(i) for i in range(4)], [1.0, 2.0, 3.0, 4.5])
expect("flow of surface", surface.GetPointData().GetArray("flow").GetTuple(3), (1.0, 2.0, 3.0))
label = surface.GetCellData().GetArray("label")
expect("labels of surface", [label.GetValue(i) for i in range(4)], [7.0, 8.0, 9.0, 10.0])
expect("ages of contour4", contour4.GetPointData().GetArray("age").GetValue(3), 4.0)
expect("elements of contour4", contour4.GetCellData().GetArray("dsigma").GetTuple(0), (0.1, 0.2, 0.3, 0.4))

empty = read(vtkHDFReader(), folder / "empty.vtkhdf")
expect("points of empty", empty.GetNumberOfPoints(), 0)
expect("cells of empty", empty.GetNumberOfCells(), 0)

ply = read(vtkPLYReader(), folder / "surface.ply")
expect("cells of ply", cells(ply), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
expect("point of ply", round(ply.GetPoint(3)[2], 6), 0.1)
expect("normal of ply", ply.GetPointData().GetNormals().GetTuple(0), (0.0, 0.0, -1.0))


def values(array):
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def total(grid, measure):
    """The sum of the sizes of all cells, as VTK computes them."""
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    return sum(value for value, in values(sizes.GetOutput().GetCellData().GetArray(measure)))


def expect_near(name, actual, expected):
    if abs(actual - expected) > 1e-9 * expected:
        sys.exit(f"{name}: {actual}; expected {expected}")


# An image, and its contours: plain, across the seam of a periodic axis, unrolled, and on a lattice.
image = read(vtkXMLImageDataReader(), folder / "ball.vti")
expect("sizes of the image", image.GetDimensions(), (12, 14, 16))
expect("steps of the image", image.GetSpacing(), (1 / 12, 1 / 14, 1 / 16))
samples = image.GetPointData().GetScalars()
expect("number of samples", samples.GetNumberOfTuples(), 12 * 14 * 16)
for i in range(0, samples.GetNumberOfTuples(), 37):
    distance = sum((x - 0.5)**2 for x in image.GetPoint(i))**0.5
    expect(f"sample {i}", abs(samples.GetValue(i) - (0.3 - distance)) < 1e-12, True)
ball, wrapped, unrolled, fcc = (read(vtkHDFReader(), folder / f"{name}.vtkhdf")
                                for name in ("ball", "wrapped", "unrolled", "fcc"))
area = total(ball, "Area")
expect("area of a ball", 0.95 * 1.13 < area < 1.14, True)
expect("number of triangles across the seam", wrapped.GetNumberOfCells(), ball.GetNumberOfCells())
expect("number of points across the seam", wrapped.GetNumberOfPoints(), ball.GetNumberOfPoints())
expect("period", values(wrapped.GetFieldData().GetArray("periods"))[:3], [(1.0,), (0.0,), (0.0,)])
expect_near("area of the unrolled ball", total(unrolled, "Area"), area)
expect("more points", unrolled.GetNumberOfPoints() > wrapped.GetNumberOfPoints(), True)
expect("types of cells on a lattice", {fcc.GetCellType(i) for i in range(fcc.GetNumberOfCells())}, {5})

# The contour is a plane, and its facets are what the tiles cut it into: together they have the size of the plane over 4,
# 4 x 4 and 4 x 4 x 4 cells, the polyhedra in the three dimensions that VTK sees of them.
segments = read(vtkXMLUnstructuredGridReader(), folder / "segments.vtu")
expect("type of segments", {segments.GetCellType(i) for i in range(segments.GetNumberOfCells())}, {3})
expect_near("length", total(segments, "Length"), 4 * (1 + 0.4**2)**0.5)

polygons = read(vtkXMLUnstructuredGridReader(), folder / "polygons.vtu")
again = read(vtkHDFReader(), folder / "polygons.vtkhdf")
for grid in (polygons, again):
    expect("type of polygons", {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}, {7})
    expect_near("area", total(grid, "Area"), 16 * (1 + 0.4**2 + 0.3**2)**0.5)
    expect("normals of polygons", grid.GetPointData().GetArray("Normals").GetNumberOfTuples(),
           grid.GetNumberOfPoints())
expect("cells of polygons", cells(again), cells(polygons))
expect("signatures of polygons", values(again.GetCellData().GetArray("signature")),
       values(polygons.GetCellData().GetArray("signature")))
axis_names = polygons.GetFieldData().GetAbstractArray("axis_names")
expect("names of axes", [axis_names.GetValue(i) for i in range(3)], ["", "", "height & <time>"])

polyhedra = read(vtkXMLUnstructuredGridReader(), folder / "polyhedra.vtu")
expect("type of polyhedra", {polyhedra.GetCellType(i) for i in range(polyhedra.GetNumberOfCells())}, {42})
expect_near("volume", total(polyhedra, "Volume"), 64.0)
t = polyhedra.GetPointData().GetArray("t")
for i in range(polyhedra.GetNumberOfPoints()):
    x, y, z = polyhedra.GetPoint(i)
    expect_near("time of a point", t.GetValue(i), 0.37 + 0.4 * x + 0.3 * y + 0.2 * z)
for i in range(polyhedra.GetNumberOfCells()):
    cell = polyhedra.GetCell(i)
    # Closed: each edge is in two faces, once in either direction.
    edges = []
    for f in range(cell.GetNumberOfFaces()):
        ids = cell.GetFace(f).GetPointIds()
        ring = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
        edges += zip(ring, ring[1:] + ring[:1])
    expect("edges of a polyhedron", len(set(edges)), len(edges))
    expect("edges of a polyhedron, reversed", set((b, a) for a, b in edges), set(edges))

nothing = read(vtkXMLUnstructuredGridReader(), folder / "nothing.vtu")
expect("cells of nothing", nothing.GetNumberOfCells(), 0)
# Single precision: float coordinates and vertex numbers of 32 bits; and compressed arrays.
FLOAT = 10  # VTK_FLOAT
surface_float = read(vtkHDFReader(), folder / "surface_float.vtkhdf")
expect("cells of surface_float", cells(surface_float), cells(surface))
expect("type of its points", surface_float.GetPoints().GetDataType(), FLOAT)
expect("point of surface_float", round(surface_float.GetPoint(3)[2], 6), 0.1)
expect("normals of surface_float", surface_float.GetPointData().GetArray("Normals").GetTuple(1), (1.0, 0.0, 0.0))
expect("flow of surface_float", surface_float.GetPointData().GetArray("flow").GetTuple(3), (1.0, 2.0, 3.0))
ply_float = read(vtkPLYReader(), folder / "surface_float.ply")
expect("cells of ply_float", cells(ply_float), cells(ply))
contour4_float = read(vtkHDFReader(), folder / "contour4_float.vtkhdf")
expect("cells of contour4_float", cells(contour4_float), cells(contour4))
times = contour4_float.GetPointData().GetArray("t")
expect("times of contour4_float", [times.GetValue(i) for i in range(4)], [7.0, 7.5, 8.0, 9.0])
polygons_float = read(vtkHDFReader(), folder / "polygons_float.vtkhdf")
expect("cells of polygons_float", cells(polygons_float), cells(polygons))

packed = read(vtkXMLUnstructuredGridReader(), folder / "polyhedra_packed.vtu")
expect("cells of polyhedra_packed", cells(packed), cells(polyhedra))
expect("points of polyhedra_packed", [packed.GetPoint(i) for i in range(packed.GetNumberOfPoints())],
       [polyhedra.GetPoint(i) for i in range(polyhedra.GetNumberOfPoints())])
for name in ("polyhedra_float", "polyhedra_float_packed"):
    single = read(vtkXMLUnstructuredGridReader(), folder / f"{name}.vtu")
    expect(f"cells of {name}", cells(single), cells(polyhedra))
    expect(f"faces of {name}", [single.GetCell(i).GetNumberOfFaces() for i in range(single.GetNumberOfCells())],
           [polyhedra.GetCell(i).GetNumberOfFaces() for i in range(polyhedra.GetNumberOfCells())])
    expect(f"type of points of {name}", single.GetPoints().GetDataType(), FLOAT)
nothing = read(vtkXMLUnstructuredGridReader(), folder / "nothing_packed.vtu")
expect("cells of nothing_packed", nothing.GetNumberOfCells(), 0)
print("VTK reads 25 files as written")
