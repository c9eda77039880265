// SPDX-License-Identifier: BSD-3-Clause
//
// Random integer fields for the oracle (multilinear.hpp), and their images.
#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "fields.hpp"
#include "multilinear.hpp"
#include "share.hpp"
#include "tegl/image.hpp"
#include "view_of.hpp"

namespace tegl::test {

/// Integers from -bound to bound; if `padded`, surrounded by one layer lower than all.
template <int N>
SampledField<N> random_field(std::mt19937_64& bits, std::size_t samples, std::int64_t bound, bool padded = false) {
  SampledField<N> field;
  const std::size_t size = samples + (padded ? 2 : 0);
  field.sizes.fill(size);
  std::array<std::size_t, N> sizes = field.sizes;
  for_each_sample<N>(Grid<N>::unit(sizes), [&](std::size_t, const std::array<std::size_t, N>& index) {
    bool border = false;
    for (const std::size_t i : index) border = border || (padded && (i == 0 || i + 1 == size));
    const auto drawn = border ? 0 : random_below(bits, 2 * static_cast<std::uint64_t>(bound) + 1);
    field.values.push_back(border ? -bound - 1 : static_cast<std::int64_t>(drawn) - bound);
  });
  return field;
}

/// The field as an image on a grid of unit steps.
template <Value T, int N>
OwnedImage<T, N> image_of(const SampledField<N>& field) {
  OwnedImage<T, N> image{Grid<N>::unit(field.sizes), {}};
  for (const std::int64_t value : field.values) image.values.push_back(static_cast<T>(value));
  return image;
}

/// The two samples at the ends of the grid edge whose interior contains the vertex, if any.
template <int N, class Real>
std::optional<std::array<std::size_t, 2>> edge_of(const std::array<Real, N>& vertex,
                                                  const std::array<std::size_t, N>& sizes) {
  std::size_t first = 0, stride = 1, step = 0;
  for (int a = 0; a < N; stride *= sizes[a], ++a) {
    const Real whole = std::floor(vertex[a]);
    first += static_cast<std::size_t>(whole) * stride;
    if (vertex[a] == whole) continue;
    if (step != 0) return std::nullopt;
    step = stride;
  }
  if (step == 0) return std::nullopt;
  return std::array{first, first + step};
}

template <int N>
std::string describe(const SampledField<N>& field) {
  std::ostringstream text;
  text << "samples less isovalue:";
  for (const std::int64_t value : field.values) text << ' ' << value;
  return text.str();
}

/// The field times 2^24 plus 1: its contour at 0 is that of the field just below 0. For values up to 16.
template <int N>
SampledField<N> just_below(SampledField<N> field) {
  for (std::int64_t& value : field.values) value = (value * (1 << 24)) + 1;
  return field;
}

}  // namespace tegl::test
