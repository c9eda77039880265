# SPDX-License-Identifier: BSD-3-Clause
"""Samples of analytic fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from . import _arguments, _kinds, _tegl
from ._arguments import Progress

#: By lattice: its number of axes, and the step between layers, in steps along the other axes, that makes it regular.
LATTICES = {"triangular": (2, 3**0.5 / 2), "fcc": (3, 2**0.5 / 2), "bcc": (3, 0.5), "d4": (4, 0.5),
            "fcc_in_time": (4, 2**0.5 / 2)}


def lattice_spacing(lattice: str, ndim: int) -> list[float]:
    """The steps of a regular lattice along the library's axes."""
    across = ndim - (2 if lattice == "fcc_in_time" else 1)
    return [LATTICES[lattice][1] if axis == across else 1.0 for axis in range(ndim)]


@_arguments.documents("make_field", "make_expression")
def sample(field: str, shape: int | Sequence[int] = 64, *, ndim: int | None = None,
           limits: tuple[float, float] = (-1.0, 1.0), parameters: Mapping[str, float] | None = None, seed: int = 0,
           expression: bool | None = None, lattice: _kinds.Lattice | None = None, threads: int = 0,
           progress: Progress | None = None) -> np.ndarray:
    """Samples of a field: an array with the axes (t, z, y, x), float32.

    ::

        tegl.sample("gyroid", 64)                                   # 64 x 64 x 64 samples from -1 to 1
        tegl.sample("merging", (20, 48, 48, 48))                    # t, z, y, x
        tegl.sample("metaballs", 128, parameters={"count": 50}, seed=7)
        tegl.sample("min(0.8 - r, abs(x) - 0.2)", 64)               # an expression of x, y, z and r

    field
        A name of `tegl.fields()`, or an expression.
    shape, ndim
        The number of samples along each axis, or one number for all of `ndim` axes (default: the lattice's number, else
        3); on a lattice, the layers are then as many as the limits need.
    limits
        Coordinates of the first and the last sample along each axis.
    parameters, seed
        Parameters of a field by name, see `tegl.fields()`; the seed of "metaballs" and "noise". Not for expressions.
    expression
        Whether `field` is an expression; by default, if it is not a word.
    lattice
        The lattice of the samples: odd layers are shifted (see `tegl.contour`). The step between layers is then
        the regular lattice's, and the last coordinate along their axis differs.
    """
    axis_count = None if ndim is None else _arguments.as_whole("ndim", ndim, 2)
    if isinstance(shape, (int, np.integer)):
        sizes = [shape] * (axis_count or LATTICES.get(lattice or "", (3, 1.0))[0])
    else:
        sizes = list(shape)
        if axis_count not in (None, len(sizes)):
            raise ValueError(f"ndim is {axis_count}, but shape has {len(sizes)} axes; expected the same number")
    sizes = [_arguments.as_whole("shape", size, 2) for size in sizes]
    if not 2 <= len(sizes) <= 5:
        raise ValueError(f"shape has {len(sizes)} axes; expected 2 to 5")
    first, last = (_arguments.as_number("limits", one) for one in limits)
    if not first < last:
        raise ValueError(f"limits are {first:g} and {last:g}; expected the lower one first")
    text = _arguments.as_text("field", field)
    is_expression = not (text.isidentifier() and len(text) > 1) if expression is None else \
        _arguments.as_bool("expression", expression)
    axes = [(size, first, (last - first) / (size - 1)) for size in sizes[::-1]]
    if lattice is not None:
        across = len(axes) - (2 if lattice == "fcc_in_time" else 1)
        if lattice in LATTICES:
            step = axes[0][2] * LATTICES[lattice][1]
            # one number: as many layers as the limits need
            count = int((last - first) / step + 1e-9) + 1 if isinstance(shape, (int, np.integer)) else axes[across][0]
            axes[across] = (count, first, step)
    given = [(_arguments.as_text("a parameter", name), _arguments.as_number(f"parameters[{name!r}]", value))
             for name, value in (parameters or {}).items()]
    if is_expression and given:
        raise ValueError("parameters with an expression; expected them with the name of a field")
    if is_expression and seed != 0:
        raise ValueError(f"seed {seed} with an expression; expected it with \"metaballs\" or \"noise\"")
    return _tegl.sample_field(text, is_expression, axes, given, _arguments.as_whole("seed", seed, 0), lattice or "",
                              _arguments.as_whole("threads", threads, 0), progress).T


@_arguments.documents("fields")
def fields() -> dict[str, dict[str, float]]:
    """The names of the fields of `tegl.sample`, each with its parameters and their defaults."""
    return {name: parameters for name, _, _, _, parameters in _tegl.fields()}
