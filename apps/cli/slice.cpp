// SPDX-License-Identifier: BSD-3-Clause
//
// tegl slice: what the contour of a 4D image, or a saved 4D contour, looks like at one time or several.
#include "tegl/slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "contour_input.hpp"
#include "cuts.hpp"
#include "extraction.hpp"
#include "numbers.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "result.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tegl slice heart.nii.gz --iso 400 --at t=7.3 -o heart.ply\n"
    "  tegl contour ocean.nc --iso 20 -o ocean.vtkhdf\n"
    "  tegl slice ocean.vtkhdf --at t=0.5,3.25,7.3 -o 'ocean_{t}.ply'\n"
    "Of an image, the steps beside each cut alone are contoured; a saved contour is cut as it is.\n"
    "Times are those of the file's last axis, in its own unit; any real number in its range will do.";

/// The axis that is cut, its range, and the image's dimension.
struct CutAxis {
  std::string name;
  double first = 0;
  double last = 0;
  int image_dim = 0;
  const char* of = "";  ///< whose range it is, for messages
};

void require_cuttable(int dim, std::string_view what) {
  if (dim == 3 || dim == 4) return;
  throw Error(ErrorCode::UnsupportedData, fmt::format("holds a {}D {}; expected a 4D one (or a 3D one)", dim, what));
}

/// World coordinates of the last axis, where the world map leaves it to itself (else the library refuses).
CutAxis cut_axis(const AnyImage& image) {
  const auto of_owned = [](const auto& owned) {
    constexpr int kLast = static_cast<int>(std::tuple_size_v<decltype(owned.grid.axes)>) - 1;
    const Axis& axis = owned.grid.axes[kLast];
    const auto world = [&](double at) { return owned.grid.linear(kLast, kLast) * at + owned.grid.offset(kLast); };
    const auto [first, last] = std::minmax({world(axis[0]), world(axis[axis.size() - 1])});
    return CutAxis{axis_label(axis.name, kLast), first, last, kLast + 1, "image"};
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

CutAxis cut_axis(const Mesh& mesh) {
  const auto last_axis = static_cast<std::size_t>(mesh.space_dim - 1);
  CutAxis result{axis_label(last_axis < mesh.axis_names.size() ? mesh.axis_names[last_axis] : "", last_axis),
                 std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), mesh.space_dim,
                 "saved contour"};
  for (std::size_t i = last_axis; i < mesh.coordinates.size(); i += last_axis + 1) {
    result.first = std::min(result.first, mesh.coordinates[i]);
    result.last = std::max(result.last, mesh.coordinates[i]);
  }
  return result;
}

/// The cuts with the axis's own name. Throws InvalidArgument for another axis, EmptyResult outside of its range.
std::vector<Cut> resolve(std::vector<Cut> cuts, const CutAxis& axis) {
  for (Cut& cut : cuts) {
    const bool named = equal_ignoring_case(cut.axis, axis.name) || (axis.image_dim == 4 && cut.axis == "t");
    if (!named) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--at {}={} names no axis that can be cut; expected the last axis, {}={}", cut.axis,
                              cut.text, axis.name, cut.text));
    }
    cut.axis = axis.name;
    if (cut.value >= axis.first && cut.value <= axis.last) continue;
    throw Error(ErrorCode::EmptyResult,
                fmt::format("the cut at {} = {} lies outside of the {}; expected {} <= {} <= {}", axis.name, cut.text,
                            axis.of, number(axis.first), axis.name, number(axis.last)));
  }
  return cuts;
}

template <class Real>
Mesh slice_mesh(const AnyImage& image, double isovalue, double at, const ExtractOptions& options, ExtractStats& stats) {
  const auto of_owned = [&](const auto& owned) -> Mesh {
    if constexpr (std::tuple_size_v<decltype(owned.grid.axes)> >= 3) {
      return to_mesh(slice_image<Real>(owned.view(), isovalue, at, options, &stats));
    } else {
      throw Error(ErrorCode::UnsupportedData, "2D images have no cuts");  // require_cuttable was first
    }
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

void require_cut(const ContourResult& result) {
  if (!result.mesh.simplices.empty()) return;
  throw Error(ErrorCode::EmptyResult,
              fmt::format("the cut at {} = {} is empty; expected a contour there", result.cut->axis, result.cut->text));
}

/// The cuts of a saved contour, one after the other.
template <int N>
std::vector<ContourResult> cut_all(const Mesh& mesh, const std::vector<Cut>& cuts, double read_seconds,
                                   ProgressBar& bar) {
  const Contour<N, double> contour = to_contour<N>(mesh);
  std::vector<ContourResult> results;
  for (const Cut& cut : cuts) {
    const Progress cutting = bar.stage("slice");
    ContourResult& result = results.emplace_back();
    result.image_dim = N;
    result.cut = cut;
    Stopwatch watch;
    result.mesh = to_mesh(slice(contour, cut.value));
    result.seconds.slice = watch.lap();
    result.seconds.read = read_seconds;
    require_cut(result);
    cutting(1);
  }
  return results;
}

class SliceCommand final : public Command {
 public:
  explicit SliceCommand(CLI::App& program)
      : Command(program, "slice", "A cut of a 4D contour at a time, whole or not",
                "a 4D image, or a 4D contour that 'tegl contour' saved (.vtkhdf)") {
    app()
        .add_option("--at", at_, "where to cut: t=7.3, or the last axis by its own name; t=1,2.5 for several")
        ->required()
        ->allow_extra_args(false)
        ->type_name("AXIS=NUMBER");
    options_.add_to(app(), false);
    app()
        .add_option("-o,--output", output_, "the result: .ply, .gltf, .glb or .vtkhdf; {t} in it stands for the time")
        ->required();
    app().add_flag("--no-check", no_check_, "leave out the check of the result");
    add_variable();
    add_quiet();
    app().footer(kExamples);
  }

  ExitCode run(const Streams& streams) override {
    std::vector<Cut> cuts = parse_cuts(at_);
    const std::vector<std::string> outputs = cut_outputs(output_, cuts);
    require_input(file());
    for (const std::string& output : outputs) require_output(output, file());
    ProgressBar bar(streams.err, wants_progress());
    std::vector<ContourResult> results =
        find_mesh_file_format(file()) != nullptr ? cut_contour(std::move(cuts), bar) : cut_image(std::move(cuts), bar);
    for (std::size_t i = 0; i < results.size(); ++i) {
      results[i].input = file();
      results[i].output = outputs[i];
      if (!no_check_) check_result(results[i], bar);
    }
    write_all(results, bar);
    bar.clear();
    if (json()) {
      streams.out.write(dump(document(results)));
    } else if (!quiet()) {
      for (const ContourResult& result : results) streams.out.write(to_text(streams.out, result));
    }
    ExitCode exit = ExitCode::Ok;
    for (const ContourResult& result : results) exit = std::max(exit, result.exit_code());
    return exit;
  }

 private:
  /// One object for one cut, a list for several.
  static Json document(const std::vector<ContourResult>& results) {
    if (results.size() == 1) return to_json(results.front());
    Json list = Json::array();
    for (const ContourResult& result : results) list.push_back(to_json(result));
    return list;
  }

  std::vector<ContourResult> cut_image(std::vector<Cut> cuts, ProgressBar& bar) {
    const double isovalue = options_.isovalue();
    ExtractOptions options = options_.library_options();
    Stopwatch watch;
    const ReadImageResult input = read(bar.stage("read"));
    require_cuttable(image_dim(input.image), "image");
    require_contour(input, isovalue);
    cuts = resolve(std::move(cuts), cut_axis(input.image));
    const double read_seconds = watch.lap();
    std::vector<ContourResult> results;
    for (const Cut& cut : cuts) {
      options.progress = bar.stage("slice");
      ContourResult& result = results.emplace_back();
      result.variable = input.info.variable;
      result.isovalue = isovalue;
      result.image_dim = image_dim(input.image);
      result.cut = cut;
      ExtractStats& stats = result.stats.emplace();
      watch.lap();
      result.mesh = options_.single_precision() ? slice_mesh<float>(input.image, isovalue, cut.value, options, stats)
                                                : slice_mesh<double>(input.image, isovalue, cut.value, options, stats);
      const double seconds = watch.lap();
      require_cut(result);
      result.seconds.add(stats);
      // The slab's extraction is a part of it; what is left is the cut proper.
      result.seconds.slice = std::max(0.0, seconds - result.seconds.total());
      result.seconds.read = read_seconds;
    }
    return results;
  }

  std::vector<ContourResult> cut_contour(std::vector<Cut> cuts, ProgressBar& bar) {
    refuse_image_options(file(), options_.given(), variable(), "--at and --output alone");
    const Progress reading = bar.stage("read");
    Stopwatch watch;
    const Mesh mesh = read_mesh(file());
    require_cuttable(mesh.space_dim, "contour");
    cuts = resolve(std::move(cuts), cut_axis(mesh));
    const double read_seconds = watch.lap();
    return mesh.space_dim == 4 ? cut_all<4>(mesh, cuts, read_seconds, bar) : cut_all<3>(mesh, cuts, read_seconds, bar);
  }

  /// All or nothing: what was written is removed if one of the files cannot be.
  static void write_all(std::vector<ContourResult>& results, ProgressBar& bar) {
    WrittenFiles written;
    for (ContourResult& result : results) {
      write_result(result, bar);
      written.add(result.output);
    }
    written.keep();
  }

  ExtractionOptions options_;
  std::vector<std::string> at_;
  std::string output_;
  bool no_check_ = false;
};

}  // namespace

std::unique_ptr<Command> make_slice_command(CLI::App& program) { return std::make_unique<SliceCommand>(program); }

}  // namespace tegl::cli
