# SPDX-License-Identifier: BSD-3-Clause
"""Curved grids: coordinates in arrays, as points and in a CurvedGrid."""

import re
import warnings

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
            found, _ = _curved.coordinates_of(array, prepared)
            assert all(np.shares_memory(one[2], array) for one in found), (time_axis, dtype)
            pitch = array.strides[2 if time_axis == 0 else 0] // array.itemsize
            assert [one[3] for one in found] == [pitch] * 3
        assert not any(np.shares_memory(one[2], ordered) for one in _curved.coordinates_of(ordered[::-1], prepared)[0])
    assert {one[2].dtype for one in _curved.coordinates_of(points.astype(int), _arguments.prepare(values))[0]} == {np.dtype("f8")}


def test_curved_grids_are_read_in_place_in_both_orders_of_samples():
    from tegl import _arguments, _curved
    values, points = curved_image(3, np.float32)
    x, y, z = np.moveaxis(points, -1, 0)
    for given in (points, {1: y, 0: x, 2: z}, {-1: z, 0: x, np.int64(1): y}):
        grid = tegl.CurvedGrid(given)
        assert list(grid.coordinates) == (list(range(3)) if given is points else list(given))
        for time_axis in (0, -1):
            prepared = _arguments.prepare(values, time_axis=time_axis)
            first, second = (_curved.coordinates_of(grid, prepared)[0] for _ in range(2))
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


@pytest.mark.filterwarnings("ignore:the curved grid is folded")  # across the seam
@pytest.mark.parametrize("fill", [9.96921e36, -1e20, 5.0])
def test_samples_with_masked_coordinates_are_missing(fill):
    values, points = curved_image(3, np.float32)
    mask = np.zeros(values.shape, dtype=bool)
    mask[3:5, 2:4, :3] = True
    of_points = np.zeros(points.shape, dtype=bool)
    of_points[mask, 1] = True
    stored = np.where(of_points, np.float32(fill), points)
    masked = np.ma.masked_array(stored, of_points)
    arrays = {axis: masked[..., axis] for axis in range(3)}
    expected_points = np.where(of_points, np.float32(np.nan), points)
    for time_axis in (0, -1):
        for numbers in (values, (values * 200).astype(np.uint8)):
            level = 0.5 if numbers is values else 100.5
            given = {"time_axis": time_axis, "dtype": np.float64}
            expected = tegl.contour(np.where(mask, np.nan, numbers), level, curved=expected_points, **given)
            whole = tegl.contour(numbers, level, curved=points, **given)
            assert 50 < len(expected.simplices) < len(whole.simplices)
            for curved in (masked, arrays, tegl.CurvedGrid(masked), tegl.CurvedGrid(arrays)):
                assert same_contours(tegl.contour(numbers, level, curved=curved, **given), expected)
            # beside masked values, and with other options
            own = np.ma.masked_array(numbers, np.roll(mask, 3, axis=0))
            assert same_contours(tegl.contour(own, level, curved=masked, **given),
                                 tegl.contour(np.where(mask | own.mask, np.nan, numbers), level, curved=expected_points, **given))
            assert same_contours(tegl.contour(numbers, level, curved=arrays, periodic=2, **given),
                                 tegl.contour(np.where(mask, np.nan, numbers), level, curved=expected_points, periodic=2, **given))
    # a mask of fewer dimensions hides samples along the others
    flat = np.ma.masked_array(points[:1, :, :, 1], mask[3:4])
    assert same_contours(tegl.contour(values, 0.5, curved={1: flat}),
                         tegl.contour(np.where(mask[3:4], np.nan, values), 0.5, curved={1: flat.filled(np.nan)}))
    assert np.isnan(tegl.CurvedGrid(masked).coordinates[1][mask]).all()


@pytest.mark.parametrize("fill, axis, unit, expected", [
    (9.96921e36, 0, "", "at most 1e19"), (-1e20, 1, "m", "at most 1e19"), (np.inf, 2, "m", "at most 1e19"),
    (1e20, 2, "degrees_east", "-720 to 720"), (-9999, 1, "degrees_north", "-90 to 90")])
def test_numbers_that_cannot_be_places_are_errors_where_they_are_needed(fill, axis, unit, expected):
    values, points = curved_image(3, np.float32)
    units = tuple(unit if one == axis else "" for one in range(3))
    hidden = values.copy()
    hidden[3, 2:4, 1] = np.nan
    points[3, 2:4, 1, axis] = np.nan
    right = tegl.contour(hidden, 0.5, curved=points, axis_units=units)
    points[3, 2:4, 1, axis] = fill
    for time_axis in (0, -1):
        for curved in (points, {one: points[..., one] for one in range(3)}, tegl.CurvedGrid(points)):
            for _ in range(2):
                with pytest.raises(ValueError) as raised:
                    tegl.contour(values, 0.5, curved=curved, axis_units=units, time_axis=time_axis)
                text = str(raised.value)
                assert "which has unknown coordinates; expected missing values there. curved" in text
                cell = [int(i) for i in re.search(r"the sample \(([^)]*)\)", text)[1].split(", ")]
                first = [3, max(2, cell[1]), 1]  # of the two in this cell
                assert all(0 <= i - base <= 1 for i, base in zip(first, cell))
                shift = ", or shift longitudes by multiples of 360" if unit == "degrees_east" else ""
                assert text.endswith(f"curved[{axis}]{first} is {np.float32(fill):g}, which cannot be a place (expected {expected}); "
                                     f"the mask of a masked array, as of numpy.ma.masked_equal, hides such samples{shift}")
            contour = tegl.contour(hidden, 0.5, curved=curved, axis_units=units, time_axis=time_axis)
            assert len(contour.simplices) == len(right.simplices) > 50
            assert time_axis == -1 or same_contours(contour, right)


@pytest.mark.parametrize("time_axis", [0, -1])
def test_errors_name_only_numbers_of_their_cell_that_cannot_be_places(time_axis):
    values, points = curved_image(3, np.float64)
    values[0, 0, 0] = np.nan
    points[0, 0, 0, 0] = 1e20  # not needed
    points[3, 2:4, 1, 1] = np.nan
    for curved in (points, {axis: points[..., axis] for axis in range(3)}, tegl.CurvedGrid(points)):
        with pytest.raises(ValueError, match="has unknown coordinates; expected missing values there$"):
            tegl.contour(values, 0.5, curved=curved, time_axis=time_axis)


def test_the_error_about_longitudes_over_several_turns_names_both_remedies():
    lon, lat = np.meshgrid(np.linspace(0, 1500, 301), np.linspace(-10, 10, 5))
    values = lat + 3 * np.sin(np.radians(7 * lon))
    units = {"axis_units": ("degrees_north", "degrees_east")}
    with pytest.raises(ValueError, match=r"curved\[1\]\[\d, \d+\] is 725, which cannot be a place \(expected -720 to 720\); the mask .* "
                                         "hides such samples, or shift longitudes by multiples of 360$"):
        tegl.contour(values[:, 140:], 0.5, curved={0: lat[:, 140:], 1: lon[:, 140:]}, **units)
    tegl.contour(values[:, 140:], 0.5, curved={0: lat[:, 140:], 1: lon[:, 140:] - 1080}, **units)


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


@pytest.mark.parametrize("time_axis", [0, -1])
def test_structured_grids_of_collections_move_over_time(tmp_path, time_axis):
    angle, radius = np.meshgrid(2 * np.pi * np.arange(24) / 24, np.linspace(1, 2, 6))
    sets = ""
    for time, moved in ((0, 0.0), (1, 0.5), (3, 2.5)):
        points = np.stack([moved + radius * np.cos(angle), radius * np.sin(angle), 0 * radius], axis=-1)
        text = ["\n".join(map(repr, map(float, numbers.ravel()))) for numbers in (radius, points)]
        (tmp_path / f"{time}.vts").write_text(
            '<VTKFile type="StructuredGrid"><StructuredGrid WholeExtent="0 23 0 5 0 0"><Piece Extent="0 23 0 5 0 0"><PointData>'
            f'<DataArray type="Float64" Name="radius" format="ascii">{text[0]}</DataArray></PointData><Points>'
            f'<DataArray type="Float64" Name="p" NumberOfComponents="3" format="ascii">{text[1]}</DataArray></Points></Piece>'
            '</StructuredGrid></VTKFile>')
        sets += f'<DataSet timestep="{time}" file="{time}.vts"/>'
    (tmp_path / "moving.pvd").write_text(f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>')
    image = tegl.read(tmp_path / "moving.pvd")
    assert image.curved[2].shape == (3, 6, 24) and image.curved[1].shape == (1, 6, 24)  # y does not change
    assert "x -2 to 4.5 (curved)" in str(image)
    tube = tegl.contour(image, 1.55, periodic="x", dtype=float)
    assert tube.check().components == 1 and tube.check().euler == 0
    for time, moved in ((0.5, 0.25), (2.0, 1.5)):
        y, x = tube.slice(time).vertices.T
        found = np.hypot(x - moved, y)  # of samples' rows, and of chords between them
        assert found.max() == pytest.approx(1.55) and found.min() == pytest.approx(1.55 * np.cos(np.pi / 24))
    # the same arrays, given by the caller
    turned = (lambda array: array) if time_axis == 0 else (lambda array: np.moveaxis(array, 0, -1))
    curved = {axis if time_axis == 0 else axis - 1: turned(array) for axis, array in image.curved.items()}
    coords = [[0, 1, 3], None, None] if time_axis == 0 else [None, None, [0, 1, 3]]
    own = tegl.contour(turned(image.array), 1.55, curved=curved, coords=coords, periodic=2 if time_axis == 0 else 1,
                       time_axis=time_axis, dtype=float)
    assert own.check().euler == 0 and own.measure().size == pytest.approx(tube.measure().size)


#: Of a globe in steps of 6 degrees.
GLOBE = {"axis_names": ["lat", "lon"], "axis_units": ["degrees_north", "degrees_east"]}


def globe(columns):
    """Values, latitudes and longitudes of a globe of 60 columns, of which the further ones repeat the first ones."""
    j, i = np.meshgrid(np.arange(30), np.arange(columns), indexing="ij")
    lon, lat = 6.0 * i, -70 + 4.8 * j
    values = 20 * np.cos(np.radians(lat)) ** 2 + 3 * np.cos(np.radians(6.0 * (i % 60) - 170))
    values[3:5, ::60] = np.nan
    return values, lat, lon


def placed(lat, lon, is_curved):
    return {"curved": {0: lat, 1: lon}} if is_curved else {"coords": [lat[:, 0], lon[0]]}


@pytest.mark.parametrize("is_curved", [False, True])
@pytest.mark.parametrize("repeated", [1, 2])
def test_longitudes_that_repeat_the_first_ones_are_left_out(is_curved, repeated):
    values, lat, lon = globe(60 + repeated)
    expected = tegl.contour(values[:, :60], 12.3, periodic="lon", **placed(lat[:, :60], lon[:, :60], is_curved), **GLOBE)
    for periodic in ("lon", "longitude", "auto", {"lon": 360}, 1):
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # no folds
            found = tegl.contour(values, 12.3, periodic=periodic, **placed(lat, lon, is_curved), **GLOBE)
        assert np.array_equal(found.vertices, expected.vertices) and np.array_equal(found.periods, expected.periods)
        assert np.array_equal(found.simplices, expected.simplices)
    values[7, 61 if repeated == 2 else 60] += 0.5
    last = "sample along axis 1 (lon) is" if repeated == 1 else "2 samples along axis 1 (lon) are"
    with pytest.raises(ValueError, match=re.escape(f"the last {last} at the longitudes of the first") + ".* at the sample "
                                         + re.escape(f"(7, {59 + repeated}), ")):
        tegl.contour(values, 12.3, periodic="lon", **placed(lat, lon, is_curved), **GLOBE)
    assert not len(tegl.contour(values, 12.3, periodic="auto", **placed(lat, lon, is_curved), **GLOBE).periods)


def test_repeated_longitudes_are_left_out_in_all_tilings_and_counted():
    values, lat, lon = globe(62)
    grids = {"coords": [lat[:, 0], lon[0]], **GLOBE}, {"coords": [lat[:, 0], lon[0, :60]], **GLOBE}
    for more in ({"lattice": "triangular"}, {"division": "kuhn"}):
        long, short = (tegl.contour(v, 12.3, periodic="lon", **more, **grid)
                       for v, grid in zip((values, values[:, :60]), grids))
        assert np.array_equal(long.vertices, short.vertices) and len(long.periods) == 1
    counts = [tegl.count(v, 12.3, periodic="lon", **grid) for v, grid in zip((values, values[:, :60]), grids)]
    assert counts[0] == counts[1]
    facets = [tegl.contour_facets(v, 12.3, periodic="lon", **grid) for v, grid in zip((values, values[:, :60]), grids)]
    assert np.array_equal(facets[0].vertices, facets[1].vertices)


@pytest.mark.parametrize("is_curved", [False, True])
def test_longitudes_of_a_region_are_not_periodic(is_curved):
    values, lat, lon = (one[:, :20] for one in globe(60))
    with pytest.raises(ValueError, match="longitudes.*span 114"):
        tegl.contour(values, 12.3, periodic="lon", **placed(lat, lon, is_curved), **GLOBE)


def test_longitudes_of_an_affine_map_are_those_of_the_world():
    values, lat, lon = globe(60)
    expected = tegl.contour(values, 12.3, periodic="lon", coords=[lat[:, 0], lon[0]], dtype=np.float64, **GLOBE)
    affine = np.array([[4.8, 0, -70], [0, 6, 0]])
    for periodic in ("lon", "auto"):
        found = tegl.contour(values, 12.3, periodic=periodic, affine=affine, dtype=np.float64, **GLOBE)
        assert np.allclose(found.periods, [[0, 360]]) and np.allclose(found.vertices, expected.vertices)
    values, lat, lon = globe(61)
    found = tegl.contour(values, 12.3, periodic="lon", affine=affine, dtype=np.float64, **GLOBE)
    assert np.allclose(found.periods, [[0, 360]]) and np.allclose(found.vertices, expected.vertices)
    # half of the globe, whose 360 columns have the indices of the whole one
    half = np.tile(values, 6)[:, :360]
    affine[1, 1] = 0.5
    assert not len(tegl.contour(half, 12.3, periodic="auto", affine=affine, **GLOBE).periods)
    with pytest.raises(ValueError, match="the world's coordinates of axis 0 .lat. also differ along it"):
        tegl.contour(half, 12.3, periodic="lon", affine=[[4.8, 0.1, -70], [0, 1, 0]], **GLOBE)


def test_measures_take_longitudes_a_turn_away_as_slices_do():
    z, y, lon = np.ogrid[0:5, 0:6, 0:36]
    values = np.cos(lon * np.pi / 18) - 0.1 * z + 0.05 * y
    found = tegl.contour(values, 0.3, axis_names=["z", "lat", "lon"], axis_units=["m", "degrees_north", "degrees_east"],
                         coords=[np.arange(5), np.arange(6), np.arange(36) * 10.0], time_axis=-1)
    expected = found.measure(at=75)
    for place in (435, -285):
        cut = found.measure(at=place)
        assert cut.size == expected.size and cut.at == place
    assert found.measure(at=[75, 435]).size[1] == expected.size
    assert len(found.track(times=[75, 80]).segments) == len(found.track(times=[435, 440]).segments)
    with pytest.raises(ValueError, match="expected a place between 0.0 and 350.0"):
        found.measure(at=355)
