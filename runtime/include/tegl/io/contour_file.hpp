// SPDX-License-Identifier: BSD-3-Clause
//
// Files of contours that are written in parts, for contours larger than memory. Link with tegl::io; the rules for
// threads in tegl/io.hpp apply.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "tegl/grid.hpp"
#include "tegl/io/write_options.hpp"
#include "tegl/stream.hpp"

namespace tegl {

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
  /// `grid` gives names and units of the axes; the isovalue is stored as in Mesh. `periods`: those of the extraction,
  /// stored as Mesh::periods.
  ContourFile(const std::filesystem::path& path, const Grid<N>& grid, std::optional<double> isovalue = {},
              Compression compression = Compression::none, const AxisPeriods<N>& periods = {});
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

}  // namespace tegl
