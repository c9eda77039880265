# SPDX-License-Identifier: BSD-3-Clause
"""The Python that docs/python.md and the package's docstring show runs, from top to bottom."""

import os
import pathlib
import re
import subprocess
import sys
import textwrap

import pytest
import tegl

SOURCE = pathlib.Path(os.environ["TEGL_SOURCE_DIR"])
PAGES = [page for page in sorted(SOURCE.glob("docs/*.md")) if "```python" in page.read_text(encoding="utf-8")]


def test_pages_with_python_were_found():
    assert SOURCE / "docs/python.md" in PAGES


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_blocks_of_a_page_run_one_after_the_other(page, tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(SOURCE / "examples")
    monkeypatch.chdir(tmp_path)
    names = {}
    text = page.read_text(encoding="utf-8")
    for block in re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        line = text[:block.start()].count("\n") + 1
        exec(compile("\n" * line + block.group(1), str(page), "exec"), names)


def test_the_docstring_of_the_package_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = re.search(r"\n\n((?:    .*\n|\n)+)", tegl.__doc__).group(1)
    exec(compile(textwrap.dedent(code), "tegl", "exec"), {})
    assert (tmp_path / "surface.ply").exists()


def test_the_page_names_all_of_the_package():
    text = (SOURCE / "docs/python.md").read_text(encoding="utf-8")
    for name in ("contour", "slice", "frame_of", "track", "components", "measure", "elements", "simplify", "check", "intersections", "Index", "read",
                 "load", "marching_cubes", "contour_mesh", "Cancelled"):
        assert re.search(rf"\b{name}\b", text), name


@pytest.mark.parametrize("line, text", [("extract.hpp no_such_function", "no documented declaration of no_such_function"),
                                        ("extract.hpp extract#9", "no documented declaration of extract number 9"),
                                        ("contour.hpp ContourSize", None)])
def test_docstrings_of_what_is_gone_fail_the_build(line, text, tmp_path):
    (tmp_path / "list.txt").write_text(line + "\n")
    done = subprocess.run([sys.executable, SOURCE / "python/extract_docs.py", tmp_path / "list.txt",
                           SOURCE / "runtime/include/tegl", tmp_path / "docs.hpp"], capture_output=True, text=True,
                          check=False)
    if text is None:
        assert done.returncode == 0 and "How large a contour is." in (tmp_path / "docs.hpp").read_text()
    else:
        assert done.returncode != 0 and text in done.stderr and not (tmp_path / "docs.hpp").exists()


def test_a_figure_of_the_thesis_is_drawn(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(tegl.__file__).parents[1])}
    subprocess.run([sys.executable, SOURCE / "scripts/thesis_figures", "9.2", tmp_path], env=environment, check=True)
    assert (tmp_path / "thesis_9_2.svg").read_bytes() == (SOURCE / "docs/images/thesis_9_2.svg").read_bytes()
