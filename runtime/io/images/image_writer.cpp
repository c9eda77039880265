// SPDX-License-Identifier: BSD-3-Clause
//
// Writes image files layer by layer: chooses the format by the extension.
#include "images/image_writer.hpp"

#include <array>

#include "base/common.hpp"

namespace tegl {

namespace io_detail {

namespace {

std::uint64_t bytes_of(ValueType type) {
  switch (type) {
    case ValueType::uint8:
    case ValueType::int8:
      return 1;
    case ValueType::uint16:
    case ValueType::int16:
      return 2;
    case ValueType::float64:
      return 8;
    default:
      return 4;
  }
}

std::string extension_of(const std::filesystem::path& path) { return lower(path.extension().string()); }

bool is_netcdf_name(const std::filesystem::path& path) {
  return extension_of(path) == ".nc" || extension_of(path) == ".cdf";
}

}  // namespace

bool ImageHead::is_separate(std::size_t axis) const noexcept {
  for (std::size_t a = 0; a < axes(); ++a)
    if (a != axis && (linear(axis, a) != 0 || linear(a, axis) != 0)) return false;
  return true;
}

bool ImageHead::has_world_map() const noexcept {
  for (std::size_t a = 0; a < axes(); ++a)
    if (!is_separate(a) || linear(a, a) != 1 || grid.offset[a] != 0) return true;
  return false;
}

std::string ImageHead::axis_name(std::size_t axis) const {
  constexpr std::array<const char*, 5> kNames = {"x", "y", "z", "t", "u"};
  return grid.axes[axis].name.empty() ? kNames.at(axis) : grid.axes[axis].name;
}

}  // namespace io_detail

bool is_image_output(const std::filesystem::path& path) {
  const std::string extension = io_detail::extension_of(path);
  return extension == ".nrrd" || extension == ".vti" || io_detail::is_netcdf_name(path);
}

bool records_lattice(const std::filesystem::path& path) {
  return is_image_output(path) && io_detail::extension_of(path) != ".vti";
}

namespace detail {

struct ImageFile::Parts {
  explicit Parts(const std::filesystem::path& path) : pending(path) {}
  PendingPath pending;
  std::unique_ptr<io_detail::LayerWriter> writer;  ///< destroyed before the pending file
};

ImageFile::ImageFile(const std::filesystem::path& path, ValueType type, StoredGrid grid, const ImageInfo& info) {
  if (!is_image_output(path))
    io_detail::fail(ErrorCode::UnsupportedFormat, path, "extension '{}'; expected .nrrd, .nc or .vti for an image",
                    path.extension().string());
  io_detail::ImageHead head{std::move(grid), type, info, io_detail::bytes_of(type)};
  for (std::size_t a = 0; a + 1 < head.axes(); ++a) head.layer_bytes *= head.grid.axes[a].size();
  parts_ = std::make_unique<Parts>(path);
  parts_->writer = io_detail::is_netcdf_name(path)           ? io_detail::write_netcdf(parts_->pending, head)
                   : io_detail::extension_of(path) == ".vti" ? io_detail::write_vti(parts_->pending, head)
                                                             : io_detail::write_nrrd(parts_->pending, head);
}

ImageFile::~ImageFile() = default;

void ImageFile::add(const void* layer) { parts_->writer->add(layer); }

void ImageFile::finish() {
  parts_->writer->close();
  parts_->pending.commit();
}

}  // namespace detail

}  // namespace tegl
