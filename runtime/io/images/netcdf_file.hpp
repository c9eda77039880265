// SPDX-License-Identifier: BSD-3-Clause
//
// An open netCDF file: its variables, attributes and values as C++ types, with errors as tegl::Error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <netcdf.h>

#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"

namespace tegl::io_detail {

/// A variable and its location.
struct NcVariable {
  int group = 0;
  int id = 0;
  std::string name;  ///< with its groups: "x" or "/group/x"
  nc_type type = NC_NAT;
  std::vector<int> dimensions;     ///< ids, slowest first
  std::vector<std::size_t> sizes;  ///< slowest first
};

/// A range of samples of a variable: `count` along each dimension, from `start`.
struct NcSlab {
  std::vector<std::size_t> start;
  std::vector<std::size_t> count;
};
/// The range of all samples.
NcSlab whole(const NcVariable& variable);

class NcFile {
 public:
  /// Opens classic and netCDF-4 files; files gzipped as a whole are decompressed in memory. HDF5 files are refused if
  /// they refer to files outside of their folder, unless `allow_outside_paths` (see hdf5_links.hpp). Errors:
  /// MalformedFile, UnsupportedData.
  NcFile(const std::filesystem::path& path, const Progress& progress, bool allow_outside_paths = false);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// All variables: first the root's, then the groups'.
  [[nodiscard]] std::vector<NcVariable> variables() const;
  [[nodiscard]] std::string dimension_name(const NcVariable& variable, std::size_t dimension) const;
  /// The coordinate variable of a dimension: one-dimensional, with its name, in the variable's group or a parent.
  [[nodiscard]] std::optional<NcVariable> coordinate(const NcVariable& variable, std::size_t dimension) const;

  [[nodiscard]] std::string text(const NcVariable& variable, const char* attribute) const;  ///< "" if absent
  [[nodiscard]] std::vector<double> numbers(const NcVariable& variable, const char* attribute) const;
  [[nodiscard]] std::optional<double> number(const NcVariable& variable, const char* attribute) const;

  /// Values in the file's order; attribute _Unsigned is applied. UnsupportedData unless numeric, MalformedFile for a
  /// variable too large for the file.
  [[nodiscard]] ValueArray values(const NcVariable& variable, const NcSlab& slab, const Progress& progress = {}) const {
    return values(variable, slab, progress, {});
  }
  /// As above; `on_block` as in SampleReader: in blocks if the slab is in one piece.
  [[nodiscard]] ValueArray values(const NcVariable& variable, const NcSlab& slab, const Progress& progress,
                                  const SampleReader::OnBlock& on_block) const;
  /// Whether a slab lies in one piece in a classic file.
  [[nodiscard]] bool is_one_piece(const NcVariable& variable, const NcSlab& slab) const;
  /// Throws MalformedFile if the values of a slab, which may be read in parts, are too large for the file.
  void require_stored(const NcVariable& variable, const NcSlab& slab) const;
  /// Number of indices of a dimension in one chunk; 1 if the variable has no chunks.
  [[nodiscard]] std::size_t block_length(const NcVariable& variable, std::size_t dimension) const;
  /// Bytes of a chunk's values, clipped to the variable.
  [[nodiscard]] std::uint64_t chunk_bytes(const NcVariable& variable, std::size_t item) const;
  [[nodiscard]] bool is_compressed() const noexcept { return !content_.empty(); }

 private:
  void check(int status, const std::string& what) const;
  void collect(int group, const std::string& prefix, int depth, std::vector<NcVariable>& out) const;
  [[nodiscard]] NcVariable describe(int group, int id, const std::string& prefix) const;
  [[nodiscard]] ValueArray numeric_array(const NcVariable& variable) const;
  void require_stored(const NcVariable& variable, std::span<const std::uint64_t> sizes, std::size_t item) const;
  /// The values of a slab in one piece, read without the library.
  [[nodiscard]] ValueArray read_piece(const NcVariable& variable, const NcSlab& slab, const ValueArray& type,
                                      const Progress& progress, const SampleReader::OnBlock& on_block) const;
  void read_blocks(const NcVariable& variable, const NcSlab& slab, std::size_t item, void* to,
                   const Progress& progress) const;

  std::filesystem::path path_;
  std::vector<unsigned char> content_;  ///< content of a compressed file; the library reads from it
  /// Of a classic file that is not compressed: the first bytes of the variables that lie in one piece, by id.
  std::vector<std::optional<std::uint64_t>> begins_;
  std::uint64_t bytes_ = 0;  ///< size of the file and those that it refers to
  int id_ = -1;
};

/// "uint8", ... ; "char", "string" or "user-defined" for non-numeric types.
const char* nc_type_name(nc_type type) noexcept;
bool is_numeric(nc_type type) noexcept;

}  // namespace tegl::io_detail
