// SPDX-License-Identifier: BSD-3-Clause
//
// Adjacency by hashing, and the greedy search for shellings.
#include "shelling.hpp"

#include <algorithm>
#include <bit>
#include <random>

namespace tegl::tile {

void SimplexMap::clear(std::size_t entries) {
  if (const std::size_t needed = std::bit_ceil(2 * entries + 16); needed > slots_.size() || epoch_ + 1 == 0) {
    slots_.assign(std::max(needed, slots_.size()), Slot{0, 0, kNone});
    epoch_ = 0;
  }
  // The mask limits probing to the current size: a small complex after a large one does not scatter over the large
  // table.
  mask_ = std::bit_ceil(2 * entries + 16) - 1;
  ++epoch_;
}

bool Adjacency::build(std::span<const Simplex> simplices) {
  width_ = simplices.empty() ? 0 : static_cast<std::size_t>(size(simplices.front()));
  neighbours_.assign(simplices.size() * width_, kNone);
  open_.clear(simplices.size() * width_);
  const auto face = [&](std::size_t of) { return without(simplices[of / width_], static_cast<int>(of % width_)); };
  for (std::size_t j = 0; j < simplices.size(); ++j) {
    const std::uint64_t whole = vertex_hash(simplices[j]);
    for (std::size_t i = 0; i < width_; ++i) {
      const std::size_t here = j * width_ + i;
      const Simplex own = face(here);
      SimplexMap::Slot& slot =
          open_.at(whole - vertex_hash(simplices[j][i]), [&](std::uint32_t there) { return face(there) == own; });
      if (slot.value == kNone) {
        slot.value = static_cast<std::uint32_t>(here);
        continue;
      }
      if (neighbours_[slot.value] != kNone) return false;
      neighbours_[slot.value] = static_cast<std::uint32_t>(j);
      neighbours_[here] = static_cast<std::uint32_t>(slot.value / width_);
    }
  }
  return true;
}

Shape Shelling::shape(std::span<const Simplex> simplices, const Adjacency& adjacency,
                      std::span<const std::uint32_t> members, VertexId apex) {
  if (members.empty()) return Shape::other;
  simplices_ = simplices, adjacency_ = &adjacency, apex_ = apex;
  const std::size_t own = adjacency.vertices_per_simplex() - (apex == kNoVertex ? 0 : 1);
  if (own == 1) return members.size() == 1 ? Shape::ball : members.size() == 2 ? Shape::sphere : Shape::other;
  state_.resize(std::max(state_.size(), simplices.size()), State::outside);
  for (const std::uint32_t m : members) state_[m] = State::waiting;
  bool closed = true;
  for (const std::uint32_t m : members)
    for (std::size_t i = 0; i < adjacency.vertices_per_simplex(); ++i)
      if (simplices[m][i] != apex) closed &= other_side(m, i) != Adjacency::kNone;
  // In dimensions 1 and 2 the first try is conclusive.
  const unsigned tries = own <= 3 ? 1 : 6;
  bool shelled = false;
  for (unsigned seed = 0; seed < tries && !shelled; ++seed) shelled = one_try(members, seed, closed);
  for (const std::uint32_t m : members) state_[m] = State::outside;
  return !shelled ? Shape::other : closed ? Shape::sphere : Shape::ball;
}

/// Returns kNone if the neighbour is not a member.
std::uint32_t Shelling::other_side(std::uint32_t simplex, std::size_t vertex) const {
  const std::uint32_t n = adjacency_->neighbour(simplex, vertex);
  return n != Adjacency::kNone && state_[n] != State::outside ? n : Adjacency::kNone;
}

bool Shelling::one_try(std::span<const std::uint32_t> members, unsigned seed, bool closed) {
  const std::size_t width = adjacency_->vertices_per_simplex();
  for (const std::uint32_t m : members) state_[m] = State::waiting;
  if (++try_ == 0) used_vertex_.assign(used_vertex_.size(), 0), try_ = 1;
  used_.clear(members.size() << width);
  queue_.assign(1, members[0]);
  std::minstd_rand random(seed);
  if (seed != 0) queue_[0] = members[random() % members.size()];
  std::size_t taken = 0;
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    if (seed != 0) std::swap(queue_[head], queue_[head + random() % (queue_.size() - head)]);
    const std::uint32_t m = queue_[head];
    if (state_[m] == State::done) continue;
    // shared faces with taken simplices, and neighbours still waiting
    unsigned shared = 0;
    std::uint32_t waiting[kMaxVertices];
    std::size_t waiting_count = 0;
    for (std::size_t i = 0; i < width; ++i) {
      if (simplices_[m][i] == apex_) continue;
      const std::uint32_t n = other_side(m, i);
      if (n == Adjacency::kNone) continue;
      if (state_[n] == State::done)
        shared |= 1u << i;
      else
        waiting[waiting_count++] = n;
    }
    if (taken != 0 && !fits(m, shared, closed && taken + 1 == members.size())) continue;
    take(m), ++taken;
    // A simplex that does not fit is queued again whenever a further neighbour is taken.
    queue_.insert(queue_.end(), waiting, waiting + waiting_count);
  }
  return taken == members.size();
}

/// The simplex meets the taken ones exactly in the faces opposite to the vertices `shared` if and only if the face
/// spanned by these vertices is not in a taken simplex.
bool Shelling::fits(std::uint32_t simplex, unsigned shared, bool last) const {
  const std::size_t width = adjacency_->vertices_per_simplex();
  const std::size_t own = width - (apex_ == kNoVertex ? 0 : 1);
  std::uint64_t hash = 0;
  std::size_t count = 0;
  VertexId vertex = 0;
  for (std::size_t i = 0; i < width; ++i)
    if (((shared >> i) & 1u) != 0) vertex = simplices_[simplex][i], hash += vertex_hash(vertex), ++count;
  if (count == own) return last;
  if (count == own - 1) return true;  // that face is of codimension one, and not shared
  if (count == 1) return vertex >= used_vertex_.size() || used_vertex_[vertex] != try_;
  return used_.find(hash, [](std::uint32_t) { return true; }) == SimplexMap::kNone;
}

void Shelling::take(std::uint32_t simplex) {
  state_[simplex] = State::done;
  const std::size_t width = adjacency_->vertices_per_simplex();
  const std::size_t largest = simplices_[simplex][width - 1];  // vertices ascend
  if (largest >= used_vertex_.size()) used_vertex_.resize(largest + 1, 0);
  for (std::size_t i = 0; i < width; ++i) used_vertex_[simplices_[simplex][i]] = try_;
  if (width - (apex_ == kNoVertex ? 0 : 1) >= 4) take_large_faces(simplex);
}

void Shelling::take_large_faces(std::uint32_t simplex) {
  std::uint64_t hashes[kMaxVertices];
  int own = 0;
  for (std::size_t i = 0; i < adjacency_->vertices_per_simplex(); ++i)
    if (simplices_[simplex][i] != apex_) hashes[own++] = vertex_hash(simplices_[simplex][i]);
  for (unsigned face = 1; face < 1u << own; ++face) {
    int count = 0;
    std::uint64_t hash = 0;
    for (int i = 0; i < own; ++i)
      if (((face >> i) & 1u) != 0) hash += hashes[i], ++count;
    // `fits` needs no other sizes.
    if (count >= 2 && count <= own - 2) used_.at(hash, [](std::uint32_t) { return true; }).value = 0;
  }
}

}  // namespace tegl::tile
