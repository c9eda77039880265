// SPDX-License-Identifier: BSD-3-Clause
//
// The contour in the faces of a polyhedron: segments between crossed edges, which form loops around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ambiguity/face_estimator.hpp"
#include "polytope/polytope_faces.hpp"

namespace tegl::detail {

/// How polygons and loops are resolved.
struct PolytopeRules {
  bool is_compact = true;          ///< no barycentre where the loop can be divided by diagonals
  bool joins_high = false;         ///< fixed rule: ambiguous faces join their high corners
  std::optional<FaceRule> rule{};  ///< instead: from the values at a face's corners
  double isovalue = 0;
};

/// Whether the high corners of an ambiguous face are joined. `values`: at the corners around the face, where high and
/// low alternate more than twice. A quadrilateral as in an image; other faces by the mean of their corners, also by the
/// rules of saddles.
[[nodiscard]] bool is_face_high(const PolytopeRules& rules, std::span<const double> values);

/// Most corners around a face, and most edges of a polyhedron, of those that are prisms over polygons as well.
inline constexpr std::size_t kRingCorners = kPolytopeCorners, kLoopEdges = 3 * kPolytopeCorners;

/// Calls add(from, to) for the segments of the contour in a face, as edges of the shape: from the edge where a run of
/// high corners ends to the edge where a run begins: its own one, or the following one if the high corners are joined.
/// In the ring of the face that shares the edge, ends are beginnings, so that the segments around a cell are loops.
/// `values`: by corner of the shape.
template <class Add>
void for_each_segment(const PolytopeFaces& shape, std::size_t face, const double* values, const PolytopeRules& rules,
                      const Add& add) {
  const std::span<const std::uint8_t> ring = shape.ring(face), edges = shape.ring_edges(face);
  const auto is_high = [&](std::uint8_t v) { return values[v] >= rules.isovalue; };
  std::array<std::uint8_t, kRingCorners> begins, ends;  // edges, in the order around the face
  std::size_t begin_count = 0, end_count = 0;
  bool ends_first = false;  // the first run begins before the ring does
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const bool before = is_high(ring[i]), after = is_high(ring[i + 1 < ring.size() ? i + 1 : 0]);
    if (before == after) continue;
    if (begin_count + end_count == 0) ends_first = before;
    (before ? ends[end_count++] : begins[begin_count++]) = edges[i];
  }
  if (end_count == 0) return;
  bool joins = false;
  if (end_count > 1) {
    std::array<double, kRingCorners> around;
    for (std::size_t i = 0; i < ring.size(); ++i) around[i] = values[ring[i]];
    joins = is_face_high(rules, {around.data(), ring.size()});
  }
  // the run of ends[k] begins at begins[k - 1] if the ring starts within a run, otherwise at begins[k]
  const std::size_t shift = (ends_first ? end_count - 1 : 0) + (joins ? 1 : 0);
  for (std::size_t k = 0; k < end_count; ++k) add(ends[k], begins[(k + shift) % end_count]);
}

/// Finds a vertex of a loop whose diagonals are in no face of the cell: the contour of a neighbour may have other
/// diagonals there. `start`: where to begin.
[[nodiscard]] inline bool find_fan(const PolytopeFaces& shape, std::span<const std::uint8_t> loop,
                                   std::size_t& start) noexcept {
  for (; start < loop.size(); ++start) {
    std::size_t i = 2;
    while (i + 1 < loop.size() && !shape.share_a_face(loop[start], loop[(start + i) % loop.size()])) ++i;
    if (i + 1 == loop.size()) return true;
  }
  return false;
}

/// Finds the loops around polyhedra, one after the other.
class Loops {
 public:
  /// Calls visit(loop) for the loops around a polyhedron with these values at its corners, by their first edges.
  /// `loop`: its edges, so that a triangle of three following ones faces high.
  template <class Visit>
  void for_each(const PolytopeFaces& shape, const double* values, const PolytopeRules& rules, const Visit& visit) {
    const std::size_t edges = shape.base_edges();
    for (std::size_t e = 0; e < edges; ++e) next_[e] = kNone;
    for (std::size_t f = 0; f < shape.face_count(); ++f)
      for_each_segment(shape, f, values, rules, [&](std::uint8_t from, std::uint8_t to) { next_[from] = to; });
    for (std::size_t first = 0; first < edges; ++first) {
      if (next_[first] == kNone) continue;
      std::size_t size = 0;
      for (std::size_t e = first; next_[e] != kNone; ++size) {
        loop_[size] = static_cast<std::uint8_t>(e);
        const std::size_t to = next_[e];
        next_[e] = kNone;
        e = to;
      }
      visit(std::span<const std::uint8_t>(loop_.data(), size));
    }
  }

 private:
  static constexpr std::uint8_t kNone = 255;
  std::array<std::uint8_t, kLoopEdges> next_, loop_;  ///< by edge: the following one of its loop
};

}  // namespace tegl::detail
