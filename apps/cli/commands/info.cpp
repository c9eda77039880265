// SPDX-License-Identifier: BSD-3-Clause
//
// tegl info: describes the contents of a file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "base/statistics.hpp"
#include "commands/contour_info.hpp"
#include "commands/index.hpp"
#include "commands/mesh_info.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/mesh_input.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/curved.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kInfoExamples =
    "Examples:\n"
    "  tegl info brain.nii.gz\n"
    "  tegl info ocean.nc --var TEMP --json\n"
    "  tegl info ensemble.nc --fix member=3\n"
    "Suggested values: 'otsu' is Otsu's threshold between two classes, 'contrast' has the largest mean gradient\n"
    "along its contour, 'median' and 'percentile p' have 50 or p % of the samples below. 'edges' is the number\n"
    "of grid edges that the contour crosses: about the number of its vertices.";
constexpr std::size_t kJsonBins = 256;
constexpr std::size_t kTextBins = 16;
constexpr std::size_t kMostAxes = 5;

/// Samples at the end of an axis that are at the longitudes of the first ones, 360 degrees further.
struct RepeatedSamples {
  std::string axis;
  std::size_t count = 0;
  bool have_equal_values = false;  ///< so that contours with a periodic axis leave them out
};

/// The contents of a report, independent of the image's type and dimension.
struct Description {
  ImageInfo info;
  ValueType value_type{};
  std::vector<Axis> axes;
  std::vector<std::vector<double>> linear;  ///< empty if there is no world map
  std::vector<double> offset;
  std::vector<std::string> around;  ///< the axes of longitudes that span 360 degrees, without repeated samples
  std::vector<RepeatedSamples> repeated;
  ValueStatistics values;
  double read_seconds = 0;
  double statistics_seconds = 0;
};

/// Whether samples that are a full turn from the first ones of an axis have their values.
template <Value T, int N>
bool have_equal_values(const Image<T, N>& image, const std::vector<CurvedAxis>& curved, int axis) {
  try {
    return without_repeated<T, N>(image, curved, std::array{axis}).left_out[static_cast<std::size_t>(axis)] > 0;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidArgument) throw;
    return false;
  }
}

template <Value T, int N>
void describe_longitudes(const Image<T, N>& image, Description& description) {
  const std::vector<CurvedAxis>& curved = description.info.curved;
  const Grid<N>& grid = image.grid();
  const auto label = [&](int axis) {
    const auto a = static_cast<std::size_t>(axis);
    return axis_label(grid.axes[a].name, a);
  };
  for (const int axis : longitude_axes<T, N>(image, curved)) description.around.push_back(label(axis));
  for (int axis = 0; axis < N; ++axis)
    if (const std::size_t count = repeated_longitudes<N>(grid, curved, axis); count > 0)
      description.repeated.push_back({label(axis), count, have_equal_values(image, curved, axis)});
}

template <int N>
void describe_grid(const Grid<N>& grid, Description& description) {
  description.axes.assign(grid.axes.begin(), grid.axes.end());
  if (!grid.has_world_map()) return;
  for (int row = 0; row < N; ++row) {
    description.linear.emplace_back();
    for (int column = 0; column < N; ++column) description.linear.back().push_back(grid.linear[row][column]);
    description.offset.push_back(grid.offset[row]);
  }
}

/// The direction of an axis as a word; empty if unknown.
std::string_view direction_name(const ImageInfo& info, std::size_t axis) {
  if (axis >= info.axis_directions.size()) return "";
  switch (info.axis_directions[axis]) {
    case AxisDirection::up:
      return "up";
    case AxisDirection::down:
      return "down";
    default:
      return "";
  }
}

/// The unit of the coordinates along an axis. Another axis's coordinates may differ along it, so the unit belongs to the
/// world's coordinates that differ; empty if these have several units.
std::string unit_along(const Description& description, std::size_t at) {
  if (description.linear.empty()) return description.axes[at].unit;
  constexpr double kRounding = 1e-6;  // of the largest entry
  double largest = 0.0;
  for (const auto& row : description.linear) largest = std::max(largest, std::abs(row[at]));
  std::vector<std::string> units;
  for (std::size_t row = 0; row < description.linear.size(); ++row)
    if (std::abs(description.linear[row][at]) > kRounding * largest) units.push_back(description.axes[row].unit);
  const bool is_one = std::ranges::adjacent_find(units, std::not_equal_to<>()) == units.end();
  return is_one && !units.empty() ? units.front() : std::string();
}

Json axis_json(const Description& description, std::size_t at) {
  const Axis& axis = description.axes[at];
  Json json;
  json["name"] = axis_label(axis.name, at);
  json["unit"] = unit_along(description, at);
  const std::string_view direction = direction_name(description.info, at);
  json["direction"] = direction.empty() ? Json(nullptr) : Json(direction);
  json["size"] = axis.size();
  json["first"] = axis[0];
  json["last"] = axis[axis.size() - 1];
  json["uniform"] = axis.is_uniform();
  if (axis.is_uniform()) {
    json["step"] = axis.step();
  } else {
    Json& coordinates = json["coordinates"] = Json::array();
    for (std::size_t i = 0; i < axis.size(); ++i) coordinates.push_back(axis[i]);
  }
  return json;
}

Json values_json(const ValueStatistics& values) {
  Json json;
  json["samples"] = values.samples;
  json["missing"] = values.missing;
  json["infinite"] = values.infinite;
  json["min"] = values.min;
  json["max"] = values.max;
  json["mean"] = values.mean;
  json["std"] = values.deviation;
  Json& percentiles = json["percentiles"] = Json::object();
  for (const auto& [percent, value] : values.percentiles) percentiles[fmt::format("{}", percent)] = value;
  const Histogram histogram = values.histogram.coarser(kJsonBins);
  json["histogram"] = {{"low", histogram.low}, {"width", histogram.width}, {"counts", histogram.counts}};
  Json& suggested = json["suggested"] = Json::array();
  for (const Suggestion& suggestion : values.suggestions) {
    suggested.push_back(
        {{"value", suggestion.value}, {"method", suggestion.method}, {"edges", suggestion.critical_edges}});
  }
  return json;
}

Json to_json(const Description& description, const InputFiles& input) {
  const ImageInfo& info = description.info;
  Json json;
  json["input"] = input.json();
  json["format"] = info.format;
  json["variable"] = info.variable;
  json["variables"] = info.variables;
  json["value_name"] = info.value_name;
  json["value_unit"] = info.value_unit;
  json["remarks"] = info.remarks;
  json["stored_type"] = info.stored_type ? name_of(*info.stored_type) : "";
  json["value_type"] = name_of(description.value_type);
  json["image_dim"] = description.axes.size();
  Json& axes = json["axes"] = Json::array();
  for (std::size_t i = 0; i < description.axes.size(); ++i) axes.push_back(axis_json(description, i));
  json["periodic"] = description.around;
  Json& repeated = json["repeated"] = Json::array();
  for (const RepeatedSamples& one : description.repeated)
    repeated.push_back({{"axis", one.axis}, {"samples", one.count}, {"equal_values", one.have_equal_values}});
  json["samples_are"] = info.samples_are_cells ? "cells" : "points";
  json["lattice"] = info.lattice ? name_of(*info.lattice) : "cubic";
  Json& curved = json["curved"] = Json::array();
  for (const CurvedAxis& one : info.curved) curved.push_back(one.name);
  json["world_frame"] = info.world_frame;
  json["world"] = nullptr;
  if (!description.linear.empty()) {
    json["world"] = {{"linear", description.linear}, {"offset", description.offset}};
  }
  json.update(values_json(description.values));
  json["seconds"] = {{"read", description.read_seconds}, {"statistics", description.statistics_seconds}};
  return json;
}

std::string axis_text(const Description& description, std::size_t at) {
  const Axis& axis = description.axes[at];
  std::string unit = unit_along(description, at);
  if (!unit.empty()) unit.insert(0, 1, ' ');
  const std::string_view direction = direction_name(description.info, at);
  std::string text =
      fmt::format("{:<6} {:>6} samples, {} .. {}{}{}", axis_label(axis.name, at), axis.size(), number(axis[0]),
                  number(axis[axis.size() - 1]), unit, direction.empty() ? "" : fmt::format(" ({}wards)", direction));
  if (axis.size() < 2) return text;
  if (axis.is_uniform()) return text + fmt::format(", step {}", number(axis.step()));
  double least = std::abs(axis[1] - axis[0]);
  double most = least;
  for (std::size_t i = 2; i < axis.size(); ++i) {
    least = std::min(least, std::abs(axis[i] - axis[i - 1]));
    most = std::max(most, std::abs(axis[i] - axis[i - 1]));
  }
  // Floating-point times are often uniform up to their last digits.
  if (number(least) == number(most)) return text + fmt::format(", steps of about {}", number(most));
  return text + fmt::format(", steps {} to {}", number(least), number(most));
}

/// An entry of a matrix with largest entry `largest`. An entry that is probably rounding noise is shown with one digit,
/// as only its magnitude is meaningful.
std::string matrix_entry(double value, double largest) {
  constexpr double kRounding = 1e-9;
  return value != 0.0 && std::abs(value) < kRounding * largest ? fmt::format("{:.0e}", value) : number(value);
}

/// Formats cells in right-aligned columns, separated by two blanks.
std::vector<std::string> aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::string> lines(rows.size());
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, row[column].size());
    for (std::size_t row = 0; row < rows.size(); ++row)
      lines[row] += fmt::format("{}{:>{}}", column == 0 ? "" : "  ", rows[row][column], width);
  }
  return lines;
}

std::string world_text(const Description& description) {
  const std::string& frame = description.info.world_frame;
  std::vector<std::string> curved;
  for (const CurvedAxis& one : description.info.curved)
    curved.push_back(one.unit.empty() ? one.name : fmt::format("{} ({})", one.name, one.unit));
  if (!curved.empty()) return report_line("world", fmt::format("a curved grid: {}", fmt::join(curved, ", ")));
  if (description.linear.empty()) return report_line("world", frame.empty() ? "the axes themselves" : frame);
  double largest = 0.0;
  for (const auto& row : description.linear)
    for (const double value : row) largest = std::max(largest, std::abs(value));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t row = 0; row < description.linear.size(); ++row) {
    auto& cells = rows.emplace_back();
    for (const double value : description.linear[row]) cells.push_back(matrix_entry(value, largest));
    cells.emplace_back("|");
    cells.push_back(number(description.offset[row]));
  }
  const std::vector<std::string> lines = aligned(rows);
  std::string text;
  for (std::size_t row = 0; row < lines.size(); ++row)
    text += report_line(row == 0 ? "world" : "", lines[row] + (row == 0 && !frame.empty() ? "  " + frame : ""));
  return text;
}

/// A histogram with bars as wide as the terminal allows. Their length is proportional to the square root of the count,
/// because backgrounds are often a hundred times as frequent as objects.
std::string histogram_text(const Histogram& fine, int width) {
  const Histogram histogram = fine.coarser(kTextBins);
  const std::uint64_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  constexpr int kBesideBars = 30;
  const double cells = std::clamp(width - kBesideBars, 10, 100);
  std::string text;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const std::uint64_t count = histogram.counts[i];
    const double share = std::sqrt(static_cast<double>(count) / static_cast<double>(most));
    // At least one cell, so that every occurring value is visible.
    const auto length = count == 0 ? 0 : static_cast<std::size_t>(std::max(1.0, std::round(share * cells)));
    text += fmt::format("  {:>12} {} {}\n", number(histogram.low + static_cast<double>(i) * histogram.width),
                        std::string(length, '#'), grouped(count));
  }
  return text;
}

std::string values_text(const Console& console, const Description& description) {
  const ValueStatistics& values = description.values;
  const std::string unit = description.info.value_unit.empty() ? "" : " " + description.info.value_unit;
  std::string text =
      report_line("samples", fmt::format("{}, {} missing{}", grouped(values.samples), grouped(values.missing),
                                         description.info.samples_are_cells ? "; they are cells" : ""));
  if (values.infinite > 0)
    text += report_line("", fmt::format("{} infinite, excluded below", grouped(values.infinite)));
  if (values.finite() == 0) return text + report_line("values", "none: all samples are missing or infinite");
  text += report_line("values", fmt::format("{} .. {}{}, mean {}, std {}", number(values.min), number(values.max), unit,
                                            number(values.mean), number(values.deviation)));
  std::string percentiles;
  for (const auto& [percent, value] : values.percentiles) {
    percentiles += fmt::format("{}{} %: {}", percentiles.empty() ? "" : ", ", percent, number(value));
  }
  text += report_line("percentiles", percentiles);
  text += fmt::format("\n{}\n", console.bold("Histogram (lower bound of each bin; bar: square root of the count)"));
  text += histogram_text(values.histogram, console.width());
  if (values.suggestions.empty())
    return text +
           (values.min == values.max
                ? "\nAll values are equal: there is nothing to contour.\n"
                : "\nNo two neighbours differ (samples are missing between them): there is nothing to contour.\n");
  text += fmt::format("\n{}\n", console.bold("Suggested values"));
  for (const Suggestion& suggestion : values.suggestions) {
    text += fmt::format("  {:>12} {:<14} {} edges{}\n", number(suggestion.value), suggestion.method,
                        grouped(suggestion.critical_edges), description.info.lattice ? " along the axes" : "");
  }
  return text;
}

std::string repeated_text(const RepeatedSamples& one) {
  const std::string last = one.count == 1 ? "the last sample" : fmt::format("the last {} samples", one.count);
  if (!one.have_equal_values)
    return fmt::format("{} along {} {} at the longitudes of the first, 360 degrees further, with other values", last,
                       one.axis, one.count == 1 ? "is" : "are");
  return fmt::format("{} along {} {}: --periodic {} leaves {} out", last, one.axis,
                     one.count == 1 ? "repeats the first one" : "repeat the first ones", one.axis,
                     one.count == 1 ? "it" : "them");
}

std::string to_text(const Console& console, const Description& description, const std::string& file) {
  const ImageInfo& info = description.info;
  std::string text =
      fmt::format("{}\n", console.bold(fmt::format("{}: {}D {}", file, description.axes.size(), info.format)));
  if (!info.variable.empty()) {
    text += report_line("variable", info.value_name.empty() ? info.variable : info.variable + ": " + info.value_name);
  }
  if (info.variables.size() > 1) text += report_line("variables", fmt::format("{}", fmt::join(info.variables, ", ")));
  for (std::size_t i = 0; i < description.axes.size(); ++i) {
    text += report_line(i == 0 ? "axes" : "", axis_text(description, i));
  }
  if (info.lattice)
    text += report_line("lattice", fmt::format("{}: odd layers are shifted by half a step", name_of(*info.lattice)));
  if (!description.around.empty()) {
    const std::string names = fmt::format("{}", fmt::join(description.around, ","));
    text +=
        report_line("periodic", fmt::format("{} spans 360 degrees: --periodic auto continues across its ends", names));
  }
  for (const RepeatedSamples& one : description.repeated) text += report_line("repeated", repeated_text(one));
  text += world_text(description);
  const ValueType stored = info.stored_type.value_or(description.value_type);
  text += report_line("type", stored == description.value_type
                                  ? std::string(name_of(stored))
                                  : fmt::format("{}, read as {}", name_of(stored), name_of(description.value_type)));
  text += values_text(console, description);
  return text + fmt::format("\n  {:<12} read {:.3f} + statistics {:.3f}\n", "seconds", description.read_seconds,
                            description.statistics_seconds);
}

/// Sizes and names of dimensions, "5 x 4 x 3 x 2 x 6 (x, y, z, time, member)"; names only for variables that are images
/// only after an index of a dimension is chosen.
std::string variable_shape(const ImageVariable& variable) {
  const std::string sizes = fmt::format("{}", fmt::join(variable.sizes, " x "));
  return variable.sizes.size() > kMostAxes ? fmt::format("{} ({})", sizes, fmt::join(variable.axes, ", ")) : sizes;
}

/// The list of variables, for a file with several, or one with too many axes, if none was selected.
std::string choice_text(const Console& console, const InputFiles& input, const std::vector<ImageVariable>& variables) {
  const std::string option = ImageOptions::choosing_option(input.names);
  const std::string title = variables.size() == 1  ? fmt::format("a variable of {} axes", variables[0].sizes.size())
                            : option == "--series" ? "several series"
                                                   : "several variables";
  std::string text = fmt::format("{}\n", console.bold(fmt::format("{}: {}", input.text(), title)));
  std::size_t number = 0;  // number for --series
  for (const ImageVariable& variable : variables) {
    const std::string name = option == "--series" ? fmt::format("{:>2}  {}", ++number, variable.name) : variable.name;
    text += report_line(
        name, fmt::format("{}{}{}", variable_shape(variable), variable.unit.empty() ? "" : " " + variable.unit,
                          variable.long_name.empty() ? "" : ", " + variable.long_name));
  }
  text += "\n";
  if (variables.size() > 1)
    text += fmt::format("Choose one with {}{}.\n", option, number > 0 ? ", by its number or name" : "");
  const auto large = std::ranges::find_if(variables, [](const auto& one) { return one.sizes.size() > kMostAxes; });
  if (large != variables.end())
    text += fmt::format("Images have 2 to {} axes: choose an index of a dimension, as with --fix {}=0.\n", kMostAxes,
                        large->axes.empty() ? "DIM" : large->axes.back());
  return text;
}

Json choice_json(const InputFiles& input, const std::vector<ImageVariable>& variables) {
  Json json;
  json["input"] = input.json();
  json["variable"] = nullptr;
  json["variables"] = Json::array();
  json["shapes"] = Json::object();
  json["dimensions"] = Json::object();
  for (const ImageVariable& variable : variables) {
    json["variables"].push_back(variable.name);
    json["shapes"][variable.name] = variable.sizes;
    json["dimensions"][variable.name] = variable.axes;
  }
  return json;
}

class InfoCommand final : public Command {
 public:
  explicit InfoCommand(CLI::App& program)
      : Command(
            program, "info", "Describe a file: axes, values, histogram, suggested isovalues",
            "the image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped), VTK (.vti, .vtr, .pvd) "
            "or DICOM (a folder); or a mesh (.vtu, .vts, .pvd), a table of points (.csv), a saved contour (.vtkhdf, "
            ".ply "
            "...) or an index (.tindex)",
            Files::image) {
    add_image_options();
    lattice_option_ = app()
                          .add_option("--lattice", lattice_,
                                      "cubic: leave the lattice that the file records out of "
                                      "account, also one that its axes cannot have")
                          ->check(CLI::IsMember({"cubic"}));
    app().footer(kInfoExamples);
  }

  ExitCode run(const Streams& streams) override {
    require_inputs();
    // an index file
    if (is_index_file(file())) {
      refuse_lattice("an index");
      if (const auto given = images().given(); !given.empty() || files().size() > 1)
        throw Error(ErrorCode::InvalidArgument, fmt::format("{} is an index, not an image; expected it without {}",
                                                            file(), given.empty() ? "other files" : given.front()));
      streams.out.write(index_info(streams.out, file(), json()));
      return ExitCode::Ok;
    }
    if (find_mesh_file_format(file()) != nullptr) return describe_contour(streams);
    if (are_cell_meshes(files(), images())) return describe_mesh(streams);
    // several variables: a list to choose from
    if (images().variable().empty() && !images().has_fixed()) {
      const std::vector<ImageVariable> variables = images().variables(files());
      if (variables.size() > 1 || (variables.size() == 1 && variables[0].sizes.size() > kMostAxes)) {
        streams.out.write(json() ? dump(choice_json(inputs(), variables))
                                 : choice_text(streams.out, inputs(), variables));
        return ExitCode::Ok;
      }
    }
    // an image: read and describe
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const auto any = read_to_5d(bar.stage("read"), CurvedGrids::allowed);
    Description description;
    description.info = std::visit([](const auto& image) { return image.info; }, any);
    description.read_seconds = watch.lap();
    InterruptHandler::throw_if_requested();
    const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      description.value_type = kValueType<T>;
      describe_grid(owned.grid, description);
      if constexpr (N <= 4) describe_longitudes(owned.view(), description);
    };
    if (const auto* const in_5d = std::get_if<ReadImage5dResult>(&any))
      std::visit(of_owned, in_5d->image);
    else
      std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, std::get<ReadImageResult>(any).image);
    description.values = std::visit([](const auto& image) { return value_statistics(image.image); }, any);
    description.statistics_seconds = watch.lap();
    bar.clear();
    streams.out.write(json() ? dump(to_json(description, inputs()))
                             : to_text(streams.out, description, inputs().text()));
    return ExitCode::Ok;
  }

 private:
  [[nodiscard]] bool knows_lattices() const override { return true; }
  void refuse_lattice(const char* kind) const {
    if (lattice_option_->count() > 0)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--lattice {} with {}, which is {}; expected it with an image", lattice_, file(), kind));
  }
  ExitCode describe_contour(const Streams& streams) {
    refuse_lattice("a contour");
    refuse_image_options(files(), {}, images(), "it without options for images");
    ProgressBar bar(streams.err, wants_progress());
    const Mesh mesh = read_finite_mesh(file(), mesh_options(bar.stage("read")));
    bar.clear();
    streams.out.write(json() ? dump(contour_json(mesh, inputs())) : contour_text(streams.out, mesh, file()));
    return ExitCode::Ok;
  }

  ExitCode describe_mesh(const Streams& streams) {
    refuse_lattice("a mesh");
    if (const auto given = images().given(); !given.empty() || files().size() > 1)
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} is a mesh; expected it without {}", file(),
                                                          given.empty() ? "other files" : given.front()));
    ProgressBar bar(streams.err, wants_progress());
    const CellMeshInfo info = describe_cell_mesh(file(), images().cell_mesh_options(bar.stage("read")));
    bar.clear();
    remark(info.remarks);
    streams.out.write(json() ? dump(mesh_json(info, inputs())) : mesh_text(streams.out, info, file()));
    return ExitCode::Ok;
  }

  std::string lattice_;
  CLI::Option* lattice_option_ = nullptr;
};

}  // namespace

std::unique_ptr<Command> make_info_command(CLI::App& program) { return std::make_unique<InfoCommand>(program); }

}  // namespace tegl::cli
