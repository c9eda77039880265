// SPDX-License-Identifier: BSD-3-Clause
//
// Reads encapsulated pixels: assigns fragments to frames, and converts the decoded samples of JPEG 2000 to stored
// values.
//
// Based on: NEMA PS3.5, A.4 (encapsulated transfer syntaxes, offset tables), 8.2.4 (JPEG 2000), annex G (RLE).
#include "dicom/dicom_frames.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dctk.h>

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "dicom/jpeg2000.hpp"

namespace tegl::io_detail {

namespace {

using Bytes = std::span<const unsigned char>;

/// The offset table, and the fragments after it.
struct Fragments {
  std::vector<Bytes> parts;
  std::vector<std::uint64_t> offsets;  ///< start of each frame, relative to the tag of the first fragment; may be empty
};

Bytes bytes_of(DcmPixelItem& item, const DicomFile& file) {
  Uint8* bytes = nullptr;
  const std::size_t length = item.getLength();
  if (length > 0 && (item.getUint8Array(bytes).bad() || bytes == nullptr))
    fail(ErrorCode::MalformedFile, file.path, "a fragment of compressed pixels cannot be read; expected {} bytes of it",
         length);
  return {bytes, length};
}

Fragments fragments_of(DcmDataset& data, const DicomFile& file) {
  DcmElement* element = nullptr;
  DcmPixelSequence* sequence = nullptr;
  if (data.findAndGetElement(DCM_PixelData, element).good())
    if (auto* const pixels = dynamic_cast<DcmPixelData*>(element))
      pixels->getEncapsulatedRepresentation(data.getOriginalXfer(), nullptr, sequence);
  if (sequence == nullptr || sequence->card() < 2)
    fail(ErrorCode::MalformedFile, file.path, "no fragments of compressed pixels; expected at least one for {} frames",
         file.frames.size());
  Fragments result;
  for (unsigned long i = 0; i < sequence->card(); ++i) {
    DcmPixelItem* item = nullptr;
    if (sequence->getItem(item, i).bad() || item == nullptr)
      fail(ErrorCode::MalformedFile, file.path, "fragment {} of compressed pixels cannot be read; expected {}", i,
           sequence->card() - 1);
    const Bytes bytes = bytes_of(*item, file);
    if (i > 0) result.parts.push_back(bytes);
    for (std::size_t b = 0; i == 0 && b + 4 <= bytes.size(); b += 4)
      result.offsets.push_back(bytes[b] | std::uint64_t{bytes[b + 1]} << 8 | std::uint64_t{bytes[b + 2]} << 16 |
                               std::uint64_t{bytes[b + 3]} << 24);
  }
  return result;
}

/// The first fragment of each frame by the offset table; empty if the table does not define it.
std::vector<std::size_t> firsts_by_table(const Fragments& fragments) {
  constexpr std::uint64_t kBeforeBytes = 8;  // tag and length of a fragment
  std::vector<std::size_t> firsts;
  std::uint64_t at = 0;
  for (std::size_t i = 0; i < fragments.parts.size(); ++i) {
    if (firsts.size() < fragments.offsets.size() && fragments.offsets[firsts.size()] == at) firsts.push_back(i);
    at += kBeforeBytes + fragments.parts[i].size();
  }
  return firsts.size() == fragments.offsets.size() ? firsts : std::vector<std::size_t>();
}

/// The first fragment of each frame: by a fragment count equal to the frame count, by the offset table, or by the first
/// bytes of fragments.
std::vector<std::size_t> first_fragments(const Fragments& fragments, const DicomFile& file) {
  const std::size_t frames = file.frames.size();
  std::vector<std::size_t> firsts(frames);
  if (fragments.parts.size() == frames) std::iota(firsts.begin(), firsts.end(), std::size_t{0});
  if (fragments.parts.size() == frames || frames == 1) return firsts;
  firsts = firsts_by_table(fragments);
  if (firsts.size() == frames) return firsts;
  firsts.clear();
  for (std::size_t i = 0; i < fragments.parts.size(); ++i)
    if (begins_jpeg2000(fragments.parts[i])) firsts.push_back(i);
  if (firsts.size() != frames || firsts.front() != 0)
    fail(ErrorCode::MalformedFile, file.path,
         "{} fragments of compressed pixels, {} of which begin a code stream, and {} offsets; expected {} frames",
         fragments.parts.size(), firsts.size(), fragments.offsets.size(), frames);
  return firsts;
}

/// Appends the samples of a frame as stored values. If the code stream has at most as many bits as are stored, its
/// values are in the low bits, whatever the header's high bit is. The header's signedness is used, as that of the code
/// stream is often wrong. A code stream with more bits has all bits of the cell.
template <class T>
void append(const Jpeg2000Image& image, const DicomFile& file, ValueVector<T>& values) {
  using Unsigned = std::make_unsigned_t<T>;
  constexpr int kBits = static_cast<int>(8 * sizeof(T));
  const bool whole_cell = image.precision > file.bits_stored;
  const int above = kBits - 1 - (whole_cell ? file.high_bit : image.precision - 1);
  const int unused = kBits - (whole_cell ? file.bits_stored : image.precision);
  std::transform(image.values.begin(), image.values.end(), std::back_inserter(values), [&](std::int32_t value) {
    const auto up = static_cast<Unsigned>(static_cast<Unsigned>(value) << above);
    return static_cast<T>(static_cast<T>(up) >> unused);
  });
}

/// Decompressed size of an RLE segment; stops counting at `enough`.
std::size_t unpacked_size(Bytes segment, std::size_t enough) {
  constexpr std::size_t kNothing = 128;
  std::size_t size = 0;
  for (std::size_t i = 0; i < segment.size() && size < enough;) {
    const std::size_t code = segment[i++];
    if (code < kNothing) {
      size += std::min(code + 1, segment.size() - i);
      i += std::min(code + 1, segment.size() - i);
    } else if (code > kNothing && i < segment.size()) {
      size += 2 * kNothing + 1 - code;
      ++i;
    }
  }
  return size;
}

/// Throws unless each segment of a frame is complete (the highest bytes of all samples, then the next ones).
void require_whole_segments(Bytes frame, const DicomFile& file, std::size_t number) {
  constexpr std::size_t kHeader = 64;
  const auto word = [&](std::size_t i) {
    return std::size_t{frame[4 * i]} | std::size_t{frame[4 * i + 1]} << 8 | std::size_t{frame[4 * i + 2]} << 16 |
           std::size_t{frame[4 * i + 3]} << 24;
  };
  const std::size_t count = frame.size() < kHeader ? 0 : word(0);
  if (count < 1 || count >= kHeader / 4)
    fail(ErrorCode::MalformedFile, file.path, "frame {}: {} bytes with {} segments in RLE; expected 1 to 15", number,
         frame.size(), count);
  const std::size_t pixels = file.columns * file.rows;
  for (std::size_t s = 0; s < count; ++s) {
    const std::size_t begin = word(1 + s);
    const std::size_t end = s + 1 < count ? word(2 + s) : frame.size();
    const bool inside = begin >= kHeader && begin <= end && end <= frame.size();
    const std::size_t size = inside ? unpacked_size(frame.subspan(begin, end - begin), pixels) : 0;
    if (size < pixels)
      fail(ErrorCode::MalformedFile, file.path, "frame {}: {} bytes in segment {} of RLE; expected {}", number, size,
           s + 1, pixels);
  }
}

}  // namespace

void require_whole_rle(DcmDataset& data, const DicomFile& file) {
  const Fragments fragments = fragments_of(data, file);
  if (fragments.parts.size() != file.frames.size())
    fail(ErrorCode::MalformedFile, file.path, "{} fragments in RLE; expected one for each of {} frames",
         fragments.parts.size(), file.frames.size());
  for (std::size_t f = 0; f < fragments.parts.size(); ++f) require_whole_segments(fragments.parts[f], file, f + 1);
}

ValueArray read_jpeg2000_frames(DcmDataset& data, const DicomFile& file) {
  const Fragments fragments = fragments_of(data, file);
  const std::vector<std::size_t> firsts = first_fragments(fragments, file);
  ValueArray values = array_of_type(file.type);
  std::vector<unsigned char> joined;
  for (std::size_t f = 0; f < firsts.size(); ++f) {
    const std::size_t end = f + 1 < firsts.size() ? firsts[f + 1] : fragments.parts.size();
    Bytes bytes = fragments.parts[firsts[f]];
    if (end - firsts[f] > 1) {
      joined.clear();
      for (std::size_t i = firsts[f]; i < end; ++i)
        joined.insert(joined.end(), fragments.parts[i].begin(), fragments.parts[i].end());
      bytes = joined;
    }
    const std::string label =
        firsts.size() == 1 ? file.path.string() : fmt::format("{}: frame {}", file.path.string(), f + 1);
    const Jpeg2000Image image = decode_jpeg2000(bytes, file.columns, file.rows, label);
    std::visit(
        [&]<class T>(ValueVector<T>& all) {
          if constexpr (std::is_integral_v<T> && sizeof(T) <= 4) {
            if (image.precision > static_cast<int>(8 * sizeof(T)))
              throw Error(ErrorCode::MalformedFile,
                          fmt::format("{}: {} bits per sample in JPEG 2000; expected at most {}", label,
                                      image.precision, 8 * sizeof(T)));
            append(image, file, all);
          }
        },
        values);
  }
  return values;
}

}  // namespace tegl::io_detail
