// SPDX-License-Identifier: BSD-3-Clause
//
// Access to rows of samples for the extraction (see sample_source.hpp).
#include "image/row_source.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>
#include <utility>

#include "image/edge_alphas.hpp"
#include "image/edge_stencil.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

template <Value T, int N>
Word RowSource<T, N>::classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept {
  return classify_rows<T>({row(start), strides()[0], row_size_, N > 2 ? strides()[1] : 0, rows}, threshold_, high,
                          missing);
}

template <Value T, int N>
void RowSource<T, N>::edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept {
  const T* const samples = layer(k);
  const T* const others = axis == N - 1 ? layer(k + 1) : samples + strides()[axis];
  if constexpr (std::is_same_v<T, float>) {
    const std::size_t most = row_size_ - (axis == 0 ? 1 : 0);
    if (edges.critical != nullptr && strides()[0] == 1 && most >= kLeastEdges)
      return row_alphas({samples + edges.rows[0], others + edges.rows[0], most, edges.critical}, this->isovalue(),
                        epsilon_, out);
  }
  detail::edge_alphas<T>({samples, others, edges.rows, edges.at, edges.count, strides()[0]}, this->isovalue(), epsilon_,
                         out);
}

/// Reads the values at all corners of a tile; `lower` and `upper` point to its first corner in the two layers.
template <int N, class T, class Out, class Strides>
[[gnu::always_inline]] static inline void gather_tile(const T* lower, const T* upper, const Strides& strides,
                                                      Out* out) noexcept {
  constexpr std::size_t kHalf = std::size_t{1} << (N - 1);
  const auto offset = [&]<std::size_t... A>(std::size_t corner, std::index_sequence<A...>) {
    return ((static_cast<std::ptrdiff_t>(corner >> A & 1u) * strides[A]) + ...);
  };
  // Unrolled, so that each corner's strides are known at compile time.
  [&]<std::size_t... C>(std::index_sequence<C...>) {
    const std::array<std::ptrdiff_t, kHalf> at = {offset(C, std::make_index_sequence<N - 1>())...};
    ((out[C] = static_cast<Out>(lower[at[C]])), ...);
    ((out[kHalf + C] = static_cast<Out>(upper[at[C]])), ...);
  }
  (std::make_index_sequence<kHalf>());
}

template <Value T, int N>
unsigned RowSource<T, N>::gather_corners(const Index& base, unsigned axes, Corners& corners) const noexcept {
  std::array<std::ptrdiff_t, std::size_t{1} << N> offsets;
  offsets[0] = 0;  // the others are set before they are read
  const std::ptrdiff_t along = offset_in_row(base);
  const T* const samples = row(base) + along;
  // A cell within the last layer has no upper layer.
  const T* const above = (axes >> (N - 1) & 1u) != 0 ? next_row(base, N - 1, 1) + along : nullptr;
  const Strides steps = strides();
  if (axes == (1u << N) - 1) {
    gather_tile<N>(samples, above, steps, corners.data());
    return N;
  }
  corners[0] = *samples;
  unsigned dim = 0;
  for (unsigned a = 0; a < N; ++a) {
    if ((axes >> a & 1u) == 0) continue;
    const T* const from = a == N - 1 ? above : samples;
    for (std::size_t c = 0, up = std::size_t{1} << dim; c < std::size_t{1} << dim; ++c, ++up) {
      offsets[up] = offsets[c] + (a == N - 1 ? 0 : steps[a]);
      corners[up] = from[offsets[up]];
    }
    ++dim;
  }
  return dim;
}

template <Value T, int N>
void RowSource<T, N>::corner_values(const Index& base, unsigned axes, double* out) const noexcept {
  if (axes == (1u << N) - 1) {
    const std::ptrdiff_t along = offset_in_row(base);
    return gather_tile<N>(row(base) + along, next_row(base, N - 1, 1) + along, strides(), out);
  }
  Corners corners;
  const unsigned dim = gather_corners(base, axes, corners);
  std::copy_n(corners.begin(), std::size_t{1} << dim, out);
}

template <Value T, int N>
void RowSource<T, N>::corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept {
  const std::ptrdiff_t along = offset_in_row(base);
  constexpr unsigned kHalf = 1u << (N - 2);
  const std::array<const T*, 2> layers = {row(base) + along, next_row(base, N - 1, 1) + along};
  for (unsigned r = 0; r < 2 * kHalf; ++r, out += pitch) {
    const T* from = layers[r / kHalf];
    for (unsigned a = 1; a < N - 1; ++a) from += static_cast<std::ptrdiff_t>(r >> (a - 1) & 1u) * strides()[a];
    if (strides()[0] == 1)
      convert_values<T, double>(from, count, out);
    else
      for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<double>(from[static_cast<std::ptrdiff_t>(i) * strides()[0]]);
  }
}

template <Value T, int N>
double RowSource<T, N>::corner_heights(const Index& base, unsigned axes, double* out) const noexcept {
  corner_values(base, axes, out);
  const std::size_t corners = std::size_t{1} << std::popcount(axes);
  for (std::size_t v = 0; v < corners; ++v) out[v] -= this->isovalue();
  return epsilon_;
}

template <Value T, int N>
void RowSource<T, N>::cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept {
  if (N == 4 && axes == (1u << N) - 1) {
    // About half of the edges are critical: computing all is faster than gathering these.
    std::array<double, std::size_t{1} << N> values;
    corner_values(base, axes, values.data());
    return tile_alphas(values.data(), this->isovalue(), epsilon_, out);
  }
  static constexpr auto kInOrder = [] {
    std::array<std::uint32_t, N << (N - 1)> result{};
    for (std::uint32_t i = 0; i < result.size(); ++i) result[i] = i;
    return result;
  }();
  static constexpr std::array<std::ptrdiff_t, kInOrder.size()> kOneRow{};
  Corners corners;
  const unsigned dim = gather_corners(base, axes, corners);
  // gather the requested edges
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
  detail::edge_alphas<T>({first.data(), second.data(), kOneRow.data(), kInOrder.data(), count, 1}, this->isovalue(),
                         epsilon_, alphas.data());
  // scatter the results
  const double* next = alphas.data();
  for (; edges != 0; edges &= edges - 1) out[std::countr_zero(edges)] = *next++;
}

template <Value T, int N>
template <int K>
void RowSource<T, N>::alphas_together(const CellsWithEdges<N, K>& cells,
                                      typename CellsWithEdges<N, K>::Alphas& out) const noexcept {
  // All edges: faster than gathering those asked for.
  constexpr std::size_t kPitch = CellsWithEdges<N, K>::kMost;
  std::array<std::array<double, kPitch>, std::size_t{1} << K> corners;
  std::array<double, std::size_t{1} << N> values;
  for (std::size_t i = 0; i < cells.count; ++i) {
    corner_values(cells.bases[i], cells.axes[i], values.data());
    for (std::size_t v = 0; v < corners.size() && v < values.size(); ++v) corners[v][i] = values[v];
  }
  alphas_of_cells(K, corners[0].data(), cells.count, kPitch, this->isovalue(), epsilon_, out[0].data());
}

namespace {

/// Locations of the values around edges along one axis. `from`, by place: the layer that contains the value, displaced
/// so that the index of the edge's first sample finds it. `first` and `second`: the samples at the two ends of the
/// edge.
template <Value T, int N>
struct Places {
  const T* first;
  const T* second;
  std::array<const T*, kEdgeValues<N>> from;
  std::ptrdiff_t along;
  std::size_t row_size;
};

/// Reads the values edge by edge.
template <bool kAlongRow, Value T, int N, class Calc>
std::uint64_t gather_each(const Places<T, N>& places, const EdgesInRows& edges, Calc* out) noexcept {
  const T* const first = places.first;
  const T* const second = places.second;
  const auto& from = places.from;
  const std::ptrdiff_t along = places.along;
  const std::size_t last = places.row_size - 1;
  std::uint64_t at_ends = 0;
  for (std::size_t i = 0; i < edges.count; ++i) {
    const std::size_t here = edges.at[i];
    const std::ptrdiff_t place = edges.rows[i] + static_cast<std::ptrdiff_t>(here) * along;
    const bool at_start = here == 0;
    const bool at_end = kAlongRow ? here + 1 == last : here == last;
    at_ends |= std::uint64_t{at_start || at_end} << i;
    const auto value = [&](const T* samples, std::ptrdiff_t step) { return static_cast<Calc>(samples[place + step]); };
    const std::ptrdiff_t back = at_start ? 0 : -along;
    const std::ptrdiff_t ahead = at_end ? 0 : along;
    Calc* const to = out + i;
    to[0] = value(first, back);
    to[kEdgesAtOnce] = value(first, kAlongRow ? along : ahead);
    to[2 * kEdgesAtOnce] = kAlongRow ? value(first, 0) : value(second, back);
    to[3 * kEdgesAtOnce] = value(second, ahead);
    // Unrolled, as not every optimisation level unrolls a loop.
    [&]<std::size_t... J>(std::index_sequence<J...>) { ((to[(J + 4) * kEdgesAtOnce] = value(from[J + 4], 0)), ...); }
    (std::make_index_sequence<kEdgeValues<N> - 4>());
  }
  return at_ends;
}

/// Whether gather_row can be used, and there are enough edges for it.
template <class Calc, Value T, int N>
bool may_be_row(const Places<T, N>& places, const EdgesInRows& edges) noexcept {
  constexpr std::size_t kLeast = kEdgesAtOnce / 2;  // with fewer, the preparation takes longer than it saves
  if (edges.count < kLeast) return false;
  const std::size_t last = edges.count - 1;
  return places.along == 1 && places.row_size >= kMostLanes + 3 && edges.rows[0] == edges.rows[last] &&
         may_be_dense<Calc>(edges.at[last] - edges.at[0], edges.count);
}

/// Reads the values of edges in one row by registers, except at the row's ends, where edges lack a neighbour and are
/// read one by one. Returns false if there are too few edges or several rows; the output is then undefined.
template <bool kAlongRow, Value T, int N, class Calc>
bool gather_row(const Places<T, N>& places, const EdgesInRows& edges, Calc* out, std::uint64_t& at_ends) noexcept {
  const std::size_t last = edges.count - 1;
  const std::size_t end = places.row_size - (kAlongRow ? 2 : 1);
  const std::size_t before = edges.at[0] == 0 ? 1 : 0;
  const std::size_t behind = edges.at[last] == end ? 1 : 0;
  if (!pick_values<T, Calc>({places.from.data(), kEdgeValues<N>, 1, end, edges.rows, edges.at, edges.count, out}))
    return false;
  if (before != 0) gather_each<kAlongRow>(places, {edges.rows, edges.at, 1}, out);
  if (behind != 0) gather_each<kAlongRow>(places, {edges.rows + last, edges.at + last, 1}, out + last);
  at_ends = std::uint64_t{before} | std::uint64_t{behind} << last;
  return true;
}

/// Reads the values of edges in any rows: four edges at a time, near the ends of rows one by one.
template <bool kAlongRow, Value T, int N, class Calc>
std::uint64_t gather_any(const Places<T, N>& places, unsigned axis, const EdgesInRows& edges, Calc* out) noexcept {
  if (places.along != 1) return gather_each<kAlongRow>(places, edges, out);
  std::uint64_t left = gather_values<T, Calc>(
      {places.from.data(), kEdgeValues<N>, axis, places.row_size, edges.rows, edges.at, edges.count, out});
  if (left == ~std::uint64_t{0} >> (kEdgesAtOnce - edges.count)) return gather_each<kAlongRow>(places, edges, out);
  std::uint64_t at_ends = 0;
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    at_ends |= gather_each<kAlongRow>(places, {edges.rows + i, edges.at + i, 1}, out + i) << i;
  }
  return at_ends;
}

}  // namespace

template <Value T, int N>
template <bool kAlongRow, class Calc>
std::uint64_t RowSource<T, N>::gather(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                                      Calc* out) const noexcept {
  const T* const first = layer(around.layer);
  const T* const second = kAlongRow              ? first + strides()[0]
                          : around.axis == N - 1 ? layer(around.layer + 1)
                                                 : first + strides()[around.axis];
  const std::ptrdiff_t along = strides()[0];
  Places<T, N> places{first, second, {first - along, first + along, second - along, second + along}, along, row_size_};
  for (int a = 1; a < N; ++a) {
    const auto neighbour = [&](unsigned j, const T* sample) {
      if (!around.exists[a][j]) return sample;
      if (a < N - 1) return sample + (j % 2 == 0 ? -strides()[a] : strides()[a]);
      const std::size_t k = around.layer + (sample == second && !kAlongRow && around.axis == N - 1 ? 1 : 0);
      return layer(j % 2 == 0 ? k - 1 : k + 1) + (sample - layer(k));
    };
    places.from[4 * a] = neighbour(0, first);
    places.from[4 * a + 1] = a == around.axis ? second : neighbour(1, first);
    places.from[4 * a + 2] = a == around.axis ? first : neighbour(2, second);
    places.from[4 * a + 3] = neighbour(3, second);
  }
  if (std::uint64_t at_ends; may_be_row<Calc>(places, edges) && gather_row<kAlongRow>(places, edges, out, at_ends))
    return at_ends;
  return gather_any<kAlongRow>(places, static_cast<unsigned>(around.axis), edges, out);
}

template <Value T, int N>
template <class Calc>
std::uint64_t RowSource<T, N>::gather_around(const SampleGradients<N>& samples, const EdgeSurroundings<N>& around,
                                             const EdgesInRows& edges, Calc* out) noexcept {
  const auto& rows = static_cast<const RowSource&>(samples);
  return around.axis == 0 ? rows.template gather<true>(around, edges, out)
                          : rows.template gather<false>(around, edges, out);
}

template <Value T, int N>
AroundEdges<N, double> RowSource<T, N>::around_edges() const noexcept {
  return &RowSource::gather_around<double>;
}

template <Value T, int N>
AroundEdges<N, float> RowSource<T, N>::around_edges_in_float() const noexcept {
  if constexpr (std::numeric_limits<T>::digits <= std::numeric_limits<float>::digits)
    return &RowSource::gather_around<float>;
  else
    return nullptr;
}

template <Value T, int N>
std::array<double, N> RowSource<T, N>::gradient(const Index& index,
                                                const std::array<AxisSteps, N>& steps) const noexcept {
  const auto value = [&](const T* samples, std::size_t k) {
    return static_cast<double>(samples[static_cast<std::ptrdiff_t>(k) * strides()[0]]);
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

template <Value T, int N>
ValuesAround<N> RowSource<T, N>::values_around(const Index& index,
                                               const std::array<AxisSteps, N>& steps) const noexcept {
  std::array<std::array<bool, 3>, N> exists;
  for (int a = 0; a < N; ++a) exists[a] = {steps[a].has_backward(index[a]), true, steps[a].has_forward(index[a])};
  ValuesAround<N> values;
  for (std::size_t row_number = 0; row_number < values.size() / 3; ++row_number) {
    Index at = index;
    bool inside = true;
    std::size_t rest = row_number;
    for (int a = 1; a < N; ++a, rest /= 3) {
      inside = inside && exists[a][rest % 3];
      at[a] += rest % 3 - 1;  // modulo 2^64
    }
    const T* const samples = inside ? row(at) + offset_in_row(index) : nullptr;
    for (std::size_t i = 0; i < 3; ++i)
      values[3 * row_number + i] =
          inside && exists[0][i] ? static_cast<double>(samples[(static_cast<std::ptrdiff_t>(i) - 1) * strides()[0]])
                                 : std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N) \
  template class RowSource<T, N>;         \
  template class ImageSource<T, N>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
