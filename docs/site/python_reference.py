# SPDX-License-Identifier: BSD-3-Clause
"""The reference of the Python package, from its sources alone: nothing is imported, so nothing need be built.

What `__all__` names is public, and what of it has no docstring is an error, as in the headers.
"""

import ast
import html
import inspect
import pathlib
import re
import textwrap


def public_names(package: pathlib.Path) -> list[tuple[str, ast.AST]]:
    """(name, definition) of what the package's `__all__` names and its own modules define; the rest is the extension's."""
    top = ast.parse((package / "__init__.py").read_text(encoding="utf-8"))
    listed, module_of = [], {}
    for node in top.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
            listed = ast.literal_eval(node.value)
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            module_of.update({alias.asname or alias.name: (node.module, alias.name) for alias in node.names})
    assert listed, f"{package}/__init__.py has lost its __all__"
    found, trees = [], {}
    for name in listed:
        module, own_name = module_of.get(name, ("", ""))
        file = package / f"{module}.py"
        if file.is_file():
            tree = trees.setdefault(module, ast.parse(file.read_text(encoding="utf-8")))
            found += [(name, node) for node in tree.body
                      if getattr(node, "name", None) == own_name and not is_overload(node)]
    return found


def is_overload(node: ast.AST) -> bool:
    """Whether a definition is an overload, which only type checkers read."""
    return any(ast.unparse(decorator).endswith("overload") for decorator in getattr(node, "decorator_list", []))


def signature(name: str, node: ast.FunctionDef) -> str:
    arguments = ast.unparse(node.args)
    arguments = re.sub(r"^(self|cls)(, )?", "", arguments)
    returns = f" → {ast.unparse(node.returns)}" if node.returns else ""
    return f"{name}({arguments}){returns}"


def marked(text: str) -> str:
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))


def is_example(block: str) -> bool:
    return all(not line or line.startswith("    ") for line in block.split("\n"))


def paragraphs(docstring: str) -> str:
    """A docstring as HTML: paragraphs, `name` with what is indented below it as a definition, examples as they are."""
    blocks: list[str] = []
    for block in re.split(r"\n\s*\n(?=.)", inspect.cleandoc(docstring)):
        if blocks and is_example(block) and is_example(blocks[-1]):
            blocks[-1] += f"\n\n{block}"
        else:
            blocks.append(block)
    return "\n".join(map(of_block, blocks))


def of_block(block: str) -> str:
    lines = block.split("\n")
    if is_example(block):
        return f"<pre class='fragment'>{html.escape(textwrap.dedent(block))}</pre>"
    if lines[0].startswith(" ") or not any(line.startswith("    ") for line in lines):
        return f"<p>{marked(' '.join(lines))}</p>"
    parts: list[str] = []
    text: list[str] = []
    for line in [*lines, ""]:
        if line.startswith("    "):
            text.append(line.strip())
        else:
            parts += [f"<dd>{marked(' '.join(text))}</dd>"] if text else []
            parts += [f"<dt><code>{html.escape(line)}</code></dt>"] if line else []
            text = []
    return f"<dl>{''.join(parts)}</dl>"


class Reference:
    """The page as it grows, its list of names, and what lacks a description."""

    def __init__(self) -> None:
        self.text, self.contents, self.missing = [], [], []

    def add(self, level: int, name: str, shown: str, node: ast.AST) -> None:
        docstring = ast.get_docstring(node, clean=False)
        if not docstring:
            self.missing.append(name)
        anchor = name.replace(".", "-")
        self.text.append(f"<h{level} id='{anchor}'>{html.escape(name)}</h{level}>"
                         f"<pre class='fragment signature'>{html.escape(shown)}</pre>{paragraphs(docstring or '')}")
        if level == 2:
            self.contents.append(f"<li><a href='#{anchor}'>{html.escape(name)}</a></li>")

    def add_class(self, name: str, node: ast.ClassDef) -> None:
        made = next((member for member in node.body if getattr(member, "name", "") == "__init__"), None)
        shown = signature(name, made).partition(" → ")[0] if made else name
        self.add(2, name, name if "_tegl." in shown else shown, node)  # what only the package itself makes
        fields = [member for member in node.body if isinstance(member, ast.AnnAssign) and not member.target.id.startswith("_")]
        if fields:
            shown = "\n".join(ast.unparse(member) for member in fields)
            self.text.append(f"<pre class='fragment'>{html.escape(shown)}</pre>")
        for member in node.body:
            if isinstance(member, ast.FunctionDef) and not member.name.startswith("_") and not is_overload(member):
                is_property = any(ast.unparse(decorator).endswith("property") for decorator in member.decorator_list)
                full = f"{name}.{member.name}"
                returns = f": {ast.unparse(member.returns)}" if member.returns else ""
                self.add(3, full, f"{full}{returns}" if is_property else signature(full, member), member)


def reference(package: pathlib.Path) -> tuple[str, list[str]]:
    """(the page's HTML, names without a description)."""
    page = Reference()
    introduction = ast.get_docstring(ast.parse((package / "__init__.py").read_text(encoding="utf-8")), clean=False) or ""
    names = public_names(package)
    for name, node in sorted(names, key=lambda pair: isinstance(pair[1], ast.ClassDef)):  # functions first
        if isinstance(node, ast.ClassDef):
            page.add_class(name, node)
        else:
            page.add(2, name, signature(name, node), node)
    return (f"<div class='toc'><ul>{''.join(page.contents)}</ul></div>{paragraphs(introduction)}{''.join(page.text)}",
            page.missing)
