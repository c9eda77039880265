# SPDX-License-Identifier: BSD-3-Clause
"""The argument `curved`: coordinates of the samples of a curved grid."""

from __future__ import annotations

import typing
import warnings
from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _tegl

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
            copied; as float32 if this represents all of them exactly.
        threads
            Number of threads for the copy; 0: all processors.
        """
        arrays = {key: _numbers(f"curved[{key!r}]", values) for key, values in _by_axis(coordinates).items()}
        self._threads = _arguments.threads_of(threads)
        self._coordinates = _stored(arrays, "C", self._threads)
        self._in_fortran_order: dict[int | str, np.ndarray] = {}
        self._folds: dict[tuple, tuple[int, list[int]]] = {}
        self._continued: dict[tuple, np.ndarray] = {}

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


def coordinates_of(curved: object, prepared: _arguments.Prepared) -> list[Coordinate]:
    """The argument `curved` for the library. Arrays of float32 and float64 are used in place if the library's order of
    samples is theirs. Longitudes are continued across 180 degrees; those of a CurvedGrid once."""
    result = []
    continued = curved._continued if isinstance(curved, CurvedGrid) else {}
    arrays = curved._in_order(prepared.is_reversed) if isinstance(curved, CurvedGrid) else _by_axis(curved, prepared.sizes)
    for key, given in arrays.items():
        axis = prepared.library_axis(key)
        values = _numbers(f"curved[{key!r}]", given)
        if values.ndim != prepared.ndim or any(size not in (1, whole) for size, whole in zip(values.shape, prepared.sizes)):
            raise ValueError(f"curved[{key!r}] has the shape {values.shape}; expected {prepared.sizes}, with 1 for axes along "
                             "which the coordinate does not differ")
        along = sum(1 << (prepared.ndim - 1 - a if prepared.is_reversed else a)
                    for a, size in enumerate(values.shape) if size > 1)
        unit = prepared.units[prepared.ndim - 1 - axis if prepared.is_reversed else axis]
        if _tegl.is_longitude_unit(unit):
            if (key, prepared.is_reversed) not in continued:
                continued[key, prepared.is_reversed] = _continued(values, prepared)
            values = continued[key, prepared.is_reversed]
        result.append((axis, along, *_evenly_spaced(values, prepared.is_reversed), unit))
    return result


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
    """Coordinates as float32 or float64 that the library can read in place; others are converted to float64."""
    values = _arguments.real(name, given)
    if values.dtype in (np.float32, np.float64) and values.dtype.isnative and values.flags.aligned:
        return values
    return values.astype(np.float64)


def _continued(values: np.ndarray, prepared: _arguments.Prepared) -> np.ndarray:
    """Longitudes continued across 180 degrees: a copy if any must be."""
    if not np.fmax.reduce(values, axis=None) - np.fmin.reduce(values, axis=None) > 180:
        return values
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
