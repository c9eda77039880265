// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the vertices of streamed wrapped contours (see wrapped_stream.hpp).
#include "periodic/wrapped_stream.hpp"

namespace tegl::detail {

template <int N, class Real>
WrappedStream<N, Real>::WrappedStream(ContourSink<N, Real>& sink, const RowShape<N>& shape, unsigned axes,
                                      std::vector<Period<N>> periods, const Options& options)
    : Base(sink, options.normals),
      shape_(shape),
      axes_(axes),
      options_(options),
      repeats_layer_0_((axes >> (N - 1) & 1u) != 0),
      cells_(axes) {
  this->periods_ = std::move(periods);
}

template <int N, class Real>
std::vector<Index> WrappedStream<N, Real>::join_seam(const ContourPart& part, BasicDisjointSets<Index>& sets) {
  auto& pairs = cells_.pairs();
  const std::size_t within = pairs.size() - cells_.pairs_with_layer_0();
  const auto in_part = [&](Index v) { return static_cast<Index>(v - static_cast<Index>(part.first_vertex)); };
  sets.reset(this->vertices_.size());
  for (std::size_t i = 0; i < within; ++i) sets.join(in_part(pairs[i].first), in_part(pairs[i].second));
  std::vector<Index> in_layer_0;
  if (within != pairs.size()) in_layer_0.resize(this->vertices_.size(), kNone);
  for (std::size_t i = within; i < pairs.size(); ++i) in_layer_0[sets.find(in_part(pairs[i].first))] = pairs[i].second;
  pairs.clear();
  return in_layer_0;
}

template <int N, class Real>
void WrappedStream<N, Real>::number_vertices(const ContourPart& part) {
  BasicDisjointSets<Index> sets;
  const std::vector<Index> in_layer_0 = join_seam(part, sets);
  Buffer<Vertex>& vertices = this->vertices_;
  const std::size_t count = vertices.size();
  std::size_t passed = 0;
  before_numbers_.swap(numbers_);
  numbers_.resize(count);
  on_seam_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const Index set = sets.find(static_cast<Index>(i));
    if (!in_layer_0.empty() && in_layer_0[set] != kNone) {
      numbers_[i] = numbers_of_layer_0_[in_layer_0[set]];
    } else if (set == i) {
      numbers_[i] = this->first_ + passed;
      vertices[passed] = vertices[i];
      if (options_.normals) this->normals_[passed] = this->normals_[i];
      ++passed;
      if (part.first_vertex + i < numbers_of_layer_0_.size()) numbers_of_layer_0_[part.first_vertex + i] = numbers_[i];
      continue;
    } else {
      numbers_[i] = numbers_[set];
      if (part.first_vertex + i < numbers_of_layer_0_.size()) numbers_of_layer_0_[part.first_vertex + i] = numbers_[i];
    }
    if (options_.may_miss_samples) on_seam_.push_back(numbers_[i]);
    if (options_.close) merged_.emplace_back(part.first_vertex + i, numbers_[i]);
  }
  vertices.resize(passed);
  if (options_.normals) this->normals_.resize(passed);
}

template <int N, class Real>
void WrappedStream<N, Real>::renumber(const ContourPart& part) {
  this->first_ = this->size().vertices;
  number_vertices(part);
  for (WideSimplex& simplex : this->wide_)
    for (std::uint64_t& v : simplex)
      v = v >= part.first_vertex ? numbers_[v - part.first_vertex] : before_numbers_[v - this->kernel_before_];
}

template <int N, class Real>
void WrappedStream<N, Real>::keep_simplices(const ContourPart& part, const NonmanifoldCandidates& nonmanifold) {
  if (!options_.may_miss_samples) return;
  const std::vector<std::uint64_t>& all = nonmanifold.vertices();
  for (; candidates_taken_ < all.size(); ++candidates_taken_)
    candidates_.push_back(numbers_[all[candidates_taken_] - part.first_vertex]);
  // Copies have only some of a vertex's tiles each, so that none of them may be a candidate by itself.
  if (nonmanifold.any_missing()) candidates_.insert(candidates_.end(), on_seam_.begin(), on_seam_.end());
  std::sort(candidates_.begin(), candidates_.end());
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
  this->remember_around(part, candidates_);
  // Simplices at layer 0, around vertices that may be candidates in the last layer.
  if (part.first_simplex != 0 || numbers_of_layer_0_.empty()) return;
  const std::uint64_t end = *std::max_element(numbers_of_layer_0_.begin(), numbers_of_layer_0_.end()) + 1;
  const auto is_candidate = [&](std::uint64_t v) {
    return std::binary_search(candidates_.begin(), candidates_.end(), v);
  };
  for (std::size_t s = 0; s < this->wide_.size(); ++s) {
    const WideSimplex& simplex = this->wide_[s];
    if (std::none_of(simplex.begin(), simplex.end(), [&](std::uint64_t v) { return v < end; })) continue;
    this->remember_places(simplex);
    if (std::none_of(simplex.begin(), simplex.end(), is_candidate)) around_layer_0_.emplace_back(s, simplex);
  }
}

template <int N, class Real>
std::uint64_t WrappedStream<N, Real>::final_number(std::uint64_t v) const noexcept {
  const auto at = std::lower_bound(merged_.begin(), merged_.end(), v,
                                   [](const auto& merged, std::uint64_t number) { return merged.first < number; });
  if (at != merged_.end() && at->first == v) return at->second;
  return v - static_cast<std::uint64_t>(at - merged_.begin());
}

template <int N, class Real>
void WrappedStream<N, Real>::take_caps(const Caps<N, Real>& caps, const ContourPart& all) {
  std::vector<std::pair<Index, Index>> pairs;
  pair_cap_corners(caps, shape_, axes_, 0, pairs);
  BasicDisjointSets<Index> sets(caps.vertices().size());
  for (const auto& [a, b] : pairs) sets.join(a, b);
  numbers_.resize(caps.vertices().size());
  this->vertices_.clear();
  this->normals_.clear();
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const Index set = sets.find(static_cast<Index>(i));
    numbers_[i] = set == i ? this->size().vertices + this->vertices_.size() : numbers_[set];
    if (set != i) continue;
    this->vertices_.push_back(caps.vertices()[i]);
    if (options_.normals) this->normals_.push_back(caps.normals()[i]);
  }
  this->wide_.assign(caps.simplices().begin(), caps.simplices().end());
  for (WideSimplex& simplex : this->wide_)
    for (std::uint64_t& stored : simplex) {
      const std::uint64_t v = caps.number(stored, all.end_vertex);
      stored = v < all.end_vertex ? final_number(v) : numbers_[v - all.end_vertex];
    }
}

template <int N, class Real>
void WrappedStream<N, Real>::finish(const ContourPart& all, const Caps<N, Real>* caps,
                                    const NonmanifoldCandidates& nonmanifold) {
  const bool any_missing = nonmanifold.any_missing();
  const auto is_candidate = [&](std::uint64_t v) {
    return std::binary_search(candidates_.begin(), candidates_.end(), v);
  };
  for (const auto& [number, simplex] : around_layer_0_)
    if (std::any_of(simplex.begin(), simplex.end(), is_candidate)) this->remember(number, simplex);
  if (caps != nullptr) {
    take_caps(*caps, all);
    this->add_caps(this->vertices_, this->normals_, any_missing, candidates_);
  }
  if (any_missing) this->separate(candidates_);
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) template class WrappedStream<N, Real>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
