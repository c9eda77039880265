// SPDX-License-Identifier: BSD-3-Clause
//
// Parses the header of a classic netCDF file. Every count is checked against the remaining bytes before it is used.
//
// Based on: Unidata, "The NetCDF Classic Format Specification" (CDF-1, CDF-2, CDF-5).
#include "images/cdf_header.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// Thrown if the header is longer than the available bytes; caught in this file.
struct EndOfBytes {};

class HeaderWalk {
 public:
  HeaderWalk(std::span<const unsigned char> bytes, std::uint64_t file_bytes, const fs::path& path)
      : bytes_(bytes), file_bytes_(file_bytes), path_(path) {}

  /// Returns the size of header and variables in bytes.
  std::uint64_t run() {
    take(3);
    version_ = take(1)[0];
    records_ = count_field();
    if (records_ == largest_count())
      fail(ErrorCode::UnsupportedData, path_,
           "netCDF file without a number of records, as if it is still being written; expected a number");
    dimensions();
    attributes();
    variables();
    return check_extents();
  }

  /// After run(): the first byte of each variable whose values lie in one piece.
  [[nodiscard]] std::vector<std::optional<std::uint64_t>> begins() const {
    std::vector<std::optional<std::uint64_t>> result;
    const std::uint64_t record_bytes = bytes_of_record();
    for (const Variable& variable : variables_)
      result.push_back(!variable.record || variable.bytes == record_bytes ? std::optional(variable.begin)
                                                                          : std::nullopt);
    return result;
  }

 private:
  struct Variable {
    std::string name;
    std::uint64_t bytes;  ///< of one record, or of the whole variable
    std::uint64_t begin;
    bool record;
  };
  static constexpr std::uint64_t kLongestName = 256;  // NC_MAX_NAME: the size of buffers in the library and its users
  static constexpr std::uint64_t kMostDimensions = 1024;  // of a variable: NC_MAX_VAR_DIMS
  static constexpr std::uint64_t kMostItems = 65536;      // of a list: a generous limit

  std::span<const unsigned char> take(std::uint64_t count) {
    if (count > bytes_.size() - at_) {
      if (count > file_bytes_ - std::min(file_bytes_, at_))
        fail(ErrorCode::MalformedFile, path_, "netCDF header needs {} bytes at byte {}; expected them in the file's {}",
             count, at_, file_bytes_);
      throw EndOfBytes{};
    }
    const auto result = bytes_.subspan(static_cast<std::size_t>(at_), static_cast<std::size_t>(count));
    at_ += count;
    return result;
  }
  std::uint64_t big_endian(std::uint64_t count) {
    std::uint64_t value = 0;
    for (const unsigned char byte : take(count)) value = value << 8 | byte;
    return value;
  }
  std::uint64_t count_field() { return big_endian(version_ == 5 ? 8 : 4); }

  [[nodiscard]] std::uint64_t largest_count() const { return version_ == 5 ? ~std::uint64_t{0} : 0xffffffffU; }

  std::string name() {
    const std::uint64_t length = count_field();
    if (length < 1 || length > kLongestName)
      fail(ErrorCode::MalformedFile, path_, "netCDF name of {} bytes before byte {}; expected 1 to {}",
           version_ == 5 ? static_cast<std::int64_t>(length) : static_cast<std::int32_t>(length), at_, kLongestName);
    const auto bytes = take(length + (4 - length % 4) % 4);
    return {reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(length)};
  }

  /// The number of elements of a list with `tag`; an absent list has zeros instead of both. Each element takes at least
  /// 8 bytes, so the count is limited by the file size.
  std::uint64_t list(std::uint64_t tag, std::string_view what) {
    const std::uint64_t found = big_endian(4);
    const std::uint64_t count = count_field();
    if (found != tag && (found != 0 || count != 0))
      fail(ErrorCode::MalformedFile, path_, "netCDF header has tag {} before the {}; expected {}", found, what, tag);
    if (count > std::min(file_bytes_ / 8, kMostItems))
      fail(ErrorCode::MalformedFile, path_, "netCDF header announces {} {}; expected at most {} in {} bytes", count,
           what, std::min(file_bytes_ / 8, kMostItems), file_bytes_);
    return count;
  }

  std::uint64_t type_bytes() {
    constexpr std::array<std::uint64_t, 12> kBytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = big_endian(4);
    if (type < 1 || type > (version_ == 5 ? 11U : 6U))
      fail(ErrorCode::MalformedFile, path_, "netCDF type {}; expected 1 to {}", type, version_ == 5 ? 11 : 6);
    return kBytes[static_cast<std::size_t>(type)];
  }

  void dimensions() {
    constexpr std::uint64_t kTag = 10;
    for (std::uint64_t i = list(kTag, "dimensions"); i > 0; --i) {
      const std::string label = name();
      const std::uint64_t size = count_field();
      const std::uint64_t most = version_ == 2 ? largest_count() : largest_count() >> 1;
      if (size > most)
        fail(ErrorCode::MalformedFile, path_, "dimension '{}' has size {}; expected at most {}", label, size, most);
      if (size == 0 && std::ranges::find(sizes_, 0U) != sizes_.end())
        fail(ErrorCode::MalformedFile, path_, "dimension '{}' is a second record dimension (size 0); expected one",
             label);
      sizes_.push_back(size);
    }
  }

  void attributes() {
    constexpr std::uint64_t kTag = 12;
    for (std::uint64_t i = list(kTag, "attributes"); i > 0; --i) {
      name();
      const std::uint64_t item = type_bytes();
      const std::uint64_t count = count_field();
      if (count > file_bytes_)
        fail(ErrorCode::MalformedFile, path_, "netCDF attribute of {} values; expected fewer in {} bytes", count,
             file_bytes_);
      take((item * count + 3) / 4 * 4);
    }
  }

  void variables() {
    constexpr std::uint64_t kTag = 11;
    for (std::uint64_t i = list(kTag, "variables"); i > 0; --i) {
      Variable variable{name(), 1, 0, false};
      std::vector<std::uint64_t> shape;
      const std::uint64_t rank = count_field();
      if (rank > kMostDimensions)
        fail(ErrorCode::MalformedFile, path_, "variable '{}' has {} dimensions; expected at most {}", variable.name,
             rank, kMostDimensions);
      for (std::uint64_t d = 0; d < rank; ++d) {
        const std::uint64_t id = count_field();
        if (id >= sizes_.size())
          fail(ErrorCode::MalformedFile, path_, "variable '{}' has dimension number {}; expected less than {}",
               variable.name, id, sizes_.size());
        const std::uint64_t size = sizes_[static_cast<std::size_t>(id)];
        if (d > 0 && size == 0)
          fail(ErrorCode::MalformedFile, path_,
               "variable '{}' has the record dimension at position {}; expected it first", variable.name, d);
        if (size == 0)
          variable.record = true;
        else
          shape.push_back(size);
      }
      attributes();
      variable.bytes = checked_bytes(shape, type_bytes(), path_);
      count_field();  // vsize: redundant, and too small a field for large variables
      variable.begin = big_endian(version_ == 1 ? 4 : 8);
      variables_.push_back(variable);
    }
  }

  /// Size of a record of all record variables.
  [[nodiscard]] std::uint64_t bytes_of_record() const {
    std::uint64_t record_bytes = 0;
    const auto count = std::count_if(variables_.begin(), variables_.end(), [](const Variable& v) { return v.record; });
    // A single record variable is not padded to 4 bytes.
    for (const Variable& variable : variables_) {
      if (!variable.record) continue;
      const std::uint64_t padded = count == 1 ? variable.bytes : (variable.bytes + 3) / 4 * 4;
      if (__builtin_add_overflow(record_bytes, padded, &record_bytes))
        fail(ErrorCode::MalformedFile, path_, "records up to variable '{}' take more than 2^64 bytes; expected fewer",
             variable.name);
    }
    return record_bytes;
  }

  /// Throws unless all variables lie after the header and within the file. Returns the end of the last one.
  [[nodiscard]] std::uint64_t check_extents() const {
    const std::uint64_t record_bytes = bytes_of_record();
    std::uint64_t last = at_;
    for (const Variable& variable : variables_) {
      std::uint64_t end = variable.bytes;
      if (variable.record) {
        std::uint64_t skipped = 0;
        if (records_ == 0) continue;
        if (__builtin_mul_overflow(records_ - 1, record_bytes, &skipped) || __builtin_add_overflow(end, skipped, &end))
          end = ~std::uint64_t{0};
      }
      if (end == 0) continue;
      if (variable.begin < at_)
        fail(ErrorCode::MalformedFile, path_, "variable '{}' begins at byte {}; expected at least {}, after the header",
             variable.name, variable.begin, at_);
      if (__builtin_add_overflow(end, variable.begin, &end) || end > file_bytes_)
        fail(ErrorCode::MalformedFile, path_, "variable '{}' ends at byte {}; expected at most {}, the file's size",
             variable.name, end, file_bytes_);
      last = std::max(last, end);
    }
    return last;
  }

  std::span<const unsigned char> bytes_;
  std::uint64_t file_bytes_;
  const fs::path& path_;
  std::uint64_t at_ = 0;
  unsigned version_ = 0;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> sizes_;
  std::vector<Variable> variables_;
};

}  // namespace

bool is_classic_netcdf(std::span<const unsigned char> prefix) {
  return prefix.size() >= 4 && prefix[0] == 'C' && prefix[1] == 'D' && prefix[2] == 'F' &&
         (prefix[3] == 1 || prefix[3] == 2 || prefix[3] == 5);
}

std::uint64_t bytes_of_classic_netcdf(std::span<const unsigned char> bytes, std::uint64_t most, const fs::path& path) {
  try {
    return HeaderWalk(bytes, most, path).run();
  } catch (const EndOfBytes&) {
    return 0;
  }
}

std::vector<std::optional<std::uint64_t>> check_classic_netcdf(const fs::path& path) {
  const std::uint64_t size = size_of_file(path);
  // Most headers are some kilobytes; a longer one is read again with a larger block.
  for (std::size_t piece = std::size_t{1} << 16;; piece *= 16) {
    const std::vector<unsigned char> bytes = read_bytes(path, 0, piece);
    try {
      HeaderWalk walk(bytes, size, path);
      walk.run();
      return walk.begins();
    } catch (const EndOfBytes&) {
      // read more
    }
    if (bytes.size() < piece)
      fail(ErrorCode::MalformedFile, path, "ends within its header, after {} bytes; expected a whole file",
           bytes.size());
  }
}

}  // namespace tegl::io_detail
