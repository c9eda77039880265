# SPDX-License-Identifier: BSD-3-Clause
"""Curved grids: coordinates in arrays, as points and in a CurvedGrid."""

import numpy as np
import pytest
import tegl


def curved_image(ndim, dtype=np.float64):
    """Noise, and coordinates that grow along their own axis by 1 and are moved by waves, as an array of the shape (..., N)."""
    random = np.random.default_rng(ndim)
    shape = tuple(range(9, 9 - ndim, -1))
    index = np.stack(np.meshgrid(*[np.arange(n, dtype=np.float64) for n in shape], indexing="ij"), axis=-1)
    return random.random(shape), (index + 0.1 * np.sin(index[..., ::-1] + 0.3)).astype(dtype)


def same_contours(one, other):
    return (np.array_equal(one.vertices, other.vertices) and np.array_equal(one.simplices, other.simplices)
            and one.vertices.dtype == other.vertices.dtype)


@pytest.mark.filterwarnings("ignore:the curved grid is folded")  # across the seam
@pytest.mark.parametrize("ndim", [2, 3, 4])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_curved_points_and_grids_give_the_contours_of_arrays(ndim, dtype):
    values, points = curved_image(ndim, dtype)
    for time_axis in (0, -1):
        for vertex_type in (np.float32, np.float64):
            given = {"time_axis": time_axis, "dtype": vertex_type}
            columns = {axis: np.array(points[..., axis], dtype=np.float64) for axis in range(ndim)}
            expected = tegl.contour(values, 0.5, curved=columns, **given)
            assert len(expected.simplices) > 50
            wide = np.concatenate([points, points[..., :2]], axis=-1)
            turned = np.ascontiguousarray(points.transpose(*range(ndim)[::-1], ndim)).transpose(*range(ndim)[::-1], ndim)
            for curved in (points, points.astype(points.dtype.newbyteorder()), wide[..., :ndim], turned, points[::-1][::-1],
                           {axis: np.asfortranarray(points[..., axis]) for axis in range(ndim)}, tegl.CurvedGrid(points),
                           tegl.CurvedGrid(columns), tegl.CurvedGrid({axis: columns[axis] for axis in (1, 0, *range(2, ndim))}),
                           {axis - ndim: points[..., axis] for axis in range(ndim)}):
                assert same_contours(tegl.contour(values, 0.5, curved=curved, **given), expected)
            closed = tegl.contour(values, 0.5, curved=columns, periodic=1, **given)
            assert same_contours(tegl.contour(values, 0.5, curved=tegl.CurvedGrid(points), periodic=1, **given), closed)
            assert same_contours(tegl.contour(values, 0.5, curved=points, periodic=1, **given), closed)


def test_coordinates_are_read_in_place():
    from tegl import _arguments, _curved
    values, points = curved_image(3)
    in_order = {0: points, -1: np.asfortranarray(points.transpose(3, 0, 1, 2)).transpose(1, 2, 3, 0)}
    for time_axis, ordered in in_order.items():
        prepared = _arguments.prepare(values, time_axis=time_axis)
        for dtype in (np.float32, np.float64):
            array = np.array(ordered, dtype=dtype)  # strides stay
            found = _curved.coordinates_of(array, prepared)
            assert all(np.shares_memory(one[2], array) for one in found), (time_axis, dtype)
            pitch = array.strides[2 if time_axis == 0 else 0] // array.itemsize
            assert [one[3] for one in found] == [pitch] * 3
        assert not any(np.shares_memory(one[2], ordered) for one in _curved.coordinates_of(ordered[::-1], prepared))
    assert {one[2].dtype for one in _curved.coordinates_of(points.astype(int), _arguments.prepare(values))} == {np.dtype("f8")}


def test_curved_grids_are_read_in_place_in_both_orders_of_samples():
    from tegl import _arguments, _curved
    values, points = curved_image(3, np.float32)
    x, y, z = np.moveaxis(points, -1, 0)
    for given in (points, {1: y, 0: x, 2: z}, {-1: z, 0: x, np.int64(1): y}):
        grid = tegl.CurvedGrid(given)
        assert list(grid.coordinates) == (list(range(3)) if given is points else list(given))
        for time_axis in (0, -1):
            prepared = _arguments.prepare(values, time_axis=time_axis)
            first, second = (_curved.coordinates_of(grid, prepared) for _ in range(2))
            for (axis, _, array, pitch, _), again in zip(first, second):
                assert pitch == 4 and array.dtype == np.float32 and not array.flags.writeable
                assert np.shares_memory(array, again[2])
                assert np.array_equal(array, points[..., 2 - axis if time_axis == 0 else axis])
            # side by side, in the order of the axes: the library then interpolates them together
            addresses = [one[2].ctypes.data for one in sorted(first, key=lambda one: one[0])]
            step = -4 if time_axis == 0 else 4
            assert [address - addresses[0] for address in addresses] == [0, step, 2 * step]


@pytest.mark.filterwarnings("ignore:the curved grid is folded")  # across the seam
def test_curved_grids_are_checked_for_folds_once_for_each_way_to_read_them(monkeypatch):
    from tegl import _tegl
    values, points = curved_image(3, np.float32)
    points[4] = points[2]
    grid = tegl.CurvedGrid(points)
    calls = []
    find_folds = _tegl.find_folds
    monkeypatch.setattr(_tegl, "find_folds", lambda *given: calls.append(given) or find_folds(*given))

    def warnings_of(curved, **given):
        with pytest.warns(UserWarning, match="the curved grid is folded") as caught:
            tegl.contour(values, 0.5, curved=curved, **given)
        return [str(one.message) for one in caught]

    ways = [{"time_axis": time_axis, **periodic} for time_axis in (0, -1) for periodic in ({}, {"periodic": 1}, {"periodic": 0},
            {"periodic": {1: 7.5}})]
    expected = [warnings_of(points, **way) for way in ways]
    assert len(calls) == len(ways)
    assert len({str(one) for one in expected}) > 2
    for _ in range(2):
        assert [warnings_of(grid, **way) for way in ways] == expected
    assert len(calls) == 2 * len(ways)


def test_curved_grids_are_stored_once_and_warn_of_each_fold():
    values, points = curved_image(3, np.float32)
    grid = tegl.CurvedGrid(points.astype(np.float64))
    assert [one.dtype for one in grid.coordinates.values()] == [np.float32] * 3  # exact
    assert repr(grid) == "<tegl.CurvedGrid 0: 9 x 8 x 7 float32, 1: 9 x 8 x 7 float32, 2: 9 x 8 x 7 float32>"
    assert all(np.array_equal(grid.coordinates[axis], points[..., axis]) for axis in range(3))
    with pytest.raises(ValueError, match="read-only"):
        grid.coordinates[0][0, 0, 0] = 1
    points[4] = points[2]
    folded = tegl.CurvedGrid(points)
    for curved in (folded, folded, points):
        with pytest.warns(UserWarning, match=r"folded in 42 cells, the first at the sample \(3, 0, 0\)"):
            tegl.contour(values, 0.5, curved=curved)


def test_one_array_may_be_the_coordinates_along_two_axes():
    values, _ = curved_image(2)
    r = np.linspace(0, 1, 8)
    values = values[:8]
    curved = {0: r[:, np.newaxis], 1: r[np.newaxis, :]}
    expected = tegl.contour(values, 0.5, curved={axis: one.copy() for axis, one in curved.items()}, dtype=np.float64)
    assert len(expected.simplices) > 10
    assert same_contours(tegl.contour(values, 0.5, curved=curved, dtype=np.float64), expected)


def test_bad_curved_points_are_errors():
    values, points = curved_image(3)
    with pytest.raises(ValueError, match=r"curved has the shape \(9, 8, 7, 2\); expected \(9, 8, 7, 3\)"):
        tegl.contour(values, 0.5, curved=points[..., :2])
    with pytest.raises(ValueError, match=r"curved\[0\] has the shape \(9, 8, 6\); expected \(9, 8, 7\)"):
        tegl.contour(values, 0.5, curved=points[:, :, :6])
    with pytest.raises(ValueError, match=r"curved has the shape \(9, 8, 7, 2\); expected \(\.\.\., N\) with N other axes"):
        tegl.CurvedGrid(points[..., :2])
    with pytest.raises(TypeError, match="expected a dict of axes and arrays of coordinates, an array"):
        tegl.CurvedGrid([1, 2])
    for scalar in (np.float64(3), np.array([1.0])):
        with pytest.raises(ValueError, match=r"curved has the shape \(1?,?\); expected \(\.\.\., N\) with N other axes"):
            tegl.CurvedGrid(scalar)
    with pytest.raises(TypeError, match="curved are of type <U1; expected real numbers"):
        tegl.contour(values, 0.5, curved=np.array([["a"]]))
    for time_axis, order in ((0, "C"), (-1, "F")):
        x = np.array(points[..., 0], order=order)  # read in place
        with pytest.raises(ValueError) as raised:
            tegl.contour(values, 0.5, curved={0: x, 1: x}, time_axis=time_axis)
        assert str(raised.value) == ("the curved coordinates of axis 0 and of axis 1 are the same numbers in memory; expected "
                                     "coordinates of its own for each axis")
    points[4, 4, :, 1] = np.nan
    with pytest.raises(ValueError, match="unknown coordinates; expected missing values there"):
        tegl.contour(values, 0.5, curved=points)
