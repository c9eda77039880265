// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the table's lists and converts their connected components to the frame of the tile.
#include "tile/cube_subcases.hpp"

#include <algorithm>
#include <stdexcept>

#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {
namespace {

using tables::kTile3Resolved;

constexpr unsigned kCubeEdges = 12;

using Triangles = std::span<const std::uint8_t>;  ///< three vertices each

/// By vertex of a list: set of vertices connected to it by an edge, including itself.
using Neighbours = std::array<std::uint32_t, kCubeEdges + ResolvedCubes::kMostOwn>;

Neighbours neighbours_of(Triangles triangles) {
  Neighbours result{};
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const std::uint8_t* const v = triangles.data() + t;
    for (unsigned i = 0; i < 3; ++i) result[v[i]] |= 1u << v[0] | 1u << v[1] | 1u << v[2];
  }
  return result;
}

/// Set of vertices connected to `vertex`.
std::uint32_t connected(const Neighbours& neighbours, unsigned vertex) {
  std::uint32_t reached = 1u << vertex, before = 0;
  while (reached != before) {
    before = reached;
    for (std::uint32_t rest = before; rest != 0; rest &= rest - 1) reached |= neighbours[std::countr_zero(rest)];
  }
  return reached;
}

/// Whether the cone from this vertex has no simplex in the cube that is not in the list: it is adjacent to all other
/// vertices of its part, and any two adjacent ones of these form a triangle with it.
bool may_be_apex(Triangles triangles, const Neighbours& neighbours, unsigned vertex, std::uint32_t part) {
  if ((part & ~neighbours[vertex]) != 0) return false;
  unsigned around = 0, edges = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    if (std::count(triangles.begin() + static_cast<std::ptrdiff_t>(t),
                   triangles.begin() + static_cast<std::ptrdiff_t>(t + 3), vertex) != 0)
      ++around;
  for (std::uint32_t rest = part & ~(1u << vertex); rest != 0; rest &= rest - 1)
    edges += static_cast<unsigned>(std::popcount(neighbours[std::countr_zero(rest)] & part & ~(1u << vertex))) - 1;
  return edges == 2 * around;  // each edge was counted from both ends
}

}  // namespace

const ResolvedCubes& ResolvedCubes::instance(Triangulation triangulation) {
  if (triangulation == Triangulation::barycentric) {
    static const ResolvedCubes barycentric(Triangulation::barycentric);
    return barycentric;
  }
  static const ResolvedCubes compact(Triangulation::compact);
  return compact;
}

ResolvedCubes::ResolvedCubes(Triangulation triangulation) {
  // signatures of cubes
  for (unsigned tile = 0; tile < 256; ++tile)
    for (unsigned f = 0; f < kCubes; ++f) {
      for (unsigned half = 0; half < 2; ++half) {
        const unsigned corners = tile << (8 * half);
        signatures_[half][tile] |= std::uint64_t{face_signature(4, corners, f)} << (8 * f);
      }
    }
  // squares of cubes
  for (unsigned pair = 0, c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d, ++pair)
      for (unsigned sides = 0; sides < 4; ++sides) {
        // In the cube that omits one of the two axes, the other axis's number is one less if it is the higher one.
        const unsigned f_of_c = 2 * c + (sides & 1u), q_of_c = 2 * (d - 1) + (sides >> 1);
        const unsigned f_of_d = 2 * d + (sides >> 1), q_of_d = 2 * c + (sides & 1u);
        const std::uint64_t bits = std::uint64_t{1} << (8 * f_of_c + q_of_c) | std::uint64_t{1}
                                                                                   << (8 * f_of_d + q_of_d);
        for (unsigned set = 0; set < 16; ++set)
          if ((set >> sides & 1u) != 0) squares_[pair][set] |= bits;
      }
  // lists, frames and parts
  number_lists(triangulation);
  make_frames();
  for (unsigned f = 0; f < kCubes; ++f) {
    for (unsigned i = 0; i < lists_.size(); ++i) {
      const auto first = static_cast<std::uint32_t>(parts_.size());
      make_parts(f, i);
      // In this cube, vertices of one part are not adjacent to those of another part.
      apexes_.push_back(parts_[first].apexes & (parts_.size() - first > 1 ? ~edges_of_[f] : ~std::uint32_t{0}));
      if (f != 0) continue;
      summaries_[i].first_part = first;
      summaries_[i].part_count = static_cast<std::uint8_t>(parts_.size() - first);
      summaries_[i].triangle_count = static_cast<std::uint8_t>(triangles_of(i).size() / 3);
    }
    apexes_.push_back(~std::uint32_t{0});  // for kNone
    if (f == 0) parts_of_cube_ = static_cast<std::uint32_t>(parts_.size());
  }
  summaries_.push_back({});
  parts_.resize(parts_.size() + kMostParts);
  part_vertices_.resize(parts_.size());
  triangles_.resize(triangles_.size() + kWordsBehind);
}

void ResolvedCubes::number_lists(Triangulation triangulation) {
  // properties of entries and signatures
  list_of_.assign(3 * std::size_t{kTile3Resolved.entry_count}, kNone);
  for (unsigned entry = 0; entry < kTile3Resolved.entry_count; ++entry)
    has_choice_.push_back(kTile3Resolved.entries[entry].components > 1 ? 1 : 0);
  for (unsigned s = 0; s < 256; ++s)
    of_signatures_[s] = {kTile3Resolved.first_entry[s], kTile3Resolved.ambiguous_squares[s]};
  // number distinct lists; `high`: each subset of the ambiguous squares
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
          const CubeKey resolved(s, entry - kTile3Resolved.first_entry[s], static_cast<tile::Choice>(choice));
          key_of_.push_back(ambiguous_signatures<3>()[s] ? resolved : CubeKey(s));
          Summary& summary = summaries_.emplace_back();
          summary.is_not_low = high == 0 && choice == 0 ? 0 : 1;
          if (triangulation == Triangulation::compact)
            take_compact(*lists[choice]);
          else
            take_barycentric();
        } else {
          list_of_[3 * entry + choice] = list_of_[3 * entry + same];
        }
      }
      high = (high - ambiguous) & ambiguous;
      if (high == 0) break;
    }
  }
}

/// Copies triangles, masks and summary of the list numbered last from the compact table.
void ResolvedCubes::take_compact(const tables::ResolvedList& list) {
  const std::uint8_t* const first = kTile3Resolved.triangles + 3 * std::size_t{list.first_triangle};
  of_cube_.insert(of_cube_.end(), first, first + 3 * std::size_t{list.triangle_count});
  first_of_cube_.push_back(static_cast<std::uint32_t>(of_cube_.size()));
  auto& masks = masks_.emplace_back();
  for (unsigned j = 0; j < list.own_vertices; ++j) masks[j] = kTile3Resolved.masks[list.first_mask + j];
  summaries_.back().own_vertices = list.own_vertices;
}

/// Takes triangles, masks and summary of the list numbered last from the table of 3D contours.
void ResolvedCubes::take_barycentric() {
  const tables::TileTable& table = variant_table<3>(Triangulation::barycentric).tile;
  const tables::List& list = table.lists[table.list_of[key_of_.back().bits()]];
  const std::uint8_t* const first = table.simplices + 3 * std::size_t{list.first_simplex};
  const std::span<const std::uint8_t> triangles(first, 3 * std::size_t{list.simplex_count});
  of_cube_.insert(of_cube_.end(), triangles.begin(), triangles.end());
  first_of_cube_.push_back(static_cast<std::uint32_t>(of_cube_.size()));
  auto& masks = masks_.emplace_back();
  const unsigned own = unsigned{list.cone_vertices} + list.side_vertices;
  if (own > kMostOwn) throw std::logic_error("a cube with more vertices of its own than tesseracts have numbers for");
  for (unsigned j = 0; j < own; ++j)
    if (j >= list.cone_vertices)
      masks[j] = static_cast<std::uint32_t>(table.side_masks[list.first_side + j - list.cone_vertices]);
  for (std::size_t t = 0; t < triangles.size(); t += 3)  // a barycentre is the first vertex of its triangles
    if (triangles[t] >= kCubeEdges && triangles[t] < kCubeEdges + list.cone_vertices)
      masks[triangles[t] - kCubeEdges] |= 1u << (8 + triangles[t + 1]) | 1u << (8 + triangles[t + 2]);
  summaries_.back().own_vertices = static_cast<std::uint8_t>(own);
  summaries_.back().barycentres = list.cone_vertices;
}

void ResolvedCubes::make_frames() {
  for (unsigned f = 0; f < kCubes; ++f) {
    for (unsigned e = 0; e < kCubeEdges; ++e) {
      const unsigned edge = lifted_edge(4, f, e);
      lifted_[f][e] = static_cast<std::uint8_t>(edge);
      edges_of_[f] |= 1u << edge;
    }
    for (unsigned j = 0; j < kMostOwn; ++j)
      lifted_[f][kCubeEdges + j] = static_cast<std::uint8_t>(kEdges + kMostOwn * f + j);
    // Sign from a tile with one high corner, in the cube: its tetrahedron is (vertex on the edge that leaves the cube,
    // triangle of the cube), and all cubes must orient it equally.
    reversed_[f] = face_sign(f) < 0;
  }
  for (unsigned f = 0; f < kCubes; ++f)
    for (unsigned e = 0; e < kEdges; ++e)
      if ((edges_of_[f] >> e & 1u) != 0)
        beside_[e] |= edges_of_[f] | ((std::uint64_t{1} << kMostOwn) - 1) << (kEdges + kMostOwn * f);
}

void ResolvedCubes::make_parts(unsigned cube, unsigned list) {
  const Triangles triangles = triangles_of(list);
  const Neighbours neighbours = neighbours_of(triangles);
  std::uint32_t done = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    if ((done >> triangles[t] & 1u) != 0) continue;
    const std::uint32_t vertices = connected(neighbours, triangles[t]);
    done |= vertices;
    Part part{~std::uint32_t{0}, static_cast<std::uint32_t>(triangles_.size()), 0, static_cast<std::uint8_t>(cube)};
    std::uint64_t& in_tile = part_vertices_.emplace_back(0);
    for (std::uint32_t rest = vertices; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      in_tile |= std::uint64_t{1} << lifted(cube, v);
      if (v < kCubeEdges && !may_be_apex(triangles, neighbours, v, vertices)) part.apexes &= ~(1u << lifted(cube, v));
    }
    for (std::size_t u = t; u < triangles.size(); u += 3) {
      const std::uint8_t* const v = triangles.data() + u;
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

unsigned list_of_key(CubeKey cube) noexcept {
  if (cube.signature() == 0 || cube.signature() == 255) return ResolvedCubes::kNone;
  unsigned squares = 0;
  unsigned bit = 0;
  for (unsigned rest = kTile3Resolved.ambiguous_squares[cube.signature()]; rest != 0; rest &= rest - 1, ++bit)
    if ((cube.resolution() >> bit & 1u) != 0) squares |= rest & (~rest + 1);
  return ResolvedCubes::instance().list(cube.signature(), squares, cube.choice());
}

}  // namespace tegl::detail
