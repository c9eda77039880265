// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of NIfTI-1 images.
//
// Based on: R. W. Cox et al., "A (sort of) new image data format standard: NIfTI-1", 2004; nifti1.h.
#include "images/nifti.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/stored_integers.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHeaderBytes = 348;
static_assert(std::endian::native == std::endian::little, "headers are decoded on little-endian machines");

/// The bytes of the header, with access to numbers in the file's byte order.
class HeaderBytes {
 public:
  explicit HeaderBytes(std::vector<unsigned char> bytes) : bytes_(std::move(bytes)) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] bool swapped() const { return swapped_; }
  void set_swapped(bool swapped) { swapped_ = swapped; }

  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    std::array<unsigned char, sizeof(T)> raw;
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[swapped_ ? sizeof(T) - 1 - i : i] = bytes_[offset + i];
    return std::bit_cast<T>(raw);
  }
  [[nodiscard]] std::span<const unsigned char> bytes(std::size_t offset, std::size_t count) const {
    return std::span(bytes_).subspan(offset, count);
  }

 private:
  std::vector<unsigned char> bytes_;
  bool swapped_ = false;
};

struct NiftiType {
  int code;
  const char* name;
  unsigned bytes;
};

constexpr std::array<NiftiType, 10> kNiftiTypes = {{{2, "uint8", 1},
                                                    {4, "int16", 2},
                                                    {8, "int32", 4},
                                                    {16, "float", 4},
                                                    {64, "double", 8},
                                                    {256, "int8", 1},
                                                    {512, "uint16", 2},
                                                    {768, "uint32", 4},
                                                    {1024, "int64", 8},
                                                    {1280, "uint64", 8}}};

struct NiftiHeader {
  std::vector<std::uint64_t> sizes;  ///< at least 3
  NiftiType type{};
  bool swapped = false;  ///< not in this machine's byte order
  bool pair = false;     ///< values are in a separate .img file
  double slope = 0;      ///< 0: values are not scaled
  double intercept = 0;
  std::uint64_t vox_offset = 0;
  std::array<double, 8> pixdim{};
  int qform_code = 0;
  int sform_code = 0;
  std::array<double, 6> quaternion{};  ///< b, c, d, then the offsets x, y, z
  Eigen::Matrix<double, 3, 4> srow;
  std::string space_unit;
  std::string time_unit;
  double toffset = 0;
};

/// Detects the byte order; fails unless the file is NIfTI-1.
void check_magic(HeaderBytes& bytes, const fs::path& path) {
  if (bytes.size() < kHeaderBytes)
    fail(ErrorCode::MalformedFile, path, "NIfTI header of {} bytes; expected {}", bytes.size(), kHeaderBytes);
  const auto declared = bytes.get<std::int32_t>(0);
  bytes.set_swapped(true);
  const auto swapped = bytes.get<std::int32_t>(0);
  bytes.set_swapped(declared != static_cast<std::int32_t>(kHeaderBytes));
  constexpr std::int32_t kNifti2Bytes = 540;
  if (declared == kNifti2Bytes || swapped == kNifti2Bytes)
    fail(ErrorCode::UnsupportedFormat, path, "NIfTI-2 file; expected NIfTI-1 (convert it, e.g. with nifti_tool)");
  const auto magic = bytes.bytes(344, 4);
  const bool known = std::memcmp(magic.data(), "n+1", 4) == 0 || std::memcmp(magic.data(), "ni1", 4) == 0;
  if (bytes.get<std::int32_t>(0) != static_cast<std::int32_t>(kHeaderBytes) || !known)
    fail(ErrorCode::MalformedFile, path,
         "not a NIfTI-1 file: header size {} and magic {}; expected 348 and 'n+1' or 'ni1'", declared, shown(magic));
}

std::vector<std::uint64_t> read_sizes(const HeaderBytes& bytes, const fs::path& path) {
  const int rank = bytes.get<std::int16_t>(40);
  if (rank < 1 || rank > 7) fail(ErrorCode::MalformedFile, path, "{} dimensions; expected 1 to 7", rank);
  std::vector<std::uint64_t> sizes;
  for (int d = 1; d <= rank; ++d) {
    const int size = bytes.get<std::int16_t>(40 + 2 * static_cast<std::size_t>(d));
    if (size < 1) fail(ErrorCode::MalformedFile, path, "dimension {} has size {}; expected at least 1", d, size);
    sizes.push_back(static_cast<std::uint64_t>(size));
  }
  while (sizes.size() > 4 && sizes.back() == 1) sizes.pop_back();
  if (sizes.size() > 4)
    fail(ErrorCode::UnsupportedData, path, "image of {} dimensions ({}), or with vectors as values; expected up to 4",
         sizes.size(), shape_text(sizes));
  while (sizes.size() < 3) sizes.push_back(1);
  return sizes;
}

NiftiType read_type(const HeaderBytes& bytes, const fs::path& path) {
  const int code = bytes.get<std::int16_t>(70);
  const int bits = bytes.get<std::int16_t>(72);
  for (const NiftiType& type : kNiftiTypes)
    if (type.code == code) {
      if (bits != static_cast<int>(8 * type.bytes))
        fail(ErrorCode::MalformedFile, path, "values of type {} with {} bits; expected {} bits", type.name, bits,
             8 * type.bytes);
      return type;
    }
  for (const int other : {1, 32, 128, 1536, 1792, 2048, 2304})
    if (code == other)
      fail(ErrorCode::UnsupportedData, path,
           "values of NIfTI type {} (binary, complex, colour or long double); expected integers, float or double",
           code);
  fail(ErrorCode::MalformedFile, path, "values of NIfTI type {}; expected 2, 4, 8, 16, 64, 256, 512, 768, 1024 or 1280",
       code);
}

std::string space_unit(int xyzt) {
  switch (xyzt & 0x07) {
    case 1:
      return "m";
    case 2:
      return "mm";
    case 3:
      return "um";
    default:
      return "";
  }
}

std::string time_unit(int xyzt) {
  switch (xyzt & 0x38) {
    case 8:
      return "s";
    case 16:
      return "ms";
    case 24:
      return "us";
    case 32:
      return "Hz";
    case 40:
      return "ppm";
    case 48:
      return "rad/s";
    default:
      return "";
  }
}

std::uint64_t read_vox_offset(const HeaderBytes& bytes, bool pair, const fs::path& path) {
  const double offset = bytes.get<float>(108);
  // 0 in a single file is common and stands for the minimum; niftilib reads it the same way.
  const double smallest = pair ? 0 : 352;
  constexpr double kLargest = 1e9;
  if (!pair && offset == 0) return 352;
  if (!(offset >= smallest && offset <= kLargest))
    fail(ErrorCode::MalformedFile, path, "values start at byte {}; expected at least {}", offset, smallest);
  return static_cast<std::uint64_t>(offset);
}

NiftiHeader parse_header(const fs::path& path) {
  HeaderBytes bytes(read_prefix(path, kHeaderBytes));
  check_magic(bytes, path);
  NiftiHeader header;
  header.sizes = read_sizes(bytes, path);
  header.type = read_type(bytes, path);
  header.swapped = bytes.swapped();
  header.pair = bytes.bytes(345, 1)[0] == 'i';
  header.slope = bytes.get<float>(112);
  header.intercept = bytes.get<float>(116);
  header.vox_offset = read_vox_offset(bytes, header.pair, path);
  for (std::size_t i = 0; i < 8; ++i) header.pixdim[i] = bytes.get<float>(76 + 4 * i);
  header.qform_code = bytes.get<std::int16_t>(252);
  header.sform_code = bytes.get<std::int16_t>(254);
  for (std::size_t i = 0; i < 6; ++i) header.quaternion[i] = bytes.get<float>(256 + 4 * i);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      header.srow(r, c) = bytes.get<float>(280 + 16 * static_cast<std::size_t>(r) + 4 * static_cast<std::size_t>(c));
  const int units = bytes.bytes(123, 1)[0];
  header.space_unit = space_unit(units);
  header.time_unit = time_unit(units);
  header.toffset = bytes.get<float>(136);
  return header;
}

/// Some converters write steps of 0, negative or NaN for "unknown".
double step_or_one(double step) { return std::isfinite(step) && step > 0 ? step : 1.0; }

/// nifti1.h, method 2: the rotation of the quaternion times pixdim; the third column also times qfac.
Eigen::Matrix<double, 3, 4> qform(const NiftiHeader& header) {
  const auto [b, c, d, x, y, z] = header.quaternion;
  const double rest = 1.0 - (b * b + c * c + d * d);
  const double a = rest > 0 ? std::sqrt(rest) : 0.0;
  Eigen::Matrix3d rotation;
  rotation << a * a + b * b - c * c - d * d, 2 * b * c - 2 * a * d, 2 * b * d + 2 * a * c,  //
      2 * b * c + 2 * a * d, a * a + c * c - b * b - d * d, 2 * c * d - 2 * a * b,          //
      2 * b * d - 2 * a * c, 2 * c * d + 2 * a * b, a * a + d * d - c * c - b * b;
  // Quaternions are stored as float, so rounding may make the norm exceed 1; normalise to a rotation.
  const double norm = a * a + b * b + c * c + d * d;
  rotation /= norm > 0 ? norm : 1.0;
  const double qfac = header.pixdim[0] < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d steps(step_or_one(header.pixdim[1]), step_or_one(header.pixdim[2]),
                              qfac * step_or_one(header.pixdim[3]));
  Eigen::Matrix<double, 3, 4> result;
  result << rotation * steps.asDiagonal(), Eigen::Vector3d(x, y, z);
  return result;
}

Eigen::Matrix<double, 3, 4> spatial_affine(const NiftiHeader& header) {
  if (header.sform_code > 0) return header.srow;
  if (header.qform_code > 0) return qform(header);
  Eigen::Matrix<double, 3, 4> scaling = Eigen::Matrix<double, 3, 4>::Zero();
  for (int a = 0; a < 3; ++a) scaling(a, a) = step_or_one(header.pixdim[static_cast<std::size_t>(a) + 1]);
  return scaling;
}

RawGrid make_grid(const NiftiHeader& header, const fs::path& path) {
  const auto n = static_cast<Eigen::Index>(header.sizes.size());
  Eigen::MatrixXd affine = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(n);
  const Eigen::Matrix<double, 3, 4> space = spatial_affine(header);
  affine.topLeftCorner<3, 3>() = space.leftCols<3>();
  offset.head<3>() = space.col(3);
  if (n == 4) {
    affine(3, 3) = step_or_one(header.pixdim[4]);
    offset(3) = std::isfinite(header.toffset) ? header.toffset : 0.0;
  }
  RawGrid grid = affine_grid({header.sizes.begin(), header.sizes.end()}, affine, offset, path);
  for (std::size_t a = 0; a < 3; ++a) grid.axes[a].unit = header.space_unit;
  if (n == 4) grid.axes[3].unit = header.time_unit;
  name_axes(grid);
  if (n == 3 && std::isfinite(header.toffset)) {  // an image of one time step
    Axis time = Axis::uniform(1, header.toffset);
    time.name = "t";
    time.unit = header.time_unit;
    grid.single.push_back({std::move(time)});
  }
  return grid;
}

/// The other file of a .hdr/.img pair, with the same compression or with the other one.
fs::path partner(const fs::path& path, const std::string& wanted) {
  const bool compressed = lower(path.extension().string()) == ".gz";
  const fs::path stem = compressed ? fs::path(path).replace_extension() : path;
  for (const bool gz : {compressed, !compressed}) {
    fs::path candidate = fs::path(stem).replace_extension(wanted);
    if (gz) candidate += ".gz";
    if (fs::exists(candidate)) return candidate;
  }
  fail(ErrorCode::FileNotFound, fs::path(stem).replace_extension(wanted), "no such file; {} requires it",
       path.filename().string());
}

/// The linear scaling of stored values.
struct Scaling {
  double slope;
  double intercept;

  [[nodiscard]] bool is_plain() const {
    return slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept) || (slope == 1 && intercept == 0);
  }
  /// Returns slope * v + intercept: as float for float and values of up to 16 bits, else as double.
  [[nodiscard]] ValueArray apply(const ValueArray& values) const {
    return std::visit(
        [&]<class T>(const ValueVector<T>& stored) -> ValueArray {
          using Real = std::conditional_t<sizeof(T) <= 2 || std::is_same_v<T, float>, float, double>;
          ValueVector<Real> result(stored.size());
          std::transform(stored.begin(), stored.end(), result.begin(),
                         [&](T value) { return static_cast<Real>(slope * static_cast<double>(value) + intercept); });
          return result;
        },
        values);
  }
};

}  // namespace

StoredImage open_nifti(const fs::path& path, bool keep_stored) {
  const std::string name = lower_name(path);
  const bool is_img = name.ends_with(".img") || name.ends_with(".img.gz");
  const fs::path header_path = is_img ? partner(path, ".hdr") : path;
  const NiftiHeader header = parse_header(header_path);
  StoredImage image;
  StoredSamples& samples = image.samples;
  samples.path = header.pair && !is_img ? partner(path, ".img") : path;
  require_readable_file(samples.path);
  // Offsets in a compressed file count decompressed bytes.
  const bool compressed = is_gzip(samples.path);
  samples.encoding = compressed ? Encoding::deflate : Encoding::raw;
  (compressed ? samples.skip : samples.offset) = header.vox_offset;
  samples.type = header.type.name;
  samples.sizes = header.sizes;
  samples.swapped = header.swapped;
  image.grid = make_grid(header, header_path);
  image.info.format = "NIfTI";
  image.info.stored_type = parse_value_type(header.type.name);
  if (header.sform_code > 0 || header.qform_code > 0) image.info.world_frame = "RAS";
  const Scaling scaling{header.slope, header.intercept};
  if (scaling.is_plain()) return image;
  if (keep_stored) image.info.scaling = integer_scaling(array_of_type(samples.type), scaling.slope, scaling.intercept);
  if (!image.info.scaling)
    image.convert = [scaling](ValueArray&& values) { return scaling.apply(values); };
  else if (scaling.slope < 0)
    image.convert = [](ValueArray&& values) { return in_reverse_order(std::move(values)); };
  return image;
}

}  // namespace tegl::io_detail
