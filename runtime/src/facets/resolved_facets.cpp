// SPDX-License-Identifier: BSD-3-Clause
//
// Components of Sigma, and the components that bound one facet together; see resolved_facets.hpp.
#include "facets/resolved_facets.hpp"

#include <algorithm>
#include <bit>

#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {
namespace {

/// By square q: bit mask of its corners in the cube.
constexpr auto kSquareCorners = [] {
  std::array<std::uint8_t, 6> result{};
  for (unsigned q = 0; q < 6; ++q) result[q] = static_cast<std::uint8_t>(face_corners(3, q));
  return result;
}();

/// Corners of a cube of the tesseract, as corners of the tesseract.
std::uint32_t lifted_corners(unsigned cube, unsigned corners) noexcept {
  std::uint32_t result = 0;
  for (; corners != 0; corners &= corners - 1)
    result |= 1u << lifted_corner(cube, static_cast<unsigned>(std::countr_zero(corners)));
  return result;
}

}  // namespace

std::size_t ResolvedFacets::begin(std::uint16_t signature, const std::array<std::uint16_t, 8>& cubes) {
  const ResolvedCubes& tables = ResolvedCubes::instance();
  signature_ = signature;
  cubes_ = cubes;
  parts_.clear();
  components_.clear();
  // list the polygons of all cubes
  for (unsigned f = 0; f < 8; ++f) {
    if (cubes[f] == kNone) continue;
    for (unsigned number = 0; number < tables_->count(3, cubes[f]); ++number) {
      std::uint64_t points = 0;
      for (unsigned rest = tables_->points(cubes[f], number); rest != 0; rest &= rest - 1)
        points |= std::uint64_t{1} << tables.lifted(f, static_cast<unsigned>(std::countr_zero(rest)));
      parts_.push_back(
          {{static_cast<std::uint8_t>(f), static_cast<std::uint8_t>(number), static_cast<std::int8_t>(face_sign(f))},
           static_cast<std::uint8_t>(tables_->entries(3, cubes[f], number).size()),
           points,
           0});
    }
  }
  // Sigma is a surface, so parts that share a point are connected. Merge them into components.
  is_known_.assign(parts_.size(), false);
  for (std::size_t first = 0; first < parts_.size(); ++first) {
    if (is_known_[first]) continue;
    std::uint64_t points = parts_[first].points;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t p = first; p < parts_.size(); ++p) {
        if (is_known_[p] || (parts_[p].points & points) == 0) continue;
        points |= parts_[p].points;
        parts_[p].component = static_cast<std::uint8_t>(components_.size());
        is_known_[p] = changed = true;
      }
    }
    components_.push_back(points);
  }
  return components_.size();
}

bool ResolvedFacets::is_sphere(std::size_t component) const noexcept {
  int polygons = 0, sides = 0;
  for (const Part& part : parts_) {
    if (part.component != component) continue;
    ++polygons;
    sides += part.sides;
  }
  return std::popcount(components_[component]) - sides / 2 + polygons == 2;
}

/// The corners of one sign that are connected, in the boundary, with those beside a component.
std::uint32_t ResolvedFacets::region(std::size_t component, bool high) const noexcept {
  const std::uint32_t corners = high ? signature_ : ~std::uint32_t{signature_} & 0xffffu;
  const auto edge = static_cast<unsigned>(std::countr_zero(components_[component]));
  const std::uint32_t from = 1u << edge_base(4, edge);
  std::uint32_t reached = (corners & from) != 0 ? from : from << (1u << edge / 8);
  const auto join = [&](std::uint32_t face) {
    if ((reached & face) != 0) reached |= corners & face;
  };
  for (std::uint32_t before = 0; reached != before;) {
    before = reached;
    reached = with_neighbours(reached) & corners;
    for (unsigned f = 0; f < 8; ++f) {
      if (cubes_[f] == kNone) continue;
      if (tables_->inside(cubes_[f]).joins == (high ? tile::Choice::high : tile::Choice::low))
        join(lifted_corners(f, 0xff));
      const CubeList& cube = ResolvedCubes::instance().lists()[cubes_[f]];
      const unsigned ambiguous = tables::kTile3Resolved.ambiguous_squares[cube.signature];
      for (unsigned rest = high ? ambiguous & cube.high_squares : ambiguous & ~unsigned{cube.high_squares}; rest != 0;
           rest &= rest - 1)
        join(lifted_corners(f, kSquareCorners[static_cast<std::size_t>(std::countr_zero(rest))]));
    }
  }
  return reached;
}

void ResolvedFacets::fill(tile::Choice choice) {
  const std::size_t count = components_.size();
  facet_of_.resize(count);
  for (std::size_t c = 0; c < count; ++c) facet_of_[c] = c;
  if (count > 1) {
    const bool high = choice != tile::Choice::high;  // the side that is copied
    std::vector<std::uint32_t> regions(count, 0);
    for (std::size_t c = 0; c < count; ++c) {
      if (choice == tile::Choice::separate && is_sphere(c)) continue;
      regions[c] = region(c, high);
      const auto same = std::find(regions.begin(), regions.begin() + static_cast<std::ptrdiff_t>(c), regions[c]);
      facet_of_[c] = static_cast<std::size_t>(same - regions.begin());
    }
  }
  // list the parts of each facet
  entries_.clear();
  first_.assign(1, 0);
  for (std::size_t c = 0; c < count; ++c) {
    if (facet_of_[c] != c) continue;
    for (const Part& part : parts_)
      if (facet_of_[part.component] == c) entries_.push_back(part.entry);
    first_.push_back(entries_.size());
  }
}

}  // namespace tegl::detail
