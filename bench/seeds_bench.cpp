// SPDX-License-Identifier: BSD-3-Clause
//
// Benchmarks of seed sets: number of seeds by method, lower bounds, time and memory, and the cost of picking a
// component. Writes the tables of docs/seed-sets.md in Markdown.
//
//   seeds_bench [--methods A,B,...] [--neighbourhoods A,B,...] [--orders] [--picks N] [--runs N] [--threads N]
//               [--scaling] IMAGE...
//
// Images can be generated: "metaballs:N" has N^3 float samples, "metaballs:N^D" D dimensions, "metaballs:N@uint8" 8
// bits. Instead of "metaballs": "gyroid", "noise", and the other names in bench/fields.hpp; "sines" (wavelength about
// 40 samples for any N), "smooth-noise" (long waves and a tenth of noise), and "plateaus" (the same waves in 20 steps).
// `--orders`: minimum and maximum number of seeds over all scan orders. `--picks`: number of components to pick, each
// at a random point and an isovalue of the middle half. `--scaling`: all images in one table, without bounds. Times
// are the minimum of `--runs`: CPU times of one thread, or, with `--threads` other than 1, wall-clock times of the
// searches with so many threads (0: all of the machine).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "fields.hpp"
#include "image_file.hpp"
#include "memory.hpp"
#include "tegl/pick.hpp"
#include "tegl/seed_set.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

struct Arguments {
  std::vector<SeedMethod> methods = seed_methods();
  std::vector<Neighbourhood> neighbourhoods{Neighbourhood::all};
  bool orders = false;
  int picks = 0;
  int runs = 1;
  unsigned threads = 1;
  bool scaling = false;
  std::vector<std::string> images;
};

/// "245", or "245 to 255" over all scan orders.
template <Value T, int N>
std::string count_seeds(const Image<T, N>& image, SeedSetOptions options, bool orders, std::size_t found) {
  const bool ordered = options.method != SeedMethod::cover && options.method != SeedMethod::volume_thinning;
  if (!orders || !ordered) return fmt::format("{}", found);
  std::size_t least = found, most = found;
  options.scan_order.resize(N);
  std::iota(options.scan_order.begin(), options.scan_order.end(), 0);
  while (std::next_permutation(options.scan_order.begin(), options.scan_order.end())) {
    const std::size_t seeds = find_seeds(image, options).tiles.size();
    least = std::min(least, seeds);
    most = std::max(most, seeds);
  }
  return fmt::format("{} to {}", least, most);
}

/// One search for seeds, and its cost.
struct Search {
  SeedSetOptions options;
  SeedSet found;
  double seconds = 0;
  double peak_bytes = 0;  ///< in addition to memory in use before
};

double passed_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Runs every requested search and prints each.
template <Value T, int N, class Print>
void for_each_search(const Image<T, N>& image, const Arguments& arguments, const Print& print) {
  for (const Neighbourhood neighbourhood : arguments.neighbourhoods)
    for (const SeedMethod method : arguments.methods) {
      Search search;
      search.options.method = method;
      search.options.neighbourhood = neighbourhood;
      search.options.work.threads = arguments.threads;
      give_back_memory();  // memory of earlier images
      reset_peak_memory();
      const std::uint64_t before = memory_bytes("VmRSS");
      search.seconds = least_seconds_by(
          arguments.threads == 1 ? worked_seconds : passed_seconds,
          [&] { search.found = find_seeds(image, search.options); }, arguments.runs);
      const std::uint64_t peak = memory_bytes("VmHWM");
      search.peak_bytes = static_cast<double>(peak - std::min(before, peak));
      print(search);
      std::fflush(stdout);
    }
}

template <Value T, int N>
void measure_scaling(const std::string& name, const Image<T, N>& image, const Arguments& arguments) {
  for_each_search(image, arguments, [&](const Search& search) {
    const auto tiles = static_cast<double>(search.found.stats.tiles);
    fmt::print("| `{}` | {} | `{}` | {} | {} | {:.2f} | {:.2f} | {:.0f} |\n", name,
               name_of(search.options.neighbourhood), name_of(search.options.method), search.found.stats.tiles,
               search.found.tiles.size(), search.seconds, 1e6 * search.seconds / tiles, search.peak_bytes / tiles);
  });
}

template <Value T, int N>
void measure_seeds(const Image<T, N>& image, const Arguments& arguments) {
  fmt::print(
      "| neighbourhood | method | seeds | bound | seconds | most memory while found |\n|---|---|---|---|---|---|\n");
  for_each_search(image, arguments, [&](const Search& search) {
    const SeedSetStats& stats = search.found.stats;
    fmt::print("| {} | `{}` | {} | {} | {:.3f} | {:.0f} MB |\n", name_of(search.options.neighbourhood),
               name_of(search.options.method),
               count_seeds(image, search.options, arguments.orders, search.found.tiles.size()),
               stats.lower_bound > 0 ? fmt::format("{}", stats.lower_bound)
               : stats.reduced       ? fmt::format("{}, at some isovalues", seed_lower_bound(image, search.options))
                                     : "",
               search.seconds, search.peak_bytes / 1e6);
  });
}

/// The quantile `share` of the finite values, estimated from about 100 000 of them.
template <Value T>
double quantile(const Values<T>& values, double share) {
  std::vector<double> finite;
  for (std::size_t i = 0; i < values.size(); i += 1 + values.size() / 100000)
    if (std::isfinite(static_cast<double>(values[i]))) finite.push_back(static_cast<double>(values[i]));
  if (finite.empty()) return 0;
  const auto at = finite.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), at, finite.end());
  return *at;
}

template <Value T, int N>
void measure_picks(const OwnedImage<T, N>& owned, int picks) {
  const auto image = owned.view();
  std::mt19937_64 random(1);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  ExtractOptions options;
  options.work.threads = 1;
  std::vector<double> tiles, seconds;
  double whole = 0;
  for (int i = 0; i < picks; ++i) {
    const double isovalue = quantile(owned.values, 0.25 + 0.5 * share());
    std::array<double, N> index, point{};
    for (int a = 0; a < N; ++a) {
      const auto& axis = image.grid().axes[a];
      index[a] = axis[0] + share() * (axis[axis.size() - 1] - axis[0]);
    }
    for (int a = 0; a < N; ++a) {
      point[a] = image.grid().offset[a];
      for (int b = 0; b < N; ++b) point[a] += image.grid().linear[a][b] * index[b];
    }
    PickedComponent<N> picked;
    seconds.push_back(least_seconds([&] { picked = extract_component(image, isovalue, point, options); }, 3));
    tiles.push_back(static_cast<double>(picked.report.tiles));
    whole += least_seconds([&] { extract<float>(image, isovalue, options); }, 1);
  }
  const Fit fit = fit_line(tiles, seconds);
  fmt::print(
      "\n{} picks: {:.0f} tiles on average; {:.3f} ms + {:.0f} ns for each tile reached, which explains {:.3f}; {:.3f} "
      "s "
      "in all, all of the contours {:.3f} s\n",
      picks, std::accumulate(tiles.begin(), tiles.end(), 0.0) / picks, 1e3 * fit.start, 1e9 * fit.each, fit.explained,
      std::accumulate(seconds.begin(), seconds.end(), 0.0), whole);
}

template <Value T, int N>
void measure(const std::string& name, const OwnedImage<T, N>& owned, const Arguments& arguments) {
  const auto image = owned.view();
  if (arguments.scaling) return measure_scaling(name, image, arguments);
  fmt::print("\n## {}\n\n{} samples of {} bits\n\n", name, fmt::join(image.grid().sizes(), " x "), 8 * sizeof(T));
  measure_seeds(image, arguments);
  if (arguments.picks > 0) measure_picks(owned, arguments.picks);
}

constexpr std::array<std::string_view, 3> kOwnFields = {"sines", "smooth-noise", "plateaus"};

bool is_own(const std::string& name) {
  return std::find(kOwnFields.begin(), kOwnFields.end(), name) != kOwnFields.end();
}
bool is_field(const std::string& name) {
  const auto fields = field_names(3);
  return is_own(name) || std::find(fields.begin(), fields.end(), name) != fields.end();
}

/// A field of kOwnFields or of bench/fields.hpp.
template <int N>
OwnedImage<float, N> make_any_field(const std::string& name, std::size_t samples) {
  auto image = make_field<N>(name == "sines" ? "empty" : is_own(name) ? "noise" : name, samples);
  if (!is_own(name)) return image;
  std::array<std::size_t, N> index{};
  for (float& value : image.values) {
    double product = 1.0, sum = 0.0;
    for (int a = 0; a < N; ++a) {
      const auto x = static_cast<double>(index[a]);
      product *= std::sin(6.28 * (a + 2) * x / static_cast<double>(samples) + a);
      sum += std::sin(0.2 * x + 0.3 * a) * std::cos(0.13 * static_cast<double>(index[(a + 1) % N]));
    }
    const double noise = static_cast<double>(value);
    value = static_cast<float>(name == "sines"      ? sum
                               : name == "plateaus" ? std::floor(20.0 * (product + 0.05 * noise))
                                                    : product + 0.1 * noise);
    for (int a = 0; a < N && ++index[a] == samples; ++a) index[a] = 0;
  }
  return image;
}

/// Scales a field to the full non-negative range of a type.
template <Value T, int N>
OwnedImage<T, N> as_type(const OwnedImage<float, N>& image) {
  const auto ends = std::minmax_element(image.values.begin(), image.values.end());
  const float least = *ends.first;
  const double scale = static_cast<double>(std::numeric_limits<T>::max()) / static_cast<double>(*ends.second - least);
  OwnedImage<T, N> result{image.grid, std::vector<T>(image.values.size())};
  std::transform(image.values.begin(), image.values.end(), result.values.begin(),
                 [&](float value) { return static_cast<T>(std::lround(scale * static_cast<double>(value - least))); });
  return result;
}

template <int N>
void measure_field_in(const std::string& name, const std::string& field, std::size_t samples, const std::string& type,
                      const Arguments& arguments) {
  const auto image = make_any_field<N>(field, samples);
  if (type == "float") return measure(name, image, arguments);
  if (type == "uint8") return measure(name, as_type<std::uint8_t>(image), arguments);
  if (type == "uint16") return measure(name, as_type<std::uint16_t>(image), arguments);
  throw Error(ErrorCode::InvalidArgument, fmt::format("{}: type '{}'; expected float, uint8 or uint16", name, type));
}

/// Maximum number of samples along an axis, for 2^32 in all.
constexpr std::size_t most_samples(int dim) { return dim == 2 ? 1u << 16 : dim == 3 ? 1625 : 1u << 8; }

/// Parses FIELD:N[^D][@TYPE] and measures that field.
void measure_field(const std::string& name, const Arguments& arguments) {
  const std::string field = name.substr(0, name.find(':'));
  if (field.size() == name.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{}: no size; expected {}:N[^D][@TYPE]", name, name));
  std::string_view rest = std::string_view(name).substr(field.size() + 1);
  const auto take_after = [&](char mark, std::string_view otherwise) {
    const std::size_t at = rest.find(mark);
    if (at == std::string_view::npos) return otherwise;
    const std::string_view after = rest.substr(at + 1);
    rest = rest.substr(0, at);
    return after;
  };
  const std::string type(take_after('@', "float"));
  const int dim = whole_number(name + ", dimensions", take_after('^', "3"), 2, 4);
  const auto samples = whole_number<std::size_t>(name + ", samples along an axis", rest, 2, most_samples(dim));
  if (dim == 2) return measure_field_in<2>(name, field, samples, type, arguments);
  if (dim == 3) return measure_field_in<3>(name, field, samples, type, arguments);
  measure_field_in<4>(name, field, samples, type, arguments);
}

/// The elements of `all` whose names are in an option's comma-separated list.
template <class Each>
std::vector<Each> choose(const std::string& option, const std::string& list, const std::vector<Each>& all) {
  std::vector<Each> chosen;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size());
    const std::string one = list.substr(from, to - from);
    const auto at = std::find_if(all.begin(), all.end(), [&](Each each) { return name_of(each) == one; });
    if (at == all.end()) {
      std::string names;
      for (const Each each : all) names += (names.empty() ? "" : ", ") + std::string(name_of(each));
      throw Error(ErrorCode::InvalidArgument, fmt::format("{}: '{}'; expected one or more of {}", option, one, names));
    }
    chosen.push_back(*at);
    from = to + 1;
  }
  return chosen;
}

constexpr const char* kUsage =
    "seeds_bench [--methods A,B,...] [--neighbourhoods A,B,...] [--orders] [--picks N] [--runs N] [--threads "
    "N] [--scaling] IMAGE|FIELD:N[^D][@TYPE] ...";

int run(int argc, char** argv) {
  if (tells_usage(argc, argv, kUsage)) return 0;
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool more = i + 1 < argc;
    if (argument == "--methods" && more)
      arguments.methods = choose(argument, argv[++i], seed_methods());
    else if (argument == "--neighbourhoods" && more)
      arguments.neighbourhoods = choose<Neighbourhood>(
          argument, argv[++i], {Neighbourhood::faces, Neighbourhood::faces_and_edges, Neighbourhood::all});
    else if (argument == "--orders")
      arguments.orders = true;
    else if (argument == "--picks" && more)
      arguments.picks = whole_number(argument, argv[++i], 0, 1000000);
    else if (argument == "--runs" && more)
      arguments.runs = whole_number(argument, argv[++i], 1, 1000000);
    else if (argument == "--threads" && more)
      arguments.threads = whole_number<unsigned>(argument, argv[++i], 0, 1024);
    else if (argument == "--scaling")
      arguments.scaling = true;
    else if (argument.rfind("--", 0) == 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("'{}'; expected {}", argument, kUsage));
    else
      arguments.images.push_back(argument);
  }
  if (arguments.images.empty()) {
    fmt::print(stderr, "usage: {}\n", kUsage);
    return 2;
  }
  if (arguments.scaling)
    fmt::print(
        "| image | neighbourhood | method | tiles | seeds | seconds | microseconds per tile | bytes per tile while "
        "found "
        "|\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& name : arguments.images) {
    if (is_field(name.substr(0, name.find(':')))) {
      measure_field(name, arguments);
      continue;
    }
    with_image_of_file(name,
                       [&](const std::string& of_file, const auto& owned) { measure(of_file, owned, arguments); });
  }
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) { return tegl::bench::run_program("seeds_bench", argc, argv, tegl::bench::run); }
