# SPDX-License-Identifier: BSD-3-Clause
"""Contours of meshes."""

from __future__ import annotations

import dataclasses
import os
import typing
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from . import _arguments, _facets, _kinds, _outside, _tegl
from ._arguments import Progress
from ._contour import Contour
from ._facets import Facets
from ._image import ContourSize

#: name -> (VTK's number, corners): names of meshio and names of VTK. The order of corners is VTK's.
_TYPES = {
    "triangle": (5, 3), "pixel": (8, 4), "quad": (9, 4), "quadrilateral": (9, 4), "tetra": (10, 4),
    "tetrahedron": (10, 4), "voxel": (11, 8), "hexahedron": (12, 8), "wedge": (13, 6), "pyramid": (14, 5),
    "simplex4": (100, 5), "octahedron": (101, 6), "cell16": (102, 8),
}
#: types without a fixed number of corners; in meshio's names a number of corners may follow
_POLYTOPES = {"polygon": 7, "polyhedron": 42, "polytope": 103}
#: (dimension, corners) -> the type of cells that are given without one
_BY_CORNERS = {(2, 3): "triangle", (2, 4): "quad", (3, 4): "tetra", (3, 8): "hexahedron", (3, 6): "wedge",
               (3, 5): "pyramid", (4, 5): "simplex4"}


#: types, corners, and the other lists of the library's CellLists, which are empty without polygons, polyhedra and
#: polytopes
_CellArrays = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def contour_mesh(points, cells=None, values=None, level: float | None = None, *, times=None,
                 triangulation: _kinds.Triangulation = "compact", ambiguity: _kinds.Ambiguity = "low",
                 direction: _kinds.Direction = "descent", close: bool = False, epsilon: float = 0.0,
                 normals: bool | typing.Literal["gradient", "geometric", "flat"] = False, dtype=np.float32,
                 allow_empty: bool = False, attributes=None, threads: int = 0,
                 progress: Progress | None = None) -> Contour:
    """The contour {value = level} of a mesh with a value at each point. It separates values >= level from the others.

    ::

        tegl.contour_mesh(points, {"tetra": tetrahedra}, values, 0.5)
        tegl.contour_mesh(meshio.read("part.vtu"), values="temperature", level=300.0, attributes=["pressure"])

    points
        #P x N coordinates, N = 2, 3 or 4; with `times`, points that move: #T x #P x N. Or a mesh: an object with `points`,
        `cells` and `point_data`, as from meshio and `tegl.read_mesh`. Its points may have a third coordinate that a 2D
        mesh does not need; cells of fewer dimensions than others are left out.
    cells
        An array #C x k of numbers of points: triangles or quadrilaterals (N = 2); tetrahedra, pyramids, wedges or
        hexahedra (N = 3; k = 4, 5, 6, 8); 4-simplices. Or several types, in the form of meshio: a mapping or a list of
        pairs of a name and such an array, with the names "triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron",
        "pixel" and "voxel". The order of corners is VTK's. Cells must meet in whole faces. Cells of type "polygon" are
        arrays or lists of numbers of points around them; cells of type "polyhedron" are lists of faces, and a face is a
        list of numbers of points around it. Cells of type "polytope" (N = 4) are lists of facets, and a facet is a list of
        faces as a polyhedron is; each face is in two facets. All have up to 64 corners.
    values
        #P values; with `times` #T x #P. NaN and masked values are missing: cells there have no contour. For a mesh also
        the name of an array in its `point_data`; none for the only one.
    times
        Ascending times of the rows of `values`, for N = 2 and 3: the result is the contour in space and time, with the time
        as the last coordinate; `slice`, `track` and `measure` slice it at any time.
    attributes
        Other arrays at the points, which are interpolated to the vertices as the coordinates are: a dict of names and
        arrays #P or #P x k (with `times` #T x #P or #T x #P x k); for a mesh also names in its `point_data`.
    triangulation, ambiguity, direction, close, epsilon, normals, dtype, allow_empty, threads, progress
        As for `tegl.contour`. `close` makes caps at the border of the mesh. Normals: True or "gradient", "geometric" or
        "flat".

    The columns of the vertices are the columns of `points`, then the time. Errors: ValueError, with the library's message;
    TypeError for an argument of a wrong type; Cancelled if `progress` returns False.
    """
    options = _options_of(triangulation=triangulation, ambiguity=ambiguity, direction=direction, close=close,
                          epsilon=epsilon, normals=normals, threads=threads)
    arguments = _arguments_of(points, cells, values, times)
    others = _attributes_of(attributes, points, arguments[2].shape)
    level, allow_empty = _level_of(level), _arguments.as_bool("allow_empty", allow_empty)
    core = _tegl.extract_mesh(*arguments, level, _is_double(dtype), options, others, progress)
    if not allow_empty and not len(core.simplices):
        _require_level(_values_of_cells(arguments[1], arguments[2]), level, arguments[2].size > 0)
    return Contour._of(core, False)


@_arguments.documents("extract_facets_2", "FacetHierarchy")
def contour_mesh_facets(points, cells=None, values=None, level: float | None = None, *, times=None,
                        ambiguity: _kinds.Ambiguity = "low", direction: _kinds.Direction = "descent", close: bool = False,
                        epsilon: float = 0.0, normals: bool | typing.Literal["gradient"] = False, dtype=np.float32,
                        allow_empty: bool = False, threads: int = 0, progress: Progress | None = None) -> Facets:
    """The contour {value = level} of a mesh as facets: segments in cells of two dimensions, polygons in cells of three,
    polyhedra in cells of four, among them the prisms over the cells of a mesh over time.

    Arguments as for `tegl.contour_mesh`. `facets[k].cells` has the cell of each facet. Cells are numbered by type, in
    the order of the library's reference below, and within a type in the order of the input.
    """
    _facets.gradient_only(normals)
    options = _options_of(triangulation="compact", ambiguity=ambiguity, direction=direction, close=close, epsilon=epsilon,
                          normals=normals, threads=threads)
    arguments = _arguments_of(points, cells, values, times)
    level, allow_empty = _level_of(level), _arguments.as_bool("allow_empty", allow_empty)
    core = _tegl.extract_mesh_facets(*arguments, level, _is_double(dtype), options, progress)
    if not allow_empty and not len(core.vertices):
        _require_level(_values_of_cells(arguments[1], arguments[2]), level, arguments[2].size > 0)
    return Facets(core, False)


def count_mesh(points, cells=None, values=None, level: float | None = None, *, times=None,
               triangulation: _kinds.Triangulation = "compact", ambiguity: _kinds.Ambiguity = "low", close: bool = False,
               threads: int = 0, progress: Progress | None = None) -> ContourSize:
    """The size of the contour that `contour_mesh` makes with the same arguments, without making it: (vertices, simplices).

    A level outside of the values gives (0, 0).
    """
    options = _options_of(triangulation=triangulation, ambiguity=ambiguity, direction="descent", close=close, epsilon=0.0,
                          threads=threads)
    arguments = _arguments_of(points, cells, values, times)[:-1]
    return ContourSize(*_tegl.count_mesh(*arguments, _level_of(level), options, progress))


class MeshIndex:
    """A mesh for contours at many levels: its edges and an interval tree of its cells, found once.

    ::

        index = tegl.MeshIndex(points, {"tetra": tetrahedra}, values)
        surfaces = [index.contour(level) for level in (0.25, 0.5, 0.75)]

    The mesh is copied. Meshes with missing values are searched cell by cell.
    """

    def __init__(self, points, cells=None, values=None, *, times=None, threads: int = 0,
                 progress: Progress | None = None) -> None:
        """Arguments as in `tegl.contour_mesh`."""
        arguments = _arguments_of(points, cells, values, times)
        self._shape = arguments[2].shape
        self._core = _tegl.MeshIndex(*arguments, _arguments.threads_of(threads), progress)  # checks the cells
        of_cells = _values_of_cells(arguments[1], arguments[2]).ravel()
        self._range = np.array([end(of_cells) for end in (np.fmin.reduce, np.fmax.reduce)] if of_cells.size else [])

    @property
    def memory(self) -> int:
        """Bytes of the interval tree."""
        return self._core.memory

    def __repr__(self) -> str:
        return f"<tegl.MeshIndex of {self._core.cells} cells: {self.memory} bytes>"

    def contour(self, level: float, *, dtype=np.float32, allow_empty: bool = False, attributes=None,
                progress: Progress | None = None, **options: typing.Any) -> Contour:
        """What `tegl.contour_mesh` of the mesh gives, byte by byte. Options as there: triangulation, normals, ...

        `attributes` is a dict of names and arrays.
        """
        chosen = _options_of(**options)
        level, allow_empty = _arguments.as_level(level), _arguments.as_bool("allow_empty", allow_empty)
        others = _attributes_of(attributes, None, self._shape)
        core = self._core.contour(level, _is_double(dtype), chosen, others, progress)
        if not allow_empty and not len(core.simplices):
            _require_level(self._range, level, self._shape[-1] > 0)
        return Contour._of(core, False)


def _level_of(level: float | None) -> float:
    if level is None:
        raise TypeError("level is missing; expected points, cells, values and level, or a mesh and level")
    return _arguments.as_level(level)


def _attributes_of(attributes, mesh, shape: tuple[int, ...]) -> list[tuple[str, np.ndarray]]:
    """Names and arrays at the points, whose values have this shape; `mesh` may have arrays by name."""
    if attributes is None:
        return []
    if not isinstance(attributes, Mapping):
        data = getattr(mesh, "point_data", None)
        if isinstance(attributes, str) or data is None or not isinstance(attributes, Iterable):
            raise TypeError(f"attributes are {attributes!r}; expected a dict of names and arrays, or a list of names in the "
                            "point_data of a mesh")
        for name in attributes:
            if name not in data:
                raise ValueError(f"attributes has {name!r}; expected names among {', '.join(map(repr, data)) or 'none'}")
        attributes = {name: data[name] for name in attributes}
    result = []
    for name, given in attributes.items():
        array = _with_missing(given)
        if array.shape[:len(shape)] != shape or array.ndim > len(shape) + 1 or not array.size:
            raise ValueError(f"attributes[{name!r}] has the shape {array.shape}; expected {shape}, or with a last axis of "
                             "several numbers for each point")
        result.append((_arguments.as_text("name of an attribute", name), array))
    return result


def _options_of(normals=False, **options) -> dict:
    """The options of `_tegl.extract_mesh`."""
    chosen = _arguments.extract_options(normals=normals, **options)
    if chosen["normals"] not in ("", "gradient", "geometric", "flat"):
        raise ValueError(f"normals of a mesh are {normals!r}; expected True, False, 'gradient', 'geometric' or 'flat'")
    chosen["kernel"] = []
    return chosen


def _arguments_of(points, cells, values, times) -> tuple[np.ndarray, _CellArrays, np.ndarray, np.ndarray, list[str]]:
    """The arguments of `_tegl.extract_mesh` and `_tegl.MeshIndex` up to the names of the axes."""
    axis_names: list[str] = []
    if hasattr(points, "points") and hasattr(points, "cells"):
        if cells is not None:
            raise TypeError("cells are given twice, by a mesh and alone; expected one of the two")
        if isinstance(points, Mesh) and times is None and len(points.times):
            times = points.times
        axis_names = list(points.axis_names) if isinstance(points, Mesh) else []
        if isinstance(points, Mesh) and values is None:
            values = points.variable
        points, cells, values = _parts_of(points, values)
    for name, given in (("cells", cells), ("values", values)):
        if given is None:
            raise TypeError(f"{name} are missing; expected points, cells, values and level, or a mesh and level")
    _require_unmasked("points", points)
    _require_unmasked("times", times)
    numbers = np.atleast_1d(_arguments.real("times", [] if times is None else times)).astype(np.float64)
    if times is not None and (numbers.ndim != 1 or not numbers.size):
        raise ValueError(f"times have the shape {numbers.shape}; expected one number or more")
    points = _arguments.real("points", points).astype(np.float64, order="C", copy=False)
    values = _with_missing(values)
    _check_shapes(points, values, len(numbers))
    arrays = _cells_of(cells, points.shape[-1])
    if axis_names and len(numbers):
        axis_names.append("t")
    return points, arrays, values, numbers, axis_names


@dataclasses.dataclass(frozen=True)
class Mesh:
    """A mesh with values at its points, the result of `tegl.read_mesh`."""

    points: np.ndarray  #: #P x N coordinates; #T x #P x N if the points move
    #: names of types, as in meshio, and #C x k numbers of points; of polygons and polyhedra lists as in `contour_mesh`
    cells: list[tuple[str, typing.Any]]
    values: np.ndarray  #: #P values; over time #T x #P
    times: np.ndarray  #: #T times; empty for a mesh at one time
    variable: str  #: the name of the values
    axis_names: tuple[str, ...]  #: of the coordinates
    #: other arrays by name, with the shape of `values`
    others: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)

    def __repr__(self) -> str:
        """One line: sizes, times, values."""
        counts: dict[str, int] = {}
        for name, array in self.cells:  # one entry for each run of cells of one type
            counts[name] = counts.get(name, 0) + len(array)
        cells = ", ".join(f"{count} {name}" for name, count in counts.items()) or "no cells"
        times = f", {len(self.times)} times from {self.times[0]:g} to {self.times[-1]:g}" if len(self.times) else ""
        return f"<tegl.Mesh {self.variable!r}: {self.points.shape[-2]} points, {cells}{times}>"

    @property
    def point_data(self) -> dict[str, np.ndarray]:
        """The values and the other arrays by their names."""
        return {self.variable: self.values, **self.others}

    def contour(self, level: float, **options: typing.Any) -> Contour:
        """The contour of this mesh: see `tegl.contour_mesh`."""
        return contour_mesh(self, level=level, **options)

    def contour_facets(self, level: float, **options: typing.Any) -> Facets:
        """The contour of this mesh as facets: see `tegl.contour_mesh_facets`."""
        return contour_mesh_facets(self, level=level, **options)

    def count(self, level: float, **options: typing.Any) -> ContourSize:
        """The size of the contour, without making it: see `tegl.count_mesh`."""
        return count_mesh(self, level=level, **options)


@_arguments.documents("read_cell_mesh")
def read_mesh(path: str | os.PathLike | Sequence[str | os.PathLike], variable: str = "", *, others: Sequence[str] = (),
              times=None, cells_to_points: bool = False, allow_outside_paths: bool = False,
              progress: Progress | None = None) -> Mesh:
    """Reads a mesh with values at its points: VTK's XML files (.vtu, .vts, .pvd), or a table of scattered points (.csv).

    ::

        tegl.read_mesh("cavity.pvd", "p").contour(0.0)            # a mesh over time: tetrahedra in space and time
        tegl.read_mesh(["step0.vtu", "step1.vtu"], times=[0, 0.5])
        tegl.read_mesh("stations.csv", "temperature").contour(20.0)

    path
        A file; or a list of files with the same cells, one for each time.
    variable
        The array of values, or the column; "NAME:0" is a component of vectors, "NAME:magnitude" their length. Needed if
        there are several.
    others
        More arrays or columns, read into `Mesh.others`: `mesh.contour(20.0, attributes=["pressure"])`.
    times
        For a list: the time of each file. Default: the times in the files, else 0, 1, 2 ...
    cells_to_points
        Makes point values of values of cells, by the mean of the cells at a point. Without it they are an error.
    allow_outside_paths
        Whether a .pvd file may name files outside of its folder.
    """
    several = isinstance(path, (list, tuple))
    paths = [os.fspath(one) for one in (path if isinstance(path, (list, tuple)) else [path])]
    if times is not None and not several:
        raise ValueError("times with one file; expected a list of files")
    if isinstance(others, str):
        raise TypeError(f"others is {others!r}; expected a list of names")
    cells_to_points = _arguments.as_bool("cells_to_points", cells_to_points)
    numbers = [] if times is None else _arguments.as_numbers("times", times)
    allow_outside_paths = _arguments.as_bool("allow_outside_paths", allow_outside_paths)
    found, *more = [_tegl.read_cell_mesh(paths, _arguments.as_text("variable", name), cells_to_points, numbers,
                                         allow_outside_paths, progress) for name in (variable, *others)]
    return Mesh(points=found["points"], cells=_blocks_of(found), values=found["values"],
                times=found["times"] if len(found["times"]) > 1 else found["times"][:0], variable=found["variable"],
                axis_names=tuple(found["axis_names"]), others={one["variable"]: one["values"] for one in more})


def _blocks_of(found: dict[str, typing.Any]) -> list[tuple[str, typing.Any]]:
    """Runs of cells of one type."""
    types, corners = found["types"], found["corners"]
    names = {number: (name, count) for name, (number, count) in reversed(_TYPES.items())}
    if len(found["ends"]):
        names.update({number: (name, 0) for name, number in _POLYTOPES.items()})
    starts = np.flatnonzero(np.diff(types.astype(np.int16), prepend=-1))
    blocks, at = [], 0
    for first, end in zip(starts, [*starts[1:], len(types)]):
        name, count = names[int(types[first])]
        if not count:
            blocks.append((name, _polytopes_of(found, name, int(first), int(end))))
            at = int(found["ends"][end - 1])
            continue
        size = int(end - first) * count
        blocks.append((name, corners[at:at + size].reshape(-1, count)))
        at += size
    return blocks


def _polytopes_of(found: dict[str, typing.Any], name: str, first: int, end: int) -> list:
    """Polygons as arrays of points, polyhedra as lists of faces."""
    def parts(ends, begin: int, last: int, whole) -> list:
        starts = [int(ends[begin - 1]) if begin else 0, *(int(at) for at in ends[begin:last])]
        return [whole(i, j) for i, j in zip(starts, starts[1:])]

    if name == "polygon":
        return parts(found["ends"], first, end, lambda i, j: found["corners"][i:j])
    return parts(found["face_lists_ends"], first, end, lambda f, g: parts(
        found["face_ends"], f, g, lambda i, j: found["face_corners"][i:j]))


def _parts_of(mesh, values) -> tuple[typing.Any, list, typing.Any]:
    """Points, cells and values of a mesh like those of meshio. A 2D mesh loses a constant coordinate."""
    pairs = _pairs_of(mesh.cells) or []
    known = [(name, block) for name, block in pairs if _number_of(name)]
    flat = [pair for pair in known if _number_of(pair[0]) in (5, 7, 8, 9)]
    others = [name for name, _ in pairs if not _number_of(name) and not name.startswith(("vertex", "line"))]
    if others:
        raise ValueError(f"cells are of type {others[0]!r}; expected one of {_known_types()}")
    is_flat = bool(flat) and len(flat) == len(known)
    cells = flat if is_flat else [pair for pair in known if _number_of(pair[0]) not in (5, 7, 8, 9)]
    points = _arguments.real("points", mesh.points)
    if is_flat and points.ndim and points.shape[-1] == 3:
        constant = [a for a in (2, 1, 0) if points.size and np.ptp(points[..., a]) == 0]
        if not constant:
            raise ValueError("a mesh of 2D cells on a surface in space; expected it in a plane where a coordinate is constant")
        points = np.delete(points, constant[0], axis=-1)
    if values is None or isinstance(values, str):
        data = mesh.point_data
        if values is None and len(data) != 1:
            listed = f"the arrays {', '.join(map(repr, data))}" if data else "no arrays"
            raise ValueError(f"the mesh has {listed}; expected the name of one as values")
        if values is not None and values not in data:
            raise ValueError(f"values are {values!r}; expected one of {', '.join(map(repr, data))}" if data else
                             f"values are {values!r}, and the mesh has no arrays; expected the name of one")
        values = data[next(iter(data)) if values is None else values]
    return points, cells, values


@_arguments.documents("delaunay")
def contour_points(points, values, level: float, *, triangulation: _kinds.Triangulation = "compact",
                   direction: _kinds.Direction = "descent", close: bool = False, epsilon: float = 0.0,
                   normals: bool | typing.Literal["gradient", "geometric", "flat"] = False, dtype=np.float32,
                   allow_empty: bool = False, attributes=None, threads: int = 0,
                   progress: Progress | None = None) -> Contour:
    """The contour {value = level} of scattered points in 2D to 4D, with linear interpolation in their Delaunay cells.

    points
        #P x N coordinates; different points, not all in a line, plane or hyperplane.
    values
        A number for each point. NaN is a missing value.

    The other arguments are those of `tegl.contour_mesh`.
    """
    _require_unmasked("points", points)
    places = _arguments.real("points", points).astype(np.float64)
    if places.ndim != 2 or not 2 <= places.shape[1] <= 4:
        raise ValueError(f"points have the shape {places.shape}; expected (#P, N) with N = 2 to 4")
    name = {2: "triangle", 3: "tetra", 4: "simplex4"}[places.shape[1]]
    return contour_mesh(places, {name: _tegl.delaunay(places)}, values, level, triangulation=triangulation,
                        direction=direction, close=close, epsilon=epsilon, normals=normals, dtype=dtype,
                        allow_empty=allow_empty, attributes=attributes, threads=threads, progress=progress)


def _with_missing(values) -> np.ndarray:
    """Values with NaN for the masked ones."""
    array = _arguments.real("values", values).astype(np.float64, order="C", copy=False)
    mask = _arguments.mask_of(values)
    if mask is None:
        return array
    array = array.copy(order="C")
    array[mask] = np.nan
    return array


def _require_unmasked(name: str, array) -> None:
    mask = _arguments.mask_of(array)
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


def _number_of(name: str) -> int:
    """VTK's number of a type; 0 for an unknown one."""
    if name in _TYPES:
        return _TYPES[name][0]
    return _POLYTOPES.get(name.rstrip("0123456789"), 0)


def _known_types() -> str:
    return ", ".join(map(repr, [*_TYPES, *_POLYTOPES]))


def _is_list(value) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def _ring_of(name: str, ring) -> np.ndarray:
    """A polygon or face as an array of numbers of points."""
    if not _is_list(ring):
        raise TypeError(f"{name} have {ring!r} in the place of a list; expected lists of numbers of points")
    try:
        array = np.asarray(ring)
    except ValueError:  # lists of different lengths
        array = np.empty((0, 0))
    if array.ndim != 1:
        raise TypeError(f"{name} have a list of lists, {ring!r}; expected lists of numbers of points")
    return _numbers_of(name, array[np.newaxis])[0]


def _rings_of(name: str, rings) -> list[np.ndarray]:
    """Polygons or faces as arrays of numbers of points."""
    if not _is_list(rings):
        raise TypeError(f"{name} are {type(rings).__name__}; expected lists of numbers of points")
    return [_ring_of(name, ring) for ring in rings]


def _ends_of(rings: Iterable) -> np.ndarray:
    return np.cumsum([len(ring) for ring in rings], dtype=np.uint64)


def _polytope_arrays(name: str, block) -> _CellArrays:
    """The cells of a block of polygons, polyhedra or polytopes."""
    number, what = _number_of(name), f"cells of type {name!r}"
    if not _is_list(block):
        expected = {7: "lists of numbers of points", 42: "lists of faces", 103: "lists of facets"}[number]
        raise TypeError(f"{what} are {type(block).__name__}; expected a list of cells: {expected}")
    counts = facet_counts = np.zeros(len(block), dtype=np.uint64)
    faces, facets, cells = [], [], [np.empty(0, np.uint32)] * len(block)
    if number == 7:
        cells = _rings_of(what, block)
    elif number == 42:
        lists = [_rings_of(f"faces of {what}", cell) for cell in block]
        faces, counts = [ring for cell in lists for ring in cell], _ends_of(lists)
    else:
        for cell in block:
            if not _is_list(cell):
                raise TypeError(f"{what} have {cell!r} in the place of a cell; expected a list of facets")
        facets = [_rings_of(f"facets of {what}", facet) for cell in block for facet in cell]
        faces, facet_counts = [ring for facet in facets for ring in facet], _ends_of(block)
    none = np.empty(0, np.uint32)
    return (np.full(len(cells), number, dtype=np.uint8), np.concatenate([none, *cells]), _ends_of(cells),
            np.concatenate([none, *faces]), _ends_of(faces), counts, _ends_of(facets), facet_counts)


def _joined(blocks: list[_CellArrays]) -> _CellArrays:
    """One after the other; ends go on from block to block."""
    def ends(which: int, of: int) -> np.ndarray:
        first = np.cumsum([0, *(len(block[of]) for block in blocks)])
        return np.concatenate([block[which].astype(np.uint64) + np.uint64(at) for block, at in zip(blocks, first)])

    types, corners, face_corners = (np.concatenate([block[i] for block in blocks]) for i in (0, 1, 3))
    facet_ends = ends(6, 4)
    face_lists = ends(5, 4) if not len(facet_ends) else np.empty(0, np.uint64)
    return types, corners, ends(2, 1), face_corners, ends(4, 3), face_lists, facet_ends, ends(7, 6)


def _cells_of(cells, ndim: int) -> _CellArrays:
    """The lists of all cells."""
    pairs = _pairs_of(cells)
    if pairs is None:
        array = _numbers_of("cells", cells)
        name = _BY_CORNERS.get((ndim, array.shape[1]))
        if name is None:
            known = ", ".join(f"{k} ({name})" for (n, k), name in _BY_CORNERS.items() if n == ndim)
            raise ValueError(f"cells have {array.shape[1]} corners; expected in {ndim} dimensions: {known}")
        pairs = [(name, array)]
    blocks: list[_CellArrays] = []
    none = np.empty(0, np.uint64)
    for name, block in pairs:
        if not _number_of(name):
            raise ValueError(f"cells are of type {name!r}; expected one of {_known_types()}")
        if name not in _TYPES:
            dimension = {7: 2, 42: 3, 103: 4}[_number_of(name)]
            blocks.append(_polytope_arrays(name, block))
            if ndim != dimension and len(block) > 0:
                raise ValueError(f"cells of type {name!r} with points in {ndim} dimensions; expected {dimension}")
            continue
        number, count = _TYPES[name]
        array = _numbers_of(f"cells of type {name!r}", block if np.size(block) else np.empty((0, count), np.uint32))
        if array.shape[1] != count:
            raise ValueError(f"cells of type {name!r} have {array.shape[1]} corners; expected {count}")
        blocks.append((np.full(len(array), number, dtype=np.uint8), array.ravel(),
                       np.arange(count, count * (len(array) + 1), count, dtype=np.uint64), none.astype(np.uint32), none,
                       np.zeros(len(array), dtype=np.uint64), none, np.zeros(len(array), dtype=np.uint64)))
    if not any(_number_of(name) in _POLYTOPES.values() for name, _ in pairs):
        types, corners = (np.concatenate([np.empty(0, kind), *(block[i] for block in blocks)])
                          for i, kind in ((0, np.uint8), (1, np.uint32)))
        return types, corners, none, none.astype(np.uint32), none, none, none, none
    return _joined(blocks)


def _pairs_of(cells) -> list[tuple[str, typing.Any]] | None:
    """Pairs of a name and an array; None for other forms."""
    if isinstance(cells, Mapping):
        return list(cells.items())
    if isinstance(cells, (list, tuple)) and cells and all(_is_pair(block) for block in cells):
        return [(block[0], block[1]) if isinstance(block, tuple) else (block.type, block.data) for block in cells]
    return None


def _is_pair(block) -> bool:
    """A pair of a name and an array, or a CellBlock of meshio."""
    if isinstance(block, tuple):
        return len(block) == 2 and isinstance(block[0], str)
    return hasattr(block, "type") and hasattr(block, "data")


def _numbers_of(name: str, block) -> np.ndarray:
    _require_unmasked(name, block)
    array = np.asarray(block)
    if array.size and array.dtype.kind not in "iu":  # an empty list has the type float64
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


def _values_of_cells(cells: _CellArrays, values: np.ndarray) -> np.ndarray:
    """The values at the points of cells: others have no contour. The cells are checked."""
    is_used = np.zeros(values.shape[-1], dtype=bool)
    is_used[cells[1]] = True
    is_used[cells[3]] = True
    return values[..., is_used]


def _require_level(values: np.ndarray, level: float, has_points: bool) -> None:
    """Raises a ValueError if an empty contour is due to the level, or to a mesh without cells. `values`: of the cells."""
    present = values[~np.isnan(values)]
    if not present.size:
        part = "cells" if has_points else "points"
        raise ValueError("all values are missing (NaN); expected values, or allow_empty=True for an empty contour"
                         if values.size else f"the mesh has no {part}; expected some, or allow_empty=True for an empty contour")
    least, most = str(present.min()), str(present.max())
    if not present.min() < level <= present.max():
        raise _outside.level_error(level, least, most, "values")
