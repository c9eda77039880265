// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the points where the pieces of a cut are no manifold, by the links of points.
#include "cut/slice_piece.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/workers.hpp"

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

/// Sorts corners that are in the order of pieces by key, then by piece. `numbers`: scratch.
void sort_by_key(std::span<Corner> corners, std::vector<std::uint64_t>& numbers) {
  constexpr std::size_t kFew = 32;
  if (corners.size() <= kFew) {
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const Corner corner = corners[i];
      std::size_t at = i;
      for (; at > 0 && corners[at - 1].key > corner.key; --at) corners[at] = corners[at - 1];
      corners[at] = corner;
    }
    return;
  }
  const Index lower = lower_end(corners.front().key);
  const bool have_one_end =
      corners.back().at >> 32 == 0 &&
      std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) { return lower_end(corner.key) == lower; });
  if (!have_one_end) {
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return std::pair(a.key, a.at) < std::pair(b.key, b.at); });
    return;
  }
  numbers.clear();  // the upper end and the place in one number
  for (const Corner& corner : corners) numbers.push_back(std::uint64_t{upper_end(corner.key)} << 32 | corner.at);
  std::sort(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = {edge_point(lower, static_cast<Index>(numbers[i] >> 32)), numbers[i] & 0xffffffffu};
}

}  // namespace

Buffer<Corner> corners_by_point(std::span<const Piece> pieces, unsigned threads) {
  Index least = std::numeric_limits<Index>::max();
  Index most = 0;
  std::size_t count = 0;
  for (const Piece& piece : pieces)
    for (int i = 0; i < piece.count; ++i, ++count) {
      least = std::min(least, lower_end(piece.points[i]));
      most = std::max(most, lower_end(piece.points[i]));
    }
  Buffer<Corner> corners(count);
  if (count == 0) return corners;
  // A counting sort by lower end, or by its upper bits if the ends are far apart: about as many buckets as corners.
  unsigned shift = 0;
  while ((most - least) >> shift > 2 * count) ++shift;
  const std::size_t buckets = (std::size_t{most - least} >> shift) + 1;
  constexpr std::size_t kPart = std::size_t{1} << 13;  // smaller parts are not worth a thread
  constexpr std::size_t kMostParts = 4;
  const std::size_t parts = std::clamp<std::size_t>(pieces.size() / kPart, 1, threads == 1 ? 1 : kMostParts);
  std::vector<std::vector<std::size_t>> next(parts);  // by part and bucket: counts, then places
  const auto for_corners = [&](const auto& visit) {
    for_each_block(parts, 1, threads, {}, [&](std::size_t part, std::size_t, std::size_t) {
      std::vector<std::size_t>& own = next[part];
      own.resize(buckets);
      for (std::size_t p = pieces.size() * part / parts; p < pieces.size() * (part + 1) / parts; ++p)
        for (int i = 0; i < pieces[p].count; ++i) {
          const PointKey key = pieces[p].points[i];
          visit(own[(lower_end(key) - least) >> shift], Corner{key, 4 * p + static_cast<std::size_t>(i)});
        }
    });
  };
  for_corners([](std::size_t& places, const Corner&) { ++places; });
  std::size_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket)
    for (auto& starts : next) sum += std::exchange(starts[bucket], sum);
  for_corners([&](std::size_t& place, const Corner& corner) { corners[place++] = corner; });
  // Places are now the ends of the buckets. Few corners are in a bucket, in the order of pieces.
  const std::vector<std::size_t>& ends = next.back();
  for_each_block(
      buckets, kPart, threads, {}, [] { return std::vector<std::uint64_t>(); },
      [&](std::size_t, std::size_t from, std::size_t to, std::vector<std::uint64_t>& numbers) {
        for (std::size_t bucket = from, first = from == 0 ? 0 : ends[from - 1]; bucket < to; first = ends[bucket++])
          sort_by_key(std::span<Corner>(corners).subspan(first, ends[bucket] - first), numbers);
      });
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
