// SPDX-License-Identifier: BSD-3-Clause
//
// Implements ContourFile and PendingContour: streamed contours in VTKHDF files.
#include "meshes/contour_file.hpp"

#include <type_traits>

#include "base/common.hpp"
#include "base/pending_path.hpp"
#include "meshes/vtkhdf_names.hpp"
#include "meshes/vtkhdf_writer.hpp"
#include "tegl/io/contour_file.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl {

namespace fs = std::filesystem;

using namespace io_detail;

namespace {

void require_vtkhdf(const fs::path& path) {
  const MeshFileFormat* const format = find_mesh_file_format(path);
  if (format == nullptr || format->extension != ".vtkhdf")
    fail(ErrorCode::UnsupportedFormat, path, "'{}' cannot be written in parts; expected .vtkhdf",
         path.extension().string());
}

template <int N>
VtkhdfLayout layout_of(const fs::path& path, const Grid<N>& grid, std::optional<double> isovalue, bool single_precision,
                       Compression compression, const AxisPeriods<N>& periods) {
  require_vtkhdf(path);
  VtkhdfLayout layout;
  layout.dim = N - 1;
  layout.space_dim = N;
  layout.isovalue = isovalue;
  layout.single_precision = single_precision;
  layout.compression = compression;
  for (const Axis& axis : grid.axes) {
    layout.axis_names.push_back(axis.name);
    layout.axis_units.push_back(axis.unit);
  }
  layout.periods = period_numbers(contour_periods(grid, periods));
  return layout;
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct PendingContour<N, Real>::Parts {
  Parts(const PendingPath& file, const Grid<N>& grid, std::optional<double> isovalue, Compression compression,
        const AxisPeriods<N>& periods)
      : writer(file, layout_of(file.target(), grid, isovalue, std::is_same_v<Real, float>, compression, periods)) {}

  using Vertex = typename ContourSink<N, Real>::Vertex;
  /// Converts rows to double and passes them on in blocks.
  void append(std::span<const Vertex> rows, void (VtkhdfWriter::*append_block)(std::span<const double>)) {
    while (!rows.empty()) {
      const auto block = rows.first(std::min(kMostRows, rows.size()));
      numbers.clear();
      for (const Vertex& row : block) numbers.insert(numbers.end(), row.begin(), row.end());
      (writer.*append_block)(numbers);
      rows = rows.subspan(block.size());
    }
  }

  VtkhdfWriter writer;
  std::vector<double> numbers;  ///< rows of one block
};

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> PendingContour<N, Real>::PendingContour(const PendingPath& file, const Grid<N>& grid,
                                                                           std::optional<double> isovalue,
                                                                           Compression compression,
                                                                           const AxisPeriods<N>& periods)
    : parts_(std::make_unique<Parts>(file, grid, isovalue, compression, periods)) {}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> PendingContour<N, Real>::~PendingContour() = default;

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void PendingContour<N, Real>::add_vertices(std::span<const Vertex> vertices) {
  parts_->append(vertices, &VtkhdfWriter::append_vertices);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void PendingContour<N, Real>::add_normals(std::span<const Vertex> normals) {
  parts_->append(normals, &VtkhdfWriter::append_normals);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void PendingContour<N, Real>::add_simplices(std::span<const Simplex> simplices) {
  static_assert(sizeof(Simplex) == N * sizeof(std::uint64_t));
  if (!simplices.empty()) parts_->writer.append_simplices({simplices.data()->data(), simplices.size() * N});
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void PendingContour<N, Real>::replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) {
  parts_->writer.replace_corner(simplex, corner, vertex);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void PendingContour<N, Real>::close() { parts_->writer.close(); }

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct ContourFile<N, Real>::Parts {
  Parts(const fs::path& path, const Grid<N>& grid, std::optional<double> isovalue, Compression compression,
        const AxisPeriods<N>& periods)
      : file(path), contour(file, grid, isovalue, compression, periods) {}

  PendingPath file;
  PendingContour<N, Real> contour;
};

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> ContourFile<N, Real>::ContourFile(const fs::path& path, const Grid<N>& grid,
                                                                     std::optional<double> isovalue,
                                                                     Compression compression,
                                                                     const AxisPeriods<N>& periods)
    : parts_((require_vtkhdf(path), std::make_unique<Parts>(path, grid, isovalue, compression, periods))) {}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> ContourFile<N, Real>::~ContourFile() = default;

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void ContourFile<N, Real>::add_vertices(std::span<const Vertex> vertices) { parts_->contour.add_vertices(vertices); }

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void ContourFile<N, Real>::add_normals(std::span<const Vertex> normals) { parts_->contour.add_normals(normals); }

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void ContourFile<N, Real>::add_simplices(std::span<const Simplex> simplices) {
  parts_->contour.add_simplices(simplices);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void ContourFile<N, Real>::replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) {
  parts_->contour.replace_corner(simplex, corner, vertex);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void ContourFile<N, Real>::commit() {
  parts_->contour.close();
  parts_->file.commit();
}

template class PendingContour<2, float>;
template class PendingContour<2, double>;
template class PendingContour<3, float>;
template class PendingContour<3, double>;
template class PendingContour<4, float>;
template class PendingContour<4, double>;
template class ContourFile<2, float>;
template class ContourFile<2, double>;
template class ContourFile<3, float>;
template class ContourFile<3, double>;
template class ContourFile<4, float>;
template class ContourFile<4, double>;

}  // namespace tegl
