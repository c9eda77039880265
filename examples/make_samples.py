#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes three small images to try tegl on: what docs/getting-started.md begins with.

    examples/make_samples.py FOLDER

    head.nii.gz                a head as computed tomography would have it, in Hounsfield units, on a grid of 3.2 mm:
                               skin, skull, brain, and a tumour of 12 mm radius. NIfTI-1.
    drops_40x24x24x21_float.raw  two drops that meet and merge, and one that comes off: only values, as simulations
                               dump them, x fastest, time last
    fireball.nc                the energy density of an expanding fireball over tau, eta, y and x, and its transverse
                               velocity. netCDF.

All are made by formulas, rounded so that every machine has the same values. Needs python3-numpy and python3-netcdf4.
"""

import gzip
import pathlib
import struct
import sys

import netCDF4
import numpy as np


def axes(*coordinates):
    """Coordinates to calculate with, the last axis first, as arrays in C order have x fastest."""
    return np.meshgrid(*reversed(coordinates), indexing="ij", sparse=True)[::-1]


def head():
    """HU over z, y, x, and the coordinates. What lies between two tissues takes a voxel to change."""
    step = 3.2
    x, y, z = coordinates = [step * (np.arange(count) - (count - 1) / 2) for count in (56, 68, 54)]
    x, y, z = axes(x, y, z)
    radius = np.sqrt((x / 72) ** 2 + (y / 92) ** 2 + (z / 70) ** 2)
    inside = lambda edge: np.clip((edge - radius) * 78 / step + 0.5, 0, 1)  # 78 mm: what a radius of 1 is, or so
    tumour = np.clip((12 - np.sqrt((x - 25) ** 2 + (y - 12) ** 2 + (z - 14) ** 2)) / step + 0.5, 0, 1)
    value = -1000 + 1040 * inside(1.0) + 860 * inside(0.94) - 865 * inside(0.84) + 50 * tumour
    return np.round(value).astype("<i2"), coordinates, step


def write_nifti(path, values, coordinates, step):
    header = bytearray(352)
    sizes = [len(axis) for axis in coordinates]
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *sizes, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)  # int16
    struct.pack_into("<8f", header, 76, 1, step, step, step, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)  # where the values begin
    struct.pack_into("<ff", header, 112, 1, 0)
    header[123] = 2  # millimetres
    struct.pack_into("<hh", header, 252, 0, 1)  # sform
    for row, axis in enumerate(coordinates):
        transform = [0.0, 0.0, 0.0, axis[0]]
        transform[row] = step
        struct.pack_into("<4f", header, 280 + 16 * row, *transform)
    header[344:348] = b"n+1\0"
    with open(path, "wb") as file:
        file.write(gzip.compress(bytes(header) + values.tobytes(), mtime=0))


def drops():
    x, y, z, t = axes(np.arange(40), np.arange(24), np.arange(24), np.arange(21))
    blob = lambda at, size: np.exp(-((x - at) ** 2 + (y - 11.5) ** 2 + (z - 11.5) ** 2) / (2 * size**2))
    left, right = blob(8 + 0.45 * t, 3.2), blob(28 - 0.45 * t, 2.6)
    comes_off = blob(19 + 1.5 * np.maximum(t - 10.3, 0), 2.0) * np.clip((t - 8) / 4, 0, 1)
    return np.round(left + right + comes_off, 4).astype("<f4")


def write_fireball(path):
    tau, eta = 0.6 + 0.4 * np.arange(26), -3 + 0.4 * np.arange(16)
    across = -9 + 0.6 * np.arange(31)
    x, y, rapidity, time = axes(across, across, eta, tau)
    width = 2.4 + 0.22 * time
    density = 25 * (0.6 / time) ** (4 / 3) * np.exp(-(x**2 + (1.25 * y) ** 2) / (2 * width**2) - rapidity**4 / 40)
    with netCDF4.Dataset(path, "w") as file:
        for name, values in (("tau", tau), ("eta", eta), ("y", across), ("x", across)):
            file.createDimension(name, len(values))
            file.createVariable(name, "f8", (name,))[:] = np.round(values, 4)
            if name != "eta":
                file[name].units = "fm"
        for name, values in (("energy_density", density), ("vx", np.tanh(0.1 * x) + 0 * density)):
            file.createVariable(name, "f4", ("tau", "eta", "y", "x"), compression="zlib")[:] = np.round(values, 4)
        file["energy_density"].units = "GeV/fm3"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    write_nifti(folder / "head.nii.gz", *head())
    drops().tofile(folder / "drops_40x24x24x21_float.raw")
    write_fireball(folder / "fireball.nc")


if __name__ == "__main__":
    main()
