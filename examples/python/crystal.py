#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A crystal: surfaces of a density of electrons (CHGCAR of VASP) or Fermi surfaces (BXSF of XCrySDen), in an oblique cell.

    examples/python/crystal.py [FILE]

Without a file, the script takes a model of a CHGCAR. The cells (# %%) are as in a notebook.
"""

# %% Files: words of numbers behind a head. Both readers give samples with the axes a, b, c, and the cell's vectors as rows
import gzip
import math
import pathlib
import re
import sys

import numpy as np
import tegl


def read_chgcar(text):
    """Electrons per Å³. The file has them times the cell's volume, the first axis fastest. The rest of the file is not read."""
    head, numbers = re.split(r"\n[ \t]*\n", text, maxsplit=1)
    lines = head.splitlines()
    vectors = np.array([line.split() for line in lines[2:5]], dtype=float)
    scale = float(lines[1])  # a factor, or, if negative, the volume
    vectors *= scale if scale > 0 else (-scale / abs(np.linalg.det(vectors))) ** (1 / 3)
    sizes = [int(word) for word in numbers.split(maxsplit=3)[:3]]
    end = 3 + math.prod(sizes)
    values = np.array(numbers.split(maxsplit=end)[3:end], dtype=float)
    return values.reshape(sizes, order="F") / abs(np.linalg.det(vectors)), vectors


def read_bxsf(text):
    """The Fermi energy and the energies of all bands, the last axis fastest. The last samples repeat the first ones: they
    are left out."""
    fermi = float(text.split("Fermi Energy:")[1].split()[0])
    words = text.split("BANDGRID_3D_BANDS")[1].split()  # count, sizes, origin, vectors, and "BAND:", number, energies
    sizes = [int(word) for word in words[1:4]]
    vectors = np.array(words[7:16], dtype=float).reshape(3, 3)
    count = math.prod(sizes)
    bands = [np.array(words[first:first + count], dtype=float).reshape(sizes)[:-1, :-1, :-1]
             for first in range(18, 18 + int(words[0]) * (count + 2), count + 2)]
    return fermi, bands, vectors


def model_chgcar(size=24, edge=3.9):
    """A face-centred cubic cell with a density that is least at the atom, where VASP's pseudo-densities may be negative."""
    vectors = 0.5 * edge * np.array([[1, 1, 0], [0, 1, 1], [1, 0, 1]])
    a, b, c = np.meshgrid(*[2 * np.pi * np.arange(size) / size] * 3, indexing="ij")
    density = 4 - np.cos(a) - np.cos(b) - np.cos(c) - np.cos(a - b + c)
    head = ["model", "1.0"] + [" ".join(f"{x:.6f}" for x in vector) for vector in vectors] + ["Si", "1", "Direct", "0 0 0"]
    return "\n".join(head + ["", f"{size} {size} {size}"] + [f"{x:.11E}" for x in density.ravel(order="F")]) + "\n"


# %% Read the file, or a model
name = sys.argv[1] if len(sys.argv) > 1 else ""
stored = pathlib.Path(name).read_bytes() if name else model_chgcar().encode()
text = (gzip.decompress(stored) if name.endswith(".gz") else stored).decode()
if "BANDGRID_3D_BANDS" in text:
    fermi, bands, vectors = read_bxsf(text)
    fields = [(values, fermi) for values in bands if values.min() < fermi < values.max()]
    if not fields:
        sys.exit(f"{name}: none of the {len(bands)} bands has the Fermi energy {fermi:g} between its energies, as in an "
                 f"insulator; expected a metal")
else:
    values, vectors = read_chgcar(text)
    fields = [(values, np.quantile(values, share)) for share in (0.2, 0.5, 0.9)]


# %% Contours of the whole cell: all three axes are periodic, and the affine transform has the vectors' steps as columns
def surface_of(values, level):
    affine = np.column_stack([vectors.T / values.shape, np.zeros(3)])
    return tegl.contour(values, level, affine=affine, periodic="all", dtype=float)


volume = abs(np.linalg.det(vectors))
print(f"{pathlib.Path(name).name or 'model'}: {' x '.join(map(str, fields[0][0].shape))} samples, a cell of the volume {volume:.5g}")
for values, level in fields:
    surface = surface_of(values, level)
    report, measures = surface.check(), surface.measure()
    if measures.content is None:
        inside = "no inside, as it winds round the cell"
    else:  # negative if the inside is low
        inside = f"{'high' if measures.content > 0 else 'low'} inside: {abs(measures.content) / volume:.2%} of the cell"
    print(f"level {level:.5g}: closed: {report.is_closed}, components: {report.components}, Euler characteristic: "
          f"{report.euler}, area: {measures.size:.5g}, {inside}")
    assert report.is_closed and report.is_manifold

    # the start of the cell makes no difference
    rolled = surface_of(np.roll(values, (3, 7, 5), axis=(0, 1, 2)), level)
    assert (rolled.check().components, rolled.check().euler) == (report.components, report.euler)
    assert np.isclose(rolled.measure().size, measures.size)

# %% For pictures, simplices across the seams move to the end of the cell
surface = surface_of(*fields[0])
picture, originals = surface.unroll()
print(f"{len(picture.vertices) - len(surface.vertices)} vertices on the seams are doubled for pictures")
