# SPDX-License-Identifier: BSD-3-Clause
"""What operations on contours give, and where cuts of contours and of arrays are."""

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
    """What `tegl.check` found, as counts: see docs/command-line.md, `tegl check`."""

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
    nonfinite_vertices: int  #: with coordinates that are infinite or no numbers

    @property
    def is_manifold(self) -> bool:
        """Whether it is an oriented manifold, with or without a border. Simplices of zero size do not count."""
        return not (self.nonmanifold_simplices or self.bad_links or self.orientation_conflicts or self.unused_vertices)

    @property
    def is_closed(self) -> bool:
        """Whether it has no border."""
        return self.boundary_simplices == 0


@dataclasses.dataclass(frozen=True)
class Measures:
    """What a contour measures."""

    size: float  #: length (2D), area (3D), 3-volume (4D), 4-volume (5D)
    content: float | None  #: the enclosed area, volume, ...: positive where it is high; None: the contour is open
    centroid: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    boundary_simplices: int
    open_simplices: int


@dataclasses.dataclass(frozen=True)
class CutMeasures:
    """What cuts of a contour measure, number by number."""

    at: np.ndarray
    size: np.ndarray  #: length (3D), area (4D), 3-volume (5D) of the cut
    content: np.ndarray  #: the enclosed area, volume, ...; NaN where the cut is open


@dataclasses.dataclass(frozen=True)
class Component:
    """What is known of one component."""

    label: int
    vertices: int
    simplices: int
    size: float  #: length, area, volume
    content: float | None  #: what it encloses; negative: a cavity; None: it is open
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
    """A contour as points with normals times volume, to integrate over it. Columns are in the array's order of axes."""

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
        """#E: of how many simplices each is made."""
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
        """Of normals and measures, compensated. The normals of a closed contour sum to zero."""
        found = _tegl.sum_of(self._core)
        for name in ("normal", "absolute"):
            found[name] = np.array(found[name][::-1] if self._is_reversed else found[name])
        return ElementSum(**found)

    @_arguments.documents("write_elements")
    def save(self, path: str | os.PathLike, *, axes: _kinds.ElementAxes = "time_first",
             components: _kinds.ElementComponents = "covariant", header: bool = False,
             progress: Progress | None = None) -> None:
        """Writes .dat or .txt in Cornelius's columns, or .h5."""
        _tegl.write_elements(self._core, os.fspath(path), _arguments.as_text("axes", axes),
                             _arguments.as_text("components", components), _arguments.as_bool("header", header),
                             progress)


@dataclasses.dataclass(frozen=True)
class SimplifyStats:
    """What a simplification did."""

    simplices_before: int
    simplices_after: int
    vertices_before: int
    vertices_after: int
    error_of_original: float | None  #: no point of the original is farther than this from the result
    error_of_result: float | None  #: and none of the result from the original
    end: _kinds.SimplifyEnd  #: what stopped it: "count", "error", "shape" or "rounds" (see docs/simplification.md)
    rounds: int


def named_axis(names: Sequence[str], ndim: int, time_axis: int, at, axis, more: dict) -> tuple[int, typing.Any]:
    """Which axis, and where; names of axes are taken out of `more`."""
    if at is None and not any(names):
        for name, place in more.items():  # such as x=2
            if name not in _arguments.EXTRACT_OPTIONS:
                raise ValueError(f"no axis is named '{name}', as the axes have no names; expected at={place!r} and axis= with a "
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
