// SPDX-License-Identifier: BSD-3-Clause
//
// The table's lists, numbered, and their parts in the frame of the tile.
#include "resolved_cubes.hpp"

#include <algorithm>

#include "corners.hpp"

namespace tegl::detail {
namespace {

using tables::kTile3Resolved;

constexpr unsigned kCubeEdges = 12;

/// The vertices of the triangles of a list.
const std::uint8_t* triangle(const tables::ResolvedList& list, unsigned t) {
  return kTile3Resolved.triangles + 3 * (std::size_t{list.first_triangle} + t);
}

/// Sets of a list's vertices that are joined by an edge, by vertex, itself among them.
using Neighbours = std::array<std::uint32_t, kCubeEdges + ResolvedCubes::kMostOwn>;

Neighbours neighbours_of(const tables::ResolvedList& list) {
  Neighbours result{};
  for (unsigned t = 0; t < list.triangle_count; ++t) {
    const std::uint8_t* const v = triangle(list, t);
    for (unsigned i = 0; i < 3; ++i) result[v[i]] |= 1u << v[0] | 1u << v[1] | 1u << v[2];
  }
  return result;
}

/// The set of vertices connected with `vertex`.
std::uint32_t connected(const Neighbours& neighbours, unsigned vertex) {
  std::uint32_t reached = 1u << vertex, before = 0;
  while (reached != before) {
    before = reached;
    for (std::uint32_t rest = before; rest != 0; rest &= rest - 1) reached |= neighbours[std::countr_zero(rest)];
  }
  return reached;
}

/// Whether a cone from this vertex has no simplex in the cube that is not the list's: it is joined with all vertices of
/// its part, and any three that are joined one with another, it among them, are a triangle.
bool may_be_apex(const tables::ResolvedList& list, const Neighbours& neighbours, unsigned vertex, std::uint32_t part) {
  if ((part & ~neighbours[vertex]) != 0) return false;
  unsigned around = 0, edges = 0;
  for (unsigned t = 0; t < list.triangle_count; ++t) {
    const std::uint8_t* const v = triangle(list, t);
    if (v[0] == vertex || v[1] == vertex || v[2] == vertex) ++around;
  }
  for (std::uint32_t rest = part & ~(1u << vertex); rest != 0; rest &= rest - 1)
    edges += static_cast<unsigned>(std::popcount(neighbours[std::countr_zero(rest)] & part & ~(1u << vertex))) - 1;
  return edges == 2 * around;  // each edge was counted from both ends
}

}  // namespace

std::array<double, 3> cube_vertex_place(const tables::ResolvedList& list, unsigned vertex) {
  std::array<double, 3> place{};
  const auto middle_of_edge = [](unsigned e, std::array<double, 3>& to) {
    const unsigned base = edge_base(3, e);
    for (unsigned a = 0; a < 3; ++a) to[a] += a == e / 4 ? 0.5 : static_cast<double>(base >> a & 1u);
  };
  if (vertex < kCubeEdges) {
    middle_of_edge(vertex, place);
    return place;
  }
  const std::uint32_t mask = kTile3Resolved.masks[list.first_mask + vertex - kCubeEdges];
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(rest));
    if (bit >= 8)
      middle_of_edge(bit - 8, place);
    else
      for (unsigned a = 0; a < 3; ++a) place[a] += static_cast<double>(bit >> a & 1u);
  }
  for (double& x : place) x /= std::popcount(mask);
  if ((mask & 0xffu) != 0)
    for (double& x : place) x = 0.5 * (0.5 + x);
  return place;
}

const ResolvedCubes& ResolvedCubes::instance() {
  static const ResolvedCubes cubes;
  return cubes;
}

ResolvedCubes::ResolvedCubes() {
  for (unsigned tile = 0; tile < 256; ++tile)
    for (unsigned f = 0; f < kCubes; ++f) {
      for (unsigned half = 0; half < 2; ++half) {
        const unsigned corners = tile << (8 * half);
        signatures_[half][tile] |= std::uint64_t{squeezed_corners<4>(corners >> (f % 2 << f / 2), f / 2)} << (8 * f);
      }
    }
  for (unsigned pair = 0, c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d, ++pair)
      for (unsigned sides = 0; sides < 4; ++sides) {
        // In the cube that leaves out one of the axes the other one's number is less by one if it is higher.
        const unsigned f_of_c = 2 * c + (sides & 1u), q_of_c = 2 * (d - 1) + (sides >> 1);
        const unsigned f_of_d = 2 * d + (sides >> 1), q_of_d = 2 * c + (sides & 1u);
        const std::uint64_t bits = std::uint64_t{1} << (8 * f_of_c + q_of_c) | std::uint64_t{1}
                                                                                   << (8 * f_of_d + q_of_d);
        for (unsigned set = 0; set < 16; ++set)
          if ((set >> sides & 1u) != 0) squares_[pair][set] |= bits;
      }
  for (unsigned ambiguous = 0; ambiguous < 64; ++ambiguous)
    for (unsigned high = 0; high < 64; ++high) {
      unsigned result = 0, at = 0;
      for (unsigned q = 0; q < 6; ++q)
        if ((ambiguous >> q & 1u) != 0) result |= (high >> q & 1u) << at++;
      compressed_[ambiguous << 6 | high] = static_cast<std::uint8_t>(result);
    }
  number_lists();
  make_frames();
  for (unsigned f = 0; f < kCubes; ++f) {
    for (std::size_t i = 0; i < lists_.size(); ++i) {
      const auto first = static_cast<std::uint32_t>(parts_.size());
      make_parts(f, lists_[i]);
      // Points of one part are not joined with those of another one in the cube.
      apexes_.push_back(parts_[first].apexes & (parts_.size() - first > 1 ? ~edges_of_[f] : ~std::uint32_t{0}));
      if (f != 0) continue;
      summaries_[i].first_part = first;
      summaries_[i].part_count = static_cast<std::uint8_t>(parts_.size() - first);
      summaries_[i].triangle_count = static_cast<std::uint8_t>(lists_[i].list->triangle_count);
    }
    apexes_.push_back(~std::uint32_t{0});  // of kNone
    if (f == 0) parts_of_cube_ = static_cast<std::uint32_t>(parts_.size());
  }
  summaries_.push_back({});
  parts_.resize(parts_.size() + kMostParts);
  part_vertices_.resize(parts_.size());
  triangles_.resize(triangles_.size() + kWordsBehind);
}

void ResolvedCubes::number_lists() {
  list_of_.assign(3 * std::size_t{kTile3Resolved.entry_count}, kNone);
  for (unsigned entry = 0; entry < kTile3Resolved.entry_count; ++entry)
    has_choice_.push_back(kTile3Resolved.entries[entry].components > 1 ? 1 : 0);
  for (unsigned s = 0; s < 256; ++s)
    of_signatures_[s] = {kTile3Resolved.first_entry[s], kTile3Resolved.ambiguous_squares[s]};
  for (unsigned s = 1; s < 255; ++s) {
    const unsigned ambiguous = kTile3Resolved.ambiguous_squares[s];
    for (unsigned high = 0, entry = kTile3Resolved.first_entry[s];; ++entry) {
      const tables::ResolvedEntry& of = kTile3Resolved.entries[entry];
      const std::array<const tables::ResolvedList*, 3> lists = {&of.separate, &of.low, &of.high};
      for (unsigned choice = 0; choice < 3; ++choice) {
        unsigned same = 0;
        while (lists[same]->first_triangle != lists[choice]->first_triangle) ++same;
        if (same == choice) {
          list_of_[3 * entry + choice] = static_cast<std::uint16_t>(lists_.size());
          lists_.push_back({lists[choice], static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(high)});
          const unsigned variant = 1 + 3 * (entry - kTile3Resolved.first_entry[s]) + choice;
          key_of_.push_back(static_cast<std::uint16_t>(s | variant << 8));
          Summary& summary = summaries_.emplace_back();
          summary.is_not_low = high == 0 && choice == 0 ? 0 : 1;
          summary.own_vertices = static_cast<std::uint8_t>(lists[choice]->own_vertices);
        } else {
          list_of_[3 * entry + choice] = list_of_[3 * entry + same];
        }
      }
      high = (high - ambiguous) & ambiguous;
      if (high == 0) break;
    }
  }
}

void ResolvedCubes::make_frames() {
  for (unsigned f = 0; f < kCubes; ++f) {
    for (unsigned e = 0; e < kCubeEdges; ++e) {
      const unsigned axis = e / 4 < f / 2 ? e / 4 : e / 4 + 1;
      const unsigned edge = axis << 3 | squeeze(lifted_corner(f, edge_base(3, e)), axis);
      lifted_[f][e] = static_cast<std::uint8_t>(edge);
      edges_of_[f] |= 1u << edge;
    }
    for (unsigned j = 0; j < kMostOwn; ++j)
      lifted_[f][kCubeEdges + j] = static_cast<std::uint8_t>(kEdges + kMostOwn * f + j);
    // The corner that axis f / 2 leaves at f % 2: over all cubes alike, (point on the edge out of the cube, triangle)
    // is the tetrahedron that cuts it off.
    reversed_[f] = (f / 2 + f % 2) % 2 == 0;
  }
  for (unsigned f = 0; f < kCubes; ++f)
    for (unsigned e = 0; e < kEdges; ++e)
      if ((edges_of_[f] >> e & 1u) != 0)
        beside_[e] |= edges_of_[f] | ((std::uint64_t{1} << kMostOwn) - 1) << (kEdges + kMostOwn * f);
}

void ResolvedCubes::make_parts(unsigned cube, const CubeList& of) {
  const tables::ResolvedList& list = *of.list;
  const Neighbours neighbours = neighbours_of(list);
  std::uint32_t done = 0;
  for (unsigned t = 0; t < list.triangle_count; ++t) {
    if ((done >> triangle(list, t)[0] & 1u) != 0) continue;
    const std::uint32_t vertices = connected(neighbours, triangle(list, t)[0]);
    done |= vertices;
    Part part{~std::uint32_t{0}, static_cast<std::uint32_t>(triangles_.size()), 0, static_cast<std::uint8_t>(cube)};
    std::uint64_t& in_tile = part_vertices_.emplace_back(0);
    for (std::uint32_t rest = vertices; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      in_tile |= std::uint64_t{1} << lifted(cube, v);
      if (v < kCubeEdges && !may_be_apex(list, neighbours, v, vertices)) part.apexes &= ~(1u << lifted(cube, v));
    }
    for (unsigned u = t; u < list.triangle_count; ++u) {
      const std::uint8_t* const v = triangle(list, u);
      if ((vertices >> v[0] & 1u) == 0) continue;
      std::array<std::uint8_t, 4> word = {0, 0, 0, 0};
      for (unsigned i = 0; i < 3; ++i) word[1 + i] = static_cast<std::uint8_t>(lifted(cube, v[i]));
      if (is_reversed(cube)) std::swap(word[2], word[3]);
      triangles_.push_back(std::bit_cast<std::uint32_t>(word));
      ++part.triangle_count;
    }
    parts_.push_back(part);
  }
}

}  // namespace tegl::detail
