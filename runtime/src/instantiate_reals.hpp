// SPDX-License-Identifier: BSD-3-Clause
//
// TEGL_INSTANTIATE_ONE(T, N, Real) for all value types, 2 to 4 dimensions, float and double. To be included where it is
// defined, hence without a guard. Not by sources whose instances capture what is in no namespace with a name: GCC warns.
#define TEGL_INSTANTIATE(T)          \
  TEGL_INSTANTIATE_ONE(T, 2, float)  \
  TEGL_INSTANTIATE_ONE(T, 2, double) \
  TEGL_INSTANTIATE_ONE(T, 3, float)  \
  TEGL_INSTANTIATE_ONE(T, 3, double) \
  TEGL_INSTANTIATE_ONE(T, 4, float)  \
  TEGL_INSTANTIATE_ONE(T, 4, double)
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_ONE
