// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the directory at the end of a zip archive. The headers before each member are used only to find its data.
//
// Based on: PKWARE, .ZIP File Format Specification (APPNOTE.TXT), 6.3.10, sections 4.3 to 4.5.
#include "base/zip_archive.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kEndSignature = 0x06054b50, kEnd64Signature = 0x06064b50, kLocatorSignature = 0x07064b50;
constexpr std::uint32_t kEntrySignature = 0x02014b50, kMemberSignature = 0x04034b50;
constexpr std::size_t kEndBytes = 22, kLocatorBytes = 20, kEnd64Bytes = 56, kEntryBytes = 46, kMemberBytes = 30;
constexpr std::uint16_t kZip64Field = 1;

/// Little-endian numbers at byte offsets, which the caller keeps within the bytes.
class Record {
 public:
  explicit Record(std::span<const unsigned char> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint16_t two(std::size_t at) const { return static_cast<std::uint16_t>(number(at, 2)); }
  [[nodiscard]] std::uint32_t four(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
  [[nodiscard]] std::uint64_t eight(std::size_t at) const { return number(at, 8); }

 private:
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t count) const {
    std::uint64_t result = 0;
    for (std::size_t i = 0; i < count; ++i) result |= std::uint64_t{bytes_[at + i]} << 8 * i;
    return result;
  }
  std::span<const unsigned char> bytes_;
};

/// Location of the directory in the file.
struct Directory {
  std::uint64_t offset = 0, bytes = 0, entries = 0;
};

/// The record at the end of an archive, before a comment of any length; nullopt if there is none.
std::optional<std::size_t> find_end(std::span<const unsigned char> tail) {
  for (std::size_t at = tail.size() < kEndBytes ? 0 : tail.size() - kEndBytes + 1; at-- > 0;) {
    const Record record(tail.subspan(at));
    if (record.four(0) == kEndSignature && at + kEndBytes + record.two(20) <= tail.size()) return at;
  }
  return std::nullopt;
}

/// The directory by the Zip64 record, which a locator of 20 bytes before the end record refers to.
Directory directory_64(const fs::path& path, std::uint64_t locator_offset) {
  const auto locator = read_bytes(path, locator_offset, kLocatorBytes);
  if (locator.size() < kLocatorBytes || Record(locator).four(0) != kLocatorSignature)
    fail(ErrorCode::MalformedFile, path, "zip archive with sizes of 64 bits and no locator of these");
  const auto bytes = read_bytes(path, Record(locator).eight(8), kEnd64Bytes);
  if (bytes.size() < kEnd64Bytes || Record(bytes).four(0) != kEnd64Signature)
    fail(ErrorCode::MalformedFile, path, "zip archive without the Zip64 record that byte {} refers to", locator_offset);
  const Record record(bytes);
  return {record.eight(48), record.eight(40), record.eight(32)};
}

Directory find_directory(const fs::path& path, std::uint64_t file_bytes) {
  constexpr std::uint64_t kLongestComment = 0xffff;
  const std::uint64_t tail_bytes = std::min(file_bytes, kLongestComment + kEndBytes);
  const auto tail = read_bytes(path, file_bytes - tail_bytes, static_cast<std::size_t>(tail_bytes));
  const std::optional<std::size_t> end = find_end(tail);
  if (!end) fail(ErrorCode::MalformedFile, path, "zip archive without a directory at its end: truncated?");
  const Record record(std::span<const unsigned char>(tail).subspan(*end));
  if (record.two(4) != 0 && record.two(4) != 0xffff)
    fail(ErrorCode::UnsupportedFormat, path, "part {} of a zip archive in several parts; expected one file",
         record.two(4));
  Directory result{record.four(16), record.four(12), record.two(10)};
  const std::uint64_t end_offset = file_bytes - tail_bytes + *end;
  if (result.offset == 0xffffffff || result.bytes == 0xffffffff || result.entries == 0xffff) {
    if (end_offset < kLocatorBytes) fail(ErrorCode::MalformedFile, path, "zip archive of {} bytes", file_bytes);
    result = directory_64(path, end_offset - kLocatorBytes);
  }
  if (result.offset > file_bytes || result.bytes > file_bytes - result.offset ||
      result.entries > result.bytes / kEntryBytes)
    fail(ErrorCode::MalformedFile, path, "zip archive of {} bytes with a directory of {} entries and {} bytes at {}",
         file_bytes, result.entries, result.bytes, result.offset);
  return result;
}

/// Takes the sizes and the offset that do not fit into 32 bits from the entry's Zip64 field. In this order, each is
/// there only if its 32 bits are all ones.
void read_zip64(std::span<const unsigned char> extra, ZipMember& member) {
  for (std::size_t at = 0; at + 4 <= extra.size();) {
    const std::uint16_t kind = Record(extra).two(at), size = Record(extra).two(at + 2);
    at += 4;
    if (size > extra.size() - at) return;
    if (kind == kZip64Field) {
      std::size_t next = at;
      for (std::uint64_t* value : {&member.bytes, &member.compressed_bytes, &member.offset})
        if (*value == 0xffffffff && next + 8 <= at + size) {
          *value = Record(extra).eight(next);
          next += 8;
        }
      return;
    }
    at += size;
  }
}

/// The offset of the data behind a member's own header, whose length may differ from the directory's.
std::uint64_t data_offset(const fs::path& path, const ZipMember& member) {
  const auto bytes = read_bytes(path, member.offset, kMemberBytes);
  if (bytes.size() < kMemberBytes || Record(bytes).four(0) != kMemberSignature)
    fail(ErrorCode::MalformedFile, path, "zip archive without the member {} at byte {}", shown(member.name),
         member.offset);
  return member.offset + kMemberBytes + Record(bytes).two(26) + Record(bytes).two(28);
}

/// Bits of an entry's flags and its numbers of compressions.
constexpr std::uint16_t kEncrypted = 1, kStored = 0, kDeflated = 8;

ZipMember read_entry(const fs::path& path, std::span<const unsigned char> entry, std::uint64_t file_bytes) {
  const Record record(entry);
  const std::size_t name = record.two(28), extra = record.two(30);
  ZipMember member;
  member.name.assign(reinterpret_cast<const char*>(entry.data()) + kEntryBytes, name);
  const std::uint16_t flags = record.two(8), method = record.two(10);
  if ((flags & kEncrypted) != 0)
    fail(ErrorCode::UnsupportedFormat, path, "encrypted member {} of a zip archive", shown(member.name));
  if (method != kStored && method != kDeflated)
    fail(ErrorCode::UnsupportedFormat, path, "member {} with compression {}; expected none or deflate (0 or 8)",
         shown(member.name), method);
  member.is_deflated = method == kDeflated;
  member.crc = record.four(16);
  member.compressed_bytes = record.four(20);
  member.bytes = record.four(24);
  member.offset = record.four(42);
  read_zip64(entry.subspan(kEntryBytes + name, extra), member);
  member.offset = data_offset(path, member);
  if (member.offset > file_bytes || member.compressed_bytes > file_bytes - member.offset ||
      (!member.is_deflated && member.compressed_bytes != member.bytes))
    fail(ErrorCode::MalformedFile, path,
         "member {} of {} bytes, {} compressed, at byte {} of a zip archive of {} bytes", shown(member.name),
         member.bytes, member.compressed_bytes, member.offset, file_bytes);
  return member;
}

}  // namespace

std::vector<ZipMember> list_zip(const fs::path& path) {
  const std::uint64_t file_bytes = size_of_file(path);
  const Directory directory = find_directory(path, file_bytes);
  const auto bytes = read_bytes(path, directory.offset, static_cast<std::size_t>(directory.bytes));
  std::span<const unsigned char> rest = bytes;
  std::vector<ZipMember> members;
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    if (rest.size() < kEntryBytes || Record(rest).four(0) != kEntrySignature)
      fail(ErrorCode::MalformedFile, path, "directory of a zip archive with {} entries; expected {}", i,
           directory.entries);
    const Record record(rest);
    const std::size_t size = kEntryBytes + record.two(28) + record.two(30) + record.two(32);
    if (size > rest.size())
      fail(ErrorCode::MalformedFile, path, "entry {} of a zip archive's directory ends {} bytes behind it", i,
           size - rest.size());
    members.push_back(read_entry(path, rest.first(size), file_bytes));
    rest = rest.subspan(size);
  }
  return members;
}

}  // namespace tegl::io_detail
