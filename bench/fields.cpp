// SPDX-License-Identifier: BSD-3-Clause
//
// The fixed fields, computed row by row. All except the sphere, the balls and noise are sums of products of functions
// of one coordinate (Gaussian bumps and products of sines are separable). So a row costs one multiplication and
// addition per term and sample, without calls of exp or sin.
#include "fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tegl/error.hpp"
#include "tegl/field.hpp"

namespace tegl::bench {
namespace {

using detail::mixed_bits;
using detail::mixed_unit;

/// Position of sample i of an axis from -1 to 1.
double position(std::size_t i, std::size_t samples) {
  return 2.0 * static_cast<double>(i) / static_cast<double>(samples - 1) - 1.0;
}

/// Calls row(first sample, index of the row along the axes 1 ... N - 1) for every row.
template <int N, class Row>
void for_each_row(std::size_t samples, float* out, Row&& row) {
  std::array<std::size_t, N> index{};
  std::size_t rows = 1;
  for (int a = 1; a < N; ++a) rows *= samples;
  for (std::size_t r = 0; r < rows; ++r, out += samples) {
    row(out, index);
    for (int a = 1; a < N && ++index[a] == samples; ++a) index[a] = 0;
  }
}

template <int N>
void fill_sphere(std::size_t samples, float* out) {
  std::vector<double> square(samples);
  for (std::size_t i = 0; i < samples; ++i) square[i] = position(i, samples) * position(i, samples);
  for_each_row<N>(samples, out, [&](float* row, const std::array<std::size_t, N>& index) {
    double rest = 0.0;
    for (int a = 1; a < N; ++a) rest += square[index[a]];
    for (std::size_t i = 0; i < samples; ++i) row[i] = static_cast<float>(0.8 - std::sqrt(rest + square[i]));
  });
}

/// Two balls of N - 1 dimensions with centres at -d and d on axis 0; d decreases from 0.5 to 0.1 along the last axis.
template <int N>
void fill_balls(std::size_t samples, float* out) {
  for_each_row<N>(samples, out, [&](float* row, const std::array<std::size_t, N>& index) {
    const double d = 0.3 - 0.2 * position(index[N - 1], samples);
    double rest = 0.0;
    for (int a = 1; a < N - 1; ++a) rest += position(index[a], samples) * position(index[a], samples);
    for (std::size_t i = 0; i < samples; ++i) {
      const double x = std::abs(position(i, samples)) - d;
      row[i] = static_cast<float>(0.245 - std::sqrt(rest + x * x));
    }
  });
}

/// sum over a of sin(k x_a) cos(k x_(a+1)).
template <int N>
void fill_gyroid(std::size_t samples, float* out) {
  const double k = std::numbers::pi * (N == 2 ? 32.0 : N == 3 ? 8.0 : 2.0);
  std::vector<float> sine(samples);
  std::vector<float> cosine(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    sine[i] = static_cast<float>(std::sin(k * position(i, samples)));
    cosine[i] = static_cast<float>(std::cos(k * position(i, samples)));
  }
  for_each_row<N>(samples, out, [&](float* row, const std::array<std::size_t, N>& index) {
    float rest = 0.0F;
    for (int a = 1; a + 1 < N; ++a) rest += sine[index[a]] * cosine[index[a + 1]];
    const float next = cosine[index[1]];
    const float last = sine[index[N - 1]];
    for (std::size_t i = 0; i < samples; ++i) row[i] = rest + sine[i] * next + last * cosine[i];
  });
}

/// 200 bumps exp(-(x - c)^2 / (2 w^2)) minus the isovalue. Bumps that add less than 1e-7 to a row are skipped there.
template <int N>
void fill_metaballs(std::size_t samples, float* out) {
  constexpr std::size_t kBumps = 200;
  constexpr double kWidth = N == 2 ? 0.035 : N == 3 ? 0.081 : 0.1;
  std::vector<float> factor(kBumps * N * samples);
  const auto at = [&](std::size_t bump, int axis) { return factor.data() + (bump * N + axis) * samples; };
  for (std::size_t b = 0; b < kBumps; ++b)
    for (int a = 0; a < N; ++a) {
      const double centre = 1.7 * mixed_unit(b * N + a) - 0.85;
      for (std::size_t i = 0; i < samples; ++i) {
        const double x = (position(i, samples) - centre) / kWidth;
        at(b, a)[i] = static_cast<float>(std::exp(-0.5 * x * x));
      }
    }
  for_each_row<N>(samples, out, [&](float* row, const std::array<std::size_t, N>& index) {
    std::fill(row, row + samples, -0.5F);
    for (std::size_t b = 0; b < kBumps; ++b) {
      float weight = 1.0F;
      for (int a = 1; a < N; ++a) weight *= at(b, a)[index[a]];
      if (weight < 1e-7F) continue;
      const float* bump = at(b, 0);
      for (std::size_t i = 0; i < samples; ++i) row[i] += weight * bump[i];
    }
  });
}

void fill_noise(std::size_t count, float* out) {
  // 24 bits, so that the difference is exact.
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(mixed_bits(i) >> 40U) * 0x1p-24F - 0.5F;
}

}  // namespace

std::vector<std::string> field_names(int dim) {
  std::vector<std::string> names{"sphere", "metaballs", "gyroid", "noise", "empty"};
  if (dim == 4) names.emplace_back("balls");
  return names;
}

template <int N>
void fill_field(const std::string& name, std::size_t samples, float* out) {
  if (samples < 2) throw Error(ErrorCode::InvalidArgument, "a field needs at least 2 samples along each axis");
  std::size_t count = 1;
  for (int a = 0; a < N; ++a) count *= samples;
  if (name == "sphere") return fill_sphere<N>(samples, out);
  if (name == "metaballs") return fill_metaballs<N>(samples, out);
  if (name == "gyroid") return fill_gyroid<N>(samples, out);
  if (name == "noise") return fill_noise(count, out);
  if (name == "empty") {
    std::fill(out, out + count, -1.0F);
    return;
  }
  if constexpr (N == 4)
    if (name == "balls") return fill_balls<N>(samples, out);
  std::string known;
  for (const std::string& field : field_names(N)) known += (known.empty() ? "" : ", ") + field;
  throw Error(ErrorCode::InvalidArgument, "no field '" + name + "'; expected " + known);
}

template <int N>
OwnedImage<float, N> make_field(const std::string& name, std::size_t samples) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  std::size_t count = 1;
  for (int a = 0; a < N; ++a) count *= samples;
  OwnedImage<float, N> image{Grid<N>::unit(sizes), std::vector<float>(count)};
  fill_field<N>(name, samples, image.values.data());
  return image;
}

template void fill_field<2>(const std::string&, std::size_t, float*);
template void fill_field<3>(const std::string&, std::size_t, float*);
template void fill_field<4>(const std::string&, std::size_t, float*);
template void fill_field<5>(const std::string&, std::size_t, float*);
template OwnedImage<float, 2> make_field<2>(const std::string&, std::size_t);
template OwnedImage<float, 3> make_field<3>(const std::string&, std::size_t);
template OwnedImage<float, 4> make_field<4>(const std::string&, std::size_t);
template OwnedImage<float, 5> make_field<5>(const std::string&, std::size_t);

}  // namespace tegl::bench
