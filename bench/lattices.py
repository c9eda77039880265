#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The error of contours of cubic, face-centred and body-centred samples, and of D4 and 4D cubic ones, with equally many
samples in the same volume.

    PYTHONPATH=build/release/python bench/lattices.py [--samples COUNT] [--picture FILE.svg]

Prints the table of docs/other-tilings.md: for a ball and for a smooth surface, turned by several angles, the root mean
square and the maximum distance of vertices and of centres of simplices from the exact surface, in units of the cubic
step. --picture draws the root mean square in 3D angle by angle instead (docs/images/lattice_errors.svg): of the smooth
surface turned about the axis of the layers, the mean over several places of the samples. Times are not measured.
"""

import argparse
import pathlib
import runpy
import sys

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
    """The contour of about `count` samples in [-1, 1]^N; the axes of the array are N - 1 ... 0. And their number."""
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


def errors_of(name, field, count):
    """Distances of the contour's vertices and of the centres of its simplices, in units of the cubic step; its size."""
    contour, samples = contour_of(name, field, count)
    centres = contour.vertices[contour.simplices].mean(axis=1)
    points = np.concatenate([contour.vertices, centres])
    ndim = LATTICES[name][1]
    inside = (np.abs(points) < 0.9).all(axis=1)
    return distances(field, points[inside]) / (2.0**ndim / count) ** (1.0 / ndim), len(contour.simplices), samples


def error_at(name, angle, count):
    """RMS error of `waves` turned by an angle in the plane of x and y, at five places of the samples."""
    c, s = np.cos(angle), np.sin(angle)
    turn, shifts = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.random.default_rng(1).uniform(0, 0.2, (5, 3))
    errors = [errors_of(name, lambda x, shift=shift: waves((x + shift) @ turn.T), count)[0] for shift in shifts]
    return np.sqrt(np.mean(np.concatenate(errors) ** 2))


def draw_by_angle(path, count):
    sys.dont_write_bytecode = True
    svg = runpy.run_path(str(pathlib.Path(__file__).parents[1] / "scripts/triangulation_pictures"))["Svg"](580, 350)
    left, top, width, height, most, angles = 60, 40, 480, 260, 0.012, range(0, 91, 3)

    def to_page(angle, error):
        return left + width * angle / 90, top + height * (1 - error / most)

    for i in range(7):
        svg.line(to_page(0, 0.002 * i), to_page(90, 0.002 * i), "#c2c7cc", 0.6)
        svg.text(left - 8, to_page(0, 0.002 * i)[1] + 4, f"{0.002 * i:g}", 11, "end")
        svg.text(to_page(15 * i, 0)[0], top + height + 18, f"{15 * i}°", 11)
    svg.text(left + width / 2, top + height + 40, "angle", 12)
    svg.text(left - 40, top - 12, "RMS error in steps of the cubic samples", 12, "start")
    for name, color in (("cubic", "#b4530a"), ("fcc", "#1f5fa8"), ("bcc", "#2f7d3b")):
        line = [to_page(angle, error_at(name, np.radians(angle), count)) for angle in angles]
        for a, b in zip(line, line[1:]):
            svg.line(a, b, color, 2)
        middle = line[len(line) // 2]
        svg.text(middle[0], middle[1] - 7, name)
    svg.write(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=64000)
    parser.add_argument("--picture", type=pathlib.Path)
    options = parser.parse_args()
    if options.picture:
        draw_by_angle(options.picture, options.samples)
        return
    print("| field | lattice | samples | simplices | RMS error | maximum |\n|---|---|---|---|---|---|")
    for title, field in (("ball", ball), ("waves", waves)):
        for name, (_, ndim) in LATTICES.items():
            turns = [rotation(ndim, seed).T for seed in range(5)]
            found = [errors_of(name, lambda x, turn=turn: field(x @ turn), options.samples) for turn in turns]
            errors = np.concatenate([each for each, _, _ in found])
            print(f"| {title} | {name} | {found[0][2]} | {np.mean([size for _, size, _ in found]):.0f} | "
                  f"{np.sqrt(np.mean(errors**2)):.4f} | {errors.max():.4f} |")


if __name__ == "__main__":
    main()
