// SPDX-License-Identifier: BSD-3-Clause
//
// Converts contours to flat arrays: lists by signature or by class, with the group elements that map classes to
// signatures.
#include "tables/tile_tables.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "base/parallel.hpp"
#include "filling/certificate.hpp"
#include "filling/embedding_evidence.hpp"

namespace tegl::gen {

const char* layout_name(Layout l) noexcept { return l == Layout::flat ? "flat" : "class"; }

namespace {

/// Number of signatures that a thread takes at a time.
constexpr std::uint64_t kChunk = 64;

/// A sign, then the simplex's vertices in ascending order: equal for equal oriented simplices.
using Canonical = std::array<std::uint32_t, 5>;

template <class Name>
std::vector<Canonical> canonical(int n, const std::vector<LocalSimplex>& simplices, bool reversed, const Name& name) {
  std::vector<Canonical> result;
  for (const LocalSimplex& s : simplices) {
    std::array<std::uint32_t, 4> names{};
    for (int i = 0; i < n; ++i) names[i] = name(s[i]);
    const int sign = tile::sort_vertices(names, n) * (reversed ? -1 : 1);
    result.push_back({sign > 0 ? 1u : 0u, names[0], names[1], names[2], names[3]});
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<LocalSimplex> all_simplices(const TileContour& contour) {
  std::vector<LocalSimplex> result;
  for (const LocalFacet& facet : contour.facets)
    result.insert(result.end(), facet.simplices.begin(), facet.simplices.end());
  return result;
}

/// Names for a tile's own vertices, independent of their numbering: a cone vertex by the smallest vertex of its
/// component, a side vertex by its mask.
class OwnNames {
 public:
  OwnNames(int n, std::uint32_t own_base, std::uint32_t cones, const std::vector<LocalSimplex>& simplices,
           const std::vector<std::uint64_t>& masks, std::map<std::uint64_t, std::uint32_t>& mask_numbers)
      : own_base_(own_base) {
    names_.assign(256, 0xffffffff);
    for (const LocalSimplex& s : simplices)
      if (s[0] >= own_base && s[0] < own_base + cones)
        for (int i = 1; i < n; ++i) names_[s[0]] = std::min<std::uint32_t>(names_[s[0]], 256u + s[i]);
    for (std::size_t k = 0; k < masks.size(); ++k)
      names_[own_base + cones + k] =
          1024u + mask_numbers.emplace(masks[k], static_cast<std::uint32_t>(mask_numbers.size())).first->second;
  }
  std::uint32_t operator()(std::uint8_t v) const { return v < own_base_ ? v : names_[v]; }

 private:
  std::uint32_t own_base_;
  std::vector<std::uint32_t> names_;
};

void append_list(TileTables& table, const TileContour& contour) {
  tables::List list{};
  list.first_simplex = static_cast<std::uint32_t>(table.simplices.size() / static_cast<std::size_t>(table.dim));
  list.cone_vertices = static_cast<std::uint8_t>(contour.cone_vertices);
  list.side_vertices = static_cast<std::uint8_t>(contour.side_masks.size());
  list.first_side = static_cast<std::uint32_t>(table.side_masks.size());
  for (const LocalSimplex& s : all_simplices(contour)) {
    ++list.simplex_count;
    table.simplices.insert(table.simplices.end(), s.begin(), s.begin() + table.dim);
  }
  // Only n = 4 has side masks: bit 2^n + e is bit 16 + e.
  table.side_masks.insert(table.side_masks.end(), contour.side_masks.begin(), contour.side_masks.end());
  table.max_simplices = std::max<std::uint32_t>(table.max_simplices, list.simplex_count);
  table.max_tile_vertices =
      std::max<std::uint32_t>(table.max_tile_vertices, std::uint32_t{list.cone_vertices} + list.side_vertices);
  table.lists.push_back(list);
}

/// The images of corners, edges and cube slots under a symmetry: a row of TileTable::permutations.
std::vector<std::uint8_t> permutation_row(const Tile& tile, const TileSymmetry& g) {
  std::vector<std::uint8_t> row(g.corner.begin(), g.corner.end());
  const auto edges = edge_permutation(tile, g.corner);
  row.insert(row.end(), edges.begin(), edges.end());
  if (tile.dim != 4) return row;
  for (const SubTile& cube : tile.faces) {
    Signature image = 0;
    for (const std::uint8_t v : cube.corner) image |= Signature{1} << g.corner[v];
    for (std::uint32_t f = 0; f < tile.faces.size(); ++f) {
      if (tile.faces[f].corners() != image) continue;
      for (std::uint32_t j = 0; j < tables::kFaceSlots; ++j)
        row.push_back(static_cast<std::uint8_t>(tile.edge_count() + f * tables::kFaceSlots + j));
    }
  }
  return row;
}

/// The facets of face f that have a barycentre, in slot order.
std::vector<const LocalFacet*> slots_of(const ContourBuilder& builder, std::uint32_t f, Signature s) {
  std::vector<const LocalFacet*> result;
  for (const LocalFacet& facet : builder.face_contour(f, s).facets)
    if (facet.filling == Filling::cone) result.push_back(&facet);
  return result;
}

/// Cubes (of the image) whose two slots are exchanged by g.
std::uint8_t swaps_of(const ContourBuilder& builder, Signature from, Signature to,
                      const std::vector<std::uint8_t>& row) {
  const Tile& tile = builder.tile();
  std::uint8_t swaps = 0;
  for (std::uint32_t f = 0; f < tile.faces.size(); ++f) {
    const auto slots = slots_of(builder, f, from);
    if (slots.size() < 2) continue;
    const std::uint32_t image =
        (row[tile.corner_count() + tile.edge_count() + f * tables::kFaceSlots] - tile.edge_count()) /
        tables::kFaceSlots;
    const std::uint8_t moved = row[tile.corner_count() + builder.lift(f, slots[0]->points.front())];
    const auto targets = slots_of(builder, image, to);
    const auto has = [&](const LocalFacet& facet) {
      return std::any_of(facet.points.begin(), facet.points.end(),
                         [&](std::uint8_t p) { return builder.lift(image, p) == moved; });
    };
    if (!has(*targets.at(0))) swaps = static_cast<std::uint8_t>(swaps | (1u << image));
  }
  return swaps;
}

/// The representative's contour mapped to a signature, in the way the runtime does it.
TileContour carried(const ContourBuilder& builder, const TileContour& contour, const std::vector<std::uint8_t>& row,
                    std::uint8_t swaps, bool reverse) {
  const std::uint32_t corners = builder.tile().corner_count(), edges = builder.tile().edge_count();
  TileContour result = contour;
  for (LocalFacet& facet : result.facets)
    for (LocalSimplex& s : facet.simplices) {
      for (int i = 0; i < builder.dim(); ++i) {
        if (s[i] >= builder.own_base()) continue;
        s[i] = row[corners + s[i]];
        if (s[i] >= edges && ((swaps >> ((s[i] - edges) / tables::kFaceSlots)) & 1u) != 0)
          s[i] = static_cast<std::uint8_t>(edges + ((s[i] - edges) ^ 1u));
      }
      if (reverse) std::swap(s[builder.dim() - 1], s[builder.dim() - 2]);
    }
  for (std::uint64_t& mask : result.side_masks) {
    std::uint64_t image = 0;
    for (std::uint32_t b = 0; b < corners + edges; ++b)
      if (((mask >> b) & 1u) != 0) image |= std::uint64_t{1} << (b < corners ? row[b] : corners + row[b]);
    mask = image;
  }
  return result;
}

bool same_contour(const ContourBuilder& builder, const TileContour& a, const TileContour& b) {
  std::map<std::uint64_t, std::uint32_t> mask_numbers;
  const auto form = [&](const TileContour& c) {
    const auto simplices = all_simplices(c);
    return canonical(
        builder.dim(), simplices, false,
        OwnNames(builder.dim(), builder.own_base(), c.cone_vertices, simplices, c.side_masks, mask_numbers));
  };
  return form(a) == form(b);
}

/// Whether the symmetry that maps the smallest signature of the class to this one also maps its contour to this one's.
bool is_image_of_representative(const ContourBuilder& builder, const std::vector<TileContour>& contours,
                                const TileClasses& of_tile, std::uint32_t s) {
  const Signature r = of_tile.classes.representatives[of_tile.classes.class_of[s]];
  const TileSymmetry& g = of_tile.symmetries[of_tile.classes.element_of[s]];
  const auto row = permutation_row(builder.tile(), g);
  const std::uint8_t swaps = builder.dim() == 4 ? swaps_of(builder, r, s, row) : std::uint8_t{0};
  return same_contour(builder, carried(builder, contours[r], row, swaps, g.reverses_orientation()), contours[s]);
}

void pack_by_class(const ContourBuilder& builder, const std::vector<TileContour>& contours, const TileClasses& of_tile,
                   TileTables& table) {
  const Transversal& classes = of_tile.classes;
  // group elements and lists of the representatives
  std::vector<std::vector<std::uint8_t>> rows;
  for (const TileSymmetry& g : of_tile.symmetries) {
    rows.push_back(permutation_row(builder.tile(), g));
    table.permutations.insert(table.permutations.end(), rows.back().begin(), rows.back().end());
    table.reverses.push_back(g.reverses_orientation() ? 1 : 0);
  }
  table.permutation_stride = static_cast<std::uint32_t>(rows.front().size());
  for (const auto r : classes.representatives) append_list(table, contours[r]);
  // class and element of each signature
  table.slot_swaps.resize(contours.size());
  for (std::size_t s = 0; s < contours.size(); ++s) {
    table.list_of.push_back(static_cast<std::uint16_t>(classes.class_of[s]));
    table.element_of.push_back(static_cast<std::uint16_t>(classes.element_of[s]));
  }
  // slot swaps; check that the mapped contour equals the signature's own
  const auto carry = [&](int, std::uint64_t number) {
    const auto s = static_cast<std::uint32_t>(number);
    const Signature r = classes.representatives[table.list_of[s]];
    const auto& row = rows[table.element_of[s]];
    table.slot_swaps[s] = swaps_of(builder, r, s, row);
    const auto image =
        carried(builder, contours[r], row, table.slot_swaps[s], table.reverses[table.element_of[s]] != 0);
    if (!same_contour(builder, image, contours[s]))
      throw Error(ErrorCode::Internal,
                  fmt::format("signature {}: the contour carried from its representative {} differs from its own; "
                              "expected an equivariant triangulation",
                              s, r));
  };
  in_parallel(
      contours.size(), kChunk, 0, [] { return 0; }, carry, [](int) {});
}

}  // namespace

tables::TileTable TileTables::view() const {
  const auto or_null = [](const auto& v) { return v.empty() ? nullptr : v.data(); };
  return {tables::kContractVersion,
          static_cast<std::uint32_t>(dim),
          static_cast<std::uint32_t>(lists.size()),
          static_cast<std::uint32_t>(simplices.size() / static_cast<std::size_t>(dim)),
          static_cast<std::uint32_t>(reverses.size()),
          permutation_stride,
          max_simplices,
          max_tile_vertices,
          list_of.data(),
          or_null(element_of),
          or_null(slot_swaps),
          or_null(permutations),
          or_null(reverses),
          lists.data(),
          simplices.data(),
          side_masks.data()};
}

std::vector<TileContour> certified_contours(const ContourBuilder& builder,
                                            const std::function<TileContour(Signature)>& make,
                                            const Transversal& classes, CertifiedFigures& figures) {
  const std::uint64_t count = builder.tile().full() + 1;
  // build and certify on all processors
  std::vector<TileContour> contours(count);
  const auto build = [&](TableCertifier& certifier, std::uint64_t number) {
    const auto s = static_cast<std::uint32_t>(number);
    contours[s] = make(s);
    if (const tile::Fault fault = certifier.certify(s, contours[s]); fault != tile::Fault::none)
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("signature {} of the {}-tile: {}", s, builder.dim(), tile::name_of(fault)));
  };
  in_parallel(
      count, kChunk, 0, [&] { return TableCertifier(builder); }, build, [](const TableCertifier&) {});
  // figures
  figures = CertifiedFigures{};
  figures.alternative = builder.alternative();
  figures.triangulation = builder.triangulation();
  figures.signatures = count;
  const int sphere = builder.dim() == 3 ? 0 : 2;
  for (std::uint32_t s = 0; s < count; ++s) {
    std::uint32_t simplices = 0;
    bool others = false;
    for (const LocalFacet& facet : contours[s].facets) {
      simplices += static_cast<std::uint32_t>(facet.simplices.size());
      ++figures.by_filling[static_cast<std::size_t>(facet.filling)];
      ++(facet.boundary_euler == sphere ? figures.spheres : figures.others);
      others |= facet.boundary_euler != sphere;
      if (builder.dim() == 4)
        figures.highest_genus =
            std::max(figures.highest_genus, static_cast<std::uint32_t>((2 - facet.boundary_euler) / 2));
    }
    figures.simplices += simplices;
    figures.max_simplices = std::max(figures.max_simplices, simplices);
    figures.facets += contours[s].facets.size();
    figures.max_facets = std::max(figures.max_facets, static_cast<std::uint32_t>(contours[s].facets.size()));
    figures.signatures_with_others += others ? 1 : 0;
    if (others && classes.representatives[classes.class_of[s]] == s) figures.classes_with_others.push_back(s);
  }
  return contours;
}

void certify_embedding(const ContourBuilder& builder, const std::vector<TileContour>& contours,
                       const TileClasses& classes, CertifiedFigures& figures) {
  const EmbeddingCertifier certifier(builder);
  const auto nothing = [] { return 0; };
  const auto finish = [](int) {};
  std::vector<std::uint8_t> is_open(contours.size());
  const auto prove = [&](int, std::uint64_t s) { is_open[s] = certifier.unproved_pairs(contours[s]).empty() ? 0 : 1; };
  in_parallel(contours.size(), kChunk, 0, nothing, prove, finish);
  // of each class one entry, and those that are not its images
  std::map<Signature, SearchedEntry> entries;
  for (std::uint32_t s = 0; s < contours.size(); ++s) {
    if (is_open[s] == 0) continue;
    const Signature of = is_image_of_representative(builder, contours, classes, s)
                             ? classes.classes.representatives[classes.classes.class_of[s]]
                             : s;
    entries[of].signature = of;
    ++entries[of].entries;
    ++figures.searched;
  }
  figures.embedded = contours.size() - figures.searched;
  figures.searches.clear();
  for (const auto& [s, entry] : entries) figures.searches.push_back(entry);
  const auto search = [&](int, std::uint64_t i) {
    SearchedEntry& entry = figures.searches[i];
    const auto pairs = certifier.unproved_pairs(contours[entry.signature]);
    entry.pairs = pairs.size();
    if (certifier.of(contours[entry.signature], entry.signature, pairs, figures.plan) == Evidence::absent)
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("signature {} of the {}-tile: its simplices intersect for some positions",
                              entry.signature, builder.dim()));
  };
  in_parallel(figures.searches.size(), 1, 0, nothing, search, finish);
}

std::string evidence_json(const CertifiedFigures& figures) {
  std::string text =
      fmt::format("\"embedded_proved\": {}, \"embedded_searched\": {}", figures.embedded, figures.searched);
  if (figures.searches.empty()) return text;
  std::string classes;
  for (const SearchedEntry& e : figures.searches)
    classes += fmt::format("{}{{\"signature\": {}, \"entries\": {}, \"unproved_pairs\": {}}}",
                           classes.empty() ? "" : ", ", e.signature, e.entries, e.pairs);
  const SearchPlan& plan = figures.plan;
  return text +
         fmt::format(
             ", \"search\": {{\"seed\": {}, \"middle\": 1, \"uniform\": {}, \"near_ends\": {}, \"descents\": {}, "
             "\"steps\": {}, \"intersections\": 0, \"classes\": [{}]}}",
             plan.seed, plan.uniform, plan.near_ends, plan.descents, plan.steps, classes);
}

void check_inversion(int dim, const std::vector<TileContour>& low, const std::vector<TileContour>& high) {
  const auto same = [](std::uint8_t v) { return std::uint32_t{v}; };
  for (std::size_t s = 0; s < low.size(); ++s) {
    const TileContour& a = high[s];
    const TileContour& b = low[low.size() - 1 - s];
    if (a.cone_vertices != b.cone_vertices || a.side_masks != b.side_masks ||
        canonical(dim, all_simplices(a), false, same) != canonical(dim, all_simplices(b), true, same))
      throw Error(ErrorCode::Internal,
                  fmt::format("signature {} of the {}-tile: the high-connected contour is not the reversed "
                              "low-connected one of the complement",
                              s, dim));
  }
}

TileTables make_tile_tables(const ContourBuilder& builder, const std::vector<TileContour>& contours, Layout layout,
                            const TileClasses& classes) {
  TileTables table;
  const Tile& tile = builder.tile();
  table.tile = tile.kind;
  table.corners = tile.corners;
  table.edges = tile.edges;
  for (const SubTile& face : tile.faces) table.faces.push_back(face.corner);
  table.first_tile_vertex = builder.own_base();
  table.dim = builder.dim();
  table.triangulation = builder.triangulation();
  table.layout = layout;
  for (const TileContour& c : contours) table.total_simplices += all_simplices(c).size();
  if (layout == Layout::by_class && tile.kind != TileKind::cube)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("class layout for a table of the {}: expected a cube", tile_kind_name(tile.kind)));
  if (layout == Layout::by_class) {
    pack_by_class(builder, contours, classes, table);
  } else {
    for (std::size_t s = 0; s < contours.size(); ++s) {
      append_list(table, contours[s]);
      table.list_of.push_back(static_cast<std::uint16_t>(s));
    }
  }
  return table;
}

RegionTables make_region_tables(const RegionBuilder& builder, Triangulation triangulation, Alternative alternative) {
  RegionTables table;
  table.dim = builder.tile().dim;
  table.triangulation = triangulation;
  table.alternative = alternative;
  const auto stride = static_cast<std::size_t>(table.dim) + 1;
  for (Signature s = 0; s <= builder.tile().full(); ++s) {
    const TileRegions& regions = builder.regions(s);
    tables::RegionList list{};
    list.first_simplex = static_cast<std::uint32_t>(table.simplices.size() / stride);
    list.simplex_count = static_cast<std::uint16_t>(regions.simplices.size());
    list.own_vertices = static_cast<std::uint16_t>(regions.own_masks.size());
    list.first_mask = static_cast<std::uint32_t>(table.masks.size());
    for (const LocalSimplex& simplex : regions.simplices)
      table.simplices.insert(table.simplices.end(), simplex.begin(), simplex.begin() + table.dim + 1);
    table.masks.insert(table.masks.end(), regions.own_masks.begin(), regions.own_masks.end());
    table.max_own_vertices = std::max<std::uint32_t>(table.max_own_vertices, list.own_vertices);
    table.lists.push_back(list);
  }
  return table;
}

std::uint64_t digest(const TileTables& table) {
  Fnv fnv;
  fnv.add(table.list_of);
  fnv.add(table.element_of);
  fnv.add(table.slot_swaps);
  fnv.add(table.permutations);
  fnv.add(table.reverses);
  for (const tables::List& l : table.lists) {
    fnv.add(l.first_simplex);
    fnv.add(l.simplex_count);
    fnv.add(l.cone_vertices);
    fnv.add(l.side_vertices);
    fnv.add(l.first_side);
  }
  fnv.add(table.simplices);
  fnv.add(table.side_masks);
  return fnv.value();
}

std::uint64_t digest(const RegionTables& table) {
  Fnv fnv;
  for (const tables::RegionList& l : table.lists) {
    fnv.add(l.first_simplex);
    fnv.add(l.simplex_count);
    fnv.add(l.own_vertices);
    fnv.add(l.first_mask);
  }
  fnv.add(table.simplices);
  fnv.add(table.masks);
  return fnv.value();
}

}  // namespace tegl::gen
