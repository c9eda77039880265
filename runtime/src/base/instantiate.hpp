// SPDX-License-Identifier: BSD-3-Clause
//
// Instantiates templates for all value types, or for all types of contours. Include it after defining one of the
// following macros; therefore it has no include guard.
// - TEGL_INSTANTIATE_REALS(T, N, Real): 2 to 4 dimensions, float and double. Not for sources whose instances capture
// something in an unnamed namespace: GCC warns.
// - TEGL_INSTANTIATE_DIMENSIONS(T, N): 2 to 5 dimensions.
// - TEGL_INSTANTIATE(T): once.
// - TEGL_INSTANTIATE_CONTOURS(N, Real): no value types; 2 to 4 dimensions, float and double. The same restriction as
// for TEGL_INSTANTIATE_REALS.
// - TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real): as TEGL_INSTANTIATE_CONTOURS, with 5 dimensions too.
#if defined(TEGL_INSTANTIATE_CONTOURS_TO_5)
#define TEGL_INSTANTIATE_CONTOURS TEGL_INSTANTIATE_CONTOURS_TO_5
#endif
#if defined(TEGL_INSTANTIATE_CONTOURS)
TEGL_INSTANTIATE_CONTOURS(2, float)
TEGL_INSTANTIATE_CONTOURS(2, double)
TEGL_INSTANTIATE_CONTOURS(3, float)
TEGL_INSTANTIATE_CONTOURS(3, double)
TEGL_INSTANTIATE_CONTOURS(4, float)
TEGL_INSTANTIATE_CONTOURS(4, double)
#if defined(TEGL_INSTANTIATE_CONTOURS_TO_5)
TEGL_INSTANTIATE_CONTOURS(5, float)
TEGL_INSTANTIATE_CONTOURS(5, double)
#endif
#else
#if defined(TEGL_INSTANTIATE_REALS)
#define TEGL_INSTANTIATE(T)            \
  TEGL_INSTANTIATE_REALS(T, 2, float)  \
  TEGL_INSTANTIATE_REALS(T, 2, double) \
  TEGL_INSTANTIATE_REALS(T, 3, float)  \
  TEGL_INSTANTIATE_REALS(T, 3, double) \
  TEGL_INSTANTIATE_REALS(T, 4, float)  \
  TEGL_INSTANTIATE_REALS(T, 4, double)
#elif defined(TEGL_INSTANTIATE_DIMENSIONS)
#define TEGL_INSTANTIATE(T)         \
  TEGL_INSTANTIATE_DIMENSIONS(T, 2) \
  TEGL_INSTANTIATE_DIMENSIONS(T, 3) \
  TEGL_INSTANTIATE_DIMENSIONS(T, 4) \
  TEGL_INSTANTIATE_DIMENSIONS(T, 5)
#endif
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#endif
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_CONTOURS
#undef TEGL_INSTANTIATE_CONTOURS_TO_5
#undef TEGL_INSTANTIATE_REALS
#undef TEGL_INSTANTIATE_DIMENSIONS
