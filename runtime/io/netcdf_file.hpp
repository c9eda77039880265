// SPDX-License-Identifier: BSD-3-Clause
//
// An open netCDF file: its variables, attributes and values, as C++ values and with the library's errors as
// tegl::Error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <netcdf.h>

#include "raw_image.hpp"

namespace tegl::io_detail {

/// A variable and where it is.
struct NcVariable {
  int group = 0;
  int id = 0;
  std::string name;  ///< with its groups: "x", or "/group/x"
  nc_type type = NC_NAT;
  std::vector<int> dimensions;     ///< ids, slowest first
  std::vector<std::size_t> sizes;  ///< slowest first
};

class NcFile {
 public:
  /// Opens classic and netCDF-4 files, gzipped as a whole too (then in memory). Errors: MalformedFile.
  NcFile(const std::filesystem::path& path, const Progress& progress);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// All variables, those of groups after those of the root.
  [[nodiscard]] std::vector<NcVariable> variables() const;
  [[nodiscard]] std::string dimension_name(const NcVariable& variable, std::size_t dimension) const;
  /// The coordinate variable of a dimension: one-dimensional and of its name, in the variable's group or above it.
  [[nodiscard]] std::optional<NcVariable> coordinate(const NcVariable& variable, std::size_t dimension) const;

  [[nodiscard]] std::string text(const NcVariable& variable, const char* attribute) const;  ///< "" if absent
  [[nodiscard]] std::vector<double> numbers(const NcVariable& variable, const char* attribute) const;
  [[nodiscard]] std::optional<double> number(const NcVariable& variable, const char* attribute) const;

  /// All values, in the order of the file; attribute _Unsigned is taken into account. UnsupportedData unless numeric.
  [[nodiscard]] ValueArray values(const NcVariable& variable, const Progress& progress) const;
  /// Those with indices [first, first + count) along one dimension (the others whole).
  [[nodiscard]] ValueArray values(const NcVariable& variable, std::size_t dimension, std::size_t first,
                                  std::size_t count) const;
  /// How many indices of a dimension lie in one block of the file; 1 if it is not stored in blocks.
  [[nodiscard]] std::size_t block_length(const NcVariable& variable, std::size_t dimension) const;
  /// Bytes of the values in a block of the file, as far as the variable has them.
  [[nodiscard]] std::uint64_t chunk_bytes(const NcVariable& variable, std::size_t item) const;
  [[nodiscard]] bool is_compressed() const noexcept { return !content_.empty(); }

 private:
  void check(int status, const std::string& what) const;
  void collect(int group, const std::string& prefix, int depth, std::vector<NcVariable>& out) const;
  [[nodiscard]] NcVariable describe(int group, int id, const std::string& prefix) const;
  [[nodiscard]] ValueArray numeric_array(const NcVariable& variable) const;
  void read_blocks(const NcVariable& variable, std::size_t item, void* to, const Progress& progress) const;

  std::filesystem::path path_;
  std::vector<unsigned char> content_;  ///< of a compressed file; the library reads from here
  int id_ = -1;
};

/// "uint8", ... ; "char", "string" or "user-defined" for types that hold no numbers.
const char* nc_type_name(nc_type type) noexcept;
bool is_numeric(nc_type type) noexcept;

}  // namespace tegl::io_detail
