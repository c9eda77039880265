// SPDX-License-Identifier: BSD-3-Clause
//
// Benchmark of one extraction, and its report by stages.
//
// Times the whole extraction. Counters, as means over the iterations: milliseconds of each stage; samples
// per second and input bytes per second of the whole, and input bytes per second of classification; active tiles per
// second of the whole, and tiles per second of finding them; simplices and output bytes per second of the whole, and
// output bytes per second of generation.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "run.hpp"

namespace tegl::bench {

/// Sums over the iterations of one benchmark.
struct Sums {
  ExtractStats stages;
  void add(const ExtractStats& stats) {
    stages.classify_seconds += stats.classify_seconds;
    stages.find_seconds += stats.find_seconds;
    stages.generate_seconds += stats.generate_seconds;
    stages.close_seconds += stats.close_seconds;
  }
};

/// Sets the counters `stage_ms` and, if the stage took time, `rate` = units per second of the stage.
inline void report_stage(benchmark::State& state, const char* stage, double seconds, const char* rate, double units) {
  const auto iterations = static_cast<double>(state.iterations());
  state.counters[std::string(stage) + "_ms"] = 1e3 * seconds / iterations;
  if (seconds > 0 && units > 0) state.counters[rate] = units * iterations / seconds;
}

inline void report(benchmark::State& state, const Sums& sums, const ExtractStats& stats, double samples, double input,
                   double simplices, double output) {
  using benchmark::Counter;
  constexpr auto kRate = Counter::kIsIterationInvariantRate;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(simplices));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(input));
  state.counters["samples/s"] = Counter(samples, kRate);
  state.counters["tiles/s"] = Counter(static_cast<double>(stats.active_tiles), kRate);
  state.counters["output_bytes/s"] = Counter(output, kRate);
  state.counters["simplices"] = simplices;
  state.counters["active_tiles"] = static_cast<double>(stats.active_tiles);
  report_stage(state, "classify", sums.stages.classify_seconds, "classify_bytes/s", input);
  report_stage(state, "find", sums.stages.find_seconds, "find_tiles/s", static_cast<double>(stats.tiles));
  report_stage(state, "generate", sums.stages.generate_seconds, "generate_bytes/s", output);
  report_stage(state, "close", sums.stages.close_seconds, "close_samples/s", 0);
}

/// Benchmarks the contour of an image; freeing it is not timed.
template <Value T, int N>
void extract_image(benchmark::State& state, const Image<T, N>& image, double isovalue, const ExtractOptions& options) {
  ExtractStats stats;
  Sums sums;
  double simplices = 0;
  double output = 0;
  for (auto _ : state) {
    auto [contour, stages] = extract_with_stats(image, isovalue, options);
    state.PauseTiming();
    stats = stages;
    sums.add(stats);
    simplices = static_cast<double>(contour.simplices.size());
    output = static_cast<double>(contour_bytes(contour));
    contour = {};
    state.ResumeTiming();
  }
  double samples = 1;
  for (int a = 0; a < N; ++a) samples *= static_cast<double>(image.size(a));
  report(state, sums, stats, samples, samples * sizeof(T), simplices, output);
}

}  // namespace tegl::bench
