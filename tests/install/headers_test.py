#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compiles the public headers as users do, without making anything of them: each header by itself, with -Wall -Wextra
-Wpedantic and no warning, and without Eigen except for tegl/eigen.hpp; the static tests of the API with these warnings;
and programs with a dimension or a type that there is not, whose first error has to name the constraint.

    headers_test.py SOURCE EIGEN COMPILER...     the first compiler takes each header, others all headers at once
"""
import concurrent.futures
import pathlib
import re
import subprocess
import sys

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]

# Clang 14 substitutes the types of parameters before it tests the constraint, and then names the type.
CUT = "DimensionBetween<\\w+, 3, 5>|constraints not satisfied for class template '(Hyperplane|Contour)' \\[with N = [16]"
# (program, what the compiler has to say, as a regular expression): the constraint, with the dimensions that there are.
REFUSED = [
    ("#include \"tegl/image.hpp\"\nconst tegl::Image<float, 1>* image;\n", "DimensionBetween<\\w+, 2, 5>"),
    ("#include \"tegl/image.hpp\"\nconst tegl::Image<float, 6>* image;\n", "DimensionBetween<\\w+, 2, 5>"),
    ("#include \"tegl/image.hpp\"\nconst tegl::Image<long double, 3>* image;\n", "\\bValue\\b"),
    ("#include \"tegl/slice.hpp\"\nauto f(const tegl::Contour<2>& c) { return tegl::slice(c, {}); }\n", CUT),
]


def compile_text(compiler, text, include, extra):
    """The status and the messages of a compiler for a source that is not kept."""
    command = [compiler, "-std=c++20", "-fsyntax-only", *extra, *include, "-x", "c++", "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def main(source, eigen, compilers):
    source = pathlib.Path(source)
    roots = [source / "runtime/include", source / "tile/include"]
    own = [f"-I{root}" for root in roots]
    include = own + ["-isystem", eigen]
    headers = sorted(str(header.relative_to(root)) for root, below in zip(roots, ["tegl/**/*.hpp", "tegl/tile/*.hpp"])
                     for header in root.glob(below))
    assert len(headers) > 30, f"only {headers} found"
    # Twice, so that a header without a guard is found, too.
    alone = [(f"{header} by {compilers[0]}", compilers[0], f"#include \"{header}\"\n" * 2,
              include if header == "tegl/eigen.hpp" else own) for header in headers]
    together = [(f"all headers by {compiler}", compiler, "".join(f"#include \"{header}\"\n" for header in headers),
                 include) for compiler in compilers[1:]]
    api = (source / "tests/runtime/base/api_test.cpp").read_text(encoding="utf-8")
    sound = alone + together + [(f"api_test.cpp by {compiler}", compiler, api, [*include, "-Wno-unused-result"]) for compiler in compilers]
    refused = [(text, words, compiler) for text, words in REFUSED for compiler in compilers]
    faults = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        sound_results = pool.map(lambda job: compile_text(job[1], job[2], job[3], WARNINGS), sound)
        refused_results = pool.map(lambda job: compile_text(job[2], job[0], include, []), refused)
        for (name, *_), (status, messages) in zip(sound, sound_results):
            if status != 0:
                faults.append(f"{name}:\n{messages[:3000]}")
        for (text, words, compiler), (status, messages) in zip(refused, refused_results):
            # The error and the notes that belong to it.
            first = messages.split("error:", 2)[1] if "error:" in messages else ""
            if status == 0 or not re.search(words, first):
                faults.append(f"{compiler}, status {status}: the first error does not name {words}:\n{text}{messages[:3000]}")
    if faults:
        sys.exit("\n".join(faults))
    print(f"{len(sound)} sources compile without a warning, {len(refused)} are refused by name")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], [compiler for compiler in sys.argv[3:] if compiler])
