# SPDX-License-Identifier: BSD-3-Clause
"""Several files as one image, and folders of DICOM: what `tegl contour` on the terminal makes of them."""

import os
import pathlib
import subprocess

import numpy as np
import pytest
import tegl
from conftest import assert_same, noise

PROGRAM = pathlib.Path(os.environ["TEGL_BUILD_DIR"]) / "bin/tegl"
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason="the program tegl is not built")


def write_nrrd(path, array, *lines):
    sizes = " ".join(str(size) for size in array.shape[::-1])
    header = ["NRRD0004", "type: float", "encoding: raw", "endian: little", f"dimension: {array.ndim}", f"sizes: {sizes}",
              *lines]
    path.write_bytes("\n".join(header).encode() + b"\n\n" + array.astype("<f4").tobytes())
    return path


def write_steps(folder, numbers, values, *lines):
    """step_1.nrrd, step_10.nrrd, ...: sheet k of the values in the file of number k."""
    return [write_nrrd(folder / f"step_{number}.nrrd", values[k], *lines) for k, number in enumerate(numbers)]


def by_the_program(tmp_path, files, *options):
    """(contour, exit code, error) of `tegl contour`."""
    path = tmp_path / "program.vtkhdf"
    done = subprocess.run([PROGRAM, "contour", *files, "--iso", "0.1", "-o", path, "--quiet", *options],
                          capture_output=True, text=True, check=False)
    return (tegl.load(path) if done.returncode == 0 else None), done.returncode, done.stderr


def assert_as_the_program(tmp_path, image, files, *options):
    theirs, code, error = by_the_program(tmp_path, files, *options)
    assert code == 0, error
    mine = image.contour(0.1, dtype=np.float64)
    assert len(mine.simplices) > 50
    assert_same(mine, theirs)
    assert mine.axis_names == theirs.axis_names and mine.axis_units == theirs.axis_units


SPACINGS = ("spacings: 0.5 1 2", 'units: "mm" "mm" "mm"')


@needs_program
@pytest.mark.parametrize("shape, lines", [((3, 4, 5, 6), SPACINGS), ((3, 5, 6), ())], ids=["volumes", "slices"])
@pytest.mark.parametrize("options, arguments", [
    (["--sort", "name"], {"sort": "name"}),
    (["--sort", "given", "--times", "0,0.5,2"], {"sort": "given", "times": [0, 0.5, 2]}),
    (["--sort", "name", "--times", "9,2,5"], {"sort": "name", "times": np.array([9, 2, 5])}),
    (["--sort", "time", "--times", "3,1,9"], {"sort": "time", "times": (3, 1, 9)}),
    (["--sort", "name", "--time-step", "-0.25", "--time-unit", "s"],
     {"sort": "name", "time_step": -0.25, "time_unit": "s"}),
])
def test_a_series_is_the_terminals(shape, lines, options, arguments, tmp_path):
    files = write_steps(tmp_path, (1, 10, 2), noise(shape, 3), *lines)
    assert_as_the_program(tmp_path, tegl.read(files, **arguments), files, *options)


def test_a_series_has_its_files_along_the_first_axis(tmp_path):
    values = noise((3, 4, 5, 6), 7)
    files = write_steps(tmp_path, (1, 10, 2), values, *SPACINGS)
    image = tegl.read(files, sort="name", time_step=0.5, time_unit="s")
    assert image.array.shape == (3, 4, 5, 6) and np.array_equal(image.array, values[[0, 2, 1]])
    assert image.axis_names[0] == "t" and image.axis_units == ("s", "mm", "mm", "mm") and image.time_axis == 0
    assert [list(axis) for axis in image.coords][:2] == [[0, 0.5, 1], [0, 2, 4, 6]]
    assert_same(tegl.contour(image, 0.1), tegl.contour(image.array, 0.1, coords=image.coords))
    tuple_of_text = tegl.read(tuple(map(str, files)), sort="name", time_step=0.5, time_unit="s", time_axis=-1)
    assert np.array_equal(tuple_of_text.array.T, image.array) and tuple_of_text.time_axis == 3
    assert np.array_equal(tegl.read(files[:1]).array, tegl.read(files[0]).array), "a list of one is that file"
    dates = tegl.read(files, sort="given", times=["2020-01-01", np.datetime64("2020-01-03"), 4.5],
                      time_unit="days since 2020-01-01")
    assert list(dates.coords[0]) == [0, 2, 4.5]


@needs_program
def test_headers_say_when_files_are(tmp_path):
    files = [write_nrrd(tmp_path / f"s{k}.nrrd", noise((1, 4, 5, 6), k), f"axis mins: 0 0 0 {time}",
                        'units: "mm" "mm" "mm" "s"', 'labels: "x" "y" "z" "time"')
             for k, time in enumerate((7, 2, 4))]
    image = tegl.read(files, sort="time")
    assert image.axis_names[0] == "time" and list(image.coords[0]) == [2, 4, 7] and image.axis_units[0] == "s"
    assert_as_the_program(tmp_path, image, files, "--sort", "time")
    with pytest.raises(ValueError, match=r"s2.nrrd: lies at 4 along the new axis by its header, after .*s1.nrrd at 2"):
        tegl.read(files)


def words_of_python(text):
    """An error of the program as it is in Python."""
    for there, here in (("--sort name", "sort='name'"), ("--sort time", "sort='time'"), ("--sort given", "sort='given'"),
                        ("--times", "times"), ("--time-step", "time_step"), ("--time-unit", "time_unit"),
                        ("--sort", "sort"), ("--var", "variable="), ("--series", "series=")):
        text = text.replace(there, here)
    return text


@needs_program
@pytest.mark.parametrize("numbers, options, arguments", [
    ((1, 10, 2), [], {}),
    ((1, 2), ["--times", "1,2,3"], {"times": (1, 2, 3)}),
    ((1, 2), ["--times", "1,1"], {"times": (1, 1)}),
    ((1, 2), ["--times", "1,2", "--time-step", "2"], {"times": (1, 2), "time_step": 2}),
    ((1, 10, 2), ["--times", "1,2,3", "--sort", "name"], {"times": (1, 2, 3), "sort": "name"}),
    ((1, 2), ["--time-step", "3", "--sort", "time"], {"time_step": 3, "sort": "time"}),
    ((1, 2), ["--time-step", "0"], {"time_step": 0}),
    ((1, 2), ["--sort", "time"], {"sort": "time"}),
    ((1,), ["--times", "1"], {"times": [1]}),
    ((1,), ["--time-step", "1"], {"time_step": 1}),
    ((1,), ["--time-unit", "s"], {"time_unit": "s"}),
    ((1,), ["--sort", "name"], {"sort": "name"}),
    ((1, 2), ["--var", "temp"], {"variable": "temp"}),
])
def test_what_is_refused_is_refused_in_the_terminals_words(numbers, options, arguments, tmp_path):
    files = write_steps(tmp_path, numbers, noise((3, 4, 5, 6), 3))
    _, code, error = by_the_program(tmp_path, files, *options)
    assert code != 0
    with pytest.raises(ValueError) as raised:
        tegl.read(files, **arguments)
    said = words_of_python(error).strip().removeprefix("tegl: ").removeprefix("error: ")
    assert str(raised.value) in said and len(str(raised.value)) > len(said) - 12, said


def test_files_that_do_not_fit_together_are_named(tmp_path):
    files = write_steps(tmp_path, (1, 2), noise((2, 4, 5, 6), 3))
    files.append(write_nrrd(tmp_path / "step_3.nrrd", noise((4, 5, 7), 3)))
    with pytest.raises(ValueError, match=r"step_3.nrrd: has 7 x 5 x 4 samples; expected 6 x 5 x 4, as .*step_1.nrrd"):
        tegl.read(files)
    with pytest.raises(FileNotFoundError, match="step_9.nrrd"):
        tegl.read([*files[:2], tmp_path / "step_9.nrrd"])
    with pytest.raises(ValueError, match="no files; expected at least one"):
        tegl.read([])


@pytest.mark.parametrize("arguments, text", [
    (({"a"},), "path is {'a'}; expected a path, or a list of them"), ((3,), "path is 3; expected a path"),
    ((["a.nrrd", 3],), "path is 3; expected a path"), (("a.nc", 3), "variable is 3; expected text")])
def test_what_is_no_path_is_a_type_error(arguments, text):
    with pytest.raises(TypeError) as raised:
        tegl.read(*arguments)
    assert text in str(raised.value)


@pytest.mark.parametrize("arguments, text", [
    ({"times": 3}, "times is 3; expected a list of numbers, one for each of 2 files"),
    ({"times": ["a", 2]}, "the coordinate 'a' is neither a number nor a date; expected one of them"), ({"time_step": "a"}, "time_step is 'a'; expected a number"),
    ({"time_unit": 3}, "time_unit is 3; expected text"), ({"sort": 3}, "sort is 3; expected text"),
    ({"sort": "size"}, "sort is 'size'; expected one of 'given', 'name', 'time'"),
    ({"series": 3}, "series is 3; expected text"),
    ({"variable": "a", "series": "b"}, "variable is 'a' and series 'b'; expected one of the two")])
def test_arguments_of_a_series_are_named(arguments, text, tmp_path):
    files = write_steps(tmp_path, (1, 2), noise((2, 4, 5, 6), 3))
    with pytest.raises((TypeError, ValueError)) as raised:
        tegl.read(files, **arguments)
    assert text in str(raised.value)


def test_progress_is_over_all_files(tmp_path):
    files = write_steps(tmp_path, range(8), noise((8, 40, 40, 40), 3))
    told = []
    tegl.read(files, progress=told.append)
    assert told == sorted(told) and told[-1] == 1
    with pytest.raises(tegl.Cancelled):
        tegl.read(files, progress=lambda fraction: False)


# DICOM.


class Dicom:
    """Writes the slices of series into a folder, as pydicom does it."""

    def __init__(self, folder):
        self.pydicom = pytest.importorskip("pydicom")
        self.folder = folder
        folder.mkdir()

    def write(self, volume, description="scan", number=1, time=None):
        from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid
        uid = generate_uid(entropy_srcs=[description])
        for z in np.random.default_rng(1).permutation(len(volume)):
            meta = self.pydicom.dataset.FileMetaDataset()
            meta.MediaStorageSOPClassUID, meta.TransferSyntaxUID = CTImageStorage, ExplicitVRLittleEndian
            meta.MediaStorageSOPInstanceUID = generate_uid()
            name = self.folder / f"{description}_{time}_{(7 * z) % 100}.dcm"
            data = self.pydicom.dataset.FileDataset(str(name), {}, file_meta=meta, preamble=b"\0" * 128)
            data.is_little_endian, data.is_implicit_VR = True, False
            data.SOPClassUID, data.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
            data.SeriesInstanceUID, data.SeriesDescription, data.SeriesNumber = uid, description, number
            data.Modality, data.PhotometricInterpretation, data.SamplesPerPixel = "CT", "MONOCHROME2", 1
            data.ImagePositionPatient, data.ImageOrientationPatient = [-3, 4, 2.5 * z], [1, 0, 0, 0, 1, 0]
            data.PixelSpacing, (data.Rows, data.Columns) = [0.5, 0.75], volume.shape[1:]
            data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = 16, 16, 15, 1
            if time is not None:
                data.TemporalPositionIdentifier, data.NumberOfTemporalPositions = time + 1, 3
                data.TriggerTime = 100.0 * time
            data.PixelData = volume[z].astype("<i2").tobytes()
            data.save_as(name, write_like_original=False)
        return self


def scan(seed=1):
    return np.random.default_rng(seed).integers(-500, 500, size=(6, 7, 8)).astype(np.int16)


def dicom_or_skip(folder):
    try:
        return tegl.read(folder)
    except ValueError as error:
        if "expected a build with DCMTK" in str(error):
            pytest.skip(str(error))
        raise


@needs_program
def test_a_folder_of_dicom_is_the_terminals(tmp_path):
    Dicom(tmp_path / "scan").write(scan())
    image = dicom_or_skip(tmp_path / "scan")
    assert image.format == "DICOM" and image.world_frame == "LPS" and np.array_equal(image.array, scan())
    assert image.axis_units == ("mm",) * 3
    assert_as_the_program(tmp_path, image, [tmp_path / "scan"])
    files = sorted((tmp_path / "scan").iterdir())
    listed = tegl.read(files)
    assert np.array_equal(listed.array, scan()), "files that say where they lie come in any order"
    assert_same(listed.contour(0.1), image.contour(0.1))
    with pytest.raises(ValueError, match="is a DICOM file, which contains its position"):
        tegl.read(files, time_step=2)


@needs_program
def test_dicom_over_time_is_4d(tmp_path):
    folder = Dicom(tmp_path / "scan")
    for time in range(3):
        folder.write(scan(time), time=time)
    image = dicom_or_skip(tmp_path / "scan")
    assert np.array_equal(image.array, [scan(0), scan(1), scan(2)]) and image.time_axis == 0
    assert_as_the_program(tmp_path, image, [tmp_path / "scan"])


@needs_program
def test_of_several_series_one_is_chosen(tmp_path):
    Dicom(tmp_path / "scan").write(scan(1), "T1", 4).write(scan(2), "T2", 5)
    with pytest.raises(ValueError) as raised:
        dicom_or_skip(tmp_path / "scan")
    _, code, error = by_the_program(tmp_path, [tmp_path / "scan"])
    assert code != 0 and str(raised.value) in words_of_python(error)
    assert "T1" in str(raised.value) and "(choose it with series=)" in str(raised.value)
    image = tegl.read(tmp_path / "scan", series="T2")
    assert np.array_equal(image.array, scan(2))
    assert_as_the_program(tmp_path, image, [tmp_path / "scan"], "--series", "T2")
    with pytest.raises(ValueError, match="T3"):
        tegl.read(tmp_path / "scan", series="T3")


def test_a_folder_without_dicom_is_said(tmp_path):
    with pytest.raises(FileNotFoundError, match="is a directory without DICOM files"):
        dicom_or_skip(tmp_path)
