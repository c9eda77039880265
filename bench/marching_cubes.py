#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tegl.marching_cubes against skimage.measure.marching_cubes, for each kind of arguments.

    PYTHONPATH=build/release/python bench/marching_cubes.py [--samples N] [--turns N] [--only TEXT]

Both get the same volume in one process and take turns, so that what disturbs the machine meets both; tegl.contour with the
same mask takes turns with them. Prints medians of milliseconds as a table in Markdown, and how many times as fast
tegl.marching_cubes is. The volume is a gyroid of N x N x N samples; the masks are a half of it, and a random half.
"""

import argparse
import os
import statistics
import time

import numpy as np
import skimage
import skimage.measure
import tegl


def gyroid(samples: int) -> np.ndarray:
    z, y, x = np.ogrid[tuple([slice(0, 8 * np.pi, samples * 1j)] * 3)]
    return (np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)).astype(np.float32)


def cases(volume: np.ndarray) -> dict:
    half = np.zeros(volume.shape, dtype=bool)
    half[:, :, :volume.shape[2] // 2] = True
    scattered = np.random.default_rng(1).random(volume.shape) < 0.5
    found = {}
    for method in ("lewiner", "lorensen"):
        found[method] = dict(method=method)
        found[f"{method}, allow_degenerate=False"] = dict(method=method, allow_degenerate=False)
    return found | {
        "float64": dict(volume=volume.astype(np.float64)),
        "int16": dict(volume=(volume * 1000).astype(np.int16)),
        "Fortran order": dict(volume=np.asfortranarray(volume)),
        "ties": dict(volume=np.round(volume * 4)),
        "ties, allow_degenerate=False": dict(volume=np.round(volume * 4), allow_degenerate=False),
        "spacing": dict(spacing=(3.0, 0.8, 0.8)),
        "step_size=2": dict(step_size=2),
        "mask: all": dict(mask=np.ones(volume.shape, dtype=bool)),
        "mask: a half": dict(mask=half),
        "mask: a half, allow_degenerate=False": dict(mask=half, allow_degenerate=False),
        "mask: a half, step_size=2": dict(mask=half, step_size=2),
        "mask: random": dict(mask=scattered),
        "mask: random, allow_degenerate=False": dict(mask=scattered, allow_degenerate=False),
    }


def milliseconds(call) -> float:
    start = time.perf_counter()
    call()
    return 1e3 * (time.perf_counter() - start)


def measure(volume: np.ndarray, arguments: dict, turns: int) -> tuple[float, float, float | None]:
    """Medians: scikit-image, tegl.marching_cubes, tegl.contour with the same mask."""
    volume = arguments.pop("volume", volume)
    sides = [lambda: skimage.measure.marching_cubes(volume, 0.1, **arguments),
             lambda: tegl.marching_cubes(volume, 0.1, **arguments)]
    if "mask" in arguments and len(arguments) == 1:
        sides.append(lambda: tegl.contour(volume, 0.1, mask=arguments["mask"]))
    for side in sides[1:]:
        side()
    runs = [[milliseconds(side) for side in sides] for _ in range(turns)]
    medians = [statistics.median(column) for column in zip(*runs)]
    return medians[0], medians[1], medians[2] if len(sides) == 3 else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=256, metavar="N", help="samples along each axis (default: 256)")
    parser.add_argument("--turns", type=int, default=5, metavar="N", help="turns of each side (default: 5)")
    parser.add_argument("--only", default="", metavar="TEXT", help="only rows whose name has TEXT, such as mask")
    options = parser.parse_args()
    volume = gyroid(options.samples)
    print(f"{options.samples}³ samples, {os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}; scikit-image "
          f"{skimage.__version__}, NumPy {np.__version__}\n")
    print("| arguments | scikit-image | tegl.marching_cubes | times as fast | tegl.contour |\n|---|---|---|---|---|")
    for name, arguments in cases(volume).items():
        if options.only not in name:
            continue
        theirs, mine, contour = measure(volume, arguments, options.turns)
        print(f"| {name} | {theirs:.0f} ms | {mine:.0f} ms | {theirs / mine:.1f} | {'' if contour is None else f'{contour:.0f} ms'} |",
              flush=True)


if __name__ == "__main__":
    main()
