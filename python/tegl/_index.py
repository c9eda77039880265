# SPDX-License-Identifier: BSD-3-Clause
"""Contours at many isovalues, or of one component, without reading all samples."""

from __future__ import annotations

import dataclasses
import os
import typing
from collections.abc import Sequence

import numpy as np

from . import _arguments, _kinds, _outside, _tegl
from ._arguments import Progress
from ._contour import Contour


@dataclasses.dataclass(frozen=True)
class PickReport:
    """The result of a search from a point."""

    found: bool  #: whether any tile is active
    tile: tuple[int, ...]  #: the lowest corner of the active tile nearest to the point, in the order of the array's axes
    distance: float  #: from the point to that tile, in steps of the grid
    tiles: int  #: number of tiles reached from it
    components: int  #: number of the contour's components in those tiles; one was picked


class Index:
    """An index of the active tiles of an array, built once. It gives contours at any isovalue without reading all samples.

    The array's values must not change; the index keeps the array. For arrays of 2 to 4 axes.
    """

    @_arguments.documents("build_active_tiles", "ActiveMethod")
    def __init__(self, array, method: _kinds.IndexMethod = "interval-tree", *, spacing=None, origin=None, coords=None,
                 affine=None, mask=None, axis_names=None, axis_units=None, time_axis: int | None = None, threads: int = 0,
                 progress: Progress | None = None) -> None:
        """Builds an index. Arguments as in `tegl.contour`; methods: "interval-tree", "span-space", "min-max-tree",
        "seed-set", "full-scan"."""
        self._prepared = _arguments.prepare(array, spacing=spacing, origin=origin, coords=coords, affine=affine,
                                            mask=mask, axis_names=axis_names, axis_units=axis_units,
                                            time_axis=time_axis)
        with self._prepared.terms():
            self._core = _tegl.build_index(self._prepared.image, _arguments.as_text("method", method),
                                           _arguments.threads_of(threads), progress)

    @classmethod
    @_arguments.documents("read_active_tiles")
    def load(cls, path: str | os.PathLike, array, *, threads: int = 0, progress: Progress | None = None,
             **grid: typing.Any) -> Index:
        """Reads an index of this array, written by `save` or `tegl index`."""
        self = cls.__new__(cls)
        self._prepared = _arguments.prepare(array, **grid)
        name = os.fspath(path)
        with self._prepared.terms(about=name):
            self._core = _tegl.load_index(name, self._prepared.image, _arguments.threads_of(threads), progress)
        return self

    @_arguments.documents("write_active_tiles")
    def save(self, path: str | os.PathLike) -> None:
        """Writes a file, .tindex."""
        self._core.save(os.fspath(path))

    @property
    def method(self) -> _kinds.IndexMethod:
        """How active tiles are found, as given."""
        return self._core.method

    @property
    def memory(self) -> int:
        """Bytes beside the array."""
        return self._core.memory

    def __repr__(self) -> str:
        shape = self._prepared.image.array.shape
        return f"<tegl.Index {self.method} of {' x '.join(map(str, self._prepared.turned(shape)))}: {self.memory} bytes>"

    def contour(self, level: float, *, dtype=np.float32, allow_empty: bool = False, progress: Progress | None = None,
                **options: typing.Any) -> Contour:
        """What `tegl.contour` of the array gives, byte by byte. Options as there: triangulation, normals, ..."""
        is_double, chosen = _arguments.is_double(dtype, self._prepared), self._prepared.library_options(
            _arguments.extract_options(**options))
        level, allow_empty = _arguments.as_level(level), _arguments.as_bool("allow_empty", allow_empty)
        with self._prepared.terms():
            core = self._core.contour(level, is_double, chosen, progress)
        if not allow_empty and not len(core.simplices):
            _outside.require_level(self._prepared, level)
        return Contour._of(core, self._prepared.is_reversed, self._prepared.extent, self._prepared.image.grid)

    def active_tiles(self, level: float) -> np.ndarray:
        """The lowest corners of the tiles that the contour passes: #T x N indices, in the order of the array's axes. None
        for a level outside of the array's values."""
        sizes = [size - 1 for size in self._prepared.image.array.shape]
        found = self._core.find(_arguments.as_level(level))
        corners = np.column_stack(np.unravel_index(found, sizes, order="F")) if len(found) else \
            np.empty((0, len(sizes)), dtype=np.intp)
        return corners[:, ::-1] if self._prepared.is_reversed else corners

    @typing.overload
    def pick(self, point: Sequence[float] | np.ndarray, level: float, *, dtype: typing.Any = ...,
             allow_empty: bool = False, return_report: typing.Literal[False] = False, progress: Progress | None = None,
             **options: typing.Any) -> Contour: ...

    @typing.overload
    def pick(self, point: Sequence[float] | np.ndarray, level: float, *, dtype: typing.Any = ...,
             allow_empty: bool = False, return_report: typing.Literal[True], progress: Progress | None = None,
             **options: typing.Any) -> tuple[Contour, PickReport]: ...

    @_arguments.documents("extract_component")
    def pick(self, point, level: float, *, dtype=np.float32, allow_empty: bool = False, return_report: bool = False,
             progress: Progress | None = None, **options: typing.Any) -> Contour | tuple[Contour, PickReport]:
        """The component of the contour that is nearest to a point, in the array's coordinates.

        The search starts at the point and does not use the index. With `return_report`: (contour, PickReport).
        """
        numbers = _arguments.as_numbers("point", point, "its coordinates along the array's axes")
        is_double, chosen = _arguments.is_double(dtype, self._prepared), self._prepared.library_options(
            _arguments.extract_options(**options))
        level, allow_empty = _arguments.as_level(level), _arguments.as_bool("allow_empty", allow_empty)
        is_reported = _arguments.as_bool("return_report", return_report)
        with self._prepared.terms():
            core, report = _tegl.extract_component(self._prepared.image, level, self._prepared.turned(numbers), is_double,
                                                   chosen, progress)
        if not allow_empty and not report["found"]:
            _outside.require_level(self._prepared, level)
        result = Contour._of(core, self._prepared.is_reversed, self._prepared.extent, self._prepared.image.grid)
        report["tile"] = tuple(self._prepared.turned(report["tile"]))
        return (result, PickReport(**report)) if is_reported else result
