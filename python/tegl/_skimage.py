# SPDX-License-Identifier: BSD-3-Clause
"""marching_cubes with the interface of scikit-image 0.19.3."""

from __future__ import annotations

import numpy as np

from . import _arguments, _tegl


def marching_cubes(volume, level=None, *, spacing=(1.0, 1.0, 1.0), gradient_direction="descent", step_size=1,
                   allow_degenerate=True, method="lewiner", mask=None
                   ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Surfaces of a volume, with the arguments and the results of skimage.measure.marching_cubes.

    Returns (verts, faces, normals, values): #V x 3 coordinates in the order of the volume's axes, #F x 3 vertex numbers,
    #V x 3 normals towards lower values, and for each vertex the largest range of the samples of a cube around it.

    docs/scikit-image.md lists the differences. In short: the vertices are the same, in another order, each once; surfaces
    are manifolds for all values; NaN is a missing value; the volume is not copied.

    level
        Default: the mean of minimum and maximum. As in scikit-image, samples *above* the level are inside.
    gradient_direction
        "descent": values inside are higher, and faces are clockwise seen from outside (scikit-image's left-hand rule);
        "ascent": the reverse.
    step_size
        Only every step_size-th sample along each axis is used.
    allow_degenerate
        False: coincident vertices are merged, and triangles with two equal corners are removed.
    method
        Ambiguous cubes: "lewiner": resolved by the trilinear interpolant; "lorensen": by a fixed rule.
    mask
        True for the cubes to be contoured, by their corner with the highest indices (as in scikit-image).
    """
    is_whole = _arguments.as_bool("allow_degenerate", allow_degenerate)
    data, level, step = _checked(volume, level, spacing, step_size, method, mask)
    if gradient_direction not in ("descent", "ascent"):
        raise ValueError(f"Incorrect input {gradient_direction} in `gradient_direction`, see docstring.")
    prepared = _arguments.prepare(data[::step, ::step, ::step])
    # Samples at the level are high in tegl and low in scikit-image.
    above = np.nextafter(level, np.inf)
    options = prepared.library_options(
        _arguments.extract_options(ambiguity="saddle" if method == "lewiner" else "low", normals=True))
    cubes = None if mask is None else _arguments.booleans(mask)[::step, ::step, ::step].T
    if cubes is None or cubes[1:, 1:, 1:].all():
        core = _tegl.extract(prepared.image, above, False, options, None)
    else:
        core = _tegl.extract_masked(prepared.image, cubes, above, options)
    if not len(core.vertices):
        raise RuntimeError("No surface found at the given iso value.")
    values = _tegl.ranges_around(prepared.image, core)
    verts, simplices, normals = core.take_arrays()
    verts, normals, faces = verts[:, ::-1], normals[:, ::-1], simplices.view(np.int32)
    # With the columns reversed, triangles have the library's orientation, which is the opposite of scikit-image's.
    if gradient_direction == "ascent":
        faces = faces[:, ::-1]
    if step != 1:
        verts = verts * verts.dtype.type(step)
    if not np.array_equal(spacing, (1, 1, 1)):
        verts = verts * np.asarray(spacing, dtype=np.float64)
    if not is_whole:
        kept, faces = _tegl.weld(verts, faces)
        verts, normals, values = verts[kept], normals[kept], values[kept]
    return verts, faces, normals, values


def _checked(volume, level, spacing, step_size, method, mask) -> tuple[np.ndarray, float, int]:
    """The volume, the level, the step. Errors have the messages of scikit-image."""
    if method not in ("lewiner", "lorensen", "_lorensen"):
        raise ValueError("method should be one of 'lewiner', 'lorensen' or '_lorensen'.")
    if method == "_lorensen" and mask is not None:
        raise NotImplementedError('Parameter `mask` is not implemented for method "_lorensen" and will be ignored.')
    if not isinstance(volume, np.ndarray) or volume.ndim != 3:
        raise ValueError("Input volume should be a 3D numpy array.")
    if min(volume.shape) < 2:
        raise ValueError("Input array must be at least 2x2x2.")
    least, greatest = np.nanmin(volume), np.nanmax(volume)
    if level is None:
        level = 0.5 * (float(least) + float(greatest))
    else:
        level = _arguments.as_level(level)
        if not least <= level <= greatest:
            raise ValueError("Surface level must be within volume data range.")
    if len(spacing) != 3:
        raise ValueError("`spacing` must consist of three floats.")
    if int(_arguments.as_number("step_size", step_size)) < 1:
        raise ValueError("step_size must be at least one.")
    if mask is not None and np.shape(mask) != volume.shape:
        raise ValueError("volume and mask must have the same shape.")
    return volume, level, int(step_size)
