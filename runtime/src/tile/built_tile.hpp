// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles built at run time, kept in the form that an extraction goes through: which vertices the contour of a tile has
// in each face, how their places follow from each other, and its simplices.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "tegl/error.hpp"
#include "tegl/facets/facets.hpp"
#include "tile/cube_symmetries.hpp"

namespace tegl::detail {

/// The faces of an n-cube as the extraction names them.
class CubeFaces {
 public:
  struct Cell {
    std::uint8_t base;  ///< its least corner
    std::uint8_t axes;  ///< bit a: whether it spans axis a
    std::uint8_t dim;
  };
  explicit CubeFaces(int n);

  [[nodiscard]] const facets::FaceLattice& lattice() const noexcept { return lattice_; }
  [[nodiscard]] int dim() const noexcept { return lattice_.dim(); }
  /// By number in the lattice.
  [[nodiscard]] const std::vector<Cell>& cells() const noexcept { return cells_; }
  /// The number of the face with this base and axes.
  [[nodiscard]] std::uint16_t number(unsigned base, unsigned axes) const noexcept {
    return numbers_[base << lattice_.dim() | axes];
  }
  [[nodiscard]] std::size_t tile() const noexcept { return cells_.size() - 1; }
  /// The number of the first face of two dimensions: it and those after it are what there are choices for.
  [[nodiscard]] std::size_t first_choice() const noexcept { return first_choice_; }

 private:
  facets::FaceLattice lattice_;
  std::vector<Cell> cells_;
  std::vector<std::uint16_t> numbers_;
  std::size_t first_choice_ = 0;
};

/// What `build` returns; where it throws std::length_error, as builders do for tiles of too many vertices, throws
/// Error{TooLarge}.
template <class Build>
decltype(auto) too_large_as_error(const Build& build) {
  try {
    return build();
  } catch (const std::length_error& error) {
    throw Error(ErrorCode::TooLarge, error.what());
  }
}

/// The contour of a tile, every vertex by its number in here. The contour's own vertices come first, face by face and
/// within a face by the number that all tiles around it know; then those that places depend on.
struct BuiltTile {
  struct Vertex {
    facets::VertexKind kind;
    std::uint16_t face;                          ///< number in the lattice
    std::uint16_t copied;                        ///< side: the vertex that it is a copy of
    std::uint32_t first, end;                    ///< barycentre, centre: its part of `of`
    std::uint32_t first_edge = 0, end_edge = 0;  ///< barycentre beside others in its face: its part of `edges`
  };
  /// A face with vertices [first, first + count) of the contour.
  struct FaceVertices {
    std::uint16_t face, first, count;
    bool by_edges;  ///< several barycentres and nothing else: numbered by the least edge that each is connected with
  };
  /// Set in the first vertex of a simplex below a barycentre: that vertex is the middle of the facet that the simplex
  /// belongs to.
  static constexpr std::uint16_t kIsMiddle = 0x8000;

  std::vector<FaceVertices> faces;  ///< in the lattice's order
  std::vector<Vertex> vertices;
  std::vector<std::uint16_t> of;         ///< barycentre: simplices of dim - 1 vertices; centre: vertices
  std::vector<std::uint16_t> edges;      ///< points on edges below a barycentre
  std::vector<std::uint16_t> simplices;  ///< of n vertices each; positive side towards high
  bool has_sides = false;                ///< whether it depends on the order of the axes
  bool is_settled = true;                ///< what it has on its boundary is one sphere: its own choice does not matter

  /// Throws Error{TooLarge} for a tile of 32768 vertices or more.
  BuiltTile(const CubeFaces& cube, const facets::TileFacets& tile);
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void list_edges(std::size_t barycentre);
};

/// What fixes the contour in a tile: which corners are high, and what is chosen for its faces.
struct TileKey {
  std::uint64_t signature = 0;
  /// Two bits (facets::Choice) for each face of two or more dimensions, in the lattice's order.
  std::array<std::uint64_t, 5> choices{};

  friend bool operator==(const TileKey&, const TileKey&) = default;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
  [[nodiscard]] bool has_choices() const noexcept { return choices != decltype(choices){}; }
  [[nodiscard]] facets::Choice choice(std::size_t number) const noexcept {
    return static_cast<facets::Choice>(choices[number / 32] >> (2 * (number % 32)) & 3u);
  }
  void choose(std::size_t number, facets::Choice choice) noexcept {
    choices[number / 32] |= static_cast<std::uint64_t>(choice) << (2 * (number % 32));
  }
};

struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const noexcept {
    std::uint64_t hash = key.signature;
    for (const std::uint64_t word : key.choices) hash = (hash ^ hash >> 29 ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
  }
};

/// A tile as it is found: a built one, seen from another side.
struct SeenTile {
  std::shared_ptr<const BuiltTile> tile;
  CubeSymmetry symmetry;  ///< from the built tile's frame
};

/// Built tiles by key; without choices, up to symmetry where symmetries leave a tile's contour as it is: where all of
/// it is coned (side fillings depend on the order of the axes). What is asked for stays alive as long as someone holds
/// it; beside that, at most `max_bytes` are kept: half of it for tiles, the other half, in equal shares, for what each
/// of `builders` builders keeps of tiles' faces.
class BuiltTiles {
 public:
  using Pointer = std::shared_ptr<const BuiltTile>;
  BuiltTiles(const CubeFaces& cube, facets::Alternative alternative, std::size_t max_bytes, std::size_t builders)
      : cube_(cube),
        symmetries_(cube.dim()),
        alternative_(alternative),
        max_bytes_(max_bytes / 2),
        max_builder_bytes_(max_bytes / 2 / builders) {}

  [[nodiscard]] const CubeSymmetries& symmetries() const noexcept { return symmetries_; }
  /// What is kept at the moment, in tiles and by builders that are not at work.
  [[nodiscard]] std::size_t kept_bytes();

  /// The tiles of these keys. `for_range(count, work)` calls work(from, to) for parts of 0 ... count - 1, up to
  /// `builders` of them side by side; if it leaves any out, it throws. Throws Error{TooLarge} for a tile of too many
  /// vertices.
  template <class ForRange>
  std::vector<SeenTile> get(std::span<const TileKey> keys, const ForRange& for_range) {
    std::vector<SeenTile> result(keys.size());
    std::vector<TileKey> wanted(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i].has_choices()) continue;
      result[i].symmetry = symmetries_.to_frame_of(keys[i].signature);
      wanted[i].signature = symmetries_.before(result[i].symmetry, keys[i].signature);
    }
    assign(result, wanted, for_range);
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
  /// Finds the tiles or builds them, each once.
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

  /// A builder that no one else has meanwhile. What builders keep makes them fast, so there are no more of them than
  /// threads.
  class BuilderLoan {
   public:
    explicit BuilderLoan(BuiltTiles& from);
    ~BuilderLoan();
    BuilderLoan(const BuilderLoan&) = delete;
    BuilderLoan& operator=(const BuilderLoan&) = delete;
    [[nodiscard]] Pointer build(const TileKey& key) const;

   private:
    BuiltTiles& from_;
    std::unique_ptr<facets::FacetBuilder> builder_;
  };
  void keep(const TileKey& key, const Pointer& tile);

  const CubeFaces& cube_;
  CubeSymmetries symmetries_;
  facets::Alternative alternative_;
  std::size_t max_bytes_;          ///< of tiles
  std::size_t max_builder_bytes_;  ///< of each builder
  std::size_t bytes_ = 0;
  std::unordered_map<TileKey, Pointer, TileKeyHash> known_;
  std::mutex mutex_;      ///< of what follows
  std::size_t made_ = 0;  ///< builders, lent ones included
  std::vector<std::unique_ptr<facets::FacetBuilder>> builders_;
};

}  // namespace tegl::detail
