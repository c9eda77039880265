#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What Doxygen reads instead of a page or a header; called by it, with the file's path, and TEGL_SOURCE set.

Pages: headings get the anchors that they have on GitHub, under a name of the page's own, as Doxygen's are global; links
become HTML, to pages directly and to other files as `repo:PATH`; inline code becomes one word. build.py resolves both.
Headers: the paragraph at the top becomes the file's description. No line moves, so that warnings name the right one.
"""

import html
import os
import pathlib
import re
import sys

import pages


def of_page(source: pathlib.Path, page: pathlib.Path) -> str:
    text = page.read_text(encoding="utf-8")
    own = pages.page_id(source, page)
    anchors = iter(pages.headings(text))
    # A comment before the title would keep Doxygen from seeing it.
    text = re.sub(r"\A(<!--.*-->)?\n", "\n", text)
    if own not in ("index", "changelog") and sum(level == 2 for level, _, _ in pages.headings(text)) >= 4:
        text = re.sub(r"\A(\n?# .*\n)\n", r"\1[TOC]\n", text)  # of longer pages, in place of the line below the title
    return "\n".join(paragraph if is_code else of_paragraph(source, page, own, anchors, paragraph)
                     for _, paragraph, is_code in pages.paragraphs(text)) + "\n"


def of_paragraph(source, page, own, anchors, text: str) -> str:
    if pages.HEADING.match(text):
        level, title, anchor = next(anchors)
        title = title.replace("`", "")  # Doxygen shows the code marks of a title as they are
        if level == 1:  # Doxygen names the front page itself
            return f"# {title}" if own == "index" else f"# {title} {{#{own}}}"
        return f"{'#' * level} {title} {{#{own}--{anchor}}}"
    text = pages.CODE.sub(lambda found: sealed_code(found[2]), text)
    text = pages.TAG.sub(lambda found: found[0].replace(f'"{found[1]}"', f'"{address(source, page, found[1])}"'), text)
    text = pages.LINK.sub(lambda found: of_link(source, page, found), text)
    return re.sub(r'(?<![\w"/(&])#(?=\w)', r"\\#", text.replace("@", "\\@"))  # "#V x N" is no link to a V


def sealed_code(code: str) -> str:
    """Inline code as one word, for build.py to open: Doxygen would take options for dashes, and the like."""
    return f"tgqx{code.encode().hex()}xqgt"


def of_link(source, page, found) -> str:
    picture, text, target = found.groups()
    if pages.LINK.search(text):
        text = pages.LINK.sub(lambda inner: of_link(source, page, inner), text)
    where = address(source, page, target)
    if picture:
        return f'<img src="{where}" alt="{html.escape(text)}"/>'
    return f'<a href="{where}">{text}</a>'


def address(source, page, target: str) -> str:
    if pages.is_external(target):
        return target
    path, _, anchor = target.partition("#")
    to = (page.parent / path).resolve() if path else page
    if to.suffix == ".md" and to in pages.all_pages(source):
        name = pages.page_id(source, to)
        return f"{name}.html#{name}--{anchor}" if anchor else f"{name}.html"
    return f"repo:{to.relative_to(source).as_posix()}"


def of_comment(comment: str) -> str:
    comment = re.sub(r"#(?=\w)", r"\\#", comment)
    return re.sub(r"docs/([\w/-]+)\.md", lambda found: f'<a href="{found[1].replace("/", "-")}.html">{found[0]}</a>', comment)


def of_header(text: str) -> str:
    lines = text.split("\n")
    if lines[0].startswith("// SPDX") and lines[1] == "//":
        lines[0] = "/// @file"
        for number in range(1, len(lines)):
            if not lines[number].startswith("//"):
                break
            lines[number] = "/" + lines[number]
    return re.sub(r"///.*", lambda found: of_comment(found[0]), "\n".join(lines))


if __name__ == "__main__":
    sources, file = pathlib.Path(os.environ["TEGL_SOURCE"]), pathlib.Path(sys.argv[1]).resolve()
    sys.stdout.reconfigure(encoding="utf-8")
    sys.stdout.write(of_page(sources, file) if file.suffix == ".md" else of_header(file.read_text(encoding="utf-8")))
