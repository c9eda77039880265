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
// Why the cut is closed where the contour is (the contour's last coordinate t, "at" = h, a vertex at h called on):
// with on vertices counted as above, simplices have points on the same edges as at h - e, for any e > 0 smaller than
// the distance to the next vertex below: combinatorially the cut at h - e, a manifold. Its points around an on vertex u
// are then drawn together into u. That keeps the manifold if those points span a disc (of discs drawn to points a
// surface comes out unchanged: R. L. Moore, Concerning upper semi-continuous collections of continua, 1925), but
// pinches it where h is a critical value at u. There the points are left apart, each in u's place: see `draw_together`.
// If h is the coordinate of a layer of the image, the on vertices are that layer's (up to samples that equal the
// isovalue): the contour's part in the hyperplane is the layer's contour M, each face of which is met by one simplex
// from below. The cut of that simplex is the face, other simplices collapse, and the cut is M. Where there is no tile
// below (the first layer, or missing values below), M's faces are met from above only: they are boundary faces of the
// contour and are added as they are. If the contour is closed at its first layer, the faces' other side is the cap, a
// part of the contour flat in the hyperplane with nothing below it.
#include "tegl/slice.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
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

enum class Side : std::uint8_t { below, on, above };

/// The vertices of a simplex with those of `high` (bit j: vertex j) first, by an even permutation.
template <int N>
std::array<Index, N> high_first(const std::array<Index, N>& simplex, unsigned high) {
  std::array<Index, N> sorted = simplex;
  std::array<bool, N> is_high;
  int high_count = 0;
  for (int j = 0; j < N; ++j) high_count += is_high[j] = ((high >> j) & 1u) != 0;
  bool odd = false;
  for (int i = 1; i < N; ++i)
    for (int j = i; j > 0 && is_high[j] && !is_high[j - 1]; --j) {
      std::swap(sorted[j], sorted[j - 1]);
      std::swap(is_high[j], is_high[j - 1]);
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
    classify();
    cut_simplices();
    draw_together();
    number_points();
    Contour<N - 1, Real> result;
    std::copy_n(contour_.axis_names.begin(), N - 1, result.axis_names.begin());
    std::copy_n(contour_.axis_units.begin(), N - 1, result.axis_units.begin());
    result.direction = contour_.direction;
    result.vertices.resize(keys_.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) result.vertices[i] = position(keys_[i]);
    emit(result);
    return result;
  }

 private:
  /// An (N-2)-face that lies in the hyperplane, as seen from one of its simplices.
  struct OnFace {
    std::array<Index, N - 1> vertices;  // ascending
    Side apex;                          // of the simplex's other vertex; on: the simplex is flat
    int omitted;                        // the place of the other vertex in the simplex
    Index simplex;
    Index flat;  // its number among the flat simplices
  };

  void classify() {
    sides_.resize(contour_.vertices.size());
    for (std::size_t v = 0; v < sides_.size(); ++v) {
      const Real t = contour_.vertices[v][N - 1];
      sides_[v] = t < at_ ? Side::below : t > at_ ? Side::above : Side::on;
      has_on_vertices_ = has_on_vertices_ || t == at_;
    }
  }

  void cut_simplices() {
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s) {
      const auto& simplex = contour_.simplices[s];
      unsigned high = 0;
      unsigned on = 0;
      for (int j = 0; j < N; ++j) {
        high |= static_cast<unsigned>(sides_[simplex[j]] != Side::below) << j;
        on |= static_cast<unsigned>(sides_[simplex[j]] == Side::on) << j;
      }
      if (on != 0) gather_on_faces(static_cast<Index>(s), on);
      if (high != 0 && high != (1u << N) - 1) add_piece(simplex, high, pieces_);
    }
  }

  void gather_on_faces(Index s, unsigned on) {
    const auto& simplex = contour_.simplices[s];
    const bool flat = on == (1u << N) - 1;
    for (int omitted = 0; omitted < N; ++omitted) {
      if ((on | (1u << omitted)) != (1u << N) - 1) continue;
      OnFace face{{}, sides_[simplex[omitted]], omitted, s, flat_count_};
      for (int j = 0, k = 0; j < N; ++j)
        if (j != omitted) face.vertices[k++] = simplex[j];
      std::sort(face.vertices.begin(), face.vertices.end());
      on_faces_.push_back(face);
    }
    if (flat) ++flat_count_;
  }

  /// The piece between the `high` vertices of a simplex and the others; its points not yet drawn together.
  void add_piece(const std::array<Index, N>& simplex, unsigned high, std::vector<Piece>& pieces) const {
    const std::array<Index, N> sorted = high_first<N>(simplex, high);
    const auto [pairs, count] = cut_pairs<N>(std::popcount(high));
    Piece piece;
    piece.count = count;
    for (int i = 0; i < count; ++i) {
      const Index lower = sorted[pairs[i].second];
      // A lower vertex that is on belongs to a face met from above alone.
      piece.points[i] = sides_[lower] == Side::on ? vertex_point(lower) : edge_point(lower, sorted[pairs[i].first]);
    }
    pieces.push_back(piece);
  }

  /// Draws the points around on vertices together. Where the result is pinched and the points themselves were not, the
  /// vertices concerned are left apart; each round leaves more of them so, and with all apart nothing is pinched.
  void draw_together() {
    const std::vector<Piece> faces = faces_met_from_above();
    std::vector<bool> apart(has_on_vertices_ ? sides_.size() : 0, false);
    std::vector<PointKey> excused;
    for (int round = 0; has_on_vertices_; ++round) {
      std::vector<Piece> drawn = drawn_pieces(apart);
      drawn.insert(drawn.end(), faces.begin(), faces.end());
      const std::vector<PointKey> pinched = detail::pinched_points(drawn);
      if (round == 0 && !pinched.empty()) excused = detail::pinched_points(pieces_);
      if (!leave_apart(pinched, excused, round >= kMostRounds, apart)) {
        pieces_ = std::move(drawn);
        return;
      }
    }
  }

  std::vector<Piece> drawn_pieces(const std::vector<bool>& apart) const {
    std::vector<Piece> result;
    result.reserve(pieces_.size());
    for (const Piece& piece : pieces_) {
      Piece drawn;
      for (int i = 0; i < piece.count; ++i) {
        const Index upper = upper_end(piece.points[i]);
        const PointKey key = sides_[upper] == Side::on && !apart[upper] ? vertex_point(upper) : piece.points[i];
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
    std::vector<bool> candidates(apart.size(), false);
    for (const PointKey key : pinched)
      if (is_vertex_point(key)) candidates[upper_end(key)] = true;
    if (all && !pinched.empty()) candidates.assign(apart.size(), true);
    for (const PointKey key : excused) candidates[upper_end(key)] = false;
    bool changed = false;
    for (std::size_t v = 0; v < apart.size(); ++v) {
      if (!candidates[v] || apart[v]) continue;
      apart[v] = true;
      changed = true;
    }
    return changed;
  }

  /// Faces with one simplex above and none below; see the top of this file. Where a flat part has simplices below
  /// as well, they made the cut already.
  std::vector<Piece> faces_met_from_above() {
    std::sort(on_faces_.begin(), on_faces_.end(), [](const OnFace& a, const OnFace& b) {
      return std::tie(a.vertices, a.simplex) < std::tie(b.vertices, b.simplex);
    });
    std::vector<Index> part(flat_count_);  // disjoint sets of the flat simplices
    std::iota(part.begin(), part.end(), Index{0});
    const auto find = [&part](Index i) {
      while (part[i] != i) i = part[i] = part[part[i]];
      return i;
    };
    for_each_on_face([&](std::span<const OnFace> cofaces) {
      const OnFace* first_flat = nullptr;
      for (const OnFace& face : cofaces) {
        if (face.apex != Side::on) continue;
        if (first_flat) part[find(face.flat)] = find(first_flat->flat);
        first_flat = &face;
      }
    });
    std::vector<bool> met_from_below(flat_count_, false);
    for_each_on_face([&](std::span<const OnFace> cofaces) {
      if (count_apexes(cofaces, Side::below) == 0) return;
      for (const OnFace& face : cofaces)
        if (face.apex == Side::on) met_from_below[find(face.flat)] = true;
    });
    std::vector<Piece> faces;
    for_each_on_face([&](std::span<const OnFace> cofaces) {
      if (count_apexes(cofaces, Side::below) != 0 || count_apexes(cofaces, Side::above) != 1) return;
      const OnFace* from_above = nullptr;
      for (const OnFace& face : cofaces) {
        if (face.apex == Side::on && met_from_below[find(face.flat)]) return;
        if (face.apex == Side::above) from_above = &face;
      }
      add_piece(contour_.simplices[from_above->simplex], 1u << from_above->omitted, faces);
    });
    return faces;
  }

  static std::ptrdiff_t count_apexes(std::span<const OnFace> cofaces, Side side) {
    return std::count_if(cofaces.begin(), cofaces.end(), [side](const OnFace& face) { return face.apex == side; });
  }

  template <class Visit>
  void for_each_on_face(const Visit& visit) const {
    for (std::size_t i = 0, j = 0; i < on_faces_.size(); i = j) {
      while (j < on_faces_.size() && on_faces_[j].vertices == on_faces_[i].vertices) ++j;
      visit(std::span(on_faces_).subspan(i, j - i));
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
    const auto& low = contour_.vertices[lower_end(key)];
    const auto& high = contour_.vertices[upper_end(key)];
    std::array<Real, N - 1> result;
    if (high[N - 1] == at_) {
      std::copy_n(high.begin(), N - 1, result.begin());
      return result;
    }
    const auto t = static_cast<double>(low[N - 1]);
    const double beta = (static_cast<double>(at_) - t) / (static_cast<double>(high[N - 1]) - t);
    for (int a = 0; a < N - 1; ++a) {
      const auto x = static_cast<double>(low[a]);
      result[a] = static_cast<Real>(x + beta * (static_cast<double>(high[a]) - x));
    }
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
  std::vector<Piece> pieces_;
  std::vector<OnFace> on_faces_;
  Index flat_count_ = 0;
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
