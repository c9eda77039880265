// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the compact contours of 3D faces.
#include "regions/face_fillings.hpp"

#include <algorithm>
#include <utility>

#include "regions/cube_frame.hpp"

namespace tegl::detail {

namespace {

/// The ends of an edge as numbers, the smaller one first.
std::pair<Index, Index> ends_of(const tables::CellTable& table, unsigned edge, const Index* corners) noexcept {
  return std::minmax(Index{corners[table.edges[2 * edge]]}, Index{corners[table.edges[2 * edge + 1]]});
}

}  // namespace

std::uint8_t FaceFillings::choose(unsigned signature, const Index* corners) const noexcept {
  const tables::FillingCase& of = fillings_.cases[signature];
  if (of.fillings == 1) return 0;
  if (fillings_.of_frames != nullptr) return fillings_.of_frames[signature][CubeFrame::number_of(corners)];
  unsigned number = 0;
  for (const tables::FillingPolygon& polygon : std::span(fillings_.polygons + of.first_polygon, of.polygons)) {
    const std::span apexes(fillings_.apexes + polygon.first_apex, polygon.apexes);
    const auto smallest = std::min_element(apexes.begin(), apexes.end(), [&](const auto& a, const auto& b) {
      return ends_of(table_, a.edge, corners) < ends_of(table_, b.edge, corners);
    });
    number += unsigned{polygon.weight} * smallest->choice;
  }
  return static_cast<std::uint8_t>(number);
}

}  // namespace tegl::detail
