// SPDX-License-Identifier: BSD-3-Clause
//
// Writers of small .npy and .npz files, byte by byte.
#pragma once

#include <string>
#include <vector>

#include "io_support.hpp"

namespace tegl::test {

/// A number of `bytes` bytes, lowest first.
inline std::string little(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> 8 * i & 0xffu);
  return text;
}

/// An array with this dictionary as header.
inline std::string npy_with(const std::string& dictionary, const std::string& samples, int version = 1) {
  std::string header = dictionary;
  const std::size_t before = version == 1 ? 10 : 12;
  while ((before + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  return "\x93NUMPY" + little(static_cast<std::uint64_t>(version), 2) + little(header.size(), version == 1 ? 2 : 4) +
         header + samples;
}

inline std::string npy(const std::string& type, const std::string& shape, const std::string& samples,
                       bool fortran_order = false) {
  return npy_with("{'descr': '" + type + "', 'fortran_order': " + (fortran_order ? "True" : "False") + ", 'shape': (" +
                      shape + "), }",
                  samples);
}

/// A file in an archive, and what its entry claims.
struct ZipFile {
  std::string name;
  std::string bytes;
  bool deflated = false;
  std::uint16_t flags = 0;
  std::uint32_t crc_error = 0;
  bool zip64 = false;
};

inline std::string zip(const std::vector<ZipFile>& files, const std::string& comment = "") {
  std::string archive, directory;
  for (const ZipFile& file : files) {
    // raw deflate: zlib's stream without its two bytes of header and four of checksum
    const std::string framed = compressed(file.bytes, true);
    const std::string data = file.deflated ? framed.substr(2, framed.size() - 6) : file.bytes;
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(file.bytes.data()), static_cast<uInt>(file.bytes.size())));
    const std::string extra =
        file.zip64 ? little(1, 2) + little(16, 2) + little(file.bytes.size(), 8) + little(data.size(), 8) : "";
    const auto size = [&](std::size_t number) { return little(file.zip64 ? 0xffffffff : number, 4); };
    const std::string common = little(file.flags, 2) + little(file.deflated ? 8 : 0, 2) + little(0, 4) +
                               little(crc ^ file.crc_error, 4) + size(data.size()) + size(file.bytes.size()) +
                               little(file.name.size(), 2) + little(extra.size(), 2);
    directory += little(0x02014b50, 4) + little(20, 2) + little(20, 2) + common + little(0, 2) + little(0, 2) +
                 little(0, 2) + little(0, 4) + little(archive.size(), 4) + file.name + extra;
    archive += little(0x04034b50, 4) + little(20, 2) + common + file.name + extra + data;
  }
  const std::size_t start = archive.size();
  return archive + directory + little(0x06054b50, 4) + little(0, 4) + little(files.size(), 2) +
         little(files.size(), 2) + little(directory.size(), 4) + little(start, 4) + little(comment.size(), 2) + comment;
}

}  // namespace tegl::test
