// SPDX-License-Identifier: BSD-3-Clause
//
// ambiguity_errors: for each way to resolve ambiguities, the number of contours of random fields whose topology (number
// of components or Euler characteristic) differs from the interpolant's. Writes CSV.
//
//     ambiguity_errors [FIELDS [CELLS]]
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "support/multilinear.hpp"
#include "support/random_fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "usage.hpp"

namespace {

using namespace tegl;
using namespace tegl::test;

constexpr std::array<std::pair<const char*, Ambiguity>, 6> kWays{{{"low", Ambiguity::low},
                                                                  {"high", Ambiguity::high},
                                                                  {"mean", Ambiguity::mean},
                                                                  {"saddle", Ambiguity::saddle},
                                                                  {"squares", Ambiguity::squares},
                                                                  {"decider", Ambiguity::decider}}};

template <int N>
void measure(const char* name, std::size_t count, std::size_t samples, bool padded) {
  std::mt19937_64 bits(2012);
  std::array<std::size_t, kWays.size()> wrong{}, unsound{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto field = random_field<N>(bits, samples, 1 << 23, padded);
    const auto image = image_of<float>(field);
    const Topology expected = interpolant_topology(field).contour;
    for (std::size_t w = 0; w < kWays.size(); ++w) {
      ExtractOptions options;
      options.ambiguity = kWays[w].second;
      options.work.threads = 1;
      const MeshReport report = check(extract<float>(image.view(), 0.0, options));
      wrong[w] += report.euler != expected.euler || static_cast<std::int64_t>(report.components) != expected.components;
      unsound[w] += report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts > 0;
    }
  }
  for (std::size_t w = 0; w < kWays.size(); ++w)
    std::printf("%s,%zu,%s,%zu,%.3f,%zu\n", name, count, kWays[w].first, wrong[w],
                100.0 * static_cast<double>(wrong[w]) / static_cast<double>(count), unsound[w]);
}

}  // namespace

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv,
                               "ambiguity_errors [FIELDS [CELLS]]: contours of noise that have another topology than "
                               "the interpolant's, as CSV"))
    return 0;
  const std::size_t fields = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 10'000;
  const std::size_t cells = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 10 * fields;
  std::printf("fields,count,ambiguity,wrong,percent,not manifold\n");
  measure<2>("5 x 5 with a low border", fields, 5, true);
  measure<3>("cubes", cells, 2, false);
  measure<3>("5 x 5 x 5", fields, 5, false);
  measure<3>("5 x 5 x 5 with a low border", fields, 5, true);
}
