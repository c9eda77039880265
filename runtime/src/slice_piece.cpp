// SPDX-License-Identifier: BSD-3-Clause
//
// Where the pieces of a cut do not make a manifold: the links of its points.
#include "slice_piece.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace tegl::detail {
namespace {

/// The corner i of piece p has the number 4 p + i.
constexpr std::size_t corner_number(std::size_t piece, int i) { return 4 * piece + static_cast<std::size_t>(i); }

/// A side of a polygon, from its smaller to its larger point, and the polygon's corners there.
struct PolygonSide {
  PointKey first;
  PointKey second;
  std::size_t first_corner;
  std::size_t second_corner;
};

class Fans {
 public:
  explicit Fans(std::span<const Piece> pieces) : pieces_(pieces), parent_(4 * pieces.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    gather_sides();
  }

  std::vector<PointKey> pinched() {
    std::vector<PointKey> result;
    for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
      while (j < sides_.size() && sides_[j].first == sides_[i].first && sides_[j].second == sides_[i].second) ++j;
      if (j - i > 2) result.insert(result.end(), {sides_[i].first, sides_[i].second});
      if (j - i != 2) continue;
      join(sides_[i].first_corner, sides_[i + 1].first_corner);
      join(sides_[i].second_corner, sides_[i + 1].second_corner);
    }
    add_points_of_several_fans(result);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  void gather_sides() {
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (int i = 0; i < pieces_[p].count; ++i) {
        const int j = i + 1 == pieces_[p].count ? 0 : i + 1;
        PolygonSide side{pieces_[p].points[i], pieces_[p].points[j], corner_number(p, i), corner_number(p, j)};
        if (side.first > side.second) {
          std::swap(side.first, side.second);
          std::swap(side.first_corner, side.second_corner);
        }
        sides_.push_back(side);
      }
    std::sort(sides_.begin(), sides_.end(), [](const PolygonSide& a, const PolygonSide& b) {
      return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
  }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

  void add_points_of_several_fans(std::vector<PointKey>& result) {
    std::vector<std::pair<PointKey, std::size_t>> fans;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (int i = 0; i < pieces_[p].count; ++i) fans.emplace_back(pieces_[p].points[i], find(corner_number(p, i)));
    std::sort(fans.begin(), fans.end());
    for (std::size_t i = 1; i < fans.size(); ++i)
      if (fans[i].first == fans[i - 1].first && fans[i].second != fans[i - 1].second) result.push_back(fans[i].first);
  }

  std::span<const Piece> pieces_;
  std::vector<std::size_t> parent_;
  std::vector<PolygonSide> sides_;
};

/// Points where more than two segments meet.
std::vector<PointKey> branching_points(std::span<const Piece> segments) {
  std::vector<PointKey> ends;
  for (const Piece& segment : segments) ends.insert(ends.end(), {segment.points[0], segment.points[1]});
  std::sort(ends.begin(), ends.end());
  std::vector<PointKey> result;
  for (std::size_t i = 2; i < ends.size(); ++i)
    if (ends[i] == ends[i - 2]) result.push_back(ends[i]);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

std::vector<PointKey> pinched_points(std::span<const Piece> pieces) {
  if (!pieces.empty() && pieces[0].count == 2) return branching_points(pieces);
  return Fans(pieces).pinched();
}

}  // namespace tegl::detail
