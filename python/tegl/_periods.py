# SPDX-License-Identifier: BSD-3-Clause
"""The argument `periodic`: axes that continue at their other end, by name, number, period or as longitudes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _curved, _tegl


def given_or_none(periodic: object) -> object:
    """The argument `periodic`; None if it is the program's word for that."""
    return None if isinstance(periodic, str) and periodic == "none" else periodic


def axes_of(periodic: object, prepared: _arguments.Prepared,
            curved: Sequence[_curved.Coordinate] = ()) -> tuple[list[int], list[float]]:
    """The library's axes and their periods (NaN: by the samples) of the argument `periodic`; `curved`: of
    `_curved.coordinates_of`."""
    if isinstance(periodic, str) and periodic == "auto":
        found = _tegl.longitude_axes(prepared.image, curved)
        return found, [float("nan")] * len(found)
    if isinstance(periodic, str) and periodic == "all":
        periodic = list(range(prepared.ndim))
    if isinstance(periodic, (str, int, np.integer)) and not isinstance(periodic, bool):
        periodic = [periodic]
    if isinstance(periodic, Mapping):
        given = [(axis, _arguments.as_number(f"periodic[{axis!r}]", period)) for axis, period in periodic.items()]
        for axis, period in given:
            if not np.isfinite(period) or period <= 0:
                raise ValueError(f"periodic[{axis!r}] is {period}; expected a positive number")
    elif isinstance(periodic, (list, tuple)):
        given = [(axis, float("nan")) for axis in periodic]
    else:
        raise TypeError(f"periodic is {periodic!r}; expected an axis, a list of axes, 'all', 'auto', 'none', or a "
                        "dict of axes and periods")
    axes = [_axis(axis, prepared, curved) for axis, _ in given]
    if not axes or len(set(axes)) != len(axes):
        raise ValueError(f"periodic is {periodic!r}; expected at least one axis, each once")
    return axes, [period for _, period in given]


def _axis(axis: int | str, prepared: _arguments.Prepared,
          curved: Sequence[_curved.Coordinate]) -> int:
    """The library's axis of a name or number. Names of curved longitudes, by their unit, stand for the axis along which
    these run or grow most, and so do "lon" and "longitude" if only one axis has longitudes, or runs around the globe."""
    if not isinstance(axis, str):
        return prepared.library_axis(axis, "periodic")
    longitudes = [(one[0], _tegl.axis_of_longitudes(prepared.image, [one])) for one in curved
                  if _tegl.is_longitude_unit(one[4])]
    if axis not in prepared.names:
        found: list[int] = []
        if axis in ("lon", "longitude"):
            of_units = [prepared.library_axis(number) for number, unit in enumerate(prepared.units)
                        if _tegl.is_longitude_unit(unit)]
            along = dict(longitudes)
            found = [along.get(number, number) for number in of_units]
            if len(found) != 1:
                found = _tegl.longitude_axes(prepared.image, curved)
        return found[0] if len(found) == 1 else prepared.library_axis(axis)
    number = prepared.library_axis(axis)
    for own, axis_along in longitudes:
        if number in (own, axis_along):  # the other coordinate has the other axis
            return axis_along if number == own else own
    return number
