# SPDX-License-Identifier: BSD-3-Clause
"""The stub of the compiled module has its names and its arguments, and no others; the rest of the package has hints."""

import ast
import inspect
import os
import pathlib
import re
import typing

import numpy as np
import pytest
import tegl
from tegl import _kinds, _tegl

STUB = ast.parse((pathlib.Path(tegl.__file__).parent / "_tegl.pyi").read_text(encoding="utf-8"))


def stub_names(body):
    """name -> list of argument names of a function, None of an attribute or property, dict of a class."""
    names = {}
    for node in body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = stub_names(node.body)
        elif isinstance(node, ast.FunctionDef):
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
            names[node.name] = None if is_property else [argument.arg for argument in node.args.args]
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = None
    return names


def arguments_of(function):
    """Argument names as pybind11 writes them into the docstring."""
    written = re.match(r"\w+\((.*?)\) ->", function.__doc__, re.DOTALL)
    if written is None:  # object's own __init__, of classes that functions alone make
        return None
    signature = written.group(1)
    return re.findall(r"(?:^|, )(\w+): ", signature)


def module_names(of):
    names = {}
    for name, value in vars(of).items():
        if (name.startswith("_") and name not in ("__init__", "__version__")) or name.startswith("pybind11"):
            continue
        value = value.__func__ if isinstance(value, staticmethod) else value
        if inspect.isclass(value):
            names[name] = {} if issubclass(value, Exception) else module_names(value)
        elif isinstance(value, property):
            names[name] = None
        elif callable(value):
            names[name] = arguments_of(value)
        else:
            names[name] = None
    return names


def test_the_stub_says_what_the_module_has():
    stub, module = stub_names(STUB.body), module_names(_tegl)
    for members in module.values():
        if isinstance(members, dict) and members.get("__init__", ()) is None:
            del members["__init__"]
    assert stub == module


@pytest.mark.parametrize("name", tegl.__all__)
def test_the_package_has_type_hints(name):
    thing = getattr(tegl, name)
    functions = [thing] if inspect.isfunction(thing) else [
        member for key, member in vars(thing).items() if inspect.isfunction(member) and not key.startswith("_")
    ] if inspect.isclass(thing) else []
    for function in functions:
        hints = typing.get_type_hints(function, {**vars(tegl), **function.__globals__})
        assert "return" in hints, function


def refused(call):
    with pytest.raises(ValueError) as raised:
        call()
    return re.findall(r"'([\w-]+)'", str(raised.value).partition("expected one of ")[2])


def test_the_names_of_options_are_the_librarys():
    volume = np.random.default_rng(1).normal(size=(5, 6, 7))
    contour = tegl.contour(volume, 0.0)
    calls = {"Triangulation": lambda: tegl.contour(volume, 0.0, triangulation="?"),
             "Ambiguity": lambda: tegl.contour(volume, 0.0, ambiguity="?"),
             "Lattice": lambda: tegl.sample("ball", 8, lattice="?"),
             "PolygonTriangulation": lambda: tegl.contour_facets(volume, 0.0).triangulate("?"),
             "Division": lambda: tegl.contour(volume, 0.0, division="?"),
             "Direction": lambda: tegl.contour(volume, 0.0, direction="?"),
             "FilterBorder": lambda: tegl.filter(volume, median=1, border="?"),
             "Samples": lambda: tegl.contour(volume, 0.0, samples="?"),
             "Positions": lambda: tegl.contour(volume, 0.0, positions="?"),
             "Gradient": lambda: tegl.contour(volume, 0.0, gradient="?"),
             "SimplifyMethod": lambda: contour.simplify(0.5, method="?"),
             "SimplifyBorder": lambda: contour.simplify(0.5, border="?"), "IndexMethod": lambda: tegl.Index(volume, "?"),
             "SeriesOrder": lambda: tegl.read(["a.nrrd", "b.nrrd"], sort="?"),
             "ElementAxes": lambda: contour.elements().save("a.dat", axes="?"),
             "ElementComponents": lambda: contour.elements().save("a.dat", components="?")}
    for name, call in calls.items():
        assert sorted(refused(call)) == sorted(typing.get_args(getattr(_kinds, name))), name
    lattices = refused(lambda: tegl.contour(volume, 0.0, lattice="?"))
    assert sorted(lattices) == sorted(["cubic", *typing.get_args(_kinds.Lattice)])
    for kind in typing.get_args(_kinds.Normals):
        tegl.contour(volume, 0.0, normals=kind)
    headers = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]) / "runtime/include/tegl"
    for name, header, enumeration in (("EventKind", "track.hpp", "TrackEventKind"), ("SimplifyEnd", "simplify.hpp", "SimplifyEnd"),
                                      ("AxisDirection", "io/images.hpp", "AxisDirection")):
        text = (headers / header).read_text(encoding="utf-8")
        values = re.search(r"enum class %s[^{]*\{(.*?)\};" % enumeration, text, re.DOTALL).group(1)
        values = re.sub(r"///.*", "", values)
        assert sorted(re.findall(r"\w+", values)) == sorted(typing.get_args(getattr(_kinds, name))), name
    tested = {"Normals", "EventKind", "SimplifyEnd", "AxisDirection", *calls}
    assert {name for name in vars(_kinds) if name[0].isupper()} == tested


def test_the_package_is_marked_as_typed():
    assert (pathlib.Path(tegl.__file__).parent / "py.typed").exists()
