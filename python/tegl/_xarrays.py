# SPDX-License-Identifier: BSD-3-Clause
"""What is read of xarrays without the rest of the arguments."""

from __future__ import annotations

import numpy as np

from . import _tegl

INDEX_SUFFIX = "_index"  #: of the dimensions of an xarray with the coordinates of a curved grid
TIME_NAMES = ("t", "time")
#: units of latitudes
NORTH = ("degrees_north", "degree_north", "degree_N", "degrees_N", "degreeN", "degreesN")


def is_xarray(data: object) -> bool:
    return type(data).__module__.split(".")[0] == "xarray" and hasattr(data, "dims")


def curved_names(data) -> dict[int, object]:
    """The names of an xarray's coordinates of a curved grid, by axis: "lon" of the dimension "lon_index", as tegl.read makes
    it, or else longitude and latitude."""
    found: dict[int, object] = {}
    for axis, dim in enumerate(data.dims):
        name = str(dim).removesuffix(INDEX_SUFFIX)
        if name != str(dim) and name in data.coords and dim in data.coords[name].dims:
            found[axis] = name
    return found or _longitude_and_latitude(data)


def _longitude_and_latitude(data) -> dict[int, object]:
    """Longitude and latitude, by their units, along the same two or more dimensions (CF conventions, section 5.2): for the
    last two of these that have no coordinates of their own, the longitude for the last one."""

    def of_unit(is_unit) -> list:
        return [name for name, one in data.coords.items() if one.ndim >= 2 and is_unit(str(one.attrs.get("units", "")))]

    for lon in of_unit(_tegl.is_longitude_unit):
        for lat in of_unit(NORTH.__contains__):
            dims = data.coords[lon].dims
            free = [axis for axis, dim in enumerate(data.dims)
                    if dim in dims and dim not in data.coords and str(dim).lower() not in TIME_NAMES]
            if set(dims) == set(data.coords[lat].dims) and len(free) >= 2:
                return {free[-2]: lat, free[-1]: lon}
    return {}


def without_longitude_and_latitude(data):
    """An xarray without a longitude and a latitude in two or more dimensions."""
    return data.drop_vars(list(_longitude_and_latitude(data).values())) if is_xarray(data) else data


def without_replaced(data, coords: list):
    """An xarray without its coordinates of a curved grid, if `coords` has others for both of their axes."""
    curved = _longitude_and_latitude(data) if is_xarray(data) and len(coords) == data.ndim else {}
    given = [axis for axis in curved if coords[axis] is not None]
    if 0 < len(given) < len(curved):
        others = [axis for axis in curved if axis not in given]
        raise ValueError(f"coords[{given[0]}], but not coords[{others[0]}], of an xarray with the coordinates "
                         f"{' and '.join(map(repr, curved.values()))} of a curved grid along both axes; expected both, in "
                         "place of these, or None for both")
    return without_longitude_and_latitude(data) if given else data


def own_curved(data) -> dict[int, np.ndarray]:
    """The coordinates of a curved grid, by axis, of an image of tegl.read or an xarray."""
    if not is_xarray(data):
        return data.curved if hasattr(data, "__tegl_image__") else {}
    found: dict[int, np.ndarray] = {}
    for axis, name in curved_names(data).items():
        coordinate = data.coords[name].transpose(*(one for one in data.dims if one in data.coords[name].dims))
        found[axis] = coordinate.values.reshape([data.sizes[one] if one in coordinate.dims else 1 for one in data.dims])
    return found


def in_order(mask, data):
    """An xarray's mask with its dimensions and coordinates in the order of those of `data`."""
    if set(mask.dims) != set(data.dims):
        raise ValueError(f"mask has the dimensions {', '.join(map(str, mask.dims))}; expected those of the array, "
                         f"{', '.join(map(str, data.dims))}")
    for dim in data.dims:
        if dim not in mask.coords or dim not in data.coords or mask.sizes[dim] != data.sizes[dim]:
            continue
        own, expected = mask.coords[dim].values, data.coords[dim].values
        if np.array_equal(own, expected):
            continue
        if len(np.unique(own)) < len(own) or not np.array_equal(np.sort(own), np.sort(expected)):
            raise ValueError(f"mask has other coordinates along '{dim}' than the array, {own[0]} to {own[-1]}; expected "
                             f"those of the array, {expected[0]} to {expected[-1]}, in any order")
        mask = mask.sel({dim: expected})
    return mask.transpose(*data.dims)
