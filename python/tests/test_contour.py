# SPDX-License-Identifier: BSD-3-Clause
"""tegl.contour: what it takes, what it gives, and that nothing is copied on the way."""

import functools
import gc
import pickle
import sys
import time
import weakref

import numpy as np
import pytest
import tegl
from conftest import assert_closed_manifold, assert_same, ball, face_counts, noise, signed_content
from hypothesis import given, settings
from hypothesis import strategies as st

TYPES = [np.uint8, np.int8, np.uint16, np.int16, np.int32, np.float32, np.float64]


@pytest.mark.parametrize("ndim", [2, 3, 4, 5])
@pytest.mark.parametrize("time_axis", [0, -1])
def test_what_is_high_has_positive_content_and_normals_point_to_low(ndim, time_axis):
    array = ball(ndim, {2: 21, 3: 21, 4: 13, 5: 7}[ndim])
    contour = tegl.contour(array, 0.0, time_axis=time_axis, dtype=np.float64, normals=ndim < 5)
    content = signed_content(contour.vertices, contour.simplices)
    assert content > 0
    assert contour.measure().content == pytest.approx(content, rel=1e-9)
    middle = (array.shape[0] - 1) / 2
    if ndim < 5:
        outwards = contour.vertices - middle
        cosines = (outwards * contour.normals).sum(axis=1) / np.linalg.norm(outwards, axis=1)
        assert cosines.min() > 0.8
    reverse = tegl.contour(array, 0.0, time_axis=time_axis, dtype=np.float64, direction="ascent")
    assert signed_content(reverse.vertices, reverse.simplices) == pytest.approx(-content, rel=1e-9)


@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_content_is_positive_whatever_way_the_coordinates_run(ndim):
    array = ball(ndim)
    for signs in ([1] * ndim, [-1] * ndim, [-1] + [1] * (ndim - 1), [1] * (ndim - 1) + [-1]):
        contour = tegl.contour(array, 0.0, spacing=[2.0 * sign for sign in signs], dtype=np.float64)
        assert signed_content(contour.vertices, contour.simplices) > 0


@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_columns_are_in_the_order_of_the_arrays_axes(ndim):
    array = ball(ndim, 15)[tuple(slice(0, 9 + axis) for axis in range(ndim))]  # off the middle, in another way per axis
    array = np.pad(array, 1, constant_values=-1.0)
    contour = tegl.contour(array, 0.0, dtype=np.float64)
    for axis in range(ndim):
        on_axis = np.flatnonzero((array > 0).any(axis=tuple(a for a in range(ndim) if a != axis)))
        along = contour.vertices[:, axis]
        assert on_axis[0] - 1 <= along.min() <= on_axis[0]
        assert on_axis[-1] <= along.max() <= on_axis[-1] + 1


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.integers(2, 4), st.integers(0, 2**32 - 1), st.sampled_from(TYPES), st.booleans())
def test_contours_of_noise_are_closed_manifolds(ndim, seed, dtype, ties):
    shape = np.random.default_rng(seed).integers(2, {2: 12, 3: 8, 4: 5}[ndim] + 1, size=ndim)
    values = noise(shape, seed, np.float64) * (1.2 if ties else 20)
    array = np.abs(np.round(values)).astype(dtype) if np.dtype(dtype).kind == "u" else \
        (np.round(values) if ties else values).astype(dtype)
    level = 1.0
    contour = tegl.contour(array, level, close=True, allow_empty=True)
    assert_closed_manifold(contour.simplices)
    assert contour.check().is_manifold and contour.check().is_closed
    # Open, it ends at the border of the array alone.
    open_contour = tegl.contour(array, level, allow_empty=True)
    count, _ = face_counts(open_contour.simplices)
    last = np.array(array.shape) - 1
    for face, times in count.items():
        assert times in (1, 2)
        if times == 1:
            corners = open_contour.vertices[list(face)]
            assert ((corners == 0).all(axis=0) | (corners == last).all(axis=0)).any()


@pytest.mark.parametrize("dtype", TYPES)
def test_all_value_types_are_seen_as_they_are(dtype):
    array = np.clip(np.round(ball(3) * 100), 0, 100).astype(dtype)
    expected = tegl.contour(array.astype(np.float64), 20.0, dtype=np.float64)
    contour = tegl.contour(array, 20.0, dtype=np.float64)
    assert len(contour.simplices) > 0
    assert_same(contour, expected)


@pytest.mark.parametrize("dtype", [bool, np.float16, np.int64, np.uint32, np.uint64, ">i2", ">f8", "<f4"])
def test_other_types_become_the_librarys(dtype):
    array = (ball(3) > 0).astype(dtype)
    assert_same(tegl.contour(array, 0.5), tegl.contour(array.astype(np.uint8), 0.5))


def test_integers_beyond_32_bits_are_doubles():
    array = np.array([[0, 2**40], [0, 2**40]], dtype=np.int64)
    assert tegl.contour(array, 2.0**39, dtype=np.float64).vertices[:, 1] == pytest.approx([0.5, 0.5])


def test_any_strides_give_the_same_contour():
    array = noise((9, 10, 11), 5)
    expected = tegl.contour(array, 0.1)
    assert_same(tegl.contour(np.asfortranarray(array), 0.1), expected)
    assert_same(tegl.contour(np.ascontiguousarray(array[::-1, :, ::-1])[::-1, :, ::-1], 0.1), expected)
    wide = np.zeros((9, 30, 22), dtype=np.float32)
    wide[:, ::3, ::2] = array
    assert_same(tegl.contour(wide[:, ::3, ::2], 0.1), expected)
    assert_same(tegl.contour(np.moveaxis(np.ascontiguousarray(np.moveaxis(array, 0, 2)), 2, 0), 0.1), expected)
    records = np.zeros(array.shape, dtype=[("flag", "u1"), ("value", "f4")])
    records["value"] = array
    assert_same(tegl.contour(records["value"], 0.1), expected)
    assert_same(tegl.contour(np.broadcast_to(array[:1], array.shape), 0.1),
                tegl.contour(np.repeat(array[:1], 9, axis=0), 0.1))


def test_a_view_is_not_copied():
    array = noise((9, 10, 11), 5)
    for view in (array, array[::-1, :, ::2], np.asfortranarray(array), array > 0):
        prepared = tegl._arguments.prepare(view)
        assert prepared.image.array.__array_interface__["data"][0] == view.__array_interface__["data"][0]
        assert np.shares_memory(prepared.image.array, view)


def test_results_look_into_the_librarys_memory():
    contour = tegl.contour(noise((9, 10, 11), 5), 0.0, normals=True)
    assert np.shares_memory(contour.vertices, contour.vertices)
    assert contour.vertices.__array_interface__["data"] == contour.vertices.__array_interface__["data"]
    for array in (contour.vertices, contour.simplices, contour.normals):
        assert not array.flags.owndata and not array.flags.writeable


def test_arrays_outlive_their_contour_and_contours_their_array():
    array = noise((20, 20, 20), 7)
    contour = tegl.contour(array, 0.0, normals=True)
    expected = contour.vertices.copy(), contour.simplices.copy(), contour.normals.copy()
    del array
    kept = contour.vertices, contour.simplices, contour.normals
    references = sys.getrefcount(contour._core)
    del contour
    gc.collect()
    noise((200, 200), 1)  # something else in the memory that is free
    for one, other in zip(kept, expected):
        assert np.array_equal(one, other)
    assert references > 2


def test_contours_do_not_keep_the_array_and_indexes_do():
    array = noise((9, 10, 11), 5)
    before = sys.getrefcount(array)
    contour = tegl.contour(array, 0.0)
    assert sys.getrefcount(array) == before
    assert len(contour.elements(by_cell=True)) > 0  # its grid is known all the same
    index = tegl.Index(array)
    assert sys.getrefcount(array) > before
    del index
    gc.collect()
    assert sys.getrefcount(array) == before


def test_coordinates_spacing_and_affine_say_the_same():
    array = ball(3)[:, :-1, :-2]
    spacing, origin = (2.0, 0.5, -1.0), (10.0, -3.0, 7.0)
    expected = tegl.contour(array, 0.0, spacing=spacing, origin=origin, dtype=np.float64)
    unit = tegl.contour(array, 0.0, dtype=np.float64)
    assert np.allclose(expected.vertices, unit.vertices * spacing + origin)
    coords = [origin[axis] + spacing[axis] * np.arange(array.shape[axis]) for axis in range(3)]
    assert_same(tegl.contour(array, 0.0, coords=coords, dtype=np.float64), expected)
    affine = np.column_stack([np.diag(spacing), origin])
    assert np.allclose(tegl.contour(array, 0.0, affine=affine, dtype=np.float64).vertices, expected.vertices)


def test_an_affine_map_takes_indices_of_the_array_to_the_world():
    array = ball(3)[:, :-1, :-2]
    affine = np.eye(4)
    affine[:3] = [[0.0, 2.0, 0.1, 5.0], [1.0, 0.0, 0.3, 6.0], [0.2, 0.0, 3.0, 7.0]]
    contour = tegl.contour(array, 0.0, affine=affine, dtype=np.float64)
    unit = tegl.contour(array, 0.0, dtype=np.float64)
    assert np.allclose(contour.vertices, unit.vertices @ affine[:3, :3].T + affine[:3, 3])
    assert np.linalg.det(affine[:3, :3]) < 0 and signed_content(contour.vertices, contour.simplices) > 0


def test_coordinates_may_be_uneven_and_falling():
    array = ball(2, 9)
    coords = [np.arange(9)[::-1] ** 2 * 1.0, None]
    contour = tegl.contour(array, 0.0, coords=coords, dtype=np.float64)
    unit = tegl.contour(array, 0.0, dtype=np.float64)
    assert np.allclose(np.sort(contour.vertices[:, 0]),
                       np.sort(np.interp(unit.vertices[:, 0], np.arange(9), coords[0])))
    assert signed_content(contour.vertices, contour.simplices) > 0


def test_masked_samples_are_missing():
    array = noise((8, 9, 10), 3)
    mask = np.random.default_rng(4).random(array.shape) > 0.2
    with_nan = np.where(mask, array, np.float32(np.nan))
    expected = tegl.contour(with_nan, 0.1)
    assert expected.check().is_manifold
    assert_same(tegl.contour(array, 0.1, mask=mask), expected)
    assert_same(tegl.contour(np.ma.masked_array(array, ~mask), 0.1), expected)
    layers = [np.ma.masked_array(layer, ~valid) for layer, valid in zip(array, mask)]
    assert_same(tegl.contour(layers, 0.1), expected)
    assert_same(tegl.contour([layers, list(2 * np.ma.stack(layers))], 0.1),
                tegl.contour(np.stack([with_nan, 2 * with_nan]), 0.1))
    labels = np.ma.masked_array((2 * array).astype(np.int16), ~mask)
    assert_same(tegl.contour(list(labels), label=1), tegl.contour(labels, label=1))
    assert_same(tegl.contour(np.ma.masked_array(array, array > 9), 0.1, mask=mask), expected)
    assert np.isfinite(array).all(), "the caller's array is not written to"
    whole = (array * 100).astype(np.int16)
    assert_same(tegl.contour(whole, 10, mask=mask),
                tegl.contour(np.where(mask, whole, np.nan).astype(np.float32), 10))


def test_missing_samples_in_5d_leave_cells_out():
    array = noise((3, 3, 4, 4, 4), 1)
    whole = tegl.contour(array, 0.1)
    array[1, 1, 2, 1, 1] = np.nan
    contour = tegl.contour(array, 0.1)
    assert contour.check().is_manifold and 0 < len(contour.simplices) < len(whole.simplices)


def test_the_options_reach_the_library():
    array = np.round(noise((7, 8, 9), 11) * 2)
    low = tegl.contour(array, 0.0)
    assert tegl.contour(array, 0.0, ambiguity="high").check().euler != low.check().euler
    assert len(tegl.contour(array, 0.0, triangulation="barycentric").vertices) > len(low.vertices)
    assert low.check().degenerate_simplices > 0
    assert tegl.contour(array, 0.0, epsilon=0.1).check().degenerate_simplices == 0
    assert tegl.contour(array, 0.0, close=True).check().is_closed and not low.check().is_closed
    sobel = tegl.contour(array, 0.5, normals=True, gradient="sobel").normals
    assert not np.array_equal(sobel, tegl.contour(array, 0.5, normals=True).normals)
    assert low.normals is None
    rules = {rule: tegl.contour(array, 0.5, ambiguity=rule) for rule in ("mean", "saddle", "squares", "decider")}
    assert all(contour.check().is_manifold for contour in rules.values())
    assert rules["squares"].check().euler != rules["mean"].check().euler  # tunnels in cells
    for threads in (1, 3):
        assert_same(tegl.contour(array, 0.0, threads=threads), low)


def test_a_contour_says_what_it_is():
    contour = tegl.contour(ball(3), 0.25, axis_names=["z", "y", "x"], axis_units=["mm", "mm", "cm"])
    assert contour.ndim == 3 and contour.isovalue == 0.25 and contour.direction == "descent"
    assert contour.axis_names == ("z", "y", "x") and contour.axis_units == ("mm", "mm", "cm")
    assert contour.time_axis == 0 and tegl.contour(ball(3), 0.25, time_axis=-1).time_axis == 2
    assert "triangles" in repr(contour) and "0.25" in repr(contour)
    assert tegl.contour(ball(3), 5.0, allow_empty=True).vertices.shape == (0, 3)


@pytest.mark.parametrize("arguments, error, text", [
    (dict(array=np.zeros(5)), ValueError, "1 axes; expected 2 to 5"),
    (dict(array=np.zeros((2,) * 6)), ValueError, "6 axes; expected 2 to 5"),
    (dict(array=np.zeros((3, 3), complex)), TypeError, "complex128; expected real numbers"),
    (dict(array=np.zeros((3, 0))), ValueError, "axis"),
    (dict(level=np.nan), ValueError, "nan"),
    (dict(level=np.inf), ValueError, "inf"),
    (dict(epsilon=0.5), ValueError, "0.5"),
    (dict(triangulation="other"), ValueError, "triangulation is 'other'; expected one of 'compact', 'barycentric'"),
    (dict(ambiguity="other"), ValueError,
     "ambiguity is 'other'; expected one of 'low', 'high', 'mean', 'saddle', 'squares', 'decider'"),
    (dict(direction="up"), ValueError, "direction is 'up'; expected one of 'descent', 'ascent'"),
    (dict(gradient="central"), ValueError, "gradient is 'central'"),
    (dict(dtype=np.int32), ValueError, "dtype is int32; expected float32 or float64"),
    (dict(threads=-1), ValueError, "threads is -1"),
    (dict(spacing=(1, 2)), ValueError, "spacing has 2 numbers; expected one for each of 3 axes"),
    (dict(spacing=(1, 0, 1)), ValueError, "axis 1 has the origin 0 and the spacing 0"),
    (dict(coords=[None, None]), ValueError, "coords has 2 entries; expected one for each of 3 axes"),
    (dict(coords=[None, [1, 2], None]), ValueError, "axis 1 has 11 samples and 2 coordinates"),
    (dict(coords=[None, None, np.zeros(11)]), ValueError, "strictly ascending"),
    (dict(coords=[None] * 3, spacing=2), ValueError, "coords with spacing or origin"),
    (dict(affine=np.eye(3)), ValueError, r"\(3, 3\); expected \(3, 4\) or \(4, 4\)"),
    (dict(affine=np.zeros((3, 4))), ValueError, "invertible"),
    (dict(mask=np.ones((2, 2, 2))), ValueError, r"mask has the shape \(2, 2, 2\); expected \(11, 11, 11\)"),
    (dict(time_axis=1), ValueError, "time_axis is 1; expected 0 or -1"),
    (dict(axis_names="zy"), ValueError, "axis_names has 2 entries; expected one for each of 3 axes"),
])
def test_what_is_wrong_is_said(arguments, error, text):
    arguments = {"array": ball(3), "level": 0.0, **arguments}
    with pytest.raises(error, match=text):
        tegl.contour(arguments.pop("array"), arguments.pop("level"), **arguments)


def test_5d_with_missing_values_is_a_manifold():
    array = ball(5, 5)
    whole = tegl.contour(array, 0.0)
    array[2, 2, 2, 2, 3] = np.nan
    contour = tegl.contour(array, 0.0)
    report = contour.check()
    assert report.is_manifold and not report.is_closed
    assert 0 < len(contour.simplices) < len(whole.simplices)
    assert tuple(tegl.count(array, 0.0)) == (len(contour.vertices), len(contour.simplices))


def test_a_contour_may_be_made_of_arrays():
    made = tegl.contour(ball(3), 0.0, normals=True, axis_names="zyx")
    contour = tegl.Contour(made.vertices, made.simplices, normals=made.normals, axis_names=made.axis_names,
                           isovalue=0.0, vertex_attributes={"number": np.arange(len(made.vertices))})
    assert_same(contour, made)
    assert np.array_equal(contour.normals, made.normals) and contour.axis_names == ("z", "y", "x")
    assert np.array_equal(contour.vertex_attributes["number"], np.arange(len(made.vertices)))
    assert contour.check() == made.check()
    with pytest.raises(ValueError, match="expected 0 to 2"):
        tegl.Contour(np.zeros((3, 2)), [[0, 3]])
    with pytest.raises(ValueError, match="attribute 'a' has 2 rows"):
        tegl.Contour(np.zeros((3, 2)), [[0, 1]], vertex_attributes={"a": [1, 2]})
    with pytest.raises(ValueError, match=r"simplices have the shape \(1, 3\); expected \(#S, 2\)"):
        tegl.Contour(np.zeros((3, 2)), [[0, 1, 2]])


def test_the_docstrings_are_those_of_the_headers():
    assert "separates samples >= isovalue (high) from the others" in tegl.contour.__doc__
    assert "Keeps the points on edges at least this share of an edge away" in tegl.contour.__doc__
    assert "Follows the parts (connected components) of the cuts" in tegl.track.__doc__
    for name in tegl.__all__:
        assert getattr(tegl, name).__doc__, name


def test_periodic_axes_give_a_wrapped_contour(tmp_path):

    turn = 2 * np.pi * np.arange(20) / 20
    z, y, x = np.meshgrid(turn, turn, turn, indexing="ij")
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    contour = tegl.contour(gyroid, 0.01, periodic="all", dtype=float)
    report = contour.check()
    assert report.is_closed and report.euler == -8
    np.testing.assert_array_equal(contour.periods, 20 * np.eye(3)[::-1])
    unrolled, originals = contour.unroll()
    assert len(unrolled.periods) == 0 and not unrolled.check().is_closed
    np.testing.assert_array_equal(originals[unrolled.simplices], contour.simplices)
    assert unrolled.measure().size == pytest.approx(contour.measure().size)
    contour.save(tmp_path / "gyroid.vtkhdf")
    for other in (tegl.load(tmp_path / "gyroid.vtkhdf"), pickle.loads(pickle.dumps(contour))):
        np.testing.assert_array_equal(other.periods, contour.periods)
        assert other.measure().size == pytest.approx(contour.measure().size)
    with pytest.raises(ValueError, match="cannot hold a wrapped contour"):
        contour.save(tmp_path / "gyroid.ply")
    for convert in (contour.to_vtk, contour.to_pyvista, contour.to_meshio):
        try:
            convert()
        except ImportError:  # pyvista need not be there
            assert convert == contour.to_pyvista
        except ValueError as error:
            assert "cannot hold a wrapped contour" in str(error) and "Contour.unroll" in str(error)
        else:
            pytest.fail("a wrapped contour was converted")
    with pytest.raises(ValueError, match="expected an unrolled one"):
        contour.simplify(0.5)


def test_count_has_the_size_of_the_contour():
    values = noise((7, 8, 9), 4)
    for options in ({}, {"periodic": "all"}, {"periodic": [0, 2], "close": True}, {"ambiguity": "saddle"},
                    {"triangulation": "barycentric", "periodic": {1: 8.5}}):
        contour = tegl.contour(values, 0.5, **options)
        size = tegl.count(values, 0.5, **options)
        assert size == (len(contour.vertices), len(contour.simplices)) and size.simplices > 100, options
    assert tegl.count(values, 7.0) == (0, 0)
    with pytest.raises(ValueError, match="periodic"):
        tegl.count(np.zeros((3, 3, 3, 3, 3)), 0.5, periodic=0)


@pytest.mark.parametrize("period", [0, 0.0, -6.0, float("nan"), float("inf")])
def test_periods_are_positive_and_finite(period):
    values = np.random.default_rng(1).random((6, 6)).astype(np.float32)
    for function in (tegl.contour, tegl.count):
        with pytest.raises(ValueError, match="expected a positive number"):
            function(values, 0.5, periodic={0: period})


def test_steps_of_half_a_period_and_more_are_errors():
    angle, y = 2 * np.pi * np.arange(36) / 36, np.arange(20.0)
    tube = np.broadcast_to(8 - np.hypot(y[:, None] - 9.5, y - 9.5)[..., None], (20, 20, 36))

    def contour(period, of=tegl.contour, **arguments):
        return of(tube, 0.0, coords=[y, y, angle], periodic={2: period}, **arguments)

    around = contour(2 * np.pi, dtype=float)
    assert around.measure().size == pytest.approx(2 * np.pi * around.slice(6.25, axis=2).measure().size)
    for of in (tegl.contour, tegl.count, tegl.contour_facets):
        with pytest.raises(ValueError, match="is 360, and the step across the seam, from 6.1.* to 360, is 353.*, such as 6.28319"):
            contour(360, of)
    with pytest.raises(ValueError, match="is 360, and the step across the seam"):
        contour(360, division="kuhn")


def test_longitudes_have_a_period_of_360():
    def contour(lon, periodic, of=tegl.contour, unit="degrees_east"):
        values = np.cos(np.radians(lon - 3)) + np.zeros((5, 1))
        return of(values, 0.5, coords=[np.arange(5.0), lon], axis_names=("lat", "lon"), axis_units=("", unit), periodic=periodic)

    for lon in (np.arange(0, 360, 10.0), np.r_[0:180:10.0, 180:360:5.0], np.arange(0, 350, 10.0), np.arange(-120, 180, 120.0)):
        for periodic in ("lon", "longitude", 1, ["lon"]):
            assert contour(lon, periodic).periods.tolist() == [[0, 360]]
        assert contour(lon, "lon", tegl.count) == contour(lon, {"lon": 360}, tegl.count)
        assert contour(lon, {"lon": 400.0}).periods.tolist() == [[0, 400]]
    assert contour(np.arange(0, 350, 10.0), "lon", unit="").periods.tolist() == [[0, 350]]
    for of in (tegl.contour, tegl.count):
        with pytest.raises(ValueError, match=r"the period of axis 1 \(lon\), of longitudes, is 360, and is not more than 361, the span"):
            contour(np.r_[0:360:10.0, 361], "lon", of)
        with pytest.raises(ValueError, match=r"axis 1 \(lon\).* span 30, and the gap behind them is 330; expected less than 180, or a"):
            contour(np.arange(120, 151, 10.0), "lon", of)
    assert contour(np.arange(0, 151, 10.0), {"lon": 160.0}).periods.tolist() == [[0, 160]]


def test_longitudes_of_an_axis_are_continued_across_their_jump():
    lon = np.arange(-180.0, 180.0, 10.0)
    values = np.cos(np.radians(lon - 3)) + np.linspace(-0.5, 0.5, 5)[:, None]

    def contour(lon, values, unit="degrees_east", **more):
        return tegl.contour(values, 0.5, coords=[np.arange(5.0), lon], axis_names=("lat", "lon"), axis_units=("", unit),
                            dtype=np.float64, **more)

    rolled, jumps = np.roll(values, -12, axis=1), np.roll(lon, -12)  # from -60 to 170, then from -180 to -70
    expected = contour(-60 + np.arange(0.0, 360.0, 10.0), rolled)
    for coordinates in (jumps, jumps.tolist(), jumps.astype(np.float32)):
        assert np.array_equal(contour(coordinates, rolled).vertices, expected.vertices)
    assert jumps[24] == -180  # remains
    around = contour(jumps, rolled, periodic="auto")
    assert around.periods.tolist() == [[0, 360]] and around.check().is_closed == contour(lon, values, periodic="lon").check().is_closed
    assert around.measure().size == pytest.approx(contour(lon, values, periodic="lon").measure().size, rel=1e-12)
    with pytest.raises(ValueError, match=r"coordinates 23 and 24 of axis 1 \('lon'\) are 170 and -180; expected them strictly ascending"):
        contour(jumps, rolled, unit="m")
    with pytest.raises(ValueError, match=r"coordinates 1 and 2 of axis 1 \('lon'\) are 350 and 0;"):
        contour([340, 350, 0, 10, 5], np.eye(5))


@pytest.mark.filterwarnings("ignore:the curved grid is folded")  # across latitudes
def test_longitudes_that_span_360_degrees_are_found():
    lon, lat = np.meshgrid(np.arange(0.0, 360.0, 10.0), np.arange(-40.0, 41.0, 10.0))
    spot = 30 - np.hypot(np.minimum(lon, 360 - lon), lat)
    names = {"coords": [lat[:, 0], lon[0]], "axis_names": ("lat", "lon")}
    units = {"axis_units": ("degrees_north", "degrees_east")}
    found = tegl.contour(spot, 0.0, periodic="auto", **names, **units)
    assert found.check().is_closed and found.check().components == 1
    assert np.array_equal(found.vertices, tegl.contour(spot, 0.0, periodic="lon", **names, **units).vertices)
    assert np.array_equal(found.vertices, tegl.contour(spot, 0.0, periodic="longitude", **names, **units).vertices)
    with pytest.raises(ValueError, match="no axis is named 'longitude'; expected one of"):
        tegl.contour(spot, 0.0, periodic="longitude", **names)
    assert tegl.count(spot, 0.0, periodic="auto", **names, **units) == (len(found.vertices), len(found.simplices))
    # on a curved grid, whose longitudes are named by either axis, the one along which they run around the globe
    curved = {"curved": {"lat": lat, "lon": lon + lat / 50}, **units}
    for order in (("lat", "lon"), ("lon", "lat")):
        turned = {"curved": curved["curved"], "axis_names": order, "axis_units": tuple(f"degrees_{'east' if n == 'lon' else 'north'}"
                                                                                      for n in order)}
        for name in ("lon", "auto", 1):
            around = tegl.contour(spot, 0.0, periodic=name, **turned)
            assert around.check().is_closed and around.check().components == 1
        for name in ("lat", 0):
            assert tegl.contour(spot, 0.0, periodic=name, **turned).check().components == 2
    plain = tegl.contour(spot, 0.0, periodic="auto", **names)
    assert plain.check().components == 2 and np.array_equal(plain.vertices, tegl.contour(spot, 0.0, **names).vertices)
    assert tegl.count(spot, 0.0, periodic="auto", **names) == (len(plain.vertices), len(plain.simplices))
    none = tegl.contour(spot, 0.0, periodic="none", **names, **units)
    assert np.array_equal(none.vertices, plain.vertices) and np.array_equal(none.simplices, plain.simplices)
    assert tegl.count(spot, 0.0, periodic="none", **names, **units) == (len(none.vertices), len(none.simplices))
    in_5d = np.random.default_rng(1).random((3, 3, 3, 3, 3))
    contour = tegl.contour(in_5d, 0.5, periodic="auto")
    assert np.array_equal(contour.vertices, tegl.contour(in_5d, 0.5).vertices)
    assert tegl.count(in_5d, 0.5, periodic="auto") == (len(contour.vertices), len(contour.simplices))
    around = {"axis_names": ("b", "a", "z", "y", "lon"), "axis_units": ("", "", "", "", "degrees_east"),
              "spacing": (1, 1, 1, 1, 120)}
    with pytest.raises(ValueError, match="5D .*division 'kuhn' or 'symmetric'"):
        tegl.contour(in_5d, 0.5, periodic="auto", **around)
    wrapped = tegl.contour(in_5d, 0.5, periodic="auto", division="kuhn", **around)
    named = tegl.contour(in_5d, 0.5, periodic="longitude", division="kuhn", **around)
    assert np.array_equal(wrapped.simplices, named.simplices) and len(wrapped.periods) == 1
    with pytest.raises(TypeError, match="'all', 'auto', 'none', or a dict"):
        tegl.contour(spot, 0.0, periodic=1.5)


def test_cuts_across_periods_by_place_or_normal():
    turn = 2 * np.pi * np.arange(24) / 24
    z, y, x = np.meshgrid(turn, turn, turn, indexing="ij")
    values = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x) + 0.2 * np.cos(x)

    def contour(shear, periodic="all"):
        affine = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [shear, 0, 1, 0]]) / 24
        return tegl.contour(values, 0.01, periodic=periodic, dtype=float, affine=affine)

    straight = contour(0.0)
    for axis, normal in enumerate(np.eye(3)):
        at = straight.slice(0.97, axis=axis)
        for factor, place in ((1, 0.97), (2, 0.97), (1, 3.97), (0.5, -0.03)):
            cut = straight.slice(normal=factor * normal, offset=factor * place)
            assert cut.check().is_closed and len(cut.vertices) == len(at.vertices)
            np.testing.assert_allclose(cut.vertices, at.vertices, atol=1e-9)
    # lattice planes
    for normal in ([1, 1, 0], [1, 1, 1], [1, -2, 0]):
        assert straight.slice(normal=normal, offset=7.3).check().is_closed
    # other planes are refused for this reason, wherever they are
    for offset in (0.5, 7.5):
        with pytest.raises(ValueError, match="along which it does not repeat itself within 32 periods; expected another"):
            straight.slice(normal=[1, 2 ** 0.5, 0], offset=offset)
    # rounding of the affine is none of the cell
    for shear in (1e-8, 0.3):
        oblique = contour(shear)
        for axis in range(3):
            for place in (0.2, 1.2, -4.8):
                assert oblique.slice(place, axis=axis).check().is_closed
    with pytest.raises(ValueError, match="between"):
        contour(0.0, periodic=0).slice(1.5, axis=2)
    for place in (0.2, 1.2, -0.8, 5.2):
        assert straight.measure(at=place).size[0] == pytest.approx(straight.measure(at=0.2).size[0])


def test_periodic_axes_by_name_number_and_period():
    image = np.add.outer(np.zeros(8), np.cos(2 * np.pi * np.arange(12) / 12))
    def edges(**arguments):
        return tegl.contour(image, 0.1, **arguments).check().boundary_simplices
    assert edges() == 4 and edges(periodic=0) == 0
    assert edges(periodic="x", axis_names=["y", "x"]) == 4 and edges(periodic={0: 8.0}) == 0
    for periodic, expected in (({0: 7.0}, "expected more than 7"), ([], "at least one axis"), ([0, -2], "each once"),
                               ("q", "no axis is named 'q'")):
        with pytest.raises(ValueError, match=expected):
            edges(periodic=periodic, axis_names=["y", "x"])
    with pytest.raises(TypeError, match="periodic is True"):
        edges(periodic=True)
    assert edges(periodic=0, close=True) == 0 and edges(close=True) == 0


@pytest.mark.parametrize("shape", [(6, 7), (5, 6, 7), (4, 5, 4, 5)])
def test_cells_have_their_exact_volume(shape):
    mask = np.random.default_rng(3).random(shape) < 0.4
    spacing = [0.5, 2.0, 1.5, 0.25][:len(shape)]
    contour = tegl.contour(mask, 1, samples="cells", spacing=spacing, dtype=np.float64)
    assert contour.check().is_closed
    assert contour.measure().content == pytest.approx(mask.sum() * np.prod(spacing))
    smooth = tegl.contour(mask, 1, samples="cells", positions="relaxed")
    assert smooth.check().is_closed and len(smooth.simplices) < len(contour.simplices)
    with pytest.raises(ValueError, match="expected one of 'points', 'cells', 'file'"):
        tegl.contour(mask, 1, samples="boxes")
    with pytest.raises(ValueError, match="periodic with samples"):
        tegl.contour(mask, 1, samples="cells", periodic="all")


def test_positions_of_masks():
    z, y, x = np.ogrid[-1:1:24j, -1:1:26j, -1:1:25j]
    mask = x**2 + y**2 + z**2 < 0.5
    # differences that float32 rounds
    ball = 10 - np.linalg.norm(np.indices((24, 24, 24)) - 11.4, axis=0)
    for image, level in ((1e6 + 1e-3 * ball, 1e6), ((1e8 + 4 * ball).astype(np.int32), 1e8)):
        for given in (image, np.ma.masked_array(image, False)):
            filtered = tegl.contour(image, level, positions="filtered", positions_image=given, dtype=np.float64)
            assert np.array_equal(filtered.vertices, tegl.contour(image, level, dtype=np.float64).vertices)
    linear = tegl.contour(mask, 0.5)
    relaxed = tegl.contour(mask, 0.5, positions="relaxed")
    assert np.array_equal(relaxed.simplices, linear.simplices)
    assert relaxed.check().is_closed and not np.array_equal(relaxed.vertices, linear.vertices)
    values = np.random.default_rng(1).random(mask.shape)
    for time_axis in (0, -1):
        given = tegl.contour(mask, 0.5, positions="filtered", positions_image=values, dtype=np.float64, time_axis=time_axis)
        # at each vertex, both ends of its edge, clamped to their sides
        high = np.where(mask, np.maximum(values, 0.5), np.minimum(values, 0.5))
        for vertex in given.vertices[::7]:
            start, end = np.floor(vertex).astype(int), np.ceil(vertex).astype(int)
            a, b = float(high[tuple(start)]), float(high[tuple(end)])
            if a != b:
                assert abs((vertex - start).sum() - (0.5 - a) / (b - a)) < 1e-6
    with pytest.raises(ValueError, match="expected one of 'linear', 'filtered', 'gravitation', 'relaxed'"):
        tegl.contour(mask, 0.5, positions="smooth")
    with pytest.raises(TypeError, match="positions is 3; expected text or a function"):
        tegl.contour(mask, 0.5, positions=3)
    with pytest.raises(ValueError, match="without positions_image"):
        tegl.contour(mask, 0.5, positions="filtered")
    with pytest.raises(ValueError, match=r"has the shape \(2, 2\); expected \(24, 26, 25\)"):
        tegl.contour(mask, 0.5, positions="filtered", positions_image=np.zeros((2, 2)))
    with pytest.raises(ValueError, match="expected positions='filtered'"):
        tegl.contour(mask, 0.5, positions="relaxed", positions_image=values)
    with pytest.raises(ValueError, match="periodic with positions"):
        tegl.contour(mask, 0.5, positions="relaxed", periodic="all")
    with pytest.raises(ValueError, match="expected positions='relaxed'"):
        tegl.contour(mask, 0.5, time_weight=0)


@pytest.mark.parametrize("shape", [(9, 8), (40, 41, 39), (6, 5, 6, 4)])
def test_positions_by_a_function(shape):
    volume = np.random.default_rng(2).random(shape)
    kept = []

    def linear(first, second, level):
        kept.append((first, second))
        assert level == 0.5 and first.shape == second.shape and np.all((first >= level) != (second >= level))
        return (level - first) / (second - first)

    expected = tegl.contour(volume, 0.5, dtype=np.float64)
    placed = tegl.contour(volume, 0.5, dtype=np.float64, positions=linear, threads=2)
    np.testing.assert_array_equal(placed.simplices, expected.simplices)
    np.testing.assert_allclose(placed.vertices, expected.vertices, atol=1e-12)
    # the arrays are the caller's, in few calls
    assert sum(len(first) for first, _ in kept) > len(kept) * 20 and np.isin(kept[0][0], volume).all()
    # one number, at both ends of a step along the array's last axis
    step = np.broadcast_to(np.arange(shape[-1]) >= 2, shape)
    for position, place in ((0.25, 1.25), (1.5, 2), (-3, 1), (np.float32(0.5), 1.5), (True, 2)):
        contour = tegl.contour(step, 0.5, positions=lambda first, second, level, position=position: position)
        assert set(contour.vertices[:, -1]) == {place}


def test_errors_of_functions_for_positions_propagate():
    volume = np.random.default_rng(2).random((6, 7, 8))

    class Mine(Exception):
        pass

    def fails(first, second, level):
        raise Mine("in the function")

    with pytest.raises(Mine, match="in the function"):
        tegl.contour(volume, 0.5, positions=fails)
    with pytest.raises(Mine):
        tegl.contour(volume, 0.5, positions=fails, progress=lambda fraction: True)
    for error, wrong, text in ((ValueError, lambda a, b, level: a[1:], r"the shape \(\d+,\); expected \(\d+,\)"),
                               (ValueError, lambda a, b, level: np.nan, "returned NaN for samples"),
                               (ValueError, lambda a, b, level: np.ma.masked_greater(a, 0.9), "returned NaN"),
                               (TypeError, lambda a, b, level: None, "returned None; expected numbers from 0 to 1"),
                               (TypeError, lambda a, b, level: a * 1j, "expected numbers from 0 to 1"),
                               (TypeError, lambda a, b: a, "positional argument")):
        with pytest.raises(error, match=text):
            tegl.contour(volume, 0.5, positions=wrong)
    with pytest.raises(ValueError, match="or a function"):
        tegl.contour(volume, 0.5, positions="custom")
    with pytest.raises(ValueError, match="an image of cells"):
        tegl.contour(volume, 0.5, positions=lambda a, b, level: 0.5, samples="cells")
    with pytest.raises(ValueError, match="periodic with positions"):
        tegl.contour(volume, 0.5, positions=lambda a, b, level: 0.5, periodic="all")
    with pytest.raises(tegl.Cancelled):
        tegl.contour(volume, 0.5, positions=lambda a, b, level: time.sleep(0.03) or 0.5, progress=lambda fraction: False)
    # nothing keeps the function or its arrays
    calls = [0]
    function = functools.partial(lambda calls, a, b, level: calls.append(weakref.ref(a)) or 0.5, calls)
    of_function = weakref.ref(function)
    tegl.contour(volume, 0.5, positions=function)
    del function
    gc.collect()
    assert of_function() is None and len(calls) > 1 and all(array() is None for array in calls[1:])


# Curved grids.
