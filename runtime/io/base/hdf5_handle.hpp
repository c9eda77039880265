// SPDX-License-Identifier: BSD-3-Clause
//
// RAII handles of the HDF5 C library, and suppression of its own error output.
#pragma once

#include <hdf5.h>

namespace tegl::io_detail {

/// Closes its id on destruction; negative ids are empty.
class H5Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  H5Handle(hid_t id, Closer closer) noexcept : id_(id), closer_(closer) {}
  H5Handle(H5Handle&& other) noexcept : id_(other.id_), closer_(other.closer_) { other.id_ = -1; }
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  H5Handle& operator=(H5Handle&&) = delete;
  ~H5Handle() {
    if (id_ >= 0) closer_(id_);
  }
  [[nodiscard]] hid_t id() const noexcept { return id_; }
  /// Closes now; returns whether this succeeded.
  bool close() noexcept;

 private:
  hid_t id_;
  Closer closer_;
};

/// Suppresses HDF5's error output while it exists.
class H5Quiet {
 public:
  H5Quiet();
  ~H5Quiet();
  H5Quiet(const H5Quiet&) = delete;
  H5Quiet& operator=(const H5Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

}  // namespace tegl::io_detail
