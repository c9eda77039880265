#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""All planes that separate the high and low samples of one plane: how close a rule for positions can come.

    bench/separating_planes.py

Prints CSV. The plane is y = p x + r z + q in 96^3 samples, with the coordinates counted from the middle. Each sample
is a linear inequality of (p, r, q), so the planes with the same samples are a convex polyhedron. Distances are root
mean squares over the columns of the inner part, as of the vertices in positions.cpp. Half of the largest distance of
two of these planes bounds every rule: wherever it places the vertices, one of both planes is at least that far away.
The normal and offset are in docs/positions.md; here they are changed by less than half of the
last digit given there. Debian: python3-scipy.
"""

import itertools

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

SIZE = 96
NORMAL, OFFSET = (-0.446, 0.895, -0.003), 0.088


def hull(points):
    return points[ConvexHull(points).vertices]


def separating(normal, offset):
    """The vertices of the polyhedron of all (p, r, q) with the samples of a plane."""
    places = np.arange(SIZE) - SIZE / 2
    x, z = np.meshgrid(places, places, indexing="ij")
    heights = normal[0] * x[..., None] + normal[1] * places + normal[2] * z[..., None] - offset
    high = (heights >= 0).sum(-1)  # in each column, the samples of the largest y
    crossed = (high > 0) & (high < SIZE)
    x, z, lowest_high = x[crossed], z[crossed], (SIZE - high[crossed]) - SIZE / 2
    # the plane is at or below the high samples and above the low ones: only those on their convex hulls count
    above, below = hull(np.c_[x, z, lowest_high]), hull(np.c_[x, z, lowest_high - 1])
    rows = np.r_[np.c_[above[:, :2], np.ones(len(above))], -np.c_[below[:, :2], np.ones(len(below))]]
    limits = np.r_[above[:, 2], -below[:, 2]]
    lengths = np.linalg.norm(rows, axis=1)
    inside = linprog([0, 0, 0, -1], A_ub=np.c_[rows, lengths], b_ub=limits, bounds=[(None, None)] * 3 + [(0, None)])
    return hull(HalfspaceIntersection(np.c_[rows, -limits], inside.x[:3]).intersections)


def in_metric(normal, offset, planes):
    """Planes, the last of them the given one, in coordinates whose distances are root mean square ones."""
    places = np.arange(SIZE) - SIZE / 2
    x, z = np.meshgrid(places, places, indexing="ij")
    true = np.array([-normal[0], -normal[2], offset]) / normal[1]
    most = 0.8 * SIZE / 2
    inner = (abs(x) < most) & (abs(z) < most) & (abs(true[0] * x + true[1] * z + true[2]) < most)
    columns = np.c_[x[inner], z[inner], np.ones(inner.sum())]
    factor = np.linalg.cholesky(columns.T @ columns / len(columns))
    return np.vstack([planes, true]) @ factor * normal[1]


def mean_of(corners):
    """The centroid of a polyhedron, and the root mean square distance of its points from it."""
    apex, volume, first, second = corners.mean(0), 0.0, np.zeros(3), 0.0
    for triangle in ConvexHull(corners).simplices:
        tetrahedron = np.vstack([corners[triangle], apex]) - apex
        part = abs(np.linalg.det(tetrahedron[:3])) / 6
        total = tetrahedron.sum(0)
        volume += part
        first += part * total / 4
        second += part * ((tetrahedron**2).sum() + total @ total) / 20
    first /= volume
    return apex + first, np.sqrt(second / volume - first @ first)


def main():
    print("normal x,normal y,normal z,offset,half of the largest distance,root mean square from centroid,"
          "plane from centroid")
    for change in itertools.product((-4e-4, 4e-4), (-4e-4, 4e-4), (-4e-4, 0, 4e-4), (-4e-4, 4e-4)):
        normal, offset = np.array(NORMAL) + change[:3], OFFSET + change[3]
        scale = np.linalg.norm(normal)
        *planes, true = in_metric(normal / scale, offset, separating(normal / scale, offset))
        planes = np.array(planes)
        centroid, spread = mean_of(planes)
        half = np.linalg.norm(planes[:, None] - planes, axis=2).max() / 2
        numbers = (*normal, offset, half, spread, np.linalg.norm(centroid - true))
        print(*(f"{number:.4f}" for number in numbers), sep=",")


if __name__ == "__main__":
    main()
