// SPDX-License-Identifier: BSD-3-Clause
//
// filter_bench FILTER SIZE THREADS [FILE]: seconds of a filter of SIZE^3 floats, the minimum of three runs. FILTER:
// gaussian (sigma 2), median (3^3), bilateral (sigma 1). The samples are the field "metaballs" of the other
// measurements. FILE: the samples are written there, for filters.py.
//
// filter_bench scale-space SIZE THREADS: processor seconds of the contour of a scale space of 24 scales, 0.5 to 8
// samples, and of its parts made one by one: a discrete Gaussian for each scale, and the contour of the 4D image.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/filter.hpp"
#include "tegl/scale_space.hpp"

namespace {

/// Processor seconds of `work`.
template <class Work>
double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int measure_scale_space(std::size_t size, unsigned threads) {
  std::vector<double> sigmas;
  for (int i = 0; i < 24; ++i) sigmas.push_back(0.5 * std::pow(16.0, i / 23.0));
  const auto image = tegl::bench::make_field<3>("metaballs", size);
  tegl::ScaleSpaceOptions options;
  options.in_samples = true;
  options.filter.work.threads = threads;
  const tegl::ExtractOptions extraction{.work = {.threads = threads}};
  double gaussians = 1e30, dropped = 1e30, scales = 1e30, contour = 1e30;
  std::size_t simplices = 0;
  for (int run = 0; run < 3; ++run) {
    // The smoothed images are kept, as a contour of all of them would need them.
    std::vector<tegl::OwnedImage<float, 3>> kept;
    const auto smooth = [&](bool keep) {
      for (const double sigma : sigmas) {
        const tegl::SeparableConvolution filter{
            std::vector<tegl::AxisWeights>(3, tegl::discrete_gaussian_weights(sigma))};
        auto smoothed = tegl::filter_image(image.view(), filter, options.filter);
        if (keep) kept.push_back(std::move(smoothed));
      }
    };
    dropped = std::min(dropped, seconds_of([&] { smooth(false); }));
    gaussians = std::min(gaussians, seconds_of([&] { smooth(true); }));
    kept = {};
    tegl::OwnedImage<float, 4> space;
    scales = std::min(
        scales, seconds_of([&] { space = tegl::ScaleSpaceLayers<float, 3>(image.view(), sigmas, options).all(); }));
    contour = std::min(
        contour, seconds_of([&] { simplices = tegl::extract<float>(space.view(), 0.0, extraction).simplices.size(); }));
  }
  std::printf(
      "scale space of %zu^3 at 24 scales, %u threads: %.2f s; 24 Gaussians: %.2f s; contour: %.2f s "
      "(%zu tetrahedra); scale space and contour / Gaussians and contour: %.3f; if each Gaussian is dropped before the "
      "next: %.3f\n",
      size, threads, scales, gaussians, contour, simplices, (scales + contour) / (gaussians + contour),
      (scales + contour) / (dropped + contour));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: filter_bench gaussian|median|bilateral|scale-space SIZE THREADS [FILE]\n", stderr);
    return 1;
  }
  const std::string name = argv[1];
  const auto size = static_cast<std::size_t>(std::atoi(argv[2]));
  if (name == "scale-space") return measure_scale_space(size, static_cast<unsigned>(std::atoi(argv[3])));
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
