// SPDX-License-Identifier: BSD-3-Clause
//
// To be included, after HWY_TARGET_INCLUDE is defined, by files that Highway compiles for several instruction sets.
// Left out are sets that bring nothing here beside their neighbours, and those whose registers have no fixed length.
// AVX3_DL is there where HWY_WANT_AVX3_DL is defined.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include "hwy/foreach_target.h"
