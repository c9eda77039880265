# SPDX-License-Identifier: BSD-3-Clause
"""Contours for VTK, pyvista and meshio, which are imported when they are asked for."""

from __future__ import annotations

import importlib
import typing

import numpy as np

if typing.TYPE_CHECKING:
    from ._contour import Contour


def _imported(module: str, function: str, what: str) -> typing.Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{function} needs {what}, which Python does not find: {error}") from error


def _points(contour: Contour) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """#V x 3, and what has no place in them."""
    vertices = contour._core.vertices
    extra = {}
    if contour.ndim == 4:
        name = contour._core.axis_names[3] or "t"
        while name in contour.vertex_attributes:
            name += "_"
        extra[name] = np.ascontiguousarray(vertices[:, 3])
    if contour.ndim == 2:
        vertices = np.column_stack([vertices, np.zeros(len(vertices), vertices.dtype)])
    return np.ascontiguousarray(vertices[:, :3]), extra


def _normals(contour: Contour) -> np.ndarray | None:
    normals = contour._core.normals
    if normals is None or contour.ndim == 4:
        return normals
    return normals if contour.ndim == 3 else np.column_stack([normals, np.zeros(len(normals), normals.dtype)])


def _of_cells(contour: Contour) -> dict[str, np.ndarray]:
    """Attributes of simplices, vectors among them in the order of the points' coordinates."""
    return {name: values for name, (values, _) in contour._core.simplex_attributes.items()}


def to_meshio(contour: Contour):
    meshio = _imported("meshio", "to_meshio", "meshio")
    _, cells = contour.points_and_cells()
    points, extra = _points(contour)
    data = {**extra, **contour.vertex_attributes}
    normals = _normals(contour)
    if normals is not None:
        data["Normals"] = normals
    return meshio.Mesh(points, [(kind, np.asarray(rows, dtype=np.int64)) for kind, rows in cells], point_data=data,
                       cell_data={name: [values] for name, values in _of_cells(contour).items()})


def _cells(contour: Contour):
    core = _imported("vtkmodules.vtkCommonDataModel", "to_vtk", "VTK's Python modules")
    support = importlib.import_module("vtkmodules.util.numpy_support")
    simplices = contour._core.simplices
    cells = core.vtkCellArray()
    offsets = np.arange(0, simplices.size + 1, contour.ndim, dtype=np.int64)
    cells.SetData(support.numpy_to_vtkIdTypeArray(offsets, deep=True),
                  support.numpy_to_vtkIdTypeArray(simplices.astype(np.int64).ravel(), deep=True))
    return core, support, cells


def to_vtk(contour: Contour):
    if not 2 <= contour.ndim <= 4:
        raise ValueError(f"cells of a {contour.ndim}D contour; expected 2 to 4 dimensions")
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
    for data, arrays in ((mesh.GetPointData(), {**extra, **contour.vertex_attributes}),
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


def to_pyvista(contour: Contour):
    pyvista = _imported("pyvista", "to_pyvista", "pyvista")
    return pyvista.wrap(to_vtk(contour))
