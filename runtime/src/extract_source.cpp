// SPDX-License-Identifier: BSD-3-Clause
//
// What the extraction asks of rows of samples; see extract_source.hpp.
#include "extract_source.hpp"

#include <bit>

#include "corners.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

template <Value T, int N>
bool RowSource<T, N>::classify(const Index& start, Word* high, Word* missing) const noexcept {
  return classify_row(row(start), strides_[0], row_size_, threshold_, high, missing);
}

template <Value T, int N>
void RowSource<T, N>::edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept {
  const T* const samples = layer(k);
  const T* const others = axis == N - 1 ? layer(k + 1) : samples + strides_[axis];
  detail::edge_alphas<T>({samples, others, edges.rows, edges.at, edges.count, strides_[0]}, isovalue_, epsilon_, out);
}

template <Value T, int N>
void RowSource<T, N>::cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept {
  static constexpr auto kInOrder = [] {
    std::array<std::uint32_t, N << (N - 1)> result{};
    for (std::uint32_t i = 0; i < result.size(); ++i) result[i] = i;
    return result;
  }();
  static constexpr std::array<std::ptrdiff_t, kInOrder.size()> kOneRow{};
  std::array<T, std::size_t{1} << N> corners;
  std::array<std::ptrdiff_t, std::size_t{1} << N> offsets{};
  const std::ptrdiff_t along = static_cast<std::ptrdiff_t>(base[0]) * strides_[0];
  const T* const samples = row(base) + along;
  // A cell within the last layer has nothing above.
  const T* const above = (axes >> (N - 1) & 1u) != 0 ? next_row(base, N - 1, 1) + along : nullptr;
  const Strides strides = strides_;
  corners[0] = *samples;
  unsigned dim = 0;
  for (unsigned a = 0; a < N; ++a) {
    if ((axes >> a & 1u) == 0) continue;
    const T* const from = a == N - 1 ? above : samples;
    for (std::size_t c = 0, up = std::size_t{1} << dim; c < std::size_t{1} << dim; ++c, ++up) {
      offsets[up] = offsets[c] + (a == N - 1 ? 0 : strides[a]);
      corners[up] = from[offsets[up]];
    }
    ++dim;
  }
  std::array<T, kInOrder.size()> first{};
  std::array<T, kInOrder.size()> second{};
  std::array<double, kInOrder.size()> alphas;
  std::size_t count = 0;
  for (std::uint32_t rest = edges; rest != 0; rest &= rest - 1, ++count) {
    const auto e = static_cast<unsigned>(std::countr_zero(rest));
    const unsigned at = edge_base(dim, e);
    first[count] = corners[at];
    second[count] = corners[at | 1u << (e >> (dim - 1))];
  }
  detail::edge_alphas<T>({first.data(), second.data(), kOneRow.data(), kInOrder.data(), count, 1}, isovalue_, epsilon_,
                         alphas.data());
  const double* next = alphas.data();
  for (; edges != 0; edges &= edges - 1) out[std::countr_zero(edges)] = *next++;
}

template <Value T, int N>
template <class Calc>
void RowSource<T, N>::gather(const EdgeSurroundings<N>& edges, const std::uint32_t* at, std::size_t count,
                             Calc* out) const noexcept {
  const bool along_row = edges.axis == 0;
  const T* const first = row(edges.start);
  Index second_start = edges.start;
  if (!along_row) ++second_start[edges.axis];
  const T* const second = along_row ? first + strides_[0] : row(second_start);
  // By place: the row that the value is in, displaced so that the sample's own number finds it.
  std::array<const T*, kEdgeValues<N>> rows;
  for (int a = 1; a < N; ++a) {
    const std::array<bool, 4>& exists = edges.exists[a];
    rows[4 * a] = exists[0] ? next_row(edges.start, a, ~std::size_t{0}) : first;
    if (a == edges.axis) {
      rows[4 * a + 1] = second;
      rows[4 * a + 2] = first;
    } else {
      const std::ptrdiff_t ahead = along_row ? strides_[0] : 0;
      rows[4 * a + 1] = exists[1] ? next_row(edges.start, a, 1) : first;
      rows[4 * a + 2] = exists[2] ? next_row(second_start, a, ~std::size_t{0}) + ahead : second;
    }
    rows[4 * a + 3] = exists[3] ? next_row(second_start, a, 1) + (along_row ? strides_[0] : 0) : second;
  }
  const std::size_t last = row_size_ - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t here = at[i];
    const auto value = [&](const T* samples, std::size_t k) {
      return static_cast<Calc>(samples[static_cast<std::ptrdiff_t>(k) * strides_[0]]);
    };
    Calc* const to = out + i;
    to[0] = value(first, here - (here > 0 ? 1 : 0));
    to[kEdgesAtOnce] = value(first, here + (here < last ? 1 : 0));
    if (along_row) {
      to[2 * kEdgesAtOnce] = value(first, here);
      to[3 * kEdgesAtOnce] = value(first, here + (here + 1 < last ? 2 : 1));
    } else {
      to[2 * kEdgesAtOnce] = value(second, here - (here > 0 ? 1 : 0));
      to[3 * kEdgesAtOnce] = value(second, here + (here < last ? 1 : 0));
    }
    for (unsigned place = 4; place < kEdgeValues<N>; ++place) to[place * kEdgesAtOnce] = value(rows[place], here);
  }
}

template <Value T, int N>
void RowSource<T, N>::around_edges(const EdgeSurroundings<N>& edges, const std::uint32_t* at, std::size_t count,
                                   float* out) const noexcept {
  gather(edges, at, count, out);
}

template <Value T, int N>
void RowSource<T, N>::around_edges(const EdgeSurroundings<N>& edges, const std::uint32_t* at, std::size_t count,
                                   double* out) const noexcept {
  gather(edges, at, count, out);
}

template <Value T, int N>
std::array<double, N> RowSource<T, N>::gradient(const Index& index,
                                                const std::array<AxisSteps, N>& steps) const noexcept {
  const auto value = [&](const T* samples, std::size_t k) {
    return static_cast<double>(samples[static_cast<std::ptrdiff_t>(k) * strides_[0]]);
  };
  const T* const samples = row(index);
  const double here = value(samples, index[0]);
  std::array<double, N> result;
  for (int a = 0; a < N; ++a) {
    const auto neighbour = [&](bool exists, std::size_t step) {
      if (!exists) return here;
      return a == 0 ? value(samples, index[0] + step) : value(next_row(index, a, step), index[0]);
    };
    const double backward = neighbour(steps[a].has_backward(index[a]), ~std::size_t{0});
    const double forward = neighbour(steps[a].has_forward(index[a]), 1);
    result[a] = derivative(backward, here, forward, steps[a].at(index[a]));
  }
  return result;
}

#define TEGL_INSTANTIATE(T)       \
  template class RowSource<T, 2>; \
  template class RowSource<T, 3>; \
  template class RowSource<T, 4>; \
  template class RowSource<T, 5>;
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
