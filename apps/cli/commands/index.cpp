// SPDX-License-Identifier: BSD-3-Clause
//
// tegl index: builds an index of the active tiles of an image, for contours at many isovalues.
#include "commands/index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "base/word_list.hpp"
#include "input/commands.hpp"
#include "input/extraction.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/io/active_tiles.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kIndexExamples =
    "Examples:\n"
    "  tegl index head.nii.gz\n"
    "  tegl contour head.nii.gz --index head.nii.gz.tindex --iso 60 -o head.ply\n"
    "  tegl index ocean.nc --var TEMP --method min-max-tree -o ocean.tindex\n"
    "  tegl info ocean.tindex\n"
    "An index finds the active tiles (the grid cells that a contour crosses) without scanning the image. It is valid\n"
    "for one image only: the same values in the same order.";

/// The result of building and writing.
struct IndexResult {
  InputFiles input;
  std::string variable, output, method;
  int image_dim = 0;
  std::uint64_t tiles = 0;
  std::uint64_t memory_bytes = 0, output_bytes = 0;
  double read_seconds = 0, build_seconds = 0, write_seconds = 0;

  [[nodiscard]] double total_seconds() const { return read_seconds + build_seconds + write_seconds; }
};

Json to_json(const IndexResult& result) {
  Json json;
  json["input"] = result.input.json();
  json["variable"] = result.variable.empty() ? Json(nullptr) : Json(result.variable);
  json["output"] = result.output;
  json["image_dim"] = result.image_dim;
  json["method"] = result.method;
  json["tiles"] = result.tiles;
  json["memory_bytes"] = result.memory_bytes;
  json["output_bytes"] = result.output_bytes;
  json["seconds"] = {{"read", result.read_seconds},
                     {"build", result.build_seconds},
                     {"write", result.write_seconds},
                     {"total", result.total_seconds()}};
  return json;
}

std::string to_text(const Console& console, const IndexResult& result) {
  std::string text = fmt::format("{}\n", console.bold(fmt::format("Index of {}", result.input.text())));
  if (!result.variable.empty()) text += report_line("variable", result.variable);
  text += report_line("method", result.method);
  text += report_line("tiles", fmt::format("{} in {}D", grouped(result.tiles), result.image_dim));
  text += report_line("memory", byte_size(result.memory_bytes));
  text += report_line("output", fmt::format("{}, {}", result.output, byte_size(result.output_bytes)));
  return text + report_line("seconds",
                            fmt::format("{:.3f} = read {:.3f} + build {:.3f} + write {:.3f}", result.total_seconds(),
                                        result.read_seconds, result.build_seconds, result.write_seconds));
}

class IndexCommand final : public Command {
 public:
  explicit IndexCommand(CLI::App& program)
      : Command(program, "index", "Build an index of an image's active tiles, for contours at many isovalues",
                "the image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped), VTK (.vti, .vtr, "
                ".pvd) or DICOM (a folder)",
                Files::image) {
    std::vector<std::string> names;
    for (const ActiveMethod method : active_methods()) names.emplace_back(name_of(method));
    app()
        .add_option("-o,--output", output_, "the index; default: the name of FILE followed by .tindex")
        ->type_name("FILE");
    app()
        .add_option("--method", method_, "search structure for active tiles; docs/active-tiles.md compares them")
        ->check(CLI::IsMember(names))
        ->capture_default_str();
    std::vector<std::string> seeds;
    for (const SeedMethod method : seed_methods()) seeds.emplace_back(name_of(method));
    app()
        .add_option("--seeds", seeds_, "with --method seed-set: method that selects the seeds (docs/seed-sets.md)")
        ->check(CLI::IsMember(seeds))
        ->capture_default_str();
    add_word_list(app(), "--scan-order", scan_order_,
                  "with --method seed-set: order of the axes, the axis of a scan line first, such as 2,0,1; 'cover' "
                  "and 'volume-thinning' do not depend on it",
                  whole_number(0))
        ->type_name("AXES");
    app()
        .add_option("--threads", threads_, "number of threads; 0: all processors")
        ->type_name("COUNT")
        ->check(whole_number(0, 4096))
        ->capture_default_str();
    add_image_options();
    add_quiet();
    app().footer(kIndexExamples);
  }

  ExitCode run(const Streams& streams) override {
    IndexResult result;
    result.output = output_.empty() ? default_output() : output_;
    result.method = method_;
    // validate options and files
    require_inputs();
    if (method_ != name_of(ActiveMethod::seed_set) && (app().count("--seeds") > 0 || app().count("--scan-order") > 0))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--seeds and --scan-order are for --method seed-set; the method is {}", method_));
    if (!is_index_file(result.output))
      throw Error(ErrorCode::WriteFailed, fmt::format("{}: expected a file named *{}", result.output, kIndexExtension));
    require_text_output(result.output, files());
    // read and build
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const ReadImageResult input = read(bar.stage("read"));
    result.input = inputs();
    result.variable = input.info.variable;
    result.image_dim = image_dim(input.image);
    result.read_seconds = watch.lap();
    build(input.image, bar, result);
    // report
    bar.clear();
    if (!quiet()) streams.out.write(json() ? dump(to_json(result)) : to_text(streams.out, result));
    return ExitCode::Ok;
  }

 private:
  /// FILE with .tindex appended; for a folder, a file beside it.
  [[nodiscard]] std::string default_output() const {
    std::string name = file();
    while (name.size() > 1 && name.back() == '/') name.pop_back();
    return name + kIndexExtension;
  }

  void build(const AnyImage& image, ProgressBar& bar, IndexResult& result) const {
    Stopwatch watch;
    const std::vector<ActiveMethod> methods = active_methods();
    const ActiveMethod method =
        *std::find_if(methods.begin(), methods.end(), [&](ActiveMethod each) { return name_of(each) == method_; });
    const std::vector<SeedMethod> seeds = seed_methods();
    ActiveTilesOptions options{.work = {threads_, bar.stage("build")}};
    options.seed_method =
        *std::find_if(seeds.begin(), seeds.end(), [&](SeedMethod each) { return name_of(each) == seeds_; });
    for (const std::string& axis : scan_order_) options.scan_order.push_back(std::stoi(axis));
    const auto write = [&](const auto& index) {
      result.tiles = index.grid().count();
      result.memory_bytes = index.memory_bytes();
      result.build_seconds = watch.lap();
      write_active_tiles(index, result.output, {.progress = bar.stage("write")});
    };
    const auto of_owned = [&](const auto& owned) { write(*build_active_tiles(owned.view(), method, options)); };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
    result.output_bytes = std::filesystem::file_size(result.output);
    result.write_seconds = watch.lap();
  }

  std::string output_;
  std::string method_{name_of(ActiveMethod::span_space)};
  std::string seeds_{name_of(SeedMethod::cover)};
  std::vector<std::string> scan_order_;
  unsigned threads_ = 0;
};

}  // namespace

bool is_index_file(const std::filesystem::path& path) {
  return equal_ignoring_case(path.extension().string(), kIndexExtension);
}

std::string index_info(const Console& console, const std::filesystem::path& path, bool json) {
  const ActiveTilesHead head = check_active_tiles(path);
  const std::uint64_t bytes = std::filesystem::file_size(path);
  if (json) {
    Json document;
    document["input"] = path.string();
    document["format"] = "tindex";
    document["version"] = head.version;
    document["method"] = name_of(head.method);
    document["image"] = {{"sizes", head.sizes},
                         {"type", name_of(head.value_type)},
                         {"digest", fmt::format("{:016x}", head.digest)},
                         {"any_missing", head.any_missing}};
    document["bytes"] = bytes;
    return dump(document);
  }
  std::string text = fmt::format("{}\n", console.bold(fmt::format("{}: index of active tiles", path.string())));
  text += report_line("method", name_of(head.method));
  text += report_line("image", fmt::format("{} {}{}", fmt::join(head.sizes, " x "), name_of(head.value_type),
                                           head.any_missing ? ", some missing" : ""));
  text += report_line("digest", fmt::format("{:016x}", head.digest));
  return text + report_line("size", fmt::format("{}, version {}", byte_size(bytes), head.version));
}

std::unique_ptr<Command> make_index_command(CLI::App& program) { return std::make_unique<IndexCommand>(program); }

}  // namespace tegl::cli
