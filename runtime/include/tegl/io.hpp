// SPDX-License-Identifier: BSD-3-Clause
//
// Files in, files out. Link with tegl::io.
//
// Nothing here is thread-safe, not even on different files: the libraries behind some formats (netCDF, HDF5) keep
// global state. Nothing is printed.
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

namespace tegl {

/// An image of any value type in N dimensions.
template <int N>
using AnyImageN =
    std::variant<OwnedImage<std::uint8_t, N>, OwnedImage<std::int8_t, N>, OwnedImage<std::uint16_t, N>,
                 OwnedImage<std::int16_t, N>, OwnedImage<std::int32_t, N>, OwnedImage<float, N>, OwnedImage<double, N>>;
/// An image of any value type in 2, 3 or 4 dimensions.
using AnyImage = std::variant<AnyImageN<2>, AnyImageN<3>, AnyImageN<4>>;

/// Where the coordinates of an axis grow to, as far as a file says so: the depths of an ocean and the pressures of an
/// atmosphere grow downwards.
enum class AxisDirection : std::uint8_t { unknown, up, down };

/// What a file says beyond values and grid.
struct ImageInfo {
  std::string format = {};                          ///< "NIfTI", "NRRD", "MetaImage", "netCDF", "DICOM", "raw"
  std::string variable = {};                        ///< netCDF: the variable read
  std::vector<std::string> variables = {};          ///< netCDF: all that can be read as an image
  std::string value_unit = {};                      ///< such as "degC"; may be empty
  std::string value_name = {};                      ///< long name; may be empty
  std::string world_frame = {};                     ///< such as "RAS", "LPS", "" where there is none
  std::string stored_type = {};                     ///< value type in the file, before any conversion
  std::vector<AxisDirection> axis_directions = {};  ///< netCDF: of each axis of the image; else empty
  std::vector<std::string> remarks = {};  ///< DICOM: what was left out, slices at uneven distances; else empty
};

/// An image, and what its file says of it.
struct ReadImageResult {
  AnyImage image = {};  ///< values and grid
  ImageInfo info = {};  ///< beyond these
};

/// One index of a dimension of a netCDF variable.
struct FixedIndex {
  std::string dimension = {};  ///< its name in the file
  std::size_t index = 0;       ///< 0 is the first
};

/// What to read of a file.
struct ReadImageOptions {
  std::string variable =
      {};                  ///< netCDF: which; DICOM: which series, by UID, description or number; empty: the only one
  Progress progress = {};  ///< see Progress
  /// netCDF: only the samples at these indices are read, and the image does not have these dimensions as axes.
  std::vector<FixedIndex> fixed = {};
  /// Headers may name a file of samples (NRRD `data file`, MetaImage `ElementDataFile`). It is read if it lies in the
  /// header's folder or below, with symbolic links resolved; with this option, wherever it lies.
  bool allow_outside_paths = false;
  /// Reads formats whose libraries some damaged files bring down, HDF5 (netCDF-4) and DCMTK, in a child process with
  /// limits of memory and time: if it crashes, loops or needs too much memory, the error is MalformedFile. The values
  /// are the same, in memory that the child has filled, without a copy. A child takes a few milliseconds to start, and
  /// some 20 ms more for each gigabyte that this process has in small pages. Other threads may run meanwhile. Linux.
  bool separate_process = false;
};

/// Reads NIfTI-1 (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr; raw, gzip, ascii, hex; one data file), MetaImage
/// (.mha, .mhd; one data file) and netCDF (.nc, .cdf, .nc4; also gzipped as a whole). A file of another extension is
/// recognised by its first bytes. With DCMTK also DICOM: a file, a DICOMDIR, or a folder with all below it, whose
/// slices are sorted by place, and by time where several lie at one place. What is no DICOM there, or has colours, is
/// left out, and slices at uneven distances make a rectilinear axis: ImageInfo::remarks says so.
///
/// Axes: the one that runs fastest in the file is axis 0, time is last. Trailing axes of one sample are dropped
/// (netCDF: wherever they are); what is left must be 2, 3 or 4 axes. Units as the file states them. Orientations that
/// couple axes become Grid::linear and offset, exact even if sheared; others go into the axes. NRRD spaces RAS and LAS
/// are turned to LPS. Values: as stored; uint32, int64 and uint64 as int32 if all fit, else as double. NIfTI slope and
/// intercept and netCDF packing are applied, and netCDF's missing values are NaN: in float, or in double for what float
/// cannot hold.
///
/// Errors, all naming the file: FileNotFound, MalformedFile (damaged, cut short or contradicting itself; compressed
/// data are checked to the last byte), UnsupportedFormat, UnsupportedData (colours, vectors, other than 2 to 4 axes),
/// VariableNotFound (listing what there is), InvalidGrid (a coordinate variable that is not monotone), InvalidArgument
/// (a variable or a fixed index for a format without names; a fixed dimension or index that the variable does not
/// have), TooLarge, Cancelled. A file of samples outside of the header's folder is UnsupportedData. Memory: up to three
/// times the values; a damaged file takes no more than its bytes can hold.
ReadImageResult read_image(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// A variable that can be read as an image.
struct ImageVariable {
  std::string name = {};  ///< as ReadImageOptions::variable takes it
  std::vector<std::size_t> sizes =
      {};                      ///< of its axes longer than 1, as in the image: axis 0, which runs fastest, first
  std::string unit = {};       ///< may be empty
  std::string long_name = {};  ///< may be empty
  std::vector<std::string> axes = {};  ///< netCDF: names of the dimensions, in the order of `sizes`
};

/// The variables that ReadImageOptions::variable may name in a netCDF file, or the series in DICOM (the description as
/// long_name); none for the other formats, whose files hold one image without a name. Variables of more than 4 axes
/// need ReadImageOptions::fixed to be read. Reads no values. Errors: those of read_image.
std::vector<ImageVariable> list_image_variables(const std::filesystem::path& path,
                                                const ReadImageOptions& options = {});

/// The layers of an image of any value type in N dimensions.
template <int N>
using AnyLayersN =
    std::variant<std::unique_ptr<LayerReader<std::uint8_t, N>>, std::unique_ptr<LayerReader<std::int8_t, N>>,
                 std::unique_ptr<LayerReader<std::uint16_t, N>>, std::unique_ptr<LayerReader<std::int16_t, N>>,
                 std::unique_ptr<LayerReader<std::int32_t, N>>, std::unique_ptr<LayerReader<float, N>>,
                 std::unique_ptr<LayerReader<double, N>>>;
/// The layers of an image of any value type in 2, 3 or 4 dimensions.
using AnyLayers = std::variant<AnyLayersN<2>, AnyLayersN<3>, AnyLayersN<4>>;

/// An image to be read layer by layer, and what its file says of it.
struct OpenLayersResult {
  AnyLayers layers = {};  ///< of whatever type and dimension
  ImageInfo info = {};    ///< beyond values and grid
};

/// Opens an image to be read layer by layer, with the grid and values that read_image gives (uint32, int64 and uint64
/// as double): NIfTI, NRRD and MetaImage, compressed or not; variables of netCDF files and datasets of HDF5 files;
/// DICOM, slice by slice. The file stays open as long as the layers live. Memory: a layer, or as many as lie in one
/// compressed block of a netCDF-4 or HDF5 file, if these are no more than 256 MiB. NIfTI, NRRD and MetaImage files that
/// are compressed or text are read in one pass if layers are read in ascending order; a layer before the last one read
/// starts a new pass. Errors: those of read_image, now or by read() (what is wrong with compressed samples is found
/// when they are read); UnsupportedData for a netCDF file that is gzipped as a whole, and for an NRRD list of images
/// whose axis is not the last one in the file.
OpenLayersResult open_layers(const std::filesystem::path& path, const ReadImageOptions& options = {});
/// As above; `variable` as in ReadImageOptions.
OpenLayersResult open_layers(const std::filesystem::path& path, const std::string& variable);

/// Values that lie in a file one after the other, axis 0 fastest.
struct RawLayout {
  std::vector<std::size_t> sizes = {};       ///< of 2 to 4 axes
  std::string type = {};                     ///< "uint8", "int8", "uint16", "int16", "int32", "float" or "double"
  std::uint64_t offset = 0;                  ///< bytes before the first value
  bool big_endian = false;                   ///< the order of a value's bytes
  std::vector<double> spacing = {};          ///< distance of neighbouring samples along each axis, not 0; empty: 1
  std::vector<double> origin = {};           ///< coordinates of the first sample; empty: 0
  std::vector<std::string> axis_names = {};  ///< empty: x, y, z, t
  std::vector<std::string> axis_units = {};  ///< empty: none
};

/// Opens a file that holds nothing but values, to be read layer by layer. Errors: FileNotFound; InvalidArgument (the
/// layout: a size, a spacing or an origin that cannot be, or lists of another length than `sizes`); MalformedFile if
/// the file is shorter than the layout needs.
OpenLayersResult open_raw_layers(const std::filesystem::path& path, const RawLayout& layout);

/// A mesh as files hold it: d-simplices in space_dim-space. A 4D contour: d = 3, space_dim = 4.
struct Mesh {
  int dim = 2;                                     ///< of the simplices
  int space_dim = 3;                               ///< of the coordinates
  Buffer<double> coordinates = {};                 ///< #V x space_dim, row = vertex
  Buffer<double> normals = {};                     ///< as many, of length 1 or 0; or none
  Buffer<Index> simplices = {};                    ///< #S x (dim + 1), row = simplex
  std::vector<std::string> axis_names = {};        ///< space_dim names, may be empty
  std::vector<std::string> axis_units = {};        ///< as many, may be empty
  std::vector<Attribute> vertex_attributes = {};   ///< rows as many as vertices; names not empty and different
  std::vector<Attribute> simplex_attributes = {};  ///< likewise, as many as simplices
  std::optional<double> isovalue = {};             ///< of the contour, where it is known; finite
  /// Coordinates and normals hold no more than single precision: files get them as float if their format has both
  /// types, and vertex numbers of 32 bits. Coordinates that float does not represent are rounded then.
  bool single_precision = false;
};

/// Whether a file's arrays are compressed: by deflate, without loss, in formats whose readers all know that.
enum class Compression : std::uint8_t { none, deflate };

/// What a file with a certain extension holds.
struct MeshFileFormat {
  std::string_view extension = {};  ///< with its dot, in lower case
  int least_dim = 0;                ///< simplices from this dimension
  int most_dim = 0;                 ///< up to this one; 3: in 4-space as well
};

/// The formats of read_mesh and write_mesh, by extension.
std::span<const MeshFileFormat> mesh_file_formats() noexcept;

/// The format that a file's extension tells, in upper or lower case; null if it tells none.
const MeshFileFormat* find_mesh_file_format(const std::filesystem::path& path);

/// The contour as files hold it, with names, units, normals and attributes; `single_precision` for Real = float. Copies
/// all of them.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Mesh to_mesh(const Contour<N, Real>& contour);
/// The contour of a mesh with dim = N - 1 and space_dim = N (planar meshes read back from 3D files:
/// dim 1 with all z = 0 become N = 2; normals lose their z). Throws UnsupportedData otherwise.
template <int N>
requires DimensionBetween<N, 2, 4> Contour<N, double> to_contour(const Mesh& mesh);

/// Writes by extension: .ply, .obj (text; both lossless) and .gltf/.glb (coordinates as float) hold segments and
/// triangles in the plane or in space; .stl (binary, float) triangles alone; .vtkhdf (lossless) segments, triangles and
/// 4D contours, as tetrahedra with t as a point array. Normals go into all but .stl, which has the facets' own: as nx,
/// ny, nz (.ply), vn (.obj), NORMAL (.gltf/.glb; 0 as (0, 0, 1), as the format has none of length 0), and the point
/// arrays Normals and, in 4-space, normal_t (.vtkhdf). Attributes become properties of vertices and of faces or edges
/// (.ply), point and cell arrays (.vtkhdf; both as double, with names and units), and _NAME attributes of vertices
/// (.gltf/.glb; as float, of up to four numbers: others, and those of simplices, have no place there and are left
/// out). The isovalue goes into the field array `isovalue` (.vtkhdf), a comment (.ply), or asset.extras. .stl and .obj
/// have no place for attributes, isovalue, names and units: these are left out. Written under another name beside the
/// target and renamed at the end: never half a file. An empty mesh gives a valid file.
/// Errors: UnsupportedFormat (the extension, or one that cannot hold this mesh), InvalidArgument (a mesh that
/// contradicts itself), UnsupportedData (.gltf, .stl: coordinates or attributes beyond float; .obj: not finite),
/// TooLarge (.glb beyond 4 GiB, .stl beyond 2^32 - 1 triangles), WriteFailed, Cancelled.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress = {},
                Compression compression = Compression::none);

/// Writes bytes as they are: tables and graphs as text. Under another name first, so never half a file. Errors:
/// WriteFailed.
void write_text(std::string_view text, const std::filesystem::path& path);

/// Writes the contour's facets without triangulation, by extension: .vtu (XML, raw appended data) holds the segments of
/// 2D contours (VTK_LINE), the polygons of 3D ones (VTK_POLYGON) and the polyhedra of 4D ones (VTK_POLYHEDRON, with t
/// as a point array); .vtkhdf the first two, as its polyhedra came after the versions that VTK 9.1 reads. Points, and
/// what else is lossless, as write_mesh does it. Polygons of a polyhedron are oriented as parts of its boundary. Cell
/// arrays: `sample` and `signature`, as in FacetPlace, and `cap`, 1 for parts of the border. Points and normals are
/// float for Real = float, and vertex numbers have 32 bits then. Never half a file. Memory: that of a few numbers per
/// facet, and in .vtu with compression that of the file. Errors: UnsupportedFormat, WriteFailed, Cancelled. read_mesh
/// does not read polygons and polyhedra.
template <int N, class Real>
void write_facets(const FacetHierarchy<N, Real>& facets, const std::filesystem::path& path,
                  const Progress& progress = {}, Compression compression = Compression::none);

/// A VTKHDF file (.vtkhdf) that a streamed contour goes to as it comes: what write_mesh would write of the whole
/// contour, the same datasets with the same bytes (for Real = float, vertex numbers have 64 bits here). Written under
/// another name beside the target: nothing is at the target before `commit`, nor ever if that is not called. Memory: a
/// few MiB. Errors, of all functions: WriteFailed; UnsupportedFormat for another extension.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
class ContourFile final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  /// The grid gives names and units of the axes; the isovalue is written as in Mesh.
  ContourFile(const std::filesystem::path& path, const Grid<N>& grid, std::optional<double> isovalue = {},
              Compression compression = Compression::none);
  ~ContourFile() override;
  void add_vertices(std::span<const Vertex> vertices) override;
  void add_normals(std::span<const Vertex> normals) override;
  void add_simplices(std::span<const Simplex> simplices) override;
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override;
  /// Completes the file and moves it to its target. Call it once, when all has come.
  void commit();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// How to read a mesh.
struct ReadMeshOptions {
  Progress progress = {};  ///< see Progress
  /// Also reads files that the mesh's file names outside of its own folder and the folders below it: buffers of glTF,
  /// external links, external storage and virtual datasets of HDF5. Otherwise these are refused with UnsupportedData.
  bool allow_outside_paths = false;
  bool separate_process = false;  ///< as in ReadImageOptions: for VTKHDF
};

/// Reads the formats of write_mesh, by this program or others (PLY: also text and big-endian; polygons are fanned into
/// triangles; glTF: nodes applied). Of .stl come triangles with coordinates as float, where vertices with equal
/// coordinates become one, and nothing else. Of .obj come the vertices as they are numbered, with all digits, and
/// triangles, polygons fanned, or segments, if there are none; normals where every corner of a face names the one of
/// its vertex's number. Empty ones of these two are refused.
/// Normals are read where one of the other formats has them for all vertices, and so are attributes: of other
/// programs any numbers by a name of their own (PLY: scalar properties; VTKHDF: arrays of one or two dimensions; glTF:
/// _NAME as float). What write_mesh wrote to these comes back with the same numbering, names, units and isovalue; to
/// .obj with the same numbering.
/// Counts and sizes of a file are checked before memory is taken for them. A small file may still describe a large
/// mesh (glTF: nodes that share a mesh; VTKHDF: compressed arrays): instances are limited to 64 times the file's bytes
/// plus 64 MiB, arrays to 4096 times the bytes that the file stores for them.
/// Errors: FileNotFound, MalformedFile, UnsupportedFormat, UnsupportedData (also a further file outside of the folder,
/// see ReadMeshOptions), TooLarge, Cancelled.
Mesh read_mesh(const std::filesystem::path& path, const ReadMeshOptions& options);
/// Reads a mesh with the default options and this progress.
Mesh read_mesh(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace tegl
