#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""filters.py PROGRAM [SIZE]: a Gaussian filter of SIZE^3 floats (512), and a median of at most 128^3, on one thread, by
tegl and by SciPy.

PROGRAM is filter_bench, whose samples both read. Needs python3-scipy (Debian). Prints seconds, the minimum of three
runs each.
"""

import os
import re
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy.ndimage


def seconds_of(call):
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


def main():
    program = sys.argv[1]
    size = int(sys.argv[2]) if len(sys.argv) > 2 else 512
    filters = {
        "gaussian": lambda image: scipy.ndimage.gaussian_filter(image, 2, mode="nearest"),
        "median": lambda image: scipy.ndimage.median_filter(image, 3, mode="nearest"),
    }
    with tempfile.TemporaryDirectory() as folder:
        samples = os.path.join(folder, "samples")
        for name, call in filters.items():
            if name == "median":
                size = min(size, 128)  # SciPy takes a minute for 256^3
            done = subprocess.run([program, name, str(size), "1", samples], capture_output=True, text=True, check=True)
            ours = float(re.search(r": ([0-9.]+) s", done.stdout).group(1))
            image = np.fromfile(samples, np.float32).reshape(size, size, size)
            theirs = seconds_of(lambda: call(image))
            print(f"{name} {size}^3, one thread: tegl {ours:.3f} s, SciPy {scipy.__version__} {theirs:.3f} s, "
                  f"ratio {theirs / ours:.2f}")


main()
