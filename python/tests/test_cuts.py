# SPDX-License-Identifier: BSD-3-Clause
"""Cuts of contours by hyperplanes."""

import numpy as np
import pytest
import tegl
from conftest import assert_closed_manifold, assert_same, assert_same_places, ball, noise, signed_content


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("ndim", [3, 4])
def test_a_cut_at_a_sample_is_the_contour_of_that_layer(ndim, time_axis):
    array = noise((6, 7, 8, 5)[:ndim], ndim)
    contour = tegl.contour(array, 0.1, time_axis=time_axis)
    for at in (0, 2, array.shape[time_axis] - 1):
        layer = tegl.contour(np.take(array, at, axis=time_axis), 0.1, time_axis=time_axis)
        assert_same_places(contour.slice(at), layer)


def test_cuts_between_samples_are_closed_and_oriented(balls):
    for at in (0.3, 3.1415, 6.9):
        cut = balls.slice(at)
        assert_closed_manifold(cut.simplices)
        assert signed_content(cut.vertices, cut.simplices) == pytest.approx(cut.measure().content)
        assert cut.measure().content > 0
        assert cut.axis_names == ("z", "y", "x") and cut.axis_units == ("mm",) * 3 and cut.isovalue == 0.0


def test_axes_are_cut_by_name_or_number(balls):
    by_name = balls.slice(x=9.5)
    assert_same(by_name, balls.slice(9.5, axis="x"))
    assert_same(by_name, balls.slice(9.5, axis=3))
    assert_same(by_name, balls.slice(9.5, axis=-1))
    assert_same(by_name, tegl.slice(balls, at=9.5, axis=-1))
    assert_same(by_name, balls.slice(normal=(0, 0, 0, 1), offset=9.5))
    assert by_name.axis_names == ("t", "z", "y")
    several = balls.slice([3.0, 1.5])
    assert_same(several[0], balls.slice(3.0))
    assert_same(several[1], balls.slice(t=1.5))


def test_oblique_cuts_lie_in_their_plane():
    contour = tegl.contour(ball(3, 21), 0.0, dtype=np.float64)
    cut = contour.slice(normal=(1, 1, 0), offset=20)
    assert_closed_manifold(cut.simplices)
    assert cut.measure().size == pytest.approx(2 * np.pi * 7, rel=0.01)
    assert cut.measure().content == pytest.approx(signed_content(cut.vertices, cut.simplices))


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("normal", [(1, 1, 1), (1, 2, 0), (-1, 0.5, 3), (0, 1, -1), (0, -2, 0), (1, 1, 1, 1), (0, 0, 1, 2),
                                    (3, -1, 1, 0.5), (1, 1, 0, 0, 0), (1, 1, 1, 2, 1)])
def test_frames_place_cuts_on_the_contour(normal, time_axis):
    ndim = len(normal)
    spacing, centre, radius = np.linspace(1, 1.5, ndim), np.arange(1.0, ndim + 1) + 0.25, 3.5
    shape = (9,) * ndim
    steps = np.stack(np.meshgrid(*(np.arange(9) - 4.0 for _ in shape), indexing="ij"), axis=-1) * spacing
    # linear in each tile, so that the contour is known: a box, which has no symmetry that hides wrong axes
    field = np.max(np.abs(steps) / np.arange(2, ndim + 2), axis=-1) - 1.0
    contour = tegl.contour(-field, 0.0, spacing=spacing, origin=centre - 4 * spacing, time_axis=time_axis, dtype=float)
    offset = float(np.dot(normal, centre)) + 0.3
    frame, cut = contour.frame_of(normal=normal, offset=offset), contour.slice(normal=normal, offset=offset)
    assert frame.origin.shape == (ndim,) and frame.axes.shape == (ndim - 1, ndim)
    np.testing.assert_allclose(frame.axes @ frame.axes.T, np.eye(ndim - 1), atol=1e-12)
    np.testing.assert_allclose(frame.axes @ normal, 0, atol=1e-12)
    # each vertex of the cut is on an edge of the contour
    points = frame.to_space(cut.vertices)
    np.testing.assert_allclose(points @ normal, offset, atol=1e-9)
    np.testing.assert_allclose(frame.to_plane(points), cut.vertices, atol=1e-9)
    corners = contour.vertices[np.unique(np.sort(contour.simplices[:, pairs_of(ndim)], axis=-1).reshape(-1, 2), axis=0)]
    heights = corners @ np.array(normal, float) - offset
    crossed = (heights[:, 0] < 0) != (heights[:, 1] < 0)
    share = heights[crossed, 0] / (heights[crossed, 0] - heights[crossed, 1])
    ends = corners[crossed]
    expected = ends[:, 0] + share[:, None] * (ends[:, 1] - ends[:, 0])
    assert len(points) > 10
    for point in points[:: max(1, len(points) // 50)]:
        assert np.abs(expected - point).max(axis=1).min() < 1e-9
    # and a cut across an axis keeps the others
    across = contour.frame_of(normal=np.eye(ndim)[1], offset=2.0)
    assert np.array_equal(across.axes, np.delete(np.eye(ndim), 1, axis=0)) and across.origin[1] == 2.0
    assert np.array_equal(tegl.frame_of(contour, normal=normal, offset=offset).axes, frame.axes)


def pairs_of(ndim):
    """Places of the ends of all edges of a simplex."""
    return [(i, j) for i in range(ndim) for j in range(i)]


def test_frames_place_cuts_of_crystals_and_name_wrong_numbers():
    turn = 2 * np.pi * np.arange(16) / 16
    x, y, z = np.meshgrid(turn, turn, turn, indexing="ij")
    values = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    cell = tegl.contour(values, 0.01, periodic="all", spacing=1 / 16, dtype=float)
    for place in (dict(normal=(1, 1, 1), offset=0.4), dict(normal=(1, 1, 1), offset=7.4), dict(normal=(2, -1, 0), offset=0.3)):
        cut = cell.slice(**place)
        x, y, z = 2 * np.pi * cell.frame_of(**place).to_space(cut.vertices).T
        found = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        assert np.abs(found - 0.01).max() < 0.05
    frame = cell.frame_of(normal=(1, 1, 1), offset=0.4)
    with pytest.raises(ValueError, match=r"points of a slice have the shape \(4, 3\); expected 2 coordinates each"):
        frame.to_space(np.zeros((4, 3)))
    with pytest.raises(ValueError, match=r"points have the shape \(2,\); expected 3 coordinates each"):
        frame.to_plane((1.0, 2.0))
    with pytest.raises(ValueError, match="the normal has 2 numbers; expected one for each of 3 axes"):
        cell.frame_of(normal=(1, 1), offset=0.4)
    with pytest.raises(ValueError, match="normal"):
        cell.frame_of(normal=(0, 0, 0), offset=0.4)
    with pytest.raises(TypeError, match="is not a contour"):
        tegl.frame_of(values, normal=(1, 1, 1), offset=0.4)


def test_cuts_straight_from_an_array_are_those_of_the_contour(moving_balls):
    whole = tegl.contour(moving_balls, 0.0, dtype=np.float64)
    for arguments in (dict(at=2.25), dict(at=9.5, axis=3), dict(at=4.0)):
        direct, cut = tegl.slice(moving_balls, 0.0, dtype=np.float64, **arguments), whole.slice(**arguments)
        assert len(direct.simplices) == len(cut.simplices) > 0
        assert direct.measure().content == pytest.approx(cut.measure().content, rel=1e-12)
        assert np.array_equal(np.unique(direct.vertices, axis=0), np.unique(cut.vertices, axis=0))
    several = tegl.slice(moving_balls, 0.0, at=[1.5, 2.5], spacing=(0.5, 1, 1, 1), close=True)
    assert [len(cut.simplices) > 0 for cut in several] == [True, True]
    oblique = tegl.slice(moving_balls, 0.0, normal=(0, 0, 1, 1), offset=24.2, dtype=np.float64)
    assert_same(oblique, whole.slice(normal=(0, 0, 1, 1), offset=24.2))


@pytest.mark.parametrize("arguments, text", [
    (dict(), "no hyperplane"),
    (dict(at=1, t=1), "several hyperplanes"),
    (dict(x=1, y=1), "several hyperplanes"),
    (dict(q=1), "no hyperplane"),
    (dict(at=1, q=1), "no axis is named 'q'"),
    (dict(at=1, axis="q"), "no axis is named 'q'"),
    (dict(at=1, axis=4), "axis is 4; expected -4 to 3"),
    (dict(normal=(1, 0, 0, 0)), "normal without offset"),
    (dict(offset=1), "offset without normal"),
    (dict(normal=(1, 0, 0), offset=1), "the normal has 3 numbers; expected one for each of 4 axes"),
    (dict(normal=(0, 0, 0, 0), offset=1), r"normal of a hyperplane that is 0 or not finite: \(0, 0, 0, 0\); expected"),
    (dict(at=np.nan), "nan"),
    (dict(at=np.datetime64("2020-01-01")), "is a date, and the axis has the unit 'h'"),
])
def test_what_is_no_cut_is_said(balls, arguments, text):
    with pytest.raises(ValueError, match=text):
        balls.slice(**arguments)


def test_dimensions_that_there_are_not_are_said():
    flat, five = tegl.contour(ball(2), 0.0), tegl.contour(ball(5, 5), 0.0)
    for contour, call in ((flat, lambda c: c.slice(1)), (five, lambda c: c.simplify(ratio=0.5)),
                          (five, lambda c: c.to_vtk()), (flat, lambda c: tegl.measure(c, at=1))):
        with pytest.raises(ValueError, match=f"{contour.ndim}D contour; expected"):
            call(contour)
    with pytest.raises(ValueError, match="expected 2 to 4"):
        tegl.Index(ball(5, 4))
    with pytest.raises(ValueError, match="3 to 5"):
        tegl.slice(ball(2), 0.0, at=1)


def test_five_dimensions_are_cut_to_four_three_and_two(tmp_path):
    array = ball(5, 7)
    contour = tegl.contour(array, 0.0)
    four = contour.slice(3.2)
    assert four.ndim == 4 and four.check().is_closed and four.check().is_manifold
    three = four.slice(2.9)
    assert three.ndim == 3 and three.check().euler == 2
    direct = tegl.slice(array, 0.0, at=3.2)
    assert np.array_equal(np.sort(direct.vertices, axis=0), np.sort(four.vertices, axis=0))
    assert len(direct.simplices) == len(four.simplices)
    tilted = contour.slice(normal=(1, 1, 0, 0, 0), offset=6.3)
    assert tilted.ndim == 4 and tilted.check().is_closed and len(four.track().tracks) == 1
    contour.save(tmp_path / "five.vtkhdf")
    saved = tegl.load(tmp_path / "five.vtkhdf")
    assert saved.ndim == 5 and np.array_equal(saved.simplices, contour.simplices)
    assert np.array_equal(saved.vertices, contour.vertices) and len(saved.slice(3.2).simplices) == len(four.simplices)
    np.save(tmp_path / "five.npy", array)
    image = tegl.read(tmp_path / "five.npy")
    assert image.array.shape == array.shape and len(image.contour(0.0).simplices) == len(contour.simplices)
    with pytest.raises(ValueError, match="expected a place between"):
        contour.slice(9)


def test_cuts_across_longitudes_take_places_a_turn_away():
    lon = np.array([160.0, 165, 170, 175, 180, -175, -170, -165, -160])  # continued to 200
    array = np.cos(np.radians(np.linspace(0, 80, 9))) + np.linspace(-0.4, 0.4, 6)[:, None] + np.linspace(-0.3, 0.3, 5)[:, None, None]
    grid = {"coords": [np.arange(5.0), np.arange(6.0), lon], "axis_names": ("z", "lat", "lon"), "axis_units": ("", "", "degrees_east")}
    contour = tegl.contour(array, 0.6, dtype=np.float64, **grid)
    expected = contour.slice(lon=195)
    assert len(expected.simplices) > 0
    for place in (-165, 555, 195):
        assert_same(contour.slice(lon=place), expected)
        assert_same(tegl.slice(array, 0.6, at=place, axis="lon", dtype=np.float64, **grid), tegl.slice(array, 0.6, at=195, axis="lon", dtype=np.float64, **grid))
    assert_same(contour.slice(lon=[-165, 170])[0], expected)
    assert len(contour.slice(lon=0, allow_empty=True).simplices) == 0
    for cut in (lambda: contour.slice(lon=0), lambda: tegl.slice(array, 0.6, at=0, axis="lon", **grid)):
        with pytest.raises(ValueError, match=r"\('lon'\) is 0.0; expected a place between 160.0 and 200.0"):
            cut()
    with pytest.raises(ValueError, match="is -165.0; expected a place between"):  # not of longitudes
        tegl.slice(array, 0.6, at=-165, axis="x", coords=[np.arange(5.0), np.arange(6.0), np.arange(160.0, 201, 5)], axis_names=("z", "y", "x"))
