#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws cuts of a 4D contour of the ocean below each other: one oblique view of the surface for each time.

    examples/render_cuts.py --land examples/data/ocean_temperature.nc -o ocean.png 1.5=a.ply 7.3=b.ply

Each cut is a PLY file as `tegl slice` writes it, in degrees east, degrees north and metres down; the number in
front of it is its time in months, for the caption. Land is taken from the missing values of the image. Needs
python3-numpy, python3-matplotlib and python3-netcdf4; the projection and the hidden surfaces are done here: an
orthographic view towards the north, polygons painted from the far to the near.
"""

import argparse
import io
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import netCDF4
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from PIL import Image

ELEVATION = np.radians(48.0)  # of the eye above the horizon
DEGREES_PER_METRE = 0.085  # the exaggeration of depth
FLOOR = 300.0  # metres; where the drawn block of ocean ends
SOUTH, NORTH = -48.0, 52.0  # the 20 degC surface lies between
LIGHT = np.array([-0.45, -0.35, 0.82]) / np.linalg.norm([-0.45, -0.35, 0.82])
LAND, DEEP, BASE = np.array([0.905, 0.885, 0.845]), np.array([0.77, 0.81, 0.83]), np.array([0.925, 0.945, 0.96])
BACK_WALL, EDGE = np.array([0.955, 0.967, 0.976]), "#b9c6d0"
MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()

PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
             "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4",
             "float32": "f4", "double": "f8", "float64": "f8"}


def read_ply_tables(path):
    """The elements of a binary little-endian PLY file of triangles, by name, as tables with a column per property."""
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
    return tables


def read_ply(path):
    """Vertices (#V x 3) and triangles (#F x 3) of a binary little-endian PLY file of triangles."""
    tables = read_ply_tables(path)
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


def runs(keys):
    """The runs of equal entries of a sequence: (first, end) of each."""
    edges = [0, *(np.flatnonzero(keys[1:] != keys[:-1]) + 1), len(keys)]
    return zip(edges[:-1], edges[1:])


def ground_polygons(path):
    """Land and sea floor as steps, from the depth at which values begin to be missing: the tops of the steps, and
    their walls to the south (no other side can be seen)."""
    with netCDF4.Dataset(path) as data:
        lon, lat, depth = (data[name][:].data for name in ("lon", "lat", "depth"))
        missing = np.ma.getmaskarray(data["temperature"][0])
    top = np.where(missing.any(axis=0), depth[missing.argmax(axis=0)], FLOOR).clip(max=FLOOR)
    rows = np.flatnonzero((lat > SOUTH) & (lat < NORTH))
    half = (lon[1] - lon[0]) / 2
    polygons, colours = [], []

    def add(polygon, shallow, brightness):
        polygons.append(polygon)
        share = shallow / FLOOR
        colours.append(((1 - share) * LAND + share * DEEP) * brightness)

    for j in rows:
        south, north = max(lat[j] - half, SOUTH), min(lat[j] + half, NORTH)
        in_front = top[j - 1] if j > rows[0] else np.full_like(top[j], FLOOR)
        for first, end in runs(top[j]):
            if top[j, first] < FLOOR:
                add(box(lon[first] - half, lon[end - 1] + half, south, north, top[j, first]), top[j, first], 1.0)
        for first, end in runs(top[j] * 1e4 + in_front):
            if top[j, first] < in_front[first]:
                add(wall(lon[first] - half, lon[end - 1] + half, south, top[j, first], in_front[first]),
                    top[j, first], 0.78)
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


def draw_box(axes, west, east):
    """The block of ocean behind the surface: its floor and the wall to the north."""
    floor = np.array(box(west, east, SOUTH, NORTH, FLOOR))
    back = np.array(wall(west, east, NORTH, 0.0, FLOOR))
    for polygon, colour in ((floor, BASE), (back, BACK_WALL)):
        axes.add_patch(plt.Polygon(project(polygon), facecolor=colour, edgecolor=EDGE, linewidth=0.6))


def draw_rim(axes, west, east):
    """The edges of the block that are nearest to the eye."""
    for line in (box(west, east, SOUTH, NORTH, 0.0)[:2], wall(west, west, SOUTH, 0.0, FLOOR)[1:3],
                 wall(east, east, SOUTH, 0.0, FLOOR)[1:3], box(west, west, SOUTH, NORTH, 0.0)[1:3],
                 box(east, east, SOUTH, NORTH, 0.0)[1:3]):
        axes.plot(*project(np.array(line)).T, color=EDGE, linewidth=0.6)


def degrees(value, negative, positive):
    """-30 -> '30° S'; longitudes beyond 180 degrees are west."""
    value = value - 360 if value > 180 else value
    return f"{abs(value):g}°" + (f" {negative if value < 0 else positive}" if value % 180 else "")


def draw_degrees(axes, west, east):
    """Longitudes below the block, along its edge nearest to the eye; latitudes beside it, at the surface of the sea."""
    style = {"fontsize": 8.5, "color": "#666666"}
    for lon in range(60 * int(np.ceil(west / 60)), int(east) + 1, 60):
        x, y = project(np.array([lon, SOUTH, FLOOR]))
        axes.plot([x, x], [y, y - 1.2], color=EDGE, linewidth=0.8, clip_on=False)
        axes.text(x, y - 1.8, degrees(lon, "W", "E"), ha="center", va="top", **style)
    for lat in (-30, 0, 30):
        x, y = project(np.array([west, lat, 0.0]))
        axes.plot([x - 1.2, x], [y, y], color=EDGE, linewidth=0.8, clip_on=False)
        axes.text(x - 2, y, degrees(lat, "S", "N"), ha="right", va="center", **style)


def panel(axes, time, path, ground, colours, scale):
    ground_shapes, ground_colours, (west, east) = ground
    vertices, triangles = read_ply(path)
    shapes, faces = surface_polygons(vertices, triangles, colours, scale)
    # Triangles as quadrilaterals with a doubled corner: one collection, one order of painting.
    shapes = np.concatenate([shapes, shapes[:, 2:]], axis=1)
    draw_box(axes, west, east)
    draw(axes, np.concatenate([ground_shapes, shapes]), np.concatenate([ground_colours, faces]))
    draw_rim(axes, west, east)
    draw_degrees(axes, west, east)
    lowest, highest = (project(np.array([west, *corner]))[1] for corner in ((SOUTH, FLOOR), (NORTH, 0.0)))
    axes.set_xlim(west - 1, east + 1)
    axes.set_ylim(lowest - 1, highest + 1)
    axes.set_aspect("equal")
    axes.axis("off")
    title, detail = caption(time)
    axes.text(0.003, 1.01, title, transform=axes.transAxes, fontsize=15, fontweight="bold", va="bottom",
              color="#222222")
    axes.text(0.115, 1.018, detail, transform=axes.transAxes, fontsize=11.5, va="bottom", color="#666666")


def save(figure, path):
    """As a PNG of 256 colours: a third of the size, and hardly a difference to be seen."""
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=100, facecolor="white")
    image = Image.open(buffer).convert("RGB").quantize(256, kmeans=4, dither=Image.Dither.NONE)
    image.save(path, format="PNG", optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cuts", nargs="+", metavar="TIME=PLY")
    parser.add_argument("--land", required=True, help="the image, a netCDF file")
    parser.add_argument("-o", "--output", required=True, help="the picture, a PNG file")
    arguments = parser.parse_args()

    cuts = [(float(time), path) for time, _, path in (cut.partition("=") for cut in arguments.cuts)]
    colours, scale = plt.get_cmap("viridis_r"), Normalize(0.0, 250.0)
    ground = ground_polygons(arguments.land)
    figure, panels = plt.subplots(len(cuts), 1, figsize=(11, 2.95 * len(cuts)), squeeze=False)
    figure.subplots_adjust(left=0.042, right=0.918, top=1 - 0.11 / len(cuts), bottom=0.022, hspace=0.16)
    for axes, (time, path) in zip(panels[:, 0], cuts):
        panel(axes, time, path, ground, colours, scale)
    bar = figure.colorbar(plt.cm.ScalarMappable(scale, colours), cax=figure.add_axes([0.93, 0.25, 0.014, 0.5]))
    bar.ax.invert_yaxis()
    bar.set_label("depth of the 20 °C surface (m)", fontsize=11.5)
    bar.outline.set_visible(False)
    save(figure, arguments.output)


if __name__ == "__main__":
    main()
