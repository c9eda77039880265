# SPDX-License-Identifier: BSD-3-Clause
"""Levels outside of the values, and slices outside of the data: errors with the range, unless the caller allows empty
results. A slice within the data that misses the contour is an empty result, not an error.

The extent of an image, or of a contour without one, is an array of 2 x N: the lowest and the highest world coordinate
along each of the array's axes.
"""

from __future__ import annotations

import typing
from collections.abc import Sequence

import numpy as np

from . import _tegl
from ._arguments import Prepared

ALLOWED = "or allow_empty=True for an empty {}"


def _in_blocks(array: np.ndarray) -> typing.Iterator[np.ndarray]:
    """Parts of an array, a few megabytes each, in the order of memory."""
    if array.size == 0:
        return
    turned = np.moveaxis(array, int(np.argmax(np.abs(array.strides))), 0)
    rows = max(1, (1 << 20) * len(turned) // array.size)
    for first in range(0, len(turned), rows):
        yield turned[first:first + rows]


def _range_not_around(array: np.ndarray, level: float) -> tuple[typing.Any, typing.Any] | None:
    """The lowest and the highest value, NaN if all are missing; None once there are samples below the level and not below
    it."""
    least: typing.Any = np.nan
    most: typing.Any = np.nan
    for block in _in_blocks(array):
        least, most = np.fmin(least, np.fmin.reduce(block, axis=None)), np.fmax(most, np.fmax.reduce(block, axis=None))
        if least < level <= most:
            return None
    return array.dtype.type(least) if least == least else least, array.dtype.type(most) if most == most else most


def require_level(prepared: Prepared, level: float, what: str = "contour") -> None:
    """Raises a ValueError unless the level lies between the values of an array. For empty results: one pass over the
    values finds out whether the level is the reason."""
    found = _range_not_around(prepared.image.array, level)
    if found is None:
        return
    least, most = map(str, found)  # the shortest form for their type, unlike format()
    unit = f" {prepared.value_unit}" if prepared.value_unit else ""
    allowed = ALLOWED.format(what)
    if least == "nan":
        raise ValueError(f"level is {level}, and all values of the array are missing (NaN or masked); expected values, {allowed}")
    raise level_error(level, least, most, "array", unit, what)


def level_error(level: float, least: str, most: str, of: str, unit: str = "", what: str = "contour") -> ValueError:
    """The error of a level outside of the values from `least` to `most`. `of`: the array, or the values of a mesh."""
    allowed = ALLOWED.format(what)
    if least == most:
        all_values = "values" if of == "values" else f"values of the {of}"
        return ValueError(f"level is {level}, and all {all_values} are {least}{unit}; expected a level between two values, "
                          f"{allowed}")
    return ValueError(f"level is {level}; expected a level above {least} and up to {most}{unit}, the minimum and maximum "
                      f"of the {of}, {allowed}")


def without_axis(extent: np.ndarray | None, axis: int) -> np.ndarray | None:
    return None if extent is None else np.delete(extent, axis, axis=1)


def is_outside(extent: np.ndarray | None, axis: int, place: float, dtype) -> bool:
    """Whether a place along an axis lies outside of an extent, with both rounded like coordinates. The library checks
    places that are not finite."""
    if extent is None or not np.isfinite(place):
        return False
    with np.errstate(over="ignore"):
        low, at, high = np.array([extent[0, axis], place, extent[1, axis]]).astype(dtype)
    return not low <= at <= high


def turned(extent: np.ndarray | None, axis: int, place: float, dtype, unit: str) -> float:
    """A place along an axis of longitudes, moved by turns of 360 into the extent; unchanged if no turn leads there, and along
    other axes."""
    if extent is None or not _tegl.is_longitude_unit(unit) or not is_outside(extent, axis, place, dtype):
        return place
    moved = float(place - 360 * np.floor((place - extent[0, axis]) / 360))
    return place if is_outside(extent, axis, moved, dtype) else moved


def require_places(extent: np.ndarray | None, axis: int, places: Sequence[float], given: Sequence, dtype, name: str,
                      unit: str, of: str) -> None:
    """Raises a ValueError unless all places along an axis lie in the extent. `given`: the places in the caller's form."""
    for place, said in zip(places, given):
        if extent is None or not is_outside(extent, axis, place, dtype):
            continue
        low, high = map(str, extent[:, axis].astype(dtype))
        called = f"axis {axis}" + (f" ('{name}')" if name else "")
        said_as = "" if isinstance(said, (int, float, np.number)) else f" ({said})"
        raise ValueError(f"the place along {called} is {place}{said_as}; expected a place between {low} and {high}"
                         f"{' ' + unit if unit else ''}, the ends of the {of}, {ALLOWED.format('slice')}")


def extent_around(vertices: np.ndarray) -> np.ndarray | None:
    """The extent of a contour's vertices; None without vertices, or if some are not finite."""
    if not len(vertices):
        return None
    ends = np.stack([vertices.min(axis=0), vertices.max(axis=0)]).astype(np.float64)
    return ends if np.isfinite(ends).all() else None


def require_offsets(extent: np.ndarray | None, normal: Sequence[float], offsets: Sequence[float], dtype, of: str) -> None:
    """Raises a ValueError unless all hyperplanes <normal, x> = offset meet the extent, up to rounding."""
    if extent is None or len(normal) != extent.shape[1] or not np.isfinite(normal).all() or not np.any(normal):
        return
    ends = extent * np.asarray(normal, dtype=np.float64)
    low, high = np.min(ends, axis=0).sum(), np.max(ends, axis=0).sum()
    slack = 4 * np.finfo(dtype).eps * np.abs(ends).max(axis=0).sum()
    for offset in offsets:
        if np.isfinite(offset) and not low - slack <= offset <= high + slack:
            raise ValueError(f"offset is {offset}; expected an offset between {low:g} and {high:g}, the ends of the {of} along this "
                             f"normal, {ALLOWED.format('slice')}")
