// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles from a seed set: the active seeds and all tiles reached from them through faces.
#include <vector>

#include "search/active_tiles_methods.hpp"
#include "search/propagation.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::detail {

namespace {

/// Propagation through faces needs few more seeds than through all neighbours, and tests 2N instead of 3^N - 1
/// neighbours.
constexpr Neighbourhood kNeighbourhood = Neighbourhood::faces;

template <Value T, int N>
class SeedIndex final : public tegl::ActiveTiles<N> {
 public:
  SeedIndex(const IndexTask<T, N>& task, std::vector<TileNumber> seeds)
      : tegl::ActiveTiles<N>(task.identity),
        image_(task.image),
        threads_(task.options.work.threads),
        seeds_(std::move(seeds)) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return ActiveMethod::seed_set; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return seeds_.size() * sizeof(TileNumber); }
  [[nodiscard]] bool needs_image() const noexcept override { return true; }

 protected:
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const TileFlood<T, N> flood(image_, isovalue);
    std::vector<TileNumber> active;
    for (const TileNumber seed : seeds_)
      if (flood.is_active(flood.signature(seed))) active.push_back(seed);
    const auto found = flood.run(std::move(active), FloodRule::active_neighbours, kNeighbourhood, threads_, {});
    tiles.insert(tiles.end(), found.begin(), found.end());
  }
  void write(IndexWriter& to) const override { to.array(seeds_); }

 private:
  Image<T, N> image_;
  unsigned threads_;
  std::vector<TileNumber> seeds_;
};

}  // namespace

template <Value T, int N>
ActiveTilesPtr<N> build_seed_index(const IndexTask<T, N>& task) {
  SeedSetOptions options;
  options.method = task.options.seed_method;
  options.scan_order = task.options.scan_order;
  options.neighbourhood = kNeighbourhood;
  options.work.threads = task.options.work.threads;
  options.work.progress = [&task](double fraction) {
    task.tell(fraction);
    return true;
  };
  return std::make_unique<SeedIndex<T, N>>(task, find_seeds(task.image, options).tiles);
}

template <Value T, int N>
ActiveTilesPtr<N> read_seed_index(IndexReader& from, const IndexTask<T, N>& task) {
  const TileNumber count = TileGrid<N>(task.identity.sizes).count();
  auto seeds = from.array<TileNumber>(count, "seeds");
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i] >= count || (i > 0 && seeds[i] <= seeds[i - 1]))
      IndexReader::damaged(fmt::format("seed {} is tile {}; expected ascending numbers below {}", i, seeds[i], count));
  return std::make_unique<SeedIndex<T, N>>(task, std::move(seeds));
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                         \
  template ActiveTilesPtr<N> build_seed_index<T, N>(const IndexTask<T, N>& task); \
  template ActiveTilesPtr<N> read_seed_index<T, N>(IndexReader&, const IndexTask<T, N>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
