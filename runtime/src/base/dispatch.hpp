// SPDX-License-Identifier: BSD-3-Clause
//
// Include after defining HWY_TARGET_INCLUDE, in files that Highway compiles for several instruction sets. Disables sets
// that are no faster here than similar ones, and sets whose registers have no fixed length. AVX3_DL is enabled if
// HWY_WANT_AVX3_DL is defined.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include "hwy/foreach_target.h"
