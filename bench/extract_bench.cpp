// SPDX-License-Identifier: BSD-3-Clause
//
// Benchmarks of extraction, stage by stage: the fixed fields in 2D, 3D and 4D, both triangulations, all value types,
// closed or open, by number of threads and by size (scaling/..., which bench/scaling plots); in 5D a smooth field,
// noise, and single tiles. stages.hpp documents the report. With --simd=NAME (of Highway, as AVX2) as the first
// argument, the library uses no instruction set that is better than this one.
#include <benchmark/benchmark.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fields.hpp"
#include "stages.hpp"
#include "tegl/error.hpp"
#include "tegl/tile_facets.hpp"

namespace tegl::bench {
namespace {

/// One benchmark.
struct Case {
  std::string field;
  std::size_t samples = 0;
  ExtractOptions options;
  int threads = 1;
};

/// Returns a field; keeps only the last one. Benchmarks of one field run in sequence, so a 512^3 image does not share
/// memory with others.
template <int N>
const OwnedImage<float, N>& field_image(const std::string& name, std::size_t samples) {
  static std::map<std::string, OwnedImage<float, N>> kept;
  const std::string key = name + std::to_string(samples);
  if (!kept.contains(key)) {
    kept.clear();
    kept.emplace(key, make_field<N>(name, samples));
  }
  return kept.at(key);
}

/// Converts the field to another value type: integers are spread over the type's range, with isovalue 0 in its middle.
template <Value T, int N>
OwnedImage<T, N> convert(const OwnedImage<float, N>& image) {
  OwnedImage<T, N> converted{image.grid, std::vector<T>(image.values.size())};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if constexpr (std::is_floating_point_v<T>) {
      converted.values[i] = image.values[i];
    } else {
      constexpr double kLow = std::numeric_limits<T>::lowest();
      constexpr double kHigh = std::numeric_limits<T>::max();
      const double middle = (kLow + kHigh + 1) / 2;
      converted.values[i] =
          static_cast<T>(std::clamp(middle + std::floor(double{image.values[i]} * (kHigh - kLow) / 8), kLow, kHigh));
    }
  }
  return converted;
}

/// The isovalue of converted fields: the middle of the type's range.
template <Value T>
constexpr double isovalue() {
  if constexpr (std::is_floating_point_v<T>) return 0.0;
  return (double{std::numeric_limits<T>::lowest()} + double{std::numeric_limits<T>::max()} + 1) / 2;
}

template <Value T, int N>
void add(const std::string& group, const Case& what) {
  std::string name = group + "/" + what.field + "/" + std::to_string(what.samples) + "^" + std::to_string(N);
  if (what.options.triangulation == Triangulation::barycentric) name += "/barycentric";
  if (what.options.close) name += "/closed";
  constexpr std::array<const char*, 6> kRules = {"", "/high", "/mean", "/saddle", "/squares", "/decider"};
  name += kRules[static_cast<std::size_t>(what.options.ambiguity)];
  if constexpr (!std::is_same_v<T, float>)
    name += std::is_same_v<T, double> ? "/double"
                                      : (std::is_signed_v<T> ? "/int" : "/uint") + std::to_string(8 * sizeof(T));
  name += "/threads:" + std::to_string(what.threads);
  benchmark::RegisterBenchmark(name.c_str(),
                               [what](benchmark::State& state) {
                                 const auto& image = field_image<N>(what.field, what.samples);
                                 const ExtractOptions options = with_threads(what.options, what.threads);
                                 if constexpr (std::is_same_v<T, float>) {
                                   extract_image(state, image.view(), 0.0, options);
                                 } else {
                                   const auto converted = convert<T>(image);
                                   extract_image(state, converted.view(), isovalue<T>(), options);
                                 }
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

template <int N>
void add_field(const std::string& field, std::size_t samples) {
  Case what{field, samples, {}, 1};
  add<float, N>("extract", what);
  if (field == "empty") return;
  add<float, N>("extract", {field, samples, {}, 4});
  what.options.triangulation = Triangulation::barycentric;
  add<float, N>("extract", what);
  what.options.triangulation = Triangulation::compact;
  what.options.close = true;
  add<float, N>("extract", what);
}

/// Ambiguous faces resolved from the data, to compare with `low` in add_field: a smooth field, with hardly any
/// ambiguity, and noise of the same size as there.
template <int N>
void add_estimators(const std::string& smooth, std::size_t samples, std::size_t samples_of_noise) {
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider})
    for (const int threads : {1, 4}) {
      Case what{smooth, samples, {}, threads};
      what.options.ambiguity = ambiguity;
      add<float, N>("extract", what);
      what.field = "noise";
      what.samples = samples_of_noise;
      add<float, N>("extract", what);
    }
}

/// Noise of another size by all rules.
template <int N>
void add_noise_by_rules(std::size_t samples) {
  for (const Ambiguity ambiguity :
       {Ambiguity::low, Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider})
    for (const int threads : {1, 4}) {
      Case what{"noise", samples, {}, threads};
      what.options.ambiguity = ambiguity;
      add<float, N>("extract", what);
    }
}

/// Barycentric 4D tiles resolved from the data, which are assembled from their cubes, to compare with table tiles: a
/// smooth field and noise.
void add_barycentric_4d() {
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::mean, Ambiguity::saddle}) {
    Case what{"sphere", 24, {}, 1};
    what.options.triangulation = Triangulation::barycentric;
    what.options.ambiguity = ambiguity;
    add<float, 4>("barycentric", what);
    what.field = "noise";
    what.samples = 8;
    add<float, 4>("barycentric", what);
  }
}

/// One smooth field in every value type: classification reads fewer bytes, the other stages are equal.
void add_types() {
  const Case what{"metaballs", 256, {}, 1};
  add<std::uint8_t, 3>("types", what);
  add<std::int8_t, 3>("types", what);
  add<std::uint16_t, 3>("types", what);
  add<std::int16_t, 3>("types", what);
  add<std::int32_t, 3>("types", what);
  add<float, 3>("types", what);
  add<double, 3>("types", what);
}

template <int N>
void add_scaling(const std::string& field, std::initializer_list<std::size_t> sizes) {
  for (const std::size_t samples : sizes)
    for (int threads = 1; threads <= 4; ++threads) add<float, N>("scaling", {field, samples, {}, threads});
}

/// A smooth field, whose time is mostly spent on writing, and noise, whose time is spent on building tiles.
void add_5d() {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const int threads : {1, 4}) {
      Case what{"sphere", 12, {}, threads};
      what.options.triangulation = triangulation;
      add<float, 5>("extract", what);
      what.samples = 20;
      add<float, 5>("extract", what);
      what.field = "noise";
      what.samples = 4;
      for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::mean, Ambiguity::saddle}) {
        what.options.ambiguity = ambiguity;
        add<float, 5>("extract", what);
      }
    }
}

/// The facets of a 5D tile: one corner cut off, a plane, random signatures, and random signatures with random signs of
/// faces.
void add_tiles() {
  constexpr int N = 5;
  const auto add_tile = [](const char* name, std::uint32_t signature, bool random_signature, bool random_signs) {
    benchmark::RegisterBenchmark((std::string("tile_facets/5D/") + name).c_str(), [=](benchmark::State& state) {
      std::mt19937_64 random(1);
      std::vector<tile::Choice> signs;
      for (auto _ : state) {
        const std::uint64_t key = random_signature ? random() & 0xffffffffU : signature;
        signs.resize(random_signs ? 243 : 0);
        for (auto& sign : signs) sign = static_cast<tile::Choice>(random() % 3);
        benchmark::DoNotOptimize(tile_facets<N>(key, {.choices = signs}));
      }
    })->Unit(benchmark::kMillisecond);
  };
  add_tile("corner", 1U, false, false);
  add_tile("plane", 0xaaaaaaaaU, false, false);
  add_tile("random", 0, true, false);
  add_tile("random_signs", 0, true, true);
}

void add_all() {
  for (const auto& field : field_names(2)) add_field<2>(field, 4096);
  for (const auto& field : field_names(3)) add_field<3>(field, field == "noise" ? 128 : 256);
  for (const auto& field : field_names(4)) add_field<4>(field, field == "noise" ? 32 : 64);
  add_estimators<2>("gyroid", 4096, 4096);
  add_estimators<3>("gyroid", 256, 128);
  add_estimators<4>("balls", 64, 32);
  add_noise_by_rules<4>(16);  // short rows
  add_barycentric_4d();
  add_5d();
  add_tiles();
  add_types();
  add_scaling<3>("metaballs", {32, 64, 128, 256, 512});
  add_scaling<3>("gyroid", {32, 64, 128, 256, 512});
  add_scaling<3>("noise", {32, 64, 128, 256});
  add_scaling<4>("sphere", {16, 24, 32, 48, 64, 96});
  add_scaling<4>("balls", {16, 24, 32, 48, 64, 96});
  add_scaling<4>("noise", {16, 24, 32, 48});
}

/// Disables the instruction sets that are better than `name`. Error: InvalidArgument, if the processor or the library
/// does not have it.
void restrict_to(std::string_view name) {
  std::vector<std::string_view> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name == hwy::TargetName(target)) return hwy::DisableTargets(target - 1);  // better ones are lower bits
    names.emplace_back(hwy::TargetName(target));
  }
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("--simd is '{}'; expected one of {}", name, fmt::join(names, ", ")));
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  constexpr std::string_view kSimd = "--simd=";
  if (argc > 1 && std::string_view(argv[1]).starts_with(kSimd)) {
    try {
      tegl::bench::restrict_to(std::string_view(argv[1]).substr(kSimd.size()));
    } catch (const tegl::Error& error) {
      fmt::print(stderr, "extract_bench: {}\n", error.what());
      return 2;
    }
    std::copy(argv + 2, argv + argc + 1, argv + 1);  // with the null at the end
    --argc;
  }
  tegl::bench::add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
