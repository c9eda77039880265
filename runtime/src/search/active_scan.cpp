// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by a scan of all samples, one bit per sample, as in the extraction. This is the reference for all other
// methods, and the fastest one if most rows are active.
#include <bit>
#include <vector>

#include "base/workers.hpp"
#include "image/bitplanes.hpp"
#include "kernel/extract_layers.hpp"
#include "search/active_tiles_methods.hpp"

namespace tegl::detail {

namespace {

/// The bits of a layer of samples.
struct LayerBits {
  std::vector<Word> high, missing;  ///< rows x pitch
  std::vector<std::uint8_t> row_missing;
};

template <Value T, int N>
class FullScan final : public tegl::ActiveTiles<N> {
 public:
  explicit FullScan(const IndexTask<T, N>& task)
      : tegl::ActiveTiles<N>(task.identity),
        image_(task.image),
        shape_(task.image.grid().sizes()),
        threads_(task.options.work.threads) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return ActiveMethod::full_scan; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return 0; }
  [[nodiscard]] bool needs_image() const noexcept override { return true; }

 protected:
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    const std::size_t slabs = shape_.layers() - 1;
    std::vector<std::vector<TileNumber>> found(slabs);
    Workers<std::array<LayerBits, 2>> workers(threads_, [&] {
      LayerBits bits;
      bits.high.resize(shape_.rows() * shape_.pitch());
      bits.missing.resize(shape_.rows() * shape_.pitch());
      bits.row_missing.resize(shape_.rows());
      return std::array{bits, bits};
    });
    // Each part classifies its own first layer again.
    constexpr std::size_t kLeastSlabs = 8;
    workers.for_range(slabs, kLeastSlabs, [&](std::size_t from, std::size_t to, std::array<LayerBits, 2>& bits) {
      classify(from, threshold, bits[from % 2]);
      for (std::size_t k = from; k < to; ++k) {
        classify(k + 1, threshold, bits[(k + 1) % 2]);
        for (std::size_t row = 0; row < shape_.rows(); ++row) find_in_row(k, row, bits, found[k]);
      }
    });
    std::size_t count = tiles.size();
    for (const auto& part : found) count += part.size();
    tiles.reserve(count);
    for (const auto& part : found) tiles.insert(tiles.end(), part.begin(), part.end());
  }

  void collect_rows(double /*isovalue*/, TileRowSet& rows) const override { rows.add_all(); }
  void write(IndexWriter& /*to*/) const override {}

 private:
  void classify(std::size_t k, const Threshold<T>& threshold, LayerBits& bits) const {
    const auto& strides = image_.strides();
    for (std::size_t row = 0; row < shape_.rows(); ++row) {
      const T* samples = image_.data() + static_cast<std::ptrdiff_t>(k) * strides[N - 1];
      for (int a = 1; a < N - 1; ++a) samples += static_cast<std::ptrdiff_t>(shape_.index_of(row)[a]) * strides[a];
      const std::size_t at = row * shape_.pitch();
      const bool any =
          classify_row(samples, strides[0], shape_.size(0), threshold, bits.high.data() + at, bits.missing.data() + at);
      bits.row_missing[row] = any ? 1 : 0;
    }
  }

  void find_in_row(std::size_t k, std::size_t row, const std::array<LayerBits, 2>& bits,
                   std::vector<TileNumber>& found) const {
    constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
    typename TileGrid<N>::GridIndex index = shape_.index_of(row);
    if (!shape_.has_cells(index, kMiddle)) return;
    index[N - 1] = k;
    const TileNumber first = this->grid().number(index);
    for (std::size_t w = 0; w < shape_.words(); ++w) {
      Word any = 0, all = ~Word{0}, next_any = 0, next_all = ~Word{0}, missing = 0;
      for (unsigned corner = 0; corner <= kMiddle; corner += 2)
        for (const std::size_t layer : {k % 2, (k + 1) % 2}) {
          const std::size_t at = shape_.shifted(row, corner);
          const Word* const high = bits[layer].high.data() + at * shape_.pitch() + w;
          any |= high[0];
          all &= high[0];
          next_any |= high[1];
          next_all &= high[1];
          if (bits[layer].row_missing[at] == 0) continue;
          const Word* const none = bits[layer].missing.data() + at * shape_.pitch() + w;
          missing |= none[0] | none[0] >> 1 | none[1] << (kWordBits - 1);
        }
      any |= any >> 1 | next_any << (kWordBits - 1);
      all &= all >> 1 | next_all << (kWordBits - 1);
      for (Word active = any & ~all & ~missing & shape_.mask(w, true); active != 0; active &= active - 1)
        found.push_back(first + w * kWordBits + static_cast<unsigned>(std::countr_zero(active)));
    }
  }

  Image<T, N> image_;
  RowShape<N> shape_;
  unsigned threads_;
};

}  // namespace

template <Value T, int N>
ActiveTilesPtr<N> make_full_scan(const IndexTask<T, N>& task) {
  return std::make_unique<FullScan<T, N>>(task);
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N) template ActiveTilesPtr<N> make_full_scan<T, N>(const IndexTask<T, N>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
