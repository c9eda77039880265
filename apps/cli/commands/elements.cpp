// SPDX-License-Identifier: BSD-3-Clause
//
// tegl elements: writes a contour as points with normal vectors, for codes that integrate over it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/numbers.hpp"
#include "input/attributes.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/mesh_input.hpp"
#include "output/output.hpp"
#include "tegl/elements.hpp"
#include "tegl/io/elements.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kElementsExamples =
    "Examples:\n"
    "  tegl elements energy.nrrd --iso 0.5 --per cell -o surface.dat\n"
    "  tegl elements hydro.nc --var e --iso 0.3 --attribute hydro.nc:T --attribute hydro.nc:ux -o surface.dat "
    "--header\n"
    "  tegl elements ocean.vtkhdf -o ocean.h5\n"
    "Each line is one element: centroid, normal times volume (d sigma), attributes; the time is the first axis.\n"
    "Elements need no metric: they are the same in Euclidean and Minkowski space.";

/// Result of a run, in one type for all dimensions.
struct ElementReport {
  std::size_t count = 0;
  std::vector<std::string> axes;  ///< as in the contour
  std::vector<double> sum, absolute;
  double closure_error = 0.0;
  double measure = 0.0;
  struct Range {
    std::string name, unit;
    double min, max;
    std::uint64_t missing;
  };
  std::vector<Range> attributes;
  std::uint64_t output_bytes = 0;
  double attribute_seconds = 0, elements_seconds = 0, write_seconds = 0;
};

ElementReport::Range range_of(const Attribute& attribute) {
  ElementReport::Range range{attribute.name, attribute.unit, INFINITY, -INFINITY, 0};
  for (const double value : attribute.values) {
    if (std::isnan(value)) ++range.missing;
    range.min = std::fmin(range.min, value);
    range.max = std::fmax(range.max, value);
  }
  return range;
}

class ElementsCommand final : public ContourInputCommand {
 public:
  explicit ElementsCommand(CLI::App& program)
      : ContourInputCommand(program, "elements",
                            "Write a contour as centroids and normals times volume, the input of freeze-out codes") {
    app()
        .add_option("-o,--output", output_, "the elements: .dat or .txt (with the columns of Cornelius), or .h5")
        ->type_name("FILE")
        ->required();
    app()
        .add_option("--per", per_,
                    "one element per simplex, or per connected part of the contour in a cell of the image's grid")
        ->check(CLI::IsMember({"simplex", "cell"}))
        ->capture_default_str();
    attributes_.add_to(app());
    interpolate_arrays_of(&attributes_);
    app()
        .add_option("--order", order_,
                    "order of the axes in the file: time-first (the last axis becomes the first) or as-is")
        ->check(CLI::IsMember({"time-first", "as-is"}))
        ->capture_default_str();
    app()
        .add_option(
            "--components", components_,
            "components of the normals: covariant, or contravariant by the metric (+,-,-,-) with + for the last axis")
        ->check(CLI::IsMember({"covariant", "contravariant"}))
        ->capture_default_str();
    app().add_flag("--header", header_, "text files: a first line with the names of the columns");
    app().footer(kElementsExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    require_inputs();
    require_element_output();
    also_read(attributes_.files());
    attributes_.require_inputs();
    if (per_ == "cell" && find_mesh_file_format(file()) != nullptr)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--per cell with {}, a saved contour, which has no cells; expected an image", file()));
    if (per_ == "cell" && are_cell_meshes(files(), images()))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--per cell with {}, which is a mesh; expected an image", file()));
    // read and make elements
    ProgressBar bar(streams.err, wants_progress());
    ContourInput input =
        read_contour(bar, per_ == "cell", per_ == "cell" ? CurvedGrids::refused : CurvedGrids::allowed);
    if (per_ == "cell" && input.lattice)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--per cell on the lattice {}; expected --per simplex, or a cubic grid",
                              name_of(*input.lattice)));
    ElementReport report;
    std::visit([&](auto& contour) { make(contour, input, report, bar); }, input.contour);
    // report
    bar.clear();
    if (json())
      streams.out.write(dump(to_json(input, report)));
    else if (!quiet())
      streams.out.write(to_text(streams.out, input, report));
    return ExitCode::Ok;
  }

 private:
  void require_element_output() const {
    std::string extension = std::filesystem::path(output_).extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    constexpr std::array kKnown = {".dat", ".txt", ".h5", ".hdf5"};
    if (std::find(kKnown.begin(), kKnown.end(), extension) == kKnown.end())
      throw Error(
          ErrorCode::WriteFailed,
          fmt::format("{}: the extension '{}' is not known; expected .dat, .txt, .h5 or .hdf5", output_, extension));
    if (header_ && (extension == ".h5" || extension == ".hdf5"))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--header with {}; expected a text file (.dat, .txt)", output_));
    require_text_output(output_, files());
  }

  [[nodiscard]] ElementFileOptions file_options() const {
    ElementFileOptions options;
    options.axes = order_ == "as-is" ? ElementAxes::as_is : ElementAxes::time_first;
    options.components =
        components_ == "contravariant" ? ElementComponents::contravariant : ElementComponents::covariant;
    options.header = header_;
    return options;
  }

  template <int N>
  void make(Contour<N, double>& contour, const ContourInput& input, ElementReport& report, ProgressBar& bar) const {
    // attributes
    Stopwatch watch;
    if constexpr (N <= 4)
      attributes_.sample_to(contour, image_options(), threads(), bar,
                            {{}, nullptr, false, are_cell_meshes(files(), images())});
    else if (attributes_.wanted())
      throw Error(ErrorCode::InvalidArgument, "--attribute with a 5D contour; expected one in 2 to 4 dimensions");
    report.attribute_seconds = watch.lap();
    // elements
    const WorkOptions work{threads(), bar.stage("elements")};
    const auto found = [&] {
      if constexpr (N <= 4)  // images of 5 axes are not kept
        if (input.image) return elements_by_cell(contour, grid_of<N>(input.image->image), work);
      return elements(contour, work);
    };
    const Elements<N> all = found();
    report.elements_seconds = watch.lap();
    // sums for the report
    const ElementSum<N> sum = sum_of(all);
    report.count = all.centroids.size();
    report.sum.assign(sum.normal.begin(), sum.normal.end());
    report.absolute.assign(sum.absolute.begin(), sum.absolute.end());
    report.closure_error = sum.closure_error();
    report.measure = sum.measure;
    for (int a = 0; a < N; ++a) report.axes.push_back(input.axis_name(a));
    for (const Attribute& attribute : all.attributes) report.attributes.push_back(range_of(attribute));
    // write
    ElementFileOptions options = file_options();
    options.work.progress = bar.stage("write");
    watch.lap();
    write_elements(all, output_, options);
    report.output_bytes = std::filesystem::file_size(output_);
    report.write_seconds = watch.lap();
  }

  template <int N>
  static const Grid<N>& grid_of(const AnyImage& image) {
    return std::visit([](const auto& owned) -> const Grid<N>& { return owned.grid; }, std::get<AnyImageN<N>>(image));
  }

  [[nodiscard]] Json to_json(const ContourInput& input, const ElementReport& report) const {
    Json json;
    add_input_keys(json, input);
    json["output"] = output_;
    json["per"] = per_;
    json["order"] = order_;
    json["components"] = components_;
    json["simplices"] = input.size().simplices;
    json["elements"] = report.count;
    json["axes"] = report.axes;
    json["sum"] = report.sum;
    json["absolute"] = report.absolute;
    json["closure_error"] = report.closure_error;
    json["measure"] = report.measure;
    json["attributes"] = Json::array();
    for (const auto& range : report.attributes) {
      const bool any = range.min <= range.max;
      json["attributes"].push_back({{"name", range.name},
                                    {"unit", range.unit},
                                    {"min", any ? Json(range.min) : Json(nullptr)},
                                    {"max", any ? Json(range.max) : Json(nullptr)},
                                    {"missing", range.missing}});
    }
    const double contour = input.seconds.total() - input.seconds.read;
    json["seconds"] = {
        {"read", input.seconds.read},
        {"contour", contour},
        {"attributes", report.attribute_seconds},
        {"elements", report.elements_seconds},
        {"write", report.write_seconds},
        {"total", input.seconds.total() + report.attribute_seconds + report.elements_seconds + report.write_seconds}};
    return json;
  }

  /// The sum of the normals as text, with a verdict whether the elements are closed.
  [[nodiscard]] static std::string sum_text(const ElementReport& report) {
    std::string sum;
    for (std::size_t a = 0; a < report.axes.size(); ++a)
      sum += fmt::format("{}{} {}", a == 0 ? "" : ", ", report.axes[a], number(report.sum[a]));
    return report_line("sum", sum) +
           report_line(
               "", report.closure_error < 1e-9
                       ? fmt::format("0 up to rounding ({:.1e} of the whole): closed (Gauss)", report.closure_error)
                       : fmt::format("the contour is open: {:.3g} % of the absolute sum along one axis does not cancel",
                                     100.0 * report.closure_error));
  }

  [[nodiscard]] std::string to_text(const Console& console, const ContourInput& input,
                                    const ElementReport& report) const {
    std::string text =
        fmt::format("{}\n", console.bold(fmt::format("Elements of a contour in {}D", input.space_dim())));
    text += input_text(input);
    text += report_line("elements", fmt::format("{}, one per {}", grouped(report.count),
                                                per_ == "cell" ? "connected part in a cell" : "simplex"));
    if (report.count > 0) text += sum_text(report);
    text += report_line("measure", number(report.measure));
    for (const auto& range : report.attributes) {
      std::string values =
          range.min <= range.max ? fmt::format("{} .. {}", number(range.min), number(range.max)) : "none";
      if (!range.unit.empty()) values += " " + range.unit;
      if (range.missing > 0) values += fmt::format(", {} missing", grouped(range.missing));
      text += report_line("attribute", fmt::format("{}: {}", range.name, values));
    }
    const double seconds =
        input.seconds.total() + report.attribute_seconds + report.elements_seconds + report.write_seconds;
    text +=
        report_line("seconds", fmt::format("{:.3f} = input {:.3f} + attributes {:.3f} + elements {:.3f} + write {:.3f}",
                                           seconds, input.seconds.total(), report.attribute_seconds,
                                           report.elements_seconds, report.write_seconds));
    text += report_line("output", fmt::format("{} ({})", output_, byte_size(report.output_bytes)));
    return text;
  }

  AttributeOptions attributes_;
  std::string output_;
  std::string per_ = "simplex";
  std::string order_ = "time-first";
  std::string components_ = "covariant";
  bool header_ = false;
};

}  // namespace

std::unique_ptr<Command> make_elements_command(CLI::App& program) { return std::make_unique<ElementsCommand>(program); }

}  // namespace tegl::cli
