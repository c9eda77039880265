// SPDX-License-Identifier: BSD-3-Clause
//
// filter_bench FILTER SIZE THREADS [FILE]: seconds of a filter of SIZE^3 floats, the minimum of three runs. FILTER:
// gaussian (sigma 2), median (3^3), bilateral (sigma 1). The samples are the field "metaballs" of the other
// measurements. FILE: the samples are written there, for filters.py.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fields.hpp"
#include "tegl/filter.hpp"

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: filter_bench gaussian|median|bilateral SIZE THREADS [FILE]\n", stderr);
    return 1;
  }
  const std::string name = argv[1];
  const auto size = static_cast<std::size_t>(std::atoi(argv[2]));
  tegl::Filter filter = tegl::SeparableConvolution{std::vector<tegl::AxisWeights>(3, tegl::gaussian_weights(2))};
  if (name == "median") filter = tegl::MedianFilter{{1, 1, 1}};
  if (name == "bilateral") filter = tegl::BilateralFilter{{1, 1, 1}, 0.1};
  tegl::FilterOptions options;
  options.work.threads = static_cast<unsigned>(std::atoi(argv[3]));
  const auto image = tegl::bench::make_field<3>("metaballs", size);
  if (argc > 4) {
    std::FILE* const file = std::fopen(argv[4], "wb");
    if (file == nullptr) return 1;
    std::fwrite(image.values.data(), sizeof(float), image.values.size(), file);
    std::fclose(file);
  }
  double best = 1e30;
  double sum = 0;
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const auto result = tegl::filter_image(image.view(), filter, options);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count());
    sum = 0;
    for (const float value : result.values) sum += static_cast<double>(value);
  }
  std::printf("%s %zu^3, %s threads: %.3f s (sum %.6g)\n", name.c_str(), size, argv[3], best, sum);
  return 0;
}
