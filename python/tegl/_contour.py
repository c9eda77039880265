# SPDX-License-Identifier: BSD-3-Clause
"""The class Contour, its operations, and its components."""

from __future__ import annotations

import builtins
import os
import typing
from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _export, _incidence, _kinds, _results, _outside, _tegl
from ._arguments import Labelled, Place, Places, Progress
from ._columns import ArrayOrdered
from ._incidence import Incidence
from ._results import (Component, CutMeasures, Elements, Frame, Intersections, Measures, MergeReport, MeshReport,
                       SimplifyStats)
from ._track import TrackGraph


class Contour(ArrayOrdered):
    """Simplices in the space of an array: segments (2D), triangles (3D), tetrahedra (4D) or 4-simplices (5D).

    Results of `tegl.contour`, `load`, `slice`, `simplify` and other functions. The arrays are read-only views of the
    library's memory, which they keep alive: nothing is copied.

    Columns of `vertices` are in the order of the array's axes, as in scikit-image. Orientation, in this order of the
    columns: the normal n of a simplex with vertices v0, v1, ... for which det(v1 - v0, v2 - v0, ..., n) > 0 faces the
    lower values (`direction` "descent") or the higher ones ("ascent"). So with "descent" the signed content of a closed
    contour, (-1)^(N-1) times the sum over its simplices of det(vertices[simplex]) / N!, is positive if high values are
    inside: triangles are counterclockwise, seen from the low side.
    """

    _core: _tegl.Contour
    _grid: _tegl.Grid | None
    _extent: np.ndarray | None  #: of the image, 2 x N in the order of the columns of `vertices`; None: not known

    def __init__(self, vertices, simplices, *, normals=None, axis_names: Sequence[str] | None = None,
                 axis_units: Sequence[str] | None = None, direction: _kinds.Direction = "descent",
                 isovalue: float | None = None,
                 vertex_attributes: Mapping[str, typing.Any] | None = None,
                 simplex_attributes: Mapping[str, typing.Any] | None = None, time_axis: int = 0) -> None:
        """A contour from arrays (any mesh of simplices), which are copied. Attributes: name -> numbers, one row each."""
        vertices = _arguments.real("vertices", vertices)
        if vertices.ndim != 2 or not 2 <= vertices.shape[1] <= 5:
            raise ValueError(f"vertices have the shape {vertices.shape}; expected (#V, N) with N = 2 to 5")
        if vertices.dtype != np.float64:
            vertices = vertices.astype(np.float32 if vertices.dtype.itemsize < 4 or vertices.dtype == np.float32
                                       else np.float64)
        simplices = np.asarray(simplices)
        if simplices.size and simplices.dtype.kind not in "iu":
            raise ValueError(f"simplices are of type {simplices.dtype}; expected integers")
        if simplices.size and (simplices.min() < 0 or simplices.max() >= len(vertices)):
            raise ValueError(f"simplices have vertex numbers {simplices.min()} to {simplices.max()}; expected 0 to "
                             f"{len(vertices) - 1}")
        ndim = vertices.shape[1]
        if simplices.size and (simplices.ndim != 2 or simplices.shape[1] != ndim):
            raise ValueError(f"simplices have the shape {simplices.shape}; expected (#S, {ndim}), as vertices have {ndim} "
                             "coordinates")
        if normals is not None:
            normals = _arguments.real("normals", normals)
            if normals.shape != vertices.shape:
                raise ValueError(f"normals have the shape {normals.shape}; expected {vertices.shape}, as vertices")
        self._is_reversed = _arguments.turn_around(time_axis, ndim)
        turn = slice(None, None, -1) if self._is_reversed else slice(None)

        names = _arguments.labels_of("axis_names", axis_names, ndim)
        units = _arguments.labels_of("axis_units", axis_units, ndim)
        _arguments.require_different("axis_names", names)

        def attributes(of: str, given: Mapping[str, typing.Any] | None) -> list[tuple[str, str, np.ndarray]]:
            if given is not None and not isinstance(given, Mapping):
                raise TypeError(f"{of} is {given!r}; expected a dict of names and numbers")
            found = [(_arguments.as_text(f"a name of {of}", name), "",
                      _arguments.real(f"{of}[{name!r}]", values).astype(np.float64))
                     for name, values in (given or {}).items()]
            return [(name, unit, self._turned(values) if _is_flat_normal(of, name, values) else values)
                    for name, unit, values in found]

        self._grid = self._extent = None
        self._core = _tegl.Contour.from_arrays(
            vertices[:, turn], simplices.reshape(-1, ndim)[:, turn], None if normals is None else normals[:, turn],
            list(names[turn]), list(units[turn]), _arguments.as_text("direction", direction),
            _arguments.or_none(_arguments.as_number, "isovalue", isovalue),
            attributes("vertex_attributes", vertex_attributes), attributes("simplex_attributes", simplex_attributes))

    @classmethod
    def _of(cls, core: _tegl.Contour, is_reversed: bool, extent: np.ndarray | None = None,
            grid: _tegl.Grid | None = None) -> Contour:
        self = cls.__new__(cls)
        self._core, self._is_reversed, self._extent, self._grid = core, is_reversed, extent, grid
        return self

    # What it is.

    @property
    def simplices(self) -> np.ndarray:
        """#S x N vertex numbers (uint32), row = simplex."""
        return self._turned(self._core.simplices)

    @property
    def vertex_attributes(self) -> dict[str, np.ndarray]:
        """Numbers of every vertex: name -> #V, or #V x width, in double precision."""
        return {name: values for name, (values, _) in self._core.vertex_attributes.items()}

    @property
    def simplex_attributes(self) -> dict[str, np.ndarray]:
        """Numbers of every simplex: name -> #S, or #S x width, in double precision. The columns of `normal`, from
        `normals="flat"`, are in the order of the columns of `vertices`."""
        return {name: self._turned(values) if _is_flat_normal("simplex_attributes", name, values) else values
                for name, (values, _) in self._core.simplex_attributes.items()}

    @property
    def attribute_units(self) -> dict[str, str]:
        """The units of all attributes; empty if not known."""
        return {name: unit for attributes in (self._core.vertex_attributes, self._core.simplex_attributes)
                for name, (_, unit) in attributes.items()}

    @property
    def time_axis(self) -> int:
        """The axis across which contours are sliced by default, and along which components are tracked: 0 or N - 1."""
        return 0 if self._is_reversed else self.ndim - 1

    @property
    def direction(self) -> _kinds.Direction:
        """The direction of orientation and normals: "descent" (towards lower values) or "ascent"."""
        return self._core.direction

    @property
    def isovalue(self) -> float | None:
        """The level of the contour; None if a file does not contain it."""
        return self._core.isovalue

    def __reduce__(self):
        def attributes(of: Mapping[str, tuple[np.ndarray, str]]) -> list[tuple[str, str, np.ndarray]]:
            return [(name, unit, np.array(values)) for name, (values, unit) in of.items()]

        core = self._core
        own = {name: value for name, value in self.__dict__.items()
               if name not in ("_core", "_is_reversed", "_grid", "_extent")}
        return _restored, (type(self), np.array(core.vertices), np.array(core.simplices),
                           None if core.normals is None else np.array(core.normals), core.axis_names, core.axis_units,
                           core.direction, core.isovalue, attributes(core.vertex_attributes),
                           attributes(core.simplex_attributes), core.periods, self._is_reversed,
                           self._extent), own or None

    def __repr__(self) -> str:
        what = {2: "segments", 3: "triangles", 4: "tetrahedra", 5: "4-simplices"}[self.ndim]
        level = "" if self.isovalue is None else f" at {self.isovalue:g}"
        return f"<tegl.Contour{level}: {len(self._core.vertices)} vertices, {len(self._core.simplices)} {what}>"

    def _extent_around(self) -> tuple[np.ndarray | None, str]:
        """The extent for the places of slices, and its source: the image or, if that is not known, the contour itself."""
        if self._extent is not None:
            return self._extent, "image"
        return _outside.extent_around(self.vertices), "contour"

    def _has_range(self, direction: Sequence[float]) -> bool:
        """Whether offsets of slices in this direction have a range: if not, every one has a slice, or none has."""
        normal = self._listed(direction)
        return self._core.cuts_wrapped(normal) and not self._core.has_all_offsets(normal)

    def _has_range_of_places(self, axis: int) -> bool:
        return self._has_range([float(a == axis) for a in range(self.ndim)])

    def _places_within(self, axis: int, places: list[float]) -> list[float]:
        """Longitudes moved by turns into that extent. The library moves places on periodic axes."""
        unit = self.axis_units[axis]
        if self.ndim < 3 or not _tegl.is_longitude_unit(unit) or not self._has_range_of_places(axis):
            return places
        extent, _ = self._extent_around()
        return [_outside.turned(extent, axis, place, self.vertices.dtype, unit) for place in places]

    def _require_places(self, axis: int, places: Sequence[float], given: Sequence) -> None:
        """Raises a ValueError unless all places along an axis lie in that extent. A periodic axis has every place."""
        if not self._has_range_of_places(axis):
            return
        extent, of = self._extent_around()
        _outside.require_places(extent, axis, places, given, self.vertices.dtype, self.axis_names[axis],
                                self.axis_units[axis], of)

    # What can be done with it: see the functions of the same names.

    def unroll(self) -> tuple[Contour, np.ndarray]:
        """An unrolled copy of a wrapped contour (`tegl.contour(..., periodic=...)`), and the number of each of its
        vertices in the wrapped one.

        Simplices across the seam are moved to the end of the period, with copies of their vertices. Vertices and
        simplices keep their numbers; the copies follow. For pictures, and for operations that do not know periods.
        """
        core, originals = _tegl.unroll(self._core)
        return Contour._of(core, self._is_reversed, None, self._grid), originals

    @typing.overload
    def slice(self, at: Place | None = None, *, axis: int | str | None = None,
              normal: Sequence[float] | np.ndarray | None = None, offset: float | None = None,
              allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
              **coordinate: Place) -> Contour: ...

    @typing.overload
    def slice(self, at: Places, *, axis: int | str | None = None, allow_empty: bool = False, threads: int = 0,
              progress: Progress | None = None) -> list[Contour]: ...

    @typing.overload
    def slice(self, at: Labelled, *, axis: int | str | None = None, allow_empty: bool = False, threads: int = 0,
              progress: Progress | None = None) -> Contour | list[Contour]: ...

    @typing.overload
    def slice(self, at: None = None, *, axis: None = None, normal: None = None, offset: None = None,
              allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
              **coordinate: Places | Labelled) -> Contour | list[Contour]: ...

    def slice(self, at=None, *, axis: int | str | None = None, normal=None, offset=None, allow_empty: bool = False,
              threads: int = 0, progress: Progress | None = None, **coordinate) -> Contour | list[Contour]:
        """The slice by a hyperplane: see `tegl.slice`."""
        return self._cut(at, axis, normal, offset, allow_empty, threads, progress, coordinate)

    def _cut(self, at, axis, normal, offset, allow_empty, threads, progress, more) -> Contour | list[Contour]:
        is_checked = not _arguments.as_bool("allow_empty", allow_empty) and self.ndim >= 3
        is_list = _results.is_list
        if normal is not None:
            if at is not None or axis is not None or offset is None or more:
                raise ValueError("normal without offset, or with other arguments; expected normal= and offset=, or at=")
            direction = _arguments.as_numbers("normal", normal, "a number for each axis")
            places: typing.Any = _arguments.as_numbers("offset", offset) if is_list(offset) else \
                _arguments.as_number("offset", offset)
            left = None
            if is_checked and self._has_range(direction):
                extent, of = self._extent_around()
                _outside.require_offsets(extent, direction, places if is_list(offset) else [places], self.vertices.dtype, of)
        else:
            if offset is not None:
                raise ValueError(_results.offset_alone(self.axis_names))
            number, places = _results.named_axis(self.axis_names, self.ndim, self.time_axis, at, axis, more)
            if more:
                raise ValueError(f"no axis is named '{next(iter(more))}'; the contour's are "
                                 f"{', '.join(repr(name) for name in self.axis_names)}")
            direction = [float(a == number) for a in range(self.ndim)]
            unit = self.axis_units[number]
            given = list(places) if is_list(places) else [places]
            wanted = self._places_within(number, [_arguments.number_on_axis(place, unit) for place in given])
            if is_checked:
                self._require_places(number, wanted, given)
            left = _outside.without_axis(self._extent, number)
            places = wanted if is_list(places) else wanted[0]
        several = is_list(places)
        cuts = _tegl.slice_stack(self._core, self._listed(direction), list(places) if several else [places],
                                 _arguments.threads_of(threads), progress)
        found = [Contour._of(cut, self._is_reversed, left) for cut in cuts]
        return found if several else found[0]

    def frame_of(self, *, normal: Sequence[float] | np.ndarray, offset: float) -> Frame:
        """The place of the slice by a hyperplane in the contour's space: see `tegl.frame_of`."""
        direction = _arguments.as_numbers("normal", normal, "a number for each axis")
        origin, axes = _tegl.frame_of(self._core, self._listed(direction), _arguments.as_number("offset", offset))
        return Frame(np.array(self._listed(origin)), np.array(self._listed([self._listed(axis) for axis in axes])))

    def components(self, *, incidence: Incidence | None = None, threads: int = 0,
                   progress: Progress | None = None) -> Components:
        """The connected components: see `tegl.components`."""
        core, shared, threads = self._core, _incidence.core_or_none(incidence), _arguments.threads_of(threads)
        labels = _tegl.label_components(core, threads, _arguments.part_of(progress, 0.0, 0.3))
        found = []
        for one in _tegl.components(core, labels, shared, threads, _arguments.part_of(progress, 0.3, 1.0)):
            for name in ("centroid", "lowest", "highest"):
                one[name] = np.array(self._listed(one[name]))
            found.append(Component(**one))
        return Components(self, labels, found)

    @typing.overload
    def measure(self, *, at: None = None, allow_empty: bool = False, incidence: Incidence | None = None,
                threads: int = 0, progress: Progress | None = None) -> Measures: ...

    @typing.overload
    def measure(self, *, at: Place | Places | Labelled, allow_empty: bool = False, threads: int = 0,
                progress: Progress | None = None) -> CutMeasures: ...

    def measure(self, *, at=None, allow_empty: bool = False, incidence: Incidence | None = None, threads: int = 0,
                progress: Progress | None = None) -> Measures | CutMeasures:
        """Size, content, centroid; with `at`, sizes and contents of slices: see `tegl.measure`."""
        allow_empty = _arguments.as_bool("allow_empty", allow_empty)
        shared = _incidence.core_or_none(incidence)
        if at is not None:
            if shared is not None:
                raise ValueError("incidence with at=; expected one of them: the measures of slices need no incidence")
            unit = self.axis_units[self.time_axis]
            given = list(at) if _results.is_list(at) else [at]
            places = [_arguments.number_on_axis(place, unit) for place in given]
            wanted = self._places_within(self.time_axis, places)
            if not allow_empty and self.ndim > 2:
                self._require_places(self.time_axis, wanted, given)
            size, content = _tegl.measure_cuts(self._core, wanted, _arguments.threads_of(threads), progress)
            return CutMeasures(np.array(places), np.array(size), np.array(content))
        found = _tegl.measure(self._core, shared, _arguments.threads_of(threads), progress)
        for name in ("centroid", "lowest", "highest"):
            found[name] = np.array(self._listed(found[name]))
        return Measures(**found)

    def check(self, *, incidence: Incidence | None = None, threads: int = 0,
              progress: Progress | None = None) -> MeshReport:
        """Checks whether the contour is a manifold: see `tegl.check`."""
        return MeshReport(**_tegl.check(self._core, _incidence.core_or_none(incidence), _arguments.threads_of(threads),
                                        progress))

    def intersections(self, *, tile: float | Sequence[float] | None = None, origin: float | Sequence[float] = 0.0,
                      most_listed: int | None = None, threads: int = 0,
                      progress: Progress | None = None) -> Intersections:
        """Finds all simplices that intersect: see `tegl.intersections`."""
        sizes = None if tile is None else self._of_axes("tile", tile)
        found = _tegl.find_intersections(self._core, sizes, self._of_axes("origin", origin),
                                         _arguments.or_none(_arguments.as_whole, "most_listed", most_listed, 0),
                                         _arguments.threads_of(threads), progress)
        if self._is_reversed:
            found["places"] = found["places"][:, ::-1]
        return Intersections(**found)

    def _of_axes(self, name: str, given: float | Sequence[float] | np.ndarray) -> list[float]:
        """One number for all axes, or one for each, in the library's order."""
        if not _results.is_list(given):
            return [_arguments.as_number(name, given)] * self.ndim
        numbers = _arguments.as_numbers(name, given, "a number, or one for each axis")
        if len(numbers) != self.ndim:
            raise ValueError(f"{name} has {len(numbers)} numbers; expected {self.ndim}, one for each axis")
        return self._listed(numbers)

    @typing.overload
    def simplify(self, ratio: float | None = None, *, count: int | None = None,
                 max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
                 border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
                 scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
                 allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
                 progress: Progress | None = None,
                 return_stats: typing.Literal[False] = False) -> Contour: ...

    @typing.overload
    def simplify(self, ratio: float | None = None, *, count: int | None = None,
                 max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
                 border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
                 scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
                 allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
                 progress: Progress | None = None,
                 return_stats: typing.Literal[True]) -> tuple[Contour, SimplifyStats]: ...

    def simplify(self, ratio: float | None = None, *, count: int | None = None,
                 max_error: float | None = None, method: _kinds.SimplifyMethod = "quadric",
                 border: _kinds.SimplifyBorder = "fixed", max_curvature: float | None = None,
                 scale: Sequence[float] | typing.Literal["auto"] | None = None, measure: bool = True,
                 allow_nonmanifold: bool = False, keep_embedded: bool = False, threads: int = 0,
                 progress: Progress | None = None,
                 return_stats: bool = False) -> Contour | tuple[Contour, SimplifyStats]:
        """The contour with fewer simplices and the same topology: see `tegl.simplify`."""
        return self._simplify(ratio, count, max_error, method, border, max_curvature, scale, measure, allow_nonmanifold,
                              keep_embedded, threads, progress, return_stats)

    def _simplify(self, ratio, count, max_error, method, border, max_curvature, scale, measure, allow_nonmanifold,
                  keep_embedded, threads, progress, return_stats) -> typing.Any:
        if isinstance(scale, str) and scale != "auto":
            raise ValueError(f"scale is '{scale}'; expected 'auto' or a number for each axis")
        factors: list[float] | None = None
        if isinstance(scale, str):
            factors = _tegl.automatic_scale(self._core)
        elif scale is not None:
            given = _arguments.as_numbers("scale", scale, "'auto' or a number for each axis")
            for axis, factor in enumerate(given):
                if not 0 < factor < np.inf:
                    raise ValueError(f"the scale of axis {axis} is {factor:g}; expected a finite number above 0")
            factors = self._listed(given)
        number, either, truth = _arguments.as_number, _arguments.or_none, _arguments.as_bool
        if ratio is not None and (number("ratio", ratio) > 1 or ratio < 0):
            raise ValueError(f"ratio is {ratio}; expected 0 to 1, the fraction of the simplices to keep, or count= with "
                             "their number")
        is_reported = truth("return_stats", return_stats)
        options = {"method": _arguments.as_text("method", method), "border": _arguments.as_text("border", border),
                   "ratio": either(number, "ratio", ratio), "count": either(_arguments.as_whole, "count", count, 0),
                   "max_error": either(number, "max_error", max_error),
                   "max_curvature": either(number, "max_curvature", max_curvature), "scale": factors,
                   "measure": truth("measure", measure),
                   "allow_nonmanifold": truth("allow_nonmanifold", allow_nonmanifold),
                   "keep_embedded": truth("keep_embedded", keep_embedded),
                   "threads": _arguments.threads_of(threads)}
        simplified, stats = _tegl.simplify(self._core, options, progress)
        result = Contour._of(simplified, self._is_reversed, self._extent)
        return (result, SimplifyStats(**stats)) if is_reported else result

    def merge_vertices(self, tolerance: float = 0.0, *, most_listed: int = 1000, threads: int = 0,
                       progress: Progress | None = None) -> tuple[Contour, MergeReport]:
        """The contour with vertices that coincide merged, and a report: see `tegl.merge_vertices`."""
        merged, report = _tegl.merge_vertices(self._core, _arguments.as_number("tolerance", tolerance),
                                              _arguments.as_whole("most_listed", most_listed, 0),
                                              _arguments.threads_of(threads), progress)
        for name in ("vanished", "shrunk"):
            places = np.array(report[name], dtype=np.float64).reshape(-1, self.ndim)
            report[name] = places[:, ::-1] if self._is_reversed else places
        return Contour._of(merged, self._is_reversed, self._extent), MergeReport(**report)

    def elements(self, *, by_cell: bool = False, threads: int = 0, progress: Progress | None = None) -> Elements:
        """Hypersurface elements: see `tegl.elements`."""
        core = self._core
        if _arguments.as_bool("by_cell", by_cell) and self._grid is None:
            raise ValueError("by_cell for a contour whose grid is not known; expected a contour from tegl.contour")
        found = _tegl.elements(core, self._grid if by_cell else None, _arguments.threads_of(threads), progress)
        return Elements(found, self._is_reversed,
                        "normal" in core.simplex_attributes and "normal" not in core.vertex_attributes)

    def track(self, *, min_lifetime: float = 0.0, times: int | Places | Labelled | None = None,
              first: Place | None = None, last: Place | None = None, handles: bool = True, label_simplices: bool = False,
              allow_empty: bool = False, incidence: Incidence | None = None, threads: int = 0,
              progress: Progress | None = None) -> TrackGraph:
        """Tracks the parts of the contour: see `tegl.track`."""
        allow_empty = _arguments.as_bool("allow_empty", allow_empty)
        unit = self.axis_units[self.time_axis]
        wanted: list[float] = []
        if times is None:
            places: list[float] = []
        elif isinstance(times, (int, np.integer)):
            count = _arguments.as_whole("times", times, 0)
            along = self.vertices[:, self.time_axis]
            places = _tegl.even_times(float(along.min()), float(along.max()), count) if len(along) else []
        else:
            given = _arguments.as_list("times", times, "a list of times, or a whole number of even ones")
            wanted = [_arguments.number_on_axis(time, unit) for time in given]
            places = wanted if allow_empty else self._places_within(self.time_axis, wanted)
            if any(after <= before for before, after in zip(places, places[1:])):
                places = wanted  # moved, they would not ascend
            if not allow_empty:
                self._require_places(self.time_axis, places, given)
        found = _tegl.track(self._core, _arguments.as_number("min_lifetime", min_lifetime), places,
                            None if first is None else _arguments.number_on_axis(first, unit),
                            None if last is None else _arguments.number_on_axis(last, unit),
                            _arguments.as_bool("handles", handles),
                            _arguments.as_bool("label_simplices", label_simplices),
                            _incidence.core_or_none(incidence), _arguments.threads_of(threads), progress)
        return TrackGraph(found, self._is_reversed, unit, dict(zip(places, wanted)))

    @_arguments.documents("sample")
    def sample(self, array, name: str, unit: str = "", *, threads: int = 0, progress: Progress | None = None,
               **grid) -> np.ndarray:
        """The values of another array at the vertices, added to the contour as the attribute `name`: #V numbers.

        The array (with spacing, origin, coords, ... as in `tegl.contour`) has as many axes as the contour, in the same
        order, and the same world coordinates; its grid may differ. Later slices, splits and simplifications of the contour
        inherit the attribute, and so do its elements.
        """
        given: dict[str, typing.Any] = {"time_axis": self.time_axis, **grid}
        prepared = _arguments.prepare(array, **given)
        if prepared.is_reversed != self._is_reversed:
            raise ValueError(f"the array has another time_axis than the contour; expected {self.time_axis}")
        if prepared.names != self.axis_names and sorted(prepared.names) == sorted(self.axis_names):
            raise ValueError(f"the array has the axes {', '.join(prepared.names)}; expected the contour's order, "
                             f"{', '.join(self.axis_names)}")
        if not _arguments.as_text("name", name):
            raise ValueError("name is ''; expected a name for the attribute")
        _tegl.sample(self._core, prepared.image, name, _arguments.as_text("unit", unit), _arguments.threads_of(threads),
                     progress)
        return self.vertex_attributes[name]

    @_arguments.documents("write_mesh")
    def save(self, path: str | os.PathLike, *, progress: Progress | None = None) -> None:
        """Writes a file, in the format of its suffix: .ply, .gltf, .glb, .obj (2D, 3D), .stl (3D) or .vtkhdf (2D to 5D).

        Files have the coordinates x, y, z and t, from arrays over (t, z, y, x).
        """
        _tegl.write_contour(self._core, os.fspath(path), progress)

    @staticmethod
    def load(path: str | os.PathLike, *, time_axis: int = 0, allow_outside_paths: bool = False,
             separate_process: bool = False, progress: Progress | None = None) -> Contour:
        """Reads a contour from a file: see `tegl.load`."""
        return load(path, time_axis=time_axis, allow_outside_paths=allow_outside_paths,
                    separate_process=separate_process, progress=progress)

    # For other programs. Their points are x, y, z (and t): the library's order of axes, as in files.

    def points_and_cells(self) -> tuple[np.ndarray, list[tuple[str, np.ndarray]]]:
        """(points, cells) in the form of meshio: points #V x N as x, y, z, t; cells [("triangle", #S x N)]."""
        return _export.points_and_cells(self._core)

    def to_meshio(self) -> typing.Any:
        """A meshio.Mesh with points x, y, z; the t of 4D contours is point data. A wrapped contour is a ValueError:
        `unroll` it. Needs meshio."""
        return _export.to_meshio(self._core)

    def to_vtk(self) -> typing.Any:
        """A vtkPolyData of segments or triangles, or a vtkUnstructuredGrid of tetrahedra with t as a point array, with
        normals and attributes, points as x, y, z. A wrapped contour is a ValueError: `unroll` it. Needs VTK's Python
        modules."""
        return _export.to_vtk(self._core)

    def to_pyvista(self) -> typing.Any:
        """The mesh of `to_vtk` as a mesh of pyvista. Needs pyvista."""
        return _export.to_pyvista(self._core)


class Components(Sequence[Component]):
    """The components of a contour, in the order of their labels."""

    def __init__(self, contour: Contour, labels: _tegl.ComponentLabels, found: list[Component]) -> None:
        self._contour, self._labels, self._found = contour, labels, found

    @property
    def vertex_labels(self) -> np.ndarray:
        """#V labels; 2**32 - 1 for vertices in no simplex."""
        return self._labels.vertices

    @property
    def simplex_labels(self) -> np.ndarray:
        """#S labels."""
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
        """One contour per component."""
        return [Contour._of(part, self._contour._is_reversed, self._contour._extent, self._contour._grid)
                for part in _tegl.split_components(self._contour._core, self._labels, progress)]

    @_arguments.documents("select_components")
    def select(self, keep, *, progress: Progress | None = None) -> Contour:
        """The contour of selected components: a truth value for each component, or the labels of those to keep."""
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

    @_arguments.documents("nearest_component")
    def nearest(self, point: Sequence[float] | np.ndarray, *, steps: float | Sequence[float] | np.ndarray = 1.0,
                progress: Progress | None = None) -> int:
        """The label of the component with the vertex nearest to a point, in the contour's coordinates.

        `steps`: divide distances along the axes, one number or one for each axis. `select` of the label is the
        component's contour. It works for all contours, also of lattices and meshes. ValueError for an empty contour.
        """
        place = _arguments.as_numbers("point", point, "its coordinates along the contour's axes")
        at, divisors = self._contour._listed(place), self._contour._of_axes("steps", steps)
        with _arguments.array_terms(self._contour._is_reversed, self._contour.ndim):
            found = _tegl.nearest_component(self._contour._core, self._labels, at, divisors, progress)
        if found is None:
            raise ValueError("the component nearest to a point: the contour is empty")
        return found[0]

    def largest(self, count: int = 1, *, progress: Progress | None = None) -> Contour:
        """The contour of the largest components by size."""
        count = _arguments.as_whole("count", count, 0)
        order = sorted(range(len(self)), key=lambda label: (-self._found[label].size, label))
        return self.select(np.array(order[:count], dtype=np.int64), progress=progress)


def _is_flat_normal(of: str, name: str, values: np.ndarray) -> bool:
    """Whether an attribute is the normals of simplices, whose columns belong to the axes."""
    return of == "simplex_attributes" and name == "normal" and values.ndim == 2


def _restored(of: type[Contour], *parts) -> Contour:
    """A contour from a pickle or a copy: it has the extent of its image, but not the grid."""
    return of._of(_tegl.Contour.from_arrays(*parts[:-2]), *parts[-2:])


@_arguments.documents("read_mesh")
def load(path: str | os.PathLike, *, time_axis: int = 0, allow_outside_paths: bool = False,
         separate_process: bool = False, progress: Progress | None = None) -> Contour:
    """Reads a contour from a file: .vtkhdf, .ply, .gltf, .glb, .stl, .obj.

    Files have x, y, z and t. With `time_axis=0` the columns are (t,) z, y, x, as for contours of arrays in C order; with
    -1 they are x, y, z (, t).

    A file may refer to further files: buffers of glTF, links and external storage of HDF5. These are read in the folder
    of `path` and below it; with `allow_outside_paths=True` also elsewhere. With `separate_process` a .vtkhdf is read in a
    child process, as in `tegl.read`.
    """
    core = _tegl.load_contour(os.fspath(path), _arguments.as_bool("allow_outside_paths", allow_outside_paths),
                              _arguments.as_bool("separate_process", separate_process), progress)
    return Contour._of(core, _arguments.turn_around(time_axis, core.ndim))
