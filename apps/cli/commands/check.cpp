// SPDX-License-Identifier: BSD-3-Clause
//
// tegl check: checks whether a mesh is a manifold and, if requested, whether its simplices intersect.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "base/word_list.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/intersections.hpp"
#include "tegl/periodic.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kCheckExamples =
    "Examples:\n"
    "  tegl check skull.ply\n"
    "  tegl check --require closed --json ball.vtkhdf\n"
    "  tegl check --intersections --places 10 --tile 1 skull.ply\n"
    "The exit code is 0 for an oriented manifold, with or without a border, and 1 for anything else; also 1 if\n"
    "--intersections finds a pair, or simplices of zero size, which it cannot examine.";

/// Options of --intersections, and the numbers of one run.
class IntersectionSearch {
 public:
  void add_to(CLI::App& app) {
    auto* const search = app.add_flag("--intersections", is_on_,
                                      "also find all pairs of simplices that intersect outside of their common face, "
                                      "by exact arithmetic");
    app.add_option("--places", places_,
                   "list the deepest pairs, at most this many: numbers of both simplices, a common point, "
                   "and the depth")
        ->type_name("COUNT")
        ->check(whole_number(0))
        ->capture_default_str()
        ->needs(search);
    auto* const tile = app.add_option("--tile", tile_,
                                      "count the tiles that contain such pairs: the size of a tile, one "
                                      "number for all axes or one for each")
                           ->type_name("NUMBERS")
                           ->needs(search);
    app.add_option("--tile-origin", origin_, "a corner of a tile: one number for all axes or one for each; default 0")
        ->type_name("NUMBERS")
        ->needs(tile);
  }

  [[nodiscard]] bool is_on() const { return is_on_; }

  void run(Mesh&& mesh, const WorkOptions& work) {
    AnyContour contour = to_any_contour(std::move(mesh));
    visit_to_4d(contour, [&](const auto& c) { find(c, work); });
  }

  /// Whether the last run found a pair, or flat simplices, which are not examined.
  [[nodiscard]] bool has_faults() const { return pairs_ > 0 || flat_ > 0; }

  /// Lines of the report.
  [[nodiscard]] std::string text(const Console& console) const {
    std::string text = report_line("intersect", result_text(console));
    if (flat_ > 0)
      text += report_line("flat",
                          console.red(fmt::format("{} of zero size, not examined", counted_simplices(dim_, flat_))));
    if (!tile_.empty())
      text += report_line("tiles", fmt::format("{} of {} with intersections ({:.3g} %)", grouped(tiles_hit_),
                                               grouped(tiles_), 100.0 * share()));
    for (const Pair& pair : listed_) {
      std::vector<std::string> place;
      for (const double x : pair.place) place.push_back(number(x));
      text += report_line("pair", fmt::format("{} and {} at ({}), {} deep", pair.first, pair.second,
                                              fmt::join(place, ", "), number(pair.depth)));
    }
    return text;
  }

  [[nodiscard]] Json json() const {
    Json json{{"pairs", pairs_}, {"simplices", intersecting_}, {"flat_simplices", flat_}, {"depth", depth_}};
    json["tiles"] = tile_.empty() ? Json(nullptr) : Json(tiles_);
    json["tiles_with_pairs"] = tile_.empty() ? Json(nullptr) : Json(tiles_hit_);
    json["places"] = Json::array();
    for (const Pair& pair : listed_)
      json["places"].push_back({{"simplices", {pair.first, pair.second}}, {"at", pair.place}, {"depth", pair.depth}});
    return json;
  }

 private:
  struct Pair {
    Index first, second;
    std::vector<double> place;
    double depth;
  };

  [[nodiscard]] Styled result_text(const Console& console) const {
    if (pairs_ > 0)
      return console.red(fmt::format("{} of {}, {}", counted(pairs_, "pair", "pairs"),
                                     counted_simplices(dim_, intersecting_),
                                     depth_ > 0.0 ? fmt::format("up to {} deep", number(depth_)) : "all of depth 0"));
    return flat_ > 0 ? Styled{"none among the others"} : console.green("none");
  }

  /// The numbers of an option, one for each axis.
  template <int N>
  static std::array<double, N> of_axes(const char* option, const std::string& text) {
    const auto words = split(text, ',');
    if (words.size() != 1 && words.size() != N)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} {} has {}; expected one, or {}, one for each axis of the mesh", option, text,
                              counted(words.size(), "number", "numbers"), N));
    std::array<double, N> result;
    for (std::size_t a = 0; a < N; ++a) result[a] = parse_finite(option, words[words.size() == 1 ? 0 : a]);
    return result;
  }

  template <int N>
  void find(const Contour<N, double>& contour, const WorkOptions& work) {
    IntersectionOptions<N> options;
    options.work = work;
    options.most_listed = places_;
    options.deepest_first = true;
    if (!tile_.empty()) {
      options.tiles = IntersectionTiles<N>{of_axes<N>("--tile", tile_), {}};
      for (const double size : options.tiles->size)
        if (!(size > 0.0))
          throw Error(ErrorCode::InvalidArgument, fmt::format("--tile is {}; expected positive numbers", tile_));
      if (!origin_.empty()) options.tiles->origin = of_axes<N>("--tile-origin", origin_);
    }
    // unrolled, a simplex across the end of an axis has copies of vertices, not other numbers
    const Intersections<N> found = contour.periods.empty() ? find_intersections(contour, options)
                                                           : find_intersections(unroll(contour).contour, options);
    dim_ = N - 1;
    pairs_ = found.pair_count;
    intersecting_ = found.intersecting;
    flat_ = found.flat;
    depth_ = found.depth;
    tiles_ = found.tiles;
    tiles_hit_ = found.tiles_hit;
    listed_.clear();
    for (const IntersectingPair<N>& pair : found.pairs)
      listed_.push_back({pair.first, pair.second, {pair.place.begin(), pair.place.end()}, pair.depth});
  }

  [[nodiscard]] double share() const {
    return tiles_ == 0 ? 0.0 : static_cast<double>(tiles_hit_) / static_cast<double>(tiles_);
  }

  bool is_on_ = false;
  std::uint64_t places_ = 0;
  std::string tile_, origin_;

  int dim_ = 0;
  std::uint64_t pairs_ = 0, intersecting_ = 0, flat_ = 0, tiles_ = 0, tiles_hit_ = 0;
  double depth_ = 0.0;
  std::vector<Pair> listed_;
};

class CheckCommand final : public Command {
 public:
  explicit CheckCommand(CLI::App& program)
      : Command(program, "check", "Check whether a mesh is an oriented manifold, and count its faults",
                "the mesh: .ply, .gltf, .glb, .vtkhdf, .stl or .obj") {
    add_quiet();
    add_word_list(app(), "--require", required_,
                  "further requirements: closed (no border), nondegenerate (no simplices of zero size)",
                  CLI::IsMember({"closed", "nondegenerate"}));
    intersections_.add_to(app());
    app()
        .add_option("--threads", threads_, "number of threads; 0: all processors")
        ->type_name("COUNT")
        ->check(whole_number(0, 4096))
        ->capture_default_str();
    app().footer(kCheckExamples);
  }

  ExitCode run(const Streams& streams) override {
    require_inputs();
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    Mesh mesh = read_finite_mesh(file(), mesh_options(bar.stage("read")));
    const double read_seconds = watch.lap();
    const MeshReport report = check_mesh(mesh, {threads_, bar.stage("check")});
    const double check_seconds = watch.lap();
    const MeshSize size = size_of(mesh);
    if (intersections_.is_on()) intersections_.run(std::move(mesh), {threads_, bar.stage("intersections")});
    const double intersection_seconds = watch.lap();
    bar.clear();
    const std::string missed = missed_requirement(report);
    if (json()) {
      Json json;
      add_check_keys(json, size, report);
      if (intersections_.is_on()) json["intersections"] = intersections_.json();
      json["seconds"] = {{"read", read_seconds}, {"check", check_seconds}};
      if (intersections_.is_on()) json["seconds"]["intersections"] = intersection_seconds;
      json["seconds"]["total"] = read_seconds + check_seconds + (intersections_.is_on() ? intersection_seconds : 0.0);
      streams.out.write(dump(json));
    } else if (!quiet()) {
      std::string text =
          fmt::format("{}\n{}", streams.out.bold(file()), check_text(streams.out, size, report, wording()));
      if (intersections_.is_on()) text += intersections_.text(streams.out);
      if (!missed.empty()) text += report_line("", streams.out.red(missed));
      std::string seconds = fmt::format("read {:.3f} + check {:.3f}", read_seconds, check_seconds);
      if (intersections_.is_on()) seconds += fmt::format(" + intersections {:.3f}", intersection_seconds);
      streams.out.write(text + report_line("seconds", seconds));
    }
    return has_faults(report) || !missed.empty() || intersections_.has_faults() ? ExitCode::Faults : ExitCode::Ok;
  }

 private:
  /// Texts for a mesh of unknown origin.
  static Wording wording() {
    Wording wording;
    wording.no_size =
        "if tegl made the contour: samples equal the isovalue, which 'tegl contour --epsilon' avoids, or a slice "
        "passes through vertices of its contour";
    return wording;
  }

  [[nodiscard]] std::string missed_requirement(const MeshReport& report) const {
    for (const std::string& requirement : required_) {
      if (report.simplices == 0) return fmt::format("empty; --require {} expects simplices", requirement);
      if (requirement == "closed" && report.boundary_simplices > 0)
        return "has a border; --require closed expects none";
      if (requirement == "nondegenerate" && report.degenerate_simplices > 0) {
        return "has simplices of zero size; --require nondegenerate expects none";
      }
    }
    return {};
  }

  std::vector<std::string> required_;
  IntersectionSearch intersections_;
  unsigned threads_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_check_command(CLI::App& program) { return std::make_unique<CheckCommand>(program); }

}  // namespace tegl::cli
