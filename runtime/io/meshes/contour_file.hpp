// SPDX-License-Identifier: BSD-3-Clause
//
// Streaming of contours to a pending file: for the program, which puts several files in place together.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "tegl/grid.hpp"
#include "tegl/io/write_options.hpp"
#include "tegl/stream.hpp"

namespace tegl {

class PendingPath;

/// As ContourFile of tegl/io/contour_file.hpp, to a pending file, which must live as long; the caller commits it.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
class PendingContour final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  PendingContour(const PendingPath& file, const Grid<N>& grid, std::optional<double> isovalue, Compression compression,
                 const AxisPeriods<N>& periods);
  ~PendingContour() override;
  void add_vertices(std::span<const Vertex> vertices) override;
  void add_normals(std::span<const Vertex> normals) override;
  void add_simplices(std::span<const Simplex> simplices) override;
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override;
  /// Completes and closes the file. Call it once, after all parts were added.
  void close();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tegl
