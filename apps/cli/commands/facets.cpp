// SPDX-License-Identifier: BSD-3-Clause
//
// Extracts, checks, writes and reports contours as facets.
#include "commands/facets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/numbers.hpp"
#include "input/extraction.hpp"
#include "io/meshes/facets.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, const char*>, 4> kFacetNames = {
    {{"point", "points"}, {"segment", "segments"}, {"polygon", "polygons"}, {"polyhedron", "polyhedra"}}};

std::string facets_text(const FacetsResult& result) {
  std::string text;
  for (int k = 0; k < result.image_dim; ++k) {
    const auto& [singular, plural] = kFacetNames.at(static_cast<std::size_t>(k));
    text += (k == 0 ? "" : ", ") + counted(result.facets.at(static_cast<std::size_t>(k)), singular, plural);
  }
  return text;
}

std::string fault_text(const FacetReport& report) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(count), what);
  };
  add(report.branching, "ridges that bound neither one nor two facets");
  add(report.conflicts, "orientation conflicts");
  add(report.open_boundaries, "facets with an open boundary");
  return text;
}

/// The polyhedra whose Euler characteristic is not that of a ball, as text; empty if there are none.
std::string unlike_balls(const FacetReport& report) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* of) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, "polyhedron", "polyhedra") + of;
  };
  add(report.below_zero, " with several handles");
  add(report.tori, " with one handle (as a solid torus)");
  add(report.above_one, " with cavities");
  return text;
}

/// The tiles of an image, with those across the seam of periodic axes.
template <int N>
std::uint64_t tiles_of(const Grid<N>& grid, const AxisPeriods<N>& periods) {
  std::uint64_t tiles = 1;
  for (int a = 0; a < N; ++a) tiles *= grid.axes[a].size() - (periods[a] != 0.0 ? 0 : 1);
  return tiles;
}

template <int N, class Real>
ExtractStats stats_of(const FacetHierarchy<N, Real>& facets, std::uint64_t tiles, double seconds) {
  ExtractStats stats;
  stats.tiles = tiles;
  const auto& places = facets.levels[N - 1].places;
  stats.active_tiles = static_cast<std::uint64_t>(std::count_if(
      places.begin(), places.end(), [](const FacetPlace& place) { return place.number == 0 && !place.is_cap; }));
  stats.generate_seconds = seconds;
  return stats;
}

/// Extracts the facets of an image at the isovalues one after the other and passes them to use(i, facets, number of
/// tiles).
template <class T, int N, class Use>
void use_facets(const OwnedImage<T, N>& image, const FacetsWork& work, const std::vector<double>& isovalues,
                const ExtractOptions& options, const Use& use) {
  const AxisPeriods<N> periods = periods_of(image.grid, work.periodic);
  const auto extract_all = [&]<class Real>(Real) {
    const auto use_of_cells = [&](std::size_t i, const FacetHierarchy<N, Real>& facets) {
      use(i, facets, facets.cells);
    };
    if (work.lattice)
      return extract_facets_several<Real>(image.view(), *work.lattice, isovalues, use_of_cells, options, periods);
    if (work.division)
      return extract_facets_several<Real>(image.view(), *work.division, isovalues, use_of_cells, options, periods);
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
      ExtractOptions one = options;
      if (options.work.progress)
        one.work.progress = [&, done = static_cast<double>(i)](double fraction) {
          return options.work.progress((done + fraction) / static_cast<double>(isovalues.size()));
        };
      use(i, extract_facets<Real>(image.view(), isovalues[i], one, periods), tiles_of(image.grid, periods));
    }
  };
  work.single_precision ? extract_all(float{}) : extract_all(double{});
}

template <int N, class Real>
void check_and_write(const FacetHierarchy<N, Real>& facets, const FacetsWork& work, ProgressBar& bar,
                     FacetsResult& result, WrittenFiles& written) {
  for (int k = 0; k < N; ++k) result.facets.at(static_cast<std::size_t>(k)) = facets.count(k);
  Stopwatch watch;
  if (!work.no_check) {
    result.report = check(facets, {.progress = bar.stage("check")});
    result.seconds.check = watch.lap();
  }
  const Progress progress = bar.stage("write");
  result.output_bytes = written.write(result.output, [&](const PendingPath& file) {
    write_facets(facets, file, {.work = {.progress = progress}, .compression = work.compression});
  });
  result.seconds.write = watch.lap();
}

/// Extracts the facets of a complex, sets their axes with set_axes(facets), and writes them. Adds to the time to
/// generate them.
template <int N, class SetAxes>
void write_facets_of(const Complex<N>& complex, const SetAxes& set_axes, const FacetsWork& work, ProgressBar& bar,
                     FacetsResult& result, WrittenFiles& written) {
  Stopwatch watch;
  const auto finish = [&](auto facets) {
    set_axes(facets);
    result.seconds.generate += watch.lap();
    result.stats = stats_of(facets, facets.cells, result.seconds.generate);
    check_and_write(facets, work, bar, result, written);
  };
  work.single_precision ? finish(extract_facets<float>(complex, work.isovalue, work.options))
                        : finish(extract_facets<double>(complex, work.isovalue, work.options));
}

[[noreturn]] void fail_output(const fs::path& output, std::string_view why) {
  throw Error(ErrorCode::WriteFailed, fmt::format("{}: {}", output.string(), why));
}

bool has_extension(const fs::path& output, std::string_view extension) {
  return equal_ignoring_case(output.extension().string(), extension);
}

}  // namespace

Json to_json(const FacetsResult& result) {
  Json json;
  json["input"] = result.input.json();
  json["variable"] = result.variable.empty() ? Json(nullptr) : Json(result.variable);
  json["output"] = result.output;
  json["image_dim"] = result.image_dim;
  json["isovalue"] = result.isovalue;
  Json& facets = json["facets"];
  for (int k = 0; k < result.image_dim; ++k)
    facets[kFacetNames.at(static_cast<std::size_t>(k)).second] = result.facets.at(static_cast<std::size_t>(k));
  const auto of = [&](auto member) { return result.report ? Json((*result.report).*member) : Json(nullptr); };
  json["components"] = of(&FacetReport::components);
  json["euler"] = of(&FacetReport::euler);
  json["unlike_balls"] = {{"euler_below_0", of(&FacetReport::below_zero)},
                          {"euler_0", of(&FacetReport::tori)},
                          {"euler_above_1", of(&FacetReport::above_one)}};
  json["boundary_facets"] = of(&FacetReport::border);
  json["nonmanifold_facets"] = of(&FacetReport::branching);
  json["orientation_conflicts"] = of(&FacetReport::conflicts);
  json["open_boundaries"] = of(&FacetReport::open_boundaries);
  json["tiles"] = result.stats.tiles;
  json["active_tiles"] = result.stats.active_tiles;
  json["seconds"] = {{"read", result.seconds.read},
                     {"generate", result.seconds.generate},
                     {"check", result.seconds.check},
                     {"write", result.seconds.write},
                     {"total", result.seconds.total()}};
  return json;
}

std::string to_text(const Console& console, const FacetsResult& result) {
  std::string text = fmt::format("{}\n", console.bold(fmt::format("Facets of the contour in {}D of the isovalue {}",
                                                                  result.image_dim, number(result.isovalue))));
  text += input_line(result.input, result.variable);
  text += report_line("tiles",
                      fmt::format("{} active of {}", grouped(result.stats.active_tiles), grouped(result.stats.tiles)));
  text += report_line("facets", facets_text(result));
  if (result.report) {
    const FacetReport& report = *result.report;
    text += report_line("components", grouped(report.components));
    text += report_line("Euler", fmt::format("{}", report.euler));
    const std::string others = unlike_balls(report);
    if (!others.empty()) text += report_line("", others);
    const auto& [singular, plural] = kFacetNames.at(static_cast<std::size_t>(result.image_dim - 2));
    text += report_line("border", report.border == 0 ? "none: closed" : counted(report.border, singular, plural));
    const std::string faults = fault_text(report);
    text += report_line(
        "check", faults.empty() ? console.green("oriented; at most two facets at each ridge") : console.red(faults));
  } else {
    text += report_line("check", "skipped");
  }
  text += report_line("seconds", fmt::format("{:.3f}", result.seconds.total()));
  return text + report_line("output", fmt::format("{} ({})", result.output, byte_size(result.output_bytes)));
}

void require_facets_output(const fs::path& output, const std::vector<std::string>& inputs) {
  if (!has_extension(output, ".vtu") && !has_extension(output, ".vtkhdf"))
    fail_output(output, fmt::format("'{}' cannot hold facets; expected .vtu, or for 2D and 3D images .vtkhdf",
                                    output.extension().string()));
  require_text_output(output, inputs);
}

void refuse_with_facets(const ExtractionOptions& extraction, bool is_streamed, bool has_attributes) {
  const auto given = extraction.given();
  if (is_streamed || std::find(given.begin(), given.end(), "--triangulation") != given.end())
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format(
            "--facets with {}; expected one of the two: facets need the image in memory and are not triangulated",
            is_streamed ? "--stream" : "--triangulation " + extraction.triangulation()));
  if (extraction.wants_shape_normals() || has_attributes)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--facets with {}, which is for simplices; expected {}",
                                                        has_attributes ? "--attribute" : "--normals geometric or flat",
                                                        has_attributes ? "none" : "normals from the gradient"));
}

void require_output_holds_facets(const fs::path& output, int image_dim) {
  if (image_dim == 4 && !has_extension(output, ".vtu"))
    fail_output(output, fmt::format("'{}' cannot hold the polyhedra of a 4D contour; expected .vtu",
                                    output.extension().string()));
}

void write_image_facets(const AnyImage& image, const FacetsWork& work, ProgressBar& bar,
                        std::vector<FacetsResult>& results, WrittenFiles& written) {
  ExtractOptions options = work.options;
  options.work.progress = bar.stage("facets");
  std::vector<double> isovalues;
  for (const FacetsResult& result : results) isovalues.push_back(result.isovalue);
  Stopwatch watch;
  const auto finish = [&](std::size_t i, const auto& facets, std::uint64_t tiles) {
    FacetsResult& result = results[i];
    result.seconds.generate = watch.lap();
    result.stats = stats_of(facets, tiles, result.seconds.generate);
    check_and_write(facets, work, bar, result, written);
    (void)watch.lap();
  };
  std::visit(
      [&](const auto& typed) {
        std::visit([&](const auto& owned) { use_facets(owned, work, isovalues, options, finish); }, typed);
      },
      image);
}

std::vector<FacetsResult> write_mesh_facets(const MeshInput& input, const InputFiles& files, double read_seconds,
                                            const std::vector<SpelledNumber>& isovalues,
                                            const std::vector<std::string>& outputs, FacetsWork work,
                                            ProgressBar& bar) {
  std::vector<FacetsResult> results(isovalues.size());
  WrittenFiles written;
  for (std::size_t i = 0; i < results.size(); ++i) {
    FacetsResult& result = results[i];
    result.input = files;
    result.variable = input.mesh.variable;
    result.output = outputs[i];
    result.image_dim = input.space_dim();
    result.isovalue = work.isovalue = isovalues[i].value;
    result.seconds.read = std::exchange(read_seconds, 0.0);
    require_output_holds_facets(result.output, result.image_dim);
    require_mesh_contour(input.mesh, work.isovalue, work.allows_empty, work.options.ambiguity);
    work.options.work.progress = bar.stage("facets");
    const auto set_axes = [&](auto& facets) {
      const std::vector<std::string>& names = input.mesh.axis_names;
      for (std::size_t a = 0; a < facets.axis_names.size(); ++a)
        facets.axis_names[a] = a < names.size() ? names[a] : std::string("t");
    };
    std::visit([&](const auto& complex) { write_facets_of(complex, set_axes, work, bar, result, written); },
               input.complex);
  }
  written.keep();
  bar.clear();
  return results;
}

std::variant<Extraction<3, float>, Extraction<3, double>> triangulated_polygons(const AnyImage& image,
                                                                                const FacetsWork& work,
                                                                                PolygonTriangulation method,
                                                                                ProgressBar& bar) {
  using Triangles = std::variant<Extraction<3, float>, Extraction<3, double>>;
  const auto* const typed = std::get_if<AnyImageN<3>>(&image);
  if (typed == nullptr)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--triangulation is for the polygons of 3D images; the image "
                                                        "has {} dimensions: expected compact or barycentric",
                                                        image_dim(image)));
  ExtractOptions options = work.options;
  options.work.progress = bar.stage("facets");
  Stopwatch watch;
  Triangles triangles;
  const auto triangulated = [&]<class Real>(std::size_t, const FacetHierarchy<3, Real>& facets, std::uint64_t tiles) {
    auto contour = triangulate(facets, method, {work.options.work.threads, bar.stage("triangles")});
    triangles = Extraction<3, Real>{std::move(contour), stats_of(facets, tiles, watch.lap())};
  };
  std::visit([&](const auto& owned) { use_facets(owned, work, {work.isovalue}, options, triangulated); }, *typed);
  return triangles;
}

}  // namespace tegl::cli
