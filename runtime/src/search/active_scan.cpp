// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by a scan of all samples, one bit per sample, as in the extraction. This is the reference for all other
// methods, and the fastest one if most rows are active.
#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <span>
#include <vector>

#include "base/workers.hpp"
#include "image/bitplanes.hpp"
#include "kernel/extract_layers.hpp"
#include "search/active_tiles_methods.hpp"

namespace tegl::detail {

namespace {

/// Classifies the row of samples that begins at an offset in the image, in elements. Returns whether it has NaNs.
using RowClassifier = std::function<bool(std::ptrdiff_t, Word* high, Word* missing)>;

/// The bits of a layer of samples.
struct LayerBits {
  std::vector<Word> high, missing;  ///< rows x pitch
  std::vector<std::uint8_t> row_missing;
};

/// Everything that does not depend on the type of the values.
template <int N>
class FullScan {
 public:
  using Sizes = std::array<std::size_t, N>;

  FullScan(const Sizes& sizes, std::span<const std::ptrdiff_t> strides, unsigned threads)
      : grid_(sizes), shape_(sizes), threads_(threads) {
    std::copy_n(strides.begin(), N, strides_.begin());
  }

  void collect(const RowClassifier& classify_row, std::vector<TileNumber>& tiles) const {
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
      classify(from, classify_row, bits[from % 2]);
      for (std::size_t k = from; k < to; ++k) {
        classify(k + 1, classify_row, bits[(k + 1) % 2]);
        for (std::size_t row = 0; row < shape_.rows(); ++row) find_in_row(k, row, bits, found[k]);
      }
    });
    std::size_t count = tiles.size();
    for (const auto& part : found) count += part.size();
    tiles.reserve(count);
    for (const auto& part : found) tiles.insert(tiles.end(), part.begin(), part.end());
  }

 private:
  void classify(std::size_t k, const RowClassifier& classify_row, LayerBits& bits) const {
    for (std::size_t row = 0; row < shape_.rows(); ++row) {
      std::ptrdiff_t samples = static_cast<std::ptrdiff_t>(k) * strides_[N - 1];
      for (int a = 1; a < N - 1; ++a) samples += static_cast<std::ptrdiff_t>(shape_.index_of(row)[a]) * strides_[a];
      const std::size_t at = row * shape_.pitch();
      const bool any = classify_row(samples, bits.high.data() + at, bits.missing.data() + at);
      bits.row_missing[row] = any ? 1 : 0;
    }
  }

  void find_in_row(std::size_t k, std::size_t row, const std::array<LayerBits, 2>& bits,
                   std::vector<TileNumber>& found) const {
    constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
    typename TileGrid<N>::GridIndex index = shape_.index_of(row);
    if (!shape_.has_cells(index, kMiddle)) return;
    index[N - 1] = k;
    const TileNumber first = grid_.number(index);
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

  TileGrid<N> grid_;
  RowShape<N> shape_;
  std::array<std::ptrdiff_t, N> strides_;
  unsigned threads_;
};

template <int N>
void scan_all(std::span<const std::size_t> sizes, std::span<const std::ptrdiff_t> strides, unsigned threads,
              const RowClassifier& classify_row, std::vector<TileNumber>& tiles) {
  typename FullScan<N>::Sizes all;
  std::copy_n(sizes.begin(), N, all.begin());
  FullScan<N>(all, strides, threads).collect(classify_row, tiles);
}

template <Value T>
class FullScanMethod final : public IndexMethod {
 public:
  explicit FullScanMethod(const IndexTask<T>& task) : samples_(task.samples), threads_(task.options.work.threads) {}

  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return 0; }
  [[nodiscard]] bool needs_image() const noexcept override { return true; }
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    const RowClassifier classify = [&](std::ptrdiff_t first, Word* high, Word* missing) {
      return classify_row(samples_.data + first, samples_.strides[0], samples_.sizes[0], threshold, high, missing);
    };
    constexpr std::array scan = {scan_all<2>, scan_all<3>, scan_all<4>, scan_all<5>};
    scan[static_cast<std::size_t>(samples_.dim - 2)](samples_.axes(), samples_.strides, threads_, classify, tiles);
  }
  bool collect_rows(double /*isovalue*/, TileRowSet& rows) const override {
    rows.add_all();
    return true;
  }
  void write(IndexWriter& /*to*/) const override {}

 private:
  SampleView<T> samples_;
  unsigned threads_;
};

}  // namespace

template <Value T>
IndexMethodPtr make_full_scan(const IndexTask<T>& task) {
  return std::make_unique<FullScanMethod<T>>(task);
}

#define TEGL_INSTANTIATE(T) template IndexMethodPtr make_full_scan<T>(const IndexTask<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
