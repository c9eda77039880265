// SPDX-License-Identifier: BSD-3-Clause
//
// Builds and loads indexes of active tiles, by any method, and makes indexes of chosen tiles.
#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "search/active_tiles_methods.hpp"
#include "tegl/seed_set.hpp"

namespace tegl {

namespace {
constexpr double kIdentifyShare = 0.2;  ///< fraction of the progress

/// Throws InvalidArgument if an option is set that the method ignores.
void require_used(ActiveMethod method, const ActiveTilesOptions& options) {
  if (method == ActiveMethod::seed_set) return;
  const auto refuse = [&](const char* option) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} for the method {}; it is only for seed-set", option, name_of(method)));
  };
  if (options.seed_method != SeedMethod::cover) refuse("seed_method");
  if (!options.scan_order.empty()) refuse("scan_order");
}

}  // namespace

namespace detail {

namespace {

/// Adds a row of samples to the hash of its layer; `first`: offset of its first sample in the image, in elements. Sets
/// `missing` if any sample is NaN. `room`: bytes for a row.
using RowHash = std::function<std::uint64_t(std::ptrdiff_t first, std::uint64_t hash, void* room, bool& missing)>;

template <Value T>
std::uint64_t hash_row(const T* samples, std::ptrdiff_t stride, std::size_t count, std::uint64_t hash, T* row,
                       bool& missing) {
  if (stride != 1) {
    for (std::size_t i = 0; i < count; ++i) row[i] = samples[static_cast<std::ptrdiff_t>(i) * stride];
    samples = row;
  }
  if constexpr (std::is_floating_point_v<T>) {
    unsigned any = 0;
    for (std::size_t i = 0; i < count; ++i) any |= samples[i] != samples[i] ? 1u : 0u;
    missing = missing || any != 0;
  }
  return hash_bytes(samples, count * sizeof(T), hash);
}

/// Digest of an image, and whether any value is NaN.
struct Identity {
  std::uint64_t digest = 0;
  bool any_missing = false;
};

template <int N>
using ImageSizes = std::array<std::size_t, N>;

template <int N>
IndexedImage<N> identity_of(const ImageSizes<N>& sizes, ValueType type, const Identity& found) {
  return {sizes, type, found.digest, found.any_missing};
}

/// Calls `hash_of` for all rows of an image.
Identity identify_rows(std::span<const std::size_t> sizes, std::span<const std::ptrdiff_t> strides,
                       ValueType value_type, const RowHash& hash_of, const WorkOptions& work) {
  const std::size_t last = sizes.size() - 1;
  const std::size_t layers = sizes[last];
  std::size_t rows = 1;
  for (std::size_t a = 1; a < last; ++a) rows *= sizes[a];
  struct Layer {
    std::uint64_t hash;
    bool missing = false;
  };
  std::vector<Layer> found(layers);
  using Room = std::vector<std::uint64_t>;
  Workers<Room> workers(work.threads, [&] { return Room(sizes[0]); });
  constexpr std::size_t kSamplesAtOnce = std::size_t{1} << 24;
  const std::size_t at_once = std::max<std::size_t>(1, kSamplesAtOnce / (rows * sizes[0]));
  // hash each layer
  for (std::size_t first = 0; first < layers; first += at_once) {
    if (work.progress && !work.progress(static_cast<double>(first) / static_cast<double>(layers)))
      throw Error(ErrorCode::Cancelled, fmt::format("reading of values cancelled at layer {} of {}", first, layers));
    workers.for_range(std::min(at_once, layers - first), 1, [&](std::size_t from, std::size_t to, Room& room) {
      for (std::size_t k = first + from; k < first + to; ++k) {
        Layer layer{k};
        for (std::size_t row = 0; row < rows; ++row) {
          std::ptrdiff_t samples = static_cast<std::ptrdiff_t>(k) * strides[last];
          for (std::size_t a = 1, rest = row; a < last; rest /= sizes[a++])
            samples += static_cast<std::ptrdiff_t>(rest % sizes[a]) * strides[a];
          layer.hash = hash_of(samples, layer.hash, room.data(), layer.missing);
        }
        found[k] = layer;
      }
    });
  }
  // combine type, sizes and layers
  Identity result;
  const std::string_view type = name_of(value_type);
  result.digest = hash_bytes(type.data(), type.size(), sizes.size());
  for (const std::size_t size : sizes) {
    const std::uint64_t wide = size;
    result.digest = hash_bytes(&wide, sizeof(wide), result.digest);
  }
  for (const Layer& layer : found) {
    result.digest = hash_bytes(&layer.hash, sizeof(layer.hash), result.digest);
    result.any_missing = result.any_missing || layer.missing;
  }
  return result;
}

/// Reads all values.
template <Value T>
Identity identify_samples(const SampleView<T>& image, const WorkOptions& work) {
  const RowHash of_row = [&](std::ptrdiff_t first, std::uint64_t hash, void* room, bool& missing) {
    return hash_row(image.data + first, image.strides[0], image.sizes[0], hash, static_cast<T*>(room), missing);
  };
  return identify_rows(image.axes(), image.strides, kValueType<T>, of_row, work);
}

/// Whether a corner of a tile is NaN. `lowest`: offset of its lowest sample in the image, in elements.
template <Value T>
bool has_missing_corner(const SampleView<T>& image, std::ptrdiff_t lowest) noexcept {
  for (unsigned corner = 0; corner < 1u << image.dim; ++corner) {
    std::ptrdiff_t at = lowest;
    for (int a = 0; a < image.dim; ++a)
      if ((corner >> a & 1u) != 0) at += image.strides[a];
    if (image.data[at] != image.data[at]) return true;
  }
  return false;
}

/// Throws InvalidArgument unless the numbers are ascending and below `count`.
void require_ascending(const std::vector<TileNumber>& tiles, TileNumber count) {
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i] >= count)
      throw Error(ErrorCode::InvalidArgument, fmt::format("tile {} is chosen; expected one of {}", tiles[i], count));
    if (i > 0 && tiles[i] <= tiles[i - 1])
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("tile {} is chosen after {}; expected ascending numbers", tiles[i], tiles[i - 1]));
  }
}

/// Checks the numbers and removes tiles with a missing corner.
template <Value T>
void check_chosen(const SampleView<T>& image, std::vector<TileNumber>& tiles) {
  const TileShape grid(image.axes());
  require_ascending(tiles, grid.count());
  if constexpr (std::is_floating_point_v<T>)
    std::erase_if(tiles, [&](TileNumber tile) {
      const TileShape::Index index = grid.index(tile);
      std::ptrdiff_t lowest = 0;
      for (int a = 0; a < image.dim; ++a) lowest += static_cast<std::ptrdiff_t>(index[a]) * image.strides[a];
      return has_missing_corner(image, lowest);
    });
}

/// An index by any method that finds all active tiles.
template <int N>
class MethodTiles final : public tegl::ActiveTiles<N> {
 public:
  MethodTiles(IndexedImage<N> identity, ActiveMethod method, IndexMethodPtr index)
      : tegl::ActiveTiles<N>(std::move(identity)), method_(method), index_(std::move(index)) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return method_; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return index_->memory_bytes(); }
  [[nodiscard]] bool needs_image() const noexcept override { return index_->needs_image(); }

 protected:
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override { index_->collect(isovalue, tiles); }
  void collect_rows(double isovalue, TileRowSet& rows) const override {
    if (!index_->collect_rows(isovalue, rows)) tegl::ActiveTiles<N>::collect_rows(isovalue, rows);
  }
  void write(IndexWriter& to) const override { index_->write(to); }

 private:
  ActiveMethod method_;
  IndexMethodPtr index_;
};

/// Tiles that the caller chose, at every isovalue.
template <int N>
class ChosenTiles final : public tegl::ActiveTiles<N> {
 public:
  ChosenTiles(IndexedImage<N> identity, std::vector<TileNumber> tiles)
      : tegl::ActiveTiles<N>(std::move(identity)), tiles_(std::move(tiles)) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return ActiveMethod::full_scan; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return tiles_.size() * sizeof(TileNumber); }
  [[nodiscard]] bool is_complete() const noexcept override { return false; }

 protected:
  void collect(double /*isovalue*/, std::vector<TileNumber>& tiles) const override {
    tiles.insert(tiles.end(), tiles_.begin(), tiles_.end());
  }
  void write(IndexWriter& /*to*/) const override {}  // not reached: `save` throws

 private:
  std::vector<TileNumber> tiles_;
};

template <Value T>
IndexMethodPtr build_method(const SampleView<T>& image, ActiveMethod method, const ActiveTilesOptions& options) {
  const IndexTask<T> task{image, TileShape(image.axes()), options};
  task.tell(0);
  IndexMethodPtr result;
  switch (method) {
    case ActiveMethod::full_scan:
      result = make_full_scan(task);
      break;
    case ActiveMethod::interval_tree:
      result = build_interval_tree(task);
      break;
    case ActiveMethod::span_space:
      result = build_span_space(task);
      break;
    case ActiveMethod::min_max_tree:
      result = build_min_max_tree(task);
      break;
    case ActiveMethod::seed_set:
      result = build_seed_index(task);
      break;
  }
  task.tell(1);
  return result;
}

/// Reads all that follows the head.
template <Value T>
IndexMethodPtr read_method(IndexReader& from, const SampleView<T>& image, ActiveMethod method,
                           const ActiveTilesOptions& options) {
  const IndexTask<T> task{image, TileShape(image.axes()), options};
  task.tell(0);
  IndexMethodPtr result;
  switch (method) {
    case ActiveMethod::full_scan:
      result = make_full_scan(task);
      break;
    case ActiveMethod::interval_tree:
      result = read_interval_tree(from, task);
      break;
    case ActiveMethod::span_space:
      result = read_span_space(from, task);
      break;
    case ActiveMethod::min_max_tree:
      result = read_min_max_tree(from, task);
      break;
    case ActiveMethod::seed_set:
      result = read_seed_index(from, task);
      break;
  }
  from.finish();
  task.tell(1);
  return result;
}

/// An index without the sizes and the type of its image.
struct FoundIndex {
  Identity identity;
  ActiveMethod method;
  IndexMethodPtr index;
};

/// `options` for the part of the progress from `first` on.
ActiveTilesOptions from_share(const ActiveTilesOptions& options, double first) {
  ActiveTilesOptions rest = options;
  rest.work.progress = part_of(options.work.progress, first, 1);
  return rest;
}

template <Value T>
FoundIndex build_index(const SampleView<T>& image, ActiveMethod method, const ActiveTilesOptions& options) {
  // A full scan builds nothing, so identification is all of its progress; other methods read the values several times
  // more.
  const double identified = method == ActiveMethod::full_scan ? 1.0 : kIdentifyShare;
  const Identity identity =
      identify_samples(image, {options.work.threads, part_of(options.work.progress, 0, identified)});
  return {identity, method, build_method(image, method, from_share(options, identified))};
}

template <Value T>
FoundIndex read_index(ByteSource& from, const SampleView<T>& image, const ActiveTilesOptions& options) {
  // compare sizes and type first: computing the digest reads all values
  IndexReader reader(from);
  const ActiveTilesHead head = read_head(reader);
  require_same_image(head, image.axes(), kValueType<T>, head.digest);
  constexpr double kReadShare = 0.5;
  const Identity identity =
      identify_samples(image, {options.work.threads, part_of(options.work.progress, 0, kReadShare)});
  require_same_image(head, image.axes(), kValueType<T>, identity.digest);
  return {identity, head.method, read_method(reader, image, head.method, from_share(options, kReadShare))};
}

/// Adds sizes and type.
template <int N>
std::unique_ptr<tegl::ActiveTiles<N>> to_active_tiles(const ImageSizes<N>& sizes, ValueType type, FoundIndex found) {
  return std::make_unique<MethodTiles<N>>(identity_of<N>(sizes, type, found.identity), found.method,
                                          std::move(found.index));
}
template <int N>
std::unique_ptr<tegl::ActiveTiles<N>> to_active_tiles(const ImageSizes<N>& sizes, ValueType type,
                                                      std::vector<TileNumber> chosen) {
  return std::make_unique<ChosenTiles<N>>(identity_of<N>(sizes, type, {}), std::move(chosen));
}

}  // namespace

}  // namespace detail

template <Value T, int N>
requires DimensionBetween<N, 2, 5> IndexedImage<N> identify(const Image<T, N>& image, const WorkOptions& work) {
  return detail::identity_of<N>(image.grid().sizes(), kValueType<T>,
                                detail::identify_samples(detail::SampleView<T>(image), work));
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> build_active_tiles(
    const Image<T, N>& image, ActiveMethod method, const ActiveTilesOptions& options) {
  require_used(method, options);
  return detail::to_active_tiles<N>(image.grid().sizes(), kValueType<T>,
                                    detail::build_index(detail::SampleView<T>(image), method, options));
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> load_active_tiles(ByteSource& from,
                                                                                     const Image<T, N>& image,
                                                                                     const WorkOptions& work) {
  return detail::to_active_tiles<N>(image.grid().sizes(), kValueType<T>,
                                    detail::read_index(from, detail::SampleView<T>(image), {.work = work}));
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> choose_tiles(const Image<T, N>& image,
                                                                                std::vector<TileNumber> tiles) {
  detail::check_chosen(detail::SampleView<T>(image), tiles);
  return detail::to_active_tiles<N>(image.grid().sizes(), kValueType<T>, std::move(tiles));
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                             \
  template IndexedImage<N> identify<T, N>(const Image<T, N>&, const WorkOptions&);                    \
  template std::unique_ptr<ActiveTiles<N>> build_active_tiles<T, N>(const Image<T, N>&, ActiveMethod, \
                                                                    const ActiveTilesOptions&);       \
  template std::unique_ptr<ActiveTiles<N>> load_active_tiles<T, N>(ByteSource&, const Image<T, N>&,   \
                                                                   const WorkOptions&);               \
  template std::unique_ptr<ActiveTiles<N>> choose_tiles<T, N>(const Image<T, N>&, std::vector<TileNumber>);
#include "base/instantiate.hpp"

}  // namespace tegl
