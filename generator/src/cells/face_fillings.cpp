// SPDX-License-Identifier: BSD-3-Clause
//
// Lists, certifies and emits the compact contours of 3D faces.
#include "cells/face_fillings.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "tables/emit_arrays.hpp"
#include "tables/emit_text.hpp"

namespace tegl::gen {

namespace {

using Cycle = std::vector<std::uint8_t>;
using Triangle = std::array<std::uint8_t, 3>;
using Triangles = std::vector<Triangle>;

constexpr std::array<std::array<unsigned, 3>, 6> kAxisOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

/// Triangles in an order that does not depend on how they were listed; each starts at its smallest edge.
Triangles sorted(Triangles triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// The number of a filling among those found so far; adds it if it is new.
std::uint8_t number_of(Triangles filling, std::vector<Triangles>& fillings) {
  filling = sorted(std::move(filling));
  const auto at = std::find(fillings.begin(), fillings.end(), filling);
  const auto number = static_cast<std::uint8_t>(at - fillings.begin());
  if (at == fillings.end()) fillings.push_back(std::move(filling));
  return number;
}

/// Directed sides of triangles without those that two triangles pass in opposite directions.
std::map<std::uint8_t, std::uint8_t> outline_of(const Triangles& triangles) {
  std::set<std::pair<std::uint8_t, std::uint8_t>> sides;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) sides.emplace(t[i], t[(i + 1) % 3]);
  std::map<std::uint8_t, std::uint8_t> next;
  for (const auto& [from, to] : sides)
    if (sides.count({to, from}) == 0) next[from] = to;
  return next;
}

/// The outlines of discs of triangles, along their orientation.
std::vector<Cycle> cycles_of(const Triangles& triangles) {
  std::map<std::uint8_t, std::uint8_t> next = outline_of(triangles);
  std::vector<Cycle> cycles;
  while (!next.empty()) {
    Cycle& cycle = cycles.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      cycle.push_back(at->first);
      const std::uint8_t to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return cycles;
}

/// A 3D shape with its compact table.
class Shape {
 public:
  Shape(const CellTables& compact, bool high_connected) : table_(compact), high_connected_(high_connected) {
    if (!compact.element_of.empty() || !compact.masks.empty())
      throw Error(ErrorCode::Internal, compact.name + ": fillings of faces need one list for each signature, on edges");
    for (const SubTile& face : compact.tile.faces) polygons_.push_back(static_cast<unsigned>(face.corners()));
  }

  [[nodiscard]] unsigned corners() const { return table_.tile.corner_count(); }
  [[nodiscard]] bool is_cube() const { return corners() == 8; }
  [[nodiscard]] std::string text_of(unsigned signature) const {
    return fmt::format("{}, signature {}, {}-connected: ", table_.name, signature, high_connected_ ? "high" : "low");
  }

  /// The contour in the shape's own table.
  [[nodiscard]] Triangles of_table(unsigned signature) const {
    const unsigned all = (1u << corners()) - 1;
    const tables::CellList& list = table_.lists[table_.list_of[high_connected_ ? all & ~signature : signature]];
    Triangles triangles(list.simplex_count);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      std::copy_n(table_.simplices.begin() + static_cast<std::ptrdiff_t>(3 * (list.first_simplex + i)), 3,
                  triangles[i].begin());
      if (high_connected_) std::swap(triangles[i][1], triangles[i][2]);
    }
    return triangles;
  }

  /// Whether the points of two edges lie in one face.
  [[nodiscard]] bool share_a_face(unsigned edge, unsigned other) const {
    unsigned ends = 0;
    for (const unsigned e : {edge, other}) ends |= 1u << table_.tile.edges[e][0] | 1u << table_.tile.edges[e][1];
    return std::any_of(polygons_.begin(), polygons_.end(), [&](unsigned polygon) { return (ends & ~polygon) == 0; });
  }

  /// The contour of a cube whose frame is moved to another one.
  [[nodiscard]] Triangles in_frame(unsigned signature, unsigned frame) const {
    const unsigned origin = frame / 6;
    const auto& axes = kAxisOrders[frame % 6];
    const auto corner = [&](unsigned v) {  // of the cube, for a corner of the frame
      unsigned of_cube = origin;
      for (unsigned i = 0; i < 3; ++i) of_cube ^= (v >> i & 1u) << axes[i];
      return of_cube;
    };
    unsigned in_frame = 0;
    for (unsigned v = 0; v < 8; ++v) in_frame |= (signature >> corner(v) & 1u) << v;
    const bool odd = (axes[0] > axes[1]) != ((axes[0] > axes[2]) != (axes[1] > axes[2]));
    const bool is_mirrored = odd != (std::popcount(origin) % 2 == 1);
    Triangles triangles = of_table(in_frame);
    for (Triangle& t : triangles) {
      for (std::uint8_t& e : t) e = edge_between(corner(table_.tile.edges[e][0]), corner(table_.tile.edges[e][1]));
      if (is_mirrored) std::swap(t[1], t[2]);
    }
    return triangles;
  }

 private:
  [[nodiscard]] std::uint8_t edge_between(unsigned p, unsigned q) const {
    const auto at = std::find_if(table_.tile.edges.begin(), table_.tile.edges.end(), [&](const auto& ends) {
      return (ends[0] == p && ends[1] == q) || (ends[0] == q && ends[1] == p);
    });
    return static_cast<std::uint8_t>(at - table_.tile.edges.begin());
  }

  const CellTables& table_;
  bool high_connected_;
  std::vector<unsigned> polygons_;  ///< corners of the shape's 2-faces
};

/// The fans of one polygon, with the edges that they may start from.
struct Fans {
  std::vector<Triangles> fans;
  std::vector<tables::FillingApex> apexes;
};

Fans fans_of(const Shape& shape, const Cycle& cycle) {
  Fans result;
  const std::size_t size = cycle.size();
  for (std::size_t a = 0; a < size; ++a) {
    bool is_allowed = true;
    Triangles fan;
    for (std::size_t i = 1; i + 1 < size; ++i) {
      fan.push_back({cycle[a], cycle[(a + i) % size], cycle[(a + i + 1) % size]});
      is_allowed = is_allowed && (i == 1 || !shape.share_a_face(cycle[a], cycle[(a + i) % size]));
    }
    if (is_allowed) result.apexes.push_back({cycle[a], number_of(std::move(fan), result.fans)});
  }
  return result;
}

/// All products of the fans of the polygons. Adds the polygons that have several.
std::vector<Triangles> add_polygons(const Shape& shape, unsigned signature, FaceFillings& to) {
  std::vector<Triangles> fillings = {{}};
  for (const Cycle& cycle : cycles_of(shape.of_table(signature))) {
    const Fans of = fans_of(shape, cycle);
    std::vector<Triangles> all;
    for (const Triangles& fan : of.fans)
      for (const Triangles& before : fillings) {
        Triangles& both = all.emplace_back(before);
        both.insert(both.end(), fan.begin(), fan.end());
      }
    if (of.fans.size() > 1) {
      to.polygons.push_back({static_cast<std::uint16_t>(to.apexes.size()), static_cast<std::uint8_t>(of.apexes.size()),
                             static_cast<std::uint8_t>(fillings.size())});
      to.apexes.insert(to.apexes.end(), of.apexes.begin(), of.apexes.end());
    }
    fillings = std::move(all);
  }
  for (Triangles& filling : fillings) filling = sorted(std::move(filling));
  return fillings;
}

std::string prefix(const FaceFillings& of) {
  return fmt::format("k{}{}", upper_camel(of.name), of.high_connected ? "High" : "Low");
}

std::uint64_t digest(const FaceFillings& of) {
  Fnv hash;
  for (const auto& c : of.cases) {
    hash.add(c.first_filling), hash.add(c.fillings), hash.add(c.own);
    hash.add(c.first_polygon), hash.add(c.polygons);
  }
  for (const auto& f : of.fillings) hash.add(f.first_triangle), hash.add(f.triangles);
  for (const auto& t : of.triangles)
    for (const std::uint8_t e : t) hash.add(e);
  for (const auto& p : of.polygons) hash.add(p.first_apex), hash.add(p.apexes), hash.add(p.weight);
  for (const auto& a : of.apexes) hash.add(a.edge), hash.add(a.choice);
  for (const auto& frames : of.of_frames)
    for (const std::uint8_t filling : frames) hash.add(filling);
  return hash.value();
}

}  // namespace

FaceFillings make_face_fillings(const CellTables& compact, bool high_connected) {
  const Shape shape(compact, high_connected);
  FaceFillings result{compact.name, high_connected};
  for (unsigned s = 0; s < 1u << shape.corners(); ++s) {
    tables::FillingCase& of = result.cases.emplace_back();
    of.first_filling = static_cast<std::uint16_t>(result.fillings.size());
    of.first_polygon = static_cast<std::uint16_t>(result.polygons.size());
    std::vector<Triangles> fillings;
    if (shape.is_cube()) {
      auto& frames = result.of_frames.emplace_back();
      for (unsigned f = 0; f < tables::kCubeFrames; ++f) frames[f] = number_of(shape.in_frame(s, f), fillings);
    } else {
      fillings = add_polygons(shape, s, result);
    }
    of.own = number_of(shape.of_table(s), fillings);
    of.fillings = static_cast<std::uint8_t>(fillings.size());
    of.polygons = static_cast<std::uint8_t>(result.polygons.size() - of.first_polygon);
    for (const Triangles& filling : fillings) {
      result.fillings.push_back(
          {static_cast<std::uint16_t>(result.triangles.size()), static_cast<std::uint8_t>(filling.size())});
      result.triangles.insert(result.triangles.end(), filling.begin(), filling.end());
    }
  }
  certify_face_fillings(compact, result);
  return result;
}

void certify_face_fillings(const CellTables& compact, const FaceFillings& fillings) {
  const Shape shape(compact, fillings.high_connected);
  for (unsigned s = 0; s < fillings.cases.size(); ++s) {
    const auto fail = [&](const char* fault) { throw Error(ErrorCode::CertificateFailed, shape.text_of(s) + fault); };
    const tables::FillingCase& of = fillings.cases[s];
    const Triangles own = sorted(shape.of_table(s));
    std::set<Triangles> all;
    for (unsigned i = 0; i < of.fillings; ++i) {
      const tables::FaceFilling& at = fillings.fillings[of.first_filling + i];
      const Triangles filling(fillings.triangles.begin() + at.first_triangle,
                              fillings.triangles.begin() + at.first_triangle + at.triangles);
      if (!all.insert(filling).second) fail("two equal fillings");
      if (filling.size() != own.size()) fail("a filling with another number of triangles");
      const auto outline = outline_of(filling);
      if (outline != outline_of(own)) fail("a filling with another boundary");
      for (const Triangle& t : filling)
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint8_t from = t[k], to = t[(k + 1) % 3];
          const auto next = outline.find(from);
          const bool is_outer = next != outline.end() && next->second == to;
          const auto before = outline.find(to);
          const bool is_inner = !is_outer && (before == outline.end() || before->second != from);
          if (!is_outer && (!is_inner || shape.share_a_face(from, to))) fail("a side in a face of the shape");
        }
      if (i == of.own && filling != own) fail("the number of its own contour");
    }
    if (shape.is_cube()) {
      for (const std::uint8_t number : fillings.of_frames[s])
        if (number >= of.fillings) fail("a frame without a filling");
      continue;
    }
    unsigned last = 0;  // the sum of the largest choices
    for (unsigned p = 0; p < of.polygons; ++p) {
      const tables::FillingPolygon& polygon = fillings.polygons[of.first_polygon + p];
      unsigned largest = 0;
      for (unsigned a = 0; a < polygon.apexes; ++a)
        largest = std::max<unsigned>(largest, fillings.apexes[polygon.first_apex + a].choice);
      last += largest * polygon.weight;
    }
    if (last >= of.fillings) fail("choices without a filling");
  }
}

std::vector<FaceFillings> make_all_face_fillings(std::span<const CellTables> tables) {
  std::vector<FaceFillings> all;
  for (const CellTables& table : tables) {
    if (table.tile.dim != 3 || table.triangulation != Triangulation::compact) continue;
    for (const bool high : {false, true}) all.push_back(make_face_fillings(table, high));
  }
  return all;
}

std::string face_filling_arrays(const std::vector<FaceFillings>& all) {
  std::string text;
  for (const FaceFillings& of : all) {
    fmt::format_to(Appender(text), "\n// {}, {}-connected, all compact contours: {} of {} signatures.\n", of.name,
                   of.high_connected ? "high" : "low", of.fillings.size(), of.cases.size());
    const std::string name = prefix(of);
    write_records(text, "FillingCase", (name + "Cases").c_str(),
                  "first filling, fillings, own, first polygon, polygons", of.cases, [](const auto& c) {
                    return fmt::format("{{{},{},{},{},{}}}", c.first_filling, c.fillings, c.own, c.first_polygon,
                                       c.polygons);
                  });
    write_records(text, "FaceFilling", (name + "Fillings").c_str(), "first triangle, triangles", of.fillings,
                  [](const auto& f) { return fmt::format("{{{},{}}}", f.first_triangle, f.triangles); });
    write_records(text, "std::array<std::uint8_t, 3>", (name + "FaceTriangles").c_str(), "edges", of.triangles,
                  [](const auto& t) { return fmt::format("{{{{{}}}}}", fmt::join(t, ",")); });
    if (!of.polygons.empty()) {
      write_records(text, "FillingPolygon", (name + "Polygons").c_str(), "first apex, apexes, weight", of.polygons,
                    [](const auto& p) { return fmt::format("{{{},{},{}}}", p.first_apex, p.apexes, p.weight); });
      write_records(text, "FillingApex", (name + "Apexes").c_str(), "edge, choice", of.apexes,
                    [](const auto& a) { return fmt::format("{{{},{}}}", a.edge, a.choice); });
    }
    if (!of.of_frames.empty())
      write_records(text, "std::array<std::uint8_t, kCubeFrames>", (name + "Frames").c_str(),
                    "signature -> filling by frame", of.of_frames,
                    [](const auto& f) { return fmt::format("{{{{{}}}}}", fmt::join(f, ",")); });
  }
  return text;
}

std::string face_filling_function(const std::vector<FaceFillings>& all) {
  std::string text =
      "const FaceFillingTable* face_filling_table(CellShape shape, bool high_connected) noexcept {\n  switch (shape) "
      "{\n";
  for (std::size_t i = 0; i < all.size(); i += 2) {
    fmt::format_to(Appender(text),
                   "    case CellShape::{}: {{\n      static constexpr FaceFillingTable kBoth[2] = {{\n", all[i].name);
    for (std::size_t high = 0; high < 2; ++high) {
      const FaceFillings& of = all[i + high];
      const std::string name = prefix(of);
      const auto or_null = [&](bool is_empty, const char* what) { return is_empty ? "nullptr" : name + what; };
      fmt::format_to(Appender(text), "          {{{0}Cases, {0}Fillings, {0}FaceTriangles, {1}, {2}, {3}}},\n", name,
                     or_null(of.polygons.empty(), "Polygons"), or_null(of.apexes.empty(), "Apexes"),
                     or_null(of.of_frames.empty(), "Frames"));
    }
    text += "      };\n      return &kBoth[high_connected ? 1 : 0];\n    }\n";
  }
  return text + "    default:\n      return nullptr;\n  }\n}\n";
}

std::string face_filling_manifest(const std::vector<FaceFillings>& all) {
  std::vector<std::string> lines;
  for (const FaceFillings& of : all)
    lines.push_back(fmt::format(
        "    {{\"cell\": \"{}\", \"alternative\": \"{}\", \"signatures\": {}, \"fillings\": {}, \"triangles\": {}, "
        "\"fnv1a\": \"{:016x}\"}}",
        of.name, of.high_connected ? "high" : "low", of.cases.size(), of.fillings.size(), of.triangles.size(),
        digest(of)));
  return fmt::format("{}", fmt::join(lines, ",\n"));
}

}  // namespace tegl::gen
