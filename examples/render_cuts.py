#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws cuts of a 4D contour of the ocean side by side: one oblique view of the surface for each time.

    examples/render_cuts.py --land examples/data/ocean_temperature.nc -o ocean.png 1.5=a.ply 7.3=b.ply

Each cut is a PLY file as `tegl slice` writes it, in degrees east, degrees north and metres down; the number in
front of it is its time in months, for the caption. Land is taken from the missing values of the image. Needs
python3-numpy, python3-matplotlib and python3-netcdf4; the projection and the hidden surfaces are done here: an
orthographic view towards the north, polygons painted from the far to the near.
"""

import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import netCDF4
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize

ELEVATION = np.radians(48.0)  # of the eye above the horizon
DEGREES_PER_METRE = 0.085  # the exaggeration of depth
FLOOR = 300.0  # metres; where the drawn block of ocean ends
SOUTH, NORTH = -48.0, 52.0  # the 20 degC surface lies between
LIGHT = np.array([-0.45, -0.35, 0.82]) / np.linalg.norm([-0.45, -0.35, 0.82])
LAND, LAND_WALL = np.array([0.905, 0.885, 0.845]), np.array([0.70, 0.675, 0.63])
BASE, BASE_EDGE = np.array([0.925, 0.945, 0.96]), "#b9c6d0"
MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()

PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
             "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4",
             "float32": "f4", "double": "f8", "float64": "f8"}


def read_ply(path):
    """Vertices (#V x 3) and triangles (#F x 3) of a binary little-endian PLY file of triangles."""
    data = pathlib.Path(path).read_bytes()
    head, mark, body = data.partition(b"end_header\n")
    lines = [line.split() for line in head.decode("ascii").splitlines()]
    if not mark or lines[0] != ["ply"] or lines[1][:2] != ["format", "binary_little_endian"]:
        sys.exit(f"render_cuts: {path}: expected a binary little-endian PLY file")
    elements = []
    for words in lines:
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].extend([("count", "<" + PLY_TYPES[words[2]]), ("list", "<" + PLY_TYPES[words[3]], (3,))])
        elif words[0] == "property":
            elements[-1][2].append((words[2], "<" + PLY_TYPES[words[1]]))
    tables, offset = {}, 0
    for name, count, fields in elements:
        tables[name] = np.frombuffer(body, np.dtype(fields), count, offset)
        offset += tables[name].nbytes
    if np.any(tables["face"]["count"] != 3):
        sys.exit(f"render_cuts: {path}: expected triangles only")
    vertices = np.stack([tables["vertex"][c].astype(float) for c in "xyz"], axis=1)
    return vertices, tables["face"]["list"].astype(np.int64)


def project(points):
    """World (degrees east, degrees north, metres down; last axis) to the picture plane."""
    up = -points[..., 2] * DEGREES_PER_METRE
    return np.stack([points[..., 0], points[..., 1] * np.sin(ELEVATION) + up * np.cos(ELEVATION)], axis=-1)


def nearness(points):
    """Grows towards the eye: the order of painting."""
    up = -points[..., 2] * DEGREES_PER_METRE
    return up * np.sin(ELEVATION) - points[..., 1] * np.cos(ELEVATION)


def shade(normals):
    """Brightness of surfaces by their unit normals; lit from both sides."""
    return 0.55 + 0.45 * np.abs(normals @ LIGHT)


def surface_polygons(vertices, triangles, colours, scale):
    """The cut: triangles coloured by depth and shaded by the mean normals of their corners."""
    inside = np.all((vertices[triangles][..., 1] > SOUTH) & (vertices[triangles][..., 1] < NORTH) &
                    (vertices[triangles][..., 2] < FLOOR), axis=1)
    triangles = triangles[inside]
    scene = vertices * [1.0, 1.0, -DEGREES_PER_METRE]
    corners = scene[triangles]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(scene)
    for k in range(3):
        np.add.at(normals, triangles[:, k], flat)
    mean = normals[triangles].mean(axis=1)
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-30)
    depth = vertices[triangles][..., 2].mean(axis=1)
    face = colours(scale(depth))[:, :3] * shade(mean)[:, None]
    return vertices[triangles], np.clip(face, 0.0, 1.0)


def box(west, east, south, north, depth):
    return [[west, south, depth], [east, south, depth], [east, north, depth], [west, north, depth]]


def wall(west, east, south, top, bottom):
    return [[west, south, top], [east, south, top], [east, south, bottom], [west, south, bottom]]


def land_polygons(path):
    """Land as blocks, from the values that are missing at the surface: tops, and the walls that face south."""
    with netCDF4.Dataset(path) as data:
        lon, lat = data["lon"][:].data, data["lat"][:].data
        land = np.ma.getmaskarray(data["temperature"][0, 0])
    half = (lon[1] - lon[0]) / 2
    polygons, colours = [], []
    for j in np.nonzero((lat > SOUTH) & (lat < NORTH))[0]:
        south, north = max(lat[j] - half, SOUTH), min(lat[j] + half, NORTH)
        for mask, make, colour in ((land[j], lambda w, e: box(w, e, south, north, 0.0), LAND),
                                   (land[j] & ~(land[j - 1] & (lat[j - 1] > SOUTH)),
                                    lambda w, e: wall(w, e, south, 0.0, FLOOR), LAND_WALL)):
            change = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
            for first, last in change.reshape(-1, 2):
                polygons.append(make(lon[first] - half, lon[last - 1] + half))
                colours.append(colour)
    return np.array(polygons), np.array(colours), (lon[0] - half, lon[-1] + half)


def draw(axes, polygons, colours):
    order = np.argsort(nearness(polygons).mean(axis=1), kind="stable")
    axes.add_collection(PolyCollection(project(polygons[order]), facecolors=colours[order],
                                       edgecolors=colours[order], linewidths=0.25))


def caption(time):
    """7.3 -> 't = 7.30', 'between mid-Jul and mid-Aug'."""
    month = int(np.floor(time))
    name = f"mid-{MONTHS[(month - 1) % 12]}"
    share = time - month
    return f"t = {time:g}", name if share == 0 else f"{share:.0%} of the way from {name} to mid-{MONTHS[month % 12]}"


def panel(axes, time, path, land, colours, scale):
    land_shapes, land_colours, (west, east) = land
    vertices, triangles = read_ply(path)
    shapes, faces = surface_polygons(vertices, triangles, colours, scale)
    base = project(np.array(box(west, east, SOUTH, NORTH, FLOOR)))
    axes.add_patch(plt.Polygon(base, facecolor=BASE, edgecolor=BASE_EDGE, linewidth=0.6))
    # Triangles as quadrilaterals with a doubled corner: one collection, one order of painting.
    shapes = np.concatenate([shapes, shapes[:, 2:]], axis=1)
    draw(axes, np.concatenate([land_shapes, shapes]), np.concatenate([land_colours, faces]))
    rim = project(np.array(box(west, east, SOUTH, NORTH, 0.0) + box(west, west, SOUTH, SOUTH, FLOOR)))
    axes.plot(*rim[[0, 1, 2, 3, 0]].T, color=BASE_EDGE, linewidth=0.6)
    low = project(np.array(box(west, east, SOUTH, NORTH, FLOOR)))
    for k in range(4):
        axes.plot(*np.stack([rim[k], low[k]]).T, color=BASE_EDGE, linewidth=0.6)
    title, detail = caption(time)
    axes.set_xlim(west - 2, east + 2)
    axes.set_ylim(low[0, 1] - 2, rim[3, 1] + 2)
    axes.set_aspect("equal")
    axes.axis("off")
    axes.text(0.0, 1.0, title, transform=axes.transAxes, fontsize=15, fontweight="bold", va="bottom", color="#222222")
    axes.text(0.105, 1.004, detail, transform=axes.transAxes, fontsize=11, va="bottom", color="#666666")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cuts", nargs="+", metavar="TIME=PLY")
    parser.add_argument("--land", required=True, help="the image, a netCDF file")
    parser.add_argument("-o", "--output", required=True, help="the picture, a PNG file")
    parser.add_argument("--title", default="")
    arguments = parser.parse_args()

    cuts = [(float(time), path) for time, _, path in (cut.partition("=") for cut in arguments.cuts)]
    colours, scale = plt.get_cmap("viridis_r"), Normalize(0.0, 250.0)
    land = land_polygons(arguments.land)
    figure, panels = plt.subplots(len(cuts), 1, figsize=(11, 0.4 + 3.15 * len(cuts)), squeeze=False)
    for axes, (time, path) in zip(panels[:, 0], cuts):
        panel(axes, time, path, land, colours, scale)
    figure.subplots_adjust(left=0.01, right=0.9, top=0.955, bottom=0.01, hspace=0.1)
    bar = figure.colorbar(plt.cm.ScalarMappable(scale, colours), cax=figure.add_axes([0.915, 0.25, 0.014, 0.5]))
    bar.ax.invert_yaxis()
    bar.set_label("depth of the 20 °C surface (m)", fontsize=11)
    bar.outline.set_visible(False)
    figure.savefig(arguments.output, dpi=100, facecolor="white")


if __name__ == "__main__":
    main()
