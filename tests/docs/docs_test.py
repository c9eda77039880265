#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What README.md and docs/ show is what works.

    docs_test.py commands SOURCE BIN    runs every block marked ```sh in a scratch checkout, BIN first in the PATH
    docs_test.py snippets SOURCE        every ```cpp, ```glsl and ```cmake block stands in a file that the build compiles
    docs_test.py emitted SOURCE BIN     every ```c++ block stands in a builder that gen emits
    docs_test.py links SOURCE           every link leads to a file, every anchor to a heading, and the front page to all pages
    docs_test.py transcripts SOURCE BIN [--update]
                                        the ```console blocks of getting-started.md, guides.md and the tutorials: what is behind each $ runs,
                                        and says what stands below it. --update writes what it says into the page. Neither
                                        these nor the pages' ```sh blocks leave anything that git status would show
    docs_test.py html SOURCE FOLDER     builds the documentation as scripts/docs does, into FOLDER
    docs_test.py checkers SOURCE        what looks for dead links and stale output finds them
    docs_test.py options SOURCE BIN     docs/command-line.md names every option that the programs' help names
    docs_test.py examples SOURCE BIN    what the help and inline code show of ocean.vtkhdf and ocean.nc works with the
                                        file in examples/data

Blocks marked otherwise (```text, and ```console of other pages) are for reading only.
"""

import itertools
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap


sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/site"))
import pages as markdown  # noqa: E402

pages = markdown.all_pages
TRANSCRIPTS = ("docs/getting-started.md", "docs/guides.md", "docs/tutorial-medicine.md", "docs/tutorial-ocean.md",
               "docs/tutorial-simulation.md", "docs/tutorial-physics.md")


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


def runs_here(text, programs):
    """A build without esbuild and three.js has no viewer, and says so."""
    return "tegl view " not in text or "has no viewer" not in subprocess.run(
        [f"{programs}/tegl", "view", __file__, "-o", "probe.html"], text=True, capture_output=True, check=False).stderr


class Shell:
    """A reader's shell in the root of a checkout: commands run one after the other, each where the last one went. The checkout
    is a scratch folder with what the commands read of it, and knows by git what they leave there."""

    def __init__(self, source, programs):
        self._scratch = tempfile.TemporaryDirectory()
        self._root = pathlib.Path(self._scratch.name) / "checkout"
        self._place = pathlib.Path(self._scratch.name) / "place"
        self._environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "DOCS_TEST_PLACE": str(self._place)}
        self._root.mkdir()
        self._place.write_text(f"{self._root}\n", encoding="utf-8")
        os.symlink(source / "examples", self._root / "examples")
        (self._root / ".gitignore").write_bytes((source / ".gitignore").read_bytes())
        self._git("init", "--quiet")
        self._git("add", "--all")
        self._git("-c", "user.name=test", "-c", "user.email=test@example.org", "commit", "--quiet", "--message", "before")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._scratch.cleanup()

    def _git(self, *arguments):
        return subprocess.run(["git", "-C", self._root, *arguments], text=True, capture_output=True, check=True).stdout

    def run(self, text):
        """(exit status, what was said in either stream)"""
        folder = self._place.read_text(encoding="utf-8").rstrip("\n")
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", f"{text}\npwd >\"$DOCS_TEST_PLACE\""], cwd=folder, text=True,
                              env=self._environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout

    def left_behind(self):
        """What `git status --short` says."""
        return self._git("status", "--short")


def require_clean(page, shell):
    if shell.left_behind():
        sys.exit(f"{page}: the commands leave files in the checkout:\n{shell.left_behind()}")


def commands(source, programs):
    """Runs the blocks of each page one after the other, as a reader would, and reports the first that fails."""
    count = 0
    for page in pages(source):
        with Shell(source, programs) as shell:
            for line, _, text in blocks(page, {"sh"}):
                if not runs_here(text, programs):
                    continue
                status, said = shell.run(text)
                if status != 0:
                    sys.exit(f"{page}:{line}: exit status {status}\n{text}{said}")
                count += 1
            if str(page.relative_to(source)) in TRANSCRIPTS:
                require_clean(page, shell)
    assert count > 0, "no commands found: the pages have lost their blocks"
    print(f"{count} blocks of commands ran")


def snippets(source, _=None):
    """Looks for each snippet, as it is but for its indentation, in the compiled sources."""
    compiled = {"cpp": [*sorted((source / "examples").glob("*.cpp")), source / "tests/docs/pages_test.cpp",
                        source / "tests/generator/builders/cell_example_test.cpp"],
                "glsl": [source / "tests/generator/builders/builders.comp"],
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


def stand_in(lines, chunks):
    """Whether the chunks of lines stand in the lines, one behind the other."""
    at = 0
    for chunk in chunks:
        at = next((first + len(chunk) for first in range(at, len(lines)) if lines[first:first + len(chunk)] == chunk), None)
        if at is None:
            return False
    return True


def emitted(source, programs):
    """Looks for each ```c++ block in the builders that gen emits from the edges. A line `// ...` stands for any lines."""
    rows_of = lambda text: [line.strip() for line in text.strip().splitlines()]
    texts = [rows_of(subprocess.run([f"{programs}/gen", "--dim", dim, "--builder", "--leaf", "edges"], text=True,
                                    capture_output=True, check=True).stdout) for dim in ("2", "3")]
    count = 0
    for page in pages(source):
        for line, _, text in blocks(page, ("c++",)):
            chunks = [rows_of(part) for part in text.replace("// ...\n", "\0").split("\0")]
            if not any(stand_in(rows, chunks) for rows in texts):
                sys.exit(f"{page}:{line}: gen emits no such lines:\n{text}")
            count += 1
    assert count > 0, "no emitted lines found: the pages have lost their blocks"
    print(f"{count} blocks are what gen emits")


def links(source, _=None):
    count, dead, seen, to_visit = 0, [], set(), [source / "docs/index.md"]
    for page in pages(source):
        for line, target in markdown.links(page.read_text(encoding="utf-8")):
            fault = markdown.dead_link(source, page, target)
            dead += [f"{page.relative_to(source)}:{line}: {fault}"] if fault else []
            count += 1
    while to_visit:
        page = to_visit.pop()
        seen.add(page)
        targets = [(page.parent / target.partition("#")[0]).resolve()
                   for _, target in markdown.links(page.read_text(encoding="utf-8")) if not markdown.is_external(target)]
        to_visit += [to for to in targets if to.suffix == ".md" and to.exists() and to not in seen | set(to_visit)]
    dead += [f"no links lead from docs/index.md to {page.relative_to(source)}" for page in pages(source) if page not in seen]
    front = (source / "docs/index.md").read_text(encoding="utf-8")
    include = source / "runtime/include"
    dead += [f"docs/index.md does not name {header}"
             for header in sorted(str(path.relative_to(include)) for path in include.rglob("*.hpp"))
             if f"`{header}`" not in front]
    if dead:
        sys.exit("\n".join(dead))
    assert count > 0, "no links found"
    print(f"{count} links lead somewhere")


NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.]*\w)")


def same_output(shown, said):
    """Whether a program said what is shown. Seconds and the sizes of files may differ, other numbers by rounding; a line
    of three dots stands for any lines."""
    if "..." in shown:
        at = shown.index("...")
        rest = shown[at + 1:]
        return len(said) >= len(shown) - 1 and same_output(shown[:at], said[:at]) and any(
            same_output(rest, said[first:]) for first in range(at, len(said) + 1))
    return len(shown) == len(said) and all(same_line(*lines) for lines in zip(shown, said))


def same_line(shown, said):
    mask = lambda line: re.sub(r"\([\d.]+ [kMG]?B\)", "(SIZE)", re.sub(r"^(  seconds ) *.*", r"\1", line)).rstrip()
    shown, said = mask(shown), mask(said)
    numbers = list(itertools.zip_longest(NUMBER.findall(shown), NUMBER.findall(said)))
    near = lambda a, b: math.isclose(float(a), float(b), rel_tol=1e-5, abs_tol=1e-12)
    # Blanks align columns, so they go with the digits.
    words = lambda line: NUMBER.sub("0", line).split()
    return words(shown) == words(said) and all(a is not None and b is not None and near(a, b) for a, b in numbers)


def steps(text):
    """[command, lines below it] of each command of a block; lines that a command goes on in end with a backslash."""
    found = []
    for line in text.splitlines():
        if line.startswith("$ "):
            found.append([line[2:], []])
        elif found and found[-1][0].endswith("\\") and not found[-1][1]:
            found[-1][0] += "\n" + line
        else:
            assert found, f"output without a command: {line}"
            found[-1][1].append(line)
    return found


def transcripts(source, programs, update=None):
    count = 0
    for page in (source / name for name in TRANSCRIPTS):
        text = page.read_text(encoding="utf-8")
        with Shell(source, programs) as shell:
            for line, _, block in blocks(page, {"console"}):
                for command, shown in steps(block):
                    status, output = shell.run(command)
                    said = output.rstrip("\n").splitlines()
                    if status != 0:
                        sys.exit(f"{page}:{line}: exit status {status}\n$ {command}\n{output}")
                    if update and "..." not in shown:
                        before = "\n".join([f"$ {command}", *shown]) + "\n"
                        assert text.count(before) == 1, f"{page}:{line}: not there once: {before}"
                        text = text.replace(before, "\n".join([f"$ {command}", *said]) + "\n")
                    elif not same_output(shown, said):
                        sys.exit(f"{page}:{line}: says something else (docs_test.py transcripts … --update takes it over)\n"
                                 f"$ {command}\n{output}\nand not\n" + "\n".join(shown))
                    count += 1
            require_clean(page, shell)
        if update:
            page.write_text(text, encoding="utf-8")
    assert count > 0, "no transcripts found: the pages have lost their blocks"
    print(f"{count} commands say what the pages show")


def html(source, folder):
    sys.exit(subprocess.run([sys.executable, "-B", source / "docs/site/build.py", folder], check=False).returncode)


def checkers(source):
    """Pages with faults, each of which has to be found."""
    import build  # in docs/site
    import python_reference
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name).resolve()
        (root / "other.md").write_text("# Other\n\n## A *heading*: with `code`\n\n## Twice\n\n## Twice\n", encoding="utf-8")
        page = root / "page.md"
        page.write_text("# Page\n\n`[no](link.md)` [a\nb](gone.md) ![p](gone.png) [`c`](other.md#gone) <img src=\"gone.svg\">\n"
                        "```sh\n[no](link.md)\n```\n"
                        "[x](other.md#a-heading-with-code) [y](other.md#twice-1) [z](#page) [w](https://example.org)\n",
                        encoding="utf-8")
        found = [markdown.dead_link(root, page, target) for _, target in markdown.links(page.read_text(encoding="utf-8"))]
        assert [fault.split(":")[0] for fault in found if fault] == ["gone.md", "gone.png", "other.md#gone", "gone.svg"], found
        assert len(found) == 8, found
        (root / "a.html").write_text('<a href="b.html#there">1</a><a href="b.html#gone">2</a><img src="c.png"/>'
                                     '<a href="repo:x">3</a><a href="https://example.org">4</a>', encoding="utf-8")
        (root / "b.html").write_text('<h1 id="there">b</h1>', encoding="utf-8")
        dead, count = build.dead_links(root)
        assert count == 4 and [text.split(": ", 1)[1] for text in dead] == [
            "b.html#gone: no such anchor", "c.png: no such file", "repo:x: no such file"], dead
        package = root / "package"
        package.mkdir()
        (package / "__init__.py").write_text('"""P."""\nfrom ._m import A, f\n__all__ = ["A", "f"]\n', encoding="utf-8")
        (package / "_m.py").write_text('class A:\n    """A."""\n    def told(self):\n        """T."""\n    def untold(self): ...\n'
                                       'def f(a, *, b=1) -> int:\n    """F.\n\n    a\n        The `a`.\n    """\n', encoding="utf-8")
        shown, missing = python_reference.reference(package)
        assert missing == ["A.untold"] and "f(a, *, b=1) → int" in shown and "<dd>The <code>a</code>.</dd>" in shown, shown
    said = ["Contour", "  size         17 680 vertices", "  seconds      0.4 = read 0.1", "  output       a.glb (1.5 kB)"]
    assert same_output(["Contour", "...", "  output       a.glb (1.4 kB)"], said)
    assert same_output([said[0], said[1], "  seconds      9", said[3]], said)
    assert not same_output(["Contour", "...", "  output       b.glb (1.5 kB)"], said)
    assert not same_output([said[0], "  size         17 681 vertices", *said[2:]], said)
    assert not same_output(said[:3], said) and not same_output([*said, "more"], said)
    with Shell(source, "/usr/bin") as shell:
        assert shell.run("mkdir -p try && cd try\ntouch film_1.glb") == (0, "") and shell.left_behind() == ""
        assert shell.run("basename \"$PWD\"") == (0, "try\n"), "each command runs where the last one went"
        assert shell.run("touch ../stray") == (0, "") and shell.left_behind() == "?? stray\n"
        assert shell.run("false | true")[0] == 1
    assert same_line("area 1771.30 mm", "area 1771.3001 mm") and not same_line("area 1771.3 mm", "area 1771.4 mm")
    print("all faults were found")


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
            if not runs_here(text, programs):
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
