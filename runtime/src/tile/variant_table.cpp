// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the tables of resolved squares and cubes (see variant_table.hpp).
#include "tile/variant_table.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include "tegl/generated/tables.hpp"

namespace tegl::detail {
namespace {

/// Triangles of three local vertices each; own vertices by mask (tables::ResolvedList).
struct Polygons {
  static constexpr unsigned kFirstOwn = tables::first_tile_vertex(3);
  std::vector<std::uint8_t> triangles;
  unsigned cones = 0;  ///< number of own vertices that are barycentres; they come first
  std::vector<std::uint64_t> masks;

  explicit Polygons(const tables::ResolvedList& list) {
    const auto& table = tables::kTile3Resolved;
    const std::uint8_t* const first = table.triangles + std::size_t{list.first_triangle} * 3;
    triangles.assign(first, first + std::size_t{list.triangle_count} * 3);
    masks.assign(table.masks + list.first_mask, table.masks + list.first_mask + list.own_vertices);
  }
};

/// The triangles of each connected component.
std::vector<std::vector<std::uint8_t>> parts_of(const std::vector<std::uint8_t>& triangles) {
  std::array<std::uint8_t, 256> part{};
  for (unsigned v = 0; v < part.size(); ++v) part[v] = static_cast<std::uint8_t>(v);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const std::uint8_t least = std::min({part[triangles[t]], part[triangles[t + 1]], part[triangles[t + 2]]});
      for (std::size_t j = t; j < t + 3; ++j) {
        changed = changed || part[triangles[j]] != least;
        part[triangles[j]] = least;
      }
    }
  }
  std::map<std::uint8_t, std::vector<std::uint8_t>> parts;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    parts[part[triangles[t]]].insert(parts[part[triangles[t]]].end(), &triangles[t], &triangles[t] + 3);
  std::vector<std::vector<std::uint8_t>> result;
  for (auto& [least, of_part] : parts) result.push_back(std::move(of_part));
  return result;
}

/// The directed boundary edges of a connected component; empty unless it is a disc.
std::vector<std::pair<std::uint8_t, std::uint8_t>> outline(const std::vector<std::uint8_t>& triangles) {
  std::set<std::uint8_t> vertices(triangles.begin(), triangles.end());
  std::set<std::pair<std::uint8_t, std::uint8_t>> directed;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    for (std::size_t j = 0; j < 3; ++j) directed.emplace(triangles[t + j], triangles[t + (j + 1) % 3]);
  std::vector<std::pair<std::uint8_t, std::uint8_t>> around;
  for (const auto& [from, to] : directed)
    if (!directed.contains({to, from})) around.emplace_back(from, to);
  const auto edges = (directed.size() + around.size()) / 2;
  const auto euler = static_cast<long>(vertices.size() + triangles.size() / 3) - static_cast<long>(edges);
  if (euler != 1) around.clear();
  return around;
}

/// Cones every disc with more than one triangle from its barycentre. Other components are kept.
void cone_discs(Polygons& polygons) {
  // cone discs
  std::vector<std::vector<std::uint8_t>> kept;
  std::vector<std::uint8_t> triangles;
  for (std::vector<std::uint8_t>& part : parts_of(polygons.triangles)) {
    const auto around = outline(part);
    if (around.empty()) {
      kept.push_back(std::move(part));
    } else if (around.size() == 3) {
      triangles.insert(triangles.end(), part.begin(), part.end());
    } else {
      const auto apex = static_cast<std::uint8_t>(Polygons::kFirstOwn + polygons.cones++);
      for (const auto& [from, to] : around) triangles.insert(triangles.end(), {apex, from, to});
    }
  }
  // renumber the own vertices of the others
  std::vector<std::uint64_t> masks;
  std::map<std::uint8_t, std::uint8_t> number;
  for (const std::vector<std::uint8_t>& part : kept)
    for (const std::uint8_t v : part) {
      if (v >= Polygons::kFirstOwn && number.try_emplace(v, Polygons::kFirstOwn + polygons.cones + masks.size()).second)
        masks.push_back(polygons.masks[v - Polygons::kFirstOwn]);
      triangles.push_back(v < Polygons::kFirstOwn ? v : number.at(v));
    }
  polygons.triangles = std::move(triangles);
  polygons.masks = std::move(masks);
}

}  // namespace

template <int N>
VariantTable<N>::VariantTable(Triangulation triangulation) : list_of_(kKeys<N>) {
  const tables::TileTable& plain = tables::tile_table(N, triangulation);
  for (unsigned s = 0; s < 1u << (1u << N); ++s) add_plain(s, plain, s, false);
  add_variants(triangulation);
  finish();
}

template <int N>
void VariantTable<N>::add(unsigned key, const std::vector<std::uint8_t>& simplices, unsigned cones,
                          const std::vector<std::uint64_t>& masks) {
  list_of_[key] = static_cast<std::uint16_t>(lists_.size());
  lists_.push_back({static_cast<std::uint32_t>(simplices_.size() / N), static_cast<std::uint16_t>(simplices.size() / N),
                    static_cast<std::uint8_t>(cones), static_cast<std::uint8_t>(masks.size()),
                    static_cast<std::uint32_t>(masks_.size())});
  simplices_.insert(simplices_.end(), simplices.begin(), simplices.end());
  masks_.insert(masks_.end(), masks.begin(), masks.end());
}

template <int N>
void VariantTable<N>::add_plain(unsigned key, const tables::TileTable& from, unsigned signature, bool reversed) {
  const tables::List& list = from.lists[from.list_of[signature]];
  const std::uint8_t* const first = from.simplices + std::size_t{list.first_simplex} * N;
  std::vector<std::uint8_t> simplices(first, first + std::size_t{list.simplex_count} * N);
  for (std::size_t q = 0; reversed && q < simplices.size(); q += N)
    std::swap(simplices[q + N - 2], simplices[q + N - 1]);
  const std::uint64_t* const masks = from.side_masks + list.first_side;
  add(key, simplices, list.cone_vertices, {masks, masks + list.side_vertices});
}

/// The high-connected square is the low-connected one of the complement, reversed (table contract).
template <>
void VariantTable<2>::add_variants(Triangulation triangulation) {
  for (unsigned s = 0; s < 16; ++s)
    if (ambiguous_signatures<2>()[s]) add_plain(s | 16, tables::tile_table(2, triangulation), ~s & 15, true);
}

template <>
void VariantTable<3>::add_variants(Triangulation triangulation) {
  const auto& table = tables::kTile3Resolved;
  for (unsigned s = 0; s < 256; ++s) {
    if (!ambiguous_signatures<3>()[s]) continue;
    const unsigned resolutions = 1u << std::popcount(unsigned{table.ambiguous_squares[s]});
    for (unsigned r = 0; r < resolutions; ++r) {
      const tables::ResolvedEntry& entry = table.entries[table.first_entry[s] + r];
      const std::array<const tables::ResolvedList*, 3> lists = {&entry.separate, &entry.low, &entry.high};
      for (unsigned choice = 0; choice < lists.size(); ++choice) {
        Polygons polygons(*lists[choice]);
        if (triangulation == Triangulation::barycentric) cone_discs(polygons);
        const CubeKey key(s, r, static_cast<tile::Choice>(choice));
        add(key.bits(), polygons.triangles, polygons.cones, polygons.masks);
      }
    }
  }
}

template <int N>
void VariantTable<N>::finish() {
  tile_.version = tables::kContractVersion;
  tile_.dim = N;
  tile_.list_count = static_cast<std::uint32_t>(lists_.size());
  tile_.simplex_count = static_cast<std::uint32_t>(simplices_.size() / N);
  for (const tables::List& list : lists_) {
    tile_.max_simplices = std::max(tile_.max_simplices, std::uint32_t{list.simplex_count});
    tile_.max_tile_vertices = std::max(tile_.max_tile_vertices, std::uint32_t{list.cone_vertices} + list.side_vertices);
  }
  tile_.list_of = list_of_.data();
  tile_.lists = lists_.data();
  tile_.simplices = simplices_.data();
  tile_.side_masks = masks_.data();
  make_rows();
}

template <>
void VariantTable<2>::make_rows() {
  rows_.emplace_back(tile_, kKeys<2>);
}

template <>
void VariantTable<3>::make_rows() {
  const auto& table = tables::kTile3Resolved;
  std::array<unsigned, 256> counts{};
  std::vector<Variant> variants(4 * std::size_t{table.entry_count});
  for (unsigned s = 0; s < counts.size(); ++s) {
    const unsigned resolutions = 1u << std::popcount(unsigned{table.ambiguous_squares[s]});
    counts[s] = ambiguous_signatures<3>()[s] ? 1 + 3 * resolutions : 1;
    if (counts[s] == 1) continue;
    const tables::List& plain = lists_[list_of_[s]];
    for (unsigned r = 0; r < resolutions; ++r) {
      const unsigned entry = table.first_entry[s] + r;
      for (unsigned choice = 0; choice < 3; ++choice) {
        const unsigned chosen = table.entries[entry].components > 1 ? choice : 0;
        const CubeKey key(s, r, static_cast<tile::Choice>(chosen));
        const tables::List& list = lists_[list_of_[key.bits()]];
        variants[4 * entry + choice] = {key.bits(), static_cast<std::int8_t>(list.simplex_count - plain.simplex_count),
                                        static_cast<std::int8_t>(list.cone_vertices + list.side_vertices -
                                                                 plain.cone_vertices - plain.side_vertices)};
      }
    }
  }
  rows_.emplace_back(tile_, counts, std::move(variants));
}

template <int N>
const VariantTable<N>& variant_table(Triangulation triangulation) {
  if (triangulation == Triangulation::barycentric) {
    static const VariantTable<N> barycentric(Triangulation::barycentric);
    return barycentric;
  }
  static const VariantTable<N> compact(Triangulation::compact);
  return compact;
}

template <>
const std::array<bool, 16>& ambiguous_signatures<2>() noexcept {
  static constexpr auto kAmbiguous = [] {
    std::array<bool, 16> result{};
    result[0b0110] = result[0b1001] = true;
    return result;
  }();
  return kAmbiguous;
}

template <>
const std::array<bool, 256>& ambiguous_signatures<3>() noexcept {
  static const auto kAmbiguous = [] {
    const auto& table = tables::kTile3Resolved;
    std::array<bool, 256> result{};
    for (unsigned s = 0; s < 256; ++s)
      result[s] = table.ambiguous_squares[s] != 0 || table.entries[table.first_entry[s]].components > 1;
    return result;
  }();
  return kAmbiguous;
}

template class VariantTable<2>;
template class VariantTable<3>;
template const VariantTable<2>& variant_table<2>(Triangulation);
template const VariantTable<3>& variant_table<3>(Triangulation);

}  // namespace tegl::detail
