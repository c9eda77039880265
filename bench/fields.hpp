// SPDX-License-Identifier: BSD-3-Clause
//
// The fixed fields of all measurements, fast enough for 512^3 samples. Samples are equal in every program and run and
// (except for the last bits of sin and exp) on every machine. Fields are float32 on a grid of unit steps, scaled so
// that the contour of interest is at isovalue 0.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tegl/image.hpp"

namespace tegl::bench {

/// The names that `make_field` accepts:
///   sphere     a ball in the middle, of 0.8 times the half width
///   metaballs  200 Gaussian bumps at seeded places
///   gyroid     32 periods along each axis in 2D, 8 in 3D, 2 in 4D
///   noise      independent and uniform in [-0.5, 0.5)
///   empty      -1 everywhere: no contour
///   balls      in 4D only: two balls that meet half-way along the last axis
std::vector<std::string> field_names(int dim);

/// A field with `samples` samples along every axis (at least 2). Throws Error InvalidArgument for an unknown name. One
/// pass over the samples on one thread: about a second for 512^3.
template <int N>
OwnedImage<float, N> make_field(const std::string& name, std::size_t samples);

/// As make_field, but writes samples^N floats to `out`.
template <int N>
void fill_field(const std::string& name, std::size_t samples, float* out);

}  // namespace tegl::bench
