// SPDX-License-Identifier: BSD-3-Clause
//
// Reads DICOM series as images: groups the files by series, orders their planes by position and time, and reads the
// values plane by plane.
//
// Based on: NEMA PS3.3, C.7.6.2.1.1 (Image Position and Image Orientation).
#include "dicom/dicom.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include <Eigen/Geometry>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "base/reading_process.hpp"
#include "base/stored_integers.hpp"
#include "dicom/dicom_file.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// A frame of one of a series' files.
struct Plane {
  std::size_t file = 0;
  std::size_t frame = 0;
  double along = 0;  ///< position along the normal, mm
};

/// A series with its planes in the image's order: by time, then by position.
struct Volume {
  std::vector<DicomFile> files;
  std::vector<Plane> planes;
  std::size_t places = 1;
  std::size_t times = 1;
  Axis time;  ///< if there are several times

  [[nodiscard]] const DicomFrame& frame(const Plane& plane) const { return files[plane.file].frames[plane.frame]; }
  [[nodiscard]] const fs::path& path(const Plane& plane) const { return files[plane.file].path; }
};

/// Whether macOS created the file, as companion of the file whose name follows the prefix.
bool is_of_finder(const fs::path& path) { return path.filename().string().starts_with("._"); }

/// The files in a folder and below, by name; those of a DICOMDIR; or the file itself, which may be empty if there are
/// others.
std::vector<fs::path> candidates(const fs::path& path, bool among_others) {
  if (!fs::is_directory(path)) {
    std::error_code error;
    if (!among_others || !fs::is_empty(path, error)) require_readable_file(path);
    return lower_name(path) == "dicomdir" ? read_dicomdir(path) : std::vector{path};
  }
  std::vector<fs::path> files;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(path, fs::directory_options::skip_permission_denied))
      if (lower_name(entry.path()) != "dicomdir" && !is_of_finder(entry.path()) && is_dicom_file(entry.path()))
        files.push_back(entry.path());
  } catch (const fs::filesystem_error& error) {
    fail(ErrorCode::FileNotFound, path, "cannot be read ({})", error.code().message());
  }
  std::sort(files.begin(), files.end());
  if (files.empty())
    fail(ErrorCode::FileNotFound, path, "is a directory without DICOM files; expected a file, or a folder with some");
  return files;
}

/// The files with images by series, in the order of series numbers, and remarks about other files.
struct Found {
  std::vector<std::vector<DicomFile>> series;
  std::vector<std::string> remarks;
  std::vector<Error> damaged;  ///< files whose series cannot be read
};

/// Removes series of colours and other unsupported values (screenshots beside a scan), unless all series are
/// unsupported.
void leave_out_unsupported(Found& found) {
  const auto is_unsupported = [](const std::vector<DicomFile>& series) {
    return std::all_of(series.begin(), series.end(), [](const DicomFile& file) {
      return file.fault && file.fault->code() == ErrorCode::UnsupportedData;
    });
  };
  if (std::all_of(found.series.begin(), found.series.end(), is_unsupported)) return;
  for (const auto& files : found.series)
    if (is_unsupported(files))
      found.remarks.push_back(fmt::format("skipped{}: {}",
                                          files.size() == 1 ? "" : fmt::format(", a series of {} files", files.size()),
                                          files.front().fault->what()));
  std::erase_if(found.series, is_unsupported);
}

/// Reads the header of a file among others; nullopt if it contains no image. Adds files that are not DICOM to
/// `strangers`, and damaged ones to `damaged`.
std::optional<DicomFile> read_header_among_others(const fs::path& path, std::vector<fs::path>& strangers,
                                                  std::vector<Error>& damaged) {
  const bool is_stranger = !begins_as_dicom(path);
  std::optional<DicomFile> header;
  try {
    header = read_dicom_header(path);  // DCMTK reads old formats that the first bytes do not identify
  } catch (const Error& error) {
    if (error.code() != ErrorCode::MalformedFile) throw;
    if (!is_stranger) damaged.push_back(error);
  }
  if (!header && is_stranger) strangers.push_back(path);
  return header;
}

/// Returns the series if the values of all its files can be read. Throws the first fault.
std::vector<DicomFile> sound(std::vector<DicomFile>&& series) {
  for (const DicomFile& file : series)
    if (file.fault) throw *file.fault;
  return std::move(series);
}

Found read_all_series(std::span<const fs::path> paths, const Progress& progress) {
  std::map<std::string, std::vector<DicomFile>> by_uid;
  Found found;
  std::vector<fs::path> strangers;
  const bool among_others = paths.size() > 1 || fs::is_directory(paths.front());
  for (const fs::path& path : paths)
    for (const fs::path& file : candidates(path, among_others)) {
      tick(progress, 0.0, file);
      auto header = among_others ? read_header_among_others(file, strangers, found.damaged) : read_dicom_header(file);
      if (header) by_uid[header->series].push_back(std::move(*header));
    }
  for (auto& [uid, files] : by_uid) found.series.push_back(std::move(files));
  if (found.series.empty() && !found.damaged.empty()) throw found.damaged.front();
  if (found.series.empty())
    fail(ErrorCode::UnsupportedData, paths.front(), "contains no DICOM image; expected at least one file with pixels");
  if (!strangers.empty())
    found.remarks.push_back(
        fmt::format("skipped: {}{}: not DICOM, despite the name", strangers.front().string(),
                    strangers.size() == 1 ? "" : fmt::format(" and {} more", strangers.size() - 1)));
  leave_out_unsupported(found);
  std::stable_sort(found.series.begin(), found.series.end(),
                   [](const auto& a, const auto& b) { return a.front().series_number < b.front().series_number; });
  return found;
}

std::size_t frames_of(const std::vector<DicomFile>& files) {
  return std::accumulate(files.begin(), files.end(), std::size_t{0},
                         [](std::size_t count, const DicomFile& file) { return count + file.frames.size(); });
}

std::string listing(const std::vector<std::vector<DicomFile>>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DicomFile& first = all[i].front();
    text += fmt::format("{}{}: {} ({}, '{}', {} slices)", i == 0 ? "" : "; ", i + 1, first.series, first.modality,
                        first.description, frames_of(all[i]));
  }
  return text;
}

/// Selects the series by UID, number in the list, or description.
std::vector<DicomFile> choose(std::vector<std::vector<DicomFile>>&& all, const std::string& wanted,
                              const fs::path& path) {
  if (wanted.empty() && all.size() == 1) return sound(std::move(all.front()));
  if (wanted.empty())
    fail(ErrorCode::VariableNotFound, path, "{} DICOM series, and none chosen; expected one of {}", all.size(),
         listing(all));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].front().series == wanted || all[i].front().description == wanted) found.push_back(i);
  std::uint64_t number = 0;
  if (found.empty() && parse_number(wanted, number) && number >= 1 && number <= all.size())
    found.push_back(static_cast<std::size_t>(number - 1));
  if (found.size() != 1)
    fail(ErrorCode::VariableNotFound, path, "{} DICOM series '{}'; expected one of {}",
         found.empty() ? "no" : "several", wanted, listing(all));
  return sound(std::move(all[found.front()]));
}

/// Throws unless all files have planes of equal size, type, directions and spacing.
void require_alike(const Volume& volume) {
  constexpr double kTolerance = 1e-4;
  const DicomFile& first = volume.files.front();
  const DicomFrame& like = first.frames.front();
  for (const DicomFile& file : volume.files) {
    if (file.columns != first.columns || file.rows != first.rows)
      fail(ErrorCode::UnsupportedData, file.path, "has {} x {} samples; expected {} x {}, as {} of the same series",
           file.columns, file.rows, first.columns, first.rows, first.path.string());
    if (file.type != first.type)
      fail(ErrorCode::UnsupportedData, file.path, "has values of type {}; expected {}, as {} of the same series",
           file.type, first.type, first.path.string());
    for (const DicomFrame& frame : file.frames) {
      const bool one_file = volume.files.size() == 1 && file.frames.size() == 1;
      if (!one_file && file.frames.size() == 1 && (!frame.position || !frame.directions))
        fail(ErrorCode::UnsupportedData, file.path,
             "has no position in space; expected Image Position and Image Orientation (0020,0032), (0020,0037)");
      if (frame.directions.has_value() != like.directions.has_value() ||
          frame.position.has_value() != like.position.has_value() ||
          frame.spacing.has_value() != like.spacing.has_value() ||
          (frame.directions && (*frame.directions - *like.directions).norm() > kTolerance))
        fail(ErrorCode::UnsupportedData, file.path,
             "is not parallel to {} of the same series; expected parallel planes", first.path.string());
      if (frame.spacing && (*frame.spacing - *like.spacing).norm() > 10 * kTolerance * like.spacing->norm())
        fail(ErrorCode::UnsupportedData, file.path, "has samples {} x {} mm apart; expected {} x {}, as {}",
             (*frame.spacing)[0], (*frame.spacing)[1], (*like.spacing)[0], (*like.spacing)[1], first.path.string());
    }
  }
}

bool is_placed(const Volume& volume) {
  const DicomFrame& first = volume.files.front().frames.front();
  return first.position.has_value() && first.directions.has_value();
}

Eigen::Vector3d normal_of(const DicomFrame& frame) { return frame.directions->col(0).cross(frame.directions->col(1)); }

/// A header field that may distinguish the times of planes at one position.
struct TimeKey {
  std::optional<double> DicomFrame::*member;
  const char* unit;
  bool from_zero;  ///< clock times, counted from the first one
};
constexpr std::array<TimeKey, 3> kTimeKeys = {{{&DicomFrame::trigger_time, "ms", false},
                                               {&DicomFrame::temporal_position, "", false},
                                               {&DicomFrame::acquisition_time, "s", true}}};

/// Sorts the planes of each position by this key. Returns true if the key is different for all of them, and its means
/// over the positions are ascending.
bool sort_by_time(Volume& volume, const TimeKey& key) {
  std::vector<Plane> sorted = volume.planes;  // position by position
  std::vector<double> times(volume.times, 0.0);
  for (std::size_t p = 0; p < volume.places; ++p) {
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(p * volume.times);
    const auto end = begin + static_cast<std::ptrdiff_t>(volume.times);
    const auto value = [&](const Plane& plane) { return volume.frame(plane).*key.member; };
    if (!std::all_of(begin, end, [&](const Plane& plane) { return value(plane).has_value(); })) return false;
    std::stable_sort(begin, end, [&](const Plane& a, const Plane& b) { return *value(a) < *value(b); });
    for (std::size_t k = 0; k < volume.times; ++k) {
      const double at = *value(begin[static_cast<std::ptrdiff_t>(k)]);
      if (k > 0 && !(at > *value(begin[static_cast<std::ptrdiff_t>(k) - 1]))) return false;
      times[k] += at / static_cast<double>(volume.places);
    }
  }
  const double first = key.from_zero ? times[0] : 0.0;
  constexpr double kResolution = 1e6;  // the resolution of DICOM's times
  for (double& time : times) time = std::round((time - first) * kResolution) / kResolution;
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end()) return false;
  volume.time = axis_of(times);
  volume.time.name = "t";
  volume.time.unit = key.unit;
  std::vector<Plane> by_time;
  for (std::size_t k = 0; k < volume.times; ++k)
    for (std::size_t p = 0; p < volume.places; ++p) by_time.push_back(sorted[p * volume.times + k]);
  volume.planes = std::move(by_time);
  return true;
}

/// The most frequent count; of equally frequent ones the larger.
std::size_t usual_of(const std::vector<std::size_t>& counts) {
  std::map<std::size_t, std::size_t> times;
  for (const std::size_t count : counts) ++times[count];
  auto usual = times.begin();
  for (auto next = times.begin(); next != times.end(); ++next)
    if (next->second >= usual->second) usual = next;
  return usual->first;
}

/// Sorts the planes by position and time. Throws unless every position has the same number of times, and a key
/// distinguishes them.
void sort_planes(Volume& volume) {
  const Eigen::Vector3d normal = normal_of(volume.files.front().frames.front());
  // sort by position along the normal
  for (Plane& plane : volume.planes) plane.along = normal.dot(*volume.frame(plane).position);
  std::stable_sort(volume.planes.begin(), volume.planes.end(),
                   [](const Plane& a, const Plane& b) { return a.along < b.along; });
  const auto& spacing = volume.files.front().frames.front().spacing;
  const double same = 0.01 * (spacing ? spacing->minCoeff() : 1.0);
  // count planes per position
  std::vector<std::size_t> counts = {0};
  for (std::size_t i = 0; i < volume.planes.size(); ++i) {
    if (i > 0 && volume.planes[i].along - volume.planes[i - 1].along > same) counts.push_back(0);
    ++counts.back();
  }
  volume.places = counts.size();
  volume.times = usual_of(counts);
  for (std::size_t p = 0, first = 0; p < counts.size(); first += counts[p++])
    if (counts[p] != volume.times)
      fail(ErrorCode::UnsupportedData, volume.path(volume.planes[first + counts[p] - 1]),
           "is one of {} slices at {} mm along the normal; expected {}, as at most other positions{} (some slices are "
           "{})",
           counts[p], volume.planes[first].along, volume.times,
           counts[p] == 1 ? "" : fmt::format(": see also {}", volume.path(volume.planes[first]).string()),
           counts[p] > volume.times ? "duplicates" : "missing");
  // sort by time
  if (volume.times == 1) return;
  for (const TimeKey& key : kTimeKeys)
    if (sort_by_time(volume, key)) return;
  fail(ErrorCode::UnsupportedData, volume.path(volume.planes[1]),
       "has the same position as {}, and no time distinguishes {} slices at one position; expected a Trigger Time "
       "(0018,1060), Temporal Position (0020,0100) or Acquisition Time (0008,0032) that does",
       volume.path(volume.planes[0]).string(), volume.times);
}

/// The positions of the planes: on a line, in steps from the first.
struct Stack {
  Eigen::Vector3d step;       ///< mean step between positions
  std::vector<double> steps;  ///< position of each plane in units of `step`; 0, 1, 2 ... if even
  bool even = true;
};

constexpr double kLarger = 1.5;    // times the adjacent distance: larger gaps suggest missing slices
constexpr std::size_t kMeant = 3;  // this many equal gaps in sequence are intended

/// Minimum of a distance and its two neighbours.
double least_around(const std::vector<double>& gaps, std::size_t g) {
  double least = gaps[g];
  if (g > 0) least = std::min(least, gaps[g - 1]);
  if (g + 1 < gaps.size()) least = std::min(least, gaps[g + 1]);
  return least;
}

/// Whether a distance is one of several equal ones: some protocols change the distance within a series.
bool is_meant(const std::vector<double>& gaps, std::size_t g) {
  constexpr double kSame = 0.1;
  const auto alike = [&](std::size_t other) { return std::abs(gaps[other] - gaps[g]) <= kSame * gaps[g]; };
  std::size_t first = g;
  std::size_t last = g;
  while (first > 0 && alike(first - 1)) --first;
  while (last + 1 < gaps.size() && alike(last + 1)) ++last;
  return last - first + 1 >= kMeant;
}

/// Throws if a distance is so much larger than its neighbours that slices are probably missing; names the largest.
void require_none_missing(const Volume& volume, const Stack& stack) {
  std::vector<double> gaps;
  for (std::size_t p = 1; p < stack.steps.size(); ++p)
    gaps.push_back((stack.steps[p] - stack.steps[p - 1]) * stack.step.norm());
  std::optional<std::size_t> worst;
  for (std::size_t g = 0; g < gaps.size(); ++g)
    if (gaps[g] > kLarger * least_around(gaps, g) && !is_meant(gaps, g) && (!worst || gaps[g] > gaps[*worst]))
      worst = g;
  if (!worst) return;
  fail(ErrorCode::UnsupportedData, volume.path(volume.planes[*worst + 1]),
       "lies {:.6g} mm from {}, and the next ones {:.6g} mm apart (slices seem to be missing); expected distances of "
       "at most {} times the neighbouring ones, or {} equal ones in a row; the files on either side of the gap can be "
       "read separately",
       gaps[*worst], volume.path(volume.planes[*worst]).string(), least_around(gaps, *worst), kLarger, kMeant);
}

/// Fits the line through the positions. Throws unless all planes lie on it, at all times, and no slice seems to be
/// missing.
Stack stack_of(const Volume& volume) {
  const std::size_t n = volume.places;
  const Eigen::Vector3d normal = normal_of(volume.files.front().frames.front());
  const auto at = [&](std::size_t plane) { return *volume.frame(volume.planes[plane]).position; };
  if (n == 1) return {normal, {0}};
  Stack stack{(at(n - 1) - at(0)) / static_cast<double>(n - 1), {}};
  constexpr double kTolerance = 0.02;  // of a step: positions are rounded, some to hundredths of a millimetre
  for (std::size_t p = 0; p < n; ++p) {
    stack.steps.push_back(normal.dot(at(p) - at(0)) / normal.dot(stack.step));
    stack.even = stack.even && std::abs(stack.steps[p] - static_cast<double>(p)) <= kTolerance;
  }
  require_none_missing(volume, stack);
  for (std::size_t i = 0; i < volume.planes.size(); ++i) {
    const Eigen::Vector3d beside = at(i) - at(0) - stack.steps[i % n] * stack.step;
    if (beside.norm() > 10 * kTolerance * stack.step.norm())
      fail(ErrorCode::UnsupportedData, volume.path(volume.planes[i]),
           "lies {:.6g} mm away from the line through the other slices; expected slices along a straight line, at any "
           "distances: other grids are not supported",
           beside.norm());
  }
  return stack;
}

/// The remark about slices at uneven distances.
std::string uneven_text(const Stack& stack) {
  double least = stack.steps[1] - stack.steps[0];
  double most = least;
  for (std::size_t p = 1; p < stack.steps.size(); ++p) {
    least = std::min(least, stack.steps[p] - stack.steps[p - 1]);
    most = std::max(most, stack.steps[p] - stack.steps[p - 1]);
  }
  return fmt::format("the slices lie at uneven distances, {:.6g} to {:.6g} mm; their positions are kept",
                     least * stack.step.norm(), most * stack.step.norm());
}

/// The spatial grid of the planes: x, y, and z if there are several positions.
RawImage spatial_grid(const Volume& volume) {
  // matrix and origin
  const DicomFile& first = volume.files.front();
  const DicomFrame& frame = volume.frame(volume.planes.front());
  const Eigen::Vector2d spacing = frame.spacing.value_or(Eigen::Vector2d(1, 1));
  Eigen::MatrixXd affine = Eigen::MatrixXd::Identity(3, 3);
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(3);
  affine(0, 0) = spacing[0];
  affine(1, 1) = spacing[1];
  RawImage image;
  Stack stack;
  if (is_placed(volume)) {
    stack = stack_of(volume);
    affine.leftCols(2) = *frame.directions * spacing.asDiagonal();
    affine.col(2) = stack.step;
    offset = *frame.position;
    image.info.world_frame = "LPS";
  }
  // grid; a rectilinear axis for uneven distances
  image.grid = affine_grid({first.columns, first.rows, volume.places}, affine, offset, first.path);
  if (!stack.even) {
    Axis& along = image.grid.axes[2];
    std::vector<double> coordinates;
    for (const double steps : stack.steps) coordinates.push_back(along.origin() + steps * along.step());
    along = Axis::rectilinear(std::move(coordinates));
    image.info.remarks.push_back(uneven_text(stack));
  }
  // units and names
  for (Axis& axis : image.grid.axes) axis.unit = frame.spacing ? "mm" : "";
  if (!is_placed(volume)) image.grid.axes[2].unit.clear();
  name_axes(image.grid);
  drop_trailing_axes(image.grid, image.info);
  return image;
}

/// Arranges planes without positions: the frames of one file, in its order; they are times if the file defines that.
void arrange_unplaced(Volume& volume) {
  const DicomFile& file = volume.files.front();
  volume.places = volume.planes.size();
  if (!file.frame_time || *file.frame_time <= 0 || volume.planes.size() < 2) return;
  volume.times = volume.planes.size();
  volume.places = 1;
  volume.time = Axis::uniform(volume.times, 0, *file.frame_time);
  volume.time.name = "t";
  volume.time.unit = "ms";
}

Volume arrange(std::vector<DicomFile> files) {
  Volume volume;
  volume.files = std::move(files);
  for (std::size_t f = 0; f < volume.files.size(); ++f)
    for (std::size_t i = 0; i < volume.files[f].frames.size(); ++i) volume.planes.push_back({f, i, 0});
  require_alike(volume);
  if (is_placed(volume) && !volume.files.front().frame_time)
    sort_planes(volume);
  else if (volume.files.size() == 1)
    arrange_unplaced(volume);
  else
    fail(ErrorCode::UnsupportedData, volume.files[1].path,
         "has frames without positions in space, and is one of {} files; expected one such file", volume.files.size());
  return volume;
}

/// The conversion of stored values to the image's values.
struct Rescaling {
  std::string type;  ///< of the result
  bool any = false;
  std::optional<ValueScaling> kept = {};  ///< set if values stay as they are stored
};

/// Selects the value type: the stored type without rescaling; integers if slopes and intercepts are integers and equal
/// for all frames, as in CT; else float, or double for 32-bit values.
Rescaling rescaling_of(const Volume& volume) {
  const DicomFile& first = volume.files.front();
  const double slope = first.frames.front().slope;
  const double intercept = first.frames.front().intercept;
  bool same = true;
  double least = first.least;
  double most = first.most;
  for (const DicomFile& file : volume.files) {
    least = std::min(least, file.least);
    most = std::max(most, file.most);
    for (const DicomFrame& frame : file.frames) {
      if (!std::isfinite(frame.slope) || frame.slope == 0 || !std::isfinite(frame.intercept))
        fail(ErrorCode::MalformedFile, file.path,
             "rescale slope {} and intercept {}; expected finite ones, the slope not 0", frame.slope, frame.intercept);
      same = same && frame.slope == slope && frame.intercept == intercept;
    }
  }
  if (same && slope == 1 && intercept == 0) return {first.type, false};
  const double low = std::min(slope * least, slope * most) + intercept;
  const double high = std::max(slope * least, slope * most) + intercept;
  const bool whole = same && slope == std::floor(slope) && intercept == std::floor(intercept);
  if (whole && low >= -32768 && high <= 32767) return {"int16", true};
  if (whole && low >= -2147483648.0 && high <= 2147483647.0) return {"int32", true};
  return {first.type.ends_with("32") ? "double" : "float", true};
}

std::size_t bytes_of(const std::string& type) {
  return std::visit([]<class T>(const ValueVector<T>&) { return sizeof(T); }, array_of_type(type));
}

/// Keeps the stored integers if all frames have one scaling and their values take more memory.
Rescaling with_stored_integers(Rescaling rescaling, const Volume& volume) {
  const DicomFile& first = volume.files.front();
  const DicomFrame& frame = first.frames.front();
  const bool same = std::all_of(volume.planes.begin(), volume.planes.end(), [&](const Plane& plane) {
    return volume.frame(plane).slope == frame.slope && volume.frame(plane).intercept == frame.intercept;
  });
  if (!rescaling.any || !same || bytes_of(rescaling.type) <= bytes_of(first.type)) return rescaling;
  auto kept = integer_scaling(array_of_type(first.type), frame.slope, frame.intercept);
  if (!kept) return rescaling;
  kept->single_precision = rescaling.type == "float";
  return {first.type, false, kept};
}

/// Reads the values of planes in order; caches the last decoded file, which may have many planes.
class PlaneReader {
 public:
  PlaneReader(Volume volume, Rescaling rescaling) : volume_(std::move(volume)), rescaling_(std::move(rescaling)) {}

  ValueArray read(std::size_t first, std::size_t count, const Progress& progress) {
    const std::size_t size = volume_.files.front().columns * volume_.files.front().rows;
    ValueArray values = array_of_type(rescaling_.type);
    for (std::size_t i = first; i < first + count; ++i) {
      const Plane& plane = volume_.planes[i];
      tick(progress, static_cast<double>(i - first) / static_cast<double>(count), volume_.path(plane));
      decode(plane.file);
      // values too large for the file were refused in decode()
      if (i == first) {
        expect_memory(kBytesPerValue * size * count);
        std::visit([&](auto& all) { all.reserve(size * count); }, values);
      }
      append(volume_.frame(plane), plane.frame * size, size, values);
    }
    if (rescaling_.kept && rescaling_.kept->slope < 0) return in_reverse_order(std::move(values));
    return values;
  }

 private:
  void decode(std::size_t file) {
    if (decoded_ == file) return;
    decoded_.reset();
    values_ = read_dicom_values(volume_.files[file]);
    decoded_ = file;
  }

  void append(const DicomFrame& frame, std::size_t first, std::size_t size, ValueArray& values) const {
    std::visit(
        [&]<class To, class From>(ValueVector<To>& to, const ValueVector<From>& from) {
          const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
          const auto end = begin + static_cast<std::ptrdiff_t>(size);
          to.resize(to.size() + size);
          const auto result = to.end() - static_cast<std::ptrdiff_t>(size);
          if (rescaling_.any)
            std::transform(begin, end, result, [slope = frame.slope, intercept = frame.intercept](From value) {
              return static_cast<To>(slope * static_cast<double>(value) + intercept);
            });
          else
            std::transform(begin, end, result, [](From value) { return static_cast<To>(value); });
        },
        values, values_);
  }

  Volume volume_;
  Rescaling rescaling_;
  std::optional<std::size_t> decoded_;
  ValueArray values_;
};

ImageInfo info_of(const Volume& volume) {
  const DicomFile& first = volume.files.front();
  ImageInfo info;
  info.format = "DICOM";
  info.value_unit = first.value_unit;
  info.value_name = first.description;
  info.stored_type = parse_value_type(first.type);
  return info;
}

}  // namespace

bool is_dicom(const fs::path& path) {
  return fs::is_directory(path) || lower_name(path) == "dicomdir" || is_dicom_file(path);
}

RawLayers open_dicom(std::span<const fs::path> paths, const std::string& series, bool keep_stored,
                     const Progress& progress) {
  // select and arrange the series
  Found found = read_all_series(paths, progress);
  if (series.empty() && found.series.size() == 1 && !found.damaged.empty()) throw found.damaged.front();
  for (const Error& error : found.damaged)  // they may belong to this series; a missing slice would be detected
    found.remarks.push_back(fmt::format("skipped: {}; the file's series is unknown", error.what()));
  Volume volume = arrange(choose(std::move(found.series), series, paths.front()));
  RawImage spatial = spatial_grid(volume);
  // metadata
  RawLayers result;
  result.info = info_of(volume);
  result.info.remarks = std::move(found.remarks);
  result.info.remarks.insert(result.info.remarks.end(), spatial.info.remarks.begin(), spatial.info.remarks.end());
  result.info.world_frame = spatial.info.world_frame;
  // grid
  const bool moves = volume.times > 1;
  const std::size_t per_layer = moves ? volume.places : 1;
  const bool flat = volume.planes.size() == 1;
  const std::size_t columns = volume.files.front().columns;
  result.grid = moves ? with_last_axis(spatial.grid, volume.time) : std::move(spatial.grid);
  // reader of layers
  Rescaling rescaling = rescaling_of(volume);
  if (keep_stored) rescaling = with_stored_integers(std::move(rescaling), volume);
  result.info.scaling = rescaling.kept;
  const auto reader = std::make_shared<PlaneReader>(std::move(volume), std::move(rescaling));
  result.read = [reader, per_layer, flat, columns, progress](std::size_t first, std::size_t count) {
    if (!flat || count == 0) return reader->read(first * per_layer, count * per_layer, progress);
    ValueArray values = reader->read(0, 1, progress);  // a single plane, whose layers are rows
    std::visit(
        [&](auto& all) {
          const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first * columns);
          all = {begin, begin + static_cast<std::ptrdiff_t>(count * columns)};
        },
        values);
    return values;
  };
  return result;
}

std::vector<ImageVariable> list_dicom(const fs::path& path) {
  std::vector<ImageVariable> result;
  for (const auto& files : read_all_series(std::span(&path, 1), {}).series) {
    const DicomFile& first = files.front();
    result.push_back({first.series, {first.columns, first.rows}, first.value_unit, first.description});
    if (const std::size_t frames = frames_of(files); frames > 1) result.back().sizes.push_back(frames);
  }
  return result;
}

}  // namespace tegl::io_detail
