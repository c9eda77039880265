// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction from images of 8-bit integers.
#include "extract/extract_image.hpp"

TEGL_INSTANTIATE_EXTRACT(std::uint8_t)
TEGL_INSTANTIATE_EXTRACT(std::int8_t)
