# SPDX-License-Identifier: BSD-3-Clause
"""What is read of xarrays without the rest of the arguments."""

from __future__ import annotations

import numpy as np

INDEX_SUFFIX = "_index"  #: of the dimensions of an xarray with the coordinates of a curved grid


def is_xarray(data: object) -> bool:
    return type(data).__module__.split(".")[0] == "xarray" and hasattr(data, "dims")


def own_curved(data) -> dict[int, np.ndarray]:
    """The coordinates of a curved grid, by axis, of an image of tegl.read or an xarray made of it: those of the dimension
    "lon_index" are the coordinate "lon"."""
    if not is_xarray(data):
        return data.curved if hasattr(data, "__tegl_image__") else {}
    found: dict[int, np.ndarray] = {}
    for axis, dim in enumerate(data.dims):
        name = str(dim).removesuffix(INDEX_SUFFIX)
        if name == str(dim) or name not in data.coords or dim not in data.coords[name].dims:
            continue
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
