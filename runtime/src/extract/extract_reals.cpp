// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction from images of floating point numbers.
#include "extract/extract_image.hpp"

TEGL_INSTANTIATE_EXTRACT(float)
TEGL_INSTANTIATE_EXTRACT(double)
