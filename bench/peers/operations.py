#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Operations on a surface: tegl against VTK's filters, on the same triangles.

    bench/peers/operations.py [--samples N] [--turns N]

Needs the Python packages of tegl (on the PYTHONPATH; a release build) and VTK. The surfaces are contours of fields of N^3
samples, closed. All filters use one thread, and take turns, so that other work on the machine disturbs both sides. Prints a table
in Markdown: the least time of each side, their ratio, and a result of each side that has to agree. A ratio above 1 means
that tegl is faster. bench/peers/simplify.py compares simplification.
"""

import argparse
import time

import numpy as np
import tegl
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkSMPTools
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPlane, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCutter, vtkFeatureEdges, vtkMassProperties, vtkPlaneCutter
from vtkmodules.vtkFiltersCore import vtkPolyDataConnectivityFilter, vtkProbeFilter


def axes(samples):
    return np.meshgrid(*[np.linspace(-1.0, 1.0, samples)] * 3, indexing="ij")


def gyroid(z, y, x):
    a, b, c = 9 * x, 9 * y, 9 * z
    return np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a)


def balls(z, y, x):
    places = np.random.default_rng(1)
    result = np.full(x.shape, -1.0)
    for _ in range(200):
        a, b, c = places.uniform(-0.9, 0.9, 3)
        radius = places.uniform(0.02, 0.12)
        np.maximum(result, radius - np.sqrt((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2), out=result)
    return result


FIELDS = {"gyroid": gyroid, "200 balls": balls}


def polydata(contour):
    data, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(contour.vertices), deep=True))
    data.SetPoints(points)
    triangles = contour.simplices.astype(np.int64)
    offsets = numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64), deep=True)
    cells.SetData(offsets, numpy_to_vtkIdTypeArray(triangles.ravel(), deep=True))
    data.SetPolys(cells)
    return data


def image_data(values):
    """Samples with the indices as coordinates, the first axis as x, as the contour's vertices have them."""
    image = vtkImageData()
    image.SetDimensions(*values.shape)
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(order="F"), deep=True))
    return image


def plane(middle):
    result = vtkPlane()
    result.SetOrigin(*middle)
    result.SetNormal(*NORMAL)
    return result


NORMAL = (0.36, 0.48, 0.8)


class Vtk:
    """Each function returns a filter, and what to read of it after its update."""

    def __init__(self, contour, values):
        self.data, self.image = polydata(contour), image_data(values)
        self.middle = contour.vertices.mean(axis=0)

    def components(self):
        regions = vtkPolyDataConnectivityFilter()
        regions.SetInputData(self.data)
        regions.SetExtractionModeToAllRegions()
        regions.ColorRegionsOn()
        return regions, regions.GetNumberOfExtractedRegions

    def measure(self):
        mass = vtkMassProperties()
        mass.SetInputData(self.data)
        return mass, mass.GetSurfaceArea

    def check(self):
        edges = vtkFeatureEdges()
        edges.SetInputData(self.data)
        edges.BoundaryEdgesOn()
        edges.NonManifoldEdgesOn()
        edges.FeatureEdgesOff()
        edges.ManifoldEdgesOff()
        return edges, lambda: edges.GetOutput().GetNumberOfCells()

    def cut(self):
        cutter = vtkCutter()
        cutter.SetInputData(self.data)
        cutter.SetCutFunction(plane(self.middle))
        return cutter, lambda: cutter.GetOutput().GetNumberOfCells()

    def cut_by_trees(self):
        cutter = vtkPlaneCutter()
        cutter.SetInputData(self.data)
        cutter.SetPlane(plane(self.middle))
        return cutter, lambda: parts(cutter.GetOutput())

    def probe(self):
        probe = vtkProbeFilter()
        probe.SetInputData(self.data)
        probe.SetSourceData(self.image)
        return probe, lambda: float(vtk_to_numpy(probe.GetOutput().GetPointData().GetScalars()).std())


def parts(output):
    """Cells of the pieces that vtkPlaneCutter returns, one for each thread."""
    if hasattr(output, "GetNumberOfPartitions"):
        return sum(output.GetPartition(i).GetNumberOfCells() for i in range(output.GetNumberOfPartitions()))
    return output.GetNumberOfCells()


class Tegl:
    def __init__(self, contour, values):
        self.contour, self.values, self.probes = contour, values, 0
        self.offset = float(np.dot(NORMAL, contour.vertices.mean(axis=0)))

    def components(self):
        return len(self.contour.components(threads=1))

    def measure(self):
        return self.contour.measure(threads=1).size

    def check(self):
        found = self.contour.check(threads=1)
        return found.boundary_simplices + found.nonmanifold_simplices

    def cut(self):
        return len(self.contour.slice(normal=NORMAL, offset=self.offset, threads=1).simplices)

    def probe(self):
        self.probes += 1
        self.contour.sample(self.values, f"values {self.probes}", threads=1)
        return lambda: float(self.contour.vertex_attributes[f"values {self.probes}"].std())


PAIRS = (("parts of the surface", "components", "vtkPolyDataConnectivityFilter", "components"),
         ("area and volume", "measure", "vtkMassProperties", "measure"),
         ("closed and manifold", "check", "vtkFeatureEdges", "check"),
         ("oblique cut", "slice", "vtkCutter", "cut"),
         ("oblique cut", "slice", "vtkPlaneCutter", "cut_by_trees"),
         ("values of an image at the vertices", "sample", "vtkProbeFilter", "probe"))


def timed(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result() if callable(result) else result


def by_vtk(vtk, name):
    made, read = getattr(vtk, name)()
    start = time.perf_counter()
    made.Update()
    return time.perf_counter() - start, read()


def compare(name, args):
    values = FIELDS[name](*axes(args.samples)).astype(np.float32)
    contour = tegl.contour(values, 0.0, close=True)
    other = gyroid(*axes(args.samples))  # to be sampled on the surface
    ours, theirs = Tegl(contour, other), Vtk(contour, other)
    for what, operation, peer, attribute in PAIRS:
        least = [float("inf")] * 2
        for _ in range(args.turns):
            one, result = timed(getattr(ours, "cut" if attribute == "cut_by_trees" else attribute))
            two, peers = by_vtk(theirs, attribute)
            least = [min(least[0], one), min(least[1], two)]
        print(f"| {name}, {len(contour.simplices)} | {what} | `{operation}` | {1e3 * least[0]:.1f} | {peer} | "
              f"{1e3 * least[1]:.1f} | {least[1] / least[0]:.1f} | {result:.8g} | {peers:.8g} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--turns", type=int, default=5)
    args = parser.parse_args()
    vtkSMPTools.Initialize(1)
    print("| surface, triangles | operation | tegl | ms | VTK | ms | ratio | result | VTK's result |\n" + "|---" * 9 + "|")
    for name in FIELDS:
        compare(name, args)


if __name__ == "__main__":
    main()
