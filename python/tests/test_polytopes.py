# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of 4D polytopes."""

import itertools
import types

import numpy as np
import pytest

import tegl


def cells24(along):
    """24-cells around the integers with an even sum: points and cells."""
    corners = np.array([*itertools.product((-1, 1), repeat=4), *(2 * np.eye(4, dtype=int)), *(-2 * np.eye(4, dtype=int))])
    normals = [n for n in itertools.product((-1, 0, 1), repeat=4) if sum(map(abs, n)) == 2]
    facets = [frozenset(np.flatnonzero(corners @ n == 2)) for n in normals]
    faces = [[sorted(facet & other) for other in facets if len(facet & other) == 3] for facet in facets]
    numbers, points, cells = {}, [], []
    for centre in itertools.product(range(along), repeat=4):
        if sum(centre) % 2:
            continue
        places = [tuple(place) for place in 2 * np.array(centre) + corners]
        for place in places:
            if place not in numbers:
                numbers[place] = len(points)
                points.append(np.array(place) / 2)
        cells.append([[[numbers[places[v]] for v in face] for face in facet] for facet in faces])
    return np.array(points) - (along - 1) / 2, cells


def duoprism():
    """The product of a triangle and a square, as facets, and as the type that it is."""
    number = np.arange(12).reshape(3, 4)
    facets = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        sides = [[number[a, k], number[a, (k + 1) % 4], number[b, (k + 1) % 4], number[b, k]] for k in range(4)]
        facets.append([number[a], number[b], *sides])
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        sides = [[number[k, a], number[(k + 1) % 3, a], number[(k + 1) % 3, b], number[k, b]] for k in range(3)]
        facets.append([number[:, a], number[:, b], *sides])
    points = np.array([[x, y, z, w] for x, y in ((0, 0), (1, 0), (0, 1)) for z, w in ((0, 0), (1, 0), (1, 1), (0, 1))])
    return points, facets


@pytest.mark.parametrize("triangulation", ["compact", "barycentric"])
def test_a_ball_in_24_cells_is_a_sphere(triangulation):
    points, cells = cells24(7)
    values = 2.7 - np.linalg.norm(points, axis=1)
    contour = tegl.contour_mesh(points, {"polytope": cells}, values, 0.0, triangulation=triangulation, dtype=np.float64)
    report = contour.check()
    assert report.is_closed and report.euler == 0 and report.components == 1
    content = np.pi**2 / 2 * 2.7**4
    assert abs(contour.measure().content / content - 1) < 0.25
    cut = contour.slice(axis=3, at=0.1)
    assert cut.check().is_closed and cut.check().euler == 2
    size = tegl.count_mesh(points, {"polytope": cells}, values, 0.0, triangulation=triangulation)
    assert size == (len(contour.vertices), len(contour.simplices))
    index = tegl.MeshIndex(points, [("polytope", cells)], values)
    other = index.contour(0.0, triangulation=triangulation, dtype=np.float64)
    assert np.array_equal(other.vertices, contour.vertices) and np.array_equal(other.simplices, contour.simplices)


def test_noise_is_closed_with_every_rule():
    points, cells = cells24(4)
    around = np.zeros(len(points), dtype=int)
    for cell in cells:
        around[list({v for facet in cell for face in facet for v in face})] += 1
    # low at the border: eight cells are around each other point
    values = np.where(around == 8, np.random.default_rng(1).random(len(points)), 0.0)
    for ambiguity in ("low", "high", "mean", "saddle", "squares", "decider"):
        inside = tegl.contour_mesh(points, {"polytope24": cells}, values, 0.5, ambiguity=ambiguity)
        assert len(inside.simplices) > 100 and inside.check().is_closed
        one = tegl.contour_mesh(points, {"polytope": cells[:1]}, values + 0.6 * (around != 8), 0.5, ambiguity=ambiguity, close=True)
        assert len(one.simplices) > 0 and one.check().is_closed


def test_known_shapes_are_their_types_beside_others():
    points, facets = duoprism()
    values = np.linspace(0, 1, 12)
    one = tegl.contour_mesh(points, {"polytope": [facets]}, values, 0.45, triangulation="barycentric", close=True)
    assert one.check().is_closed
    simplex = np.array([[0, 1, 4, 8, 12]])  # beside the duoprism, with points of its own
    more = np.vstack([points + [0, 0, 0, 0], points + 5.0])
    blocks = [("polytope", [facets]), ("simplex4", simplex + [12, 12, 12, 12, 11]), ("polytope", [facets])]
    both = tegl.contour_mesh(more, blocks[:2], np.tile(values, 2), 0.45, triangulation="barycentric", close=True)
    assert both.check().is_closed and both.check().components == 2
    mesh = types.SimpleNamespace(points=points, cells=[types.SimpleNamespace(type="polytope", data=[facets])],
                                 point_data={"values": values})
    assert len(tegl.contour_mesh(mesh, level=0.45).simplices) > 0


@pytest.mark.parametrize("cells, error, message", [
    ({"polytope": 5}, TypeError, "cells of type 'polytope' are int; expected a list of cells: lists of facets"),
    ({"polytope": [5]}, TypeError, "cells of type 'polytope' have 5 in the place of a cell; expected a list of facets"),
    ({"polytope": [[5]]}, TypeError, "facets of cells of type 'polytope' are int; expected lists of numbers of points"),
    ({"polytope": [[[0, 1, 2]]]}, TypeError, "facets of cells of type 'polytope' have 0 in the place of a list"),
    ({"polytope": [[[[0, 1, 2]]]]}, ValueError, "cell 0: a polytope of 1 facets; expected 5 to 1952"),
    ({"polytope": [duoprism()[1][:-1]]}, ValueError, "only; expected two facets: a closed polytope"),
    ({"polytope": [duoprism()[1]], "tetra": [[0, 1, 2, 3]]}, ValueError, "cell 1: type 10 (tetrahedron); expected a 4D cell"),
])
def test_bad_cells(cells, error, message):
    points, _ = duoprism()
    with pytest.raises(error) as caught:
        tegl.contour_mesh(points, cells, np.arange(12.0), 5.5)
    assert message in str(caught.value)
