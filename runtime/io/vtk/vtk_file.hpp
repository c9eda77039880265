// SPDX-License-Identifier: BSD-3-Clause
//
// XML files of VTK: the header, and arrays of numbers in any encoding.
//
// Based on: VTK File Formats (docs.vtk.org), section XML.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/value_array.hpp"
#include "tegl/work.hpp"
#include "vtk/xml_file.hpp"

namespace tegl::io_detail {

/// A <DataArray>.
struct VtkArray {
  std::string name;
  std::string_view type;  ///< "uint8", ... as type_name returns it
  std::uint64_t components = 1;
  const XmlElement* element = nullptr;
};

/// An open file. Its elements and arrays live as long as this object.
class VtkFile {
 public:
  /// Reads all elements, no arrays. Errors: FileNotFound; MalformedFile (no XML, no VTKFile, unknown attributes);
  /// UnsupportedFormat (a compressor other than zlib; parallel and composite files, which name others), Cancelled.
  explicit VtkFile(const std::filesystem::path& path, const Progress& progress = {});
  VtkFile(const VtkFile&) = delete;
  VtkFile& operator=(const VtkFile&) = delete;
  ~VtkFile() = default;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The type of the data: "ImageData", "UnstructuredGrid", ...
  [[nodiscard]] const std::string& type() const noexcept { return type_; }
  /// A remark if the file's extension is for another type of data: empty for others.
  [[nodiscard]] std::string remark_on_extension() const;
  /// The element of this type in the file.
  [[nodiscard]] const XmlElement& data() const noexcept { return *data_; }
  /// The pieces. Errors: MalformedFile if there is none.
  [[nodiscard]] std::vector<const XmlElement*> pieces() const;

  /// The arrays of numbers in `parent`, which may be null; texts and bits are left out. Errors: MalformedFile (a type
  /// or number of components that is none).
  [[nodiscard]] std::vector<VtkArray> arrays(const XmlElement* parent) const;
  /// The array with this name, or the only one if the name is empty. Errors: MalformedFile.
  [[nodiscard]] VtkArray array(const XmlElement& piece, std::string_view parent, std::string_view name) const;

  /// All numbers of an array: `count` of them, or as many as there are. Sizes in the file are checked against its bytes
  /// before memory is allocated. Errors: MalformedFile (missing or damaged data, another number of values), TooLarge.
  [[nodiscard]] ValueArray read(const VtkArray& array, std::optional<std::uint64_t> count,
                                const Progress& progress = {}) const;
  /// The same, converted.
  [[nodiscard]] std::vector<double> read_doubles(const VtkArray& array, std::uint64_t count) const;
  /// Whole numbers; values above the range of int64 become negative.
  [[nodiscard]] std::vector<std::int64_t> read_integers(const VtkArray& array,
                                                        std::optional<std::uint64_t> count) const;

  /// Place of the first value in the file if values are stored one after the other, not compressed: the array can be
  /// read in parts. Errors: MalformedFile if there are not `count` values.
  [[nodiscard]] std::optional<std::uint64_t> place_of_raw(const VtkArray& array, std::uint64_t count) const;
  /// Whether values are not in this machine's byte order.
  [[nodiscard]] bool is_swapped() const noexcept { return swapped_; }

  /// The field array TimeValue, if the file has one.
  [[nodiscard]] std::optional<double> time() const;

  /// Parses `count` numbers of an attribute; `missing` if there is no such attribute. Errors: MalformedFile.
  [[nodiscard]] std::vector<double> numbers(const XmlElement& element, std::string_view key, std::size_t count,
                                            std::vector<double> missing) const;
  /// Parses an attribute as a whole number of at least 0. Errors: MalformedFile if it is missing or none.
  [[nodiscard]] std::uint64_t whole_number(const XmlElement& element, std::string_view key) const;

 private:
  struct Place;  ///< where the encoded bytes of an array are
  [[nodiscard]] Place place_of(const VtkArray& array) const;
  template <class T>
  void read_text(const VtkArray& array, std::optional<std::uint64_t> count, ValueVector<T>& to,
                 const Progress& progress) const;
  template <class T>
  void read_bytes_of(const VtkArray& array, std::optional<std::uint64_t> count, ValueVector<T>& to,
                     const Progress& progress) const;
  [[nodiscard]] std::uint64_t header_number(class EncodedBytes& bytes, const VtkArray& array, const char* what) const;
  /// Returns the bytes of the compressed blocks.
  std::uint64_t inflate_blocks(class EncodedBytes& bytes, const VtkArray& array, std::optional<std::uint64_t> count,
                               std::uint64_t item, std::vector<unsigned char>& to, const Progress& progress) const;
  /// Throws if bytes follow those that the header of an array in base64 names: `length`.
  void require_end(class EncodedBytes& bytes, const VtkArray& array, std::uint64_t length) const;

  std::filesystem::path path_;
  XmlFile xml_;
  std::string type_;
  const XmlElement* data_ = nullptr;
  std::uint64_t file_size_ = 0;
  std::uint64_t appended_ = 0;  ///< place of appended data after the '_'; 0: none
  bool appended_base64_ = false;
  bool compressed_ = false;
  bool swapped_ = false;
  std::uint64_t header_bytes_ = 4;  ///< of each number in a header
};

}  // namespace tegl::io_detail
