// SPDX-License-Identifier: BSD-3-Clause
//
// Checks, orients and recognises a polyhedron.
#include "polytope/recognised_polyhedron.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "polytope/polytope_faces.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kCorners = kPolytopeCorners;
constexpr std::size_t kFaces = 2 * kCorners - 4;  // of a polyhedron with so many corners
using Ring = std::vector<std::uint8_t>;

template <class... Arguments>
[[noreturn]] void fail(const CellPlace& cell, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("{}: {}", cell.name(), fmt::format(format, std::forward<Arguments>(arguments)...)));
}

/// A polyhedron while it is checked.
class Checked {
 public:
  Checked(const CellPlace& cell, std::size_t points, std::span<const Index> faces, std::span<const std::uint64_t> ends)
      : cell_(cell) {
    if (ends.size() < 4 || ends.size() > kFaces)
      fail(cell_, "a polyhedron of {} faces; expected 4 to {}", ends.size(), kFaces);
    for (std::size_t f = 0; f < ends.size(); ++f) {
      const std::uint64_t begin = f == 0 ? 0 : ends[f - 1];
      add_face(points, faces.subspan(begin, ends[f] - begin));
    }
    find_edges();
    check_meetings();
    orient();
    check_sphere();
  }

  RecognisedPolyhedron recognise() {
    RecognisedPolyhedron result;
    std::vector<std::uint8_t> order;
    result.shape = shape(order);
    if (result.shape != PolyhedronShape::other) {
      for (const std::uint8_t v : order) result.corners.push_back(corners_[v]);
      return result;
    }
    result.corners = std::move(corners_);
    for (const Ring& ring : rings_) {
      result.rings.insert(result.rings.end(), ring.begin(), ring.end());
      result.ends.push_back(static_cast<std::uint16_t>(result.rings.size()));
    }
    return result;
  }

 private:
  void add_face(std::size_t points, std::span<const Index> face) {
    const std::size_t f = rings_.size();
    if (face.size() < 3) fail(cell_, "face {} has {} corners; expected at least 3", f, face.size());
    Ring& ring = rings_.emplace_back();
    for (const Index p : face) {
      if (p >= points) fail(cell_, "face {} has the point {}; expected a number below {}", f, p, points);
      const auto at = static_cast<std::size_t>(std::find(corners_.begin(), corners_.end(), p) - corners_.begin());
      if (at == corners_.size()) {
        if (at == kCorners)
          fail(cell_, "a polyhedron of more than {} corners; expected at most {}", kCorners, kCorners);
        corners_.push_back(p);
      }
      if (std::find(ring.begin(), ring.end(), at) != ring.end())
        fail(cell_, "face {} has the point {} twice; expected different points", f, p);
      ring.push_back(static_cast<std::uint8_t>(at));
    }
  }

  static void for_each_edge(const Ring& ring, const auto& visit) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  }

  void find_edges() {
    for (auto& row : faces_at_) row.fill({kNone, kNone});
    for (std::size_t f = 0; f < rings_.size(); ++f)
      for_each_edge(rings_[f], [&](std::size_t a, std::size_t b) {
        auto& faces = faces_at_[std::min(a, b)][std::max(a, b)];
        if (faces[1] != kNone)
          fail(cell_, "the edge between the points {} and {} is in the faces {}, {} and {}; expected two faces",
               corners_[a], corners_[b], faces[0], faces[1], f);
        faces[faces[0] == kNone ? 0 : 1] = static_cast<std::uint8_t>(f);
      });
    for (std::size_t a = 0; a < corners_.size(); ++a)
      for (std::size_t b = a + 1; b < corners_.size(); ++b) {
        const auto& faces = faces_at_[a][b];
        if (faces[0] != kNone && faces[1] == kNone)
          fail(cell_,
               "the edge between the points {} and {} is in the face {} only; expected two faces: a closed "
               "polyhedron",
               corners_[a], corners_[b], faces[0]);
        edge_count_ += faces[0] != kNone ? 1 : 0;
      }
  }

  void check_meetings() const {
    std::vector<std::uint64_t> corners_of;
    for (const Ring& ring : rings_) {
      std::uint64_t& bits = corners_of.emplace_back(0);
      for (const std::uint8_t v : ring) bits |= std::uint64_t{1} << v;
    }
    for (std::size_t f = 0; f < rings_.size(); ++f)
      for (std::size_t g = 0; g < f; ++g) {
        const std::uint64_t both = corners_of[f] & corners_of[g];
        if (std::popcount(both) < 2) continue;
        const auto a = static_cast<std::size_t>(std::countr_zero(both));
        const auto b = static_cast<std::size_t>(63 - std::countl_zero(both));
        const auto& faces = faces_at_[a][b];
        if (std::popcount(both) > 2 || faces[0] != g || faces[1] != f)
          fail(cell_, "the faces {} and {} share {} points, among them {} and {}; expected nothing, a point or an edge",
               g, f, std::popcount(both), corners_[a], corners_[b]);
      }
  }

  /// Gives all faces the orientation of the first one.
  void orient() {
    std::vector<bool> is_known(rings_.size());
    std::vector<std::size_t> known{0};
    is_known[0] = true;
    for (std::size_t i = 0; i < known.size(); ++i)
      for_each_edge(rings_[known[i]], [&](std::size_t a, std::size_t b) {
        const auto& faces = faces_at_[std::min(a, b)][std::max(a, b)];
        const std::size_t other = faces[0] == known[i] ? faces[1] : faces[0];
        if (is_known[other]) return;
        is_known[other] = true;
        known.push_back(other);
        bool is_along = false;
        for_each_edge(rings_[other], [&](std::size_t c, std::size_t d) { is_along = is_along || (c == a && d == b); });
        if (is_along) std::reverse(rings_[other].begin(), rings_[other].end());
      });
    if (known.size() != rings_.size())
      fail(cell_, "{} of {} faces are connected by edges; expected all", known.size(), rings_.size());
  }

  /// Euler's formula. A connected surface with more corners than a sphere, such as two of them at one point, has a
  /// smaller characteristic as well.
  void check_sphere() const {
    const auto count = [](std::size_t size) { return static_cast<std::ptrdiff_t>(size); };
    const std::ptrdiff_t euler = count(corners_.size()) - count(edge_count_) + count(rings_.size());
    if (euler != 2)
      fail(cell_, "{} corners, {} edges and {} faces, with the Euler characteristic {}; expected 2, that of a sphere",
           corners_.size(), edge_count_, rings_.size(), euler);
  }

  [[nodiscard]] bool are_neighbours(std::size_t a, std::size_t b) const {
    return faces_at_[std::min(a, b)][std::max(a, b)][0] != kNone;
  }
  /// The neighbour of a corner that is not in a ring.
  [[nodiscard]] std::uint8_t neighbour_beside(std::uint8_t corner, const Ring& ring) const {
    std::uint8_t v = 0;
    while (v == corner || !are_neighbours(corner, v) || std::find(ring.begin(), ring.end(), v) != ring.end()) ++v;
    return v;
  }

  /// The shape, and its corners in order. These numbers of corners and faces determine it, but for the octahedron.
  PolyhedronShape shape(std::vector<std::uint8_t>& order) const {
    const std::size_t corners = corners_.size(), faces = rings_.size();
    const auto face_of = [&](std::size_t size) -> const Ring& {
      return *std::find_if(rings_.begin(), rings_.end(), [&](const Ring& ring) { return ring.size() == size; });
    };
    const auto add_layers = [&](const Ring& base) {
      order = base;
      for (const std::uint8_t v : base) order.push_back(neighbour_beside(v, base));
    };
    if (corners == 4) {
      order = {0, 1, 2, 3};
      return PolyhedronShape::tetrahedron;
    }
    if (corners == 5 && faces == 5) {
      order = face_of(4);
      order.push_back(neighbour_beside(order[0], order));
      return PolyhedronShape::pyramid;
    }
    if (corners == 6 && faces == 5) {
      add_layers(face_of(3));
      return PolyhedronShape::wedge;
    }
    if (corners == 8 && faces == 6 &&
        std::all_of(rings_.begin(), rings_.end(), [](const Ring& ring) { return ring.size() == 4; })) {
      add_layers(rings_[0]);
      return PolyhedronShape::hexahedron;
    }
    if (corners != 6 || faces != 8) return PolyhedronShape::other;
    for (std::uint8_t v = 0; v < 6; ++v) {
      if (std::find(order.begin(), order.end(), v) != order.end()) continue;
      std::vector<std::uint8_t> apart;
      for (std::uint8_t w = 0; w < 6; ++w)
        if (w != v && !are_neighbours(v, w)) apart.push_back(w);
      if (apart.size() != 1) return PolyhedronShape::other;
      order.insert(order.end(), {v, apart[0]});
    }
    return PolyhedronShape::octahedron;
  }

  static constexpr std::uint8_t kNone = 255;

  CellPlace cell_;
  std::vector<Index> corners_;
  std::vector<Ring> rings_;
  std::array<std::array<std::array<std::uint8_t, 2>, kCorners>, kCorners> faces_at_;  ///< by ends, the smaller first
  std::size_t edge_count_ = 0;
};

}  // namespace

std::string CellPlace::name() const {
  return facet ? fmt::format("cell {}, facet {}", cell, *facet) : fmt::format("cell {}", cell);
}

RecognisedPolyhedron recognise_polyhedron(const CellPlace& cell, std::size_t points, std::span<const Index> faces,
                                          std::span<const std::uint64_t> ends) {
  return Checked(cell, points, faces, ends).recognise();
}

}  // namespace tegl::detail
