// SPDX-License-Identifier: BSD-3-Clause
//
// Backtracking search: assigns corners one by one to images with matching edges to the earlier corners, and keeps a
// complete assignment if it maps every face to a face.
#include "symmetry/tile_symmetry.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/determinant.hpp"
#include "base/error.hpp"
#include "symmetry/orbits.hpp"

namespace tegl::gen {

namespace {

class Search {
 public:
  explicit Search(const Tile& tile) : tile_(tile), neighbours_(tile.corner_count(), 0) {
    for (const auto& [a, b] : tile.edges) {
      neighbours_[a] |= Signature{1} << b;
      neighbours_[b] |= Signature{1} << a;
    }
    for (const SubTile& face : tile.faces) faces_.insert(image_of(face.corner, nullptr));
  }

  std::vector<std::vector<std::uint32_t>> all() {
    extend(0);
    return std::move(found_);
  }

 private:
  static Signature image_of(const std::vector<std::uint8_t>& corners, const std::vector<std::uint32_t>* images) {
    Signature set = 0;
    for (const std::uint8_t v : corners) set |= Signature{1} << (images == nullptr ? v : (*images)[v]);
    return set;
  }

  void extend(Signature used) {
    const std::size_t next = images_.size();
    if (next == tile_.corner_count()) {
      const bool carries_faces = std::all_of(tile_.faces.begin(), tile_.faces.end(), [this](const SubTile& face) {
        return faces_.contains(image_of(face.corner, &images_));
      });
      if (carries_faces) found_.push_back(images_);
      return;
    }
    for (std::uint32_t v = 0; v < tile_.corner_count(); ++v) {
      if (((used >> v) & 1u) != 0) continue;
      bool fits = true;
      for (std::size_t earlier = 0; fits && earlier < next; ++earlier)
        fits = ((neighbours_[next] >> earlier) & 1u) == ((neighbours_[v] >> images_[earlier]) & 1u);
      if (!fits) continue;
      images_.push_back(v);
      extend(used | Signature{1} << v);
      images_.pop_back();
    }
  }

  const Tile& tile_;
  std::vector<Signature> neighbours_;
  std::set<Signature> faces_;
  std::vector<std::uint32_t> images_;
  std::vector<std::vector<std::uint32_t>> found_;
};

/// The determinant of the vectors from the first of n + 1 corners to the others.
double volume(const Tile& tile, const std::vector<std::uint32_t>& corners) {
  std::array<std::array<double, 4>, 4> rows{};
  for (std::size_t i = 1; i < corners.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) rows[i - 1][k] = tile.corners[corners[i]][k] - tile.corners[corners[0]][k];
  return determinant(rows, tile.dim);
}

/// The lexicographically first n + 1 corners in general position.
std::vector<std::uint32_t> frame_of(const Tile& tile) {
  const auto size = static_cast<std::size_t>(tile.dim) + 1;
  std::vector<bool> chosen(tile.corner_count(), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(size), true);
  do {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t v = 0; v < chosen.size(); ++v)
      if (chosen[v]) corners.push_back(v);
    if (volume(tile, corners) != 0) return corners;
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  throw Error(ErrorCode::Internal, fmt::format("a {}-tile whose corners lie in a hyperplane", tile.dim));
}

}  // namespace

std::vector<TileSymmetry> symmetries(const Tile& tile, GroupKind kind, bool inversion) {
  const std::vector<std::uint32_t> frame = frame_of(tile);
  std::vector<TileSymmetry> result;
  for (auto& images : Search(tile).all()) {
    std::vector<std::uint32_t> moved;
    for (const std::uint32_t v : frame) moved.push_back(images[v]);
    const int det = volume(tile, moved) * volume(tile, frame) > 0 ? 1 : -1;
    if (kind == GroupKind::Full || det > 0) result.push_back({std::move(images), det, false});
  }
  const std::size_t plain = result.size();
  for (std::size_t i = 0; inversion && i < plain; ++i) {
    result.push_back(result[i]);
    result.back().inverts = true;
  }
  return result;
}

WideUint burnside_orbits(std::span<const TileSymmetry> group) {
  WideUint sum;
  for (const TileSymmetry& g : group) {
    std::vector<bool> seen(g.corner.size(), false);
    int cycles = 0;
    bool odd = false;
    for (std::uint32_t v = 0; v < g.corner.size(); ++v) {
      std::size_t length = 0;
      for (std::uint32_t w = v; !seen[w]; w = g.corner[w], ++length) seen[w] = true;
      cycles += length > 0 ? 1 : 0;
      odd |= length % 2 != 0;
    }
    if (!g.inverts || !odd) sum += WideUint::power_of_two(cycles);
  }
  return sum.exactly_divided_by(group.size());
}

Transversal transversal(const Tile& tile, std::span<const TileSymmetry> group) {
  if (tile.corner_count() > 16)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("enumerating the signatures of {} corners: expected at most 16", tile.corner_count()));
  std::vector<CornerMap> maps;
  for (const TileSymmetry& g : group) maps.push_back({g.corner, g.inverts});
  return orbits(tile.corner_count(), maps);
}

void require_burnside_count(const Transversal& classes, std::span<const TileSymmetry> group) {
  const WideUint expected = burnside_orbits(group);
  if (!(WideUint{classes.representatives.size()} == expected))
    throw Error(ErrorCode::CountMismatch,
                fmt::format("{} classes by enumeration, {} by Burnside's lemma: expected the same",
                            classes.representatives.size(), expected.to_decimal()));
}

TileClasses tile_classes(const Tile& tile, GroupKind kind) {
  TileClasses result;
  if (tile.kind == TileKind::cube)
    for (const Element& g : group(tile.dim, kind, false))
      result.symmetries.push_back({corner_permutation(g, tile.dim), g.det, g.inverts});
  else
    result.symmetries = symmetries(tile, kind, false);
  result.classes = transversal(tile, result.symmetries);
  require_burnside_count(result.classes, result.symmetries);
  return result;
}

TileClasses single_signatures(const Tile& tile) {
  TileClasses result;
  result.symmetries.emplace_back().corner.resize(tile.corner_count());
  std::iota(result.symmetries[0].corner.begin(), result.symmetries[0].corner.end(), 0u);
  result.classes = transversal(tile, result.symmetries);
  return result;
}

}  // namespace tegl::gen
