# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong is said by name, with what was expected, and with axes as the array has them: never in the words of the
binding, nor in the library's order of axes."""

import copy
import pickle

import numpy as np
import pytest
import tegl
from conftest import ball, noise

VOLUME = noise((7, 8, 9), 0)
CONTOUR = tegl.contour(VOLUME, 0.1)
MOVING = tegl.contour(noise((5, 6, 7, 8), 0), 0.1)
INDEX = tegl.Index(VOLUME)
CORNERS, FACE = np.eye(3), [[0, 1, 2]]
OUTSIDE = ("the place along %s is 30.0; expected a place between 0.0 and %s, the ends of the image, or allow_empty=True for an "
           "empty slice")
THREADS = "threads is -1; expected 0 (all) or more"


def contour(**arguments):
    return tegl.contour(VOLUME, arguments.pop("level", 0.1), **arguments)


@pytest.mark.parametrize("call, error, text", [
    # Axes by the array's numbers.
    (lambda: tegl.slice(VOLUME, 0.1, at=30), ValueError, OUTSIDE % ("axis 0", "6.0")),
    (lambda: tegl.slice(VOLUME, 0.1, at=30, axis=2), ValueError, OUTSIDE % ("axis 2", "8.0")),
    (lambda: tegl.slice(VOLUME, 0.1, at=30, time_axis=-1), ValueError, OUTSIDE % ("axis 2", "8.0")),
    (lambda: tegl.slice(VOLUME, 0.1, z=30, axis_names=["z", "y", "x"]), ValueError, OUTSIDE % ("axis 0 ('z')", "6.0")),
    (lambda: tegl.slice(VOLUME, 0.1, at=1, affine=np.array([[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])), ValueError,
     "mixes axis 0 with others; expected a row 0 and a column 0"),
    (lambda: INDEX.pick((300, 3, 4), 0.1), ValueError,
     "the point (300, 3, 4) is not in the image; expected one from (0, 0, 0) to (6, 7, 8)"),
    (lambda: tegl.Index(VOLUME, time_axis=-1).pick((300, 3, 4), 0.1), ValueError,
     "the point (300, 3, 4) is not in the image; expected one from (0, 0, 0) to (6, 7, 8)"),
    (lambda: MOVING.simplify(ratio=0.5, scale=(0, 1, 1, 1)), ValueError, "the scale of axis 0 is 0; expected a finite number above 0"),
    (lambda: contour(coords=[None, [1, 2], None]), ValueError, "axis 1 has 8 samples and 2 coordinates"),
    (lambda: contour(coords=[[0, 1, 3, 2, 4, 5, 6], None, None]), ValueError,
     "coordinates 2 and 3 of axis 0 are 3 and 2; expected them strictly ascending or strictly descending"),
    (lambda: contour(coords=[[6, 5, 4, 3, 2, 2, 0], None, None], axis_names=["t", "", ""]), ValueError,
     "coordinates 4 and 5 of axis 0 ('t') are 2 and 2"),
    (lambda: contour(coords=[None, None, [0, 1, 2, 3, np.nan, 5, 6, 7, 8]]), ValueError,
     "coordinate 4 of axis 2 is nan; expected a finite number"),
    (lambda: contour(coords=["a", None, None]), TypeError, "the coordinates of axis 0 are 'a'; expected numbers"),
    (lambda: contour(coords=[5, None, None]), ValueError, "the coordinates of axis 0 have 0 dimensions; expected 1"),
    (lambda: contour(coords=7), TypeError, "coords is 7; expected the coordinates of each axis"),
    (lambda: contour(spacing=(1, 0, 1)), ValueError, "axis 1 has the origin 0 and the spacing 0; expected finite"),
    (lambda: contour(origin=(1, 2, np.inf)), ValueError, "axis 2 has the origin inf and the spacing 1; expected finite"),
    (lambda: tegl.contour(VOLUME[:, :0], 0.1), ValueError, "axis 1 has 0 samples; expected at least 1"),
    # Coordinates that the vertices cannot hold.
    (lambda: contour(spacing=(1, 1e300, 1)), ValueError,
     "coordinates along axis 1 reach 7e+300; expected 1.18e-38 to 3.4e+38, the range of float32, or dtype=numpy.float64"),
    (lambda: contour(origin=1e39), ValueError, "coordinates along axis 0 reach 1e+39"),
    (lambda: contour(spacing=1e-300), ValueError, "coordinates along axis 0 reach 6e-300; expected 1.18e-38 to"),
    (lambda: contour(affine=np.diag([1, 1, 1e60, 1])), ValueError, "coordinates along axis 2 reach 8e+60"),
    (lambda: contour(spacing=1e308, dtype=np.float64), ValueError, "coordinates along axis 0 reach inf"),
    (lambda: tegl.slice(VOLUME, 0.1, at=1e300, spacing=1e300), ValueError, "coordinates along axis 0 reach 6e+300"),
    (lambda: tegl.Index(VOLUME, spacing=1e300).contour(0.1), ValueError, "coordinates along axis 0 reach 6e+300"),
    # What is no contour.
    (lambda: tegl.simplify(VOLUME, scale="auto"), TypeError, "ndarray is not a contour; expected a tegl.Contour"),
    (lambda: tegl.elements(VOLUME, by_cell=True), TypeError, "ndarray is not a contour; expected a tegl.Contour"),
    # Arguments by name.
    (lambda: CONTOUR.slice(3, threads=-1), ValueError, THREADS), (lambda: CONTOUR.measure(threads=-1), ValueError, THREADS),
    (lambda: tegl.measure(MOVING, at=2, threads=-1), ValueError, THREADS),
    (lambda: CONTOUR.components(threads=-1), ValueError, THREADS),
    (lambda: CONTOUR.track(threads=-1), ValueError, THREADS), (lambda: CONTOUR.elements(threads=-1), ValueError, THREADS),
    (lambda: CONTOUR.simplify(ratio=0.5, threads=-1), ValueError, THREADS),
    (lambda: CONTOUR.sample(VOLUME, "a", threads=-1), ValueError, THREADS),
    (lambda: tegl.Index(VOLUME, threads=-1), ValueError, THREADS),
    (lambda: contour(threads=1.5), TypeError, "threads is 1.5; expected a whole number"),
    (lambda: contour(level="a"), TypeError, "level is 'a'; expected a number"),
    (lambda: contour(level=None), TypeError, "level is missing"),
    (lambda: contour(level=10**400), ValueError, "0000; expected a number in the range of float64"),
    (lambda: tegl.contour(None, 0.1), TypeError, "the array is None; expected an array"),
    (lambda: tegl.contour([[0, 1], [1]], 0.5), ValueError, "the array is [[0, 1], [1]], with rows of different lengths"),
    (lambda: contour(spacing="a"), TypeError, "spacing is 'a'; expected a number"),
    (lambda: contour(spacing=(1, "a", 2)), TypeError, "spacing[1] is 'a'; expected a number"),
    (lambda: contour(affine="a"), TypeError, "affine is 'a'; expected 3 x 4 or 4 x 4 numbers"),
    (lambda: contour(epsilon="a"), TypeError, "epsilon is 'a'; expected a number"),
    # Numbers are numbers, truth values truth values: nothing that merely can be made one of these.
    (lambda: contour(level="0.1"), TypeError, "level is '0.1'; expected a number"),
    (lambda: contour(level=True), TypeError, "level is True; expected a number"),
    (lambda: contour(level=np.bool_(True)), TypeError, "level is True; expected a number"),
    (lambda: contour(level=1j), TypeError, "level is 1j; expected a number"),
    (lambda: contour(level=np.complex128(1)), TypeError, "level is (1+0j); expected a number"),
    (lambda: contour(level=np.timedelta64(1, "h")), TypeError, "expected a number"),
    (lambda: contour(level=[0.1]), TypeError, "level is [0.1]; expected a number"),
    (lambda: contour(level=np.array([0.1])), TypeError, "level is array([0.1]); expected a number"),
    (lambda: contour(epsilon="0.1"), TypeError, "epsilon is '0.1'; expected a number"),
    (lambda: contour(spacing="2"), TypeError, "spacing is '2'; expected a number"),
    (lambda: contour(spacing=("1", 1, 1)), TypeError, "spacing[0] is '1'; expected a number"),
    (lambda: contour(origin=b"2"), TypeError, "origin is b'2'; expected a number"),
    (lambda: contour(coords=[["0", "1", "2", "3", "4", "5", "6"], None, None]), TypeError,
     "the coordinates of axis 0 are ['0', '1', '2', '3', '4', '5', '6']; expected numbers"),
    (lambda: contour(coords=[np.arange("2000-01-01", "2000-01-08", dtype="M8[D]"), None, None]), TypeError,
     "expected numbers, ascending or descending"),
    (lambda: contour(affine=np.eye(4).astype(str)), TypeError, "expected 3 x 4 or 4 x 4 numbers"),
    (lambda: contour(mask=np.full(VOLUME.shape, "no")), TypeError, "mask is of type <U2; expected True or False"),
    (lambda: contour(dtype=None), TypeError, "dtype is None; expected float32 or float64"),
    (lambda: contour(axis_names=["z", None, "x"]), TypeError, "axis_names[1] is None; expected text"),
    (lambda: contour(axis_units=[1, 2, 3]), TypeError, "axis_units[0] is 1; expected text"),
    (lambda: contour(level=np.nan), ValueError, "level is nan; expected a finite number"),
    (lambda: tegl.count(VOLUME, np.inf), ValueError, "level is inf; expected a finite number"),
    (lambda: contour(periodic=5), ValueError, "periodic is 5; expected -3 to 2"),
    (lambda: MOVING.save("x.ply"), ValueError, "'.ply' cannot hold tetrahedra in 4D space (the contour of a 4D image)"),
    (lambda: contour(time_axis="0"), TypeError, "time_axis is '0'; expected a whole number"),
    (lambda: contour(time_axis=False), TypeError, "time_axis is False; expected a whole number"),
    (lambda: contour(threads=True), TypeError, "threads is True; expected a whole number"),
    (lambda: contour(close="no"), TypeError, "close is 'no'; expected True or False"),
    (lambda: contour(close=1), TypeError, "close is 1; expected True or False"),
    (lambda: contour(close=None), TypeError, "close is None; expected True or False"),
    (lambda: contour(allow_empty="no"), TypeError, "allow_empty is 'no'; expected True or False"),
    (lambda: contour(normals="no"), ValueError,
     "normals is 'no'; expected True, False or one of 'gradient', 'sobel', 'prewitt', 'context', 'forward', 'backward', "
     "'geometric', 'flat'"),
    (lambda: contour(normals=np.zeros((3, 3, 3))), ValueError, "kernel whose differences along axis"),
    (lambda: contour(normals=np.ones((3, 3, 3))), ValueError, "kernel with the weights 1, 1, 1 on a line along axis"),
    (lambda: contour(normals=np.zeros((3, 3))), ValueError, "kernel of the shape"),
    (lambda: contour(normals=["a"]), TypeError, "expected real numbers"),
    (lambda: contour(normals=1), TypeError, "normals is 1; expected True, False or one of 'gradient', "),
    (lambda: contour(normals=None), TypeError, "normals is None; expected True, False or one of 'gradient', "),
    (lambda: contour(normals="flat", gradient="sobel"), ValueError, "normals is 'flat' and gradient 'sobel'; expected"),
    (lambda: INDEX.contour(0.1, normals="yes"), ValueError, "normals is 'yes'; expected True, False or one of"),
    (lambda: tegl.slice(VOLUME, 0.1, at=2, normals="yes"), ValueError, "normals is 'yes'; expected True, False or one of"),
    (lambda: tegl.contour(ball(5, 4), 0.0, normals="flat"), ValueError, "5D contour; expected 2 to 4 dimensions, or "),
    (lambda: CONTOUR.slice(3, allow_empty=1), TypeError, "allow_empty is 1; expected True or False"),
    (lambda: CONTOUR.slice(True), TypeError, "the coordinate is True; expected a number"),
    (lambda: CONTOUR.slice(3, axis=True), TypeError, "axis is True; expected a whole number"),
    (lambda: CONTOUR.slice(normal=(True, 0, 0), offset=3), TypeError, "normal[0] is True; expected a number"),
    (lambda: CONTOUR.elements(by_cell="no"), TypeError, "by_cell is 'no'; expected True or False"),
    (lambda: CONTOUR.elements().save("a.dat", header="no"), TypeError, "header is 'no'; expected True or False"),
    (lambda: CONTOUR.track(handles="no"), TypeError, "handles is 'no'; expected True or False"),
    (lambda: CONTOUR.track(label_simplices=1), TypeError, "label_simplices is 1; expected True or False"),
    (lambda: CONTOUR.track(times=True), TypeError, "times is True; expected a whole number"),
    (lambda: CONTOUR.simplify(0.5, measure="no"), TypeError, "measure is 'no'; expected True or False"),
    (lambda: CONTOUR.simplify(0.5, allow_nonmanifold="no"), TypeError, "allow_nonmanifold is 'no'; expected True or"),
    (lambda: CONTOUR.simplify(0.5, return_stats="no"), TypeError, "return_stats is 'no'; expected True or False"),
    (lambda: CONTOUR.simplify("0.5"), TypeError, "ratio is '0.5'; expected a number"),
    (lambda: CONTOUR.simplify(100), ValueError, "ratio is 100; expected 0 to 1, the fraction of the simplices to keep, "
     "or count= with their number"),
    (lambda: INDEX.pick((1, 2, 3), 0.1, return_report="no"), TypeError, "return_report is 'no'; expected True or False"),
    (lambda: tegl.marching_cubes(VOLUME, "0.1"), TypeError, "level is '0.1'; expected a number"),
    (lambda: tegl.marching_cubes(VOLUME, 0.1, allow_degenerate="no"), TypeError, "allow_degenerate is 'no'; expected True"),
    (lambda: contour(triangulation=3), TypeError, "triangulation is 3; expected text"),
    (lambda: contour(dtype="nonsense"), TypeError, "dtype is 'nonsense'; expected float32 or float64"),
    (lambda: contour(progress=3), TypeError, "progress is 3; expected a function that takes a fraction, or None"),
    (lambda: CONTOUR.components(progress=3), TypeError, "progress is 3; expected a function"),
    (lambda: contour(axis_names="ab"), ValueError, "axis_names has 2 entries; expected one for each of 3 axes"),
    (lambda: contour(axis_units=3), TypeError, "axis_units is 3; expected a list of text"),
    (lambda: contour(axis_names=["a", "b", "a"]), ValueError, "axis_names has 'a' more than once; expected different"),
    (lambda: tegl.slice(VOLUME, 0.1, at=3, lat=2), TypeError, "no argument is named 'lat'; expected one of triangulation"),
    (lambda: tegl.slice(VOLUME, "a", at=3), TypeError, "level is 'a'; expected a number"),
    (lambda: CONTOUR.slice("soon"), ValueError, "the coordinate 'soon' is neither a number nor a date; expected one of them"),
    (lambda: CONTOUR.slice([1, None]), TypeError, "the coordinate is None; expected a number"),
    (lambda: CONTOUR.slice(3, axis=1.5), TypeError, "axis is 1.5; expected a whole number"),
    (lambda: CONTOUR.slice(normal="abc", offset=3), TypeError, "normal is 'abc'; expected a number for each axis"),
    (lambda: CONTOUR.slice(normal=(1, 0, 0), offset="a"), TypeError, "offset is 'a'; expected a number"),
    (lambda: CONTOUR.track(times=-1), ValueError, "times is -1; expected 0 or more"),
    (lambda: CONTOUR.track(times=2.5), TypeError, "times is 2.5; expected a list of times, or a whole number"),
    (lambda: CONTOUR.track(min_lifetime="a"), TypeError, "min_lifetime is 'a'; expected a number"),
    (lambda: CONTOUR.track().save("a.svg", title=3), TypeError, "title is 3; expected text"),
    (lambda: CONTOUR.sample(VOLUME, 3), TypeError, "name is 3; expected text"),
    (lambda: CONTOUR.sample(VOLUME, ""), ValueError, "name is ''; expected a name"),
    (lambda: CONTOUR.sample(VOLUME, "a", 3), TypeError, "unit is 3; expected text"),
    (lambda: CONTOUR.simplify(ratio="a"), TypeError, "ratio is 'a'; expected a number"),
    (lambda: CONTOUR.simplify(count=1.5), TypeError, "count is 1.5; expected a whole number"),
    (lambda: CONTOUR.simplify(count=-1), ValueError, "count is -1; expected 0 or more"),
    (lambda: CONTOUR.simplify(count=2**70), ValueError, "expected 0 or more, below 2**63"),
    (lambda: CONTOUR.simplify(method=3), TypeError, "method is 3; expected text"),
    (lambda: CONTOUR.simplify(scale=3), TypeError, "scale is 3; expected 'auto' or a number for each axis"),
    (lambda: tegl.Index(VOLUME, 3), TypeError, "method is 3; expected text"),
    (lambda: INDEX.contour("a"), TypeError, "level is 'a'; expected a number"),
    (lambda: INDEX.active_tiles("a"), TypeError, "level is 'a'; expected a number"),
    (lambda: INDEX.pick(3, 0.1), TypeError, "point is 3; expected its coordinates along the array's axes"),
    (lambda: INDEX.pick((1, 2, "a"), 0.1), TypeError, "point[2] is 'a'; expected a number"),
    (lambda: CONTOUR.elements().save("a.dat", axes=3), TypeError, "axes is 3; expected text"),
    (lambda: CONTOUR.components().largest(-1), ValueError, "count is -1; expected 0 or more"),
    (lambda: CONTOUR.components().largest("a"), TypeError, "count is 'a'; expected a whole number"),
    (lambda: CONTOUR.components().select([1.5]), TypeError, "keep is [1.5]; expected a truth value for each component"),
    # Contours from arrays.
    (lambda: tegl.Contour(CORNERS * 1j, FACE), TypeError, "vertices are of type complex128; expected real numbers"),
    (lambda: tegl.Contour(CORNERS, FACE, normals=CORNERS * 1j), TypeError, "normals are of type complex128"),
    (lambda: tegl.Contour(CORNERS, FACE, normals=[1, 2]), ValueError, "normals have the shape (2,); expected (3, 3)"),
    (lambda: tegl.Contour(CORNERS, [0, 1, 2]), ValueError, "simplices have the shape (3,); expected (#S, 3)"),
    (lambda: tegl.Contour(CORNERS, [[0, 1]]), ValueError, "simplices have the shape (1, 2); expected (#S, 3)"),
    (lambda: tegl.Contour(CORNERS, FACE, axis_names=["a"]), ValueError, "axis_names has 1 entries; expected one for each"),
    (lambda: tegl.Contour(CORNERS, FACE, axis_names=["a", "b", "b"]), ValueError, "axis_names has 'b' more than once"),
    (lambda: tegl.Contour(CORNERS, FACE, direction=3), TypeError, "direction is 3; expected text"),
    (lambda: tegl.Contour(CORNERS, FACE, isovalue="a"), TypeError, "isovalue is 'a'; expected a number"),
    (lambda: tegl.Contour(CORNERS, FACE, vertex_attributes={3: [1, 2, 3]}), TypeError, "a name of vertex_attributes is 3"),
    (lambda: tegl.Contour(CORNERS, FACE, simplex_attributes={"a": ["x"]}), TypeError,
     "simplex_attributes['a'] are of type <U1; expected real numbers"),
    (lambda: tegl.Contour(CORNERS, FACE, vertex_attributes=3), TypeError, "vertex_attributes is 3; expected a dict"),
])
def test_what_is_wrong_is_named(call, error, text):
    with pytest.raises(error) as raised:
        call()
    assert text in str(raised.value)


def test_an_index_of_another_array_is_told_by_its_shape(tmp_path):
    path = tmp_path / "of 9 x 8 x 7 (1, 2, 3).tindex"
    INDEX.save(path)
    with pytest.raises(ValueError) as raised:
        tegl.Index.load(path, VOLUME[:5])
    assert "an image of 7 x 8 x 9 float; expected the one of 5 x 8 x 9 float" in str(raised.value)
    assert str(path) in str(raised.value), "the file's name stays as it is"


def test_an_axis_whose_name_two_have_is_cut_by_number(tmp_path):
    path = tmp_path / "a.nrrd"
    path.write_bytes(b'NRRD0004\ntype: float\nencoding: raw\nendian: little\ndimension: 3\nsizes: 9 8 7\n'
                     b'labels: "x" "a" "a"\n\n' + VOLUME.astype("<f4").tobytes())
    found = tegl.read(path).contour(0.1)
    with pytest.raises(ValueError, match="2 axes are named 'a'; expected axis= with the number of one"):
        found.slice(a=2.5)
    assert len(found.slice(2.5, axis=1).simplices) > 0 and len(found.slice(x=2.5).simplices) > 0


@pytest.mark.parametrize("no", [False, np.bool_(False), np.array(False), np.float32(0.5) < 0.25])
def test_false_of_any_kind_ends_the_work(no):
    long = noise((64, 64, 64), 1)
    with pytest.raises(tegl.Cancelled):
        tegl.contour(long, 0.1, progress=lambda fraction: no)


@pytest.mark.parametrize("other", [None, True, np.bool_(True), 0, 0.0, np.float64(0), ""])
def test_what_is_not_false_goes_on(other):
    long = noise((64, 64, 64), 1)
    assert len(tegl.contour(long, 0.1, progress=lambda fraction: other).simplices) > 1000


@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_an_empty_contour_encloses_nothing(ndim):
    empty = tegl.contour(ball(ndim), 100.0, allow_empty=True)
    assert empty.check().is_closed and empty.measure().content == 0 and empty.measure().size == 0
    if ndim > 2:
        assert tegl.measure(tegl.contour(ball(ndim), 0.0), at=-99, allow_empty=True).content[0] == 0


def test_extremes_that_fit_are_taken():
    far = contour(spacing=1e300, dtype=np.float64)
    assert np.isfinite(far.vertices).all() and np.allclose(far.vertices / 1e300, contour(dtype=np.float64).vertices)
    assert np.isfinite(contour(spacing=1e37).vertices).all()
    assert tegl.contour(VOLUME[:1], 0.1).vertices.shape == (0, 3), "an axis of one sample at 0"


# Levels and places outside of the data: an error that names the value, the range and its unit, unless empty results are
# allowed. What is empty within the data is no error.

HOURLY = noise((6, 7, 8, 9), 3)


def hourly():
    xarray = pytest.importorskip("xarray")
    times = np.datetime64("2020-01-01", "ns") + np.arange(6) * np.timedelta64(1, "h")
    return xarray.DataArray(HOURLY, dims=("time", "z", "y", "x"), coords={"time": times}, attrs={"units": "K"})


def said(call):
    with pytest.raises(ValueError) as raised:
        call()
    return str(raised.value)


def test_a_level_outside_of_the_values_is_an_error_that_names_them():
    least, most = VOLUME.min(), VOLUME.max()
    expected = (f"expected a level above {least!s} and up to {most!s}, the minimum and maximum of the array, or "
                "allow_empty=True for an empty contour")
    above, below = float(most) + 1, float(least)
    assert said(lambda: contour(level=above)) == f"level is {above}; {expected}"
    assert said(lambda: contour(level=below)) == f"level is {below}; {expected}", "all samples are at or above it"
    assert said(lambda: INDEX.contour(above)) == f"level is {above}; {expected}"
    assert said(lambda: INDEX.pick((1, 2, 3), above)) == f"level is {above}; {expected}"
    cut = expected.replace("empty contour", "empty slice")
    assert said(lambda: tegl.slice(VOLUME, above, at=2)) == f"level is {above}; {cut}"
    assert said(lambda: tegl.slice(VOLUME, above, at=[2, 3])) == f"level is {above}; {cut}"
    assert said(lambda: tegl.slice(VOLUME, above, normal=(1, 1, 0), offset=5)) == f"level is {above}; {expected}"
    assert "above 0.1 and up to 0.3 K, the minimum and" in said(lambda: tegl.Image(
        np.array([[0.1, 0.3]] * 2, np.float32), (np.arange(2.0), np.arange(2.0)), ("", ""), ("", ""), None, 0, "", "K", "", "", (),
        "", ("unknown",) * 2, (np.arange(2.0), np.arange(2.0))).contour(9)), "in as few digits as there are"
    assert "up to 200, the minimum and" in said(lambda: tegl.contour(np.array([[7, 200], [9, 8]], np.uint8), 300))
    assert len(contour(level=float(most)).simplices) > 0, "the highest sample is at the level"
    for level in (above, below):
        assert len(contour(level=level, allow_empty=True).simplices) == 0
        assert len(INDEX.contour(level, allow_empty=True).simplices) == 0
        assert len(INDEX.pick((1, 2, 3), level, allow_empty=True).simplices) == 0
        assert len(tegl.slice(VOLUME, level, at=2, allow_empty=True).simplices) == 0
        assert INDEX.active_tiles(level).shape == (0, 3)
    assert len(contour(level=below, close=True).simplices) > 0, "what is high everywhere is closed at the border"
    assert " K, the minimum and maximum" in said(lambda: tegl.contour(hourly(), 99))


def test_a_level_is_outside_of_values_that_are_all_alike_or_missing():
    flat, none = np.full((3, 4, 5), 7.0), np.full((3, 4, 5), np.nan)
    assert said(lambda: tegl.contour(flat, 7)) == ("level is 7.0, and all values of the array are 7.0; expected a level between "
                                                   "two values, or allow_empty=True for an empty contour")
    missing = ("level is 7.0, and all values of the array are missing (NaN or masked); expected values, or allow_empty=True for an "
               "empty contour")
    assert said(lambda: tegl.contour(none, 7)) == missing
    assert said(lambda: tegl.contour(flat, 7, mask=np.zeros(flat.shape, bool))) == missing
    assert said(lambda: tegl.contour(np.ma.masked_all((3, 4, 5)), 7)) == missing
    assert said(lambda: tegl.Index(none).contour(7)) == missing
    assert len(tegl.contour(none, 7, allow_empty=True).simplices) == 0
    apart = none.copy()
    apart[0, 0, 0], apart[2, 3, 4] = 0, 9
    assert len(tegl.contour(apart, 7).simplices) == 0, "the level lies between values, which no tile has"


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_place_outside_of_the_image_is_an_error_with_its_unit(dtype):
    moving = tegl.contour(hourly(), 0.1, dtype=dtype)
    most = moving.vertices.dtype.type(5 / 24)
    text = (f"the place along axis 0 ('time') is 31.25; expected a place between 0.0 and {most!s} days since 2020-01-01T00:00:00, the "
            "ends of the image, or allow_empty=True for an empty slice")
    calls = {"slice": lambda **more: moving.slice(31.25, **more), "slices": lambda **more: moving.slice([0.1, 31.25], **more),
             "name": lambda **more: moving.slice(time=31.25, **more), "measure": lambda **more: moving.measure(at=31.25, **more),
             "measures": lambda **more: tegl.measure(moving, at=[0.1, 31.25], **more),
             "track": lambda **more: moving.track(times=[0.1, 31.25], **more),
             "direct": lambda **more: tegl.slice(hourly(), 0.1, at=31.25, dtype=dtype, **more)}
    for name, call in calls.items():
        assert said(call) == text, name
        call(allow_empty=True)
    assert "is 366.0 (2021-01-01); expected a place between 0.0 and" in said(lambda: moving.slice("2021-01-01"))
    empty = moving.slice(31.25, allow_empty=True)
    direct = calls["direct"](allow_empty=True)
    for cut in (empty, direct):
        assert len(cut.simplices) == 0 and cut.isovalue == 0.1 and cut.vertices.dtype == dtype
        assert cut.axis_names == ("z", "y", "x") and cut.direction == "descent"
    several = tegl.slice(hourly(), 0.1, at=[0.1, 31.25], allow_empty=True)
    assert [len(cut.simplices) > 0 for cut in several] == [True, False]
    assert calls["measures"](allow_empty=True).size[1] == 0
    assert calls["measures"](allow_empty=True).content[1] == 0
    assert len(moving.slice(5 / 24).simplices) > 0 and len(moving.slice(float(most)).simplices) > 0, "the ends belong to it"


def test_oblique_planes_outside_of_the_image_are_an_error():
    moving = contour()
    assert said(lambda: moving.slice(normal=(1, 1, 0), offset=99)) == (
        "offset is 99.0; expected an offset between 0 and 13, the ends of the image along this normal, or allow_empty=True for an "
        "empty slice")
    assert "normal of a hyperplane that is 0" in said(lambda: moving.slice(normal=(0, 0, 0), offset=99))
    assert "offset is 8.0; expected an offset between -7 and 6, " in said(lambda: moving.slice(normal=(1, -1, 0), offset=[-1, 8]))
    assert len(moving.slice(normal=(1, 1, 0), offset=99, allow_empty=True).simplices) == 0
    moving.slice(normal=(1, 1, 0), offset=13.0)


def test_places_are_in_the_image_that_a_contour_is_of():
    """Where no contour is, but the image, a cut is empty without a word: so too for what was made of the contour."""
    array = ball(4, 9, 0.3)  # from 0 to 8, in the middle
    whole = tegl.contour(array, 0.0, spacing=(1, 2, 2, 2))
    assert whole.vertices[:, 0].min() > 2
    made = {"contour": whole, "pickled": pickle.loads(pickle.dumps(whole)), "copied": copy.deepcopy(whole),
            "part": whole.components().largest(), "split": whole.components().split()[0],
            "simplified": whole.simplify(0.5), "index": tegl.Index(array, spacing=(1, 2, 2, 2)).contour(0.0)}
    for name, one in made.items():
        assert len(one.slice(1).simplices) == 0, name
        assert "between 0.0 and 8.0, the ends of the image" in said(lambda: one.slice(8.5)), name
        assert "axis 2 is 16.5; expected a place between 0.0 and 16.0" in said(lambda: one.slice(16.5, axis=2)), name
    cut = whole.slice(4)
    assert len(cut.slice(0.5).simplices) == 0 and "between 0.0 and 16.0" in said(lambda: cut.slice(16.5))
    direct = tegl.slice(array, 0.0, at=4, spacing=(1, 2, 2, 2))
    assert len(direct.slice(0.5).simplices) == 0 and "between 0.0 and 16.0" in said(lambda: direct.slice(16.5))
    alone = tegl.Contour(whole.vertices, whole.simplices)
    low, high = alone.vertices[:, 0].min(), alone.vertices[:, 0].max()
    assert f"is 1.0; expected a place between {low!s} and {high!s}, the ends of the contour" in said(lambda: alone.slice(1))
    assert len(tegl.Contour(np.empty((0, 3)), np.empty((0, 3), int)).slice(1).simplices) == 0
    falling = tegl.contour(array, 0.0, coords=[np.arange(9.0)[::-1] ** 2, None, None, None])
    assert "between 0.0 and 64.0" in said(lambda: falling.slice(65))
    shifted = np.column_stack([np.diag([-1.0, 2, 2, 2]), [5.0, 0, 0, 0]])
    assert "between -3.0 and 5.0" in said(lambda: tegl.contour(array, 0.0, affine=shifted).slice(5.5))


def test_an_axis_without_a_name_is_cut_by_its_number():
    text = ("no axis is named 'x': the axes have no names; expected at=2 and axis= with a number from 0 to 2, or names for "
            "the axes: tegl.contour(array, level, axis_names=...)")
    assert said(lambda: CONTOUR.slice(x=2)) == text
    assert said(lambda: tegl.slice(CONTOUR, x=2)) == text
    assert said(lambda: tegl.slice(VOLUME, 0.1, x=2)) == text
