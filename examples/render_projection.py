#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws coloured surfaces side by side, as `tegl project` writes them, seen obliquely from above.

    tegl project fingers.nhdr --iso 30 --as cuts --count 6 -o cuts.ply
    tegl project fingers.nhdr --iso 30 --close -o swept.ply
    examples/render_projection.py -o projection.png --down --time "time step" "the surface at six times=cuts.ply" \
      "all that it sweeps=swept.ply"

Each is a caption and a PLY file of triangles with vertex colours and, for the scale below, a time in the property t;
--time names it and its unit. All have one scale.
The last axis in the file points down, as depths do, with --down. Needs python3-numpy and python3-matplotlib;
polygons are painted from the far to the near.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap

from render_cuts import read_ply_tables

AZIMUTH, ELEVATION = np.radians(28.0), np.radians(24.0)
LIGHT = np.array([-0.5, -0.45, 0.74])


def axes_of_view():
    """The picture's right and up, and the way to the eye, in space."""
    eye = np.array([np.sin(AZIMUTH) * np.cos(ELEVATION), -np.cos(AZIMUTH) * np.cos(ELEVATION), np.sin(ELEVATION)])
    right = np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    return right, np.cross(eye, right), eye


def draw(axes, path, down):
    """One surface; returns the range of its times, and its lowest and highest place in the picture."""
    tables = read_ply_tables(path)
    table = tables["vertex"]
    points = np.stack([table[c].astype(float) for c in "xyz"], axis=1)
    if down:
        points[:, 2] *= -1
    colours = np.stack([table[c] for c in ("red", "green", "blue")], axis=1) / 255.0
    corners = points[tables["face"]["list"]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    right, up, eye = axes_of_view()
    brightness = 0.45 + 0.55 * np.abs(normals @ (LIGHT / np.linalg.norm(LIGHT)))
    faces = colours[tables["face"]["list"]].mean(axis=1) * brightness[:, None]
    order = np.argsort(corners.mean(axis=1) @ eye)
    flat = np.stack([corners @ right, corners @ up], axis=-1)
    axes.add_collection(PolyCollection(flat[order], facecolors=np.clip(faces, 0, 1)[order],
                                       edgecolors=np.clip(faces, 0, 1)[order], linewidths=0.15))
    axes.set_aspect("equal")
    axes.axis("off")
    return (table["t"].min(), table["t"].max()), flat.min(axis=(0, 1)), flat.max(axis=(0, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--down", action="store_true", help="the last axis points down")
    parser.add_argument("--time", default="t", help="the name of the colours, with a unit")
    parser.add_argument("panels", nargs="+", metavar="CAPTION=FILE")
    options = parser.parse_args()
    figure, panels = plt.subplots(1, len(options.panels), figsize=(5.2 * len(options.panels), 5.4), squeeze=False)
    drawn = []
    for axes, panel in zip(panels[0], options.panels):
        caption, _, path = panel.rpartition("=")
        drawn.append(draw(axes, path, options.down))
        axes.set_title(caption, fontsize=12, color="#333333")
    times, lowest, highest = zip(*drawn)
    (left, bottom), (right, top) = np.min(lowest, axis=0), np.max(highest, axis=0)
    for axes in panels[0]:
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
    viridis = [(68, 1, 84), (71, 45, 123), (59, 82, 139), (44, 114, 142), (33, 145, 140), (40, 174, 128), (94, 201, 98),
               (173, 220, 48), (253, 231, 37)]
    steps = np.linspace(0, 8, 256)
    colours = np.stack([np.interp(steps, range(9), [c[i] for c in viridis]) for i in range(3)], axis=1) / 255.0
    scale = plt.cm.ScalarMappable(plt.Normalize(min(t[0] for t in times), max(t[1] for t in times)),
                                  ListedColormap(colours))
    bar = figure.colorbar(scale, ax=list(panels[0]), orientation="horizontal", fraction=0.04, pad=0.02, aspect=50)
    bar.set_label(options.time)
    figure.savefig(options.output, dpi=100, bbox_inches="tight", pad_inches=0.1, metadata={"Software": None})


if __name__ == "__main__":
    main()
