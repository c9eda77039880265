// SPDX-License-Identifier: BSD-3-Clause
//
// image_intersections: how many simplices of an image's contour intersect, by rule and triangulation, and of its cuts
// across the last axis.
//
//     image_intersections --slices 100 --epsilon 0.01 ocean_temperature.nc 20
//     image_intersections --low --runs 3 --threads 1 --field metaballs 512
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arguments.hpp"
#include "fields.hpp"
#include "image_file.hpp"
#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/intersections.hpp"
#include "tegl/slice.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

struct Arguments {
  std::string file;
  std::string field;         ///< instead of a file
  std::size_t samples = 64;  ///< of the field, along each of three axes
  double isovalue = 0.0;
  double epsilon = 0.0;
  int slices = 0;
  int runs = 1;
  bool is_low = false;  ///< only compact, by low
  unsigned threads = 0;
};

/// Pairs of all cuts, and the number of cuts that have any.
struct OfCuts {
  std::uint64_t pairs = 0;
  int hit = 0;
};

template <int N>
IntersectionOptions<N> counting(unsigned threads) {
  IntersectionOptions<N> options;
  options.most_listed = 0;
  options.work.threads = threads;
  return options;
}

/// Cuts at equal distances across the last axis.
template <int N>
OfCuts intersections_of_cuts(const Contour<N, double>& contour, const Arguments& arguments) {
  OfCuts result;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto& vertex : contour.vertices) {
    least = std::min(least, vertex[N - 1]);
    most = std::max(most, vertex[N - 1]);
  }
  if (contour.vertices.empty()) return result;
  for (int k = 0; k < arguments.slices; ++k) {
    // 0.37: no cut contains a layer of samples, unless there are very many
    const double at = least + (k + 0.37) / arguments.slices * (most - least);
    const auto found =
        find_intersections(slice(contour, Hyperplane<N>::across(N - 1, at)), counting<N - 1>(arguments.threads));
    result.pairs += found.pair_count;
    result.hit += found.pair_count > 0 ? 1 : 0;
  }
  return result;
}

template <int N, class Value>
void measure(const std::string& name, const OwnedImage<Value, N>& image, const Arguments& arguments) {
  constexpr std::pair<Ambiguity, const char*> kRules[] = {
      {Ambiguity::low, "low"}, {Ambiguity::mean, "mean"}, {Ambiguity::saddle, "saddle"}};
  constexpr std::pair<Triangulation, const char*> kTriangulations[] = {{Triangulation::compact, "compact"},
                                                                       {Triangulation::barycentric, "barycentric"}};
  for (const auto& [rule, rule_name] : kRules)
    for (const auto& [triangulation, triangulation_name] : kTriangulations) {
      if (arguments.is_low && (rule != Ambiguity::low || triangulation != Triangulation::compact)) continue;
      ExtractOptions options;
      options.ambiguity = rule;
      options.triangulation = triangulation;
      options.epsilon = arguments.epsilon;
      options.work.threads = arguments.threads;
      const auto contour = extract<double>(image.view(), arguments.isovalue, options);
      Intersections<N> found;
      const double seconds =
          least_seconds([&] { found = find_intersections(contour, counting<N>(arguments.threads)); }, arguments.runs);
      OfCuts cuts;
      if constexpr (N > 2) cuts = intersections_of_cuts(contour, arguments);
      fmt::print("| {} | {} | {} | {} | {} | {:.3g} | {} | {:.2f} | {} | {} |\n", name, rule_name, triangulation_name,
                 found.simplices, found.pair_count, found.depth, found.flat, seconds, cuts.pairs, cuts.hit);
      std::fflush(stdout);
    }
}

constexpr const char* kUsage =
    "image_intersections [options] IMAGE ISOVALUE: pairs of simplices that intersect\n"
    "  --slices N    also of N cuts across the last axis, of 3D and 4D contours\n"
    "  --epsilon E   of the extraction\n"
    "  --threads T   0: all of the machine\n"
    "  --low         only the compact contour by low, not all rules and triangulations\n"
    "  --runs N      repeats the check; prints the minimum of its times\n"
    "  --field NAME SAMPLES   instead of IMAGE ISOVALUE: a 3D field of the benchmarks, such as metaballs, at 0\n";

Arguments parsed(int argc, char** argv) {
  constexpr double kMost = std::numeric_limits<double>::max();
  Arguments arguments;
  std::vector<std::string_view> names;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const bool has_more = i + 1 < argc;
    if (argument == "--slices" && has_more)
      arguments.slices = whole_number(argument, argv[++i], 0, 1'000'000);
    else if (argument == "--epsilon" && has_more)
      arguments.epsilon = real_number(argument, argv[++i], 0.0, 0.5);
    else if (argument == "--runs" && has_more)
      arguments.runs = whole_number(argument, argv[++i], 1, 1000);
    else if (argument == "--low")
      arguments.is_low = true;
    else if (argument == "--field" && i + 2 < argc) {
      arguments.field = argv[++i];
      arguments.samples = whole_number<std::size_t>(argument, argv[++i], 2, 4096);
    } else if (argument == "--threads" && has_more)
      arguments.threads = whole_number(argument, argv[++i], 0u, 1024u);
    else if (argument.rfind("--", 0) == 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("'{}'; expected {}", argument, kUsage));
    else
      names.push_back(argument);
  }
  if (names.empty() && !arguments.field.empty()) return arguments;
  if (names.size() != 2)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} names; expected {}", names.size(), kUsage));
  arguments.file = names[0];
  arguments.isovalue = real_number("isovalue", names[1], -kMost, kMost);
  return arguments;
}

int run(int argc, char** argv) {
  if (tells_usage(argc, argv, kUsage)) return 0;
  const Arguments arguments = parsed(argc, argv);
  fmt::print(
      "| image | rule | triangulation | simplices | pairs | depth | flat | processor seconds of the check "
      "| pairs in {} cuts | cuts with pairs |\n|---|---|---|---|---|---|---|---|---|---|\n",
      arguments.slices);
  if (!arguments.field.empty())
    measure(fmt::format("{} {}^3", arguments.field, arguments.samples),
            make_field<3>(arguments.field, arguments.samples), arguments);
  else
    with_image_of_file(arguments.file,
                       [&](const std::string& name, const auto& image) { measure(name, image, arguments); });
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  return tegl::bench::run_program("image_intersections", argc, argv, tegl::bench::run);
}
