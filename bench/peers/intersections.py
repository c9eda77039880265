#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often the triangles of one cube intersect: scikit-image, VTK and tegl on the same random images.

    PYTHONPATH=build/release/python bench/peers/intersections.py [--cells N] [--seed S]

Each image has 2 x 2 x 2 samples. Its signature (the set of samples above the isovalue) is random; the distances of the
samples from the isovalue are uniform, or have a uniform logarithm over three decades. tegl.intersections counts the
pairs of triangles of every program, exactly for the coordinates that the program gives; vertices of equal coordinates
are one vertex. A cell has a tunnel if a component of its triangles is no disc. Prints a table in Markdown.
Needs python3-skimage and python3-vtk9.
"""

import argparse
import sys

import numpy as np
import tegl

try:
    import skimage
    import skimage.measure
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkMarchingCubes
except ImportError as error:
    sys.exit(f"intersections.py: {error}; expected Debian's python3-skimage and python3-vtk9")

DISTANCES = ("uniform", "log-uniform")


def random_cells(count: int, distances: str, seed: int):
    """Values of cells, positive at the high corners; the isovalue is 0."""
    random = np.random.default_rng(seed)
    for signature in random.integers(1, 255, count):
        share = 1.0 - random.random(8)  # in (0, 1]
        values = share if distances == "uniform" else 1e-3 ** share
        yield np.where(signature >> np.arange(8) & 1, values, -values).reshape(2, 2, 2).astype(np.float32)


def by_skimage(method: str):
    def mesh(values):
        points, triangles, _, _ = skimage.measure.marching_cubes(values, 0.0, method=method)
        return points, triangles
    return mesh


def by_vtk(kind):
    def mesh(values):
        image = vtkImageData()
        image.SetDimensions(2, 2, 2)
        image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(), deep=True))
        made = kind()
        made.SetInputData(image)
        made.SetValue(0, 0.0)
        made.ComputeNormalsOff()
        made.Update()
        surface = made.GetOutput()
        return (vtk_to_numpy(surface.GetPoints().GetData()),
                vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3))
    return mesh


def by_tegl(ambiguity: str):
    def mesh(values):
        contour = tegl.contour(values, 0.0, ambiguity=ambiguity)
        return contour.vertices, contour.simplices
    return mesh


def merged(points, triangles):
    """The mesh with one vertex for equal coordinates."""
    points, number = np.unique(np.asarray(points) + 0.0, axis=0, return_inverse=True)
    return points, number[np.asarray(triangles)]


def has_tunnel(triangles) -> bool:
    """Whether the Euler characteristic of a component is not that of a disc."""
    label = {v: v for v in triangles.ravel().tolist()}
    for triangle in triangles.tolist():
        names = {label[v] for v in triangle}
        label = {v: min(names) if name in names else name for v, name in label.items()}
    edges = {tuple(sorted(pair)) for a, b, c in triangles.tolist() for pair in ((a, b), (b, c), (c, a))}
    euler = dict.fromkeys(label.values(), 0)
    for name in label.values():
        euler[name] += 1
    for a, _ in edges:
        euler[label[a]] -= 1
    for a, _, _ in triangles.tolist():
        euler[label[a]] += 1
    return any(count != 1 for count in euler.values())


def measure(mesh, cells) -> dict:
    found = dict(cells=0, triangles=0, tunnels=0, hit=0, pairs=0, flat=0)
    for values in cells:
        points, triangles = merged(*mesh(values))
        report = tegl.intersections(tegl.Contour(points, triangles))
        found["cells"] += 1
        found["triangles"] += len(triangles)
        found["tunnels"] += has_tunnel(triangles)
        found["hit"] += report.count > 0
        found["pairs"] += report.count
        found["flat"] += report.flat
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=100_000, help="random cells for each row (100000)")
    parser.add_argument("--seed", type=int, default=1994)
    arguments = parser.parse_args()
    vtk, sk = vtkVersion().GetVTKVersion(), skimage.__version__
    programs = {f"scikit-image {sk}, `lewiner` (marching cubes 33)": by_skimage("lewiner"),
                f"scikit-image {sk}, `lorensen`": by_skimage("lorensen"),
                f"VTK {vtk}, vtkMarchingCubes": by_vtk(vtkMarchingCubes),
                f"VTK {vtk}, vtkFlyingEdges3D": by_vtk(vtkFlyingEdges3D)}
    programs |= {f"tegl, `{rule}`": by_tegl(rule) for rule in ("low", "decider", "mean", "saddle")}
    print("| program | distances | triangles per cell | cells with a tunnel | cells hit | pairs | flat triangles |")
    print("|---|---|---|---|---|---|---|")
    for name, mesh in programs.items():
        for distances in DISTANCES:
            found = measure(mesh, random_cells(arguments.cells, distances, arguments.seed))
            print(f"| {name} | {distances} | {found['triangles'] / found['cells']:.2f} | {found['tunnels']} | "
                  f"{found['hit']} | {found['pairs']} | {found['flat']} |", flush=True)


if __name__ == "__main__":
    main()
