// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of tesseracts whose ambiguous faces are resolved from the data. They are computed for each tile: there are
// too many cases for tables.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "facets/facet_tables.hpp"

namespace tegl::detail {

/// Processes one tesseract at a time. Use one object per thread.
class ResolvedFacets {
 public:
  static constexpr std::uint16_t kNone = ResolvedCubes::kNone;  ///< a cube without a contour

  /// The tables must outlive it.
  explicit ResolvedFacets(const FacetTables& tables) : tables_(&tables) {}

  /// Starts a tesseract with these high corners, whose cube 2 a + side has the given type. Returns the number of
  /// components of the contour on its boundary (Sigma).
  std::size_t begin(std::uint16_t signature, const std::array<std::uint16_t, 8>& cubes);

  /// Computes its facets. `choice`: sign of its centre. separate: each sphere bounds its own facet, and other
  /// components are filled as with a low centre. low, high: all components around one boundary region of the other sign
  /// (high regions for low, low ones for high) bound one facet, which is a copy of that region, moved inwards.
  void fill(tile::Choice choice);

  [[nodiscard]] unsigned count() const noexcept { return static_cast<unsigned>(first_.size() - 1); }
  [[nodiscard]] std::size_t entry_count() const noexcept { return entries_.size(); }
  /// Boundary of facet `number`: polygons, by cube and number.
  [[nodiscard]] std::span<const FacetEntry> entries(unsigned number) const noexcept {
    return {entries_.data() + first_[number], first_[number + 1] - first_[number]};
  }

 private:
  struct Part {
    FacetEntry entry;
    std::uint8_t sides;    ///< number of sides of the polygon
    std::uint64_t points;  ///< as ResolvedCubes::Part::vertices
    std::uint8_t component;
  };
  [[nodiscard]] bool is_sphere(std::size_t component) const noexcept;
  [[nodiscard]] std::uint32_t region(std::size_t component, bool high) const noexcept;

  const FacetTables* tables_;
  std::uint16_t signature_ = 0;
  std::array<std::uint16_t, 8> cubes_{};
  std::vector<Part> parts_;
  std::vector<bool> is_known_;             ///< by part: whether its component is known
  std::vector<std::uint64_t> components_;  ///< the points of each component
  std::vector<std::size_t> facet_of_;      ///< by component: the first component of its facet
  std::vector<FacetEntry> entries_;
  std::vector<std::size_t> first_;
};

}  // namespace tegl::detail
