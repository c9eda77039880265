// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contours of polygons and polyhedra.
#include "polytope/polytope_contours.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "ambiguity/face_decision.hpp"
#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"

namespace tegl::detail {

bool is_face_high(const PolytopeRules& rules, std::span<const double> values) {
  if (!rules.rule) return rules.joins_high;
  if (values.size() != 4) return is_mean_high(values, rules.isovalue);
  const std::array<double, 4> square = {values[0], values[1], values[3], values[2]};  // in the order of its corners
  return is_square_high(*rules.rule, square, rules.isovalue);
}

namespace {

/// Builds the contours of the cells of a block.
class BlockBuilder {
 public:
  BlockBuilder(const Polytopes& polytopes, std::span<const double> values, const PolytopeRules& rules,
               PolytopeBlock& block)
      : polytopes_(polytopes), is_plane_(polytopes.dim() == 2), values_(values), rules_(rules), block_(block) {}

  void add(Index cell) {
    const std::span<const Index> corners = polytopes_.points_of(cell);
    std::size_t high = 0;
    bool is_missing = false;
    for (std::size_t v = 0; v < corners.size(); ++v) {
      at_[v] = values_[corners[v]];
      high += is_high(v) ? 1 : 0;
      is_missing = is_missing || std::isnan(at_[v]);
    }
    if (is_missing) block_.missing.push_back(cell);
    if (is_missing || high == 0 || high == corners.size()) return;
    ++block_.active;
    shape_ = &polytopes_.shape(cell);
    cell_ = cell;
    if (is_plane_)
      for_each_segment(*shape_, 0, at_.data(), rules_,
                       [&](std::size_t from, std::size_t to) { add_segment(from, to); });
    else
      loops_.for_each(*shape_, at_.data(), rules_, [&](std::span<const std::uint8_t> loop) { add_loop(loop); });
  }

  void finish() { set_edges(block_, crossed_); }

 private:
  [[nodiscard]] bool is_high(std::size_t v) const noexcept { return at_[v] >= rules_.isovalue; }

  void add_edge(std::size_t e) {
    const auto& ends = shape_->edges()[e];
    const Index* const corners = polytopes_.cell(cell_);
    crossed_.push_back({std::min(corners[ends[0]], corners[ends[1]]), std::max(corners[ends[0]], corners[ends[1]])});
  }

  /// The segment of a polygon's contour.
  void add_segment(std::size_t from, std::size_t to) {
    add_edge(from);
    add_edge(to);
    block_.pieces.push_back({cell_, static_cast<std::uint32_t>(crossed_.size()), false});
    ++block_.simplices;
  }

  void add_loop(std::span<const std::uint8_t> loop) {
    const std::size_t size = loop.size();
    std::size_t start = 0;
    const bool is_coned = size > 3 && !(rules_.is_compact && find_fan(*shape_, loop, start));
    if (is_coned) start = 0;
    for (std::size_t i = 0; i < size; ++i) add_edge(loop[(start + i) % size]);
    block_.pieces.push_back({cell_, static_cast<std::uint32_t>(crossed_.size()), is_coned});
    block_.simplices += is_coned ? size : size - 2;
    block_.own += is_coned ? 1 : 0;
  }

  const Polytopes& polytopes_;
  bool is_plane_;  ///< polygons
  std::span<const double> values_;
  const PolytopeRules& rules_;
  PolytopeBlock& block_;
  const PolytopeShape* shape_ = nullptr;  ///< of the current cell
  Index cell_ = 0;
  std::array<double, kPolytopeCorners> at_{};
  Loops loops_;
  std::vector<std::array<Index, 2>> crossed_;  ///< of all pieces
};

}  // namespace

std::vector<PolytopeBlock> build_polytope_contours(const Polytopes& polytopes, std::span<const double> values,
                                                   const PolytopeRules& rules, const std::vector<Index>* listed,
                                                   const WorkOptions& work) {
  return build_blocks(4096, polytopes, listed, work,
                      [&](PolytopeBlock& block) { return BlockBuilder(polytopes, values, rules, block); });
}

void set_edges(PolytopeBlock& block, const std::vector<std::array<Index, 2>>& crossed) {
  struct Crossing {
    std::uint64_t ends;
    std::uint32_t place;
  };
  std::vector<Crossing> crossings(crossed.size());
  Index most = 0;
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const auto& [p, q] = crossed[i];
    crossings[i] = {std::uint64_t{p} << 32 | q, static_cast<std::uint32_t>(i)};
    most = std::max(most, p);
  }
  // by the smaller end, then the few with the same one
  sort_by_bits(crossings, static_cast<unsigned>(std::bit_width(most)), [](const Crossing& c) { return c.ends >> 32; });
  for (auto at = crossings.begin(); at != crossings.end();) {
    const auto end =
        std::find_if(at, crossings.end(), [&](const Crossing& c) { return c.ends >> 32 != at->ends >> 32; });
    std::sort(at, end, [](const Crossing& a, const Crossing& b) { return a.ends < b.ends; });
    at = end;
  }
  block.vertices.resize(crossed.size());
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const std::uint64_t ends = crossings[i].ends;
    if (i == 0 || ends != crossings[i - 1].ends)
      block.edges.push_back({static_cast<Index>(ends >> 32), static_cast<Index>(ends)});
    block.vertices[crossings[i].place] = static_cast<std::uint32_t>(block.edges.size() - 1);
  }
}

void separate_diagonals(std::vector<PolytopeBlock>& blocks, unsigned threads) {
  struct Diagonal {
    std::uint64_t ends;
    std::uint32_t block, piece;
  };
  const auto for_each_diagonal = [&](std::size_t b, const auto& visit) {
    const PolytopeBlock& block = blocks[b];
    std::uint32_t first = 0;
    for (std::size_t p = 0; p < block.pieces.size(); first = block.pieces[p++].end) {
      const auto vertex = [&](std::uint32_t i) { return block.numbers[block.vertices[i]]; };
      if (block.pieces[p].is_coned) continue;
      for (std::uint32_t i = first + 2; i + 1 < block.pieces[p].end; ++i) {
        const Index v = vertex(first), w = vertex(i);
        visit(Diagonal{std::uint64_t{std::min(v, w)} << 32 | std::max(v, w), static_cast<std::uint32_t>(b),
                       static_cast<std::uint32_t>(p)});
      }
    }
  };
  std::vector<std::uint64_t> first_of(blocks.size() + 1);
  for_each_item(blocks.size(), threads, nullptr,
                [&](std::size_t b) { for_each_diagonal(b, [&](const Diagonal&) { ++first_of[b + 1]; }); });
  for (std::size_t b = 0; b < blocks.size(); ++b) first_of[b + 1] += first_of[b];
  std::vector<Diagonal> diagonals(first_of.back());
  Index most = 0;
  for (const PolytopeBlock& block : blocks)
    for (const Index number : block.numbers) most = std::max(most, number);
  for_each_item(blocks.size(), threads, nullptr, [&](std::size_t b) {
    std::uint64_t place = first_of[b];
    for_each_diagonal(b, [&](const Diagonal& diagonal) { diagonals[place++] = diagonal; });
  });
  // sort by the smaller vertex, then the few that are equal
  sort_by_bits(
      diagonals, static_cast<unsigned>(std::bit_width(most)),
      [](const Diagonal& diagonal) { return diagonal.ends >> 32; }, threads);
  for (auto at = diagonals.begin(); at != diagonals.end();) {
    const auto end =
        std::find_if(at, diagonals.end(), [&](const Diagonal& other) { return other.ends >> 32 != at->ends >> 32; });
    std::stable_sort(at, end, [](const Diagonal& a, const Diagonal& b) { return a.ends < b.ends; });
    at = end;
  }
  const auto cone = [&](const Diagonal& at) {
    PolytopeBlock& block = blocks[at.block];
    if (std::exchange(block.pieces[at.piece].is_coned, true)) return;
    block.simplices += 2;  // a fan has two triangles fewer than vertices
    ++block.own;
  };
  for (std::size_t i = 1; i < diagonals.size(); ++i) {
    if (diagonals[i].ends != diagonals[i - 1].ends) continue;
    cone(diagonals[i - 1]);
    cone(diagonals[i]);
  }
}

}  // namespace tegl::detail
