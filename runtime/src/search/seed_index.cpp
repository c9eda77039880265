// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles from a seed set: the active seeds and all tiles reached from them through faces.
#include <vector>

#include "search/active_tiles_methods.hpp"
#include "search/propagation.hpp"
#include "search/seed_methods.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::detail {

namespace {

/// Propagation through faces needs few more seeds than through all neighbours, and tests 2N instead of 3^N - 1
/// neighbours.
constexpr Neighbourhood kNeighbourhood = Neighbourhood::faces;

template <Value T>
class SeedIndex final : public IndexMethod {
 public:
  SeedIndex(const IndexTask<T>& task, std::vector<TileNumber> seeds)
      : samples_(task.samples), threads_(task.options.work.threads), seeds_(std::move(seeds)) {}

  [[nodiscard]] std::size_t memory_bytes() const noexcept override { return seeds_.size() * sizeof(TileNumber); }
  [[nodiscard]] bool needs_image() const noexcept override { return true; }
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const TilePropagation propagation(samples_, isovalue);
    std::vector<TileNumber> active;
    for (const TileNumber seed : seeds_)
      if (propagation.is_active(propagation.signature(seed))) active.push_back(seed);
    const auto found =
        propagation.run(std::move(active), PropagationRule::active_neighbours, kNeighbourhood, threads_, {});
    tiles.insert(tiles.end(), found.begin(), found.end());
  }
  void write(IndexWriter& to) const override { to.array(seeds_); }

 private:
  SampleView<T> samples_;
  unsigned threads_;
  std::vector<TileNumber> seeds_;
};

}  // namespace

template <Value T>
IndexMethodPtr build_seed_index(const IndexTask<T>& task) {
  SeedSetOptions options;
  options.method = task.options.seed_method;
  options.scan_order = task.options.scan_order;
  options.neighbourhood = kNeighbourhood;
  options.work.threads = task.options.work.threads;
  options.work.progress = [&task](double fraction) {
    task.tell(fraction);
    return true;
  };
  return std::make_unique<SeedIndex<T>>(task, find_seeds(task.samples, options).tiles);
}

template <Value T>
IndexMethodPtr read_seed_index(IndexReader& from, const IndexTask<T>& task) {
  const TileNumber count = task.tiles.count();
  auto seeds = from.array<TileNumber>(count, "seeds");
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i] >= count || (i > 0 && seeds[i] <= seeds[i - 1]))
      IndexReader::damaged(fmt::format("seed {} is tile {}; expected ascending numbers below {}", i, seeds[i], count));
  return std::make_unique<SeedIndex<T>>(task, std::move(seeds));
}

#define TEGL_INSTANTIATE(T)                                         \
  template IndexMethodPtr build_seed_index<T>(const IndexTask<T>&); \
  template IndexMethodPtr read_seed_index<T>(IndexReader&, const IndexTask<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
