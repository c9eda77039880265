# SPDX-License-Identifier: BSD-3-Clause
"""What is done with contours: cuts, checks, components, measures, elements, simplification."""

from __future__ import annotations

import builtins
import dataclasses
import os
import typing
from collections.abc import Sequence

import numpy as np

from . import _arguments, _kinds, _outside, _tegl
from ._contour import Contour, Labelled, Place, Places, Progress


@typing.overload
def slice(contour_or_array: Contour, level: None = None, *, at: Place | None = None, axis: int | str | None = None,
          normal: Sequence[float] | np.ndarray | None = None, offset: float | None = None, allow_empty: bool = False,
          threads: int = 0, progress: Progress | None = None, **coordinate: Place) -> Contour: ...


@typing.overload
def slice(contour_or_array: Contour, level: None = None, *, at: Places, axis: int | str | None = None,
          allow_empty: bool = False, threads: int = 0, progress: Progress | None = None) -> list[Contour]: ...


@typing.overload
def slice(contour_or_array: Contour, level: None = None, *, at: Labelled, axis: int | str | None = None,
          allow_empty: bool = False, threads: int = 0,
          progress: Progress | None = None) -> Contour | list[Contour]: ...


@typing.overload
def slice(contour_or_array: Contour, level: None = None, *, at: None = None, axis: None = None, normal: None = None,
          offset: None = None, allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
          **coordinate: Places | Labelled) -> Contour | list[Contour]: ...


@typing.overload
def slice(contour_or_array: typing.Any, level: float, *, at: Place, axis: int | str | None = None,
          allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
          **more: typing.Any) -> Contour: ...


@typing.overload
def slice(contour_or_array: typing.Any, level: float, *, at: Places, axis: int | str | None = None,
          allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
          **more: typing.Any) -> list[Contour]: ...


@typing.overload
def slice(contour_or_array: typing.Any, level: float, *, axis: int | str | None = None, allow_empty: bool = False,
          threads: int = 0, progress: Progress | None = None, **more: typing.Any) -> Contour | list[Contour]: ...


@_arguments.documents("slice", "slice_2", "slice_image_across")
def slice(contour_or_array, level: float | None = None, *, at=None, axis: int | str | None = None, normal=None,
          offset=None, allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
          **more) -> Contour | list[Contour]:
    """The cut of a contour by a hyperplane, one dimension less: what a moving surface is like at a time.

    ::

        tegl.slice(contour, at=7.3)                          # the time axis
        tegl.slice(contour, lat=-20.5)                       # an axis by its name
        tegl.slice(contour, at=3.0, axis=2)                  # or by its number
        tegl.slice(contour, at=[1.5, 7.3])                   # several, in one pass: a list
        tegl.slice(contour, normal=(0, 1, 1, 0), offset=9)   # any hyperplane <normal, x> = offset
        tegl.slice(array, 20.0, at=7.3)                      # straight from an array: only the layers beside it are read

    The last form takes the arguments of `tegl.contour` too. An axis whose name is that of an argument (level, offset) is
    cut by at= and axis=. Places may be dates, of any kind or as text, where the axis's unit says since when it counts, and
    durations where it counts hours, days, ... Of 3D and 4D contours.

    A place outside of the image, or of a contour that does not know its image, is a ValueError that names the range and
    its unit, and so is a level that no sample of the array is above or below; with `allow_empty` the cut is empty
    instead. Within the image a cut that meets no contour is empty in any case.
    """
    if isinstance(contour_or_array, Contour):
        if level is not None and "level" in contour_or_array.axis_names:  # an axis of pressures
            more["level"], level = level, None
        if level is not None:
            raise ValueError(f"level is {level} and the first argument a contour, which has its level; expected at=")
        return _cut(contour_or_array, at, axis, normal, offset, allow_empty, threads, progress, more)
    if level is None:
        raise ValueError("a cut of an array needs a level; expected tegl.slice(array, level, at=...)")
    return _cut_image(contour_or_array, _arguments.as_number("level", level), at, axis, normal, offset, allow_empty,
                      threads, progress, more)


def _named_axis(names: Sequence[str], ndim: int, time_axis: int, at, axis, more: dict) -> tuple[int, typing.Any]:
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


def _cut(contour: Contour, at, axis, normal, offset, allow_empty, threads, progress, more) -> Contour | list[Contour]:
    ndim = contour.ndim
    is_checked = not _arguments.as_bool("allow_empty", allow_empty) and ndim in (3, 4)
    if normal is not None:
        if at is not None or axis is not None or offset is None or more:
            raise ValueError("normal goes with offset alone; expected normal= and offset=, or at=")
        direction = _arguments.as_numbers("normal", normal, "a number for each axis")
        places: typing.Any = _arguments.as_numbers("offset", offset) if _is_list(offset) else \
            _arguments.as_number("offset", offset)
        left = None
        if is_checked:
            _outside.require_offsets(contour, direction, places if _is_list(offset) else [places])
    else:
        if offset is not None:
            raise ValueError(_offset_alone(contour.axis_names))
        number, places = _named_axis(contour.axis_names, ndim, contour.time_axis, at, axis, more)
        if more:
            raise ValueError(f"no axis is named '{next(iter(more))}'; the contour's are "
                             f"{', '.join(repr(name) for name in contour.axis_names)}")
        direction = [float(a == number) for a in range(ndim)]
        unit = contour.axis_units[number]
        given = list(places) if _is_list(places) else [places]
        wanted = [_arguments.number_on_axis(place, unit) for place in given]
        if is_checked:
            _outside.require_places(contour, number, wanted, given)
        left = _outside.without_axis(contour._extent, number)
        places = wanted if _is_list(places) else wanted[0]
    several = _is_list(places)
    cuts = _tegl.slice_stack(contour._core, contour._listed(direction),
                             list(places) if several else [places], _arguments.threads_of(threads), progress)
    found = [Contour._of(cut, contour._is_reversed, left) for cut in cuts]
    return found if several else found[0]


def _offset_alone(names: Sequence[str]) -> str:
    return "offset without normal; expected both, or at=" + (", with axis='offset'" if "offset" in names else "")


def _is_list(value) -> bool:
    return isinstance(value, (list, tuple)) or (not isinstance(value, str) and np.ndim(value) == 1)


_GRID = ("spacing", "origin", "coords", "affine", "mask", "axis_names", "axis_units", "time_axis")


def _cut_image(array, level, at, axis, normal, offset, allow_empty, threads, progress, more) -> Contour | list[Contour]:
    if normal is not None:  # there is no short way to an oblique cut
        from ._image import contour
        whole = contour(array, level, allow_empty=allow_empty, threads=threads,
                        progress=_arguments.part_of(progress, 0.0, 0.5), **more)
        return _cut(whole, at, axis, normal, offset, allow_empty, threads, _arguments.part_of(progress, 0.5, 1.0), {})
    if offset is not None:
        raise ValueError(_offset_alone(()))
    prepared = _arguments.prepare(array, **{name: more.pop(name) for name in _GRID if name in more})
    is_double = _arguments.is_double(more.pop("dtype", np.float32), prepared)
    time_axis = 0 if prepared.is_reversed else prepared.ndim - 1
    number, places = _named_axis(prepared.names, prepared.ndim, time_axis, at, axis, more)
    options = _arguments.extract_options(threads=threads, **more)
    unit = prepared.units[number]
    given = list(places) if _is_list(places) else [places]
    wanted = [_arguments.number_on_axis(place, unit) for place in given]
    kind = np.float64 if is_double else np.float32

    extent = prepared.extent if prepared.ndim in (3, 4) else None  # of others the library says that there are no cuts
    if not _arguments.as_bool("allow_empty", allow_empty):
        _outside.require_places_of(extent, number, wanted, given, kind, prepared.names[number], unit, "image")

    def cut(i: int) -> _tegl.Contour:
        if _outside.is_outside(extent, number, wanted[i], kind):
            return _nothing(prepared, number, level, options["direction"], kind)
        return _tegl.slice_image(prepared.image, level, prepared.library_axis(number), wanted[i], is_double, options,
                                 _arguments.part_of(progress, i / len(wanted), (i + 1) / len(wanted)))

    with prepared.terms():
        found = [cut(i) for i in range(len(wanted))]
    if not allow_empty and found and not any(len(one.simplices) for one in found):
        _outside.require_level(prepared, level, "cut")
    left = _outside.without_axis(prepared.extent, number)
    cuts = [Contour._of(one, prepared.is_reversed, left) for one in found]
    return cuts if _is_list(places) else cuts[0]


def _nothing(prepared: _arguments.Prepared, axis: int, level: float, direction: str, kind) -> _tegl.Contour:
    """The empty cut outside of an image."""
    def others(labels: Sequence[str]) -> list[str]:
        return prepared.turned([label for number, label in enumerate(labels) if number != axis])

    rows = np.empty((0, prepared.ndim - 1), dtype=kind)
    return _tegl.Contour.from_arrays(rows, rows.astype(np.uint32), None, others(prepared.names), others(prepared.units),
                                     direction, level, [], [])


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


@_arguments.documents("MeshReport")
def check(contour: Contour, *, progress: Progress | None = None) -> MeshReport:
    """Counts a contour's invariants: is it a manifold, closed, oriented? In how many pieces?"""
    return MeshReport(**_tegl.check(_arguments.core_of(contour), progress))


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


@typing.overload
def measure(contour: Contour, *, at: None = None, allow_empty: bool = False, threads: int = 0,
            progress: Progress | None = None) -> Measures: ...


@typing.overload
def measure(contour: Contour, *, at: Place | Places | Labelled, allow_empty: bool = False, threads: int = 0,
            progress: Progress | None = None) -> CutMeasures: ...


@_arguments.documents("measure", "Measures", "measure_cuts")
def measure(contour: Contour, *, at=None, allow_empty: bool = False, threads: int = 0,
            progress: Progress | None = None) -> Measures | CutMeasures:
    """Size, enclosed content, centroid and box of a contour; or, with `at`, size and content of its cuts at times.

    Times outside of the image are a ValueError, as in `slice`; with `allow_empty` their sizes and contents are 0.
    """
    core = _arguments.core_of(contour)
    allow_empty = _arguments.as_bool("allow_empty", allow_empty)
    if at is not None:
        unit = contour.axis_units[contour.time_axis]
        given = list(at) if _is_list(at) else [at]
        places = [_arguments.number_on_axis(place, unit) for place in given]
        if not allow_empty and contour.ndim > 2:
            _outside.require_places(contour, contour.time_axis, places, given)
        size, content = _tegl.measure_cuts(core, places, _arguments.threads_of(threads), progress)
        return CutMeasures(np.array(places), np.array(size), np.array(content))
    found = _tegl.measure(core, _arguments.threads_of(threads), progress)
    for name in ("centroid", "lowest", "highest"):
        found[name] = np.array(contour._listed(found[name]))
    return Measures(**found)


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


class Components(Sequence[Component]):
    """The components of a contour, in the order of their labels."""

    def __init__(self, contour: Contour, labels: _tegl.ComponentLabels, found: list[Component]) -> None:
        self._contour, self._labels, self._found = contour, labels, found

    @property
    def vertex_labels(self) -> np.ndarray:
        """#V; 2**32 - 1 for vertices in no simplex."""
        return self._labels.vertices

    @property
    def simplex_labels(self) -> np.ndarray:
        """#S."""
        return self._labels.simplices

    def __len__(self) -> int:
        return len(self._found)

    @typing.overload
    def __getitem__(self, index: typing.SupportsIndex) -> Component: ...

    @typing.overload
    def __getitem__(self, index: builtins.slice) -> list[Component]: ...

    def __getitem__(self, index):
        return self._found[index]

    def __repr__(self) -> str:
        return f"<tegl.Components: {len(self)}>"

    @_arguments.documents("split_components")
    def split(self, *, progress: Progress | None = None) -> list[Contour]:
        """A contour for each."""
        return [Contour._of(part, self._contour._is_reversed, self._contour._extent, self._contour._grid)
                for part in _tegl.split_components(self._contour._core, self._labels, progress)]

    @_arguments.documents("select_components")
    def select(self, keep, *, progress: Progress | None = None) -> Contour:
        """The contour of some: a truth value for each component, or the labels of those to keep."""
        chosen = np.atleast_1d(np.asarray(keep))
        if chosen.dtype != bool:
            if chosen.size and chosen.dtype.kind not in "iu":
                raise TypeError(f"keep is {keep!r}; expected a truth value for each component, or labels")
            labels, chosen = chosen.astype(np.int64).ravel(), np.zeros(len(self), dtype=bool)
            if labels.size and not (0 <= labels.min() and labels.max() < len(self)):
                raise ValueError(f"labels are {labels.min()} to {labels.max()}; expected 0 to {len(self) - 1}")
            chosen[labels] = True
        core = _tegl.select_components(self._contour._core, self._labels, chosen.tolist(), progress)
        return Contour._of(core, self._contour._is_reversed, self._contour._extent, self._contour._grid)

    def largest(self, count: int = 1, *, progress: Progress | None = None) -> Contour:
        """The contour of the largest ones by size."""
        count = _arguments.as_whole("count", count, 0)
        order = sorted(range(len(self)), key=lambda label: (-self._found[label].size, label))
        return self.select(np.array(order[:count], dtype=np.int64), progress=progress)


@_arguments.documents("label_components", "components", "Component")
def components(contour: Contour, *, threads: int = 0, progress: Progress | None = None) -> Components:
    """The connected components: labels, what each is, contours of some."""
    core, threads = _arguments.core_of(contour), _arguments.threads_of(threads)
    labels = _tegl.label_components(core, threads, _arguments.part_of(progress, 0.0, 0.3))
    found = []
    for one in _tegl.components(core, labels, threads, _arguments.part_of(progress, 0.3, 1.0)):
        for name in ("centroid", "lowest", "highest"):
            one[name] = np.array(contour._listed(one[name]))
        found.append(Component(**one))
    return Components(contour, labels, found)


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


@_arguments.documents("elements", "elements_by_cell", "Elements")
def elements(contour: Contour, *, by_cell: bool = False, threads: int = 0,
             progress: Progress | None = None) -> Elements:
    """Hypersurface elements of a contour: one for each simplex, or (`by_cell`) for each piece in a cell of the grid.

    `by_cell` is for contours straight from `tegl.contour`, or some of their components, whose grid is known.
    """
    core = _arguments.core_of(contour)
    if _arguments.as_bool("by_cell", by_cell) and contour._grid is None:
        raise ValueError("by_cell of a contour whose grid is not known; expected one that tegl.contour made")
    found = _tegl.elements(core, contour._grid if by_cell else None, _arguments.threads_of(threads), progress)
    return Elements(found, contour._is_reversed,
                    "normal" in core.simplex_attributes and "normal" not in core.vertex_attributes)


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


@typing.overload
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, threads: int = 0, progress: Progress | None = None,
             return_stats: typing.Literal[False] = False) -> Contour: ...


@typing.overload
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, threads: int = 0, progress: Progress | None = None,
             return_stats: typing.Literal[True]) -> tuple[Contour, SimplifyStats]: ...


@_arguments.documents("simplify", "SimplifyOptions", "SimplifyStats")
def simplify(contour: Contour, ratio: float | None = None, *, count: int | None = None,
             max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
             border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
             scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
             allow_nonmanifold: bool = False, threads: int = 0, progress: Progress | None = None,
             return_stats: bool = False) -> Contour | tuple[Contour, SimplifyStats]:
    """The same contour with fewer simplices, and a bound of the error: the attribute "simplification_error".

    ratio, count, max_error
        How far: to this share of the simplices (0.1: a tenth), to so many, or as long as the error stays below this.
        One of them, or several: what is reached first ends it.
    method, border
        "quadric", "facets", "vertices" or "fast"; "fixed" or "within".
    scale
        A number for each axis of the array by which its lengths count, or "auto".
    return_stats
        Whether to return (contour, SimplifyStats).
    """
    return _simplify(contour, ratio, count, max_error, method, border, max_curvature, scale, measure, allow_nonmanifold,
                     threads, progress, return_stats)


def _simplify(contour, ratio, count, max_error, method, border, max_curvature, scale, measure, allow_nonmanifold, threads,
              progress, return_stats) -> typing.Any:
    core = _arguments.core_of(contour)
    if isinstance(scale, str) and scale != "auto":
        raise ValueError(f"scale is '{scale}'; expected 'auto' or a number for each axis")
    factors: list[float] | None = None
    if isinstance(scale, str):
        factors = _tegl.automatic_scale(core)
    elif scale is not None:
        given = _arguments.as_numbers("scale", scale, "'auto' or a number for each axis")
        for axis, factor in enumerate(given):
            if not 0 < factor < np.inf:
                raise ValueError(f"the scale of axis {axis} is {factor:g}; expected a finite number above 0")
        factors = contour._listed(given)
    number, either, truth = _arguments.as_number, _arguments.or_none, _arguments.as_bool
    if ratio is not None and (number("ratio", ratio) > 1 or ratio < 0):
        raise ValueError(f"ratio is {ratio}; expected 0 to 1, the share of the simplices that are left, or count= with their "
                         "number")
    is_reported = truth("return_stats", return_stats)
    options = {"method": _arguments.as_text("method", method), "border": _arguments.as_text("border", border),
               "ratio": either(number, "ratio", ratio), "count": either(_arguments.as_whole, "count", count, 0),
               "max_error": either(number, "max_error", max_error),
               "max_curvature": either(number, "max_curvature", max_curvature), "scale": factors,
               "measure": truth("measure", measure),
               "allow_nonmanifold": truth("allow_nonmanifold", allow_nonmanifold),
               "threads": _arguments.threads_of(threads)}
    simplified, stats = _tegl.simplify(core, options, progress)
    result = Contour._of(simplified, contour._is_reversed, contour._extent)
    return (result, SimplifyStats(**stats)) if is_reported else result
