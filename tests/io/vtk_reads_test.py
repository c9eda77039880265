#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
#
# vtk_reads_test.py WRITER FOLDER: lets WRITER write samples into FOLDER and compares what VTK's own readers make of
# them with what was written.

import pathlib
import subprocess
import sys

from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOPLY import vtkPLYReader


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
print("VTK reads 5 files as written")
