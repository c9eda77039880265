// SPDX-License-Identifier: BSD-3-Clause
//
// Wraps the netCDF-C library.
//
// Based on: Unidata, netCDF-C 4.9 API.
#include "images/netcdf_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <netcdf_filter.h>
#include <netcdf_mem.h>

#include "base/common.hpp"
#include "base/hdf5_file.hpp"
#include "base/hdf5_links.hpp"
#include "base/inflate.hpp"
#include "base/reading_process.hpp"
#include "images/cdf_header.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::array<unsigned char, 8> kHdf5Magic = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

bool is_hdf5(std::span<const unsigned char> prefix) {
  return prefix.size() >= kHdf5Magic.size() && std::equal(kHdf5Magic.begin(), kHdf5Magic.end(), prefix.begin());
}

/// Size of an HDF5 file in bytes, from its superblock; 0 if that is not in the first bytes.
///
/// Based on: The HDF Group, "HDF5 File Format Specification", section II.A.
std::uint64_t bytes_of_hdf5(std::span<const unsigned char> bytes, const fs::path& path) {
  constexpr std::size_t kVersion = 8;
  if (bytes.size() < 96) return 0;
  const unsigned version = bytes[kVersion];
  // Addresses in the superblock: base, free space or extension, end. The third one is the end of the file.
  const std::size_t item = bytes[version < 2 ? 13 : 9];
  const std::size_t first = version == 0 ? 24 : version == 1 ? 28 : 12;
  if (version > 3 || (item != 2 && item != 4 && item != 8))
    fail(ErrorCode::MalformedFile, path,
         "HDF5 superblock of version {} with addresses of {} bytes; expected version 0 to 3 and 2, 4 or 8 bytes",
         version, item);
  std::uint64_t end = 0;
  for (std::size_t i = item; i-- > 0;) end = end << 8 | bytes[first + 2 * item + i];
  const std::uint64_t most = size_of_file(path) * kMostInflation;
  if (end == 0 || end > most)
    fail(ErrorCode::MalformedFile, path, "HDF5 file of {} bytes by its superblock; expected 1 to {} from {} compressed",
         end, most, size_of_file(path));
  return end;
}

/// Decompresses a gzipped netCDF file up to the end of its header and variables.
std::vector<unsigned char> inflate_netcdf(const fs::path& path, const Progress& progress) {
  const std::uint64_t most = size_of_file(path) * kMostInflation;
  const auto needed = [&](std::span<const unsigned char> bytes) -> std::uint64_t {
    if (is_classic_netcdf(bytes)) return bytes_of_classic_netcdf(bytes, most, path);
    if (is_hdf5(bytes)) return bytes_of_hdf5(bytes, path);
    return bytes.size();
  };
  std::vector<unsigned char> content = inflate_to_memory(path, needed, progress);
  if (!is_classic_netcdf(content)) return content;
  bytes_of_classic_netcdf(content, content.size(), path);
  // The library reads headers in blocks, and reports an error if the memory ends within a block.
  content.resize(content.size() + kInflateSpare);
  return content;
}

/// Reads a name that `get` writes to a buffer of unknown size: netCDF promises at most NC_MAX_NAME bytes, but copies
/// longer names of damaged files.
template <class Get>
std::pair<int, std::string> name_from(const Get& get) {
  constexpr std::size_t kRoom = std::size_t{1} << 16;  // the longest name in HDF5's old format
  const auto buffer = std::make_unique_for_overwrite<char[]>(kRoom + 1);
  buffer[0] = buffer[kRoom] = '\0';
  const int status = get(buffer.get());
  buffer[kRoom] = '\0';
  return {status, buffer.get()};
}

/// An empty array of a netCDF type.
ValueArray array_for(nc_type type, bool as_unsigned) {
  switch (type) {
    case NC_BYTE:
      if (as_unsigned) return ValueVector<std::uint8_t>();
      return ValueVector<std::int8_t>();
    case NC_UBYTE:
      return ValueVector<std::uint8_t>();
    case NC_SHORT:
      if (as_unsigned) return ValueVector<std::uint16_t>();
      return ValueVector<std::int16_t>();
    case NC_USHORT:
      return ValueVector<std::uint16_t>();
    case NC_INT:
      if (as_unsigned) return ValueVector<std::uint32_t>();
      return ValueVector<std::int32_t>();
    case NC_UINT:
      return ValueVector<std::uint32_t>();
    case NC_INT64:
      return ValueVector<std::int64_t>();
    case NC_UINT64:
      return ValueVector<std::uint64_t>();
    case NC_FLOAT:
      return ValueVector<float>();
    default:
      return ValueVector<double>();
  }
}

}  // namespace

const char* nc_type_name(nc_type type) noexcept {
  constexpr std::array<const char*, 13> kNames = {"none",  "int8",   "char",   "int16", "int32",  "float", "double",
                                                  "uint8", "uint16", "uint32", "int64", "uint64", "string"};
  return type >= 0 && type < static_cast<nc_type>(kNames.size()) ? kNames[static_cast<std::size_t>(type)]
                                                                 : "user-defined";
}

bool is_numeric(nc_type type) noexcept { return type >= NC_BYTE && type <= NC_UINT64 && type != NC_CHAR; }

NcFile::NcFile(const fs::path& path, const Progress& progress, bool allow_outside_paths) : path_(path) {
  now_reading(path);
  // check the file before the library opens it
  if (is_gzip(path)) content_ = inflate_netcdf(path, progress);
  const std::vector<unsigned char> start = content_.empty() ? read_bytes(path, 0, 8) : std::vector<unsigned char>();
  const auto all = std::span<const unsigned char>(content_.empty() ? start : content_);
  const auto prefix = all.first(std::min<std::size_t>(all.size(), 8));
  if (is_classic_netcdf(prefix)) {
    if (content_.empty()) begins_ = check_classic_netcdf(path);
  } else if (!is_hdf5(prefix)) {
    fail(ErrorCode::MalformedFile, path, "starts with {}; expected netCDF: 'CDF' and 1, 2 or 5, or '\\x89HDF'",
         shown(prefix));
  }
  bytes_ = is_hdf5(prefix)    ? check_hdf5_links(path, content_, Hdf5Reader::netcdf, allow_outside_paths)
           : content_.empty() ? size_of_file(path)
                              : content_.size();
  // The library reads classic files through a buffer of this size, by default 4 KiB, with a call to the system for
  // each. A larger one would read too much for a time of each record.
  std::size_t buffer = std::size_t{1} << 16;
  // An absolute path is never taken for a server's URL.
  const int status = content_.empty()
                         ? nc__open(fs::absolute(path).c_str(), NC_NOWRITE, &buffer, &id_)
                         : nc_open_mem(path.filename().c_str(), NC_NOWRITE, content_.size(), content_.data(), &id_);
  check(status, "opening it");
}

NcFile::~NcFile() {
  if (id_ >= 0) nc_close(id_);
}

void NcFile::check(int status, const std::string& what) const {
  if (status != NC_NOERR)
    fail(ErrorCode::MalformedFile, path_,
         "{} failed in the netCDF library ({}); expected a whole, undamaged netCDF file", what, nc_strerror(status));
}

NcVariable NcFile::describe(int group, int id, const std::string& prefix) const {
  NcVariable variable{group, id, "", NC_NAT, {}, {}};
  int rank = 0;
  const auto [status, name] =
      name_from([&](char* to) { return nc_inq_var(group, id, to, &variable.type, &rank, nullptr, nullptr); });
  check(status, "reading a variable's name");
  variable.name = prefix + name;
  variable.dimensions.resize(static_cast<std::size_t>(rank));
  check(nc_inq_vardimid(group, id, variable.dimensions.data()), "reading the dimensions of " + variable.name);
  for (const int dimension : variable.dimensions) {
    std::size_t size = 0;
    check(nc_inq_dimlen(group, dimension, &size), "reading the dimensions of " + variable.name);
    variable.sizes.push_back(size);
  }
  return variable;
}

void NcFile::collect(int group, const std::string& prefix, int depth, std::vector<NcVariable>& out) const {
  int count = 0;
  check(nc_inq_nvars(group, &count), "listing the variables");
  std::vector<int> ids(static_cast<std::size_t>(count));
  check(nc_inq_varids(group, &count, ids.data()), "listing the variables");
  for (const int id : ids) out.push_back(describe(group, id, prefix));
  check(nc_inq_grps(group, &count, nullptr), "listing the groups");
  std::vector<int> groups(static_cast<std::size_t>(count));
  check(nc_inq_grps(group, &count, groups.data()), "listing the groups");
  constexpr int kDeepest = 32;
  if (depth > kDeepest) fail(ErrorCode::MalformedFile, path_, "groups nested deeper than {}", kDeepest);
  for (const int child : groups) {
    const auto [status, name] = name_from([&](char* to) { return nc_inq_grpname(child, to); });
    check(status, "reading a group's name");
    if (depth == 0 && name == "VTKHDF")
      fail(ErrorCode::UnsupportedData, path_, "holds a mesh (VTKHDF), such as a saved contour; expected an image");
    collect(child, (prefix.empty() ? "/" : prefix) + name + "/", depth + 1, out);
  }
}

std::vector<NcVariable> NcFile::variables() const {
  std::vector<NcVariable> result;
  collect(id_, "", 0, result);
  return result;
}

std::string NcFile::dimension_name(const NcVariable& variable, std::size_t dimension) const {
  const auto [status, name] =
      name_from([&](char* to) { return nc_inq_dimname(variable.group, variable.dimensions[dimension], to); });
  check(status, "reading a dimension's name");
  return name;
}

std::optional<NcVariable> NcFile::coordinate(const NcVariable& variable, std::size_t dimension) const {
  const std::string name = dimension_name(variable, dimension);
  for (int group = variable.group;;) {
    int id = 0;
    if (nc_inq_varid(group, name.c_str(), &id) == NC_NOERR) {
      NcVariable found = describe(group, id, "");
      const bool fits = found.dimensions.size() == 1 && found.dimensions[0] == variable.dimensions[dimension];
      if (fits && is_numeric(found.type)) return found;
    }
    if (nc_inq_grp_parent(group, &group) != NC_NOERR) return std::nullopt;
  }
}

std::string NcFile::text(const NcVariable& variable, const char* attribute) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(variable.group, variable.id, attribute, &type, &length) != NC_NOERR || length == 0) return {};
  if (type == NC_CHAR) {
    std::string value(length, '\0');
    check(nc_get_att_text(variable.group, variable.id, attribute, value.data()), "reading an attribute");
    return std::string(trim(value.c_str()));
  }
  if (type != NC_STRING) return {};
  std::vector<char*> strings(length, nullptr);
  check(nc_get_att_string(variable.group, variable.id, attribute, strings.data()), "reading an attribute");
  std::string value = strings[0] == nullptr ? "" : strings[0];
  nc_free_string(length, strings.data());
  return std::string(trim(value));
}

std::vector<double> NcFile::numbers(const NcVariable& variable, const char* attribute) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(variable.group, variable.id, attribute, &type, &length) != NC_NOERR || !is_numeric(type)) return {};
  std::vector<double> values(length);
  if (length > 0)
    check(nc_get_att_double(variable.group, variable.id, attribute, values.data()),
          "reading the attribute " + std::string(attribute));
  return values;
}

std::optional<double> NcFile::number(const NcVariable& variable, const char* attribute) const {
  const auto values = numbers(variable, attribute);
  if (values.empty()) return std::nullopt;
  return values[0];
}

bool NcFile::is_one_piece(const NcVariable& variable, const NcSlab& slab) const {
  const auto id = static_cast<std::size_t>(variable.id);
  if (id >= begins_.size() || !begins_[id]) return false;
  // More than one index of a dimension only with all indices of the faster ones.
  bool any = false;
  for (std::size_t d = 0; d < slab.count.size(); ++d) {
    if (any && slab.count[d] != variable.sizes[d]) return false;
    any = any || slab.count[d] > 1;
  }
  return true;
}

ValueArray NcFile::read_piece(const NcVariable& variable, const NcSlab& slab, const ValueArray& type,
                              const Progress& progress, const SampleReader::OnBlock& on_block) const {
  StoredSamples samples;
  samples.path = path_;
  samples.offset = *begins_[static_cast<std::size_t>(variable.id)];
  samples.type = type_name(type);
  samples.swapped = std::endian::native == std::endian::little;
  samples.sizes.assign(variable.sizes.rbegin(), variable.sizes.rend());
  std::uint64_t first = 0;
  std::uint64_t count = 1;
  for (std::size_t d = 0; d < slab.count.size(); ++d) {
    first = first * variable.sizes[d] + slab.start[d];
    count *= slab.count[d];
  }
  return SampleReader(std::move(samples)).read(first, count, progress, on_block);
}

void NcFile::read_blocks(const NcVariable& variable, const NcSlab& slab, std::size_t item, void* to,
                         const Progress& progress) const {
  const std::size_t rank = slab.count.size();
  if (rank == 0) return check(nc_get_var(variable.group, variable.id, to), "reading " + variable.name);
  // Reads blocks along the slowest dimension with more than one sample: such blocks are contiguous in memory.
  std::size_t along = 0;
  while (along + 1 < rank && slab.count[along] == 1) ++along;
  std::size_t layer_bytes = item;
  std::size_t layer_chunks = 1;
  for (std::size_t d = along + 1; d < rank; ++d) {
    layer_bytes *= slab.count[d];
    layer_chunks *= slab.count[d] / block_length(variable, d) + 1;
  }
  // Blocks consist of whole chunks, so no chunk is decompressed twice. HDF5 takes some 3 KiB for each chunk of a block.
  constexpr std::size_t kBlockBytes = std::size_t{1} << 24;
  constexpr std::size_t kBlockChunks = std::size_t{1} << 12;
  const std::size_t block = block_length(variable, along);
  std::size_t step = std::min(kBlockBytes / std::max<std::size_t>(1, layer_bytes), kBlockChunks / layer_chunks * block);
  step = std::max<std::size_t>(1, (step + block - 1) / block) * block;
  // read
  NcSlab part = slab;
  const std::size_t layers = slab.count[along];
  for (std::size_t first = 0; first < layers; first += step) {
    tick(progress, static_cast<double>(first) / static_cast<double>(layers), path_);
    part.start[along] = slab.start[along] + first;
    part.count[along] = std::min(step, layers - first);
    expect_step(part.count[along] * layer_bytes);
    check(nc_get_vara(variable.group, variable.id, part.start.data(), part.count.data(),
                      static_cast<unsigned char*>(to) + first * layer_bytes),
          "reading " + variable.name);
  }
}

std::size_t NcFile::block_length(const NcVariable& variable, std::size_t dimension) const {
  int storage = NC_CONTIGUOUS;
  std::vector<std::size_t> chunks(variable.sizes.size(), 1);
  const bool chunked =
      nc_inq_var_chunking(variable.group, variable.id, &storage, chunks.data()) == NC_NOERR && storage == NC_CHUNKED;
  return chunked ? std::max<std::size_t>(1, chunks[dimension]) : 1;
}

std::uint64_t NcFile::chunk_bytes(const NcVariable& variable, std::size_t item) const {
  std::uint64_t bytes = item;
  for (std::size_t d = 0; d < variable.sizes.size(); ++d)
    bytes *= std::min(variable.sizes[d], block_length(variable, d));
  return bytes;
}

ValueArray NcFile::numeric_array(const NcVariable& variable) const {
  if (!is_numeric(variable.type))
    fail(ErrorCode::UnsupportedData, path_, "variable '{}' holds {} values; expected numbers", variable.name,
         nc_type_name(variable.type));
  return array_for(variable.type, lower(text(variable, "_Unsigned")) == "true");
}

namespace {

/// Maximum expansion ratio of a variable's storage.
std::uint64_t most_expansion(const NcVariable& variable) {
  std::uint64_t ratio = kMostInflation;
  std::size_t count = 0;
  if (nc_inq_var_filter_ids(variable.group, variable.id, &count, nullptr) != NC_NOERR || count == 0) return ratio;
  std::vector<unsigned> filters(count);
  nc_inq_var_filter_ids(variable.group, variable.id, &count, filters.data());
  for (const unsigned filter : filters) ratio = std::max(ratio, most_expansion_by(static_cast<H5Z_filter_t>(filter)));
  return ratio;
}

}  // namespace

void NcFile::require_stored(const NcVariable& variable, std::span<const std::uint64_t> sizes, std::size_t item) const {
  const std::uint64_t bytes = checked_bytes(sizes, item, path_);
  // A larger size means a damaged header.
  const std::uint64_t ratio = most_expansion(variable);
  if (bytes / ratio > bytes_)
    fail(ErrorCode::MalformedFile, path_,
         "variable '{}' of {} samples takes {} bytes in a file of {}; expected at most {} times as many", variable.name,
         shape_text(sizes), bytes, bytes_, ratio);
  // A chunk is always decompressed as a whole.
  int storage = NC_CONTIGUOUS;
  std::vector<std::size_t> chunks(std::max<std::size_t>(1, variable.sizes.size()), 1);
  if (nc_inq_var_chunking(variable.group, variable.id, &storage, chunks.data()) != NC_NOERR || storage != NC_CHUNKED)
    return;
  const std::uint64_t of_chunk = checked_bytes(std::vector<std::uint64_t>(chunks.begin(), chunks.end()), item, path_);
  const std::vector<std::uint64_t> all(variable.sizes.begin(), variable.sizes.end());
  if (const std::uint64_t whole = checked_bytes(all, item, path_); is_chunk_too_large(of_chunk, whole))
    fail(ErrorCode::MalformedFile, path_, "variable '{}' of {} bytes in chunks of {} ({} bytes); expected at most {}",
         variable.name, whole, shape_text(chunks), of_chunk, std::max(kMostChunkBytes, 2 * whole));
  // A stored chunk takes at least 16 bytes, including its index entry.
  constexpr std::uint64_t kFewChunks = 4096;
  const std::uint64_t most_chunks = std::max(kFewChunks, bytes_ / 16);
  std::uint64_t count = 1;
  for (std::size_t d = 0; d < sizes.size(); ++d) {
    const std::uint64_t chunk = std::max<std::size_t>(1, chunks[d]);
    count *= (sizes[d] + chunk - 1) / chunk;
  }
  if (count > most_chunks)
    fail(ErrorCode::MalformedFile, path_,
         "variable '{}' has {} chunks of {} in a file of {} bytes; expected at most {}", variable.name, count,
         shape_text(chunks), bytes_, most_chunks);
}

void NcFile::require_stored(const NcVariable& variable, const NcSlab& slab) const {
  const std::vector<std::uint64_t> sizes(slab.count.begin(), slab.count.end());
  std::visit([&]<class T>(const ValueVector<T>&) { require_stored(variable, sizes, sizeof(T)); },
             numeric_array(variable));
}

ValueArray NcFile::values(const NcVariable& variable, const NcSlab& slab, const Progress& progress,
                          const SampleReader::OnBlock& on_block) const {
  ValueArray result = numeric_array(variable);
  const std::vector<std::uint64_t> sizes(slab.count.begin(), slab.count.end());
  std::visit(
      [&]<class T>(ValueVector<T>& values) {
        require_stored(variable, sizes, sizeof(T));
        const std::uint64_t bytes = checked_bytes(sizes, sizeof(T), path_);
        expect_step(std::max(bytes, bytes == 0 ? 0 : chunk_bytes(variable, sizeof(T))));
        expect_memory(kBytesPerValue * (bytes / sizeof(T)));
        if (bytes == 0) return;
        if (is_one_piece(variable, slab)) {
          values = std::move(std::get<ValueVector<T>>(read_piece(variable, slab, result, progress, on_block)));
          return;
        }
        values.resize(static_cast<std::size_t>(bytes / sizeof(T)));
        read_blocks(variable, slab, sizeof(T), values.data(), progress);
        if (on_block) on_block(result, 0, values.size());
      },
      result);
  return result;
}

NcSlab whole(const NcVariable& variable) {
  return {std::vector<std::size_t>(variable.sizes.size(), 0), variable.sizes};
}

}  // namespace tegl::io_detail
