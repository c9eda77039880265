#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Other tilings: the date line, a crystal, FCC against cubic samples, and a mesh over time.

    examples/python/tilings.py

The cells (# %%) are as in a notebook.
"""

# %% The date line: a warm patch around longitude 180, in a world map from -180 to 180 degrees
import numpy as np
import tegl

longitude, latitude = np.arange(-180.0, 180.0, 4.0), np.linspace(-40.0, 40.0, 41)
east = np.minimum(np.abs(longitude - 180), np.abs(longitude + 180))
warm = 28 - 0.1 * np.hypot(east[None, :], latitude[:, None])
flat = tegl.contour(warm, 26.0, coords=[latitude, longitude], axis_names=["lat", "lon"])
around = tegl.contour(warm, 26.0, coords=[latitude, longitude], axis_names=["lat", "lon"], periodic={"lon": 360})
print("components without and with the period:", flat.check().components, around.check().components)
assert flat.check().components == 2 and around.check().components == 1 and around.check().is_closed

# %% A crystal: the surface of a gyroid in its unit cell, three periodic axes, with normals across the seams
turn = 2 * np.pi * np.arange(32) / 32
z, y, x = np.meshgrid(turn, turn, turn, indexing="ij")
gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
cell = tegl.contour(gyroid, 0.01, periodic="all", spacing=1 / 32, normals=True)
print(cell, "Euler characteristic", cell.check().euler)
assert cell.check().is_closed and cell.check().euler == -8
picture, originals = cell.unroll()
print(f"{len(picture.vertices) - len(cell.vertices)} vertices on the seams are doubled for pictures")

# %% FCC against cubic samples: as many of them, a smaller error
def ball(steps, staggered):
    """A ball of radius 0.8, with samples in [-1, 1]^3, and its surface's error."""
    axes = [np.arange(-1.0, 1.0001, step) for step in steps]
    k, j, i = np.meshgrid(*[np.arange(len(axis)) for axis in axes], indexing="ij")
    half = 0.5 * (k % 2) * steps[1] if staggered else 0.0
    values = 0.8 - np.sqrt(axes[0][k]**2 + (axes[1][j] + half)**2 + (axes[2][i] + half)**2)
    surface = tegl.contour(values, 0.0, spacing=steps, origin=-1.0, lattice="fcc" if staggered else None)
    centres = surface.vertices[surface.simplices].mean(axis=1)
    return values.size, np.sqrt(np.mean((0.8 - np.linalg.norm(centres, axis=1))**2))

cubic = ball([2 / 24] * 3, False)
step = 2 / 24 * 2**(1 / 6)
fcc = ball([step * 0.5**0.5, step, step], True)
print(f"cubic: {cubic[0]} samples, error {cubic[1]:.5f}; FCC: {fcc[0]} samples, error {fcc[1]:.5f}")
assert fcc[1] < 0.9 * cubic[1]

# %% A mesh over time: triangles, a disc that moves; the contour at any time is a closed line
side = 17
rows, columns = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
points = np.stack([rows.ravel(), columns.ravel()], axis=1) / (side - 1.0)
first = (rows[:-1, :-1] * side + columns[:-1, :-1]).ravel()
triangles = np.concatenate([np.stack([first, first + 1, first + side + 1], axis=1),
                            np.stack([first, first + side + 1, first + side], axis=1)])
times = np.arange(5.0)
values = np.stack([0.22 - np.hypot(points[:, 0] - 0.3 - 0.1 * t, points[:, 1] - 0.5) for t in times])
moving = tegl.contour_mesh(points, triangles, values, 0.0, times=times)
line = moving.slice(2.5)
print(moving, "at t = 2.5:", line)
assert line.check().is_closed and line.check().components == 1
