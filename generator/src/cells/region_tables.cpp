// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the regions of shapes, certifies their divisions, and emits them.
#include "cells/region_tables.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "base/parallel.hpp"
#include "tables/emit_arrays.hpp"
#include "tables/emit_text.hpp"

namespace tegl::gen {

namespace {

using Vertices = ShapeVertices;
using Part = std::vector<std::uint8_t>;
using PartFans = std::vector<RegionTriangles>;  ///< all ways to divide a part of a polygon

/// Corners and edges of a shape in the form of the contract.
struct Outline {
  explicit Outline(const Cell& cell) {
    for (const auto& corner : cell.tile.corners)
      for (std::size_t a = 0; a < 3; ++a) corners.push_back(static_cast<std::int8_t>(corner[a]));
    for (const auto& [a, b] : cell.tile.edges) edges.push_back(a), edges.push_back(b);
    table.dim = 3;
    table.corner_count = cell.tile.corner_count(), table.edge_count = cell.tile.edge_count();
    table.corners = corners.data(), table.edges = edges.data();
  }
  Outline(const Outline&) = delete;
  Outline& operator=(const Outline&) = delete;

  std::vector<std::int8_t> corners;
  std::vector<std::uint8_t> edges;
  tables::CellTable table{};
};

/// Lists the boundaries of the high part of a shape.
class Boundaries {
 public:
  Boundaries(const Cell& cell, const ShapeTables& shape, std::span<const FaceFillings> fillings)
      : cell_(cell), fillings_(fillings) {
    for (const tables::CellFacet& facet : shape.facets) {  // seen from outside
      Part ring(facet.corners.begin(), facet.corners.begin() + facet.corner_count);
      if (ring.size() == 4) std::swap(ring[2], ring[3]);
      if (!facet.is_inverted) std::reverse(ring.begin(), ring.end());
      rings_.push_back(std::move(ring));
    }
  }

  /// Calls visit(boundary) for all boundaries of a signature, sorted.
  template <class Visit>
  void list(unsigned signature, const Visit& visit) {
    signature_ = signature;
    Part ambiguous;
    for (std::uint8_t f = 0; f < rings_.size(); ++f)
      if (is_ambiguous(rings_[f])) ambiguous.push_back(f);
    const unsigned resolutions = 1u << ambiguous.size();
    for (unsigned joined = 0; joined < resolutions; ++joined) {
      cut(ambiguous, joined);
      RegionTriangles contour = with_barycentres();
      visit_fans(contour, visit);
      for (const FaceFillings& of : fillings_) {
        if (joined != (of.high_connected ? resolutions - 1 : 0)) continue;
        const tables::FillingCase& at = of.cases[signature];
        for (unsigned i = 0; i < at.fillings; ++i) {
          contour = compact(of, of.fillings[at.first_filling + i]);
          visit_fans(contour, visit);
        }
      }
    }
  }

 private:
  [[nodiscard]] bool is_high(const Part& ring, std::size_t i) const {
    return (signature_ >> ring[i % ring.size()] & 1u) != 0;
  }
  [[nodiscard]] bool is_ambiguous(const Part& ring) const {
    return ring.size() == 4 && is_high(ring, 0) == is_high(ring, 2) && is_high(ring, 1) == is_high(ring, 3) &&
           is_high(ring, 0) != is_high(ring, 1);
  }
  [[nodiscard]] std::uint8_t on_edge(const Part& ring, std::size_t i) const {
    return static_cast<std::uint8_t>(Vertices::kFirstEdge +
                                     cell_.tile.edge_between(ring[i % ring.size()], ring[(i + 1) % ring.size()]));
  }

  /// Finds the high parts of the polygons, and the contour's segments in them, with the high part of the shape on the
  /// other side.
  void cut(const Part& ambiguous, unsigned joined) {
    parts_.clear(), next_.clear();
    for (std::size_t f = 0; f < rings_.size(); ++f) {
      const Part& ring = rings_[f];
      const auto at = std::find(ambiguous.begin(), ambiguous.end(), f);
      const bool is_apart = at != ambiguous.end() && (joined >> (at - ambiguous.begin()) & 1u) == 0;
      Part all;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (is_high(ring, i)) all.push_back(ring[i]);
        if (is_high(ring, i) == is_high(ring, i + 1)) continue;
        all.push_back(on_edge(ring, i));
        if (!is_high(ring, i)) continue;
        // from the next point of the contour that leads into the part
        std::size_t into = i + 1;
        while (!is_high(ring, into + 1)) ++into;
        if (is_apart) into = i + ring.size() - 1;
        next_[on_edge(ring, into)] = on_edge(ring, i);
        if (is_apart) parts_.push_back({on_edge(ring, into), ring[i], on_edge(ring, i)});
      }
      if (!is_apart && !all.empty()) parts_.push_back(std::move(all));
    }
  }

  /// The contour's polygons from a barycentre, but triangles as they are.
  [[nodiscard]] RegionTriangles with_barycentres() const {
    RegionTriangles triangles;
    std::map<std::uint8_t, std::uint8_t> next = next_;
    std::uint8_t centre = Vertices::kFirstCentre;
    while (!next.empty()) {
      Part loop;
      for (auto at = next.begin(); at != next.end();) {
        loop.push_back(at->first);
        const std::uint8_t to = at->second;
        next.erase(at);
        at = next.find(to);
      }
      if (loop.size() == 3) {
        triangles.push_back({loop[0], loop[1], loop[2]});
        continue;
      }
      for (std::size_t i = 0; i < loop.size(); ++i) triangles.push_back({centre, loop[i], loop[(i + 1) % loop.size()]});
      ++centre;
    }
    return triangles;
  }

  /// A compact contour. Its triangles have one orientation in the shape, so one side of the contour fixes it.
  [[nodiscard]] RegionTriangles compact(const FaceFillings& of, const tables::FaceFilling& filling) const {
    RegionTriangles triangles;
    for (unsigned i = 0; i < filling.triangles; ++i) {
      const auto& edges = of.triangles[filling.first_triangle + i];
      RegionTriangle& t = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) t[k] = static_cast<std::uint8_t>(Vertices::kFirstEdge + edges[k]);
    }
    const auto has_side = [&](const RegionTriangle& t, bool reversed) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = next_.find(t[reversed ? (k + 1) % 3 : k]);
        if (at != next_.end() && at->second == t[reversed ? k : (k + 1) % 3]) return true;
      }
      return false;
    };
    const auto at_border = std::find_if(triangles.begin(), triangles.end(),
                                        [&](const auto& t) { return has_side(t, false) != has_side(t, true); });
    if (at_border != triangles.end() && has_side(*at_border, true))
      for (RegionTriangle& t : triangles) std::swap(t[1], t[2]);
    return triangles;
  }

  /// All fans from corners; of three corners in a row only from the middle one.
  [[nodiscard]] static PartFans fans_of(const Part& part) {
    const std::size_t size = part.size();
    const auto is_corner = [&](std::size_t i) { return part[i % size] < Vertices::kFirstEdge; };
    const auto corners = std::count_if(part.begin(), part.end(), [](auto v) { return v < Vertices::kFirstEdge; });
    PartFans fans;
    for (std::size_t i = 0; i < size; ++i) {
      if (!is_corner(i) || (corners == 3 && size > 3 && !(is_corner(i + 1) && is_corner(i + size - 1)))) continue;
      RegionTriangles fan;
      for (std::size_t k = 1; k + 1 < size; ++k)
        fan.push_back({part[i], part[(i + k) % size], part[(i + k + 1) % size]});
      detail::sort_boundary(fan);
      if (std::find(fans.begin(), fans.end(), fan) == fans.end()) fans.push_back(std::move(fan));
    }
    return fans;
  }

  template <class Visit>
  void visit_fans(const RegionTriangles& contour, const Visit& visit) const {
    std::vector<PartFans> fans;
    for (const Part& part : parts_) fans.push_back(fans_of(part));
    std::vector<std::size_t> chosen(fans.size(), 0);
    for (std::size_t i = 0; i == 0 || i < fans.size();) {
      RegionTriangles boundary = contour;
      for (std::size_t p = 0; p < fans.size(); ++p)
        boundary.insert(boundary.end(), fans[p][chosen[p]].begin(), fans[p][chosen[p]].end());
      detail::sort_boundary(boundary);
      visit(boundary);
      for (i = 0; i < fans.size() && ++chosen[i] == fans[i].size(); ++i) chosen[i] = 0;
      if (i == fans.size()) break;
    }
  }

  const Cell& cell_;
  std::span<const FaceFillings> fillings_;
  std::vector<Part> rings_;  ///< the shape's polygons
  unsigned signature_ = 0;
  std::vector<Part> parts_;
  std::map<std::uint8_t, std::uint8_t> next_;  ///< the contour's segments
};

/// An offset or a count in the type of a record.
template <class Field>
Field narrowed(std::size_t value) {
  if (!std::in_range<Field>(value))
    throw std::logic_error(fmt::format("an offset or a count of {} in a table of regions; expected at most {}", value,
                                       std::numeric_limits<Field>::max()));
  return static_cast<Field>(value);
}

/// Appends a region with its division.
void append(const RegionTriangles& boundary, const CapDivision& division, CapTables& to) {
  tables::RegionRecord& record = to.records.emplace_back();
  record.first_triangle = narrowed<std::uint32_t>(to.triangles.size());
  record.first_tetrahedron = narrowed<std::uint32_t>(to.tetrahedra.size());
  record.first_own = narrowed<std::uint16_t>(to.own.size());
  record.first_near = narrowed<std::uint16_t>(to.near.size());
  record.triangles = narrowed<std::uint8_t>(boundary.size());
  record.tetrahedra = narrowed<std::uint8_t>(division.tetrahedra.size());
  record.own = narrowed<std::uint8_t>(division.own.size());
  record.near = narrowed<std::uint8_t>(division.near.size());
  to.triangles.insert(to.triangles.end(), boundary.begin(), boundary.end());
  to.tetrahedra.insert(to.tetrahedra.end(), division.tetrahedra.begin(), division.tetrahedra.end());
  to.own.insert(to.own.end(), division.own.begin(), division.own.end());
  for (const CapDivision::Near& near : division.near) {
    to.near.push_back({near.own, near.corner, narrowed<std::uint8_t>(near.seen.size()),
                       narrowed<std::uint32_t>(to.triangles.size())});
    to.triangles.insert(to.triangles.end(), near.seen.begin(), near.seen.end());
  }
}

/// The message about a record that refers to elements beyond the arrays or the shape; null if it does not.
const char* missing(const Outline& outline, const CapTables& tables, const tables::RegionRecord& record) {
  const auto are_in = [](const auto& array, std::size_t first, std::size_t count) {
    return first <= array.size() && count <= array.size() - first;
  };
  if (!are_in(tables.triangles, record.first_triangle, record.triangles) ||
      !are_in(tables.tetrahedra, record.first_tetrahedron, record.tetrahedra) ||
      !are_in(tables.own, record.first_own, record.own) || !are_in(tables.near, record.first_near, record.near))
    return "a range outside of its array";
  const std::uint32_t corners = (1u << outline.table.corner_count) - 1, edges = (1u << outline.table.edge_count) - 1;
  for (unsigned i = 0; i < record.own; ++i)
    if ((tables.own[record.first_own + i] & ~(corners | edges << Vertices::kFirstEdge)) != 0)
      return "a mean of a point that does not exist";
  for (unsigned i = 0; i < record.near; ++i) {
    const tables::NearVertex& near = tables.near[record.first_near + i];
    if (!are_in(tables.triangles, near.first_seen, near.seen)) return "a range outside of its array";
    if (near.corner >= outline.table.corner_count) return "a vertex near a corner that does not exist";
  }
  return nullptr;
}

/// Checks the tetrahedra of one division, whose record refers to nothing that is missing.
class DivisionCheck {
 public:
  DivisionCheck(const Outline& outline, const CapTables& tables, const tables::RegionRecord& record)
      : tables_(tables),
        record_(record),
        boundary_(tables.triangles.begin() + record.first_triangle,
                  tables.triangles.begin() + record.first_triangle + record.triangles),
        volumes_(volumes_with(outline.table, boundary_)),
        outwards_(is_outwards(volumes_, boundary_)) {}

  [[nodiscard]] const RegionTriangles& boundary() const { return boundary_; }

  /// The first fault that is found, or null.
  [[nodiscard]] const char* fault() const {
    if (!std::is_sorted(boundary_.begin(), boundary_.end())) return "triangles that do not ascend";
    if (!is_closed(boundary_) || detail::split_regions(boundary_).size() != 1) return "a boundary of no single region";
    RegionTriangles sum;
    for (unsigned i = 0; i < record_.tetrahedra; ++i) {
      const RegionTetrahedron& t = tables_.tetrahedra[record_.first_tetrahedron + i];
      if (std::any_of(t.begin(), t.end(), [&](unsigned v) { return v >= Vertices::kFirstOwn + record_.own; }))
        return "a vertex that does not exist";
      if (!is_positive(t)) return "a tetrahedron that may be negative";
      for (const RegionTriangle& face : detail::faces_of(t)) detail::add_to_boundary(sum, face);
    }
    return sum == boundary_ ? nullptr : "tetrahedra with another boundary";
  }

 private:
  static bool is_closed(const RegionTriangles& triangles) {
    std::map<std::pair<std::uint8_t, std::uint8_t>, int> sides;
    for (const RegionTriangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}], --sides[{t[(k + 1) % 3], t[k]}];
    return std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; });
  }
  [[nodiscard]] VolumeSigns signs(std::uint8_t apex, const RegionTriangle& t) const {
    const RegionTetrahedron tetrahedron{apex, t[0], t[1], t[2]};
    VolumeSigns of = volumes_.signs(tetrahedron);
    if (of.positive && of.negative) of = volumes_.exact_signs(tetrahedron);
    if (!outwards_) std::swap(of.positive, of.negative);
    return of;
  }
  [[nodiscard]] bool is_positive(const RegionTetrahedron& t) const {
    const RegionTriangle base = {t[1], t[2], t[3]};
    if (std::any_of(base.begin(), base.end(), [](unsigned v) { return v >= Vertices::kFirstOwn; })) return false;
    if (t[0] < Vertices::kFirstOwn) return signs(t[0], base).is_positive();
    const auto own = static_cast<std::uint8_t>(t[0] - Vertices::kFirstOwn);
    for (unsigned i = 0; i < record_.near; ++i)
      if (const tables::NearVertex& near = tables_.near[record_.first_near + i]; near.own == t[0])
        return is_positive_near(near, own, base);
    return sees(own, base);
  }
  /// Whether the mean of the points of an own vertex is in front of a triangle.
  [[nodiscard]] bool sees(unsigned own, const RegionTriangle& base) const {
    VolumeSigns all;
    for (std::uint32_t rest = tables_.own[record_.first_own + own]; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::uint8_t>(std::countr_zero(rest));
      if (std::find(base.begin(), base.end(), v) != base.end()) continue;
      const VolumeSigns of = signs(v, base);
      if (of.negative) return false;
      all.positive = all.positive || of.is_positive();
    }
    return all.positive;
  }
  /// Near the corner, a triangle that the corner sees is seen; others, which the corner must lie in the plane of, if
  /// the mean sees them. The vertex is placed by the triangles in `seen`.
  [[nodiscard]] bool is_positive_near(const tables::NearVertex& near, unsigned own, const RegionTriangle& base) const {
    const auto begin = tables_.triangles.begin() + near.first_seen;
    if (std::find(begin, begin + near.seen, detail::from_smallest(base)) == begin + near.seen) return false;
    const bool has_corner = std::find(base.begin(), base.end(), near.corner) != base.end();
    const VolumeSigns of = has_corner ? VolumeSigns{} : signs(near.corner, base);
    if (of.negative) return false;
    return of.is_positive() || sees(own, base);
  }

  const CapTables& tables_;
  const tables::RegionRecord& record_;
  RegionTriangles boundary_;
  RegionVolumes volumes_;
  bool outwards_;
};

template <class Simplices>
std::vector<std::uint8_t> bytes_of(const Simplices& simplices) {
  std::vector<std::uint8_t> bytes;
  for (const auto& s : simplices) bytes.insert(bytes.end(), s.begin(), s.end());
  return bytes;
}

std::uint64_t digest(const CapTables& of) {
  Fnv hash;
  for (const tables::RegionRecord& r : of.records) {
    hash.add(r.first_triangle), hash.add(r.first_tetrahedron), hash.add(r.first_own), hash.add(r.first_near);
    hash.add(r.triangles), hash.add(r.tetrahedra), hash.add(r.own), hash.add(r.near);
  }
  hash.add(bytes_of(of.triangles));
  hash.add(bytes_of(of.tetrahedra));
  hash.add(of.own);
  for (const tables::NearVertex& n : of.near)
    hash.add(n.own), hash.add(n.corner), hash.add(n.seen), hash.add(n.first_seen);
  return hash.value();
}

}  // namespace

std::vector<RegionTriangles> list_boundaries(const Cell& cell, const ShapeTables& shape,
                                             std::span<const FaceFillings> fillings) {
  std::set<RegionTriangles> distinct;
  Boundaries boundaries(cell, shape, fillings);
  for (unsigned s = 1; s < 1u << cell.tile.corner_count(); ++s)
    boundaries.list(s, [&](const RegionTriangles& boundary) { distinct.insert(boundary); });
  return {distinct.begin(), distinct.end()};
}

CapTables make_region_tables(const Cell& cell, const ShapeTables& shape, std::span<const FaceFillings> fillings) {
  const Outline outline(cell);
  CapTables result{cell.name};
  const std::vector<RegionTriangles> boundaries = list_boundaries(cell, shape, fillings);
  std::set<RegionTriangles> regions;
  detail::RegionMap map{};
  for (const RegionTriangles& boundary : boundaries)
    for (const RegionTriangles& region : detail::split_regions(boundary))
      regions.insert(detail::representative_of(region, outline.table, shape.symmetries, map));
  result.boundaries = boundaries.size();
  const std::vector<RegionTriangles> all(regions.begin(), regions.end());
  std::vector<std::optional<CapDivision>> divisions(all.size());
  const auto nothing = [] { return 0; };
  in_parallel(
      all.size(), 1, 0, nothing, [&](int, std::uint64_t i) { divisions[i] = divide_region(outline.table, all[i]); },
      [](int) {});
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (divisions[i])
      append(all[i], *divisions[i], result);
    else
      result.unproved.push_back(all[i]);
  }
  certify_region_tables(cell, result);
  return result;
}

void certify_region_tables(const Cell& cell, const CapTables& tables) {
  const Outline outline(cell);
  RegionTriangles before;
  for (std::size_t i = 0; i < tables.records.size(); ++i) {
    const auto expect_none = [&](const char* fault) {
      if (fault != nullptr)
        throw Error(ErrorCode::CertificateFailed, fmt::format("{}, region {}: {}", cell.name, i, fault));
    };
    expect_none(missing(outline, tables, tables.records[i]));
    const DivisionCheck check(outline, tables, tables.records[i]);
    expect_none(check.fault());
    if (check.boundary() <= before) expect_none("a boundary that does not follow the one before");
    before = check.boundary();
  }
}

std::vector<CapTables> make_all_region_tables(std::span<const ShapeTables> shapes,
                                              std::span<const FaceFillings> fillings) {
  std::vector<CapTables> all;
  const std::vector<Cell> cells = mesh_cells();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].tile.dim != 3) continue;
    std::vector<FaceFillings> own;
    std::copy_if(fillings.begin(), fillings.end(), std::back_inserter(own),
                 [&](const FaceFillings& of) { return of.name == cells[i].name; });
    all.push_back(make_region_tables(cells[i], shapes[i], own));
  }
  return all;
}

std::string region_arrays(const std::vector<CapTables>& all) {
  std::string text;
  for (const CapTables& of : all) {
    fmt::format_to(Appender(text), "\n// {}: {} regions up to symmetry, proved; {} others.\n", of.name,
                   of.records.size(), of.unproved.size());
    const std::string name = "k" + upper_camel(of.name) + "Region";
    write_records(text, "RegionRecord", (name + "Records").c_str(), "firsts, counts", of.records,
                  [](const tables::RegionRecord& r) {
                    return fmt::format("{{{},{},{},{},{},{},{},{}}}", r.first_triangle, r.first_tetrahedron,
                                       r.first_own, r.first_near, r.triangles, r.tetrahedra, r.own, r.near);
                  });
    write_bytes(text, (name + "Triangles").c_str(), "three vertices, octal", bytes_of(of.triangles), 36);
    write_bytes(text, (name + "Tetrahedra").c_str(), "four vertices, octal", bytes_of(of.tetrahedra), 36);
    write_array(text, "std::uint32_t", (name + "Own").c_str(), "corners and edges", of.own);
    if (!of.near.empty())
      write_records(text, "NearVertex", (name + "Near").c_str(), "vertex, corner, seen triangles, first", of.near,
                    [](const tables::NearVertex& n) {
                      return fmt::format("{{{},{},{},{}}}", n.own, n.corner, n.seen, n.first_seen);
                    });
  }
  return text;
}

std::string region_function(const std::vector<CapTables>& all) {
  std::string text =
      "const RegionDivisionTable* region_division_table(CellShape shape) noexcept {\n  switch (shape) {\n";
  for (const CapTables& of : all) {
    const std::string name = "k" + upper_camel(of.name) + "Region";
    const auto or_null = [&](bool is_empty, const char* what) { return is_empty ? "nullptr" : name + what; };
    const auto bytes = [&](const char* what) {
      return fmt::format("reinterpret_cast<const std::uint8_t*>({})", name + what);
    };
    fmt::format_to(Appender(text),
                   "    case CellShape::{}: {{\n      static const RegionDivisionTable kTable = {{\n"
                   "          {}, {}Records, {},\n          {}, {}, {}}};\n      return &kTable;\n    }}\n",
                   of.name, of.records.size(), name, bytes("Triangles"), bytes("Tetrahedra"),
                   or_null(of.own.empty(), "Own"), or_null(of.near.empty(), "Near"));
  }
  return text + "    default:\n      return nullptr;\n  }\n}\n";
}

std::string region_manifest(const std::vector<CapTables>& all) {
  std::vector<std::string> lines;
  for (const CapTables& of : all)
    lines.push_back(fmt::format(
        "    {{\"cell\": \"{}\", \"boundaries\": {}, \"regions\": {}, \"unproved\": {}, \"tetrahedra\": {}, \"fnv1a\": "
        "\"{:016x}\"}}",
        of.name, of.boundaries, of.records.size(), of.unproved.size(), of.tetrahedra.size(), digest(of)));
  return fmt::format("{}", fmt::join(lines, ",\n"));
}

}  // namespace tegl::gen
