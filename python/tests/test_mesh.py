# SPDX-License-Identifier: BSD-3-Clause
"""Contours of meshes."""

import itertools

import numpy as np
import pytest
import tegl
from conftest import assert_same


def grid(n, ndim=3):
    """Points of a grid in [-1, 1], axis 0 fastest, and its cells in the order of pixels and voxels."""
    axes = np.meshgrid(*[np.linspace(-1, 1, n)] * ndim, indexing="ij")
    points = np.stack([axis.ravel() for axis in axes[::-1]], axis=1)
    base = np.arange(n**ndim).reshape([n] * ndim)[(slice(0, -1),) * ndim].ravel()
    steps = [sum(n**a for a in range(ndim) if v >> a & 1) for v in range(2**ndim)]
    return points, base[:, None] + np.array(steps)


def tetrahedra(n):
    points, cubes = grid(n)
    paths = [[0, 1 << a, 1 << a | 1 << b, 7] for a, b, _ in itertools.permutations(range(3))]
    return points, np.concatenate([cubes[:, path] for path in paths])


def ball(points):
    return 0.7 - np.linalg.norm(points, axis=-1)


def test_a_tetrahedral_mesh_has_a_sphere():
    points, cells = tetrahedra(21)
    contour = tegl.contour_mesh(points, cells, ball(points), 0.0)
    report = contour.check()
    assert report.is_closed and report.euler == 2 and report.components == 1
    assert contour.vertices.dtype == np.float32 and contour.isovalue == 0.0
    assert contour.measure().content == pytest.approx(4 / 3 * np.pi * 0.343, rel=0.02)
    assert np.abs(ball(contour.vertices)).max() < 0.01


def test_voxels_have_the_contour_of_the_array():
    points, cells = grid(12)
    values = np.random.default_rng(1).random(12**3)
    mesh = tegl.contour_mesh(points, {"voxel": cells}, values, 0.5, dtype=np.float64)
    array = tegl.contour(values.reshape(12, 12, 12), 0.5, origin=-1.0, spacing=2 / 11, dtype=np.float64)
    assert len(mesh.simplices) == len(array.simplices) and len(mesh.vertices) == len(array.vertices)
    ours, theirs = mesh.vertices, array.vertices[:, ::-1]
    order = [np.lexsort(np.round(v, 9).T) for v in (ours, theirs)]
    assert np.allclose(ours[order[0]], theirs[order[1]])


def test_types_may_be_mixed_and_named_as_in_meshio():
    points, cells = grid(9)
    around = cells[:, [0, 1, 3, 2, 4, 5, 7, 6]]
    half = len(cells) // 2  # the lower layers hexahedra, the upper ones wedges: quadrilaterals do not meet triangles
    upper = cells[half:]
    wedges = np.concatenate([upper[:, [0, 4, 1, 2, 6, 3]], upper[:, [1, 4, 5, 3, 6, 7]]])
    values = ball(points)
    expected = tegl.contour_mesh(points, around, values, 0.0).check()
    for blocks in ([("hexahedron", around[:half]), ("wedge", wedges)], {"hexahedron": around[:half], "wedge": wedges}):
        report = tegl.contour_mesh(points, blocks, values, 0.0).check()
        assert report.is_closed and report.euler == expected.euler == 2
    types = [type("CellBlock", (), {"type": name, "data": data}) for name, data in blocks.items()]
    assert tegl.contour_mesh(points, types, values, 0.0).check().is_closed


def test_two_dimensional_meshes():
    points, cells = grid(30, 2)
    values = 0.7 - np.linalg.norm(points, axis=1)
    for blocks in (cells[:, [0, 1, 3, 2]], np.concatenate([cells[:, [0, 1, 3]], cells[:, [0, 2, 3]]])):
        contour = tegl.contour_mesh(points, blocks, values, 0.0)
        assert contour.check().is_closed
        assert contour.measure().size == pytest.approx(2 * np.pi * 0.7, rel=0.01)


def test_values_at_several_times_are_cut_at_any_time():
    points, cells = tetrahedra(13)
    times = [0.0, 0.5, 2.0]
    values = np.stack([ball(points) - 0.1 * t for t in times])
    contour = tegl.contour_mesh(points, cells, values, 0.0, times=times)
    assert contour.vertices.shape[1] == 4
    for t in (0.0, 0.2, 0.5, 1.7):
        cut = contour.slice(t)
        assert cut.check().is_closed
        assert cut.measure().content == pytest.approx(4 / 3 * np.pi * (0.7 - 0.1 * t)**3, rel=0.06)
    assert len(contour.slice(0.5).simplices) == len(tegl.contour_mesh(points, cells, values[1], 0.0).simplices)
    decided = tegl.contour_mesh(points, cells, values, 0.0, times=times, triangulation="barycentric", ambiguity="saddle")
    assert decided.slice(1.7).check().is_closed and len(decided.simplices) > 2 * len(contour.simplices)


def test_points_may_move():
    points, cells = tetrahedra(11)
    times = [0.0, 1.0]
    moving = np.stack([points + [2 * t, 0, 0] for t in times])
    contour = tegl.contour_mesh(moving, cells, np.stack([ball(points)] * 2), 0.0, times=times)
    assert contour.slice(0.5).measure().centroid[0] == pytest.approx(1.0, abs=0.02)


def test_missing_values_leave_a_boundary():
    points, cells = tetrahedra(11)
    values = ball(points)
    values[points[:, 0] > 0.3] = np.nan
    report = tegl.contour_mesh(points, cells, values, 0.0).check()
    assert report.boundary_simplices > 0 and report.is_manifold


def test_masked_values_are_missing():
    points, cells = tetrahedra(11)
    values = ball(points)
    mask = points[:, 0] > 0.3
    expected = tegl.contour_mesh(points, cells, np.where(mask, np.nan, values), 0.0)
    filled = np.where(mask, 1e20, values)
    for masked in (np.ma.masked_array(filled, mask), np.ma.masked_array(filled, mask, fill_value=7.0)):
        contour = tegl.contour_mesh(points, cells, masked, 0.0)
        assert np.array_equal(contour.vertices, expected.vertices)
        assert np.array_equal(contour.simplices, expected.simplices)
    assert np.count_nonzero(filled == 1e20) == mask.sum()  # the argument is as before
    whole = tegl.contour_mesh(points, cells, values, 0.0)
    assert np.array_equal(tegl.contour_mesh(points, cells, np.ma.masked_array(values), 0.0).vertices, whole.vertices)
    integers = np.ma.masked_array(np.round(100 * values).astype(np.int32), mask)
    assert tegl.contour_mesh(points, cells, integers, 0.5).check().boundary_simplices > 0
    moving = tegl.contour_mesh(points, cells, [np.ma.masked_array(filled, mask)] * 2, 0.0, times=[0.0, 1.0])
    assert np.array_equal(moving.vertices, tegl.contour_mesh(
        points, cells, [np.where(mask, np.nan, values)] * 2, 0.0, times=[0.0, 1.0]).vertices)


def test_options_and_progress_are_those_of_contour():
    points, cells = tetrahedra(11)
    values = ball(points)
    down = tegl.contour_mesh(points, cells, values, 0.0)
    up = tegl.contour_mesh(points, cells, values, 0.0, direction="ascent", threads=1)
    assert np.array_equal(down.vertices, up.vertices)
    assert np.array_equal(down.simplices, up.simplices[:, [0, 2, 1]])
    assert down.measure().content == pytest.approx(up.measure().content)
    heard = []
    tegl.contour_mesh(points, cells, values, 0.0, progress=heard.append)
    assert heard == sorted(heard) and heard[-1] == 1.0
    with pytest.raises(tegl.Cancelled):
        tegl.contour_mesh(points, cells, values, 0.0, progress=lambda _: False)


def test_caps_close_contours_at_the_border_and_normals_are_gradients():
    points, cells = tetrahedra(9)
    values = points @ [2.0, -1.0, 2.0]
    contour = tegl.contour_mesh(points, cells, values, 0.3, close=True, normals=True, ambiguity="saddle")
    assert contour.check().is_closed
    np.testing.assert_allclose(contour.normals, np.broadcast_to([-2 / 3, 1 / 3, -2 / 3], contour.normals.shape), atol=1e-6)
    low = tegl.contour_mesh(points, cells, -values, -0.3, close=True, normals="flat")
    assert low.measure().content + contour.measure().content == pytest.approx(8.0)
    assert not tegl.contour_mesh(points, cells, values, 0.3).check().is_closed


def test_an_index_gives_the_contours_of_the_mesh():
    points, cells = tetrahedra(9)
    values = ball(points)
    for given in (dict(values=values), dict(values=[values, values - 0.2], times=[0.0, 1.0])):
        index = tegl.MeshIndex(points, cells, **given)
        assert index.memory > 0 and repr(index).startswith("<tegl.MeshIndex of ")
        for level in (-0.3, 0.0, 0.2):
            one = index.contour(level, normals=True, close=True)
            other = tegl.contour_mesh(points, cells, level=level, normals=True, close=True, **given)
            assert np.array_equal(one.vertices, other.vertices) and np.array_equal(one.simplices, other.simplices)
            assert np.array_equal(one.normals, other.normals)
        with pytest.raises(ValueError, match="level is 7.0; expected a level above"):
            index.contour(7.0)
        assert not len(index.contour(7.0, allow_empty=True).vertices)
    with pytest.raises(TypeError, match="no argument is named 'colour'"):
        index.contour(0.0, colour=1)
    with pytest.raises(TypeError, match="values are missing"):
        tegl.MeshIndex(points, cells)


@pytest.mark.parametrize("change, error, text", [
    (dict(cells=[[0, 1, 2, 99999]]), ValueError, "cell 0: corner 3 is point 99999; expected a number below 27"),
    (dict(cells=[[0, 1, 2, -1]]), ValueError, "from -1 to 2"),
    (dict(cells=[[0, 1, 2]]), ValueError, "cells have 3 corners; expected in 3 dimensions: 4 (tetra)"),
    (dict(cells=[[0.0, 1, 2, 3]]), TypeError, "float64; expected integers"),
    (dict(cells={"tetra10": [[0, 1, 2, 3]]}), ValueError, "'tetra10'; expected one of 'triangle'"),
    (dict(cells={"wedge": [[0, 1, 2, 3]]}), ValueError, "'wedge' have 4 corners; expected 6"),
    (dict(cells={"triangle": [[0, 1, 2]]}), ValueError, "cell 0: type 5 (triangle); expected a 3D cell"),
    (dict(points=np.zeros((27, 5))), ValueError, "5 coordinates; expected 2 to 4"),
    (dict(points=np.full((27, 3), np.nan)), ValueError, "point 0"),
    (dict(points=np.full((27, 3), 1e39)), ValueError, "point 0: coordinate 0 is 1e+39; expected"),
    (dict(points=np.ma.masked_less(grid(3)[0], -0.5)), ValueError, "points have 27 masked numbers; expected none"),
    (dict(cells=np.ma.masked_equal([[0, 1, 2, 3]], 3)), ValueError, "cells have 1 masked numbers; expected none"),
    (dict(values=np.zeros((2, 27)), times=np.ma.masked_array([0.0, 1.0], [False, True])), ValueError,
     "times have 1 masked numbers; expected none"),
    (dict(values=np.zeros(26)), ValueError, "values have the shape (26,); expected (27,)"),
    (dict(times=[0.0, 1.0]), ValueError, "values have the shape (27,); expected (2, 27)"),
    (dict(times=[1.0, 0.0], values=np.zeros((2, 27))), ValueError, "expected ascending times"),
    (dict(level=7.0), ValueError, "level is 7.0; expected a level above"),
    (dict(values=np.zeros(27)), ValueError, "level is 0.0, and all values are 0.0; expected a level between two values"),
    (dict(points=np.zeros((0, 3)), cells={"tetra": []}, values=[]), ValueError, "the mesh has no points; expected some"),
    (dict(cells={}), ValueError, "the mesh has no cells; expected some, or allow_empty=True"),
    (dict(cells={"tetra": [[0, 1, 3, 9], [1, 2, 4, 10], [9, 1, 0, 3]]}), ValueError,
     "cell 2 has the same corners as cell 0; expected each cell once"),
    (dict(normals="sobel"), ValueError, "normals of a mesh are 'sobel'; expected True"),
    (dict(dtype="int32"), ValueError, "expected float32 or float64"),
])
def test_bad_arguments_are_errors_that_name_them(change, error, text):
    points, cells = tetrahedra(3)
    arguments = dict(points=points, cells=cells, values=ball(points), level=0.0) | change
    with pytest.raises(error) as raised:
        tegl.contour_mesh(**arguments)
    assert text in str(raised.value)


def test_levels_that_only_points_without_a_cell_have_are_outside():
    points, cells, values = np.eye(5)[:, :3], {"tetra": [[0, 1, 2, 3]]}, np.array([0.0, 1.0, 2.0, 3.0, 9.0])
    index = tegl.MeshIndex(points, cells, values)
    for contour in (lambda **more: tegl.contour_mesh(points, cells, values, 5.0, **more), lambda **more: index.contour(5.0, **more),
                    lambda **more: tegl.contour_mesh_facets(points, cells, values, 5.0, **more)):
        with pytest.raises(ValueError, match="level is 5.0; expected a level above 0.0 and up to 3.0"):
            contour()
        assert not len(contour(allow_empty=True).vertices)
    with pytest.raises(ValueError, match="the mesh has no cells"):
        tegl.MeshIndex(points, {}, values).contour(5.0)
    assert not len(tegl.contour_mesh(points, {}, values, 5.0, allow_empty=True).vertices)


def test_contours_of_divided_cells():
    ball = 0.7 - np.sqrt(sum(x**2 for x in np.meshgrid(*[np.linspace(-1, 1, 20)] * 3, indexing="ij")))
    for division in ("kuhn", "alternating", "symmetric", "hybrid"):
        surface = tegl.contour(ball, 0.0, division=division, spacing=2 / 19)
        assert surface.check().is_closed and surface.check().euler == 2
        assert surface.measure().content == pytest.approx(4 / 3 * np.pi * 0.343, rel=0.03)
    with pytest.raises(ValueError, match="normals context of a divided image"):
        tegl.contour(ball, 0.0, division="kuhn", normals="context")
    turn = 2 * np.pi * np.arange(12) / 12
    z, y, x = np.meshgrid(turn, turn, turn, indexing="ij")
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    for division in ("kuhn", "alternating", "symmetric", "hybrid"):
        cell = tegl.contour(gyroid, 0.01, division=division, periodic="all", normals="sobel")
        assert cell.check().is_closed and cell.check().euler == -8 and len(cell.normals) == len(cell.vertices)
        assert tuple(tegl.count(gyroid, 0.01, division=division, periodic="all")) == (len(cell.vertices), len(cell.simplices))
        assert not cell.unroll()[0].check().is_closed
    with pytest.raises(ValueError, match="expected an even number"):
        tegl.contour(gyroid[:-1], 0.01, division="alternating", periodic="all")
    with pytest.raises(ValueError, match="expected kuhn or symmetric"):
        tegl.contour(np.zeros((3, 3, 3, 3)), 0.0, division="hybrid", allow_empty=True)


def test_contours_of_divided_cells_in_5d():
    def ball_of(samples):
        return 0.7 - np.sqrt(sum(x**2 for x in np.meshgrid(*[np.linspace(-1, 1, samples)] * 5, indexing="ij")))

    # the interpolated ball lies inside; the error is of order 2
    content = 8 / 15 * np.pi**2 * 0.7**5
    errors = [1 - tegl.contour(ball_of(n), 0.0, division="kuhn", spacing=2 / (n - 1)).measure().content / content for n in (7, 9)]
    assert 0 < errors[1] < 0.21 and errors[1] / errors[0] == pytest.approx((6 / 8)**2, rel=0.1)
    ball = ball_of(5)
    expected = tegl.contour(ball, 0.0, division="kuhn", spacing=0.5).measure().content
    for division in ("kuhn", "symmetric"):
        surface = tegl.contour(ball, 0.0, division=division, spacing=0.5)
        assert surface.check().is_closed and surface.check().euler == 2
        assert surface.measure().content == pytest.approx(expected, rel=0.01)
        assert tuple(tegl.count(ball, 0.0, division=division)) == (len(surface.vertices), len(surface.simplices))
    with pytest.raises(ValueError, match="division hybrid of a 5D image; expected kuhn or symmetric"):
        tegl.contour(ball, 0.0, division="hybrid")
    turn = 2 * np.pi * np.arange(4) / 4
    torus = np.cos(turn).reshape(4, 1, 1, 1, 1) + np.zeros([4] * 5)  # two flat T^4 in T^5
    sheets = tegl.contour(torus, 0.1, division="kuhn", periodic="all", normals=True)
    report = sheets.check()
    assert report.is_closed and report.components == 2 and report.euler == 0
    assert np.abs(np.abs(sheets.normals[:, 0]) - 1).max() < 1e-6
    assert tuple(tegl.count(torus, 0.1, division="kuhn", periodic="all")) == (len(sheets.vertices), len(sheets.simplices))
    assert not sheets.unroll()[0].check().is_closed
    ball[2, 2, 2, 2, 2] = np.nan
    for division in (None, "kuhn", "symmetric"):
        report = tegl.contour(ball, -0.2, division=division).check()
        assert report.is_manifold and not report.is_closed


def test_contours_of_lattices_and_of_scattered_points():
    layers, n = 30, 22
    k, j, i = np.meshgrid(np.arange(layers), np.arange(n), np.arange(n), indexing="ij")
    for lattice, step in (("fcc", 0.5**0.5), ("bcc", 0.5)):
        z, y, x = (k - layers / 2) * step, j + 0.5 * (k % 2) - 11, i + 0.5 * (k % 2) - 11
        ball = 6.0 - np.sqrt(x**2 + y**2 + z**2)
        surface = tegl.contour(ball, 0.0, lattice=lattice, spacing=[step, 1.0, 1.0])
        assert surface.check().is_closed and surface.check().euler == 2
        assert surface.measure().content == pytest.approx(4 / 3 * np.pi * 216, rel=0.05)
        normals = tegl.contour(ball, 0.0, lattice=lattice, spacing=[step, 1.0, 1.0], normals=True).normals
        outwards = surface.vertices - [layers / 2 * step, 11, 11]
        outwards /= np.linalg.norm(outwards, axis=1, keepdims=True)
        assert np.abs(normals - outwards).max() < 0.1
    with pytest.raises(ValueError, match="expected one of the two"):
        tegl.contour(ball, 0.0, lattice="fcc", division="kuhn")
    with pytest.raises(ValueError, match="lattice is 'hexagonal'; expected one of 'triangular', .*'fcc_in_time', or 'cubic'"):
        tegl.contour(ball, 0.0, lattice="hexagonal")
    with pytest.raises(ValueError, match="expected 4 dimensions"):
        tegl.contour(ball, 0.0, lattice="d4")
    points = np.random.default_rng(1).uniform(-1, 1, (3000, 3))
    surface = tegl.contour_points(points, 0.7 - np.linalg.norm(points, axis=1), 0.0)
    assert surface.check().is_closed and surface.check().euler == 2
    with pytest.raises(ValueError, match="are equal"):
        tegl.contour_points(points[[0, 1, 2, 3, 4, 0]], np.zeros(6), 0.0)
    with pytest.raises(ValueError, match="shape"):
        tegl.contour_points(points[0], np.zeros(3), 0.0)
    square, near = [[0, 0], [1, 0], [0, 1], [1, 1]], [[1e-300, 0], [0, 1e-300], [1e-300, 1e-300]]
    for count, text in ((1, "point 4 is so close to other points that rounding hides it; expected points that are further apart"),
                        (2, "point 4 and 1 other are so close to other points that rounding hides them"),
                        (3, "point 4 and 2 others are so close to other points that rounding hides them")):
        with pytest.raises(ValueError, match=text):
            tegl.contour_points(square + near[:count], np.arange(4 + count), 0.5)


VTU = """<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="{points}" NumberOfCells="{cells}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{places}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">{corners}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">{ends}</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">{types}</DataArray></Cells>
<PointData><DataArray type="Float64" Name="f" format="ascii">{values}</DataArray></PointData>
</Piece></UnstructuredGrid></VTKFile>"""


def write_vtu(path, points, voxels, values):
    def row(numbers):
        return " ".join(repr(x) for x in np.asarray(numbers).ravel().tolist())

    path.write_text(VTU.format(points=len(points), cells=len(voxels), places=row(points), corners=row(voxels),
                               ends=row(8 * np.arange(1, len(voxels) + 1)), types=row([11] * len(voxels)), values=row(values)))
    return path


def test_meshes_are_read_from_files(tmp_path):
    points, cells = grid(9)
    path = write_vtu(tmp_path / "a.vtu", points, cells, ball(points))
    mesh = tegl.read_mesh(path)
    assert np.array_equal(mesh.points, points) and np.array_equal(mesh.values, ball(points))
    assert [(name, array.shape) for name, array in mesh.cells] == [("voxel", cells.shape)]
    assert mesh.variable == "f" and mesh.axis_names == ("x", "y", "z") and not len(mesh.times)
    assert "729 points, 512 voxel" in repr(mesh)
    expected = tegl.contour_mesh(points, {"voxel": cells}, ball(points), 0.0)
    contour = mesh.contour(0.0)
    assert np.array_equal(contour.vertices, expected.vertices) and np.array_equal(contour.simplices, expected.simplices)
    assert contour.axis_names == ("x", "y", "z")


def test_the_repr_of_a_mesh_counts_its_types_of_cells(tmp_path):
    corners, ends, types = [], [], []
    for i in range(40):  # a row of squares, every second one divided into two triangles
        square = [i, i + 1, i + 42, i + 41]
        for cell in [square] if i % 2 == 0 else [square[:3], [square[0], *square[2:]]]:
            corners += cell
            ends.append(len(corners))
            types.append(9 if len(cell) == 4 else 5)
    places = [f"{i} {j} 0" for j in range(2) for i in range(41)]
    path = tmp_path / "mixed.vtu"
    path.write_text(VTU.format(points=82, cells=60, places=" ".join(places), corners=" ".join(map(str, corners)),
                               ends=" ".join(map(str, ends)), types=" ".join(map(str, types)), values=" ".join(["0"] * 82)))
    mesh = tegl.read_mesh(path)
    assert len(mesh.cells) == 40
    assert repr(mesh) == "<tegl.Mesh 'f': 82 points, 20 quad, 40 triangle>"


def test_files_over_time_are_one_mesh(tmp_path):
    points, cells = grid(9)
    files = [write_vtu(tmp_path / f"{k}.vtu", points * (1 + 0.1 * k), cells, ball(points) - 0.1 * k) for k in range(3)]
    mesh = tegl.read_mesh(files, "f", times=[0, 0.5, 2])
    assert mesh.points.shape == (3, 729, 3) and mesh.values.shape == (3, 729) and mesh.times.tolist() == [0, 0.5, 2]
    contour = mesh.contour(0.0, dtype=np.float64)
    assert contour.axis_names == ("x", "y", "z", "t")
    assert contour.slice(0.7).check().is_closed
    with pytest.raises(ValueError, match="2 times for 3 files"):
        tegl.read_mesh(files, times=[0, 1])
    with pytest.raises(ValueError, match="times with one file"):
        tegl.read_mesh(files[0], times=[0])


def test_tables_of_points_are_read(tmp_path):
    points = np.random.default_rng(3).uniform(-1, 1, (500, 3))
    table = tmp_path / "points.csv"
    np.savetxt(table, np.column_stack([points, ball(points), points[:, 0]]), delimiter=",", header="x,y,z,f,g", comments="")
    mesh = tegl.read_mesh(table, "f")
    expected = tegl.contour_points(mesh.points, mesh.values, 0.2)
    assert np.array_equal(mesh.contour(0.2).vertices, expected.vertices)
    with pytest.raises(ValueError, match="2 columns, and none chosen; expected one of f, g"):
        tegl.read_mesh(table)
    table.write_text("x,y,f\n0,0,1\n1,zero,2\n")
    with pytest.raises(ValueError, match="line 3, column 2"):
        tegl.read_mesh(table)
    with pytest.raises(FileNotFoundError):
        tegl.read_mesh(tmp_path / "none.csv")


def test_meshes_like_those_of_meshio():
    class Block:
        def __init__(self, kind, data):
            self.type, self.data = kind, data

    class MeshOfMeshio:
        pass

    points, cells = grid(9)
    mesh = MeshOfMeshio()
    mesh.points, mesh.point_data = points, {"f": ball(points), "g": points[:, 0]}
    mesh.cells = [Block("vertex", np.array([[0]])), Block("triangle", np.array([[0, 1, 2]])), Block("voxel", cells)]
    expected = tegl.contour_mesh(points, {"voxel": cells}, ball(points), 0.0)
    assert np.array_equal(tegl.contour_mesh(mesh, values="f", level=0.0).vertices, expected.vertices)
    for arguments, error, text in [(dict(level=0.0), ValueError, "'f', 'g'; expected the name"),
                                   (dict(values="h", level=0.0), ValueError, "'h'; expected one of 'f', 'g'"),
                                   (dict(values="f"), TypeError, "level is missing"),
                                   (dict(cells=cells, values="f", level=0.0), TypeError, "twice")]:
        with pytest.raises(error) as raised:
            tegl.contour_mesh(mesh, **arguments)
        assert text in str(raised.value)
    mesh.cells.append(Block("tetra10", np.array([range(10)])))
    with pytest.raises(ValueError, match="'tetra10'; expected one of"):
        tegl.contour_mesh(mesh, values="f", level=0.0)
    # 2D, with a coordinate that it does not need
    flat, squares = grid(9, 2)
    for axis in range(3):
        mesh.points, mesh.cells = np.insert(flat, axis, 3.0, axis=1), [Block("pixel", squares), Block("line", squares[:, :2])]
        mesh.point_data = {"f": ball(flat)}
        assert tegl.contour_mesh(mesh, level=0.0).check().is_closed
    mesh.points = np.column_stack([flat, flat[:, 0]])
    with pytest.raises(ValueError, match="on a surface in space"):
        tegl.contour_mesh(mesh, level=0.0)


def test_curved_grids_have_the_coordinates_of_their_samples():
    angle, radius = np.meshgrid(np.linspace(0, 3, 60), np.linspace(1, 2, 20), indexing="ij")
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    for order in ("C", "F"):
        arc = tegl.contour(np.array(1.5 - radius, order=order), 0.0, curved={0: x, 1: y}, dtype=np.float64, normals=True)
        assert np.abs(np.hypot(*arc.vertices.T) - 1.5).max() < 0.002
        assert arc.measure().size == pytest.approx(4.5, rel=1e-3)
        radial = arc.vertices / np.hypot(*arc.vertices.T)[:, None]
        assert (arc.normals * radial).sum(axis=1).min() > 0.99
    last = tegl.contour((1.5 - radius)[..., None] + np.zeros(5), 0.0, curved={0: x[..., None], 1: y[..., None]}, time_axis=-1)
    assert last.vertices[:, 2].max() == 4 and last.check().is_manifold
    with pytest.raises(ValueError, match=r"curved\[0\] has the shape \(20, 60\); expected \(60, 20\)"):
        tegl.contour(radius, 1.5, curved={0: x.T})
    with pytest.raises(ValueError, match="along the axes"):
        tegl.contour(radius, 1.5, curved={0: x[:1]})
    with pytest.raises(TypeError, match="expected a dict"):
        tegl.contour(radius, 1.5, curved=[x, y])
    with pytest.raises(ValueError, match="division with curved"):
        tegl.contour(radius, 1.5, curved={0: x, 1: y}, division="kuhn")
    for other in (dict(spacing=2), dict(origin=1), dict(coords=[np.arange(60), None])):
        with pytest.raises(ValueError, match=f"{next(iter(other))}.* with a curved grid"):
            tegl.contour(radius, 1.5, curved={0: x, 1: y}, **other)
    times = [0, 1, 3, 4, 7]
    timed = tegl.contour((1.5 - radius)[..., None] + np.zeros(5), 0.0, curved={0: x[..., None], 1: y[..., None]},
                         coords=[None, None, times], time_axis=-1)
    assert timed.vertices[:, 2].max() == 7
    folded = x.copy()
    folded[30] = folded[28]
    with pytest.warns(UserWarning, match="the curved grid is folded in .* cells, the first at the sample"):
        tegl.contour(radius, 1.5, curved={0: folded, 1: np.where(np.arange(60)[:, None] == 30, y[28], y)})


def test_curved_grids_of_netcdf_files(tmp_path):
    netcdf_file = pytest.importorskip("scipy.io").netcdf_file
    with netcdf_file(tmp_path / "model.nc", "w") as file:
        for name, size in (("time", 3), ("eta", 12), ("xi", 15)):
            file.createDimension(name, size)
        eta, xi = np.meshgrid(np.arange(12.0), np.arange(15.0), indexing="ij")
        lon, lat = 175 + xi + 0.1 * eta, 10 + eta + 0.2 * xi
        for name, values, unit in (("lon", np.where(lon > 180, lon - 360, lon), "degrees_east"), ("lat", lat, "degrees_north")):
            variable = file.createVariable(name, "d", ("eta", "xi"))
            variable[:] = values
            variable.units = unit
        temp = file.createVariable("temp", "f", ("time", "eta", "xi"))
        temp[:] = 20 - np.hypot(lon - 182, lat - 17) + np.zeros((3, 1, 1))
        temp.coordinates = "lon lat"
    image = tegl.read(tmp_path / "model.nc", "temp")
    assert image.axis_names == ("time", "lat", "lon") and image.axis_units[1:] == ("degrees_north", "degrees_east")
    assert sorted(image.curved) == [1, 2] and np.allclose(image.curved[2], lon[None]) and np.allclose(image.curved[1], lat[None])
    assert "lat 10 to " in repr(image) and "degrees_north (curved)" in repr(image)
    tube = image.contour(17.0)
    assert np.abs(np.hypot(tube.vertices[:, 2] - 182, tube.vertices[:, 1] - 17) - 3).max() < 0.1
    assert tube.axis_names == ("time", "lat", "lon")
    assert tegl.contour(image.array, 17.0).vertices[:, 2].max() < 15  # indices
    for refused in (lambda: tegl.slice(image, 17.0, at=1), lambda: tegl.scale_space(image, [1, 2]), lambda: tegl.Index(image)):
        with pytest.raises(ValueError, match="curved grid"):
            refused()
    assert tegl.filter(image, gaussian=1).contour(17.0).vertices[:, 2].min() > 170


def test_samples_are_cells_if_the_file_says_so(tmp_path):
    mask = np.zeros((4, 4, 4), np.uint8)
    mask[1:3, 1:3, 1:3] = 1
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n{}\n"
    for centers, content in (("centers: cell cell cell\n", 8), ("", None)):
        (tmp_path / "mask.nrrd").write_bytes(header.format(centers).encode() + mask.tobytes())
        image = tegl.read(tmp_path / "mask.nrrd")
        assert image.samples_are_cells == (content is not None)
        if content:
            assert image.contour(1, samples="file").measure().content == pytest.approx(content)
        assert image.contour(1, samples="file").check().is_closed
    with pytest.raises(ValueError, match="samples is 'file' for a ndarray"):
        tegl.contour(mask, 1, samples="file")
    (tmp_path / "cells.vtr").write_text(
        '<VTKFile type="RectilinearGrid" byte_order="LittleEndian"><RectilinearGrid WholeExtent="0 3 0 3 0 0">'
        '<Piece Extent="0 3 0 3 0 0"><CellData><DataArray type="UInt8" Name="v" format="ascii">0 0 0 0 1 0 0 1 0</DataArray>'
        '</CellData><Coordinates><DataArray type="Float64" Name="x" format="ascii">0 1 5 6</DataArray><DataArray type="Float64" '
        'Name="y" format="ascii">0 4 5 7</DataArray><DataArray type="Float64" Name="z" format="ascii">0</DataArray>'
        "</Coordinates></Piece></RectilinearGrid></VTKFile>")
    for time_axis in (0, -1):
        image = tegl.read(tmp_path / "cells.vtr", time_axis=time_axis)
        assert list(image.cell_faces[-time_axis]) == [0, 4, 5, 7]
        assert image.contour(1, samples="file").measure().content == pytest.approx(4 * 3, rel=1e-12)


def test_cospherical_points_in_4d_have_an_oriented_contour():
    for n in (6, 7):
        points = np.stack(np.meshgrid(*[np.linspace(-1, 1, n)] * 4, indexing="ij"), -1).reshape(-1, 4)
        contour = tegl.contour_points(points, 0.7 - np.linalg.norm(points, axis=1), 0.0, dtype=np.float64)
        report = contour.check()
        assert report.orientation_conflicts == 0 and report.is_closed
    smallest = tegl.contour_points([[0, 0], [1, 0], [0, 1]], [1, 0, 0], 0.5)
    assert len(smallest.simplices) == 1
    with pytest.raises(ValueError, match="3 points that lie in a line"):
        tegl.contour_points([[0, 0], [1, 1], [2, 2]], [1, 0, 0], 0.5)


def test_attributes_are_interpolated_as_the_coordinates():
    points, cells = tetrahedra(9)
    values, linear = ball(points), points @ [1.0, 2.0, 3.0]
    attributes = {"a": linear, "xyz": points}
    mesh = tegl.contour_mesh(points, cells, values, 0.0, attributes=attributes, dtype=np.float64)
    assert np.allclose(mesh.vertex_attributes["a"], mesh.vertices @ [1.0, 2.0, 3.0])
    assert np.allclose(mesh.vertex_attributes["xyz"], mesh.vertices)
    index = tegl.MeshIndex(points, cells, values)
    assert np.array_equal(index.contour(0.0, attributes=attributes, dtype=np.float64).vertex_attributes["a"], mesh.vertex_attributes["a"])
    moving = tegl.contour_mesh(points, cells, [values, values + 0.1], 0.05, times=[0, 2], dtype=np.float64,
                               attributes={"t": np.repeat([[0.0], [2.0]], len(points), axis=1)})
    assert np.allclose(moving.vertex_attributes["t"], moving.vertices[:, 3])
    scattered = tegl.contour_points(points, values, 0.0, attributes={"a": linear}, dtype=np.float64)
    assert np.allclose(scattered.vertex_attributes["a"], scattered.vertices @ [1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"attributes\['a'\] has the shape \(3,\); expected \(729,\)"):
        tegl.contour_mesh(points, cells, values, 0.0, attributes={"a": [1, 2, 3]})
    with pytest.raises(TypeError, match="expected a dict of names and arrays"):
        tegl.contour_mesh(points, cells, values, 0.0, attributes=["a"])


def test_attributes_of_a_file_are_read_by_name(tmp_path):
    table = tmp_path / "points.csv"
    table.write_text("x,y,f,g\n" + "".join(f"{x},{y},{x + 2 * y},{3 * x}\n" for x in range(5) for y in range(5)))
    mesh = tegl.read_mesh(table, "f", others=["g"])
    line = mesh.contour(5.5, attributes=["g"], dtype=np.float64)
    assert np.allclose(line.vertex_attributes["g"], 3 * line.vertices[:, 0])
    assert mesh.count(5.5) == (len(line.vertices), len(line.simplices))
    with pytest.raises(ValueError, match="attributes has 'h'; expected names among 'f', 'g'"):
        mesh.contour(5.5, attributes=["h"])


def test_lattices_are_periodic_closed_and_recorded_in_files(tmp_path):
    k, j, i = np.meshgrid(np.arange(20), np.arange(12), np.arange(12), indexing="ij")
    turn = 2 * np.pi / np.array([20.0, 12.0, 12.0])
    z, y, x = turn[0] * k, turn[1] * (j + 0.5 * (k % 2)), turn[2] * (i + 0.5 * (k % 2))
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    cell = tegl.contour(gyroid, 0.01, lattice="fcc", periodic="all", dtype=np.float64)
    assert cell.check().is_closed and cell.check().euler == -8
    assert tegl.count(gyroid, 0.01, lattice="fcc", periodic="all") == (len(cell.vertices), len(cell.simplices))
    assert tegl.contour(gyroid, 0.01, lattice="bcc", close=True).check().is_closed
    with pytest.raises(ValueError, match="expected an even number"):
        tegl.contour(gyroid[:19], 0.01, lattice="fcc", periodic=0)

    np.savez(tmp_path / "a.npz", values=gyroid, sample_lattice="fcc")
    image = tegl.read(tmp_path / "a.npz")
    assert image.lattice == "fcc"
    own = tegl.contour(image, 0.01, dtype=np.float64)
    assert len(own.vertices) == len(tegl.contour(gyroid, 0.01, lattice="fcc").vertices)
    assert len(own.vertices) == tegl.count(image, 0.01).vertices
    cubic = tegl.contour(image, 0.01, lattice="cubic")
    assert len(cubic.vertices) == len(tegl.contour(gyroid, 0.01).vertices)
    with pytest.raises(ValueError, match="on the lattice fcc, which only tegl.contour and tegl.count know"):
        tegl.filter(image, median=1)
    with pytest.raises(ValueError, match="positions_image is on the lattice fcc; expected an image on a cubic grid"):
        tegl.contour(gyroid, 0.01, positions="filtered", positions_image=image)


def test_curved_grids_are_periodic():
    angle, radius = np.meshgrid(np.linspace(0, 2 * np.pi, 60, endpoint=False), np.linspace(1, 2, 20), indexing="ij")
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    ring = tegl.contour(1.5 - radius, 0.0, curved={0: x, 1: y}, periodic=0, normals=True, dtype=np.float64)
    assert ring.check().is_closed and ring.check().components == 1
    assert abs(np.hypot(*ring.vertices.T) - 1.5).max() < 0.003
    assert abs(ring.normals - ring.vertices / 1.5).max() < 0.05

    lon, lat = np.meshgrid(np.arange(-175.0, 185.0, 10.0), np.arange(-80.0, 81.0, 10.0))
    away = lon - 180 - 360 * np.round((lon - 180) / 360)
    spot = 40 - np.hypot(away, lat)
    for periodic in ("lon", {"lon": 360.0}, "auto"):
        around = tegl.contour(spot, 0.0, curved={"lon": lon, "lat": lat}, periodic=periodic, axis_names=("lat", "lon"),
                              axis_units=("degrees_north", "degrees_east"), dtype=np.float64)
        assert around.check().is_closed and around.check().components == 1
        flat = around.unroll()[0]
        segments = flat.vertices[flat.simplices]
        assert abs(segments[:, 0] - segments[:, 1]).max() < 20

    # longitudes that descend
    for periodic in ("lon", {"lon": 360.0}, "auto"):
        back = tegl.contour(spot[:, ::-1], 0.0, curved={"lon": lon[:, ::-1], "lat": lat}, periodic=periodic,
                            axis_names=("lat", "lon"), axis_units=("degrees_north", "degrees_east"), dtype=np.float64)
        assert back.check().is_closed and back.check().components == 1
        assert abs(back.measure().content) == pytest.approx(abs(around.measure().content))


def test_longitudes_of_curved_grids_are_continued_across_180_degrees():
    lat, true = np.meshgrid(np.arange(6) * 10.0, np.arange(36) * 10.0 + 100, indexing="ij")
    names = {"axis_names": ("lat", "lon"), "axis_units": ("degrees_north", "degrees_east"), "dtype": np.float64}
    for order, time_axis in (("C", 0), ("F", 0), ("C", -1)):
        lon = np.array((true + 180) % 360 - 180, order=order)
        given = lon.copy()
        lon.flags.writeable = False
        for periodic in (None, "lon", "auto", {"lon": 360}):
            line = tegl.contour(lat - 25, -3.0, curved={0: lat, 1: lon}, periodic=periodic, time_axis=time_axis, **names)
            expected = tegl.contour(lat - 25, -3.0, curved={0: lat, 1: true}, periodic=periodic, time_axis=time_axis, **names)
            assert_same(line, expected)
            assert line.measure().size == pytest.approx(350 if periodic is None else 360)
            assert line.periods.tolist() == ([] if periodic is None else [[0, 360]])
        assert np.array_equal(lon, given), "the caller's array stays as it is"
    grid, points = tegl.CurvedGrid({0: lat, 1: given}), np.stack([lat, given], axis=-1)
    around = tegl.contour(lat - 25, -3.0, curved={0: lat, 1: true}, periodic="lon", **names)
    for curved in (grid, grid, points, {0: lat.astype(np.float32), 1: given.astype(np.float32)}):
        assert_same(tegl.contour(lat - 25, -3.0, curved=curved, periodic="lon", **names), around)
    assert np.array_equal(grid.coordinates[1], given) and np.array_equal(points[..., 1], given)
    land = np.zeros(lat.shape, bool)
    land[:, 0] = land[2, 3:28] = True
    masked = {0: np.where(land, np.nan, lat), 1: np.where(land, np.nan, (true + 180) % 360 - 180)}
    line = tegl.contour(np.where(land, np.nan, true - 300), -3.0, curved=masked, **names)
    assert np.allclose(line.vertices[:, 1], 297) and len(line.vertices) > 1
    with pytest.warns(UserWarning, match="the curved grid is folded in 5 cells"):
        plain = tegl.contour(lat - 25, -3.0, curved={0: lat, 1: given}, axis_names=("lat", "lon"), dtype=np.float64)
    assert plain.vertices[:, 1].max() < 180, "other units are not continued"


def test_count_has_the_size_of_contours_of_meshes_lattices_and_divisions():
    points, cells = tetrahedra(9)
    for options in ({}, {"close": True}):
        contour = tegl.contour_mesh(points, cells, ball(points), -0.2, **options)
        assert tegl.count_mesh(points, cells, ball(points), -0.2, **options) == (len(contour.vertices),
                                                                                 len(contour.simplices))
    values = np.random.default_rng(3).random((9, 10, 11))
    for options in ({"lattice": "fcc"}, {"lattice": "bcc"}, {"division": "kuhn"}, {"division": "symmetric"}):
        contour = tegl.contour(values, 0.5, **options)
        assert tegl.count(values, 0.5, **options) == (len(contour.vertices), len(contour.simplices))
    with pytest.raises(ValueError, match="lattice with division; expected one of the two"):
        tegl.count(values, 0.5, lattice="fcc", division="kuhn")


def test_curved_grids_take_positions():
    i, j, k = np.meshgrid(*[np.arange(16.0)] * 3, indexing="ij")
    mask = ((i - 7.5)**2 + (j - 7.5)**2 + (k - 7.5)**2 < 30).astype(np.uint8)
    lon = 2 * k + 0.05 * j
    curved = tegl.contour(mask, 0.5, curved={2: lon}, positions="relaxed", dtype=np.float64)
    plain = tegl.contour(mask, 0.5, positions="relaxed", dtype=np.float64)
    assert np.array_equal(curved.simplices, plain.simplices)
    expected = plain.vertices * [1, 1, 2] + plain.vertices[:, [1]] * [0, 0, 0.05]
    assert np.allclose(curved.vertices, expected, atol=1e-9)


def test_axes_without_names_are_given_by_number():
    with pytest.raises(ValueError, match="the axes have no names; expected a number from -3 to 2, or axis_names"):
        tegl.contour(np.zeros((4, 4, 4)), 0.5, periodic="lon")
