// SPDX-License-Identifier: BSD-3-Clause
//
// The cache of tiles that an extraction without tables builds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "tile/built_tile.hpp"
#include "tile/cube_symmetries.hpp"

namespace tegl::detail {

/// A tile of an image: a built tile and the symmetry that maps it there.
struct SeenTile {
  std::shared_ptr<const BuiltTile> tile;
  CubeSymmetry symmetry;  ///< maps from the built tile's frame
};

/// Cache of built tiles by key. Keys without choices of barycentric tiles are stored up to symmetry if the contour is
/// invariant, which holds if it is coned (side fillings depend on the order of the axes). Returned tiles live as long
/// as someone holds them. In addition at most `max_bytes` are kept: half for tiles, half in equal shares for the faces
/// that each of `builders` builders keeps.
class BuiltTiles {
 public:
  using Pointer = std::shared_ptr<const BuiltTile>;
  BuiltTiles(const CubeFaces& cube, const TileKind& kind, std::size_t max_bytes, std::size_t builders)
      : cube_(cube),
        symmetries_(cube.dim()),
        kind_(kind),
        max_bytes_(max_bytes / 2),
        max_builder_bytes_(max_bytes / 2 / builders) {
    if (cube.dim() != 5) kind_.triangulation = Triangulation::barycentric;
    if (kind_.triangulation == Triangulation::compact) max_bytes_ = max_bytes;  // its makers keep nothing
  }

  [[nodiscard]] const CubeSymmetries& symmetries() const noexcept { return symmetries_; }
  /// Bytes kept in tiles and in builders that are not in use.
  [[nodiscard]] std::size_t kept_bytes();

  /// Returns the tiles of these keys. `for_range(count, work)` must call work(from, to) for parts of 0 ... count - 1,
  /// at most `builders` of them concurrently, and throw if it omits any. Throws Error{TooLarge} for a tile with too
  /// many vertices.
  template <class ForRange>
  std::vector<SeenTile> get(std::span<const TileKey> keys, const ForRange& for_range) {
    std::vector<SeenTile> result(keys.size());
    // keys without choices: to a common frame
    std::vector<TileKey> wanted(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i].has_choices() || kind_.triangulation == Triangulation::compact) continue;
      result[i].symmetry = symmetries_.to_frame_of(keys[i].signature);
      wanted[i].signature = symmetries_.before(result[i].symmetry, keys[i].signature);
    }
    assign(result, wanted, for_range);
    // tiles with side fillings: again, in their own frame
    std::vector<std::size_t> again;
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (result[i].tile->has_sides && !keys[i].has_choices()) again.push_back(i);
    if (again.empty()) return result;
    std::vector<SeenTile> as_they_are(again.size());
    wanted.clear();
    for (const std::size_t i : again) wanted.push_back(keys[i]);
    assign(as_they_are, wanted, for_range);
    for (std::size_t j = 0; j < again.size(); ++j) result[again[j]] = as_they_are[j];
    return result;
  }

 private:
  /// Finds or builds the tiles, each once.
  template <class ForRange>
  void assign(std::vector<SeenTile>& seen, const std::vector<TileKey>& keys, const ForRange& for_range) {
    std::vector<TileKey> sorted(keys);
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    const std::vector<Pointer> tiles = find(sorted, for_range);
    for (std::size_t i = 0; i < seen.size(); ++i)
      seen[i].tile =
          tiles[static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), keys[i]) - sorted.begin())];
  }

  template <class ForRange>
  std::vector<Pointer> find(std::span<const TileKey> keys, const ForRange& for_range) {
    std::vector<Pointer> result(keys.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (const auto at = known_.find(keys[i]); at != known_.end())
        result[i] = at->second;
      else
        missing.push_back(i);
    }
    for_range(missing.size(), [&](std::size_t from, std::size_t to) {
      const BuilderLoan builder(*this);
      for (std::size_t j = from; j < to; ++j) result[missing[j]] = builder.build(keys[missing[j]]);
    });
    for (const std::size_t i : missing) keep(keys[i], result[i]);
    return result;
  }

  /// A builder for exclusive use. Builders are reused, because the faces that they keep make them fast; there are no
  /// more of them than threads.
  class BuilderLoan {
   public:
    explicit BuilderLoan(BuiltTiles& from);
    ~BuilderLoan();
    BuilderLoan(const BuilderLoan&) = delete;
    BuilderLoan& operator=(const BuilderLoan&) = delete;
    [[nodiscard]] Pointer build(const TileKey& key) const;

   private:
    BuiltTiles& from_;
    std::unique_ptr<TileMaker> builder_;
  };
  void keep(const TileKey& key, const Pointer& tile);

  CubeFaces cube_;
  CubeSymmetries symmetries_;
  TileKind kind_;
  std::size_t max_bytes_;          ///< for tiles
  std::size_t max_builder_bytes_;  ///< for each builder
  std::size_t bytes_ = 0;
  std::unordered_map<TileKey, Pointer, TileKeyHash> known_;
  std::mutex mutex_;      ///< guards the members below
  std::size_t made_ = 0;  ///< builders created, including lent ones
  std::vector<std::unique_ptr<TileMaker>> builders_;
};

}  // namespace tegl::detail
