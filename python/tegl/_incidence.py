# SPDX-License-Identifier: BSD-3-Clause
"""The incidence of a contour's simplices: found once, passed to several operations."""

from __future__ import annotations

import typing

import numpy as np

from . import _arguments, _tegl
from ._arguments import Progress


class Incidence:
    """Which simplices of a contour are around a vertex, and which is across a face. Computed once, it serves several
    operations on the same contour:

        incidence = tegl.Incidence(contour)
        report = contour.check(incidence=incidence)
        measures = contour.measure(incidence=incidence)

    `check`, `components`, `measure` and `track` accept it and give the same result in less time. They raise ValueError
    if the contour has other simplices than the one that it was made of. It takes memory, and does not keep the contour.
    """

    @_arguments.documents("Incidence")
    def __init__(self, contour: typing.Any, *, threads: int = 0, progress: Progress | None = None) -> None:
        """Finds the incidence of a contour."""
        self._core = _tegl.Incidence(_arguments.core_of(contour), _arguments.threads_of(threads), progress)
        self._is_reversed = contour._is_reversed

    @property
    def vertex_count(self) -> int:
        """Number of the contour's vertices."""
        return self._core.vertex_count

    @property
    def simplex_count(self) -> int:
        """Number of the contour's simplices."""
        return self._core.simplex_count

    @property
    def across(self) -> np.ndarray:
        """#S x N (uint32), read-only: at [s, i] the other simplex with the face of simplex s opposite to its vertex
        `contour.simplices[s, i]`; 2**32 - 1 if there is none (the face is in the boundary), 2**32 - 2 if there are
        several."""
        return self._core.across[:, ::-1] if self._is_reversed else self._core.across

    def around(self, vertex: int) -> np.ndarray:
        """The numbers of the simplices around a vertex (uint32), ascending, read-only."""
        return self._core.around(_arguments.as_whole("vertex", vertex, 0))

    def fits(self, contour: typing.Any) -> bool:
        """Whether it was made of a contour with these simplices and this number of vertices."""
        return self._core.fits(_arguments.core_of(contour))

    def __repr__(self) -> str:
        return f"<tegl.Incidence: {self.vertex_count} vertices, {self.simplex_count} simplices>"


def core_or_none(incidence: Incidence | None) -> _tegl.Incidence | None:
    """The library's incidence, of an argument `incidence`."""
    if incidence is None:
        return None
    if not isinstance(incidence, Incidence):
        raise TypeError(f"incidence is {incidence!r}; expected a tegl.Incidence of the contour, or None")
    return incidence._core
