// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction from measured images, by number of threads: the ocean of examples/data and, if present, the larger data
// sets beside the checkout. Reading is not timed. stages.hpp documents the report.
#include <benchmark/benchmark.h>

#include <array>
#include <filesystem>
#include <string>
#include <variant>

#include "stages.hpp"
#include "tegl/io.hpp"

namespace tegl::bench {
namespace {

struct DataSet {
  std::filesystem::path file;
  double isovalue;
};

void extract_file(benchmark::State& state, const DataSet& data, int threads) {
  const ReadImageResult read = read_image(data.file);
  const ExtractOptions options = with_threads(ExtractOptions{}, threads);
  std::visit(
      [&](const auto& by_dimension) {
        std::visit([&](const auto& image) { extract_image(state, image.view(), data.isovalue, options); },
                   by_dimension);
      },
      read.image);
}

void add_all() {
  const std::filesystem::path examples = TEGL_EXAMPLE_DATA_DIR;
  const std::filesystem::path shared = TEGL_SHARED_DATA_DIR;
  const std::array sets{
      DataSet{shared / "dem2d/jacksboro_403x344_int16.nhdr", 600},
      DataSet{shared / "classic/aneurism_256x256x256_uint8.nhdr", 60},
      DataSet{shared / "ct_mri/chris_t1.nii.gz", 60},
      DataSet{shared / "ct_mri/3DCT_lung.mha", -400},
      DataSet{examples / "ocean_temperature.nc", 20},
      DataSet{shared / "fourd/pcasl.nii.gz", 700},
      DataSet{shared / "fourd/viscous_fingers_64x64x64x24_float.nhdr", 30},
  };
  for (const DataSet& data : sets) {
    if (!std::filesystem::exists(data.file)) continue;
    for (const int threads : {1, 4}) {
      const std::string name = data.file.filename().string() + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { extract_file(state, data, threads); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  tegl::bench::add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
