#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Physics: elements of a freeze-out hypersurface, and currents integrated over it.

    examples/python/physics.py [OUTPUT_FOLDER]

The energy density of an expanding fireball over tau, eta, y and x. Where it falls to 0.6 GeV/fm3 the matter freezes out:
a hypersurface, here as a sum over elements d sigma_mu. The cells (# %%) are as in a notebook.
"""

# %% The fields that examples/make_samples.py writes
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import tegl

output = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
samples = pathlib.Path(__file__).resolve().parent.parent / "make_samples.py"
subprocess.run([sys.executable, samples, output], check=True)
density = tegl.read(output / "fireball.nc", "energy_density")
velocity = tegl.read(output / "fireball.nc", "vx")
print(f"{density.variable} in {density.value_unit} over {', '.join(density.axis_names)}: {density.array.shape}")

# %% The hypersurface, with the velocity on it
surface = density.contour(0.6, dtype=np.float64)
surface.sample(velocity, "vx")
print(surface, "manifold:", surface.check().is_manifold)
assert surface.check().is_manifold

# %% Its elements, one for each piece in a cell of the grid, as Cornelius gives them
elements = surface.elements(by_cell=True)
elements.save(output / "surface.dat", header=True)
print((output / "surface.dat").read_text().splitlines()[0])
total = elements.sum()
print(f"{len(elements)} elements; their sum: "
      + ", ".join(f"{name} {value:.3f}" for name, value in zip(density.axis_names, total.normal)))
# Open where the matter is hot already at the first time: what is missing is the area of that region, along tau alone.
assert (np.abs(total.normal[1:]) < 1e-9 * total.absolute[1:]).all() and total.normal[0] > 0

# %% Closed there, all elements add up to nothing: Gauss's theorem
closed = density.contour(0.6, close=True, dtype=np.float64)
total = closed.elements().sum()
print(f"closed: {np.abs(total.normal).max():.1e} of {total.absolute.max():.0f}, closure error {total.closure_error:.1e}")
assert closed.check().is_closed and total.closure_error < 1e-12

# %% A current's flux through it is the divergence inside: for j = position, 4 times the content
elements = closed.elements()
flux = (elements.centroids * elements.normals).sum()
inside = closed.measure().content
print(f"flux of x: {flux:.3f} = 4 x {inside:.3f}")
assert inside is not None and np.isclose(flux, 4 * inside, rtol=1e-9)

# %% A current n u^mu with n = 0.6, in the coordinates' order, through the open surface: the velocity is sampled on it
elements = surface.elements()
vx = elements.attributes["vx"]
gamma = 1 / np.sqrt(1 - vx**2)
current = 0.6 * np.stack([gamma, 0 * vx, 0 * vx, gamma * vx], axis=1)  # tau, eta, y, x
through = (current * elements.normals).sum()
print(f"flux of n u through the surface: {through:.2f}")
assert np.isfinite(through) and np.isfinite(vx).all()
