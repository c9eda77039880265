// SPDX-License-Identifier: BSD-3-Clause
//
// The HDF5 file driver for writing. HDF5's own drivers report a failed write, but the library then cannot close the
// file, keeps it open, and crashes at program end. This driver stores the first failure and ignores all later writes,
// so a failed file can be closed and discarded.
#pragma once

#include <hdf5.h>

namespace tegl::io_detail {

/// The error state of a file being written; outlives the file.
struct H5WriteStatus {
  int error = 0;  ///< errno of the first failure; 0: none
};

/// Sets this driver in the property list `access` of files to be created; they report errors to `status`. Returns false
/// if HDF5 refuses.
bool use_pending_file_driver(hid_t access, H5WriteStatus& status);

}  // namespace tegl::io_detail
