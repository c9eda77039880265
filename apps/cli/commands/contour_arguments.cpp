// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the options of `tegl contour`.
#include "commands/contour_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/numbers.hpp"
#include "commands/facets.hpp"
#include "input/cuts.hpp"

namespace tegl::cli {
namespace {

constexpr const char* kPick = "--pick";

/// Whether an option of images with plain cells is also one of images on lattices.
bool knows_lattices(std::string_view option) { return option == kFacets || option == kPick; }

}  // namespace

void ContourArguments::add_to(CLI::App& app, const ImageOptions& images) {
  app_ = &app;
  images_ = &images;
  extraction.add_to(app, true);
  extraction.add_tiling_to(
      app, {"--index", "--pick", "--merge", "--merge-within", "--one-file", "--positions", "--scale-space"});
  app.add_flag("--unroll", unroll,
               "with --periodic, .vtkhdf: double the vertices on the seam, for pictures; other formats always do");
  app.add_option("-o,--output", output,
                 std::string("the result: ") + kContourFiles +
                     "; with --facets .vtu or, in 2D and 3D, .vtkhdf; with several isovalues, {iso} in the name is "
                     "replaced by the isovalue and {n} by its position")
      ->type_name("FILE")
      ->required();
  app.add_flag("--one-file", one_file,
               "several isovalues: all contours in one file, with the isovalue as an attribute");
  app.add_flag("--facets", facets, "the contour without triangulation: segments, polygons or polyhedra");
  app.add_flag("--no-check", no_check, "skip the check of the result");
  app.add_option("--index", index, "an index of the image's active tiles, written by 'tegl index'")->type_name("FILE");
  app.add_option("--pick", pick,
                 "only the component nearest to the point x,y,z (x,y in 2D, x,y,z,t in 4D), in the units of the "
                 "image's axes")
      ->type_name("X,Y,Z[,T]");
  positions.add_to(app);
  merging.add_to(app);
  scales.add_to(app);
  attributes.add_to(app);
  compress.add_to(app);
  app.add_flag("--stream", stream,
               "read and write layer by layer, with little memory: one FILE of any format, --raw, or "
               "several FILEs, "
               "to .vtkhdf");
}

bool ContourArguments::picks() const { return app_->count("--pick") > 0; }

bool ContourArguments::is_streamed() const {
  if (stream || !images_->raw()) return stream;
  const auto sizes = app_->get_option("--raw")->as<std::string>();
  if (std::count(sizes.begin(), sizes.end(), 'x') >= 4) return false;  // 5D contours are made in memory
  Tiling tiling = extraction.tiling();
  if (!unroll) tiling.periodic.clear();  // periodic axes are streamed
  const bool needs_memory = !tiling.is_plain() || !index.empty() || facets || one_file || picks() ||
                            !positions.are_linear() || merging.are_given() || scales.are_given() ||
                            extraction.wants_shape_normals() || attributes.wanted() ||
                            extraction.polygon_triangulation();
  return !needs_memory && equal_ignoring_case(std::filesystem::path(output).extension().string(), ".vtkhdf");
}

bool ContourArguments::is_named_by_image() const {
  return positions.finds_isovalue(extraction) && output.find("{iso}") != std::string::npos;
}

bool ContourArguments::knows_curved_grids() const {
  return index.empty() && !extraction.polygon_triangulation() && !scales.are_given();
}

bool ContourArguments::takes_stored_integers(const ExtractOptions& options) const {
  return index.empty() && !scales.are_given() && positions.are_linear() && !positions.has_label() &&
         extraction.tiling().is_plain() && !extraction.polygon_triangulation() &&
         (options.ambiguity == Ambiguity::low || options.ambiguity == Ambiguity::high);
}

std::vector<double> ContourArguments::picked_point() const {
  if (!picks()) return {};
  if (is_streamed() || !index.empty() || facets)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--pick with {}; expected one of the two", !index.empty() ? "--index"
                                                                       : facets       ? "--facets"
                                                                                      : "--stream"));
  return parse_list("--pick", pick);
}

std::vector<std::string> ContourArguments::for_images() const {
  std::vector<std::string> given = {"--stream",    "--index",           "--pick",
                                    "--positions", "--positions-image", "--last-axis-weight",
                                    "--label",     "--scale-space",     "--factors"};
  std::erase_if(given, [&](const std::string& name) { return app_->count(name) == 0; });
  return given;
}

template <class Refuse>
void ContourArguments::for_plain_cells(const Refuse& refuse) const {
  if (is_streamed()) refuse(stream ? "--stream" : "--raw and a .vtkhdf output, which is streamed");
  if (!index.empty()) refuse("--index");
  if (facets) refuse(kFacets);
  if (picks()) refuse(kPick);
  if (one_file) refuse("--one-file");
  if (extraction.polygon_triangulation()) refuse("a triangulation of polygons");
}

void ContourArguments::require_tiling() const {
  if (unroll && extraction.tiling().periodic.empty())
    throw Error(ErrorCode::InvalidArgument, "--unroll without --periodic; expected both");
  if (unroll && (is_streamed() || facets))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--unroll with {}; expected one of the two", facets ? "--facets" : "--stream"));
  for_plain_cells([&](const char* with) {
    if (is_streamed() && extraction.tiling().lattice) return;
    if (knows_lattices(with) && extraction.tiling().lattice) return;
    if (with == std::string_view(kFacets) && extraction.tiling().division) return;
    // the file may name a lattice, for which --pick knows periodic axes: refuse_tiling_of_file decides
    const bool may_be_periodic = is_streamed() || facets || with == std::string_view(kPick);
    may_be_periodic ? extraction.refuse_other_tiling(with) : extraction.refuse_tiling(with);
  });
  if (attributes.wanted() && extraction.tiling().of_cells) extraction.refuse_tiling("--attribute");
}

void ContourArguments::require_positions() const {
  if (is_streamed()) positions.refuse("--stream");
  if (!index.empty()) positions.refuse("--index");
  if (facets) positions.refuse("--facets");
  if (picks()) positions.refuse("--pick");
  if (extraction.polygon_triangulation()) positions.refuse("a triangulation of polygons");
  const Tiling tiling = extraction.tiling();
  if (!tiling.is_plain() && !tiling.of_cells) positions.refuse(extraction.given_tiling());
  positions.require();
}

void ContourArguments::require_merging() const {
  if (is_streamed()) merging.refuse("--stream");
  if (facets) merging.refuse("--facets");
  if (one_file) merging.refuse("--one-file");
  if (!extraction.tiling().periodic.empty()) merging.refuse("--periodic");
  (void)merging.tolerance();
}

void ContourArguments::require_scale_space() {
  scales.require();
  scales.refuse(!index.empty(), "--index");
  scales.refuse(facets, "--facets");
  scales.refuse(attributes.wanted(), "--attribute");
  scales.refuse(!extraction.tiling().is_plain() && !extraction.tiling().of_cells, extraction.given_tiling());
}

void ContourArguments::require_one_file_of_several(std::size_t isovalues) const {
  if (!one_file) return;
  if (isovalues < 2)
    throw Error(ErrorCode::InvalidArgument, "--one-file with one isovalue; expected several, as in --iso 20,25,30");
  if (is_streamed() || facets)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--one-file with {}; expected a file for each isovalue, as in -o 'out_{{iso}}.vtkhdf'",
                            facets ? "--facets" : "--stream"));
  for (const char* const place : {"{iso}", "{n}"})
    if (output.find(place) != std::string::npos)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("--output is '{}' with --one-file; expected a name without {}, for one file", output, place));
}

void ContourArguments::require_to_5d() const {
  extraction.require_to_5d();
  for (const char* const name : {"--index", "--pick", "--merge", "--merge-within", "--one-file"})
    if (app_->get_option_no_throw(name) != nullptr && app_->count(name) > 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} with an image of 5 axes; expected 2 to 4 axes", name));
  if (attributes.wanted())
    throw Error(ErrorCode::InvalidArgument, "--attribute with an image of 5 axes; expected 2 to 4 axes");
}

void ContourArguments::refuse_tiling_of_file(const ImageInfo& info, const std::string& file) const {
  for_plain_cells([&](const char* with) {
    extraction.refuse_cells(info.samples_are_cells, file, with);
    if (!is_streamed() && !knows_lattices(with)) extraction.refuse_lattice(info, file, with);
  });
  if (picks() && !extraction.has_lattice(info)) extraction.refuse_periodic_with(kPick);
  if (attributes.wanted()) extraction.refuse_cells(info.samples_are_cells, file, "--attribute");
  if (!positions.are_linear()) extraction.refuse_lattice(info, file, "--positions");
}

}  // namespace tegl::cli
