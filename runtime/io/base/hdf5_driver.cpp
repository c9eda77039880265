// SPDX-License-Identifier: BSD-3-Clause
//
// Implements an HDF5 file driver with pwrite and pread, for files that one process creates, writes and closes.
//
// Based on: The HDF Group, HDF5 1.10 Virtual File Layer (H5FDpublic.h).
#include "base/hdf5_driver.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

namespace tegl::io_detail {

namespace {

struct DriverInfo {
  H5WriteStatus* status;
};

struct PendingFile {
  H5FD_t base;  ///< must be the first member: HDF5 casts pointers to it
  int descriptor;
  H5WriteStatus* status;
  haddr_t allocated;
  haddr_t end;
};

PendingFile& as_pending(H5FD_t* file) { return *reinterpret_cast<PendingFile*>(file); }
const PendingFile& as_pending(const H5FD_t* file) { return *reinterpret_cast<const PendingFile*>(file); }

H5FD_t* open_file(const char* name, unsigned flags, hid_t access, haddr_t) {
  const auto* const info = static_cast<const DriverInfo*>(H5Pget_driver_info(access));
  if (info == nullptr || (flags & H5F_ACC_RDWR) == 0) return nullptr;
  const int descriptor = ::open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    info->status->error = errno;
    return nullptr;
  }
  // Exceptions must not pass through HDF5.
  auto* const file = new (std::nothrow) PendingFile{{}, descriptor, info->status, 0, 0};
  if (file == nullptr) {
    ::close(descriptor);
    info->status->error = ENOMEM;
    return nullptr;
  }
  return &file->base;
}

herr_t close_file(H5FD_t* file) {
  const std::unique_ptr<PendingFile> pending(&as_pending(file));
  if (::close(pending->descriptor) != 0 && pending->status->error == 0) pending->status->error = errno;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t) { return as_pending(file).allocated; }

herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  as_pending(file).allocated = address;
  return 0;
}

haddr_t get_end(const H5FD_t* file, H5FD_mem_t) { return as_pending(file).end; }

/// Reads zeros past the end and for bytes that were never written.
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* to) {
  auto* bytes = static_cast<unsigned char*>(to);
  while (size > 0) {
    const ssize_t count = ::pread(as_pending(file).descriptor, bytes, size, static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return -1;
    if (count == 0) break;
    bytes += count;
    address += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  std::memset(bytes, 0, size);
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* from) {
  PendingFile& pending = as_pending(file);
  const haddr_t end = address + size;
  const auto* bytes = static_cast<const unsigned char*>(from);
  while (size > 0 && pending.status->error == 0) {
    const ssize_t count = ::pwrite(pending.descriptor, bytes, size, static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      pending.status->error = count < 0 ? errno : ENOSPC;
      break;
    }
    bytes += count;
    address += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  pending.end = std::max(pending.end, end);
  return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  PendingFile& pending = as_pending(file);
  if (pending.end == pending.allocated) return 0;
  if (pending.status->error == 0 && ::ftruncate(pending.descriptor, static_cast<off_t>(pending.allocated)) != 0)
    pending.status->error = errno;
  pending.end = pending.allocated;
  return 0;
}

H5FD_class_t make_class() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED);
#endif
  driver.name = "tegl_pending_file";
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = get_allocated;
  driver.set_eoa = set_allocated;
  driver.get_eof = get_end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kMap), std::end(kMap), driver.fl_map);
  return driver;
}

}  // namespace

bool use_pending_file_driver(hid_t access, H5WriteStatus& status) {
  static const H5FD_class_t kClass = make_class();
  const DriverInfo info{&status};
  const hid_t driver = H5FDregister(&kClass);
  if (driver < 0) return false;
  const bool done = H5Pset_driver(access, driver, &info) >= 0;
  H5FDunregister(driver);  // property lists and files keep a reference to it
  return done;
}

}  // namespace tegl::io_detail
