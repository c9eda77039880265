#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Angular errors of normals beside a jump of the values, by distance from the jump: tegl's kinds and VTK's.

Phantoms of two materials: a ball of radius 12 steps, whose values fall linearly from its centre, beside a half-space with
a value of its own. Only vertices on edges with both ends in the ball count, as their normal is known.

    PYTHONPATH=build/release/python bench/phantom_normals.py

Needs NumPy and, for VTK's column, python3-vtk9.
"""
import numpy as np
import tegl

RADIUS, SIZE = 12.0, 35
NORMAL, OFFSET = np.array([0.3, 0.953, 0.0]) / np.hypot(0.3, 0.953), 2.1  # of the jump, which is in the array's axes
ORIGIN = np.array([0.13, 0.26, 0.39]) - SIZE // 2
DISTANCES = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 99.0)
PHANTOMS = (("constant 20", lambda inside, beside: np.full_like(inside, 20.0), 0.0),
            ("constant 20, noise of 0.1 step", lambda inside, beside: np.full_like(inside, 20.0), 0.1),
            ("three times as steep from the jump on", lambda inside, beside: inside + 3.0 * beside, 0.0))


def beside(points):
    return points @ NORMAL - OFFSET


def phantom(other, noise):
    points = np.stack(np.meshgrid(*[np.arange(SIZE)] * 3, indexing="ij"), axis=-1) + ORIGIN
    inside = RADIUS - np.linalg.norm(points, axis=-1)
    values = np.where(beside(points) > 0, other(inside, np.maximum(beside(points), 0.0)), inside)
    return (values + noise * np.random.default_rng(5).normal(size=values.shape)).astype(np.float32)


def by_vtk(values):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape)
    image.SetOrigin(*ORIGIN)
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(order="F"), deep=True))
    flying = vtk.vtkFlyingEdges3D()
    flying.SetInputData(image)
    flying.SetValue(0, 0.0)
    flying.ComputeNormalsOn()
    flying.Update()
    output = flying.GetOutput()
    return vtk_to_numpy(output.GetPoints().GetData()), vtk_to_numpy(output.GetPointData().GetNormals())


def errors(vertices, normals):
    """By interval of distances from the jump, the root mean square angle in degrees."""
    vertices = vertices.astype(np.float64)
    index = vertices - ORIGIN
    fraction = np.abs(index - np.round(index)) > 1e-3
    low, high = np.where(fraction, np.floor(index), np.round(index)), np.where(fraction, np.ceil(index), np.round(index))
    kept = (fraction.sum(axis=1) == 1) & (beside(low + ORIGIN) <= 0) & (beside(high + ORIGIN) <= 0)
    radial = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    angle = np.degrees(np.arccos(np.clip((radial * normals).sum(axis=1), -1, 1)))
    distance = -beside(vertices)
    groups = [kept & (distance >= a) & (distance < b) for a, b in zip(DISTANCES, DISTANCES[1:])]
    return [np.sqrt((angle[group]**2).mean()) if group.any() else np.nan for group in groups]


def main():
    heads = [f"{a:g} to {b:g}" if b < 99 else f"from {a:g}" for a, b in zip(DISTANCES, DISTANCES[1:])]
    for name, other, noise in PHANTOMS:
        values = phantom(other, noise)
        print(f"\n{name}\n| steps from the jump | {' | '.join(heads)} |\n|---|" + "---|" * len(heads))
        kinds = {"gradient": "gradient", "Sobel": "sobel", "Prewitt": "prewitt", "context": "context"}
        rows = {}
        for label, kind in kinds.items():
            contour = tegl.contour(values, 0.0, origin=tuple(ORIGIN), normals=kind)
            rows[label] = errors(contour.vertices, contour.normals)
        try:
            rows["VTK 9, vtkFlyingEdges3D"] = errors(*by_vtk(values))
        except ImportError:
            pass
        for label, row in rows.items():
            print(f"| {label} | {' | '.join('-' if np.isnan(x) else f'{x:.2g}' for x in row)} |")


if __name__ == "__main__":
    main()
