# SPDX-License-Identifier: BSD-3-Clause
"""Contours of arrays, slices of contours and of arrays, and images from files."""

from __future__ import annotations

import builtins
import dataclasses
import os
import typing
from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _curved, _facets, _kinds, _labels, _results, _outside, _periods, _tegl
from ._arguments import Labelled, Place, Places, Progress
from ._contour import Contour
from ._facets import Facets
from ._fields import LATTICES, lattice_spacing


@_arguments.documents("extract", "ExtractOptions", "Ambiguity", "extract_placed", "extract_cells")
def contour(array, level: float | None = None, *, label: float | None = None, spacing=None, origin=None, coords=None,
            affine=None, mask=None, axis_names: Sequence[str] | None = None, axis_units: Sequence[str] | None = None,
            time_axis: int | None = None, triangulation: _kinds.Triangulation = "compact",
            ambiguity: _kinds.Ambiguity = "low", direction: _kinds.Direction = "descent", close: bool = False,
            epsilon: float = 0.0, normals: bool | _kinds.Normals | np.ndarray = False, gradient: _kinds.Gradient = "differences",
            dtype=np.float32, allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
            periodic=None, lattice: _kinds.Lattice | typing.Literal["cubic"] | None = None, division: _kinds.Division | None = None,
            positions: _kinds.Positions | _arguments.PositionFunction = "linear", positions_image=None, time_weight: float = 1.0,
            samples: _kinds.Samples = "points", curved=None) -> Contour:
    """The contour {value = level} of an array of 2 to 5 axes. It separates samples >= level from the others.

    array
        A NumPy array of real numbers with any strides, a masked array, an xarray.DataArray (with its coordinates, names
        and units), or an image from `tegl.read`. uint8, int8, uint16, int16, int32, float32 and float64 are read in
        place; bool counts as uint8; other types are copied to one of these. NaN is a missing value: there is no
        contour next to it.
    level
        The isovalue. With `positions` "relaxed" it may be left out for an array of exactly two values: their middle.
    label
        In place of `level`: the contour at 0.5 of the mask that is 1 at the samples of this value, 0 elsewhere.
    spacing, origin
        Distance of the samples along each axis, and coordinate of the first one, in the order of the array's axes; or
        one number for all. They take the place of the coordinates of an xarray or image, and of their units.
    coords
        The coordinates of the samples along each axis, instead of `spacing` and `origin`: ascending or descending, in
        any steps. None for an axis that keeps its coordinates and its unit: those of an xarray or image, otherwise the
        indices. Other axes have no unit without `axis_units`, unless there is an affine map.
    affine
        A matrix of N x (N+1) or (N+1) x (N+1) numbers that maps these coordinates to world coordinates, as in NIfTI.
    mask
        True for valid samples, as in scikit-image; the others are missing. (The mask of a masked array of numpy.ma, which
        has the opposite sense, is handled too.) With a mask the values are copied.
    time_axis
        The axis that `slice`, `track` and `measure` use as the time: 0, the first (default), or -1, the last. Default
        for xarray: the axis with dates or named "time" or "t".
    triangulation
        "compact", or "barycentric": more simplices, none of them flat unless points coincide.
    ambiguity
        The rule for ambiguous cells: "low" separates and "high" joins the samples inside; "mean" and "saddle" decide by
        the values, "squares" and "decider" also, but only in squares. See docs/ambiguity.md.
    direction
        The direction of simplices and normals: "descent", towards lower values, or "ascent".
    close
        Whether the contour is closed at the border of the array.
    epsilon
        Minimum distance of vertices from samples, as a fraction of an edge: above 0, it avoids flat simplices.
    normals, gradient
        Whether to compute normals: True or "gradient" (from the gradients of the values), "sobel" or "prewitt" (from
        gradients by these kernels, for noise; "sobel" is also True with gradient="sobel"), "context" (from the samples on
        the same side of jumps, for several materials; adds the attribute `normal_uncertainty`), "forward" or "backward"
        (differences), a kernel as an array of the shape (3, ..., 3) or (N, 3, ..., 3), "geometric" (from the simplices around
        each vertex) or "flat" (of simplices: the attribute `normal` in `simplex_attributes`). See docs/normals.md.
    dtype
        Type of the vertices: float32 or float64.
    allow_empty
        Whether a level outside of the values gives an empty contour. Otherwise it is a ValueError with the range of the
        values.
    threads
        Number of threads; 0: all processors. The result does not depend on it.
    progress
        Called repeatedly with the fraction done. If it returns False, the call raises `tegl.Cancelled`. Ctrl-C ends the
        call too.
    periodic
        Axes that are periodic: a name or number, or "lon" or "longitude" for the axis along which longitudes run around
        the globe, a list of these, "all", a dict of axes and their periods, or "auto": the
        longitudes (by their unit, degrees_east) that span 360 degrees, if there are any; None or "none": no axis. Without a
        dict, the period is the number of samples x the step, or 360 for axes with a unit of degrees_east. It must be more
        than twice each step, the one across the seam included. The contour is *wrapped*: it continues across the seam, and
        `Contour.unroll` makes one for pictures. Longitudes at the end that repeat the first ones 360 degrees further, as in
        global ocean grids, are left out if their values are equal, up to rounding; otherwise they are an error. On a curved
        grid, the last samples along the axis are connected to the first ones: at their own places (O-grids), 360 further
        along longitudes, or by a given period along the axis's own coordinate, in the direction in which that grows. See
        docs/other-tilings.md.

    lattice
        Samples on a staggered lattice: the odd layers of the last library axis (of C-ordered arrays, the first axis) are
        shifted by half a step along the other axes. "triangular" (2D), "fcc" or "bcc" (3D), "d4" (4D), or "fcc_in_time"
        (4D: fcc in the last three axes, over time). For arrays without `spacing`, `coords` and `affine`, the step between
        layers is 0.866, 0.707 or 0.5, with which the lattice is regular. Default: that of an image from `tegl.read`, which
        "cubic" overrides. With `periodic`, the layers must be even in number. See docs/other-tilings.md.
    division
        How cells are divided into simplices: "kuhn" or "symmetric", in 2D and 3D also "alternating", or "hybrid", which
        divides ambiguous cells only. May be combined with `periodic`. In 5D without "barycentric". See docs/other-tilings.md.
    positions
        Where vertices lie between two samples: "linear" (interpolation), "relaxed" (smooth surfaces of masks and labels,
        without stair steps; every sample stays on its side), "filtered" (linear in `positions_image`) or "gravitation"
        (moved towards neighbouring samples, for masks). Or a function `positions(first, second, level)` of two arrays with
        the samples at the ends of many edges, one of them at or above the level and the other below. It returns an array
        with the positions, from 0 at the first sample to 1 at the second, or one number for all; others are clamped. Not
        with `periodic` and `lattice`. See docs/positions.md.
    positions_image
        For "filtered": an array of the same shape, such as a smoothed one. Its samples are clamped to the side of the
        array's samples. Where it is NaN, the array's own sample counts.
    time_weight
        For "relaxed": weight of the smoothing along the `time_axis` relative to the others; 0: each layer by itself.
    samples
        "points", or "cells": samples are small squares, cubes or tesseracts. The contour runs along the faces between high
        and low cells and encloses their exact volume; with `positions` "relaxed" or "gravitation" it gets a smooth shape.
        It is always closed. For 2 to 4 axes. "file": as `Image.samples_are_cells` says. See docs/cells.md.
    curved
        Coordinates of the samples of a curved grid, in place of `coords` of some axes: a dict of axes (names or numbers) and
        arrays of coordinates with as many axes as `array`, and size 1 along the axes on which they do not depend, such as
        `{"lon": lon[None], "lat": lat[None]}` for 2D arrays and values over time. Or an array of the shape (..., N), whose last
        axis has the coordinates of each sample, as of VTK's structured grids. float32 and float64 in C order (with
        `time_axis=-1` in Fortran order) are read in place; coordinates of a sample side by side in memory take less time. For
        several contours: a `tegl.CurvedGrid`. Samples without a coordinate, by the mask of a masked array, are missing. Default: the image's own, from `tegl.read`, and
        the longitude and latitude in two dimensions of an xarray, unless `spacing`, `origin`, `affine`, or `coords` for the
        axes of both are given in their place. Longitudes (by `axis_units`, degrees_east) are continued
        across 180 degrees, in a copy if they must be. Numbers that cannot be places are unknown, and an error if the contour
        needs them: fill values such as 1e20, latitudes beyond 90, and longitudes beyond 720 degrees (those of several turns
        are to be shifted by multiples of 360). See docs/other-tilings.md.

    The columns of the vertices are in the order of the array's axes. Errors: ValueError, with the library's message;
    OverflowError for a contour that is too large; MemoryError.
    """
    options = _arguments.extract_options(triangulation=triangulation, ambiguity=ambiguity, direction=direction,
                                         close=close, epsilon=epsilon, normals=normals, gradient=gradient,
                                         threads=threads)
    if label is not None:
        if level is not None:
            raise ValueError(f"level {level!r} with label {label!r}; expected one of the two")
        array, level = _labels.mask_of(array, label), 0.5
    if any(given is not None for given in (curved, spacing, origin, affine)):
        array = _arguments.without_longitude_and_latitude(array)
    elif coords is not None:
        coords = _arguments.listed_coords(coords)
        array = _arguments.without_replaced(array, coords)
    prepared = _prepared_on(lattice, array, spacing=spacing, origin=origin, coords=coords, affine=affine, mask=mask,
                            axis_names=axis_names, axis_units=axis_units, time_axis=time_axis,
                            hidden=None if curved is None else _curved.masked_samples(curved), allow_curved=True)
    if level is None and positions != "relaxed":
        raise TypeError("level is missing; expected a number, such as tegl.contour(array, 0.5)")
    if level is None:
        level = _labels.middle_of(prepared.image.array)
    instead = ""
    if curved is None and (curved := _arguments.own_curved(array) or None) is not None:
        instead = f", or {_arguments.without_curved(array)} in place of the image"
    lattice = _lattice_of(array, lattice)
    is_double = _arguments.is_double(dtype, prepared)
    values = _arguments.position_values(positions, positions_image, prepared)
    weight = _arguments.as_number("time_weight", time_weight)
    if weight != 1 and positions != "relaxed":
        raise ValueError(f"time_weight is {time_weight!r} with positions {positions!r}; expected positions='relaxed'")
    if _arguments.as_text("samples", samples) not in ("points", "cells", "file"):
        raise ValueError(f"samples is {samples!r}; expected one of 'points', 'cells', 'file'")
    if samples == "file" and not isinstance(array, Image):
        raise ValueError(f"samples is 'file' for a {type(array).__name__}; expected an image from tegl.read")
    of_cells = samples == "cells" or (samples == "file" and array.samples_are_cells)
    level, allow_empty = _arguments.as_level(level), _arguments.as_bool("allow_empty", allow_empty)
    options = prepared.library_options(options)
    periodic = _periods.given_or_none(periodic)
    of_samples, no_places = ([], []) if curved is None else _curved.coordinates_of(curved, prepared)
    if curved is not None:
        _refuse_other_coordinates([one[0] for one in of_samples], prepared, spacing, origin, coords, affine, instead)
    with _curved.naming(no_places), prepared.terms():
        given = [name for name, value in (("lattice", lattice), ("division", division), ("periodic", periodic),
                                          ("samples" if of_cells else "positions",
                                           None if positions == "linear" and not of_cells else positions),
                                          ("curved", curved))
                 if value is not None]
        if given not in (["positions", "curved"], ["lattice", "periodic"], ["division", "periodic"],
                         ["periodic", "curved"]) and len(given) > 1:
            raise ValueError(f"{given[0]} with {given[1]}; expected one of the two")
        axes, periods = ([], []) if periodic is None else _periods.axes_of(periodic, prepared, of_samples)
        if division is not None:
            core = _tegl.extract_divided(prepared.image, _arguments.as_text("division", division), axes, periods, level,
                                         is_double, options, progress)
        elif positions != "linear" or of_cells:
            faces = _cell_faces(array, prepared, (spacing, origin, coords)) if of_cells else None
            rule = "custom" if callable(positions) else positions
            core = _tegl.extract_placed(prepared.image, rule, values, _arguments.position_function(positions), 0.01, weight,
                                        faces, of_samples, level, is_double, options, progress)
            if curved is not None:
                _curved.warn_of_folds(curved, prepared, of_samples, [], [])
        elif lattice is not None:
            core = _tegl.extract_lattice(prepared.image, _arguments.as_text("lattice", lattice), axes, periods, level,
                                         is_double, options, progress)
        elif curved is not None:
            core = _tegl.extract_curved(prepared.image, of_samples, axes, periods, level, is_double, options, progress)
            _curved.warn_of_folds(curved, prepared, of_samples, axes, periods)
        elif not axes:
            core = _tegl.extract(prepared.image, level, is_double, options, progress)
        else:
            core = _tegl.extract_periodic(prepared.image, axes, periods, level, is_double, options, progress)
    if not allow_empty and not len(core.simplices):
        _outside.require_level(prepared, level)
    if curved is not None:
        return Contour._of(core, prepared.is_reversed)
    return Contour._of(core, prepared.is_reversed, prepared.extent, prepared.image.grid)


def _prepared_on(lattice, array, *, allow_curved: bool, **grid: typing.Any) -> _arguments.Prepared:
    """A prepared array; without coordinates, its layers have the step with which the lattice is regular."""
    prepared = _arguments.prepare(array, allow_curved=allow_curved, allow_lattice=True, **grid)
    if (lattice not in LATTICES or not isinstance(array, np.ndarray)
            or any(grid[name] is not None for name in ("spacing", "coords", "affine"))):
        return prepared
    grid["spacing"] = prepared.turned(lattice_spacing(lattice, prepared.ndim))
    return _arguments.prepare(array, **grid)


@_arguments.documents("extract_facets", "FacetHierarchy", "extract_facets_3")
def contour_facets(array, level: float, *, spacing=None, origin=None, coords=None, affine=None, mask=None,
                   axis_names: Sequence[str] | None = None, axis_units: Sequence[str] | None = None,
                   time_axis: int | None = None, ambiguity: _kinds.Ambiguity = "low",
                   direction: _kinds.Direction = "descent", close: bool = False, epsilon: float = 0.0,
                   normals: bool | _kinds.Normals | np.ndarray = False, dtype=np.float32, allow_empty: bool = False,
                   threads: int = 0, progress: Progress | None = None, periodic=None,
                   lattice: _kinds.Lattice | typing.Literal["cubic"] | None = None,
                   division: _kinds.Division | None = None) -> Facets:
    """The contour {value = level} of an array of 2 to 4 axes as facets: points, segments, polygons and polyhedra with their
    incidences, as the grid cuts the contour.

    Arguments as for `tegl.contour`; normals are from the gradient. `tegl.contour` makes simplices of these facets:
    both have the same points, components and Euler characteristic. Facets of meshes: `tegl.contour_mesh_facets`.
    """
    _facets.gradient_only(normals)
    options = _arguments.extract_options(triangulation="compact", ambiguity=ambiguity, direction=direction, close=close,
                                         epsilon=epsilon, normals=normals, gradient="differences", threads=threads)
    prepared = _prepared_on(lattice, array, spacing=spacing, origin=origin, coords=coords, affine=affine, mask=mask,
                            axis_names=axis_names, axis_units=axis_units, time_axis=time_axis, allow_curved=False)
    on, simplices = _lattice_of(array, lattice) or "", _arguments.as_text("division", "" if division is None else division)
    if on and simplices:
        raise ValueError(f"lattice '{on}' with division; expected one of the two")
    is_double = _arguments.is_double(dtype, prepared)
    level, allow_empty = _arguments.as_level(level), _arguments.as_bool("allow_empty", allow_empty)
    options = prepared.library_options(options)
    periodic = _periods.given_or_none(periodic)
    with prepared.terms():
        axes, periods = ([], []) if periodic is None else _periods.axes_of(periodic, prepared)
        core = _tegl.extract_facets(prepared.image, on, simplices, axes, periods, level, is_double, options, progress)
    if not allow_empty and not len(core.vertices):
        _outside.require_level(prepared, level)
    return Facets(core, prepared.is_reversed)


class ContourSize(typing.NamedTuple):
    """The numbers of vertices and simplices of a contour."""

    vertices: int
    simplices: int


@_arguments.documents("count", "count_periodic")
def count(array, level: float, *, spacing=None, origin=None, coords=None, affine=None, mask=None,
          axis_names: Sequence[str] | None = None, axis_units: Sequence[str] | None = None, time_axis: int | None = None,
          triangulation: _kinds.Triangulation = "compact", ambiguity: _kinds.Ambiguity = "low", close: bool = False,
          threads: int = 0, progress: Progress | None = None, periodic=None, lattice: _kinds.Lattice | typing.Literal["cubic"] | None = None,
          division: _kinds.Division | None = None) -> ContourSize:
    """The size of the contour that `contour` makes with the same arguments, without making it: (vertices, simplices).

    Arguments are those of `tegl.contour`. A level outside of the values gives (0, 0). Of meshes: `tegl.count_mesh`.
    """
    options = _arguments.extract_options(triangulation=triangulation, ambiguity=ambiguity, direction="descent",
                                         close=close, epsilon=0.0, normals=False, gradient="differences",
                                         threads=threads)
    prepared = _arguments.prepare(array, spacing=spacing, origin=origin, coords=coords, affine=affine, mask=mask,
                                  axis_names=axis_names, axis_units=axis_units, time_axis=time_axis, allow_curved=True,
                                  allow_lattice=True)
    level = _arguments.as_level(level)
    options = prepared.library_options(options)
    lattice = _lattice_of(array, lattice)
    periodic = _periods.given_or_none(periodic)
    with prepared.terms():
        given = [name for name, value in (("lattice", lattice), ("division", division), ("periodic", periodic))
                 if value is not None]
        if len(given) > 1 and given not in (["lattice", "periodic"], ["division", "periodic"]):
            raise ValueError(f"{given[0]} with {given[1]}; expected one of the two")
        axes, periods = ([], []) if periodic is None else _periods.axes_of(periodic, prepared)
        points = _arguments.as_text("lattice", "" if lattice is None else lattice)
        simplices = _arguments.as_text("division", "" if division is None else division)
        return ContourSize(*_tegl.count(prepared.image, axes, periods, points, simplices, level, options, progress))


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


@_arguments.documents("slice", "slice_image")
def slice(contour_or_array, level: float | None = None, *, at=None, axis: int | str | None = None, normal=None,
          offset=None, allow_empty: bool = False, threads: int = 0, progress: Progress | None = None,
          **more) -> Contour | list[Contour]:
    """The slice of a contour by a hyperplane, one dimension lower: a moving surface at one time.

    ::

        tegl.slice(contour, at=7.3)                          # the time axis
        tegl.slice(contour, lat=-20.5)                       # an axis by its name
        tegl.slice(contour, at=3.0, axis=2)                  # or by its number
        tegl.slice(contour, at=[1.5, 7.3])                   # several, in one pass: a list
        tegl.slice(contour, normal=(0, 1, 1, 0), offset=9)   # any hyperplane <normal, x> = offset
        tegl.slice(array, 20.0, at=7.3)                      # directly from an array: reads only the adjacent layers

    The last form also takes the arguments of `tegl.contour`. An axis with the name of an argument (level, offset) is
    given by at= and axis=. Places may be dates (of any type, or text) if the axis's unit contains a start date, and
    durations if the unit is hours, days, ... For 3D and 4D contours.

    A place outside of the image (or of the contour, if its image is unknown) is a ValueError with the range and its
    unit, and so is a level outside of the array's values; with `allow_empty` the slice is empty instead. A slice within the
    image that misses the contour is always empty.
    """
    if isinstance(contour_or_array, Contour):
        if level is not None and "level" in contour_or_array.axis_names:  # an axis of pressures
            more["level"], level = level, None
        if level is not None:
            raise ValueError(f"level is {level} and the first argument a contour, which has its level; expected at=")
        return contour_or_array._cut(at, axis, normal, offset, allow_empty, threads, progress, more)
    if level is None:
        raise ValueError("no level for the slice of an array; expected tegl.slice(array, level, at=...)")
    return _cut_image(contour_or_array, _arguments.as_level(level), at, axis, normal, offset, allow_empty,
                      threads, progress, more)


_GRID = ("spacing", "origin", "coords", "affine", "mask", "axis_names", "axis_units", "time_axis")


def _lattice_of(array, lattice: _kinds.Lattice | typing.Literal["cubic"] | None) -> _kinds.Lattice | None:
    """The argument `lattice`, or the image's own."""
    name = "lattice"
    if lattice is None:
        lattice = typing.cast("_kinds.Lattice | None", _arguments.own_lattice(array))
        name = "the attribute 'sample_lattice'"
    if isinstance(lattice, str) and lattice != "cubic" and lattice not in LATTICES:
        raise ValueError(f"{name} is {lattice!r}; expected one of {', '.join(map(repr, LATTICES))}, or 'cubic'")
    return None if lattice == "cubic" else typing.cast("_kinds.Lattice | None", lattice)


def _cut_image(array, level, at, axis, normal, offset, allow_empty, threads, progress, more) -> Contour | list[Contour]:
    if normal is not None:  # an oblique slice needs the whole contour
        whole = contour(array, level, allow_empty=allow_empty, threads=threads,
                        progress=_arguments.part_of(progress, 0.0, 0.5), **more)
        return whole._cut(at, axis, normal, offset, allow_empty, threads, _arguments.part_of(progress, 0.5, 1.0), {})
    if offset is not None:
        raise ValueError(_results.offset_alone(()))
    prepared = _arguments.prepare(array, **{name: more.pop(name) for name in _GRID if name in more})
    is_double = _arguments.is_double(more.pop("dtype", np.float32), prepared)
    time_axis = 0 if prepared.is_reversed else prepared.ndim - 1
    number, places = _results.named_axis(prepared.names, prepared.ndim, time_axis, at, axis, more)
    options = prepared.library_options(_arguments.extract_options(threads=threads, **more))
    unit = prepared.units[number]
    given = list(places) if _results.is_list(places) else [places]
    wanted = [_arguments.number_on_axis(place, unit) for place in given]
    kind = np.float64 if is_double else np.float32

    extent = prepared.extent if prepared.ndim >= 3 else None  # for others the library raises the error
    wanted = [_outside.turned(extent, number, place, kind, unit) for place in wanted]
    if not _arguments.as_bool("allow_empty", allow_empty):
        _outside.require_places(extent, number, wanted, given, kind, prepared.names[number], unit, "image")

    def cut(i: int) -> _tegl.Contour:
        if _outside.is_outside(extent, number, wanted[i], kind):
            return _nothing(prepared, number, level, options["direction"], kind)
        return _tegl.slice_image(prepared.image, level, prepared.library_axis(number), wanted[i], is_double, options,
                                 _arguments.part_of(progress, i / len(wanted), (i + 1) / len(wanted)))

    with prepared.terms():
        found = [cut(i) for i in range(len(wanted))]
    if not allow_empty and found and not any(len(one.simplices) for one in found):
        _outside.require_level(prepared, level, "slice")
    left = _outside.without_axis(prepared.extent, number)
    cuts = [Contour._of(one, prepared.is_reversed, left) for one in found]
    return cuts if _results.is_list(places) else cuts[0]


def _nothing(prepared: _arguments.Prepared, axis: int, level: float, direction: str, kind) -> _tegl.Contour:
    """The empty slice outside of an image."""
    def others(labels: Sequence[str]) -> list[str]:
        return prepared.turned([label for number, label in enumerate(labels) if number != axis])

    rows = np.empty((0, prepared.ndim - 1), dtype=kind)
    return _tegl.Contour.from_arrays(rows, rows.astype(np.uint32), None, others(prepared.names), others(prepared.units),
                                     direction, level, [], [])


@dataclasses.dataclass(frozen=True)
class Image:
    """An array with its coordinates, the result of `tegl.read`. Lists by axis are in the order of the array's axes."""

    array: np.ndarray
    coords: tuple[np.ndarray, ...]  #: of the samples along each axis
    axis_names: tuple[str, ...]
    axis_units: tuple[str, ...]
    affine: np.ndarray | None  #: N x (N+1), maps `coords` to world coordinates; None: identity
    time_axis: int  #: 0 or N - 1
    value_name: str
    value_unit: str
    format: str  #: such as "netCDF"
    variable: str  #: the variable that was read, of a file with several
    variables: tuple[str, ...]  #: all variables that can be read as an image
    world_frame: str  #: such as "RAS"; "" if there is none
    #: direction of growing coordinates of each axis, from the file: "up", "down" (depths, pressures) or "unknown"
    axis_directions: tuple[_kinds.AxisDirection, ...]
    _axes: tuple = dataclasses.field(repr=False, default=())
    #: coordinates of a curved grid, by axis: see `tegl.contour`; those axes have indices as `coords`. {}: straight axes
    curved: dict[int, np.ndarray] = dataclasses.field(repr=False, default_factory=dict)
    #: the lattice that the samples are on, as the file says: "fcc", ...; None: a cubic grid. `tegl.contour` uses it.
    lattice: _kinds.Lattice | None = None
    samples_are_cells: bool = False  #: whether the file says that the samples are cells, for `samples="file"`
    #: coordinates of the faces between cells along each axis, one more than samples, of files with cells of uneven size
    #: (.vtr); () or an empty array: midway between `coords`
    cell_faces: tuple[np.ndarray, ...] = dataclasses.field(repr=False, default=())

    def __repr__(self) -> str:
        """Three lines: values, axes, source."""
        def shown(text: str) -> str:  # with control characters escaped
            return text if text.isprintable() else repr(text)[1:-1]

        def along(axis: int) -> str:
            unit = f" {shown(self.axis_units[axis])}" if self.axis_units[axis] else ""
            coords = self.coords[axis]
            if axis in self.curved:  # `coords` are indices
                known = self.curved[axis][np.isfinite(self.curved[axis])]
                coords = np.array([known.min(), known.max()]) if known.size else known
            ends = f"{coords[0]:g} to {coords[-1]:g}" if len(coords) > 1 else "".join(f"{one:g}" for one in coords)
            return f"{shown(self.axis_names[axis]) or f'axis {axis}'} {ends}{unit}{' (curved)' if axis in self.curved else ''}"

        name = f" {shown(self.variable or self.value_name)}" if self.variable or self.value_name else ""
        unit = f" in {shown(self.value_unit)}" if self.value_unit else ""
        world = f", world {shown(self.world_frame)}" if self.world_frame else ""
        affine = ", with an affine map" if self.affine is not None else ""
        others = len(self.variables) - 1
        more = f", one of {others + 1} variables" if others > 0 else ""
        return (f"<tegl.Image{name}{unit}: {' x '.join(map(str, self.array.shape))} {self.array.dtype}\n"
                f"  axes: {'; '.join(map(along, range(self.array.ndim)))}\n"
                f"  time_axis {self.time_axis}{affine}{world}, read from {self.format}{more}>")

    def __tegl_image__(self):
        return (self._axes, self.axis_names, self.axis_units, self.affine, self.time_axis, self.value_unit, self.array)

    def contour(self, level: float | None = None, **options: typing.Any) -> Contour:
        """The contour of this image: see `tegl.contour`."""
        return contour(self, level, **options)

    def contour_facets(self, level: float, **options: typing.Any) -> Facets:
        """The contour of this image as facets: see `tegl.contour_facets`."""
        return contour_facets(self, level, **options)

    def to_xarray(self) -> typing.Any:
        """An xarray.DataArray with these names, coordinates, units and directions (CF's "positive"); the affine map is its
        attribute "affine", for the dimensions in "affine_axes", the lattice its attribute "sample_lattice", for
        the dimensions in "sample_lattice_axes". On a curved grid, the coordinates "lat" and "lon" belong to the dimensions
        "lat_index" and "lon_index". Functions find the affine map again, also in another order of the dimensions; `tegl.contour`
        also finds lattices, in this order of the dimensions only, and curved coordinates."""
        try:
            import xarray
        except ImportError as error:
            raise ImportError(f"to_xarray needs xarray, which cannot be imported: {error}") from error
        names = [name or f"axis_{number}" for number, name in enumerate(self.axis_names)]
        dims = [name + _arguments.INDEX_SUFFIX if axis in self.curved else name for axis, name in enumerate(names)]
        coords: dict[str, typing.Any] = {}
        for axis, (name, values) in enumerate(zip(names, self.coords)):
            unit, direction = self.axis_units[axis], self.axis_directions[axis]
            along = [axis]
            if axis in self.curved:
                along = [one for one, size in enumerate(self.curved[axis].shape) if one == axis or size > 1]
                values = self.curved[axis].reshape([self.curved[axis].shape[one] for one in along])
            coords[name] = ([dims[one] for one in along], values,
                            {**({"units": unit} if unit else {}),
                             **({"positive": direction} if direction != "unknown" else {})})
        attrs: dict[str, typing.Any] = {"units": self.value_unit} if self.value_unit else {}
        if self.value_name:
            attrs["long_name"] = self.value_name
        if self.affine is not None:
            attrs["affine"] = self.affine
            attrs["affine_axes"] = dims
        if self.lattice is not None:
            attrs["sample_lattice"] = self.lattice
            attrs["sample_lattice_axes"] = dims
        return xarray.DataArray(self.array, dims=dims, coords=coords, name=self.variable or None, attrs=attrs)


Path = typing.Union[str, "os.PathLike[str]"]


@_arguments.documents("read_image", "read_series")
def read(path: Path | Sequence[Path], variable: str = "", *, series: str | None = None, times=None,
         time_step: float | None = None, time_unit: str | None = None, sort: _kinds.SeriesOrder | None = None,
         time_axis: int = 0, fix: Mapping[str, int] | None = None, allow_outside_paths: bool = False,
         separate_process: bool = False, progress: Progress | None = None) -> Image:
    """Reads an image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF, VTK (.vti, .vtr, .pvd), DICOM. The values are not copied from the library's memory.

    ::

        tegl.read("ocean.nc", "temp")                             # a variable of a file
        tegl.read("ensemble.nc", fix={"member": 3})               # the fourth member of a variable of 5 axes
        tegl.read("scan/")                                        # a folder of DICOM files
        tegl.read("scan/", series="T1")                           # one of several series in it
        tegl.read(glob.glob("step_*.nrrd"), sort="name", time_step=0.5, time_unit="s")

    path
        A file or a folder; or a list of files of one shape that form one image with one more axis: 3D files over time,
        2D files as the slices of a volume. `tegl contour` reads them in the same way.
    variable, series
        netCDF: the variable to read; .npz: the array. DICOM: the series, by its UID, its description or its number. Needed if there are
        several.
    times, time_step, time_unit
        For a list: the coordinate of each file along the new axis, in the order of the list; or the distance of
        neighbours, in the order of `sort`; and the unit. Default: the coordinates in the files, else 0, 1, 2 ...
    sort
        For a list, its order: "name", by the numbers in the names; "time", by `times` or the times in the headers; or
        "given".
    fix
        netCDF: an index, counted from 0, for each of these dimensions. Only the samples there are read, and the image
        does not have these dimensions as axes.
    allow_outside_paths
        Whether a file of samples that a header refers to (NRRD, MetaImage) is also read outside of the header's folder.
    separate_process
        Whether netCDF-4 and DICOM are read in a child process, for files of unknown origin: a damaged file that makes
        their libraries crash, loop or use all memory is then a ValueError, and this process goes on. The array is the
        same, without a copy; starting the child takes a few milliseconds.

    The array's first axis is the slowest one in the file: (t, z, y, x), in C order. With `time_axis=-1` the axes are in
    the reverse order, (x, y, z, t) in Fortran order, as in nibabel.
    """
    paths = [_path(one) for one in path] if isinstance(path, (list, tuple)) else [_path(path)]
    if series is not None and variable:
        raise ValueError(f"variable is {variable!r} and series {series!r}; expected one of the two")
    found = _tegl.read_series(
        paths, _arguments.as_text("variable", variable) if series is None else _arguments.as_text("series", series),
        None if times is None else _times(times, len(paths), time_unit),
        None if time_step is None else _arguments.as_number("time_step", time_step),
        None if time_unit is None else _arguments.as_text("time_unit", time_unit),
        None if sort is None else _arguments.as_text("sort", sort), _fixed(fix),
        _arguments.as_bool("allow_outside_paths", allow_outside_paths),
        _arguments.as_bool("separate_process", separate_process), progress)
    array = found["array"]
    ndim = array.ndim
    is_reversed = _arguments.turn_around(time_axis, ndim)
    turn = builtins.slice(None, None, -1) if is_reversed else builtins.slice(None)
    affine = None if found["affine"] is None else np.array(found["affine"])
    if affine is not None and is_reversed:
        affine = np.column_stack([affine[::-1, ndim - 1::-1], affine[::-1, ndim]])
    axes: tuple[typing.Any, ...] = tuple(_arguments.UniformAxis(*axis) if isinstance(axis, tuple) else np.array(axis)
                                         for axis in found["axes"])[turn]
    array = array.T if is_reversed else array
    coords = tuple(axis.origin + np.arange(size) * axis.step if isinstance(axis, _arguments.UniformAxis) else axis
                   for axis, size in zip(axes, array.shape))
    curved = {}
    names, units = list(found["names"]), list(found["units"])
    for axis, along, values, name, unit in found["curved"]:
        sizes = [size if along >> a & 1 else 1 for a, size in enumerate(found["array"].shape)]
        values = values.reshape(sizes, order="F")  # a view: coordinates stay side by side
        curved[ndim - 1 - axis if is_reversed else axis] = values.T if is_reversed else values
        names[axis], units[axis] = name or names[axis], unit or units[axis]
    return Image(array=array, coords=coords, axis_names=tuple(names)[turn],
                 axis_units=tuple(units)[turn], curved=curved, lattice=found["lattice"], samples_are_cells=found["samples_are_cells"],
                 cell_faces=_faces_by_axis(found["cell_faces"], ndim)[turn], affine=affine,
                 time_axis=0 if is_reversed else ndim - 1,
                 value_name=found["value_name"], value_unit=found["value_unit"], format=found["format"],
                 variable=found["variable"], variables=tuple(found["variables"]), world_frame=found["world_frame"],
                 axis_directions=tuple(found["axis_directions"] or ["unknown"] * ndim)[turn], _axes=axes)


def _faces_by_axis(faces: list[list[float]], ndim: int) -> tuple[np.ndarray, ...]:
    """One array for each axis; () without any."""
    return tuple(np.array(faces[axis] if axis < len(faces) else []) for axis in range(ndim)) if any(faces) else ()


def _cell_faces(array, prepared, other_coordinates: tuple) -> list[list[float]]:
    """The faces of the file's cells by axis of the library; none with coordinates other than the file's."""
    if any(given is not None for given in other_coordinates):
        return []
    faces = [one.tolist() for one in getattr(array, "cell_faces", ())]
    return faces[::-1] if prepared.is_reversed else faces


def _refuse_other_coordinates(curved: list[int], prepared, spacing, origin, coords, affine, instead: str) -> None:
    """An error for coordinates of axes of a curved grid (numbers of the library) that would not be used. `instead`: what else
    is expected."""
    for name, given in (("spacing", spacing), ("origin", origin), ("affine", affine)):
        if given is not None:
            raise ValueError(f"{name} with a curved grid, whose samples have coordinates of their own; expected coords, with "
                             f"None for each curved axis{instead}")
    for axis, given in enumerate(coords or []):
        if given is not None and (prepared.ndim - 1 - axis if prepared.is_reversed else axis) in curved:
            raise ValueError(f"coords[{axis}] with a curved grid along this axis; expected None for it{instead}")


def _path(path) -> str:
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"path is {path!r}; expected a path, or a list of them")
    return os.fspath(path)


def _fixed(fix) -> list[tuple[str, int]]:
    if fix is None:
        return []
    if not isinstance(fix, Mapping):
        raise TypeError(f"fix is {fix!r}; expected the names of dimensions with an index each, such as {{'member': 3}}")
    return [(_arguments.as_text("a dimension of fix", name), _arguments.as_whole(f"fix[{name!r}]", index, 0))
            for name, index in fix.items()]


def _times(times, files: int, unit: str | None) -> list[float]:
    return [_arguments.number_on_axis(time, unit or "")
            for time in _arguments.as_list("times", times, f"a list of numbers, one for each of {files} files")]
