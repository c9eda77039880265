// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 handles, attributes and datasets.
//
// Based on: The HDF Group, HDF5 1.10 C API.
#include "hdf5_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "common.hpp"
#include "reading_process.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Reason = std::array<char, 256>;

/// Nothing may be thrown through HDF5, so what is kept has room beforehand.
herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* out) {
  // The walk starts at the innermost call: the first entry with a text is the reason.
  auto& reason = *static_cast<Reason*>(out);
  if (reason[0] == '\0' && error->desc != nullptr) std::strncpy(reason.data(), error->desc, reason.size() - 1);
  return 0;
}

std::string innermost_reason() {
  Reason reason{};
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  return reason[0] == '\0' ? "no reason given" : reason.data();
}

/// The driver takes what it cannot write without complaint.
void require_written(const H5WriteStatus& status, const fs::path& path) {
  if (status.error != 0) fail(ErrorCode::WriteFailed, path, "cannot be written ({})", std::strerror(status.error));
}

/// Properties of something to be created. Without the time of its creation: equal contents make equal files.
H5Handle timeless(hid_t kind) {
  H5Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

}  // namespace

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

H5File H5File::create(const fs::path& where, const fs::path& path) {
  // The format of HDF5 1.8 has checksums on all metadata, which the default, older one has not: readers then notice
  // damage instead of following it.
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  auto status = std::make_shared<H5WriteStatus>();
  if (!use_pending_file_driver(access.id(), *status))
    fail(ErrorCode::WriteFailed, path, "cannot be created ({})", innermost_reason());
  const H5Handle root = timeless(H5P_FILE_CREATE);
  H5Handle handle(H5Fcreate(where.c_str(), H5F_ACC_TRUNC, root.id(), access.id()), H5Fclose);
  if (handle.id() < 0)
    fail(ErrorCode::WriteFailed, path, "cannot be created ({})",
         status->error != 0 ? std::strerror(status->error) : innermost_reason());
  return {path, ErrorCode::WriteFailed, std::move(status), std::move(handle)};
}

H5File H5File::open(const fs::path& path) {
  H5Handle handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (handle.id() < 0)
    fail(ErrorCode::MalformedFile, path, "cannot be opened as HDF5 ({}); expected a whole HDF5 file",
         innermost_reason());
  return {path, ErrorCode::MalformedFile, nullptr, std::move(handle)};
}

H5Handle H5File::checked(hid_t id, H5Handle::Closer closer, const char* what) const {
  if (id < 0) fail(code_, path_, "{} failed in HDF5 ({})", what, innermost_reason());
  return {id, closer};
}

void H5File::checked(herr_t status, const char* what) const {
  if (status < 0) fail(code_, path_, "{} failed in HDF5 ({})", what, innermost_reason());
}

void H5File::close() {
  checked(H5Fflush(file_.id(), H5F_SCOPE_LOCAL), "writing");
  if (!file_.close()) fail(code_, path_, "closing failed in HDF5 ({})", innermost_reason());
  if (status_) require_written(*status_, path_);
}

H5Handle H5File::create_group(const char* name) const {
  const H5Handle options = timeless(H5P_GROUP_CREATE);
  return checked(H5Gcreate2(file_.id(), name, H5P_DEFAULT, options.id(), H5P_DEFAULT), H5Gclose, "creating a group");
}

H5Handle H5File::open_group(const char* name) const {
  return checked(H5Gopen2(file_.id(), name, H5P_DEFAULT), H5Gclose, "opening a group");
}

bool H5File::has(hid_t group, const char* name) const {
  return H5Lexists(group, name, H5P_DEFAULT) > 0 && H5Oexists_by_name(group, name, H5P_DEFAULT) > 0;
}

H5Handle H5File::open_dataset(hid_t group, const char* name) const {
  return checked(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, "opening a dataset");
}

std::vector<std::string> H5File::number_datasets(hid_t group) const {
  H5G_info_t info{};
  checked(H5Gget_info(group, &info), "listing a group");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_of = [&](char* to, std::size_t size) {
      return H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, to, size, H5P_DEFAULT);
    };
    const ssize_t length = name_of(nullptr, 0);
    constexpr ssize_t kLongest = 1 << 16;
    if (length < 0 || length > kLongest) fail(code_, path_, "listing a group failed in HDF5 ({})", innermost_reason());
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    name_of(name.data(), name.size());
    name.pop_back();
    if (!has(group, name.c_str())) continue;
    const H5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (object.id() < 0 || H5Iget_type(object.id()) != H5I_DATASET) continue;
    const H5Handle type(H5Dget_type(object.id()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind == H5T_INTEGER || kind == H5T_FLOAT) names.push_back(std::move(name));
  }
  return names;
}

void H5File::put_text(hid_t object, const char* name, const std::string& text) const {
  // Fixed length and null-padded: what VTK compares the grid's type with.
  const H5Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose, "writing an attribute");
  checked(H5Tset_size(type.id(), std::max<std::size_t>(1, text.size())), "writing an attribute");
  checked(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), "writing an attribute");
  const H5Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, "writing an attribute");
  const H5Handle attribute = checked(H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                                     H5Aclose, "writing an attribute");
  checked(H5Awrite(attribute.id(), type.id(), text.c_str()), "writing an attribute");
}

void H5File::put_numbers(hid_t object, const char* name, std::span<const std::int64_t> numbers) const {
  const hsize_t size = numbers.size();
  const H5Handle space = checked(H5Screate_simple(1, &size, nullptr), H5Sclose, "writing an attribute");
  const H5Handle attribute = checked(H5Acreate2(object, name, H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                                     H5Aclose, "writing an attribute");
  checked(H5Awrite(attribute.id(), H5T_NATIVE_INT64, numbers.data()), "writing an attribute");
}

std::string H5File::get_text(hid_t object, const char* name) const {
  if (H5Aexists(object, name) <= 0) return {};
  const H5Handle attribute = checked(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, "reading an attribute");
  const H5Handle type = checked(H5Aget_type(attribute.id()), H5Tclose, "reading an attribute");
  if (H5Tget_class(type.id()) != H5T_STRING) return {};
  const H5Handle space = checked(H5Aget_space(attribute.id()), H5Sclose, "reading an attribute");
  if (H5Sget_simple_extent_npoints(space.id()) != 1) return {};
  if (H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    checked(H5Aread(attribute.id(), type.id(), static_cast<void*>(&text)), "reading an attribute");
    const std::string result = text == nullptr ? "" : text;
    H5free_memory(text);
    return result;
  }
  constexpr std::size_t kLongest = std::size_t{1} << 16;  // HDF5's own limit of an attribute
  const std::size_t size = H5Tget_size(type.id());
  if (size > kLongest) fail(code_, path_, "attribute '{}' of {} bytes; expected at most {}", name, size, kLongest);
  std::string text(size, '\0');
  checked(H5Aread(attribute.id(), type.id(), text.data()), "reading an attribute");
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

std::vector<std::int64_t> H5File::get_numbers(hid_t object, const char* name) const {
  if (H5Aexists(object, name) <= 0) return {};
  const H5Handle attribute = checked(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, "reading an attribute");
  const H5Handle type = checked(H5Aget_type(attribute.id()), H5Tclose, "reading an attribute");
  const H5Handle space = checked(H5Aget_space(attribute.id()), H5Sclose, "reading an attribute");
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  constexpr hssize_t kMost = 1024;
  if (H5Tget_class(type.id()) != H5T_INTEGER || count < 0 || count > kMost) return {};
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  checked(H5Aread(attribute.id(), H5T_NATIVE_INT64, numbers.data()), "reading an attribute");
  return numbers;
}

H5Table H5File::create_table(hid_t group, const char* name, hid_t file_type, std::uint64_t columns,
                             std::uint64_t expected) const {
  const int rank = columns == 0 ? 1 : 2;
  // A chunk fits the cache that HDF5 keeps per dataset (1 MiB), so that a partly filled one stays in memory.
  constexpr hsize_t kChunkBytes = hsize_t{1} << 19;
  const std::array<hsize_t, 2> size = {0, columns};
  const std::array<hsize_t, 2> most = {H5S_UNLIMITED, columns};
  const hsize_t most_rows = kChunkBytes / (H5Tget_size(file_type) * std::max<hsize_t>(1, columns));
  const std::array<hsize_t, 2> chunk = {std::clamp<hsize_t>(expected, 1, most_rows), columns};  // stored whole
  const H5Handle space = checked(H5Screate_simple(rank, size.data(), most.data()), H5Sclose, "creating a dataset");
  const H5Handle options = timeless(H5P_DATASET_CREATE);
  checked(H5Pset_chunk(options.id(), rank, chunk.data()), "creating a dataset");
  return {path_, status_,
          checked(H5Dcreate2(group, name, file_type, space.id(), H5P_DEFAULT, options.id(), H5P_DEFAULT), H5Dclose,
                  "creating a dataset"),
          columns};
}

void H5Table::write(hid_t memory_type, const void* values, std::span<const std::uint64_t> start,
                    std::span<const std::uint64_t> count) const {
  const std::array<hsize_t, 2> from = {start[0], start[1]};
  const std::array<hsize_t, 2> size = {count[0], count[1]};
  const H5Handle file(H5Dget_space(dataset_.id()), H5Sclose);
  const H5Handle memory(H5Screate_simple(columns_ == 0 ? 1 : 2, size.data(), nullptr), H5Sclose);
  if (file.id() < 0 || memory.id() < 0 ||
      H5Sselect_hyperslab(file.id(), H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr) < 0 ||
      H5Dwrite(dataset_.id(), memory_type, memory.id(), file.id(), H5P_DEFAULT, values) < 0)
    fail(ErrorCode::WriteFailed, path_, "writing a dataset failed in HDF5 ({})", innermost_reason());
  require_written(*status_, path_);
}

void H5Table::append(hid_t memory_type, const void* values, std::uint64_t rows) {
  if (rows == 0) return;
  const std::array<hsize_t, 2> size = {rows_ + rows, columns_};
  if (H5Dset_extent(dataset_.id(), size.data()) < 0)
    fail(ErrorCode::WriteFailed, path_, "growing a dataset failed in HDF5 ({})", innermost_reason());
  write(memory_type, values, std::array{rows_, std::uint64_t{0}}, std::array{rows, columns_});
  rows_ += rows;
}

void H5Table::replace(hid_t memory_type, const void* value, std::uint64_t row, std::uint64_t column) {
  write(memory_type, value, std::array{row, column}, std::array{std::uint64_t{1}, std::uint64_t{1}});
}

int H5File::rank(hid_t group, const char* name) const {
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  return H5Sget_simple_extent_ndims(space.id());
}

std::vector<std::uint64_t> H5File::sizes(hid_t group, const char* name) const {
  if (!has(group, name)) fail(code_, path_, "no dataset '{}'; expected it", name);
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 1 || rank > 2) fail(code_, path_, "dataset '{}' of {} dimensions; expected 1 or 2", name, rank);
  std::array<hsize_t, 2> size{};
  checked(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), "opening a dataset");
  const std::vector<std::uint64_t> result(size.begin(), size.begin() + rank);
  // Compressed data may be larger than the file, but by no more than the filters can do.
  constexpr std::uint64_t kBestRatio = 4096;
  if (checked_bytes(result, 1, path_) / kBestRatio > size_of_file(path_))
    fail(code_, path_, "dataset '{}' of {} values in a file of {} bytes", name, shape_text(result),
         size_of_file(path_));
  return result;
}

void H5File::read(hid_t group, const char* name, hid_t memory_type, void* to,
                  const std::function<void(std::uint64_t)>& done) const {
  const std::vector<std::uint64_t> size = sizes(group, name);
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  const auto rank = static_cast<int>(size.size());
  const std::uint64_t row_bytes = H5Tget_size(memory_type) * (rank == 2 ? std::max<std::uint64_t>(1, size[1]) : 1);
  // Whole chunks: a part of one would be inflated anew for each part.
  const H5Handle layout = checked(H5Dget_create_plist(dataset.id()), H5Pclose, "opening a dataset");
  std::array<hsize_t, 2> chunk{1, 1};
  if (H5Pget_layout(layout.id()) == H5D_CHUNKED)
    checked(H5Pget_chunk(layout.id(), rank, chunk.data()), "opening a dataset");
  constexpr std::uint64_t kBytesAtOnce = std::uint64_t{1} << 22;
  const std::uint64_t most = (kBytesAtOnce / row_bytes / chunk[0] + 1) * chunk[0];
  for (std::uint64_t first = 0; first < size[0]; first += most) {
    const std::array<hsize_t, 2> from{first, 0};
    const std::array<hsize_t, 2> rows{std::min(most, size[0] - first), rank == 2 ? size[1] : 1};
    expect_step(rows[0] * row_bytes);
    const H5Handle room = checked(H5Screate_simple(rank, rows.data(), nullptr), H5Sclose, "reading a dataset");
    checked(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, from.data(), nullptr, rows.data(), nullptr),
            "reading a dataset");
    checked(H5Dread(dataset.id(), memory_type, room.id(), space.id(), H5P_DEFAULT,
                    static_cast<std::byte*>(to) + first * row_bytes),
            "reading a dataset");
    if (done) done(rows[0] * row_bytes);
  }
}

}  // namespace tegl::io_detail
