# SPDX-License-Identifier: BSD-3-Clause
"""From what callers have (arrays, masked arrays, xarray's, what tegl.read gave) to the library's images.

The library's axes are the array's the other way round, so that its first axis is the one that runs fastest in a NumPy
array of C order and its last one, the time, is the array's first. With `time_axis=-1` they are the array's own. All
that goes in and comes out is turned around here and in `Contour`; the library's numbers never show.
"""

from __future__ import annotations

import dataclasses
import datetime
import inspect
import os
import typing
from collections.abc import Mapping, Sequence

import numpy as np

from . import _tegl

_TYPES = ("uint8", "int8", "uint16", "int16", "int32", "float32", "float64")
_TIME_NAMES = ("t", "time")


_Documented = typing.TypeVar("_Documented", bound=typing.Callable[..., typing.Any])


def documents(*names: str) -> typing.Callable[[_Documented], _Documented]:
    """Puts the library's own comments behind a docstring."""

    def decorate(function: _Documented) -> _Documented:
        texts = [_tegl.docs[name] for name in names]
        if function.__doc__:  # None under python -OO
            function.__doc__ = (inspect.cleandoc(function.__doc__) + "\n\nFrom the library's reference, whose axes are those of "
                                "the array from the last to the first (its last axis is the array's `time_axis`):\n\n"
                                + "\n\n".join(texts) + "\n")
        return function

    return decorate


class UniformAxis(typing.NamedTuple):
    """Samples at origin + i * step."""

    origin: float
    step: float


def core_of(contour) -> _tegl.Contour:
    """The library's own contour."""
    core = getattr(contour, "_core", None)
    if not isinstance(core, _tegl.Contour):
        raise TypeError(f"{type(contour).__name__} is no contour; expected a tegl.Contour, as tegl.contour(array, level) "
                        "and tegl.load(path) give")
    return core


def part_of(progress, first: float, last: float):
    """The progress of a call that takes the whole from `first` to `last`."""
    return None if progress is None else lambda fraction: progress(
        first + (last - first) * fraction if fraction < 1 else last)


@dataclasses.dataclass(frozen=True)
class Prepared:
    """An array as the library sees it."""

    image: _tegl.Image
    is_reversed: bool
    names: tuple[str, ...]
    units: tuple[str, ...]

    @property
    def ndim(self) -> int:
        return self.image.ndim

    def turned(self, per_axis: Sequence) -> list:
        """Numbers of the array's axes, in the library's order."""
        return list(per_axis)[::-1] if self.is_reversed else list(per_axis)

    def library_axis(self, axis: int | str) -> int:
        number = axis_number(axis, self.names, self.ndim)
        return self.ndim - 1 - number if self.is_reversed else number


def axis_number(axis: int | str, names: Sequence[str], ndim: int) -> int:
    """0 ... ndim - 1 of an axis given by name or number (negative ones count from the end)."""
    if isinstance(axis, str):
        if axis not in names:
            raise ValueError(f"no axis is named '{axis}'; expected one of {', '.join(repr(n) for n in names)}")
        return list(names).index(axis)
    if not -ndim <= axis < ndim:
        raise ValueError(f"axis is {axis}; expected {-ndim} to {ndim - 1}")
    return axis % ndim


def turn_around(time_axis: int, ndim: int) -> bool:
    """Whether the library's axes are the array's from the last to the first."""
    if time_axis not in (0, -1, ndim - 1):
        raise ValueError(f"time_axis is {time_axis}; expected 0 or -1, the array's first or last axis; numpy.moveaxis "
                         "gives a view with another axis first")
    return time_axis == 0


def is_xarray(data: object) -> bool:
    return type(data).__module__.split(".")[0] == "xarray" and hasattr(data, "dims")


def time_as_numbers(times: np.ndarray) -> tuple[np.ndarray, str]:
    """Days since the first of these dates, and the unit that says so."""
    start = times.astype("datetime64[ns]").min()
    return (times.astype("datetime64[ns]") - start) / np.timedelta64(1, "D"), f"days since {start.astype('datetime64[s]')}"


def _as_date(at: object) -> np.datetime64 | None:
    """What a date is, in any of the forms that Python has for them: NumPy's, xarray's, pandas' and its own. None for
    what is no date."""
    if isinstance(at, datetime.datetime) and at.tzinfo is not None:  # pandas' timestamps are datetimes
        at = at.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    if isinstance(at, (str, datetime.date)):
        try:
            return np.datetime64(typing.cast(str, at))
        except ValueError:
            raise ValueError(f"the coordinate {at!r} is no number, and no date; expected one") from None
    if getattr(getattr(at, "dtype", None), "kind", "") == "M" and np.ndim(typing.cast(float, at)) == 0:
        return typing.cast(np.datetime64, np.asarray(at)[()])
    return None


def number_on_axis(at: object, unit: str) -> float:
    """A coordinate as a number; dates on an axis whose unit is `days since DATE`, as of xarray's times."""
    date = _as_date(at)
    if date is None:
        if getattr(getattr(at, "dtype", None), "kind", "") == "m":
            raise ValueError(f"the coordinate {at!r} is a duration; expected a number, or a date")
        return as_number("the coordinate", at)
    if not unit.startswith("days since "):
        raise ValueError(f"the coordinate {at!r} is a date, and the axis has the unit '{unit}'; expected a number")
    if unit.rstrip().endswith(")"):
        raise ValueError(f"the coordinate {at!r} is a date, and the axis has '{unit}', of another calendar; expected a "
                         "number")
    if np.isnat(date):
        raise ValueError("the coordinate is no date (NaT); expected one")
    start = np.datetime64(unit.removeprefix("days since ").strip().replace(" ", "T"))
    return float((date - start) / np.timedelta64(1, "D"))


def as_number(name: str, value: object) -> float:
    """A real number, by the name that the caller knows it by."""
    try:
        return float(typing.cast(float, value))
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {value!r}; expected a number") from None


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
    if np.ndim(value) == 0:
        return [float(value)] * ndim
    result = [float(v) for v in value]
    if len(result) != ndim:
        raise ValueError(f"{name} has {len(result)} numbers; expected one for each of {ndim} axes")
    return result


def _axis(coordinates) -> UniformAxis | list[float]:
    """Uniform if that is exact to the last bit; else all coordinates."""
    if isinstance(coordinates, UniformAxis):
        return coordinates
    values = np.asarray(coordinates, dtype=np.float64)
    if values.ndim != 1:
        raise ValueError(f"the coordinates of an axis have {values.ndim} dimensions; expected 1")
    if len(values) > 1 and np.isfinite(values).all():
        for step in (values[1] - values[0], (values[-1] - values[0]) / (len(values) - 1)):
            if step != 0 and np.array_equal(values[0] + np.arange(len(values)) * step, values):
                return UniformAxis(float(values[0]), float(step))
    return values.tolist()


def _affine(affine, ndim: int) -> np.ndarray | None:
    if affine is None:
        return None
    matrix = np.asarray(affine, dtype=np.float64)
    if matrix.shape not in ((ndim, ndim + 1), (ndim + 1, ndim + 1)):
        raise ValueError(f"affine has the shape {matrix.shape}; expected {(ndim, ndim + 1)} or {(ndim + 1, ndim + 1)}")
    if len(matrix) > ndim and not np.array_equal(matrix[ndim], [0.0] * ndim + [1.0]):
        raise ValueError(f"the last row of affine is {matrix[ndim].tolist()}; expected {[0.0] * ndim + [1.0]}")
    return matrix[:ndim]


def _from_xarray(data) -> tuple[list, list[str], list[str], int | None]:
    """Coordinates (None where there are none), names, units, and the axis of the time, if there is one."""
    coordinates: list = []
    units: list[str] = []
    time_axis = None
    for number, dim in enumerate(data.dims):
        values, unit = None, ""
        if dim in data.coords:
            values = data.coords[dim].values
            unit = str(data.coords[dim].attrs.get("units", ""))
            if values.dtype.kind == "M":
                values, unit = time_as_numbers(values)
                time_axis = number if time_axis is None else time_axis
            elif values.dtype.kind == "m":
                values, unit = values / np.timedelta64(1, "D"), "days"
            elif values.dtype.kind not in "iuf":
                raise ValueError(f"the coordinate '{dim}' has values of type {values.dtype}; expected numbers or dates "
                                 f"(data.drop_vars('{dim}') leaves the indices)")
        if str(dim).lower() in _TIME_NAMES and time_axis is None:
            time_axis = number
        coordinates.append(values)
        units.append(unit)
    return coordinates, [str(dim) for dim in data.dims], units, time_axis


def _values(array: np.ndarray) -> np.ndarray:
    """The array in a type that the library has; as it is wherever that can be."""
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


def _in_order(mask, dims: Sequence):
    """An xarray with its dimensions in the order of the image's."""
    if set(mask.dims) != set(dims):
        raise ValueError(f"mask has the dimensions {', '.join(map(str, mask.dims))}; expected those of the array, "
                         f"{', '.join(map(str, dims))}")
    return mask.transpose(*dims)


def _masked(array: np.ndarray, mask) -> np.ndarray:
    """Where the mask is False, values are missing: NaN, in a copy."""
    mask = np.asarray(mask, dtype=bool)
    if mask.shape != array.shape:
        raise ValueError(f"mask has the shape {mask.shape}; expected {array.shape}, that of the array")
    if mask.all():
        return array
    kind = array.dtype if array.dtype.kind == "f" else np.dtype(np.float64 if array.itemsize > 2 else np.float32)
    return np.where(mask, array, kind.type(np.nan)).astype(kind, copy=False)


def prepare(data, *, spacing=None, origin=None, coords=None, affine=None, mask=None, axis_names=None, axis_units=None,
            time_axis=None) -> Prepared:
    """The library's view of an array: no values are copied but where the type or a mask asks for it."""
    if isinstance(data, (str, os.PathLike)):
        raise TypeError(f"{data!r} is a path; expected an array, or tegl.read({data!r})")
    if hasattr(data, "data_vars"):
        raise TypeError(f"a dataset of {', '.join(map(repr, data.data_vars))}; expected one of them, dataset[name]")
    names: Sequence[str] | None = None
    units: Sequence[str] | None = None
    known: Sequence | None = None
    dims: Sequence | None = None
    if hasattr(data, "__tegl_image__"):
        known, names, units, own_affine, own_axis, data = data.__tegl_image__()
        affine = own_affine if affine is None else affine
        time_axis = own_axis if time_axis is None else time_axis
    elif is_xarray(data):
        dims = data.dims
        known, names, units, found_axis = _from_xarray(data)
        if time_axis is None:
            if found_axis not in (None, 0, data.ndim - 1):
                time = data.dims[found_axis]
                raise ValueError(f"the time '{time}' is between the other axes, {', '.join(map(str, data.dims))}; expected "
                                 f"it first or last: data.transpose('{time}', ...); or time_axis=0 or -1, for cuts and "
                                 "tracks along the first or last axis")
            time_axis = found_axis
        data = data.data if isinstance(data.data, np.ndarray) else data.values
    if isinstance(data, np.ma.MaskedArray):
        if np.ma.getmask(data) is not np.ma.nomask:
            mask = ~np.ma.getmaskarray(data) if mask is None else ~np.ma.getmaskarray(data) & np.asarray(mask, bool)
        data = data.data
    array = np.asarray(data)
    ndim = array.ndim
    if not 2 <= ndim <= 5:
        raise ValueError(f"the array has {ndim} axes; expected 2 to 5")
    array = _values(array)
    if mask is not None:
        array = _masked(array, mask if dims is None or not is_xarray(mask) else _in_order(mask, dims))
    if coords is None:
        coords = known if spacing is None and origin is None else None
    elif len(coords) != ndim:
        raise ValueError(f"coords has {len(coords)} entries; expected one for each of {ndim} axes")
    spacings, origins = _per_axis(spacing, ndim, "spacing", 1.0), _per_axis(origin, ndim, "origin", 0.0)
    if coords is not None and (spacing is not None or origin is not None):
        raise ValueError("coords with spacing or origin; expected the one or the other")
    for axis in range(ndim if coords is not None else 0):
        given = coords[axis]
        if given is not None and not isinstance(given, UniformAxis) and len(given) != array.shape[axis]:
            raise ValueError(f"axis {axis} has {array.shape[axis]} samples and {len(given)} coordinates; expected as many")
    axes = [UniformAxis(origins[a], spacings[a]) if coords is None or coords[a] is None else _axis(coords[a])
            for a in range(ndim)]
    names = _labels(axis_names if axis_names is not None else names, ndim, "axis_names")
    units = _labels(axis_units if axis_units is not None else units, ndim, "axis_units")
    is_reversed = turn_around(0 if time_axis is None else time_axis, ndim)
    matrix = _affine(affine, ndim)
    if not is_reversed:
        image = _tegl.Image(array, axes, None if matrix is None else matrix.tolist(), list(names), list(units))
    else:
        if matrix is not None:
            matrix = np.column_stack([matrix[::-1, ndim - 1::-1], matrix[::-1, ndim]])
        image = _tegl.Image(array.T, axes[::-1], None if matrix is None else matrix.tolist(), list(names)[::-1],
                            list(units)[::-1])
    return Prepared(image, is_reversed, names, units)


def _labels(labels, ndim: int, name: str) -> tuple[str, ...]:
    if labels is None:
        return ("",) * ndim
    if len(labels) != ndim:
        raise ValueError(f"{name} has {len(labels)} entries; expected one for each of {ndim} axes")
    return tuple(str(label) for label in labels)


def is_double(dtype) -> bool:
    """Whether coordinates are to be of double precision."""
    kind = np.dtype(dtype)
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype is {kind}; expected float32 or float64")
    return kind == np.dtype(np.float64)


def extract_options(*, triangulation="compact", ambiguity="low", direction="descent", close=False, epsilon=0.0,
                    normals=False, gradient="differences", threads=0) -> dict:
    """What `_tegl.extract` takes."""
    if threads is None:
        threads = 0
    if threads < 0:
        raise ValueError(f"threads is {threads}; expected 0 (all) or more")
    return {"triangulation": triangulation, "ambiguity": ambiguity, "direction": direction, "close": bool(close),
            "epsilon": float(epsilon), "normals": bool(normals), "gradient": gradient, "threads": int(threads)}
