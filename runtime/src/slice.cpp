// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of simplicial contours by "last coordinate = constant".
//
// Orientation. Let (v_0 … v_{N-1}) be a contour's simplex, positive towards d: det[v_1 - v_0, …, v_{N-1} - v_0, d] > 0,
// and g a direction inside the simplex with a positive last component. A simplex of the cut with edges f_1 … f_{N-2}
// must be positive towards the same d, taken inside the hyperplane: det[f_1, …, f_{N-2}, d, e_{N-1}] > 0. As g is
// e_{N-1} times a positive number plus a part inside the hyperplane, exchanging two columns gives det[f_1, …, f_{N-2},
// g, d] < 0: the cut (f_1 … f_{N-2}), followed by the way up, is a negative frame of the simplex. So the orientation
// follows from which vertices are above and from their order alone, also where coordinates coincide.
//
// Why the cut is closed where the contour is. Let h be the hyperplane's coordinate, and call a vertex at h "on". If on
// vertices count as above, simplices have points on the same edges as at h - e, for any e > 0 smaller than the distance
// to the next vertex below: combinatorially the cut is that at h - e, a manifold. If they count as below, it is the cut
// at h + e; and as the argument is about one vertex at a time, groups of on vertices without an edge between them may
// count differently. A group (on vertices connected by edges among themselves) counts as below if no edge of it goes
// down, else as above: the limit from below where there is one.
// The points around an on vertex u are then drawn together into u. That keeps the manifold if those points span a disc
// (of discs drawn to points a surface comes out unchanged: R. L. Moore, Concerning upper semi-continuous collections of
// continua, 1925), but pinches it where h is a critical value at u. There the points are left apart, each in u's place.
//
// Why the cut at a layer of the image is that layer's contour M: the on vertices are M's vertices (up to samples that
// equal the isovalue). With tiles below, each face of M is met by one simplex from below; the cut of that simplex is
// the face, other simplices collapse. Without any (the first layer, or missing values below) M's vertices count as
// below, and the simplices above cut to its faces in the same way; if the contour is closed at its first layer, the cap
// lies flat in the hyperplane with nothing below. Where tiles below are missing under a part of M alone, the faces
// met from above are boundary faces of the contour, and are added as they are.
#include "tegl/slice.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slice_at.hpp"
#include "slice_piece.hpp"

namespace tegl {
namespace {

using detail::edge_point;
using detail::is_vertex_point;
using detail::lower_end;
using detail::Piece;
using detail::PointKey;
using detail::upper_end;
using detail::vertex_point;

/// Where a vertex lies; on_low and on_high lie on the hyperplane and count as below and above it.
enum class Side : std::uint8_t { below, on_low, on_high, above };
constexpr bool is_high(Side side) { return side >= Side::on_high; }
constexpr bool is_on(Side side) { return side == Side::on_low || side == Side::on_high; }

/// The vertices of a simplex with those of `high` (bit j: vertex j) first, by an even permutation.
template <int N>
std::array<Index, N> high_first(const std::array<Index, N>& simplex, unsigned high) {
  std::array<Index, N> sorted = simplex;
  std::array<bool, N> is_first;
  int high_count = 0;
  for (int j = 0; j < N; ++j) high_count += is_first[j] = ((high >> j) & 1u) != 0;
  bool odd = false;
  for (int i = 1; i < N; ++i)
    for (int j = i; j > 0 && is_first[j] && !is_first[j - 1]; --j) {
      std::swap(sorted[j], sorted[j - 1]);
      std::swap(is_first[j], is_first[j - 1]);
      odd = !odd;
    }
  // There are at least three vertices, so two on one side to make the permutation even with.
  if (odd && high_count >= 2) std::swap(sorted[0], sorted[1]);
  if (odd && high_count < 2) std::swap(sorted[N - 2], sorted[N - 1]);
  return sorted;
}

/// The pairs (above, below) of places in the order of `high_first` whose edges the cut's points lie on, in the
/// orientation derived at the top of this file.
using Pairs = std::array<std::pair<int, int>, 4>;
template <int N>
std::pair<Pairs, int> cut_pairs(int high_count) {
  if constexpr (N == 3)
    return high_count == 1 ? std::pair{Pairs{{{0, 2}, {0, 1}}}, 2} : std::pair{Pairs{{{0, 2}, {1, 2}}}, 2};
  if constexpr (N == 4) {
    if (high_count == 1) return {Pairs{{{0, 1}, {0, 2}, {0, 3}}}, 3};
    if (high_count == 2) return {Pairs{{{0, 2}, {0, 3}, {1, 3}, {1, 2}}}, 4};
    return {Pairs{{{0, 3}, {1, 3}, {2, 3}}}, 3};
  }
}

template <int N, class Real>
class Cutter {
 public:
  Cutter(const Contour<N, Real>& contour, Real at) : contour_(contour), at_(at) {}

  Contour<N - 1, Real> cut() {
    find_sides();
    if (has_on_vertices_) group_on_vertices();
    cut_simplices();
    if (has_on_vertices_) draw_together();
    number_points();
    Contour<N - 1, Real> result;
    std::copy_n(contour_.axis_names.begin(), N - 1, result.axis_names.begin());
    std::copy_n(contour_.axis_units.begin(), N - 1, result.axis_units.begin());
    result.direction = contour_.direction;
    result.vertices.resize(keys_.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) result.vertices[i] = position(keys_[i]);
    if (!contour_.normals.empty()) {
      result.normals.resize(keys_.size());
      for (std::size_t i = 0; i < keys_.size(); ++i) result.normals[i] = normal(keys_[i]);
    }
    emit(result);
    return result;
  }

 private:
  /// An (N-2)-face that lies in the hyperplane, as seen from one of its simplices.
  struct OnFace {
    std::array<Index, N - 1> vertices;  // ascending
    Index simplex;
    int omitted;  // the place in the simplex of the vertex that is not in the face
  };
  static constexpr unsigned kAll = (1u << N) - 1;

  /// Bit j: `test` holds for the side of vertex j.
  template <class Test>
  [[nodiscard]] unsigned corners(const std::array<Index, N>& simplex, const Test& test) const {
    unsigned mask = 0;
    for (int j = 0; j < N; ++j) mask |= static_cast<unsigned>(test(sides_[simplex[j]])) << j;
    return mask;
  }

  /// On vertices count as above until they are grouped. Simplices on one side, off the hyperplane, are done with.
  void find_sides() {
    sides_.resize(contour_.vertices.size());
    for (std::size_t v = 0; v < sides_.size(); ++v) {
      const Real t = contour_.vertices[v][N - 1];
      sides_[v] = t < at_ ? Side::below : t > at_ ? Side::above : Side::on_high;
      has_on_vertices_ = has_on_vertices_ || t == at_;
    }
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s) {
      const auto& simplex = contour_.simplices[s];
      Side least = sides_[simplex[0]];
      Side most = least;
      for (int j = 1; j < N; ++j) {
        least = std::min(least, sides_[simplex[j]]);
        most = std::max(most, sides_[simplex[j]]);
      }
      if (least != most || is_on(least)) touching_.push_back(static_cast<Index>(s));
    }
  }

  /// Makes groups of on vertices without a way down count as below.
  void group_on_vertices() {
    std::vector<Index> parent(sides_.size());  // disjoint sets
    std::iota(parent.begin(), parent.end(), Index{0});
    const auto find = [&parent](Index v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    std::vector<bool> has_way_down(sides_.size(), false);  // of vertices, then of sets
    for (const Index s : touching_) {
      const auto& simplex = contour_.simplices[s];
      const bool down = corners(simplex, [](Side side) { return side == Side::below; }) != 0;
      const Index* last = nullptr;
      for (const Index& v : simplex) {
        if (!is_on(sides_[v])) continue;
        if (last != nullptr) parent[find(v)] = find(*last);
        last = &v;
        if (down) has_way_down[v] = true;
      }
    }
    for (std::size_t v = 0; v < sides_.size(); ++v)
      if (has_way_down[v]) has_way_down[find(static_cast<Index>(v))] = true;
    for (std::size_t v = 0; v < sides_.size(); ++v)
      if (is_on(sides_[v]) && !has_way_down[find(static_cast<Index>(v))]) sides_[v] = Side::on_low;
  }

  void cut_simplices() {
    for (const Index s : touching_) {
      const auto& simplex = contour_.simplices[s];
      const unsigned high = corners(simplex, is_high);
      if (high != 0 && high != kAll) pieces_.push_back(make_piece(simplex, high));
    }
  }

  /// The piece between the `high` vertices of a simplex and the others.
  static Piece make_piece(const std::array<Index, N>& simplex, unsigned high) {
    const std::array<Index, N> sorted = high_first<N>(simplex, high);
    const auto [pairs, count] = cut_pairs<N>(std::popcount(high));
    Piece piece;
    piece.count = count;
    for (int i = 0; i < count; ++i) piece.points[i] = edge_point(sorted[pairs[i].second], sorted[pairs[i].first]);
    return piece;
  }

  /// The end of a point's edge that is on; an edge has at most one, as its ends would be in one group.
  [[nodiscard]] std::optional<Index> on_end(PointKey key) const {
    if (is_on(sides_[upper_end(key)])) return upper_end(key);
    if (is_on(sides_[lower_end(key)])) return lower_end(key);
    return std::nullopt;
  }

  /// Draws the points around on vertices together. Where the result is pinched and the points themselves were not, the
  /// vertices concerned are left apart; each round leaves more of them so, and with all apart nothing is pinched.
  void draw_together() {
    const std::vector<Piece> faces = faces_met_from_above();
    std::vector<bool> apart(sides_.size(), false);
    std::vector<PointKey> excused;
    for (int round = 0;; ++round) {
      std::vector<Piece> drawn = drawn_pieces(apart);
      drawn.insert(drawn.end(), faces.begin(), faces.end());
      const std::vector<PointKey> pinched = detail::pinched_points(drawn);
      if (round == 0 && !pinched.empty()) excused = detail::pinched_points(pieces_);
      if (leave_apart(pinched, excused, round >= kMostRounds, apart)) continue;
      pieces_ = std::move(drawn);
      return;
    }
  }

  [[nodiscard]] std::vector<Piece> drawn_pieces(const std::vector<bool>& apart) const {
    std::vector<Piece> result;
    result.reserve(pieces_.size());
    for (const Piece& piece : pieces_) {
      Piece drawn;
      for (int i = 0; i < piece.count; ++i) {
        const std::optional<Index> on = on_end(piece.points[i]);
        const PointKey key = on && !apart[*on] ? vertex_point(*on) : piece.points[i];
        // Points drawn together are neighbours in the cycle: they share the on vertex.
        const bool repeats = drawn.count > 0 &&
                             (drawn.points[drawn.count - 1] == key || (i == piece.count - 1 && drawn.points[0] == key));
        if (!repeats) drawn.points[drawn.count++] = key;
      }
      if (drawn.count >= N - 1) result.push_back(drawn);
    }
    return result;
  }

  /// Marks the on vertices among the pinched points (or all on vertices), except those around which the points were
  /// pinched before, as a contour may be next to missing values. True if that changes anything.
  bool leave_apart(const std::vector<PointKey>& pinched, const std::vector<PointKey>& excused, bool all,
                   std::vector<bool>& apart) const {
    std::vector<bool> candidates(apart.size(), all && !pinched.empty());
    for (const PointKey key : pinched)
      if (is_vertex_point(key)) candidates[upper_end(key)] = true;
    for (const PointKey key : excused)
      if (const std::optional<Index> on = on_end(key)) candidates[*on] = false;
    bool changed = false;
    for (std::size_t v = 0; v < apart.size(); ++v) {
      if (!candidates[v] || apart[v]) continue;
      apart[v] = true;
      changed = true;
    }
    return changed;
  }

  /// The contour's boundary faces among vertices that count as above, whose simplex is above; see the top of this file.
  [[nodiscard]] std::vector<Piece> faces_met_from_above() const {
    std::vector<OnFace> on_faces;
    for (const Index s : touching_)
      gather_on_faces(s, corners(contour_.simplices[s], [](Side side) { return side == Side::on_high; }), on_faces);
    std::sort(on_faces.begin(), on_faces.end(), [](const OnFace& a, const OnFace& b) {
      return std::tie(a.vertices, a.simplex) < std::tie(b.vertices, b.simplex);
    });
    std::vector<Piece> faces;
    for (std::size_t i = 0, j = 0; i < on_faces.size(); i = j) {
      while (j < on_faces.size() && on_faces[j].vertices == on_faces[i].vertices) ++j;
      const auto& simplex = contour_.simplices[on_faces[i].simplex];
      if (j - i != 1 || sides_[simplex[on_faces[i].omitted]] != Side::above) continue;
      Piece face = make_piece(simplex, 1u << on_faces[i].omitted);
      for (int k = 0; k < face.count; ++k) face.points[k] = vertex_point(lower_end(face.points[k]));
      faces.push_back(face);
    }
    return faces;
  }

  void gather_on_faces(Index s, unsigned on, std::vector<OnFace>& on_faces) const {
    for (int omitted = 0; omitted < N; ++omitted) {
      if ((on | (1u << omitted)) != kAll) continue;
      OnFace face{{}, s, omitted};
      for (int j = 0, k = 0; j < N; ++j)
        if (j != omitted) face.vertices[k++] = contour_.simplices[s][j];
      std::sort(face.vertices.begin(), face.vertices.end());
      on_faces.push_back(face);
    }
  }

  /// Numbers the points in the order of their keys, and puts numbers in the place of keys.
  void number_points() {
    for (const Piece& piece : pieces_)
      keys_.insert(keys_.end(), piece.points.begin(), piece.points.begin() + piece.count);
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    if (keys_.size() > std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, fmt::format("{} vertices in a cut; expected at most {}", keys_.size(),
                                                   std::numeric_limits<Index>::max()));
    for (Piece& piece : pieces_)
      for (int i = 0; i < piece.count; ++i)
        piece.points[i] =
            static_cast<PointKey>(std::lower_bound(keys_.begin(), keys_.end(), piece.points[i]) - keys_.begin());
  }

  [[nodiscard]] std::array<Real, N - 1> position(PointKey key) const {
    std::array<Real, N - 1> result;
    if (const std::optional<Index> on = on_end(key)) {
      std::copy_n(contour_.vertices[*on].begin(), N - 1, result.begin());
      return result;
    }
    const auto& low = contour_.vertices[lower_end(key)];
    const auto& high = contour_.vertices[upper_end(key)];
    const double beta = share(key);
    for (int a = 0; a < N - 1; ++a) result[a] = static_cast<Real>(between(low[a], high[a], beta));
    return result;
  }

  /// How far a point lies up its edge.
  [[nodiscard]] double share(PointKey key) const {
    const auto t = static_cast<double>(contour_.vertices[lower_end(key)][N - 1]);
    return (static_cast<double>(at_) - t) / (static_cast<double>(contour_.vertices[upper_end(key)][N - 1]) - t);
  }

  static double between(Real low, Real high, double beta) {
    const auto x = static_cast<double>(low);
    return x + beta * (static_cast<double>(high) - x);
  }

  /// The contour's normal there, within the hyperplane: a gradient without its last component is that of the field in
  /// the hyperplane.
  [[nodiscard]] std::array<Real, N - 1> normal(PointKey key) const {
    const std::optional<Index> on = on_end(key);
    const auto& low = contour_.normals[on ? *on : lower_end(key)];
    const auto& high = contour_.normals[on ? *on : upper_end(key)];
    const double beta = on ? 0.0 : share(key);
    std::array<double, N - 1> v;
    double square = 0.0;
    for (int a = 0; a < N - 1; ++a) {
      v[a] = between(low[a], high[a], beta);
      square += v[a] * v[a];
    }
    std::array<Real, N - 1> result;
    for (int a = 0; a < N - 1; ++a) result[a] = square > 0.0 ? static_cast<Real>(v[a] / std::sqrt(square)) : Real{0};
    return result;
  }

  void emit(Contour<N - 1, Real>& result) const {
    for (const Piece& piece : pieces_) {
      const auto& p = piece.points;
      const auto at = [&p](int i) { return static_cast<Index>(p[i]); };
      if constexpr (N == 3) {
        result.simplices.push_back({at(0), at(1)});
      } else if (piece.count == 3) {
        result.simplices.push_back({at(0), at(1), at(2)});
      } else if (splits_from_first(result, piece)) {
        result.simplices.push_back({at(0), at(1), at(2)});
        result.simplices.push_back({at(0), at(2), at(3)});
      } else {
        result.simplices.push_back({at(1), at(2), at(3)});
        result.simplices.push_back({at(1), at(3), at(0)});
      }
    }
  }

  /// The shorter diagonal; of two equal ones that with the first end in lexicographic order of the coordinates, so
  /// that the choice depends on the points' places alone.
  static bool splits_from_first(const Contour<N - 1, Real>& result, const Piece& piece) {
    const auto corner = [&](int i) -> const std::array<Real, N - 1>& { return result.vertices[piece.points[i]]; };
    const auto length = [&](int i, int j) {
      double sum = 0.0;
      for (int a = 0; a < N - 1; ++a) {
        const double d = static_cast<double>(corner(j)[a]) - static_cast<double>(corner(i)[a]);
        sum += d * d;
      }
      return sum;
    };
    const double first = length(0, 2);
    const double second = length(1, 3);
    if (first != second) return first < second;
    return std::minmax(corner(0), corner(2)) <= std::minmax(corner(1), corner(3));
  }

  static constexpr int kMostRounds = 16;  ///< then all on vertices are left apart at once, to bound the time

  const Contour<N, Real>& contour_;
  const Real at_;
  std::vector<Side> sides_;
  bool has_on_vertices_ = false;
  std::vector<Index> touching_;  ///< simplices not wholly on one side
  std::vector<Piece> pieces_;
  std::vector<PointKey> keys_;
};

}  // namespace

template <int N, class Real>
Contour<N - 1, Real> slice(const Contour<N, Real>& contour, double at) {
  return Cutter<N, Real>(contour, detail::rounded_at<Real>(at)).cut();
}

template Contour<2, float> slice(const Contour<3, float>&, double);
template Contour<2, double> slice(const Contour<3, double>&, double);
template Contour<3, float> slice(const Contour<4, float>&, double);
template Contour<3, double> slice(const Contour<4, double>&, double);

}  // namespace tegl
