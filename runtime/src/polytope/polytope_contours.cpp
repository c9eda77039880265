// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contours of polygons and polyhedra.
#include "polytope/polytope_contours.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ambiguity/face_decision.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"

namespace tegl::detail {

bool is_face_high(const PolytopeRules& rules, std::span<const double> values) {
  if (!rules.rule) return rules.joins_high;
  if (values.size() != 4) return is_mean_high(values, rules.isovalue);
  const std::array<double, 4> square = {values[0], values[1], values[3], values[2]};  // in the order of its corners
  return is_square_high(*rules.rule, square, rules.isovalue);
}

namespace {

/// Most edges of a polyhedron with so many corners.
constexpr std::size_t kEdges = 3 * kPolytopeCorners - 6;

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
    for (std::size_t e = 0; e < shape_->edges().size(); ++e) next_[e] = kNone;
    cell_ = cell;
    for (std::size_t f = 0; f < shape_->face_count(); ++f) add_segments(f);
    for (std::size_t e = 0; e < shape_->edges().size(); ++e)
      if (next_[e] != kNone) add_loop(e);
  }

  /// Numbers the edges of the block.
  void finish() {
    std::vector<std::array<Index, 2>>& edges = block_.edges;
    edges = crossed_;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    block_.vertices.reserve(crossed_.size());
    for (const auto& edge : crossed_)
      block_.vertices.push_back(
          static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin()));
  }

 private:
  [[nodiscard]] bool is_high(std::size_t v) const noexcept { return at_[v] >= rules_.isovalue; }

  /// The segments of the contour in a face: from the edge where a run of high corners ends to the edge where a run
  /// begins: its own one, or the following one if the high corners are joined. In the ring of the face that shares the
  /// edge, ends are beginnings, so that the segments around a cell are loops.
  void add_segments(std::size_t face) {
    const std::span<const std::uint8_t> ring = shape_->ring(face), edges = shape_->ring_edges(face);
    std::array<std::uint8_t, kPolytopeCorners> begins, ends;  // edges, in the order around the face
    std::size_t begin_count = 0, end_count = 0;
    bool ends_first = false;  // the first run begins before the ring does
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const bool before = is_high(ring[i]), after = is_high(ring[(i + 1) % ring.size()]);
      if (before == after) continue;
      if (begin_count + end_count == 0) ends_first = before;
      (before ? ends[end_count++] : begins[begin_count++]) = edges[i];
    }
    if (end_count == 0) return;
    bool joins = false;
    if (end_count > 1) {
      std::array<double, kPolytopeCorners> values;
      for (std::size_t i = 0; i < ring.size(); ++i) values[i] = at_[ring[i]];
      joins = is_face_high(rules_, {values.data(), ring.size()});
    }
    // the run of ends[k] begins at begins[k - 1] if the ring starts within a run, otherwise at begins[k]
    const std::size_t shift = (ends_first ? end_count - 1 : 0) + (joins ? 1 : 0);
    for (std::size_t k = 0; k < end_count; ++k) {
      if (is_plane_)
        add_segment(ends[k], begins[(k + shift) % end_count]);
      else
        next_[ends[k]] = begins[(k + shift) % end_count];
    }
  }

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

  void add_loop(std::size_t first) {
    std::size_t size = 0;
    for (std::size_t e = first; next_[e] != kNone; ++size) {
      loop_[size] = static_cast<std::uint8_t>(e);
      const std::size_t to = next_[e];
      next_[e] = kNone;
      e = to;
    }
    std::size_t start = 0;
    const bool is_coned = size > 3 && !(rules_.is_compact && find_fan(size, start));
    for (std::size_t i = 0; i < size; ++i) add_edge(loop_[(start + i) % size]);
    block_.pieces.push_back({cell_, static_cast<std::uint32_t>(crossed_.size()), is_coned});
    block_.simplices += is_coned ? size : size - 2;
    block_.own += is_coned ? 1 : 0;
  }

  /// Finds a vertex of a loop whose diagonals are in no face of the cell: the contour of a neighbour may have other
  /// diagonals there.
  bool find_fan(std::size_t size, std::size_t& start) const {
    for (start = 0; start < size; ++start) {
      std::size_t i = 2;
      while (i + 1 < size && !shape_->share_a_face(loop_[start], loop_[(start + i) % size])) ++i;
      if (i + 1 == size) return true;
    }
    return false;
  }

  static constexpr std::uint8_t kNone = 255;

  const Polytopes& polytopes_;
  bool is_plane_;  ///< polygons
  std::span<const double> values_;
  const PolytopeRules& rules_;
  PolytopeBlock& block_;
  const PolytopeShape* shape_ = nullptr;  ///< of the current cell
  Index cell_ = 0;
  std::array<double, kPolytopeCorners> at_{};
  std::array<std::uint8_t, kEdges> next_{}, loop_{};  ///< by edge: the following one of its loop
  std::vector<std::array<Index, 2>> crossed_;         ///< of all pieces
};

}  // namespace

std::vector<PolytopeBlock> build_polytope_contours(const Polytopes& polytopes, std::span<const double> values,
                                                   const PolytopeRules& rules, const std::vector<Index>* listed,
                                                   const WorkOptions& work) {
  constexpr std::size_t kCells = 4096;
  const std::size_t count = listed == nullptr ? polytopes.size() : listed->size();
  std::vector<PolytopeBlock> blocks(block_count(count, kCells));
  for_each_item(blocks.size(), work.threads, work.progress, [&](std::size_t b) {
    BlockBuilder builder(polytopes, values, rules, blocks[b]);
    for (std::size_t i = kCells * b; i < std::min(count, kCells * (b + 1)); ++i)
      builder.add(listed == nullptr ? static_cast<Index>(i) : (*listed)[i]);
    builder.finish();
  });
  return blocks;
}

void separate_diagonals(std::vector<PolytopeBlock>& blocks) {
  struct Diagonal {
    std::uint64_t ends;
    std::uint32_t block, piece;
  };
  std::vector<Diagonal> diagonals;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const PolytopeBlock& block = blocks[b];
    std::uint32_t first = 0;
    for (std::size_t p = 0; p < block.pieces.size(); first = block.pieces[p++].end) {
      const auto vertex = [&](std::uint32_t i) { return block.numbers[block.vertices[i]]; };
      if (block.pieces[p].is_coned) continue;
      for (std::uint32_t i = first + 2; i + 1 < block.pieces[p].end; ++i)
        diagonals.push_back(
            {std::uint64_t{std::min(vertex(first), vertex(i))} << 32 | std::max(vertex(first), vertex(i)),
             static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(p)});
    }
  }
  std::sort(diagonals.begin(), diagonals.end(), [](const Diagonal& a, const Diagonal& b) { return a.ends < b.ends; });
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
