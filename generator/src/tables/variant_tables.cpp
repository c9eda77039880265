// SPDX-License-Identifier: BSD-3-Clause
//
// Derives row tables and the tables of resolved squares and cubes.
#include "tables/variant_tables.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "cubes/ambiguity.hpp"
#include "cubes/cube_certificate.hpp"
#include "cubes/cube_frame.hpp"
#include "tegl/tile/choices.hpp"
#include "tegl/tile/complex.hpp"

namespace tegl::gen {

namespace {

using tables::RowTable;

constexpr unsigned kCubeVariants = 1 + 3 * 64;  ///< most variants of a signature

/// Triangles of three local vertices each; own vertices by mask (tables::ResolvedList).
struct Polygons {
  static constexpr unsigned kFirstOwn = tables::first_tile_vertex(3);
  std::vector<std::uint8_t> triangles;
  unsigned cones = 0;                ///< number of own vertices that are barycentres; they come first
  std::vector<std::uint64_t> masks;  ///< of the other own vertices

  Polygons(const ResolvedCube& cube, const tables::ResolvedList& list) {
    const auto first = cube.triangles.begin() + 3 * std::ptrdiff_t{list.first_triangle};
    triangles.assign(first, first + 3 * std::ptrdiff_t{list.triangle_count});
    const auto mask = cube.masks.begin() + list.first_mask;
    masks.assign(mask, mask + list.own_vertices);
  }

  [[nodiscard]] CubeTriangles as_triangles() const {
    CubeTriangles result;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
      result.push_back({triangles[t], triangles[t + 1], triangles[t + 2]});
    return result;
  }
  /// Masks of all own vertices. That of a barycentre has the edges of its triangles.
  [[nodiscard]] std::vector<std::uint32_t> all_masks() const {
    std::vector<std::uint32_t> result(cones);
    for (const CubeTriangle& t : as_triangles())
      if (t[0] >= kFirstOwn && t[0] < kFirstOwn + cones)
        result[t[0] - kFirstOwn] |= 1u << (8 + t[1]) | 1u << (8 + t[2]);
    for (const std::uint64_t mask : masks) result.push_back(static_cast<std::uint32_t>(mask));
    return result;
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
    for (std::size_t j = t; j < t + 3; ++j) parts[part[triangles[t]]].push_back(triangles[j]);
  std::vector<std::vector<std::uint8_t>> result;
  for (auto& [least, of_part] : parts) result.push_back(std::move(of_part));
  return result;
}

tile::Simplices simplices_of(const std::vector<std::uint8_t>& triangles) {
  tile::Simplices result;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    tile::Simplex& simplex = result.emplace_back(tile::kNoSimplex);
    for (std::size_t j = 0; j < 3; ++j) simplex[j] = triangles[t + j];
    tile::sort_vertices(simplex);
  }
  return result;
}

using DirectedEdges = std::vector<std::pair<std::uint8_t, std::uint8_t>>;

/// The directed edges of triangles whose reverses do not occur.
DirectedEdges boundary_of(const std::vector<std::uint8_t>& triangles) {
  std::set<std::pair<std::uint8_t, std::uint8_t>> directed;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    for (std::size_t j = 0; j < 3; ++j) directed.emplace(triangles[t + j], triangles[t + (j + 1) % 3]);
  DirectedEdges around;
  for (const auto& [from, to] : directed)
    if (!directed.contains({to, from})) around.emplace_back(from, to);
  return around;
}

/// Cones every disc with more than one triangle from its barycentre. Other components are kept, and discs with own
/// vertices on rays.
void cone_discs(Polygons& polygons) {
  const DirectedEdges before = boundary_of(polygons.triangles);
  // cone discs
  std::vector<std::vector<std::uint8_t>> kept;
  std::vector<std::uint8_t> triangles;
  for (std::vector<std::uint8_t>& part : parts_of(polygons.triangles)) {
    const bool has_ray = std::any_of(part.begin(), part.end(), [&](std::uint8_t v) {
      return v >= Polygons::kFirstOwn && is_on_ray(static_cast<std::uint32_t>(polygons.masks[v - Polygons::kFirstOwn]));
    });
    if (has_ray || tile::shape_of(simplices_of(part)) != tile::Shape::ball) {
      kept.push_back(std::move(part));
      continue;
    }
    const DirectedEdges around = boundary_of(part);
    if (around.size() == 3) {
      triangles.insert(triangles.end(), part.begin(), part.end());
      continue;
    }
    const auto apex = static_cast<std::uint8_t>(Polygons::kFirstOwn + polygons.cones++);
    std::vector<std::uint8_t> cone;
    for (const auto& [from, to] : around) cone.insert(cone.end(), {apex, from, to});
    if (tile::shape_of(simplices_of(cone)) != tile::Shape::ball)
      throw Error(ErrorCode::CertificateFailed, "a cone over a polygon of a cube is no disc");
    triangles.insert(triangles.end(), cone.begin(), cone.end());
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
  if (boundary_of(triangles) != before)
    throw Error(ErrorCode::CertificateFailed, "coned polygons of a cube with another boundary");
  polygons.triangles = std::move(triangles);
  polygons.masks = std::move(masks);
}

std::uint32_t make_entry(const tables::List& list) {
  const bool own = list.cone_vertices != 0 || list.side_vertices != 0;
  return list.first_simplex << RowTable::kFirstShift | (own ? RowTable::kOwnFlag : 0) | list.simplex_count;
}

void count_simplices(int dim, RowTables& rows) {
  if (dim > 3) return;
  rows.counts.resize(256);
  for (std::size_t s = 0; s < std::min(rows.entries.size(), rows.counts.size()); ++s)
    rows.counts[s] = static_cast<std::uint8_t>(rows.entries[s] & RowTable::kCountMask);
}

/// Byte shuffles of a square's segments, in both orientations.
void add_shuffles(const TileTables& table, RowTables& rows) {
  constexpr std::size_t kKeys = 32, kBytes = 16;
  rows.shuffles.resize(2 * kKeys * kBytes);
  for (std::size_t s = 0; s < rows.entries.size(); ++s)
    for (std::size_t v = 0; v < 2 * std::size_t{rows.entries[s] & RowTable::kCountMask}; ++v) {
      const unsigned edge = table.simplices[2 * std::size_t{rows.entries[s] >> RowTable::kFirstShift} + v];
      for (std::size_t byte = 0; byte < 4; ++byte) {
        const auto value = static_cast<std::uint8_t>(4 * edge + byte);
        rows.shuffles[kBytes * s + 4 * v + byte] = value;
        rows.shuffles[kBytes * (kKeys + s) + 4 * (v ^ 1) + byte] = value;
      }
    }
}

void require_rows(const TileTables& table) {
  if (!has_row_tables(table))
    throw Error(ErrorCode::Internal, fmt::format("the {}-tile's lists do not fit in row entries", table.dim));
}

/// Collects the lists of keys.
class VariantMaker {
 public:
  VariantMaker(const TileTables& plain, std::size_t keys) : plain_(plain) {
    TileTables& tile = result_.tile;
    tile.dim = plain.dim;
    tile.triangulation = plain.triangulation;
    tile.layout = Layout::flat;
    tile.first_tile_vertex = plain.first_tile_vertex;
    tile.list_of.resize(keys);
  }

  void add(unsigned key, const std::vector<std::uint8_t>& simplices, unsigned cones,
           const std::vector<std::uint64_t>& masks) {
    TileTables& tile = result_.tile;
    const auto n = static_cast<std::size_t>(tile.dim);
    tile.list_of[key] = static_cast<std::uint16_t>(tile.lists.size());
    tile.lists.push_back({static_cast<std::uint32_t>(tile.simplices.size() / n),
                          static_cast<std::uint16_t>(simplices.size() / n), static_cast<std::uint8_t>(cones),
                          static_cast<std::uint8_t>(masks.size()), static_cast<std::uint32_t>(tile.side_masks.size())});
    tile.simplices.insert(tile.simplices.end(), simplices.begin(), simplices.end());
    tile.side_masks.insert(tile.side_masks.end(), masks.begin(), masks.end());
  }

  /// Adds the plain list of a signature, if `reversed` with the opposite orientation.
  void add_plain(unsigned key, unsigned signature, bool reversed) {
    const auto n = static_cast<std::ptrdiff_t>(plain_.dim);
    const tables::List& list = plain_.lists[plain_.list_of[signature]];
    const auto first = plain_.simplices.begin() + std::ptrdiff_t{list.first_simplex} * n;
    std::vector<std::uint8_t> simplices(first, first + std::ptrdiff_t{list.simplex_count} * n);
    for (auto at = simplices.begin(); reversed && at != simplices.end(); at += n)
      std::iter_swap(at + n - 2, at + n - 1);
    const auto mask = plain_.side_masks.begin() + std::ptrdiff_t{list.first_side};
    add(key, simplices, list.cone_vertices, {mask, mask + list.side_vertices});
  }

  [[nodiscard]] const tables::List& list(unsigned key) const { return result_.tile.lists[result_.tile.list_of[key]]; }

  VariantTables finish() {
    TileTables& tile = result_.tile;
    for (const tables::List& list : tile.lists) {
      tile.max_simplices = std::max(tile.max_simplices, std::uint32_t{list.simplex_count});
      tile.max_tile_vertices = std::max(tile.max_tile_vertices, std::uint32_t{list.cone_vertices} + list.side_vertices);
      tile.total_simplices += list.simplex_count;
    }
    require_rows(tile);
    result_.rows.more_keys = true;
    return std::move(result_);
  }

  RowTables& rows() { return result_.rows; }

 private:
  const TileTables& plain_;
  VariantTables result_;
};

/// The key of a cube (tables::VariantTable).
unsigned key_of(unsigned signature, unsigned resolution, unsigned choice) {
  return signature | (1 + 3 * resolution + choice) << 8;
}

/// Entries of all keys without gaps, and the variants of the entries of the resolved cube.
void add_cube_rows(const ResolvedCube& cube, const std::vector<bool>& ambiguous, VariantMaker& maker) {
  RowTables& rows = maker.rows();
  // Unresolved signatures come first, so that a signature is its own index as in other tables.
  for (unsigned s = 0; s < 256; ++s) rows.entries.push_back(make_entry(maker.list(s)));
  rows.variants.resize(4 * cube.entries.size());
  for (unsigned s = 0; s < 256; ++s) {
    rows.variant_places.push_back(static_cast<std::uint16_t>(ambiguous[s] ? rows.entries.size() : s));
    if (!ambiguous[s]) continue;
    const unsigned resolutions = 1u << std::popcount(unsigned{cube.ambiguous[s]});
    for (unsigned variant = 0; variant < 1 + 3 * resolutions; ++variant)
      rows.entries.push_back(make_entry(maker.list(s | variant << 8)));
    const tables::List& plain = maker.list(s);
    for (unsigned r = 0; r < resolutions; ++r)
      for (unsigned choice = 0; choice < 3; ++choice) {
        const unsigned entry = cube.first_entry[s] + r;
        const unsigned key = key_of(s, r, cube.entries[entry].components > 1 ? choice : 0);
        const tables::List& list = maker.list(key);
        rows.variants[std::size_t{4} * entry + choice] = {
            static_cast<std::uint16_t>(key), static_cast<std::int8_t>(list.simplex_count - plain.simplex_count),
            static_cast<std::int8_t>(list.cone_vertices + list.side_vertices - plain.cone_vertices -
                                     plain.side_vertices)};
      }
  }
  count_simplices(3, rows);
}

}  // namespace

bool has_row_tables(const TileTables& table) {
  return table.layout == Layout::flat && table.max_simplices <= RowTable::kCountMask &&
         table.simplices.size() / static_cast<std::size_t>(table.dim) < (1u << (32 - RowTable::kFirstShift));
}

RowTables make_row_tables(const TileTables& table) {
  require_rows(table);
  RowTables rows;
  for (const std::uint16_t list : table.list_of) rows.entries.push_back(make_entry(table.lists[list]));
  count_simplices(table.dim, rows);
  if (table.dim == 2) add_shuffles(table, rows);
  return rows;
}

RowTables make_estimated_rows(const TileTables& table, const std::vector<bool>& is_estimated) {
  RowTables rows = make_row_tables(table);
  for (std::size_t s = 0; s < rows.entries.size(); ++s)
    if (is_estimated[s]) rows.entries[s] |= RowTable::kOwnFlag;
  return rows;
}

VariantTables make_square_variants(const TileTables& plain) {
  VariantMaker maker(plain, 32);
  for (unsigned s = 0; s < 16; ++s) maker.add_plain(s, s, false);
  for (const unsigned s : {0b0110u, 0b1001u}) maker.add_plain(s | 16, ~s & 15u, true);
  VariantTables result = maker.finish();
  result.rows = make_row_tables(result.tile);
  result.rows.more_keys = true;
  return result;
}

VariantTables make_cube_variants(const TileTables& plain, const ResolvedCube& cube) {
  const std::vector<bool> ambiguous = ambiguous_cubes(cube);
  VariantMaker maker(plain, std::size_t{256} * kCubeVariants);
  CubeListCertifier certifier;
  for (unsigned s = 0; s < 256; ++s) {
    if (ambiguous[s] || plain.triangulation == Triangulation::barycentric) {
      maker.add_plain(s, s, false);
    } else {
      const Polygons polygons(cube, cube.entries[cube.first_entry[s]].separate);
      maker.add(s, polygons.triangles, polygons.cones, polygons.masks);
    }
  }
  for (unsigned s = 0; s < 256; ++s) {
    if (!ambiguous[s]) continue;
    const unsigned resolutions = 1u << std::popcount(unsigned{cube.ambiguous[s]});
    for (unsigned r = 0; r < resolutions; ++r) {
      const tables::ResolvedEntry& entry = cube.entries[cube.first_entry[s] + r];
      const std::array<const tables::ResolvedList*, 3> lists = {&entry.separate, &entry.low, &entry.high};
      for (unsigned choice = 0; choice < lists.size(); ++choice) {
        Polygons polygons(cube, *lists[choice]);
        if (plain.triangulation == Triangulation::barycentric) cone_discs(polygons);
        certifier.certify(polygons.as_triangles(), polygons.all_masks(),
                          fmt::format("cube of signature {}, resolution {}, choice {}, {}", s, r, choice,
                                      triangulation_name(plain.triangulation)));
        maker.add(key_of(s, r, choice), polygons.triangles, polygons.cones, polygons.masks);
      }
    }
  }
  add_cube_rows(cube, ambiguous, maker);
  VariantTables result = maker.finish();
  result.embedded = certifier.proved();
  return result;
}

std::uint64_t digest(const RowTables& table) {
  Fnv fnv;
  fnv.add(table.entries);
  fnv.add(table.counts);
  fnv.add(table.shuffles);
  fnv.add(table.variant_places);
  for (const tables::Variant& variant : table.variants) {
    fnv.add(variant.key);
    fnv.add(variant.more_simplices);
    fnv.add(variant.more_own_vertices);
  }
  return fnv.value();
}

}  // namespace tegl::gen
