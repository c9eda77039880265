// SPDX-License-Identifier: BSD-3-Clause
//
// tegl contour: the contour of an image, in the dimension that the file holds.
#include <fmt/format.h>

#include <string>

#include "commands.hpp"
#include "extraction.hpp"
#include "numbers.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "result.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tegl contour head.nii.gz --iso 60 -o head.ply\n"
    "  tegl contour terrain.nrrd --iso 600 -o lines.glb --json\n"
    "  tegl contour ocean.nc --var TEMP --iso 20 --close -o warm_water.vtkhdf\n"
    "A file of 2, 3 or 4 dimensions gives segments, triangles or tetrahedra. Cut the latter with 'tegl slice'.";

/// The contour in one type for all dimensions.
template <class Real>
Mesh extract_mesh(const AnyImage& image, double isovalue, const ExtractOptions& options, ExtractStats& stats) {
  const auto of_owned = [&](const auto& owned) {
    return to_mesh(extract<Real>(owned.view(), isovalue, options, &stats));
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

class ContourCommand final : public Command {
 public:
  explicit ContourCommand(CLI::App& program)
      : Command(program, "contour", "The contour of an image in 2D, 3D or 4D",
                "the image: NIfTI, NRRD, MetaImage or netCDF (.nc, also gzipped)") {
    options_.add_to(app(), true);
    app()
        .add_option("-o,--output", output_, "the result: .ply, .gltf, .glb (2D and 3D) or .vtkhdf (4D too)")
        ->required();
    app().add_flag("--no-check", no_check_, "leave out the check of the result");
    add_variable();
    add_quiet();
    app().footer(kExamples);
  }

  ExitCode run(const Streams& streams) override {
    const double isovalue = options_.isovalue();
    ExtractOptions options = options_.library_options();
    require_input(file());
    require_output(output_, file());

    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    ReadImageResult input = read(bar.stage("read"));
    ContourResult result;
    result.input = file();
    result.variable = input.info.variable;
    result.output = output_;
    result.isovalue = isovalue;
    result.image_dim = image_dim(input.image);
    require_output_holds(output_, result.image_dim - 1);
    require_contour(input, isovalue);
    result.seconds.read = watch.lap();

    options.progress = bar.stage("contour");
    ExtractStats& stats = result.stats.emplace();
    result.mesh = options_.single_precision() ? extract_mesh<float>(input.image, isovalue, options, stats)
                                              : extract_mesh<double>(input.image, isovalue, options, stats);
    result.seconds.add(stats);
    if (result.mesh.simplices.empty()) {
      throw Error(
          ErrorCode::EmptyResult,
          fmt::format("no contour at {}: every tile that it passes touches a missing sample", number(isovalue)));
    }
    input.image = AnyImage();  // its memory is of more use to the check
    if (!no_check_) check_result(result, bar);
    write_result(result, bar);
    bar.clear();
    if (!quiet()) streams.out.write(json() ? dump(to_json(result)) : to_text(streams.out, result));
    return result.exit_code();
  }

 private:
  ExtractionOptions options_;
  std::string output_;
  bool no_check_ = false;
};

}  // namespace

std::unique_ptr<Command> make_contour_command(CLI::App& program) { return std::make_unique<ContourCommand>(program); }

}  // namespace tegl::cli
