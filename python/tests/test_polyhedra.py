# SPDX-License-Identifier: BSD-3-Clause
"""Contours of meshes of polygons and polyhedra."""

import itertools
import types

import numpy as np
import pytest
import tegl


def honeycomb(n):
    """Hexagons that fill a part of the plane."""
    numbers, cells = {}, []
    for i, j in itertools.product(range(n), repeat=2):
        x, y = 3 * i, 2 * j + i % 2
        corners = [(x + 2, y), (x + 1, y + 1), (x - 1, y + 1), (x - 2, y), (x - 1, y - 1), (x + 1, y - 1)]
        cells.append([numbers.setdefault(corner, len(numbers)) for corner in corners])
    return np.array(list(numbers)) * [0.5, 3**0.5 / 2], np.array(cells)


def prisms(n):
    """Prisms over hexagons, by faces, and their points."""
    plane, hexagons = honeycomb(n)
    layers = [np.column_stack([plane, np.full(len(plane), 1.5 * k)]) for k in range(n)]
    cells = []
    for k, ring in itertools.product(range(n - 1), hexagons):
        low, high = ring + k * len(plane), ring + (k + 1) * len(plane)
        sides = [[low[v], low[(v + 1) % 6], high[(v + 1) % 6], high[v]] for v in range(6)]
        cells.append([low, high, *sides])
    return np.concatenate(layers), cells


def ball(points, radius=4.0):
    return radius - np.linalg.norm(points - (points.min(axis=0) + points.max(axis=0)) / 2, axis=-1)


def test_prisms_by_their_faces_have_a_sphere():
    points, cells = prisms(9)
    for name in ("polyhedron", "polyhedron12"):
        contour = tegl.contour_mesh(points, {name: cells}, ball(points), 0.0)
        report = contour.check()
        assert report.is_closed and report.euler == 2 and report.components == 1
        assert contour.measure().content == pytest.approx(4 / 3 * np.pi * 64, rel=0.1)
    size = tegl.count_mesh(points, {"polyhedron": cells}, ball(points), 0.0)
    assert size == (len(contour.vertices), len(contour.simplices))
    index = tegl.MeshIndex(points, [("polyhedron", cells)], ball(points))
    assert np.array_equal(index.contour(0.0).simplices, contour.simplices)


def test_polyhedra_mix_with_other_cells():
    points, cells = prisms(5)
    values = np.random.default_rng(1).random(len(points))
    every = tegl.contour_mesh(points, {"polyhedron": cells}, values, 0.5, close=True)
    assert every.check().is_closed
    # a pyramid on a side of a prism
    square = [int(p) for p in cells[0][4]]
    apex = len(points)
    middle = points[np.unique(np.concatenate(cells[0]))].mean(axis=0)
    more = np.vstack([points, 2 * points[square].mean(axis=0) - middle])
    mixed = [("polyhedron", cells[:7]), ("pyramid", np.array([[*square, apex]])), ("polyhedron", cells[7:])]
    contour = tegl.contour_mesh(more, mixed, np.append(values, 1.0), 0.5)
    report = contour.check()
    assert report.nonmanifold_simplices == 0 and report.orientation_conflicts == 0


def test_polygons_and_polygons_over_time():
    points, cells = honeycomb(12)
    for block in (cells, list(cells), [[int(p) for p in cell] for cell in cells]):
        curve = tegl.contour_mesh(points, {"polygon": block}, ball(points), 0.0)
        assert curve.check().is_closed
        assert curve.measure().content == pytest.approx(np.pi * 16, rel=0.1)
    surface = tegl.contour_mesh(points, {"polygon6": cells}, [ball(points, r) for r in (-1, 3, 5, -1)], 0.0, times=[0, 1, 2, 3])
    assert surface.check().is_closed and surface.slice(1.5).check().is_closed


def test_a_mesh_like_that_of_meshio():
    points, cells = prisms(4)
    blocks = [types.SimpleNamespace(type="polyhedron12", data=cells), types.SimpleNamespace(type="line", data=[[0, 1]])]
    mesh = types.SimpleNamespace(points=points, cells=blocks, point_data={"f": ball(points, 2.0)})
    assert len(tegl.contour_mesh(mesh, level=0.0).simplices)
    plane, hexagons = honeycomb(4)
    flat = types.SimpleNamespace(points=np.column_stack([plane, np.zeros(len(plane))]), cells={"polygon": hexagons},
                                 point_data={"f": ball(plane, 2.0)})
    assert tegl.contour_mesh(flat, level=0.0).ndim == 2


def test_files_of_polyhedra(tmp_path):
    faces = [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9], *([k, (k + 1) % 5, (k + 1) % 5 + 5, k + 5] for k in range(5))]
    ring = [(np.cos(0.4 * np.pi * k), np.sin(0.4 * np.pi * k)) for k in range(5)]
    points = [(x, y, z) for z in (0, 1) for x, y in ring] + [(0, 0, 2), (1, 0, 2), (0, 1, 2), (0, 0, 3)]
    stream = [len(faces), *(n for face in faces for n in (len(face), *face))]
    arrays = {"connectivity": [10, 11, 12, 13, *range(10)], "offsets": [4, 14], "faces": stream, "faceoffsets": [-1, len(stream)]}
    text = "".join(f'<DataArray type="Int64" Name="{name}" format="ascii">{" ".join(map(str, numbers))}</DataArray>'
                   for name, numbers in arrays.items())
    (tmp_path / "prism.vtu").write_text(
        '<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid><Piece NumberOfPoints="14" NumberOfCells="2">'
        '<PointData><DataArray type="Float64" Name="f" format="ascii">0 0 0 0 0 1 1 1 1 1 0 1 1 1</DataArray></PointData>'
        '<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">'
        + " ".join(str(x) for point in points for x in point) + f'</DataArray></Points><Cells>{text}'
        '<DataArray type="UInt8" Name="types" format="ascii">10 42</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>')
    mesh = tegl.read_mesh(tmp_path / "prism.vtu")
    assert [name for name, _ in mesh.cells] == ["tetra", "polyhedron"] and "1 polyhedron" in repr(mesh)
    assert [[int(p) for p in face] for face in mesh.cells[1][1][0]] == faces
    assert len(mesh.contour(0.5).vertices) == 8
    assert np.array_equal(mesh.contour(0.5).simplices,
                          tegl.contour_mesh(points, mesh.cells, mesh.values, 0.5).simplices)


@pytest.mark.parametrize("cells, error, text", [
    ({"polyhedron": [[[0, 1, 2], [0, 1, 3]]]}, ValueError, "cell 0: a polyhedron of 2 faces; expected 4 to 124"),
    ({"polyhedron": [[[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 4]]]}, ValueError, "expected two faces"),
    ({"polyhedron": [[[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 0.5]]]}, TypeError, "expected integers"),
    ({"polyhedron": [[[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, -3]]]}, ValueError, "expected 0 or more"),
    ({"polyhedron": ["abc"]}, TypeError, "faces of cells of type 'polyhedron' are str; expected lists"),
    ({"polyhedron": 5}, TypeError, "cells of type 'polyhedron' are int; expected a list of cells: lists of faces"),
    ({"polygon": "abc"}, TypeError, "cells of type 'polygon' are str; expected a list of cells: lists of numbers"),
    ({"polyhedron": [5]}, TypeError, "faces of cells of type 'polyhedron' are int; expected lists of numbers of points"),
    ({"polyhedron": [[0, 1, 2, 3]]}, TypeError, "faces of cells of type 'polyhedron' have 0 in the place of a list"),
    ({"polyhedron": [[[[0, 1, 2]]]]}, TypeError, "have a list of lists, [[0, 1, 2]]; expected lists of numbers"),
    ({"polyhedron": [[[[0, 1], [2]]]]}, TypeError, "have a list of lists, [[0, 1], [2]]; expected lists of numbers"),
    ({"polygon": [3, 4]}, TypeError, "cells of type 'polygon' have 3 in the place of a list"),
    ({"polygon": [[0, 1, 2, 3, 4]]}, ValueError, "type 'polygon' with points in 3 dimensions; expected 2"),
    ({"polyhedron": [[[]]]}, ValueError, "cell 0: a polyhedron of 1 faces; expected 4 to 124"),
    ({"polyeder": [[0, 1, 2, 3, 4]]}, ValueError, "'polyhedron'"),
])
def test_bad_cells_are_errors_that_name_them(cells, error, text):
    with pytest.raises(error) as raised:
        tegl.contour_mesh(np.eye(5, 3), cells, np.arange(5.0), 0.5)
    assert text in str(raised.value)


def test_polyhedra_over_time():
    points, cells = prisms(9)
    values = [ball(points, r) for r in (-1, 3, 5, -1)]
    hypersurface = tegl.contour_mesh(points, {"polyhedron": cells}, values, 0.0, times=[0, 1, 2, 3])
    assert hypersurface.ndim == 4 and hypersurface.check().is_closed
    assert hypersurface.slice(1.5).check().euler == 2
    step = tegl.contour_mesh(points, {"polyhedron": cells}, values[2], 0.0)
    at_step = hypersurface.slice(2)
    assert np.array_equal(np.sort(at_step.vertices, axis=0), np.sort(step.vertices, axis=0))
    assert len(at_step.simplices) == len(step.simplices)
    moving = tegl.contour_mesh([points, points + 1], {"polyhedron": cells}, [ball(points)] * 2, 0.0, times=[0, 1])
    assert moving.slice(0.5).measure().centroid[0] == pytest.approx(moving.slice(0).measure().centroid[0] + 0.5, abs=0.05)
