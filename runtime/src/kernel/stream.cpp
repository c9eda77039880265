// SPDX-License-Identifier: BSD-3-Clause
//
// Splits a streamed contour at non-manifold vertices and edges, after its last part.
#include "kernel/stream.hpp"

namespace tegl::detail {

template <int N, class Real>
void StreamOutput<N, Real>::separate(const std::vector<std::uint64_t>& candidates) {
  // A cap simplex may have corners on the contour that no kept simplex of the contour has. These are no candidates, so
  // their places are irrelevant.
  // a small contour of the kept simplices, with local numbers
  std::vector<std::uint64_t> numbers;
  for (const WideSimplex& simplex : kept_) numbers.insert(numbers.end(), simplex.begin(), simplex.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto local = [&](std::uint64_t v) {
    return static_cast<Index>(std::lower_bound(numbers.begin(), numbers.end(), v) - numbers.begin());
  };
  Contour<N, Real> around;
  around.periods = periods_;
  for (const std::uint64_t v : numbers) {
    const auto found = places_.find(v);
    const Place place = found == places_.end() ? Place{} : found->second;
    around.vertices.push_back(place.vertex);
    if (with_normals_) around.normals.push_back(place.normal);
  }
  for (const WideSimplex& simplex : kept_) {
    Simplex& narrow = around.simplices.emplace_back();
    for (int j = 0; j < N; ++j) narrow[j] = local(simplex[j]);
  }
  // separate it at the candidates
  std::vector<Index> narrow;
  for (const std::uint64_t v : candidates)
    if (std::binary_search(numbers.begin(), numbers.end(), v)) narrow.push_back(local(v));
  split_nonmanifold(around, narrow, kMaxVertices);

  // pass the changes to the sink
  const auto number = [&](Index v) { return v < numbers.size() ? numbers[v] : size_.vertices + (v - numbers.size()); };
  for (std::size_t s = 0; s < kept_.size(); ++s)
    for (int j = 0; j < N; ++j)
      if (const std::uint64_t v = number(around.simplices[s][j]); v != kept_[s][j])
        sink_.replace_corner(kept_numbers_[s], j, v);
  wide_.clear();
  for (std::size_t s = kept_.size(); s < around.simplices.size(); ++s) {
    WideSimplex& simplex = wide_.emplace_back();
    for (int j = 0; j < N; ++j) simplex[j] = number(around.simplices[s][j]);
  }
  add_vertices(std::span(around.vertices).subspan(numbers.size()),
               std::span(around.normals).subspan(with_normals_ ? numbers.size() : 0));
  sink_.add_simplices(wide_);
  size_.vertices += around.vertices.size() - numbers.size();
  size_.simplices += wide_.size();
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) \
  template void StreamOutput<N, Real>::separate(const std::vector<std::uint64_t>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
