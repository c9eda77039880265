# SPDX-License-Identifier: BSD-3-Clause
"""Contours as facets: points, segments, polygons and polyhedra with their incidences."""

from __future__ import annotations

import dataclasses
import functools
import os

import numpy as np

from . import _arguments, _kinds, _tegl
from ._arguments import Progress
from ._columns import ArrayOrdered
from ._contour import Contour

_NAMES = ("points", "segments", "polygons", "polyhedra")


@dataclasses.dataclass(frozen=True)
class FacetReport:
    """The counts and faults of `Facets.check`."""

    counts: tuple[int, ...]  #: facets by dimension
    components: int
    euler: int  #: sum over all facets of (-1)^k times their Euler characteristic
    tori: int  #: polyhedra of Euler characteristic 0, such as solid tori
    below_zero: int  #: polyhedra with several handles
    above_one: int  #: polyhedra with cavities
    border: int  #: facets of the second highest dimension in exactly one of the highest
    branching: int  #: fault: those in none or in more than two
    conflicts: int  #: fault: those in two with the same sign
    open_boundaries: int  #: fault: facets whose boundary has a boundary

    @property
    def is_manifold(self) -> bool:
        """Whether the facets are free of faults: oriented, with at most two facets around each of the dimension below."""
        return not (self.branching or self.conflicts or self.open_boundaries)

    @property
    def is_closed(self) -> bool:
        """Whether the contour has no border."""
        return self.border == 0


class FacetLevel:
    """The facets of one dimension k, row = facet.

    Lists are in the form of compressed sparse rows: the entries of facet f are those from `offsets[f]` up to
    `offsets[f + 1]`. So with SciPy, `csr_matrix((level.signs, level.boundary, level.offsets))` is the boundary matrix.
    The arrays are read-only; most are views of the library's memory.
    """

    def __init__(self, core: _tegl.Facets, dimension: int, is_reversed: bool) -> None:
        self._core, self._is_reversed = core, is_reversed
        #: k: 0 for points, 1 for segments, 2 for polygons, 3 for polyhedra
        self.dimension = dimension
        self._places = core.places(dimension)

    def __len__(self) -> int:
        return len(self._places["base"])

    def __repr__(self) -> str:
        return f"<tegl.FacetLevel: {len(self)} {_NAMES[self.dimension]}>"

    @property
    def _is_mirrored(self) -> bool:
        """Whether facets of the highest dimension change their direction: the library's axes are in reverse order, which
        in 2D and 3D mirrors space."""
        return self._is_reversed and self._core.ndim < 4 and self.dimension == self._core.ndim - 1

    @functools.cached_property
    def _down(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        first, facets, signs = self._core.down(self.dimension)
        if not len(first):  # of points
            first = _fixed(np.zeros(len(self) + 1, dtype=np.uint32))
        if not self._is_mirrored:
            return first, facets, signs
        back = _backwards(first)
        return first, _fixed(facets[back]), _fixed(-signs[back])

    @property
    def offsets(self) -> np.ndarray:
        """#F + 1: where the entries of each facet begin in `boundary` and `signs`."""
        return self._down[0]

    @property
    def boundary(self) -> np.ndarray:
        """Numbers of the facets of dimension k - 1 around each facet. Segment: its start and its end. Polygon: its segments
        in order, each starting at the end of the previous one. Polyhedron: its polygons. Points have none."""
        return self._down[1]

    @property
    def signs(self) -> np.ndarray:
        """Incidence numbers of `boundary`, 1 or -1 (int8): a segment with -1 is passed from its end to its start."""
        return self._down[2]

    @functools.cached_property
    def _up(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        first, facets, signs = self._core.up(self.dimension)
        if not len(first):  # of the highest dimension
            first = _fixed(np.zeros(len(self) + 1, dtype=np.uint32))
        above_is_mirrored = self._is_reversed and self._core.ndim < 4 and self.dimension == self._core.ndim - 2
        return first, facets, _fixed(-signs) if above_is_mirrored else signs

    @property
    def up_offsets(self) -> np.ndarray:
        """#F + 1: where the entries of each facet begin in `coboundary` and `up_signs`."""
        return self._up[0]

    @property
    def coboundary(self) -> np.ndarray:
        """Numbers of the facets of dimension k + 1 that each facet bounds, ascending; none for the highest dimension."""
        return self._up[1]

    @property
    def up_signs(self) -> np.ndarray:
        """Incidence numbers of each facet in the boundaries of `coboundary` (int8)."""
        return self._up[2]

    @functools.cached_property
    def _points(self) -> tuple[np.ndarray, np.ndarray]:
        first, points = self._core.points(self.dimension)
        if not self._is_mirrored:
            return _fixed(first), _fixed(points)
        # a segment from its end; a polygon from the start of its first side, as `boundary`
        return _fixed(first), _fixed(points[_backwards(first, keeps_first=self.dimension == 2)])

    @property
    def point_offsets(self) -> np.ndarray:
        """#F + 1: where the entries of each facet begin in `points`."""
        return self._points[0]

    @property
    def points(self) -> np.ndarray:
        """Numbers of the points of each facet, rows of `Facets.vertices`. Segment: start, end. Polygon: in order around it.
        Polyhedron: ascending, each once."""
        return self._points[1]

    @functools.cached_property
    def euler(self) -> np.ndarray:
        """#F Euler characteristics: 1; other numbers for polyhedra with handles (less) or cavities (more)."""
        return _fixed(self._core.euler(self.dimension))

    @property
    def cells(self) -> np.ndarray:
        """#F: the cell of the mesh or lattice that has the facet; of facets in several cells the first. For images the
        lowest sample of the facet's face of the grid, as the index of `array.ravel()` (with `time_axis=-1`, of
        `array.T.ravel()`)."""
        return self._places["base"]

    @functools.cached_property
    def samples(self) -> np.ndarray | None:
        """#F x N, of images: the index of the lowest sample of the facet's face of the grid, along each axis of the array.
        None for meshes and lattices."""
        sizes = self._core.sizes
        if not all(sizes):
            return None
        index = np.unravel_index(self.cells.astype(np.intp), tuple(sizes), order="F")
        return _fixed(np.stack(index[::-1] if self._is_reversed else index, axis=1))

    @functools.cached_property
    def axes(self) -> np.ndarray | None:
        """#F x N truth values, of images: the axes of the array along which the facet's face of the grid extends, by one
        step from its lowest sample. None for meshes and lattices."""
        if not all(self._core.sizes):
            return None
        axes = np.arange(self._core.ndim)
        found = (self._places["axes"][:, np.newaxis] >> (axes[::-1] if self._is_reversed else axes)) & 1
        return _fixed(found.astype(bool))

    @property
    def signatures(self) -> np.ndarray:
        """#F (uint16): which corners of the face or cell are at or above the level. Of images, bit v is the corner at v >> j & 1
        along the j-th axis of the face, counted from the array's last axis (with `time_axis=-1`, from the first)."""
        return self._places["signature"]

    @property
    def numbers(self) -> np.ndarray:
        """#F (uint8): the number of the facet among those in its face or cell."""
        return self._places["number"]

    @property
    def is_cap(self) -> np.ndarray:
        """#F truth values: whether the facet is a cap, which `close=True` adds at the border."""
        return self._places["is_cap"]


class Facets(ArrayOrdered):
    """A contour as facets of all dimensions, without triangulation: `facets[k]` has the facets of dimension k.

    ::

        facets = tegl.contour_facets(array, 0.5)
        polygons = facets[2]
        first = polygons.points[polygons.point_offsets[0]:polygons.point_offsets[1]]
        corners = facets.vertices[first]               # of polygon 0, in order

    A k-facet is a connected part of the contour in a face of the grid with one dimension more: a point on an edge, a segment
    in a square, a polygon (usually not plane) in a cube, a polyhedron in a tesseract. Results of `tegl.contour_facets` and
    `tegl.contour_mesh_facets`.

    Columns of `vertices` are in the order of the array's axes. The facets of the highest dimension have the orientation of
    the simplices of `tegl.contour`; those of lower dimensions have one of their own, to which `signs` refer.
    """

    _core: _tegl.Facets

    def __init__(self, core: _tegl.Facets, is_reversed: bool) -> None:
        self._core, self._is_reversed = core, is_reversed
        self._levels = tuple(FacetLevel(core, k, is_reversed) for k in range(core.ndim))

    def __len__(self) -> int:
        return len(self._levels)

    def __getitem__(self, dimension: int) -> FacetLevel:
        k = _arguments.as_whole("dimension of facets", dimension)
        if not -len(self) <= k < len(self):
            raise IndexError(f"facets of dimension {k}; expected 0 to {len(self) - 1}")
        return self._levels[k]

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(level)} {_NAMES[level.dimension]}" for level in self._levels)
        return f"<tegl.Facets at {self.isovalue:g}: {counts}>"

    @property
    def direction(self) -> _kinds.Direction:
        """The side that the facets of the highest dimension and the normals face: "descent" or "ascent"."""
        return self._core.direction

    @property
    def isovalue(self) -> float:
        """The level of the contour."""
        return self._core.isovalue

    @property
    def cell_count(self) -> int | None:
        """The number of cells of the mesh or lattice; None for an image."""
        return self._core.cells or None

    def neighbours(self) -> tuple[np.ndarray, np.ndarray]:
        """(pairs, ridges): all pairs of facets of the highest dimension that meet, #R x 2, and the facet of the dimension
        below in which they do, #R. Two facets may meet in several."""
        ridges = self._levels[-2]
        first = ridges.up_offsets[:-1].astype(np.intp)
        inner = np.flatnonzero(np.diff(ridges.up_offsets.astype(np.intp)) == 2)
        return ridges.coboundary[first[inner, np.newaxis] + np.arange(2)], inner

    def check(self, *, progress: Progress | None = None) -> FacetReport:
        """Counts the facets and their faults, components and Euler characteristic."""
        found = _tegl.check_facets(self._core, progress)
        found["counts"] = tuple(found["counts"])
        return FacetReport(**found)

    @_arguments.documents("triangulate")
    def triangulate(self, method: _kinds.PolygonTriangulation = "halving-chord", *, threads: int = 0,
                    progress: Progress | None = None) -> Contour:
        """The polygons of a 3D image cut into triangles: "fan", "zigzag", "halving-chord", "halving-kink" or
        "barycentric". Points keep their numbers."""
        core = _tegl.triangulate(self._core, _arguments.as_text("method", method), _arguments.threads_of(threads), progress)
        return Contour._of(core, self._is_reversed)

    @_arguments.documents("write_facets")
    def save(self, path: str | os.PathLike, *, compress: bool = False, progress: Progress | None = None) -> None:
        """Writes a file for ParaView and VTK: .vtu, or in 2D and 3D .vtkhdf. Files have the coordinates x, y, z and t."""
        _tegl.write_facets(self._core, os.fspath(path), _arguments.as_bool("compress", compress), progress)


def gradient_only(normals: object) -> None:
    """Raises a ValueError for normals that belong to simplices."""
    if isinstance(normals, str) and normals in ("geometric", "flat"):
        raise ValueError(f"normals is {normals!r}, which is for simplices; expected normals from the gradient, or none, for "
                         "facets")


def _fixed(array: np.ndarray) -> np.ndarray:
    array.flags.writeable = False
    return array


def _backwards(first: np.ndarray, keeps_first: bool = False) -> np.ndarray:
    """The entries of each row from its last to its first; or its first one, then the others from the last on."""
    starts, counts = first[:-1].astype(np.intp), np.diff(first.astype(np.intp))
    size = np.repeat(counts, counts)
    place = np.arange(len(size)) - np.repeat(starts, counts)
    return np.repeat(starts, counts) + ((size - place) % size if keeps_first else size - 1 - place)
