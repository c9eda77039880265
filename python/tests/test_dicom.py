# SPDX-License-Identifier: BSD-3-Clause
"""DICOM in Python: what is left out of a folder, or lies unevenly, is a warning."""

import numpy as np
import pytest
import tegl

pydicom = pytest.importorskip("pydicom")


def write_slice(path, z):
    meta = pydicom.dataset.FileMetaDataset()
    meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
    meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
    meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
    data = pydicom.dataset.FileDataset(str(path), {}, file_meta=meta, preamble=bytes(128))
    data.is_little_endian, data.is_implicit_VR = True, False
    data.SOPClassUID, data.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID, data.SpecificCharacterSet, data.SeriesDescription = "1.2.3", "ISO_IR 100", "Schädel"
    data.ImagePositionPatient, data.ImageOrientationPatient = [0, 0, z], [1, 0, 0, 0, 1, 0]
    data.PixelSpacing, data.PhotometricInterpretation, data.SamplesPerPixel = [1, 1], "MONOCHROME2", 1
    data.Rows, data.Columns, data.BitsAllocated, data.BitsStored, data.HighBit = 4, 5, 16, 16, 15
    data.PixelRepresentation, data.PixelData = 0, np.full((4, 5), round(z), np.uint16).tobytes()
    data.save_as(path, write_like_original=False)


@pytest.fixture
def folder(tmp_path):
    try:
        tegl.read(tmp_path)
    except Exception as error:
        if "DCMTK" in str(error):
            pytest.skip("built without DICOM")
    return tmp_path


def test_what_is_left_out_is_a_warning(folder, recwarn):
    for z in range(4):
        write_slice(folder / f"{z}.dcm", z)
    image = tegl.read(folder)
    assert image.format == "DICOM" and image.array.shape == (4, 4, 5) and not recwarn.list
    (folder / "notes.dcm").write_text("no DICOM")
    with pytest.warns(UserWarning, match="skipped: .*notes.dcm"):
        assert np.array_equal(tegl.read(folder).array, image.array)


def test_uneven_slices_lie_where_they_lie_and_are_a_warning(folder):
    places = [0, 1.2, 2, 3.1, 4]
    for z in places:
        write_slice(folder / f"{z}.dcm", z)
    with pytest.warns(UserWarning, match="uneven distances"):
        image = tegl.read(folder)
    assert np.allclose(image.coords[0], places)
