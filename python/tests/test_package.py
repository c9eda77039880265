# SPDX-License-Identifier: BSD-3-Clause
"""`pip install .` without a network, from the build that is there, and the package from another folder."""

import hashlib
import base64
import csv
import os
import pathlib
import subprocess
import sys
import zipfile

import pytest

SOURCE, BUILD = (pathlib.Path(os.environ[name]) for name in ("TEGL_SOURCE_DIR", "TEGL_BUILD_DIR"))


def run(*command, **more):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, **more)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def environment():
    """Without the build's package, and without a way to anywhere."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | {
        "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_NO_CACHE_DIR": "1"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory, environment):
    folder = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "-w", folder, f"--config-settings=build-dir={BUILD}",
        SOURCE, cwd=folder, env=environment)
    found = list(folder.glob("tegl-*.whl"))
    assert len(found) == 1
    return found[0]


def test_the_wheel_has_what_its_record_says(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        record = next(name for name in names if name.endswith("/RECORD"))
        rows = list(csv.reader(archive.read(record).decode().splitlines()))
        assert {row[0] for row in rows} == names
        for name, digest, size in rows:
            if name != record:
                data = archive.read(name)
                assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
                assert int(size) == len(data)
        metadata = archive.read(record.replace("RECORD", "METADATA")).decode()
    assert {"tegl/__init__.py", "tegl/py.typed", "tegl/_tegl.pyi"} <= names
    assert all(name.startswith(("tegl/", "tegl-")) for name in names)
    assert "Name: tegl\n" in metadata and "Requires-Dist: numpy\n" in metadata


def test_pip_installs_it_and_it_works_elsewhere(tmp_path, environment):
    site = tmp_path / "site"
    run(sys.executable, "-m", "pip", "install", "--no-deps", "--target", site, f"--config-settings=build-dir={BUILD}",
        SOURCE, cwd=tmp_path, env=environment)
    output = run(sys.executable, "-c", "import numpy, tegl; print(tegl.__file__, tegl.__version__); "
                 "print(tegl.marching_cubes(numpy.eye(4)[:, :, None] * numpy.ones(4), 0.5)[1].shape[1])",
                 cwd=tmp_path, env=environment | {"PYTHONPATH": str(site)})
    assert output.startswith(str(site)) and output.endswith("\n3\n")
