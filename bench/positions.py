#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of masks by tegl and by VTK's windowed sinc: distance from tilted planes, volume of balls, wrong samples.

    PYTHONPATH=build/release/python bench/positions.py

Prints CSV. VTK: vtkFlyingEdges3D, then vtkWindowedSincPolyDataFilter with 20 iterations and several pass bands
(Debian: python3-vtk9). A sample is wrong if it is on the other side of the surface than its value.
"""

import numpy as np
import tegl
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def vtk_surface(mask, pass_band):
    image = vtk.vtkImageData()
    image.SetDimensions(*mask.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(mask.ravel(), deep=True))
    contour = vtk.vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.5)
    last = contour
    if pass_band:
        last = vtk.vtkWindowedSincPolyDataFilter()
        last.SetInputConnection(contour.GetOutputPort())
        last.SetNumberOfIterations(20)
        last.SetPassBand(pass_band)
        last.NonManifoldSmoothingOn()
        last.NormalizeCoordinatesOn()
    last.Update()
    return last.GetOutput()


def wrong_samples(surface, mask):
    """Samples near the surface whose side differs from their value."""
    near = np.zeros(mask.shape, bool)
    for axis in range(3):
        differ = np.diff(mask.astype(int), axis=axis) != 0
        low, high = [slice(None)] * 3, [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        near[tuple(low)] |= differ
        near[tuple(high)] |= differ
    places = np.argwhere(near)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(places[:, ::-1].astype(float), deep=True))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    enclosed = vtk.vtkSelectEnclosedPoints()
    enclosed.SetTolerance(1e-9)
    enclosed.SetInputData(data)
    enclosed.SetSurfaceData(surface)
    enclosed.Update()
    inside = vtk_to_numpy(enclosed.GetOutput().GetPointData().GetArray("SelectedPoints")) != 0
    return int(np.sum(inside != (mask[tuple(places.T)] != 0)))


def polydata(contour):
    result, points, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetData(numpy_to_vtk(contour.vertices[:, ::-1].astype(float), deep=True))
    for triangle in contour.simplices:
        cells.InsertNextCell(3, [int(v) for v in triangle])
    result.SetPoints(points)
    result.SetPolys(cells)
    return result


def surfaces(mask):
    for rule in ("linear", "gravitation", "relaxed"):
        yield f"tegl {rule}", polydata(tegl.contour(mask, 0.5, positions=rule, dtype=np.float64))
    for pass_band in (0.1, 0.03, 0.01, 0.003):
        yield f"VTK windowed sinc {pass_band}", vtk_surface(mask, pass_band)


def volume_of(surface):
    mass = vtk.vtkMassProperties()
    mass.SetInputData(surface)
    mass.Update()
    return mass.GetVolume()


def main():
    print("shape,surface,root mean square distance,volume error in percent,wrong samples")
    z, y, x = np.indices((64, 64, 64)).astype(float)
    for degrees in (2, 15, 30, 44):
        angle, turn = np.radians(degrees), np.radians(7)
        normal = np.array([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)])
        height = normal[0] * (x - 32) + normal[1] * (y - 32) + normal[2] * (z - 32) - 0.3
        for name, surface in surfaces((height < 0).astype(np.uint8)):
            points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
            inner = np.all(np.abs(points - 32) < 24, axis=1)
            distances = (points[inner] - 32) @ normal - 0.3
            print(f"plane {degrees} degrees,{name},{np.sqrt(np.mean(distances ** 2)):.3f},,")
    for radius in (5, 20):
        size = 2 * radius + 12
        z, y, x = np.indices((size, size, size)).astype(float)
        for shift in (0.13, 0.41):
            c = size / 2 - shift
            distance = np.sqrt((x - c) ** 2 + (y - c - 0.2) ** 2 + (z - c + 0.1) ** 2)
            mask = (distance <= radius).astype(np.uint8)
            for name, surface in surfaces(mask):
                points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float) - [c, c + 0.2, c - 0.1]
                error = np.sqrt(np.mean((np.linalg.norm(points, axis=1) - radius) ** 2))
                volume = 100 * (volume_of(surface) / (4 / 3 * np.pi * radius ** 3) - 1)
                print(f"ball {radius} at {shift},{name},{error:.3f},{volume:.2f},{wrong_samples(surface, mask)}")


if __name__ == "__main__":
    main()
