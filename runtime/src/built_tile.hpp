// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles built at run time, kept in the form that an extraction goes through: which vertices the contour of a tile has
// in each face, how their places follow from each other, and its simplices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "tegl/facets/facets.hpp"

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
  [[nodiscard]] std::size_t tile() const noexcept { return cells_.size() - 1; }

 private:
  facets::FaceLattice lattice_;
  std::vector<Cell> cells_;
};

/// The contour of a tile, every vertex by its number in here. The contour's own vertices come first, face by face and
/// within a face by the number that all tiles around it know; then those that places depend on.
struct BuiltTile {
  struct Vertex {
    facets::VertexKind kind;
    std::uint16_t face;        ///< number in the lattice
    std::uint16_t copied;      ///< side: the vertex that it is a copy of
    std::uint32_t first, end;  ///< barycentre, centre: its part of `of`
  };
  /// A face with vertices [first, first + count) of the contour.
  struct FaceVertices {
    std::uint16_t face, first, count;
  };
  /// Set in the first vertex of a simplex below a barycentre: that vertex is the middle of the facet that the simplex
  /// belongs to.
  static constexpr std::uint16_t kIsMiddle = 0x8000;

  std::vector<FaceVertices> faces;  ///< in the lattice's order
  std::vector<Vertex> vertices;
  std::vector<std::uint16_t> of;         ///< barycentre: simplices of dim - 1 vertices; centre: vertices
  std::vector<std::uint16_t> simplices;  ///< of n vertices each; positive side towards high

  /// Throws Error{TooLarge} for a tile of 32768 vertices or more.
  BuiltTile(const CubeFaces& cube, const facets::TileFacets& tile);
  [[nodiscard]] std::size_t bytes() const noexcept;
};

/// Built tiles by signature. What is asked for stays alive as long as someone holds it; beside that, at most
/// `max_bytes` are kept.
class BuiltTiles {
 public:
  using Pointer = std::shared_ptr<const BuiltTile>;
  BuiltTiles(const CubeFaces& cube, facets::Alternative alternative, std::size_t max_bytes)
      : cube_(cube), alternative_(alternative), max_bytes_(max_bytes) {}

  /// The tiles of these signatures, each once. `for_range(count, work)` calls work(from, to) for parts of
  /// 0 ... count - 1, maybe side by side.
  template <class ForRange>
  std::vector<Pointer> get(std::span<const std::uint64_t> signatures, const ForRange& for_range) {
    std::vector<Pointer> result(signatures.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < signatures.size(); ++i) {
      if (const auto at = known_.find(signatures[i]); at != known_.end())
        result[i] = at->second;
      else
        missing.push_back(i);
    }
    for_range(missing.size(), [&](std::size_t from, std::size_t to) {
      const BuilderLoan builder(*this);
      for (std::size_t j = from; j < to; ++j) result[missing[j]] = builder.build(signatures[missing[j]]);
    });
    for (const std::size_t i : missing) keep(signatures[i], result[i]);
    return result;
  }

 private:
  /// A builder that no one else has meanwhile. What builders keep makes them fast, so there are no more of them than
  /// threads.
  class BuilderLoan {
   public:
    explicit BuilderLoan(BuiltTiles& from);
    ~BuilderLoan();
    BuilderLoan(const BuilderLoan&) = delete;
    BuilderLoan& operator=(const BuilderLoan&) = delete;
    [[nodiscard]] Pointer build(std::uint64_t signature) const;

   private:
    BuiltTiles& from_;
    std::unique_ptr<facets::FacetBuilder> builder_;
  };
  void keep(std::uint64_t signature, const Pointer& tile);

  const CubeFaces& cube_;
  facets::Alternative alternative_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::unordered_map<std::uint64_t, Pointer> known_;
  std::mutex mutex_;  ///< of builders_
  std::vector<std::unique_ptr<facets::FacetBuilder>> builders_;
};

}  // namespace tegl::detail
