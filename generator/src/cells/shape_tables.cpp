// SPDX-License-Identifier: BSD-3-Clause
//
// Lists, certifies and emits the facets, symmetries and planes of shapes.
#include "cells/shape_tables.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/determinant.hpp"
#include "base/error.hpp"
#include "base/fnv.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tables/emit_arrays.hpp"
#include "tables/emit_text.hpp"

namespace tegl::gen {

namespace {

using tables::CellFacet;
using tables::CellShape;
using Vector = std::array<std::int64_t, 5>;
using Masks = std::vector<unsigned>;
using Planes = std::vector<tables::PlaneSides>;

/// The facets of the shapes that are no prisms of four dimensions, as bits of corners. Closed contours are listed in
/// this order.
Masks listed_facets(std::string_view name) {
  static const std::map<std::string_view, Masks> kFacets = {
      {"triangle", {0b011, 0b110, 0b101}},
      {"quadrilateral", {0b0101, 0b1010, 0b0011, 0b1100}},
      {"tetrahedron", {0b0111, 0b1011, 0b1101, 0b1110}},
      {"wedge", {0b011'011, 0b110'110, 0b101'101, 0b000'111, 0b111'000}},
      {"pyramid", {0b1'0011, 0b1'0101, 0b1'1010, 0b1'1100, 0b0'1111}},
      {"hexahedron", {0x55, 0xaa, 0x33, 0xcc, 0x0f, 0xf0}},
      {"octahedron", {0x15, 0x16, 0x19, 0x1a, 0x25, 0x26, 0x29, 0x2a}},
      {"simplex4", {0x0f, 0x17, 0x1b, 0x1d, 0x1e}},
      {"cell16", {0x55, 0x56, 0x59, 0x5a, 0x65, 0x66, 0x69, 0x6a, 0x95, 0x96, 0x99, 0x9a, 0xa5, 0xa6, 0xa9, 0xaa}}};
  return kFacets.at(name);
}

/// The facets of a shape as bits of corners: of a prism its ends, then those over the facets of its base.
Masks facets_of(const Cell& cell) {
  constexpr std::string_view kPrism = "_prism";
  const std::string_view name = cell.name;
  if (!name.ends_with(kPrism)) return listed_facets(name);
  const unsigned count = cell.tile.corner_count() / 2, lower = (1u << count) - 1;
  Masks facets = {lower, lower << count};
  for (const unsigned facet : listed_facets(name.substr(0, name.size() - kPrism.size())))
    facets.push_back(facet | facet << count);
  return facets;
}

/// Coordinates of a corner, followed by 1 and zeros.
Vector corner_of(const Cell& cell, unsigned v) {
  Vector corner{};
  const auto dim = static_cast<std::size_t>(cell.tile.dim);
  for (std::size_t i = 0; i < dim; ++i) corner[i] = static_cast<std::int64_t>(cell.tile.corners[v][i]);
  corner[dim] = 1;
  return corner;
}

Vector difference(Vector a, const Vector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

constexpr int sign_of(std::int64_t x) noexcept { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// The sign of the volume of corners that are given by number, one more than the dimension.
int volume_sign(const Cell& cell, std::span<const unsigned> corners) {
  std::array<Vector, 5> rows{};
  for (std::size_t i = 0; i < corners.size(); ++i) rows[i] = corner_of(cell, corners[i]);
  // (-1)^dim: the determinant of differences has its rows from the first corner to the others
  const int sign = sign_of(cofactor_determinant(rows, corners.size()));
  return cell.tile.dim % 2 == 0 ? sign : -sign;
}

/// Corners of a facet that span it, by their number in the facet, ascending. `count`: one more than its dimension.
std::vector<unsigned> spanning(const Cell& facet) {
  const auto dim = static_cast<unsigned>(facet.tile.dim);
  const unsigned count = facet.tile.corner_count();
  for (unsigned chosen = 0; chosen < 1u << count; ++chosen) {
    if (std::popcount(chosen) != static_cast<int>(dim) + 1) continue;
    std::vector<unsigned> corners;
    for (unsigned rest = chosen; rest != 0; rest &= rest - 1)
      corners.push_back(static_cast<unsigned>(std::countr_zero(rest)));
    if (volume_sign(facet, corners) != 0) return corners;
  }
  throw Error(ErrorCode::Internal, facet.name + ": a shape without volume");
}

/// The orientation of a facet's corners, which span it, followed by a direction into the cell.
int sign_inwards(const Cell& cell, const CellFacet& facet, const std::vector<unsigned>& spanning) {
  const auto dim = static_cast<std::size_t>(cell.tile.dim);
  std::array<Vector, 5> rows{};
  const Vector first = corner_of(cell, facet.corners[spanning[0]]);
  for (std::size_t k = 1; k < spanning.size(); ++k)
    rows[k - 1] = difference(corner_of(cell, facet.corners[spanning[k]]), first);
  for (unsigned v = 0; v < cell.tile.corner_count(); ++v) {
    const Vector to = difference(corner_of(cell, v), first);
    for (std::size_t i = 0; i < dim; ++i) rows[dim - 1][i] += to[i];
  }
  return sign_of(cofactor_determinant(rows, dim));
}

/// Whether facets have the orientation that the contract defines: a facet's own orientation is that of the reference
/// corners of its shape.
bool is_inverted(const Cell& cell, const CellFacet& facet, const std::vector<Cell>& shapes) {
  if (facet.corner_count == 2) return sign_inwards(cell, facet, {0, 1}) < 0;
  const Cell& own = shapes[static_cast<std::size_t>(facet.shape)];
  const std::vector<unsigned> corners = spanning(own);
  return volume_sign(own, corners) != sign_inwards(cell, facet, corners);
}

/// Facets of a shape as sets of corners.
std::set<unsigned> sets_of_facets(const Cell& cell) {
  std::set<unsigned> facets;
  for (const SubTile& face : cell.tile.faces) facets.insert(static_cast<unsigned>(face.corners()));
  return facets;
}

/// The corners of a facet as bits, or of corners of it.
unsigned lifted(const CellFacet& facet, unsigned corners) {
  unsigned result = 0;
  for (unsigned v = 0; v < facet.corner_count; ++v) result |= (corners >> v & 1u) << facet.corners[v];
  return result;
}

/// Whether a facet is of a shape: it meets other facets of the cell in that shape's facets.
bool is_of_shape(const Cell& cell, const CellFacet& facet, const Cell& shape) {
  if (shape.tile.dim + 1 != cell.tile.dim || shape.tile.corner_count() != facet.corner_count) return false;
  const std::set<unsigned> facets = sets_of_facets(cell);
  const std::set<unsigned> own = sets_of_facets(shape);
  const unsigned all = lifted(facet, ~0u);
  std::set<unsigned> expected, found;
  for (const unsigned face : own) expected.insert(lifted(facet, face));
  for (const unsigned other : facets)
    if (other != all && std::popcount(other & all) >= shape.tile.dim && cell.lattice.find(other & all))
      found.insert(other & all);
  return found == expected;
}

std::vector<CellFacet> make_facets(const Cell& cell, const std::vector<Cell>& shapes) {
  std::vector<CellFacet> facets;
  for (const unsigned mask : facets_of(cell)) {
    CellFacet& facet = facets.emplace_back(CellFacet{CellShape::triangle, 0, {}, false});
    for (std::uint8_t v = 0; v < cell.tile.corner_count(); ++v)
      if ((mask >> v & 1u) != 0) facet.corners[facet.corner_count++] = v;
    if (facet.corner_count > 2) {
      const auto at = std::find_if(shapes.begin(), shapes.end(),
                                   [&](const Cell& shape) { return is_of_shape(cell, facet, shape); });
      if (at == shapes.end()) throw Error(ErrorCode::Internal, cell.name + ": a facet of no known shape");
      facet.shape = static_cast<CellShape>(at - shapes.begin());
    }
    facet.is_inverted = is_inverted(cell, facet, shapes);
  }
  return facets;
}

std::vector<std::uint8_t> make_symmetries(const Cell& cell) {
  std::vector<std::uint8_t> result;
  for (const TileSymmetry& g : symmetries(cell.tile, GroupKind::Full, false)) {
    result.insert(result.end(), g.corner.begin(), g.corner.end());
    const auto edges = edge_permutation(cell.tile, g.corner);
    result.insert(result.end(), edges.begin(), edges.end());
  }
  return result;
}

/// Calls visit(corners) for all sets of four corners.
template <class Visit>
void for_each_four(unsigned count, const Visit& visit) {
  for (unsigned a = 0; a < count; ++a)
    for (unsigned b = a + 1; b < count; ++b)
      for (unsigned c = b + 1; c < count; ++c)
        for (unsigned d = c + 1; d < count; ++d) visit(std::array{a, b, c, d});
}

using Sides = std::pair<std::uint16_t, std::uint16_t>;

/// The corners on both sides of a hyperplane; `side`: the sign of a corner's height above it.
template <class Side>
Sides sides_of(unsigned count, const Side& side) {
  std::array<std::uint16_t, 2> sides{};
  for (unsigned v = 0; v < count; ++v)
    if (const int at = side(v); at != 0)
      sides[at > 0 ? 0 : 1] = static_cast<std::uint16_t>(sides[at > 0 ? 0 : 1] | 1u << v);
  return std::minmax(sides[0], sides[1]);
}

Planes make_planes(const Cell& cell) {
  std::set<Sides> all;
  const unsigned count = cell.tile.corner_count();
  for_each_four(count, [&](const std::array<unsigned, 4>& four) {
    const Vector first = corner_of(cell, four[0]);
    std::array<Vector, 3> rows;
    for (std::size_t i = 0; i < 3; ++i) rows[i] = difference(corner_of(cell, four[i + 1]), first);
    const Vector normal = cross_product(rows, 4);
    if (normal == Vector{}) return;  // in a common plane
    all.insert(sides_of(count, [&](unsigned v) {
      const Vector to = difference(corner_of(cell, v), first);
      return sign_of(std::inner_product(to.begin(), to.end(), normal.begin(), std::int64_t{0}));
    }));
  });
  Planes planes;
  for (const auto& [above, below] : all) planes.push_back({above, below});
  return planes;
}

// certificates: each returns what is wrong, or null

const char* fault_of_facets(const Cell& cell, const std::vector<CellFacet>& facets, const std::vector<Cell>& shapes) {
  std::set<unsigned> found;
  for (const CellFacet& facet : facets) {
    if (facet.corner_count < 2 || facet.corner_count > 8) return "a facet with too few or too many corners";
    const auto end = facet.corners.begin() + facet.corner_count;
    if (std::adjacent_find(facet.corners.begin(), end, std::greater_equal<>()) != end)
      return "corners of a facet that do not ascend";
    found.insert(lifted(facet, ~0u));
    const bool is_edge = facet.corner_count == 2 && facet.shape == CellShape::triangle;
    if (!is_edge && !is_of_shape(cell, facet, shapes[static_cast<std::size_t>(facet.shape)]))
      return "a facet of another shape";
  }
  if (found != sets_of_facets(cell) || found.size() != facets.size()) return "facets other than those of the lattice";
  return nullptr;
}

/// Each face between two facets has opposite orientations in them. If one facet has the right one, all have, since the
/// boundary is connected.
const char* fault_of_orientations(const Cell& cell, const std::vector<CellFacet>& facets,
                                  std::span<const ShapeTables> all, const std::vector<Cell>& shapes) {
  std::map<unsigned, std::vector<bool>> ridges;  // whether they are inverted, by corners
  for (const CellFacet& facet : facets) {
    if (facet.corner_count == 2) {
      ridges[1u << facet.corners[0]].push_back(facet.is_inverted);
      ridges[1u << facet.corners[1]].push_back(!facet.is_inverted);
      continue;
    }
    for (const CellFacet& ridge : all[static_cast<std::size_t>(facet.shape)].facets)
      ridges[lifted(facet, lifted(ridge, ~0u))].push_back(ridge.is_inverted != facet.is_inverted);
  }
  for (const auto& [corners, inverted] : ridges)
    if (inverted.size() != 2 || inverted[0] == inverted[1]) return "orientations of facets that do not cancel";
  if (facets[0].is_inverted != is_inverted(cell, facets[0], shapes)) return "inverted orientations of all facets";
  return nullptr;
}

/// By definition: all permutations of corners that map facets to facets, in ascending order.
const char* fault_of_symmetries(const Cell& cell, const std::vector<std::uint8_t>& symmetries) {
  const unsigned count = cell.tile.corner_count();
  const std::set<unsigned> facets = sets_of_facets(cell);
  std::vector<std::uint32_t> corner(count);
  std::iota(corner.begin(), corner.end(), 0u);
  std::vector<std::uint8_t> expected;
  do {
    const bool fits = std::all_of(facets.begin(), facets.end(), [&](unsigned facet) {
      unsigned image = 0;
      for (unsigned v = 0; v < count; ++v) image |= (facet >> v & 1u) << corner[v];
      return facets.count(image) != 0;
    });
    if (!fits) continue;
    expected.insert(expected.end(), corner.begin(), corner.end());
    for (const auto& [a, b] : cell.tile.edges) expected.push_back(cell.tile.edge_between(corner[a], corner[b]));
  } while (std::next_permutation(corner.begin(), corner.end()));
  return symmetries == expected ? nullptr : "symmetries other than all permutations that map facets to facets";
}

/// By determinants of five corners: every hyperplane through four corners is listed, and no other one.
const char* fault_of_planes(const Cell& cell, const Planes& planes) {
  const unsigned count = cell.tile.corner_count();
  std::set<Sides> listed, found;
  for (const auto& [above, below] : planes) {
    const Sides sides{above, below};
    if (above > below || (!listed.empty() && sides <= *listed.rbegin())) return "hyperplanes that do not ascend";
    listed.insert(sides);
  }
  for_each_four(count, [&](const std::array<unsigned, 4>& four) {
    const Sides sides = sides_of(count, [&](unsigned v) {
      return volume_sign(cell, std::array{four[0], four[1], four[2], four[3], v});
    });
    if (sides != Sides{}) found.insert(sides);
  });
  return found == listed ? nullptr : "hyperplanes other than those through four corners";
}

const char* fault_of(const Cell& cell, const ShapeTables& tables, std::span<const ShapeTables> all,
                     const std::vector<Cell>& shapes) {
  if (tables.name != cell.name) return "the name of another shape";
  const char* fault = fault_of_facets(cell, tables.facets, shapes);
  if (fault == nullptr) fault = fault_of_orientations(cell, tables.facets, all, shapes);
  if (fault != nullptr) return fault;
  if (cell.tile.dim == 3) return fault_of_symmetries(cell, tables.symmetries);
  if (!tables.symmetries.empty()) return "a table of 3D shapes";
  if (cell.tile.dim == 4) return fault_of_planes(cell, tables.planes);
  return tables.planes.empty() ? nullptr : "a table of 4D shapes";
}

std::uint64_t digest(const ShapeTables& of) {
  Fnv hash;
  for (const CellFacet& f : of.facets) {
    hash.add(static_cast<std::uint8_t>(f.shape)), hash.add(f.corner_count);
    for (const std::uint8_t v : f.corners) hash.add(v);
    hash.add(static_cast<std::uint8_t>(f.is_inverted));
  }
  hash.add(of.symmetries);
  for (const auto& p : of.planes) hash.add(p.above), hash.add(p.below);
  return hash.value();
}

std::size_t symmetry_count(const Cell& cell, const ShapeTables& of) {
  return of.symmetries.size() / (cell.tile.corner_count() + cell.tile.edge_count());
}

}  // namespace

std::vector<ShapeTables> make_all_shape_tables() {
  const std::vector<Cell> shapes = mesh_cells();
  std::vector<ShapeTables> all;
  for (const Cell& cell : shapes) {
    ShapeTables& tables = all.emplace_back(ShapeTables{cell.name, make_facets(cell, shapes)});
    if (cell.tile.dim == 3) tables.symmetries = make_symmetries(cell);
    if (cell.tile.dim == 4) tables.planes = make_planes(cell);
  }
  certify_shape_tables(all);
  return all;
}

void certify_shape_tables(std::span<const ShapeTables> all) {
  const std::vector<Cell> shapes = mesh_cells();
  if (all.size() != shapes.size()) throw Error(ErrorCode::CertificateFailed, "another number of shapes");
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const char* fault = fault_of(shapes[i], all[i], all, shapes))
      throw Error(ErrorCode::CertificateFailed, shapes[i].name + ": " + fault);
}

std::string shape_arrays(const std::vector<ShapeTables>& all) {
  std::string text = "\n// Shapes: facets, symmetries, sides of planes through corners.\n";
  for (const ShapeTables& of : all) {
    const std::string name = "k" + upper_camel(of.name);
    write_records(
        text, "CellFacet", (name + "Facets").c_str(), "shape, corners, inverted", of.facets, [](const CellFacet& f) {
          return fmt::format("{{CellShape{{{}}},{},{{{{{}}}}},{}}}", static_cast<int>(f.shape), f.corner_count,
                             fmt::join(f.corners.begin(), f.corners.begin() + f.corner_count, ","), f.is_inverted);
        });
    write_array(text, "std::uint8_t", (name + "Symmetries").c_str(), "symmetry x (corners, edges)", of.symmetries);
    if (!of.planes.empty())
      write_records(text, "PlaneSides", (name + "Planes").c_str(), "corners above, below", of.planes,
                    [](const auto& p) { return fmt::format("{{{:#x},{:#x}}}", p.above, p.below); });
  }
  return text;
}

std::string shape_function(const std::vector<ShapeTables>& all) {
  const std::vector<Cell> shapes = mesh_cells();
  std::string text = fmt::format(
      "const ShapeTable& shape_table(CellShape shape) noexcept {{\n  static constexpr ShapeTable kShapes[{}] = {{\n",
      all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ShapeTables& of = all[i];
    const std::string name = "k" + upper_camel(of.name);
    const auto or_null = [&](bool is_empty, const char* what) { return is_empty ? "nullptr" : name + what; };
    fmt::format_to(Appender(text), "      {{{}, {}, {}, {},\n       {}, {}}},\n", of.facets.size(),
                   symmetry_count(shapes[i], of), of.planes.size(), name + "Facets",
                   or_null(of.symmetries.empty(), "Symmetries"), or_null(of.planes.empty(), "Planes"));
  }
  return text + "  };\n  return kShapes[static_cast<unsigned>(shape)];\n}\n";
}

std::string shape_manifest(const std::vector<ShapeTables>& all) {
  const std::vector<Cell> shapes = mesh_cells();
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < all.size(); ++i)
    lines.push_back(fmt::format(
        "    {{\"cell\": \"{}\", \"facets\": {}, \"symmetries\": {}, \"hyperplanes\": {}, \"fnv1a\": "
        "\"{:016x}\"}}",
        all[i].name, all[i].facets.size(), symmetry_count(shapes[i], all[i]), all[i].planes.size(), digest(all[i])));
  return fmt::format("{}", fmt::join(lines, ",\n"));
}

}  // namespace tegl::gen
