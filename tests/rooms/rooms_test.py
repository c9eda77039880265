#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The rooms of the sources: folders with a README that lists the other rooms that they may include ('May use: a, b.').

Fails if a file includes a room that its own room's README does not allow, or if the README allows a room that no file
includes; on circles of rooms, and of files (a header and its source count as one); on a source outside of rooms; on a
room of more than 40 headers and sources. Fails on a header over 400 or a source over 700 lines, also in the folders
OTHERS. Also checks which public and private headers each library includes, and finds circles of public headers and of
Python modules.

    rooms_test.py SOURCE_FOLDER
"""

import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop(1)) if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]) else Path(__file__).parents[2]

# Folders of rooms; for each, the folders outside that it may include from, besides public headers `tegl/...`.
ROOTS = {
    "runtime/src": [],
    "runtime/io": ["runtime/src/base"],
    "apps/cli": [],
    "generator/src": [],
}
# Folders without rooms whose files have limits of lines, too.
OTHERS = ["tile", "runtime/include", "python/src"]
# By library or program: the folders whose public headers it may include.
PUBLIC = {
    "tile/include": ["tile/include"],
    "tile/src": ["tile/include"],
    "generator/src": ["tile/include"],
    "runtime/src": ["tile/include", "runtime/include", "generated/include"],
    "runtime/io": ["tile/include", "runtime/include"],
    "apps/cli": ["tile/include", "runtime/include"],
}
# Private headers of `runtime/io` that others may include, by these names from `runtime`. They are not installed.
SHARED = {
    "apps/cli": [
        "io/base/pending_path.hpp",
        "io/base/simplex_names.hpp",
        "io/base/text.hpp",
        "io/images/series_request.hpp",
        "io/meshes/contour_file.hpp",
        "io/meshes/facets.hpp",
        "io/meshes/meshes.hpp",
        "io/reports/tracks.hpp",
    ],
    "python/src": ["io/images/series_request.hpp"],
}
MOST_LINES = {".hpp": 400, ".cpp": 700}
MOST_FILES = 40  # headers and sources of a room
INCLUDE = re.compile(r'^\s*#\s*include\s+["<]([^">]+)[">]', re.MULTILINE)
DOOR = re.compile(r"^May use: (.+)\.$", re.MULTILINE)


def sources_below(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in MOST_LINES)


def stem(name):
    return str(Path(name).with_suffix(""))


def circles(arrows):
    """The strongly connected parts of a graph (Tarjan, without recursion) that are more than one node."""
    index, low, stack, result = {}, {}, [], []
    on_stack = set()
    for root in sorted(arrows):
        if root in index:
            continue
        work = [(root, iter(sorted(arrows[root])))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, rest = work[-1]
            after = next(rest, None)
            if after is None:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    part = []
                    while not part or part[-1] != node:
                        part.append(stack.pop())
                        on_stack.discard(part[-1])
                    if len(part) > 1:
                        result.append(sorted(part))
            elif after not in index:
                index[after] = low[after] = len(index)
                stack.append(after)
                on_stack.add(after)
                work.append((after, iter(sorted(arrows.get(after, ())))))
            elif after in on_stack:
                low[node] = min(low[node], index[after])
    return result


def includes_within(root, file):
    """The files below `root` that `file` includes, as paths from `root`; and those in other folders, with their names."""
    root = root.resolve()
    inside, outside = [], []
    for name in INCLUDE.findall(file.read_text()):
        found = next((at.resolve() for at in (file.parent / name, root / name) if at.is_file()), None)
        if found is None or name.startswith("tegl/"):
            continue
        if found.is_relative_to(root):
            inside.append(str(found.relative_to(root)))
        else:
            outside.append((name, found))
    return inside, outside


def doors_of(root):
    """The rooms and files that each room's README allows it to include, its *door*; and the faults of these lists."""
    doors, faults = {}, []
    for room in sorted(path for path in root.iterdir() if path.is_dir() and sources_below(path)):
        readme = room / "README.md"
        found = DOOR.findall(readme.read_text()) if readme.is_file() else []
        if len(found) != 1:
            faults.append(f"{room.name}: expected a README.md with one line 'May use: a, b.' or 'May use: nothing.'")
        words = [word.strip() for word in found[0].split(",")] if len(found) == 1 else []
        doors[room.name] = [] if words == ["nothing"] else words
        files = len(sources_below(room))
        if files > MOST_FILES:
            faults.append(f"{room.name}: {files} files; expected at most {MOST_FILES}")
    for room, words in doors.items():
        faults += [f"{room}: may use '{word}', which is not there" for word in words if not (root / word).exists()]
    return doors, faults


def faults_of_lengths(folder):
    """Files below `folder` with too many lines."""
    faults = []
    for file in sources_below(folder):
        lines = file.read_text().count("\n")
        if lines > MOST_LINES[file.suffix]:
            faults.append(f"{file.relative_to(folder)}: {lines} lines; expected at most {MOST_LINES[file.suffix]}")
    return faults


def faults_of_rooms(root, elsewhere=()):
    """Faults of the rooms below `root`. `elsewhere`: folders outside that they may include from."""
    doors, faults = doors_of(root)
    faults += faults_of_lengths(root)
    arrows, rooms = {}, {room: set() for room in doors}
    unused = {room: {word for word in words if (root / word).exists()} for room, words in doors.items()}
    for file in sources_below(root):
        name = str(file.relative_to(root))
        room = name.split("/")[0]
        if room not in doors:
            faults.append(f"{name}: in no room")
            continue
        inside, outside = includes_within(root, file)
        for used in inside:
            if stem(used) != stem(name):
                arrows.setdefault(stem(name), set()).add(stem(used))
            other = used.split("/")[0]
            if other != room:
                rooms[room].add(other)
                unused[room] -= {other, used}
                if other not in doors[room] and used not in doors[room]:
                    faults.append(f"{name} includes {used}; '{room}' may use {', '.join(doors[room]) or 'nothing'}")
        for used, at in outside:
            if not any(at.is_relative_to(folder.resolve()) for folder in elsewhere):
                faults.append(f"{name} includes {used}, outside of its rooms")
    faults += [f"{room}: may use '{word}', which no file of it includes"
               for room, words in unused.items() for word in sorted(words)]
    faults += ["a circle of files: " + ", ".join(part) for part in circles(arrows)]
    faults += ["a circle of rooms: " + ", ".join(part) for part in circles(rooms)]
    return faults


def faults_of_public_headers(source, user, folders):
    """Includes of `tegl/...` from other libraries than `user` may use."""
    faults = []
    for file in sources_below(source / user):
        for name in INCLUDE.findall(file.read_text()):
            if name.startswith("tegl/") and not any((source / folder / name).is_file() for folder in folders):
                faults.append(f"{file.relative_to(source)} includes {name}; expected headers of {', '.join(folders)}")
    return faults


def faults_of_shared_headers(source, user, allowed):
    """Includes of private headers that the user may not know, and shared ones that are gone or need other private ones."""
    faults = [f"{name}: shared with {user}, and not there" for name in allowed
              if not (source / "runtime" / name).is_file()]
    for name in allowed:
        used = [other for other in INCLUDE.findall((source / "runtime" / name).read_text())
                if (source / "runtime/io" / other).is_file()]
        faults += [f"{name} is shared and includes {other}; expected public headers" for other in used]
    for file in sources_below(source / user):
        used = [name for name in INCLUDE.findall(file.read_text()) if (source / "runtime" / name).is_file()]
        faults += [f"{file.relative_to(source)} includes {name}, which is private" for name in used
                   if name not in allowed]
    return faults


def faults_of_headers(folder):
    """Circles of public headers."""
    arrows = {}
    for file in sources_below(folder):
        name = str(file.relative_to(folder))
        arrows[name] = {used for used in INCLUDE.findall(file.read_text()) if (folder / used).is_file()}
    return ["a circle of headers: " + ", ".join(part) for part in circles(arrows)]


def faults_of_python(package):
    """Circles of modules of a Python package, imports inside of functions too."""
    arrows = {}
    for file in sorted(package.glob("*.py")):
        text = file.read_text()
        names = re.findall(r"^\s*from \.(\w+) import", text, re.MULTILINE)
        for group in re.findall(r"^\s*from \. import \(?([\w,\s]+?)\)?$", text, re.MULTILINE):
            names += re.findall(r"\w+", group)
        arrows[file.stem] = {name for name in names if (package / f"{name}.py").is_file()}
    return ["a circle of modules: " + ", ".join(part) for part in circles(arrows)]


class Rooms(unittest.TestCase):
    def test_every_arrow_is_allowed(self):
        for root, elsewhere in ROOTS.items():
            with self.subTest(root):
                faults = faults_of_rooms(SOURCE / root, [SOURCE / folder for folder in elsewhere])
                self.assertEqual([], faults, "\n".join(faults))

    def test_files_outside_of_rooms_are_short(self):
        for folder in OTHERS:
            with self.subTest(folder):
                self.assertTrue(sources_below(SOURCE / folder))
                self.assertEqual([], faults_of_lengths(SOURCE / folder))

    def test_libraries_use_those_below_them(self):
        for user, folders in PUBLIC.items():
            with self.subTest(user):
                faults = faults_of_public_headers(SOURCE, user, folders)
                self.assertEqual([], faults, "\n".join(faults))

    def test_private_headers_are_shared_by_name(self):
        for user, allowed in SHARED.items():
            with self.subTest(user):
                faults = faults_of_shared_headers(SOURCE, user, allowed)
                self.assertEqual([], faults, "\n".join(faults))

    def test_public_headers_include_public_ones(self):
        for file in sources_below(SOURCE / "runtime/include"):
            for name in re.findall(r'#include "([^"]+)"', file.read_text()):
                self.assertTrue(name.startswith("tegl/"), f"{file} includes {name}")

    def test_public_headers_have_no_circle(self):
        for folder in ("runtime/include", "tile/include"):
            self.assertTrue(sources_below(SOURCE / folder))
            self.assertEqual([], faults_of_headers(SOURCE / folder))

    def test_python_modules_have_no_circle(self):
        self.assertEqual([], faults_of_python(SOURCE / "python/tegl"))


class Faults(unittest.TestCase):
    """The checks themselves, on small trees with one fault each."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("low/README.md", "# low\nMay use: nothing.\n")
        self.write("high/README.md", "# high\nMay use: low.\n")
        self.write("low/a.hpp", "")
        self.write("high/b.hpp", '#include "low/a.hpp"\n')
        self.write("high/b.cpp", '#include "high/b.hpp"\n')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def expect(self, *words):
        faults = faults_of_rooms(self.root)
        self.assertEqual(1, len(faults), faults)
        for word in words:
            self.assertIn(word, faults[0])

    def test_none(self):
        self.assertEqual([], faults_of_rooms(self.root))

    def test_arrow_upwards(self):
        self.write("low/c.cpp", '#include "high/b.hpp"\n')
        faults = faults_of_rooms(self.root)
        self.assertEqual(2, len(faults), faults)
        self.assertIn("low/c.cpp includes high/b.hpp; 'low' may use nothing", faults[0])
        self.assertIn("a circle of rooms: high, low", faults[1])

    def test_one_file_of_a_room(self):
        self.write("side/README.md", "# side\nMay use: high/b.hpp.\n")
        self.write("side/c.cpp", '#include "high/b.hpp"\n')
        self.assertEqual([], faults_of_rooms(self.root))
        self.write("high/d.hpp", "")
        self.write("side/c.cpp", '#include "high/b.hpp"\n#include "high/d.hpp"\n')
        self.expect("side/c.cpp includes high/d.hpp", "may use high/b.hpp")

    def test_circle_of_stems(self):
        # Neither header includes the other's, but the sources do.
        self.write("low/a.cpp", '#include "low/a.hpp"\n#include "low/c.hpp"\n')
        self.write("low/c.hpp", "")
        self.write("low/c.cpp", '#include "low/c.hpp"\n#include "a.hpp"\n')
        self.expect("a circle of files: low/a, low/c")

    def test_no_door(self):
        (self.root / "low/README.md").unlink()
        self.expect("low: expected a README.md")

    def test_door_to_nowhere(self):
        self.write("high/README.md", "# high\nMay use: low, attic.\n")
        self.expect("high: may use 'attic', which is not there")

    def test_door_that_no_file_uses(self):
        self.write("side/README.md", "# side\nMay use: high/b.hpp, low.\n")
        self.write("side/c.cpp", '#include "low/a.hpp"\n')
        self.expect("side: may use 'high/b.hpp', which no file of it includes")
        self.write("side/c.cpp", '#include "high/b.hpp"\n')
        self.expect("side: may use 'low', which no file of it includes")

    def test_outside_of_the_rooms(self):
        self.write("c.cpp", "")
        self.expect("c.cpp: in no room")

    def test_too_long(self):
        self.write("low/a.hpp", "\n" * 401)
        self.expect("low/a.hpp: 401 lines; expected at most 400")

    def test_too_many_files(self):
        for number in range(MOST_FILES):
            self.write(f"low/c{number}.hpp", "")
        self.expect("low: 41 files; expected at most 40")

    def test_circle_of_modules(self):
        self.write("p/a.py", "def f():\n    from .b import g\n")
        self.write("p/b.py", "from . import a\n")
        self.assertEqual(["a circle of modules: a, b"], faults_of_python(self.root / "p"))

    def test_circle_of_headers(self):
        self.write("i/tegl/a.hpp", '#include "tegl/b.hpp"\n')
        self.write("i/tegl/b.hpp", "#include <tegl/a.hpp>\n")
        self.assertEqual(["a circle of headers: tegl/a.hpp, tegl/b.hpp"], faults_of_headers(self.root / "i"))


if __name__ == "__main__":
    unittest.main()
