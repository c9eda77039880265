# SPDX-License-Identifier: BSD-3-Clause
"""What a type checker knows of code that uses tegl: test_types.py has mypy look at it. It is not run."""
# mypy: disallow-untyped-calls, disallow-untyped-defs, disallow-any-generics, warn-return-any, strict-equality

import datetime
import pathlib
from typing import Any, List, Literal, Optional, Tuple, Union

import numpy as np
import tegl
from typing_extensions import assert_type

volume = np.zeros((4, 5, 6, 7))
contour = tegl.contour(volume, 0.5, spacing=(1, 2, 3, 4), normals=True)
assert_type(contour, tegl.Contour)
assert_type(tegl.contour(volume, 0.5, positions=lambda first, second, level: (level - first) / (second - first)), tegl.Contour)
assert_type(contour.isovalue, Optional[float])
assert_type(contour.ndim, int)
assert_type(contour.axis_names, Tuple[str, ...])
assert_type(contour.check().is_closed, bool)
shared = tegl.Incidence(contour, threads=2)
assert_type(contour.check(incidence=shared), tegl.MeshReport)
assert_type(contour.measure(incidence=shared), tegl.Measures)
assert_type(tegl.track(contour, incidence=shared), tegl.TrackGraph)
assert_type(len(contour.components(incidence=shared)), int)
assert_type(shared.fits(contour), bool)
assert_type(len(shared.around(3)), int)
assert_type(contour.normals is None, bool)

# Cuts: one place is a contour, several are a list.
assert_type(contour.slice(1.5), tegl.Contour)
assert_type(contour.slice(1.5).slice(at=2), tegl.Contour)
assert_type(contour.slice("2020-02-15"), tegl.Contour)
assert_type(contour.slice(datetime.datetime(2020, 2, 15)), tegl.Contour)
assert_type(contour.slice(np.datetime64("2020-02-15")), tegl.Contour)
assert_type(contour.slice(datetime.timedelta(hours=3)), tegl.Contour)
assert_type(contour.slice(lat=40.0), tegl.Contour)
assert_type(contour.slice(normal=(0, 1, 1, 0), offset=9), tegl.Contour)
assert_type(contour.frame_of(normal=(0, 1, 1, 0), offset=9), tegl.Frame)
assert_type(tegl.frame_of(contour, normal=np.ones(4), offset=9.5).axes.shape, Tuple[int, ...])
assert_type(contour.slice([1.5, 2]), List[tegl.Contour])
assert_type(contour.slice(np.linspace(0, 3, 4)), List[tegl.Contour])
assert_type(contour.slice(lat=[1.5, 2]), Union[tegl.Contour, List[tegl.Contour]])
assert_type(contour.slice([1.5, 2])[0].vertices.shape, Tuple[int, ...])
assert_type(tegl.slice(contour, at=1.5), tegl.Contour)
assert_type(tegl.slice(contour, lat=1.5), tegl.Contour)
assert_type(tegl.slice(contour, at=(1.5, 2)), List[tegl.Contour])
assert_type(tegl.slice(volume, 0.5, at=1.5, normals=True), tegl.Contour)
assert_type(tegl.slice(volume, 0.5, at=[1.5]), List[tegl.Contour])

# What is done with contours.
assert_type(contour.measure(), tegl.Measures)
assert_type(contour.measure().content, Optional[float])
assert_type(tegl.measure(contour), tegl.Measures)
assert_type(tegl.measure(contour, at=[1, 2]), tegl.CutMeasures)
assert_type(tegl.measure(contour, at=1.5), tegl.CutMeasures)
assert_type(contour.measure(at=[1, 2]), tegl.CutMeasures)
assert_type(contour.measure(at="2020-02-15", allow_empty=True).size.shape, Tuple[int, ...])
assert_type(contour.components(), tegl.Components)
assert_type(contour.components()[0], tegl.Component)
assert_type(contour.components()[:2], List[tegl.Component])
assert_type([component.size for component in contour.components()], List[float])
assert_type(contour.components().largest(), tegl.Contour)
assert_type(contour.components().split(), List[tegl.Contour])
assert_type(contour.simplify(ratio=0.5), tegl.Contour)
assert_type(contour.simplify(0.5, method="facets", border="within", scale="auto"), tegl.Contour)
assert_type(contour.simplify(0.5, scale=(1, 1, 1, 2), return_stats=True), Tuple[tegl.Contour, tegl.SimplifyStats])
assert_type(contour.simplify(ratio=0.5, return_stats=True), Tuple[tegl.Contour, tegl.SimplifyStats])
assert_type(tegl.simplify(contour, ratio=0.5), tegl.Contour)
assert_type(tegl.simplify(contour, ratio=0.5, return_stats=True)[1].rounds, int)
assert_type(contour.elements(by_cell=True).sum(), tegl.ElementSum)
assert_type(contour.track(times=5), tegl.TrackGraph)
assert_type(contour.track(times=[1.0, 2.5], first="2020-01-01", allow_empty=True, handles=False), tegl.TrackGraph)
assert_type(tegl.contour(volume, 0.5, normals="flat", allow_empty=True), tegl.Contour)
assert_type(tegl.track(contour).events[0], tegl.TrackEvent)
assert_type(tegl.track(contour).events[0].time, float)
assert_type(tegl.simplify(contour, 0.5, return_stats=True)[1].end, Literal["count", "error", "shape", "rounds"])
assert_type(tegl.Index(volume).method, Literal["full-scan", "interval-tree", "span-space", "min-max-tree", "seed-set"])

# Indexes, files, scikit-image's.
index = tegl.Index(volume)
assert_type(index.contour(0.5), tegl.Contour)
assert_type(index.pick((1, 2, 3, 4), 0.5), tegl.Contour)
assert_type(index.pick((1, 2, 3, 4), 0.5, return_report=True), Tuple[tegl.Contour, tegl.PickReport])
assert_type(tegl.load("surface.ply"), tegl.Contour)
assert_type(tegl.read("ocean.nc", "temp"), tegl.Image)
assert_type(tegl.read([pathlib.Path("a.nrrd"), pathlib.Path("b.nrrd")], times=[0, 2], sort="name"), tegl.Image)
assert_type(tegl.read(["a.nrrd", "b.nrrd"], time_step=0.5).contour(3.0), tegl.Contour)
assert_type(tegl.read("scan", series="T1").axis_directions, Tuple[Literal["up", "down", "unknown"], ...])
assert_type(tegl.read("scan").to_xarray(), Any)
verts, faces, normals, values = tegl.marching_cubes(volume[0], 0.5)
assert_type(len(faces), int)


def stop(fraction: float) -> bool:
    return fraction < 0.5


assert_type(tegl.contour(volume, 0.5, progress=stop).direction, Literal["descent", "ascent"])


def either(at: Union[float, List[float]]) -> None:
    assert_type(contour.slice(at), Union[tegl.Contour, List[tegl.Contour]])


# What is wrong is found: an ignored error that is none is an error itself.
tegl.contour()  # type: ignore[call-arg]
tegl.contour(volume, 0.5, spacings=3)  # type: ignore[call-arg]
tegl.contour(volume, 0.5, normals="yes")  # type: ignore[arg-type]
tegl.contour(volume, 0.5, ambiguity="most")  # type: ignore[arg-type]
tegl.contour(volume, "0.5")  # type: ignore[arg-type]
contour.simplify(0.5, method="best")  # type: ignore[call-overload]
contour.simplify(0.5, ratios=2)  # type: ignore[call-overload]
contour.track(handle=False)  # type: ignore[call-arg]
contour.slice(1.5, allow_empty="yes")  # type: ignore[call-overload]
tegl.Index(volume, "tree")  # type: ignore[arg-type]
contour.measure(at=1.5, incidence=shared)  # type: ignore[call-overload]
contour.check(incidence=contour)  # type: ignore[arg-type]
contour.vertex  # type: ignore[attr-defined]
contour.slice([1.5, 2]).vertices  # type: ignore[attr-defined]
contour.vertices = volume  # type: ignore[misc]
tegl.read(3)  # type: ignore[arg-type]
tegl.check(volume)  # type: ignore[arg-type]
tegl.load("surface.ply", progress=3)  # type: ignore[arg-type]
