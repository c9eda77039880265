// SPDX-License-Identifier: BSD-3-Clause
//
// Compares the emitted builder of facets, as compiled, with tile::FacetBuilder, and checks that boundaries of
// boundaries are zero. A template, because each copy with a fault has classes of its own.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "tegl/tile/corners.hpp"
#include "tesseract_checks.hpp"

namespace tegl::test {

/// The squares of a tesseract by cube and square of the cube, from their corners.
inline unsigned square_in_tile(unsigned f, unsigned q) {
  const unsigned base = detail::lifted_corner(f, (q % 2) << (q / 2));
  const unsigned axes = 15u ^ 1u << f / 2 ^ 1u << detail::lifted_axis(f, q / 2);
  unsigned number = 0;
  while (builders::kTesseractSquares[number].base != base || builders::kTesseractSquares[number].axes != axes) ++number;
  return number;
}

/// Figures of the facets that an emitted builder finds, and what is wrong with their boundaries.
template <class Faces, class Tesseract>
class FacetFinder {
 public:
  FacetFigures figures(const ResolvedKey& key) {
    key_ = key;
    lists_ = builders::ResolvedTesseract::lists_of(key);
    fault_.clear();
    tesseract_.begin(lists_);
    const auto facets = tesseract_.joined(key.signature, key.tile);
    FacetFigures result;
    std::size_t entries = 0;
    for (unsigned number = 0; number < facets.count(); ++number) {
      result.insert(figures_of_facet(facets.entries(number)));
      entries += facets.entries(number).size();
    }
    if (entries != facets.entry_count()) fault_ = "another number of entries";
    return result;
  }
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  /// A point or a segment: kind of face, its number, and the number in the face.
  using Name = std::tuple<char, unsigned, unsigned>;

  template <class Entries>
  std::pair<std::uint64_t, long> figures_of_facet(const Entries& polygons) {
    std::set<Name> points;
    std::map<Name, std::pair<int, int>> segments;  // number of uses and sum of signs
    for (const auto& polygon : polygons) {
      const unsigned f = polygon.face;
      if (polygon.sign != detail::face_sign(f)) fault_ = "sign of a cube";
      std::map<Name, int> ends;  // sum of signs
      for (const auto& side : Faces::of_cube(lists_[f]).entries(polygon.number)) {
        const bool is_inside = side.face == Faces::kInside;
        const Name name = is_inside ? Name{'i', f, side.number} : Name{'s', square_in_tile(f, side.face), side.number};
        auto& [uses, sum] = segments[name];
        ++uses;
        sum += polygon.sign * side.sign;
        if (is_inside)
          add_inside(f, side, ends);
        else
          add_ends(f, side, ends);
      }
      for (const auto& [point, sum] : ends) {
        points.insert(point);
        if (sum != 0) fault_ = "an open boundary of a polygon";
      }
    }
    for (const auto& [name, of] : segments)
      if (of != std::pair{2, 0}) fault_ = "a segment that does not bound two polygons with opposite signs";
    std::uint64_t edges = 0;
    for (const auto& [kind, number, of_cube] : points)
      if (kind == 'e') edges |= std::uint64_t{1} << number;
    const long twice =
        static_cast<long>(points.size()) - static_cast<long>(segments.size()) + static_cast<long>(polygons.size());
    return {edges, twice / 2};
  }

  template <class Entry>
  void add_ends(unsigned f, const Entry& side, std::map<Name, int>& ends) {
    const unsigned of_cube = detail::face_signature(4, key_.signature, f);
    const bool high = (key_.squares >> square_in_tile(f, side.face) & 1u) != 0;
    const auto facets = Faces::of_square(Faces::square_type(detail::face_signature(3, of_cube, side.face), high));
    if (side.number >= facets.count()) {
      fault_ = "a segment that the square lacks";
      return;
    }
    for (const auto& point : facets.entries(side.number)) {
      // face 2 a + side of the square is its edge along the other axis
      const unsigned edge = detail::edge_number(2, 1u - point.face / 2u, (point.face % 2u) << (point.face / 2u));
      ends[{'e', detail::lifted_edge(4, f, detail::lifted_edge(3, side.face, edge)), 0}] += side.sign * point.sign;
    }
  }
  template <class Entry>
  void add_inside(unsigned f, const Entry& side, std::map<Name, int>& ends) {
    const auto inside = Faces::inside(lists_[f]);
    for (const std::size_t end : {0u, 1u}) {
      const unsigned v = inside.segments[side.number][end];
      const Name name = v < 12 ? Name{'e', detail::lifted_edge(4, f, v), 0} : Name{'p', f, inside.points[v - 12]};
      ends[name] += end == 0 ? -side.sign : side.sign;
    }
  }

  Tesseract tesseract_;
  ResolvedKey key_;
  builders::ResolvedCubes::Lists lists_{};
  std::string fault_;
};

/// What is wrong with the facets of a tile; "" if nothing is.
template <class Finder>
std::string fault_of_facets(Finder& finder, GeneralTesseract& general, const ResolvedKey& key) {
  const FacetFigures figures = finder.figures(key);
  if (!finder.fault().empty()) return text_of(key) + finder.fault();
  if (const FacetFigures expected = general.figures(key); figures != expected)
    return text_of(key) + "facets" + text_of(figures) + ", of the general builder" + text_of(expected);
  return "";
}

/// What is wrong with random tiles of a builder.
template <class Finder>
std::string fault_of_random_facets(Finder finder, int count) {
  GeneralTesseract general;
  RandomKeys keys(6);
  for (int i = 0; i < count; ++i)
    if (std::string fault = fault_of_facets(finder, general, keys()); !fault.empty()) return fault;
  return "";
}

}  // namespace tegl::test
