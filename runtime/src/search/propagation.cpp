// SPDX-License-Identifier: BSD-3-Clause
//
// Propagation. Based on: Bajaj, Pascucci, Schikore, Fast isocontouring for improved interactivity, 1996.
#include "search/propagation.hpp"

#include <atomic>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>

#include "base/workers.hpp"

namespace tegl::detail {

/// One bit per tile, set atomically by the first thread that reaches it. calloc provides zeroed pages on demand, so
/// pages without visited tiles take no memory.
class TilePropagation::Seen {
 public:
  explicit Seen(TileNumber tiles) : words_(static_cast<Word*>(std::calloc((tiles + 63) / 64, sizeof(Word)))) {
    if (words_ == nullptr) throw std::bad_alloc();
  }
  /// Whether the tile was not seen before.
  bool add(TileNumber tile) noexcept {
    const Word bit = Word{1} << (tile % 64);
    const std::atomic_ref<Word> word(words_.get()[tile / 64]);
    if ((word.load(std::memory_order_relaxed) & bit) != 0) return false;
    return (word.fetch_or(bit, std::memory_order_relaxed) & bit) == 0;
  }

 private:
  struct Free {
    void operator()(Word* words) const noexcept { std::free(words); }
  };
  std::unique_ptr<Word, Free> words_;
};

namespace {

/// Reads signatures of tiles with this number of corners.
template <Value T, unsigned Corners>
class SignatureReader {
 public:
  SignatureReader(const SampleView<T>& samples, double isovalue)
      : data_(samples.data), threshold_(make_threshold<T>(isovalue)) {
    for (unsigned corner = 0; corner < Corners; ++corner)
      for (int a = 0; a < samples.dim; ++a)
        if ((corner >> a & 1u) != 0) corners_[corner] += samples.strides[a];
  }
  std::uint32_t operator()(std::ptrdiff_t lowest) const noexcept {
    std::uint32_t signature = 0;
    bool missing = threshold_.never;
    for (unsigned corner = 0; corner < Corners; ++corner) {
      const T value = data_[lowest + corners_[corner]];
      signature |= (value >= threshold_.value ? 1u : 0u) << corner;
      if constexpr (std::is_floating_point_v<T>) missing = missing || value != value;
    }
    return missing ? 0 : signature;
  }

 private:
  const T* data_;
  Threshold<T> threshold_;
  std::array<std::ptrdiff_t, Corners> corners_{};  ///< from a tile's lowest sample, in elements
};

template <Value T>
std::function<std::uint32_t(std::ptrdiff_t)> signature_reader(const SampleView<T>& samples, double isovalue) {
  switch (samples.dim) {
    case 2:
      return SignatureReader<T, 4>(samples, isovalue);
    case 3:
      return SignatureReader<T, 8>(samples, isovalue);
    case 4:
      return SignatureReader<T, 16>(samples, isovalue);
    default:
      return SignatureReader<T, 32>(samples, isovalue);
  }
}

}  // namespace

template <Value T>
TilePropagation::TilePropagation(const SampleView<T>& samples, double isovalue)
    : strides_(samples.strides),
      grid_(samples.axes()),
      all_high_(static_cast<std::uint32_t>((std::uint64_t{1} << (1u << samples.dim)) - 1)),
      signature_at_(signature_reader(samples, isovalue)) {}

std::uint32_t TilePropagation::signature(TileNumber tile) const noexcept {
  return signature_at_(lowest(grid_.index(tile)));
}

std::ptrdiff_t TilePropagation::lowest(const Index& index) const noexcept {
  std::ptrdiff_t at = 0;
  for (int a = 0; a < grid_.dim(); ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides_[a];
  return at;
}

std::vector<TilePropagation::Move> TilePropagation::moves(Neighbourhood neighbourhood) const {
  std::vector<Move> result;
  for (const Step& step : neighbour_steps(grid_.dim(), neighbourhood)) {
    Move move{step, 0, 0, all_high_};
    for (int a = 0; a < grid_.dim(); ++a) {
      move.distance += step[a] * static_cast<std::ptrdiff_t>(grid_.stride(a));
      move.samples += step[a] * strides_[a];
      for (unsigned corner = 0; corner < 1u << grid_.dim(); ++corner)
        if (step[a] != 0 && (corner >> a & 1u) != (step[a] > 0 ? 1u : 0u)) move.face &= ~(1u << corner);
    }
    result.push_back(move);
  }
  return result;
}

void TilePropagation::visit(TileNumber tile, const std::vector<Move>& moves, PropagationRule rule, Seen& seen,
                            Found& found) const {
  const Index index = grid_.index(tile);
  const std::ptrdiff_t at = lowest(index);
  const std::uint32_t own = signature_at_(at);
  for (const Move& move : moves) {
    const std::uint32_t shared = own & move.face;
    if (rule == PropagationRule::crossed_faces && (shared == 0 || shared == move.face)) continue;
    bool inside = true;
    for (int a = 0; a < grid_.dim(); ++a) {
      const std::size_t next = index[a] + static_cast<std::size_t>(static_cast<std::ptrdiff_t>(move.along[a]));
      inside = inside && next < grid_.size(a);  // negative indices wrap around to large ones
    }
    if (!inside) continue;
    const auto other = static_cast<TileNumber>(static_cast<std::ptrdiff_t>(tile) + move.distance);
    if (!seen.add(other)) continue;
    if (is_active(signature_at_(at + move.samples)))
      found.tiles.push_back(other);
    else
      found.stopped = true;
  }
}

std::vector<TileNumber> TilePropagation::run(std::vector<TileNumber> from, PropagationRule rule,
                                             Neighbourhood neighbourhood, unsigned threads, const Progress& progress,
                                             bool* stopped) const {
  const std::vector<Move> moves = this->moves(neighbourhood);
  // the starting tiles are the first layer
  Seen seen(grid_.count());
  Found all;
  for (const TileNumber tile : from)
    if (seen.add(tile)) all.tiles.push_back(tile);
  constexpr std::size_t kGrain = 512;  // one thread is faster for fewer tiles
  Workers<Found> workers(threads, [] { return Found(); });
  std::mutex mutex;
  for (std::size_t first = 0; first < all.tiles.size();) {
    const std::size_t end = all.tiles.size();
    report_progress(progress, static_cast<double>(end) / (1.0 + static_cast<double>(grid_.count())));
    if (end - first <= kGrain) {
      for (std::size_t i = first; i < end; ++i) visit(all.tiles[i], moves, rule, seen, all);
    } else {
      Found layer;
      workers.for_range(end - first, kGrain, [&](std::size_t begin, std::size_t stop, Found& found) {
        found.tiles.clear();
        found.stopped = false;
        for (std::size_t i = first + begin; i < first + stop; ++i) visit(all.tiles[i], moves, rule, seen, found);
        const std::lock_guard lock(mutex);
        layer.tiles.insert(layer.tiles.end(), found.tiles.begin(), found.tiles.end());
        layer.stopped = layer.stopped || found.stopped;
      });
      all.tiles.insert(all.tiles.end(), layer.tiles.begin(), layer.tiles.end());
      all.stopped = all.stopped || layer.stopped;
    }
    first = end;
  }
  if (stopped != nullptr) *stopped = all.stopped;
  return std::move(all.tiles);
}

std::vector<TileNumber> TilePropagation::beside(const std::vector<TileNumber>& tiles, PropagationRule rule,
                                                Neighbourhood neighbourhood) const {
  const std::vector<Move> moves = this->moves(neighbourhood);
  Seen seen(grid_.count());
  for (const TileNumber tile : tiles) seen.add(tile);
  Found found;
  for (const TileNumber tile : tiles) visit(tile, moves, rule, seen, found);
  return std::move(found.tiles);
}

#define TEGL_INSTANTIATE(T) template TilePropagation::TilePropagation(const SampleView<T>&, double);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
