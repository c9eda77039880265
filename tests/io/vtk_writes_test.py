#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
#
# vtk_writes_test.py TEGL FOLDER: lets VTK write its XML files in all encodings into FOLDER, and compares what the program
# TEGL makes of them with the same data in other files, and with itself.

import itertools
import json
import pathlib
import shutil
import subprocess
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkRectilinearGrid, vtkStructuredGrid, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkCellDataToPointData, vtkContourFilter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import (vtkXMLImageDataWriter, vtkXMLRectilinearGridWriter, vtkXMLStructuredGridWriter,
                                 vtkXMLUnstructuredGridWriter)

TEGL, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
SIZES = (9, 8, 7)
DATA = {"ascii": "SetDataModeToAscii", "binary": "SetDataModeToBinary", "raw": "SetDataModeToAppended",
        "base64": "SetDataModeToAppended"}


def expect(name, actual, expected):
    if actual != expected:
        sys.exit(f"{name}: {actual}; expected {expected}")


def tegl(*words, status=0):
    run = subprocess.run([TEGL, *map(str, words)], capture_output=True, text=True, check=False)
    if run.returncode != status:
        sys.exit(f"tegl {' '.join(map(str, words))}: status {run.returncode}; expected {status}\n{run.stdout}{run.stderr}")
    return run.stdout if status == 0 else run.stderr


def contour(file, iso, *more):
    """The bytes of the contour in a file."""
    out = FOLDER / "contour.ply"
    tegl("contour", file, "--iso", iso, "-o", out, "--quiet", *more)
    return out.read_bytes()


def report(file, iso, *more):
    out = FOLDER / "contour.vtkhdf"
    return json.loads(tegl("contour", file, "--iso", iso, "-o", out, "--json", *more))


def refused(message, *words, status=4):
    """Expects this error, and no new file."""
    before = sorted(FOLDER.iterdir())
    text = tegl(*words, status=status)
    if message not in text:
        sys.exit(f"{' '.join(map(str, words))}: {text!r}; expected {message!r} in it")
    expect(f"files after {words}", sorted(FOLDER.iterdir()), before)


def written(writer, data, name, encoding="raw", compressor="None", is_big=False, is_wide=False, pieces=1):
    writer.SetInputData(data)
    getattr(writer, DATA[encoding])()
    writer.SetEncodeAppendedData(encoding == "base64")
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetByteOrderToBigEndian() if is_big else writer.SetByteOrderToLittleEndian()
    writer.SetHeaderTypeToUInt64() if is_wide else writer.SetHeaderTypeToUInt32()
    if pieces > 1:
        writer.SetNumberOfPieces(pieces)
    path = FOLDER / name
    writer.SetFileName(str(path))
    writer.Write()
    return path


def encodings():
    yield from itertools.product(DATA, ("None", "ZLib"), (False, True), (False, True))


def field(places, t=0.0):
    """Not symmetric, with values that floats hold exactly."""
    x, y, z = places
    return numpy.round(64 * (numpy.sin(x + 0.3 * t) + numpy.cos(1.3 * y) * x / 3 + numpy.sin(0.7 * z + y))) / 64


def samples(sizes=SIZES, t=0.0):
    """Values, axis 0 fastest."""
    z, y, x = numpy.meshgrid(*(numpy.arange(n) for n in reversed(sizes)), indexing="ij")
    return field((x, y, z), t).astype("f4")


def add(data, values, name="f"):
    array = numpy_to_vtk(values.ravel(), deep=True)
    array.SetName(name)
    data.AddArray(array)


def image(values, spacing=(0.5, 2.0, 3.0), origin=(1.0, -2.0, 4.0)):
    data = vtkImageData()
    data.SetDimensions(*values.shape[::-1])
    data.SetSpacing(*spacing)
    data.SetOrigin(*origin)
    add(data.GetPointData(), values)
    return data


def nrrd(name, values, directions, origin):
    """The same image in a NRRD file."""
    vectors = " ".join("(" + ",".join(map(repr, map(float, v))) + ")" for v in directions)
    head = (f"NRRD0004\ntype: {'float' if values.dtype == numpy.float32 else 'double'}\ndimension: {values.ndim}\n"
            f"sizes: {' '.join(map(str, values.shape[::-1]))}\nspace dimension: {values.ndim}\n"
            f"space directions: {vectors}\nspace origin: ({','.join(map(repr, map(float, origin)))})\n"
            "endian: little\nencoding: raw\n\n")
    path = FOLDER / name
    path.write_bytes(head.encode() + values.tobytes())
    return path


def coordinates():
    return [numpy.cumsum(1.0 + 0.25 * (numpy.arange(n) % 3)) for n in SIZES]


def rectilinear(values):
    data = vtkRectilinearGrid()
    data.SetDimensions(*SIZES)
    for axis, places in zip("XYZ", coordinates()):
        getattr(data, f"Set{axis}Coordinates")(numpy_to_vtk(places, deep=True))
    add(data.GetPointData(), values)
    return data


def structured(values):
    data = vtkStructuredGrid()
    data.SetDimensions(*SIZES)
    z, y, x = numpy.meshgrid(*reversed(coordinates()), indexing="ij")
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.column_stack([x.ravel(), y.ravel(), z.ravel()]), deep=True))
    data.SetPoints(points)
    add(data.GetPointData(), values)
    return data


def mesh(points, cells, values=None, of_cells=None):
    """`cells`: pairs of VTK's type and corners."""
    data = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(*point)
    data.SetPoints(places)
    for kind, corners in cells:
        data.InsertNextCell(kind, len(corners), [int(c) for c in corners])
    if values is not None:
        add(data.GetPointData(), numpy.asarray(values, "f8"))
    if of_cells is not None:
        add(data.GetCellData(), numpy.asarray(of_cells, "f8"), "c")
    return data


def grid_cells(sizes):
    """Hexahedra of a grid."""
    nx, ny = sizes[0], sizes[1]
    around = [0, 1, 1 + nx, nx]
    for z, y, x in itertools.product(*(range(n - 1) for n in reversed(sizes))):
        p = (z * ny + y) * nx + x
        yield 12, [p + c for c in around] + [p + nx * ny + c for c in around]


def grid_points(sizes):
    z, y, x = numpy.meshgrid(*(numpy.arange(float(n)) for n in reversed(sizes)), indexing="ij")
    return numpy.column_stack([x.ravel(), y.ravel(), z.ravel()])


def images():
    values = samples()
    wanted = contour(nrrd("same.nrrd", values, numpy.diag((0.5, 2.0, 3.0)), (1.0, -2.0, 4.0)), 0.1)
    for encoding, compressor, is_big, is_wide in encodings():
        name = f"{encoding}_{compressor}_{is_big}_{is_wide}.vti"
        path = written(vtkXMLImageDataWriter(), image(values), name, encoding, compressor, is_big, is_wide)
        expect(name, contour(path, 0.1) == wanted, True)
    expect("vti in pieces", contour(written(vtkXMLImageDataWriter(), image(values), "p.vti", pieces=3), 0.1) == wanted, True)
    expect("vti streamed", report(FOLDER / "p.vti", 0.1, "--stream")["vertices"], report(FOLDER / "p.vti", 0.1)["vertices"])
    # values of the seven types of images
    for kind in ("u1", "i1", "u2", "i2", "i4", "f4", "f8"):
        middle = 100 if kind.startswith("u") else 0
        whole = (numpy.clip(40 * values, -90, 90) + middle).astype(kind)
        path = written(vtkXMLImageDataWriter(), image(whole), "type.vti", "ascii")
        other = nrrd("type.nrrd", whole.astype("f8"), numpy.diag((0.5, 2.0, 3.0)), (1.0, -2.0, 4.0))
        expect(f"vti of {kind}", contour(path, middle + 7.5) == contour(other, middle + 7.5), True)
    # a direction
    turn = numpy.array([[0.0, -1.0, 0.0], [0.8, 0.0, -0.6], [0.6, 0.0, 0.8]])
    turned = image(values)
    turned.SetDirectionMatrix(*turn.ravel())
    path = written(vtkXMLImageDataWriter(), turned, "turned.vti")
    expect("Direction is written", "Direction" in path.read_bytes()[:400].decode(errors="replace"), True)
    expect("vti with a direction", contour(path, 0.1),
           contour(nrrd("turned.nrrd", values, (turn * (0.5, 2.0, 3.0)).T, (1.0, -2.0, 4.0)), 0.1))
    # a plane, and values of cells, which lie at the cells' middles
    flat = image(values[:1])
    path = written(vtkXMLImageDataWriter(), flat, "flat.vti")
    expect("2D vti", report(path, 0.1)["simplices"],
           report(nrrd("flat.nrrd", values[0], numpy.diag((0.5, 2.0)), (1.0, -2.0)), 0.1)["simplices"])
    of_cells = vtkImageData()
    of_cells.SetDimensions(*(n + 1 for n in SIZES))
    of_cells.SetSpacing(0.5, 2.0, 3.0)
    add(of_cells.GetCellData(), values)
    path = written(vtkXMLImageDataWriter(), of_cells, "cells.vti")
    same = nrrd("c.nrrd", values, numpy.diag((0.5, 2.0, 3.0)), (0.25, 1.0, 1.5))
    expect("vti of cells", contour(path, 0.1) == contour(same, 0.1), True)
    # compressors that are not supported
    for compressor in ("LZ4", "LZMA"):
        path = written(vtkXMLImageDataWriter(), image(values), "c.vti", compressor=compressor)
        refused(f"compressed by '{compressor}'" , "contour", path, "--iso", 0.1, "-o", FOLDER / "no.ply")
    # a parallel file
    path = FOLDER / "parallel.pvti"
    path.write_text('<?xml version="1.0"?>\n<VTKFile type="PImageData"><PImageData WholeExtent="0 8 0 7 0 6"><Piece Extent="0 8 0 7 0 6" '
                    'Source="type.vti"/></PImageData></VTKFile>')
    for command in ("contour", "info"):
        more = ["--iso", 0.1, "-o", FOLDER / "no.ply"] if command == "contour" else []
        refused("holds 'PImageData', which names other files", command, path, *more)
    # the old format
    path = FOLDER / "old.vtk"
    path.write_text("# vtk DataFile Version 3.0\nvalues\nASCII\nDATASET STRUCTURED_POINTS\n")
    refused("VTK's old format; expected VTK's XML", "info", path)


def rectilinear_and_structured():
    values = samples()
    wanted = None
    for encoding, compressor, is_big, is_wide in encodings():
        how = (encoding, compressor, is_big, is_wide)
        of_grid = contour(written(vtkXMLRectilinearGridWriter(), rectilinear(values), "r.vtr", *how), 0.1)
        of_points = contour(written(vtkXMLStructuredGridWriter(), structured(values), "s.vts", *how), 0.1)
        wanted = wanted or (of_grid, of_points)
        expect(f"vtr, vts, {how}", (of_grid, of_points) == wanted, True)
    pieces = (written(vtkXMLRectilinearGridWriter(), rectilinear(values), "r3.vtr", pieces=3),
              written(vtkXMLStructuredGridWriter(), structured(values), "s3.vts", pieces=3))
    expect("vtr, vts in pieces", tuple(contour(path, 0.1) for path in pieces) == wanted, True)
    # the cells of a grid have the contour of the grid
    grid, cells = report(FOLDER / "r.vtr", 0.1), report(FOLDER / "s.vts", 0.1)
    for key in ("vertices", "simplices"):
        expect(f"{key} of vts and vtr", cells[key], grid[key])
    area = [json.loads(tegl("measure", FOLDER / name, "--iso", 0.1, "--json"))["size"] for name in ("r.vtr", "s.vts")]
    expect("area of vts and vtr", round(area[0], 9), round(area[1], 9))


def unstructured():
    values = field(grid_points(SIZES).T)
    points, cells = grid_points(SIZES), list(grid_cells(SIZES))
    wanted = None
    for encoding, compressor, is_big, is_wide in encodings():
        how = (encoding, compressor, is_big, is_wide)
        found = contour(written(vtkXMLUnstructuredGridWriter(), mesh(points, cells, values), "u.vtu", *how), 0.1)
        wanted = wanted or found
        expect(f"vtu, {how}", found == wanted, True)
    one = report(FOLDER / "u.vtu", 0.1)
    # several pieces: points that they share become one
    parts = []
    for first, end in ((0, 100), (100, 101), (101, len(cells))):
        used = sorted({corner for _, corners in cells[first:end] for corner in corners})
        place = {point: k for k, point in enumerate(used)}
        part = mesh(points[used], [(kind, [place[c] for c in corners]) for kind, corners in cells[first:end]], values[used])
        text = written(vtkXMLUnstructuredGridWriter(), part, "part.vtu", "binary").read_text()
        parts.append(text[text.index("<Piece"):text.index("</UnstructuredGrid>")])
    path = FOLDER / "pieces.vtu"
    path.write_text(text[:text.index("<Piece")] + "".join(parts) + text[text.index("</UnstructuredGrid>"):])
    several = report(path, 0.1)
    for key in ("vertices", "simplices", "euler", "boundary_simplices", "components"):
        expect(f"{key} of pieces", several[key], one[key])
    # values of cells
    of_cells = numpy.arange(len(cells)) % 7
    averaged = vtkCellDataToPointData()
    averaged.SetInputData(mesh(points, cells, None, of_cells))
    averaged.Update()
    means = vtk_to_numpy(averaged.GetOutput().GetPointData().GetArray("c"))
    path = written(vtkXMLUnstructuredGridWriter(), mesh(points, cells, None, of_cells), "cells.vtu")
    same = written(vtkXMLUnstructuredGridWriter(), mesh(points, cells, means), "means.vtu")
    expect("cells to points", contour(path, 2.9, "--cells-to-points") == contour(same, 2.9), True)
    refused("--cells-to-points", "contour", path, "--iso", 2.9, "-o", FOLDER / "no.ply")
    # hidden cells: as if they were not there
    ghosts = numpy.zeros(len(cells), "u1")
    ghosts[10:40] = 32
    hidden = mesh(points, cells, values)
    array = numpy_to_vtk(ghosts, deep=True)
    array.SetName("vtkGhostType")
    hidden.GetCellData().AddArray(array)
    rest = [cell for cell, ghost in zip(cells, ghosts) if not ghost]
    path = written(vtkXMLUnstructuredGridWriter(), hidden, "hidden.vtu")
    same = written(vtkXMLUnstructuredGridWriter(), mesh(points, rest, values), "rest.vtu")
    expect("hidden cells", contour(path, 0.1) == contour(same, 0.1), True)
    # types of cells that are refused, by name
    lists = {37: "triquadratic pyramid", 72: "Lagrange hexahedron", 74: "Lagrange pyramid", 81: "Bezier pyramid"}
    for kind, name in lists.items():
        data = mesh(points, cells[:3], values)
        path = written(vtkXMLUnstructuredGridWriter(), data, "kind.vtu", "ascii")
        text = path.read_text()
        begin = text.index(">", text.index('Name="types"')) + 1
        path.write_text(text[:begin] + f" 12 {kind} 12 " + text[text.index("</DataArray>", begin):])
        refused(f"cell 1 is a {name} (VTK's type {kind})", "contour", path, "--iso", 0.1, "-o", FOLDER / "no.ply")


def truncated_octahedra(count):
    """Points and the faces of cells that fill space: those of a body-centred cubic lattice."""
    places = [tuple(numpy.roll(v, k)) for k in range(3) for a in (-1, 1) for b in (-1, 1)
              for v in ((0, a, 2 * b), (0, 2 * a, b))]
    squares = [[p for p in places if p[axis] == 2 * side] for axis in range(3) for side in (-1, 1)]
    hexagons = [[p for p in places if numpy.dot(p, s) == 3] for s in itertools.product((-1, 1), repeat=3)]
    faces = []
    for face in squares + hexagons:
        middle = numpy.mean(face, axis=0)
        u = face[0] - middle
        v = numpy.cross(middle, u)
        faces.append(sorted(face, key=lambda p: numpy.arctan2(numpy.dot(p - middle, v) / numpy.linalg.norm(v),
                                                              numpy.dot(p - middle, u) / numpy.linalg.norm(u))))
    numbers, cells = {}, []
    for centre in itertools.product(range(2 * count), repeat=3):
        if len({x % 2 for x in centre}) == 1:
            cells.append([[numbers.setdefault(tuple(2 * numpy.array(centre) + p), len(numbers)) for p in face]
                          for face in faces])
    return numpy.array(list(numbers), float), cells


def polyhedra_of(points, cells, values, others=()):
    data = mesh(points, others, values)
    for faces in cells:
        stream = vtkIdList()
        for number in [len(faces)] + [number for face in faces for number in (len(face), *face)]:
            stream.InsertNextId(int(number))
        data.InsertNextCell(42, stream)
    return data


def polyhedra():
    """Polyhedra as VTK writes them; a plane through them has the area that VTK finds."""
    points, cells = truncated_octahedra(4)
    values = 5.3 - numpy.linalg.norm(points - 7.1, axis=1)
    wanted = None
    for encoding, compressor, is_big, is_wide in encodings():
        how = (encoding, compressor, is_big, is_wide)
        path = written(vtkXMLUnstructuredGridWriter(), polyhedra_of(points, cells, values), "p.vtu", *how)
        wanted = wanted or contour(path, 0.1)
        expect(f"polyhedra, {how}", contour(path, 0.1) == wanted, True)
    found = report(path, 0.1)
    expect("sphere in polyhedra", (found["euler"], found["boundary_simplices"], found["components"]), (2, 0, 1))
    # a linear function: the section of the mesh by a plane, of which VTK measures the area
    plane = points @ (0.3, -0.5, 0.8) - 4.1
    data = polyhedra_of(points, cells, plane)
    data.GetPointData().SetActiveScalars("f")
    cutter = vtkContourFilter()
    cutter.SetInputData(data)
    cutter.SetValue(0, 0.0)
    sizes = vtkCellSizeFilter()
    sizes.SetInputConnection(cutter.GetOutputPort())
    sizes.Update()
    area = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area")).sum()
    path = written(vtkXMLUnstructuredGridWriter(), data, "plane.vtu")
    measured = json.loads(tegl("measure", path, "--iso", 0, "--json"))["size"]
    expect("area of a plane in polyhedra", round(measured / area, 5), 1.0)
    kinds = json.loads(tegl("info", path, "--json"))["cells"]
    expect("kinds of cells", kinds, {"polyhedron": len(cells)})
    # hexahedra as polyhedra, a hexagonal prism as VTK's own type and as a polyhedron
    cubes = [list(corners) for kind, corners in grid_cells(SIZES) if kind == 12]
    faces = [[[c[i] for i in face] for face in ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                                                (3, 0, 4, 7))] for c in cubes]
    places = grid_points(SIZES)
    of_grid = field(places.T)
    one = report(written(vtkXMLUnstructuredGridWriter(), mesh(places, [(12, c) for c in cubes], of_grid), "h.vtu"), 0.1)
    other = report(written(vtkXMLUnstructuredGridWriter(), polyhedra_of(places, faces, of_grid), "hp.vtu"), 0.1)
    for key in ("vertices", "simplices", "euler", "boundary_simplices"):
        expect(f"{key} of hexahedra as polyhedra", other[key], one[key])
    ring = [(numpy.cos(k * numpy.pi / 3), numpy.sin(k * numpy.pi / 3)) for k in range(6)]
    prism = [(x, y, z) for z in (0.0, 1.0) for x, y in ring]
    sides = [[k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6] for k in range(6)]
    prism_faces = [list(range(6)), list(range(6, 12)), *sides]
    for iso in (0.5, 3.5):
        one = contour(written(vtkXMLUnstructuredGridWriter(), mesh(prism, [(16, range(12))], range(12)), "x.vtu"), iso)
        other = contour(written(vtkXMLUnstructuredGridWriter(), polyhedra_of(prism, [prism_faces], range(12)), "y.vtu"), iso)
        expect("hexagonal prism", one, other)
    refused("(hexagonal prism) has 10 corners; expected 12", "contour",
            written(vtkXMLUnstructuredGridWriter(), mesh(prism, [(16, range(10))], range(12)), "z.vtu", "ascii"), "--iso", 1,
            "-o", FOLDER / "no.ply")
    open_cell = written(vtkXMLUnstructuredGridWriter(), polyhedra_of(prism, [prism_faces[1:]], range(12)), "open.vtu")
    refused("open.vtu: cell 0: the edge between the points", "contour", open_cell, "--iso", 1, "-o", FOLDER / "no.ply")


def planar():
    """2D meshes, in a plane across any axis, of quadrilaterals and polygons."""
    points = numpy.array([(x, y) for y in range(6) for x in range(6)], float)
    values = numpy.hypot(points[:, 0] - 2.4, points[:, 1] - 2.6)
    squares = [[y * 6 + x, y * 6 + x + 1, y * 6 + x + 7, y * 6 + x + 6] for y in range(5) for x in range(5)]
    lengths = []
    for across, kind in itertools.product(range(3), (9, 7)):
        places = numpy.insert(points, across, 0.5, axis=1)
        path = written(vtkXMLUnstructuredGridWriter(), mesh(places, [(kind, s) for s in squares], values), "2d.vtu")
        found = report(path, 1.7)
        expect("dimension of a planar mesh", found["image_dim"], 2)
        expect("boundary", found["boundary_simplices"], 0)
        lengths.append(json.loads(tegl("measure", path, "--iso", 1.7, "--json"))["size"])
    expect("lengths", {round(length, 9) for length in lengths}, {round(lengths[0], 9)})
    # two pentagons around an edge
    ring = [(0, 0, 0), (2, 0, 0), (3, 1.5, 0), (1, 3, 0), (-1, 1.5, 0), (4, -1, 0), (5, 1, 0), (4.5, 2, 0)]
    path = written(vtkXMLUnstructuredGridWriter(), mesh(ring, [(7, [0, 1, 2, 3, 4]), (7, [1, 5, 6, 7, 2])], range(8)), "5.vtu")
    expect("pentagons", report(path, 2.5)["nonmanifold_simplices"], 0)
    tilted = mesh(numpy.column_stack([points, points[:, 0]]), [(9, s) for s in squares], values)
    path = written(vtkXMLUnstructuredGridWriter(), tilted, "tilted.vtu")
    refused("in a plane", "contour", path, "--iso", 1.7, "-o", FOLDER / "no.ply")


def collection(name, files):
    path = FOLDER / name
    rows = "".join(f'<DataSet timestep="{t}" file="{file}"/>' for t, file in files)
    path.write_text(f'<VTKFile type="Collection"><Collection>{rows}</Collection></VTKFile>')
    return path


def over_time():
    times = [0.0, 0.5, 1.0, 2.0]
    # images: as one 4D image; NRRD has equal steps only
    steps = [samples(t=t) for t in range(4)]
    for k, step in enumerate(steps):
        written(vtkXMLImageDataWriter(), image(step), f"step_{k}.vti", compressor="ZLib")
    path = collection("images.pvd", [(0.25 * k, f"step_{k}.vti") for k in range(4)])
    same = nrrd("4d.nrrd", numpy.stack(steps), numpy.diag((0.5, 2.0, 3.0, 0.25)), (1.0, -2.0, 4.0, 0.0))
    for t in (0.25, 0.4):
        cut = [FOLDER / "pvd.ply", FOLDER / "nrrd.ply"]
        tegl("slice", path, "--iso", 0.1, "--at", f"t={t}", "-o", cut[0], "--quiet")
        tegl("slice", same, "--iso", 0.1, "--at", f"t={t}", "-o", cut[1], "--quiet")
        expect(f"slice of images at {t}", cut[0].read_bytes() == cut[1].read_bytes(), True)
    # a mesh whose points move: 4D, closed where the border is not met, and the same in all commands
    points, cells = grid_points(SIZES), list(grid_cells(SIZES))
    for k, t in enumerate(times):
        moved = points * (1.0, 1.0, 1.0 + 0.1 * t)
        ball = 2.2 + 0.2 * t - numpy.linalg.norm(points - (4.1, 3.4, 3.2), axis=1)
        written(vtkXMLUnstructuredGridWriter(), mesh(moved, cells, ball), f"ball_{k}.vtu")
    path = collection("ball.pvd", [(t, f"ball_{k}.vtu") for k, t in enumerate(times)])
    found = report(path, 0.0)
    expect("dimension in time", found["image_dim"], 4)
    expect("manifold", (found["nonmanifold_simplices"], found["bad_links"], found["orientation_conflicts"]), (0, 0, 0))
    saved = FOLDER / "contour.vtkhdf"
    for t in (0.0, 0.75, 2.0):
        cut = [FOLDER / "mesh.ply", FOLDER / "saved.ply"]
        both = [json.loads(tegl("slice", source, *more, "--at", f"t={t}", "-o", out, "--json"))
                for source, more, out in zip((path, saved), (["--iso", 0], []), cut)]
        expect(f"cut at {t}", cut[0].read_bytes() == cut[1].read_bytes(), True)
        expect(f"cut at {t} is closed", both[0]["boundary_simplices"], 0)
    tracks = json.loads(tegl("track", path, "--iso", 0, "--json"))["graph"]
    expect("one track", len(tracks["tracks"]), 1)
    expect("its ends", [event["kind"] for event in tracks["events"]], ["begin", "end"])
    measured = json.loads(tegl("measure", path, "--iso", 0, "--at", "t=0.3", "--json"))["cuts"][0]
    expect("volume", 40 < measured["content"] < 60, True)
    expect("components", json.loads(tegl("components", path, "--iso", 0, "--json"))["count"], 1)
    tegl("simplify", path, "--iso", 0, "--ratio", 0.5, "-o", FOLDER / "fewer.vtkhdf", "--quiet")
    refused("expected 0 <= t <= 2", "measure", path, "--iso", 0, "--at", "t=2.5", status=5)
    refused("expected 0 <= t <= 2", "slice", path, "--iso", 0, "--at", "t=-1", "-o", FOLDER / "no.ply", status=5)
    # the same from a list of files
    names = [FOLDER / f"ball_{k}.vtu" for k in range(4)]
    expect("a list of files", contour_vtkhdf(names, "--times", "0,0.5,1,2"), report(path, 0.0)["simplices"])
    polyhedra_over_time(times)


def polyhedra_over_time(times):
    points, cells = truncated_octahedra(4)
    for k, t in enumerate(times):
        ball = 4.5 + 0.4 * t - numpy.linalg.norm(points - 7.1, axis=1)
        written(vtkXMLUnstructuredGridWriter(), polyhedra_of(points + 0.1 * t, cells, ball), f"polyhedra_{k}.vtu")
    path = collection("polyhedra.pvd", [(t, f"polyhedra_{k}.vtu") for k, t in enumerate(times)])
    found = report(path, 0.0)
    expect("dimension of polyhedra in time", found["image_dim"], 4)
    expect("manifold of polyhedra in time",
           (found["nonmanifold_simplices"], found["bad_links"], found["orientation_conflicts"], found["components"]),
           (0, 0, 0, 1))
    cut = json.loads(tegl("slice", path, "--iso", 0, "--at", "t=1", "-o", FOLDER / "cut.ply", "--json"))
    step = report(FOLDER / "polyhedra_2.vtu", 0.0)
    for key in ("vertices", "simplices", "boundary_simplices"):
        expect(f"{key} of polyhedra at a time", cut[key], step[key])
    expect("track of polyhedra", len(json.loads(tegl("track", path, "--iso", 0, "--json"))["graph"]["tracks"]), 1)


def contour_vtkhdf(names, *more):
    out = FOLDER / "list.vtkhdf"
    return json.loads(tegl("contour", *names, "--iso", 0, "-o", out, "--json", *more))["simplices"]


shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
for test in (images, rectilinear_and_structured, unstructured, polyhedra, planar, over_time):
    test()
