// SPDX-License-Identifier: BSD-3-Clause
//
// Walks the header of a classic netCDF file. Every count is checked against what is left of the file before it is used.
//
// Based on: Unidata, "The NetCDF Classic Format Specification" (CDF-1, CDF-2, CDF-5).
#include "cdf_header.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// Thrown when the header goes on after the bytes at hand; never leaves this file.
struct EndOfBytes {};

class HeaderWalk {
 public:
  HeaderWalk(std::span<const unsigned char> bytes, std::uint64_t file_bytes, const fs::path& path)
      : bytes_(bytes), file_bytes_(file_bytes), path_(path) {}

  void run() {
    take(3);
    version_ = take(1)[0];
    const std::uint64_t unknown_records = version_ == 5 ? ~std::uint64_t{0} : 0xffffffffU;
    records_ = count_field();
    streaming_ = records_ == unknown_records;
    dimensions();
    attributes();
    variables();
    check_extents();
  }

 private:
  struct Variable {
    std::string name;
    std::uint64_t bytes;  ///< of one record, or of all
    std::uint64_t begin;
    bool record;
  };

  std::span<const unsigned char> take(std::uint64_t count) {
    if (count > bytes_.size() - at_) {
      if (at_ + count > file_bytes_ || at_ + count < at_)
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

  std::string name() {
    const std::uint64_t length = count_field();
    const auto bytes = take(length + (4 - length % 4) % 4);
    return {reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(length)};
  }

  /// The number of elements of a list that carries `tag`; an absent list has neither tag nor elements. Each element
  /// takes at least 8 bytes, so that a count cannot be larger than the file.
  std::uint64_t list(std::uint64_t tag, std::string_view what) {
    const std::uint64_t found = big_endian(4);
    const std::uint64_t count = count_field();
    if (found != tag && (found != 0 || count != 0))
      fail(ErrorCode::MalformedFile, path_, "netCDF header has tag {} before the {}; expected {}", found, what, tag);
    if (count > file_bytes_ / 8)
      fail(ErrorCode::MalformedFile, path_, "netCDF header announces {} {}; expected fewer in {} bytes", count, what,
           file_bytes_);
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
      name();
      sizes_.push_back(count_field());
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
      for (std::uint64_t d = 0; d < rank; ++d) {
        const std::uint64_t id = count_field();
        if (id >= sizes_.size())
          fail(ErrorCode::MalformedFile, path_, "variable '{}' has dimension number {}; expected less than {}",
               variable.name, id, sizes_.size());
        const std::uint64_t size = sizes_[static_cast<std::size_t>(id)];
        if (d == 0 && size == 0)
          variable.record = true;
        else
          shape.push_back(size);
      }
      attributes();
      variable.bytes = checked_bytes(shape, type_bytes(), path_);
      count_field();  // vsize: redundant, and too small for large variables
      variable.begin = big_endian(version_ == 1 ? 4 : 8);
      variables_.push_back(variable);
    }
  }

  void check_extents() const {
    std::uint64_t record_bytes = 0;
    const auto count = std::count_if(variables_.begin(), variables_.end(), [](const Variable& v) { return v.record; });
    // A single record variable is not padded to 4 bytes.
    for (const Variable& variable : variables_)
      if (variable.record) record_bytes += count == 1 ? variable.bytes : (variable.bytes + 3) / 4 * 4;
    for (const Variable& variable : variables_) {
      std::uint64_t end = variable.bytes;
      if (variable.record) {
        const std::uint64_t before = streaming_ || records_ == 0 ? 0 : records_ - 1;
        if (streaming_ || records_ == 0) end = 0;
        std::uint64_t skipped = 0;
        if (__builtin_mul_overflow(before, record_bytes, &skipped) || __builtin_add_overflow(end, skipped, &end))
          end = ~std::uint64_t{0};
      }
      if (end == 0) continue;
      if (__builtin_add_overflow(end, variable.begin, &end) || end > file_bytes_)
        fail(ErrorCode::MalformedFile, path_, "variable '{}' ends at byte {}; expected at most {}, the file's size",
             variable.name, end, file_bytes_);
    }
  }

  std::span<const unsigned char> bytes_;
  std::uint64_t file_bytes_;
  const fs::path& path_;
  std::uint64_t at_ = 0;
  unsigned version_ = 0;
  std::uint64_t records_ = 0;
  bool streaming_ = false;
  std::vector<std::uint64_t> sizes_;
  std::vector<Variable> variables_;
};

}  // namespace

bool is_classic_netcdf(std::span<const unsigned char> prefix) {
  return prefix.size() >= 4 && prefix[0] == 'C' && prefix[1] == 'D' && prefix[2] == 'F' &&
         (prefix[3] == 1 || prefix[3] == 2 || prefix[3] == 5);
}

void check_classic_netcdf(const fs::path& path, std::span<const unsigned char> content) {
  if (!content.empty()) {
    HeaderWalk(content, content.size(), path).run();
    return;
  }
  const std::uint64_t size = size_of_file(path);
  // Headers are mostly some kilobytes; the rare long one is read again in larger pieces.
  for (std::size_t piece = std::size_t{1} << 16;; piece *= 16) {
    const auto bytes = read_bytes(path, 0, piece);
    try {
      HeaderWalk(bytes, size, path).run();
      return;
    } catch (const EndOfBytes&) {
    }
  }
}

}  // namespace tegl::io_detail
