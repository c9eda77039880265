# SPDX-License-Identifier: BSD-3-Clause
"""The tracks of the parts of a moving contour: events, and the segments between them."""

from __future__ import annotations

import dataclasses
import importlib
import os
import typing

import numpy as np

from . import _arguments, _kinds, _tegl


@dataclasses.dataclass(frozen=True)
class TrackEvent:
    """A moment at which parts appear, merge, split or vanish."""

    kind: _kinds.EventKind
    time: float
    place: np.ndarray  #: the other coordinates, in the order of the array's axes
    vertex: int
    at_border: bool
    segments_in: list[int]  #: segments that end here
    segments_out: list[int]  #: segments that start here
    euler_change: int


@dataclasses.dataclass(frozen=True)
class TrackHandle:
    """A change of the topology of one part, without a change of the number of parts."""

    time: float
    place: np.ndarray
    vertex: int
    at_border: bool
    segment: int
    euler_change: int


@dataclasses.dataclass(frozen=True)
class TrackSample:
    """A part at one time."""

    time: float
    measure: float  #: area; for 3D contours length
    content: float  #: enclosed volume (or area); NaN: open
    centroid: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@dataclasses.dataclass(frozen=True)
class TrackSegment:
    """One part between two events."""

    event_from: int
    event_to: int
    start: float
    end: float
    track: int
    size_at_start: int
    size_at_end: int
    euler_at_start: int
    euler_at_end: int
    samples: list[TrackSample]


@dataclasses.dataclass(frozen=True)
class Track:
    """A part that continues through merges and splits, as the largest of the parts involved."""

    number: int
    segments: list[int]
    start: float
    end: float


class TrackGraph:
    """The Reeb graph of the time on a contour: events, and the segments of parts between them."""

    def __init__(self, core: _tegl.TrackGraph, is_reversed: bool, unit: str,
                 given: typing.Mapping[float, float] | None = None) -> None:
        """`given`: times of samples as the caller gave them, by those in the data."""
        self._core = core
        self._unit = unit

        def turned(found: dict[str, typing.Any], *names: str) -> dict[str, typing.Any]:
            return {**found, **{name: np.array(found[name][::-1] if is_reversed else found[name]) for name in names}}

        self.events: list[TrackEvent] = [TrackEvent(**turned(one, "place")) for one in core.events()]
        self.handles: list[TrackHandle] = [TrackHandle(**turned(one, "place")) for one in core.handles()]
        self.tracks: list[Track] = [Track(**one) for one in core.tracks()]

        def segment(one: dict[str, typing.Any]) -> TrackSegment:
            times = given or {}
            for sample in one["samples"]:
                sample["time"] = times.get(sample["time"], sample["time"])
            one["samples"] = [TrackSample(**turned(sample, "centroid", "lower", "upper")) for sample in one["samples"]]
            return TrackSegment(**one)

        self.segments: list[TrackSegment] = [segment(one) for one in core.segments()]

    @property
    def first(self) -> float:
        """The time at which the data begin."""
        return self._core.first

    @property
    def last(self) -> float:
        """The time at which the data end."""
        return self._core.last

    @property
    def time_unit(self) -> str:
        """Unit of the times; may be empty."""
        return self._unit

    @property
    def simplex_segments(self) -> np.ndarray:
        """#S: the segment of each simplex, 2**32 - 1 for none; empty without `label_simplices`."""
        return self._core.simplex_segments

    def __repr__(self) -> str:
        return f"<tegl.TrackGraph: {len(self.events)} events, {len(self.segments)} segments, {len(self.tracks)} tracks>"

    def to_dict(self) -> dict[str, typing.Any]:
        """The graph as dicts and lists of numbers, for json."""

        def plain(value):
            if isinstance(value, np.ndarray):
                return value.tolist()
            if dataclasses.is_dataclass(value) and not isinstance(value, type):
                return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
            if isinstance(value, list):
                return [plain(one) for one in value]
            return value

        return {"first": self.first, "last": self.last, "time_unit": self._unit, "events": plain(self.events),
                "segments": plain(self.segments), "tracks": plain(self.tracks), "handles": plain(self.handles)}

    def to_networkx(self) -> typing.Any:
        """A networkx.MultiDiGraph: events are nodes and segments edges, with their fields. Needs networkx."""
        try:
            networkx = importlib.import_module("networkx")
        except ImportError as error:
            raise ImportError(f"to_networkx needs networkx, which cannot be imported: {error}") from error
        graph = networkx.MultiDiGraph(first=self.first, last=self.last, time_unit=self._unit)
        for number, event in enumerate(self.events):
            graph.add_node(number, **{field.name: getattr(event, field.name) for field in dataclasses.fields(event)})
        for number, segment in enumerate(self.segments):
            known = {field.name: getattr(segment, field.name) for field in dataclasses.fields(segment)}
            graph.add_edge(known.pop("event_from"), known.pop("event_to"), key=number, **known)
        return graph

    @_arguments.documents("write_track")
    def save(self, path: str | os.PathLike, *, title: str = "") -> None:
        """Writes .json, .dot (graphviz) or a picture, .svg."""
        _tegl.write_track(self._core, os.fspath(path), _arguments.as_text("title", title))
