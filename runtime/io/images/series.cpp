// SPDX-License-Identifier: BSD-3-Clause
//
// Implements file series as one image: options, and the choice of readers. The files are combined in members.cpp.
#include "tegl/io/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "base/reading_process.hpp"
#include "base/time_units.hpp"
#include "dicom/dicom.hpp"
#include "images/images.hpp"
#include "images/layers.hpp"
#include "images/members.hpp"
#include "process/separate_reading.hpp"
#include "tegl/curved.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

ReadImageOptions member_options(const SeriesOptions& options, const Progress& progress) {
  return {.variable = options.variable,
          .work = {.progress = progress},
          .fixed = options.fixed,
          .allow_outside_paths = options.allow_outside_paths,
          .keep_stored = options.keep_stored,
          .as_cubic = options.as_cubic};
}

RawImage read_member(const fs::path& path, Extent extent, const SeriesOptions& options, const Progress& progress) {
  if (!options.raw) return read_any(path, extent, member_options(options, progress));
  const RawLayers layers = open_raw(path, *options.raw);
  const std::size_t count = extent == Extent::whole ? layers.grid.axes.back().size() : 0;
  RawImage image{layers.grid, layers.read(0, count), layers.info};
  drop_trailing_axes(image.grid, image.info);
  return image;
}

void require_sound(std::span<const fs::path> files, const SeriesOptions& options) {
  if (files.empty()) throw Error(ErrorCode::InvalidArgument, "no files; expected at least one");
  if (!options.coordinates.empty() && options.step)
    throw Error(ErrorCode::InvalidArgument, "coordinates and a step; expected one of the two");
  if (!options.coordinates.empty() && options.coordinates.size() != files.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} coordinates for {} files; expected one for each",
                                                        options.coordinates.size(), files.size()));
  if (options.step && !std::isnormal(*options.step))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("a step of {}; expected a finite number, of a size of at least {:.2g}", *options.step,
                            std::numeric_limits<double>::min()));
}

/// `keep_stored`: see ReadImageOptions.
RawLayers open_dicom_files(std::span<const fs::path> files, bool keep_stored, const SeriesOptions& options) {
  if (!options.coordinates.empty() || options.step || !options.unit.empty() || options.order != SeriesOrder::given)
    fail(ErrorCode::InvalidArgument, files[0],
         "is a DICOM file, which contains its position; expected no coordinates, step, unit or order");
  if (!options.fixed.empty())
    fail(ErrorCode::InvalidArgument, files[0], "is a DICOM file, which has no dimension '{}'; expected no fixed index",
         options.fixed[0].dimension);
  return open_dicom(files, options.variable, keep_stored, options.work.progress);
}

MemberReader reader_of(const SeriesOptions& options) {
  return [options](const fs::path& path, Extent extent, const Progress& progress) {
    return read_member(path, extent, options, progress);
  };
}

LayersOfFiles open_several(std::span<const fs::path> files, SeriesOptions options) {
  options.keep_stored = false;
  if (options.raw) {
    LayersOfFiles opened = open_members(files, options, reader_of(options));
    opened.layers.info.remarks = remarks_on_rest(opened.files, *options.raw);
    return opened;
  }
  if (!are_dicom_files(files)) return open_members(files, options, reader_of(options));
  return {open_dicom_files(files, false, options), {files.begin(), files.end()}};
}

ImageOfFiles all_layers(LayersOfFiles&& opened) {
  auto& [layers, files] = opened;
  ValueArray values = layers.read(0, layers.grid.axes.back().size());
  return {{std::move(layers.grid), std::move(values), std::move(layers.info)}, std::move(files)};
}

/// Reads one or several files in this process.
ImageOfFiles read_files(std::span<const fs::path> files, const SeriesOptions& options) {
  if (files.size() == 1) return {read_member(files[0], Extent::whole, options, options.work.progress), {files[0]}};
  if (options.keep_stored && !options.raw) {
    if (are_dicom_files(files))
      return all_layers({open_dicom_files(files, true, options), {files.begin(), files.end()}});
    // If a file has missing values, all files are read again: progress then waits.
    SeriesOptions own = options;
    if (options.work.progress)
      own.work.progress = [&options, most = 0.0](double share) mutable {
        most = std::max(most, share);
        return options.work.progress(most);
      };
    if (auto stored = read_stored_members(files, own, reader_of(own))) return std::move(*stored);
    return all_layers(open_several(files, own));
  }
  return all_layers(open_several(files, options));
}

LayersOfFiles open_files(std::span<const fs::path> files, const SeriesOptions& options) {
  if (files.size() > 1) return open_several(files, options);
  return {options.raw ? open_raw(files[0], *options.raw)
                      : open_any_layers(files[0], member_options(options, options.work.progress)),
          {files[0]}};
}

bool is_read_separately(std::span<const fs::path> files, const SeriesOptions& options) {
  return options.separate_process && !options.raw && needs_separate_process(files);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

namespace {

/// Reads the files, in a child process if needed.
ImageOfFiles read_raw(std::span<const fs::path> files, const SeriesOptions& options) {
  require_sound(files, options);
  const auto read = [&](const Progress& progress) {
    SeriesOptions own = options;
    own.work.progress = progress;
    return read_files(files, own);
  };
  ImageOfFiles result = is_read_separately(files, options) ? read_separately(files[0], options.work.progress, read)
                                                           : read(options.work.progress);
  result.image.info.curved = by_points(std::move(result.image.info.curved), options.work.threads);  // as in read_image
  return result;
}

ReadSeriesResult series_of(ImageOfFiles&& read, std::span<const fs::path> files, const SeriesOptions& options) {
  ImageInfo info = read.image.info;  // errors about the axes name the format
  AnyImage result = to_any_image(std::move(read.image), files[0]);
  tick(options.work.progress, 1.0, files[0]);
  return {{std::move(result), std::move(info)}, std::move(read.files)};
}

}  // namespace

ReadSeriesResult read_series(std::span<const fs::path> files, const SeriesOptions& options) {
  return series_of(read_raw(files, options), files, options);
}

std::variant<ReadSeriesResult, ReadSeries5dResult> read_series_to_5d(std::span<const fs::path> files,
                                                                     const SeriesOptions& options) {
  ImageOfFiles read = read_raw(files, options);
  if (read.image.grid.axes.size() != 5) return series_of(std::move(read), files, options);
  ImageInfo info = std::move(read.image.info);
  AnyImage5d result = to_image_5d(std::move(read.image));
  tick(options.work.progress, 1.0, files[0]);
  return ReadSeries5dResult{{std::move(result), std::move(info)}, std::move(read.files)};
}

OpenSeriesResult open_series(std::span<const fs::path> files, const SeriesOptions& options) {
  require_sound(files, options);
  const auto open = [&](const Progress& progress) {
    SeriesOptions own = options;
    own.work.progress = progress;
    return open_files(files, own);
  };
  LayersOfFiles opened = open_reporting(files[0], options.work.progress, is_read_separately(files, options), open);
  return {to_open_layers(std::move(opened.layers), files[0]), std::move(opened.files)};
}

bool are_dicom_files(std::span<const fs::path> files) {
  return std::all_of(files.begin(), files.end(),
                     [](const fs::path& file) { return is_dicom(file) && !fs::is_directory(file); });
}

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    const auto run = [](std::string_view text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string_view left = run(a, i);
    const std::string_view right = run(b, j);
    if (left.size() != right.size()) return left.size() < right.size();
    if (left != right) return left < right;
  }
  if ((a.size() - i) != (b.size() - j)) return a.size() - i < b.size() - j;
  return a < b;
}

}  // namespace tegl
