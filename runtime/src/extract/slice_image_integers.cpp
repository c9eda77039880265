// SPDX-License-Identifier: BSD-3-Clause
//
// Direct cuts of images of integers; see slice_image.hpp.
#include "extract/slice_image.hpp"

TEGL_INSTANTIATE_SLICE_IMAGE(std::uint8_t)
TEGL_INSTANTIATE_SLICE_IMAGE(std::int8_t)
TEGL_INSTANTIATE_SLICE_IMAGE(std::uint16_t)
TEGL_INSTANTIATE_SLICE_IMAGE(std::int16_t)
TEGL_INSTANTIATE_SLICE_IMAGE(std::int32_t)
