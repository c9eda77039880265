# SPDX-License-Identifier: BSD-3-Clause
"""Results of operations on contours, and the places of slices of contours and arrays."""

from __future__ import annotations

import dataclasses
import os
import typing
from collections.abc import Sequence

import numpy as np

from . import _arguments, _kinds, _tegl
from ._arguments import Progress


@dataclasses.dataclass(frozen=True)
class MeshReport:
    """The counts of `tegl.check`: see docs/command-line.md, `tegl check`."""

    dim: int
    vertices: int
    unused_vertices: int
    simplices: int
    components: int
    euler: int
    boundary_simplices: int
    nonmanifold_simplices: int
    bad_links: int
    orientation_conflicts: int
    degenerate_simplices: int
    nonfinite_vertices: int  #: with infinite or NaN coordinates

    @property
    def is_manifold(self) -> bool:
        """Whether the mesh is an oriented manifold, with or without a border. Simplices of zero size are allowed."""
        return not (self.nonmanifold_simplices or self.bad_links or self.orientation_conflicts or self.unused_vertices)

    @property
    def is_closed(self) -> bool:
        """Whether the mesh has no border."""
        return self.boundary_simplices == 0


@dataclasses.dataclass(frozen=True, eq=False)
class Frame:
    """Coordinates in a hyperplane of N-space, those of its slices: see `tegl.frame_of`."""

    origin: np.ndarray  #: N coordinates of the point of the hyperplane that is nearest to 0
    axes: np.ndarray  #: N - 1 rows: orthonormal vectors of N-space, one for each column of the slice's vertices

    def to_space(self, points) -> np.ndarray:
        """Points of a slice, such as its vertices (#P x N - 1, or one point), in the space of the contour: #P x N."""
        return self.origin + self._numbers("points of a slice", points, len(self.axes)) @ self.axes

    def to_plane(self, points) -> np.ndarray:
        """Coordinates of points of N-space (#P x N, or one point) in the hyperplane, after orthogonal projection."""
        return self._numbers("points", points, len(self.origin)) @ self.axes.T

    @staticmethod
    def _numbers(name: str, points, count: int) -> np.ndarray:
        found = _arguments.real(name, points).astype(np.float64, copy=False)
        if found.ndim == 0 or found.shape[-1] != count:
            raise ValueError(f"{name} have the shape {found.shape}; expected {count} coordinates each")
        return found


@dataclasses.dataclass(frozen=True, eq=False)
class Intersections:
    """The pairs of simplices that intersect outside of their common face."""

    simplices: int  #: of the contour
    flat: int  #: simplices of measure zero: not examined, and in no pair
    count: int  #: number of pairs
    intersecting: int  #: number of simplices in at least one pair
    pairs: np.ndarray  #: #P x 2 numbers of simplices, ascending; all pairs, or the first `most_listed`
    places: np.ndarray  #: #P x N: a common point of each pair
    depths: np.ndarray  #: #P: how far one simplex has to be moved so that they do not cross; 0 if they touch
    tiles: int  #: tiles that contain simplices; 0 without `tile`
    tiles_hit: int  #: tiles that contain simplices in pairs

    @property
    def is_embedded(self) -> bool:
        """Whether no two simplices intersect and none is flat: flat ones are not examined, as by `tegl check`."""
        return self.count == 0 and self.flat == 0


@dataclasses.dataclass(frozen=True)
class Measures:
    """Measures of a contour."""

    size: float  #: length (2D), area (3D), 3-volume (4D), 4-volume (5D)
    content: float | None  #: the enclosed area, volume, ...: positive if high values are inside; None: the contour is open
    centroid: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    boundary_simplices: int
    open_simplices: int


@dataclasses.dataclass(frozen=True)
class CutMeasures:
    """Measures of the slices of a contour, one entry per slice."""

    at: np.ndarray
    size: np.ndarray  #: length (3D), area (4D), 3-volume (5D) of the slice
    content: np.ndarray  #: the enclosed area, volume, ...; NaN if the slice is open


@dataclasses.dataclass(frozen=True)
class Component:
    """Measures of one component."""

    label: int
    vertices: int
    simplices: int
    size: float  #: length, area, volume
    content: float | None  #: enclosed area or volume; negative: a cavity; None: the component is open
    centroid: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    euler: int
    boundary_simplices: int


@dataclasses.dataclass(frozen=True)
class ElementSum:
    """Sums over elements."""

    normal: np.ndarray
    absolute: np.ndarray
    measure: float
    closure_error: float  #: 0: closed, up to rounding


class Elements:
    """A contour as points with normals times volume, for integrals over it. Columns are in the order of the array's axes."""

    def __init__(self, core: _tegl.Elements, is_reversed: bool, has_flat_normals: bool = False) -> None:
        self._core, self._is_reversed, self._has_flat_normals = core, is_reversed, has_flat_normals

    def _turned(self, rows: np.ndarray) -> np.ndarray:
        return rows[:, ::-1] if self._is_reversed else rows

    @property
    def centroids(self) -> np.ndarray:
        """#E x N."""
        return self._turned(self._core.centroids)

    @property
    def normals(self) -> np.ndarray:
        """#E x N: d sigma_mu, covariant."""
        return self._turned(self._core.normals)

    @property
    def measures(self) -> np.ndarray:
        """#E: lengths, areas or volumes."""
        return self._core.measures

    @property
    def counts(self) -> np.ndarray:
        """#E: number of simplices of each element."""
        return self._core.counts

    @property
    def attributes(self) -> dict[str, np.ndarray]:
        """name -> #E, or #E x width."""
        return {name: self._turned(values) if name == "normal" and self._has_flat_normals else values
                for name, (values, _) in self._core.attributes.items()}

    def __len__(self) -> int:
        return len(self._core.measures)

    def __repr__(self) -> str:
        return f"<tegl.Elements: {len(self)}>"

    def sum(self) -> ElementSum:
        """Sums of normals and measures (compensated). The normals of a closed contour sum to zero."""
        found = _tegl.sum_of(self._core)
        for name in ("normal", "absolute"):
            found[name] = np.array(found[name][::-1] if self._is_reversed else found[name])
        return ElementSum(**found)

    @_arguments.documents("write_elements")
    def save(self, path: str | os.PathLike, *, axes: _kinds.ElementAxes = "time_first",
             components: _kinds.ElementComponents = "covariant", header: bool = False,
             progress: Progress | None = None) -> None:
        """Writes .dat or .txt with the columns of Cornelius, or .h5."""
        _tegl.write_elements(self._core, os.fspath(path), _arguments.as_text("axes", axes),
                             _arguments.as_text("components", components), _arguments.as_bool("header", header),
                             progress)


@dataclasses.dataclass(frozen=True)
class SimplifyStats:
    """Figures of a simplification."""

    simplices_before: int
    simplices_after: int
    vertices_before: int
    vertices_after: int
    error_of_original: float | None  #: no point of the original is farther than this from the result
    error_of_result: float | None  #: no point of the result is farther than this from the original
    end: _kinds.SimplifyEnd  #: reason for the end: "count", "error", "shape" or "rounds" (see docs/simplification.md)
    rounds: int


@dataclasses.dataclass(frozen=True)
class MergeReport:
    """What merging vertices did, and where its result is no manifold. Vertex numbers refer to the result."""

    vertices_before: int
    simplices_before: int
    merged_vertices: int  #: vertices replaced by another one
    collapsed_simplices: int  #: dropped: they repeat a vertex
    flat_simplices: int  #: dropped: of zero content with different vertices
    kept_flat_simplices: int  #: of zero content, but without them there would be a gap
    divided_simplices: int  #: divided beside dropped ones
    turned_simplices: int  #: whose normal turned by more than 90 degrees
    euler_before: int
    euler_after: int
    components_before: int
    components_after: int  #: more than before if merging cut the contour, fewer if it joined components
    vanished_components: int  #: components without size, of which nothing is left
    vanished: np.ndarray  #: where they were, a row each
    shrunk_places: int  #: places where tubes or loops shrank to points, which changes the topology
    shrunk: np.ndarray  #: these places, a row each
    pinched_vertices: int  #: vertices whose link is neither a sphere nor a ball
    vertices: list[int]  #: these vertices, ascending
    pinched_faces: int  #: vertices (2D), edges (3D) or triangles (4D) in more than two simplices
    faces: list[list[int]]  #: the vertices of these faces


def named_axis(names: Sequence[str], ndim: int, time_axis: int, at, axis, more: dict) -> tuple[int, typing.Any]:
    """The axis and the place of a slice; names of axes are removed from `more`."""
    if at is None and not any(names):
        for name, place in more.items():  # such as x=2
            if name not in _arguments.EXTRACT_OPTIONS:
                raise ValueError(f"no axis is named '{name}': the axes have no names; expected at={place!r} and axis= with a "
                                 f"number from 0 to {ndim - 1}, or names for the axes: tegl.contour(array, level, "
                                 "axis_names=...)")
    named = [name for name in more if name in names]
    if named:
        if len(named) > 1 or at is not None or axis is not None:
            raise ValueError(f"several hyperplanes: {', '.join(named)}"
                             f"{' and at' if at is not None else ''}{' and axis' if axis is not None else ''}; "
                             "expected one")
        axis, at = named[0], more.pop(named[0])
    if at is None:
        raise ValueError("no hyperplane; expected at=, the name of an axis" +
                         (f" ({', '.join(n for n in names if n)})" if any(names) else "") + ", or normal= and offset=")
    return _arguments.axis_number(time_axis if axis is None else axis, names, ndim), at


def offset_alone(names: Sequence[str]) -> str:
    return "offset without normal; expected both, or at=" + (", with axis='offset'" if "offset" in names else "")


def is_list(value) -> bool:
    return isinstance(value, (list, tuple)) or (not isinstance(value, str) and np.ndim(value) == 1)
