// SPDX-License-Identifier: BSD-3-Clause
//
// How fast contours are extracted: smooth fields and noise, 3D and 4D, both triangulations. Items are
// simplices; the counters give tiles and samples per second beside them.
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

#include "fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::bench {
namespace {

template <int N>
test::Metaballs<N> metaballs() {
  test::Metaballs<N> field;
  field.width = 0.2;
  std::mt19937_64 bits(7);
  for (int i = 0; i < 12; ++i) {
    test::Point<N> centre;
    for (double& x : centre) x = 1.4 * test::unit_random(bits) - 0.7;
    field.centres.push_back(centre);
  }
  return field;
}

template <int N>
OwnedImage<float, N> make_image(const std::string& field, std::size_t samples) {
  const auto grid = test::centred_grid<N>(samples, 1.0);
  if (field == "sphere") return test::sample_field<float, N>(grid, test::Ball<N>{{}, 0.8});
  if (field == "gyroid") return test::sample_field<float, N>(grid, test::Gyroid<N>{});
  if (field == "metaballs") return test::sample_field<float, N>(grid, metaballs<N>(), 1.0, -0.5);
  auto image = test::noise<float, N>(grid, 11);
  for (float& value : image.values) value -= 0.5f;
  return image;
}

template <int N>
void extract_field(benchmark::State& state, const std::string& field, std::size_t samples,
                   const ExtractOptions& options) {
  const auto image = make_image<N>(field, samples);
  ExtractStats stats;
  std::size_t simplices = 0;
  std::size_t vertices = 0;
  for (auto _ : state) {
    const auto contour = extract<float>(image.view(), 0.0, options, &stats);
    simplices = contour.simplices.size();
    vertices = contour.vertices.size();
    benchmark::DoNotOptimize(contour.simplices.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(simplices));
  state.counters["tiles/s"] =
      benchmark::Counter(static_cast<double>(stats.active_tiles), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["samples/s"] =
      benchmark::Counter(static_cast<double>(image.values.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["simplices"] = static_cast<double>(simplices);
  state.counters["vertices"] = static_cast<double>(vertices);
  state.counters["classify_ms"] = 1e3 * stats.classify_seconds;
  state.counters["find_ms"] = 1e3 * stats.find_seconds;
  state.counters["generate_ms"] = 1e3 * stats.generate_seconds;
}

template <int N>
void add(const std::string& field, std::size_t samples) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
    ExtractOptions options;
    options.triangulation = triangulation;
    const auto name = field + "/" + std::to_string(samples) + "^" + std::to_string(N) + "/" +
                      (triangulation == Triangulation::compact ? "compact" : "barycentric");
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
      extract_field<N>(state, field, samples, options);
    })->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  using tegl::bench::add;
  add<2>("metaballs", 4096);
  add<3>("sphere", 256);
  add<3>("metaballs", 256);
  add<3>("gyroid", 256);
  add<3>("noise", 128);
  add<4>("sphere", 64);
  add<4>("noise", 32);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
