// SPDX-License-Identifier: BSD-3-Clause
//
// Reading and writing of images, meshes and facets. Link with tegl::io.
//
// Not thread-safe, not even for different files: the libraries behind some formats (netCDF, HDF5) have global state.
// Nothing is printed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/image.hpp"
#include "tegl/layers.hpp"
#include "tegl/stream.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// An image of any value type in N dimensions.
template <int N>
using AnyImageN =
    std::variant<OwnedImage<std::uint8_t, N>, OwnedImage<std::int8_t, N>, OwnedImage<std::uint16_t, N>,
                 OwnedImage<std::int16_t, N>, OwnedImage<std::int32_t, N>, OwnedImage<float, N>, OwnedImage<double, N>>;
/// An image of any value type in 2, 3 or 4 dimensions.
using AnyImage = std::variant<AnyImageN<2>, AnyImageN<3>, AnyImageN<4>>;

/// The direction in which the coordinates of an axis increase, if the file defines it: ocean depths and atmospheric
/// pressures increase downwards.
enum class AxisDirection : std::uint8_t { unknown, up, down };

/// Metadata of an image file besides values and grid.
struct ImageInfo {
  std::string format = {};                          ///< "NIfTI", "NRRD", "MetaImage", "netCDF", "DICOM", "raw"
  std::string variable = {};                        ///< netCDF: the variable read
  std::vector<std::string> variables = {};          ///< netCDF: all variables that are readable as an image
  std::string value_unit = {};                      ///< such as "degC"; may be empty
  std::string value_name = {};                      ///< long name; may be empty
  std::string world_frame = {};                     ///< such as "RAS", "LPS"; empty if unknown
  std::string stored_type = {};                     ///< value type in the file, before any conversion
  std::vector<AxisDirection> axis_directions = {};  ///< netCDF: one per axis of the image; else empty
  std::vector<std::string> remarks = {};            ///< DICOM: skipped files, uneven slice distances; else empty
};

/// An image and its metadata.
struct ReadImageResult {
  AnyImage image = {};  ///< values and grid
  ImageInfo info = {};  ///< metadata
};

/// A fixed index along one dimension of a netCDF variable.
struct FixedIndex {
  std::string dimension = {};  ///< name of the dimension in the file
  std::size_t index = 0;       ///< 0 is the first
};

/// Options of read_image.
struct ReadImageOptions {
  std::string variable = {};  ///< netCDF: variable; DICOM: UID, description or number of a series; empty: the only one
  Progress progress = {};     ///< see Progress
  /// netCDF: reads only the samples at these indices. The image does not have these dimensions as axes.
  std::vector<FixedIndex> fixed = {};
  /// Headers may name a file of samples (NRRD `data file`, MetaImage `ElementDataFile`). By default it must lie in the
  /// header's folder or below, with symbolic links resolved; this option allows any place.
  bool allow_outside_paths = false;
  /// Reads formats whose libraries may crash on damaged files, HDF5 (netCDF-4) and DCMTK, in a child process with
  /// limits of memory and time. If it crashes, loops or exceeds its memory, the error is MalformedFile. The values are
  /// the same; they stay in the memory that the child filled, without a copy. The child starts in a few milliseconds,
  /// plus some 20 ms for each gigabyte that this process has in small pages. Other threads may run meanwhile. Linux
  /// only.
  bool separate_process = false;
};

/// Reads NIfTI-1 (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr; raw, gzip, ascii, hex; one data file), MetaImage
/// (.mha, .mhd; one data file) and netCDF (.nc, .cdf, .nc4; also gzipped as a whole). Files with another extension are
/// recognised by their first bytes. With DCMTK also DICOM: a file, a DICOMDIR, or a folder and everything below it.
/// DICOM slices are sorted by position, and by time if several have one position. Files there that are not DICOM, or
/// have colours, are skipped; slices at uneven distances give a rectilinear axis. ImageInfo::remarks reports both.
///
/// Axes: the fastest axis in the file is axis 0, time is last. Trailing axes of one sample are dropped (in netCDF at
/// any position); 2, 3 or 4 axes must remain. Units are those of the file. Orientations that couple axes become
/// Grid::linear and offset, exactly, even if sheared; other orientations become part of the axes. NRRD spaces RAS and
/// LAS are converted to LPS. Values are those stored; uint32, int64 and uint64 become int32 if all values fit, else
/// double. NIfTI slope and intercept and netCDF packing are applied. Missing values of netCDF become NaN, in float, or
/// in double if float cannot represent the values.
///
/// Errors, all naming the file: FileNotFound, MalformedFile (damaged, truncated or inconsistent; compressed data are
/// checked to the last byte), UnsupportedFormat, UnsupportedData (colours, vectors, other than 2 to 4 axes; a file of
/// samples outside of the header's folder), VariableNotFound (lists the variables), InvalidGrid (a coordinate variable
/// that is not monotone), InvalidArgument (a variable or a fixed index for a format without names; a fixed dimension or
/// index that the variable does not have), TooLarge, Cancelled. Memory: up to three times the values; a damaged file
/// takes no more than its bytes can hold.
ReadImageResult read_image(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// A variable that is readable as an image.
struct ImageVariable {
  std::string name = {};                ///< name for ReadImageOptions::variable
  std::vector<std::size_t> sizes = {};  ///< of its axes longer than 1, in the image's order: fastest first
  std::string unit = {};                ///< may be empty
  std::string long_name = {};           ///< may be empty
  std::vector<std::string> axes = {};   ///< netCDF: dimension names, in the order of `sizes`
};

/// Lists the values for ReadImageOptions::variable: the variables of a netCDF file, or the series of DICOM (with the
/// description as long_name). Empty for other formats, whose files hold one unnamed image. Variables of more than 4
/// axes are only readable with ReadImageOptions::fixed. Reads no values. Errors: those of read_image.
std::vector<ImageVariable> list_image_variables(const std::filesystem::path& path,
                                                const ReadImageOptions& options = {});

/// Readers of an image's layers, for any value type in N dimensions.
template <int N>
using AnyLayersN =
    std::variant<std::unique_ptr<LayerReader<std::uint8_t, N>>, std::unique_ptr<LayerReader<std::int8_t, N>>,
                 std::unique_ptr<LayerReader<std::uint16_t, N>>, std::unique_ptr<LayerReader<std::int16_t, N>>,
                 std::unique_ptr<LayerReader<std::int32_t, N>>, std::unique_ptr<LayerReader<float, N>>,
                 std::unique_ptr<LayerReader<double, N>>>;
/// Readers of an image's layers, for any value type in 2, 3 or 4 dimensions.
using AnyLayers = std::variant<AnyLayersN<2>, AnyLayersN<3>, AnyLayersN<4>>;

/// An opened image and its metadata.
struct OpenLayersResult {
  AnyLayers layers = {};  ///< of any type and dimension
  ImageInfo info = {};    ///< metadata besides values and grid
};

/// Opens an image to be read layer by layer. Grid and values are those of read_image, except that uint32, int64 and
/// uint64 become double. Formats: NIfTI, NRRD and MetaImage, compressed or not; variables of netCDF files and datasets
/// of HDF5 files; DICOM, slice by slice. The file stays open as long as the reader exists. Memory: one layer, or all
/// layers of one compressed block of a netCDF-4 or HDF5 file if these take at most 256 MiB. Compressed and text files
/// of NIfTI, NRRD and MetaImage are read in one pass if layers are requested in ascending order; a layer before the
/// last one starts a new pass. Errors: those of read_image, here or in read() (faults in compressed samples are found
/// when they are read); UnsupportedData for a netCDF file that is gzipped as a whole, and for an NRRD list of images
/// whose axis is not the last one in the file.
OpenLayersResult open_layers(const std::filesystem::path& path, const ReadImageOptions& options = {});
/// As above, with `variable` as in ReadImageOptions and other options by default.
OpenLayersResult open_layers(const std::filesystem::path& path, const std::string& variable);

/// The layout of a headerless raw file: contiguous values, axis 0 fastest.
struct RawLayout {
  std::vector<std::size_t> sizes = {};       ///< sizes of 2 to 4 axes
  std::string type = {};                     ///< "uint8", "int8", "uint16", "int16", "int32", "float" or "double"
  std::uint64_t offset = 0;                  ///< bytes before the first value
  bool big_endian = false;                   ///< byte order of values
  std::vector<double> spacing = {};          ///< distance of adjacent samples by axis, not 0; empty: 1
  std::vector<double> origin = {};           ///< coordinates of the first sample; empty: 0
  std::vector<std::string> axis_names = {};  ///< empty: x, y, z, t
  std::vector<std::string> axis_units = {};  ///< empty: none
};

/// Opens a headerless raw file to be read layer by layer. Errors: FileNotFound; InvalidArgument (the layout: an invalid
/// size, spacing or origin, or lists of another length than `sizes`); MalformedFile if the file is shorter than the
/// layout requires.
OpenLayersResult open_raw_layers(const std::filesystem::path& path, const RawLayout& layout);

/// A mesh in the form that files store: d-simplices in space_dim-space. A 4D contour has d = 3, space_dim = 4.
struct Mesh {
  int dim = 2;                                     ///< dimension of the simplices
  int space_dim = 3;                               ///< number of coordinates of a vertex
  Buffer<double> coordinates = {};                 ///< #V x space_dim, row = vertex
  Buffer<double> normals = {};                     ///< #V x space_dim, of length 1 or 0; or empty
  Buffer<Index> simplices = {};                    ///< #S x (dim + 1), row = simplex
  std::vector<std::string> axis_names = {};        ///< space_dim names, may be empty
  std::vector<std::string> axis_units = {};        ///< space_dim units, may be empty
  std::vector<Attribute> vertex_attributes = {};   ///< #V rows each; names are unique and not empty
  std::vector<Attribute> simplex_attributes = {};  ///< #S rows each; names are unique and not empty
  std::optional<double> isovalue = {};             ///< of the contour, if known; finite
  /// Coordinates and normals have at most single precision. Formats with both types then store float, and 32-bit vertex
  /// numbers. Coordinates that float does not represent are rounded.
  bool single_precision = false;
};

/// Compression of a file's arrays: deflate is lossless, for formats whose readers all support it.
enum class Compression : std::uint8_t { none, deflate };

/// The meshes that a file format supports.
struct MeshFileFormat {
  std::string_view extension = {};  ///< with the dot, in lower case
  int least_dim = 0;                ///< minimum dimension of simplices
  int most_dim = 0;                 ///< maximum dimension; 3: in 4-space
};

/// The formats of read_mesh and write_mesh, by extension.
std::span<const MeshFileFormat> mesh_file_formats() noexcept;

/// The format for a file's extension, in upper or lower case; null if it is unknown.
const MeshFileFormat* find_mesh_file_format(const std::filesystem::path& path);

/// Converts a contour to a mesh with names, units, normals and attributes; `single_precision` is set for Real = float.
/// Copies all data.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Mesh to_mesh(const Contour<N, Real>& contour);
/// Converts a mesh with dim = N - 1 and space_dim = N to a contour. Planar meshes read from 3D files (dim 1, all z = 0)
/// become N = 2; their normals lose z. Throws UnsupportedData for other meshes.
template <int N>
requires DimensionBetween<N, 2, 4> Contour<N, double> to_contour(const Mesh& mesh);

/// Writes a mesh; the extension selects the format. Supported meshes: .ply, .obj (text; both lossless) and .gltf/.glb
/// (coordinates as float): segments and triangles in the plane or in space; .stl (binary, float): triangles only;
/// .vtkhdf (lossless): segments, triangles and 4D contours, as tetrahedra with t as a point array.
///
/// Normals: nx, ny, nz (.ply), vn (.obj), NORMAL (.gltf/.glb; 0 becomes (0, 0, 1), as the format requires length 1),
/// the point arrays Normals and, in 4-space, normal_t (.vtkhdf). .stl stores the normals of its triangles instead.
///
/// Attributes: properties of vertices and of faces or edges (.ply), point and cell arrays (.vtkhdf; both as double,
/// with names and units), and _NAME attributes of vertices (.gltf/.glb; as float, of up to four numbers; wider
/// attributes and those of simplices are left out). The isovalue: the field array `isovalue` (.vtkhdf), a comment
/// (.ply), or asset.extras (.gltf/.glb). .stl and .obj cannot hold attributes, isovalue, names and units, which are
/// left out.
///
/// Written to a temporary name beside the target and renamed at the end, so there is never a partial file. An empty
/// mesh gives a valid file. Errors: UnsupportedFormat (the extension, or one that cannot hold this mesh),
/// InvalidArgument (an inconsistent mesh), UnsupportedData (.gltf, .stl: coordinates or attributes beyond float; .obj:
/// not finite), TooLarge (.glb beyond 4 GiB, .stl beyond 2^32 - 1 triangles), WriteFailed, Cancelled.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress = {},
                Compression compression = Compression::none);

/// Writes text unchanged: tables and graphs. The file appears complete or not at all. Errors: WriteFailed.
void write_text(std::string_view text, const std::filesystem::path& path);

/// Writes a contour's facets without triangulation; the extension selects the format. .vtu (XML, raw appended data)
/// holds the segments of 2D contours (VTK_LINE), the polygons of 3D ones (VTK_POLYGON) and the polyhedra of 4D ones
/// (VTK_POLYHEDRON, with t as a point array). .vtkhdf holds the first two; VTK 9.1 does not read its polyhedra.
/// Vertices, names, units, normals and compression as in write_mesh, lossless. Polygons of a polyhedron are oriented as
/// parts of its boundary. Cell arrays: `sample` and `signature`, as in FacetPlace, and `cap`, 1 for caps. For Real =
/// float, vertices and normals are float and vertex numbers have 32 bits. There is never a partial file. Memory: a few
/// numbers per facet; for compressed .vtu the size of the file. Errors: UnsupportedFormat, WriteFailed, Cancelled.
/// read_mesh does not read polygons and polyhedra.
template <int N, class Real>
void write_facets(const FacetHierarchy<N, Real>& facets, const std::filesystem::path& path,
                  const Progress& progress = {}, Compression compression = Compression::none);

/// A VTKHDF file (.vtkhdf) that a streamed contour is written to in parts. It has the datasets and bytes that
/// write_mesh writes for the whole contour (except that vertex numbers have 64 bits also for Real = float). Written to
/// a temporary name: the target appears only with `commit`. Memory: a few MiB. Errors of all functions: WriteFailed;
/// UnsupportedFormat for another extension.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
class ContourFile final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  /// `grid` gives names and units of the axes; the isovalue is stored as in Mesh.
  ContourFile(const std::filesystem::path& path, const Grid<N>& grid, std::optional<double> isovalue = {},
              Compression compression = Compression::none);
  ~ContourFile() override;
  void add_vertices(std::span<const Vertex> vertices) override;
  void add_normals(std::span<const Vertex> normals) override;
  void add_simplices(std::span<const Simplex> simplices) override;
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override;
  /// Completes the file and moves it to the target. Call it once, after all parts were added.
  void commit();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Options of read_mesh.
struct ReadMeshOptions {
  Progress progress = {};  ///< see Progress
  /// Also reads files that the mesh's file names outside of its own folder and the folders below it: buffers of glTF;
  /// external links, external storage and virtual datasets of HDF5. By default these are refused with UnsupportedData.
  bool allow_outside_paths = false;
  bool separate_process = false;  ///< as in ReadImageOptions; for VTKHDF
};

/// Reads the formats of write_mesh, written by this library or others. PLY: also text and big-endian; polygons are
/// triangulated as fans. glTF: node transformations are applied. .stl: only triangles with float coordinates; vertices
/// with equal coordinates become one. .obj: vertices with their numbers and all digits; triangles (polygons as fans),
/// or segments if there are no faces; normals if every corner of a face has the normal of its vertex's number. Empty
/// .stl and .obj files are refused.
///
/// The other formats give normals if all vertices have them, and attributes. From other programs these are any named
/// numbers (PLY: scalar properties; VTKHDF: arrays of one or two dimensions; glTF: _NAME as float). Files of write_mesh
/// in these formats are read with the same numbering, names, units and isovalue; .obj with the same numbering.
///
/// Counts and sizes in a file are checked before memory is allocated for them. A small file may describe a large mesh
/// (glTF: nodes that share a mesh; VTKHDF: compressed arrays): instances are limited to 64 times the file's bytes plus
/// 64 MiB, arrays to 4096 times the bytes stored for them.
///
/// Errors: FileNotFound, MalformedFile, UnsupportedFormat, UnsupportedData (also a further file outside of the folder,
/// see ReadMeshOptions), TooLarge, Cancelled.
Mesh read_mesh(const std::filesystem::path& path, const ReadMeshOptions& options);
/// Reads a mesh with default options and this progress callback.
Mesh read_mesh(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace tegl
