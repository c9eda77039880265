#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the surfaces that example 13 writes: two fields above each other, and side by side what they are and what
estimators make of them on a coarse grid. Each component has a colour of its own.

    mkdir pair && build/release/examples/13_own_estimator pair
    examples/render_estimators.py pair -o docs/images/estimators.png

Needs python3-numpy, python3-matplotlib and python3-netcdf4; polygons are painted from the far to the near.
"""

import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from render_cuts import read_ply_tables

COLUMNS = {"fine": "the field (8 samples for one)", "mean": "mean", "saddle": "saddle", "cubic": "own: cubic, example 13"}
ROWS = {1: "first field", 2: "second field"}
COLOURS = np.array([[0.16, 0.47, 0.71], [0.93, 0.58, 0.20], [0.4, 0.65, 0.35]])
AZIMUTH, ELEVATION = np.radians(45.0 - 8.0), np.radians(24.0)
LIGHT = np.array([-0.15, -0.65, 0.74])


def components(triangles, vertices):
    """The number of each triangle's component, by their size."""
    label = np.arange(vertices)
    while True:
        least = label[triangles].min(axis=1)
        after = label.copy()
        for corner in range(3):
            np.minimum.at(after, triangles[:, corner], least)
        after = after[after]
        if np.array_equal(after, label):
            break
        label = after
    of = label[triangles[:, 0]]
    names, counts = np.unique(of, return_counts=True)
    rank = {name: place for place, name in enumerate(names[np.argsort(-counts, kind="stable")])}
    return np.array([rank[name] for name in of]), len(names)


def draw(axes, path, with_edges):
    tables = read_ply_tables(path)
    points = np.stack([tables["vertex"][c].astype(float) for c in "xyz"], axis=1)
    triangles = tables["face"]["list"]
    component, count = components(triangles, len(points))
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    eye = np.array([np.sin(AZIMUTH) * np.cos(ELEVATION), -np.cos(AZIMUTH) * np.cos(ELEVATION), np.sin(ELEVATION)])
    right = np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    up = np.cross(eye, right)
    brightness = 0.42 + 0.58 * np.abs(normals @ (LIGHT / np.linalg.norm(LIGHT)))
    faces = np.clip(COLOURS[component % len(COLOURS)] * brightness[:, None], 0, 1)
    order = np.argsort(corners.mean(axis=1) @ eye)
    flat = np.stack([corners @ right, corners @ up], axis=-1)
    edges = np.clip(faces * 0.72, 0, 1) if with_edges else faces
    axes.add_collection(PolyCollection(flat[order], facecolors=faces[order], edgecolors=edges[order],
                                       linewidths=0.4 if with_edges else 0.15))
    axes.set_xlim(-12.5, 6.5)
    axes.set_ylim(-7.5, 8.5)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for side in axes.spines.values():
        side.set_visible(False)
    axes.set_xlabel("1 component" if count == 1 else f"{count} components", fontsize=11, color="#333333")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    figure, panels = plt.subplots(len(ROWS), len(COLUMNS), figsize=(3.3 * len(COLUMNS), 3.1 * len(ROWS)))
    for row, (number, title) in zip(panels, ROWS.items()):
        for axes, (name, caption) in zip(row, COLUMNS.items()):
            draw(axes, options.folder / f"{name}_{number}.ply", name != "fine")
            if number == 1:
                axes.set_title(caption, fontsize=12, color="#333333")
        row[0].set_ylabel(title, fontsize=12, color="#333333")
    figure.subplots_adjust(wspace=0.04, hspace=0.12)
    figure.savefig(options.output, dpi=80, bbox_inches="tight", pad_inches=0.1, metadata={"Software": None})


if __name__ == "__main__":
    main()
