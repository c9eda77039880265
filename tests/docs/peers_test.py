#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What docs/coming-from.md says of VTK 9.1 and scikit-image 0.19.3, shown by them, beside tegl on the same samples.

    peers_test.py BIN         exit status 77 where python3-vtk9 or python3-skimage, or these versions, are not there
"""

import collections
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import skimage
    from skimage.measure import find_contours, marching_cubes
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkMarchingCubes
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


def contour_by(kind, values, level):
    """Points, triangles and normals of a VTK filter; values[z, y, x]."""
    image = vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(), deep=True))
    made = kind()
    made.SetInputData(image)
    made.SetValue(0, level)
    made.ComputeNormalsOn()
    made.Update()
    mesh = made.GetOutput()
    return (vtk_to_numpy(mesh.GetPoints().GetData()), vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3),
            vtk_to_numpy(mesh.GetPointData().GetNormals()))


def edges(triangles):
    """How many edges have one triangle, and how many more than two."""
    count = collections.Counter(tuple(sorted(edge)) for a, b, c in triangles.tolist() for edge in ((a, b), (b, c), (c, a)))
    return sum(n == 1 for n in count.values()), sum(n > 2 for n in count.values())


def volume(points, triangles):
    """Positive where right-hand normals point out."""
    a, b, c = (points[triangles[:, corner]].astype(float) for corner in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def by_tegl(programs, values, level):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "values.raw"
        values.astype("f4").tofile(file)
        mesh = file.with_suffix(".vtkhdf")
        sizes = "x".join(str(size) for size in values.shape[::-1])
        subprocess.run([f"{programs}/tegl", "contour", file, "--raw", sizes, "--raw-type", "float", "--iso", str(level), "-q",
                        "-o", mesh], check=True)
        run = lambda *command: json.loads(subprocess.run([f"{programs}/tegl", *command, mesh, "--json"], check=True, text=True,
                                                         capture_output=True).stdout)
        return run("check"), run("measure")


def orientation(programs):
    z, y, x = np.mgrid[:24, :24, :24]
    middle = np.array([11.3, 11.6, 11.9])
    ball = (8 - np.sqrt((x - middle[0]) ** 2 + (y - middle[1]) ** 2 + (z - middle[2]) ** 2)).astype("f4")
    report, measures = by_tegl(programs, ball, 0)
    points, triangles, normals = contour_by(vtkFlyingEdges3D, ball, 0)
    assert (len(points), len(triangles)) == (report["vertices"], report["simplices"]), "VTK has as many as tegl"
    assert np.all(np.einsum("ij,ij->i", normals, points - middle) > 0), "VTK's normals point to low"
    assert np.isclose(volume(points, triangles), measures["content"], rtol=1e-3), "and its triangles face low"
    assert points.dtype == np.float32 and triangles.dtype == np.int64
    points, triangles, _, _ = marching_cubes(ball, 0)
    assert np.isclose(volume(points[:, ::-1], triangles), measures["content"], rtol=1e-3), "in x, y, z: low"
    assert volume(points, triangles) < 0, "in the array's order of axes: high"
    assert points.dtype == np.float32 and triangles.dtype == np.int32


def what_is_high():
    one = np.zeros((3, 3, 3), dtype="f4")
    one[1, 1, 1] = 1
    assert len(contour_by(vtkFlyingEdges3D, one, 1.0)[1]) == 8, "VTK: a sample at the value is high"
    try:
        found = len(marching_cubes(one, 1.0)[1])
    except RuntimeError:
        found = 0  # "No surface found at the given iso value."
    assert found == 0, "scikit-image: a sample at the level is low"


def ties(programs):
    values = np.pad(np.random.default_rng(1).integers(0, 3, (12, 12, 12)), 1, constant_values=-1).astype("f4")
    assert edges(contour_by(vtkFlyingEdges3D, values, 1.0)[1]) == (0, 0), "vtkFlyingEdges3D: a manifold"
    assert edges(contour_by(vtkMarchingCubes, values, 1.0)[1])[1] > 0, "vtkMarchingCubes: edges of four triangles"
    assert edges(marching_cubes(values, 1.0)[1])[0] > 0, "scikit-image: open edges"
    report, _ = by_tegl(programs, values, 1)
    assert report["boundary_simplices"] == report["nonmanifold_simplices"] == report["bad_links"] == 0, report


def diagonals():
    square = np.zeros((4, 4))
    square[1, 1] = square[2, 2] = 1
    assert len(find_contours(square, 0.5, fully_connected="low")) == 2, "low is connected: high samples are apart"
    assert len(find_contours(square, 0.5, fully_connected="high")) == 1


def main(programs):
    if not vtkVersion.GetVTKVersion().startswith("9.1") or skimage.__version__ != "0.19.3":
        print(f"skipped: VTK {vtkVersion.GetVTKVersion()}, scikit-image {skimage.__version__}")
        sys.exit(77)
    orientation(programs)
    what_is_high()
    ties(programs)
    diagonals()
    print("VTK and scikit-image do what docs/coming-from.md says")


if __name__ == "__main__":
    main(sys.argv[1])
