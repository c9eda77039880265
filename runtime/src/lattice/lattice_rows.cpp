// SPDX-License-Identifier: BSD-3-Clause
//
// Classifies the rows of a lattice, and counts its contour.
#include "lattice/lattice_rows.hpp"

#include <algorithm>
#include <atomic>

#include "base/workers.hpp"
#include "kernel/contour_output.hpp"
#include "lattice/lattice_grid.hpp"

namespace tegl::detail {

LatticeRows::LatticeRows(Lattice lattice, const std::array<std::size_t, 4>& sizes, const LatticePatterns& patterns)
    : size_(sizes),
      layer_axis_(static_cast<std::size_t>(layer_axis(lattice))),
      patterns_(patterns),
      words_((sizes[0] + kWordBits - 1) / kWordBits),
      kinds_(std::max(patterns[0].edges.size(), patterns[1].edges.size())),
      high_(1 + row_count() * (words_ + 1), 0),
      lines_(size_[2] * size_[3]),
      crossed_(row_count() * kinds_ * words_),
      before_(crossed_.size()),
      rows_(row_count()) {
  for (std::size_t parity = 0; parity < 2; ++parity)
    for (const LatticeCell& cell : patterns[parity].cells) steps_[parity].push_back(steps_of(cell));
}

LatticeRows::CellSteps LatticeRows::steps_of(const LatticeCell& cell) const {
  CellSteps steps;
  for (const LatticePlace& corner : cell.corners)
    steps.corners.push_back(static_cast<std::ptrdiff_t>(this->steps(corner) * (words_ + 1)) - (corner[0] < 0 ? 1 : 0));
  for (const LatticeCell::Edge& edge : cell.edges) {
    steps.rows.push_back(this->steps(edge.at));
    steps.words.push_back((steps.rows.back() * kinds_ + edge.kind) * words_);
  }
  return steps;
}

LatticeRows::Block LatticeRows::block(std::size_t b) const noexcept {
  const std::size_t in_line = detail::block_count(size_[1], kRows);
  const std::size_t line = b / in_line, j = b % in_line * kRows;
  return {line * size_[1] + j, std::min(kRows, size_[1] - j), {0, j, line % size_[2], line / size_[2]}};
}

template <int N>
bool LatticeRows::classify(const SampleClassifier<N>& samples, const WorkOptions& work) {
  std::atomic<bool> any_missing = false;
  std::vector<std::uint8_t> states(block_count());
  const auto make_missing = [&] { return std::vector<Word>(kRows * words_); };
  for_each_block(block_count(), 1, work.threads, work.progress, make_missing,
                 [&](std::size_t b, std::size_t, std::size_t, std::vector<Word>& missing) {
                   const Block rows = block(b);
                   SampleIndex<N> start{};
                   for (int a = 2; a < N; ++a) start[a] = rows.at[static_cast<std::size_t>(a)];
                   // rows of one layer at a time: in 2D a row is a layer
                   const std::size_t at_once = N == 2 ? 1 : rows.count;
                   for (std::size_t j = 0; j < rows.count; j += at_once) {
                     start[1] = rows.at[1] + j;
                     Word* const to = high_.data() + 1 + (rows.first + j) * (words_ + 1);
                     if (samples.classify(start, at_once, {to, words_ + 1}, {missing.data(), words_}) != 0)
                       any_missing.store(true, std::memory_order_relaxed);
                   }
                   states[b] = state_of(rows);
                 });
  for (std::size_t b = 0; b < states.size(); ++b) lines_[block(b).first / size_[1]] |= states[b];
  find_quiet_lines();
  return any_missing;
}
template bool LatticeRows::classify<2>(const SampleClassifier<2>&, const WorkOptions&);
template bool LatticeRows::classify<3>(const SampleClassifier<3>&, const WorkOptions&);
template bool LatticeRows::classify<4>(const SampleClassifier<4>&, const WorkOptions&);

bool LatticeRows::applies(const At& at, const LatticeCell& cell) const noexcept {
  if (cell.at_ends && at[layer_axis_] != 0 && at[layer_axis_] + 1 != size_[layer_axis_]) return false;
  return has_row(at, cell.least) && has_row(at, cell.most);
}

LatticeCellRow LatticeRows::cells_of_row(std::size_t r, const At& at, std::size_t cell) const noexcept {
  const LatticeCell& of = pattern(at).cells[cell];
  return {&of, high(r), steps_[parity(at)][cell].corners.data(), words_, -of.least[0], last(of)};
}

void LatticeRows::streams_of_row(std::size_t r, const At& at, std::size_t cell, EdgeStream* out) const noexcept {
  const CellSteps& steps = steps_[parity(at)][cell];
  const std::vector<LatticeCell::Edge>& edges = pattern(at).cells[cell].edges;
  const std::size_t words = r * kinds_ * words_;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t first = words + steps.words[e];
    out[e] = {crossed_.data() + first, before_.data() + first, rows_[r + steps.rows[e]].first, edges[e].at[0]};
  }
}

std::uint64_t LatticeRows::cells(std::size_t r) const noexcept {
  const At at = this->at(r);
  std::uint64_t count = 0;
  for (const LatticeCell& cell : pattern(at).cells)
    if (applies(at, cell)) count += static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(0, last(cell) + cell.least[0]));
  return count;
}

std::uint64_t LatticeRows::count_all_cells() const noexcept {
  std::uint64_t count = 0;
  for (std::size_t parity = 0; parity < 2; ++parity)
    for (const LatticeCell& cell : patterns_[parity].cells) {
      std::uint64_t in_layer = 1, layers = 0;
      for (std::size_t a = 0; a < 4; ++a) {
        const std::ptrdiff_t first = -cell.least[a], end = static_cast<std::ptrdiff_t>(size_[a]) - cell.most[a];
        if (a != layer_axis_) in_layer *= static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(0, end - first));
        for (std::ptrdiff_t k = first; a == layer_axis_ && k < end; ++k)
          if (static_cast<std::size_t>(k) % 2 == parity &&
              (!cell.at_ends || k == 0 || static_cast<std::size_t>(k) + 1 == size_[a]))
            ++layers;
      }
      count += layers * in_layer;
    }
  return count;
}

std::uint8_t LatticeRows::state_of(const Block& rows) const noexcept {
  const auto samples = static_cast<std::ptrdiff_t>(size_[0]);
  Word any_high = 0, any_low = 0;
  for (std::size_t r = rows.first; r < rows.first + rows.count; ++r) {
    const Word* const bits = high(r);
    for (std::size_t w = 0; w < words_; ++w) {
      any_high |= bits[w];
      any_low |= ~bits[w] & (w + 1 < words_ ? ~Word{0} : range(w, 0, samples));
    }
  }
  return static_cast<std::uint8_t>((any_low != 0 ? kLow : 0) | (any_high != 0 ? kHigh : 0));
}

/// A line is quiet if all lines near it are alike: those that are as far away as corners of one cell.
void LatticeRows::find_quiet_lines() {
  std::array<std::ptrdiff_t, 4> reach{};
  for (const LayerPattern& pattern : patterns_)
    for (const LatticeCell& cell : pattern.cells)
      for (std::size_t a = 2; a < 4; ++a) reach[a] = std::max(reach[a], cell.most[a] - cell.least[a]);
  for (std::size_t a = 2; a < 4; ++a) {
    const std::vector<std::uint8_t> of = lines_;
    const std::size_t step = a == 2 ? 1 : size_[2];
    for (std::size_t line = 0; line < lines_.size(); ++line) {
      const auto at = static_cast<std::ptrdiff_t>(line / step % size_[a]),
                 last = static_cast<std::ptrdiff_t>(size_[a]) - 1;
      for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(at - reach[a], 0); i <= std::min(at + reach[a], last); ++i)
        lines_[line] |= of[line + static_cast<std::size_t>(i - at) * step];
    }
  }
}

std::size_t LatticeRows::border_of(const At& at) const noexcept {
  std::size_t border = parity(at);
  for (std::size_t a = 1; a < 4; ++a) {
    const std::size_t from_end = size_[a] - at[a];
    const std::size_t distance =
        size_[a] <= kDistances || at[a] < kNear ? at[a] : kDistances - std::min(from_end, kNear + 1);
    border = border * kDistances + distance;
  }
  return border;
}

LatticeRows::Ranges LatticeRows::find_ranges(const At& at) const {
  const std::vector<EdgeKind>& kinds = pattern(at).edges;
  Ranges ranges(kinds.size());
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    for (const EdgeKind::Use& use : kinds[kind].uses) {
      const LatticeCell& cell = patterns_[use.parity].cells[use.cell];
      At of = at;  // modulo 2^64
      for (std::size_t a = 1; a < 4; ++a) of[a] -= static_cast<std::size_t>(use.at[a]);
      if (!has_row(of, {}) || !applies(of, cell)) continue;
      const Range range = {use.at[0] - cell.least[0], use.at[0] + last(cell)};
      std::vector<Range>& found = ranges[kind];
      if (range[0] < range[1] && std::find(found.begin(), found.end(), range) == found.end()) found.push_back(range);
    }
  return ranges;
}

void LatticeRows::find_crossed(std::size_t r, const At& at, Scratch& scratch) {
  const Word* const here = high(r);
  const Ranges* used = nullptr;  // needed if an edge is crossed
  std::uint32_t next = 0;
  const std::vector<EdgeKind>& kinds = pattern(at).edges;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const LatticePlace& to = kinds[kind].to;
    const std::size_t first = (r * kinds_ + kind) * words_;
    if (!has_row(at, to)) {
      std::fill_n(crossed_.begin() + static_cast<std::ptrdiff_t>(first), words_, Word{0});
      continue;
    }
    const Word* const there = high(r + steps(to));
    for (std::size_t w = 0; w < words_; ++w) {
      Word bits = here[w] ^ shifted(there, w, to[0]);
      if (bits != 0) {
        if (used == nullptr) {
          std::optional<Ranges>& known = scratch.ranges[border_of(at)];
          if (!known) known = find_ranges(at);
          used = &*known;
        }
        Word in_cells = 0;
        for (const auto& [from, end] : (*used)[kind]) in_cells |= range(w, from, end);
        bits &= in_cells;
      }
      crossed_[first + w] = bits;
      before_[first + w] = next;
      next += count_bits(bits);
    }
  }
  rows_[r].first_own = next;  // relative until rows are numbered
}

void LatticeRows::find_signatures(OccurringSignatures& signatures, const WorkOptions& work) {
  for_each_block(block_count(), 1, work.threads, work.progress, [&](std::size_t b, std::size_t, std::size_t) {
    Block rows = block(b);
    if (is_quiet(rows)) return;
    for (std::size_t r = rows.first; r < rows.first + rows.count; ++r, ++rows.at[1]) {
      const std::vector<LatticeCell>& cells = pattern(rows.at).cells;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        if (!applies(rows.at, cells[c])) continue;
        const std::uint32_t active = mark_signatures(cells_of_row(r, rows.at, c), signatures.of(parity(rows.at), c));
        rows_[r].active += active;
        if (active != 0) rows_[r].kinds |= 1u << c;
      }
    }
  });
  knows_active_ = true;
}

void LatticeRows::count_row(std::size_t r, const At& at) {
  Row& row = rows_[r];
  if (knows_active_ && row.active == 0) return;
  const std::vector<LatticeCell>& cells = pattern(at).cells;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (knows_active_ ? (row.kinds >> c & 1u) == 0 : !applies(at, cells[c])) continue;
    const LatticeCellCount count = count_cells(cells_of_row(r, at, c));
    row.simplices += count.simplices;
    row.own += count.own;
    if (knows_active_) continue;
    row.active += count.active;
    if (count.active != 0) row.kinds |= 1u << c;
  }
}

void LatticeRows::count(const WorkOptions& work) {
  const auto make_scratch = [] { return Scratch{std::vector<std::optional<Ranges>>(kBorders)}; };
  for_each_block(block_count(), 1, work.threads, work.progress, make_scratch,
                 [&](std::size_t b, std::size_t, std::size_t, Scratch& scratch) {
                   Block rows = block(b);
                   if (is_quiet(rows)) return;
                   for (std::size_t r = rows.first; r < rows.first + rows.count; ++r, ++rows.at[1]) {
                     find_crossed(r, rows.at, scratch);
                     count_row(r, rows.at);
                   }
                 });
  for (Row& row : rows_) {
    const std::uint64_t on_edges = row.first_own;
    row.first = static_cast<Index>(vertices_);
    row.first_own = static_cast<Index>(vertices_ + on_edges);
    row.first_simplex = simplices_;
    vertices_ += on_edges + row.own;
    simplices_ += row.simplices;
    active_cells_ += row.active;
  }
  cells_ = count_all_cells();
  check_vertex_count(vertices_, kMaxVertices);
}

}  // namespace tegl::detail
