# SPDX-License-Identifier: BSD-3-Clause
"""The base of contours and facets: points whose columns are in the order of an array's axes."""

from __future__ import annotations

import typing

import numpy as np

from . import _tegl


class ArrayOrdered:
    """Points of a result of the library, with the columns in the order of the array's axes."""

    _core: _tegl.Contour | _tegl.Facets
    _is_reversed: bool  #: whether the library's axes are the array's in reverse order

    def _turned(self, rows: np.ndarray) -> np.ndarray:
        """A view with the columns turned around: of points and of simplices alike, so that orientation stays."""
        return rows[:, ::-1] if self._is_reversed else rows

    def _listed(self, per_axis: typing.Iterable) -> list:
        return list(per_axis)[::-1] if self._is_reversed else list(per_axis)

    @property
    def ndim(self) -> int:
        """N, the number of coordinates of a point."""
        return self._core.ndim

    @property
    def vertices(self) -> np.ndarray:
        """#V x N coordinates, row = vertex (of facets: point), columns in the order of the array's axes."""
        return self._turned(self._core.vertices)

    @property
    def normals(self) -> np.ndarray | None:
        """#V x N, of length 1, or 0 if the gradient vanishes; None if they were not requested."""
        normals = self._core.normals
        return None if normals is None else self._turned(normals)

    @property
    def axis_names(self) -> tuple[str, ...]:
        """Names of the columns of `vertices`; empty for an axis without one."""
        return tuple(self._listed(self._core.axis_names))

    @property
    def axis_units(self) -> tuple[str, ...]:
        """Units of the columns of `vertices`; empty for an axis without one."""
        return tuple(self._listed(self._core.axis_units))

    @property
    def periods(self) -> np.ndarray:
        """#P x N: the vectors by which a wrapped contour repeats itself, columns as in `vertices`; 0 x N for others."""
        numbers = np.array(self._core.periods).reshape(-1, 2 * self.ndim + 1)
        return self._turned(numbers[:, :self.ndim])
