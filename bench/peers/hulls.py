#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often the contour of a 4D cell intersects itself if it is a part of a convex hull.

    PYTHONPATH=build/release/python bench/peers/hulls.py [--cells N] [--pairs N] [--seed S]

The contour of a signature (the set of high corners) is the hull of the high corners and of the points on the edges
between high and low corners, without the facets in the cell's boundary. As in a table, tetrahedra are found once for
points in the middle of edges, by Qhull, which triangulates facets with more than four vertices; then the points move
along their edges, and tegl.intersections counts the pairs that intersect, exactly. A crack: two cells beside each other
have different triangles in their common cube. Prints a table in Markdown. Needs python3-scipy.

Based on: P. Bhaniramka, R. Wenger and R. Crawfis, Isosurface construction in any dimension using convex hulls, 2004.
"""

import argparse
import functools

import numpy as np
import tegl
from scipy.spatial import ConvexHull

CORNERS = np.array([[v >> a & 1 for a in range(4)] for v in range(16)], float)
EDGES = [(v, v | 1 << a) for a in range(4) for v in range(16) if not v >> a & 1]
DISTANCES = ("middle", "uniform", "log-uniform")


def points_on_edges(share) -> np.ndarray:
    """The points at these shares of the edges, from the lower end."""
    return np.array([CORNERS[a] + s * (CORNERS[b] - CORNERS[a]) for (a, b), s in zip(EDGES, share)])


@functools.lru_cache(maxsize=None)
def tetrahedra(signature: int) -> np.ndarray:
    """The tetrahedra of a signature, by numbers of edges."""
    high = [v for v in range(16) if signature >> v & 1]
    edges = [e for e, (a, b) in enumerate(EDGES) if (signature >> a ^ signature >> b) & 1]
    points = np.vstack([points_on_edges([0.5] * 32)[edges], CORNERS[high]])
    hull = ConvexHull(points, qhull_options="Qt")
    is_inside = [not any(np.ptp(points[facet][:, a]) == 0 and points[facet[0], a] in (0, 1) for a in range(4))
                 for facet in hull.simplices]
    return np.array([[edges[v] for v in facet] for facet in hull.simplices[is_inside]]).reshape(-1, 4)


def triangles_in(signature: int, side: int) -> set:
    """The triangles in the cube x = side, by the edge numbers of the cell with x = 0 there."""
    names = {}
    for e, (a, b) in enumerate(EDGES):
        if a & 1 == side and b & 1 == side:
            names[e] = EDGES.index((a & ~1, b & ~1))
    faces = [tuple(sorted(set(t) - {v})) for t in tetrahedra(signature).tolist() for v in t]
    return {tuple(names[v] for v in face) for face in faces if all(v in names for v in face)}


def cracks(count: int, random) -> int:
    """Pairs of cells along x, with the same corners in the common cube, whose triangles differ there."""
    found = 0
    for first, other in random.integers(1, 65535, (count, 2)).tolist():
        common = first & 0xaaaa
        second = common >> 1 | other & 0xaaaa
        if 0 < second < 65535:
            found += triangles_in(first, 1) != triangles_in(second, 0)
    return found


def measure(count: int, distances: str, random) -> dict:
    found = dict(tetrahedra=0, hit=0, pairs=0, flat=0)
    for signature in random.integers(1, 65535, count).tolist():
        share = 1.0 - random.random(16)  # in (0, 1]: distances of the corners from the isovalue
        distance = dict(zip(DISTANCES, (np.ones(16), share, 1e-3 ** share)))[distances]
        simplices = tetrahedra(signature)
        points = points_on_edges([distance[a] / (distance[a] + distance[b]) for a, b in EDGES])
        report = tegl.intersections(tegl.Contour(points, simplices))
        found["tetrahedra"] += len(simplices)
        found["hit"] += report.count > 0
        found["pairs"] += report.count
        found["flat"] += report.flat > 0
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=20_000, help="random cells for each row (20000)")
    parser.add_argument("--pairs", type=int, default=2_000, help="pairs of cells that are tested for cracks (2000)")
    parser.add_argument("--seed", type=int, default=1994)
    arguments = parser.parse_args()
    print("| distances | tetrahedra per cell | cells hit | pairs | cells with flat tetrahedra |")
    print("|---|---|---|---|---|")
    for distances in DISTANCES:
        found = measure(arguments.cells, distances, np.random.default_rng(arguments.seed))
        print(f"| {distances} | {found['tetrahedra'] / arguments.cells:.2f} | {found['hit']} | {found['pairs']} | "
              f"{found['flat']} |", flush=True)
    found = cracks(arguments.pairs, np.random.default_rng(arguments.seed))
    print(f"\n{arguments.pairs} pairs of cells, {found} with a crack")


if __name__ == "__main__":
    main()
