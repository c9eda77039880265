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
    """The library's axes and their periods (NaN: by the samples) of the argument `periodic`; `curved`: of `_curved.coordinates_of`."""
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
    """The library's axis of a name or number. "lon" and "longitude" also are the axis along which longitudes, by their unit,
    run around the globe, or else the only axis of longitudes; so is the name of longitudes in an array of several dimensions."""
    if not isinstance(axis, str):
        return prepared.library_axis(axis)
    if axis not in prepared.names:
        is_longitude = axis in ("lon", "longitude")
        found = _tegl.longitude_axes(prepared.image, curved) if is_longitude else []
        if is_longitude and len(found) != 1:
            found = [prepared.library_axis(number) for number, unit in enumerate(prepared.units) if _tegl.is_longitude_unit(unit)]
        return found[0] if len(found) == 1 else prepared.library_axis(axis)
    number = prepared.library_axis(axis)
    for one in curved:
        found = [a for a in _tegl.longitude_axes(prepared.image, [one]) if one[1] >> a & 1]
        if len(found) == 1 and number in (one[0], found[0]):  # the other coordinate has the other axis
            return found[0] if number == one[0] else one[0]
    return number
