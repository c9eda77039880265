// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of simplicial contours by hyperplanes. The text below says "last coordinate = constant". For other hyperplanes
// the height over the hyperplane replaces the last coordinate, and a right-handed frame with the normal replaces the
// axes. The construction depends only on the order of the vertices' heights, so any function on the vertices may serve
// as the height.
//
// Orientation. Let (v_0 … v_{N-1}) be a simplex of the contour, positive towards d: det[v_1 - v_0, …, v_{N-1} - v_0, d]
// > 0, and let g be a direction inside the simplex with a positive last component. A simplex of the cut with edges f_1
// … f_{N-2} must be positive towards the same d, within the hyperplane: det[f_1, …, f_{N-2}, d, e_{N-1}] > 0. Because g
// is a positive multiple of e_{N-1} plus a part inside the hyperplane, exchanging two columns gives det[f_1, …,
// f_{N-2}, g, d] < 0: the cut (f_1 … f_{N-2}), followed by the upward direction, is a negative frame of the simplex. So
// the orientation follows only from which vertices are above and from their order, even if coordinates coincide.
//
// Why the cut of a closed contour is closed. Let h be the coordinate of the hyperplane, and call a vertex at h "on". If
// on vertices count as above, simplices have cut points on the same edges as at h - e, for any e > 0 smaller than the
// distance to the next vertex below: combinatorially the cut is the one at h - e, a manifold. If they count as below,
// it is the cut at h + e. The argument concerns one vertex at a time, so groups of on vertices without an edge between
// them may count differently. A group (on vertices connected by edges among themselves) counts as below if no edge
// leads down from it, else as above: the cut is the limit from below if that exists.
// The cut points around an on vertex u are then merged into u. The result is a manifold if these points span a disc
// (contracting discs to points does not change a surface: R. L. Moore, Concerning upper semi-continuous collections of
// continua, 1925). It is pinched if h is a critical value at u. Such points are kept separate, each at the place of u.
// In the cut of a 5D contour the points around u span a solid, and contracting it may also spoil the links of points
// beside it. All links are tested; vertices at or beside one that is no sphere or disc are left apart.
//
// Why the cut at a layer of the image is the contour M of that layer. The on vertices are the vertices of M (except for
// samples equal to the isovalue). If there are tiles below, each face of M is a face of one simplex from below. The cut
// of that simplex is the face; other simplices collapse. Without tiles below (first layer, or missing values below),
// the vertices of M count as below, and the simplices above are cut to its faces in the same way. If the contour is
// closed at its first layer, the cap lies in the hyperplane with nothing below. If tiles below are missing only under a
// part of M, the faces with simplices above are boundary faces of the contour and are added unchanged.
//
// If samples equal the isovalue, boundary faces may also lie in the hyperplane for another reason: faces in a side of
// the image along another axis whose vertices are all on. The cut from below is complete without them. The extraction
// creates no such faces for layers of the last axis. For other axes, faces that may be of this kind are omitted; for
// oblique hyperplanes, which are no layers, all are omitted.
#include "cut/closed_cut.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/disjoint_sets.hpp"
#include "base/index_map.hpp"
#include "base/periods.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "cut/point_numbers.hpp"
#include "cut/simplex_cut.hpp"
#include "cut/slice_piece.hpp"

namespace tegl::detail {
namespace {

/// An (N-2)-face that lies in the hyperplane, as seen from one of its simplices.
template <int N>
struct OnFace {
  std::array<Index, N - 1> vertices;  // ascending
  Index simplex;
  int omitted;  // position in the simplex of the vertex that is not in the face
};

/// Sorts by the vertices, then by simplex. `most`: maximum vertex number.
template <int N>
void sort_on_faces(std::vector<OnFace<N>>& on_faces, Index most) {
  sort_by_bits(on_faces, static_cast<unsigned>(std::bit_width(most)),
               [](const OnFace<N>& face) { return face.vertices[0]; });
  const auto before = [](const OnFace<N>& a, const OnFace<N>& b) {
    return std::tie(a.vertices, a.simplex) < std::tie(b.vertices, b.simplex);
  };
  // sort by all vertices within runs of equal first vertex
  for (auto from = on_faces.begin(), to = from; from != on_faces.end(); from = to) {
    to = std::find_if(from, on_faces.end(), [&](const OnFace<N>& f) { return f.vertices[0] != from->vertices[0]; });
    std::sort(from, to, before);
  }
}

/// Sorts entries of on vertices: twice the vertex, plus 0 or 1. `most`: maximum vertex number.
void sort_entries(std::vector<std::uint64_t>& entries, Index most) {
  sort_by_bits(entries, static_cast<unsigned>(std::bit_width(most)) + 1, [](std::uint64_t entry) { return entry; });
}

template <int N, class Real>
class Cutter {
 public:
  Cutter(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level,
         std::span<const Index> touching, unsigned threads, std::span<const Side> sides)
      : contour_(contour),
        family_(family),
        level_(level),
        touching_(touching),
        threads_(threads),
        sides_of_vertices_(sides) {}

  Contour<N - 1, Real> cut() {
    if (!cut_between_vertices()) {
      classify();
      merge_on_vertices();
      divide_pieces();
    }
    number_points();
    if (keys_.size() > std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, fmt::format("{} vertices in a slice; expected at most {}", keys_.size(),
                                                   std::numeric_limits<Index>::max()));
    Contour<N - 1, Real> result;
    for (int i = 0, a = 0; i < N - 1; ++i, ++a) {
      a += a == family_.dropped_axis();
      if (!family_.keeps_axis(i)) continue;
      result.axis_names[i] = contour_.axis_names[a];
      result.axis_units[i] = contour_.axis_units[a];
    }
    result.direction = contour_.direction;
    result.periods = periods_within();
    result.vertices.resize(keys_.size());
    for_each_item(keys_.size(), threads_, {}, [&](std::size_t i) { result.vertices[i] = position(keys_[i]); });
    if (!contour_.normals.empty()) {
      result.normals.resize(keys_.size());
      for_each_item(keys_.size(), threads_, {}, [&](std::size_t i) { result.normals[i] = normal(keys_[i]); });
    }
    for (const Attribute& attribute : contour_.vertex_attributes)
      result.vertex_attributes.push_back(interpolated(attribute));
    emit(result);
    return result;
  }

 private:
  using OnFace = detail::OnFace<N>;
  static constexpr unsigned kAll = (1u << N) - 1;

  /// The vertices of a simplex below the hyperplane and on it: bit j for vertex j.
  struct Sides {
    std::uint8_t below = 0;
    std::uint8_t on = 0;
  };

  /// A piece, by the numbers of its points in its part. Triangles have no last point.
  using PieceOfPart = std::array<std::uint16_t, 4>;
  static constexpr std::uint16_t kNone = std::numeric_limits<std::uint16_t>::max();
  /// A part of the pieces.
  struct Part {
    std::vector<PieceOfPart> pieces;
    std::vector<Index> sources;      ///< by piece, if simplices have attributes: the simplex that was cut
    std::vector<PointKey> keys;      ///< of the points, until they have numbers
    std::span<const Index> numbers;  ///< of the points, in the cut
    std::size_t simplices = 0;       ///< of the cut
  };

  void add(const Piece& piece, PartPoints& points, Part& part) const {
    PieceOfPart& numbers = part.pieces.emplace_back();
    numbers.fill(kNone);
    for (int k = 0; k < piece.count; ++k) numbers[k] = static_cast<std::uint16_t>(points.number_of(piece.points[k]));
    part.simplices += N == 4 ? static_cast<std::size_t>(piece.count - 2) : 1;
    if (!contour_.simplex_attributes.empty()) part.sources.push_back(piece.simplex);
  }

  /// Cuts all simplices, if no vertex is on the hyperplane. Returns false if one is.
  bool cut_between_vertices() {
    parts_.resize(block_count(touching_.size(), kBlock));
    std::atomic<bool> any_on = false;
    for_each_block(
        touching_.size(), kBlock, threads_, {}, [] { return PartPoints(); },
        [&](std::size_t block, std::size_t from, std::size_t to, PartPoints& points) {
          Part& part = parts_[block];
          part.pieces.reserve(to - from);
          for (std::size_t i = from; i < to; ++i) {
            const auto& simplex = contour_.simplices[touching_[i]];
            const Sides sides = sides_of(simplex);
            if (sides.on != 0) return any_on.store(true, std::memory_order_relaxed);
            visit_pieces<N>(simplex, touching_[i], kAll & ~unsigned{sides.below},
                            [&](const Piece& piece) { add(piece, points, part); });
          }
          part.keys = points.take_keys();
        });
    if (any_on) parts_.clear();
    return !any_on;
  }

  /// The periods of the cut of a wrapped contour, none of which the hyperplane crosses.
  [[nodiscard]] std::vector<Period<N - 1>> periods_within() const {
    std::vector<Period<N - 1>> result;
    for (const Period<N>& period : contour_.periods) {
      Period<N - 1>& inside = result.emplace_back();
      inside.vector = family_.within(period.vector);
      inside.dual = family_.within(period.dual);
      // without the part of <dual, x> that is the same for all points of the cut
      inside.start = period.start - share_of(period, family_.origin(level_));
    }
    return result;
  }

  [[nodiscard]] double height(Index v) const { return family_.height(contour_.vertices[v]); }
  [[nodiscard]] bool is_on(Index v) const { return height(v) == level_; }

  /// Classifies all vertices, lists the on vertices, and finds those that count as below.
  void classify() {
    // One entry per on vertex of each simplex: twice the vertex, plus 1 if the simplex has a vertex below. Most entries
    // are duplicates from neighbouring simplices; a small cache of recent entries removes them.
    constexpr std::size_t kRecent = 1 << 12;
    struct Found {
      std::vector<std::uint64_t> on;
      Index most = 0;
    };
    std::vector<Found> parts(block_count(touching_.size(), kBlock));
    sides_.resize(touching_.size());
    for_each_block(
        touching_.size(), kBlock, threads_, {}, [] { return std::vector<std::uint64_t>(kRecent); },
        [&](std::size_t block, std::size_t from, std::size_t to, std::vector<std::uint64_t>& recent) {
          Found& found = parts[block];
          // empty, so that the entries do not depend on what else the thread has done
          std::fill(recent.begin(), recent.end(), ~std::uint64_t{0});
          for (std::size_t i = from; i < to; ++i) {
            const auto& simplex = contour_.simplices[touching_[i]];
            const Sides sides = sides_of(simplex);
            sides_[i] = sides;
            found.most = std::max(found.most, *std::max_element(simplex.begin(), simplex.end()));
            for (unsigned left = sides.on; left != 0; left &= left - 1) {
              const std::uint64_t entry =
                  2 * std::uint64_t{simplex[std::countr_zero(left)]} + static_cast<unsigned>(sides.below != 0);
              if (std::exchange(recent[entry % kRecent], entry) != entry) found.on.push_back(entry);
            }
          }
        });
    std::vector<std::uint64_t> on;
    for (const Found& found : parts) {
      on.insert(on.end(), found.on.begin(), found.on.end());
      most_ = std::max(most_, found.most);
    }
    if (!on.empty()) list_on_vertices(std::move(on));
  }

  [[nodiscard]] Sides sides_of(const std::array<Index, N>& simplex) const {
    Sides sides;
    if (!sides_of_vertices_.empty()) {
      for (int j = 0; j < N; ++j) {
        const Side here = sides_of_vertices_[simplex[j]];
        sides.below = static_cast<std::uint8_t>(sides.below | static_cast<unsigned>(here == Side::below) << j);
        sides.on = static_cast<std::uint8_t>(sides.on | static_cast<unsigned>(here == Side::on) << j);
      }
      return sides;
    }
    for (int j = 0; j < N; ++j) {
      const double here = height(simplex[j]);
      sides.below = static_cast<std::uint8_t>(sides.below | static_cast<unsigned>(here < level_) << j);
      sides.on = static_cast<std::uint8_t>(sides.on | static_cast<unsigned>(here == level_) << j);
    }
    return sides;
  }

  void list_on_vertices(std::vector<std::uint64_t> entries) {
    sort_entries(entries, most_);
    std::vector<Index> on;
    std::vector<bool> has_way_down;
    bool all_have = true;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (i + 1 < entries.size() && entries[i + 1] / 2 == entries[i] / 2) continue;
      on.push_back(static_cast<Index>(entries[i] / 2));
      has_way_down.push_back(entries[i] % 2 == 1);
      all_have = all_have && has_way_down.back();
    }
    is_low_.assign(on.size(), false);
    on_ = IndexMap(std::move(on));
    if (!all_have) group_on_vertices(std::move(has_way_down));
  }

  /// Marks the groups of on vertices without an edge leading down: they count as below.
  void group_on_vertices(std::vector<bool> has_way_down) {
    BasicDisjointSets<std::size_t> groups(on_.size());
    for (std::size_t i = 0; i < touching_.size(); ++i) {
      std::optional<std::size_t> last;
      for (unsigned left = sides_[i].on; left != 0; left &= left - 1) {
        const std::size_t here = on_(contour_.simplices[touching_[i]][std::countr_zero(left)]);
        if (last) groups.join(here, *last);
        last = here;
      }
    }
    for (std::size_t i = 0; i < on_.size(); ++i)
      if (has_way_down[i]) has_way_down[groups.find(i)] = true;
    for (std::size_t i = 0; i < on_.size(); ++i) {
      is_low_[i] = !has_way_down[groups.find(i)];
      any_low_ = any_low_ || is_low_[i];
    }
  }

  /// The on vertices of the i-th touching simplex that count as above.
  [[nodiscard]] unsigned on_high(std::size_t i) const {
    if (!any_low_) return sides_[i].on;
    unsigned result = 0;
    for (unsigned left = sides_[i].on; left != 0; left &= left - 1)
      if (const int j = std::countr_zero(left); !is_low_[on_(contour_.simplices[touching_[i]][j])]) result |= 1u << j;
    return result;
  }

  /// The vertices of the i-th touching simplex that are above or count as above.
  [[nodiscard]] unsigned high(std::size_t i) const {
    return (kAll & ~(unsigned{sides_[i].below} | sides_[i].on)) | on_high(i);
  }

  /// The pieces of all simplices. Points around on vertices are merged, except around the vertices in `apart`.
  /// Collapsed pieces are omitted.
  [[nodiscard]] Buffer<Piece> cut_pieces(const std::vector<bool>& apart) const {
    const bool any_apart = std::find(apart.begin(), apart.end(), true) != apart.end();
    const auto is_merged = [&](Index v) { return !any_apart || !apart[on_(v)]; };
    std::vector<std::vector<Piece>> parts(block_count(touching_.size(), kBlock));
    for_each_block(touching_.size(), kBlock, threads_, {}, [&](std::size_t block, std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const unsigned above = high(i);
        if (above == 0 || above == kAll) continue;
        visit_pieces<N>(contour_.simplices[touching_[i]], touching_[i], above, [&](const Piece& piece) {
          const Piece merged = sides_[i].on == 0 ? piece : merged_piece(piece, is_merged);
          if (merged.count >= N - 1) parts[block].push_back(merged);
        });
      }
    });
    Buffer<Piece> result;
    result.reserve(std::accumulate(parts.begin(), parts.end(), std::size_t{0},
                                   [](std::size_t sum, const auto& part) { return sum + part.size(); }));
    for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
    return result;
  }

  /// The piece with its points around on vertices merged, where `is_merged(vertex)`.
  template <class IsMerged>
  [[nodiscard]] Piece merged_piece(const Piece& piece, const IsMerged& is_merged) const {
    Piece merged;
    merged.simplex = piece.simplex;
    merged.count = 0;
    for (int k = 0; k < piece.count; ++k) {
      const std::optional<Index> on = on_end(piece.points[k]);
      const PointKey key = on && is_merged(*on) ? vertex_point(*on) : piece.points[k];
      // Merged points of a polygon are adjacent in the cycle, because they share the on vertex. The points of a
      // tetrahedron are in no cycle; any two that are merged leave less than four.
      const auto* const end = merged.points.cbegin() + merged.count;
      const bool repeats =
          N == 5 ? std::find(merged.points.cbegin(), end, key) != end
                 : merged.count > 0 && (*(end - 1) == key || (k == piece.count - 1 && merged.points[0] == key));
      if (!repeats) merged.points[merged.count++] = key;
    }
    return merged;
  }

  /// The end of a point's edge that is on. At most one end is on: two would be in the same group and on the same side.
  [[nodiscard]] std::optional<Index> on_end(PointKey key) const {
    if (on_.empty()) return std::nullopt;
    if (is_on(upper_end(key))) return upper_end(key);
    if (is_on(lower_end(key))) return lower_end(key);
    return std::nullopt;
  }

  /// Merges the points around on vertices. If the result is pinched at a vertex where the points themselves were not,
  /// that vertex is left apart. Each round leaves more vertices apart; with all apart, nothing is pinched.
  void merge_on_vertices() {
    std::vector<Piece> faces = faces_met_from_above();
    std::vector<bool> apart(on_.size(), false);
    std::vector<PointKey> excused;
    for (int round = 0;; ++round) {
      Buffer<Piece> merged = cut_pieces(apart);
      merged.insert(merged.end(), faces.begin(), faces.end());
      set_pieces(std::move(merged));
      const std::vector<PointKey> pinched = nonmanifold_points(pieces_, corners_, N - 2);
      if (round == 0 && !pinched.empty()) {
        const Buffer<Piece> unmerged = cut_pieces(std::vector<bool>(on_.size(), true));
        excused = nonmanifold_points(unmerged, corners_by_point(unmerged, threads_), N - 2);
      }
      if (!drop_faces(pinched, apart, faces) && !leave_apart(pinched, excused, round >= kMostRounds, apart)) return;
    }
  }

  void set_pieces(Buffer<Piece> pieces) {
    pieces_ = std::move(pieces);
    corners_ = corners_by_point(pieces_, threads_);
  }

  /// Marks the on vertices among the pinched points (with `all`, every on vertex) as apart, except those whose points
  /// were already pinched before merging, as next to missing values. Returns whether anything changed.
  bool leave_apart(const std::vector<PointKey>& pinched, const std::vector<PointKey>& excused, bool all,
                   std::vector<bool>& apart) const {
    std::vector<bool> candidates(apart.size(), all && !pinched.empty());
    for (const PointKey key : pinched) mark_merged_near(key, candidates);
    for (const PointKey key : excused)
      if (const std::optional<Index> on = on_end(key)) candidates[on_(*on)] = false;
    bool changed = false;
    for (std::size_t i = 0; i < apart.size(); ++i) {
      if (!candidates[i] || apart[i]) continue;
      apart[i] = true;
      changed = true;
    }
    return changed;
  }

  /// Marks the on vertex of a merged point. Contracting discs never pinches a surface anywhere else; contracted solids
  /// may, so in a cut of tetrahedra the merged points next to another pinched point are marked.
  void mark_merged_near(PointKey key, std::vector<bool>& marks) const {
    if (is_vertex_point(key)) marks[on_(upper_end(key))] = true;
    if (N < 5 || is_vertex_point(key)) return;
    const auto first = std::lower_bound(corners_.begin(), corners_.end(), key,
                                        [](const Corner& corner, PointKey k) { return corner.key < k; });
    for (auto corner = first; corner != corners_.end() && corner->key == key; ++corner)
      for (const PointKey near : pieces_[corner->at / 4].points)
        if (is_vertex_point(near)) marks[on_(upper_end(near))] = true;
  }

  /// Removes faces at vertices that are apart and still pinched: only faces meet there. Returns whether any were
  /// removed.
  bool drop_faces(const std::vector<PointKey>& pinched, const std::vector<bool>& apart,
                  std::vector<Piece>& faces) const {
    return std::erase_if(faces, [&](const Piece& face) {
             return std::any_of(face.points.begin(), face.points.begin() + face.count, [&](PointKey key) {
               return apart[on_(upper_end(key))] && std::binary_search(pinched.begin(), pinched.end(), key);
             });
           }) > 0;
  }

  /// Range of the touching simplices along each axis.
  using Reach = std::array<std::pair<Real, Real>, N>;
  [[nodiscard]] Reach reach() const {
    Reach result;
    const auto& first = contour_.vertices[contour_.simplices[touching_[0]][0]];
    for (int a = 0; a < N; ++a) result[a] = {first[a], first[a]};
    for (const Index s : touching_)
      for (const Index v : contour_.simplices[s])
        for (int a = 0; a < N; ++a) {
          result[a].first = std::min(result[a].first, contour_.vertices[v][a]);
          result[a].second = std::max(result[a].second, contour_.vertices[v][a]);
        }
    return result;
  }

  /// Whether a boundary face may lie in a side of the image along another axis than the cut's. Then all its vertices
  /// share that coordinate, and its simplex extends inwards or lies in the side as well, at the end of the range.
  [[nodiscard]] bool may_lie_in_another_side(const OnFace& face, const Reach& reach) const {
    const auto& inside = contour_.vertices[contour_.simplices[face.simplex][face.omitted]];
    const auto& first = contour_.vertices[face.vertices[0]];
    for (int a = 0; a < N; ++a) {
      const auto [low, high] = reach[a];
      const bool may_be_side = low < high && (first[a] == low || first[a] == high);
      if (a == family_.dropped_axis() || (inside[a] == first[a] && !may_be_side)) continue;
      if (std::all_of(face.vertices.begin(), face.vertices.end(),
                      [&](Index v) { return contour_.vertices[v][a] == first[a]; }))
        return true;
    }
    return false;
  }

  /// The boundary faces of the contour among on vertices that count as above, with their simplex above; see the top of
  /// this file.
  [[nodiscard]] std::vector<Piece> faces_met_from_above() const {
    if (!family_.is_across_axis()) return {};
    std::vector<OnFace> on_faces;
    for (std::size_t i = 0; i < touching_.size(); ++i)
      if (std::popcount(unsigned{sides_[i].on}) >= N - 1) gather_on_faces(touching_[i], on_high(i), on_faces);
    sort_on_faces<N>(on_faces, most_);
    // keep the boundary faces whose simplex is above
    std::vector<Piece> faces;
    if (on_faces.empty()) return faces;
    const Reach reach = this->reach();
    for (std::size_t i = 0, j = 0; i < on_faces.size(); i = j) {
      while (j < on_faces.size() && on_faces[j].vertices == on_faces[i].vertices) ++j;
      const auto& simplex = contour_.simplices[on_faces[i].simplex];
      if (j - i != 1 || !(height(simplex[on_faces[i].omitted]) > level_)) continue;
      if (!family_.is_along_last_axis() && may_lie_in_another_side(on_faces[i], reach)) continue;
      visit_pieces<N>(simplex, on_faces[i].simplex, 1u << on_faces[i].omitted, [&](Piece face) {
        for (int k = 0; k < face.count; ++k) face.points[k] = vertex_point(lower_end(face.points[k]));
        faces.push_back(face);
      });
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

  void divide_pieces() {
    parts_.resize(block_count(pieces_.size(), kBlock));
    PartPoints points;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      Part& part = parts_[p / kBlock];
      add(pieces_[p], points, part);
      if (p % kBlock + 1 == kBlock || p + 1 == pieces_.size()) part.keys = points.take_keys();
    }
    pieces_ = {};
    corners_ = {};
  }

  /// Numbers the points of all parts in the order of their keys.
  void number_points() {
    std::vector<std::span<const PointKey>> keys;
    for (const Part& part : parts_) keys.push_back(part.keys);
    std::size_t first = 0;
    keys_ = number_points_of_parts(keys, numbers_);
    for (Part& part : parts_) {
      part.numbers = std::span<const Index>(numbers_).subspan(first, part.keys.size());
      first += part.keys.size();
      part.keys = {};
    }
  }

  /// The edge of a point and the fraction at which it lies. If a vertex is on, both ends are that vertex.
  struct Place {
    Index low;
    Index high;
    double share;
  };
  [[nodiscard]] Place place(PointKey key) const {
    if (const std::optional<Index> on = on_end(key)) return {*on, *on, 0.0};
    const double below = height(lower_end(key));
    return {lower_end(key), upper_end(key), (level_ - below) / (height(upper_end(key)) - below)};
  }

  static double between(double low, double high, double share) { return low + share * (high - low); }
  static std::array<double, N> between(const std::array<Real, N>& low, const std::array<Real, N>& high, double share) {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) x[a] = between(static_cast<double>(low[a]), static_cast<double>(high[a]), share);
    return x;
  }

  [[nodiscard]] std::array<Real, N - 1> position(PointKey key) const {
    const auto [low, high, share] = place(key);
    if (!contour_.periods.empty()) {
      const auto point = between_modulo<N>(contour_.vertices[low], contour_.vertices[high], share,
                                           std::span<const Period<N>>(contour_.periods));
      const std::array<double, N - 1> inside = family_.within(widened_point<N>(point));
      std::array<Real, N - 1> result;
      for (int a = 0; a < N - 1; ++a) result[a] = static_cast<Real>(inside[a]);
      return result;
    }
    const std::array<double, N - 1> y = family_.within(between(contour_.vertices[low], contour_.vertices[high], share));
    std::array<Real, N - 1> result;
    for (int a = 0; a < N - 1; ++a) result[a] = static_cast<Real>(y[a]);
    return result;
  }

  /// The normal of the contour at the point, projected into the hyperplane: the projected gradient is the gradient of
  /// the field in the hyperplane.
  [[nodiscard]] std::array<Real, N - 1> normal(PointKey key) const {
    const auto [low, high, share] = place(key);
    const std::array<double, N - 1> v = family_.within(between(contour_.normals[low], contour_.normals[high], share));
    double square = 0.0;
    for (const double component : v) square += component * component;
    std::array<Real, N - 1> result;
    for (int a = 0; a < N - 1; ++a) result[a] = square > 0.0 ? static_cast<Real>(v[a] / std::sqrt(square)) : Real{0};
    return result;
  }

  [[nodiscard]] Attribute interpolated(const Attribute& attribute) const {
    const auto width = static_cast<std::size_t>(attribute.width);
    Attribute result{attribute.name, attribute.unit, attribute.width, {}};
    result.values.reserve(keys_.size() * width);
    for (const PointKey key : keys_) {
      const auto [low, high, share] = place(key);
      for (std::size_t i = 0; i < width; ++i)
        result.values.push_back(between(attribute.values[low * width + i], attribute.values[high * width + i], share));
    }
    return result;
  }

  void emit(Contour<N - 1, Real>& result) const {
    std::vector<std::size_t> first(1, 0);  // by part
    for (const Part& part : parts_) first.push_back(first.back() + part.simplices);
    result.simplices.resize(first.back());
    Buffer<Index> sources(contour_.simplex_attributes.empty() ? 0 : first.back());
    for_each_block(parts_.size(), 1, threads_, {},
                   [&](std::size_t p, std::size_t, std::size_t) { emit_part(parts_[p], first[p], result, sources); });
    // copy the attributes of the source simplices
    for (const Attribute& attribute : contour_.simplex_attributes) {
      const auto width = static_cast<std::size_t>(attribute.width);
      Attribute& rows = result.simplex_attributes.emplace_back();
      rows = {attribute.name, attribute.unit, attribute.width, {}};
      rows.values.reserve(sources.size() * width);
      for (const Index s : sources) {
        const double* const row = attribute.values.data() + s * width;
        rows.values.insert(rows.values.end(), row, row + width);
      }
    }
  }

  /// Writes the simplices of a part from place `next`, and their sources if these are wanted.
  void emit_part(const Part& part, std::size_t next, Contour<N - 1, Real>& result, Buffer<Index>& sources) const {
    const bool swaps = !family_.is_right_handed();
    for (std::size_t p = 0; p < part.pieces.size(); ++p) {
      std::array<Index, 4> points{};
      int count = 0;
      for (; count < 4 && part.pieces[p][count] != kNone; ++count) points[count] = part.numbers[part.pieces[p][count]];
      const auto add = [&](const std::array<int, N - 1>& corners) {
        std::array<Index, N - 1>& simplex = result.simplices[next];
        for (int i = 0; i < N - 1; ++i) simplex[i] = points[corners[i]];
        if (swaps) std::swap(simplex[N - 3], simplex[N - 2]);
        if (!sources.empty()) sources[next] = part.sources[p];
        ++next;
      };
      if constexpr (N == 3) {
        add({0, 1});
      } else if constexpr (N == 5) {
        add({0, 1, 2, 3});
      } else if (count == 3) {
        add({0, 1, 2});
      } else if (splits_from_first(result, points)) {
        add({0, 1, 2});
        add({0, 2, 3});
      } else {
        add({1, 2, 3});
        add({1, 3, 0});
      }
    }
  }

  /// Splits at the shorter diagonal. Of two equal ones, takes the one with the first end in lexicographic order of the
  /// coordinates, so that the choice depends only on the places of the points.
  static bool splits_from_first(const Contour<N - 1, Real>& result, const std::array<Index, 4>& points) {
    const auto corner = [&](int i) -> const std::array<Real, N - 1>& { return result.vertices[points[i]]; };
    const auto length = [&](int i, int j) {
      double sum = 0.0;
      std::array<double, N - 1> to = widened_point<N - 1>(corner(j));
      const std::array<double, N - 1> from = widened_point<N - 1>(corner(i));
      if (!result.periods.empty()) move_near(std::span<const Period<N - 1>>(result.periods), from, to);
      for (int a = 0; a < N - 1; ++a) sum += (to[a] - from[a]) * (to[a] - from[a]);
      return sum;
    };
    const double first = length(0, 2);
    const double second = length(1, 3);
    if (first != second) return first < second;
    return std::minmax(corner(0), corner(2)) <= std::minmax(corner(1), corner(3));
  }

  static constexpr std::size_t kBlock = std::size_t{1} << 12;  ///< simplices of a part of the work
  static constexpr int kMostRounds = 16;  ///< then all on vertices are left apart, to bound the time

  const Contour<N, Real>& contour_;
  const HyperplaneFamily<N>& family_;
  const double level_;
  const std::span<const Index> touching_;  ///< simplices not entirely on one side
  const unsigned threads_;
  const std::span<const Side> sides_of_vertices_;  ///< of the contour; if empty, heights are compared
  IndexMap on_;                                    ///< vertices of these simplices on the hyperplane
  std::vector<bool> is_low_;                       ///< by on vertex: whether it counts as below
  bool any_low_ = false;
  std::vector<Sides> sides_;  ///< by touching simplex
  Index most_ = 0;            ///< maximum number of their vertices
  Buffer<Piece> pieces_;      ///< if there are vertices on the hyperplane
  Buffer<Corner> corners_;    ///< incidences of the pieces, sorted by key
  std::vector<Part> parts_;
  std::vector<Index> numbers_;  ///< of the points of the parts, part by part
  std::vector<PointKey> keys_;  ///< of the points of the cut
};

}  // namespace

template <int N, class Real>
Contour<N - 1, Real> cut_simplices(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level,
                                   std::span<const Index> touching, unsigned threads, std::span<const Side> sides) {
  return Cutter<N, Real>(contour, family, level, touching, threads, sides).cut();
}

template Contour<2, float> cut_simplices(const Contour<3, float>&, const HyperplaneFamily<3>&, double,
                                         std::span<const Index>, unsigned, std::span<const Side>);
template Contour<2, double> cut_simplices(const Contour<3, double>&, const HyperplaneFamily<3>&, double,
                                          std::span<const Index>, unsigned, std::span<const Side>);
template Contour<3, float> cut_simplices(const Contour<4, float>&, const HyperplaneFamily<4>&, double,
                                         std::span<const Index>, unsigned, std::span<const Side>);
template Contour<3, double> cut_simplices(const Contour<4, double>&, const HyperplaneFamily<4>&, double,
                                          std::span<const Index>, unsigned, std::span<const Side>);
template Contour<4, float> cut_simplices(const Contour<5, float>&, const HyperplaneFamily<5>&, double,
                                         std::span<const Index>, unsigned, std::span<const Side>);
template Contour<4, double> cut_simplices(const Contour<5, double>&, const HyperplaneFamily<5>&, double,
                                          std::span<const Index>, unsigned, std::span<const Side>);

}  // namespace tegl::detail
