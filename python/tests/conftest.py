# SPDX-License-Identifier: BSD-3-Clause
"""Fields, and checks of contours that know nothing of tegl's own."""

import collections
import itertools
import math

import numpy as np
import pytest
import tegl


def ball(ndim, size=11, radius=0.7):
    """Positive inside of a ball in the middle."""
    axes = np.ogrid[tuple([slice(-1, 1, size * 1j)] * ndim)]
    return radius - np.sqrt(sum(axis**2 for axis in axes))


def noise(shape, seed, dtype=np.float32):
    return np.random.default_rng(seed).normal(size=shape).astype(dtype)


def signed_content(vertices, simplices):
    """What a closed contour with normals towards low encloses, by the divergence theorem."""
    ndim = vertices.shape[1]
    corners = vertices.astype(np.float64)[simplices]
    return (-1) ** (ndim - 1) * np.linalg.det(corners).sum() / math.factorial(ndim)


def sign_of(order):
    """1 for an even permutation, -1 for an odd one."""
    return (-1) ** sum(a > b for a, b in itertools.combinations(order, 2))


def face_counts(simplices):
    """For each facet of the simplices: how many have it, and the sum of the signs they run through it with."""
    count, balance = collections.Counter(), collections.Counter()
    for simplex in np.asarray(simplices).tolist():
        for left_out in range(len(simplex)):
            face = simplex[:left_out] + simplex[left_out + 1:]
            ordered = tuple(sorted(face))
            count[ordered] += 1
            balance[ordered] += (-1) ** left_out * sign_of([ordered.index(v) for v in face])
    return count, balance


def assert_closed_manifold(simplices):
    """Every facet in exactly two simplices, which run through it in opposite directions."""
    count, balance = face_counts(simplices)
    assert set(count.values()) <= {2}
    assert set(balance.values()) <= {0}


def assert_same(a, b):
    """The same contour, byte by byte."""
    assert a.vertices.dtype == b.vertices.dtype
    assert a.vertices.tobytes() == b.vertices.tobytes()
    assert a.simplices.tobytes() == b.simplices.tobytes()


def places(contour):
    """The simplices as corners' coordinates, whatever the numbering: equal for equal contours."""
    _, number = np.unique(contour.vertices, axis=0, return_inverse=True)
    rows = number.reshape(-1)[contour.simplices]
    signs = [sign_of(row) for row in rows.tolist()]
    return sorted(zip(map(tuple, np.sort(rows, axis=1).tolist()), signs))


def assert_same_places(a, b):
    """The same contour up to the numbering, bit by bit, with the same orientation."""
    assert np.array_equal(np.unique(a.vertices, axis=0), np.unique(b.vertices, axis=0))
    assert places(a) == places(b)


@pytest.fixture
def moving_balls():
    """4D (t, z, y, x): two balls that become one between t = 3 and 4, in 8 steps."""
    t, z, y, x = np.ogrid[0:8, -1:1:17j, -1:1:17j, -2:2:33j]
    apart = 1.2 - 0.14 * t
    return 0.6 - np.minimum(np.sqrt(z**2 + y**2 + (x - apart)**2), np.sqrt(z**2 + y**2 + (x + apart)**2))


@pytest.fixture
def balls(moving_balls):
    """The 4D contour of the moving balls, with names and units."""
    return tegl.contour(moving_balls, 0.0, axis_names="tzyx", axis_units=["h", "mm", "mm", "mm"], dtype=np.float64)
