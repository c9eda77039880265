#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tests/io/make_seeds.py FOLDER: writes the small sound files that tests/io/hostile/fuzz_test.cpp mutates, tests/io/seeds. Each format is
written by several programs, in old and new versions of the format, as text and binary, chunked and compressed, as each
writer lays out its headers in its own way. The files are kept in the tree, as writers change; this script documents how
they were made. It needs Debian's python3-h5py, python3-nibabel, python3-netcdf4, python3-pydicom, python3-meshio,
python3-vtk9, python3-scipy, teem-apps and assimp-utils."""

import itertools
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import h5py
import meshio
import netCDF4
import nibabel
import numpy
import pydicom
import scipy.io
import vtk
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.encaps import encapsulate
from vtkmodules.util import numpy_support

SHAPE = (2, 3, 4, 5)


def values(shape, dtype):
    return (numpy.arange(numpy.prod(shape)) % 100).astype(dtype).reshape(shape)


def vtk_image(shape, dtype):
    image = vtk.vtkImageData()
    image.SetDimensions(shape[::-1])
    image.SetSpacing(0.5, 2, 3)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(values(shape, dtype).ravel(), deep=True))
    return image


def write_nifti(folder):
    affine = numpy.array([[0, -2, 0, 1], [2, 0, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1.0]])
    four = nibabel.Nifti1Image(values((5, 4, 3, 2), "i2"), affine)
    four.header.set_xyzt_units("mm", "sec")
    four.header.set_slope_inter(2, 1)
    nibabel.save(four, folder / "nibabel_4d.nii")
    nibabel.save(four, folder / "nibabel_4d_gz.nii.gz")
    extended = nibabel.Nifti1Image(values((5, 4, 3), "f4"), affine)
    extended.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", b"a comment"))
    nibabel.save(extended, folder / "nibabel_extension.nii")
    nibabel.save(nibabel.Nifti1Image(values((5, 4, 3), ">f8"), affine), folder / "nibabel_big_endian.nii")
    writer = vtk.vtkNIFTIImageWriter()
    writer.SetFileName(str(folder / "vtk.nii"))
    writer.SetInputData(vtk_image((3, 4, 5), "u1"))
    writer.Write()


def write_nrrd_and_metaimage(folder):
    writer = vtk.vtkMetaImageWriter()
    writer.SetCompression(False)
    writer.SetFileName(str(folder / "vtk.mha"))
    writer.SetInputData(vtk_image((3, 4, 5), "i2"))
    writer.Write()
    writer.SetCompression(True)
    writer.SetFileName(str(folder / "vtk_compressed.mha"))
    writer.Write()
    raw = folder / "raw.bin"
    raw.write_bytes(values((3, 4, 5), "i2").tobytes())
    make = ["teem-unu", "make", "-i", raw, "-t", "short", "-s", "5", "4", "3", "-en", "little", "-e", "raw", "-sp", "0.5", "2", "3",
            "-l", "x", "y", "z"]
    for encoding in ("raw", "gzip", "hex", "ascii"):
        out = folder / f"teem_{encoding}.nrrd"
        with subprocess.Popen(make, stdout=subprocess.PIPE) as made:
            subprocess.run(["teem-unu", "save", "-f", "nrrd", "-e", encoding, "-o", out], stdin=made.stdout, check=False)
    raw.unlink()
    (folder / "hand_ascii.mha").write_text(
        "ObjectType = Image\nNDims = 3\nBinaryData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\n"
        "ElementSpacing = 1 2 3\nDimSize = 3 2 2\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n" +
        " ".join(map(str, range(12))) + "\n")
    (folder / "hand_4d.nrrd").write_bytes(
        b"NRRD0005\r\n# comment\r\ntype: unsigned short\r\ndimension: 4\r\nsizes: 5 4 3 2\r\nspace: left-posterior-superior\r\n"
        b"kinds: domain domain domain list\r\nspace directions: (1,2,0) (0,3,-1) (0.5,0,4) none\r\n"
        b"space origin: (10,20,30)\r\nspace units: \"mm\" \"mm\" \"mm\"\r\nendian: big\r\nkey:=value\r\nencoding: raw\r\n\r\n" +
        values(SHAPE, ">u2").tobytes())


def fill_netcdf(data, compressed=False):
    sizes = dict(time=None, depth=3, lat=4, lon=5)
    for name, size in sizes.items():
        data.createDimension(name, size)
    extra = dict(zlib=True, chunksizes=(1, 2, 2, 5), shuffle=True, fletcher32=True) if compressed else {}
    variable = data.createVariable("temperature", "i2", tuple(sizes), fill_value=-1, **extra)
    variable.scale_factor, variable.add_offset, variable.units = 0.5, 10.0, "degC"
    lon = data.createVariable("lon", "f4", ("lon",))
    time = data.createVariable("time", "f8", ("time",))
    time.units, time.calendar = "days since 2000-01-01", "noleap"
    lon[:] = [0, 90, 180, 270, 359]
    variable[:] = values(SHAPE, "i2")
    time[:] = [0, 31]


def write_netcdf(folder):
    for kind in ("NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4", "NETCDF4_CLASSIC"):
        with netCDF4.Dataset(folder / f"netcdf_{kind.lower()}.nc", "w", format=kind) as data:
            fill_netcdf(data)
    with netCDF4.Dataset(folder / "netcdf_compressed.nc", "w") as data:
        fill_netcdf(data, True)
        group = data.createGroup("group")
        text = group.createVariable("names", str, ("lon",))
        for i in range(5):
            text[i] = f"name {i}"
        group.createVariable("x", "u8", ("lat", "lon"))[:] = values((4, 5), "u8")
    with scipy.io.netcdf_file(folder / "scipy.nc", "w") as data:
        for name, size in (("y", 4), ("x", 5)):
            data.createDimension(name, size)
        data.createVariable("v", "f4", ("y", "x"))[:] = values((4, 5), "f4")
    write_curved_netcdf(folder / "netcdf_curved.nc")


def write_curved_netcdf(path):
    """A cone around longitude 179.5 and latitude 37, at two times, on a curved grid across the date line."""
    with scipy.io.netcdf_file(path, "w") as data:
        for name, size in (("time", 2), ("eta", 6), ("xi", 7)):
            data.createDimension(name, size)
        eta, xi = numpy.meshgrid(numpy.arange(6.0), numpy.arange(7.0), indexing="ij")
        lon, lat = 176 + xi + 0.2 * eta, 40 - eta - 0.1 * xi
        for name, array, unit in (("lon", numpy.where(lon > 180, lon - 360, lon), "degrees_east"),
                                  ("lat", lat, "degrees_north")):
            variable = data.createVariable(name, "d", ("eta", "xi"))
            variable[:] = array
            variable.units = unit
        cone = data.createVariable("v", "f", ("time", "eta", "xi"))
        cone[:] = numpy.hypot(lon - 179.5, lat - 37) + numpy.zeros((2, 1, 1))
        cone.coordinates = "lon lat"


def fill_hdf5(data, compressed):
    extra = dict(chunks=(1, 2, 2, 5), compression="gzip", shuffle=True, fletcher32=True) if compressed else {}
    data.create_dataset("temperature", data=values(SHAPE, "f4"), **extra)
    data["lon"] = numpy.arange(5.0)
    data["lon"].make_scale("lon")
    data["temperature"].dims[3].attach_scale(data["lon"])
    data.create_group("a").create_dataset("b", data=values((3, 4), "u2"))


def write_hdf5(folder):
    for version in ("earliest", "latest"):
        for compressed in (False, True):
            name = f"h5py_{version}_{'gzip' if compressed else 'contiguous'}.h5"
            with h5py.File(folder / name, "w", libver=version) as data:
                fill_hdf5(data, compressed)


def write_vtkhdf(folder):
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
    for version in ("earliest", "latest"):
        for corners, kind in ((3, 5), (4, 10)):
            cells = numpy.array([[0, 1, 2, 3], [1, 2, 3, 4]])[:, :corners]
            with h5py.File(folder / f"h5py_{version}_{corners}.vtkhdf", "w", libver=version) as data:
                root = data.create_group("VTKHDF")
                root.attrs["Version"] = [1, 0]
                root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
                root["NumberOfPoints"], root["NumberOfCells"] = [5], [2]
                root["NumberOfConnectivityIds"] = [2 * corners]
                chunks = dict(chunks=(2, 3), compression="gzip") if version == "latest" else {}
                root.create_dataset("Points", data=points, maxshape=(None, 3) if chunks else None, **chunks)
                root["Offsets"], root["Connectivity"] = numpy.arange(3) * corners, cells.ravel()
                root["Types"] = numpy.full(2, kind, "u1")
                root["PointData/temperature"] = numpy.arange(5.0)
                root["PointData/t"] = numpy.arange(5.0)
                root["CellData/label"] = numpy.arange(2, dtype="i4")


def write_dicom(folder):
    syntaxes = dict(explicit=pydicom.uid.ExplicitVRLittleEndian, implicit=pydicom.uid.ImplicitVRLittleEndian,
                    big=pydicom.uid.ExplicitVRBigEndian, deflated=pydicom.uid.DeflatedExplicitVRLittleEndian,
                    rle=pydicom.uid.RLELossless)
    for name, syntax in syntaxes.items():
        meta = FileMetaDataset()
        meta.TransferSyntaxUID = syntax
        meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
        meta.MediaStorageSOPInstanceUID = "1.2.3.4"
        image = Dataset()
        image.file_meta = meta
        image.is_little_endian, image.is_implicit_VR = syntax.is_little_endian, syntax.is_implicit_VR
        image.SOPClassUID, image.SOPInstanceUID = meta.MediaStorageSOPClassUID, "1.2.3.4"
        image.SeriesInstanceUID, image.StudyInstanceUID, image.Modality = "1.2.3", "1.2", "CT"
        image.Rows, image.Columns, image.BitsAllocated, image.BitsStored, image.HighBit = 4, 5, 16, 12, 11
        image.SamplesPerPixel, image.PhotometricInterpretation, image.PixelRepresentation = 1, "MONOCHROME2", 0
        image.ImagePositionPatient, image.ImageOrientationPatient = [1, 2, 3], [1, 0, 0, 0, 1, 0]
        image.PixelSpacing, image.SliceThickness = [0.5, 0.25], 2
        image.RescaleSlope, image.RescaleIntercept = 2, -1000
        item = Dataset()
        item.CodeValue = "1"
        image.AnatomicRegionSequence = pydicom.Sequence([item])
        pixels = values((4, 5), "u2" if syntax.is_little_endian else ">u2").tobytes()
        image.PixelData = pixels
        image["PixelData"].VR = "OW"
        if name == "rle":
            image.PixelData = encapsulate([pydicom.pixel_data_handlers.rle_handler.rle_encode_frame(values((4, 5), "u2"))])
            image["PixelData"].is_undefined_length = True
        pydicom.dcmwrite(folder / f"pydicom_{name}.dcm", image, write_like_original=False)


def write_meshes(folder):
    points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = numpy.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    mesh = meshio.Mesh(points, [("triangle", faces)], point_data={"temperature": numpy.arange(4.0)},
                       cell_data={"label": [numpy.arange(4)]})
    meshio.write(folder / "meshio.ply", mesh)
    meshio.write(folder / "meshio_text.ply", mesh, binary=False)
    plain = meshio.Mesh(points, [("triangle", faces)])
    meshio.write(folder / "meshio.stl", plain, binary=True)
    meshio.write(folder / "meshio_text.stl", plain)
    meshio.write(folder / "meshio.obj", plain)

    source = vtk.vtkSphereSource()
    source.SetThetaResolution(6)
    source.SetPhiResolution(5)
    for name, writer in (("vtk.ply", vtk.vtkPLYWriter()), ("vtk.stl", vtk.vtkSTLWriter()), ("vtk.obj", vtk.vtkOBJWriter())):
        writer.SetFileName(str(folder / name))
        writer.SetInputConnection(source.GetOutputPort())
        if name != "vtk.obj":
            writer.SetFileTypeToBinary()
        writer.Write()
    source.Update()
    writer = vtk.vtkPLYWriter()
    writer.SetFileName(str(folder / "vtk_big_endian.ply"))
    writer.SetInputConnection(source.GetOutputPort())
    writer.SetDataByteOrderToBigEndian()
    writer.Write()
    for kind in ("gltf2", "glb2"):
        extension = kind[:-1]
        subprocess.run(["assimp", "export", folder / "meshio.obj", folder / f"assimp.{extension}", f"-f{kind}"], check=True,
                       stdout=subprocess.DEVNULL)
    subprocess.run(["assimp", "export", folder / "vtk.obj", folder / "assimp.obj", "-fobj"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["assimp", "export", folder / "vtk.obj", folder / "assimp.ply", "-fply"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["assimp", "export", folder / "vtk.obj", folder / "assimp.stl", "-fstl"], check=True, stdout=subprocess.DEVNULL)
    (folder / "assimp.mtl").unlink()


def listed_faces(source, target):
    """The polyhedra of a file in the arrays of VTK 9.4 and later: each face once, for both of its cells."""
    root = xml.etree.ElementTree.parse(source)
    cells = root.find(".//Cells")
    arrays = {array.get("Name"): array for array in cells}
    stream, ends = ([int(number) for number in arrays[name].text.split()] for name in ("faces", "faceoffsets"))
    numbers, of_cells, at = {}, [], 0  # by face: its corners
    for end in ends:
        of_cells.append([])
        at += 1 if end >= 0 else 0
        while at < end:
            face = stream[at + 1:at + 1 + stream[at]]
            of_cells[-1].append(numbers.setdefault(frozenset(face), (len(numbers), face))[0])
            at += 1 + stream[at]
    faces = [face for _, face in numbers.values()]
    for name in ("faces", "faceoffsets"):
        cells.remove(arrays[name])
    for name, rows in (("face", faces), ("polyhedron", of_cells)):
        flat = [number for row in rows for number in row]
        sums = list(itertools.accumulate(map(len, rows)))
        for array, values in (("face_connectivity" if name == "face" else "polyhedron_to_faces", flat),
                              (f"{name}_offsets", sums)):
            element = xml.etree.ElementTree.SubElement(cells, "DataArray", type="Int64", Name=array, format="ascii")
            element.text = " ".join(map(str, values))
    root.getroot().set("version", "2.3")
    root.write(target)


def write_vtk_xml(folder):
    """Images, meshes of cells, in all encodings."""
    def write(writer, data, name, set_mode, compress=False, big=False, wide=False):
        writer.SetFileName(str(folder / name))
        writer.SetInputData(data)
        getattr(writer, set_mode)()
        writer.SetCompressorTypeToZLib() if compress else writer.SetCompressorTypeToNone()
        writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
        writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
        writer.SetEncodeAppendedData("base64" in name)
        writer.Write()

    image = vtk_image((3, 4, 5), "i2")
    image.GetPointData().GetScalars().SetName("f")
    write(vtk.vtkXMLImageDataWriter(), image, "vtk_ascii.vti", "SetDataModeToAscii")
    write(vtk.vtkXMLImageDataWriter(), image, "vtk_binary_zlib.vti", "SetDataModeToBinary", True, True, True)
    write(vtk.vtkXMLImageDataWriter(), image, "vtk_raw.vti", "SetDataModeToAppended")
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(5, 4, 3)
    for axis, size in zip("XYZ", (5, 4, 3)):
        getattr(grid, f"Set{axis}Coordinates")(numpy_support.numpy_to_vtk(numpy.arange(size) ** 1.5, deep=True))
    grid.GetPointData().AddArray(image.GetPointData().GetScalars())
    write(vtk.vtkXMLRectilinearGridWriter(), grid, "vtk_base64_zlib.vtr", "SetDataModeToAppended", True)
    to_structured = vtk.vtkImageToStructuredGrid()
    to_structured.SetInputData(image)
    to_structured.Update()
    write(vtk.vtkXMLStructuredGridWriter(), to_structured.GetOutput(), "vtk_base64.vts", "SetDataModeToAppended", False, True)
    to_tetrahedra = vtk.vtkDataSetTriangleFilter()
    to_tetrahedra.SetInputData(image)
    to_tetrahedra.Update()
    mesh = to_tetrahedra.GetOutput()
    write(vtk.vtkXMLUnstructuredGridWriter(), mesh, "vtk_ascii.vtu", "SetDataModeToAscii")
    # a pentagonal prism and a pyramid on one of its sides as polyhedra, another prism beside it
    ring = [(numpy.cos(0.4 * numpy.pi * k), numpy.sin(0.4 * numpy.pi * k)) for k in range(5)]
    places = vtk.vtkPoints()
    for x, y, z in [*((x, y, z) for z in (0, 1, 2) for x, y in ring), (2, 1.5, 0.5)]:
        places.InsertNextPoint(x, y, z)
    polyhedra = vtk.vtkUnstructuredGrid()
    polyhedra.SetPoints(places)
    sides = [[k, (k + 1) % 5, (k + 1) % 5 + 5, k + 5] for k in range(5)]
    pyramid = [sides[0], *([a, b, 15] for a, b in ((0, 1), (1, 6), (6, 5), (5, 0)))]
    for faces in ([list(range(5)), list(range(5, 10)), *sides], pyramid):
        stream = vtk.vtkIdList()
        for number in [len(faces)] + [number for face in faces for number in (len(face), *face)]:
            stream.InsertNextId(number)
        polyhedra.InsertNextCell(vtk.VTK_POLYHEDRON, stream)
    polyhedra.InsertNextCell(vtk.VTK_PENTAGONAL_PRISM, 10, list(range(5, 15)))
    values = numpy_support.numpy_to_vtk(numpy.arange(16.0) * 7 % 100, deep=True)
    values.SetName("f")
    polyhedra.GetPointData().AddArray(values)
    write(vtk.vtkXMLUnstructuredGridWriter(), polyhedra, "vtk_polyhedra.vtu", "SetDataModeToAscii")
    listed_faces(folder / "vtk_polyhedra.vtu", folder / "vtk_listed_faces.vtu")
    write(vtk.vtkXMLUnstructuredGridWriter(), mesh, "vtk_raw_zlib.vtu", "SetDataModeToAppended", True, False, True)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for write in (write_nifti, write_nrrd_and_metaimage, write_netcdf, write_hdf5, write_vtkhdf, write_dicom, write_meshes,
                  write_vtk_xml):
        write(folder)


if __name__ == "__main__":
    main()
