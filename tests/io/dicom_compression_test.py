#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compressed DICOM as tegl reads it: dicom_compression_test.py DUMP_IMAGE

What GDCM and OpenJPEG compress is held against the uncompressed files, bit by bit; lossy JPEG 2000 against what
OpenJPEG's own program makes of the same code streams. Damaged files must give errors that name them. Exit status 77
where there is no pydicom, GDCM or OpenJPEG.
"""

import itertools
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

DUMP = sys.argv.pop(1)
for tool in ("gdcmconv", "opj_compress", "opj_decompress"):
    if not shutil.which(tool):
        print(f"skipped: no {tool}")
        sys.exit(77)
sys.argv.insert(1, DUMP)  # for the other file, which takes it
from dicom_test import Writer, dump, files_of, header, np, pydicom, put_pixels  # noqa: E402

from pydicom.encaps import encapsulate, generate_pixel_data_frame  # noqa: E402
from pydicom.uid import (DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian, ImplicitVRLittleEndian,  # noqa: E402
                         JPEG2000, JPEG2000Lossless, RLELossless)

KINDS = {"uint8": (np.uint8, None, 0, 255), "uint16": (np.uint16, None, 0, 65535),
         "int16": (np.int16, None, -32768, 32767), "uint12": (np.uint16, 12, 0, 4095), "int12": (np.int16, 12, -2048, 2047)}
SHAPE = (21, 34)


def run(*command):
    subprocess.run([str(word) for word in command], check=True, capture_output=True)


def smooth(numbers, shape, low, high):
    """Some waves and some noise: as compressible as a scan."""
    y, x = np.mgrid[: shape[-2], : shape[-1]]
    waves = np.sin(x / 3.0) + np.cos(y / 4.0) + numbers.normal(0, 0.2, shape)
    return np.clip(low + (waves + 2.6) / 5.2 * (high - low), low, high)


def code_stream(folder, values, *options, signed=False, bits=None):
    """A plane, compressed by OpenJPEG; and what OpenJPEG's program makes of it."""
    bits = bits or values.dtype.itemsize * 8
    raw, stream, back = folder / "plane.rawl", folder / "plane.j2k", folder / "back.rawl"
    raw.write_bytes(values.astype(values.dtype.newbyteorder("<")).tobytes())
    rows, columns = values.shape
    run("opj_compress", "-i", raw, "-o", stream, "-n", 3, "-F", f"{columns},{rows},1,{bits},{'s' if signed else 'u'}",
        *options)
    run("opj_decompress", "-i", stream, "-o", back)
    decoded = np.frombuffer(back.read_bytes(), dtype=values.dtype)
    if signed:  # it leaves out the bits above the sign
        decoded = (decoded.astype(np.int32) + (1 << (bits - 1))) % (1 << bits) - (1 << (bits - 1))
    return stream.read_bytes(), decoded.reshape(values.shape).astype(values.dtype)


def wide_code_stream(folder, values, bits):
    """The same of more than 16 bits, which OpenJPEG's program takes as PGX; it cuts signed ones off: here as bits."""
    rows, columns = values.shape
    path = folder / "plane.pgx"
    as_bits = values.astype(np.int64) & ((1 << bits) - 1)
    path.write_bytes(f"PG ML + {bits} {columns} {rows}\n".encode() + as_bits.astype(">u4").tobytes())
    run("opj_compress", "-i", path, "-o", folder / "plane.j2k", "-n", 3)
    return (folder / "plane.j2k").read_bytes()


def even(stream):
    return stream + b"\0" * (len(stream) % 2)


class Compression(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.numbers = np.random.default_rng(7)

    def new_folder(self, name):
        folder = self.folder / name
        folder.mkdir()
        return folder

    def scan(self, name, kind, planes=2):
        """A folder of planes of a kind, and the image."""
        dtype, bits, low, high = KINDS[kind]
        folder = self.new_folder(name)
        writer = Writer(folder)
        tags = {"BitsStored": bits} if bits else {}
        for k in range(planes):
            values = smooth(self.numbers, SHAPE, low, high).astype(dtype)
            values[0, 0], values[0, 1] = low, high
            writer.plane(values, (0, 0, k), RescaleSlope=1, RescaleIntercept=0, **tags)
        return folder, dump(folder)

    def assert_same(self, folder, plain):
        self.assertNotIn("error", plain, plain.get("message"))
        for how in ("whole", "layers"):
            image = dump(folder, how=how)
            self.assertNotIn("error", image, image.get("message"))
            self.assertEqual(image, plain)

    def write(self, name, streams, values, compressed_as, bits_stored=None, frames=None, **tags):
        """A file of compressed frames: the header is that of `values`, which it does not hold."""
        path = self.folder / name
        data = header(path)
        data.SeriesInstanceUID = "1.2.3"
        put_pixels(data, values, bits_stored)
        if values.ndim == 3:
            data.NumberOfFrames = frames or len(values)
        for tag, value in tags.items():
            setattr(data, tag, value)
        data.file_meta.TransferSyntaxUID = compressed_as
        data.PixelData = streams if isinstance(streams, bytes) else encapsulate([even(stream) for stream in streams])
        data["PixelData"].is_undefined_length = True
        data.save_as(path, write_like_original=False)
        return path

    def test_lossless_compression_by_gdcm_is_undone_bit_by_bit(self):
        for kind, (name, options) in itertools.product(KINDS, {
                "jpeg": ["--jpeg"], "jpegls": ["--jpegls"], "rle": ["--rle"], "j2k": ["--j2k"]}.items()):
            with self.subTest(kind, compression=name):
                folder, plain = self.scan(f"{kind}{name}", kind)
                for path in files_of(folder):
                    run("gdcmconv", *options, path, path.with_suffix(".new"))
                    path.with_suffix(".new").rename(path)
                    self.assertTrue(pydicom.dcmread(path).file_meta.TransferSyntaxUID.is_compressed)
                self.assert_same(folder, plain)

    def test_files_of_scanners_that_pydicom_comes_with(self):
        found = pathlib.Path(pydicom.__file__).parent / "data" / "test_files"
        if not (found / "MR_small.dcm").exists():
            self.skipTest("pydicom without its test files")
        plain = dump(found / "MR_small.dcm")
        self.assertEqual([len(axis["at"]) for axis in plain["axes"]], [64, 64])
        for name in ("jp2klossless", "jpeg_ls_lossless", "RLE", "bigendian", "implicit", "expb", "padded"):
            self.assertEqual(dump(found / f"MR_small_{name}.dcm"), plain, name)
        self.assertEqual(dump(found / "rtdose_rle.dcm")["type"], "float64")  # the type of its scaling is "unknown"
        np.testing.assert_allclose(dump(found / "rtdose_rle.dcm")["values"],
                                   pydicom.dcmread(found / "rtdose_rle.dcm").pixel_array.ravel() * 1e-6, rtol=1e-9)
        for name in ("693_J2KI", "J2K_pixelrep_mismatch", "JPEG2000", "image_dfl"):
            data = pydicom.dcmread(found / f"{name}.dcm")
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of bits and signs that are not those of the header
                try:
                    stored = data.pixel_array.astype(float)
                except (ImportError, NotImplementedError, RuntimeError):
                    continue  # no Pillow, or one without JPEG 2000
            expected = stored * float(data.get("RescaleSlope", 1)) + float(data.get("RescaleIntercept", 0))
            np.testing.assert_array_equal(dump(found / f"{name}.dcm")["values"], expected.ravel())

    def test_other_orders_of_bytes_deflated_and_rle_by_pydicom(self):
        for kind, syntax in itertools.product(KINDS, [DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian,
                                                      ImplicitVRLittleEndian, RLELossless]):
            with self.subTest(kind, syntax=syntax.name):
                folder, plain = self.scan(f"{kind}{syntax}", kind)
                for path in files_of(folder):
                    data = pydicom.dcmread(path)
                    if syntax == RLELossless:
                        data.compress(syntax)
                    elif syntax == ExplicitVRBigEndian and data.BitsAllocated == 16:
                        data.PixelData = np.frombuffer(data.PixelData, "<u2").astype(">u2").tobytes()
                    data.file_meta.TransferSyntaxUID = syntax
                    data.is_little_endian = syntax != ExplicitVRBigEndian
                    data.is_implicit_VR = syntax == ImplicitVRLittleEndian
                    data.save_as(path, write_like_original=False)
                self.assert_same(folder, plain)

    def test_jpeg_lossless_of_any_predictor_is_that_of_the_first(self):
        """What may use any predictor may use the first, as GDCM does."""
        folder, plain = self.scan("any", "uint16")
        for path in files_of(folder):
            run("gdcmconv", "--jpeg", path, path.with_suffix(".new"))
            data = pydicom.dcmread(path.with_suffix(".new"))
            data.file_meta.TransferSyntaxUID = pydicom.uid.UID("1.2.840.10008.1.2.4.57")
            data.save_as(path, write_like_original=False)
            path.with_suffix(".new").unlink()
        self.assert_same(folder, plain)

    def test_near_lossless_jpeg_ls_is_near(self):
        folder, plain = self.scan("near", "uint12")
        for path in files_of(folder):
            run("gdcmconv", "--jpegls", "--lossy", "-e", "3", path, path.with_suffix(".new"))
            path.with_suffix(".new").rename(path)
            self.assertEqual(pydicom.dcmread(path).file_meta.TransferSyntaxUID, "1.2.840.10008.1.2.4.81")
        apart = np.abs(np.array(dump(folder)["values"]) - np.array(plain["values"]))
        self.assertLessEqual(apart.max(), 3)
        self.assertGreater(apart.max(), 0)

    def test_lossy_jpeg_2000_is_what_openjpeg_makes_of_it(self):
        for kind in KINDS:
            with self.subTest(kind):
                dtype, bits, low, high = KINDS[kind]
                values = smooth(self.numbers, SHAPE, low, high).astype(dtype)
                stream, decoded = code_stream(self.folder, values, "-I", "-r", "4", signed=low < 0, bits=bits)
                self.assertTrue((decoded != values).any())
                path = self.write("lossy.dcm", [stream], values, JPEG2000, bits)
                self.assertEqual(dump(path)["values"], decoded.ravel().tolist())

    def test_jpeg_2000_of_more_bits(self):
        for signed in (False, True):
            for bits in (20, 24):
                dtype, half = (np.int32, 1 << (bits - 1)) if signed else (np.uint32, 0)
                values = self.numbers.integers(-half, (1 << bits) - half, SHAPE).astype(dtype)
                stream = wide_code_stream(self.folder, values, bits)
                path = self.folder / "wide.dcm"
                data = header(path)
                put_pixels(data, values)
                data.BitsStored, data.HighBit, data.SeriesInstanceUID = bits, bits - 1, "1.2"
                data.file_meta.TransferSyntaxUID = JPEG2000Lossless
                data.PixelData = encapsulate([even(stream)])
                data["PixelData"].is_undefined_length = True
                data.save_as(path, write_like_original=False)
                self.assertEqual(dump(path)["values"], values.ravel().tolist())
        data.PixelData = encapsulate([even(wide_code_stream(self.folder, values.astype(np.int64) + (1 << 25), 26))])
        data["PixelData"].is_undefined_length = True
        data.save_as(path, write_like_original=False)
        self.assert_error(path, "UnsupportedData", "26 bits per sample", "1 to 24")

    def test_the_sign_is_the_headers_not_the_code_streams(self):
        """Writers often compress the bits of signed values as if they were unsigned."""
        for bits, stored in ((16, None), (12, 12)):
            values = self.numbers.integers(-(1 << (bits - 1)), 1 << (bits - 1), SHAPE).astype(np.int16)
            as_bits = values.astype(np.int32) & ((1 << bits) - 1)
            stream, _ = code_stream(self.folder, as_bits.astype(np.uint16), bits=bits)
            path = self.write("sign.dcm", [stream], values, JPEG2000Lossless, stored)
            self.assertEqual(dump(path)["values"], values.ravel().tolist())
            signed, _ = code_stream(self.folder, values, signed=True, bits=bits)
            path = self.write("sign.dcm", [signed], as_bits.astype(np.uint16), JPEG2000Lossless, stored)
            self.assertEqual(dump(path)["values"], as_bits.ravel().tolist())

    def test_a_cell_of_more_bits_than_are_stored_has_its_stray_bits_removed(self):
        values = self.numbers.integers(-2048, 2048, SHAPE).astype(np.int16)
        cell = (values.astype(np.int32) & 0x0fff) | 0x5000  # an overlay above the values
        stream, _ = code_stream(self.folder, cell.astype(np.uint16))
        path = self.write("cell.dcm", [stream], values, JPEG2000Lossless, 12)
        self.assertEqual(dump(path)["values"], values.ravel().tolist())

    def test_the_jp2_box_that_some_writers_leave_around_it_is_opened(self):
        values = smooth(self.numbers, SHAPE, 0, 4000).astype(np.uint16)
        (self.folder / "plane.rawl").write_bytes(values.tobytes())
        run("opj_compress", "-i", self.folder / "plane.rawl", "-o", self.folder / "plane.jp2", "-n", 3, "-F",
            f"{SHAPE[1]},{SHAPE[0]},1,16,u")
        path = self.write("jp2.dcm", [(self.folder / "plane.jp2").read_bytes()], values, JPEG2000Lossless)
        self.assertEqual(dump(path)["values"], values.ravel().tolist())

    def frames(self, count=4):
        """Frames of a film, their code streams, and an item of each fragment that they are cut into."""
        values = smooth(self.numbers, (count, *SHAPE), 0, 3000).astype(np.uint16)
        return values, [even(code_stream(self.folder, plane)[0]) for plane in values]

    @staticmethod
    def fragments(parts, offsets):
        def item(content):
            return b"\xfe\xff\x00\xe0" + len(content).to_bytes(4, "little") + content
        table = b"".join(offset.to_bytes(4, "little") for offset in offsets)
        return item(table) + b"".join(item(part) for part in parts)

    def test_fragments_find_their_frames(self):
        values, streams = self.frames()
        parts, offsets = [], []
        for number, stream in enumerate(streams):  # into 1 to 4 fragments
            offsets.append(sum(len(part) + 8 for part in parts))
            cut = 2 * (len(stream) // (2 * (number + 1)) + 1)
            parts += [stream[at:at + cut] for at in range(0, len(stream), cut)]
        self.assertGreater(len(parts), len(streams))
        cases = {"table": (parts, offsets), "no table": (parts, []), "wrong table": (parts, [0, 10, 20, 30]),
                 "short table": (parts, offsets[:2]), "one each": (streams, []), "one each, wrong table": (streams, [8])}
        for name, (pieces, table) in cases.items():
            with self.subTest(name):
                path = self.write("film.dcm", self.fragments(pieces, table), values, JPEG2000Lossless, FrameTime=20)
                for how in ("whole", "layers"):
                    self.assertEqual(dump(path, how=how).get("values"), values.ravel().tolist())
        single = self.write("one.dcm", self.fragments([streams[0][:50], streams[0][50:]], []), values[0], JPEG2000Lossless)
        self.assertEqual(dump(single)["values"], values[0].ravel().tolist())
        for pieces, count in ((parts[:-3], 4), (streams[:3], 4), (streams, 3), ([], 4)):
            path = self.write("film.dcm", self.fragments(pieces, []), values, JPEG2000Lossless, frames=count, FrameTime=20)
            self.assert_error(path, "MalformedFile", "film.dcm")

    def assert_error(self, path, code, *parts):
        for how in ("whole", "layers"):
            result = dump(path, how=how)
            self.assertEqual(result.get("error"), code, result.get("message", "no error"))
            for part in parts:
                self.assertIn(part, result["message"])

    def test_damaged_code_streams_are_named_with_their_frame(self):
        values, streams = self.frames(3)
        whole = streams[1].rstrip(b"\0")
        for size in [0, 1, 2, 4, 20, 60, *range(100, len(whole) - 2, len(whole) // 9)]:
            with self.subTest(size=size):
                cut = [streams[0], even(whole[:size]) or b"\0\0", streams[2]]
                path = self.write("cut.dcm", self.fragments(cut, []), values, JPEG2000Lossless, FrameTime=20)
                self.assert_error(path, "MalformedFile", "cut.dcm: frame 2", "expected")
        path = self.write("size.dcm", [streams[0]], values[0, :-1], JPEG2000Lossless)
        self.assert_error(path, "MalformedFile", f"{SHAPE[1]} x {SHAPE[0]}", f"expected {SHAPE[1]} x {SHAPE[0] - 1}")
        path = self.write("bits.dcm", [streams[0]], values[0].astype(np.uint8), JPEG2000Lossless)
        self.assert_error(path, "MalformedFile", "16 bits per sample", "at most 8")
        path = self.write("jpeg.dcm", [b"\xff\xd8\xff\xe0" + bytes(100)], values[0], JPEG2000Lossless)
        self.assert_error(path, "MalformedFile", "JPEG 2000 code stream", "ff 4f ff 51")

    def test_compressed_pixels_that_are_cut_short_are_never_an_image(self):
        folder, _ = self.scan("sound", "uint12", planes=1)
        for compression in ("--j2k", "--jpegls", "--jpeg", "--rle"):
            path = self.folder / "cut.dcm"
            run("gdcmconv", compression, files_of(folder)[0], path)
            data = pydicom.dcmread(path)
            whole = next(generate_pixel_data_frame(data.PixelData))
            for share in (0.02, 0.1, 0.3, 0.5, 0.6, 0.75, 0.9, 0.97):
                with self.subTest(compression=compression, share=share):
                    data.PixelData = encapsulate([even(whole[:int(share * len(whole))])])
                    data["PixelData"].is_undefined_length = True
                    data.save_as(path, write_like_original=False)
                    self.assertEqual(dump(path).get("error"), "MalformedFile")

    def test_mutated_files_are_read_or_refused(self):
        """An image of the right size, or an error that names the file: never a crash, never a word on the terminal."""
        folder, _ = self.scan("sound", "uint12", planes=1)
        sound = files_of(folder)[0]
        for compression in ("--j2k", "--jpegls", "--jpeg", "--rle"):
            compressed = self.folder / f"sound{compression}.dcm"
            run("gdcmconv", compression, sound, compressed)
            whole = compressed.read_bytes()
            pixels = whole.index(b"\xe0\x7f\x10\x00")
            for number in range(60 if compression == "--j2k" else 12):
                numbers = np.random.default_rng([number, len(whole)])
                mutated = bytearray(whole)
                for _ in range(1 + number % 4):
                    # headers of the stream more often than what follows
                    at = int(numbers.integers(pixels, pixels + 200 if number % 2 else len(whole)))
                    mutated[at] = int(numbers.integers(256))
                path = self.folder / "mutated.dcm"
                path.write_bytes(mutated)
                with self.subTest(compression=compression, number=number):
                    result = dump(path)
                    if "error" in result:
                        self.assertIn("mutated.dcm", result["message"])
                    else:
                        self.assertEqual(len(result["values"]), SHAPE[0] * SHAPE[1])

    def test_what_cannot_be_decompressed_is_refused_by_its_name(self):
        values, streams = self.frames(1)
        names = {"1.2.840.10008.1.2.4.92": "JPEG 2000", "1.2.840.10008.1.2.4.100": "MPEG2",
                 "1.2.840.10008.1.2.4.102": "MPEG-4",
                 "1.2.840.10008.1.2.4.107": "HEVC", "1.2.840.10008.1.2.4.94": "JPIP", "1.2.840.10008.1.2.4.201": "HTJ2K",
                 "1.2.840.10008.1.2.4.203": "HTJ2K", "1.2.840.10008.1.2.4.110": "JPEG XL", "1.2.3.4.5": "1.2.3.4.5"}
        for uid, name in names.items():
            with self.subTest(uid):
                path = self.write("other.dcm", [streams[0]], values[0], pydicom.uid.UID("1.2.840.10008.1.2.4.100"))
                old, new = (f"1.2.840.10008.1.2.4.100 {uid}".encode().split())
                # pydicom knows few of them
                path.write_bytes(path.read_bytes().replace(old + b"\0", new.ljust(len(old) + 1, b"\0")))
                self.assert_error(path, "UnsupportedFormat", "other.dcm", name, uid)


if __name__ == "__main__":
    unittest.main()
