// SPDX-License-Identifier: BSD-3-Clause
//
// Reading and writing of HDF5 groups, attributes and datasets.
//
// Based on: The HDF Group, HDF5 1.10 C API.
#include "base/hdf5_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/common.hpp"
#include "base/hdf5_links.hpp"
#include "base/inflate.hpp"
#include "base/reading_process.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Reason = std::array<char, 256>;

/// Callback of H5Ewalk2. Exceptions must not pass through HDF5, so the text is stored in a fixed array.
herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* out) {
  // H5Ewalk2 starts at the innermost call: the first entry with a text is the reason.
  auto& reason = *static_cast<Reason*>(out);
  if (reason[0] == '\0' && error->desc != nullptr) std::strncpy(reason.data(), error->desc, reason.size() - 1);
  return 0;
}

/// The names of a group's links.
struct Names {
  std::vector<std::string> names;
  bool out_of_memory = false;
};

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* to) {
  auto& names = *static_cast<Names*>(to);
  try {
    names.names.emplace_back(name);
    return 0;
  } catch (const std::bad_alloc&) {
    names.out_of_memory = true;
    return -1;
  }
}

std::string innermost_reason() {
  Reason reason{};
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  return reason[0] == '\0' ? "no reason given" : reason.data();
}

/// Throws if the driver stored an error: it reports write errors only in `status`.
void require_written(const H5WriteStatus& status, const fs::path& path) {
  if (status.error != 0) fail(ErrorCode::WriteFailed, path, "cannot be written ({})", std::strerror(status.error));
}

/// Properties for objects to be created, without their creation time: equal contents give equal files.
H5Handle timeless(hid_t kind) {
  H5Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

}  // namespace

H5File H5File::create(const fs::path& where, const fs::path& path) {
  // The format of HDF5 1.8 has checksums for all metadata; the default, older format has none. Readers then detect
  // damage.
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

H5File H5File::open(const fs::path& path, bool allow_outside_paths) {
  const std::uint64_t bytes = check_hdf5_links(path, {}, Hdf5Reader::h5file, allow_outside_paths);
  H5Handle handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (handle.id() < 0)
    fail(ErrorCode::MalformedFile, path, "cannot be opened as HDF5 ({}); expected a whole HDF5 file",
         innermost_reason());
  H5File file(path, ErrorCode::MalformedFile, nullptr, std::move(handle));
  file.bytes_ = bytes;
  return file;
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
  const H5Handle access = checked(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, "opening a dataset");
  checked(H5Pset_efile_prefix(access.id(), "${ORIGIN}"), "opening a dataset");  // external storage beside the file
  return checked(H5Dopen2(group, name, access.id()), H5Dclose, "opening a dataset");
}

std::vector<std::string> H5File::number_datasets(hid_t group) const {
  // One pass over all links: H5Lget_name_by_idx takes linear time for each.
  Names links;
  if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &links) < 0) {
    if (links.out_of_memory) throw std::bad_alloc();
    fail(code_, path_, "listing a group failed in HDF5 ({})", innermost_reason());
  }
  std::vector<std::string> names;
  for (std::string& name : links.names) {
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
  // Fixed length and null-padded: the form that VTK expects for the grid's type.
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
  constexpr std::size_t kLongest = std::size_t{1} << 16;  // HDF5's own limit for attributes
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
                             std::uint64_t expected, Compression compression) const {
  // A chunk fits the cache that HDF5 has per dataset (1 MiB), so a partly filled chunk stays in memory.
  constexpr hsize_t kChunkBytes = hsize_t{1} << 19;
  const hsize_t most_rows = kChunkBytes / (H5Tget_size(file_type) * std::max<hsize_t>(1, columns));
  // The group stays open until the dataset is created. Two steps: nothing is lost if there is no memory for the second.
  H5Iinc_ref(group);
  H5Handle counted(group, H5Gclose);
  const auto parent = std::make_shared<const H5Handle>(std::move(counted));
  const auto create = [this, parent, text = std::string(name), file_type, columns, most_rows,
                       compression](std::uint64_t rows) {
    const int rank = columns == 0 ? 1 : 2;
    const std::array<hsize_t, 2> size = {0, columns};
    const std::array<hsize_t, 2> most = {H5S_UNLIMITED, columns};
    const std::array<hsize_t, 2> chunk = {std::clamp<hsize_t>(rows, 1, most_rows), columns};  // stored whole
    const H5Handle space = checked(H5Screate_simple(rank, size.data(), most.data()), H5Sclose, "creating a dataset");
    const H5Handle options = timeless(H5P_DATASET_CREATE);
    checked(H5Pset_chunk(options.id(), rank, chunk.data()), "creating a dataset");
    if (compression == Compression::deflate) {
      // Shuffle puts bytes of equal significance side by side: the high bytes of adjacent numbers are mostly equal.
      constexpr unsigned kLevel = 4;
      checked(H5Pset_shuffle(options.id()), "creating a dataset");
      checked(H5Pset_deflate(options.id(), kLevel), "creating a dataset");
    }
    return checked(
        H5Dcreate2(parent->id(), text.c_str(), file_type, space.id(), H5P_DEFAULT, options.id(), H5P_DEFAULT), H5Dclose,
        "creating a dataset");
  };
  H5Table table(path_, status_, create, columns, most_rows);
  if (expected != kUnknownRows) table.create(expected);
  return table;
}

void H5Table::write(hid_t memory_type, const void* values, std::span<const std::uint64_t> start,
                    std::span<const std::uint64_t> count) const {
  const std::array<hsize_t, 2> from = {start[0], start[1]};
  const std::array<hsize_t, 2> size = {count[0], count[1]};
  const H5Handle file(H5Dget_space(dataset_->id()), H5Sclose);
  const H5Handle memory(H5Screate_simple(columns_ == 0 ? 1 : 2, size.data(), nullptr), H5Sclose);
  if (file.id() < 0 || memory.id() < 0 ||
      H5Sselect_hyperslab(file.id(), H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr) < 0 ||
      H5Dwrite(dataset_->id(), memory_type, memory.id(), file.id(), H5P_DEFAULT, values) < 0)
    fail(ErrorCode::WriteFailed, path_, "writing a dataset failed in HDF5 ({})", innermost_reason());
  require_written(*status_, path_);
}

void H5Table::append(hid_t memory_type, const void* values, std::uint64_t rows) {
  if (rows == 0) return;
  if (!dataset_ && rows_ + rows < rows_of_chunk_ && (kept_.empty() || H5Tequal(kept_type_, memory_type) > 0)) {
    const auto* const bytes = static_cast<const unsigned char*>(values);
    kept_type_ = memory_type;
    kept_.insert(kept_.end(), bytes, bytes + rows * std::max<std::uint64_t>(1, columns_) * H5Tget_size(memory_type));
    rows_ += rows;
    return;
  }
  if (!dataset_) create(rows_of_chunk_);
  extend(rows_ + rows);
  write(memory_type, values, std::array{rows_, std::uint64_t{0}}, std::array{rows, columns_});
  rows_ += rows;
}

void H5Table::extend(std::uint64_t rows) const {
  const std::array<hsize_t, 2> size = {rows, columns_};
  if (H5Dset_extent(dataset_->id(), size.data()) < 0)
    fail(ErrorCode::WriteFailed, path_, "growing a dataset failed in HDF5 ({})", innermost_reason());
}

void H5Table::create(std::uint64_t rows) {
  dataset_.emplace(create_(rows));
  create_ = nullptr;
  if (rows_ == 0) return;
  extend(rows_);
  write(kept_type_, kept_.data(), std::array{std::uint64_t{0}, std::uint64_t{0}}, std::array{rows_, columns_});
  kept_ = {};
}

void H5Table::complete() {
  if (!dataset_) create(rows_);
}

void H5Table::replace(hid_t memory_type, const void* value, std::uint64_t row, std::uint64_t column) {
  if (!dataset_ && H5Tequal(kept_type_, memory_type) > 0) {
    const std::size_t size = H5Tget_size(memory_type);
    std::memcpy(kept_.data() + (row * std::max<std::uint64_t>(1, columns_) + column) * size, value, size);
    return;
  }
  if (!dataset_) create(rows_of_chunk_);
  write(memory_type, value, std::array{row, column}, std::array{std::uint64_t{1}, std::uint64_t{1}});
}

int H5File::rank(hid_t group, const char* name) const {
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  return H5Sget_simple_extent_ndims(space.id());
}

std::uint64_t most_expansion_by(H5Z_filter_t filter) {
  if (filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32) return 1;
  return filter == H5Z_FILTER_DEFLATE ? kMostInflation : kMostExpansion;
}

namespace {

/// Sizes and storage of a dataset.
struct Stored {
  std::vector<std::uint64_t> sizes;
  std::uint64_t bytes = 0;        ///< size of all values with the file's type
  std::uint64_t stored = 0;       ///< bytes of them in the file
  std::uint64_t ratio = 1;        ///< maximum expansion ratio of the filters
  std::uint64_t chunk_bytes = 0;  ///< size of a compressed chunk when decompressed; 0: none
  bool is_virtual = false;        ///< a view of other datasets
};

/// Maximum expansion ratio of the filters of a dataset.
std::uint64_t most_expansion(hid_t properties) {
  std::uint64_t ratio = 1;
  for (int i = 0; i < H5Pget_nfilters(properties); ++i) {
    std::size_t parameters = 0;
    ratio = std::max(ratio, most_expansion_by(H5Pget_filter2(properties, static_cast<unsigned>(i), nullptr, &parameters,
                                                             nullptr, 0, nullptr, nullptr)));
  }
  return ratio;
}

/// Size of a chunk in bytes; 0 if its sizes are damaged.
std::uint64_t bytes_of_chunk(hid_t properties, std::size_t rank, std::uint64_t item, const fs::path& path) {
  std::array<hsize_t, 2> chunk{};
  if (H5Pget_chunk(properties, static_cast<int>(rank), chunk.data()) != static_cast<int>(rank)) return 0;
  return checked_bytes(std::vector<std::uint64_t>(chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(rank)),
                       item, path);
}

void require_stored(const Stored& dataset, const char* name, const fs::path& path) {
  // Partly stored datasets would read as zeros for the rest; meshes are always written completely.
  if (dataset.bytes / dataset.ratio > dataset.stored)
    fail(ErrorCode::MalformedFile, path,
         "dataset '{}' of {} values takes {} bytes, of which the file stores {}; expected {} or more", name,
         shape_text(dataset.sizes), dataset.bytes, dataset.stored, dataset.bytes / dataset.ratio);
  if (is_chunk_too_large(dataset.chunk_bytes, dataset.bytes))
    fail(ErrorCode::MalformedFile, path, "dataset '{}' of {} bytes in compressed chunks of {}; expected at most {}",
         name, dataset.bytes, dataset.chunk_bytes, std::max(kMostChunkBytes, 2 * dataset.bytes));
}

/// `all_bytes`: size of the file and those that it refers to.
Stored stored_of(hid_t dataset, const std::array<hsize_t, 2>& size, std::size_t rank, std::uint64_t all_bytes,
                 const char* name, const fs::path& path) {
  Stored result;
  result.sizes.assign(size.begin(), size.begin() + static_cast<std::ptrdiff_t>(rank));
  const H5Handle type(H5Dget_type(dataset), H5Tclose);
  const H5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const std::uint64_t item = type.id() < 0 ? 0 : H5Tget_size(type.id());
  constexpr std::uint64_t kLargestNumber = 16;
  if (properties.id() < 0 || item < 1 || item > kLargestNumber)
    fail(ErrorCode::MalformedFile, path, "dataset '{}' of values of {} bytes; expected numbers of 1 to {}", name, item,
         kLargestNumber);
  result.bytes = checked_bytes(result.sizes, item, path);
  result.stored = H5Dget_storage_size(dataset);
  const H5D_layout_t layout = H5Pget_layout(properties.id());
  if (layout == H5D_CHUNKED) {
    result.ratio = most_expansion(properties.id());
    const std::uint64_t chunk = bytes_of_chunk(properties.id(), rank, item, path);
    if (chunk == 0)
      fail(ErrorCode::MalformedFile, path, "dataset '{}' in chunks of size 0 or of other dimensions; expected {}", name,
           rank);
    if (H5Pget_nfilters(properties.id()) > 0) result.chunk_bytes = chunk;
  } else if (layout == H5D_VIRTUAL) {
    result.is_virtual = true;
    result.stored = all_bytes;
    result.ratio = kMostExpansion;  // source datasets may be compressed
  }
  result.stored = std::min(result.stored, all_bytes);
  return result;
}

}  // namespace

std::vector<std::uint64_t> H5File::sizes(hid_t group, const char* name) const { return stored(group, name).sizes; }

std::vector<std::uint64_t> H5File::claim(hid_t group, const char* name) {
  const StoredSizes it = stored(group, name);
  claimed_.bytes += it.bytes;
  claimed_.stored += it.stored;
  if (claimed_.stored > bytes_ || claimed_.bytes / kMostExpansion > bytes_)
    fail(
        code_, path_,
        "dataset '{}' and those read before it take {} bytes, of which the file stores {}; expected at most {} and {}, "
        "for a file of {} bytes",
        name, claimed_.bytes, claimed_.stored, kMostExpansion * bytes_, bytes_, bytes_);
  return it.sizes;
}

H5File::StoredSizes H5File::stored(hid_t group, const char* name) const {
  if (!has(group, name)) fail(code_, path_, "no dataset '{}'; expected it", name);
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 1 || rank > 2) fail(code_, path_, "dataset '{}' of {} dimensions; expected 1 or 2", name, rank);
  std::array<hsize_t, 2> size{};
  checked(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), "opening a dataset");
  const Stored found = stored_of(dataset.id(), size, static_cast<std::size_t>(rank), bytes_, name, path_);
  require_stored(found, name, path_);
  return {found.sizes, found.bytes, found.is_virtual ? 0 : found.stored};
}

void H5File::read(hid_t group, const char* name, hid_t memory_type, void* to,
                  const std::function<void(std::uint64_t)>& done) const {
  const std::vector<std::uint64_t> size = sizes(group, name);
  const H5Handle dataset = open_dataset(group, name);
  const H5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "opening a dataset");
  const auto rank = static_cast<int>(size.size());
  const std::uint64_t row_bytes =
      checked_bytes(std::array{rank == 2 ? std::max<std::uint64_t>(1, size[1]) : 1}, H5Tget_size(memory_type), path_);
  // Reads whole chunks, because each partial read of a chunk decompresses it again.
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
