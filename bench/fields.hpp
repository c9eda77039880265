// SPDX-License-Identifier: BSD-3-Clause
//
// The fixed fields that all measurements use, made fast enough for 512^3 samples: the same samples in every program,
// run and (but for the last bits of sin and exp) on every machine. Each is scaled so that the contour of interest is
// at isovalue 0, on a grid of unit steps, float32.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tegl/image.hpp"

namespace tegl::bench {

/// The names that `make_field` knows:
///   sphere     a ball in the middle, of 0.8 times the half width
///   metaballs  200 Gaussian bumps at seeded places
///   gyroid     32 periods along each axis in 2D, 8 in 3D, 2 in 4D
///   noise      independent and uniform in [-0.5, 0.5)
///   empty      -1 everywhere: no contour
///   balls      in 4D only: two balls that meet half-way along the last axis
std::vector<std::string> field_names(int dim);

/// A field with `samples` samples along every axis (at least 2). Throws Error InvalidArgument for a name that is not
/// known. Costs one pass over the samples, on one thread: 512^3 take about a second.
template <int N>
OwnedImage<float, N> make_field(const std::string& name, std::size_t samples);

/// The same, written to samples^N floats at `out`.
template <int N>
void fill_field(const std::string& name, std::size_t samples, float* out);

}  // namespace tegl::bench
