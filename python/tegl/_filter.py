# SPDX-License-Identifier: BSD-3-Clause
"""Filters of arrays."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Sequence

import numpy as np

from . import _arguments, _kinds, _tegl
from ._arguments import Progress
from ._image import Image

_SIGMAS = ("gaussian", "discrete_gaussian", "binomial", "bilateral")


@_arguments.documents("filter_image")
def filter(array, *, gaussian=None, discrete_gaussian=None, binomial=None, median=None, bilateral=None,
           contextual: float | None = None, curvature: float | None = None, kernel=None, value_sigma: float | None = None, samples: bool = False,
           border: _kinds.FilterBorder | Sequence[_kinds.FilterBorder] = "extended", fill: bool = False, spacing=None,
           origin=None, coords=None, affine=None, mask=None, axis_names: Sequence[str] | None = None,
           axis_units: Sequence[str] | None = None, time_axis: int | None = None, threads: int = 0,
           progress: Progress | None = None) -> typing.Any:
    """An array after a filter: of the same shape, float32, or float64 for an array of float64.

    ::

        tegl.filter(volume, gaussian=1.5)                          # sigma in units of the axes (spacing=)
        tegl.filter(film, gaussian=(0.5, 2, 2, 2), samples=True)   # t, z, y, x, in samples
        tegl.filter(scan, median=1)                                # a box of 3 samples along each axis
        tegl.filter(scan, bilateral=2, value_sigma=30)
        tegl.filter(mask, contextual=0.5)                          # for the contour at 0.5
        tegl.filter(mask, curvature=2)                             # curvature flow of this duration
        tegl.filter(picture, kernel=[[1, 2, 1], [2, 4, 2], [1, 2, 1]])

    gaussian, discrete_gaussian, binomial, bilateral
        Sigma in units of the axes: one number for all, or one for each axis of the array; 0: not along this axis.
    median
        Radius of the box in samples: one number, or one for each axis.
    contextual
        The level of a contour whose steps are smoothed and whose details stay.
    curvature
        Duration of the curvature flow, in the square of the axes' unit: a ball of radius r gets the radius
        sqrt(r**2 - 4 * curvature) in 3D. The time axis of an array of 4 axes does not take part.
    kernel
        Weights a with as many axes as the array, odd sizes, and the centre in the middle: sum of a[l] * array[x + l].
    value_sigma
        With `bilateral`: sigma of the values.
    samples
        Whether sigmas, and the time of the flow, count samples.
    border
        Samples beyond the border: "extended" (as the nearest one), "cyclic" or "missing"; one word, or one for each axis.
    fill
        Whether missing samples (NaN) get values from their neighbours. Otherwise they stay missing.
    spacing, origin, coords, affine, mask, axis_names, axis_units, time_axis, threads, progress
        As for `tegl.contour`.

    An image from `tegl.read` gives an image, with the same coordinates.
    """
    given = {name: value for name, value in (
        ("gaussian", gaussian), ("discrete_gaussian", discrete_gaussian), ("binomial", binomial), ("median", median),
        ("bilateral", bilateral), ("contextual", contextual), ("curvature", curvature),
        ("kernel", kernel)) if value is not None}
    if len(given) != 1:
        raise ValueError(f"{' and '.join(given) or 'no filter'}; expected one of gaussian, discrete_gaussian, binomial, "
                         "median, bilateral, contextual, curvature, kernel")
    kind, value = next(iter(given.items()))
    if (value_sigma is not None) != (kind == "bilateral"):
        raise ValueError("bilateral without value_sigma; expected the sigma of the values" if kind == "bilateral" else
                         f"value_sigma with {kind}; expected it with bilateral")
    if _arguments.as_bool("samples", samples) and kind not in (*_SIGMAS, "curvature"):
        raise ValueError(f"samples with {kind}, which has no sigma")
    prepared = _arguments.prepare(array, spacing=spacing, origin=origin, coords=coords, affine=affine, mask=mask,
                                  allow_curved=True, axis_names=axis_names, axis_units=axis_units, time_axis=time_axis)
    numbers, sizes = _numbers(kind, value, prepared)
    with prepared.terms():
        result = _tegl.filter(prepared.image, kind.replace("_", "-"), numbers, sizes,
                              _value(value_sigma, curvature), samples,
                              _borders(border, prepared), _arguments.as_bool("fill", fill),
                              _arguments.as_whole("threads", threads, 0), progress)
    result = result.T if prepared.is_reversed else result
    return dataclasses.replace(array, array=result) if isinstance(array, Image) else result


def _value(value_sigma: float | None, curvature: float | None) -> float:
    """The number of the filter that is not by axis."""
    if curvature is not None:
        return _arguments.as_number("curvature", curvature)
    return 0.0 if value_sigma is None else _arguments.as_number("value_sigma", value_sigma)


def _numbers(kind: str, value, prepared: _arguments.Prepared) -> tuple[list[float], list[int]]:
    """Sigmas, weights or the level; and radii or sizes: both in the library's order of axes."""
    if kind == "contextual":
        return [_arguments.as_number(kind, value)], []
    if kind == "curvature":
        return [0.0 if prepared.ndim == 4 and axis == 3 else 1.0 for axis in range(prepared.ndim)], []
    if kind == "kernel":
        weights = np.asarray(value, dtype=np.float64)
        if weights.ndim != prepared.ndim:
            raise ValueError(f"kernel has {weights.ndim} axes; expected {prepared.ndim}, as the array")
        weights = weights.T if prepared.is_reversed else weights
        return weights.ravel(order="F").tolist(), list(weights.shape)
    many = isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, str)
    each = list(value) if many else [value] * prepared.ndim
    if len(each) != prepared.ndim:
        raise ValueError(f"{kind} has {len(each)} numbers; expected one, or one for each of {prepared.ndim} axes")
    each = prepared.turned(each)
    if kind == "median":
        return [], [_arguments.as_whole(kind, one, 0) for one in each]
    return [_arguments.as_number(kind, one) for one in each], []


@_arguments.documents("ScaleSpaceLayers")
def scale_space(array, sigmas, *, laplacian: bool = False, factors=None, samples: bool = False,
                border: _kinds.FilterBorder | Sequence[_kinds.FilterBorder] = "extended", fill: bool = False, spacing=None,
                origin=None, coords=None, affine=None, mask=None, axis_names: Sequence[str] | None = None,
                axis_units: Sequence[str] | None = None, time_axis: int | None = None, threads: int = 0,
                progress: Progress | None = None) -> Image:
    """The array smoothed at many scales: an image with one more axis, log2_sigma, which is its time axis.

    ::

        scales = tegl.scale_space(picture, numpy.geomspace(0.5, 16, 24))
        surface = tegl.contour(scales, 0.5)                # the contours over the scale
        line = surface.slice(log2_sigma=1.5)               # the contour at sigma = 2**1.5
        graph = surface.track()                            # which parts vanish at which scale

    sigmas
        The scales, ascending, in units of the axes: sigma of the discrete Gaussian.
    laplacian
        Whether to give the scale-normalised Laplacian instead of the values: greatest at blobs of this scale.
    factors
        By axis of the array: sigma along it as a multiple of the scale; 0 for an axis that is not smoothed, as a time.
    samples, border, fill
        As for `tegl.filter`.
    spacing, origin, coords, affine, mask, axis_names, axis_units, time_axis, threads, progress
        As for `tegl.contour`.

    For arrays of 2 to 4 axes. The scale is the first axis of the result, or the last one with `time_axis=-1`.
    """
    prepared = _arguments.prepare(array, spacing=spacing, origin=origin, coords=coords, affine=affine, mask=mask,
                                  axis_names=axis_names, axis_units=axis_units, time_axis=time_axis)
    scales = _arguments.as_numbers("sigmas", sigmas)
    along = [] if factors is None else prepared.turned(_arguments.as_numbers("factors", factors))
    with prepared.terms():
        result = _tegl.scale_space(prepared.image, scales, along, _arguments.as_bool("laplacian", laplacian),
                                   _arguments.as_bool("samples", samples), _borders(border, prepared),
                                   _arguments.as_bool("fill", fill), _arguments.as_whole("threads", threads, 0), progress)
    return _with_scales(array, prepared, result.T if prepared.is_reversed else result, scales)


def _borders(border, prepared: _arguments.Prepared) -> list[str]:
    if isinstance(border, str):
        return [border]
    return prepared.turned(_arguments.as_list("border", border, "a word, or a word for each axis"))


def _with_scales(array, prepared: _arguments.Prepared, values: np.ndarray, scales: Sequence[float]) -> Image:
    logarithms = np.log2(np.asarray(scales, dtype=np.float64))
    put = (lambda rest, one: (one, *rest)) if prepared.is_reversed else (lambda rest, one: (*rest, one))
    axes = tuple(prepared.axes)
    ndim = prepared.ndim
    coords = tuple(axis.origin + np.arange(size) * axis.step if isinstance(axis, _arguments.UniformAxis) else np.asarray(axis)
                   for axis, size in zip(axes, values.shape[1:] if prepared.is_reversed else values.shape[:-1]))
    affine = prepared.affine
    if affine is not None:
        wide = np.eye(ndim + 1, ndim + 2)
        first = 1 if prepared.is_reversed else 0
        wide[first:first + ndim, first:first + ndim] = affine[:ndim, :ndim]
        wide[first:first + ndim, ndim + 1] = affine[:ndim, ndim]
        affine = wide
    known = array if isinstance(array, Image) else None
    return Image(array=values, coords=put(coords, logarithms), axis_names=put(prepared.names, "log2_sigma"),
                 axis_units=put(prepared.units, ""), affine=affine, time_axis=0 if prepared.is_reversed else ndim,
                 value_name=known.value_name if known else "", value_unit=prepared.value_unit, format="scale space",
                 variable=known.variable if known else "", variables=(),
                 world_frame=known.world_frame if known else "",
                 axis_directions=put(known.axis_directions if known else ("unknown",) * ndim, "unknown"),
                 _axes=put(axes, logarithms))


@_arguments.documents("most_stable_scale")
def most_stable_scale(sigmas, measures) -> tuple[float, float]:
    """The scale at which a measure of the contour changes least, and d ln(measure) / d ln(sigma) there.

    The scale is NaN if there is none: at fewer than three scales in a row the measure is above 0.
    """
    sigma, change = _tegl.most_stable_scale(_arguments.as_numbers("sigmas", sigmas),
                                            _arguments.as_numbers("measures", measures))
    return (sigma, change) if sigma else (float("nan"), float("nan"))
