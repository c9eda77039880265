// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes in files: PLY, STL, OBJ, glTF, VTKHDF. Link with tegl::io; the rules for threads in tegl/io.hpp apply.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/io/mesh_array.hpp"
#include "tegl/io/write_options.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// A mesh in the form that files store: d-simplices in space_dim-space. A 4D contour has d = 3, space_dim = 4; a 5D
/// contour d = 4, space_dim = 5.
struct Mesh {
  int dim = 2;                                     ///< dimension of the simplices
  int space_dim = 3;                               ///< number of coordinates of a vertex
  MeshArray<double> coordinates = {};              ///< #V x space_dim, row = vertex
  MeshArray<double> normals = {};                  ///< #V x space_dim, of length 1 or 0; or empty
  MeshArray<Index> simplices = {};                 ///< #S x (dim + 1), row = simplex
  std::vector<std::string> axis_names = {};        ///< space_dim names, may be empty
  std::vector<std::string> axis_units = {};        ///< space_dim units, may be empty
  std::vector<Attribute> vertex_attributes = {};   ///< #V rows each; names are unique and not empty
  std::vector<Attribute> simplex_attributes = {};  ///< #S rows each; names are unique and not empty
  std::optional<double> isovalue = {};             ///< of the contour, if known; finite
  /// Of a wrapped contour (Contour::periods): for each period `vector`, `dual` and `start`, 2 space_dim + 1 numbers.
  std::vector<double> periods = {};
  /// Coordinates and normals have at most single precision. Formats with both types then store float, and 32-bit vertex
  /// numbers. Coordinates that float does not represent are rounded.
  bool single_precision = false;
};

/// Coordinates or normals, in single or double precision; owns nothing.
class CoordinateView {
 public:
  CoordinateView() = default;                                             ///< none
  CoordinateView(std::span<const float> numbers) : numbers_(numbers) {}   ///< in single precision
  CoordinateView(std::span<const double> numbers) : numbers_(numbers) {}  ///< in double precision
  [[nodiscard]] std::size_t size() const noexcept {                       ///< how many numbers
    return std::visit([](const auto& numbers) { return numbers.size(); }, numbers_);
  }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }  ///< whether size() is 0
  [[nodiscard]] double operator[](std::size_t i) const noexcept {    ///< number i < size()
    const auto* const full = std::get_if<std::span<const double>>(&numbers_);
    return full != nullptr ? (*full)[i] : static_cast<double>((*std::get_if<std::span<const float>>(&numbers_))[i]);
  }
  /// Calls f with the span of numbers, of float or double.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), numbers_);
  }

 private:
  std::variant<std::span<const double>, std::span<const float>> numbers_;
};

/// A mesh or a contour to be written, without a copy: refers to its arrays, names and attributes, which must live and
/// stay unchanged as long as the view.
struct MeshView {
  int dim = 2;                                         ///< as in Mesh
  int space_dim = 3;                                   ///< as in Mesh
  CoordinateView coordinates = {};                     ///< as in Mesh
  CoordinateView normals = {};                         ///< as in Mesh
  std::span<const Index> simplices = {};               ///< as in Mesh
  std::span<const std::string> axis_names = {};        ///< as in Mesh
  std::span<const std::string> axis_units = {};        ///< as in Mesh
  std::span<const Attribute> vertex_attributes = {};   ///< as in Mesh
  std::span<const Attribute> simplex_attributes = {};  ///< as in Mesh
  std::optional<double> isovalue = {};                 ///< as in Mesh
  std::vector<double> periods = {};                    ///< as in Mesh
  bool single_precision = false;                       ///< as in Mesh

  MeshView() = default;        ///< an empty mesh
  MeshView(const Mesh& mesh);  ///< all of the mesh
  /// All of the contour; `isovalue` is not set.
  template <int N, Coordinate Real>
  requires DimensionBetween<N, 2, 5> MeshView(const Contour<N, Real>& contour);
  /// Deleted: the view of a temporary would dangle.
  MeshView(const Mesh&& mesh) = delete;
  /// Deleted: the view of a temporary would dangle.
  template <int N, Coordinate Real>
  requires DimensionBetween<N, 2, 5> MeshView(const Contour<N, Real>&& contour)
  = delete;
};

/// Converts a contour to a mesh with names, units, normals and attributes; `single_precision` is set for Real = float.
/// Copies all data. write_mesh also takes contours and needs no Mesh.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Mesh to_mesh(const Contour<N, Real>& contour);
/// Takes the contour's memory over: simplices, attributes and, for Real = double, coordinates and normals are not
/// copied.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Mesh to_mesh(Contour<N, Real>&& contour);
/// Converts a mesh with dim = N - 1 and space_dim = N to a contour. Planar meshes read from 3D files (dim 1, all z = 0)
/// become N = 2; their normals lose z. Throws UnsupportedData for other meshes.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, double> to_contour(const Mesh& mesh);
/// Takes the mesh's memory over: attributes, and arrays that hold rows as a contour has them. Other arrays are freed as
/// soon as they are copied (but arrays of planar meshes with the mesh). After UnsupportedData the mesh is unchanged.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, double> to_contour(Mesh&& mesh);

/// The meshes that a file format supports.
struct MeshFileFormat {
  std::string_view extension = {};  ///< with the dot, in lower case
  int least_dim = 0;                ///< minimum dimension of simplices
  int most_dim = 0;                 ///< maximum dimension; 3: in 4-space; 4: in 5-space
};

/// The formats of read_mesh and write_mesh, by extension.
[[nodiscard]] std::span<const MeshFileFormat> mesh_file_formats() noexcept;

/// The format for a file's extension, in upper or lower case; null if it is unknown.
[[nodiscard]] const MeshFileFormat* find_mesh_file_format(const std::filesystem::path& path);

/// Writes a mesh or a contour; the extension selects the format. Supported meshes: .ply, .obj (text; both lossless) and
/// .gltf/.glb (coordinates as float): segments and triangles in the plane or in space; .stl (binary, float): triangles
/// only; .vtkhdf (lossless): segments, triangles, 4D contours, as tetrahedra with t as a point array, and 5D contours.
/// VTK has no 4-simplices: those of a 5D contour are poly-vertex cells of 5 points, with t and u as point arrays.
///
/// Normals: nx, ny, nz (.ply), vn (.obj), NORMAL (.gltf/.glb; 0 becomes (0, 0, 1), as the format requires length 1),
/// the point arrays Normals and, in 4-space and 5-space, normal_t and normal_u (.vtkhdf). .stl stores the normals of
/// its triangles instead.
///
/// Attributes: properties of vertices and of faces or edges (.ply), point and cell arrays (.vtkhdf; both as double,
/// with names and units), and _NAME attributes of vertices (.gltf/.glb; as float, of up to four numbers; wider
/// attributes and those of simplices are left out). The isovalue: the field array `isovalue` (.vtkhdf), a comment
/// (.ply), or asset.extras (.gltf/.glb). .stl and .obj cannot hold attributes, isovalue, names and units, which are
/// left out. Periods: the field array `periods` (.vtkhdf); other formats refuse them.
///
/// Written to a temporary name beside the target and renamed at the end, so there is never a partial file. An empty
/// mesh gives a valid file. Errors: UnsupportedFormat (the extension, or one that cannot hold this mesh),
/// InvalidArgument (an inconsistent mesh), UnsupportedData (.gltf, .stl: coordinates or attributes beyond float; .obj:
/// not finite), TooLarge (.glb beyond 4 GiB, .stl beyond 2^32 - 1 triangles), WriteFailed, Cancelled.
void write_mesh(const MeshView& mesh, const std::filesystem::path& path, const WriteOptions& options = {});
/// As above, also for temporaries.
inline void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const WriteOptions& options = {}) {
  write_mesh(MeshView(mesh), path, options);
}
/// As above, also for temporaries.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
void write_mesh(const Contour<N, Real>& contour, const std::filesystem::path& path, const WriteOptions& options = {}) {
  write_mesh(MeshView(contour), path, options);
}

/// Options of read_mesh.
struct ReadMeshOptions {
  WorkOptions work = {};  ///< progress; files are read by one thread
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
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path, const ReadMeshOptions& options = {});

}  // namespace tegl
