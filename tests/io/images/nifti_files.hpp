// SPDX-License-Identifier: BSD-3-Clause
//
// NIfTI-1 files written field by field, for the tests: offsets as in nifti1.h.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tegl::test {

class NiftiHeader {
 public:
  NiftiHeader(const std::vector<int>& sizes, int datatype, int bits) : bytes_(352, '\0') {
    put<std::int32_t>(0, 348);
    put<std::int16_t>(40, static_cast<std::int16_t>(sizes.size()));
    for (std::size_t i = 0; i < 7; ++i)
      put<std::int16_t>(42 + 2 * i, static_cast<std::int16_t>(i < sizes.size() ? sizes[i] : 1));
    put<std::int16_t>(70, static_cast<std::int16_t>(datatype));
    put<std::int16_t>(72, static_cast<std::int16_t>(bits));
    for (std::size_t i = 0; i < 8; ++i) put<float>(76 + 4 * i, 1.0F);
    put<float>(108, 352.0F);
    std::memcpy(&bytes_[344], "n+1", 4);
  }
  template <class T>
  NiftiHeader& put(std::size_t offset, T value) {
    std::memcpy(&bytes_[offset], &value, sizeof(T));
    return *this;
  }
  NiftiHeader& units(int xyzt) { return put<std::uint8_t>(123, static_cast<std::uint8_t>(xyzt)); }
  NiftiHeader& scaling(float slope, float intercept) { return put(112, slope).put(116, intercept); }
  NiftiHeader& pixdim(std::size_t i, float value) { return put(76 + 4 * i, value); }
  NiftiHeader& sform(const std::array<float, 12>& rows) {
    put<std::int16_t>(254, 1);
    for (std::size_t i = 0; i < 12; ++i) put(280 + 4 * i, rows[i]);
    return *this;
  }
  NiftiHeader& qform(const std::array<float, 6>& quaternion_and_offset, float qfac) {
    put<std::int16_t>(252, 1).pixdim(0, qfac);
    for (std::size_t i = 0; i < 6; ++i) put(256 + 4 * i, quaternion_and_offset[i]);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace tegl::test
