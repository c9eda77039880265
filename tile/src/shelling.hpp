// SPDX-License-Identifier: BSD-3-Clause
//
// Adjacency of simplices through their faces of codimension one, and shellings: orders of the simplices in which each
// one meets the union of its predecessors in a ball. A shellable complex without branching is a PL ball or sphere (G.
// Danaraj and V. Klee, Shellings of spheres and polytopes, 1974). On balls and spheres of dimension 2 every partial
// shelling can be completed (Danaraj and Klee, Which spheres are shellable?, 1978).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tegl/tile/complex.hpp"

namespace tegl::tile {

/// Hash of a set of vertices: the sum of one number per vertex, so that adding or removing a vertex is one addition.
inline std::uint64_t vertex_hash(VertexId vertex) noexcept {
  // The finaliser of splitmix64; sums of its values behave like random numbers.
  std::uint64_t x = (vertex + std::uint64_t{1}) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline std::uint64_t vertex_hash(const Simplex& simplex) noexcept {
  std::uint64_t sum = 0;
  for (int i = 0; i < kMaxVertices && simplex[i] != kNoVertex; ++i) sum += vertex_hash(simplex[i]);
  return sum;
}

/// Hash map from simplices to numbers. Open addressing; reuses its memory.
class SimplexMap {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// Removes all entries and reserves room for `entries`.
  void clear(std::size_t entries);
  struct Slot {
    std::uint64_t hash;
    std::uint32_t epoch;
    std::uint32_t value;
  };
  /// Returns the slot with this hash for which `equal(value)` holds, or a new slot with the value kNone.
  template <class Equal>
  Slot& at(std::uint64_t hash, const Equal& equal) {
    for (std::size_t i = (hash >> 20) & mask_;; i = (i + 1) & mask_) {
      Slot& slot = slots_[i];
      if (slot.epoch != epoch_) return slot = {hash, epoch_, kNone};
      if (slot.hash == hash && slot.value != kNone && equal(slot.value)) return slot;
    }
  }
  template <class Equal>
  [[nodiscard]] std::uint32_t find(std::uint64_t hash, const Equal& equal) const {
    for (std::size_t i = (hash >> 20) & mask_;; i = (i + 1) & mask_) {
      const Slot& slot = slots_[i];
      if (slot.epoch != epoch_) return kNone;
      if (slot.hash == hash && equal(slot.value)) return slot.value;
    }
  }

 private:
  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::uint32_t epoch_ = 0;
};

/// For each simplex and vertex: the simplex on the other side of the face opposite to that vertex.
class Adjacency {
 public:
  static constexpr std::uint32_t kNone = SimplexMap::kNone;
  /// Simplices have equal sizes and sorted vertices. Returns false if a face of codimension one lies in more than two.
  bool build(std::span<const Simplex> simplices);
  [[nodiscard]] std::size_t vertices_per_simplex() const { return width_; }
  /// Number of the adjacent simplex, or kNone.
  [[nodiscard]] std::uint32_t neighbour(std::size_t simplex, std::size_t vertex) const {
    return neighbours_[simplex * width_ + vertex];
  }

 private:
  std::size_t width_ = 0;
  std::vector<std::uint32_t> neighbours_;
  SimplexMap open_;
};

/// Searches for shellings. Reuses its memory.
class Shelling {
 public:
  /// The shape of the link of `apex` in a complex without branching; with kNoVertex, the shape of the complex itself.
  /// `members`: the simplices that contain `apex`, or all. `other`: none of a few seeded tries found a shelling.
  Shape shape(std::span<const Simplex> simplices, const Adjacency& adjacency, std::span<const std::uint32_t> members,
              VertexId apex);

 private:
  enum class State : std::uint8_t { outside, waiting, done };
  [[nodiscard]] std::uint32_t other_side(std::uint32_t simplex, std::size_t vertex) const;
  bool one_try(std::span<const std::uint32_t> members, unsigned seed, bool closed);
  [[nodiscard]] bool fits(std::uint32_t simplex, unsigned shared, bool last) const;
  void take(std::uint32_t simplex);
  void take_large_faces(std::uint32_t simplex);

  std::span<const Simplex> simplices_;
  const Adjacency* adjacency_ = nullptr;
  VertexId apex_ = kNoVertex;
  std::vector<State> state_;
  std::vector<std::uint32_t> queue_;
  // Faces of the simplices taken. Larger faces are stored by hash only: a collision can make a try fail, but never
  // succeed wrongly.
  std::vector<std::uint32_t> used_vertex_;  ///< by vertex: the last try that took it
  std::uint32_t try_ = 0;
  SimplexMap used_;
};

}  // namespace tegl::tile
