// SPDX-License-Identifier: BSD-3-Clause
//
// Errors of normals: the root mean square of their angles to the exact normals of a sphere, by kind, dimension, grid,
// number of samples and noise, as CSV. The result does not depend on the machine.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/normals.hpp"
#include "usage.hpp"

namespace {

using tegl::Normals;
using tegl::NormalWeights;

/// A grid with `samples` samples along every axis over [-1.35, 1.35], slightly off centre to avoid symmetry.
template <int N>
tegl::Grid<N> grid_of(const std::string& kind, std::size_t samples) {
  tegl::Grid<N> grid;
  const double step = 2.7 / static_cast<double>(samples - 1);
  for (int a = 0; a < N; ++a) {
    const double origin = -1.35 + step * 0.17 * (a + 1);
    std::vector<double> uneven;
    for (std::size_t i = 0; i < samples; ++i) {
      const double x = origin + static_cast<double>(i) * step;
      uneven.push_back(kind == "smooth" ? x + 0.15 * std::sin(2.0 * x) : x + (i % 2 == 0 ? 0.2 * step : 0.0));
    }
    grid.axes[a] = kind == "smooth" || kind == "rough" ? tegl::Axis::rectilinear(uneven)
                                                       : tegl::Axis::uniform(samples, origin, step);
    if (kind == "sheared" && a + 1 < N) grid.linear[a][a + 1] = 0.3;
  }
  return grid;
}

/// 0.8 minus the distance from the origin in world coordinates, plus normally distributed noise with a standard
/// deviation of `noise` steps.
template <int N>
tegl::OwnedImage<double, N> ball_of(const tegl::Grid<N>& grid, double noise) {
  std::size_t count = 1;
  for (const tegl::Axis& axis : grid.axes) count *= axis.size();
  tegl::OwnedImage<double, N> image{grid, std::vector<double>(count)};
  std::mt19937_64 bits(7);
  const auto unit = [&] { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; };
  const Eigen::Matrix<double, N, N> linear = tegl::as_eigen(grid.linear);
  std::array<std::size_t, N> index{};
  for (double& value : image.values) {
    Eigen::Matrix<double, N, 1> x;
    for (int a = 0; a < N; ++a) x(a) = grid.axes[a][index[a]];
    const double normal = std::sqrt(-2.0 * std::log(unit())) * std::cos(2.0 * std::numbers::pi * unit());
    value = 0.8 - (linear * x).norm() + noise * std::abs(grid.axes[0].step()) * normal;
    for (int a = 0; a < N && ++index[a] == grid.axes[a].size(); ++a) index[a] = 0;
  }
  return image;
}

/// The squared angle, in degrees, between a normal and the direction of a point.
template <int N>
double squared_angle(const std::array<double, N>& normal, const std::array<double, N>& at) {
  double size = 0.0, square = 0.0;
  for (const double x : at) size += x * x;
  for (int a = 0; a < N; ++a) square += std::pow(normal[a] - at[a] / std::sqrt(size), 2);
  return std::pow(2.0 * std::asin(std::min(1.0, std::sqrt(square) / 2.0)) * 180.0 / std::numbers::pi, 2);
}

template <int N>
double error_at_vertices(const tegl::Contour<N, double>& contour,
                         const tegl::Buffer<std::array<double, std::size_t{N}>>& normals) {
  double sum = 0.0;
  for (std::size_t v = 0; v < normals.size(); ++v) sum += squared_angle<N>(normals[v], contour.vertices[v]);
  return std::sqrt(sum / static_cast<double>(normals.size()));
}

/// Root mean square error of flat normals, against the directions of the centroids.
template <int N>
double error_of_simplices(const tegl::Contour<N, double>& contour) {
  const auto normals = tegl::flat_normals(contour);
  double sum = 0.0;
  for (std::size_t s = 0; s < normals.size(); ++s) {
    std::array<double, N> centroid{};
    for (const tegl::Index v : contour.simplices[s])
      for (int a = 0; a < N; ++a) centroid[a] += contour.vertices[v][a] / N;
    sum += squared_angle<N>(normals[s], centroid);
  }
  return std::sqrt(sum / static_cast<double>(normals.size()));
}

template <int N>
void print_errors(const std::string& grid, std::size_t samples, double noise) {
  const auto image = ball_of<N>(grid_of<N>(grid, samples), noise);
  const auto print = [&](const char* kind, double error) {
    std::printf("%d,%s,%zu,%g,%s,%.4g\n", N, grid.c_str(), samples, noise, kind, error);
  };
  tegl::ExtractOptions options;
  tegl::Contour<N, double> contour;
  for (const Normals kind : {Normals::sobel, Normals::differences}) {
    options.normals = kind;
    contour = tegl::extract<double>(image.view(), 0.0, options);
    print(kind == Normals::sobel ? "sobel" : "differences", error_at_vertices<N>(contour, contour.normals));
  }
  print("angle", error_at_vertices<N>(contour, tegl::geometric_normals(contour, NormalWeights::angle)));
  print("area", error_at_vertices<N>(contour, tegl::geometric_normals(contour, NormalWeights::area)));
  print("equal", error_at_vertices<N>(contour, tegl::geometric_normals(contour, NormalWeights::equal)));
  print("flat", error_of_simplices<N>(contour));
}

template <int N>
void print_all(const std::vector<std::size_t>& sizes) {
  for (const char* grid : {"regular", "smooth", "rough", "sheared"})
    for (const std::size_t samples : sizes) print_errors<N>(grid, samples, 0.0);
  for (const double noise : {0.003, 0.01, 0.03, 0.1, 0.3}) print_errors<N>("regular", sizes[sizes.size() - 2], noise);
}

}  // namespace

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv, "normal_errors: how exact normals are, as CSV")) return 0;
  std::printf("dim,grid,samples,noise,kind,degrees\n");
  print_all<2>({17, 33, 65, 129});
  print_all<3>({17, 33, 65, 129});
  print_all<4>({9, 17, 33});
  return 0;
}
