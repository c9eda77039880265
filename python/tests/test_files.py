# SPDX-License-Identifier: BSD-3-Clause
"""Files in and out, other programs' structures, and that the program `tegl` gives the same."""

import base64
import dataclasses
import importlib.util
import json
import os
import pathlib
import runpy
import subprocess
import sys
import threading

import numpy as np
import pytest
import tegl
from conftest import assert_same, assert_same_places, ball, noise, signed_content

OCEAN = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]) / "examples/data/ocean_temperature.nc"
PROGRAM = pathlib.Path(os.environ["TEGL_BUILD_DIR"]) / "bin/tegl"
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason="the program tegl is not built")


def test_an_image_from_a_file_has_its_coordinates():
    image = tegl.read(OCEAN)
    assert image.format == "netCDF" and image.array.ndim == 4
    assert image.array.shape == tuple(len(coordinates) for coordinates in image.coords)
    assert image.array.flags.c_contiguous and not image.array.flags.owndata, "the library's memory, as it is"
    other = tegl.read(OCEAN, time_axis=-1)
    assert np.array_equal(other.array.T, image.array, equal_nan=True) and other.axis_names == image.axis_names[::-1]
    assert image.time_axis == 0 and other.time_axis == 3
    assert_same(image.contour(20.0), tegl.contour(image, 20.0))
    by_hand = tegl.contour(image.array, 20.0, coords=image.coords)
    assert_same(by_hand, image.contour(20.0))
    with pytest.raises(ValueError, match="no_such"):
        tegl.read(OCEAN, "no_such")
    with pytest.raises(FileNotFoundError, match="no_such.nc"):
        tegl.read(OCEAN.with_name("no_such.nc"))


@pytest.mark.parametrize("dtype", [np.uint8, ">i2", np.float16, np.float32, np.int64, bool])
@pytest.mark.parametrize("order", ["C", "F"])
def test_saved_arrays_have_the_contour_of_the_array(dtype, order, tmp_path):
    array = np.asarray(ball(4) > 0 if dtype is bool else 40 * ball(4) + 60).astype(dtype, order=order)
    level = 0.5 if dtype is bool else 59.5
    np.save(tmp_path / "a.npy", array)
    np.savez(tmp_path / "stored.npz", words=np.array(["a", "b"]), array=array)
    np.savez_compressed(tmp_path / "deflated.npz", other=array[0], array=array)
    numbers = array.astype(np.float32) if dtype is np.float16 else array.astype(np.uint8) if dtype is bool else array
    expected = tegl.contour(numbers, level)
    for image in (tegl.read(tmp_path / "a.npy"), tegl.read(tmp_path / "stored.npz"),
                  tegl.read(tmp_path / "deflated.npz", "array")):
        assert image.format == "NumPy" and image.array.shape == array.shape
        assert np.array_equal(image.array, numbers)
        assert_same(image.contour(level), expected)
    with pytest.raises(ValueError, match="2 arrays.*other.*array"):
        tegl.read(tmp_path / "deflated.npz")
    if PROGRAM.exists():
        subprocess.run([PROGRAM, "contour", tmp_path / "deflated.npz", "--var", "array", "--iso", str(level), "-o",
                        tmp_path / "program.vtkhdf", "--quiet"], check=True)
        theirs = tegl.load(tmp_path / "program.vtkhdf")
        mine = tegl.read(tmp_path / "a.npy").contour(level, dtype=np.float64)
        assert np.array_equal(theirs.vertices, mine.vertices) and np.array_equal(theirs.simplices, mine.simplices)
    np.save(tmp_path / "objects.npy", np.array([[1, "a"]], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="'|O'"):
        tegl.read(tmp_path / "objects.npy")


def test_one_index_of_a_dimension_is_read():
    image = tegl.read(OCEAN)
    part = tegl.read(OCEAN, fix={image.axis_names[0]: np.int64(3)})
    assert np.array_equal(part.array, image.array[3], equal_nan=True) and part.axis_names == image.axis_names[1:]
    plane = tegl.read(OCEAN, fix={image.axis_names[0]: 3, image.axis_names[1]: 0})
    assert np.array_equal(plane.array, image.array[3, 0], equal_nan=True)
    for fix, error, text in [({"no_such": 0}, ValueError, "no dimension 'no_such'"),
                             ({image.axis_names[0]: 99}, ValueError, "=99; expected an index from 0 to"),
                             ({image.axis_names[0]: -1}, ValueError, "is -1; expected 0 or more"),
                             ({image.axis_names[0]: 1.5}, TypeError, "is 1.5; expected a whole number"),
                             ({3: 1}, TypeError, "expected text"), ("time=3", TypeError, "fix is 'time=3'")]:
        with pytest.raises(error, match=text):
            tegl.read(OCEAN, fix=fix)


def test_samples_outside_of_the_headers_folder_are_read_only_if_allowed(tmp_path):
    (tmp_path / "headers").mkdir()
    (tmp_path / "a.raw").write_bytes(bytes(range(8)))
    header = tmp_path / "headers" / "a.nhdr"
    header.write_text("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: ../a.raw\n")
    with pytest.raises(ValueError, match="allow_outside_paths"):
        tegl.read(header)
    assert tegl.read(header, allow_outside_paths=True).array.ravel().tolist() == list(range(8))
    header.write_text(header.read_text().replace("../a.raw", "/etc/passwd"))
    with pytest.raises(ValueError, match="/etc/passwd"):
        tegl.read(header)


def test_an_image_is_three_lines_however_large_it_is():
    image = tegl.read(OCEAN)
    assert repr(image) == str(image) == (
        "<tegl.Image temperature in degC: 12 x 14 x 90 x 180 float32\n"
        "  axes: time 1 to 12 month; depth 0 to 500 m; lat -89.5 to 88.5 degrees_north; lon 20.5 to 378.5 degrees_east\n"
        "  time_axis 0, read from netCDF>")
    turned = tegl.read(OCEAN, time_axis=-1)
    assert "180 x 90 x 14 x 12" in repr(turned) and "; time 1 to 12 month\n  time_axis 3" in repr(turned)
    odd = dataclasses.replace(image, variable="v\x1b[2J\n", axis_names=("", "a\nb", "y", "x"), world_frame="RAS",
                              affine=np.eye(4, 5), variables=("a", "b"))
    assert repr(odd).count("\n") == 2 and "\x1b" not in repr(odd) and "axes: axis 0 1 to 12 month; a\\nb 0 to" in repr(odd)
    assert repr(odd).endswith("time_axis 0, with an affine map, world RAS, read from netCDF, one of 2 variables>")


@needs_program
@pytest.mark.parametrize("suffix", [".vtkhdf", ".ply"])
def test_the_program_gives_the_same_contour(suffix, tmp_path):
    image = tegl.read(OCEAN)
    path = tmp_path / f"program{suffix}"
    if suffix == ".ply":
        subprocess.run([PROGRAM, "slice", OCEAN, "--iso", "20", "--at", "t=7.3", "-o", path, "--quiet"], check=True)
        mine = tegl.slice(image, 20.0, at=7.3, dtype=np.float64)
    else:
        subprocess.run([PROGRAM, "contour", OCEAN, "--iso", "20", "-o", path, "--quiet"], check=True)
        mine = image.contour(20.0, dtype=np.float64)
    theirs = tegl.load(path)
    assert len(mine.simplices) > 1000
    assert np.array_equal(theirs.vertices, mine.vertices) and np.array_equal(theirs.simplices, mine.simplices)
    assert theirs.axis_names == mine.axis_names and theirs.axis_units == mine.axis_units and theirs.isovalue == 20.0
    mine.save(tmp_path / f"python{suffix}")
    assert path.read_bytes() == (tmp_path / f"python{suffix}").read_bytes()


@pytest.mark.parametrize("suffix, ndim", [(".ply", 2), (".ply", 3), (".vtkhdf", 2), (".vtkhdf", 3), (".vtkhdf", 4)])
@pytest.mark.parametrize("time_axis", [0, -1])
def test_what_is_saved_comes_back(suffix, ndim, time_axis, tmp_path):
    names = ["a", "b", "c", "d"][:ndim]
    contour = tegl.contour(ball(ndim, 9)[:-1], 0.0, normals=True, axis_names=names, axis_units=["mm"] * ndim,
                           dtype=np.float64, time_axis=time_axis)
    path = tmp_path / f"contour{suffix}"
    contour.save(path)
    loaded = tegl.Contour.load(path, time_axis=time_axis)
    assert_same(loaded, contour)
    assert np.array_equal(loaded.normals, contour.normals)
    assert loaded.axis_names == contour.axis_names and loaded.isovalue == 0.0
    simplified = tegl.contour(ball(3, 21), 0.0).simplify(ratio=0.3)
    simplified.save(tmp_path / "simplified.ply")
    assert "simplification_error" in tegl.load(tmp_path / "simplified.ply").vertex_attributes


@pytest.mark.parametrize("time_axis", [0, -1])
def test_stl_and_obj_hold_the_same_closed_surface_with_high_inside(time_axis, tmp_path):
    contour = tegl.contour(ball(3, 21), 0.0, spacing=(1.0, 0.5, 2.0), time_axis=time_axis)
    assert contour.check().is_closed
    for name in ("ball.stl", "ball.obj"):
        contour.save(tmp_path / name)
        loaded = tegl.load(tmp_path / name, time_axis=time_axis)
        assert loaded.check().is_closed and loaded.check().euler == 2
        # OBJ has the digits of floats, which are read as doubles.
        assert np.array_equal(loaded.vertices[loaded.simplices].astype(np.float32), contour.vertices[contour.simplices])
        assert loaded.measure().content == pytest.approx(contour.measure().content, rel=1e-6) and loaded.measure().content > 0
    assert (tmp_path / "ball.stl").stat().st_size == 84 + 50 * len(contour.simplices)
    tegl.contour(ball(2, 21), 0.0).save(tmp_path / "line.obj")
    assert tegl.load(tmp_path / "line.obj").check().is_closed
    with pytest.raises(ValueError, match="expected .vtkhdf, or a slice of it"):
        tegl.contour(ball(4, 9), 0.0).save(tmp_path / "no.stl")


def test_files_that_cannot_be(tmp_path):
    contour = tegl.contour(ball(3), 0.0)
    with pytest.raises(OSError):
        contour.save(tmp_path / "no such folder" / "contour.ply")
    with pytest.raises(ValueError, match="contour.xyz"):
        contour.save(tmp_path / "contour.xyz")
    with pytest.raises(FileNotFoundError, match="missing.ply"):
        tegl.load(tmp_path / "missing.ply")
    (tmp_path / "broken.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
    with pytest.raises(ValueError, match="broken.ply"):
        tegl.load(tmp_path / "broken.ply")


def test_files_that_a_file_names(tmp_path):
    contour = tegl.contour(ball(3), 0.0)
    (tmp_path / "meshes").mkdir()
    path = tmp_path / "meshes" / "contour.gltf"
    contour.save(path)
    text = json.loads(path.read_text())
    buffer = text["buffers"][0]
    (tmp_path / "outside.bin").write_bytes(base64.b64decode(buffer["uri"].split(",")[1]))
    buffer["uri"] = "../outside.bin"
    path.write_text(json.dumps(text))
    with pytest.raises(ValueError, match="outside.bin.*allow_outside_paths"):
        tegl.load(path)
    assert tegl.load(path, allow_outside_paths=True).check().is_closed


# xarray.

def data_array():
    xarray = pytest.importorskip("xarray")
    values = noise((5, 6, 7), 4)
    return xarray.DataArray(values, dims=("time", "depth", "lon"), coords={
        "time": np.array(["2020-01-01", "2020-02-01", "2020-03-01", "2020-04-01", "2020-05-01"], dtype="datetime64[ns]"),
        "depth": ("depth", [0.0, 5, 20, 50, 100, 300], {"units": "m"}), "lon": ("lon", np.arange(7) * 0.5)})


def test_an_xarray_brings_its_names_coordinates_and_units():
    data = data_array()
    contour = tegl.contour(data, 0.1, dtype=np.float64)
    days = np.array([0, 31, 60, 91, 121.0])
    expected = tegl.contour(data.values, 0.1, coords=[days, data.depth.values, data.lon.values], dtype=np.float64)
    assert_same(contour, expected)
    assert contour.axis_names == ("time", "depth", "lon")
    assert contour.axis_units == ("days since 2020-01-01T00:00:00", "m", "")
    assert contour.time_axis == 0
    assert tegl._arguments.prepare(data).image.array.base is not None
    assert np.shares_memory(tegl._arguments.prepare(data).image.array, data.values)
    cut = contour.slice(np.datetime64("2020-02-15T12:00"))
    assert len(cut.vertices) > 0
    assert_same(cut, contour.slice(time=45.5))
    assert_same_places(tegl.slice(data, 0.1, at=np.datetime64("2020-02-15T12:00"), dtype=np.float64), cut)
    assert tegl.contour(data.transpose("lon", "depth", "time"), 0.1).time_axis == 2


def test_what_is_missing_in_an_xarray_is_missing():
    data = data_array()
    data[2, 3, 4] = np.nan
    contour = tegl.contour(data, 0.1)
    assert contour.check().is_manifold
    assert_same(contour, tegl.contour(data_array(), 0.1, mask=np.isfinite(data.values)))


def test_an_xarray_without_coordinates_or_with_words():
    xarray = pytest.importorskip("xarray")
    values = noise((5, 6), 4)
    assert_same(tegl.contour(xarray.DataArray(values), 0.1), tegl.contour(values, 0.1))
    words = xarray.DataArray(values, dims=("run", "x"), coords={"run": list("abcde")})
    with pytest.raises(ValueError, match="'run' has values of type <U1; expected numbers or dates"):
        tegl.contour(words, 0.1)
    assert_same(tegl.contour(data_array(), 0.1, spacing=1.0), tegl.contour(data_array().values, 0.1))


def test_images_become_xarrays_and_back():
    pytest.importorskip("xarray")
    image = tegl.read(OCEAN)
    data = image.to_xarray()
    assert data.dims == image.axis_names and data.attrs["units"] == image.value_unit
    assert_same(tegl.contour(data, 20.0), image.contour(20.0))


def test_xarrays_keep_the_lattice(tmp_path):
    pytest.importorskip("xarray")
    np.savez(tmp_path / "a.npz", values=noise((8, 6, 6), 4), sample_lattice="fcc")
    image = tegl.read(tmp_path / "a.npz", "values")
    data = image.to_xarray()
    assert data.attrs["sample_lattice"] == "fcc"
    assert_same(tegl.contour(data, 0.1), image.contour(0.1))
    assert tegl.count(data, 0.1) == tegl.count(image, 0.1)
    assert_same(tegl.contour(data, 0.1, lattice="cubic"), image.contour(0.1, lattice="cubic"))
    with pytest.raises(ValueError, match="on the lattice fcc, which only tegl.contour and tegl.count know"):
        tegl.slice(data, 0.1, at=1.5)
    with pytest.raises(ValueError, match="the lattice 'fcc' is for the axes .*; expected the same axes in this order"):
        tegl.contour(data.transpose(*data.dims[::-1]), 0.1)
    data.attrs["sample_lattice"] = "hex"
    with pytest.raises(ValueError, match="the attribute 'sample_lattice' is 'hex'; expected one of"):
        tegl.contour(data, 0.1)
    with pytest.raises(ValueError, match="^lattice is 'hex'; expected one of"):
        tegl.contour(data, 0.1, lattice="hex")


def test_xarrays_keep_the_affine_map():
    pytest.importorskip("xarray")
    values = noise((4, 5, 6, 7), 5)
    affine = np.array([[2.0, 0, 0, 0, 10], [0, 0, 0.5, 3, -1], [0, 1, 0.25, 0, 2], [0, 0.1, -2, 0, 3]])
    coords = tuple(np.arange(n) * 1.0 for n in values.shape)
    image = tegl.Image(values, coords, ("t", "z", "y", "x"), ("s", "", "", ""), affine, 0, "", "", "NIfTI", "", (), "RAS",
                       ("unknown",) * 4, coords)
    data = image.to_xarray()
    assert_same(tegl.contour(data, 0.1), image.contour(0.1))
    assert tegl.slice(data, 0.1, at=11.0).measure().size == tegl.slice(image, 0.1, at=11.0).measure().size
    # one time, and another order of the axes
    one = tegl.contour(values[2], 0.1, affine=affine[1:, 1:], axis_names=("z", "y", "x"))
    assert_same(tegl.contour(data[2], 0.1), one)
    turned = tegl.contour(data[2].transpose("x", "z", "y"), 0.1, dtype=float)
    order = [2, 0, 1]
    assert_same(turned, tegl.contour(values[2].transpose(order), 0.1, affine=affine[1:, 1:][order][:, [*order, 3]],
                                     axis_names=("x", "z", "y"), dtype=float))
    # an argument comes first
    assert_same(tegl.contour(data[2], 0.1, affine=np.eye(4)), tegl.contour(values[2], 0.1, axis_names=("z", "y", "x")))
    with pytest.raises(ValueError, match="the attribute 'affine' is for the axes t, z, y, x, and the array has t, z, x; expected the"):
        tegl.contour(data[:, :, 2], 0.1)
    # without the names of its axes, the attribute is another program's
    other = data.copy()
    del other.attrs["affine_axes"]
    assert_same(tegl.contour(other, 0.1), tegl.contour(values, 0.1, axis_names=("t", "z", "y", "x"), axis_units=("s", "", "", "")))
    data.attrs["affine"] = [1, 2]
    with pytest.raises(ValueError, match=r"the attribute 'affine' has the shape \(2,\); expected \(4, 5\)"):
        tegl.contour(data, 0.1)


def test_xarrays_keep_the_coordinates_of_a_curved_grid():
    pytest.importorskip("xarray")
    angle, radius = np.meshgrid(np.linspace(0, 3, 20), np.linspace(1, 2, 10), indexing="ij")
    values = np.stack([1.4 - radius, 1.6 - radius])
    curved = {1: (radius * np.cos(angle))[None], 2: (radius * np.sin(angle))[None]}
    image = tegl.Image(values, tuple(np.arange(n) * 1.0 for n in values.shape), ("time", "x", "y"), ("s", "m", "m"), None, 0, "",
                       "", "netCDF", "", (), "", ("unknown",) * 3, ({},) * 3, curved)
    data = image.to_xarray()
    assert data.dims == ("time", "x_index", "y_index") and data.coords["x"].dims == ("x_index", "y_index")
    contour = tegl.contour(data, 0.0)
    assert_same(contour, tegl.contour(values, 0.0, curved=curved, axis_names=("time", "x", "y"), axis_units=("s", "m", "m")))
    assert contour.axis_names == ("time", "x", "y") and contour.axis_units == ("s", "m", "m")
    assert_same(tegl.contour(data.transpose("time", "y_index", "x_index")[:, :, :12], 0.0),
                tegl.contour(values.transpose(0, 2, 1)[:, :, :12], 0.0, axis_names=("time", "y", "x"),
                             axis_units=("s", "m", "m"), curved={2: curved[1].transpose(0, 2, 1)[:, :, :12],
                                                                 1: curved[2].transpose(0, 2, 1)[:, :, :12]}))
    with pytest.raises(ValueError, match=r"coords\[1\] with a curved grid along this axis; expected None for it, or "
                                         r"drop_vars\(\['x', 'y'\]\) in place of the image"):
        tegl.contour(data, 0.0, coords=[None, range(20), range(10)])
    with pytest.raises(ValueError, match="spacing with a curved grid.*None for each curved axis, or its `array` in place of the image"):
        tegl.contour(image, 0.0, spacing=2.0)
    with pytest.raises(ValueError, match="an image with a curved grid"):
        tegl.slice(data, 0.0, at=0.5)


def test_axes_without_given_coordinates_keep_those_of_an_image():
    image = tegl.read(OCEAN)
    some = [None, *image.coords[1:]]
    kept = tegl.contour(image, 20.0, coords=some)
    assert_same(kept, tegl.contour(image, 20.0))
    assert kept.axis_units == (image.axis_units[0], "", "", "")[:len(image.axis_units)] and image.axis_units[0]
    assert tegl.contour(image, 20.0, spacing=2.0, origin=1.0).axis_units == ("",) * len(image.axis_units)


def test_xarrays_with_longitude_and_latitude_in_two_dimensions_are_curved():
    xarray = pytest.importorskip("xarray")
    lat, lon = np.meshgrid(np.linspace(-60, 60, 20), np.arange(0, 360, 10.0), indexing="ij")
    lat = lat + 3 * np.sin(np.radians(lon))
    values = lat - 25 + np.arange(3.0)[:, None, None]
    stored = (lon + 280) % 360 - 180  # in -180 to 180
    times = np.array([100.0, 130.0, 160.0])
    coords = {"time": ("time", times, {"units": "days since 1990-01-01"}), "TLAT": (("j", "i"), lat, {"units": "degrees_north"}),
              "TLONG": (("j", "i"), stored, {"units": "degrees_east"}), "area": (("j", "i"), lat * 0, {"units": "m2"})}
    data = xarray.DataArray(values, dims=("time", "j", "i"), coords=coords)
    names, units = ("time", "TLAT", "TLONG"), ("days since 1990-01-01", "degrees_north", "degrees_east")
    in_time = {"coords": [times, None, None]}
    curved = {1: lat[None], 2: stored[None]}
    contour = tegl.contour(data, 0.0)
    assert contour.axis_names == names and contour.axis_units == units
    assert_same(contour, tegl.contour(values, 0.0, curved=curved, axis_names=names, axis_units=units, **in_time))
    around = tegl.contour(data, 0.0, periodic="auto")
    assert around.periods.tolist() == [[0, 0, 360]]
    assert_same(around, tegl.contour(data, 0.0, periodic="TLONG"))
    # in another order of the dimensions
    turned = tegl.contour(data.transpose("time", "i", "j"), 0.0)
    assert turned.axis_names == names and len(turned.vertices) == len(contour.vertices)
    assert turned.measure().size == pytest.approx(contour.measure().size, rel=1e-3)
    # dimensions with coordinates, other coordinates by arguments, and indices
    straight = data.assign_coords(i=np.arange(36) * 2.0, j=np.arange(20) * 1.0)
    assert tegl.contour(straight, 0.0).axis_names == ("time", "j", "i")
    other = tegl.contour(data, 0.0, curved={"j": lat[None], "i": lon[None]})
    assert_same(other, tegl.contour(values, 0.0, curved={1: lat[None], 2: lon[None]}, **in_time))
    assert_same(tegl.contour(data.drop_vars(["TLAT", "TLONG"]), 0.0), tegl.contour(values, 0.0, **in_time))
    indices = tegl.contour(data, 0.0, spacing=1.0)
    assert_same(indices, tegl.contour(values, 0.0))
    assert indices.axis_units == ("", "", "") and indices.axis_names == ("time", "j", "i")
    with_units = tegl.contour(data, 0.0, spacing=1.0, axis_units=("month", "", ""))
    assert with_units.axis_units == ("month", "", "")
    # coordinates of both dimensions in place of longitude and latitude
    i, j = np.arange(36) * 2.0, np.arange(20) * 1.0
    for coords, unit in (([None, j, i], units[0]), ((list(times), list(j), i), "")):
        given = tegl.contour(data, 0.0, coords=coords)
        assert given.axis_names == ("time", "j", "i") and given.axis_units == (unit, "", "")
        assert np.ptp(given.vertices[:, 0]) == 60
        assert_same(given, tegl.contour(straight, 0.0))
    assert_same(tegl.contour(data, 0.0, coords=[times, None, None]), contour)
    with pytest.raises(ValueError, match=r"coords\[2\], but not coords\[1\], of an xarray with the coordinates 'TLAT' and 'TLONG' "
                                         "of a curved grid along both axes; expected both, in place of these, or None for both"):
        tegl.contour(data, 0.0, coords=[None, None, i])
    with pytest.raises(ValueError, match=r"coords\[1\] with a curved grid along this axis; expected None for it$"):
        tegl.contour(data, 0.0, coords=[None, j, i], curved=curved)
    with pytest.raises(ValueError, match="coords has 2 entries; expected one for each of 3 axes"):
        tegl.contour(data, 0.0, coords=[j, i])
    assert tegl.contour(data[:, 14], 2.5).axis_names == ("time", "i")  # no longer in two dimensions
    with pytest.raises(ValueError, match=r"a curved grid.*expected drop_vars\(\['TLAT', 'TLONG'\]\)"):
        tegl.slice(data, 0.0, at=0.5)


# Other programs.

def test_points_and_cells_are_x_y_z():
    contour = tegl.contour(ball(3, 11), 0.0, spacing=(1, 2, 3))
    points, cells = contour.points_and_cells()
    assert cells[0][0] == "triangle" and np.array_equal(points, contour.vertices[:, ::-1])
    assert signed_content(points, cells[0][1]) == pytest.approx(contour.measure().content, rel=1e-5)
    assert tegl.contour(ball(4), 0.0).points_and_cells()[1][0][0] == "tetra"
    assert tegl.contour(ball(2), 0.0).points_and_cells()[1][0][0] == "line"


@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_meshio(ndim):
    pytest.importorskip("meshio")
    contour = tegl.contour(ball(ndim, 9), 0.0, normals=True)
    mesh = contour.to_meshio()
    assert mesh.points.shape == (len(contour.vertices), 3)
    assert len(mesh.cells[0].data) == len(contour.simplices)
    if ndim == 4:
        assert np.array_equal(mesh.point_data["t"], contour.vertices[:, 0])
    assert mesh.point_data["Normals"].shape[1] == max(ndim, 3)


@pytest.mark.parametrize("ndim", [2, 3, 4])
def test_vtk(ndim):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    contour = tegl.contour(ball(ndim, 9), 0.0, normals=True).simplify(ratio=0.5) if ndim > 2 else \
        tegl.contour(ball(ndim, 9), 0.0, normals=True)
    mesh = contour.to_vtk()
    assert mesh.GetNumberOfCells() == len(contour.simplices) and mesh.GetNumberOfPoints() == len(contour.vertices)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    assert np.array_equal(points[:, :min(ndim, 3)], contour.vertices[:, ::-1][:, :3])
    ids = mesh.GetCell(3).GetPointIds()
    assert [ids.GetId(corner) for corner in range(ndim)] == contour.simplices[3, ::-1].tolist()
    data = mesh.GetPointData()
    if ndim == 4:
        assert np.array_equal(vtk_to_numpy(data.GetArray("t")), contour.vertices[:, 0])
    if ndim > 2:
        assert np.array_equal(vtk_to_numpy(data.GetArray("simplification_error")),
                              contour.vertex_attributes["simplification_error"])
    assert data.GetArray("Normals").GetNumberOfTuples() == len(contour.vertices)


def test_volume_by_vtk_is_ours():
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkFiltersCore import vtkMassProperties
    contour = tegl.contour(ball(3, 21), 0.0)
    mass = vtkMassProperties()
    mass.SetInputData(contour.to_vtk())
    assert mass.GetVolume() == pytest.approx(contour.measure().content, rel=1e-3)
    assert mass.GetSurfaceArea() == pytest.approx(contour.measure().size, rel=1e-5)


@pytest.mark.parametrize("module, method", [("pyvista", "to_pyvista"), ("meshio", "to_meshio"),
                                            ("vtkmodules.vtkCommonDataModel", "to_vtk")])
def test_what_is_not_installed_is_named(module, method, monkeypatch):
    import sys
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=f"{method} needs"):
        getattr(tegl.contour(ball(3), 0.0), method)()


def test_pyvista_gets_what_vtk_gets(monkeypatch):
    """pyvista wraps VTK's meshes; where it is not installed, something that does the same stands in."""
    import sys
    import types
    pytest.importorskip("vtkmodules")
    if "pyvista" not in sys.modules:
        try:
            import pyvista  # noqa: F401
        except ImportError:
            monkeypatch.setitem(sys.modules, "pyvista", types.SimpleNamespace(wrap=lambda mesh: mesh))
    mesh = tegl.contour(ball(3), 0.0).to_pyvista()
    assert mesh.GetNumberOfCells() == len(tegl.contour(ball(3), 0.0).simplices)


def test_a_progress_function_that_asks_for_another_file_is_refused(tmp_path):
    path = tmp_path / "c.ply"
    tegl.contour(noise((20, 20, 20), 1), 0.0).save(path)
    with pytest.raises(ValueError, match="reads or writes another file"):
        tegl.load(path, progress=lambda fraction: tegl.load(path))
    assert len(tegl.load(path).simplices) > 0


def test_who_waits_for_files_can_be_cancelled(tmp_path):
    path = tmp_path / "c.ply"
    tegl.contour(noise((20, 20, 20), 1), 0.0).save(path)
    waits, result = threading.Event(), []

    def hold(fraction):
        if not result:
            thread = threading.Thread(target=other)
            thread.start()
            assert waits.wait(20)
            thread.join(20)

    def other():
        def stop(fraction):
            waits.set()
            return False

        try:
            tegl.load(path, progress=stop)
        except tegl.Cancelled:
            result.append("cancelled")

    tegl.load(path, progress=hold)
    assert result == ["cancelled"]


def test_the_directions_of_axes_are_the_files(tmp_path):
    """As the terminal says them: depths and pressures grow downwards."""
    netcdf = pytest.importorskip("netCDF4")
    path = tmp_path / "column.nc"
    with netcdf.Dataset(path, "w") as file:
        for name, size in (("time", 2), ("depth", 3), ("level", 4), ("height", 5)):
            file.createDimension(name, size)
            file.createVariable(name, "f8", (name,))[:] = np.arange(size) + 1.0
        file["depth"].positive, file["depth"].units = "down", "m"
        file["level"].units = "millibar"
        file["height"].positive, file["height"].units = "up", "m"
        file["time"].units = "s"
        file.createVariable("temp", "f4", ("time", "depth", "level", "height"))[:] = noise((2, 3, 4, 5), 1)
    image = tegl.read(path)
    assert image.axis_names == ("time", "depth", "level", "height")
    assert image.axis_directions == ("unknown", "down", "down", "up")
    assert tegl.read(path, time_axis=-1).axis_directions == ("up", "down", "down", "unknown")
    assert tegl.read(OCEAN).axis_directions == tegl.read(OCEAN, time_axis=-1).axis_directions[::-1]
    if PROGRAM.exists():
        told = subprocess.run([PROGRAM, "info", path, "--json"], capture_output=True, text=True, check=True).stdout
        said = [axis["direction"] or "unknown" for axis in json.loads(told)["axes"]]
        assert tuple(said) == image.axis_directions[::-1]
    if importlib.util.find_spec("xarray"):
        data = image.to_xarray()
        assert [data[name].attrs.get("positive") for name in data.dims] == [None, "down", "down", "up"]


def test_formats_without_directions_do_not_know_them(tmp_path):
    path = tmp_path / "a.nrrd"
    path.write_bytes(b"NRRD0004\ntype: uchar\nencoding: raw\ndimension: 3\nsizes: 2 2 2\n\n" + bytes(8))
    assert tegl.read(path).axis_directions == ("unknown",) * 3


def test_a_separate_process_gives_the_same_contour(tmp_path):
    contour = tegl.contour(noise((12, 40, 40), 1), 0.5)
    path = tmp_path / "a.vtkhdf"
    contour.save(path)
    assert_same(tegl.load(path, separate_process=True), tegl.load(path))
    assert_same(tegl.Contour.load(path, separate_process=True), tegl.load(path))


def write_hdf5(path, array):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.create_dataset("v", data=array, chunks=(1, *array.shape[1:]), compression="gzip", compression_opts=1)


def test_a_separate_process_gives_the_same_array(tmp_path):
    array = noise((60, 90, 120), 2).astype(np.float32)
    write_hdf5(tmp_path / "a.nc", array)
    image = tegl.read(tmp_path / "a.nc", separate_process=True)
    assert np.array_equal(image.array, array) and not image.array.flags.owndata
    image.array[...] += 1
    assert np.array_equal(image.array, array + 1)
    seen = []
    tegl.read(tmp_path / "a.nc", separate_process=True, progress=lambda share: seen.append(share))
    assert seen == sorted(seen) and seen[-1] == 1
    with pytest.raises(tegl.Cancelled):
        tegl.read(tmp_path / "a.nc", separate_process=True, progress=lambda share: False)


def test_separate_processes_under_threads(tmp_path):
    array = noise((20, 30, 40), 3).astype(np.float32)
    write_hdf5(tmp_path / "a.nc", array)
    wrong = []

    def work():
        for _ in range(20):
            image = tegl.read(tmp_path / "a.nc", separate_process=True)
            if not np.array_equal(image.array, array) or not len(tegl.contour(image, 0.5).vertices):
                wrong.append(image)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.parametrize("name", ["n4_byte_0x1545.nc", "chunk.nc", "seq_10000.dcm", "vtkhdf_sig11_2_149.vtkhdf",
                                  "vtkhdf_sig11_2_330.vtkhdf", "vtkhdf_sig14_rss_1_899.vtkhdf"])
def test_what_brings_a_library_down_is_a_value_error(name):
    path = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]).parent / "shared/data/hostile" / name
    if not path.exists():
        pytest.skip(f"no {path}")
    with pytest.raises(ValueError, match=name):
        (tegl.load if name.endswith(".vtkhdf") else tegl.read)(path, separate_process=True)


def crystal(monkeypatch, name=None):
    """The variables of examples/python/crystal.py, run on a real file or else on its model. It checks that contours are
    closed, and that data from another start have the same ones."""
    script = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]) / "examples/python/crystal.py"
    path = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]).parent / f"shared/data/lattice/{name}"
    if name and not path.exists():
        pytest.skip(f"no {path}")
    monkeypatch.setattr(sys, "argv", [str(script)] + ([str(path)] if name else []))
    return runpy.run_path(str(script))


def test_the_head_of_a_density_in_a_crystal_has_several_forms(monkeypatch):
    of = crystal(monkeypatch)
    text, volume = of["model_chgcar"](12), 3.9**3 / 4
    values, vectors = of["read_chgcar"](text)
    assert np.linalg.det(vectors) == pytest.approx(volume) and values.mean() * volume == pytest.approx(4)
    old = text.replace("Si\n", "")  # without the symbols of the atoms
    more = text + "augmentation occupancies 1 2\n 0.1 0.2\n\n 12 12 12\n 1 2 3\n"
    for same in (old, more, text.replace("\n1.0\n", f"\n-{volume}\n")):
        for found, expected in zip(of["read_chgcar"](same), (values, vectors)):
            np.testing.assert_allclose(found, expected)
    larger = of["read_chgcar"](text.replace("\n1.0\n", "\n2.0\n"))
    np.testing.assert_allclose(larger[1], 2 * vectors)
    np.testing.assert_allclose(larger[0], values / 8)


def test_a_density_in_a_crystal_is_closed_on_the_cubic_grid_and_on_fcc(monkeypatch, capsys):
    of = crystal(monkeypatch, "CHGCAR_Si_fcc.vasp")
    assert "28 x 28 x 28 samples, a cell of the volume 14.83" in capsys.readouterr().out
    density, vectors, n = of["values"], of["vectors"], 28
    assert density.mean() * of["volume"] == pytest.approx(4, abs=1e-4)  # valence electrons of an atom
    # The samples along the primitive vectors are a lattice fcc, whose axes are (1, 1, 0), (1, -1, 0) and (0, 0, 1). A box of
    # 56 layers repeats itself, and has two primitive cells.
    k, y, x = np.meshgrid(np.arange(2 * n), np.arange(n), np.arange(n), indexing="ij")
    a, b, c = x + (k % 2 - k) // 2, (k - k % 2) // 2 - y, y + (k % 2 + k) // 2
    layers, layer = density[a % n, b % n, c % n], vectors[0, 0] / n
    for share, euler in ((0.2, -8), (0.5, -8), (0.7, 4), (0.9, 4)):
        level = np.quantile(density, share)
        cell = of["surface_of"](density, level)
        box = tegl.contour(layers, level, periodic="all", lattice="fcc", spacing=[layer, 2**0.5 * layer, 2**0.5 * layer],
                           dtype=float)
        for contour, count in ((cell, 1), (box, 2)):
            report = contour.check()
            assert report.is_closed and report.is_manifold and report.euler == count * euler
        assert box.measure().size == pytest.approx(2 * cell.measure().size, rel=0.01)
        content = cell.measure().content  # of as large a share of the cell as of the samples, unless it winds round
        assert (content is None) == (euler == -8)
        assert content is None or content == pytest.approx((1 - share) * of["volume"], rel=0.12)


def test_fermi_surfaces_of_a_crystal_are_closed(monkeypatch):
    of = crystal(monkeypatch, "RhBulkFcc.bxsf.gz")
    text = of["text"].split("BAND:  6")[1].split()
    assert np.array(text[:32**3], dtype=float).reshape([32] * 3)[:-1, :-1, :-1].tolist() == of["bands"][0].tolist()
    reports = [of["surface_of"](*field).check() for field in of["fields"]]
    assert all(report.is_closed and report.is_manifold for report in reports)
    assert [(report.components, report.euler) for report in reports] == [(3, 6), (7, 14), (1, 2)]


def test_a_crystal_without_a_fermi_surface_has_a_message(monkeypatch, tmp_path):
    script = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]) / "examples/python/crystal.py"
    path = tmp_path / "insulator.bxsf"
    bands = "".join(f"BAND: {number} " + " ".join([f"{low}", f"{low + 1}"] * 32) + "\n" for number, low in ((1, -3), (2, 4)))
    path.write_text("BEGIN_INFO\nFermi Energy: 0.5\nEND_INFO\nBEGIN_BLOCK_BANDGRID_3D\nbands\nBEGIN_BANDGRID_3D_BANDS\n2\n4 4 4\n0 0 0\n"
                    f"1 0 0\n0 1 0\n0 0 1\n{bands}END_BANDGRID_3D\n")
    monkeypatch.setattr(sys, "argv", [str(script), str(path)])
    with pytest.raises(SystemExit, match="insulator.bxsf: none of the 2 bands has the Fermi energy 0.5 between its energies"):
        runpy.run_path(str(script))
