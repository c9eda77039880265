# SPDX-License-Identifier: BSD-3-Clause
"""Contours of meshes."""

from __future__ import annotations

import typing
from collections.abc import Mapping

import numpy as np

from . import _arguments, _kinds, _tegl
from ._arguments import Progress
from ._contour import Contour

#: name -> (VTK's number, corners): names of meshio and names of VTK. The order of corners is VTK's.
_TYPES = {
    "triangle": (5, 3), "pixel": (8, 4), "quad": (9, 4), "quadrilateral": (9, 4), "tetra": (10, 4),
    "tetrahedron": (10, 4), "voxel": (11, 8), "hexahedron": (12, 8), "wedge": (13, 6), "pyramid": (14, 5),
    "simplex4": (100, 5), "octahedron": (101, 6), "cell16": (102, 8),
}
#: (dimension, corners) -> the type of cells that are given without one
_BY_CORNERS = {(2, 3): "triangle", (2, 4): "quad", (3, 4): "tetra", (3, 8): "hexahedron", (3, 6): "wedge",
               (3, 5): "pyramid", (4, 5): "simplex4"}


def contour_mesh(points, cells, values, level: float, *, times=None, triangulation: _kinds.Triangulation = "compact",
                 ambiguity: typing.Literal["low", "high"] = "low", direction: _kinds.Direction = "descent",
                 epsilon: float = 0.0, dtype=np.float32, allow_empty: bool = False, threads: int = 0,
                 progress: Progress | None = None) -> Contour:
    """The contour {value = level} of a mesh with a value at each point. It separates values >= level from the others.

    points
        #P x N coordinates, N = 2, 3 or 4; with `times`, points that move: #T x #P x N.
    cells
        An array #C x k of numbers of points: triangles or quadrilaterals (N = 2); tetrahedra, pyramids, wedges or
        hexahedra (N = 3; k = 4, 5, 6, 8); 4-simplices. Or several types, in the form of meshio: a mapping or a list of
        pairs of a name and such an array, with the names "triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron",
        "pixel" and "voxel". The order of corners is VTK's. Cells must meet in whole faces.
    values
        #P values; with `times` #T x #P. NaN and masked values are missing: cells there have no contour.
    times
        Ascending times of the rows of `values`, for N = 2 and 3: the result is the contour in space and time, with the time
        as the last coordinate; `slice`, `track` and `measure` cut it at any time.
    triangulation, ambiguity, direction, epsilon, dtype, allow_empty, threads, progress
        As for `tegl.contour`. Ambiguity: "low" or "high". 4D contours are barycentric.

    The columns of the vertices are the columns of `points`, then the time. Errors: ValueError, with the library's message;
    TypeError for an argument of a wrong type; Cancelled if `progress` returns False.
    """
    options = _arguments.extract_options(triangulation=triangulation, ambiguity=ambiguity, direction=direction,
                                         epsilon=epsilon, threads=threads)
    options["kernel"] = []
    level, allow_empty = _arguments.as_number("level", level), _arguments.as_bool("allow_empty", allow_empty)
    _require_unmasked("points", points)
    _require_unmasked("times", times)
    numbers = np.atleast_1d(_arguments.real("times", [] if times is None else times)).astype(np.float64)
    if times is not None and (numbers.ndim != 1 or not numbers.size):
        raise ValueError(f"times have the shape {numbers.shape}; expected one number or more")
    points = _arguments.real("points", points).astype(np.float64, order="C", copy=False)
    values = _with_missing(values)
    _check_shapes(points, values, len(numbers))
    types, corners = _cells_of(cells, points.shape[-1])
    core = _tegl.extract_mesh(points, types, corners, values, numbers, level, _is_double(dtype), options, progress)
    if not allow_empty and not len(core.simplices):
        _require_level(values, level)
    return Contour._of(core, False)


@_arguments.documents("delaunay")
def contour_points(points, values, level: float, *, triangulation: _kinds.Triangulation = "compact",
                   direction: _kinds.Direction = "descent", epsilon: float = 0.0, dtype=np.float32,
                   allow_empty: bool = False, threads: int = 0, progress: Progress | None = None) -> Contour:
    """The contour {value = level} of scattered points in 2D to 4D, with linear interpolation in their Delaunay cells.

    points
        #P x N coordinates; different points, not all in a line, plane or hyperplane.
    values
        A number for each point. NaN is a missing value.

    The other arguments are those of `tegl.contour_mesh`.
    """
    places = _arguments.real("points", points).astype(np.float64)
    if places.ndim != 2 or not 2 <= places.shape[1] <= 4:
        raise ValueError(f"points have the shape {places.shape}; expected (#P, N) with N = 2 to 4")
    name = {2: "triangle", 3: "tetra", 4: "simplex4"}[places.shape[1]]
    return contour_mesh(places, {name: _tegl.delaunay(places)}, values, level, triangulation=triangulation,
                        direction=direction, epsilon=epsilon, dtype=dtype, allow_empty=allow_empty, threads=threads,
                        progress=progress)


def _mask_of(array) -> np.ndarray | None:
    """Where a masked array, or a list of them, is masked; None if there is no mask."""
    if isinstance(array, (list, tuple)) and any(isinstance(part, np.ma.MaskedArray) for part in array):
        array = np.ma.array(array)
    return np.ma.getmaskarray(array) if np.ma.getmask(array) is not np.ma.nomask else None


def _with_missing(values) -> np.ndarray:
    """Values with NaN for the masked ones."""
    array = _arguments.real("values", values).astype(np.float64, order="C", copy=False)
    mask = _mask_of(values)
    if mask is None:
        return array
    array = array.copy(order="C")
    array[mask] = np.nan
    return array


def _require_unmasked(name: str, array) -> None:
    mask = _mask_of(array)
    if mask is not None and mask.any():
        raise ValueError(f"{name} have {np.count_nonzero(mask)} masked numbers; expected none: only values may be masked")


def _check_shapes(points: np.ndarray, values: np.ndarray, times: int) -> None:
    if points.ndim != 2 and not (points.ndim == 3 and times):
        raise ValueError(f"points have the shape {points.shape}; expected (#P, N)" + (", or (#T, #P, N)" if times else ""))
    if not 2 <= points.shape[-1] <= 4:
        raise ValueError(f"points have {points.shape[-1]} coordinates; expected 2 to 4")
    expected = (times, points.shape[-2]) if times else (points.shape[-2],)
    if values.shape != expected:
        raise ValueError(f"values have the shape {values.shape}; expected {expected}")
    if points.ndim == 3 and len(points) != times:
        raise ValueError(f"points have the shape {points.shape}; expected {(times, *points.shape[1:])}")


def _cells_of(cells, ndim: int) -> tuple[np.ndarray, np.ndarray]:
    """Types and corners of all cells."""
    if isinstance(cells, Mapping):
        pairs = list(cells.items())
    elif isinstance(cells, (list, tuple)) and cells and all(_is_pair(block) for block in cells):
        pairs = [(block[0], block[1]) if isinstance(block, tuple) else (block.type, block.data) for block in cells]
    else:
        array = _numbers_of("cells", cells)
        name = _BY_CORNERS.get((ndim, array.shape[1]))
        if name is None:
            known = ", ".join(f"{k} ({name})" for (n, k), name in _BY_CORNERS.items() if n == ndim)
            raise ValueError(f"cells have {array.shape[1]} corners; expected in {ndim} dimensions: {known}")
        pairs = [(name, array)]
    types, corners = [], []
    for name, block in pairs:
        if name not in _TYPES:
            raise ValueError(f"cells are of type {name!r}; expected one of {', '.join(map(repr, _TYPES))}")
        number, count = _TYPES[name]
        array = _numbers_of(f"cells of type {name!r}", block)
        if array.shape[1] != count:
            raise ValueError(f"cells of type {name!r} have {array.shape[1]} corners; expected {count}")
        types.append(np.full(len(array), number, dtype=np.uint8))
        corners.append(array.ravel())
    if not types:
        return np.empty(0, np.uint8), np.empty(0, np.uint32)
    return np.concatenate(types), np.concatenate(corners)


def _is_pair(block) -> bool:
    """A pair of a name and an array, or a CellBlock of meshio."""
    if isinstance(block, tuple):
        return len(block) == 2 and isinstance(block[0], str)
    return hasattr(block, "type") and hasattr(block, "data")


def _numbers_of(name: str, block) -> np.ndarray:
    _require_unmasked(name, block)
    array = np.asarray(block)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} are of type {array.dtype}; expected integers")
    if array.ndim != 2:
        raise ValueError(f"{name} have the shape {array.shape}; expected (#C, corners)")
    if array.size and (array.min() < 0 or array.max() >= 2**32):
        raise ValueError(f"{name} have numbers of points from {array.min()} to {array.max()}; expected 0 or more, below 2**32")
    return array.astype(np.uint32)


def _is_double(dtype) -> bool:
    kind = np.dtype(dtype) if dtype is not None else None
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype is {dtype!r}; expected float32 or float64")
    return kind == np.dtype(np.float64)


def _require_level(values: np.ndarray, level: float) -> None:
    """Raises a ValueError if an empty contour is due to the level."""
    present = values[~np.isnan(values)]
    if not present.size:
        raise ValueError("all values are missing (NaN); expected values, or allow_empty=True for an empty contour")
    if not present.min() < level <= present.max():
        raise ValueError(f"level is {level}; expected a level above {present.min()} and up to {present.max()}, the minimum and "
                         "maximum of the values, or allow_empty=True for an empty contour")
