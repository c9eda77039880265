// SPDX-License-Identifier: BSD-3-Clause
//
// The first contour of a process: first_contour RULE prints the milliseconds of the first contour of a small 4D image
// of noise, and the least of the 20 that follow. The difference is what a program pays once: pages of tables and code
// that are loaded, memory, tables that are computed at first use. bench/resolved.py runs it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <string_view>
#include <utility>

#include "fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::bench {
namespace {

constexpr std::pair<std::string_view, Ambiguity> kRules[] = {{"low", Ambiguity::low},
                                                             {"mean", Ambiguity::mean},
                                                             {"saddle", Ambiguity::saddle},
                                                             {"squares", Ambiguity::squares},
                                                             {"decider", Ambiguity::decider}};

int run(std::string_view rule) {
  const auto* const found =
      std::find_if(std::begin(kRules), std::end(kRules), [&](auto& r) { return r.first == rule; });
  if (found == std::end(kRules)) {
    std::fprintf(stderr, "first_contour: the rule is '%.*s'; expected low, mean, saddle, squares or decider\n",
                 static_cast<int>(rule.size()), rule.data());
    return 2;
  }
  const auto image = make_field<4>("noise", 6);
  ExtractOptions options;
  options.ambiguity = found->second;
  options.work.threads = 1;
  const auto milliseconds = [&] {
    const auto start = std::chrono::steady_clock::now();
    const auto contour = extract(image.view(), 0.0, options);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    return contour.simplices.empty() ? std::numeric_limits<double>::infinity() : time.count();
  };
  const double first = milliseconds();
  double later = milliseconds();
  for (int i = 1; i < 20; ++i) later = std::min(later, milliseconds());
  std::printf("%.4f %.4f\n", first, later);
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  try {
    return tegl::bench::run(argc == 2 ? argv[1] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "first_contour: %s\n", error.what());
    return 1;
  }
}
