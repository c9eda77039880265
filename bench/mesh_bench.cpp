// SPDX-License-Identifier: BSD-3-Clause
//
// Benchmarks of using contours: slices at a time (`slice`), slices of the image without its contour (`slice_image`),
// checks (`check`). Items are simplices of the contour, or samples of the image.
#include <benchmark/benchmark.h>

#include <string>

#include "fields.hpp"
#include "run.hpp"
#include "tegl/check.hpp"
#include "tegl/slice.hpp"

namespace tegl::bench {
namespace {

template <int N>
auto contour_of(const std::string& field, std::size_t samples) {
  const OwnedImage<float, N> image = make_field<N>(field, samples);
  return extract(image.view(), 0.0);
}

template <int N>
void slice_contour(benchmark::State& state, const std::string& field, std::size_t samples) {
  const auto contour = contour_of<N>(field, samples);
  std::size_t cut = 0;
  for (auto _ : state)
    cut = slice(contour, Hyperplane<N>::across(N - 1, 0.37 * static_cast<double>(samples))).simplices.size();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(contour.simplices.size()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(contour_bytes(contour)));
  state.counters["cut_simplices"] = static_cast<double>(cut);
}

template <int N>
void slice_field(benchmark::State& state, const std::string& field, std::size_t samples) {
  const auto image = make_field<N>(field, samples);
  std::size_t cut = 0;
  for (auto _ : state)
    cut = slice_image(image.view(), 0.0, Hyperplane<N>::across(N - 1, 0.37 * static_cast<double>(samples)))
              .simplices.size();
  // A slice reads the two adjacent layers.
  const auto samples_read = static_cast<std::int64_t>(2 * image.values.size() / samples);
  state.SetItemsProcessed(state.iterations() * samples_read);
  state.SetBytesProcessed(state.iterations() * samples_read * static_cast<std::int64_t>(sizeof(float)));
  state.counters["cut_simplices"] = static_cast<double>(cut);
}

template <int N>
void check_contour(benchmark::State& state, const std::string& field, std::size_t samples) {
  const auto contour = contour_of<N>(field, samples);
  for (auto _ : state) benchmark::DoNotOptimize(check(contour));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(contour.simplices.size()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(contour_bytes(contour)));
}

template <int N>
void add(const std::string& field, std::size_t samples) {
  const std::string what = field + "/" + std::to_string(samples) + "^" + std::to_string(N);
  const auto bench = [&](const char* name, void (*function)(benchmark::State&, const std::string&, std::size_t)) {
    benchmark::RegisterBenchmark((name + ("/" + what)).c_str(), [=](benchmark::State& state) {
      function(state, field, samples);
    })->Unit(benchmark::kMillisecond);
  };
  bench("slice", slice_contour<N>);
  bench("slice_image", slice_field<N>);
  bench("check", check_contour<N>);
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  using tegl::bench::add;
  add<3>("metaballs", 128);
  add<3>("noise", 48);
  add<4>("balls", 48);
  add<4>("gyroid", 32);
  add<4>("noise", 16);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
