# SPDX-License-Identifier: BSD-3-Clause
"""Contours as facets: their lists fit together, and they are those that `tegl.contour` divides."""

import numpy as np
import pytest
import tegl

SIZES = {2: (9, 12), 3: (7, 8, 9), 4: (5, 6, 5, 6)}
NAMES = ("points", "segments", "polygons", "polyhedra")


def noise(sizes, seed=3):
    return np.random.default_rng(seed).random(sizes)


def rows(offsets, entries):
    """A list of arrays."""
    return np.split(entries, np.asarray(offsets[1:-1], dtype=np.intp))


def row_of(offsets):
    """The row of each entry."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets.astype(int)))


def has_closed_boundaries(level, below):
    """Whether the boundary of the boundary is zero."""
    counts = np.diff(below.offsets.astype(int))[level.boundary]
    entries = np.concatenate([[0], *(np.arange(below.offsets[g], below.offsets[g + 1]) for g in level.boundary)])[1:]
    keys = np.repeat(row_of(level.offsets), counts) * 2**32 + below.boundary[entries]
    _, places = np.unique(keys, return_inverse=True)
    return not np.bincount(places, np.repeat(level.signs, counts) * below.signs[entries].astype(int)).any()


def require_lists(facets):
    """Everything that holds for the lists of any facets."""
    assert len(facets) == facets.ndim
    assert len(facets[0]) == len(facets.vertices)
    for k, level in enumerate(facets):
        assert level.dimension == k
        assert len(level.offsets) == len(level.up_offsets) == len(level.point_offsets) == len(level) + 1
        assert len(level.cells) == len(level.signatures) == len(level.numbers) == len(level.is_cap) == len(level)
        assert level.offsets[-1] == len(level.boundary) == len(level.signs)
        assert level.point_offsets[-1] == len(level.points)
        assert set(np.unique(level.signs)) <= {-1, 1}
        assert not level.boundary.flags.writeable and not level.points.flags.writeable
        points = rows(level.point_offsets, level.points)
        if k == 0:
            assert len(level.boundary) == 0
            assert np.array_equal(level.points, np.arange(len(level)))
            continue
        below = facets[k - 1]
        # the boundary of the boundary is zero
        if k > 1:
            assert has_closed_boundaries(level, below)
        # up is the transpose of down
        assert len(below.coboundary) == len(level.boundary)
        down = sorted(zip(level.boundary, row_of(level.offsets), level.signs))
        assert down == list(zip(row_of(below.up_offsets), below.coboundary, below.up_signs))
        # the points of the boundary
        for f, entries in enumerate(rows(level.offsets, level.boundary)):
            of_boundary = {p for g in entries for p in below.points[below.point_offsets[g]:below.point_offsets[g + 1]]}
            assert set(points[f]) == of_boundary
        if k == 2:  # each segment starts at the end of the previous one, the first at the first point
            segments = facets[1].boundary.reshape(-1, 2)
            for f in range(len(level)):
                part = slice(level.offsets[f], level.offsets[f + 1])
                starts = [segments[s, 0 if sign > 0 else 1] for s, sign in zip(level.boundary[part], level.signs[part])]
                assert starts == list(points[f])
    assert len(facets[-1].coboundary) == 0
    euler = sum((-1) ** k * int(level.euler.sum()) for k, level in enumerate(facets))
    report = facets.check()
    assert report.is_manifold and report.euler == euler and report.counts == tuple(map(len, facets))
    pairs, ridges = facets.neighbours()
    assert len(pairs) == len(ridges) == len(facets[-2]) - report.border
    for pair, ridge in list(zip(pairs, ridges))[:20]:
        for f in pair:
            assert ridge in facets[-1].boundary[facets[-1].offsets[f]:facets[-1].offsets[f + 1]]
    return report


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("close", [False, True])
@pytest.mark.parametrize("ambiguity", ["low", "saddle"])
@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_facets_of_arrays_are_those_of_the_contour(ndim, ambiguity, close, time_axis):
    array = noise(SIZES[ndim])
    arguments = dict(ambiguity=ambiguity, close=close, time_axis=time_axis, normals=True, dtype=np.float64)
    facets = tegl.contour_facets(array, 0.5, **arguments)
    contour = tegl.contour(array, 0.5, **arguments)
    report, expected = require_lists(facets), contour.check()
    assert (report.euler, report.components) == (expected.euler, expected.components)
    assert report.is_closed == expected.is_closed == close
    vertices = set(map(tuple, np.hstack([contour.vertices, contour.normals])))
    assert vertices >= set(map(tuple, np.hstack([facets.vertices, facets.normals])))
    assert (facets[-1].is_cap.any(), facets.isovalue, facets.direction) == (close, 0.5, "descent")
    assert repr(facets) == f"<tegl.Facets at 0.5: {', '.join(f'{len(facets[k])} {NAMES[k]}' for k in range(ndim))}>"
    # places: the face around a point on an edge has its two samples
    on_edges = ~facets[0].is_cap & (facets[0].axes.sum(axis=1) == 1)
    lowest, axes = facets[0].samples[on_edges], facets[0].axes[on_edges]
    assert on_edges.any()
    inside = [array[tuple(index)] >= 0.5 for index in lowest]
    beyond = [array[tuple(index)] >= 0.5 for index in lowest + axes]
    assert not np.any(np.equal(inside, beyond))
    assert np.all(facets.vertices[on_edges] >= lowest) and np.all(facets.vertices[on_edges] <= lowest + axes)
    order = "C" if time_axis == 0 else "F"
    assert np.array_equal(np.ravel_multi_index(facets[-1].samples.T, array.shape, order=order), facets[-1].cells)
    assert facets.cell_count is None


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("direction", ["descent", "ascent"])
def test_the_highest_facets_face_the_side_of_the_contour(direction, time_axis):
    sign = 1 if direction == "descent" else -1
    for ndim in (2, 3):
        axes = np.meshgrid(*[np.arange(9.0) - 4.1] * ndim, indexing="ij")
        ball = 3.2 - np.sqrt(sum(x**2 for x in axes))
        facets = tegl.contour_facets(ball, 0.0, direction=direction, time_axis=time_axis, dtype=np.float64)
        contour = tegl.contour(ball, 0.0, direction=direction, time_axis=time_axis, dtype=np.float64)
        level, x = facets[-1], facets.vertices - 4.1
        for points in rows(level.point_offsets, level.points):
            a, b = x[points[0]], x[points[1]]
            if ndim == 2:
                normal = np.linalg.det(np.array([b - a, a + b])) * sign
            else:
                around = sum(np.cross(x[p], x[q]) for p, q in zip(points, np.roll(points, -1)))
                normal = around @ x[points].mean(axis=0) * sign
            assert normal > 0
        # as the simplices: the facets have the same sum of cross products, or of directions
        simplices = contour.vertices[contour.simplices] - 4.1
        if ndim == 3:
            volume = sum(np.cross(x[p[0]], x[p[i]]) @ x[p[i + 1]]
                         for p in rows(level.point_offsets, level.points) for i in range(1, len(p) - 1)) / 6
            assert np.linalg.det(simplices).sum() / 6 == pytest.approx(volume, rel=0.01)
        else:
            area = sum(np.linalg.det(x[p]) for p in rows(level.point_offsets, level.points)) / 2
            assert np.linalg.det(simplices).sum() / 2 == pytest.approx(area)


def test_the_coordinates_of_the_array_are_those_of_the_facets(tmp_path):
    array = noise((6, 7, 8))
    facets = tegl.contour_facets(array, 0.5, spacing=(3, 2, 1), origin=10, axis_names=["z", "y", "x"],
                                 axis_units=["m", "m", "s"], epsilon=0.01)
    assert facets.axis_names == ("z", "y", "x") and facets.axis_units == ("m", "m", "s")
    assert np.all(facets.vertices.max(axis=0) <= 10 + 3 * np.array([5, 4, 7 / 3]))
    for name in ("polygons.vtu", "polygons.vtkhdf"):
        facets.save(tmp_path / name)
        size = (tmp_path / name).stat().st_size
        facets.save(tmp_path / name, compress=True)
        assert 0 < (tmp_path / name).stat().st_size < size
    with pytest.raises(ValueError, match="ply"):
        facets.save(tmp_path / "polygons.ply")
    with pytest.raises(ValueError, match=r"facets that are not triangulated: cells of VTK type 7 \(polygons\).*without --facets"):
        tegl.load(tmp_path / "polygons.vtkhdf")
    for method in ("fan", "zigzag", "halving-chord", "halving-kink", "barycentric"):
        surface = facets.triangulate(method)
        assert surface.check().is_manifold and surface.check().euler == facets.check().euler
        assert np.array_equal(surface.vertices[:len(facets.vertices)], facets.vertices)
    whole = tegl.contour(array, 0.5, spacing=(3, 2, 1), origin=10, epsilon=0.01)
    # polygons of noise are far from plane
    assert facets.triangulate().measure().size == pytest.approx(whole.measure().size, rel=0.05)


def gyroid(x, y, z):
    return np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)


def test_facets_of_a_periodic_array_are_closed():
    turn = 2 * np.pi * np.arange(16) / 16
    array = gyroid(*np.meshgrid(turn, turn, turn, indexing="ij"))
    facets = tegl.contour_facets(array, 0.01, periodic="all")
    report = require_lists(facets)
    assert report.is_closed and report.euler == -8 and report.components == 1
    assert sorted(map(tuple, facets.periods)) == [(0, 0, 16), (0, 16, 0), (16, 0, 0)]
    one = tegl.contour_facets(array, 0.01, periodic=[0])
    assert not one.check().is_closed and np.array_equal(one.periods, [[16, 0, 0]])
    assert tegl.contour_facets(array, 0.01, periodic={0: 20.0}).periods[0, 0] == 20


@pytest.mark.parametrize("lattice, sizes", [("fcc", (16, 12, 12)), ("bcc", (20, 10, 10))])
def test_facets_of_periodic_lattices_are_closed(lattice, sizes):
    k, j, i = np.meshgrid(*map(np.arange, sizes), indexing="ij")
    z, y, x = 2 * np.pi * k / sizes[0], 2 * np.pi * (j + k % 2 / 2) / sizes[1], 2 * np.pi * (i + k % 2 / 2) / sizes[2]
    array = gyroid(x, y, z)
    facets = tegl.contour_facets(array, 0.01, lattice=lattice, periodic="all", normals=True)
    contour = tegl.contour(array, 0.01, lattice=lattice, periodic="all")
    report = require_lists(facets)
    assert report.is_closed and report.euler == contour.check().euler == -8
    assert len(facets.vertices) == len(contour.vertices) and len(facets.periods) == 3
    # layers are as far apart as in the regular lattice
    assert facets.periods.max() == pytest.approx(np.abs(contour.periods).max())
    assert facets.cell_count == 3 * array.size * (1 if lattice == "fcc" else 2)
    assert facets[2].samples is None and facets[2].axes is None
    assert facets[2].cells.max() < facets.cell_count
    with pytest.raises(ValueError, match="mesh or lattice"):
        facets.triangulate()


@pytest.mark.parametrize("division", ["kuhn", "alternating", "symmetric", "hybrid"])
def test_facets_of_divisions_are_one_for_each_simplex(division):
    turn = 2 * np.pi * np.arange(12) / 12
    array = gyroid(*np.meshgrid(turn, turn, turn, indexing="ij"))
    facets = tegl.contour_facets(array, 0.01, division=division, periodic="all", normals=True)
    contour = tegl.contour(array, 0.01, division=division, periodic="all")
    report = require_lists(facets)
    assert report.is_closed and report.euler == contour.check().euler == -8
    assert len(facets.vertices) == len(contour.vertices) and len(facets.normals) == len(facets.vertices)
    if division != "hybrid":
        corners = np.diff(facets[2].offsets.astype(int))
        assert set(corners) == {3, 4} and (corners - 2).sum() == len(contour.simplices)
    with pytest.raises(ValueError, match="with division; expected one of the two"):
        tegl.contour_facets(array, 0.01, division=division, lattice="fcc")
    with pytest.raises(ValueError, match="division is 'cubes'"):
        tegl.contour_facets(array, 0.01, division="cubes")


def tetrahedra_of(n):
    """Points of a cubic grid, and six tetrahedra in each cube."""
    points = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(n**3).reshape(n, n, n)
    cells = []
    for path in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        at, corners = np.zeros(3, dtype=int), []
        for axis in (None, *path):
            if axis is not None:
                at[axis] += 1
            corners.append(number[tuple(slice(a, n - 1 + a) for a in at)].ravel())
        cells.append(np.stack(corners, axis=1))
    return points.astype(float), np.concatenate(cells)


def test_facets_of_meshes_have_the_cells_of_their_mesh():
    points, cells = tetrahedra_of(6)
    values = noise(len(points))
    facets = tegl.contour_mesh_facets(points, {"tetra": cells}, values, 0.5, dtype=np.float64, normals=True)
    contour = tegl.contour_mesh(points, {"tetra": cells}, values, 0.5, dtype=np.float64, normals=True)
    require_lists(facets)
    assert np.array_equal(facets.vertices, contour.vertices) and np.array_equal(facets.normals, contour.normals)
    active = np.flatnonzero((values[cells] >= 0.5).any(axis=1) & (values[cells] < 0.5).any(axis=1))
    assert np.array_equal(facets[2].cells, active) and facets.cell_count == len(cells)
    bits = (values[cells[active]] >= 0.5) @ (1 << np.arange(4))
    assert np.array_equal(facets[2].signatures, bits)
    # triangles, or quadrilaterals where two corners are high
    corners = np.diff(facets[2].offsets.astype(int))
    assert np.array_equal(corners == 4, (values[cells[active]] >= 0.5).sum(axis=1) == 2)
    closed = tegl.contour_mesh_facets(points, cells, values, 0.5, close=True)
    assert require_lists(closed).is_closed and closed[2].is_cap.any()


def test_facets_of_mixed_and_moving_meshes():
    # a cube with a pyramid on its top: hexahedra come after pyramids
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0.5, 0.5, 2]])
    mixed = {"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]], "pyramid": [[4, 5, 6, 7, 8]]}
    two = tegl.contour_mesh_facets(cube, mixed, [1, 0, 0, 0, 0, 0, 1, 0, 0], 0.5, ambiguity="mean")
    require_lists(two)
    assert two.cell_count == 2 and list(two[2].cells) == [0, 1, 1]
    points, cells = tetrahedra_of(4)
    # over time: polyhedra in prisms
    over_time = np.stack([noise(64, 1), noise(64, 2), noise(64, 3)])
    moving = tegl.contour_mesh_facets(points, cells, over_time, 0.5, times=[0.0, 0.5, 2.0])
    assert moving.ndim == 4 and moving[3].dimension == 3
    report = require_lists(moving)
    contour = tegl.contour_mesh(points, cells, over_time, 0.5, times=[0.0, 0.5, 2.0]).check()
    assert (report.euler, report.components) == (contour.euler, contour.components)
    plane = tegl.contour_mesh_facets([[0, 0], [1, 0], [1, 1], [0, 1]], {"polygon": [[0, 1, 2, 3]]}, [0, 1, 0, 1], 0.5)
    require_lists(plane)
    assert len(plane[1]) == 2


def test_facets_of_polyhedra_and_polytopes():
    cube = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    one = tegl.contour_mesh_facets(cube, {"polyhedron": [faces]}, [0, 0, 0, 0, 1, 1, 1, 1], 0.5)
    require_lists(one)
    assert len(one[2]) == 1 and len(one[1]) == 4
    # a 4-simplex as a polytope: one high corner cuts it in a tetrahedron
    corners = np.vstack([np.zeros(4), np.eye(4)])
    facets = [[[a for a in range(5) if a not in (left, other)] for other in range(5) if other != left] for left in range(5)]
    cell = tegl.contour_mesh_facets(corners, {"polytope": [facets]}, [1, 0, 0, 0, 0], 0.5)
    require_lists(cell)
    assert [len(level) for level in cell] == [4, 6, 4, 1]


def test_an_image_and_a_mesh_have_their_facets(tmp_path):
    np.save(tmp_path / "values.npy", noise((5, 6, 7)))
    image = tegl.read(tmp_path / "values.npy")
    facets = image.contour_facets(0.5)
    assert facets.check() == tegl.contour_facets(image.array, 0.5).check()
    points, cells = tetrahedra_of(3)
    mesh = tegl.Mesh(points=points, cells=[("tetra", cells)], values=noise(27), times=np.empty(0), variable="p",
                     axis_names=("a", "b", "c"))
    assert mesh.contour_facets(0.5).axis_names == ("a", "b", "c")


def test_dtype_threads_and_missing_values():
    array = noise((7, 8, 9))
    assert tegl.contour_facets(array, 0.5).vertices.dtype == np.float32
    first, second = (tegl.contour_facets(array, 0.5, threads=threads, dtype=np.float64) for threads in (1, 4))
    assert np.array_equal(first.vertices, second.vertices) and np.array_equal(first[2].boundary, second[2].boundary)
    with_missing = tegl.contour_facets(array, 0.5, mask=noise(array.shape, 1) < 0.9)
    assert not require_lists(with_missing).is_closed
    assert len(with_missing.vertices) < len(first.vertices)
    fractions = []
    tegl.contour_facets(array, 0.5, progress=fractions.append)
    assert fractions[-1] == 1
    with pytest.raises(tegl.Cancelled):
        tegl.contour_facets(array, 0.5, progress=lambda fraction: False)


def test_no_contour_and_wrong_arguments():
    array = noise((5, 6, 7))
    for level in (-1.0, 2.0):
        with pytest.raises(ValueError, match=f"level is {level}"):
            tegl.contour_facets(array, level)
        empty = tegl.contour_facets(array, level, allow_empty=True)
        assert [len(one) for one in empty] == [0, 0, 0] and empty.vertices.shape == (0, 3)
        assert empty[2].samples.shape == (0, 3) and empty[1].points.shape == (0,)
        require_lists(empty)
    with pytest.raises(ValueError, match="normals is 'flat', which is for simplices"):
        tegl.contour_facets(array, 0.5, normals="flat")
    with pytest.raises(ValueError, match="normals is 'geometric'"):
        tegl.contour_mesh_facets(*tetrahedra_of(3), noise(27), 0.5, normals="geometric")
    with pytest.raises(ValueError, match="ambiguity is 'both'"):
        tegl.contour_facets(array, 0.5, ambiguity="both")
    with pytest.raises(ValueError, match="facets of a 5D"):
        tegl.contour_facets(noise((3, 3, 3, 3, 3)), 0.5)
    with pytest.raises(ValueError, match="lattice d4 of a 3D image"):
        tegl.contour_facets(array, 0.5, lattice="d4")
    with pytest.raises(ValueError, match="lattice is 'hcp'"):
        tegl.contour_facets(array, 0.5, lattice="hcp")
    with pytest.raises(ValueError, match="5 layers; expected an even number"):
        tegl.contour_facets(array, 0.5, lattice="fcc", periodic=0)
    with pytest.raises(ValueError, match="no axis is named 'lon'"):
        tegl.contour_facets(array, 0.5, periodic="lon")
    facets = tegl.contour_facets(array, 0.5)
    with pytest.raises(IndexError, match="facets of dimension 3; expected 0 to 2"):
        facets[3]
    with pytest.raises(ValueError, match="method is 'strips'"):
        facets.triangulate("strips")
    with pytest.raises(ValueError, match="triangulate"):
        tegl.contour_facets(array[0], 0.5).triangulate()
    with pytest.raises(TypeError, match="level is missing"):
        tegl.contour_mesh_facets(*tetrahedra_of(3), noise(27))
    with pytest.raises(ValueError, match="level is 7"):
        tegl.contour_mesh_facets(*tetrahedra_of(3), noise(27), 7)
