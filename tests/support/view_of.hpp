// SPDX-License-Identifier: BSD-3-Clause
//
// Views of images that live for one expression.
#pragma once

#include "tegl/image.hpp"

namespace tegl {

/// The view of a temporary image, for use within one expression: extract(view_of(noise<float, 3>(8, 1)), 0.5).
/// OwnedImage::view refuses temporaries, as it cannot know how long its result is kept. In namespace tegl, so that
/// argument-dependent lookup finds it.
template <Value T, int N>
Image<T, N> view_of(const OwnedImage<T, N>& image) {
  return image.view();
}

}  // namespace tegl
