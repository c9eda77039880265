// SPDX-License-Identifier: BSD-3-Clause
//
// tegl demo: extracts the surface where the world's ocean has 20 °C, through a year, as one contour in space and time.
// Plays its cuts at any time in the terminal, as a map of the surface's depth.
#include "commands/demo.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "base/progress.hpp"
#include "output/result.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kDemoExamples =
    "Examples:\n"
    "  tegl demo\n"
    "  tegl demo --frames 240\n"
    "  tegl demo --no-animation\n"
    "The map of the world shows the depth at which the water becomes colder than 20 degrees: brighter is deeper, '.'\n"
    "is land. The animation plays on a terminal only; otherwise the report contains one map as text.";

constexpr double kIsovalue = 20;

/// Finds the data of the program in ../share/tegl beside it, in installations and build trees.
fs::path find_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path data = program.parent_path().parent_path() / "share" / "tegl" / "ocean_temperature.nc";
  if (!fs::exists(data, error))
    throw Error(
        ErrorCode::FileNotFound,
        fmt::format("{}: the demo's data are missing; expected the file that is installed with tegl", data.string()));
  return data;
}

/// Whether the terminal's character set is UTF-8.
bool knows_unicode() {
  for (const char* const name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string text = value;
    return text.find("UTF-8") != std::string::npos || text.find("utf8") != std::string::npos;
  }
  return false;
}

/// A map of the world: for each pixel the depth of the surface, or a code.
struct Map {
  static constexpr float kLand = -2;
  static constexpr float kNone = -1;  ///< water that is colder even at the top
  int width = 0;
  int height = 0;
  std::vector<float> depth;

  [[nodiscard]] float at(int x, int y) const { return depth[static_cast<std::size_t>(y * width + x)]; }
};

/// A map without a surface: land where the first layer has no value, else water.
template <class T>
Map empty_map(const OwnedImage<T, 4>& image, int width, int height) {
  Map map{width, height, {}};
  const auto view = image.view();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto place = [](int pixel, int pixels, std::size_t samples) {
        return std::min(samples - 1, static_cast<std::size_t>((pixel + 0.5) * static_cast<double>(samples) / pixels));
      };
      const auto value =
          static_cast<double>(view({place(x, width, view.size(0)), place(height - 1 - y, height, view.size(1)), 0, 0}));
      map.depth.push_back(std::isnan(value) ? Map::kLand : Map::kNone);
    }
  return map;
}

/// Rasterises a triangle's depth into the pixels whose centre it covers; the maximum depth wins, because the water
/// above is warm.
void draw(Map& map, const std::array<std::array<double, 3>, 3>& corners) {
  const auto& [a, b, c] = corners;
  const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  if (std::abs(area) < 1e-12) return;
  const auto [left, right] = std::minmax({a[0], b[0], c[0]});
  const auto [top, bottom] = std::minmax({a[1], b[1], c[1]});
  for (int y = std::max(0, static_cast<int>(top)); y <= std::min(map.height - 1, static_cast<int>(bottom)); ++y)
    for (int x = std::max(0, static_cast<int>(left)); x <= std::min(map.width - 1, static_cast<int>(right)); ++x) {
      const double px = x + 0.5;
      const double py = y + 0.5;
      const double v = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / area;
      const double w = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area;
      if (v < 0 || w < 0 || v + w > 1) continue;
      float& pixel = map.depth[static_cast<std::size_t>(y * map.width + x)];
      const auto depth = static_cast<float>(a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2]));
      if (pixel != Map::kLand) pixel = std::max(pixel, depth);
    }
}

/// Colour of a depth, from deep red to bright yellow: matplotlib's "inferno" in a few steps.
std::array<int, 3> colour_of(float depth) {
  constexpr std::array<std::array<int, 3>, 6> kSteps = {
      {{66, 10, 104}, {147, 38, 103}, {221, 81, 58}, {252, 145, 30}, {246, 215, 70}, {252, 255, 164}}};
  constexpr double kDeepest = 280;
  if (depth == Map::kLand) return {88, 88, 88};
  if (depth < 0) return {10, 22, 50};
  const double at = std::clamp(static_cast<double>(depth) / kDeepest, 0.0, 1.0) * (kSteps.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kSteps.size() - 2);
  const double share = at - static_cast<double>(low);
  std::array<int, 3> colour{};
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<int>(std::lround(kSteps[low][i] + share * (kSteps[low + 1][i] - kSteps[low][i])));
  return colour;
}

/// Formats two pixels per character, with foreground and background colours.
std::string coloured(const Map& map) {
  std::string text;
  for (int y = 0; y + 1 < map.height; y += 2) {
    for (int x = 0; x < map.width; ++x) {
      const auto up = colour_of(map.at(x, y));
      const auto low = colour_of(map.at(x, y + 1));
      text += fmt::format("\x1b[38;2;{};{};{}m\x1b[48;2;{};{};{}m▀", up[0], up[1], up[2], low[0], low[1], low[2]);
    }
    text += "\x1b[0m\n";
  }
  return text;
}

/// Formats two pixels per character, denser for greater depths.
std::string plain(const Map& map) {
  constexpr std::string_view kShades = ":-=+*#%@";
  constexpr double kDeepest = 280;
  std::string text;
  for (int y = 0; y + 1 < map.height; y += 2) {
    std::string line;
    for (int x = 0; x < map.width; ++x) {
      const float deepest = std::max(map.at(x, y), map.at(x, y + 1));
      if (deepest < 0)
        line += deepest == Map::kLand ? '.' : ' ';
      else
        line += kShades[std::min(kShades.size() - 1,
                                 static_cast<std::size_t>(deepest / kDeepest * static_cast<double>(kShades.size())))];
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    text += line + "\n";
  }
  return text;
}

/// A time in months as text, such as "middle of July".
std::string month_text(double t) {
  constexpr std::array<const char*, 12> kMonths = {"January",   "February", "March",    "April",
                                                   "May",       "June",     "July",     "August",
                                                   "September", "October",  "November", "December"};
  const double days = (t - 0.5 - std::floor(t - 0.5)) * 30.4;
  const auto month = static_cast<std::size_t>(std::clamp(std::floor(t - 0.5), 0.0, 11.0));
  return fmt::format("{} {}", kMonths.at(month), 1 + static_cast<int>(days));
}

class DemoCommand final : public Command {
 public:
  explicit DemoCommand(CLI::App& program)
      : Command(program, "demo", "Show an animation and a report of the data that come with tegl", "no file") {
    app().remove_option(app().get_option("FILE"));
    app()
        .add_option("--frames", frames_, "frames of the animation")
        ->check(whole_number(2, 100000))
        ->type_name("COUNT")
        ->capture_default_str();
    app().add_flag("--no-animation", no_animation_,
                   "show one map, of the beginning of August, instead of the animation");
    add_quiet();
    app().footer(kDemoExamples);
  }

  ExitCode run(const Streams& streams) override {
    // read
    const fs::path data = find_data();
    ProgressBar bar(streams.err, wants_progress());
    const ReadImageResult input = read_image(data, image_options(bar.stage("read")));
    const auto* const of_4d = std::get_if<AnyImageN<4>>(&input.image);
    const auto* const image = of_4d == nullptr ? nullptr : std::get_if<OwnedImage<float, 4>>(of_4d);
    if (image == nullptr)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("{}: not the demo's data; expected 4D floats", data.string()));
    // contour
    Stopwatch watch;
    ExtractOptions options;
    options.work.progress = bar.stage("contour");
    const Contour<4, double> contour = extract<double>(image->view(), kIsovalue, options);
    const double seconds = watch.lap();
    // animation or report
    bar.clear();
    const bool animated = !json() && !quiet() && !no_animation_ && streams.out.moves_its_cursor() &&
                          map_width(streams.out, true).has_value();
    if (animated) play(streams.out, *image, contour);
    if (json())
      streams.out.write(dump(document(data, *image, contour, seconds)));
    else if (!quiet())
      streams.out.write(report(streams.out, data, *image, contour, seconds, !animated));
    return ExitCode::Ok;
  }

 private:
  static constexpr int kLeastWidth = 16;  ///< of a map; its height is a quarter as many lines
  static constexpr int kMostWidth = 100;  ///< one pixel per sample of longitude

  /// Map width for a console; nullopt if there is not enough room. Lines of a terminal must not be full, and an
  /// animation must fit into the window, with a line for the time and one for the cursor.
  [[nodiscard]] static std::optional<int> map_width(const Console& console, bool played) {
    int width = std::min(kMostWidth, console.width() - 1);
    if (!console.is_terminal()) return std::max(width, kLeastWidth);
    if (played) width = std::min(width, 4 * (console.height() - 2));
    return width < kLeastWidth ? std::nullopt : std::optional(width);
  }

  [[nodiscard]] static Map draw_world(int width, const OwnedImage<float, 4>& image, const Contour<3, double>& cut) {
    Map map = empty_map(image, width, width / 4 * 2);  // an even number
    const Axis& longitude = image.grid.axes[0];
    const Axis& latitude = image.grid.axes[1];
    const auto pixel = [&](const std::array<double, 3>& vertex) {
      const double x = (vertex[0] - longitude[0]) / longitude.step() + 0.5;
      const double y = (vertex[1] - latitude[0]) / latitude.step() + 0.5;
      return std::array<double, 3>{x / static_cast<double>(longitude.size()) * map.width,
                                   map.height - y / static_cast<double>(latitude.size()) * map.height, vertex[2]};
    };
    for (const auto& triangle : cut.simplices)
      draw(map, {pixel(cut.vertices[triangle[0]]), pixel(cut.vertices[triangle[1]]), pixel(cut.vertices[triangle[2]])});
    return map;
  }

  /// Draws frames in place, about ten per second. Ctrl-C ends the animation and restores the terminal.
  void play(const Console& console, const OwnedImage<float, 4>& image, const Contour<4, double>& contour) const {
    struct HiddenCursor {
      explicit HiddenCursor(const Console& on) : console(on) { console.write("\x1b[?25l"); }
      ~HiddenCursor() { console.write("\x1b[0m\x1b[?25h"); }
      HiddenCursor(const HiddenCursor&) = delete;
      HiddenCursor& operator=(const HiddenCursor&) = delete;
      const Console& console;
    };
    // play
    const HiddenCursor hidden(console);
    const bool in_colour = console.has_colours() && knows_unicode();
    const Axis& time = image.grid.axes[3];
    int lines = 0;
    for (std::size_t i = 0; i < frames_; ++i) {
      InterruptHandler::throw_if_requested();
      const auto shown = std::chrono::steady_clock::now();
      const auto width = map_width(console, true);  // the window may have been resized
      if (!width) return;
      const double share = static_cast<double>(i) / static_cast<double>(frames_ - 1);
      const double t = time[0] + share * (time[time.size() - 1] - time[0]);
      const Map map = draw_world(*width, image, slice(contour, Hyperplane<4>::across(3, t)));
      const auto columns = static_cast<std::size_t>(console.width() - 1);
      const std::string back = lines == 0 ? "" : fmt::format("\x1b[{}A", lines);
      console.write(fmt::format("{}\r{}\x1b[K{}\n", back, in_colour ? coloured(map) : plain_lines(map),
                                fmt::format("t = {:5.2f}  {}", t, month_text(t)).substr(0, columns)));
      lines = map.height / 2 + 1;
      std::this_thread::sleep_until(shown + std::chrono::milliseconds(80));
    }
  }

  /// Each line clears its previous contents.
  static std::string plain_lines(const Map& map) {
    std::string text = "\x1b[K";
    for (const char c : plain(map)) {
      text += c;
      if (c == '\n') text += "\x1b[K";
    }
    return text;
  }

  static constexpr std::array<double, 4> kTimes = {1, 4.25, 7.5, 10.9};

  [[nodiscard]] Json document(const fs::path& data, const OwnedImage<float, 4>& image,
                              const Contour<4, double>& contour, double seconds) const {
    Json json;
    json["input"] = data.string();
    json["variable"] = "temperature";
    json["image_dim"] = 4;
    json["samples"] = image.values.size();
    json["isovalue"] = kIsovalue;
    json["vertices"] = contour.vertices.size();
    json["simplices"] = contour.simplices.size();
    json["cuts"] = Json::array();
    for (const double t : kTimes) {
      const Contour<3, double> cut = slice(contour, Hyperplane<4>::across(3, t));
      json["cuts"].push_back({{"t", t}, {"vertices", cut.vertices.size()}, {"simplices", cut.simplices.size()}});
    }
    json["seconds"] = seconds;
    return json;
  }

  [[nodiscard]] static std::string report(const Console& console, const fs::path& data,
                                          const OwnedImage<float, 4>& image, const Contour<4, double>& contour,
                                          double seconds, bool with_map) {
    std::string text;
    const auto width = map_width(console, false);
    if (with_map && !width) {
      text += fmt::format("The window is too narrow for the map: {} columns; expected at least {}\n\n", console.width(),
                          kLeastWidth + 1);
    } else if (with_map) {
      const Map map = draw_world(*width, image, slice(contour, Hyperplane<4>::across(3, kTimes[2])));
      text += console.has_colours() && knows_unicode() ? coloured(map) : plain(map);
      text +=
          fmt::format("Depth of the water of 20 degrees or more at t = {} ({})\n\n", kTimes[2], month_text(kTimes[2]));
    }
    text += fmt::format("{}\n", console.bold("The 20 degree surface of the world's ocean over a year"));
    text += report_line("data", data.string());
    text += report_line(
        "image", fmt::format("{} x {} x {} x {} samples: longitude, latitude, depth, month", image.grid.axes[0].size(),
                             image.grid.axes[1].size(), image.grid.axes[2].size(), image.grid.axes[3].size()));
    text += report_line("contour", fmt::format("one surface in space and time: {}, in {:.2f} s",
                                               counted_simplices(3, contour.simplices.size()), seconds));
    for (const double t : kTimes)
      text +=
          report_line(t == kTimes[0] ? "slices" : "",
                      fmt::format("t = {:5.2f}, {:<12} {}", t, month_text(t),
                                  counted_simplices(2, slice(contour, Hyperplane<4>::across(3, t)).simplices.size())));
    text += fmt::format(
        "\nTime is an axis like the others: the data have 12 months, the animation any number of times.\n\n{}\n",
        console.bold("Next steps"));
    text += "  DATA=" + printable(data.string()) + "\n";
    for (const char* const command : {"tegl info $DATA", "tegl contour $DATA --iso 20 -o ocean.vtkhdf",
                                      "tegl slice ocean.vtkhdf --at t=7.3 -o july.ply",
                                      "tegl view $DATA --iso 20 -o ocean.html", "tegl contour --help"})
      text += fmt::format("  {}\n", command);
    return text;
  }

  std::size_t frames_ = 90;
  bool no_animation_ = false;
};

}  // namespace

std::unique_ptr<Command> make_demo_command(CLI::App& program) { return std::make_unique<DemoCommand>(program); }

}  // namespace tegl::cli
