#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What README.md and docs/ show is what works.

    docs_test.py commands SOURCE BIN    runs every block marked ```sh in a scratch folder, BIN first in the PATH
    docs_test.py snippets SOURCE        every ```cpp and ```cmake block stands in a file that the build compiles
    docs_test.py links SOURCE           every relative link leads to a file
    docs_test.py options SOURCE BIN     docs/command-line.md names every option that the programs' help names
    docs_test.py examples SOURCE BIN    what the help and inline code show of ocean.vtkhdf and ocean.nc works with the
                                        file in examples/data

Blocks marked otherwise (```console, ```text) are for reading only.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap


def pages(source):
    return [source / "README.md", source / "CONTRIBUTING.md", source / "CHANGELOG.md",
            source / "examples/data/README.md", *sorted((source / "docs").rglob("*.md"))]


def blocks(page, languages):
    """(line number, language, text) of each fenced block of one of these languages."""
    found, start, language, lines = [], 0, None, []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if not line.lstrip().startswith("```"):
            lines.append(line)
        elif language is None:
            start, language, lines = number, line.strip()[3:].strip(), []
        else:
            if language in languages:
                found.append((start, language, textwrap.dedent("\n".join(lines)) + "\n"))
            language, lines = None, []
    assert language is None, f"{page}:{start}: a block without an end"
    return found


def commands(source, programs):
    """Runs the blocks of each page one after the other, as a reader would, and reports the first that fails."""
    count = 0
    for page in pages(source):
        with tempfile.TemporaryDirectory() as folder:
            # Commands are written for the root of the checkout, but must not leave files there.
            for name in ("examples",):
                os.symlink(source / name, pathlib.Path(folder) / name)
            environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
            for line, _, text in blocks(page, {"sh"}):
                done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, text=True,
                                      capture_output=True, check=False)
                if done.returncode != 0:
                    sys.exit(f"{page}:{line}: exit status {done.returncode}\n{text}{done.stdout}{done.stderr}")
                count += 1
    assert count > 0, "no commands found: the pages have lost their blocks"
    print(f"{count} blocks of commands ran")


def snippets(source, _=None):
    """Looks for each snippet, as it is but for its indentation, in the compiled sources."""
    compiled = {"cpp": sorted((source / "examples").glob("*.cpp")),
                "cmake": [source / "tests/install/consumer/CMakeLists.txt"]}
    squeeze = lambda text: "\n".join(line.strip() for line in text.strip().splitlines())
    texts = {language: [squeeze(file.read_text(encoding="utf-8")) for file in files]
             for language, files in compiled.items()}
    count = 0
    for page in pages(source):
        for line, language, text in blocks(page, compiled.keys()):
            if not any(squeeze(text) in whole for whole in texts[language]):
                sys.exit(f"{page}:{line}: this {language} block is in none of "
                         f"{[str(file.relative_to(source)) for file in compiled[language]]}:\n{text}")
            count += 1
    assert count > 0, "no snippets found: the pages have lost their blocks"
    print(f"{count} snippets are compiled elsewhere")


def links(source, _=None):
    count = 0
    for page in pages(source):
        for target in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8")):
            if re.match(r"[a-z]+:", target):
                continue
            if not (page.parent / target).exists():
                sys.exit(f"{page}: links to {target}, which is not there")
            count += 1
    assert count > 0, "no links found"
    print(f"{count} links lead somewhere")


def examples(source, programs):
    """Of other files, and of other variables, it is not known what they are; to simplify takes long."""
    count = 0
    environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    shown = [(f"tegl {name} --help", line.split("   (")[0].strip())
             for name in commands_of_tegl(programs) for line in help_of(programs, ["tegl", name]).splitlines()]
    shown += [(page, code) for page in pages(source)
              for code in re.findall(r"(?<!`)`([^`\n]+)`(?!`)", page.read_text(encoding="utf-8"))]
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(source / "examples/data/ocean_temperature.nc", pathlib.Path(folder) / "ocean.nc")
        run = lambda text: subprocess.run(["bash", "-c", text], cwd=folder, env=environment, text=True,
                                          capture_output=True, check=False)
        assert run("tegl contour ocean.nc --iso 20 -o ocean.vtkhdf").returncode == 0
        for where, text in shown:
            if "--var" in text or text.startswith("tegl simplify") or not re.match(r"tegl [a-z]+ ocean\.(nc|vtkhdf) ", text):
                continue
            done = run(text)
            if done.returncode != 0:
                sys.exit(f"{where}: exit status {done.returncode}\n{text}\n{done.stdout}{done.stderr}")
            count += 1
    assert count > 10, "the help has lost its examples"
    print(f"{count} examples ran")


def help_of(programs, program):
    return subprocess.run([f"{programs}/{program[0]}", *program[1:], "--help"], text=True, capture_output=True,
                          check=True).stdout


def commands_of_tegl(programs):
    listed = help_of(programs, ["tegl"]).split("Subcommands:")[1].split("Exit codes:")[0]
    found = re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE)
    assert {"info", "contour", "slice", "check"} <= set(found), found
    return found


def options(source, programs):
    page = (source / "docs/command-line.md").read_text(encoding="utf-8")
    count = 0
    for program in (["tegl"], *(["tegl", command] for command in commands_of_tegl(programs)), ["gen"]):
        text = help_of(programs, program)
        for option in sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text))):
            if f"`{option}" not in page and f" {option}" not in page:
                sys.exit(f"docs/command-line.md does not mention {option} of {' '.join(program)}")
            count += 1
    assert count > 10, "the programs' help has lost its options"
    print(f"{count} options are documented")


if __name__ == "__main__":
    globals()[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), *sys.argv[3:])
