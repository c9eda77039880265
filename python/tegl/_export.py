# SPDX-License-Identifier: BSD-3-Clause
"""The library's contours for VTK, pyvista and meshio, which are imported on demand. Points are x, y, z (and t): the
library's order of axes, as in files."""

from __future__ import annotations

import importlib
import typing

import numpy as np

from . import _tegl


def _imported(module: str, function: str, what: str) -> typing.Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{function} needs {what}, which cannot be imported: {error}") from error


def points_and_cells(contour: _tegl.Contour) -> tuple[np.ndarray, list[tuple[str, np.ndarray]]]:
    kind = {2: "line", 3: "triangle", 4: "tetra"}.get(contour.ndim)
    if kind is None:
        raise ValueError(f"cells of a {contour.ndim}D contour; expected 2 to 4 dimensions")
    return contour.vertices, [(kind, contour.simplices)]


def _refuse_periods(contour: _tegl.Contour, function: str) -> None:
    """Cells across a seam would extend over the whole domain."""
    if contour.periods:
        raise ValueError(f"'{function}' cannot hold a wrapped contour, with periods; expected an unrolled contour "
                         "(Contour.unroll)")


def _points(contour: _tegl.Contour) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Points, #V x 3, and the remaining coordinates."""
    vertices = contour.vertices
    extra = {}
    if contour.ndim == 4:
        name = contour.axis_names[3] or "t"
        while name in contour.vertex_attributes:
            name += "_"
        extra[name] = np.ascontiguousarray(vertices[:, 3])
    if contour.ndim == 2:
        vertices = np.column_stack([vertices, np.zeros(len(vertices), vertices.dtype)])
    return np.ascontiguousarray(vertices[:, :3]), extra


def _normals(contour: _tegl.Contour) -> np.ndarray | None:
    normals = contour.normals
    if normals is None or contour.ndim == 4:
        return normals
    return normals if contour.ndim == 3 else np.column_stack([normals, np.zeros(len(normals), normals.dtype)])


def _of_points(contour: _tegl.Contour) -> dict[str, np.ndarray]:
    """Attributes of vertices."""
    return {name: values for name, (values, _) in contour.vertex_attributes.items()}


def _of_cells(contour: _tegl.Contour) -> dict[str, np.ndarray]:
    """Attributes of simplices, vectors among them in the order of the points' coordinates."""
    return {name: values for name, (values, _) in contour.simplex_attributes.items()}


def to_meshio(contour: _tegl.Contour):
    _refuse_periods(contour, "to_meshio")
    meshio = _imported("meshio", "to_meshio", "meshio")
    _, cells = points_and_cells(contour)
    points, extra = _points(contour)
    data = {**extra, **_of_points(contour)}
    normals = _normals(contour)
    if normals is not None:
        data["Normals"] = normals
    return meshio.Mesh(points, [(kind, np.asarray(rows, dtype=np.int64)) for kind, rows in cells], point_data=data,
                       cell_data={name: [values] for name, values in _of_cells(contour).items()})


def _cells(contour: _tegl.Contour):
    core = _imported("vtkmodules.vtkCommonDataModel", "to_vtk", "VTK's Python modules")
    support = importlib.import_module("vtkmodules.util.numpy_support")
    simplices = contour.simplices
    cells = core.vtkCellArray()
    offsets = np.arange(0, simplices.size + 1, contour.ndim, dtype=np.int64)
    cells.SetData(support.numpy_to_vtkIdTypeArray(offsets, deep=True),
                  support.numpy_to_vtkIdTypeArray(simplices.astype(np.int64).ravel(), deep=True))
    return core, support, cells


def to_vtk(contour: _tegl.Contour):
    if not 2 <= contour.ndim <= 4:
        raise ValueError(f"cells of a {contour.ndim}D contour; expected 2 to 4 dimensions")
    _refuse_periods(contour, "to_vtk")
    core, support, cells = _cells(contour)
    coordinates, extra = _points(contour)
    points = _vtk_points(support, coordinates)
    if contour.ndim == 4:
        mesh = core.vtkUnstructuredGrid()
        mesh.SetPoints(points)
        mesh.SetCells(core.VTK_TETRA, cells)
    else:
        mesh = core.vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells) if contour.ndim == 3 else mesh.SetLines(cells)
    for data, arrays in ((mesh.GetPointData(), {**extra, **_of_points(contour)}),
                         (mesh.GetCellData(), _of_cells(contour))):
        for name, values in arrays.items():
            data.AddArray(_named(support, values, name))
    normals = _normals(contour)
    if normals is not None:
        array = _named(support, normals, "Normals")
        mesh.GetPointData().AddArray(array) if contour.ndim == 4 else mesh.GetPointData().SetNormals(array)
    return mesh


def _vtk_points(support, coordinates: np.ndarray):
    points = importlib.import_module("vtkmodules.vtkCommonCore").vtkPoints()
    points.SetData(support.numpy_to_vtk(coordinates, deep=True))
    return points


def _named(support, values: np.ndarray, name: str):
    array = support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def to_pyvista(contour: _tegl.Contour):
    pyvista = _imported("pyvista", "to_pyvista", "pyvista")
    return pyvista.wrap(to_vtk(contour))
