// SPDX-License-Identifier: BSD-3-Clause
//
// Builds and loads indexes of active tiles, by any method, and makes indexes of chosen tiles.
#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "search/active_tiles_methods.hpp"

namespace tegl {

namespace {
constexpr double kIdentifyShare = 0.2;  ///< fraction of the progress
}

namespace detail {

namespace {

/// Adds a row of samples to the hash of its layer. Sets `missing` if any sample is NaN.
template <Value T>
std::uint64_t hash_row(const T* samples, std::ptrdiff_t stride, std::vector<T>& row, std::uint64_t hash,
                       bool& missing) {
  if (stride != 1) {
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = samples[static_cast<std::ptrdiff_t>(i) * stride];
    samples = row.data();
  }
  if constexpr (std::is_floating_point_v<T>) {
    unsigned any = 0;
    for (std::size_t i = 0; i < row.size(); ++i) any |= samples[i] != samples[i] ? 1u : 0u;
    missing = missing || any != 0;
  }
  return hash_bytes(samples, row.size() * sizeof(T), hash);
}

template <int N, Value T>
IndexedImage<N> known_of(const Image<T, N>& image) {
  return {image.grid().sizes(), kValueType<T>, 0, false};
}

/// Whether a corner of a tile is NaN.
template <Value T, int N>
bool has_missing_corner(const Image<T, N>& image, const typename TileGrid<N>::Index& lowest) noexcept {
  if constexpr (std::is_floating_point_v<T>)
    for (unsigned corner = 0; corner < 1u << N; ++corner) {
      auto index = lowest;
      for (int a = 0; a < N; ++a) index[a] += corner >> a & 1u;
      if (std::isnan(image(index))) return true;
    }
  return false;
}

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

}  // namespace

}  // namespace detail

template <Value T, int N>
requires DimensionBetween<N, 2, 5> IndexedImage<N> identify(const Image<T, N>& image, const WorkOptions& work) {
  IndexedImage<N> result = detail::known_of(image);
  const auto& sizes = result.sizes;
  const std::size_t layers = sizes[N - 1];
  std::size_t rows = 1;
  for (int a = 1; a < N - 1; ++a) rows *= sizes[a];
  struct Layer {
    std::uint64_t hash;
    bool missing = false;
  };
  std::vector<Layer> found(layers);
  detail::Workers<std::vector<T>> workers(work.threads, [&] { return std::vector<T>(sizes[0]); });
  constexpr std::size_t kSamplesAtOnce = std::size_t{1} << 24;
  const std::size_t at_once = std::max<std::size_t>(1, kSamplesAtOnce / (rows * sizes[0]));
  // hash each layer
  for (std::size_t first = 0; first < layers; first += at_once) {
    if (work.progress && !work.progress(static_cast<double>(first) / static_cast<double>(layers)))
      throw Error(ErrorCode::Cancelled, fmt::format("reading of values cancelled at layer {} of {}", first, layers));
    workers.for_range(std::min(at_once, layers - first), 1,
                      [&](std::size_t from, std::size_t to, std::vector<T>& room) {
                        for (std::size_t k = first + from; k < first + to; ++k) {
                          Layer layer{k};
                          for (std::size_t row = 0; row < rows; ++row) {
                            const T* samples = image.data() + static_cast<std::ptrdiff_t>(k) * image.strides()[N - 1];
                            for (std::size_t a = 1, rest = row; a + 1 < N; rest /= sizes[a++])
                              samples += static_cast<std::ptrdiff_t>(rest % sizes[a]) * image.strides()[a];
                            layer.hash = detail::hash_row(samples, image.strides()[0], room, layer.hash, layer.missing);
                          }
                          found[k] = layer;
                        }
                      });
  }
  // combine type, sizes and layers
  const std::string_view type = name_of(result.value_type);
  result.digest = detail::hash_bytes(type.data(), type.size(), N);
  for (const std::size_t size : sizes) {
    const std::uint64_t wide = size;
    result.digest = detail::hash_bytes(&wide, sizeof(wide), result.digest);
  }
  for (const Layer& layer : found) {
    result.digest = detail::hash_bytes(&layer.hash, sizeof(layer.hash), result.digest);
    result.any_missing = result.any_missing || layer.missing;
  }
  return result;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> build_active_tiles(
    const Image<T, N>& image, ActiveMethod method, const ActiveTilesOptions& options) {
  // A full scan builds nothing, so identification is all of its progress; other methods read the values several times
  // more.
  const double identified = method == ActiveMethod::full_scan ? 1.0 : kIdentifyShare;
  const IndexedImage<N> identity =
      identify(image, {options.work.threads, detail::part_of(options.work.progress, 0, identified)});
  ActiveTilesOptions rest = options;
  rest.work.progress = detail::part_of(options.work.progress, identified, 1);
  const detail::IndexTask<T, N> task{image, identity, rest};
  task.tell(0);
  detail::ActiveTilesPtr<N> result;
  switch (method) {
    case ActiveMethod::full_scan:
      result = detail::make_full_scan(task);
      break;
    case ActiveMethod::interval_tree:
      result = detail::build_interval_tree(task);
      break;
    case ActiveMethod::span_space:
      result = detail::build_span_space(task);
      break;
    case ActiveMethod::min_max_tree:
      result = detail::build_min_max_tree(task);
      break;
    case ActiveMethod::seed_set:
      result = detail::build_seed_index(task);
      break;
  }
  task.tell(1);
  return result;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> load_active_tiles(
    ByteSource& from, const Image<T, N>& image, const ActiveTilesOptions& options) {
  // compare sizes and type first: computing the digest reads all values
  detail::IndexReader reader(from);
  const ActiveTilesHead head = detail::read_head(reader);
  IndexedImage<N> identity = detail::known_of(image);
  detail::require_same_image(head, identity.sizes, identity.value_type, head.digest);
  constexpr double kReadShare = 0.5;
  identity = identify(image, {options.work.threads, detail::part_of(options.work.progress, 0, kReadShare)});
  detail::require_same_image(head, identity.sizes, identity.value_type, identity.digest);
  ActiveTilesOptions rest = options;
  rest.work.progress = detail::part_of(options.work.progress, kReadShare, 1);
  const detail::IndexTask<T, N> task{image, identity, rest};
  task.tell(0);
  detail::ActiveTilesPtr<N> result;
  switch (head.method) {
    case ActiveMethod::full_scan:
      result = detail::make_full_scan(task);
      break;
    case ActiveMethod::interval_tree:
      result = detail::read_interval_tree(reader, task);
      break;
    case ActiveMethod::span_space:
      result = detail::read_span_space(reader, task);
      break;
    case ActiveMethod::min_max_tree:
      result = detail::read_min_max_tree(reader, task);
      break;
    case ActiveMethod::seed_set:
      result = detail::read_seed_index(reader, task);
      break;
  }
  reader.finish();
  task.tell(1);
  return result;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> choose_tiles(const Image<T, N>& image,
                                                                                std::vector<TileNumber> tiles) {
  const TileGrid<N> grid(image.grid().sizes());
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i] >= grid.count())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("tile {} is chosen; expected one of {}", tiles[i], grid.count()));
    if (i > 0 && tiles[i] <= tiles[i - 1])
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("tile {} is chosen after {}; expected ascending numbers", tiles[i], tiles[i - 1]));
  }
  std::erase_if(tiles, [&](TileNumber tile) { return detail::has_missing_corner(image, grid.index(tile)); });
  return std::make_unique<detail::ChosenTiles<N>>(detail::known_of(image), std::move(tiles));
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                             \
  template IndexedImage<N> identify<T, N>(const Image<T, N>&, const WorkOptions&);                    \
  template std::unique_ptr<ActiveTiles<N>> build_active_tiles<T, N>(const Image<T, N>&, ActiveMethod, \
                                                                    const ActiveTilesOptions&);       \
  template std::unique_ptr<ActiveTiles<N>> load_active_tiles<T, N>(ByteSource&, const Image<T, N>&,   \
                                                                   const ActiveTilesOptions&);        \
  template std::unique_ptr<ActiveTiles<N>> choose_tiles<T, N>(const Image<T, N>&, std::vector<TileNumber>);
#include "base/instantiate.hpp"

}  // namespace tegl
