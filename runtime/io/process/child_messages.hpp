// SPDX-License-Identifier: BSD-3-Clause
//
// The form of the messages between a child process and its parent.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tegl::io_detail {

enum class MessageKind : std::uint16_t {
  closed,         ///< none: the child has ended
  progress,       ///< a fraction (double)
  file,           ///< the path of the file that is read from now on (text)
  grant,          ///< seconds that the next step may take beyond the limit (double)
  block,          ///< a descriptor: a block of the result that follows
  result,         ///< of the work
  failure,        ///< number of an ErrorCode, text
  out_of_memory,  ///< whether by the limit (uint8_t), the limit in bytes
};

inline constexpr std::uint32_t kMessageMagic = 0x4c474554;
inline constexpr std::uint16_t kMessageVersion = 1;
/// Bytes behind a head; more come as a file in memory.
inline constexpr std::size_t kMostInline = std::size_t{1} << 15;

struct MessageHead {
  std::uint32_t magic = kMessageMagic;
  std::uint16_t version = kMessageVersion;
  MessageKind kind = MessageKind::closed;
  std::uint64_t in_file = 0;  ///< how many bytes are in the file that comes along; 0: there is none
};

/// Layers that the parent asks for.
struct LayerRequest {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

}  // namespace tegl::io_detail
