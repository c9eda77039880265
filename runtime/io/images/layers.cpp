// SPDX-License-Identifier: BSD-3-Clause
//
// Readers of images layer by layer, and of headerless raw files.
#include "images/layers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"
#include "images/images.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

/// Wraps `read`: returns a view of the values, which are kept until the next call.
std::function<ValueView(std::size_t, std::size_t)> keeping(std::function<ValueArray(std::size_t, std::size_t)> read) {
  return [read = std::move(read), kept = std::make_shared<ValueArray>()](std::size_t first, std::size_t count) {
    *kept = ValueArray();  // frees the previous block first
    *kept = read(first, count);
    return std::visit(
        []<class Stored>(const ValueVector<Stored>& values) -> ValueView { return std::span<const Stored>(values); },
        *kept);
  };
}

/// Reads whole blocks of the file, so no block is decompressed once per layer. Holds one block.
template <Value T, int N>
class BlockLayers final : public LayerReader<T, N> {
 public:
  BlockLayers(RawLayers source, std::size_t block)
      : grid_(fixed_grid<N>(source.grid)),
        look_(source.look ? std::move(source.look) : keeping(std::move(source.read))),
        block_(block) {
    for (int a = 0; a < N - 1; ++a) layer_size_ *= grid_.axes[a].size();
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }

  void read(std::size_t k, T* to) override {
    const std::size_t first = k / block_ * block_;
    if (first != first_) {
      first_ = kNone;
      values_ = read_block(first, std::min(block_, grid_.axes[N - 1].size() - first));
      first_ = first;
    }
    std::visit(
        [&](const auto& values) {
          const auto begin = values.begin() + static_cast<std::ptrdiff_t>((k - first_) * layer_size_);
          std::transform(begin, begin + static_cast<std::ptrdiff_t>(layer_size_), to,
                         [](auto value) { return static_cast<T>(value); });
        },
        values_);
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  ValueView read_block(std::size_t first, std::size_t count) const {
    try {
      return look_(first, count);
    } catch (const Error& error) {
      throw Error(error.code(), count == 1
                                    ? fmt::format("{} (layer {})", error.what(), first)
                                    : fmt::format("{} (layers {} to {})", error.what(), first, first + count - 1));
    }
  }

  Grid<N> grid_;
  std::function<ValueView(std::size_t, std::size_t)> look_;
  std::size_t block_;
  std::size_t layer_size_ = 1;
  ValueView values_;
  std::size_t first_ = kNone;
};

/// Larger blocks are read layer by layer.
constexpr std::uint64_t kMostBlockBytes = std::uint64_t{1} << 28;

template <int N>
AnyLayersN<N> with_dimension(RawLayers&& source, const fs::path& path) {
  return std::visit(
      [&]<class Stored>(const ValueVector<Stored>&) -> AnyLayersN<N> {
        using T = std::conditional_t<Value<Stored>, Stored, double>;
        std::vector<std::uint64_t> sizes;
        for (const Axis& axis : source.grid.axes) sizes.push_back(axis.size());
        sizes.back() = source.block;
        const std::size_t block = checked_bytes(sizes, sizeof(Stored), path) <= kMostBlockBytes ? source.block : 1;
        return std::unique_ptr<LayerReader<T, N>>(std::make_unique<BlockLayers<T, N>>(std::move(source), block));
      },
      source.read(0, 0));
}

/// The item of an axis in a list of a layout; `other` if the list is empty.
template <class Item>
const Item& item_of(const std::vector<Item>& items, std::size_t axis, const Item& other) {
  return items.empty() ? other : items[axis];
}

/// Converts a layout to axes. Throws InvalidArgument.
std::vector<Axis> raw_axes(const RawLayout& layout, const fs::path& path) {
  // check list lengths
  const auto require_count = [&](std::size_t count, const char* what) {
    if (count != 0 && count != layout.sizes.size())
      fail(ErrorCode::InvalidArgument, path, "{} of {} axes, and sizes of {}; expected one for each axis", what, count,
           layout.sizes.size());
  };
  require_count(layout.spacing.size(), "spacings");
  require_count(layout.origin.size(), "origins");
  require_count(layout.axis_names.size(), "names");
  require_count(layout.axis_units.size(), "units");
  // check and make each axis
  std::vector<Axis> axes;
  for (std::size_t a = 0; a < layout.sizes.size(); ++a) {
    const std::size_t size = layout.sizes[a];
    const double step = item_of(layout.spacing, a, 1.0);
    const double first = item_of(layout.origin, a, 0.0);
    if (size == 0) fail(ErrorCode::InvalidArgument, path, "sizes {}; expected no 0", shape_text(layout.sizes));
    if (!std::isfinite(step) || step == 0.0)
      fail(ErrorCode::InvalidArgument, path, "a spacing of {}; expected a finite number other than 0", step);
    const double last = first + step * static_cast<double>(size - 1);
    if (!std::isfinite(first) || !std::isfinite(last) || first + step == first || last + step == last)
      fail(ErrorCode::InvalidArgument, path,
           "an axis from {} in {} steps of {}; expected coordinates that are finite "
           "and differ",
           first, size - 1, step);
    axes.push_back(Axis::uniform(size, first, step));
    axes.back().name = item_of(layout.axis_names, a, std::string());
    axes.back().unit = item_of(layout.axis_units, a, std::string());
  }
  return axes;
}

}  // namespace

std::vector<std::string> io_detail::remarks_on_rest(std::span<const fs::path> files, const RawLayout& layout) {
  const std::vector<std::uint64_t> sizes(layout.sizes.begin(), layout.sizes.end());
  const std::string_view type = name_of(layout.type.value());
  // the files with a rest, and the shortest and the longest of these
  std::vector<std::string> names;
  std::uint64_t least = 0, most = 0, bytes = 0;
  for (const fs::path& path : files) {
    const std::uint64_t size = size_of_file(path);
    const std::uint64_t end = layout.offset + checked_bytes(sizes, bytes_of_type(type), path);
    if (size <= end) continue;  // shorter files are an error of the reader
    bytes = size;
    least = names.empty() ? size - end : std::min(least, size - end);
    most = std::max(most, size - end);
    names.push_back(path.string());
  }
  if (names.empty()) return {};
  // the remark
  constexpr std::size_t kMostNames = 3;
  const std::string where = names.size() <= kMostNames
                                ? fmt::format("{}", fmt::join(names, ", "))
                                : fmt::format("{} of {} files, the first {}", names.size(), files.size(), names[0]);
  const std::string rest = names.size() == 1 ? fmt::format("{} of {} bytes", least, bytes)
                           : least == most   ? fmt::format("{} bytes of each", least)
                                             : fmt::format("{} to {} bytes of each", least, most);
  return {fmt::format("{}: {} follow the last of {} samples of type {}, and are ignored", where, rest,
                      shape_text(sizes), type)};
}

OpenLayersResult io_detail::to_open_layers(RawLayers&& source, const fs::path& path) {
  ImageInfo info = source.info;
  switch (source.grid.axes.size()) {
    case 2:
      return {with_dimension<2>(std::move(source), path), std::move(info)};
    case 3:
      return {with_dimension<3>(std::move(source), path), std::move(info)};
    case 4:
      return {with_dimension<4>(std::move(source), path), std::move(info)};
    default:
      fail_axes(source.grid, source.info, path);
  }
}

LayersOfFiles io_detail::open_reporting(const fs::path& path, const Progress& progress, bool separate,
                                        const std::function<LayersOfFiles(const Progress&)>& open) {
  const auto open_quietly_after = [&](const Progress& reported) {
    const auto current = std::make_shared<Progress>(reported);
    LayersOfFiles opened = open([current](double fraction) { return !*current || (*current)(fraction); });
    *current = nullptr;
    return opened;
  };
  tick(progress, 0.0, path);
  LayersOfFiles opened = separate ? open_separately(path, progress, open_quietly_after) : open_quietly_after(progress);
  tick(progress, 1.0, path);
  return opened;
}

OpenLayersResult open_layers(const fs::path& path, const ReadImageOptions& options) {
  const auto open = [&](const Progress& progress) {
    ReadImageOptions own = options;
    own.work.progress = progress;
    return LayersOfFiles{open_any_layers(path, own), {path}};
  };
  const bool separate = options.separate_process && needs_separate_process(path);
  return to_open_layers(std::move(open_reporting(path, options.work.progress, separate, open).layers), path);
}

RawLayers io_detail::open_raw(const fs::path& path, const RawLayout& layout) {
  require_readable_file(path);
  if (!layout.type)
    fail(ErrorCode::InvalidArgument, path,
         "no type of values; expected uint8, int8, uint16, int16, int32, float or double");
  if (*layout.type > ValueType::float64)
    fail(ErrorCode::InvalidArgument, path,
         "values of type '{}'; expected uint8, int8, uint16, int16, int32, float or double", name_of(*layout.type));
  RawLayers source;
  source.grid.axes = raw_axes(layout, path);
  if (layout.sizes.size() < 2 || layout.sizes.size() > 5)
    fail(ErrorCode::InvalidArgument, path, "{} sizes; expected 2 to 5", layout.sizes.size());
  const auto n = static_cast<Eigen::Index>(layout.sizes.size());
  source.grid.linear = Eigen::MatrixXd::Identity(n, n);
  source.grid.offset = Eigen::VectorXd::Zero(n);
  name_axes(source.grid);
  drop_trailing_axes(source.grid, source.info);
  const auto dropped = static_cast<std::ptrdiff_t>(layout.sizes.size() - source.grid.axes.size());
  const std::uint64_t per_layer =
      checked_bytes(std::vector<std::uint64_t>(layout.sizes.begin(), layout.sizes.end() - 1 - dropped), 1, path);
  StoredSamples samples;
  samples.path = path;
  samples.offset = layout.offset;
  samples.type = name_of(*layout.type);
  samples.sizes.assign(layout.sizes.begin(), layout.sizes.end());
  samples.swapped = layout.big_endian != (std::endian::native == std::endian::big);
  const auto reader = std::make_shared<SampleReader>(std::move(samples));
  source.info.remarks = remarks_on_rest(std::array{path}, layout);
  source.read = [reader, per_layer](std::size_t first, std::size_t count) {
    return reader->read(first * per_layer, count * per_layer, {});
  };
  source.info.format = "raw";
  source.info.stored_type = layout.type;
  return source;
}

OpenLayersResult open_raw_layers(const fs::path& path, const RawLayout& layout) {
  return to_open_layers(open_raw(path, layout), path);
}

}  // namespace tegl
