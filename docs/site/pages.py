# SPDX-License-Identifier: BSD-3-Clause
"""The Markdown pages of the documentation: which there are, their headings and anchors, what they link to.

What scripts/docs (docs/site/build.py, docs/site/doxygen_filter.py) and tests/docs/docs_test.py know of Markdown is here.
Anchors are GitHub's, so that pages read the same there and in the HTML that scripts/docs makes.
"""

import pathlib
import re

FENCE = re.compile(r"^\s*```(.*)$")
HEADING = re.compile(r"^(#{1,6}) +(.*?) *$")
CODE = re.compile(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.S)
# [text](target): the text may hold code and one level of brackets, as ![picture](...) in a link does.
LINK = re.compile(r"(!?)\[((?:[^\[\]`]|`[^`]*`|\[[^\]]*\])*)\]\(([^()\s]*(?:\([^()\s]*\)[^()\s]*)*)\)")
TAG = re.compile(r"<(?:a|img)\b[^>]*?\b(?:href|src)=\"([^\"]*)\"")


def all_pages(source: pathlib.Path) -> list[pathlib.Path]:
    """Every page, the README first."""
    return [source / "README.md", source / "CONTRIBUTING.md", source / "CHANGELOG.md",
            source / "examples/README.md", source / "examples/data/README.md", source / "bench/README.md",
            source / "bench/results/README.md",
            *sorted((source / "docs").rglob("*.md"))]


def page_id(source: pathlib.Path, page: pathlib.Path) -> str:
    """The name of a page's HTML file, without its extension: docs/cases/3d.md is cases-3d."""
    path = page.relative_to(source).as_posix().removesuffix(".md").removeprefix("docs/")
    return path.removesuffix("/README").replace("/", "-").lower()


def lines_of(text: str):
    """(line, whether it belongs to a fenced block, its fence included) for each line."""
    inside = False
    for line in text.splitlines():
        fence = FENCE.match(line)
        yield line, inside or fence is not None
        if fence:
            inside = not inside


def paragraphs(text: str):
    """(number of the first line, text, whether it is code) of each run of lines without a blank one between them, as
    code and links may go on from one line to the next. Blank lines are paragraphs of their own; headings too."""
    first, kept = 1, []
    for number, (line, is_code) in enumerate(lines_of(text), 1):
        alone = is_code or not line.strip() or HEADING.match(line)
        if alone or not kept:
            if kept:
                yield first, "\n".join(kept), False
            first, kept = number, []
        if alone:
            yield number, line, is_code
        else:
            kept.append(line)
    if kept:
        yield first, "\n".join(kept), False


def slug(title: str) -> str:
    """GitHub's anchor of a heading: its words in lower case, joined by hyphens."""
    shown = LINK.sub(lambda found: found[2], title).replace("`", "").replace("*", "")
    return re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")


def headings(text: str) -> list[tuple[int, str, str]]:
    """(level, title, anchor) of each heading, in order; of equal anchors the later ones are numbered."""
    found, seen = [], {}
    for line, is_code in lines_of(text):
        heading = None if is_code else HEADING.match(line)
        if heading:
            anchor = slug(heading[2])
            count = seen.get(anchor, 0)
            seen[anchor] = count + 1
            found.append((len(heading[1]), heading[2], f"{anchor}-{count}" if count else anchor))
    return found


def anchors(text: str) -> set[str]:
    return {anchor for _, _, anchor in headings(text)}


def links(text: str) -> list[tuple[int, str]]:
    """(line number, target) of each link and picture, in Markdown or in HTML."""
    found = []
    for first, paragraph, is_code in paragraphs(text):
        if is_code:
            continue
        shown = CODE.sub(lambda code: re.sub(r"[^\n]", "x", code[0]), paragraph)  # links in code are none
        for link in LINK.finditer(shown):
            found += [(first + shown.count("\n", 0, link.start()), inner[3])
                      for inner in (link, *LINK.finditer(link[2]))]
        found += [(first + shown.count("\n", 0, tag.start()), tag[1]) for tag in TAG.finditer(shown)]
    return found


def is_external(target: str) -> bool:
    return re.match(r"[a-z][a-z0-9+.-]*:", target) is not None


def dead_link(source: pathlib.Path, page: pathlib.Path, target: str) -> str | None:
    """What is wrong with a link of a page, or None. Links to other sites are not checked."""
    if is_external(target):
        return None
    path, _, anchor = target.partition("#")
    to = (page.parent / path).resolve() if path else page
    if not to.exists():
        return f"{target}: there is no {path}"
    if not to.is_relative_to(source):
        return f"{target}: leads out of the project"
    if anchor and to.suffix != ".md":
        return f"{target}: {path} is no page, so it has no anchors"
    if anchor and anchor not in anchors(to.read_text(encoding="utf-8")):
        return f"{target}: no heading of {to.relative_to(source)} has the anchor {anchor}"
    return None
