// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction from images of 16-bit and 32-bit integers.
#include "extract/extract_image.hpp"

TEGL_INSTANTIATE_EXTRACT(std::uint16_t)
TEGL_INSTANTIATE_EXTRACT(std::int16_t)
TEGL_INSTANTIATE_EXTRACT(std::int32_t)
