#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulation: two balls meet. When, where, and how large are they?

    examples/python/simulation.py

A field over time, given by a formula and sampled in 13 steps; the answers lie between the steps. The cells (# %%) are
those of a notebook.
"""

# %% Two balls of radius 1 on the x axis, their centres at -2 + 0.15 t and 2 - 0.15 t: they touch at t = 20/3
import numpy as np
import tegl

time, space = np.arange(13.0), np.linspace(-3.5, 3.5, 57)
t, z, y, x = np.meshgrid(time, space, space, space, indexing="ij", sparse=True)
centre = 2 - 0.15 * t
inside = 1 - np.minimum(np.sqrt((x - centre)**2 + y**2 + z**2), np.sqrt((x + centre)**2 + y**2 + z**2))
print(f"{inside.shape} samples over t, z, y, x")

# %% One contour in space and time: tetrahedra in 4D
contour = tegl.contour(inside, 0.0, coords=[time, space, space, space], axis_names=["t", "z", "y", "x"],
                       dtype=np.float64)
print(contour, "manifold:", contour.check().is_manifold)
assert contour.check().is_manifold

# %% What becomes of the parts?
graph = contour.track(times=6)
for event in graph.events:
    print(f"t = {event.time:5.2f}: {event.kind}, {len(event.segments_in)} -> {len(event.segments_out)}, at "
          + ", ".join(f"{name} = {at:.2f}" for name, at in zip("zyx", event.place)))
merge = next(event for event in graph.events if event.kind == "merge")
# The grid's step is 1/8: a gap narrower than that is not seen, so the meeting is seen a little early.
assert 20 / 3 - 0.125 / 0.3 <= merge.time <= 20 / 3 + 0.05 and np.abs(merge.place).max() < 0.1

# %% The surface at that time, and just before
for at in (merge.time - 0.1, merge.time + 0.1):
    surface = contour.slice(at)
    report = surface.check()
    print(f"t = {at:.2f}: {report.components} components, closed: {report.is_closed}, Euler {report.euler}")
    assert report.is_closed and report.is_manifold and report.components == (2 if at < merge.time else 1)

# %% Volume over time, exactly for this contour, without making the cuts
curve = tegl.measure(contour, at=np.linspace(0, 12, 7))
for at, size, content in zip(curve.at, curve.size, curve.content):
    print(f"t = {at:4.1f}: area {size:6.3f}, volume {content:.4f}")
assert np.isclose(curve.content[0], 2 * 4 / 3 * np.pi, rtol=0.02)

# %% A family: a fifth axis, the level of the field, as one more dimension, in a small part of it
levels = np.linspace(-0.1, 0.1, 3)
family = inside[5:9, 18:39:5, 18:39:5, 8:49:5] - levels[:, None, None, None, None]
five = tegl.contour(family, 0.0, close=True)
print(five, "closed:", five.check().is_closed)
assert five.check().is_closed

# %% Other isovalues from an index, and the one ball at a point
index = tegl.Index(inside[3], coords=[space] * 3)
for level in (-0.5, 0.0, 0.5):
    print(f"radius {1 - level}: volume {index.contour(level).measure().content:.3f}")
ball = index.pick((0.0, 0.0, 1.5), 0.5)
volume = ball.measure().content  # None if it were open
assert volume is not None and np.isclose(volume, 4 / 3 * np.pi * 0.5**3, rtol=0.05)
