#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Medicine: what is in a scan, and how large is it?

    examples/python/medical.py [FILE.nii.gz [OUTPUT_FOLDER]]

Without a file, the head that examples/make_samples.py makes: skin, skull, brain, and a tumour of 12 mm radius. The cells
(# %%) are as in a notebook.
"""

# %% The file: an array with its coordinates, in mm
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import tegl

output = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp())
if len(sys.argv) > 1:
    path = pathlib.Path(sys.argv[1])
else:
    samples = pathlib.Path(__file__).resolve().parent.parent / "make_samples.py"
    subprocess.run([sys.executable, samples, output], check=True)
    path = output / "head.nii.gz"
scan = tegl.read(path)
print(f"{path.name}: {scan.format}, {scan.array.shape} of {scan.array.dtype}, axes {', '.join(scan.axis_names)} "
      f"in {scan.axis_units[0]}, frame {scan.world_frame}")

# %% Bone: a closed surface, with normals for smooth shading
skull = scan.contour(300, normals=True)
report = skull.check()
print(f"bone: {len(skull.simplices)} triangles, {report.components} surfaces, "
      f"closed: {report.is_closed}, manifold: {report.is_manifold}")
skull.save(output / "skull.ply")
assert report.is_closed and report.is_manifold and report.components == 2

# %% All parts at 60 HU, and the one that is as small as a tumour
parts = scan.contour(60).components()
for part in parts:
    print(f"part {part.label}: {part.size:9.1f} mm2, encloses {part.content:12.1f} mm3, around "
          + ", ".join(f"{name} {at:6.1f}" for name, at in zip(scan.axis_names, part.centroid)))
tumour = parts.select([part.content is not None and 0 < part.content < 10000 for part in parts])
volume = tumour.measure().content
assert volume is not None  # as of an open surface
print(f"tumour: {volume:.0f} mm3; a ball of 12 mm has {4 / 3 * np.pi * 12**3:.0f}")
assert len(parts) == 3 and abs(volume / (4 / 3 * np.pi * 12**3) - 1) < 0.06

# %% A tenth of the triangles, no point farther than 0.5 mm off
coarse, stats = skull.simplify(max_error=0.5, return_stats=True)
bounds = [bound for bound in (stats.error_of_original, stats.error_of_result) if bound is not None]
before, after = skull.measure().content, coarse.measure().content
assert len(bounds) == 2 and bounds[1] <= 0.5 and before is not None and after is not None
print(f"simplified: {stats.simplices_before} -> {stats.simplices_after} triangles, {max(bounds):.2f} mm off at most, "
      f"volume {after / before - 1:+.2%}")
assert stats.simplices_after < stats.simplices_before / 3

# %% The same surface as users of scikit-image have it
verts, faces, normals, values = tegl.marching_cubes(scan.array, 300, spacing=(3.2, 3.2, 3.2))
print(f"marching_cubes: {len(verts)} vertices, {len(faces)} faces")
assert abs(len(faces) / len(skull.simplices) - 1) < 0.01
