// SPDX-License-Identifier: BSD-3-Clause
//
// Seed sets of an image, by any method.
#include "tegl/seed_set.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "search/padded_ranges.hpp"
#include "search/range_sample.hpp"
#include "search/seed_graph.hpp"
#include "search/seed_methods.hpp"
#include "search/seed_regions.hpp"

namespace tegl {

namespace {

constexpr std::array<std::string_view, 3> kNeighbourhoodNames = {"faces", "faces-and-edges", "all"};
constexpr std::array<std::string_view, 7> kMethodNames = {
    "cover", "whole1", "whole2-disjoint-sets", "whole2", "volume-thinning", "sweeping", "climbing"};

std::vector<int> checked_order(const std::vector<int>& order, int dim) {
  if (order.empty()) return detail::default_order(dim);
  const std::vector<int> axes = detail::default_order(dim);
  if (!std::is_permutation(order.begin(), order.end(), axes.begin(), axes.end()))
    throw Error(ErrorCode::InvalidArgument, fmt::format("scan order [{}]; expected all of the axes 0 to {}, each once",
                                                        fmt::join(order, ", "), dim - 1));
  return order;
}

/// Maximum work (SeedGraphOptions::most_work) up to which all trees are covered directly. It is larger for 8-bit
/// values, because with few levels `contract` removes most trees.
template <class Key>
constexpr std::uint64_t kMostWork = std::uint64_t{1} << (sizeof(Key) == 1 ? 20 : 18);

/// Finds the places of seeds from the ranges of tiles.
template <class Key>
class SeedFinder {
 public:
  SeedFinder(const detail::RangeMap<Key>& map, const SeedSetOptions& options, SeedSetStats& stats)
      : map_(map),
        options_(options),
        order_(checked_order(options.scan_order, map.tiles.dim())),
        progress_(detail::part_of(options.work.progress, 0.1, 1.0)),
        stats_(stats) {}

  std::vector<detail::Place> find() {
    const auto neighbours = map_.tiles.neighbours(options_.neighbourhood, order_);
    switch (options_.method) {
      case SeedMethod::sweeping:
        return detail::sweep_tiles(map_, neighbours, order_, progress_);
      case SeedMethod::climbing:
        return detail::climb_tiles(map_, neighbours, order_, progress_);
      case SeedMethod::whole1:
        return make_graph(order_, false, false, 1.0).roots;
      case SeedMethod::whole2:
        return of_whole2(detail::Dependence::ancestors);
      case SeedMethod::whole2_disjoint_sets:
        return of_whole2(detail::Dependence::sets);
      default:
        return of_cover();
    }
  }

  /// Reports progress up to the fraction `end`.
  detail::SeedGraph make_graph(std::vector<int> order, bool with_links, bool of_root_groups, double end) {
    detail::SeedGraphOptions options;
    options.neighbourhood = options_.neighbourhood;
    options.order = std::move(order);
    options.with_links = with_links;
    options.of_root_groups = of_root_groups;
    options.progress = detail::part_of(progress_, 0.0, end);
    detail::SeedGraph graph = detail::make_seed_graph(map_, options);
    count(graph);
    return graph;
  }

  /// The contracted graph of all tiles; null if the work exceeds `most_work`: then the reported progress is at most
  /// kProgressWithRoots.
  std::optional<detail::SeedGraph> make_small_graph(std::uint64_t most_work, const Progress& progress) {
    detail::SeedGraphOptions options;
    options.neighbourhood = options_.neighbourhood;
    options.order = detail::default_order(map_.tiles.dim());
    options.most_work = most_work;
    options.progress = progress;
    detail::SeedGraph graph = detail::make_seed_graph(map_, options);
    if (graph.too_much_work) return std::nullopt;
    count(graph);
    detail::contract(graph);
    return graph;
  }

 private:
  void count(const detail::SeedGraph& graph) noexcept {
    stats_.constant_tiles = graph.constant_tiles;
    stats_.groups = graph.groups;
    stats_.whole1 = graph.roots.size();
  }
  static std::vector<detail::Place> places(const detail::SeedGraph& graph, const std::vector<std::uint32_t>& trees) {
    std::vector<detail::Place> places;
    for (const std::uint32_t tree : trees) places.push_back(graph.roots[tree]);
    return places;
  }
  std::vector<detail::Place> of_whole2(detail::Dependence dependence) {
    const auto graph = make_graph(order_, true, true, 0.5);
    return places(graph, detail::whole2(graph, dependence, detail::part_of(progress_, 0.5, 1.0)));
  }
  std::vector<detail::Place> of_cover() {
    double done = 0.0;
    // For many tiles with distinct values trees are not even counted: counting takes as long as `make_regions`.
    if (sizeof(Key) == 1 || stats_.tiles <= kMostTilesCounted) {
      if (const auto graph = make_small_graph(kMostWork<Key>, detail::part_of(progress_, 0.0, 0.5))) {
        const auto cover = detail::cover_components(*graph, detail::part_of(progress_, 0.5, 1.0));
        stats_.lower_bound = cover.bound;
        return places(*graph, cover.trees);
      }
      done = 0.5 * detail::kProgressWithRoots;
    }
    stats_.reduced = true;
    const auto regions = detail::make_regions(map_, options_.neighbourhood, options_.work.threads,
                                              detail::part_of(progress_, done, 0.8));
    return detail::cover_regions(map_, regions, detail::part_of(progress_, 0.8, 1.0));
  }

  static constexpr std::uint64_t kMostTilesCounted = std::uint64_t{1} << 20;

  const detail::RangeMap<Key>& map_;
  const SeedSetOptions& options_;
  std::vector<int> order_;
  Progress progress_;
  SeedSetStats& stats_;
};

/// Ranges quantized to at most `levels` levels, taken from quantiles of range ends. Tiles active at a level are the
/// tiles active at one isovalue, so components at levels are components at some of the isovalues.
template <class Key>
detail::RangeMap<std::uint8_t> at_some_levels(const detail::RangeMap<Key>& map, std::size_t levels) {
  constexpr std::size_t kSample = std::size_t{1} << 16;
  std::vector<Key> ends;
  for (const detail::Place tile : detail::sample_places(map, kSample))
    ends.insert(ends.end(), {map.least[tile], map.greatest[tile]});
  std::sort(ends.begin(), ends.end());
  std::vector<Key> chosen;
  for (std::size_t i = 1; i <= levels && !ends.empty(); ++i)
    chosen.push_back(ends[i * (ends.size() - 1) / (levels + 1)]);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  detail::RangeMap<std::uint8_t> result{map.tiles, {}, {}};
  const auto level = [&](Key key) {
    return static_cast<std::uint8_t>(std::upper_bound(chosen.begin(), chosen.end(), key) - chosen.begin());
  };
  for (std::size_t i = 0; i < map.least.size(); ++i) {
    const bool constant = map.constant(static_cast<detail::Place>(i));
    result.least.push_back(constant ? std::uint8_t{0} : level(map.least[i]));
    result.greatest.push_back(constant ? std::uint8_t{0} : level(map.greatest[i]));
  }
  return result;
}

/// The tiles of `places`, without their ranges.
SeedSet to_seed_set(const detail::PaddedTiles& tiles, const SeedSetOptions& options,
                    const std::vector<detail::Place>& places) {
  SeedSet set;
  set.method = options.method;
  set.neighbourhood = options.neighbourhood;
  for (const detail::Place place : places) set.tiles.push_back(tiles.number(place));
  return set;
}

/// A lower bound from all levels or, if that takes too much work, from fewer and fewer of them.
template <class Key>
std::uint64_t lower_bound_of(const detail::RangeMap<Key>& map, const SeedSetOptions& options) {
  double done = 0.1;
  // The lower bound from all levels or from quantized ones; null if the work exceeds `most_work`.
  const auto pack = [&](const auto& ranges, std::uint64_t most_work) -> std::optional<std::uint64_t> {
    SeedSetStats stats;
    SeedFinder finder(ranges, options, stats);
    const Progress graphs = detail::part_of(options.work.progress, done, 0.5 + 0.5 * done);
    if (const auto graph = finder.make_small_graph(most_work, graphs))
      return detail::pack_components(*graph, detail::part_of(options.work.progress, 0.5 + 0.5 * done, 1.0));
    done += 0.5 * detail::kProgressWithRoots * (1.0 - done);
    return std::nullopt;
  };
  std::optional<std::uint64_t> bound = pack(map, kMostWork<Key>);
  for (std::size_t levels = 255; !bound; levels = std::max<std::size_t>(1, levels / 4))
    bound = pack(at_some_levels(map, levels), levels > 1 ? 32 * kMostWork<std::uint8_t> : ~std::uint64_t{0});
  detail::report_progress(options.work.progress, 1.0);
  return *bound;
}

}  // namespace

std::string_view name_of(Neighbourhood neighbourhood) noexcept {
  return kNeighbourhoodNames[static_cast<std::size_t>(neighbourhood)];
}
std::string_view name_of(SeedMethod method) noexcept { return kMethodNames[static_cast<std::size_t>(method)]; }
std::vector<SeedMethod> seed_methods() {
  std::vector<SeedMethod> methods;
  for (std::size_t i = 0; i < kMethodNames.size(); ++i) methods.push_back(static_cast<SeedMethod>(i));
  return methods;
}

template <Value T>
SeedSet detail::find_seeds(const SampleView<T>& samples, const SeedSetOptions& options) {
  SeedSetStats found;
  found.tiles = TileShape(samples.axes()).count();
  const auto map = map_ranges(samples, options.work.threads, part_of(options.work.progress, 0.0, 0.1));
  SeedFinder<KeyOf<T>> finder(map, options, found);
  std::vector<Place> places;
  if (options.method == SeedMethod::volume_thinning) {
    places = thin_tiles(samples, map.tiles, part_of(options.work.progress, 0.1, 1.0));
    if (!options.keep_constant_tiles) std::erase_if(places, [&](Place place) { return map.constant(place); });
  } else {
    places = finder.find();
  }
  report_progress(options.work.progress, 1.0);
  std::sort(places.begin(), places.end());  // ascending places are ascending tile numbers
  SeedSet set = to_seed_set(map.tiles, options, places);
  for (const Place place : places) {
    const bool never = map.constant(place);
    set.least.push_back(never ? 0.0 : static_cast<double>(value_of<T>(map.least[place])));
    set.greatest.push_back(never ? 0.0 : static_cast<double>(value_of<T>(map.greatest[place])));
  }
  set.stats = found;
  return set;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> SeedSet find_seeds(const Image<T, N>& image, const SeedSetOptions& options) {
  return detail::find_seeds(detail::SampleView<T>(image), options);
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::uint64_t seed_lower_bound(const Image<T, N>& image,
                                                                  const SeedSetOptions& options) {
  const auto map = detail::map_ranges(detail::SampleView<T>(image), options.work.threads,
                                      detail::part_of(options.work.progress, 0.0, 0.1));
  return lower_bound_of(map, options);
}

#define TEGL_INSTANTIATE(T) template SeedSet detail::find_seeds<T>(const SampleView<T>&, const SeedSetOptions&);
#include "base/instantiate.hpp"
#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                       \
  template SeedSet find_seeds<T, N>(const Image<T, N>&, const SeedSetOptions&); \
  template std::uint64_t seed_lower_bound<T, N>(const Image<T, N>&, const SeedSetOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
