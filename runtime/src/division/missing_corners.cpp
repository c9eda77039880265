// SPDX-License-Identifier: BSD-3-Clause
#include "division/missing_corners.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/workers.hpp"
#include "complex/image_points.hpp"

namespace tegl::detail {
namespace {

// kinds of samples: missing, minus infinity, plus infinity; others are 0
constexpr std::uint8_t kMissing = 1, kBelowAll = 2, kAboveAll = 4;

std::uint8_t kind_of(double value) noexcept {
  if (std::isnan(value)) return kMissing;
  if (!std::isinf(value)) return 0;
  return value < 0 ? kBelowAll : kAboveAll;
}

}  // namespace

template <int N>
MissingCorners<N>::MissingCorners(const Index& cells, unsigned periodic, bool wholly, ReadSamples<N> read,
                                  const WorkOptions& work)
    : cells_(cells), periodic_(periodic) {
  Index samples;
  std::size_t rows = 1;
  for (int a = 0; a < N; ++a) {
    samples[a] = cells[a] + ((periodic >> a & 1u) != 0 ? 0 : 1);
    if (a > 0) rows *= samples[a];
  }
  // the kinds of the samples
  std::vector<std::uint8_t> kinds(rows * samples[0]);
  std::atomic<unsigned> seen = 0;
  for_each_block(
      rows, 64, work.threads, work.progress, [] { return std::vector<double>(); },
      [&](std::size_t, std::size_t from, std::size_t to, std::vector<double>& values) {
        values.resize(samples[0]);
        for (std::size_t row = from; row < to; ++row) {
          Index at{};
          for (std::size_t a = 1, rest = row; a < N; rest /= samples[a], ++a) at[a] = rest % samples[a];
          read(at, values.size(), values.data());
          unsigned in_row = 0;
          for (std::size_t i = 0; i < values.size(); ++i) in_row |= kinds[row * samples[0] + i] = kind_of(values[i]);
          seen |= in_row;
        }
      });
  constexpr unsigned kInfinite = kBelowAll | kAboveAll;
  if ((seen & kMissing) == 0 && !(wholly && (seen & kInfinite) == kInfinite)) return;
  // the corners of the cells
  std::size_t count = 1;
  for (const std::size_t size : cells) count *= size;
  of_cells_.resize(count);
  for_each_block(count, 4096, work.threads, nullptr, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t c = from; c < to; ++c) {
      const Index cell = index_of<N>(c, cells_);
      unsigned any = 0;
      std::uint32_t missing = 0;
      for (unsigned v = 0; v < 1u << N; ++v) {
        std::size_t sample = 0;
        for (int a = N - 1; a >= 0; --a) sample = sample * samples[a] + (cell[a] + (v >> a & 1u)) % samples[a];
        any |= kinds[sample];
        missing |= std::uint32_t{(kinds[sample] & kMissing) != 0} << v;
      }
      if (wholly && (missing != 0 || (any & kInfinite) == kInfinite)) missing = kAll;
      of_cells_[c] = missing;
    }
  });
  find_near(work);
}

template <int N>
void MissingCorners<N>::find_near(const WorkOptions& work) {
  near_.resize(of_cells_.size());
  for_each_block(near_.size(), 4096, work.threads, nullptr, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t c = from; c < to; ++c) {
      const Index cell = index_of<N>(c, cells_);
      std::array<std::int8_t, N> steps;
      steps.fill(-1);
      for (int a = 0; a < N && near_[c] == 0;) {
        Index other = cell;
        if (move(other, steps) && of_cells_[number_of(other)] != 0) near_[c] = 1;
        for (a = 0; a < N && ++steps[a] > 1; ++a) steps[a] = -1;
      }
    }
  });
}

template class MissingCorners<2>;
template class MissingCorners<3>;
template class MissingCorners<4>;
template class MissingCorners<5>;

}  // namespace tegl::detail
