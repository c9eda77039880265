// SPDX-License-Identifier: BSD-3-Clause
//
// Views of temporary images.
#pragma once

#include "tegl/image.hpp"

namespace tegl {

/// The view of a temporary image, valid within one expression: extract(view_of(noise<float, 3>(8, 1)), 0.5).
/// OwnedImage::view refuses temporaries, as its result could outlive them. In namespace tegl for argument-dependent
/// lookup.
template <Value T, int N>
Image<T, N> view_of(const OwnedImage<T, N>& image) {
  return image.view();
}

}  // namespace tegl
