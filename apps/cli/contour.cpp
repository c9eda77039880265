// SPDX-License-Identifier: BSD-3-Clause
//
// tegl contour: the contour of an image, in the dimension that the file holds.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "attributes.hpp"
#include "commands.hpp"
#include "extraction.hpp"
#include "facets.hpp"
#include "numbers.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "result.hpp"
#include "streaming.hpp"
#include "tegl/active_tiles_io.hpp"
#include "tegl/pick.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tegl contour head.nii.gz --iso 60 -o head.ply\n"
    "  tegl contour terrain.nrrd --iso 600 -o lines.glb --json\n"
    "  tegl contour head.nii.gz --iso 60 --pick 12.5,-40,8 -o bone.ply\n"
    "  tegl contour ocean.nc --var TEMP --iso 20 --close -o warm_water.vtkhdf\n"
    "  tegl contour head.nii.gz --index head.nii.gz.tindex --iso 60 -o head.ply\n"
    "  tegl contour head.nii.gz --iso 60 --triangulation halving-chord -o head.ply\n"
    "  tegl contour ocean.nc --var TEMP --iso 20 --facets -o polyhedra.vtu\n"
    "  tegl contour flow.raw --raw 512x512x512x1000 --raw-type float --iso 0.1 -o flow.vtkhdf\n"
    "A file of 2, 3 or 4 dimensions gives segments, triangles or tetrahedra. Cut the latter with 'tegl slice'.";

class ContourCommand final : public Command {
 public:
  explicit ContourCommand(CLI::App& program)
      : Command(program, "contour", "The contour of an image in 2D, 3D or 4D",
                "the image: NIfTI, NRRD, MetaImage, netCDF (.nc, also gzipped) or DICOM (a folder); several files are "
                "one image with an axis "
                "more",
                Files::image) {
    options_.add_to(app(), true);
    app()
        .add_option("-o,--output", output_,
                    "the result: .ply, .gltf, .glb (2D and 3D) or .vtkhdf (4D too); with --facets .vtu or, in 2D and "
                    "3D, .vtkhdf")
        ->required();
    app().add_flag("--facets", facets_, "the contour without triangulation: segments, polygons or polyhedra");
    app().add_flag("--no-check", no_check_, "leave out the check of the result");
    app().add_option("--index", index_, "an index of the image's active tiles that 'tegl index' wrote");
    app().add_option(
        "--pick", pick_,
        "this component only: the one nearest to the point x,y,z (x,y in 2D, x,y,z,t in 4D) in the units of "
        "the image's axes");
    attributes_.add_to(app());
    app().add_flag(
        "--stream", stream_,
        "read layer by layer and write as it comes, with little memory: netCDF, HDF5, --raw, or several FILEs, "
        "to .vtkhdf");
    add_image_options();
    add_quiet();
    app().footer(kExamples);
  }

  ExitCode run(const Streams& streams) override {
    const double isovalue = options_.isovalue();
    if (!index_.empty() && facets_)
      throw Error(ErrorCode::InvalidArgument, "--facets with --index; expected one of the two");
    const std::vector<double> point = picked_point();
    ExtractOptions options = options_.library_options((!is_streamed() && index_.empty() && point.empty()) || facets_);
    require_inputs();
    if (facets_) return run_facets(streams, {isovalue, options, options_.single_precision(), no_check_});
    require_output(output_, files());
    if (!index_.empty()) {
      require_input(index_);
      if (is_streamed())
        throw Error(ErrorCode::InvalidArgument, "--index is for images in memory; expected no --stream and no --raw");
    }
    attributes_.require_inputs();

    ProgressBar bar(streams.err, wants_progress());
    ContourResult result;
    if (!point.empty()) result.picked = Picked{point, {}, 0, 0, 0};
    result.input = inputs();
    result.output = output_;
    result.isovalue = isovalue;
    if (is_streamed())
      stream(options, bar, result);
    else
      contour(options, bar, result);
    bar.clear();
    if (!quiet()) streams.out.write(json() ? dump(to_json(result)) : to_text(streams.out, result));
    return result.exit_code();
  }

 private:
  void contour(ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    Stopwatch watch;
    ReadImageResult input = read(bar.stage("read"));
    result.variable = input.info.variable;
    result.image_dim = image_dim(input.image);
    require_output_holds(output_, result.image_dim - 1);
    require_contour(input, *result.isovalue);
    result.seconds.read = watch.lap();

    if (result.picked) {
      options.progress = bar.stage("contour");
      pick(input.image, options, bar, result);
      return finish(input, {}, bar, result);
    }
    ExtractStats& stats = result.stats.emplace();
    if (const auto method = options_.polygon_triangulation()) {
      auto polygons = triangulated_polygons(
          input.image, {*result.isovalue, options, options_.single_precision(), no_check_}, *method, bar, stats);
      result.mesh =
          std::visit([&](auto& contour) { return with_additions(std::move(contour), options.threads, bar); }, polygons);
      return finish(input, stats, bar, result);
    }
    options.progress = bar.stage("contour");
    result.mesh =
        index_.empty()
            ? extract_any<Mesh>(input.image, *result.isovalue, options, options_.single_precision(), stats,
                                [&](auto contour) { return with_additions(std::move(contour), options.threads, bar); })
            : extract_by_index(input.image, options, bar, result);
    finish(input, stats, bar, result);
  }

  void finish(ReadImageResult& input, const ExtractStats& stats, ProgressBar& bar, ContourResult& result) const {
    result.seconds.add(stats);
    if (result.mesh.simplices.empty()) fail_without_contour(*result.isovalue);
    input.image = AnyImage();  // its memory is of more use to the check
    if (!no_check_) check_result(result, bar);
    write_result(result, bar);
  }

  /// Whether layers come in and the contour goes out as it comes.
  [[nodiscard]] bool is_streamed() const { return stream_ || images().raw(); }

  /// --pick as numbers; none without.
  [[nodiscard]] std::vector<double> picked_point() {
    std::vector<double> point;
    if (app().count("--pick") == 0) return point;
    if (is_streamed() || !index_.empty() || facets_)
      throw Error(ErrorCode::InvalidArgument,
                  "--pick finds tiles from its point, in memory; expected no --index, --facets, --stream or --raw");
    for (std::size_t at = 0; at <= pick_.size();) {
      const std::size_t comma = std::min(pick_.find(',', at), pick_.size());
      point.push_back(parse_finite("--pick", std::string_view(pick_).substr(at, comma - at)));
      at = comma + 1;
    }
    return point;
  }

  /// The component nearest to the point of --pick.
  void pick(const AnyImage& image, const ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    Stopwatch watch;
    Picked& picked = *result.picked;
    const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      if (picked.point.size() != N)
        throw Error(ErrorCode::InvalidArgument, fmt::format("--pick {} has {} numbers; expected {}, one for each axis",
                                                            pick_, picked.point.size(), N));
      std::array<double, N> point;
      std::copy_n(picked.point.begin(), N, point.begin());
      PickReport<N> report;
      const auto keep = [&](auto contour) {
        picked.tile.assign(report.at.begin(), report.at.end());
        picked.distance = report.distance;
        picked.tiles = report.tiles;
        picked.components = report.components;
        return with_additions(std::move(contour), options.threads, bar);
      };
      return options_.single_precision()
                 ? keep(extract_component<float>(owned.view(), *result.isovalue, point, options, &report))
                 : keep(extract_component<double>(owned.view(), *result.isovalue, point, options, &report));
    };
    result.mesh = std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
    result.seconds.generate += watch.lap();
  }

  /// The contour with what --normals and --attribute add to it.
  template <class AnyContour>
  Mesh with_additions(AnyContour contour, unsigned threads, ProgressBar& bar) const {
    options_.add_shape_normals(contour);
    attributes_.sample_to(contour, threads, bar);
    return to_mesh(contour);
  }

  /// The contour by --index, whose reading counts as such.
  Mesh extract_by_index(const AnyImage& image, ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    const auto of_owned = [&](const auto& owned) {
      Stopwatch watch;
      const auto view = owned.view();
      const auto active = read_active_tiles(index_, view, {.threads = options.threads, .progress = bar.stage("index")});
      result.seconds.read += watch.lap();
      options.progress = bar.stage("contour");
      if (options_.single_precision())
        return with_additions(extract<float>(view, *result.isovalue, options, *active, &*result.stats), options.threads,
                              bar);
      return with_additions(extract<double>(view, *result.isovalue, options, *active, &*result.stats), options.threads,
                            bar);
    };
    return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
  }

  ExitCode run_facets(const Streams& streams, const FacetsWork& work) const {
    const auto given = options_.given();
    if (is_streamed() || std::find(given.begin(), given.end(), "--triangulation") != given.end())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--facets with {}; expected one of the two: facets are in memory and not triangulated",
                              is_streamed() ? "--stream or --raw" : "--triangulation"));
    if (options_.wants_shape_normals() || attributes_.wanted())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--facets with {}, which is for simplices; expected {}",
                              attributes_.wanted() ? "--attribute" : "--normals geometric or flat",
                              attributes_.wanted() ? "none" : "--normals gradient or sobel"));
    require_facets_output(output_, files());
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const ReadImageResult input = read(bar.stage("read"));
    FacetsResult result;
    result.input = inputs();
    result.variable = input.info.variable;
    result.output = output_;
    result.image_dim = image_dim(input.image);
    result.isovalue = work.isovalue;
    require_output_holds_facets(output_, result.image_dim);
    require_contour(input, work.isovalue);
    result.seconds.read = watch.lap();
    write_image_facets(input.image, work, bar, result);
    bar.clear();
    if (!quiet()) streams.out.write(json() ? dump(to_json(result)) : to_text(streams.out, result));
    return result.exit_code();
  }

  void stream(ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    require_output_grows();
    if (options_.wants_shape_normals() || attributes_.wanted())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} with a streamed contour, which is never there as a whole; expected {}",
                              attributes_.wanted() ? "--attribute" : "--normals geometric or flat",
                              attributes_.wanted() ? "an image that fits into memory" : "--normals gradient or sobel"));
    OpenLayersResult input = images().open(files());
    result.variable = input.info.variable;
    options.progress = bar.stage("stream");
    stream_contour(input, *result.isovalue, options, options_.single_precision(), result);
    result.output_bytes = std::filesystem::file_size(result.output);
  }

  void require_output_grows() const {
    const MeshFileFormat* const format = find_mesh_file_format(output_);
    if (format != nullptr && format->extension == ".vtkhdf") return;
    throw Error(ErrorCode::WriteFailed,
                fmt::format("{}: a streamed contour needs a file that can grow; expected .vtkhdf", output_));
  }

  ExtractionOptions options_;
  AttributeOptions attributes_;
  std::string output_;
  std::string index_;
  bool stream_ = false;
  bool facets_ = false;
  std::string pick_;
  bool no_check_ = false;
};

}  // namespace

std::unique_ptr<Command> make_contour_command(CLI::App& program) { return std::make_unique<ContourCommand>(program); }

}  // namespace tegl::cli
