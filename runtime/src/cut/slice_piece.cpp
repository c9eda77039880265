// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the points where the pieces of a cut are no manifold, by the links of points.
#include "cut/slice_piece.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/radix_sort.hpp"

namespace tegl::detail {
namespace {

/// Tests the links of points one by one, with shared memory.
class Links {
 public:
  explicit Links(std::span<const Piece> pieces) : pieces_(pieces) {}

  /// Whether the polygons at a point form one fan: their edges in the link (from the previous to the next point of each
  /// cycle) form one path or one cycle. The link's vertices are the neighbours of the point.
  bool is_fan(std::span<const Corner> corners) {
    ends_.clear();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Piece& piece = pieces_[corners[c].at / 4];
      const int here = static_cast<int>(corners[c].at % 4);
      ends_.emplace_back(piece.points[here == 0 ? piece.count - 1 : here - 1], c);
      ends_.emplace_back(piece.points[here + 1 == piece.count ? 0 : here + 1], c);
    }
    std::sort(ends_.begin(), ends_.end());
    sets_.reset(corners.size());
    std::size_t parts = corners.size();
    for (std::size_t i = 1; i < ends_.size(); ++i) {
      if (ends_[i].first != ends_[i - 1].first) continue;
      if (i >= 2 && ends_[i].first == ends_[i - 2].first) return false;  // an edge in three polygons
      parts -= sets_.join(ends_[i].second, ends_[i - 1].second);
    }
    return parts == 1;
  }

  /// Whether the link of a point in tetrahedra is a sphere or a disc. Each tetrahedron has a triangle in the link. If
  /// each edge is in one or two triangles and the triangles are connected across edges, then it is one iff the Euler
  /// characteristic is 2 without a border, or 1 with one (see mesh/star_search.hpp).
  bool is_sphere_or_disc(std::span<const Corner> corners) {
    edges_.clear();
    ends_.clear();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Piece& piece = pieces_[corners[c].at / 4];
      const std::size_t here = corners[c].at % 4;
      for (std::size_t i = 1; i < 4; ++i) {
        const PointKey a = piece.points[(here + i) % 4];
        const PointKey b = piece.points[(here + (i == 3 ? 1 : i + 1)) % 4];
        edges_.push_back({std::minmax(a, b), c});
        ends_.emplace_back(a, 0);
      }
    }
    std::sort(ends_.begin(), ends_.end());
    const auto vertices = std::unique(ends_.begin(), ends_.end()) - ends_.begin();
    std::sort(edges_.begin(), edges_.end());
    sets_.reset(corners.size());
    std::size_t parts = corners.size();
    std::ptrdiff_t inner = 0;
    for (std::size_t i = 1; i < edges_.size(); ++i) {
      if (edges_[i].first != edges_[i - 1].first) continue;
      if (i >= 2 && edges_[i].first == edges_[i - 2].first) return false;  // a triangle in three tetrahedra
      parts -= sets_.join(edges_[i].second, edges_[i - 1].second);
      ++inner;
    }
    const auto triangles = static_cast<std::ptrdiff_t>(corners.size());
    const std::ptrdiff_t edges = 3 * triangles - inner;
    const bool has_border = edges != inner;
    return parts == 1 && vertices - edges + triangles == (has_border ? 1 : 2);
  }

 private:
  std::span<const Piece> pieces_;
  std::vector<std::pair<std::pair<PointKey, PointKey>, std::size_t>> edges_;  ///< with their triangles
  std::vector<std::pair<PointKey, std::size_t>> ends_;
  BasicDisjointSets<std::size_t> sets_;
};

}  // namespace

std::vector<Corner> corners_by_point(std::span<const Piece> pieces, Index most, unsigned threads) {
  std::vector<Corner> corners;
  std::size_t count = 0;
  for (const Piece& piece : pieces) count += static_cast<std::size_t>(piece.count);
  corners.reserve(count);
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (int i = 0; i < pieces[p].count; ++i)
      corners.push_back({pieces[p].points[i], 4 * p + static_cast<std::size_t>(i)});
  sort_by_bits(
      corners, static_cast<unsigned>(std::bit_width(most)), [](const Corner& corner) { return lower_end(corner.key); },
      threads);
  // Few edges share a lower end, so a comparison sort is fast.
  for (std::size_t i = 0, j = 0; i < corners.size(); i = j) {
    bool sorted = true;
    for (j = i + 1; j < corners.size() && lower_end(corners[j].key) == lower_end(corners[i].key); ++j)
      sorted = sorted && corners[j - 1].key <= corners[j].key;
    const auto from = corners.begin() + static_cast<std::ptrdiff_t>(i);
    if (!sorted)
      std::sort(from, corners.begin() + static_cast<std::ptrdiff_t>(j),
                [](const Corner& a, const Corner& b) { return std::pair(a.key, a.at) < std::pair(b.key, b.at); });
  }
  return corners;
}

std::vector<PointKey> nonmanifold_points(std::span<const Piece> pieces, std::span<const Corner> corners, int dim) {
  std::vector<PointKey> result;
  Links links(pieces);
  const auto is_manifold = [&](std::span<const Corner> of_point) {
    return dim == 1 ? of_point.size() <= 2 : dim == 2 ? links.is_fan(of_point) : links.is_sphere_or_disc(of_point);
  };
  for (std::size_t i = 0, j = 0; i < corners.size(); i = j) {
    for (j = i + 1; j < corners.size() && corners[j].key == corners[i].key;) ++j;
    if (!is_manifold(corners.subspan(i, j - i))) result.push_back(corners[i].key);
  }
  return result;
}

}  // namespace tegl::detail
