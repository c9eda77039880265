// SPDX-License-Identifier: BSD-3-Clause
//
// tunnel_distance: the distance of contours from the zeros of the multilinear interpolant, in random cells whose
// contour has copies of corners inside the cell (tunnels in 3D, copied sides in 4D), with the copies at their levels
// and half way to the centre; and in one cube, of the usual triangulation of a tunnel by chords. Writes CSV.
//
//     tunnel_distance --tiles 20000
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string_view>

#include "arguments.hpp"
#include "run_program.hpp"
#include "support/interpolant_distance.hpp"
#include "tegl/extract.hpp"
#include "usage.hpp"

namespace {

using namespace tegl;
using namespace tegl::test;

struct Settings {
  std::uint64_t tiles = 20'000, seed = 1994;
};

/// Uniform in (0, 1], or with a uniform logarithm between 10^-3 and 1.
double height(bool is_log_uniform, std::mt19937_64& bits) {
  const double share = 1.0 - static_cast<double>(bits() >> 11) * 0x1p-53;
  return is_log_uniform ? std::pow(1000.0, share - 1.0) : share;
}

template <int N>
void measure(const Settings& settings, Triangulation triangulation, Ambiguity ambiguity, bool is_log_uniform) {
  std::mt19937_64 bits(settings.seed), places(settings.seed + 1);
  std::array<std::size_t, N> sizes;
  sizes.fill(2);
  const auto grid = Grid<N>::unit(sizes);
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.triangulation = triangulation;
  options.work.threads = 1;
  InterpolantDistance at_levels, half_way;
  std::uint64_t cells = 0;
  for (std::uint64_t tile = 0; tile < settings.tiles; ++tile) {
    typename CellFunction<N>::Values values;
    const std::uint64_t signature = bits();
    for (std::size_t v = 0; v < values.size(); ++v)
      values[v] = ((signature >> v & 1u) != 0 ? 1.0 : -1.0) * height(is_log_uniform, bits);
    auto contour = extract<double>(Image<double, N>(values.data(), grid), 0.0, options);
    auto moved = contour;
    if (move_copies_half_way<N>(moved) == 0) continue;
    ++cells;
    const CellFunction<N> function(values);
    add_distances(function, contour, 4, places, at_levels);
    add_distances(function, moved, 4, places, half_way);
  }
  std::printf("%d,%s,%s,%s,%llu,%.4f,%.4f,%.3f,%.3f,%.3f,%llu,%llu\n", N,
              triangulation == Triangulation::compact ? "compact" : "barycentric",
              ambiguity == Ambiguity::mean     ? "mean"
              : ambiguity == Ambiguity::saddle ? "saddle"
                                               : "low",
              is_log_uniform ? "log-uniform" : "uniform", static_cast<unsigned long long>(cells),
              half_way.root_mean_square(), at_levels.root_mean_square(),
              1.0 - at_levels.root_mean_square() / half_way.root_mean_square(), half_way.maximum, at_levels.maximum,
              static_cast<unsigned long long>(half_way.unknown), static_cast<unsigned long long>(at_levels.unknown));
}

/// The cube of docs/embedding.md: its tunnel by chords between points on edges, which are given by their ends, and
/// tegl's.
void measure_chords(const Settings& settings) {
  constexpr CellFunction<3>::Values kValues = {5, -1, -5, -1, -6, -1, 4, 10};
  constexpr std::array<std::array<std::array<unsigned, 2>, 3>, 7> kChords = {{{{{0, 4}, {3, 7}, {0, 1}}},
                                                                              {{{3, 7}, {4, 6}, {0, 1}}},
                                                                              {{{4, 6}, {5, 7}, {0, 1}}},
                                                                              {{{5, 7}, {0, 2}, {0, 1}}},
                                                                              {{{5, 7}, {0, 4}, {0, 2}}},
                                                                              {{{3, 7}, {2, 6}, {4, 6}}},
                                                                              {{{3, 7}, {0, 4}, {5, 7}}}}};
  Contour<3, double> chords;
  for (const auto& triangle : kChords) {
    for (const auto& [from, to] : triangle) {
      std::array<double, 3> point;
      const double share = kValues[from] / (kValues[from] - kValues[to]);
      for (unsigned a = 0; a < 3; ++a)
        point[a] = static_cast<double>(from >> a & 1u) * (1.0 - share) + static_cast<double>(to >> a & 1u) * share;
      chords.vertices.push_back(point);
    }
    const auto end = static_cast<Index>(chords.vertices.size());
    chords.simplices.push_back({end - 3, end - 2, end - 1});
  }
  ExtractOptions options;
  options.ambiguity = Ambiguity::saddle;
  const Image<double, 3> image(kValues.data(), Grid<3>::unit({2, 2, 2}));
  std::mt19937_64 places(settings.seed);
  InterpolantDistance by_chords, by_rays;
  add_distances(CellFunction<3>(kValues), chords, 10'000, places, by_chords);
  add_distances(CellFunction<3>(kValues), extract<double>(image, 0.0, options), 10'000, places, by_rays);
  std::printf("one cube by saddle: rms %.4f by chords, %.4f by tegl; maximum %.3f, %.3f\n",
              by_chords.root_mean_square(), by_rays.root_mean_square(), by_chords.maximum, by_rays.maximum);
}

constexpr const char* kUsage =
    "tunnel_distance [options]: distance of contours with copied corners from the multilinear interpolant's, as CSV\n"
    "  --tiles N   random cells of each kind; 20000\n"
    "  --seed S    of the random numbers; 1994\n";

int run(int argc, char** argv) {
  if (bench::tells_usage(argc, argv, kUsage)) return 0;
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view option = argv[i];
    if (i + 1 == argc || (option != "--tiles" && option != "--seed"))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("'{}'; expected --tiles or --seed, and a value; see --help", option));
    (option == "--tiles" ? settings.tiles : settings.seed) =
        bench::whole_number<std::uint64_t>(option, argv[i + 1], 1, std::numeric_limits<std::uint64_t>::max());
  }
  std::printf(
      "dimension,triangulation,ambiguity,heights,cells,rms half way,rms,less,maximum half way,maximum,"
      "unknown half way,unknown\n");
  for (const auto triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const auto ambiguity : {Ambiguity::mean, Ambiguity::saddle})
      for (const bool is_log_uniform : {false, true}) {
        measure<3>(settings, triangulation, ambiguity, is_log_uniform);
        measure<4>(settings, triangulation, ambiguity, is_log_uniform);
      }
  for (const bool is_log_uniform : {false, true})
    measure<4>(settings, Triangulation::barycentric, Ambiguity::low, is_log_uniform);
  measure_chords(settings);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return tegl::bench::run_program("tunnel_distance", argc, argv, run); }
