// SPDX-License-Identifier: BSD-3-Clause
//
// The format of messages between a child process and its parent.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tegl::io_detail {

enum class MessageKind : std::uint16_t {
  closed,         ///< not sent: the child has ended
  progress,       ///< a fraction (double)
  file,           ///< path of the file that is being read (text)
  grant,          ///< additional seconds for the next step (double)
  block,          ///< a descriptor: one block of the following result
  result,         ///< result of the work
  failure,        ///< number of an ErrorCode, and the message
  out_of_memory,  ///< whether the limit was reached (uint8_t), the limit in bytes
};

inline constexpr std::uint32_t kMessageMagic = 0x4c474554;
inline constexpr std::uint16_t kMessageVersion = 1;
/// Maximum bytes after a header; larger contents are sent as a memory file.
inline constexpr std::size_t kMostInline = std::size_t{1} << 15;

struct MessageHead {
  std::uint32_t magic = kMessageMagic;
  std::uint16_t version = kMessageVersion;
  MessageKind kind = MessageKind::closed;
  std::uint64_t in_file = 0;  ///< bytes in the attached memory file; 0: no file
};

/// The parent's request for layers.
struct LayerRequest {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

}  // namespace tegl::io_detail
