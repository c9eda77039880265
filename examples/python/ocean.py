#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Oceans: where the water is 20 degrees warm, at any time of the year.

    examples/python/ocean.py [FILE.nc [OUTPUT_FOLDER]]

A year of monthly temperatures becomes one contour in space and time, which is cut between the months. The cells (# %%)
are those of a notebook.
"""

# %% Twelve months of volumes; land is missing
import pathlib
import sys
import tempfile

import numpy as np
import tegl
import xarray

here = pathlib.Path(__file__).resolve().parent
image = tegl.read(sys.argv[1] if len(sys.argv) > 1 else here.parent / "data/ocean_temperature.nc")
output = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp())
print(f"{image.value_name} in {image.value_unit}: " +
      ", ".join(f"{name} ({size})" for name, size in zip(image.axis_names, image.array.shape)))

# %% One contour in space and time
contour = image.contour(20.0)
print(contour)
report = contour.check()
assert report.is_manifold and len(contour.simplices) > 100000

# %% Cut it at 7.3: some nine days after the middle of July
july = contour.slice(time=7.3)
print(f"t = 7.3: {july}, {july.check().components} components")
july.save(output / "july.ply")
assert july.check().is_manifold

# %% Straight from the array: only July and August are read, and the surface is the same
direct = tegl.slice(image, 20.0, at=7.3)
print(f"straight from the array: {direct}")
assert np.isclose(direct.measure().size, july.measure().size, rtol=1e-3)

# %% The same from xarray, with its own names, coordinates and missing values; any part of it will do
data: xarray.DataArray = image.to_xarray()
pacific = data.sel(lon=slice(120, 290), lat=slice(-40, 40))
surface = tegl.slice(pacific, 20.0, at=[1.5, 7.3, 10.9])
for at, cut in zip((1.5, 7.3, 10.9), surface):
    depth = cut.vertices[:, cut.axis_names.index("depth")]
    print(f"Pacific at t = {at:4}: {len(cut.simplices)} triangles, down to {depth.max():.0f} m")
    assert cut.check().is_manifold and 100 < depth.max() <= 500

# %% Values of another field on the contour: here the temperature a month later
later = image.array[np.minimum(np.arange(12) + 1, 11)]
change = contour.sample(later, "a month later", "degC", coords=image.coords) - 20.0
print(f"where it is 20 degC, it is {np.nanmean(change):+.2f} a month later, from {np.nanmin(change):+.1f} to "
      f"{np.nanmax(change):+.1f}")
assert np.isfinite(change).mean() > 0.9

# %% Which parts live longest, and what becomes of them?
graph = contour.track(min_lifetime=0.5)
kinds = [event.kind for event in graph.events]
print(f"{len(graph.tracks)} parts: " + ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds))))
graph.save(output / "tracks.svg", title="20 degC")
assert kinds.count("begin") > 0 and len(graph.tracks) > 3
