# SPDX-License-Identifier: BSD-3-Clause
"""What mypy says: of the package, of code that uses it (typed_user.py), and of examples/python. Skipped without mypy."""

import os
import pathlib
import re
import subprocess
import sys

import pytest
import tegl

pytest.importorskip("mypy")
SOURCE = pathlib.Path(os.environ["TEGL_SOURCE_DIR"])
PACKAGE = pathlib.Path(tegl.__file__).parent
USER = SOURCE / "python/tests/typed_user.py"


def mypy(cache, *files):
    """Its errors, by the name of the file; imports lead to the package as it was built. All runs have one cache, and so
    the same options: stricter ones are in typed_user.py."""
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--no-error-summary", "--config-file", SOURCE / "python/tests/mypy.ini",
         "--cache-dir", cache, *files],
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent)}, cwd=SOURCE, capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp("mypy")


def test_package_users_examples_and_docs_are_sound(cache, tmp_path):
    pages = [SOURCE / f"docs/{name}.md" for name in ("python", "python-arrays", "scikit-image")]
    files = []
    for page in pages:
        blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
        assert blocks, page
        code = re.sub(r":(\d+)j", r":\1", "\n".join(blocks))  # mypy knows no slices with complex steps, as numpy.ogrid has
        files.append(tmp_path / f"{page.stem.replace('-', '_')}_page.py")
        files[-1].write_text(code)
    assert mypy(cache, PACKAGE, USER, SOURCE / "examples/python", *files) == ""


def test_wrong_code_is_found(cache, tmp_path):
    """Each line of typed_user.py that is ignored is an error without that, so the checker really sees the hints."""
    text = USER.read_text(encoding="utf-8")
    path = tmp_path / "wrong.py"
    path.write_text(re.sub(r"  # type: ignore.*", "", text).replace("contour.slice(1.5), tegl.Contour",
                                                                     "contour.slice(1.5), tegl.Measures"))
    found = {int(line) for line in re.findall(r"wrong\.py:(\d+): error", mypy(cache, path))}
    expected = {number for number, line in enumerate(text.splitlines(), 1)
                if "# type: ignore" in line or "contour.slice(1.5), tegl.Contour" in line}
    assert found == expected and len(expected) > 8
