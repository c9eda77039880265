// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers and values of single DICOM files through DCMTK, which decompresses JPEG, JPEG-LS, RLE and deflate.
// OpenJPEG decompresses JPEG 2000. (GDCM supports both, but Debian's build of it aborts the program on a truncated
// file.)
//
// Based on: NEMA PS3.3 (DICOM Information Object Definitions), C.7.6.2 (image plane), C.7.6.16 (functional groups of
// enhanced multi-frame images), C.11.1 (modality LUT).
#include "dicom/dicom_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <type_traits>

#include <Eigen/Geometry>

#include <dcmtk/config/osconfig.h>

#include <dcmtk/dcmdata/dctk.h>

#include <dcmtk/dcmdata/dccodec.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/named_path.hpp"
#include "base/raw_image.hpp"
#include "base/reading_process.hpp"
#include "dicom/dicom_frames.hpp"
#include "dicom/dicom_nesting.hpp"
#include "dicom/jpeg2000.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Tag = DcmTagKey;

/// Silences DCMTK's log and registers its codecs. Both are global to the process.
void prepare_dcmtk() {
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    dcmEnableUnknownVRConversion.set(OFTrue);  // some archives omit the types of private elements, as in doses
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
    DcmRLEDecoderRegistration::registerCodecs();
  });
}

/// Length of the UTF-8 character at the start of the text; 0 if it is invalid.
std::size_t utf8_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return 0;
  // Rejects overlong forms, surrogates, and code points beyond the last character.
  const auto second = length > 1 ? static_cast<unsigned char>(text[1]) : 0;
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return wrong ? 0 : length;
}

/// Converts a text to UTF-8: DCMTK has converted texts with a declared character set; other bytes are read as Latin-1.
std::string as_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length > 0) {
      result += text.substr(0, length);
    } else {
      const auto byte = static_cast<unsigned char>(text[0]);
      result += static_cast<char>(0xc0 | byte >> 6);
      result += static_cast<char>(0x80 | (byte & 0x3f));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string text_of(DcmItem& data, const Tag& tag) {
  OFString text;
  if (data.findAndGetOFStringArray(tag, text).bad()) return {};
  return as_utf8(trim(std::string_view(text.c_str(), text.size())));
}

/// Parses numbers separated by backslashes; empty if one of them is invalid.
std::vector<double> numbers_of(DcmItem& data, const Tag& tag) {
  const std::string text = text_of(data, tag);
  std::vector<double> numbers;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t end = std::min(text.find('\\', begin), text.size());
    double number = 0;
    if (!parse_number(trim(std::string_view(text).substr(begin, end - begin)), number)) return {};
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

std::optional<double> number_of(DcmItem& data, const Tag& tag) {
  const std::vector<double> numbers = numbers_of(data, tag);
  return numbers.empty() ? std::optional<double>() : numbers.front();
}

/// Calls `use` with item `index` (from 0) of a sequence, if it exists.
template <class Use>
void with_item(DcmItem& data, const Tag& tag, std::size_t index, const Use& use) {
  DcmItem* item = nullptr;
  if (data.findAndGetSequenceItem(tag, item, static_cast<long>(index)).good() && item != nullptr) use(*item);
}

/// Seconds of "HHMMSS.ffffff".
std::optional<double> seconds_of(std::string_view text) {
  if (text.size() < 2) return {};
  double hours = 0, minutes = 0, seconds = 0;
  if (!parse_number(text.substr(0, 2), hours)) return {};
  if (text.size() >= 4 && !parse_number(text.substr(2, 2), minutes)) return {};
  if (text.size() >= 6 && !parse_number(text.substr(4), seconds)) return {};
  return 3600 * hours + 60 * minutes + seconds;
}

/// Days from 1970 to "YYYYMMDD"; 0 for other texts.
double days_of(std::string_view text) {
  double year = 0, month = 0, day = 0;
  if (text.size() < 8 || !parse_number(text.substr(0, 4), year) || !parse_number(text.substr(4, 2), month) ||
      !parse_number(text.substr(6, 2), day))
    return 0;
  // Howard Hinnant, "chrono-compatible low-level date algorithms": days_from_civil.
  const double y = month <= 2 ? year - 1 : year;
  const double era = std::floor(y / 400);
  const double of_era = y - era * 400;
  const double of_year = std::floor((153 * (month + (month > 2 ? -3 : 9)) + 2) / 5) + day - 1;
  constexpr double kTo1970 = 719468;
  return era * 146097 + of_era * 365 + std::floor(of_era / 4) - std::floor(of_era / 100) + of_year - kTo1970;
}

constexpr double kDay = 86400;

/// Seconds from 1970 to "YYYYMMDDHHMMSS.ffffff".
std::optional<double> moment_of(std::string_view text) {
  if (text.size() < 10) return {};
  text = text.substr(0, text.find_first_of("+-"));
  const auto seconds = seconds_of(text.substr(8));
  return seconds ? std::optional(kDay * days_of(text) + *seconds) : std::nullopt;
}

/// Reads the fields of a plane from a data set: that of the file, or of a functional group.
void read_plane(DcmItem& data, DicomFrame& frame) {
  const std::vector<double> position = numbers_of(data, Tag(0x0020, 0x0032));
  if (position.size() == 3) frame.position = Eigen::Vector3d(position[0], position[1], position[2]);
  const std::vector<double> d = numbers_of(data, Tag(0x0020, 0x0037));
  if (d.size() == 6) {
    Eigen::Matrix<double, 3, 2> directions;
    directions << d[0], d[3], d[1], d[4], d[2], d[5];
    if (directions.col(0).cross(directions.col(1)).norm() > 0.5) frame.directions = directions.colwise().normalized();
  }
  for (const Tag& tag : {Tag(0x0028, 0x0030), Tag(0x0018, 0x1164)}) {
    const std::vector<double> spacing = numbers_of(data, tag);  // distance between rows comes first
    if (frame.spacing || spacing.size() != 2 || !(spacing[0] > 0 && spacing[1] > 0)) continue;
    frame.spacing = Eigen::Vector2d(spacing[1], spacing[0]);
  }
  frame.intercept = number_of(data, Tag(0x0028, 0x1052)).value_or(frame.intercept);
  frame.slope = number_of(data, Tag(0x0028, 0x1053)).value_or(frame.slope);
}

void read_times(DcmItem& data, DicomFrame& frame) {
  frame.temporal_position = number_of(data, Tag(0x0020, 0x0100));
  frame.trigger_time = number_of(data, Tag(0x0018, 0x1060));
  frame.acquisition_time = moment_of(text_of(data, Tag(0x0008, 0x002a)));
  if (frame.acquisition_time) return;
  if (const auto seconds = seconds_of(text_of(data, Tag(0x0008, 0x0032))))
    frame.acquisition_time = kDay * days_of(text_of(data, Tag(0x0008, 0x0022))) + *seconds;
}

/// Reads a functional group, shared or of one frame.
void read_group(DcmItem& group, DicomFrame& frame) {
  const auto plane = [&](DcmItem& data) { read_plane(data, frame); };
  for (const Tag& tag : {Tag(0x0020, 0x9113), Tag(0x0020, 0x9116), Tag(0x0028, 0x9145)})
    with_item(group, tag, 0, plane);
  with_item(group, Tag(0x0028, 0x9110), 0, [&](DcmItem& data) {
    frame.spacing.reset();
    read_plane(data, frame);
  });
  with_item(group, Tag(0x0020, 0x9111), 0, [&](DcmItem& data) {
    if (const auto index = number_of(data, Tag(0x0020, 0x9128))) frame.temporal_position = index;
    if (const auto moment = moment_of(text_of(data, Tag(0x0018, 0x9074)))) frame.acquisition_time = moment;
  });
  with_item(group, Tag(0x0018, 0x9118), 0, [&](DcmItem& data) {
    if (const auto delay = number_of(data, Tag(0x0020, 0x9153))) frame.trigger_time = delay;
  });
}

/// Computes positions of frames in multi-frame files without functional groups: doses and nuclear medicine, with a
/// fixed distance between frames.
void place_frames(DcmItem& data, DicomFile& file) {
  file.frame_time = number_of(data, Tag(0x0018, 0x1063));
  const DicomFrame first = file.frames.front();
  if (file.frame_time || !first.position || !first.directions) return;
  const Eigen::Vector3d normal = first.directions->col(0).cross(first.directions->col(1));
  const std::vector<double> offsets = numbers_of(data, Tag(0x3004, 0x000c));
  const auto step = number_of(data, Tag(0x0018, 0x0088));
  for (std::size_t i = 0; i < file.frames.size(); ++i) {
    const double along =
        offsets.size() == file.frames.size() ? offsets[i] - offsets[0] : static_cast<double>(i) * step.value_or(0.0);
    file.frames[i].position = *first.position + along * normal;
    if (offsets.empty() && !step) file.frames[i].position.reset();  // unknown position
  }
}

void read_frames(DcmItem& data, DicomFile& file) {
  const double declared = number_of(data, Tag(0x0028, 0x0008)).value_or(1.0);
  constexpr double kMost = 1e6;
  if (!(declared >= 1 && declared <= kMost))
    fail(ErrorCode::MalformedFile, file.path, "{} frames; expected 1 to {}", declared, kMost);
  DicomFrame all;
  read_plane(data, all);
  read_times(data, all);
  if (const auto scaling = number_of(data, Tag(0x3004, 0x000e))) all.slope = *scaling;
  with_item(data, Tag(0x5200, 0x9229), 0, [&](DcmItem& group) { read_group(group, all); });
  file.frames.assign(static_cast<std::size_t>(declared), all);
  const Tag per_frame(0x5200, 0x9230);
  if (data.tagExists(per_frame)) {
    for (std::size_t i = 0; i < file.frames.size(); ++i)
      with_item(data, per_frame, i, [&](DcmItem& group) { read_group(group, file.frames[i]); });
  } else if (file.frames.size() > 1) {
    place_frames(data, file);
  }
}

void read_type(DcmItem& data, DicomFile& file) {
  const double samples = number_of(data, Tag(0x0028, 0x0002)).value_or(1);
  const std::string colours = text_of(data, Tag(0x0028, 0x0004));
  if (samples != 1 || colours.starts_with("PALETTE"))
    fail(ErrorCode::UnsupportedData, file.path, "{} of {} numbers per sample; expected grey values", colours, samples);
  if (data.tagExists(Tag(0x0028, 0x3000)))
    fail(ErrorCode::UnsupportedData, file.path, "values by a Modality LUT; expected a slope and an intercept");
  const double allocated = number_of(data, Tag(0x0028, 0x0100)).value_or(0);
  const double stored = number_of(data, Tag(0x0028, 0x0101)).value_or(allocated);
  const bool is_signed = number_of(data, Tag(0x0028, 0x0103)).value_or(0) == 1;
  if ((allocated != 8 && allocated != 16 && allocated != 32) || !(stored >= 1 && stored <= allocated))
    fail(ErrorCode::UnsupportedData, file.path, "values of {} bits, {} of them used; expected 8, 16 or 32 bits",
         allocated, stored);
  const double high = number_of(data, Tag(0x0028, 0x0102)).value_or(stored - 1);
  if (!(high >= stored - 1 && high < allocated))
    fail(ErrorCode::MalformedFile, file.path, "the high bit {} of {} stored of {}; expected {} to {}", high, stored,
         allocated, stored - 1, allocated - 1);
  file.bits_stored = static_cast<int>(stored);
  file.high_bit = static_cast<int>(high);
  file.type = fmt::format("{}int{}", is_signed ? "" : "u", allocated);
  file.least = is_signed ? -std::exp2(stored - 1) : 0.0;
  file.most = std::exp2(is_signed ? stored - 1 : stored) - 1;
}

constexpr Uint32 kSmallElement = 4096;  // larger elements stay in the file until they are accessed

/// Reads a file, with elements up to `largest` bytes. Returns an error if the file is damaged; elements before the
/// damage may have been read.
std::optional<Error> try_to_load(DcmFileFormat& file, const fs::path& path, Uint32 largest) {
  if (auto fault = nesting_fault(path)) return fault;
  prepare_dcmtk();
  const OFCondition status = file.loadFile(path.c_str(), EXS_Unknown, EGL_noChange, largest, ERM_autoDetect);
  if (status.good() && file.getDataset() != nullptr && file.getDataset()->card() > 0) return {};
  return Error(ErrorCode::MalformedFile, fmt::format("{}: not a readable DICOM file ({})", path.string(),
                                                     status.bad() ? status.text() : "it is empty"));
}

void load(DcmFileFormat& file, const fs::path& path, Uint32 largest) {
  if (const auto fault = try_to_load(file, path, largest)) throw *fault;
}

bool is_jpeg2000(E_TransferSyntax syntax) { return syntax == EXS_JPEG2000LosslessOnly || syntax == EXS_JPEG2000; }

/// The name of a transfer syntax that is newer than this DCMTK.
std::string_view name_of_later_syntax(std::string_view uid) {
  struct Name {
    std::string_view uid;  ///< UID or prefix of UIDs
    std::string_view name;
  };
  constexpr std::array<Name, 6> kNames = {{{"1.2.840.10008.1.2.4.20", "High-Throughput JPEG 2000 (HTJ2K)"},
                                           {"1.2.840.10008.1.2.4.11", "JPEG XL"},
                                           {"1.2.840.10008.1.2.4.10", "MPEG video"},
                                           {"1.2.840.10008.1.2.7.", "SMPTE ST 2110 video"},
                                           {"1.2.840.10008.1.2.8.", "Deflated Image Frame"},
                                           {"", "a transfer syntax without a name here"}}};
  return std::find_if(kNames.begin(), kNames.end(), [&](const Name& name) { return uid.starts_with(name.uid); })->name;
}

/// Throws unless the pixels can be decompressed.
void require_decodable(DcmFileFormat& format, const fs::path& path) {
  const E_TransferSyntax stored_as = format.getDataset()->getOriginalXfer();
  const DcmXfer syntax(stored_as);
  const std::string told = text_of(*format.getMetaInfo(), DCM_TransferSyntaxUID);
  const bool known = told.empty() || DcmXfer(told.c_str()).getXfer() != EXS_Unknown;  // else read as plain
  const bool elsewhere = stored_as == EXS_JPIPReferenced || stored_as == EXS_JPIPReferencedDeflate;
  const bool decodable = !syntax.isEncapsulated() ||
                         DcmCodecList::canChangeCoding(stored_as, EXS_LittleEndianExplicit) ||
                         (is_jpeg2000(stored_as) && has_jpeg2000());
  if (known && !elsewhere && decodable) return;
  fail(
      ErrorCode::UnsupportedFormat, path,
      "pixels stored as {} ({}), which is not supported; expected uncompressed ones, JPEG, JPEG-LS, RLE or JPEG 2000{}",
      known ? syntax.getXferName() : name_of_later_syntax(told), known ? syntax.getXferID() : told,
      has_jpeg2000() ? "" : " (that in builds with OpenJPEG, libopenjp2-7-dev)");
}

/// Throws if a file is too short for the values in its header, before memory is allocated. (The size of compressed
/// values is checked during decompression.)
void require_bytes(const DicomFile& file, E_TransferSyntax stored_as) {
  const DcmXfer syntax(stored_as);
  if (syntax.isEncapsulated() || syntax.getStreamCompression() != ESC_none) return;
  const std::vector<std::uint64_t> sizes = {file.columns, file.rows, file.frames.size()};
  const std::uint64_t bits = file.type.ends_with("32") ? 32 : file.type.ends_with("16") ? 16 : 8;
  const std::uint64_t needed = checked_bytes(sizes, bits / 8, file.path);
  if (const std::uintmax_t there = fs::file_size(file.path); there < needed)
    fail(ErrorCode::MalformedFile, file.path, "{} bytes; expected at least {} of pixels, for {} of type {}", there,
         needed, shape_text(sizes), file.type);
}

/// Requests memory and time for the pixels, limited by the maximum compression of the file.
void expect_pixels(const DicomFile& file) {
  const std::vector<std::uint64_t> sizes = {file.columns, file.rows, file.frames.size()};
  const std::uint64_t count = std::min(checked_bytes(sizes, 1, file.path), kMostExpansion * size_of_file(file.path));
  expect_memory(kBytesPerValue * count);
  expect_step(4 * count);
}

/// Shifts the stored bits of each value down and extends the sign: other bits of the cell are undefined.
template <class T>
void keep_stored_bits(ValueVector<T>& values, const DicomFile& file) {
  using Unsigned = std::make_unsigned_t<T>;
  const int unused = static_cast<int>(8 * sizeof(T)) - file.bits_stored;
  const int above = static_cast<int>(8 * sizeof(T)) - 1 - file.high_bit;
  if (unused == 0) return;
  for (T& value : values)
    value = static_cast<T>(static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(value) << above)) >> unused);
}

}  // namespace

void load_dicom_dictionary() {
  dcmDataDict.rdlock();  // loads the dictionary at the first call
  dcmDataDict.rdunlock();
}

bool is_dicom_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  const std::string name = lower_name(path);
  for (const char* const extension : {".dcm", ".dicom", ".ima"})
    if (name.ends_with(extension)) return true;
  try {
    const auto bytes = read_bytes(path, 128, 4);
    return bytes.size() == 4 && std::memcmp(bytes.data(), "DICM", 4) == 0;
  } catch (const Error&) {
    return false;
  }
}

bool begins_as_dicom(const fs::path& path) {
  constexpr std::size_t kPreamble = 128;
  const auto bytes = read_bytes(path, 0, kPreamble + 4);
  if (bytes.size() == kPreamble + 4 && std::memcmp(bytes.data() + kPreamble, "DICM", 4) == 0) return true;
  // No preamble: the first element's tag has group 2 or 8, in little endian.
  return bytes.size() >= 4 && (bytes[0] == 2 || bytes[0] == 8) && bytes[1] == 0 && bytes[3] == 0;
}

std::optional<DicomFile> read_dicom_header(const fs::path& path) {
  now_reading(path);
  // load
  DcmFileFormat format;
  const auto damage = try_to_load(format, path, kSmallElement);
  if (damage && (format.getDataset() == nullptr || !format.getDataset()->tagExists(DCM_SeriesInstanceUID)))
    throw *damage;
  DcmItem& data = *format.getDataset();
  if (!damage && (!data.tagExists(DCM_Rows) || !data.tagExists(DCM_BitsAllocated))) return {};
  format.getDataset()->convertToUTF8();  // if the character set is declared and known
  // series and sizes
  DicomFile file;
  file.path = path;
  file.series = text_of(data, DCM_SeriesInstanceUID);
  file.description = text_of(data, DCM_SeriesDescription);
  file.modality = text_of(data, DCM_Modality);
  file.value_unit = text_of(data, DCM_RescaleType);
  if (file.value_unit == "US") file.value_unit.clear();  // "unspecified"
  if (file.value_unit.empty() && file.modality == "CT") file.value_unit = "HU";
  file.series_number = number_of(data, DCM_SeriesNumber).value_or(0);
  file.rows = static_cast<std::size_t>(number_of(data, DCM_Rows).value_or(0));
  file.columns = static_cast<std::size_t>(number_of(data, DCM_Columns).value_or(0));
  // pixels; errors are stored
  try {
    file.frames.resize(1);  // at least one frame
    if (damage) throw *damage;
    if (file.rows == 0 || file.columns == 0)
      fail(ErrorCode::MalformedFile, path, "{} x {} samples; expected at least one", file.columns, file.rows);
    read_type(data, file);
    read_frames(data, file);
    require_decodable(format, path);
    require_bytes(file, format.getDataset()->getOriginalXfer());
  } catch (const Error& error) {
    file.fault = error;
  }
  return file;
}

ValueArray read_dicom_values(const DicomFile& file) {
  now_reading(file.path);
  expect_pixels(file);
  DcmFileFormat format;
  load(format, file.path, DCM_MaxReadLength);
  DcmDataset& data = *format.getDataset();
  const std::vector<std::uint64_t> sizes = {file.columns, file.rows, file.frames.size()};
  // decompress
  if (is_jpeg2000(data.getOriginalXfer())) return read_jpeg2000_frames(data, file);
  if (data.getOriginalXfer() == EXS_RLELossless) require_whole_rle(data, file);
  const DcmXfer syntax(data.getOriginalXfer());
  if (data.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad() ||
      !data.canWriteXfer(EXS_LittleEndianExplicit, data.getOriginalXfer()))
    fail(ErrorCode::MalformedFile, file.path, "pixels that cannot be decompressed; expected undamaged ones as {}",
         syntax.getXferName());
  // copy the values
  ValueArray values = array_of_type(file.type);
  std::visit(
      [&]<class T>(ValueVector<T>& all) {
        const std::uint64_t needed = checked_bytes(sizes, sizeof(T), file.path);
        const void* bytes = nullptr;
        unsigned long count = 0;  // of bytes or of 16-bit words
        OFCondition status;
        if constexpr (sizeof(T) == 1) {
          const Uint8* found = nullptr;
          status = data.findAndGetUint8Array(DCM_PixelData, found, &count);
          bytes = found;
        } else {
          const Uint16* found = nullptr;
          status = data.findAndGetUint16Array(DCM_PixelData, found, &count);
          bytes = found;
        }
        const std::uint64_t there = sizeof(T) == 1 ? count : 2 * std::uint64_t{count};
        if (status.bad() || bytes == nullptr || there < needed)  // odd sizes are padded
          fail(ErrorCode::MalformedFile, file.path, "{} bytes of pixels; expected {} for {} of type {}",
               status.bad() ? 0 : there, needed, shape_text(sizes), file.type);
        if constexpr (std::is_integral_v<T> && sizeof(T) <= 4) {
          all.resize(needed / sizeof(T));
          std::memcpy(all.data(), bytes, needed);
          keep_stored_bits(all, file);
        }
      },
      values);
  return values;
}

namespace {

/// The path of a file in a DICOMDIR. It must lie beside the DICOMDIR or below (PS3.10, section 8.5); no option allows
/// other places.
fs::path path_in_directory(const fs::path& directory, const std::string& name) {
  try {
    return named_path(directory, name, false);
  } catch (const Error&) {
    fail(ErrorCode::MalformedFile, directory, "names the file {}; expected one in its own folder or below it",
         shown(name));
  }
}

}  // namespace

std::vector<fs::path> read_dicomdir(const fs::path& path) {
  now_reading(path);
  DcmFileFormat format;
  load(format, path, DCM_MaxReadLength);
  std::vector<fs::path> files;
  DcmItem& data = *format.getDataset();
  DcmItem* record = nullptr;
  for (long i = 0; data.findAndGetSequenceItem(DCM_DirectoryRecordSequence, record, i).good() && record != nullptr;
       ++i) {
    std::string name = text_of(*record, DCM_ReferencedFileID);
    if (name.empty()) continue;
    std::replace(name.begin(), name.end(), '\\', '/');
    // Names on discs are in capitals; copies of them are often in lower case.
    std::error_code error;
    const bool as_is = fs::exists(path.parent_path() / name, error);
    files.push_back(path_in_directory(path, as_is ? name : lower(name)));
  }
  return files;
}

}  // namespace tegl::io_detail
