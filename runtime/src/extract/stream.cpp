// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed extraction: the contour is passed to a sink in parts; see stream.hpp.
#include "kernel/stream.hpp"

#include "kernel/tableless.hpp"

namespace tegl {

namespace detail {

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

}  // namespace detail

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_streamed(LayerReader<T, N>& layers, double isovalue,
                                                                  ContourSink<N, Real>& sink,
                                                                  const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  detail::LayerRing<T, N> ring(layers);
  detail::LayerSource<T, N> source(ring, isovalue, options.epsilon);
  detail::StreamOutput<N, Real> output(sink, options.normals != Normals::none);
  const ExtractStats stats = detail::extract_to<N, Real>(source, layers.grid(), detail::generated_tables<N>(options),
                                                         options, detail::streaming_plan(layers.grid()), output);
  return {output.size(), stats};
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                               \
  template ExtractedSize extract_streamed<Real, T, N>(LayerReader<T, N>&, double, ContourSink<N, Real>&, \
                                                      const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
