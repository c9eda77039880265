// SPDX-License-Identifier: BSD-3-Clause
//
// Classifies the rows of a lattice, and counts its contour.
#include "lattice/lattice_rows.hpp"

#include <algorithm>
#include <atomic>

#include "base/workers.hpp"
#include "kernel/contour_output.hpp"

namespace tegl::detail {

LatticeRows::LatticeRows(const std::array<std::size_t, 3>& size, const std::array<LayerPattern, 2>& patterns)
    : size_(size),
      patterns_(patterns),
      words_((size[0] + kWordBits - 1) / kWordBits),
      kinds_(std::max(patterns[0].edges.size(), patterns[1].edges.size())),
      high_(1 + row_count() * (words_ + 1), 0),
      crossed_(row_count() * kinds_ * words_),
      before_(crossed_.size()),
      rows_(row_count()) {}

template <int N>
bool LatticeRows::classify(const SampleClassifier<N>& samples, const WorkOptions& work) {
  std::atomic<bool> any_missing = false;
  for_each_block(size_[2], 1, work.threads, work.progress, [&](std::size_t k, std::size_t, std::size_t) {
    std::vector<Word> missing(kWordBits * words_);
    for (std::size_t j = 0; j < size_[1]; j += kWordBits) {
      SampleIndex<N> start{};
      start[N - 1] = k;
      if constexpr (N == 3) start[1] = j;
      Word* const to = high_.data() + 1 + (k * size_[1] + j) * (words_ + 1);
      if (samples.classify(start, std::min(kWordBits, size_[1] - j), {to, words_ + 1}, {missing.data(), words_}) != 0)
        any_missing.store(true, std::memory_order_relaxed);
    }
  });
  return any_missing;
}
template bool LatticeRows::classify<2>(const SampleClassifier<2>&, const WorkOptions&);
template bool LatticeRows::classify<3>(const SampleClassifier<3>&, const WorkOptions&);

bool LatticeRows::applies(std::size_t j, std::size_t k, const LatticeCell& cell) const noexcept {
  if (cell.at_ends && k != 0 && k + 1 != size_[2]) return false;
  return has_row(j, k, cell.least) && has_row(j, k, cell.most);
}

LatticeCellRow LatticeRows::cells_of_row(std::size_t j, std::size_t k, const LatticeCell& cell) const noexcept {
  LatticeCellRow row{&cell, {}, words_, -cell.least[0], last(cell)};
  for (std::size_t c = 0; c < cell.corners.size(); ++c) row.corners[c] = high(row_at(j, k, cell.corners[c]));
  return row;
}

void LatticeRows::find_ranges(std::size_t j, std::size_t k, const EdgeKind& kind, std::vector<Range>& ranges) const {
  ranges.clear();
  for (const EdgeKind::Use& use : kind.uses) {
    const std::array<std::ptrdiff_t, 3> back = {-use.at[0], -use.at[1], -use.at[2]};
    const LatticeCell& cell = patterns_[use.parity].cells[use.cell];
    if (!has_row(j, k, back) ||
        !applies(j + static_cast<std::size_t>(back[1]), k + static_cast<std::size_t>(back[2]), cell))
      continue;
    const Range range = {use.at[0] - cell.least[0], use.at[0] + last(cell)};
    if (range[0] < range[1] && std::find(ranges.begin(), ranges.end(), range) == ranges.end()) ranges.push_back(range);
  }
}

void LatticeRows::find_crossed(std::size_t j, std::size_t k, const std::vector<std::vector<Range>>& used, Row& row) {
  const std::size_t r = k * size_[1] + j;
  const Word* const here = high(r);
  std::uint32_t next = 0;
  const std::vector<EdgeKind>& kinds = pattern(k).edges;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const auto& to = kinds[kind].to;
    const std::vector<Range>& ranges = used[kind];
    if (ranges.empty()) continue;
    const Word* const there = high(row_at(j, k, to));
    const std::size_t at = (r * kinds_ + kind) * words_;
    for (std::size_t w = 0; w < words_; ++w) {
      Word bits = here[w] ^ shifted(there, w, to[0]);
      if (bits == 0) {
        crossed_[at + w] = 0;
        before_[at + w] = next;
        continue;
      }
      Word in_cells = 0;
      for (const auto& [first, end] : ranges) in_cells |= range(w, first, end);
      bits &= in_cells;
      crossed_[at + w] = bits;
      before_[at + w] = next;
      next += count_bits(bits);
    }
  }
  row.first_own = next;  // relative until rows are numbered
}

void LatticeRows::count_row(std::size_t j, std::size_t k, std::vector<ActiveInRow>& active, Row& row) const {
  for (const LatticeCell& cell : pattern(k).cells) {
    if (!applies(j, k, cell)) continue;
    row.cells += static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(0, last(cell) + cell.least[0]));
    const LatticeCellRow cells = cells_of_row(j, k, cell);
    if (cell.has_lists) {
      const LatticeCellCount count = count_cells(cells);
      row.active += count.active;
      row.simplices += count.simplices;
      continue;
    }
    active.resize(words_ * kWordBits);
    const std::size_t count = list_cells(cells, active.data());
    for (std::size_t i = 0; i < count; ++i) {
      const LatticeCell::Contour& contour = cell.contours[active[i].signature];
      row.simplices += contour.simplices;
      row.own += contour.own;
    }
    row.active += static_cast<std::uint32_t>(count);
  }
}

void LatticeRows::count(const WorkOptions& work) {
  for_each_block(size_[2], 1, work.threads, work.progress, [&](std::size_t k, std::size_t, std::size_t) {
    const std::vector<EdgeKind>& kinds = pattern(k).edges;
    std::vector<std::vector<Range>> used(kinds.size());
    std::vector<ActiveInRow> active;
    for (std::size_t j = 0; j < size_[1]; ++j) {
      Row& row = rows_[k * size_[1] + j];
      // the same for all rows that are not near the border
      constexpr std::size_t kNear = 2;
      if (j <= kNear || j + kNear >= size_[1])
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) find_ranges(j, k, kinds[kind], used[kind]);
      find_crossed(j, k, used, row);
      count_row(j, k, active, row);
    }
  });
  for (Row& row : rows_) {
    const std::uint64_t on_edges = row.first_own;
    row.first = static_cast<Index>(vertices_);
    row.first_own = static_cast<Index>(vertices_ + on_edges);
    row.first_simplex = simplices_;
    vertices_ += on_edges + row.own;
    simplices_ += row.simplices;
    cells_ += row.cells;
    active_cells_ += row.active;
  }
  check_vertex_count(vertices_, kMaxVertices);
}

}  // namespace tegl::detail
