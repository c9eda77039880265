// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the options to read an image from one or several files.
#include "input/image_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/numbers.hpp"
#include "input/cuts.hpp"
#include "io/images/series_request.hpp"
#include "io/meshes/meshes.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

/// Parses "64x64x64x400".
std::vector<std::size_t> parse_sizes(const std::string& text) {
  std::vector<std::size_t> sizes;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('x', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::optional<double> size = parse_number(part);
    constexpr double kMost = 0x1p48;
    if (!size || !(*size >= 1 && *size <= kMost) || *size != static_cast<double>(static_cast<std::size_t>(*size)))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--raw is '{}'; expected sizes such as 64x64x64x400, the fastest axis first", text));
    sizes.push_back(static_cast<std::size_t>(*size));
    begin = end + 1;
  }
  return sizes;
}

/// Parses "member=3", "depth=0" as dimensions and indices. Names may contain an equals sign.
std::vector<FixedIndex> parse_fixed(const std::vector<std::string>& texts) {
  std::vector<FixedIndex> fixed;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::optional<double> index =
        equals == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(equals + 1));
    constexpr double kMost = 0x1p48;
    if (!index || equals == 0 || !(*index >= 0 && *index <= kMost) || *index != std::floor(*index))
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("--fix is '{}'; expected the name of a dimension and an index, 0 or more, as in member=3", text));
    fixed.push_back({text.substr(0, equals), static_cast<std::size_t>(*index)});
  }
  return fixed;
}

constexpr SeriesWords kWords{"--times",     "--time-step", "--time-unit", "--sort",
                             "--sort time", "--sort name", "--sort given"};

/// The order of a value of --sort.
SeriesOrder order_of(const std::string& sort) {
  if (sort == "name") return SeriesOrder::by_name;
  return sort == "time" ? SeriesOrder::coordinate : SeriesOrder::given;
}

std::vector<std::filesystem::path> paths_of(const std::vector<std::string>& files) {
  return {files.begin(), files.end()};
}

/// The end of messages about a mesh that is given as an image; also the library's, if the file is VTKHDF.
constexpr std::string_view kSavedContour = ", such as a saved contour; expected an image";

/// Adds hints to errors: about --var if a variable is missing, and about conflicting options if files are not in
/// monotone order.
template <class Read>
auto with_hint(const std::string& variable, const std::vector<std::string>& files, const SeriesOptions& options,
               const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (const std::string hint = series_hint(error, options, kWords); !hint.empty())
      throw Error(error.code(), error.what() + hint);
    if (error.code() == ErrorCode::UnsupportedFormat && find_mesh_file_format(files.front()) != nullptr)
      throw Error(error.code(), with_option_names(fmt::format("{}: holds a mesh{}", files.front(), kSavedContour)));
    if (error.code() != ErrorCode::VariableNotFound || !variable.empty())
      throw Error(error.code(), with_option_names(error.what()));
    throw Error(error.code(),
                fmt::format("{} (choose it with {})", error.what(), ImageOptions::choosing_option(files)));
  }
}

}  // namespace

std::string with_option_names(std::string message) {
  if (message.find("a fixed index of another dimension") != std::string::npos) message += " (--fix DIMENSION=INDEX)";
  if (message.find("unknown image format") != std::string::npos)
    message += "; commands with --iso, and info, also take meshes (.vtu, .vts, .pvd) and tables of points (.csv)";
  if (message.find("holds a mesh ('UnstructuredGrid')") != std::string::npos)
    message += "; commands with --iso, and info, take meshes";
  if (message.ends_with(kSavedContour)) message += ": 'tegl check' and 'tegl slice' take meshes";
  return message;
}

void ImageOptions::add_to(CLI::App& app) {
  options_ = {
      app.add_option("--var", variable_,
                     "netCDF: the variable to read; .npz, VTK: the array; .csv: the column; needed if the file has "
                     "several. VTK: NAME:K is "
                     "component K of a vector, NAME:magnitude its length")
          ->type_name("NAME"),
      app.add_option("--series", series_,
                     "DICOM: the series to read, by its UID, its description or its number in the list of 'tegl info'; "
                     "needed if a folder has several")
          ->type_name("SERIES"),
      app.add_option("--times", times_,
                     "several FILEs: coordinate of each along the new axis, in the order of the list: 0,0.5,2; or "
                     "FIRST:LAST:COUNT; default: the times in the files, else 0, 1, 2 ...")
          ->type_name("NUMBERS"),
      app.add_option("--time-step", time_step_,
                     "several FILEs: coordinates 0, this, twice this ..., in the order of --sort")
          ->type_name("NUMBER"),
      app.add_option("--time-unit", time_unit_,
                     "several FILEs: unit of the new axis; times in headers in another unit of time are converted")
          ->type_name("UNIT"),
      app.add_option("--sort", sort_,
                     "several FILEs: order by the numbers in their names, by their times (--times or the times in "
                     "their headers), or as given")
          ->check(CLI::IsMember({"given", "name", "time"})),
      app.add_option("--fix", fixed_,
                     "netCDF: read one index of this dimension, counted from 0, as in member=3; may be given again. "
                     "Needed for variables of more than 5 axes")
          ->allow_extra_args(false)
          ->type_name("DIM=INDEX"),
  };
  options_[1]->excludes(options_[0]);
  options_.push_back(
      app.add_flag("--cells-to-points", cells_to_points_,
                   "meshes: values of cells become values of points, by the mean of the cells at a point"));
  options_.push_back(app.add_flag("--index-grid", index_grid_,
                                  "netCDF, --curved-grid: indices in place of the coordinates of a curved grid"));
  options_.push_back(app.add_flag("--curved-grid", curved_grid_,
                                  ".vts: as an image on a curved grid, with the options of images, and not as a mesh"));
  add_raw_to(app);
}

void ImageOptions::add_raw_to(CLI::App& app) {
  raw_option_ = app.add_option("--raw", raw_, "FILE contains raw values of these sizes, the fastest axis first")
                    ->type_name("XxYxZ[xT]");
  CLI::Option* const type = app.add_option("--raw-type", raw_type_, "type of the raw values")
                                ->check(CLI::IsMember({"uint8", "int8", "uint16", "int16", "int32", "float", "double"}))
                                ->needs(raw_option_);
  raw_option_->needs(type);
  options_.push_back(raw_option_);
  options_.push_back(type);
  options_.push_back(app.add_option("--raw-offset", raw_offset_, "bytes before the first value")
                         ->needs(raw_option_)
                         ->check(whole_number(0, std::uint64_t{1} << 62))
                         ->type_name("BYTES")
                         ->capture_default_str());
  options_.push_back(
      app.add_flag("--raw-big-endian", raw_big_endian_, "the raw values are big-endian")->needs(raw_option_));
  const auto add_of_axes = [&](const char* name, std::string& text, const char* type_name, const char* help) {
    options_.push_back(app.add_option(name, text, help)->needs(raw_option_)->type_name(type_name));
  };
  add_of_axes("--spacing,--step", spacing_, "NUMBERS",
              "--raw: distance of neighbouring samples, one number per axis or one for all: 0.8,0.8,3");
  add_of_axes("--origin", origin_, "NUMBERS",
              "--raw: coordinates of the first sample, one number per axis or one for all");
  add_of_axes("--axis-names", axis_names_, "NAMES", "--raw: one name per axis, as in lon,lat,depth,month");
  add_of_axes("--axis-units", axis_units_, "UNITS", "--raw: one unit per axis, as in mm,mm,mm,s; empty for none");
}

void ImageOptions::add_in_process_to(CLI::App& app) {
  app.add_flag(
      "--in-process", in_process_,
      "read netCDF-4, VTKHDF and DICOM in this process, not in a child process: a damaged file may crash the program");
}

std::vector<std::string> ImageOptions::given() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_)
    if (option->count() > 0) names.push_back(option->get_name());
  return names;
}

std::string ImageOptions::choosing_option(const std::vector<std::string>& files) {
  const std::vector<std::filesystem::path> first = {files.front()};
  return std::filesystem::is_directory(first[0]) || are_dicom_files(first) ? "--series" : "--var";
}

void ImageOptions::require_fitting_choice(const std::vector<std::string>& files) const {
  if (raw() || variable().empty()) return;
  const std::string given = series_.empty() ? "--var" : "--series";
  const std::string expected = choosing_option(files);
  if (given == expected) return;
  throw Error(ErrorCode::InvalidArgument, fmt::format("{} {} with {}, which is {}DICOM; expected {}", given, variable(),
                                                      files.front(), expected == "--series" ? "" : "no ", expected));
}

SeriesOptions ImageOptions::series_options(const std::vector<std::string>& files) const {
  require_fitting_choice(files);
  if (cells_to_points_)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--cells-to-points with {}, which is an image; expected it with a mesh", files.front()));
  if (raw() && !variable().empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} {} with --raw; expected no variable: raw values have no name",
                            series_.empty() ? "--var" : "--series", variable()));
  const auto names = given();
  const auto is_given = [&](const char* option) {
    return std::find(names.begin(), names.end(), option) != names.end();
  };
  SeriesRequest request;
  request.variable = variable();
  if (is_given("--times")) request.times = parse_numbers("--times", times_);
  if (is_given("--time-step")) request.time_step = parse_finite("--time-step", time_step_);
  if (is_given("--time-unit")) request.time_unit = time_unit_;
  if (is_given("--sort")) request.sort = order_of(sort_);
  request.fixed = parse_fixed(fixed_);
  request.allow_outside_paths = allow_outside_paths_;
  if (raw()) request.raw = raw_layout();
  return tegl::series_options(paths_of(files), request, kWords);
}

RawLayout ImageOptions::raw_layout() const {
  RawLayout layout{
      parse_sizes(raw_), parse_value_type(raw_type_).value(), raw_offset_, raw_big_endian_, {}, {}, {}, {}};
  const std::size_t axes = layout.sizes.size();
  const auto require_axes = [&](const char* option, const std::string& text, std::size_t count) {
    if (count != axes)
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} {} has {}; expected {}, one for each axis of --raw {}",
                                                          option, text, counted(count, "part", "parts"), axes, raw_));
  };
  const auto numbers = [&](const char* option, const std::string& text) {
    if (text.empty()) return std::vector<double>();
    std::vector<double> values;
    for (const std::string_view part : split(text, ',')) values.push_back(parse_finite(option, part));
    if (values.size() == 1) values.resize(axes, values.front());
    require_axes(option, text, values.size());
    return values;
  };
  const auto words = [&](const char* option, const std::string& text) {
    if (text.empty()) return std::vector<std::string>();
    const std::vector<std::string_view> parts = split(text, ',');
    require_axes(option, text, parts.size());
    return std::vector<std::string>(parts.begin(), parts.end());
  };
  layout.spacing = numbers("--spacing", spacing_);
  layout.origin = numbers("--origin", origin_);
  layout.axis_names = words("--axis-names", axis_names_);
  layout.axis_units = words("--axis-units", axis_units_);
  for (const double step : layout.spacing)
    if (step == 0.0) throw Error(ErrorCode::InvalidArgument, fmt::format("--spacing is '{}'; expected no 0", spacing_));
  for (std::size_t a = 0; a < layout.axis_names.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!layout.axis_names[a].empty() && equal_ignoring_case(layout.axis_names[a], layout.axis_names[b]))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--axis-names has the axis {} twice; expected it once", layout.axis_names[a]));
  return layout;
}

template <class Function>
auto ImageOptions::read_by(const Function& function, const std::vector<std::string>& files, const Progress& progress,
                           bool keep_stored) const {
  for (const std::string& file : files) require_input(file, Folders::allowed);
  SeriesOptions options = series_options(files);
  options.work.progress = progress;
  options.separate_process = separate_process();
  options.keep_stored = keep_stored;
  options.as_cubic = as_cubic_;
  return with_hint(variable(), files, options, [&] { return function(paths_of(files), options); });
}

ReadSeriesResult ImageOptions::read(const std::vector<std::string>& files, const Progress& progress) const {
  ReadSeriesResult result = read_by(&read_series, files, progress);
  remember(result.info);
  return result;
}

std::variant<ReadSeriesResult, ReadSeries5dResult> ImageOptions::read_to_5d(const std::vector<std::string>& files,
                                                                            const Progress& progress,
                                                                            bool keep_stored) const {
  auto result = read_by(&read_series_to_5d, files, progress, keep_stored);
  std::visit([&](const auto& read) { remember(read.info); }, result);
  return result;
}

OpenSeriesResult ImageOptions::open(const std::vector<std::string>& files) const {
  OpenSeriesResult result = read_by(&open_series, files, {});
  remember(result.info);
  return result;
}

CellMeshOptions ImageOptions::cell_mesh_options(const Progress& progress, const std::vector<std::string>& files) const {
  CellMeshOptions options;
  if (!sort_.empty()) options.order = order_of(sort_);
  if (options.order != SeriesOrder::given && files.size() == 1 &&
      !equal_ignoring_case(std::filesystem::path(files[0]).extension().string(), ".pvd"))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--sort {} with {}, which is one mesh; expected several", sort_, files[0]));
  if (options.order == SeriesOrder::coordinate && !time_step_.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--sort time with --time-step, which follows the order of the files; expected --times");
  // several files: only the order of a shell is an error of the empty request
  if (sort_.empty() && files.size() > 1) (void)tegl::series_options(paths_of(files), {}, kWords);
  options.variable = variable_;
  options.cells_to_points = cells_to_points_;
  options.allow_outside_paths = allow_outside_paths_;
  options.work.progress = progress;
  if (!times_.empty() && !time_step_.empty())
    throw Error(ErrorCode::InvalidArgument, "--times and --time-step; expected one of the two");
  if (!times_.empty()) options.times = parse_numbers("--times", times_);
  if (!time_step_.empty()) options.time_step = parse_finite("--time-step", time_step_);
  return options;
}

std::vector<ImageVariable> ImageOptions::variables(const std::vector<std::string>& files) const {
  if (raw()) return {};
  ReadImageOptions options;
  options.allow_outside_paths = allow_outside_paths_;
  options.separate_process = separate_process();
  try {
    return list_image_variables(files.front(), options);
  } catch (const Error& error) {
    throw Error(error.code(), with_option_names(error.what()));
  }
}

}  // namespace tegl::cli
