// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --certify` for tables, for tables by class, and for tiles with freely resolved ambiguities.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "cells/cell.hpp"
#include "filling/facets.hpp"
#include "filling/resolutions.hpp"
#include "program/commands.hpp"
#include "program/print_figures.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "symmetry/transversal.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

namespace {

/// `--certify --table-by-class`: prints the figures of all pairs, then throws if any pair leaves a hole.
int certify_by_class(const Options& options) {
  const CubeLattice lattice(options.dim);
  const ContourBuilder builder(lattice, options.dim, Alternative::low, Triangulation::compact);
  const auto contours = contours_by_class(builder, options.group, options.inversion);
  const auto classes =
      transversal(options.dim, group(options.dim, options.group, options.inversion)).representatives.size();
  const PairFigures pairs = certify_pairs(builder, contours);
  const char* const group_name = options.group == GroupKind::Full ? "full" : "rotations";
  if (options.json)
    fmt::print(
        "{{\"dim\": {}, \"table\": \"by class\", \"group\": \"{}\", \"inversion\": {}, \"classes\": {}, \"pairs\": {}, "
        "\"unmatched_pairs\": {}}}\n",
        options.dim, group_name, options.inversion, classes, pairs.pairs, pairs.unmatched);
  else
    fmt::print("{}-tile, table by class: group {}{}, {} classes\n  neighbours   {} pairs, {} do not match\n",
               options.dim, group_name, options.inversion ? " with inversion" : "", classes, pairs.pairs,
               pairs.unmatched);
  if (pairs.unmatched != 0) {
    std::fflush(stdout);
    throw Error(ErrorCode::CertificateFailed, unmatched_text(options.dim, pairs));
  }
  return 0;
}

/// Name of a closed oriented surface by its Euler characteristic 2 - 2 g, g the genus.
std::string surface_name(int euler) {
  if (euler == 2) return "sphere";
  if (euler == 0) return "torus";
  return fmt::format("genus {}", (2 - euler) / 2);
}

void print_resolutions(const Options& options, const ResolutionFigures& f, std::uint64_t single, double seconds) {
  const std::string_view tile = options.tile == TileKind::cube ? "tile" : tile_text(options);
  if (options.all_resolutions) {
    fmt::print("{}-{}, every resolution of its ambiguous faces of dimension 2\n", options.dim, tile);
    fmt::print("  pairs          {} of a signature and a resolution, in {} classes of signatures\n", f.pairs,
               f.classes);
    fmt::print("  up to symmetry {} of one signature of each class, {} also up to the signature's own symmetries\n",
               f.pairs_by_class, f.orbits);
  } else {
    fmt::print("{}-{}, a sample: signatures and choices in all faces at random, seed {}\n", options.dim, tile,
               options.seed);
  }
  fmt::print("  certified      {} tiles in {:.1f} s, each with the contours in its faces; no failure\n",
             f.tiles + single, seconds);
  if (single > 0)
    fmt::print("                 {} of them one for each pair, without symmetry: the same figures\n", single);
  fmt::print("  facets         {} filled by a simplex, {} by a cone, {} from the side\n", f.by_filling[0],
             f.by_filling[1], f.by_filling[2]);
  if (options.dim > 3 && options.dim % 2 == 0) {
    fmt::print("  non-spherical  {} pairs", f.non_spherical);
    if (options.all_resolutions) fmt::print(", {} classes", f.classes_with_non_spherical);
    fmt::print("{}\n", options.all_resolutions ? "; filled in both ways" : "");
  }
  if (f.tiles > 0)
    fmt::print("  simplices      {:.2f} per tile, at most {}\n",
               static_cast<double>(f.simplices) / static_cast<double>(f.tiles), f.max_simplices);
  if (options.dim % 2 == 1) {  // Sigma has odd dimension
    std::uint64_t components = 0;
    for (const auto& [euler, count] : f.euler) components += count;
    fmt::print("  components     {} of Sigma, all of Euler characteristic 0, as in every odd dimension\n", components);
    return;
  }
  fmt::print("\n    Euler characteristic   components of Sigma\n");
  for (auto at = f.euler.rbegin(); at != f.euler.rend(); ++at)
    fmt::print("    {:>20}   {:>19}{}\n", at->first, at->second,
               options.dim == 4 ? fmt::format("   {}", surface_name(at->first)) : "");
}

void print_resolutions_json(const Options& options, const ResolutionFigures& f, std::uint64_t single, double seconds) {
  std::vector<std::string> euler;
  for (const auto& [value, count] : f.euler) euler.push_back(fmt::format("\"{}\": {}", value, count));
  const std::string what =
      options.all_resolutions
          ? fmt::format("\"classes\": {}, \"classes_with_non_spherical\": {}", f.classes, f.classes_with_non_spherical)
          : fmt::format("\"sample\": {}, \"seed\": {}", options.sample, options.seed);
  fmt::print(
      "{{\"tile\": \"{}\", \"dim\": {}, {}, \"pairs\": {}, \"pairs_up_to_symmetry\": {}, \"orbits\": {}, "
      "\"certified_tiles\": {}, \"tiles_without_symmetry\": {}, "
      "\"non_spherical_pairs\": {}, \"facets\": {{\"simplex\": {}, \"cone\": {}, \"side\": {}}}, \"simplices\": {}, "
      "\"max_simplices\": {}, \"euler\": {{{}}}, \"seconds\": "
      "{:.1f}}}\n",
      tile_text(options), options.dim, what, f.pairs, f.pairs_by_class, f.orbits, f.tiles + single, single,
      f.non_spherical, f.by_filling[0], f.by_filling[1], f.by_filling[2], f.simplices, f.max_simplices,
      fmt::join(euler, ", "), seconds);
}

/// Writes the percentage done to standard error if that is a terminal.
class ProgressLine {
 public:
  ~ProgressLine() {
    if (last_ >= 0) fmt::print(stderr, "\r                    \r");
  }
  Progress callback() {
    if (isatty(STDERR_FILENO) == 0) return {};
    return [this](double done) {
      const int percent = static_cast<int>(100 * done);
      if (percent == last_) return;
      last_ = percent;
      fmt::print(stderr, "\rcertified {:>3} %", percent);
      std::fflush(stderr);
    };
  }

 private:
  int last_ = -1;
};

/// Most pairs of a signature and a resolution that are certified one by one, too: all cells but the hexahedron over
/// time, which is the cube of four dimensions.
constexpr std::uint64_t kMaxSinglePairs = std::uint64_t{1} << 20;

/// Certifies the pairs of a cell again, without symmetries. Returns the number of tiles, 0 if there are too many pairs.
/// Throws Error{CountMismatch} if the figures differ.
std::uint64_t certify_single_pairs(const Options& options, const Cell& cell, const ResolutionFigures& by_symmetry,
                                   const Progress& progress) {
  if (by_symmetry.pairs > kMaxSinglePairs) return 0;
  const ResolutionFigures single =
      certify_all_resolutions(cell.lattice, single_signatures(cell.tile), options.threads, progress);
  if (single.pairs != by_symmetry.pairs || single.non_spherical != by_symmetry.non_spherical ||
      single.euler != by_symmetry.euler)
    throw Error(ErrorCode::CountMismatch,
                fmt::format("{} pairs of a signature and a resolution one by one, {} of them non-spherical; {} and {} "
                            "by symmetry: expected the same, with the same Euler characteristics",
                            single.pairs, single.non_spherical, by_symmetry.pairs, by_symmetry.non_spherical));
  return single.tiles;
}

int certify_resolutions(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  ResolutionFigures figures;
  std::uint64_t single = 0;
  {
    ProgressLine line;
    const Progress progress = line.callback();
    if (options.cell == nullptr) {
      figures = options.all_resolutions ? certify_all_resolutions(options.tile, options.dim, options.threads, progress)
                                        : certify_sample(options.tile, options.dim, options.sample, options.seed,
                                                         options.threads, progress);
    } else {
      const Cell cell = mesh_cell(options.cell->shape);
      if (options.all_resolutions) {
        figures = certify_all_resolutions(cell.lattice, tile_classes(cell.tile), options.threads, progress);
        single = certify_single_pairs(options, cell, figures, progress);
      } else {
        figures = certify_sample(cell.lattice, options.sample, options.seed, options.threads, progress);
      }
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  options.json ? print_resolutions_json(options, figures, single, seconds)
               : print_resolutions(options, figures, single, seconds);
  return 0;
}

}  // namespace

namespace {

std::string searches_text(const CertifiedFigures& f) {
  std::vector<std::string> entries;
  for (const SearchedEntry& e : f.searches)
    entries.push_back(fmt::format("{} ({}, {})", e.signature, e.entries, e.pairs));
  return fmt::format("{}", fmt::join(entries, ", "));
}

}  // namespace

void print_figures(TileKind tile, int dim, const CertifiedFigures& f) {
  fmt::print("{}-{}, {} alternative, {} triangulation\n", dim, tile == TileKind::cube ? "tile" : tile_kind_name(tile),
             alternative_name(f.alternative), triangulation_name(f.triangulation));
  fmt::print("  certified    all {} signatures\n", f.signatures);
  fmt::print("  facets       {} (at most {} in a tile): {} around spheres, {} around others", f.facets, f.max_facets,
             f.spheres, f.others);
  if (f.others != 0)
    fmt::print(" (genus up to {}) in {} signatures, {} classes: {}", f.highest_genus, f.signatures_with_others,
               f.classes_with_others.size(), fmt::join(f.classes_with_others, " "));
  const auto of = [&](Filling filling) { return f.by_filling[static_cast<std::size_t>(filling)]; };
  fmt::print("\n  filled by    simplex {}, cone {}, own vertices {}, side {}\n", of(Filling::simplex),
             of(Filling::cone), of(Filling::pulled), of(Filling::side));
  fmt::print("  simplices    {}: {:.2f} per signature, at most {}\n", f.simplices,
             static_cast<double>(f.simplices) / static_cast<double>(f.signatures), f.max_simplices);
  fmt::print("  embedded     {} proved for all positions", f.embedded);
  if (f.searched != 0) fmt::print(", {} searched", f.searched);
  fmt::print("\n");
  if (f.searched != 0) {
    fmt::print("  searched     {} classes, {} positions each, seed {}: no intersection\n", f.searches.size(),
               f.plan.positions(), f.plan.seed);
    fmt::print("               signature (entries, pairs not proved): {}\n", searches_text(f));
  }
  if (f.pairs.pairs != 0) fmt::print("  neighbours   {} pairs, all match\n", f.pairs.pairs);
}

std::string figures_json(const CertifiedFigures& f) {
  return fmt::format(
      "{{\"alternative\": \"{}\", \"triangulation\": \"{}\", \"signatures\": {}, \"passed\": {}, \"facets\": {}, "
      "\"max_facets\": {}, \"spherical\": {}, \"non_spherical\": {}, \"signatures_with_non_spherical\": {}, "
      "\"classes_with_non_spherical\": [{}], \"highest_genus\": {}, \"simplices\": {}, \"max_simplices\": {}, "
      "\"mean_simplices\": {:.4f}, {}, \"pairs\": {}, "
      "\"unmatched_pairs\": {}}}",
      alternative_name(f.alternative), triangulation_name(f.triangulation), f.signatures, f.signatures, f.facets,
      f.max_facets, f.spheres, f.others, f.signatures_with_others, fmt::join(f.classes_with_others, ", "),
      f.highest_genus, f.simplices, f.max_simplices,
      static_cast<double>(f.simplices) / static_cast<double>(f.signatures), evidence_json(f), f.pairs.pairs,
      f.pairs.unmatched);
}

int run_certify(const Options& options) {
  if (options.table_by_class) return certify_by_class(options);
  if (options.all_resolutions || options.sample > 0) return certify_resolutions(options);
  if (options.cell != nullptr) return run_cell_certify(options);
  const auto figures = certify_all(options.dim, options.tile);
  if (!options.json) {
    for (const CertifiedFigures& f : figures) print_figures(options.tile, options.dim, f);
    return 0;
  }
  std::vector<std::string> parts;
  for (const CertifiedFigures& f : figures) parts.push_back(figures_json(f));
  fmt::print("{{\"tile\": \"{}\", \"dim\": {}, \"certified\": [\n  {}\n]}}\n", tile_kind_name(options.tile),
             options.dim, fmt::join(parts, ",\n  "));
  return 0;
}

}  // namespace tegl::gen
