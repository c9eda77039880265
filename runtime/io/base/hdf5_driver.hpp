// SPDX-License-Identifier: BSD-3-Clause
//
// How HDF5 writes a file here. Its own drivers report a write that fails, but then the library cannot close the file
// any more, keeps it open, and crashes on it when the program ends. This one remembers the first failure and from then
// on takes everything without writing it, so that a failed file can be closed and given up like any other.
#pragma once

#include <hdf5.h>

namespace tegl::io_detail {

/// What went wrong while a file was written; outlives the file.
struct H5WriteStatus {
  int error = 0;  ///< errno of the first failure; 0: none
};

/// Makes files that are created with the property list `access` use this driver and report to `status`.
/// Returns false if HDF5 refuses.
bool use_pending_file_driver(hid_t access, H5WriteStatus& status);

}  // namespace tegl::io_detail
