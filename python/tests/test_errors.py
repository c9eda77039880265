# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong is said by name, with what was expected, and with axes as the array has them: never in the words of the
binding, nor in the library's order of axes."""

import numpy as np
import pytest
import tegl
from conftest import ball, noise

VOLUME = noise((7, 8, 9), 0)
CONTOUR = tegl.contour(VOLUME, 0.1)
MOVING = tegl.contour(noise((5, 6, 7, 8), 0), 0.1)
INDEX = tegl.Index(VOLUME)
CORNERS, FACE = np.eye(3), [[0, 1, 2]]
THREADS = "threads is -1; expected 0 (all) or more"


def contour(**arguments):
    return tegl.contour(VOLUME, arguments.pop("level", 0.1), **arguments)


@pytest.mark.parametrize("call, error, text", [
    # Axes by the array's numbers.
    (lambda: tegl.slice(VOLUME, 0.1, at=30), ValueError, "between 0 and 6, the ends of axis 0"),
    (lambda: tegl.slice(VOLUME, 0.1, at=30, axis=2), ValueError, "between 0 and 8, the ends of axis 2"),
    (lambda: tegl.slice(VOLUME, 0.1, at=30, time_axis=-1), ValueError, "between 0 and 8, the ends of axis 2"),
    (lambda: tegl.slice(VOLUME, 0.1, z=30, axis_names=["z", "y", "x"]), ValueError, "the ends of axis 0 (z)"),
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
    (lambda: tegl.contour(np.where(np.arange(6) == 4, np.nan, noise((3, 3, 4, 5, 6), 1)).swapaxes(0, 4), 0.1), ValueError,
     "the first in layer 4 of its axis 0"),
    # Coordinates that the vertices cannot hold.
    (lambda: contour(spacing=(1, 1e300, 1)), ValueError,
     "coordinates along axis 1 reach 7e+300; expected 1.18e-38 to 3.4e+38, as float32 holds, or dtype=numpy.float64"),
    (lambda: contour(origin=1e39), ValueError, "coordinates along axis 0 reach 1e+39"),
    (lambda: contour(spacing=1e-300), ValueError, "coordinates along axis 0 reach 6e-300; expected 1.18e-38 to"),
    (lambda: contour(affine=np.diag([1, 1, 1e60, 1])), ValueError, "coordinates along axis 2 reach 8e+60"),
    (lambda: contour(spacing=1e308, dtype=np.float64), ValueError, "coordinates along axis 0 reach inf"),
    (lambda: tegl.slice(VOLUME, 0.1, at=1e300, spacing=1e300), ValueError, "coordinates along axis 0 reach 6e+300"),
    (lambda: tegl.Index(VOLUME, spacing=1e300).contour(0.1), ValueError, "coordinates along axis 0 reach 6e+300"),
    # What is no contour.
    (lambda: tegl.simplify(VOLUME, scale="auto"), TypeError, "ndarray is no contour; expected a tegl.Contour"),
    (lambda: tegl.elements(VOLUME, by_cell=True), TypeError, "ndarray is no contour; expected a tegl.Contour"),
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
    (lambda: contour(level=None), TypeError, "level is None; expected a number"),
    (lambda: contour(spacing="a"), TypeError, "spacing is 'a'; expected a number"),
    (lambda: contour(spacing=(1, "a", 2)), TypeError, "spacing[1] is 'a'; expected a number"),
    (lambda: contour(affine="a"), TypeError, "affine is 'a'; expected 3 x 4 or 4 x 4 numbers"),
    (lambda: contour(epsilon="a"), TypeError, "epsilon is 'a'; expected a number"),
    (lambda: contour(triangulation=3), TypeError, "triangulation is 3; expected text"),
    (lambda: contour(dtype="nonsense"), TypeError, "dtype is 'nonsense'; expected float32 or float64"),
    (lambda: contour(progress=3), TypeError, "progress is 3; expected a function that takes a fraction, or None"),
    (lambda: CONTOUR.components(progress=3), TypeError, "progress is 3; expected a function"),
    (lambda: contour(axis_names="ab"), ValueError, "axis_names has 2 entries; expected one for each of 3 axes"),
    (lambda: contour(axis_units=3), TypeError, "axis_units is 3; expected a list of text"),
    (lambda: contour(axis_names=["a", "b", "a"]), ValueError, "axis_names has 'a' more than once; expected different"),
    (lambda: tegl.slice(VOLUME, 0.1, at=3, lat=2), TypeError, "no argument is named 'lat'; expected one of triangulation"),
    (lambda: tegl.slice(VOLUME, "a", at=3), TypeError, "level is 'a'; expected a number"),
    (lambda: CONTOUR.slice("soon"), ValueError, "the coordinate 'soon' is no number, and no date; expected one"),
    (lambda: CONTOUR.slice([1, None]), TypeError, "the coordinate is None; expected a number"),
    (lambda: CONTOUR.slice(3, axis=1.5), TypeError, "axis is 1.5; expected a whole number"),
    (lambda: CONTOUR.slice(normal="abc", offset=3), TypeError, "normal is 'abc'; expected a number for each axis"),
    (lambda: CONTOUR.slice(normal=(1, 0, 0), offset="a"), TypeError, "offset is 'a'; expected a number"),
    (lambda: CONTOUR.track(times=-1), ValueError, "times is -1; expected 0 or more"),
    (lambda: CONTOUR.track(times=2.5), TypeError, "times is 2.5; expected a list of times, or a whole number"),
    (lambda: CONTOUR.track(min_lifetime="a"), TypeError, "min_lifetime is 'a'; expected a number"),
    (lambda: CONTOUR.track().save("a.svg", title=3), TypeError, "title is 3; expected text"),
    (lambda: CONTOUR.sample(VOLUME, 3), TypeError, "name is 3; expected text"),
    (lambda: CONTOUR.sample(VOLUME, ""), ValueError, "name is ''; expected one"),
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
    empty = tegl.contour(ball(ndim), 100.0)
    assert empty.check().is_closed and empty.measure().content == 0 and empty.measure().size == 0
    if ndim > 2:
        assert tegl.measure(tegl.contour(ball(ndim), 0.0), at=-99).content[0] == 0


def test_extremes_that_fit_are_taken():
    far = contour(spacing=1e300, dtype=np.float64)
    assert np.isfinite(far.vertices).all() and np.allclose(far.vertices / 1e300, contour(dtype=np.float64).vertices)
    assert np.isfinite(contour(spacing=1e37).vertices).all()
    assert tegl.contour(VOLUME[:1], 0.1).vertices.shape == (0, 3), "an axis of one sample at 0"
