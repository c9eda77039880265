# SPDX-License-Identifier: BSD-3-Clause
"""Builds the wheel of the Python package (PEP 517): what pip calls.

Where scikit-build-core is installed it does the work ([tool.scikit-build] in pyproject.toml). Debian 12 has it not, so
otherwise the few steps are done here, with CMake and the standard library alone: configure, build, install the
component `python` into a folder, zip that up. Settings, with `pip --config-settings NAME=VALUE`:

    build-dir     a folder to build in, which is kept; one that is configured already is used as it is, with the
                  package turned on, so that `build/release` takes what is built there for the program
    cmake-args    further arguments of CMake's configuration, between blanks
"""

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

try:
    import tomllib
except ImportError:  # Python 3.10
    from pip._vendor import tomli as tomllib

try:
    from scikit_build_core import build as _scikit_build
except ImportError:
    _scikit_build = None

ROOT = pathlib.Path(__file__).resolve().parent.parent


def _project():
    with open(ROOT / "pyproject.toml", "rb") as file:
        return tomllib.load(file)


def _version():
    header = (ROOT / "runtime/include/tegl/version.hpp").read_text(encoding="utf-8")
    return ".".join(re.search(rf"#define TEGL_VERSION_{part} (\d+)", header).group(1) for part in ("MAJOR", "MINOR", "PATCH"))


def _metadata():
    """The file METADATA of the wheel: what pyproject.toml says of the project."""
    project = _project()["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {_version()}",
             f"Summary: {project['description']}", f"Keywords: {','.join(project['keywords'])}",
             f"License: {project['license']['text']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Classifier: {classifier}" for classifier in project["classifiers"]]
    lines += [f"Requires-Dist: {requirement}" for requirement in project["dependencies"]]
    for extra, requirements in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {requirement} ; extra == "{extra}"' for requirement in requirements]
    readme = (ROOT / project["readme"]).read_text(encoding="utf-8")
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def _dist_info():
    """What the wheel says of itself: name of a file -> its text."""
    return {"METADATA": _metadata(), "LICENSE": (ROOT / "LICENSE").read_text(encoding="utf-8"),
            "WHEEL": f"Wheel-Version: 1.0\nGenerator: tegl_build\nRoot-Is-Purelib: false\nTag: {_tag()}\n"}


def _tag():
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{interpreter}-{interpreter}-{re.sub(r'[^A-Za-z0-9]', '_', sysconfig.get_platform())}"


def _run(*command):
    print("+", shlex.join(map(str, command)), flush=True)
    subprocess.run(list(map(str, command)), check=True)


def _build(build_dir, prefix, settings):
    """Configures (unless that is done), builds, and installs the package into a folder."""
    cache = build_dir / "CMakeCache.txt"
    if cache.exists():
        if not re.search(r"^TEGL_BUILD_PYTHON:BOOL=(ON|TRUE|YES|1)$", cache.read_text(encoding="utf-8"), re.MULTILINE):
            _run("cmake", f"-DPython_EXECUTABLE={sys.executable}", "-DTEGL_BUILD_PYTHON=ON", build_dir)
    else:
        defines = _project()["tool"]["scikit-build"]["cmake"]["define"]
        ninja = ["-G", "Ninja"] if subprocess.run(["ninja", "--version"], capture_output=True, check=False).returncode == 0 \
            else []
        _run("cmake", "-S", ROOT, "-B", build_dir, *ninja, "-DCMAKE_BUILD_TYPE=Release",
             f"-DPython_EXECUTABLE={sys.executable}", *(f"-D{name}={value}" for name, value in defines.items()),
             *shlex.split(settings.get("cmake-args", "")))
    _run("cmake", "--build", build_dir, "--target", "tegl_python_package", "--parallel", os.cpu_count() or 1)
    # RelWithDebInfo builds have symbols that are of no use in a wheel.
    _run("cmake", "--install", build_dir, "--component", "python", "--prefix", prefix, "--strip")


def _zip(folder, dist_info, wheel):
    """The wheel: the folder's files and its metadata, and RECORD, with a digest of each. Same files, same bytes."""
    files = {file.relative_to(folder).as_posix(): file.read_bytes() for file in sorted(folder.rglob("*"))
             if file.is_file()}
    files |= {f"{dist_info}/{name}": text.encode() for name, text in _dist_info().items()}
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.writerow([name, f"sha256={digest}", len(data)])
    rows.writerow([f"{dist_info}/RECORD", "", ""])
    files[f"{dist_info}/RECORD"] = record.getvalue().encode()
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    if _scikit_build is not None:
        return _scikit_build.prepare_metadata_for_build_wheel(metadata_directory, config_settings)
    name = f"tegl-{_version()}.dist-info"
    folder = pathlib.Path(metadata_directory) / name
    folder.mkdir()
    for file, text in _dist_info().items():
        (folder / file).write_text(text, encoding="utf-8")
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    if _scikit_build is not None:
        return _scikit_build.build_wheel(wheel_directory, config_settings, metadata_directory)
    settings = config_settings or {}
    name = f"tegl-{_version()}-{_tag()}.whl"
    with tempfile.TemporaryDirectory() as scratch:
        build_dir = pathlib.Path(settings.get("build-dir", pathlib.Path(scratch) / "build")).resolve()
        prefix = pathlib.Path(scratch) / "package"
        _build(build_dir, prefix, settings)
        _zip(prefix, f"tegl-{_version()}.dist-info", pathlib.Path(wheel_directory) / name)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """The files that git knows, which is what the project consists of."""
    if _scikit_build is not None:
        return _scikit_build.build_sdist(sdist_directory, config_settings)
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True, text=True).stdout
    top = f"tegl-{_version()}"
    with tarfile.open(pathlib.Path(sdist_directory) / f"{top}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for file in filter(None, listed.split("\0")):
            archive.add(ROOT / file, f"{top}/{file}", recursive=False)
        metadata = _metadata().encode()
        entry = tarfile.TarInfo(f"{top}/PKG-INFO")
        entry.size = len(metadata)
        archive.addfile(entry, io.BytesIO(metadata))
    return f"{top}.tar.gz"
