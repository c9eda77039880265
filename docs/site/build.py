#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Builds the documentation as HTML, and fails where a link is dead or something public has no description.

    docs/site/build.py OUTPUT     OUTPUT is made anew

scripts/docs installs what this needs and runs it. The steps: Doxygen makes HTML of the pages and the headers; files of
the project that pages link to are put beside it, pictures as they are and sources as pages of text; links to them are
resolved; then every link, anchor and picture of the result is checked.
"""

import html
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse
import xml.etree.ElementTree

import pages
import python_reference

SOURCE = pathlib.Path(__file__).resolve().parents[2]
AS_THEY_ARE = {".svg", ".png", ".jpg", ".jpeg", ".webp", ".gif", ".nc"}  # what browsers show, or save, themselves


def version() -> str:
    header = (SOURCE / "runtime/include/tegl/version.hpp").read_text(encoding="utf-8")
    found = [re.search(rf"#define TEGL_VERSION_{part} (\d+)", header) for part in ("MAJOR", "MINOR", "PATCH")]
    assert all(found), "version.hpp has lost the version"
    return ".".join(part[1] for part in found)


def run_doxygen(output: pathlib.Path) -> None:
    environment = {**os.environ, "TEGL_SOURCE": str(SOURCE), "TEGL_HTML": str(output), "TEGL_VERSION": version(),
                   "TEGL_PAGES": " ".join(f'"{page}"' for page in pages.all_pages(SOURCE)), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["doxygen", str(SOURCE / "docs/site/Doxyfile")], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    warnings = [line for line in done.stdout.splitlines() if line.strip()]
    if done.returncode != 0 or warnings:
        sys.exit("\n".join(warnings) + f"\ndoxygen: exit status {done.returncode}, {len(warnings)} lines of warnings")


def headers_by_path(output: pathlib.Path) -> dict[str, str]:
    """The page of each header, by its path in the project, as Doxygen's tag file has it."""
    found = {}
    for compound in xml.etree.ElementTree.parse(output / "tegl.tag").getroot().iter("compound"):
        if compound.get("kind") == "file":
            path = pathlib.Path(f"{compound.findtext('path')}{compound.findtext('name')}")
            if path.suffix == ".hpp":
                name = f"{compound.findtext('filename')}".removesuffix(".html")
                found[path.relative_to(SOURCE).as_posix()] = f"{name}.html"
    assert found, "the tag file has lost its headers"
    return found


def first_sentence(file: pathlib.Path) -> str:
    """What a source says of itself below its licence line."""
    if file.suffix not in {".cpp", ".hpp", ".py"}:
        return ""
    found = re.search(r'\A(?:#!.*\n)?(?://|#) SPDX.*\n(?://\n(?=// )((?:// .*\n)+)|"""(.*))', file.read_text(encoding="utf-8"))
    text = re.sub(r"\n?// ", " ", found[1] or found[2]).strip() if found else ""
    return re.split(r"(?<=[.?])\s", text)[0]


class Repository:
    """The project's files that pages link to: where they are in the HTML, and the pages made of them."""

    def __init__(self, output: pathlib.Path) -> None:
        self.output, self.headers, self.made = output, headers_by_path(output), {}

    def address(self, path: str) -> str:
        if path in self.headers:
            return self.headers[path]
        if path not in self.made:
            self.made[path] = self.make(SOURCE / path, path)
        return urllib.parse.quote(self.made[path])

    def make(self, file: pathlib.Path, path: str) -> str:
        if file.suffix in AS_THEY_ARE:
            where = f"files/{path}"
            (self.output / where).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, self.output / where)
            return where
        where = f"files/{path.rstrip('/')}.html"
        (self.output / where).parent.mkdir(parents=True, exist_ok=True)
        self.made[path] = where  # a folder lists its files, and may be among what these link to
        text = self.listing(file, where) if file.is_dir() else f"<pre class='fragment'>{html.escape(file.read_text(encoding='utf-8'))}</pre>"
        (self.output / where).write_text(self.frame(path, where, text), encoding="utf-8")
        return where

    def listing(self, folder: pathlib.Path, where: str) -> str:
        rows = []
        for file in sorted(folder.iterdir()):
            if file.is_file() and not file.name.startswith("."):
                to = os.path.relpath(self.address(file.relative_to(SOURCE).as_posix()), pathlib.Path(where).parent)
                rows.append(f'<li><a href="{to}">{html.escape(file.name)}</a> {html.escape(first_sentence(file))}</li>')
        return f"<ul>{''.join(rows)}</ul>"

    def frame(self, title: str, where: str, text: str) -> str:
        """A page like Doxygen's, without the search, around the text."""
        up = "../" * where.count("/")
        parts = [(SOURCE / f"docs/site/{name}.html").read_text(encoding="utf-8") for name in ("header", "footer")]
        for key, value in {"$relpath^": up, "$stylesheet": "style.css", "$title": html.escape(title), "$searchbox": "",
                           "$search": "", "$projectname": "tegl", "$projectnumber": version()}.items():
            parts = [part.replace(key, value) for part in parts]
        return f"{parts[0]}</div><div class='contents'><h1>{html.escape(title)}</h1>{text}</div>{parts[1]}"


def open_code(found: re.Match) -> str:
    """What doxygen_filter.sealed_code sealed; \\| is how Markdown writes | in a table's cell."""
    code = bytes.fromhex(found[1]).decode().replace("\\|", "|").strip()
    kind = " class='short'" if len(code) <= 24 else ""  # not broken at the hyphens of an option
    return f"<code{kind}>{html.escape(code, quote=False)}</code>"


def wide(table: re.Match) -> str:
    """A table that scrolls by itself where it is wider than the page; one of many columns takes the page's whole width."""
    columns = table[0].split("</tr>")[0].count("<th")
    return f'<div class="wide{" columns" if columns >= 5 else ""}">{table[0]}</div>'


def resolve(output: pathlib.Path) -> None:
    """repo:PATH becomes where that file is in the HTML, and what stands for inline code becomes code."""
    repository = Repository(output)
    add_python(repository)
    for page in sorted(output.glob("*.html")):
        text = page.read_text(encoding="utf-8")
        changed = re.sub(r'(href|src)="repo:([^"]*)"',
                         lambda found: f'{found[1]}="{repository.address(urllib.parse.unquote(found[2]))}"', text)
        changed = re.sub("tgqx([0-9a-f]*)xqgt", open_code, changed)
        changed = re.sub(r'<div class="summary">.*?</div>', "", changed, flags=re.S)  # links to what may not be there
        changed = re.sub(r'<table class="markdownTable">.*?</table>', wide, changed, flags=re.S)
        if changed != text:
            page.write_text(changed, encoding="utf-8")


def python_page(found: re.Match) -> str:
    return f'<a href="{found[1]}.html">{found[0]}</a>' if (SOURCE / found[0]).exists() else found[0]


def add_python(repository: Repository) -> None:
    text, missing = python_reference.reference(SOURCE / "python/tegl")
    if missing:
        sys.exit("\n".join(f"python/tegl: {name} has no docstring" for name in missing))
    (repository.output / "python-reference.html").write_text(repository.frame("The Python package tegl", "", re.sub(r"docs/([\w-]+)\.md", python_page, text)), encoding="utf-8")


class Links(html.parser.HTMLParser):
    """What a page of HTML links to, and the anchors that it has."""

    def __init__(self, page: pathlib.Path) -> None:
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.anchors.update(value for key, value in attrs if value and (key == "id" or (key == "name" and tag == "a")))
        self.targets += [values[key] for key in ("href", "src", "data") if values.get(key)]

    handle_startendtag = handle_starttag


def dead_links(output: pathlib.Path) -> tuple[list[str], int]:
    """Links, anchors and pictures of the HTML in a folder that lead nowhere, and the number of all."""
    found = {page.resolve(): Links(page) for page in sorted(output.rglob("*.html"))}
    dead, count = [], 0
    for page, links in found.items():
        for target in links.targets:
            if pages.is_external(target) and not target.startswith("repo:"):
                continue
            count += 1
            path, _, anchor = target.partition("#")
            to = (page.parent / urllib.parse.unquote(path)).resolve() if path else page
            where = f"{page.relative_to(output.resolve())}: {target}"
            if not to.exists():
                dead.append(f"{where}: no such file")
            elif anchor and to in found and urllib.parse.unquote(anchor) not in found[to].anchors:
                dead.append(f"{where}: no such anchor")
    return dead, count


def main(output: pathlib.Path) -> None:
    if output.exists() and any(output.iterdir()) and not (output / "tegl.tag").exists():
        sys.exit(f"{output}: has files, and this documentation is not among them: give a folder that may be emptied")
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    run_doxygen(output)
    shutil.copyfile(SOURCE / "docs/site/style.css", output / "search/search.css")  # of what the search finds, too
    resolve(output)
    dead, count = dead_links(output)
    if dead:
        sys.exit("\n".join(dead) + f"\n{len(dead)} of {count} links in {output} lead nowhere")
    made = len(list(output.rglob("*.html")))
    print(f"{made} pages, {count} links in them, all of which lead somewhere: {output}/index.html")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).absolute())
