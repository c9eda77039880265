# SPDX-License-Identifier: BSD-3-Clause
"""The argument `curved`: coordinates of the samples of a curved grid."""

from __future__ import annotations

import contextlib
import re
import typing
import warnings
from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _tegl
from ._xarrays import NORTH

#: A coordinate for the library: axis, set of axes that it differs along, numbers, from one to the next one of them, unit.
Coordinate = tuple[int, int, "np.ndarray[typing.Any, typing.Any]", int, str]


class CurvedGrid:
    """Coordinates of the samples of a curved grid, for several contours.

    They are stored sample by sample, and checked for folds once. So contours after the first one take 1.2 to 1.3 times the
    time of a plain contour, without a copy of coordinates. The library counts samples in another order if the time is the
    last axis (`time_axis=-1`); the first contour of such an image stores the coordinates a second time, in that order.

    ::

        grid = tegl.CurvedGrid({0: x, 1: y, 2: z})
        surfaces = [tegl.contour(array, level, curved=grid) for level in (1.0, 2.0, 3.0)]
    """

    def __init__(self, coordinates, *, threads: int = 0) -> None:
        """
        coordinates
            As the argument `curved` of `tegl.contour`: a dict of axes and arrays, or an array of the shape (..., N). They are
            copied; as float32 if this represents all of them exactly. Masked ones become NaN, and their samples are missing.
        threads
            Number of threads for the copy; 0: all processors.
        """
        self._masked = masked_samples(coordinates)
        arrays = {key: _numbers(f"curved[{key!r}]", values) for key, values in _by_axis(coordinates).items()}
        self._threads = _arguments.threads_of(threads)
        self._coordinates = _stored(arrays, "C", self._threads)
        self._in_fortran_order: dict[int | str, np.ndarray] = {}
        self._folds: dict[tuple, tuple[int, list[int]]] = {}
        self._places: dict[tuple, tuple[np.ndarray, NoPlaces | None]] = {}

    @property
    def coordinates(self) -> dict[int | str, np.ndarray]:
        """The arrays by axis, read-only, as `tegl.contour` takes them."""
        return dict(self._coordinates)

    def _in_order(self, is_reversed: bool) -> dict[int | str, np.ndarray]:
        """The arrays, in the library's order of samples."""
        if is_reversed:
            return self._coordinates
        if not self._in_fortran_order:
            self._in_fortran_order = _stored(self._coordinates, "F", self._threads)
        return self._in_fortran_order

    def __repr__(self) -> str:
        arrays = ", ".join(f"{key!r}: {' x '.join(map(str, one.shape))} {one.dtype}" for key, one in self._coordinates.items())
        return f"<tegl.CurvedGrid {arrays}>"


def masked_samples(curved: object) -> np.ndarray | None:
    """Where a coordinate is masked, with size 1 along the axes on which no mask depends; None if none is, or if the arrays do
    not fit to each other."""
    if isinstance(curved, CurvedGrid):
        return curved._masked
    if not isinstance(curved, Mapping):
        mask = np.ma.getmaskarray(curved) if np.ma.is_masked(curved) else np.False_
        return mask.any(axis=-1) if mask.ndim > 1 else None
    masks = [np.ma.getmask(one) for one in curved.values() if np.ma.is_masked(one)]
    try:
        return np.logical_or.reduce(np.broadcast_arrays(*masks)) if masks else None
    except ValueError:
        return None


def coordinates_of(curved: object, prepared: _arguments.Prepared) -> tuple[list[Coordinate], list[NoPlaces]]:
    """The argument `curved` for the library. Arrays of float32 and float64 are used in place if the library's order of
    samples is theirs. Longitudes are continued across 180 degrees; those of a CurvedGrid once. Numbers that cannot be places
    become NaN; the second result has these, by coordinate."""
    result: list[Coordinate] = []
    no_places: list[NoPlaces] = []
    known = curved._places if isinstance(curved, CurvedGrid) else {}
    arrays = curved._in_order(prepared.is_reversed) if isinstance(curved, CurvedGrid) else _by_axis(curved, prepared.sizes)
    are_small = isinstance(curved, np.ndarray) and _are_small(curved)  # of points at once, as they are side by side
    for key, given in arrays.items():
        axis = prepared.library_axis(key)
        values = _numbers(f"curved[{key!r}]", given)
        if values.ndim != prepared.ndim or any(size not in (1, whole) for size, whole in zip(values.shape, prepared.sizes)):
            raise ValueError(f"curved[{key!r}] has the shape {values.shape}; expected {prepared.sizes}, with 1 for axes along "
                             "which the coordinate does not differ")
        along = sum(1 << (prepared.ndim - 1 - a if prepared.is_reversed else a)
                    for a, size in enumerate(values.shape) if size > 1)
        unit = prepared.units[prepared.ndim - 1 - axis if prepared.is_reversed else axis]
        if (key, prepared.is_reversed, unit) not in known:
            known[key, prepared.is_reversed, unit] = _places(f"curved[{key!r}]", values, unit, are_small, prepared)
        values, wrong = known[key, prepared.is_reversed, unit]
        if wrong is not None:
            no_places.append(wrong)
        result.append((axis, along, *_evenly_spaced(values, prepared.is_reversed), unit))
    return result, no_places


@contextlib.contextmanager
def naming(no_places: list[NoPlaces]) -> typing.Iterator[None]:
    """Adds a number that cannot be a place to the library's error about a cell with unknown coordinates, if it is the reason:
    at a corner of this cell."""
    try:
        yield
    except ValueError as error:
        cell = re.search(r"the cell at the sample \(([\d, ]+)\), which has unknown coordinates", str(error))
        texts = [one.text_in(tuple(map(int, cell[1].split(", ")))) for one in no_places] if cell else []
        text = next(filter(None, texts), "")
        if not text:
            raise
        raise type(error)(f"{error}. {text}") from None


def warn_of_folds(curved: object, prepared: _arguments.Prepared, of_samples: list[Coordinate], axes: Sequence[int],
                  periods: Sequence[float]) -> None:
    """Warns if the grid is folded. A CurvedGrid is checked once for each size and all periodic axes."""
    known = curved._folds if isinstance(curved, CurvedGrid) else {}
    key = (prepared.sizes, prepared.is_reversed, prepared.units, tuple(one[0] for one in of_samples),
           tuple(zip(axes, map(str, periods))))  # NaN does not equal itself
    if key not in known:
        known[key] = _tegl.find_folds(prepared.image, of_samples, axes, periods)
    cells, first = known[key]
    if cells:
        at = ", ".join(map(str, first[::-1] if prepared.is_reversed else first))
        warnings.warn(f"the curved grid is folded in {cells} {'cell' if cells == 1 else 'cells'}, the first at the sample "
                      f"({at}): the contour may overlap itself there", stacklevel=4)


def _by_axis(curved: object, sizes: tuple[int, ...] | None = None) -> Mapping[int | str, object]:
    """Arrays by axis; of an array of the shape (..., N), or with these sizes of the axes, its columns."""
    if isinstance(curved, CurvedGrid):
        return curved.coordinates
    if isinstance(curved, Mapping) and curved:
        return curved
    if isinstance(curved, Mapping) or not hasattr(curved, "__array__"):
        raise TypeError(f"curved is {curved!r}; expected a dict of axes and arrays of coordinates, an array with the "
                        "coordinates along its last axis, or a tegl.CurvedGrid")
    points = _arguments.real("curved", curved)
    if isinstance(curved, np.ma.MaskedArray):
        points = curved
    ndim = points.ndim - 1 if sizes is None else len(sizes)
    if points.ndim < 2 or points.ndim != ndim + 1 or points.shape[-1] != ndim:
        expected = "(..., N) with N other axes" if sizes is None else f"{(*sizes, ndim)}"
        raise ValueError(f"curved has the shape {points.shape}; expected {expected}, the coordinates along the last axis")
    return {axis: points[..., axis] for axis in range(ndim)}


def _stored(arrays: Mapping[int | str, np.ndarray], order: typing.Literal["C", "F"],
            threads: int) -> dict[int | str, np.ndarray]:
    """Read-only copies of the arrays, sample by sample, with the samples in this order. Numbers of axes are sorted, as the
    library interpolates together only columns in the order of their axes."""
    result: dict[int | str, np.ndarray] = {}
    for shape in dict.fromkeys(array.shape for array in arrays.values()):
        ndim = len(shape)
        together = [key for key, array in arrays.items() if array.shape == shape]
        together.sort(key=lambda key: key % ndim if isinstance(key, (int, np.integer)) and ndim else ndim)  # stable
        for first in range(0, len(together), 4):  # as many as the library stores together
            keys = together[first:first + 4]
            points = _tegl.by_points([arrays[key].ravel(order=order) for key in keys], threads)
            points.flags.writeable = False
            for column, key in enumerate(keys):
                result[key] = points[:, column].reshape(shape, order=order)
    return {key: result[key] for key in arrays}


def _numbers(name: str, given: object) -> np.ndarray:
    """Coordinates as float32 or float64 that the library can read in place; others are converted to float64. Masked ones are
    NaN."""
    values = _arguments.real(name, given)
    if not (values.dtype in (np.float32, np.float64) and values.dtype.isnative and values.flags.aligned):
        values = values.astype(np.float64)
    return np.where(np.ma.getmaskarray(given), values.dtype.type(np.nan), values) if np.ma.is_masked(given) else values


#: Numbers beyond this, such as 1e20, mark missing coordinates, as in files.
_MOST = 1e19


class NoPlaces(typing.NamedTuple):
    """A coordinate with numbers that cannot be places."""

    name: str
    values: np.ndarray
    most: float  #: of a place
    expected: str
    other_remedy: str  #: than a mask; "": none

    def text_in(self, cell: tuple[int, ...]) -> str:
        """About the first such number at a corner of the cell at this sample, also across the seam; "" if there is none."""
        corners = np.ix_(*([i % size, (i + 1) % size] for i, size in zip(cell, self.values.shape)))
        wrong = np.argwhere(np.abs(self.values[corners]) > self.most)
        if not len(wrong):
            return ""
        first = tuple((i + int(step)) % size for i, step, size in zip(cell, wrong[0], self.values.shape))
        return (f"{self.name}[{', '.join(map(str, first))}] is {self.values[first]:g}, which cannot be a place (expected "
                f"{self.expected}); the mask of a masked array, as of numpy.ma.masked_equal, hides such samples{self.other_remedy}")


def _are_small(values: np.ndarray) -> bool:
    """Whether it is certain, in one pass, that no number is beyond _MOST."""
    if values.dtype not in (np.float32, np.float64) or not values.flags.forc:
        return False
    flat = np.asarray(values).ravel(order="K")
    with np.errstate(all="ignore"):
        return bool(np.vdot(flat, flat) < _MOST**2)  # False for NaN


def _places(name: str, values: np.ndarray, unit: str, are_small: bool,
            prepared: _arguments.Prepared) -> tuple[np.ndarray, NoPlaces | None]:
    """Coordinates with NaN for numbers that cannot be places, as in files, and longitudes continued across 180 degrees: a
    copy if any must change. Also these numbers, if there are any. `are_small`: none is beyond _MOST."""
    is_longitude = _tegl.is_longitude_unit(unit)
    most, expected = ((720.0, "-720 to 720") if is_longitude else (90.01, "-90 to 90") if unit in NORTH else
                      (_MOST, "at most 1e19"))
    if most == _MOST and (are_small or _are_small(values)):
        return values, None
    least, greatest, no_places = np.fmin.reduce(values, axis=None), np.fmax.reduce(values, axis=None), None
    if least < -most or greatest > most:
        no_places = NoPlaces(name, values, most, expected, ", or shift longitudes by multiples of 360" if is_longitude else "")
        values = np.where(np.abs(values) > most, values.dtype.type(np.nan), values)
        least, greatest = np.fmin.reduce(values, axis=None), np.fmax.reduce(values, axis=None)
    return _continued(values, prepared) if is_longitude and greatest - least > 180 else values, no_places


def _continued(values: np.ndarray, prepared: _arguments.Prepared) -> np.ndarray:
    """Longitudes continued across 180 degrees: a copy if any must be."""
    order: typing.Literal["C", "F"] = "C" if prepared.is_reversed else "F"
    result = np.array(values, dtype=np.float64, order=order)
    _tegl.continue_longitudes(result.reshape(-1, order=order), prepared.turned(values.shape))
    return values if np.array_equal(result, values, equal_nan=True) else result


def _evenly_spaced(values: np.ndarray, is_reversed: bool) -> tuple[np.ndarray, int]:
    """Coordinates, equally far apart in memory in the library's order of samples, and how far, counted in numbers. Others
    are copied."""
    pitch, expected = 1, 0
    for axis in range(values.ndim)[::-1 if is_reversed else 1]:  # the fastest one first
        if values.shape[axis] < 2:
            continue
        if not expected:
            expected = values.strides[axis]
            pitch = expected // values.itemsize
            if pitch < 1 or expected % values.itemsize:
                break
        if values.strides[axis] != expected:
            break
        expected *= values.shape[axis]
    else:
        return values, pitch
    return np.array(values, order="C" if is_reversed else "F"), 1
