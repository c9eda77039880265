// SPDX-License-Identifier: BSD-3-Clause
//
// tegl simplify: reduces the number of simplices of a contour, and bounds the error.
#include "tegl/simplify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "base/numbers.hpp"
#include "base/units.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/merging.hpp"
#include "output/output.hpp"
#include "tegl/intersections.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kSimplifyExamples =
    "Examples:\n"
    "  tegl simplify head.nii.gz --iso 60 --max-error 0.5 -o head.ply\n"
    "  tegl simplify skull.ply --ratio 0.1 -o tenth.ply\n"
    "  tegl simplify ocean.vtkhdf --count 20000 --scale auto -o small.vtkhdf\n"
    "  tegl simplify head.ply --method fast --ratio 0.05 -o preview.glb\n"
    "  tegl simplify head.ply --merge -o merged.ply             (only merges vertices that coincide)\n"
    "Errors are distances: no point of either contour is farther than the error from the other. The result has the\n"
    "bound at each vertex as the attribute 'simplification_error'. --scale relates axes of different units.";

const std::map<std::string, SimplifyMethod> kMethods = {{"quadric", SimplifyMethod::quadric},
                                                        {"facets", SimplifyMethod::facets},
                                                        {"vertices", SimplifyMethod::vertices},
                                                        {"fast", SimplifyMethod::fast}};
const std::map<std::string, SimplifyBorder> kBorders = {{"fixed", SimplifyBorder::fixed},
                                                        {"within", SimplifyBorder::within}};

class SimplifyCommand final : public ContourInputCommand {
 public:
  explicit SimplifyCommand(CLI::App& program)
      : ContourInputCommand(program, "simplify",
                            "Simplify a contour: fewer simplices, the same topology, with an error bound") {
    app()
        .add_option("--method", method_,
                    "quadric: edge collapses by quadric error; facets: by curvature; vertices: by distance, keeps "
                    "vertex positions; fast: triangles, by meshoptimizer")
        ->check(CLI::IsMember(kMethods))
        ->capture_default_str();
    app()
        .add_option("--ratio", ratio_,
                    "fraction of the simplices to keep, 0 to 1, with a small error; several rounds, but one by "
                    "quadric beyond 50 000 simplices; facets and vertices take minutes in 4D (see --no-bound)")
        ->type_name("NUMBER");
    app().add_option("--count", count_, "number of simplices to keep")->type_name("COUNT");
    app().add_option("--max-error", max_error_, "maximum distance between result and original")->type_name("NUMBER");
    app()
        .add_option("--max-curvature", max_curvature_, "facets: remove no simplices of higher curvature (1 / radius)")
        ->type_name("NUMBER");
    app()
        .add_option("--border", border_, "border of open contours; fixed: unchanged; within: vertices move along it")
        ->check(CLI::IsMember(kBorders))
        ->capture_default_str();
    app()
        .add_option("--scale", scale_,
                    "weight of lengths along each axis: 1,1,1,0.5; or auto: by the contour's resolution along axes "
                    "whose unit differs from the first one's")
        ->type_name("NUMBERS|auto");
    app().add_flag("--no-bound", no_bound_,
                   "skip the error bound, also the one of an earlier simplification, and the rounds that reduce it");
    app().add_flag("--keep-embedded", keep_embedded_,
                   "refuse contractions that make simplices intersect; see 'tegl check --intersections'");
    app().add_flag("--allow-nonmanifold", allow_nonmanifold_, "fast: also write a result that is not a manifold");
    app()
        .add_option("-o,--output", output_, std::string("the result: ") + kContourFiles)
        ->type_name("FILE")
        ->required();
    merging_.add_to(app());
    app().add_flag("--no-check", no_check_, "skip the check of the result");
    compress_.add_to(app());
    app().footer(kSimplifyExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    require_inputs();
    require_output(output_, files());
    compress_.require_known(output_);
    require_output_keeps(output_, normals(), false);
    require_goal();
    // read and simplify
    ProgressBar bar(streams.err, wants_progress());
    ContourInput input = read_contour(bar, true);
    remark(unroll_input(input));
    require_output_holds(output_, input.space_dim() - 1);
    SimplifyStats stats;
    ContourResult result = input.to_result();
    result.output = output_;
    result.compression = compress_.compression();
    visit_to_4d(input.contour, [&](auto& contour) {
      if (merging_.are_given()) {
        result.merging = merging_.merge(contour, {threads(), bar.stage("merge")});
        remark(MergeArguments::require_left(*result.merging, contour.simplices.size(), allows_empty()));
        result.mesh = to_mesh(std::move(contour));
        return;
      }
      auto [fewer, found] = simplified(contour, input, bar);
      stats = found;
      if (!no_check_) count_intersections(fewer, bar);
      result.mesh = to_mesh(std::move(fewer));
    });
    input.contour = AnyContour();
    // check and write
    if (!no_check_) check_result(result, threads(), bar);
    write_result(result, bar);
    remark(result.lost.remark(output_));
    // report
    bar.clear();
    if (json())
      streams.out.write(dump(result.merging ? to_json(result) : document(result, stats)));
    else if (!quiet())
      streams.out.write(result.merging ? to_text(streams.out, result) : text(streams.out, result, stats, input));
    return allow_nonmanifold_ ? ExitCode::Ok : result.exit_code();
  }

 private:
  void require_goal() const {
    if (merging_.are_given()) {
      (void)merging_.tolerance();
      for (const char* const goal : {"--ratio", "--count", "--max-error", "--max-curvature"})
        if (app().count(goal) > 0) merging_.refuse(goal);
      return;
    }
    if (ratio_.empty() && count_.empty() && max_error_.empty() && max_curvature_.empty())
      throw Error(
          ErrorCode::InvalidArgument,
          "no goal; expected --ratio, --count or --max-error (or --method facets with --max-curvature), or --merge");
    if (no_bound_ && !max_error_.empty())
      throw Error(ErrorCode::InvalidArgument,
                  "--no-bound with --max-error, which needs the bound; expected one of the two");
    const auto require_method = [&](bool given, const char* option, const char* method) {
      if (given && method_ != method)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("{} is for --method {}, not for --method {}; expected one of the two", option, method,
                                method_));
    };
    require_method(!max_curvature_.empty(), "--max-curvature", "facets");
    if (!ratio_.empty()) require_between("--ratio", ratio_, 0.0, 1.0);
    if (!max_error_.empty()) require_between("--max-error", max_error_, 0.0);
    if (!max_curvature_.empty()) require_between("--max-curvature", max_curvature_, 0.0);
    require_method(allow_nonmanifold_, "--allow-nonmanifold", "fast");
    if (keep_embedded_ && method_ == "fast")
      throw Error(ErrorCode::InvalidArgument, "--keep-embedded with --method fast; expected another method");
  }

  static void require_between(const char* option, const std::string& text, double least,
                              double most = std::numeric_limits<double>::infinity()) {
    const std::string expected = std::isinf(most) ? fmt::format("a number of {} or more", least)
                                                  : fmt::format("a number from {} to {}", least, most);
    const double value = parse_finite(option, text, expected);
    if (value >= least && value <= most) return;
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} is '{}'; expected {}", option, text, expected));
  }

  /// Simplifies; error messages name the options of the command line.
  template <int N>
  static Simplification<N, double> simplify_or_explain(const Contour<N, double>& contour,
                                                       const SimplifyOptions<N>& options) {
    try {
      return tegl::simplify(contour, options);
    } catch (const Error& error) {
      if (options.method != SimplifyMethod::fast || error.code() != ErrorCode::UnsupportedData) throw;
      throw Error(error.code(), fmt::format("{} (on the command line: --allow-nonmanifold, --method)", error.what()));
    }
  }

  template <int N>
  Simplification<N, double> simplified(const Contour<N, double>& contour, const ContourInput& input, ProgressBar& bar) {
    if (contour.simplices.empty()) return {.contour = contour};
    SimplifyOptions<N> options;
    options.method = kMethods.at(method_);
    options.border = kBorders.at(border_);
    if (!ratio_.empty()) options.ratio = parse_finite("--ratio", ratio_);
    if (!count_.empty()) options.count = parse_count();
    if (!max_error_.empty()) options.max_error = parse_finite("--max-error", max_error_);
    if (!max_curvature_.empty()) options.max_curvature = parse_finite("--max-curvature", max_curvature_);
    options.measure = !no_bound_;
    options.allow_nonmanifold = allow_nonmanifold_;
    options.keep_embedded = keep_embedded_;
    options.scale = scale(contour);
    used_scale_.assign(options.scale.begin(), options.scale.end());
    if (input.image && !input.is_curved) options.planes = planes<N>(input.image->image);
    options.work = {threads(), bar.stage("simplify")};
    return simplify_or_explain(contour, options);
  }

  /// Pairs of simplices that intersect in the result; a contraction may cause them without --keep-embedded.
  struct OfResult {
    int dim = 0;
    std::uint64_t pairs = 0, intersecting = 0, simplices = 0;
    double seconds = 0.0;
  };

  template <int N>
  void count_intersections(const Contour<N, double>& contour, ProgressBar& bar) {
    Stopwatch watch;
    IntersectionOptions<N> options;
    options.most_listed = 0;
    options.work = {threads(), bar.stage("intersections")};
    const Intersections<N> found = find_intersections(contour, options);
    intersections_ = OfResult{N - 1, found.pair_count, found.intersecting, found.simplices, watch.lap()};
  }

  [[nodiscard]] Json intersections_json() const {
    if (!intersections_) return nullptr;
    return {{"pairs", intersections_->pairs}, {"simplices", intersections_->intersecting}};
  }

  [[nodiscard]] std::string intersections_text() const {
    if (!intersections_) return {};
    if (intersections_->pairs == 0) return report_line("intersect", "none");
    const double share =
        static_cast<double>(intersections_->intersecting) / static_cast<double>(intersections_->simplices);
    return report_line("intersect", fmt::format("{} of {}, {:.3g} %{}", counted(intersections_->pairs, "pair", "pairs"),
                                                counted_simplices(intersections_->dim, intersections_->intersecting),
                                                100.0 * share, keep_embedded_ ? "" : "; --keep-embedded causes none"));
  }

  [[nodiscard]] std::uint64_t parse_count() const {
    const double count = parse_finite("--count", count_);
    if (count >= 0.0 && count == std::floor(count) && count < 1e18) return static_cast<std::uint64_t>(count);
    throw Error(ErrorCode::InvalidArgument, fmt::format("--count is '{}'; expected a whole number, 0 or more", count_));
  }

  /// The hyperplanes of the image's border, if the grid is not parallel to the axes (otherwise the contour's box gives
  /// them).
  template <int N>
  static std::vector<Hyperplane<N>> planes(const AnyImage& image) {
    return std::visit(
        [](const auto& typed) {
          return std::visit(
              [](const auto& owned) -> std::vector<Hyperplane<N>> {
                if constexpr (std::tuple_size_v<decltype(owned.grid.axes)> == N) return border_planes(owned.grid);
                return {};
              },
              typed);
        },
        image);
  }

  template <int N>
  [[nodiscard]] std::array<double, N> scale(const Contour<N, double>& contour) const {
    std::array<double, N> result;
    result.fill(1.0);
    if (scale_.empty()) return result;
    if (scale_ == "auto") return automatic_scale(contour);
    std::size_t given = 0;
    for (std::size_t first = 0; first <= scale_.size();) {
      const std::size_t comma = std::min(scale_.find(',', first), scale_.size());
      const double factor = parse_finite("--scale", std::string_view(scale_).substr(first, comma - first));
      if (!(factor > 0.0))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--scale has '{}'; expected positive numbers", scale_.substr(first, comma - first)));
      if (given < N) result[given] = factor;
      ++given;
      first = comma + 1;
    }
    if (given != N)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--scale {} has {}; expected {}, one for each axis, or auto",
                                                          scale_, counted(given, "number", "numbers"), N));
    return result;
  }

  static const char* name_of(SimplifyEnd end) {
    switch (end) {
      case SimplifyEnd::count:
        return "count";
      case SimplifyEnd::error:
        return "error";
      case SimplifyEnd::shape:
        return "shape";
      case SimplifyEnd::rounds:
        break;
    }
    return "rounds";
  }

  /// Why the result has more simplices than requested, or as many as before; empty if that is not the case.
  [[nodiscard]] std::string why_not_fewer(const SimplifyStats& stats) const {
    const bool by_count = !ratio_.empty() || !count_.empty();
    if (stats.end == SimplifyEnd::rounds)
      return fmt::format("none of {} rounds met --max-error {}; the contour is unchanged", stats.rounds, max_error_);
    if (stats.end == SimplifyEnd::shape) return "topology, border or the shapes of simplices prevent further removals";
    if (stats.end == SimplifyEnd::error && stats.simplices_after == stats.simplices_before && !max_error_.empty())
      return fmt::format("no simplex can be removed within --max-error {}", max_error_);
    if (stats.end == SimplifyEnd::error && by_count)
      return fmt::format("fewer simplices would exceed {}", max_error_.empty() ? "--max-curvature" : "--max-error");
    return {};
  }

  [[nodiscard]] Json document(const ContourResult& result, const SimplifyStats& stats) const {
    const auto or_null = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
    Json json = to_json(result);
    Json seconds = json["seconds"];
    json.erase("seconds");
    json["method"] = method_;
    json["vertices_before"] = stats.vertices_before;
    json["simplices_before"] = stats.simplices_before;
    json["scale"] = used_scale_;
    json["error"] = or_null(stats.error());
    json["error_of_original"] = or_null(stats.error_of_original);
    json["error_of_result"] = or_null(stats.error_of_result);
    json["end"] = name_of(stats.end);
    json["rounds"] = stats.rounds;
    json["intersections"] = intersections_json();
    seconds["simplify"] = stats.simplify_seconds;
    seconds["bound"] = stats.measure_seconds;
    if (intersections_) seconds["intersections"] = intersections_->seconds;
    seconds["total"] = result.seconds.total() + stats.simplify_seconds + stats.measure_seconds +
                       (intersections_ ? intersections_->seconds : 0.0);
    json["seconds"] = seconds;
    return json;
  }

  [[nodiscard]] std::string text(const Console& console, const ContourResult& result, const SimplifyStats& stats,
                                 const ContourInput& input) const {
    const int dim = result.mesh.dim;
    const double share = stats.simplices_before == 0
                             ? 1.0
                             : static_cast<double>(stats.simplices_after) / static_cast<double>(stats.simplices_before);
    std::string lines = fmt::format("{}\n", console.bold(fmt::format("Simplified contour in {}D", result.image_dim)));
    lines += input_line(input.file, input.variable);
    lines += report_line("before", fmt::format("{}, {}", counted(stats.vertices_before, "vertex", "vertices"),
                                               counted_simplices(dim, stats.simplices_before)));
    lines += report_line("method", fmt::format("{}: {:.3g} % of the simplices are left", method_, 100.0 * share));
    const std::string why = why_not_fewer(stats);
    if (!why.empty()) lines += report_line("stopped", fmt::format("at {:.3g} %: {}", 100.0 * share, why));
    if (stats.error()) {
      // Scaled lengths do not have the unit of the axes.
      const auto unit = scale_.empty() ? measure_unit(result.mesh.axis_units, 1) : std::nullopt;
      lines += report_line("error", fmt::format("at most {} (of the original {}, of the result {})",
                                                with_unit(number(*stats.error()), unit),
                                                number(*stats.error_of_original), number(*stats.error_of_result)));
      if (!unit && scale_.empty())
        lines += report_line("", "(mixes axes of different units; --scale sets the ratio of their lengths)");
      if (!scale_.empty()) lines += report_line("scale", fmt::format("{:.4g}", fmt::join(used_scale_, ", ")));
    }
    lines += check_text(console, result.size(), result.report) + intersections_text();
    lines +=
        report_line("seconds", fmt::format("simplify {:.3f} + bound {:.3f} + others {:.3f}", stats.simplify_seconds,
                                           stats.measure_seconds,
                                           result.seconds.total() + (intersections_ ? intersections_->seconds : 0.0)));
    lines += report_line("output", fmt::format("{} ({})", result.output, byte_size(result.output_bytes)));
    return lines;
  }

  std::string method_ = "quadric";
  std::string border_ = "fixed";
  std::string ratio_, count_, max_error_, max_curvature_, scale_, output_;
  std::vector<double> used_scale_;
  bool no_bound_ = false;
  bool allow_nonmanifold_ = false;
  bool keep_embedded_ = false;
  bool no_check_ = false;
  std::optional<OfResult> intersections_;  ///< without --no-check
  CompressOption compress_;
  MergeArguments merging_;
};

}  // namespace

std::unique_ptr<Command> make_simplify_command(CLI::App& program) { return std::make_unique<SimplifyCommand>(program); }

}  // namespace tegl::cli
