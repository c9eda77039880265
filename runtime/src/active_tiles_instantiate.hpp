// SPDX-License-Identifier: BSD-3-Clause
//
// TEGL_INSTANTIATE_ONE(T, N) for all value types and dimensions. To be included where it is defined, hence without a
// guard.
#define TEGL_INSTANTIATE(T)  \
  TEGL_INSTANTIATE_ONE(T, 2) \
  TEGL_INSTANTIATE_ONE(T, 3) \
  TEGL_INSTANTIATE_ONE(T, 4) \
  TEGL_INSTANTIATE_ONE(T, 5)
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_ONE
