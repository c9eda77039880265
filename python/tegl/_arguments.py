# SPDX-License-Identifier: BSD-3-Clause
"""Converts arguments (arrays, masked arrays, xarrays, results of tegl.read) to the library's images.

The library's axes are the array's axes in reverse order: its first axis is the fastest one of a NumPy array in C order,
and its last axis, the time, is the array's first. With `time_axis=-1` both orders are equal. This module and `Contour`
reverse all arguments and results; users never see the library's order.
"""

from __future__ import annotations

import contextlib
import dataclasses
import datetime
import inspect
import operator
import os
import re
import reprlib
import typing
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from . import _dates, _kinds, _tegl
from ._xarrays import (INDEX_SUFFIX, TIME_NAMES, curved_names, in_order, is_xarray, own_curved,
                       without_longitude_and_latitude, without_replaced)

_TYPES = ("uint8", "int8", "uint16", "int16", "int32", "float32", "float64")

Progress = Callable[[float], object]
#: A coordinate: a number; or a date or a duration, in any of Python's forms, on an axis that has them.
Place = typing.Union[float, str, datetime.date, datetime.timedelta, np.generic]
#: Several coordinates.
Places = typing.Union["list[typing.Any]", "tuple[typing.Any, ...]", "np.ndarray[typing.Any, typing.Any]"]


class Labelled(typing.Protocol):
    """An xarray of one place or of several: the type is the same."""

    @property
    def dims(self) -> typing.Any: ...


_Documented = typing.TypeVar("_Documented", bound=typing.Callable[..., typing.Any])


def documents(*names: str) -> typing.Callable[[_Documented], _Documented]:
    """Appends the library's comments to a docstring."""

    def decorate(function: _Documented) -> _Documented:
        texts = [_tegl.docs[name] for name in names]
        if function.__doc__:  # None under python -OO
            function.__doc__ = (inspect.cleandoc(function.__doc__) + "\n\nFrom the library's reference, with the array's axes "
                                "in reverse order (its last axis is the array's `time_axis`):\n\n"
                                + "\n\n".join(texts) + "\n")
        return function

    return decorate


class UniformAxis(typing.NamedTuple):
    """Samples at origin + i * step."""

    origin: float
    step: float


def core_of(contour) -> _tegl.Contour:
    """The library's contour."""
    core = getattr(contour, "_core", None)
    if not isinstance(core, _tegl.Contour):
        raise TypeError(f"{type(contour).__name__} is not a contour; expected a tegl.Contour, from "
                        "tegl.contour(array, level) or tegl.load(path)")
    return core


def part_of(progress, first: float, last: float):
    """The progress function of a part of a call, from `first` to `last` of the whole."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress is {progress!r}; expected a function that takes a fraction, or None")
    return None if progress is None else lambda fraction: progress(
        first + (last - first) * fraction if fraction < 1 else last)


def _in_array_order(text: str, ndim: int) -> str:
    """A message of the library, with numbers of axes, points (x, y, z) and sizes (x x y x z) in the order of the array's
    axes."""
    text = re.sub(r"\b(axis|row|column) (\d)\b", lambda found: f"{found[1]} {ndim - 1 - int(found[2])}", text)
    text = text.replace("of its last axis", "of its axis 0")
    for pattern, separator in ((r"(?<=\()[^(),]+(?:, [^(),]+){%d}(?=\))" % (ndim - 1), ", "),
                               (r"\b\d+(?: x \d+){%d}\b" % (ndim - 1), " x ")):
        text = re.sub(pattern, lambda found: separator.join(found[0].split(separator)[::-1]), text)
    return text


@contextlib.contextmanager
def array_terms(is_reversed: bool, ndim: int, about: str = "") -> typing.Iterator[None]:
    """Converts the library's errors to the array's order of axes, except the name of the file `about`."""
    try:
        yield
    except ValueError as error:
        if not is_reversed:
            raise
        text = str(error)
        start = len(about) if text.startswith(about) else 0
        raise type(error)(text[:start] + _in_array_order(text[start:], ndim)) from None


@dataclasses.dataclass(frozen=True)
class Prepared:
    """An array as the library sees it."""

    image: _tegl.Image
    is_reversed: bool
    names: tuple[str, ...]
    units: tuple[str, ...]
    value_unit: str
    axes: tuple  #: UniformAxis or coordinates, in the array's order
    affine: np.ndarray | None  #: in the array's order
    sizes: tuple[int, ...]  #: of the array's axes
    extent: np.ndarray  #: 2 x N: the lowest and the highest coordinates in the world, in the array's order

    @property
    def ndim(self) -> int:
        return self.image.ndim

    def terms(self, about: str = "") -> contextlib.AbstractContextManager[None]:
        """Converts the library's errors to the array's order of axes, except the name of the file `about`."""
        return array_terms(self.is_reversed, self.ndim, about)

    def turned(self, per_axis: Sequence) -> list:
        """Numbers of the array's axes, in the library's order."""
        return list(per_axis)[::-1] if self.is_reversed else list(per_axis)

    def library_options(self, options: dict) -> dict:
        """Options of `extract_options` with the gradient kernel as the library's list of weights."""
        if options["normals"] != "kernel":
            return {**options, "kernel": []}
        kernel, n = real("normals", options["kernel"]).astype(np.float64), self.ndim
        if kernel.shape == (3,) * n:
            kernel = np.stack([kernel.swapaxes(0, axis) for axis in range(n)])
        if kernel.shape != (n,) + (3,) * n:
            raise ValueError(f"normals is a kernel of the shape {kernel.shape}; expected {(3,) * n}, the derivative along the "
                             f"first axis, or {(n,) + (3,) * n}, along each axis")
        order: typing.Literal["C", "F"] = "C" if self.is_reversed else "F"  # axis 0 of the library is the fastest
        return {**options, "kernel": [w for one in self.turned(list(kernel)) for w in one.ravel(order=order).tolist()]}

    def library_axis(self, axis: int | str, argument: str = "axis") -> int:
        number = axis_number(axis, self.names, self.ndim, argument)
        return self.ndim - 1 - number if self.is_reversed else number


def axis_number(axis: int | str, names: Sequence[str], ndim: int, argument: str = "axis") -> int:
    """0 ... ndim - 1 of an axis given by name or number (negative ones count from the end). `argument`: for errors."""
    if isinstance(axis, str):
        if axis not in names and not any(names):
            raise ValueError(f"no axis is named '{axis}': the axes have no names; expected a number from {-ndim} to "
                             f"{ndim - 1}, or axis_names")
        if axis not in names:
            raise ValueError(f"no axis is named '{axis}'; expected one of {', '.join(repr(n) for n in names)}")
        if list(names).count(axis) > 1:
            raise ValueError(f"{list(names).count(axis)} axes are named '{axis}'; expected axis= with the number of one")
        return list(names).index(axis)
    axis = as_whole(argument, axis)
    if not -ndim <= axis < ndim:
        raise ValueError(f"{argument} is {axis}; expected {-ndim} to {ndim - 1}")
    return axis % ndim


def turn_around(time_axis: int, ndim: int) -> bool:
    """Whether the library's axes are the array's in reverse order."""
    if as_whole("time_axis", time_axis) not in (0, -1, ndim - 1):
        raise ValueError(f"time_axis is {time_axis!r}; expected 0 or -1, the array's first or last axis; numpy.moveaxis "
                         "gives a view with another axis first")
    return time_axis == 0


def number_on_axis(at: object, unit: str) -> float:
    """A coordinate as a number; of dates and durations, by the unit of the axis."""
    date = _dates.as_date(at)
    if date is not None:
        return _dates.date_on_axis(at, date, unit)
    duration = _dates.duration_of(at)
    if duration is not None:
        return _dates.duration_on_axis(at, duration, unit)
    return as_number("the coordinate", at)


def as_number(name: str, value: object) -> float:
    """A real number; `name` is for errors. Text, truth values, dates and complex numbers are refused, although float()
    takes some of them."""
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    if not isinstance(value, (str, bytes, bytearray, bool)) and kind not in ("b", "c", "m", "M", "S", "U") and \
            not (kind and np.ndim(typing.cast(float, value))):
        try:
            return float(typing.cast(float, value))
        except OverflowError:
            raise ValueError(f"{name} is {reprlib.repr(value)}; expected a number in the range of float64") from None
        except (TypeError, ValueError):
            pass
    raise TypeError(f"{name} is {value!r}; expected a number") from None


def as_level(level: object) -> float:
    """The level of a contour: a finite number."""
    number = as_number("level", level)
    if not np.isfinite(number):
        raise ValueError(f"level is {number}; expected a finite number")
    return number


def as_whole(name: str, value: object, least: int | None = None) -> int:
    """A whole number, not below `least`."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(typing.cast(int, value))
    except TypeError:
        raise TypeError(f"{name} is {value!r}; expected a whole number") from None
    if least is not None and not least <= number < 2**63:
        raise ValueError(f"{name} is {number}; expected {least} or more" + (", below 2**63" if number > 0 else ""))
    return number


def threads_of(threads: object) -> int:
    """The number of threads; 0: all."""
    number = 0 if threads is None else as_whole("threads", threads)
    if number < 0:
        raise ValueError(f"threads is {number}; expected 0 (all) or more")
    return min(number, 2**31 - 1)  # the library limits it to the machine's


def as_bool(name: str, value: object) -> bool:
    """A truth value of Python or NumPy; text and numbers are refused."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is {reprlib.repr(value)}; expected True or False")
    return bool(value)


def or_none(check: typing.Callable[..., typing.Any], name: str, value: object, *more: int) -> typing.Any:
    return None if value is None else check(name, value, *more)


def as_numbers(name: str, value: object, expected: str = "a list of numbers") -> list[float]:
    return [as_number(f"{name}[{i}]", one) for i, one in enumerate(as_list(name, value, expected))]


def as_text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} is {value!r}; expected text")
    return value


def as_list(name: str, value: object, expected: str) -> list:
    """The entries of a list, a tuple or an array."""
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__iter__") or np.ndim(
            np.empty(0) if isinstance(value, (list, tuple)) else typing.cast(np.ndarray, value)) == 0:
        raise TypeError(f"{name} is {value!r}; expected {expected}")
    return list(typing.cast(typing.Iterable, value))


def _per_axis(value, ndim: int, name: str, default: float) -> list[float]:
    if value is None:
        return [default] * ndim
    if isinstance(value, (str, bytes)) or np.ndim(value) == 0:
        return [as_number(name, value)] * ndim
    result = as_numbers(name, value)
    if len(result) != ndim:
        raise ValueError(f"{name} has {len(result)} numbers; expected one for each of {ndim} axes")
    return result


def _reals(what_is: str, values: object, expected: str) -> np.ndarray:
    """Numbers in double precision; text and dates, which NumPy would convert, are refused."""
    try:
        array = np.asarray(values)
        if array.dtype.kind in "iuf" or (array.dtype.kind == "O" and not any(isinstance(v, str) for v in array.flat)):
            return array.astype(np.float64)
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{what_is} {values!r}; expected {expected}") from None


def _is_monotonic(values: np.ndarray) -> bool:
    """Whether numbers ascend or descend strictly."""
    steps = np.diff(values)
    return bool((steps > 0).all() or (steps < 0).all())


def _axis(coordinates, axis: str, size: int, unit: str) -> UniformAxis | list[float]:
    """Uniform if that is exact to the last bit; else all coordinates. Longitudes that jump by a turn, as rolled ones do, are
    continued. `axis`: its name in errors."""
    if isinstance(coordinates, UniformAxis):
        return coordinates
    values = _reals(f"the coordinates of {axis} are", coordinates, "numbers, ascending or descending")
    if values.ndim != 1:
        raise ValueError(f"the coordinates of {axis} have {values.ndim} dimensions; expected 1")
    if len(values) != size:
        raise ValueError(f"{axis} has {size} samples and {len(values)} coordinates; expected equal numbers")
    if not np.isfinite(values).all():
        wrong = int(np.argmin(np.isfinite(values)))
        raise ValueError(f"coordinate {wrong} of {axis} is {values[wrong]}; expected a finite number")
    if not _is_monotonic(values) and _tegl.is_longitude_unit(unit):
        continued = values.copy()
        _tegl.continue_longitudes(continued, [len(continued)])
        values = continued if _is_monotonic(continued) else values
    if not _is_monotonic(values):
        rises, falls = np.diff(values) > 0, np.diff(values) < 0
        descends = falls[0]
        wrong = int(np.argmin(falls if descends else rises))
        raise ValueError(f"coordinates {wrong} and {wrong + 1} of {axis} are {values[wrong]:g} and {values[wrong + 1]:g}; "
                         f"expected them strictly ascending or strictly descending")
    if len(values) > 1 and np.isfinite(values).all():
        for step in (values[1] - values[0], (values[-1] - values[0]) / (len(values) - 1)):
            if step != 0 and np.array_equal(values[0] + np.arange(len(values)) * step, values):
                return UniformAxis(float(values[0]), float(step))
    return values.tolist()


def _affine(affine, ndim: int, name: str = "affine") -> np.ndarray:
    matrix = _reals(f"{name} is", affine, f"{ndim} x {ndim + 1} or {ndim + 1} x {ndim + 1} numbers")
    if matrix.shape not in ((ndim, ndim + 1), (ndim + 1, ndim + 1)):
        raise ValueError(f"{name} has the shape {matrix.shape}; expected {(ndim, ndim + 1)} or {(ndim + 1, ndim + 1)}")
    if len(matrix) > ndim and not np.array_equal(matrix[ndim], [0.0] * ndim + [1.0]):
        raise ValueError(f"the last row of {name} is {matrix[ndim].tolist()}; expected {[0.0] * ndim + [1.0]}")
    return matrix[:ndim]


def _from_xarray(data) -> tuple[list, list[str], list[str], int | None, str]:
    """Coordinates (None if there are none), names, units, the time axis or None, and the values' unit."""
    coordinates: list = []
    units: list[str] = []
    time_axis = None
    for number, dim in enumerate(data.dims):
        values, unit = None, ""
        if dim in data.coords:
            values = data.coords[dim].values
            unit = _dates.unit_with_calendar(str(data.coords[dim].attrs.get("units", "")),
                                             str(data.coords[dim].attrs.get("calendar", "")))
            if values.dtype.kind == "M":
                values, unit = _dates.dates_as_numbers(values, str(dim))
                time_axis = number if time_axis is None else time_axis
            elif values.dtype.kind == "m":
                values, unit = values / np.timedelta64(1, "D"), "days"
            elif values.dtype.kind not in "iuf":
                raise ValueError(f"the coordinate '{dim}' has values of type {values.dtype}; expected numbers or dates "
                                 f"(data.drop_vars('{dim}') leaves the indices)")
        if str(dim).lower() in TIME_NAMES and time_axis is None:
            time_axis = number
        coordinates.append(values)
        units.append(unit)
    names = [str(dim) for dim in data.dims]
    for axis, name in curved_names(data).items():
        names[axis] = str(name)
        units[axis] = str(data.coords[name].attrs.get("units", ""))
    return coordinates, names, units, time_axis, str(data.attrs.get("units", ""))


def without_curved(data) -> str:
    """For errors: the part of an image with a curved grid that has indices as coordinates."""
    return f"drop_vars({list(curved_names(data).values())})" if is_xarray(data) else "its `array`"


def own_lattice(data) -> str | None:
    """The lattice that an image of tegl.read or the attribute "sample_lattice" of an xarray records, or None."""
    if is_xarray(data):
        name = data.attrs.get("sample_lattice")
        if name is None:
            return None
        axes, names = data.attrs.get("sample_lattice_axes"), [str(dim) for dim in data.dims]
        if axes is not None and names != [str(axis) for axis in np.atleast_1d(axes)]:
            raise ValueError(f"the lattice '{name}' is for the axes {', '.join(map(str, np.atleast_1d(axes)))}, and the array "
                             f"has {', '.join(names)}; expected the same axes in this order")
        return as_text("the attribute 'sample_lattice'", name)
    return data.lattice if hasattr(data, "__tegl_image__") else None


def own_affine(data) -> np.ndarray | None:
    """The affine map that the attribute "affine" of an xarray records, in the order of its axes, or None. The attribute
    "affine_axes" has the names of the axes that the map is for. Axes of one chosen index may be missing, if the others'
    coordinates do not depend on them."""
    affine = data.attrs.get("affine")
    if affine is None or "affine_axes" not in data.attrs:  # without it, the attribute may mean something else
        return None
    names = [str(dim) for dim in data.dims]
    axes = [str(axis) for axis in np.atleast_1d(data.attrs["affine_axes"])]
    matrix = _affine(affine, len(axes), "the attribute 'affine'")
    order = [axes.index(name) for name in names if name in axes]
    gone = [number for number in range(len(axes)) if number not in order]
    if len(order) != len(names) or matrix[np.ix_(order, gone)].any():
        raise ValueError(f"the attribute 'affine' is for the axes {', '.join(axes)}, and the array has {', '.join(names)}; "
                         "expected the same axes, an argument affine=, or an array without this attribute")
    return matrix[order][:, [*order, len(axes)]]


def mask_of(array) -> np.ndarray | None:
    """Where a masked array, or a list of them or of such lists, is masked; None if there is no mask."""
    if not _has_mask(array):
        return None
    if isinstance(array, np.ma.MaskedArray):
        return np.ma.getmaskarray(array)
    _array(array)  # an error for rows of different lengths
    return np.array([np.zeros(np.shape(part), bool) if (mask := mask_of(part)) is None else mask for part in array])


def _has_mask(array) -> bool:
    if isinstance(array, (list, tuple)):
        return any(_has_mask(part) for part in array)
    return isinstance(array, np.ma.MaskedArray) and np.ma.getmask(array) is not np.ma.nomask


def _array(data) -> np.ndarray:
    """An array, or lists of numbers as one."""
    if data is None:
        raise TypeError("the array is None; expected an array")
    try:
        return np.asarray(data)
    except ValueError:
        raise ValueError(f"the array is {reprlib.repr(data)}, with rows of different lengths; expected equal ones") from None


def _values(array: np.ndarray) -> np.ndarray:
    """The array in a type of the library; without a copy if possible."""
    if array.dtype.name not in _TYPES:
        if array.dtype.kind == "b":
            return array.view(np.uint8)
        if array.dtype.kind in "iu":
            fits = array.size == 0 or (array.min() >= -2**31 and array.max() < 2**31)
            array = array.astype(np.int32 if fits else np.float64)
        elif array.dtype.kind == "f":
            array = array.astype(np.float32 if array.dtype.itemsize < 4 else np.float64)
        else:
            raise TypeError(f"values are of type {array.dtype}; expected real numbers")
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if not array.flags.aligned or any(s % array.itemsize for s in array.strides):
        array = np.array(array)  # fields of records, or bytes from anywhere
    return array


def booleans(mask) -> np.ndarray:
    """A mask as True and False."""
    mask = np.asarray(mask)
    if mask.dtype.kind not in "biuf":
        raise TypeError(f"mask is of type {mask.dtype}; expected True or False for each sample")
    if mask.dtype.kind == "f" and np.isnan(mask).any():
        raise ValueError("mask has NaN, which is neither True nor False; expected one of these for each sample (xarray's "
                         "where leaves NaN: use mask.fillna(False))")
    return mask.astype(bool, copy=False)


def _masked(array: np.ndarray, mask) -> np.ndarray:
    """A copy with NaN (missing values) if the mask is False."""
    mask = booleans(mask)
    if mask.shape != array.shape:
        raise ValueError(f"mask has the shape {mask.shape}; expected {array.shape}, as the array")
    if mask.all():
        return array
    kind = array.dtype if array.dtype.kind == "f" else np.dtype(np.float64 if array.itemsize > 2 else np.float32)
    return np.where(mask, array, kind.type(np.nan)).astype(kind, copy=False)


def listed_coords(coords) -> list:
    return as_list("coords", coords, "the coordinates of each axis, or None for one")


def prepare(data, *, spacing=None, origin=None, coords=None, affine=None, mask=None, axis_names=None, axis_units=None,
            time_axis=None, hidden: np.ndarray | None = None, allow_curved: bool = False,
            allow_lattice: bool = False) -> Prepared:
    """The library's view of an array. Values are copied only if the type or a mask requires it. `hidden`: True for other
    samples that are missing; of another shape, it is left out of account."""
    if not allow_curved and own_curved(data):
        raise ValueError("an image with a curved grid, which only tegl.contour and tegl.filter know; expected "
                         f"{without_curved(data)}, with "
                         "indices as coordinates, or a contour")
    if not allow_lattice and own_lattice(data) not in (None, "cubic"):
        raise ValueError(f"an image on the lattice {own_lattice(data)}, which only tegl.contour and tegl.count know; expected "
                         "its `array`, or an image on a cubic grid")
    if isinstance(data, (str, os.PathLike)):
        raise TypeError(f"{data!r} is a path; expected an array, or tegl.read({data!r})")
    if hasattr(data, "data_vars"):
        raise TypeError(f"a dataset of {', '.join(map(repr, data.data_vars))}; expected one of its arrays, dataset[name]")
    names: Sequence[str] | None = None
    units: Sequence[str] | None = None
    known: Sequence | None = None
    labelled = None
    value_unit = ""
    if hasattr(data, "__tegl_image__"):
        known, names, units, image_affine, own_axis, value_unit, data = data.__tegl_image__()
        affine = image_affine if affine is None else affine
        time_axis = own_axis if time_axis is None else time_axis
    elif is_xarray(data):
        labelled = data
        known, names, units, found_axis, value_unit = _from_xarray(data)
        affine = own_affine(data) if affine is None else affine
        if time_axis is None:
            if found_axis not in (None, 0, data.ndim - 1):
                time = data.dims[found_axis]
                raise ValueError(f"the time '{time}' is between the other axes, {', '.join(map(str, data.dims))}; expected "
                                 f"it first or last: data.transpose('{time}', ...); or time_axis=0 or -1, for slices and "
                                 "tracks along the first or last axis")
            time_axis = found_axis
        data = data.data if isinstance(data.data, np.ndarray) else data.values
    own_mask = mask_of(data)
    if own_mask is not None:
        mask = ~own_mask if mask is None else ~own_mask & booleans(mask)
    if isinstance(data, np.ma.MaskedArray):
        data = data.data
    array = _array(data)
    ndim = array.ndim
    if not 2 <= ndim <= 5:
        raise ValueError(f"the array has {ndim} axes; expected 2 to 5")
    array = _values(array)
    if mask is not None:
        array = _masked(array, mask if labelled is None or not is_xarray(mask) else in_order(mask, labelled))
    if hidden is not None and hidden.ndim == ndim and all(n in (1, size) for n, size in zip(hidden.shape, array.shape)):
        array = _masked(array, np.broadcast_to(~hidden, array.shape))
    is_even, has_coords = spacing is not None or origin is not None, coords is not None
    coords = listed_coords(coords) if has_coords else [None] * ndim
    if len(coords) != ndim:
        raise ValueError(f"coords has {len(coords)} entries; expected one for each of {ndim} axes")
    spacings, origins = _per_axis(spacing, ndim, "spacing", 1.0), _per_axis(origin, ndim, "origin", 0.0)
    if has_coords and is_even:
        raise ValueError("coords with spacing or origin; expected only coords, or only spacing and origin")
    if units is not None and affine is None:  # units are those of the array's own coordinates; with a map, of the world
        units = ["" if is_even or given is not None else unit for unit, given in zip(units, coords)]
    if known is not None and not is_even:
        coords = [own if given is None else given for own, given in zip(known, coords)]
    names = labels_of("axis_names", axis_names if axis_names is not None else names, ndim)
    units = labels_of("axis_units", axis_units if axis_units is not None else units, ndim)
    if axis_names is not None:
        require_different("axis_names", names)
    axes = []
    for axis, size in enumerate(array.shape):
        called = f"axis {axis}" + (f" ('{names[axis]}')" if names[axis] else "")
        if size == 0:
            raise ValueError(f"{called} has 0 samples; expected at least 1")
        given = UniformAxis(origins[axis], spacings[axis]) if coords[axis] is None else coords[axis]
        if isinstance(given, UniformAxis) and not (np.isfinite(given).all() and given.step != 0):
            raise ValueError(f"{called} has the origin {given.origin:g} and the spacing {given.step:g}; expected finite "
                             "numbers, and a spacing other than 0")
        axes.append(_axis(given, called, size, units[axis]))
    is_reversed = turn_around(0 if time_axis is None else time_axis, ndim)
    matrix = given_affine = None if affine is None else _affine(affine, ndim)
    with np.errstate(over="ignore", invalid="ignore"):
        extent = _extent_of(axes, array.shape, matrix)
    if not is_reversed:
        image = _tegl.Image(array, axes, None if matrix is None else matrix.tolist(), list(names), list(units))
    else:
        if matrix is not None:
            matrix = np.column_stack([matrix[::-1, ndim - 1::-1], matrix[::-1, ndim]])
        image = _tegl.Image(array.T, axes[::-1], None if matrix is None else matrix.tolist(), list(names)[::-1],
                            list(units)[::-1])
    return Prepared(image, is_reversed, names, units, value_unit, tuple(axes), given_affine, tuple(array.shape),
                    extent)


def real(name: str, values: object) -> np.ndarray:
    """An array of real numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} are of type {array.dtype}; expected real numbers")
    return array


def labels_of(name: str, labels: object, ndim: int) -> tuple[str, ...]:
    """Names or units of axes; without any, empty ones."""
    if labels is None:
        return ("",) * ndim
    listed = list(labels) if isinstance(labels, str) else as_list(name, labels, f"a list of text, one for each of {ndim} axes")
    if len(listed) != ndim:
        raise ValueError(f"{name} has {len(listed)} entries; expected one for each of {ndim} axes")
    return tuple(as_text(f"{name}[{number}]", label) for number, label in enumerate(listed))


def require_different(name: str, labels: Sequence[str]) -> None:
    twice = [label for label in labels if label and list(labels).count(label) > 1]
    if twice:
        raise ValueError(f"{name} has '{twice[0]}' more than once; expected different names")


def _extent_of(axes: Sequence[UniformAxis | list[float]], sizes: Sequence[int], affine: np.ndarray | None) -> np.ndarray:
    """2 x N: the lowest and the highest coordinates in the world."""
    ends = np.array([[axis.origin, axis.origin + (size - 1) * axis.step] if isinstance(axis, UniformAxis)
                     else [axis[0], axis[-1]] for axis, size in zip(axes, sizes)]).T
    if affine is None:
        return np.sort(ends, axis=0)
    products = ends[:, None, :] * affine[:, :-1]  # end, row, column
    products[:, affine[:, :-1] == 0] = 0  # also if the end is infinite
    return np.stack([np.minimum(*products).sum(axis=1), np.maximum(*products).sum(axis=1)]) + affine[:, -1]


def is_double(dtype, prepared: Prepared) -> bool:
    """Whether coordinates have double precision. The array's coordinates must be in the range of the type."""
    try:
        kind = None if dtype is None else np.dtype(dtype)  # None would be float64
    except TypeError:
        kind = None
    if kind is None:
        raise TypeError(f"dtype is {dtype!r}; expected float32 or float64")
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype is {kind}; expected float32 or float64")
    least, most = np.finfo(kind).tiny, np.finfo(kind).max
    for axis, reach in enumerate(np.abs(prepared.extent).max(axis=0)):
        if reach != 0 and not least <= reach <= most:
            raise ValueError(f"coordinates along axis {axis} reach {reach:g}; expected {least:.3g} to {most:.3g}, the range of "
                             f"{kind}" + (", or dtype=numpy.float64" if kind == np.dtype(np.float32) else ""))
    return kind == np.dtype(np.float64)


def normals_kind(normals: object, gradient: object) -> str:
    """The kind of normals for `_tegl.extract`: "" for none."""
    kinds = typing.get_args(_kinds.Normals)
    if isinstance(normals, str) and normals in kinds:
        kind = normals
    elif isinstance(normals, (np.ndarray, list, tuple)):
        kind = "kernel"
    elif isinstance(normals, (bool, np.bool_)):
        kind = "gradient" if normals else ""
    else:
        raise (ValueError if isinstance(normals, str) else TypeError)(
            f"normals is {normals!r}; expected True, False or one of {', '.join(map(repr, kinds))}")
    if gradient != "sobel":
        return kind
    if kind not in ("", "gradient", "sobel"):
        raise ValueError(f"normals is {kind!r} and gradient 'sobel'; expected normals from gradients, True or 'gradient'")
    return "sobel" if kind else ""


#: A function of two arrays of samples, one at or above the level, the other below, and of the level. Its result: for each
#: pair, or for all, the position as a number from 0, at the first sample, to 1, at the second.
PositionFunction = Callable[[np.ndarray, np.ndarray, float], object]


def position_function(positions: object) -> Callable[[np.ndarray, np.ndarray, float], np.ndarray] | None:
    """A function that calls `positions` and checks what it returns; None for rules with names."""
    if not callable(positions):
        return None
    function = typing.cast(PositionFunction, positions)

    def places(first: np.ndarray, second: np.ndarray, level: float) -> np.ndarray:
        found = function(first, second, level)
        array = np.ma.filled(found, np.nan) if np.ma.isMaskedArray(found) else np.asarray(found)
        if array.dtype.kind not in "biuf":
            raise TypeError(f"the function for positions returned {found!r}; expected numbers from 0 to 1")
        if array.shape not in ((), first.shape):
            raise ValueError(f"the function for positions returned an array of the shape {array.shape}; expected "
                             f"{first.shape}, as its arguments, or one number")
        return np.ascontiguousarray(np.broadcast_to(array, first.shape), np.float64)

    return places


def position_values(positions: object, image: object, prepared: Prepared) -> np.ndarray:
    """The samples of the second image for "filtered", in the library's order; none for other rules."""
    kinds = typing.get_args(_kinds.Positions)
    if not callable(positions) and not isinstance(positions, str):
        raise TypeError(f"positions is {positions!r}; expected text or a function of the samples")
    if not callable(positions) and positions not in kinds:
        raise ValueError(f"positions is {positions!r}; expected one of {', '.join(map(repr, kinds))}, or a function of the "
                         "samples")
    if positions != "filtered":
        if image is not None:
            raise ValueError(f"positions_image with positions {positions!r}; expected positions='filtered'")
        return np.empty(0, np.float32)
    if image is None:
        raise ValueError("positions is 'filtered' without positions_image; expected the second image, an array")
    if hasattr(image, "__tegl_image__"):
        if lattice := getattr(image, "lattice", None):
            raise ValueError(f"positions_image is on the lattice {lattice}; expected an image on a cubic grid")
        image = image.__tegl_image__()[-1]
    array: np.ndarray = typing.cast(np.ndarray, image) if np.ma.isMaskedArray(image) else np.asarray(image)
    dtype = np.float32 if np.can_cast(array.dtype, np.float32) else np.float64
    values = np.ma.filled(array.astype(dtype), np.nan) if np.ma.isMaskedArray(array) else np.asarray(array, dtype)
    shape = prepared.image.array.shape[::-1] if prepared.is_reversed else prepared.image.array.shape
    if values.shape != shape:
        raise ValueError(f"positions_image has the shape {values.shape}; expected {shape}, as the array")
    return np.ravel(values, order="C" if prepared.is_reversed else "F")


EXTRACT_OPTIONS = ("triangulation", "ambiguity", "direction", "close", "epsilon", "normals", "gradient", "threads")


def extract_options(*, triangulation="compact", ambiguity="low", direction="descent", close=False, epsilon=0.0,
                    normals=False, gradient="differences", threads=0, **unknown) -> dict:
    """The options of `_tegl.extract`."""
    if unknown:
        raise TypeError(f"no argument is named '{next(iter(unknown))}'; expected one of {', '.join(EXTRACT_OPTIONS)}")
    gradients = typing.get_args(_kinds.Gradient)
    if as_text("gradient", gradient) not in gradients:
        raise ValueError(f"gradient is {gradient!r}; expected one of {', '.join(map(repr, gradients))}")
    return {"triangulation": as_text("triangulation", triangulation), "ambiguity": as_text("ambiguity", ambiguity),
            "direction": as_text("direction", direction), "close": as_bool("close", close),
            "epsilon": as_number("epsilon", epsilon), "normals": normals_kind(normals, gradient), "kernel": normals,
            "threads": threads_of(threads)}
