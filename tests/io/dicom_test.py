#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM as tegl reads it, held against pydicom: dicom_test.py DUMP_IMAGE

Writes small series with pydicom, names shuffled; asks tests/io/dump_image for the image; and looks up each of its planes
in the files by place and time, as pydicom has them. Exit status 77 where there is no pydicom.
"""

import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import pydicom
    import pydicom.encaps
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.sequence import Sequence
    from pydicom.uid import CTImageStorage, EnhancedMRImageStorage, ExplicitVRLittleEndian, generate_uid
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

DUMP = sys.argv.pop(1)
OBLIQUE = [0.8, 0.6, 0.0, -0.36, 0.48, 0.8]


def dump(*paths, series="", how="whole"):
    run = subprocess.run([DUMP, series, how, *map(str, paths)], capture_output=True, text=True)
    # Nothing is printed, whatever a file has, and a child process gives the same.
    assert run.returncode == 0 and run.stderr == "", f"exit {run.returncode}: {run.stderr}"
    return json.loads(run.stdout)


def header(path, sop_class=CTImageStorage):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = sop_class
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data = FileDataset(str(path), {}, file_meta=meta, preamble=b"\0" * 128)
    data.SOPClassUID = sop_class
    data.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    data.is_little_endian, data.is_implicit_VR = True, False
    data.PhotometricInterpretation = "MONOCHROME2"
    data.SamplesPerPixel = 1
    return data


def put_pixels(data, values, bits_stored=None):
    bits = values.dtype.itemsize * 8
    data.Rows, data.Columns = values.shape[-2:]
    data.BitsAllocated = bits
    data.BitsStored = bits_stored or bits
    data.HighBit = data.BitsStored - 1
    data.PixelRepresentation = int(values.dtype.kind == "i")
    stored = values
    if bits_stored:  # what is above the stored bits is anyone's
        mask = (1 << bits_stored) - 1
        stored = (values.astype(np.int64) & mask).astype(np.uint16)
    data.PixelData = stored.tobytes()


class Writer:
    """One series in a folder."""

    def __init__(self, folder, seed=1, number=1, description="series", uid=None, modality="CT"):
        self.folder, self.number, self.description = pathlib.Path(folder), number, description
        self.uid, self.modality = uid or generate_uid(), modality
        self.random = random.Random(seed)
        self.numbers = np.random.default_rng(seed)

    def plane(self, values, position, iop=(1, 0, 0, 0, 1, 0), spacing=(0.5, 0.7), name=None, **tags):
        name = name or f"{self.random.randrange(10**9)}.dcm"  # in no order
        data = header(self.folder / name)
        data.SeriesInstanceUID, data.SeriesNumber = self.uid, self.number
        data.SeriesDescription, data.Modality = self.description, self.modality
        data.PixelSpacing, data.ImageOrientationPatient = list(spacing), list(iop)
        data.ImagePositionPatient = [float(f"{x:.6f}") for x in position]
        bits_stored = tags.pop("BitsStored", None)
        for tag, value in tags.items():
            setattr(data, tag, value)
        put_pixels(data, values, bits_stored)
        data.save_as(self.folder / name, write_like_original=False)
        return self.folder / name

    def volume(self, planes=5, dtype=np.int16, iop=(1, 0, 0, 0, 1, 0), step=2.5, skip=(), low=-1000, high=2000,
               shape=(4, 6), shear=(0, 0, 0), along=None, **tags):
        row, column = np.array(iop[:3]), np.array(iop[3:])
        normal = np.cross(row, column)
        along = along or [k * step for k in range(planes)]  # where each plane lies
        order = [k for k in range(len(along)) if k not in skip]
        self.random.shuffle(order)
        for k in order:
            values = self.numbers.integers(low, high, size=shape).astype(dtype)
            position = np.array([10, -20, 30]) + along[k] * (normal + np.array(shear) / step)
            own = {tag: value(k) if callable(value) else value for tag, value in tags.items()}
            self.plane(values, position, iop, InstanceNumber=self.random.randrange(1000), **own)


def files_of(folder):
    return [path for path in pathlib.Path(folder).rglob("*") if path.is_file() and path.name != "DICOMDIR"]


class Dicom(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.kept.name)
        self.addCleanup(self.kept.cleanup)

    def position(self, image, index):
        at = np.array([axis["at"][i] for axis, i in zip(image["axes"], index)])
        return np.array(image["linear"]) @ at + np.array(image["offset"])

    def assert_volume(self, image, time=None, files=None):
        """Every plane of the image is that of the file that lies there, and every sample where that says."""
        sizes = [len(axis["at"]) for axis in image["axes"]]
        values = np.array(image["values"]).reshape(sizes[::-1])
        found = 0
        for path in files or files_of(self.folder):
            data = pydicom.dcmread(path)
            k = time(data) if time else 0
            volume = values[k] if time else values
            slope, intercept = float(data.get("RescaleSlope", 1)), float(data.get("RescaleIntercept", 0))
            stored = data.pixel_array.astype(np.int64)
            if data.PixelRepresentation == 1:  # pydicom leaves the bits above those stored to its user
                stored = (stored + (1 << data.HighBit)) % (1 << data.BitsStored) - (1 << data.HighBit)
            expected = stored * slope + intercept
            origin = np.array(data.ImagePositionPatient, dtype=float)
            row = np.array(data.ImageOrientationPatient[:3], dtype=float) * float(data.PixelSpacing[1])
            column = np.array(data.ImageOrientationPatient[3:], dtype=float) * float(data.PixelSpacing[0])
            for z in range(sizes[2]):
                index = (0, 0, z, k) if time else (0, 0, z)
                if np.linalg.norm(self.position(image, index)[:3] - origin) > 1e-4:
                    continue
                found += 1
                np.testing.assert_allclose(volume[z], expected, rtol=1e-6)
                for x, y in ((sizes[0] - 1, 0), (0, sizes[1] - 1), (2, 3)):
                    index = (x, y, z, k) if time else (x, y, z)
                    np.testing.assert_allclose(self.position(image, index)[:3], origin + x * row + y * column,
                                               atol=1e-4)
        self.assertEqual(found, sizes[2] * (sizes[3] if time else 1))

    def assert_refused(self, code, *parts, paths=None, **options):
        for how in ("whole", "layers"):
            result = dump(*(paths or [self.folder]), how=how, **options)
            self.assertEqual(result.get("error"), code, result.get("message", "no error"))
            for part in parts:
                self.assertIn(part, result["message"])

    def assert_both_ways(self, *paths, **options):
        """Whole and by layers: the same image, which is returned."""
        image = dump(*(paths or [self.folder]), **options)
        self.assertNotIn("error", image, image.get("message"))
        self.assertEqual(image, dump(*(paths or [self.folder]), how="layers", **options))
        return image

    def test_slices_are_sorted_along_the_normal_whatever_their_names(self):
        for number, iop in enumerate([(1, 0, 0, 0, 1, 0), OBLIQUE, (0, 1, 0, 0, 0, -1)]):
            folder = self.folder / str(number)
            folder.mkdir()
            Writer(folder, seed=number).volume(iop=iop)
            image = self.assert_both_ways(folder)
            self.assertEqual([len(axis["at"]) for axis in image["axes"]], [6, 4, 5])
            self.assertEqual(image["frame"], "LPS")
            self.assertEqual([axis["unit"] for axis in image["axes"]], ["mm"] * 3)
            self.assertEqual(image["type"], "int16")
            self.assertGreater(np.linalg.det(np.array(image["linear"])), 0)
            self.assert_volume(image, files=files_of(folder))

    def test_a_list_of_files_is_a_folder_of_them(self):
        Writer(self.folder).volume()
        files = files_of(self.folder)
        random.Random(5).shuffle(files)
        self.assertEqual(self.assert_both_ways(*files), self.assert_both_ways())

    def test_stored_values_of_all_kinds(self):
        for number, (dtype, bits, low, high) in enumerate([(np.uint8, None, 0, 255), (np.int8, None, -128, 127),
                                                           (np.uint16, None, 0, 65535), (np.int16, 12, -2048, 2047),
                                                           (np.uint16, 12, 0, 4095), (np.int32, None, -10**9, 10**9),
                                                           (np.uint32, None, 0, 2 * 10**9)]):
            with self.subTest(dtype=dtype, bits=bits):
                folder = self.folder / str(number)
                folder.mkdir()
                tags = {"BitsStored": bits} if bits else {}
                Writer(folder, seed=number).volume(dtype=dtype, low=low, high=high, **tags)
                image = dump(folder)
                self.assertEqual(image.get("type"), "int32" if dtype == np.uint32 else np.dtype(dtype).name, image)
                self.assert_volume(image, files=files_of(folder))

    def test_slope_and_intercept(self):
        cases = [((1, -1024), np.uint16, 12, "int16"), ((2, 0), np.int16, 16, "int32"), ((0.5, 3), np.int16, 16, "float32"),
                 ((0.25, 0), np.int32, 32, "float64")]
        for number, ((slope, intercept), dtype, bits, expected) in enumerate(cases):
            with self.subTest(slope=slope, dtype=dtype):
                folder = self.folder / str(number)
                folder.mkdir()
                tags = {"BitsStored": bits} if bits < 16 else {}
                Writer(folder, seed=number).volume(dtype=dtype, low=0, high=2000, RescaleSlope=slope,
                                                   RescaleIntercept=intercept, RescaleType="HU", **tags)
                image = self.assert_both_ways(folder)
                self.assertEqual(image["type"], expected)
                self.assertEqual(image["value_unit"], "HU")
                self.assert_volume(image, files=files_of(folder))

    def test_stored_integers_have_the_values_of_the_image(self):
        cases = [((0.5, 3), np.int16, None, "int16"), ((-0.3, 7.1), np.uint16, 12, "uint16"), ((2, 0), np.int16, None, "int16"),
                 ((-2, 1), np.uint8, None, "uint8"), ((0.25, 0), np.int32, None, "int32"),
                 ((1, -1024), np.uint16, 12, None), ((1e-3, 1e5), np.int16, None, None), ((1, 0), np.int16, None, None)]
        for number, ((slope, intercept), dtype, bits, kept) in enumerate(cases):
            with self.subTest(slope=slope, dtype=dtype):
                folder = self.folder / str(number)
                folder.mkdir()
                tags = {"BitsStored": bits} if bits else {}
                Writer(folder, seed=number).volume(dtype=dtype, low=0, high=250, RescaleSlope=slope,
                                                   RescaleIntercept=intercept, **tags)
                image = dump(folder)
                for paths in ([folder], files_of(folder)):
                    stored = dump(*paths, how="stored")
                    self.assertEqual(stored.pop("kept"), kept is not None)
                    self.assertEqual(stored["type"], kept or image["type"])
                    self.assertEqual({**stored, "type": image["type"]}, image)

    def test_integers_of_slices_with_different_slopes_are_not_kept(self):
        Writer(self.folder).volume(dtype=np.uint16, low=0, high=900, RescaleIntercept=0,
                                   RescaleSlope=lambda k: 0.5 + 0.25 * k)
        stored = dump(self.folder, how="stored")
        self.assertFalse(stored.pop("kept"))
        self.assertEqual(stored, dump(self.folder))

    def test_every_slice_has_its_own_slope(self):
        Writer(self.folder, modality="PT").volume(dtype=np.uint16, low=0, high=9000, RescaleIntercept=0,
                                                  RescaleSlope=lambda k: 0.5 + 0.25 * k)
        image = self.assert_both_ways()
        self.assertEqual(image["type"], "float32")
        self.assert_volume(image)

    def test_a_tilted_gantry_shears(self):
        Writer(self.folder).volume(shear=(0, 0.9, 0))
        self.assert_volume(self.assert_both_ways())

    def test_a_missing_slice_is_told_of(self):
        for number, skip in enumerate([(3,), (1,), (5,), (3, 4), (2, 4), (3, 5, 6), (4, 9, 10, 11)]):
            with self.subTest(skip):
                folder = self.folder / str(number)
                folder.mkdir()
                Writer(folder).volume(planes=14, skip=skip, iop=OBLIQUE if number % 2 else (1, 0, 0, 0, 1, 0))
                self.assert_refused("UnsupportedData", "mm from", "2.5 mm apart", "missing", str(folder), paths=[folder])

    def test_slices_at_uneven_distances_are_taken_where_they_lie(self):
        cases = {"protocol": [0, 5, 10, 15, 20, 30, 40, 50, 60], "drifting": [0, 1, 2.1, 3.3, 4.6, 6, 7.5, 9.1],
                 "random": [0, 1.2, 2.1, 3.3, 4.2, 5.3, 6.3, 7.4], "hardly": [0, 1, 2, 3, 4.05, 5.05, 6.05, 7.05]}
        for name, along in cases.items():
            for number, (iop, shear) in enumerate([((1, 0, 0, 0, 1, 0), (0, 0, 0)), ((1, 0, 0, 0, -1, 0), (0, 0, 0)),
                                                   (OBLIQUE, (0, 0, 0)), (OBLIQUE, (0.2, 0.9, 0))]):
                with self.subTest(name, iop=iop, shear=shear):
                    folder = self.folder / f"{name}{number}"
                    folder.mkdir()
                    Writer(folder, seed=number).volume(along=along, iop=iop, shear=shear)
                    image = self.assert_both_ways(folder)
                    self.assert_volume(image, files=files_of(folder))
                    at = np.array(image["axes"][2]["at"])
                    stretch = np.linalg.norm(np.cross(iop[:3], iop[3:]) + np.array(shear) / 2.5)
                    np.testing.assert_allclose(np.abs(at - at[0]), np.array(along) * stretch, atol=1e-4)
                    self.assertEqual(len(image["remarks"]), 1)
                    self.assertIn("uneven distances", image["remarks"][0])

    def test_places_that_are_even_but_for_their_last_digits_are_even(self):
        Writer(self.folder).volume(along=[0, 1.01, 1.99, 3, 4.01])
        image = self.assert_both_ways()
        np.testing.assert_allclose(np.diff(image["axes"][2]["at"]), 1.0025, rtol=1e-9)
        self.assertEqual(image["remarks"], [])

    def test_slices_beside_a_straight_line_are_refused(self):
        writer = Writer(self.folder)
        for k in range(5):
            writer.plane(np.zeros((4, 5), dtype=np.uint8), (0.3 * k * k, 0, 2 * k))
        self.assert_refused("UnsupportedData", "away from the line", "straight line")
        for path in files_of(self.folder):
            path.unlink()
        for t in range(2):  # on a line each, but not on the same one
            for k in range(4):
                writer.plane(np.zeros((4, 5), dtype=np.uint8), (3 * t, 0, 2 * k), TriggerTime=30 * t)
        self.assert_refused("UnsupportedData", "lies 3 mm away from the line")

    def test_what_is_no_dicom_is_left_out_of_a_folder_and_said(self):
        Writer(self.folder).volume()
        plain = self.assert_both_ways()
        self.assertEqual(plain.pop("remarks"), [])
        scan = files_of(self.folder)
        strangers = {"notes.dcm": b"Dear colleague,\nthese are the slices that we spoke of.\n" * 20, "empty.dcm": b"",
                     "zeros.dcm": bytes(1000), "page.dcm": b"<html><body>404 Not Found</body></html>",
                     "noise.dcm": np.random.default_rng(1).bytes(5000),
                     "picture.dcm": b"\x89PNG\r\n\x1a\n" + bytes(300)}
        for name, content in strangers.items():
            path = self.folder / name
            path.write_bytes(content)
            with self.subTest(name):
                for paths in ([self.folder], [*scan, path]):
                    image = self.assert_both_ways(*paths)
                    self.assertEqual(len(image["remarks"]), 1)
                    self.assertIn(f"skipped: {path}", image.pop("remarks")[0])
                    self.assertEqual(image, plain)
                for how in ("whole", "layers"):  # by itself it is an error
                    self.assertIn(dump(path, how=how).get("error"), ("MalformedFile", "UnsupportedData"))
            path.unlink()
        for name, content in strangers.items():
            (self.folder / name).write_bytes(content)
        self.assertIn("empty.dcm and 5 more", self.assert_both_ways()["remarks"][0])
        for path in scan:
            path.unlink()
        self.assert_refused("UnsupportedData", "contains no DICOM image")

    def test_damaged_dicom_is_never_left_out(self):
        Writer(self.folder).volume(planes=6)
        last = max(files_of(self.folder), key=lambda path: pydicom.dcmread(path).ImagePositionPatient[2])
        whole = last.read_bytes()
        for content in (whole[:-20], whole[:300], whole[132:-20], whole[132:180]):  # without its preamble, too
            last.write_bytes(content)
            self.assert_refused("MalformedFile", last.name)

    def test_damage_is_of_its_series_alone(self):
        Writer(self.folder, seed=1, number=1, description="A", uid="1.2.3.1").volume(planes=5)
        whole = dump(self.folder)
        (self.folder / "b").mkdir()
        Writer(self.folder / "b", seed=2, number=2, description="B", uid="1.2.3.2").volume(planes=4)
        path = sorted(files_of(self.folder / "b"))[1]
        content = path.read_bytes()
        path.write_bytes(content[:-20])  # its header is there
        self.assertEqual(self.assert_both_ways(series="A"), whole)
        self.assert_refused("MalformedFile", path.name, series="B")
        self.assert_refused("VariableNotFound", "2 DICOM series", "'B', 4 slices")
        path.write_bytes(content[:300])  # nothing says which series it is of
        image = self.assert_both_ways(series="A")
        self.assertIn(path.name, image["remarks"][0])
        self.assertEqual(image["values"], whole["values"])
        for other in files_of(self.folder / "b"):
            if other != path:
                other.unlink()
        self.assert_refused("MalformedFile", path.name)  # it may be of the only one

    def test_series_of_colours_are_left_out_and_said(self):
        Writer(self.folder).volume(planes=3)
        for number in range(2):
            path = self.folder / f"z{number}.dcm"
            data = header(path)
            data.SeriesInstanceUID = "1.2.9"
            put_pixels(data, np.zeros((4, 5), dtype=np.uint8))
            data.SamplesPerPixel, data.PhotometricInterpretation, data.PlanarConfiguration = 3, "RGB", 0
            data.PixelData = bytes(60)
            data.save_as(path, write_like_original=False)
        image = self.assert_both_ways()
        self.assertIn("skipped, a series of 2 files", image["remarks"][0])
        self.assertIn("RGB", image["remarks"][0])

    def test_several_series_are_listed_and_chosen(self):
        Writer(self.folder, seed=1, number=7, description="bones", uid="1.2.3.7").volume(planes=4)
        (self.folder / "deeper").mkdir()
        Writer(self.folder / "deeper", seed=2, number=3, description="lungs", uid="1.2.3.3").volume(planes=6)
        self.assert_refused("VariableNotFound", "2 DICOM series", "1: 1.2.3.3 (CT, 'lungs', 6 slices)",
                            "2: 1.2.3.7 (CT, 'bones', 4 slices)")
        for series, planes in (("1.2.3.7", 4), ("bones", 4), ("2", 4), ("1", 6), ("1.2.3.3", 6)):
            self.assertEqual(len(self.assert_both_ways(series=series)["axes"][2]["at"]), planes)
        self.assert_refused("VariableNotFound", "no DICOM series '9'", "lungs", series="9")

    def test_descriptions_are_utf_8_whatever_they_were(self):
        cases = {"latin": ("ISO_IR 100", "Schädel"), "greek": ("ISO_IR 126", "κρανίο"), "utf": ("ISO_IR 192", "頭蓋骨")}
        for number, (name, (characters, text)) in enumerate(cases.items()):
            Writer(self.folder, seed=number, number=number, description=text, uid=f"1.2.{number}").volume(
                planes=2 + number, SpecificCharacterSet=characters)
        wrong = Writer(self.folder, seed=9, number=9, description="Schädel", uid="1.2.9")
        for k in range(9):
            path = wrong.plane(np.zeros((4, 6), dtype=np.uint8), (0, 0, k), SpecificCharacterSet="ISO_IR 100")
            path.write_bytes(path.read_bytes().replace(b"ISO_IR 100", b"ISO_IR 192"))  # which it is not
        for number, (_, text) in enumerate(list(cases.values())[1:]):
            self.assertEqual(len(self.assert_both_ways(series=text)["axes"][2]["at"]), 3 + number)
        self.assert_refused("VariableNotFound", "several DICOM series", "'Schädel', 2 slices", "'Schädel', 9 slices",
                            series="Schädel")

    def test_times_are_the_fourth_axis(self):
        cases = {
            "trigger": (lambda k, t: {"TriggerTime": 40.0 * t * t}, [0, 40, 160], "ms"),
            "temporal": (lambda k, t: {"TemporalPositionIdentifier": t + 1}, [1, 2, 3], ""),
            "acquisition": (lambda k, t: {"AcquisitionDate": "20240229" if t == 0 else "20240301",
                                          "AcquisitionTime": f"{['235950', '000010', '000100'][t]}.{25 * k:02d}"},
                            [0, 20, 70], "s"),
            "moment": (lambda k, t: {"AcquisitionDateTime": f"20231231235959.{t}"}, [0, 0.1, 0.2], "s"),
        }
        for name, (tags, times, unit) in cases.items():
            with self.subTest(name):
                folder = self.folder / name
                folder.mkdir()
                writer = Writer(folder, modality="MR")
                for t in (2, 0, 1):
                    for k in (1, 0, 2, 3):
                        writer.plane(writer.numbers.integers(0, 999, size=(4, 5)).astype(np.uint16), (0, 0, 3 * k),
                                     ReferencedFrameNumber=t, **tags(k, t))
                image = self.assert_both_ways(folder)
                self.assertEqual([len(axis["at"]) for axis in image["axes"]], [5, 4, 4, 3])
                np.testing.assert_allclose(image["axes"][3]["at"], times, atol=1e-6)
                self.assertEqual((image["axes"][3]["name"], image["axes"][3]["unit"]), ("t", unit))
                self.assert_volume(image, lambda data: data.ReferencedFrameNumber, files_of(folder))

    def test_one_place_over_time_is_a_3d_image(self):
        writer = Writer(self.folder)
        for t in (2, 0, 3, 1):
            writer.plane(np.full((4, 5), t, dtype=np.uint8), (0, 0, 7), TriggerTime=t * 30)
        image = self.assert_both_ways()
        self.assertEqual([axis["name"] for axis in image["axes"]], ["x", "y", "t"])
        self.assertEqual(image["values"][::20], [0, 1, 2, 3])

    def test_what_lies_twice_at_a_place_is_refused(self):
        writer = Writer(self.folder)
        for _ in range(2):
            for k in range(3):
                writer.plane(np.zeros((4, 5), dtype=np.uint8), (0, 0, k))
        self.assert_refused("UnsupportedData", "2 slices at one position", "Trigger Time")
        writer.plane(np.zeros((4, 5), dtype=np.uint8), (0, 0, 1))
        self.assert_refused("UnsupportedData", "one of 3 slices at", "expected 2", "duplicates")

    def test_a_copy_of_a_slice_is_named_and_a_moment_that_lacks_one(self):
        writer = Writer(self.folder)
        for k in range(9):
            writer.plane(np.zeros((4, 5), dtype=np.uint8), (0, 0, k), name=f"D{k}.dcm", TriggerTime=0)
        shutil.copy(self.folder / "D3.dcm", self.folder / "D3 copy.dcm")
        self.assert_refused("UnsupportedData", "one of 2 slices at 3 mm", "expected 1", "D3.dcm", "D3 copy.dcm")
        (self.folder / "D3 copy.dcm").unlink()
        for k in (0, 1, 2, 3, 4, 6, 7, 8):
            writer.plane(np.zeros((4, 5), dtype=np.uint8), (0, 0, k), name=f"E{k}.dcm", TriggerTime=30)
        self.assert_refused("UnsupportedData", "D5.dcm: is one of 1 slices at 5 mm", "expected 2", "missing")

    def test_planes_that_do_not_fit_are_refused(self):
        def refused(parts, **tags):
            with tempfile.TemporaryDirectory() as folder:
                writer = Writer(folder)
                writer.volume(planes=3)
                shape = tags.pop("shape", (4, 6))
                dtype = tags.pop("dtype", np.int16)
                writer.plane(np.zeros(shape, dtype=dtype), (10, -20, 37.5), name="odd.dcm", **tags)
                self.assert_refused("UnsupportedData", "odd.dcm", *parts, paths=[folder])
        refused(["parallel"], iop=(0, 1, 0, 1, 0, 0))
        refused(["7 x 4", "6 x 4"], shape=(4, 7))
        refused(["uint16", "int16"], dtype=np.uint16)
        refused(["mm apart"], spacing=(0.5, 0.8))

    def test_a_single_file_is_a_plane(self):
        path = Writer(self.folder).plane(np.arange(24, dtype=np.int16).reshape(4, 6), (3, 4, 5))
        image = self.assert_both_ways(path)
        self.assertEqual([len(axis["at"]) for axis in image["axes"]], [6, 4])
        np.testing.assert_allclose(self.position(image, (5, 3)), [3 + 5 * 0.7, 4 + 3 * 0.5])
        self.assertEqual(image["values"], list(range(24)))

    def enhanced(self, name, frames):
        data = header(self.folder / name, EnhancedMRImageStorage)
        data.SeriesInstanceUID, data.Modality = generate_uid(), "MR"
        shared = Dataset()
        measures, orientation = Dataset(), Dataset()
        measures.PixelSpacing = [0.5, 0.7]
        orientation.ImageOrientationPatient = OBLIQUE
        shared.PixelMeasuresSequence = Sequence([measures])
        shared.PlaneOrientationSequence = Sequence([orientation])
        data.SharedFunctionalGroupsSequence = Sequence([shared])
        groups = []
        for position, slope, time in frames:
            group, place, values, content = Dataset(), Dataset(), Dataset(), Dataset()
            place.ImagePositionPatient = [float(f"{x:.6f}") for x in position]
            values.RescaleSlope, values.RescaleIntercept, values.RescaleType = slope, -3, "US"
            content.TemporalPositionIndex = time
            group.PlanePositionSequence = Sequence([place])
            group.PixelValueTransformationSequence = Sequence([values])
            group.FrameContentSequence = Sequence([content])
            groups.append(group)
        data.PerFrameFunctionalGroupsSequence = Sequence(groups)
        data.NumberOfFrames = len(frames)
        values = np.random.default_rng(3).integers(0, 4000, size=(len(frames), 4, 6)).astype(np.uint16)
        put_pixels(data, values)
        data.save_as(self.folder / name, write_like_original=False)
        return values

    def test_enhanced_files_have_their_frames_in_space_and_time(self):
        normal = np.cross(OBLIQUE[:3], OBLIQUE[3:])
        order = [(k, t) for k in range(3) for t in (1, 2)]
        random.Random(3).shuffle(order)
        stored = self.enhanced("enhanced.dcm", [(2 * k * normal, 0.5 + t, t) for k, t in order])
        image = self.assert_both_ways(self.folder / "enhanced.dcm")
        self.assertEqual([len(axis["at"]) for axis in image["axes"]], [6, 4, 3, 2])
        values = np.array(image["values"]).reshape(2, 3, 4, 6)
        for frame, (k, t) in zip(stored, order):
            np.testing.assert_allclose(values[t - 1, k], frame * (0.5 + t) - 3, rtol=1e-6)
            np.testing.assert_allclose(self.position(image, (0, 0, k, t - 1))[:3], 2 * k * normal, atol=1e-5)

    def test_frames_without_a_place_are_moments_or_numbers(self):
        for tags, unit, step in (({"FrameTime": 33.3}, "ms", 33.3), ({}, "", 1)):
            path = self.folder / "film.dcm"
            data = header(path)
            data.SeriesInstanceUID, data.NumberOfFrames = "1.2", 3
            for tag, value in tags.items():
                setattr(data, tag, value)
            values = np.arange(60, dtype=np.uint8).reshape(3, 4, 5)
            put_pixels(data, values)
            data.save_as(path, write_like_original=False)
            image = self.assert_both_ways(path)
            self.assertEqual(image["values"], list(range(60)))
            self.assertEqual(image["axes"][2]["unit"], unit)
            self.assertAlmostEqual(image["axes"][2]["at"][2], 2 * step)

    def test_a_dicomdir_lists_the_files(self):
        Writer(self.folder).volume(planes=3)
        names = [path.name for path in files_of(self.folder)]
        for name in names:
            (self.folder / name).rename(self.folder / name.replace(".dcm", ""))
        directory = header(self.folder / "DICOMDIR", pydicom.uid.MediaStorageDirectoryStorage)
        records = []
        for name in ["none", *names]:
            record = Dataset()
            record.DirectoryRecordType = "IMAGE" if name != "none" else "PATIENT"
            if name != "none":
                record.ReferencedFileID = [name.replace(".dcm", "")]
            records.append(record)
        directory.DirectoryRecordSequence = Sequence(records)
        directory.save_as(self.folder / "DICOMDIR", write_like_original=False)
        self.assertEqual(self.assert_both_ways(self.folder / "DICOMDIR"), self.assert_both_ways())

    def test_what_is_no_grey_image_is_refused(self):
        path = self.folder / "colour.dcm"
        data = header(path)
        put_pixels(data, np.zeros((4, 5), dtype=np.uint8))
        data.SamplesPerPixel, data.PhotometricInterpretation, data.PlanarConfiguration = 3, "RGB", 0
        data.PixelData = bytes(60)
        data.save_as(path, write_like_original=False)
        self.assert_refused("UnsupportedData", "RGB", paths=[path])

    def test_damaged_files_and_folders_without_dicom_are_named(self):
        self.assert_refused("FileNotFound", str(self.folder), "directory")
        self.assert_refused("FileNotFound", "none.dcm", paths=[self.folder / "none.dcm"])
        Writer(self.folder).volume(planes=3)
        path = sorted(files_of(self.folder))[1]
        whole = path.read_bytes()
        for size in range(0, len(whole), 37):  # never a crash, and never an image
            path.write_bytes(whole[:size])
            self.assertIn("error", dump(path), size)
        path.write_bytes(whole[:-10])
        result = dump(self.folder)
        self.assertEqual(result.get("error"), "MalformedFile")
        self.assertIn(path.name, result["message"])


if __name__ == "__main__":
    unittest.main()
