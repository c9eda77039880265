#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The error of contours of cubic, face-centred and body-centred samples, and of D4 and 4D cubic ones, with equally many
samples in the same volume.

    PYTHONPATH=build/release/python bench/lattices.py [--samples COUNT]

Prints the table of docs/other-tilings.md: for a ball and for a smooth surface, turned by several angles, the root mean
square and the maximum distance of vertices and of centres of simplices from the exact surface, in units of the cubic
step. Times are not measured.
"""

import argparse

import numpy as np
import tegl

#: lattice -> (layers for each step along the other axes, dimension)
LATTICES = {"cubic": (1.0, 3), "fcc": (np.sqrt(0.5), 3), "bcc": (0.5, 3), "cubic 4D": (1.0, 4), "d4": (0.5, 4)}


def rotation(ndim, seed):
    """A rotation by random angles."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(ndim, ndim)))
    return q * np.sign(np.diag(r))


def ball(x):
    """Distance function: the error of a point is the value itself."""
    return 0.8 - np.linalg.norm(x, axis=-1)


def waves(x):
    """A smooth function with large gradients on its surface."""
    return np.cos(4.0 * x).sum(axis=-1) + 0.5 * np.cos(3.0 * np.roll(x, 1, axis=-1) + x).sum(axis=-1) - 0.3


def distances(field, points):
    """First-order distances |f| / |grad f| of points from the surface."""
    step = 1e-5
    gradient = np.stack([(field(points + step * unit) - field(points - step * unit)) / (2 * step)
                         for unit in np.eye(points.shape[1])], axis=-1)
    return np.abs(field(points)) / np.linalg.norm(gradient, axis=-1)


def contour_of(name, field, count):
    """The contour of about `count` samples in [-1, 1]^N; the axes of the array are N - 1 ... 0."""
    layer, ndim = LATTICES[name]
    step = (2.0**ndim / (count * layer)) ** (1.0 / ndim)
    sizes = [round(2.0 / (step * layer))] + [round(2.0 / step)] * (ndim - 1)
    steps = [step * layer] + [step] * (ndim - 1)
    axes = [width * (np.arange(size) - 0.5 * (size - 1)) for width, size in zip(steps, sizes)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    if not name.startswith("cubic"):
        places[1::2, ..., 1:] += 0.5 * step
    options = {} if name.startswith("cubic") else {"lattice": name}
    contour = tegl.contour(field(places), 0.0, spacing=steps, origin=[axis[0] for axis in axes], dtype=float, **options)
    return contour, int(np.prod(sizes))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=64000)
    count = parser.parse_args().samples
    print("| field | lattice | samples | simplices | RMS error | maximum |\n|---|---|---|---|---|---|")
    for title, field in (("ball", ball), ("waves", waves)):
        for name, (_, ndim) in LATTICES.items():
            unit = (2.0**ndim / count) ** (1.0 / ndim)
            found = []
            for seed in range(5):
                turn = rotation(ndim, seed)
                def turned(x):
                    return field(x @ turn.T)
                contour, samples = contour_of(name, turned, count)
                centres = contour.vertices[contour.simplices].mean(axis=1)
                points = np.concatenate([contour.vertices, centres])
                inside = (np.abs(points) < 0.9).all(axis=1)
                found.append((len(contour.simplices), distances(turned, points[inside]) / unit))
            errors = np.concatenate([each for _, each in found])
            print(f"| {title} | {name} | {samples} | {np.mean([n for n, _ in found]):.0f} | "
                  f"{np.sqrt(np.mean(errors**2)):.4f} | {errors.max():.4f} |")


if __name__ == "__main__":
    main()
