// SPDX-License-Identifier: BSD-3-Clause
//
// tunnel_distance: the distance of contours from the zeros of the multilinear interpolant, in random cells whose
// contour has copies of corners inside the cell (tunnels in 3D, copied sides in 4D), with the copies at their levels
// and half way to the centre; and in cubes with a tunnel, also of its triangulation by chords, as an ordinary table has
// it. Writes CSV.
//
//     tunnel_distance --tiles 20000
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "run_program.hpp"
#include "support/distance_oracle.hpp"
#include "support/interpolant_distance.hpp"
#include "tegl/extract.hpp"
#include "tunnel_chords.hpp"
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

const char* name_of(Ambiguity ambiguity) {
  return ambiguity == Ambiguity::mean ? "mean" : ambiguity == Ambiguity::saddle ? "saddle" : "low";
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
              triangulation == Triangulation::compact ? "compact" : "barycentric", name_of(ambiguity),
              is_log_uniform ? "log-uniform" : "uniform", static_cast<unsigned long long>(cells),
              half_way.root_mean_square(), at_levels.root_mean_square(),
              1.0 - at_levels.root_mean_square() / half_way.root_mean_square(), half_way.maximum, at_levels.maximum,
              static_cast<unsigned long long>(half_way.unknown), static_cast<unsigned long long>(at_levels.unknown));
}

/// The interpolant's contour in a cube, in a grid of smaller cubes.
bench::CubeContour fine_contour(const CellFunction<3>& function) {
  constexpr std::size_t kSamples = 17;
  const std::array<std::size_t, 3> sizes = {kSamples, kSamples, kSamples};
  std::vector<double> samples;
  for (std::size_t z = 0; z < kSamples; ++z)
    for (std::size_t y = 0; y < kSamples; ++y)
      for (std::size_t x = 0; x < kSamples; ++x) {
        std::array<double, 3> at = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}, gradient;
        for (double& coordinate : at) coordinate /= kSamples - 1;
        samples.push_back(function(at, gradient));
      }
  ExtractOptions options;
  options.ambiguity = Ambiguity::saddle;
  options.work.threads = 1;
  auto contour = extract<double>(Image<double, 3>(samples.data(), Grid<3>::unit(sizes)), 0.0, options);
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x /= kSamples - 1;
  return contour;
}

/// Adds the distances of random points of one contour from another one.
void add_distances(const bench::CubeContour& from, const bench::CubeContour& to, int count, std::mt19937_64& bits,
                   InterpolantDistance& distances) {
  const auto corners_of = [](const bench::CubeContour& contour, const bench::CubeTriangle& triangle) {
    return std::array{contour.vertices[triangle[0]], contour.vertices[triangle[1]], contour.vertices[triangle[2]]};
  };
  double size = 0;
  for (const auto& triangle : from.simplices) size += gram_measure<3>(corners_of(from, triangle));
  for (const auto& triangle : from.simplices) {
    // as many points as its share of the whole, rounded at random
    const auto corners = corners_of(from, triangle);
    const double share = count * gram_measure<3>(corners) / size;
    for (double left = share - unit_random(bits); left > 0; left -= 1) {
      double s = unit_random(bits), t = unit_random(bits);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      std::array<double, 3> point;
      for (std::size_t a = 0; a < 3; ++a)
        point[a] = corners[0][a] + s * (corners[1][a] - corners[0][a]) + t * (corners[2][a] - corners[0][a]);
      double least = std::numeric_limits<double>::infinity();
      for (const auto& other : to.simplices)
        least = std::min(least, distance_to_simplex_by_faces<3>(point, corners_of(to, other)));
      distances.add(least, 1.0);
    }
  }
}

/// Means over cells of the width of waists.
struct Waists {
  double interpolant = 0, chords = 0, tegl = 0;  ///< sums
  std::uint64_t cells = 0;

  void add(const bench::CubeContour& contour, const bench::CubeContour& by_chords, const bench::CubeContour& fine) {
    const auto tunnel_of = [](const bench::CubeContour& of) -> std::optional<bench::CubePiece> {
      const auto pieces = bench::pieces_of(of);
      if (pieces.size() != 1 || !pieces[0].is_tunnel()) return std::nullopt;
      return pieces[0];
    };
    const auto coarse_tunnel = tunnel_of(contour), fine_tunnel = tunnel_of(fine);
    if (!coarse_tunnel || !fine_tunnel) return;
    const auto axis = bench::axis_between(contour, coarse_tunnel->polygons);
    const auto fine_axis = bench::axis_between(fine, fine_tunnel->polygons);
    if (!axis || !fine_axis) return;
    ++cells;
    interpolant += bench::waist_of(fine, *fine_axis);
    tegl += bench::waist_of(contour, *axis);
    chords += bench::waist_of(by_chords, *axis);
  }
};

/// Cubes with a tunnel: by chords, and tegl's.
void measure_tunnels(const Settings& settings, Ambiguity ambiguity, bool is_log_uniform) {
  constexpr int kPoints = 100;
  std::mt19937_64 bits(settings.seed), places(settings.seed + 1);
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.work.threads = 1;
  InterpolantDistance chords_to, tegl_to, to_chords, to_tegl;
  Waists waists;
  std::uint64_t cells = 0;
  for (std::uint64_t tile = 0; tile < settings.tiles; ++tile) {
    CellFunction<3>::Values values;
    const std::uint64_t signature = bits();
    for (std::size_t v = 0; v < values.size(); ++v)
      values[v] = ((signature >> v & 1u) != 0 ? 1.0 : -1.0) * height(is_log_uniform, bits);
    const auto contour = extract<double>(Image<double, 3>(values.data(), Grid<3>::unit({2, 2, 2})), 0.0, options);
    const auto chords = bench::with_chords(contour);
    if (!chords) continue;
    ++cells;
    const CellFunction<3> function(values);
    test::add_distances(function, *chords, 20, places, chords_to);
    test::add_distances(function, contour, 20, places, tegl_to);
    const auto fine = fine_contour(function);
    add_distances(fine, *chords, kPoints, places, to_chords);
    add_distances(fine, contour, kPoints, places, to_tegl);
    waists.add(contour, *chords, fine);
  }
  const double measured = static_cast<double>(waists.cells);
  std::printf("%s,%s,%llu,%.4f,%.4f,%.3f,%.3f,%.4f,%.4f,%.3f,%.3f,%llu,%.3f,%.3f,%.3f\n", name_of(ambiguity),
              is_log_uniform ? "log-uniform" : "uniform", static_cast<unsigned long long>(cells),
              chords_to.root_mean_square(), tegl_to.root_mean_square(), chords_to.maximum, tegl_to.maximum,
              to_chords.root_mean_square(), to_tegl.root_mean_square(), to_chords.maximum, to_tegl.maximum,
              static_cast<unsigned long long>(waists.cells), waists.interpolant / measured, waists.chords / measured,
              waists.tegl / measured);
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
  std::printf(
      "\ncubes with a tunnel,heights,cells,rms to interpolant by chords,by tegl,maximum by chords,by tegl,"
      "rms from interpolant by chords,by tegl,maximum by chords,by tegl,"
      "cells with a waist,waist of interpolant,by chords,by tegl\n");
  for (const auto ambiguity : {Ambiguity::mean, Ambiguity::saddle})
    for (const bool is_log_uniform : {false, true}) measure_tunnels(settings, ambiguity, is_log_uniform);
  measure_chords(settings);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return tegl::bench::run_program("tunnel_distance", argc, argv, run); }
