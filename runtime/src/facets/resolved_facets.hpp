// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of tesseracts whose faces the data resolve, found tile by tile: there are too many kinds of these for
// tables.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "facets/facet_tables.hpp"

namespace tegl::detail {

/// One tesseract after the other: an object for each thread.
class ResolvedFacets {
 public:
  static constexpr std::uint16_t kNone = ResolvedCubes::kNone;  ///< a cube without a contour

  /// The tables must outlive it.
  explicit ResolvedFacets(const FacetTables& tables) : tables_(&tables) {}

  /// A tesseract with these high corners, whose cube 2 a + side has this type. Returns how many components there are of
  /// what the contour has on its boundary (Sigma).
  std::size_t begin(std::uint16_t signature, const std::array<std::uint16_t, 8>& cubes);

  /// Makes its facets. `choice`: of its centre. separate: each sphere bounds a facet of its own, and what is none is
  /// filled as by a low centre; low, high: so does what is around a part of the boundary of the other sign, the high
  /// parts or the low ones. (A copy of that part, moved inwards, is the facet.)
  void fill(facets::Choice choice);

  [[nodiscard]] unsigned count() const noexcept { return static_cast<unsigned>(first_.size() - 1); }
  [[nodiscard]] std::size_t entry_count() const noexcept { return entries_.size(); }
  /// What bounds facet `number`: polygons, by cube and number.
  [[nodiscard]] std::span<const FacetEntry> entries(unsigned number) const noexcept {
    return {entries_.data() + first_[number], first_[number + 1] - first_[number]};
  }

 private:
  struct Part {
    FacetEntry entry;
    std::uint8_t sides;    ///< of the polygon
    std::uint64_t points;  ///< as ResolvedCubes::Part::vertices
    std::uint8_t component;
  };
  [[nodiscard]] bool is_sphere(std::size_t component) const noexcept;
  [[nodiscard]] std::uint32_t region(std::size_t component, bool high) const noexcept;

  const FacetTables* tables_;
  std::uint16_t signature_ = 0;
  std::array<std::uint16_t, 8> cubes_{};
  std::vector<Part> parts_;
  std::vector<bool> is_known_;             ///< by part: whether its component is
  std::vector<std::uint64_t> components_;  ///< their points
  std::vector<std::size_t> facet_of_;      ///< by component: the first one of its facet
  std::vector<FacetEntry> entries_;
  std::vector<std::size_t> first_;
};

}  // namespace tegl::detail
