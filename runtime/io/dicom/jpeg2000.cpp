// SPDX-License-Identifier: BSD-3-Clause
//
// Decodes JPEG 2000 through OpenJPEG. Its C functions call ours, which must not throw: messages are stored and thrown
// later.
//
// Based on: ISO/IEC 15444-1, annexes A (code stream) and I (JP2).
#include "dicom/jpeg2000.hpp"

#include <openjpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::io_detail {

namespace {

/// A stream over bytes in memory.
struct Source {
  std::span<const unsigned char> bytes;
  std::size_t at = 0;
};

OPJ_SIZE_T read_some(void* to, OPJ_SIZE_T count, void* data) {
  auto& source = *static_cast<Source*>(data);
  const std::size_t some = std::min(count, source.bytes.size() - source.at);
  if (some == 0) return static_cast<OPJ_SIZE_T>(-1);  // end of stream
  std::memcpy(to, source.bytes.data() + source.at, some);
  source.at += some;
  return some;
}

OPJ_OFF_T skip_some(OPJ_OFF_T count, void* data) {
  auto& source = *static_cast<Source*>(data);
  if (count < 0) return -1;
  const auto some = std::min(static_cast<std::size_t>(count), source.bytes.size() - source.at);
  source.at += some;
  return static_cast<OPJ_OFF_T>(some);
}

OPJ_BOOL seek_to(OPJ_OFF_T place, void* data) {
  auto& source = *static_cast<Source*>(data);
  if (place < 0 || static_cast<std::size_t>(place) > source.bytes.size()) return OPJ_FALSE;
  source.at = static_cast<std::size_t>(place);
  return OPJ_TRUE;
}

/// The first error message of OpenJPEG.
using Complaint = std::array<char, 200>;

void keep_complaint(const char* message, void* data) {
  auto& text = *static_cast<Complaint*>(data);
  if (text[0] != '\0' || message == nullptr) return;
  std::strncpy(text.data(), message, text.size() - 1);
  for (char& letter : text)
    if (letter == '\n') letter = '\0';
}

void keep_quiet(const char*, void*) {}

template <class T, auto Destroy>
struct Owner {
  void operator()(T* what) const { Destroy(what); }
};
template <class T, auto Destroy>
using Owned = std::unique_ptr<T, Owner<T, Destroy>>;

constexpr std::array<unsigned char, 4> kCodeStream = {0xff, 0x4f, 0xff, 0x51};  // SOC, SIZ
constexpr std::array<unsigned char, 8> kJp2 = {0, 0, 0, 12, 'j', 'P', ' ', ' '};

template <std::size_t N>
bool begins_with(std::span<const unsigned char> bytes, const std::array<unsigned char, N>& beginning) noexcept {
  return bytes.size() >= N && std::equal(beginning.begin(), beginning.end(), bytes.begin());
}

/// One decoding by OpenJPEG.
class Decoder {
 public:
  Decoder(std::span<const unsigned char> bytes, const std::string& label)
      : label_(label),
        source_{bytes},
        codec_(opj_create_decompress(begins_with(bytes, kJp2) ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K)),
        stream_(opj_stream_default_create(OPJ_TRUE)) {
    if (!codec_ || !stream_) throw std::bad_alloc();
    opj_set_error_handler(codec_.get(), keep_complaint, &error_);
    opj_set_warning_handler(codec_.get(), keep_complaint, &warning_);
    opj_set_info_handler(codec_.get(), keep_quiet, nullptr);
    opj_stream_set_read_function(stream_.get(), read_some);
    opj_stream_set_skip_function(stream_.get(), skip_some);
    opj_stream_set_seek_function(stream_.get(), seek_to);
    opj_stream_set_user_data(stream_.get(), &source_, nullptr);
    opj_stream_set_user_data_length(stream_.get(), bytes.size());
  }

  /// Decodes the image if it is grey and has this size; checked before memory for samples is allocated.
  Jpeg2000Image decode(std::size_t columns, std::size_t rows) {
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    opj_image_t* header = nullptr;
    const bool has_header = opj_setup_decoder(codec_.get(), &parameters) == OPJ_TRUE &&
                            opj_decoder_set_strict_mode(codec_.get(), OPJ_TRUE) == OPJ_TRUE &&
                            opj_read_header(stream_.get(), codec_.get(), &header) == OPJ_TRUE;
    const Owned<opj_image_t, opj_image_destroy> image(header);
    if (!has_header || !image) fail_by_complaint("whose header cannot be read");
    require_grey(*image, columns, rows);
    if (opj_decode(codec_.get(), stream_.get(), image.get()) != OPJ_TRUE ||
        opj_end_decompress(codec_.get(), stream_.get()) != OPJ_TRUE)
      fail_by_complaint("that is damaged or truncated");
    require_grey(*image, columns, rows);  // again: a palette in JP2 changes the components
    const opj_image_comp_t& grey = image->comps[0];
    if (grey.data == nullptr) fail_by_complaint("without samples");
    return {{grey.data, grey.data + columns * rows}, static_cast<int>(grey.prec)};
  }

 private:
  [[noreturn]] void fail_by_complaint(std::string_view what) const {
    throw Error(ErrorCode::MalformedFile,
                fmt::format("{}: a JPEG 2000 code stream of {} bytes {} ({}); expected a whole one", label_,
                            source_.bytes.size(), what, (error_[0] != '\0' ? error_ : warning_).data()));
  }

  void require_grey(const opj_image_t& image, std::size_t columns, std::size_t rows) const {
    if (image.numcomps != 1)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("{}: {} numbers per sample in JPEG 2000; expected 1", label_, image.numcomps));
    const opj_image_comp_t& grey = image.comps[0];
    const std::size_t width = image.x1 - image.x0;
    const std::size_t height = image.y1 - image.y0;
    // OpenJPEG computes in 32 bits, some of which wavelets and its encoder need: beyond 24 bits, decoding its own
    // streams gives wrong values.
    constexpr OPJ_UINT32 kMost = 24;
    if (width != columns || height != rows || grey.dx != 1 || grey.dy != 1 || (grey.w != 0 && grey.w != columns) ||
        (grey.h != 0 && grey.h != rows))
      throw Error(
          ErrorCode::MalformedFile,
          fmt::format("{}: {} x {} samples in JPEG 2000, {} x {} apart; expected {} x {}, as the header has them",
                      label_, width, height, grey.dx, grey.dy, columns, rows));
    if (grey.prec < 1 || grey.prec > kMost)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("{}: {} bits per sample in JPEG 2000; expected 1 to {}", label_, grey.prec, kMost));
  }

  const std::string& label_;
  Source source_;
  Complaint error_{};
  Complaint warning_{};
  Owned<opj_codec_t, opj_destroy_codec> codec_;
  Owned<opj_stream_t, opj_stream_destroy> stream_;
};

}  // namespace

bool has_jpeg2000() noexcept { return true; }

bool begins_jpeg2000(std::span<const unsigned char> bytes) noexcept {
  return begins_with(bytes, kCodeStream) || begins_with(bytes, kJp2);
}

Jpeg2000Image decode_jpeg2000(std::span<const unsigned char> bytes, std::size_t columns, std::size_t rows,
                              const std::string& label) {
  if (!begins_jpeg2000(bytes))
    throw Error(ErrorCode::MalformedFile,
                fmt::format("{}: {} bytes that do not begin a JPEG 2000 code stream; expected ff 4f ff 51", label,
                            bytes.size()));
  return Decoder(bytes, label).decode(columns, rows);
}

}  // namespace tegl::io_detail
