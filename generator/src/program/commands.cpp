// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --classes`, `--out`, `--cases`, `--builder` and `--cells`.
#include "program/commands.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "builders/emit_builder.hpp"
#include "cells/cell.hpp"
#include "cells/cell_tables.hpp"
#include "cubes/cube_certificate.hpp"
#include "filling/facets.hpp"
#include "filling/resolutions.hpp"
#include "pictures/cases.hpp"
#include "program/print_figures.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "symmetry/transversal.hpp"
#include "tables/emit.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

namespace {

std::vector<std::string> edge_names(const Tile& tile, const std::vector<std::uint8_t>& points) {
  std::vector<std::string> names;
  for (const std::uint8_t e : points) names.push_back(tile.edge_names[e]);
  return names;
}

/// A facet by the edges of its points, and the Euler characteristic of its boundary.
struct FacetReport {
  std::vector<std::uint8_t> points;
  int boundary_euler;
};

struct ClassReport {
  Signature signature;
  std::uint32_t orbit, stabiliser;
  std::vector<FacetReport> facets;
  std::vector<std::uint32_t> ambiguous;
};

std::string json_of(const Tile& tile, const ClassReport& c) {
  std::vector<std::string> facets, euler;
  for (const FacetReport& facet : c.facets) {
    facets.push_back(fmt::format("[\"{}\"]", fmt::join(edge_names(tile, facet.points), "\", \"")));
    euler.push_back(fmt::format("{}", facet.boundary_euler));
  }
  std::vector<std::string> ambiguous;
  for (std::size_t k = 2; k < c.ambiguous.size(); ++k)
    ambiguous.push_back(fmt::format("\"{}\": {}", k, c.ambiguous[k]));
  return fmt::format(
      "{{\"signature\": {}, \"orbit_length\": {}, \"stabiliser\": {}, \"components\": {}, \"facets\": [{}], "
      "\"boundary_euler\": [{}], \"ambiguous_faces\": {{{}}}}}",
      c.signature, c.orbit, c.stabiliser, c.facets.size(), fmt::join(facets, ", "), fmt::join(euler, ", "),
      fmt::join(ambiguous, ", "));
}

std::string text_of(const Tile& tile, const ClassReport& c) {
  std::vector<std::string> facets, euler;
  for (const FacetReport& facet : c.facets) {
    facets.push_back(fmt::format("({})", fmt::join(edge_names(tile, facet.points), " ")));
    euler.push_back(fmt::format("{}", facet.boundary_euler));
  }
  std::vector<std::string> ambiguous;
  for (std::size_t k = 2; k < c.ambiguous.size(); ++k) ambiguous.push_back(fmt::format("{}", c.ambiguous[k]));
  return fmt::format("{:>9} {:>6} {:>10} {:>10}  {:<10} {:<10} {}", c.signature, c.orbit, c.stabiliser, c.facets.size(),
                     euler.empty() ? "-" : fmt::format("{}", fmt::join(euler, " ")),
                     fmt::format("{}", fmt::join(ambiguous, " ")), fmt::join(facets, " "));
}

/// Measures the seconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A file to write, and the seconds spent on generating and writing its text.
struct TimedFile {
  EmittedFile file;
  double seconds;
};

/// Generates the files of all languages; a file that two languages share is listed once.
std::vector<TimedFile> emit_all(const TableSet& set, const std::vector<Language>& languages) {
  std::vector<TimedFile> files;
  for (const Language language : languages) {
    Stopwatch watch;
    std::vector<EmittedFile> emitted = emit(set, language);
    const double seconds = watch.lap();
    double bytes = 0;
    for (const EmittedFile& file : emitted) bytes += static_cast<double>(file.text.size());
    for (EmittedFile& file : emitted) {
      // GLSL and WGSL use the same file of words for a storage buffer.
      const auto same = [&file](const TimedFile& other) { return other.file.name == file.name; };
      if (std::any_of(files.begin(), files.end(), same)) continue;
      const double share = static_cast<double>(file.text.size()) / bytes;  // time is divided by length of text
      files.push_back({std::move(file), seconds * share});
    }
  }
  return files;
}

bool has_text(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  if (std::filesystem::file_size(path, error) != text.size() || error) return false;
  std::ifstream in(path, std::ios::binary);
  std::string found(text.size(), '\0');
  in.read(found.data(), static_cast<std::streamsize>(found.size()));
  return in && found == text;
}

/// Writes all files under temporary names beside their targets and renames them at the end, so a failure while writing
/// leaves no incomplete table. `keeps_same`: a file that has its text already stays as it is, so that builds by Ninja
/// do not compile it again. Adds the writing times.
void write_files(const std::filesystem::path& folder, bool keeps_same, std::vector<TimedFile>& files) {
  const auto part = [&](const TimedFile& timed) { return folder / (timed.file.name + ".part"); };
  const auto fail = [&](const std::filesystem::path& path, const std::string& why) {
    for (const TimedFile& timed : files) {
      std::error_code ignored;
      std::filesystem::remove(part(timed), ignored);
    }
    throw Error(ErrorCode::WriteFailed, fmt::format("{}: {}", path.string(), why));
  };
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, "cannot make the folder: " + error.message());
  // write temporary files
  for (TimedFile& timed : files) {
    const auto target = folder / timed.file.name;
    std::filesystem::create_directories(target.parent_path(), error);
    if (error) fail(target, "cannot make its folder: " + error.message());
    if (std::filesystem::is_directory(target, error)) fail(target, "is a directory; expected a file, or nothing");
    Stopwatch watch;
    std::ofstream out(part(timed), std::ios::binary);
    out.write(timed.file.text.data(), static_cast<std::streamsize>(timed.file.text.size()));
    out.close();
    if (!out) fail(target, "cannot be written");
    timed.seconds += watch.lap();
  }
  // rename
  for (const TimedFile& timed : files) {
    const auto target = folder / timed.file.name;
    if (keeps_same && has_text(target, timed.file.text))
      std::filesystem::remove(part(timed), error);
    else
      std::filesystem::rename(part(timed), target, error);
    if (error) fail(target, error.message());
  }
}

}  // namespace

namespace {

using FacetsOf = std::function<std::vector<FacetReport>(Signature)>;

/// Prints the classes of a tile.
void print_classes(const Options& options, const Tile& tile, const tile::FaceLattice& faces,
                   const FacetsOf& facets_of) {
  const Alternative alternative = options.alternative;
  const auto [symmetries, classes] = tile_classes(tile);
  if (options.json)
    fmt::print(
        "{{\"tile\": \"{}\", \"dim\": {}, \"alternative\": \"{}\", \"group\": \"full\", \"order\": {}, \"classes\": [",
        tile_text(options), options.dim, alternative_name(alternative), symmetries.size());
  else
    fmt::print("signature  orbit stabiliser components  Euler      ambiguous  facets\n");
  for (std::size_t c = 0; c < classes.representatives.size(); ++c) {
    const Signature s = classes.representatives[c];
    const ClassReport report{s, classes.orbit_length[c],
                             static_cast<std::uint32_t>(symmetries.size() / classes.orbit_length[c]), facets_of(s),
                             ambiguous_faces(tile, faces, s)};
    if (options.json)
      fmt::print("{}\n  {}", c == 0 ? "" : ",", json_of(tile, report));
    else
      fmt::print("{}\n", text_of(tile, report));
  }
  if (options.json) fmt::print("\n]}}\n");
}

void print_classes_of_cell(const Options& options) {
  const Cell cell = mesh_cell(options.cell->shape);
  tile::FacetBuilder builder(cell.lattice);
  print_classes(options, cell.tile, cell.lattice, [&](Signature s) {
    const tile::TileFacets& built = builder.build(s, {{}, options.alternative}, tile::Geometry::without);
    std::vector<FacetReport> facets;
    for (const tile::Facet& facet : built.facets) {
      std::set<std::uint8_t> points;
      for (const tile::Simplex& simplex : facet.simplices)
        for (int i = 0; i < options.dim; ++i) {
          const tile::Vertex& vertex = built.vertices[simplex[static_cast<std::size_t>(i)]];
          if (vertex.kind != tile::VertexKind::edge) continue;
          const Signature ends = cell.lattice.faces()[vertex.face].corners;
          points.insert(cell.tile.edge_between(static_cast<std::uint32_t>(std::countr_zero(ends)),
                                               63u - static_cast<std::uint32_t>(std::countl_zero(ends))));
        }
      facets.push_back({{points.begin(), points.end()}, facet.boundary_euler});
    }
    return facets;
  });
}

}  // namespace

int run_classes(const Options& options) {
  if (options.cell != nullptr) {
    print_classes_of_cell(options);
    return 0;
  }
  const Lattice lattice(options.tile, options.dim);
  const ContourBuilder builder(lattice, options.dim, options.alternative, Triangulation::barycentric);
  print_classes(options, lattice.tile(options.dim), face_lattice(options.tile, options.dim), [&](Signature s) {
    std::vector<FacetReport> facets;
    const TileContour contour = builder.build(s);
    for (const LocalFacet& facet : contour.facets) facets.push_back({facet.points, facet.boundary_euler});
    return facets;
  });
  return 0;
}

int run_cases(const Options& options) {
  std::vector<TimedFile> files;
  for (EmittedFile& file : emit_cases(options.dim)) files.push_back({std::move(file), 0.0});
  write_files(options.out, options.keeps_same, files);
  fmt::print("wrote {} and {} pictures\n", files.front().file.name, files.size() - 1);
  return 0;
}

int run_builder(const Options& options) {
  const std::vector<EmittedFile> emitted =
      emit_builder({options.dim, options.leaf, options.languages,
                    options.triangulation == TriangulationChoice::Barycentric ? Triangulation::barycentric
                                                                              : Triangulation::compact});
  if (options.out.empty()) {
    for (std::size_t i = 0; i + 1 < emitted.size(); ++i)  // all but the manifest
      fmt::print("{}// ---- {} ----\n{}", i == 0 ? "" : "\n", emitted[i].name, emitted[i].text);
    return 0;
  }
  const auto read = [&](const std::string& name) {
    std::ifstream in(std::filesystem::path(options.out) / name, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  std::vector<TimedFile> files;
  for (const EmittedFile& file : emitted) files.push_back({file, 0.0});
  EmittedFile& manifest = files.back().file;
  manifest.text = with_earlier_texts(manifest.text, read(manifest.name), read);
  write_files(options.out, options.keeps_same, files);
  for (const TimedFile& timed : files) fmt::print("wrote {}: {} bytes\n", timed.file.name, timed.file.text.size());
  return 0;
}

namespace {

/// Prints the figures of tables of cells and, with a folder, writes their files.
int print_and_write(const Options& options, const std::vector<CellTables>& tables,
                    std::vector<EmittedFile> (*emit)(const Options&, const std::vector<CellTables>&)) {
  fmt::print("{:<18} {:<12} {:>10} {:>6} {:>7} {:>9} {:>13} {:>9} {:>7}\n", "cell", "", "signatures", "order",
             "classes", "certified", "non-spherical", "simplices", "at most");
  for (const CellTables& t : tables)
    fmt::print("{:<18} {:<12} {:>10} {:>6} {:>7} {:>9} {:>13} {:>9} {:>7}\n", t.name,
               triangulation_name(t.triangulation), t.list_of.size(), t.group_order, t.classes, t.certified, t.others,
               t.total_simplices, t.max_simplices);
  if (options.out.empty()) return 0;
  std::vector<TimedFile> files;
  for (EmittedFile& file : emit(options, tables)) files.push_back({std::move(file), 0.0});
  write_files(options.out, options.keeps_same, files);
  for (const TimedFile& timed : files) fmt::print("wrote {}: {} bytes\n", timed.file.name, timed.file.text.size());
  return 0;
}

}  // namespace

int run_cells(const Options& options) {
  return print_and_write(options, make_all_cell_tables(),
                         [](const Options&, const std::vector<CellTables>& tables) { return emit_cells(tables); });
}

int run_cell_out(const Options& options) {
  std::vector<Triangulation> triangulations{Triangulation::barycentric, Triangulation::compact};
  if (options.triangulation != TriangulationChoice::All)
    triangulations = {triangulations[options.triangulation == TriangulationChoice::Compact ? 1 : 0]};
  if (options.dim == 4) triangulations = {Triangulation::barycentric};
  const Cell cell = mesh_cell(options.cell->shape);
  std::vector<CellTables> tables;
  for (const Triangulation t : triangulations) tables.push_back(make_cell_tables(cell, t));
  return print_and_write(options, tables, [](const Options& o, const std::vector<CellTables>& made) {
    std::string command = fmt::format("gen --tile {}", o.cell->given);
    if (o.triangulation != TriangulationChoice::All)
      command += fmt::format(" --triangulation {}", triangulation_name(made.front().triangulation));
    return emit_cell(made, o.languages, command);
  });
}

int run_out(const Options& options) {
  // request and command line for the banner
  TableRequest request;
  request.tile = options.tile;
  request.dim = options.dim;
  request.command = fmt::format("gen --dim {}", options.dim);
  if (options.tile != TileKind::cube) request.command += fmt::format(" --tile {}", tile_kind_name(options.tile));
  if (options.triangulation != TriangulationChoice::All)
    request.triangulations = {options.triangulation == TriangulationChoice::Compact ? Triangulation::compact
                                                                                    : Triangulation::barycentric};
  if (options.triangulation != TriangulationChoice::All)
    request.command += fmt::format(" --triangulation {}", triangulation_name(request.triangulations.front()));
  if (options.layout == LayoutChoice::Class && options.dim > 2 &&
      options.triangulation != TriangulationChoice::Barycentric)
    throw Error(ErrorCode::InvalidArgument,
                "--layout class with compact tables: their triangulation does not move with the symmetries, so they "
                "have one list per signature; expected --triangulation barycentric beside it");
  if (options.layout != LayoutChoice::Auto) {
    const Layout layout = options.layout == LayoutChoice::Class ? Layout::by_class : Layout::flat;
    request.layout = [layout](Triangulation) { return layout; };
    request.command += fmt::format(" --layout {}", layout_name(layout));
  }
  // tables
  Stopwatch watch;
  const TableSet set = make_table_set(request);
  for (const CertifiedFigures& f : set.figures) print_figures(options.tile, options.dim, f);
  if (set.resolved)
    fmt::print(
        "{}-tile, every ambiguity resolved freely\n  certified    {} entries, 3 ways each\n  embedded     {} lists "
        "proved "
        "for all positions\n",
        options.dim, set.resolved->entries.size(), certify_embedding(*set.resolved));
  fmt::print("made and certified in {:.2f} s\n", watch.lap());
  // files
  std::vector<TimedFile> files = emit_all(set, options.languages);
  write_files(options.out, options.keeps_same, files);
  for (const auto& [file, seconds] : files)
    fmt::print("wrote {}: {} bytes in {:.3f} s\n", file.name, file.text.size(), seconds);
  return 0;
}

}  // namespace tegl::gen
