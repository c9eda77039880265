# SPDX-License-Identifier: BSD-3-Clause
"""The methods of the class Contour as functions."""

from __future__ import annotations

import typing
from collections.abc import Sequence

import numpy as np

from . import _arguments, _kinds
from ._arguments import Labelled, Place, Places, Progress
from ._contour import Components, Contour
from ._incidence import Incidence
from ._results import CutMeasures, Elements, Frame, Intersections, Measures, MergeReport, MeshReport, SimplifyStats
from ._track import TrackGraph


@_arguments.documents("MeshReport")
def check(contour: Contour, *, incidence: Incidence | None = None, threads: int = 0,
          progress: Progress | None = None) -> MeshReport:
    """Checks whether a contour is an oriented manifold and closed, and counts its components and faults."""
    _arguments.core_of(contour)
    return Contour.check(contour, incidence=incidence, threads=threads, progress=progress)


@_arguments.documents("find_intersections", "Intersections")
def intersections(contour: Contour, *, tile: float | Sequence[float] | None = None,
                  origin: float | Sequence[float] = 0.0, most_listed: int | None = None, threads: int = 0,
                  progress: Progress | None = None) -> Intersections:
    """Finds all pairs of simplices that intersect outside of their common face, by exact arithmetic.

    `tile` is the size of a tile, one number for all axes or one for each; then the tiles with intersections are counted.
    For an array without coordinates it is 1. `origin` is a corner of a tile.
    """
    _arguments.core_of(contour)
    return Contour.intersections(contour, tile=tile, origin=origin, most_listed=most_listed, threads=threads,
                                 progress=progress)


@typing.overload
def measure(contour: Contour, *, at: None = None, allow_empty: bool = False, incidence: Incidence | None = None,
            threads: int = 0, progress: Progress | None = None) -> Measures: ...


@typing.overload
def measure(contour: Contour, *, at: Place | Places | Labelled, allow_empty: bool = False, threads: int = 0,
            progress: Progress | None = None) -> CutMeasures: ...


@_arguments.documents("measure", "Measures", "measure_cuts")
def measure(contour: Contour, *, at=None, allow_empty: bool = False, incidence: Incidence | None = None,
            threads: int = 0, progress: Progress | None = None) -> Measures | CutMeasures:
    """Size, enclosed content, centroid and box of a contour; or, with `at`, size and content of its slices at times.

    A time outside of the image is a ValueError, as in `slice`; with `allow_empty` its size and content are 0.
    """
    _arguments.core_of(contour)
    return Contour.measure(contour, at=at, allow_empty=allow_empty, incidence=incidence, threads=threads,
                           progress=progress)


@_arguments.documents("label_components", "components", "Component")
def components(contour: Contour, *, incidence: Incidence | None = None, threads: int = 0,
               progress: Progress | None = None) -> Components:
    """The connected components of a contour: their labels and measures; contours of selected ones."""
    _arguments.core_of(contour)
    return Contour.components(contour, incidence=incidence, threads=threads, progress=progress)


@_arguments.documents("frame_of", "HyperplaneFrame")
def frame_of(contour: Contour, *, normal: Sequence[float] | np.ndarray, offset: float) -> Frame:
    """The place of the slice `tegl.slice(contour, normal=normal, offset=offset)` in the contour's space.

    ::

        frame = tegl.frame_of(contour, normal=(0, 1, 1, 0), offset=9)
        cut = tegl.slice(contour, normal=(0, 1, 1, 0), offset=9)
        points = frame.to_space(cut.vertices)                # origin + cut.vertices @ axes

    The coordinates of points, vectors and the normal are in the order of the columns of `vertices`. The frame is defined
    for every contour, also where the slice is empty.
    """
    _arguments.core_of(contour)
    return Contour.frame_of(contour, normal=normal, offset=offset)


@_arguments.documents("merge_vertices", "MergeCounts", "MergeReport")
def merge_vertices(contour: Contour, tolerance: float = 0.0, *, most_listed: int = 1000, threads: int = 0,
                   progress: Progress | None = None) -> tuple[Contour, MergeReport]:
    """A contour with vertices that coincide merged, without simplices of zero size, and a report of its pinches.

    tolerance
        Vertices at most this far apart are merged; 0: only vertices at equal positions.
    """
    _arguments.core_of(contour)
    return Contour.merge_vertices(contour, tolerance, most_listed=most_listed, threads=threads, progress=progress)


@_arguments.documents("elements", "elements_by_cell", "Elements")
def elements(contour: Contour, *, by_cell: bool = False, threads: int = 0,
             progress: Progress | None = None) -> Elements:
    """Hypersurface elements of a contour: one per simplex, or (`by_cell`) per connected part in a cell of the grid.

    `by_cell` needs a contour whose grid is known: from `tegl.contour`, or components of such a contour.
    """
    _arguments.core_of(contour)
    return Contour.elements(contour, by_cell=by_cell, threads=threads, progress=progress)


@typing.overload
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
             progress: Progress | None = None,
             return_stats: typing.Literal[False] = False) -> Contour: ...


@typing.overload
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
             progress: Progress | None = None,
             return_stats: typing.Literal[True]) -> tuple[Contour, SimplifyStats]: ...


@_arguments.documents("simplify", "SimplifyOptions", "SimplifyStats")
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
             progress: Progress | None = None,
             return_stats: bool = False) -> Contour | tuple[Contour, SimplifyStats]:
    """A contour with fewer simplices and the same topology; the attribute "simplification_error" bounds the error.

    ratio, count, max_error
        The goal: this fraction of the simplices (0.1: a tenth), this number of them, or the fewest within this error.
        With several, the first one reached ends the simplification.
    method, border
        "quadric", "facets", "vertices" or "fast"; "fixed" or "within".
    scale
        A weight for the lengths along each axis of the array, or "auto".
    return_stats
        Whether to return (contour, SimplifyStats).
    """
    _arguments.core_of(contour)
    return Contour._simplify(contour, ratio, count, max_error, method, border, max_curvature, scale, measure,
                             allow_nonmanifold, keep_embedded, threads, progress, return_stats)


@_arguments.documents("track", "TrackOptions", "TrackEventKind", "TrackSegment", "TrackSample")
def track(contour: Contour, *, min_lifetime: float = 0.0, times: int | Places | Labelled | None = None,
          first: Place | None = None, last: Place | None = None, handles: bool = True, label_simplices: bool = False,
          allow_empty: bool = False, incidence: Incidence | None = None, threads: int = 0,
          progress: Progress | None = None) -> TrackGraph:
    """Tracks the parts of a contour along its time axis: births, merges, splits, deaths.

    times
        Times at which parts are measured, ascending; or a whole number of evenly spaced times. A time outside of the
        image is a ValueError, as in `tegl.slice`; with `allow_empty` there are no parts at it.
    """
    _arguments.core_of(contour)
    return Contour.track(contour, min_lifetime=min_lifetime, times=times, first=first, last=last, handles=handles,
                         label_simplices=label_simplices, allow_empty=allow_empty, incidence=incidence, threads=threads,
                         progress=progress)
