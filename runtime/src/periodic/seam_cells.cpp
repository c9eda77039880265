// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the vertices on the seam of periodic axes (see seam_cells.hpp).
#include "periodic/seam_cells.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace tegl::detail {

namespace {

/// The number of vertices of a cell by its bits.
template <class Plane>
unsigned vertices_at(const Plane& plane, std::size_t word, unsigned bit) noexcept {
  unsigned count = 0;
  for (const auto& bits : plane.bits) count += static_cast<unsigned>(bits[word] >> bit & 1u);
  return count;
}

}  // namespace

template <int N>
template <class Plane>
void SeamCells<N>::list_row(const Plane& plane, std::size_t row, const RowShape<N>& shape, bool lists, Cells& cells) {
  if (plane.count[row] == 0) return;
  if constexpr (std::is_same_v<Plane, CubePlane>)
    if (lists) {
      const auto cubes = plane.lists.row(row);
      for (std::size_t i = 0; i < cubes.size(); ++i)
        cells.push_back({cubes[i].at, plane.first(row) + cubes[i].before, plane.listed_vertices(row, i)});
      return;
    }
  Index next = plane.first(row);
  for (std::size_t w = 0; w < shape.words(); ++w)
    for (Word rest = plane.bits[0][row * shape.words() + w]; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned count = vertices_at(plane, row * shape.words() + w, bit);
      cells.push_back({w * kWordBits + bit, next, count});
      next += count;
    }
}

template <int N>
template <class Plane>
void SeamCells<N>::list_layer(const Plane& plane, const RowShape<N>& shape, bool lists, Cells& cells) const {
  for (std::size_t row = 0; row < shape.rows(); ++row) {
    const std::size_t from = cells.size();
    list_row(plane, row, shape, lists, cells);
    for (std::size_t i = from; i < cells.size(); ++i) cells[i].place += row * shape.words() * kWordBits;
  }
}

template <int N>
template <class Plane>
void SeamCells<N>::add_plane(const Plane& plane, unsigned axes, const RowShape<N>& shape, bool lists) {
  if ((axes_ & ~axes & ((1u << (N - 1)) - 1)) == 0) return;
  for (std::size_t row = 0; row < shape.rows(); ++row) {
    if (plane.count[row] == 0) continue;
    for (int a = 1; a < N - 1; ++a) {
      if (!repeats(axes, a) || shape.index_of(row)[a] + 1 != shape.size(a)) continue;
      upper_.clear();
      lower_.clear();
      list_row(plane, row, shape, lists, upper_);
      list_row(plane, shape.at_start(row, a), shape, lists, lower_);
      pair(upper_, lower_);
    }
    if (!repeats(axes, 0)) continue;
    const std::size_t last = shape.size(0) - 1;
    if constexpr (std::is_same_v<Plane, CubePlane>)
      if (lists) {
        upper_.clear();
        list_row(plane, row, shape, lists, upper_);
        if (upper_.size() < 2 || upper_.front().place != 0 || upper_.back().place != last) continue;
        upper_.back().place = 0;
        pair({upper_.back()}, {upper_.front()});
        continue;
      }
    const std::size_t word = row * shape.words();
    const unsigned first_count = vertices_at(plane, word, 0);
    const unsigned last_count = vertices_at(plane, word + last / kWordBits, static_cast<unsigned>(last % kWordBits));
    if (first_count != 0 && last_count != 0)
      pair({{0, plane.id(row, shape.words(), last), last_count}}, {{0, plane.first(row), first_count}});
  }
}

template <int N>
void SeamCells<N>::add_edges(const EdgePlane& plane, int axis, const RowShape<N>& shape, const Word* from,
                             const Word* to) {
  const unsigned axes = 1u << axis;
  if ((axes_ & ~axes & ((1u << (N - 1)) - 1)) == 0) return;
  for (std::size_t row = 0; row < shape.rows(); ++row) {
    const std::uint32_t count = plane.count.data()[row];  // data(): checked builds do not inline operator[]
    if (count == 0) continue;
    for (int a = 1; a < N - 1; ++a)
      if (repeats(axes, a) && shape.index_of(row)[a] + 1 == shape.size(a))
        pair(plane.first(row), plane.first(shape.at_start(row, a)), count);
    if (!repeats(axes, 0)) continue;
    const bool is_critical = ((from[row * shape.pitch()] ^ to[shape.shifted(row, axes) * shape.pitch()]) & 1u) != 0;
    if (is_critical) pair(plane.first(row) + count - 1, plane.first(row), 1);
  }
}

template <int N>
void SeamCells<N>::add_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, NumberedBy by) {
  for (int a = 0; a < N - 1; ++a)
    by.ranks ? add_plane(layer.edges[a], 1u << a, shape, false)
             : add_edges(layer.edges[a], a, shape, layer.high.data(), layer.high.data());
  if constexpr (N == 4)
    if (!layer.cubes.count.empty()) add_plane(layer.cubes, 7u, shape, by.lists);
  if (!is_periodic(N - 1) || (k != 0 && k + 1 != shape.layers())) return;
  const std::size_t before = pairs_.size();
  const auto add_kind = [&](const auto& plane, int kind, bool lists) {
    if (k == 0) return list_layer(plane, shape, lists, of_first_[kind]);
    Cells cells;
    list_layer(plane, shape, lists, cells);
    pair(cells, of_first_[kind]);
  };
  for (int a = 0; a < N - 1; ++a) add_kind(layer.edges[a], a, false);
  if constexpr (N == 4)
    if (!layer.cubes.count.empty()) add_kind(layer.cubes, N - 1, by.lists);
  pairs_with_layer_0_ = pairs_.size() - before;
}

template <int N>
void SeamCells<N>::add_slab(const SlabView<N>& view, NumberedBy by) {
  constexpr unsigned kAll = (1u << N) - 1;
  const RowShape<N>& shape = *view.shape;
  const Slab<N>& slab = *view.slab;
  by.ranks ? add_plane(slab.edges, 1u << (N - 1), shape, false)
           : add_edges(slab.edges, N - 1, shape, view.layers[0]->high.data(), view.layers[1]->high.data());
  if constexpr (N == 4)
    for (int a = 0; a < N - 1; ++a)
      if (!slab.cubes[a].count.empty()) add_plane(slab.cubes[a], kAll & ~(1u << a), shape, by.lists);
}

template <int N>
void SeamCells<N>::pair(const Cells& last, const Cells& first) {
  auto at = first.begin();
  for (const Cell& cell : last) {
    while (at != first.end() && at->place < cell.place) ++at;
    if (at == first.end() || at->place != cell.place) continue;
    for (unsigned i = 0; i < std::min(cell.count, at->count); ++i) pairs_.emplace_back(cell.first + i, at->first + i);
  }
}

template class SeamCells<2>;
template class SeamCells<3>;
template class SeamCells<4>;

}  // namespace tegl::detail
