// SPDX-License-Identifier: BSD-3-Clause
//
// Direct cuts of images of floating-point numbers; see slice_image.hpp.
#include "extract/slice_image.hpp"

TEGL_INSTANTIATE_SLICE_IMAGE(float)
TEGL_INSTANTIATE_SLICE_IMAGE(double)
