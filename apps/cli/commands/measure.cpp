// SPDX-License-Identifier: BSD-3-Clause
//
// tegl measure: measures the size and the enclosed content of a contour, and of its cuts along the last axis.
#include "tegl/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/table.hpp"
#include "base/units.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/cuts.hpp"
#include "output/output.hpp"
#include "tegl/io/text.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kMeasureExamples =
    "Examples:\n"
    "  tegl measure head.nii.gz --iso 60 --close\n"
    "  tegl contour ocean.nc --iso 20 --close -o ocean.vtkhdf\n"
    "  tegl measure ocean.vtkhdf --at t=1.5,3.25,7.3\n"
    "  tegl measure ocean.vtkhdf --samples 100 --csv curve.csv\n"
    "Only closed contours have an enclosed area or volume; --close closes the contour of an image at its border.";

/// The measures, independent of the dimension.
struct Found {
  double size = 0;
  std::optional<double> content;
  std::vector<double> centroid;
  std::vector<double> lowest;
  std::vector<double> highest;
  std::uint64_t boundary = 0;
  std::uint64_t open = 0;
  std::vector<CutMeasures> cuts;
};

class MeasureCommand final : public ContourInputCommand {
 public:
  explicit MeasureCommand(CLI::App& program)
      : ContourInputCommand(program, "measure",
                            "Measure a contour: length, area or volume, enclosed volume, and both over time") {
    app()
        .add_option("--at", at_,
                    "measure the slices at these times too: t=7.3, or the name of the last axis; t=1,2.5 for several")
        ->allow_extra_args(false)
        ->type_name("AXIS=NUMBER");
    app()
        .add_option("--samples", samples_,
                    "measure this many slices too, evenly spaced from the contour's first to its last time")
        ->check(whole_number(2, 1000000))
        ->type_name("COUNT");
    app().add_option("--csv", csv_, "the measures of the slices as CSV")->type_name("FILE");
    app().footer(kMeasureExamples);
  }

  ExitCode run(const Streams& streams) override {
    const std::vector<Cut> cuts = parse_cuts(at_);
    require_inputs();
    if (!csv_.empty()) {
      require_text_output(csv_, files());
      if (cuts.empty() && samples_ == 0)
        throw Error(ErrorCode::InvalidArgument, "--csv without slices; expected also --at or --samples");
    }
    ProgressBar bar(streams.err, wants_progress());
    const ContourInput input = read_contour(bar);
    require_axis(cuts, input);
    Stopwatch watch;
    const Found found =
        std::visit([&](const auto& contour) { return measured(contour, input, cuts, bar); }, input.contour);
    const double seconds = watch.lap();
    if (!csv_.empty()) write_text(table(input, found, &exact_number).to_csv(), csv_);
    bar.clear();
    if (json())
      streams.out.write(dump(document(input, found, seconds)));
    else if (!quiet())
      streams.out.write(report(streams.out, input, found, seconds));
    return ExitCode::Ok;
  }

 private:
  void require_axis(const std::vector<Cut>& cuts, const ContourInput& input) const {
    const int last = input.space_dim() - 1;
    if (last < 2 && (!cuts.empty() || samples_ > 0))
      throw Error(ErrorCode::UnsupportedData,
                  "holds a 2D contour, whose slices are points; expected a 3D, 4D or 5D one");
    for (const Cut& cut : cuts) {
      if (equal_ignoring_case(cut.axis, input.axis_name(last)) || cut.axis == std::string(1, "xyztu"[last])) continue;
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--at {}={}: measures are taken along the last axis; expected "
                              "{}={}",
                              cut.axis, cut.text, input.axis_name(last), cut.text));
    }
  }

  template <int N>
  Found measured(const Contour<N, double>& contour, const ContourInput& input, const std::vector<Cut>& cuts,
                 ProgressBar& bar) {
    // whole contour
    const Measures<N> whole = tegl::measure(contour, {threads(), bar.stage("measure")});
    Found found{whole.size,
                whole.content,
                {whole.centroid.begin(), whole.centroid.end()},
                {whole.lowest.begin(), whole.lowest.end()},
                {whole.highest.begin(), whole.highest.end()},
                whole.boundary_simplices,
                whole.open_simplices,
                {}};
    if constexpr (N >= 3) {
      if (cuts.empty() && (samples_ == 0 || contour.simplices.empty())) return found;
      CutAxis extent{input.axis_name(N - 1), whole.lowest[N - 1], whole.highest[N - 1]};
      extent.is_longitude = is_longitude_unit(input.axis_unit(N - 1));
      CutAxis axis = input.last_axis.value_or(extent);
      const bool is_wrapped = cuts_wrapped(contour.periods, Hyperplane<N>::across(N - 1, 0.0));
      if (is_wrapped && !contour.periods.empty()) {
        axis = axis_with_periods(axis, N - 1, contour.periods);
        if (axis.period > 0.0) extent = axis;
      } else if (!is_wrapped) {
        remark(kUnrolledForCuts);
        const Contour<N, double> unrolled = unroll(contour).contour;
        extent.first = std::numeric_limits<double>::infinity();
        extent.last = -extent.first;
        for (const auto& x : unrolled.vertices) {
          extent.first = std::min(extent.first, x[N - 1]);
          extent.last = std::max(extent.last, x[N - 1]);
        }
        axis = axis_with_periods(input.last_axis.value_or(extent), N - 1, contour.periods);
        found.cuts = measured_cuts(unrolled, input, cuts, axis, extent, bar);
        return found;
      }
      found.cuts = measured_cuts(contour, input, cuts, axis, extent, bar);
    }
    return found;
  }

  /// The cuts of --at and --samples. `axis`: the range of --at; `extent`: of the contour, for --samples.
  template <int N>
  std::vector<CutMeasures> measured_cuts(const Contour<N, double>& contour, const ContourInput& input,
                                         const std::vector<Cut>& cuts, const CutAxis& axis, const CutAxis& extent,
                                         ProgressBar& bar) const {
    std::vector<double> at;
    for (const Cut& cut : cuts) {
      if (!allows_empty()) require_within(cut, axis, input);
      at.push_back(cut.value);
    }
    for (std::size_t i = 0; i < samples_ && !contour.simplices.empty(); ++i)
      at.push_back(i + 1 == samples_ ? extent.last
                                     : extent.first + (extent.last - extent.first) * static_cast<double>(i) /
                                                          static_cast<double>(samples_ - 1));
    if (samples_ > 0) {  // with --at too, as one table of ascending times
      std::sort(at.begin(), at.end());
      at.erase(std::unique(at.begin(), at.end()), at.end());
    }
    std::vector<double> places = at;
    for (double& place : places) place = within_period(axis, place);
    const std::span<const double> vertices(contour.vertices.empty() ? nullptr : contour.vertices.front().data(),
                                           contour.vertices.size() * N);
    std::vector<CutMeasures> result =
        measure_cuts(contour, meet_vertices(std::move(places), vertices, N, N - 1), {threads(), bar.stage("slices")});
    for (std::size_t i = 0; i < at.size(); ++i) result[i].at = at[i];
    return result;
  }

  /// Throws unless the cut is within the last axis of the image or mesh, or within a saved contour, which may come from
  /// a file with floats; longitudes by turns of 360. A periodic axis has every place.
  static void require_within(const Cut& cut, const CutAxis& axis, const ContourInput& input) {
    if (axis.period > 0.0) return;
    const auto single = [](double x) { return static_cast<float>(x); };
    const float place = single(within_period(axis, cut.value));
    if (place >= single(axis.first) && place <= single(axis.last)) return;
    throw outside_error(cut, axis, input.last_axis ? input.last_axis_of : "saved contour");
  }

  static std::vector<std::string> units(const ContourInput& input, int count) {
    std::vector<std::string> result;
    for (int a = 0; a < count; ++a) result.push_back(input.axis_unit(a));
    return result;
  }

  [[nodiscard]] static Table table(const ContourInput& input, const Found& found, std::string (*to_text)(double)) {
    const int last = input.space_dim() - 1;
    const std::vector<std::string> spatial = units(input, last);
    Table result{{heading_with_unit(input.axis_name(last), input.axis_unit(last)),
                  heading_with_unit(measure_name(last - 1, last), measure_unit(spatial, last - 1)),
                  heading_with_unit("enclosed " + measure_name(last, last), content_unit(spatial))},
                 {}};
    for (const CutMeasures& cut : found.cuts)
      result.rows.push_back({to_text(cut.at), to_text(cut.size), cut.content ? to_text(*cut.content) : ""});
    return result;
  }

  [[nodiscard]] static std::string position(const std::vector<double>& x) {
    std::string text;
    for (const double value : x) text += (text.empty() ? "" : ", ") + number(value);
    return text;
  }

  /// A table with units on a separate line, as they may be long.
  static std::string cuts_text(const ContourInput& input, const Found& found) {
    Table cuts = table(input, found, &number);
    std::string in;
    for (std::string& heading : cuts.headings) {
      const std::size_t unit = heading.find(" (");
      if (unit == std::string::npos) continue;
      in += fmt::format("{}{} in {}", in.empty() ? "" : ", ", heading.substr(0, unit),
                        heading.substr(unit + 2, heading.size() - unit - 3));
      heading.resize(unit);
    }
    for (auto& row : cuts.rows)
      if (row.back().empty()) row.back() = "open";
    return (in.empty() ? "" : report_line("units", in)) + cuts.to_text(cuts.rows.size());
  }

  [[nodiscard]] std::string report(const Console& console, const ContourInput& input, const Found& found,
                                   double seconds) const {
    const int dim = input.space_dim() - 1;
    const std::vector<std::string> all = units(input, dim + 1);
    const std::optional<std::string> unit = measure_unit(all, dim);
    std::string text = fmt::format("{}\n", console.bold(fmt::format("Measures of a contour in {}D", dim + 1)));
    text += input_text(input);
    text += report_line(measure_name(dim, dim + 1),
                        with_unit(number(found.size), unit) + (unit ? "" : " (mixes axes of different units)"));
    if (found.content)
      text += report_line("encloses", fmt::format("{} {}", measure_name(dim + 1, dim + 1),
                                                  with_unit(number(*found.content), content_unit(all))));
    else if (found.boundary > 0)
      text += report_line("encloses", fmt::format("not defined: it is open (border of {})",
                                                  counted_simplices(dim - 1, found.boundary)));
    else if (found.open == 0)
      text += report_line("encloses", "not defined: it winds round periodic axes");
    else
      text += report_line("encloses", fmt::format("not defined: its orientations do not agree at {}",
                                                  counted_simplices(dim - 1, found.open)));
    if (input.size().simplices > 0) {
      text += report_line("centroid", position(found.centroid));
      text += report_line("from", position(found.lowest));
      text += report_line("to", position(found.highest));
    }
    if (!found.cuts.empty()) text += cuts_text(input, found);
    text +=
        report_line("seconds", fmt::format("read and contour {:.3f} + measure {:.3f}", input.seconds.total(), seconds));
    if (!csv_.empty()) text += report_line("table", csv_);
    return text;
  }

  [[nodiscard]] static Json document(const ContourInput& input, const Found& found, double seconds) {
    const int dim = input.space_dim() - 1;
    const auto optional = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
    Json json;
    add_input_keys(json, input);
    json["dim"] = dim;
    json["vertices"] = input.size().vertices;
    json["simplices"] = input.size().simplices;
    json["size"] = found.size;
    json["size_unit"] = optional(measure_unit(units(input, dim + 1), dim));
    json["content"] = optional(found.content);
    json["content_unit"] = optional(content_unit(units(input, dim + 1)));
    json["boundary_simplices"] = found.boundary;
    json["centroid"] = found.centroid;
    json["lowest"] = found.lowest;
    json["highest"] = found.highest;
    Json& cuts = json["cuts"] = Json::array();
    for (const CutMeasures& cut : found.cuts)
      cuts.push_back(
          {{"axis", input.axis_name(dim)}, {"value", cut.at}, {"size", cut.size}, {"content", optional(cut.content)}});
    json["cut_size_unit"] = optional(measure_unit(units(input, dim), dim - 1));
    json["cut_content_unit"] = optional(content_unit(units(input, dim)));
    json["seconds"] = {{"read", input.seconds.total()}, {"measure", seconds}};
    return json;
  }

  std::vector<std::string> at_;
  std::size_t samples_ = 0;
  std::string csv_;
};

}  // namespace

std::unique_ptr<Command> make_measure_command(CLI::App& program) { return std::make_unique<MeasureCommand>(program); }

}  // namespace tegl::cli
