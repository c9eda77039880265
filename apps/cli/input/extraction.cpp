// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the options of extraction, the checks before it, and checking and writing of its result.
#include "input/extraction.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/statistics.hpp"
#include "base/word_list.hpp"
#include "io/meshes/meshes.hpp"
#include "output/output.hpp"
#include "tegl/normals.hpp"

namespace tegl::cli {

namespace {

/// Whether the list is this word, in any case.
bool is_only(const std::vector<std::string>& list, const char* word) {
  return list.size() == 1 && equal_ignoring_case(list[0], word);
}

}  // namespace

void ExtractionOptions::add_to(CLI::App& app, bool of_images_alone) {
  // Every command knows all values, for error messages about wrong ones; help lists the valid ones.
  CLI::Validator triangulations =
      CLI::IsMember({"compact", "barycentric", "fan", "zigzag", "halving-chord", "halving-kink"});
  if (!of_images_alone) triangulations.description("{compact,barycentric}");
  options_ = {
      app.add_option("--iso", isos_,
                     of_images_alone ? "the isovalue: samples at or above it are inside; or several: 20,25,30, or "
                                       "FIRST:LAST:COUNT"
                                     : "the isovalue: samples at or above it are inside")
          ->allow_extra_args(false)
          ->type_name(of_images_alone ? "NUMBERS" : "NUMBER"),
      app.add_option("--triangulation", triangulation_,
                     of_images_alone
                         ? "compact: few simplices; barycentric: more simplices of more even shape; for polygons of 3D "
                           "images: fan, zigzag, halving-chord, halving-kink"
                         : "compact: few simplices; barycentric: more simplices of more even shape")
          ->check(triangulations)
          ->capture_default_str(),
      app.add_option(
             "--ambiguity", ambiguity_,
             "ambiguous cells: inside samples across a diagonal are separate (low), joined (high) or resolved "
             "from the data, by the mean of the samples (mean) or the multilinear interpolant (saddle); or only "
             "in squares, by the mean (squares) or the bilinear interpolant (decider), without tunnels in cells")
          ->check(CLI::IsMember({"low", "high", "mean", "saddle", "squares", "decider"}))
          ->capture_default_str(),
      app.add_flag("--close", close_, "close the contour at the image's border"),
      app.add_flag(
             "--normals{gradient}", normals_,
             "normals: from the image's gradient (gradient; sobel or prewitt for noisy images; context for images "
             "of several materials; forward, backward) or from the contour, at vertices (geometric) or simplices "
             "(flat); gradient if no value is given")
          ->check(
              CLI::IsMember({"gradient", "sobel", "prewitt", "context", "forward", "backward", "geometric", "flat"})),
      app.add_option("--gradient-direction", direction_, "the contour faces lower (descent) or higher values (ascent)")
          ->check(CLI::IsMember({"descent", "ascent"}))
          ->capture_default_str(),
      app.add_option("--epsilon", epsilon_,
                     "minimum distance of vertices from samples, as a fraction of an edge, in [0, 0.5)")
          ->type_name("NUMBER")
          ->capture_default_str(),
      app.add_option("--threads", threads_, "number of threads; 0: all processors")
          ->type_name("COUNT")
          ->check(whole_number(0, 4096))
          ->capture_default_str(),
      app.add_option("--precision", precision_, "precision of the vertices")
          ->check(CLI::IsMember({"float", "double"}))
          ->capture_default_str(),
  };
  options_.front()->required(of_images_alone);
  app.add_flag("--allow-empty", allow_empty_, "a value outside of the data gives an empty result, not an error");
}

void ExtractionOptions::add_tiling_to(CLI::App& app, std::vector<std::string> without_periods) {
  app_ = &app;
  without_periods_ = std::move(without_periods);
  options_.push_back(
      add_word_list(
          app, "--periodic", periodic_,
          "axes that are periodic, by name, as in lon, or by letter, as in x,y,z; or "
          "longitude, by its unit; or all; the period is the number of samples x the step, 360 "
          "for longitudes, or as in x=2.5, in the axis's unit: more than the distance of the first and last sample, "
          "and than twice each step; "
          "auto: longitudes that span 360 degrees; none: no axis, and no remark on such "
          "longitudes")
          ->type_name("AXES"));
  options_.push_back(app.add_option("--lattice", lattice_,
                                    "samples on a staggered lattice: odd layers are shifted by half a step along the "
                                    "axes before; triangular (2D), fcc or bcc (3D), d4 or fcc_in_time (4D); cubic: on "
                                    "none; default: as the file says")
                         ->check(CLI::IsMember({"cubic", "triangular", "fcc", "bcc", "d4", "fcc_in_time"})));
  options_.push_back(
      app.add_option("--division", division_,
                     "divide cells into simplices: kuhn or symmetric (2D to 5D), in 2D and 3D also alternating, or "
                     "hybrid (ambiguous cells only)")
          ->check(CLI::IsMember({"kuhn", "alternating", "symmetric", "hybrid"})));
  add_samples_are_to(app);
}

void ExtractionOptions::add_samples_are_to(CLI::App& app) {
  options_.push_back(
      app.add_option("--samples-are", samples_,
                     "cells: the contour runs along the faces between high and low cells and encloses "
                     "their exact volume; closed at the image border. file: cells, if the file says that "
                     "they are")
          ->check(CLI::IsMember({"points", "cells", "file"}))
          ->capture_default_str());
}

Tiling ExtractionOptions::tiling() const {
  if (samples_ == "cells") {
    const std::string cells = "--samples-are " + samples_;
    refuse_periodic_with(cells);
    refuse_lattice_with(cells);
    refuse_division_with(cells);
  }
  if (!division_.empty()) refuse_lattice_with("--division " + division_);
  Tiling tiling{periodic(), std::nullopt, std::nullopt, {}, samples_ == "cells"};
  for (const Division division : {Division::kuhn, Division::alternating, Division::symmetric, Division::hybrid})
    if (name_of(division) == division_) tiling.division = division;
  tiling.lattice = parse_lattice(lattice_);
  return tiling;
}

void ExtractionOptions::take_lattice(const ImageInfo& info, const std::string& file, Tiling& tiling) const {
  if (tiling.division) refuse_lattice(info, file, "--division " + division_);
  if (tiling.of_cells) refuse_lattice(info, file, "--samples-are " + samples_);
  if (lattice_.empty()) tiling.lattice = info.lattice;
}

void ExtractionOptions::refuse_lattice(const ImageInfo& info, const std::string& file, const std::string& with) const {
  if (!lattice_.empty() || !info.lattice) return;
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("{}: {} is on the lattice {}; expected it without this, or --lattice cubic to leave the "
                          "lattice out of account",
                          with, file, name_of(*info.lattice)));
}

std::vector<std::string> ExtractionOptions::periodic() const {
  for (const char* const word : {"auto", "none"})
    if (periodic_.size() > 1 && std::any_of(periodic_.begin(), periodic_.end(), [word](const std::string& axis) {
          return equal_ignoring_case(axis, word);
        }))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--periodic {}; expected {} without other axes", fmt::join(periodic_, ","), word));
  return is_only(periodic_, "none") ? std::vector<std::string>() : periodic_;
}

bool ExtractionOptions::finds_longitudes() const { return is_only(periodic_, "auto"); }

bool ExtractionOptions::knows_periods(const Tiling& tiling) const {
  const auto is_given = [&](const char* name) {
    const CLI::Option* const option = app_->get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  };
  if (app_ == nullptr || polygon_triangulation()) return false;
  if (is_given("--attribute") && !tiling.curved.empty()) return false;
  return std::none_of(without_periods_.begin(), without_periods_.end(), [&](const std::string& name) {
    return is_given(name.c_str()) && app_->get_option(name)->as<std::string>() != "linear";  // of --positions
  });
}

namespace {

/// The end of the remark that no longitudes span 360 degrees: the reason, if there are longitudes.
template <int N>
std::string hint_on_longitudes(const Grid<N>& grid, const std::vector<CurvedAxis>& curved) {
  constexpr std::string_view kEnd = ", so no axis is periodic";
  for (std::size_t a = 0; a < N; ++a)
    if (const std::size_t count = repeated_longitudes<N>(grid, curved, static_cast<int>(a)); count > 0)
      return fmt::format(
          "{}: the last {} along {} at the longitudes of the first, 360 degrees further; --periodic {} leaves out the "
          "last {}, except with --stream, if the values are equal",
          kEnd, count == 1 ? "sample" : fmt::format("{} samples", count),
          axis_label(grid.axes[a].name, a) + (count == 1 ? " is" : " are"), axis_label(grid.axes[a].name, a),
          count == 1 ? "one" : "ones");
  for (const CurvedAxis& one : curved)
    if (is_longitude_unit(one.unit))
      return fmt::format(
          "{}: the step behind the last sample is not 0.5 to 1.5 mean steps in each row; if they run around the globe, "
          "--periodic {} makes the axis periodic",
          kEnd, one.name);
  for (std::size_t a = 0; a < N; ++a)
    if (is_longitude_unit(grid.axes[a].unit))
      return fmt::format(" in even steps{}; if they run around the globe, --periodic {} makes the axis periodic", kEnd,
                         axis_label(grid.axes[a].name, a));
  return std::string(kEnd);
}

}  // namespace

template <int N>
std::string ExtractionOptions::take_longitudes(const Grid<N>& grid, const std::vector<int>& around,
                                               Tiling& tiling) const {
  const bool finds = finds_longitudes();
  const bool may_be_periodic = periodic_.empty() && !tiling.of_cells;
  if (!finds && !may_be_periodic) return "";
  std::vector<std::string> names;
  for (const int a : around) {
    const auto axis = static_cast<std::size_t>(a);
    names.push_back(axis_label(grid.axes[axis].name, axis));
  }
  const std::string list = fmt::format("{}", fmt::join(names, ","));
  if (finds) {
    tiling.periodic = std::move(names);
    return list.empty() ? "--periodic auto: no longitudes span 360 degrees" + hint_on_longitudes<N>(grid, tiling.curved)
                        : list + " spans 360 degrees, so it is periodic";
  }
  if (list.empty()) return "";
  return fmt::format(
      "{} spans 360 degrees, and the contour ends at both its ends: {}--periodic none suppresses this remark", list,
      knows_periods(tiling) ? "--periodic auto continues it across, " : "");
}

template std::string ExtractionOptions::take_longitudes(const Grid<2>&, const std::vector<int>&, Tiling&) const;
template std::string ExtractionOptions::take_longitudes(const Grid<3>&, const std::vector<int>&, Tiling&) const;
template std::string ExtractionOptions::take_longitudes(const Grid<4>&, const std::vector<int>&, Tiling&) const;

void ExtractionOptions::refuse_periodic_with(const std::string& other) const {
  if (!periodic().empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--periodic {} with {}; expected one of the two", fmt::join(periodic_, ","), other));
}

std::string ExtractionOptions::given_tiling() const {
  return periodic().empty() ? given_other_tiling() : fmt::format("--periodic {}", fmt::join(periodic_, ","));
}

std::string ExtractionOptions::given_other_tiling() const {
  if (has_lattice()) return "--lattice " + lattice_;
  if (!division_.empty()) return "--division " + division_;
  return samples_ == "cells" ? "--samples-are " + samples_ : std::string();
}

void ExtractionOptions::refuse_tiling(const std::string& with) const {
  refuse_periodic_with(with);
  refuse_other_tiling(with);
}

void ExtractionOptions::refuse_other_tiling(const std::string& with) const {
  if (const std::string given = given_other_tiling(); !given.empty())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} with {}; expected one of the two", given, with));
}

void ExtractionOptions::refuse_cells(bool samples_are_cells, const std::string& file, const std::string& with) const {
  if (samples_are_as_in_file() && samples_are_cells)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--samples-are file with {}, and the samples of {} are cells; expected --samples-are points", with,
                    file));
}

void ExtractionOptions::refuse_cells_with_tiling(bool samples_are_cells, const std::string& file) const {
  if (!division_.empty()) refuse_cells(samples_are_cells, file, "--division " + division_);
  if (has_lattice()) refuse_cells(samples_are_cells, file, "--lattice " + lattice_);
  if (!periodic().empty()) refuse_cells(samples_are_cells, file, "--periodic");
}

void ExtractionOptions::refuse_division_with(const std::string& other) const {
  if (!division_.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--division {} with {}; expected one of the two", division_, other));
}

void ExtractionOptions::refuse_lattice_with(const std::string& other) const {
  if (has_lattice())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--lattice {} with {}; expected one of the two", lattice_, other));
}

std::vector<std::string> ExtractionOptions::given() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

double ExtractionOptions::isovalue() const {
  const std::vector<SpelledNumber> all = isovalues();
  if (all.size() > 1)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--iso has {} numbers, {} and others; expected one: 'tegl contour' makes contours at several",
                    all.size(), all.front().text));
  return all.front().value;
}

std::vector<SpelledNumber> ExtractionOptions::isovalues() const {
  if (options_.front()->count() == 0)
    throw Error(ErrorCode::InvalidArgument, "--iso is missing; expected the isovalue, as in --iso 20");
  std::vector<SpelledNumber> all;
  for (const std::string& text : isos_)
    for (SpelledNumber& number : parse_spelled_numbers("--iso", text)) {
      if (std::any_of(all.begin(), all.end(), [&](const SpelledNumber& other) { return other.value == number.value; }))
        throw Error(ErrorCode::InvalidArgument, fmt::format("--iso has {} twice; expected it once", number.text));
      all.push_back(std::move(number));
    }
  return all;
}

std::optional<PolygonTriangulation> ExtractionOptions::polygon_triangulation() const {
  if (triangulation_ == "fan") return PolygonTriangulation::fan;
  if (triangulation_ == "zigzag") return PolygonTriangulation::zigzag;
  if (triangulation_ == "halving-chord") return PolygonTriangulation::halving_chord;
  if (triangulation_ == "halving-kink") return PolygonTriangulation::halving_kink;
  return std::nullopt;
}

ExtractOptions ExtractionOptions::library_options(bool knows_polygons) const {
  if (polygon_triangulation() && !knows_polygons)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--triangulation {} is for 'tegl contour' of 3D images without "
                                                        "--stream, --index and --pick; expected compact or barycentric",
                                                        triangulation_));
  ExtractOptions options;
  options.triangulation = triangulation_ == "compact" ? Triangulation::compact : Triangulation::barycentric;
  options.ambiguity = ambiguity_ == "low"       ? Ambiguity::low
                      : ambiguity_ == "high"    ? Ambiguity::high
                      : ambiguity_ == "mean"    ? Ambiguity::mean
                      : ambiguity_ == "saddle"  ? Ambiguity::saddle
                      : ambiguity_ == "squares" ? Ambiguity::squares
                                                : Ambiguity::decider;
  options.direction = direction_ == "descent" ? GradientDirection::descent : GradientDirection::ascent;
  options.close = close_;
  // geometric and flat normals are computed later
  for (const Normals kind : kNormals)
    if (name_of(kind) == normals_) options.normals = kind;
  options.work.threads = threads_;
  options.epsilon = parse_finite("--epsilon", epsilon_);
  if (options.epsilon < 0 || options.epsilon >= 0.5) {
    throw Error(ErrorCode::InvalidArgument, fmt::format("--epsilon is {}; expected 0 <= epsilon < 0.5", epsilon_));
  }
  return options;
}

void ExtractionOptions::require_to_5d() const {
  constexpr const char* kWhat = "an image of 5 axes";
  if (division_.empty() && !periodic().empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--periodic {} with {}; expected --division kuhn or symmetric with it, or no periodic axes",
                            fmt::join(periodic_, ","), kWhat));
  if (finds_longitudes())
    throw Error(ErrorCode::InvalidArgument, fmt::format("--periodic auto with {}; expected names of axes", kWhat));
  refuse_lattice_with(kWhat);
  if (samples_ == "cells")
    throw Error(ErrorCode::InvalidArgument, fmt::format("--samples-are cells with {}; expected points", kWhat));
  if (!division_.empty() && triangulation_ != "compact")
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--triangulation {} with --division and {}; expected compact", triangulation_, kWhat));
  if (wants_shape_normals())
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--normals {} with {}; expected normals from the image's gradient, or none", normals_, kWhat));
  if (polygon_triangulation())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--triangulation {} with {}; expected compact or barycentric", triangulation_, kWhat));
}

template <int N, class Real>
void ExtractionOptions::add_shape_normals(Contour<N, Real>& contour) const {
  if (normals_ == "geometric") contour.normals = geometric_normals(contour, NormalWeights::angle, {threads_});
  if (normals_ != "flat") return;
  Attribute attribute{"normal", "", N, {}};
  for (const auto& normal : flat_normals(contour, {threads_}))
    attribute.values.insert(attribute.values.end(), normal.begin(), normal.end());
  contour.simplex_attributes.push_back(std::move(attribute));
}

template void ExtractionOptions::add_shape_normals(Contour<2, float>&) const;
template void ExtractionOptions::add_shape_normals(Contour<2, double>&) const;
template void ExtractionOptions::add_shape_normals(Contour<3, float>&) const;
template void ExtractionOptions::add_shape_normals(Contour<3, double>&) const;
template void ExtractionOptions::add_shape_normals(Contour<4, float>&) const;
template void ExtractionOptions::add_shape_normals(Contour<4, double>&) const;

namespace {

/// An axis of --periodic, and its period, if one is given.
struct NamedPeriod {
  int axis;
  std::optional<double> period;
};

/// An axis as --periodic may name it.
struct AxisNames {
  std::vector<std::string> names;  ///< its own, or its letter, and that of its curved coordinate
  bool is_longitude = false;       ///< has longitudes, by their unit
};

/// The names of axes for `axis_called`. One that is named by a letter, also by that of its curved coordinate, has it.
std::vector<std::string> labels_of(const std::vector<AxisNames>& axes) {
  std::vector<std::string> labels;
  for (const AxisNames& axis : axes) {
    const auto is_letter = [](const std::string& name) { return name.size() == 1; };
    const auto letter = std::find_if(axis.names.begin(), axis.names.end(), is_letter);
    labels.push_back(letter != axis.names.end() ? *letter : axis.names.front());
  }
  return labels;
}

/// The axis that a name of --periodic stands for: the one of this name, or else, if only one axis has longitudes, that
/// one for lon and longitude, or else the axis of the letter x, y, z, t or u; axes.size() if there is none.
std::size_t axis_of_period(const std::string& name, const std::vector<AxisNames>& axes) {
  const auto is_name = [&](const std::string& one) { return equal_ignoring_case(one, name); };
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (std::any_of(axes[a].names.begin(), axes[a].names.end(), is_name)) return a;
  const auto has_longitudes = [](const AxisNames& axis) { return axis.is_longitude; };
  if ((is_name("lon") || is_name("longitude")) && std::count_if(axes.begin(), axes.end(), has_longitudes) == 1)
    return static_cast<std::size_t>(std::find_if(axes.begin(), axes.end(), has_longitudes) - axes.begin());
  return axis_called(name, labels_of(axes));
}

[[noreturn]] void fail_to_name(const std::string& name, const std::vector<AxisNames>& axes) {
  std::vector<std::string> all, letters, with_axes;
  bool has_longitudes = false;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    all.push_back(fmt::format("{}", fmt::join(axes[a].names, " or ")));
    has_longitudes = has_longitudes || axes[a].is_longitude;
    const std::string letter = axis_label("", a);
    if (axis_of_period(letter, axes) != a) continue;
    letters.push_back(letter);
    if (letter != all.back()) with_axes.push_back(fmt::format("{} for {}", letter, axes[a].names.front()));
  }
  std::string by_letters;
  if (!with_axes.empty())
    by_letters = letters.size() == axes.size() ? fmt::format(", or {} for them in this order", fmt::join(letters, ", "))
                                               : fmt::format(", or {}", fmt::join(with_axes, ", "));
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("--periodic {} names no axis; expected one of {}{}{}, or all, {}or none", name, fmt::join(all, ", "),
                  by_letters, has_longitudes ? ", or longitude" : "", axes.size() > 4 ? "" : "auto "));
}

/// The axes that --periodic names.
std::vector<NamedPeriod> named_periods(const std::vector<AxisNames>& axes, const std::vector<std::string>& names) {
  std::vector<NamedPeriod> found;
  for (const std::string& name : names) {
    const std::size_t equal = name.find('=');
    const std::string own = name.substr(0, equal);
    const std::size_t named = axis_of_period(own, axes);
    const bool is_all = named == axes.size() && name == "all";
    if (named == axes.size() && !is_all) fail_to_name(name, axes);
    for (std::size_t a = is_all ? 0 : named; a < (is_all ? axes.size() : named + 1); ++a) {
      const auto axis = static_cast<int>(a);
      if (std::any_of(found.begin(), found.end(), [&](const NamedPeriod& other) { return other.axis == axis; }))
        throw Error(ErrorCode::InvalidArgument, fmt::format("--periodic names the axis {} twice; expected it once",
                                                            is_all ? axes[a].names.front() : own));
      NamedPeriod& one = found.emplace_back(NamedPeriod{axis, std::nullopt});
      if (equal != std::string::npos) one.period = parse_finite("--periodic " + own, name.substr(equal + 1));
      if (one.period && !(*one.period > 0.0))
        throw Error(ErrorCode::InvalidArgument, fmt::format("--periodic {}; expected a positive period", name));
    }
  }
  return found;
}

template <int N>
std::vector<AxisNames> names_of_axes(const Grid<N>& grid) {
  std::vector<AxisNames> axes(N);
  for (std::size_t a = 0; a < N; ++a)
    axes[a] = {{axis_label(grid.axes[a].name, a)}, is_longitude_unit(grid.axes[a].unit)};
  return axes;
}

/// The axes that the names of curved coordinates stand for: of longitudes `axis_of_longitudes`. In a file with the
/// other order of dimensions that is the axis of another coordinate, which gets theirs.
template <int N>
std::vector<int> axes_of_names([[maybe_unused]] const Grid<N>& grid, const std::vector<CurvedAxis>& curved) {
  std::vector<int> axes;
  for (const CurvedAxis& one : curved) axes.push_back(one.axis);
  if constexpr (N <= 4)  // 5D images are not curved
    for (std::size_t c = 0; c < curved.size(); ++c) {
      if (!is_longitude_unit(curved[c].unit)) continue;
      const int axis = axis_of_longitudes<N>(grid, curved[c]);
      std::replace(axes.begin(), axes.end(), axis, axes[c]);
      axes[c] = axis;
    }
  return axes;
}

}  // namespace

template <int N>
NamedPeriods named_periods(const Grid<N>& grid, const std::vector<CurvedAxis>& curved,
                           const std::vector<std::string>& names) {
  NamedPeriods result;
  if (names.empty()) return result;
  std::vector<AxisNames> named_axes = names_of_axes(grid);
  const std::vector<int> of_names = axes_of_names(grid, curved);
  for (std::size_t c = 0; c < curved.size(); ++c) {
    const CurvedAxis& one = curved[c];
    AxisNames& axis = named_axes[static_cast<std::size_t>(of_names[c])];
    axis.is_longitude = axis.is_longitude || is_longitude_unit(one.unit);
    if (!one.name.empty() && one.name != axis.names.front()) axis.names.push_back(one.name);
  }
  for (const NamedPeriod& named : named_periods(named_axes, names)) {
    result.axes.push_back(named.axis);
    result.periods.push_back(named.period.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return result;
}

template <int N>
AxisPeriods<N> periods_of(const Grid<N>& grid, const std::vector<std::string>& names) {
  AxisPeriods<N> periods{};
  const NamedPeriods named = named_periods(grid, {}, names);
  for (std::size_t i = 0; i < named.axes.size(); ++i) {
    const auto axis = static_cast<std::size_t>(named.axes[i]);
    const bool is_given = !std::isnan(named.periods[i]);
    periods[axis] = is_given ? named.periods[i] : default_periods(grid, std::span(&named.axes[i], 1))[axis];
  }
  return periods;
}

template <int N>
std::vector<CurvedSeam<N>> seams_of(const Grid<N>& grid, const std::vector<CurvedAxis>& curved,
                                    const std::vector<std::string>& names) {
  if (names.empty()) return {};
  const NamedPeriods named = named_periods(grid, curved, names);
  return find_seams<N>(grid, curved, named.axes, named.periods);
}

template NamedPeriods named_periods(const Grid<2>&, const std::vector<CurvedAxis>&, const std::vector<std::string>&);
template NamedPeriods named_periods(const Grid<3>&, const std::vector<CurvedAxis>&, const std::vector<std::string>&);
template NamedPeriods named_periods(const Grid<4>&, const std::vector<CurvedAxis>&, const std::vector<std::string>&);
template std::vector<CurvedSeam<2>> seams_of(const Grid<2>&, const std::vector<CurvedAxis>&,
                                             const std::vector<std::string>&);
template std::vector<CurvedSeam<3>> seams_of(const Grid<3>&, const std::vector<CurvedAxis>&,
                                             const std::vector<std::string>&);
template std::vector<CurvedSeam<4>> seams_of(const Grid<4>&, const std::vector<CurvedAxis>&,
                                             const std::vector<std::string>&);
template AxisPeriods<2> periods_of(const Grid<2>&, const std::vector<std::string>&);
template AxisPeriods<3> periods_of(const Grid<3>&, const std::vector<std::string>&);
template AxisPeriods<4> periods_of(const Grid<4>&, const std::vector<std::string>&);
template AxisPeriods<5> periods_of(const Grid<5>&, const std::vector<std::string>&);

int image_dim(const AnyImage& image) { return static_cast<int>(image.index()) + 2; }

EmptyResult outside_error(double isovalue, const ValueRange& range, const std::string& unit) {
  constexpr const char* kAllow = "(--allow-empty: an empty result)";
  if (std::isnan(range.min))
    return EmptyResult(
        fmt::format("all samples are missing; expected values on both sides of the isovalue {}", kAllow));
  if (range.min == range.max) {
    const auto texts = numbers_apart({range.min, isovalue});
    return EmptyResult(fmt::format("all values are {}; expected values on both sides of the isovalue {} {}", texts[0],
                                   texts[1], kAllow));
  }
  const auto texts = numbers_apart({isovalue, range.min, range.max});
  return EmptyResult(
      fmt::format("the isovalue {0} lies outside of the values, which are {1} .. {2}{3}; "
                  "expected {1} < isovalue <= {2} {4}",
                  texts[0], texts[1], texts[2], unit.empty() ? "" : " " + unit, kAllow));
}

void require_samples(std::span<const Axis> axes, std::optional<Lattice> lattice) {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].size() > 1) continue;
    throw EmptyResult(fmt::format("the axis '{}' has 1 sample; expected at least 2 samples along every axis",
                                  axis_label(axes[a].name, a)));
  }
  if (!lattice || dimension(*lattice) != static_cast<int>(axes.size())) return;  // other dimensions: an error later
  const std::size_t layers = axes.size() - (*lattice == Lattice::fcc_in_time ? 2 : 1);
  if (axes[layers].size() < least_layers(*lattice))
    throw EmptyResult(fmt::format("the axis '{}' has {} layers; expected at least {} layers on the lattice {}",
                                  axis_label(axes[layers].name, layers), axes[layers].size(), least_layers(*lattice),
                                  name_of(*lattice)));
}

namespace {

template <class Input>
void require_both_sides(const Input& input, double isovalue, double of_samples) {
  ValueRange range = value_range(input.image, of_samples);
  if (range.has_both_sides(of_samples)) return;
  if (input.info.scaling) {
    range.min = input.info.scaling->value_of(range.min);
    range.max = input.info.scaling->value_of(range.max);
  }
  throw outside_error(isovalue, range, input.info.value_unit);
}

}  // namespace

/// The isovalue of the samples, which may be stored integers. Requires values on both sides of it, unless
/// `allow_empty`.
template <class ReadResult>
static double checked_isovalue(const ReadResult& input, double isovalue, bool allow_empty) {
  const double of_samples = input.info.scaling ? input.info.scaling->stored_isovalue(isovalue) : isovalue;
  if (!allow_empty) require_both_sides(input, isovalue, of_samples);
  return of_samples;
}

double require_contour(const ReadImageResult& input, double isovalue, bool allow_empty,
                       std::optional<Lattice> lattice) {
  const auto require_tiles = [&](const auto& owned) { require_samples(owned.grid.axes, lattice); };
  std::visit([&](const auto& typed) { std::visit(require_tiles, typed); }, input.image);
  return checked_isovalue(input, isovalue, allow_empty);
}

double require_contour(const ReadImage5dResult& input, double isovalue, bool allow_empty,
                       std::optional<Lattice> lattice) {
  std::visit([&](const auto& owned) { require_samples(owned.grid.axes, lattice); }, input.image);
  return checked_isovalue(input, isovalue, allow_empty);
}

std::string remark_on_missing(double isovalue) {
  return fmt::format("no contour at {}: every active tile has a missing sample", number(isovalue));
}

std::string reason_of_zero_size(const AnyImage& image, double of_samples, double epsilon) {
  const std::string ties = Wording().no_size;
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) -> std::string {
    if constexpr (N == 4 && std::is_floating_point_v<T>) {
      bool any_tie = false, any_missing = false;
      for (const T value : owned.values) {  // without branches, so that the loop runs at the pace of memory
        any_tie |= static_cast<double>(value) == of_samples;
        any_missing |= std::isnan(value);
      }
      any_tie = any_tie && epsilon == 0.0;
      const std::string missing = "regions of missing values meet in an edge of a cell";
      if (any_tie && any_missing) return "samples equal the isovalue, which --epsilon avoids, or " + missing;
      if (any_missing) return missing;
    }
    return ties;
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

void check_result(ContourResult& result, unsigned threads, ProgressBar& bar) {
  Stopwatch watch;
  result.report = check_mesh(result.mesh, {threads, bar.stage("check")});
  result.seconds.check = watch.lap();
}

void write_result(ContourResult& result, ProgressBar& bar) {
  WrittenFiles written;
  write_result(result, bar, written);
  written.keep();
}

void write_result(ContourResult& result, ProgressBar& bar, WrittenFiles& written) {
  const Progress progress = bar.stage("write");
  Stopwatch watch;
  result.mesh.isovalue = result.isovalue;
  result.output_bytes = written.write(result.output, [&](const PendingPath& file) {
    write_mesh(result.mesh, file, {.work = {.progress = progress}, .compression = result.compression});
  });
  result.lost = lost_vertices(result.mesh, result.output);
  result.seconds.write = watch.lap();
}

}  // namespace tegl::cli
