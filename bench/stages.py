# SPDX-License-Identifier: BSD-3-Clause
"""Runs extract_bench for every field, value type and variant, and keeps what it found in bench/results/stages.json."""

import json
import os
import pathlib
import subprocess
import tempfile

import machine

BUILD = machine.ROOT / "build/release"
WANTED = ("name", "real_time", "classify_ms", "find_ms", "generate_ms", "close_ms", "samples/s", "tiles/s",
          "items_per_second", "bytes_per_second", "output_bytes/s", "classify_bytes/s", "generate_bytes/s", "active_tiles",
          "simplices")


def main() -> None:
    os.environ["GLIBC_TUNABLES"] = "glibc.malloc.hugetlb=1"
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([BUILD / "bench/extract_bench", "--benchmark_filter=^(extract|types)/", "--benchmark_min_time=0.2",
                        f"--benchmark_out={out}", "--benchmark_out_format=json"], check=True)
        found = json.loads(out.read_text())["benchmarks"]
    kept = [{key: run[key] for key in WANTED if key in run} for run in found]
    path = machine.ROOT / "bench/results/stages.json"
    path.write_text(json.dumps({"machine": machine.describe(BUILD), "benchmarks": kept}, indent=1) + "\n")


if __name__ == "__main__":
    main()
