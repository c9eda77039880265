# SPDX-License-Identifier: BSD-3-Clause
"""The machine of a measurement: processor, caches, memory, compiler, versions of the peers. Names nothing that tells
one machine of a kind from another, and no path."""

import json
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def output(*command: str) -> str:
    """What a command prints, or nothing if it is not there or fails."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def cache_entry(build: pathlib.Path, key: str) -> str:
    """A value of CMakeCache.txt."""
    match = re.search(rf"^{re.escape(key)}:\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return match.group(1) if match else ""


def compiler(build: pathlib.Path) -> str:
    return output(cache_entry(build, "CMAKE_CXX_COMPILER"), "--version").splitlines()[0]


def processor() -> dict:
    wanted = {"Model name": "model", "CPU(s)": "cores", "L1d cache": "l1d", "L2 cache": "l2", "L3 cache": "l3",
              "Hypervisor vendor": "hypervisor"}
    found = {}
    text = output("lscpu", "-J")
    for field in json.loads(text)["lscpu"] if text else []:
        name = field["field"].rstrip(":")
        if name in wanted:
            found[wanted[name]] = field["data"]
    flags = pathlib.Path("/proc/cpuinfo").read_text()
    found["simd"] = next((s for s in ("avx512f", "avx2", "sse4_2", "asimd") if f" {s} " in flags), "none of those known")
    return found


def memory_gib() -> float:
    kib = re.search(r"^MemTotal:\s+(\d+)", pathlib.Path("/proc/meminfo").read_text(), re.MULTILINE)
    return round(int(kib.group(1)) / 2**20, 1)


def package(name: str) -> str:
    return output("dpkg-query", "-W", "-f", "${Version}", name)


def describe(build: pathlib.Path) -> dict:
    huge = pathlib.Path("/sys/kernel/mm/transparent_hugepage/enabled")
    return {
        "processor": processor(),
        "memory_gib": memory_gib(),
        "kernel": os.uname().release,
        "transparent_huge_pages": huge.read_text().strip() if huge.exists() else "",
        "glibc_tunables": os.environ.get("GLIBC_TUNABLES", ""),
        "compiler": compiler(build),
        "build_type": cache_entry(build, "CMAKE_BUILD_TYPE"),
        "commit": output("git", "rev-parse", "--short=12", "HEAD"),
        "changed_since": bool(output("git", "status", "--porcelain", "--untracked-files=no", "--", "runtime", "generator")),
        "packages": {name: package(name) for name in
                     ("libvtk9-dev", "python3-contourpy", "python3-skimage", "python3-numpy", "libtbb-dev", "libhwy-dev")},
        "load_average": os.getloadavg()[0],
    }


def lines(machine: dict) -> list[str]:
    """The same for readers, as Markdown."""
    cpu = machine["processor"]
    caches = ", ".join(f"{name} {cpu[key]}" for name, key in (("L1d", "l1d"), ("L2", "l2"), ("L3", "l3")) if key in cpu)
    packages = ", ".join(f"{name} {version}" for name, version in machine["packages"].items() if version)
    return [
        f"{cpu.get('model', 'unknown processor')}, {cpu.get('cores', '?')} cores, {cpu['simd']} "
        f"({caches}), {machine['memory_gib']} GiB; {machine['compiler']}, {machine['build_type']}; "
        f"GLIBC_TUNABLES={machine['glibc_tunables'] or '(none)'}; transparent huge pages: "
        f"{machine['transparent_huge_pages']}; load average at the start {machine['load_average']:.1f}.",
        "",
        f"Commit {machine['commit']}{' with changes' if machine['changed_since'] else ''}. {packages}.",
    ]
