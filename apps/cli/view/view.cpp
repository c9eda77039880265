// SPDX-License-Identifier: BSD-3-Clause
//
// tegl view: writes contours as an HTML page, in which the GPU cuts them at the time of a slider.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "input/contour_input.hpp"
#include "output/output.hpp"
#include "tegl/io/text.hpp"
#include "tegl/periodic.hpp"
#include "view/view_page.hpp"

namespace tegl::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kViewExamples =
    "Examples:\n"
    "  tegl view ocean.nc --iso 20 -o ocean.html\n"
    "  tegl contour heart.nii.gz --iso 400 --normals -o heart.vtkhdf\n"
    "  tegl view heart.vtkhdf --title 'A beating heart' -o heart.html\n"
    "  tegl view skull.ply skin.ply -o head.html\n"
    "The page is one file without links to others: open it in any browser, or send it by mail. 4D contours are sliced\n"
    "at the time of a slider; the births, merges, splits and deaths on its timeline can be clicked. 3D contours\n"
    "can be rotated. In the page, '?' lists the keys.";

/// The contents of a page from one file.
struct Shown {
  std::string input_text;
  Json keys;
  Thinned thinned;
  int dim = 0;
};

class ViewCommand final : public ContourInputCommand {
 public:
  ViewCommand(CLI::App& program, std::string version)
      : ContourInputCommand(program, "view", "Write a web page that shows contours, with a slider for the time",
                            Files::each),
        version_(std::move(version)) {
    app().add_option("-o,--output", output_, "the page: .html")->type_name("FILE")->required();
    app().add_flag("--one-image", one_image_,
                   "several FILEs form one image with one more axis, as for other commands, not one contour each");
    app().add_option("--title", title_, "title of the page; default: the names of the files")->type_name("TEXT");
    app()
        .add_option("--limit", limit_,
                    "maximum number of simplices per file; a larger contour is reduced to its largest components; 0: "
                    "no limit. Without this option the largest component is shown even if it has more")
        ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
        ->type_name("COUNT")
        ->capture_default_str();
    app()
        .add_option("--tracks", tracks_, "4D: number of tracks under the slider, those with the longest lifetime")
        ->check(whole_number(0, 10000))
        ->type_name("COUNT")
        ->capture_default_str();
    app()
        .add_option("--down", down_,
                    "the axis that points down, by its name or letter, or none; default: as in a netCDF file, else an "
                    "axis with 'depth' in its name")
        ->type_name("AXIS");
    app()
        .add_option("--world", world_,
                    "the patient's sides towards which x, y and z grow, such as RAS (right, anterior, superior) or "
                    "LPS, or none; default: as in the image's file; saved contours do not have them")
        ->type_name("LETTERS");
    app().footer(kViewExamples);
  }

  ExitCode run(const Streams& streams) override {
    require_page();
    // add a layer for each file
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    PageNumbers numbers;
    Json scene;
    scene["program"] = "tegl " + version_;
    scene["title"] = title_.empty() ? names() : title_;
    scene["layers"] = Json::array();
    std::vector<Shown> shown;
    for (std::size_t i = 0; i < (one_image_ ? 1 : all_files().size()); ++i) {
      if (one_image_)
        turn_to_all_files();
      else
        turn_to_file(i);
      scene["layers"].push_back(add_file(numbers, bar, shown));
      require_one_space(shown);
    }
    if (app().count("--tracks") > 0 && std::ranges::none_of(shown, [](const Shown& one) { return one.dim == 4; }))
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("--tracks {} with a contour in {}D; expected it with one in 4D", tracks_, shown.front().dim));
    // assemble and write the page
    const std::string packed = numbers.packed(bar.stage("pack"));
    const std::string page = make_page(scene, scene["title"].get<std::string>(), packed);
    bar.stage("write")(0);
    const std::uint64_t bytes = write_file(output_, [&] { write_text(page, output_); });
    // report
    const double seconds = watch.lap();
    bar.clear();
    if (json())
      streams.out.write(dump(document(shown, bytes, seconds)));
    else if (!quiet())
      streams.out.write(report(streams.out, shown, bytes, seconds));
    else
      warn(streams.err, shown);
    return ExitCode::Ok;
  }

 private:
  void require_page() const {
    for (const std::string& input : all_files()) require_input(input, Folders::allowed);
    require_text_output(output_, all_files());
    const std::string extension = fs::path(output_).extension().string();
    if (!equal_ignoring_case(extension, ".html") && !equal_ignoring_case(extension, ".htm"))
      throw Error(ErrorCode::WriteFailed,
                  fmt::format("{}: {}; expected .html", output_,
                              extension.empty() ? "the name has no extension"
                                                : fmt::format("the extension '{}' is not known", extension)));
    if (!has_viewer())
      throw Error(ErrorCode::WriteFailed, fmt::format("{}: this build of tegl has no viewer; expected a build with "
                                                      "esbuild and three.js (scripts/setup installs both)",
                                                      output_));
  }

  /// Throws if planar contours are combined with others.
  void require_one_space(const std::vector<Shown>& shown) const {
    if ((shown.front().dim == 2) == (shown.back().dim == 2)) return;
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("{}: a contour in {}D on a page with one in {}D; expected only 2D contours, or none",
                            file(), shown.back().dim, shown.front().dim));
  }

  Json add_file(PageNumbers& numbers, ProgressBar& bar, std::vector<Shown>& shown) {
    ContourInput input = read_contour(bar, true);
    if (input.size().simplices == 0) throw EmptyResult("the contour is empty; expected one with simplices");
    ImageInfo info;
    if (input.image) info = std::move(input.image->info);
    input.image.reset();
    const Json down = axes_down(input, info);
    const std::string world = world_of(input, info);
    Shown& here = shown.emplace_back();
    here.dim = input.space_dim();
    here.input_text = input_text(input);
    add_input_keys(here.keys, input);
    const auto add = [&]<int N>(Contour<N, double>& contour) {
      here.thinned = thin(contour, view_limit(), {threads(), bar.stage("components")});
      std::optional<PageTracks> tracks;
      if constexpr (N == 4) {
        // A slider has two ends, so tracks end at both ends of a periodic time.
        if (std::ranges::any_of(contour.periods,
                                [](const Period<4>& p) { return p.vector[3] != 0 || p.dual[3] != 0; })) {
          remark("the time is periodic: the contour is unrolled, and its tracks end at both ends of the time");
          contour = unroll(contour).contour;
          input.ends = {};
        }
        tracks = page_tracks(contour, input.ends.first, input.ends.second, tracks_, {threads(), bar.stage("track")});
      }
      if (!contour.periods.empty()) contour = unroll(contour).contour;  // simplices keep their numbers
      return describe_layer(contour, input, here.thinned, tracks, numbers, {threads(), bar.stage("prepare")});
    };
    Json layer = visit_to_4d(input.contour, add);
    remark_on_size(here);
    layer["unit"] = info.value_unit;
    layer["world"] = world.empty() ? Json(nullptr) : Json(world);
    for (std::size_t a = 0; a < down.size(); ++a) layer["axes"][a]["down"] = down[a];
    return layer;
  }

  /// For each spatial axis whether it points down; null if unknown. Throws InvalidArgument if --down names an unknown
  /// axis.
  [[nodiscard]] Json axes_down(const ContourInput& input, const ImageInfo& info) const {
    std::vector<std::string> labels;
    for (int a = 0; a < std::min(input.space_dim(), 3); ++a) labels.push_back(input.axis_name(a));
    const std::size_t chosen = down_ ? axis_called(*down_, labels) : labels.size();
    if (down_ && chosen == labels.size() && !equal_ignoring_case(*down_, "none"))
      throw Error(ErrorCode::InvalidArgument, fmt::format("--down {} names no axis in space; expected {} or none",
                                                          *down_, fmt::join(labels, ", ")));
    Json down = Json::array();
    for (std::size_t a = 0; a < labels.size(); ++a) {
      const AxisDirection said = a < info.axis_directions.size() ? info.axis_directions[a] : AxisDirection::unknown;
      if (down_)
        down.push_back(a == chosen);
      else if (said != AxisDirection::unknown)
        down.push_back(said == AxisDirection::down);
      else
        down.push_back(has_depth(labels[a]) ? Json(true) : Json(nullptr));
    }
    return down;
  }

  /// Whether the text is one letter each of right or left, anterior or posterior, superior or inferior, in this order.
  [[nodiscard]] static bool is_world(std::string_view letters) {
    constexpr std::array<std::string_view, 3> kSides = {"RL", "AP", "SI"};
    if (letters.size() != kSides.size()) return false;
    for (std::size_t a = 0; a < kSides.size(); ++a)
      if (kSides[a].find(letters[a]) == std::string_view::npos) return false;
    return true;
  }

  /// The anatomical frame of a contour in space; empty if unknown. Throws InvalidArgument for an invalid --world.
  [[nodiscard]] std::string world_of(const ContourInput& input, const ImageInfo& info) const {
    if (world_) {
      std::string letters = *world_;
      for (char& c : letters) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      if (letters == "NONE") return "";
      if (is_world(letters)) return letters;
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--world {}; expected R or L, A or P, S or I, as in RAS or LPS, or none", *world_));
    }
    // If the axes have different units, one of them is not spatial, such as the time of a slice.
    const bool in_space =
        input.space_dim() >= 3 && input.axis_unit(0) == input.axis_unit(1) && input.axis_unit(0) == input.axis_unit(2);
    return in_space && is_world(info.world_frame) ? info.world_frame : "";
  }

  /// Whether a name refers to depth.
  [[nodiscard]] static bool has_depth(std::string_view name) {
    constexpr std::string_view kDepth = "depth";
    const auto is_alike = [](char a, char b) { return equal_ignoring_case({&a, 1}, {&b, 1}); };
    return std::search(name.begin(), name.end(), kDepth.begin(), kDepth.end(), is_alike) != name.end();
  }

  [[nodiscard]] std::string names() const {
    std::vector<std::string> names;
    for (const std::string& input : all_files()) names.push_back(fs::path(input).filename().string());
    return fmt::format("{}", fmt::join(names, ", "));
  }

  /// The parts of a contour that a page leaves out; empty if there are none.
  [[nodiscard]] std::string left_out(const Shown& shown) const {
    if (!shown.thinned.left_out()) return "";
    const Thinned& thinned = shown.thinned;
    return fmt::format("the {}largest of {} components, {} of {}: more than --limit {}",
                       thinned.components == 1 ? "" : grouped(thinned.components) + " ", grouped(thinned.of_components),
                       grouped(thinned.simplices), counted_simplices(shown.dim - 1, thinned.of_simplices),
                       grouped(limit_));
  }

  /// Without --limit, a contour that is one large component is shown up to the browsers' limit, with a remark.
  [[nodiscard]] ViewLimit view_limit() const {
    const bool is_given = app().count("--limit") > 0;
    return {limit_, is_given ? limit_ : kMostByDefault};
  }

  /// Adds a remark that a page may be slow, with advice.
  void remark_on_size(const Shown& shown) {
    if (limit_ == 0 || shown.thinned.simplices <= limit_) return;
    remark(
        fmt::format("{}: {} are shown, more than {}: the page may be slow ('tegl simplify --count {}' makes a smaller "
                    "contour; --limit {} shows all without this warning)",
                    file(), counted_simplices(shown.dim - 1, shown.thinned.simplices), grouped(limit_), limit_,
                    shown.thinned.simplices));
  }

  void warn(const Console& console, const std::vector<Shown>& shown) const {
    for (std::size_t i = 0; i < shown.size(); ++i)
      if (const std::string text = left_out(shown[i]); !text.empty())
        console.write(fmt::format("tegl: {}: the page shows {}\n", printable(all_files()[i]), text));
  }

  [[nodiscard]] Json document(const std::vector<Shown>& shown, std::uint64_t bytes, double seconds) const {
    Json json;
    json["output"] = output_;
    json["bytes"] = bytes;
    json["limit"] = limit_;
    json["files"] = Json::array();
    for (const Shown& one : shown) {
      Json& keys = json["files"].emplace_back(one.keys);
      keys["components"] = one.thinned.of_components;
      keys["components_shown"] = one.thinned.components;
      keys["simplices"] = one.thinned.of_simplices;
      keys["simplices_shown"] = one.thinned.simplices;
    }
    json["seconds"] = seconds;
    return json;
  }

  [[nodiscard]] std::string report(const Console& console, const std::vector<Shown>& shown, std::uint64_t bytes,
                                   double seconds) const {
    std::string text = fmt::format("{}\n", console.bold("Page"));
    for (const Shown& one : shown) {
      text += one.input_text;
      text += report_line("components", grouped(one.thinned.of_components));
      if (const std::string left = left_out(one); !left.empty()) text += report_line("shown", console.red(left));
    }
    text += report_line("seconds", fmt::format("{:.3f}", seconds));
    text += report_line("output", fmt::format("{} ({}): open it in a browser", output_, byte_size(bytes)));
    return text;
  }

  static constexpr std::uint64_t kDefaultLimit = 2000000;
  static constexpr std::uint64_t kMostByDefault = 10000000;

  std::string version_;
  std::string output_;
  std::string title_;
  bool one_image_ = false;
  std::optional<std::string> down_;
  std::optional<std::string> world_;
  std::uint64_t limit_ = kDefaultLimit;
  std::size_t tracks_ = 60;
};

}  // namespace

std::unique_ptr<Command> make_view_command(CLI::App& program, std::string version) {
  return std::make_unique<ViewCommand>(program, std::move(version));
}

}  // namespace tegl::cli
