// SPDX-License-Identifier: BSD-3-Clause
//
// Benchmarks indexes of active tiles: time and memory of building each, query time against the number of active tiles,
// and the gain of a sweep over 256 isovalues. Writes tables in Markdown.
//
//   active_tiles_bench [--queries N] [--csv FILE] IMAGE...
//
// An image "balls:N" is generated: N^3 float samples with three balls, empty elsewhere. One thread; CPU times. Times of
// queries and contours are minima over a few runs. `--csv` writes every single query.
#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include "arguments.hpp"
#include "image_file.hpp"
#include "memory.hpp"
#include "tegl/io/active_tiles.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

struct Query {
  double isovalue;
  double active;           ///< number of active tiles
  double seconds;          ///< time to find them
  double extract_seconds;  ///< time to find them and generate the contour
};

/// Isovalues spread over the range of the values; for 8 bits and 256 queries about one between adjacent values.
template <class Owned>
std::vector<double> isovalues_of(const Owned& owned, int queries) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto value : owned.values) {
    if (!std::isfinite(static_cast<double>(value))) continue;
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
  std::vector<double> isovalues;
  for (int i = 0; i < queries; ++i) isovalues.push_back(low + (high - low) * (i + 0.5) / queries);
  return isovalues;
}

template <class Owned>
void measure(const std::string& name, const Owned& owned, int queries, std::FILE* csv) {
  const auto image = owned.view();
  ExtractOptions options;
  options.work.threads = 1;
  const std::vector<double> isovalues = isovalues_of(owned, queries);
  const double plain = [&] {
    double sum = 0;
    for (const double isovalue : isovalues) sum += least_seconds([&] { extract<float>(image, isovalue, options); });
    return sum;
  }();
  const double identify_seconds = least_seconds([&] { identify(image, {.threads = 1}); });
  fmt::print(
      "\n## {}\n\n{} samples, {} isovalues; all contours without an index: {:.3f} s; digest of the values: "
      "{:.1f} ms\n\n",
      name, owned.values.size(), queries, plain, 1e3 * identify_seconds);
  fmt::print(
      "| method | build s | index | bytes per tile | most memory while built | median query | query = a + b k "
      "| explained | all contours s | of those without |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const ActiveMethod method : active_methods()) {
    const std::uint64_t before = memory_bytes("VmRSS");
    reset_peak_memory();
    const double start = worked_seconds();
    auto index = build_active_tiles(image, method, {.work = {.threads = 1}});
    const double build = worked_seconds() - start;
    const std::uint64_t peak = memory_bytes("VmHWM") - std::min(before, memory_bytes("VmHWM"));
    std::vector<Query> done;
    double contours = 0;
    for (const double isovalue : isovalues) {
      std::vector<TileNumber> tiles;
      Query query{isovalue, 0, least_seconds([&] { tiles = index->find(isovalue); }), 0};
      query.active = static_cast<double>(tiles.size());
      query.extract_seconds = least_seconds([&] { extract<float>(image, isovalue, *index, options); });
      contours += query.extract_seconds;
      done.push_back(query);
      if (csv != nullptr)
        fmt::print(csv, "{},{},{},{},{},{}\n", name, active_method_name(method), query.isovalue, query.active,
                   query.seconds, query.extract_seconds);
    }
    std::vector<double> active, seconds;
    for (const Query& query : done) {
      active.push_back(query.active);
      seconds.push_back(query.seconds);
    }
    const Fit fit = fit_line(active, seconds);
    std::sort(done.begin(), done.end(), [](const Query& a, const Query& b) { return a.seconds < b.seconds; });
    const auto bytes = static_cast<double>(index->memory_bytes());
    fmt::print(
        "| {} | {:.3f} | {:.2f} MB | {:.2f} | {:.0f} MB | {:.3f} ms | {:.3f} ms + {:.2f} ns k | {:.3f} | {:.3f} "
        "| {:.2f} |\n",
        active_method_name(method), build, bytes / 1e6, bytes / static_cast<double>(index->grid().count()),
        static_cast<double>(peak) / 1e6, 1e3 * done[done.size() / 2].seconds, 1e3 * fit.start, 1e9 * fit.each,
        fit.explained, contours, contours / plain);
    std::fflush(stdout);
  }
}

/// N^3 samples, most of them far from any contour: the best case for an index.
OwnedImage<float, 3> few_balls(std::size_t n) {
  OwnedImage<float, 3> image{Grid<3>::unit({n, n, n}), std::vector<float>(n * n * n)};
  const auto radius = static_cast<double>(n) / 12;
  std::size_t i = 0;
  for (std::size_t z = 0; z < n; ++z)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x, ++i) {
        double value = 0;
        for (const double share : {0.2, 0.45, 0.8}) {
          const double at = share * static_cast<double>(n);
          const double distance =
              std::hypot(static_cast<double>(x) - at, static_cast<double>(y) - 0.9 * at, static_cast<double>(z) - at);
          value = std::max(value, radius - distance);
        }
        image.values[i] = static_cast<float>(value);
      }
  return image;
}

constexpr const char* kUsage = "active_tiles_bench [--queries N] [--csv FILE] IMAGE|balls:N ...";

int run(int argc, char** argv) {
  if (tells_usage(argc, argv, kUsage)) return 0;
  int queries = 256;
  std::FILE* csv = nullptr;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool more = i + 1 < argc;
    if (argument == "--queries" && more)
      queries = whole_number(argument, argv[++i], 1, 1000000);
    else if (argument == "--csv" && more) {
      csv = std::fopen(argv[++i], "w");
      if (csv == nullptr) throw std::system_error(errno, std::generic_category(), argv[i]);
    } else if (argument.rfind("--", 0) == 0) {
      throw Error(ErrorCode::InvalidArgument, fmt::format("'{}'; expected {}", argument, kUsage));
    } else {
      files.push_back(argument);
    }
  }
  if (files.empty()) {
    fmt::print(stderr, "usage: {}\n", kUsage);
    return 2;
  }
  if (csv != nullptr) fmt::print(csv, "image,method,isovalue,active_tiles,find_seconds,extract_seconds\n");
  for (const std::string& file : files) {
    if (file.rfind("balls:", 0) == 0) {
      measure(file, few_balls(whole_number<std::size_t>(file, file.substr(6), 2, 1u << 11)), queries, csv);
      continue;
    }
    with_image_of_file(file,
                       [&](const std::string& of_file, const auto& owned) { measure(of_file, owned, queries, csv); });
  }
  if (csv != nullptr) std::fclose(csv);
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) { return tegl::bench::run_program("active_tiles_bench", argc, argv, tegl::bench::run); }
