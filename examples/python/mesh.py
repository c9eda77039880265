#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh: two balls on a mesh of tetrahedra meet. When, where, and how large are they?

    examples/python/mesh.py

The mesh has values at five times, and its points move; the answers lie between the times. The cells (# %%) are those of a
notebook.
"""

# %% A mesh: a box of cubes, each divided into six tetrahedra
import itertools

import numpy as np
import tegl

size = (25, 13, 13)
z, y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in size[::-1]), indexing="ij")
points = np.stack([2 * x.ravel(), y.ravel(), z.ravel()], axis=1)
numbers = np.arange(len(points)).reshape(size[::-1])
cubes = numbers[:-1, :-1, :-1].ravel()
steps = (1, size[0], size[0] * size[1])
tetrahedra = np.concatenate([np.stack([cubes, cubes + a, cubes + a + b, cubes + a + b + c], axis=1)
                             for a, b, c in itertools.permutations(steps)])
print(f"{len(points)} points, {len(tetrahedra)} tetrahedra")

# %% Values at five times: two balls of radius 0.5, which touch where the distance of their centres is 1. The box swells.
times = np.linspace(0, 4, 5)
places = [points * (1, 1 + 0.02 * t, 1) for t in times]
values = [0.5 - np.minimum(*(np.linalg.norm(p - (sign * (1.1 - 0.2 * t), 0, 0), axis=1) for sign in (-1, 1)))
          for p, t in zip(places, times)]

# %% One contour in space and time: tetrahedra in 4D
contour = tegl.contour_mesh(places, {"tetra": tetrahedra}, values, 0.0, times=times, dtype=np.float64)
print(contour, "manifold:", contour.check().is_manifold)
assert contour.check().is_manifold

# %% What becomes of the parts?
graph = contour.track(times=5)
for event in graph.events:
    print(f"t = {event.time:5.2f}: {event.kind}, at " + ", ".join(f"{name} = {at:.2f}" for name, at in zip("xyz", event.place)))
merge = next(event for event in graph.events if event.kind == "merge")
# The mesh's step along x is 1/6: a gap narrower than that is not seen.
assert 2.0 < merge.time <= 3.1 and np.abs(merge.place).max() < 0.2

# %% The surfaces before and after, at any time
for at in (merge.time - 0.2, merge.time + 0.2):
    surface = contour.slice(at)
    report = surface.check()
    print(f"t = {at:.2f}: {report.components} components, closed: {report.is_closed}, volume {surface.measure().content:.3f}")
    assert report.is_closed and report.components == (2 if at < merge.time else 1)
