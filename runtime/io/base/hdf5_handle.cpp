// SPDX-License-Identifier: BSD-3-Clause
//
// Implements H5Handle and H5Quiet.
//
// Based on: The HDF Group, HDF5 1.10 C API.
#include "base/hdf5_handle.hpp"

namespace tegl::io_detail {

bool H5Handle::close() noexcept {
  const hid_t id = id_;
  id_ = -1;
  return id < 0 || closer_(id) >= 0;
}

H5Quiet::H5Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

H5Quiet::~H5Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

}  // namespace tegl::io_detail
