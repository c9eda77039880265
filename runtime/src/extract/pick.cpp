// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction of the contour component nearest to a point: find the nearest active tile, propagate through all faces
// that the contour crosses, and extract the contour in the tiles reached. Propagation enters a tile only through a face
// crossed by the contour, so the result consists of whole components.
#include "tegl/pick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/function_ref.hpp"
#include "base/nearest_item.hpp"
#include "base/progress.hpp"
#include "image/locate.hpp"
#include "kernel/extract_in_memory.hpp"
#include "search/propagation.hpp"
#include "tegl/components.hpp"

namespace tegl {

namespace {

// Progress after each step.
constexpr double kNearestShare = 0.1;  ///< search of the nearest tile
constexpr double kPropagated = 0.35;
constexpr double kExtracted = 0.5;
constexpr double kLabelled = 0.6;
constexpr double kChosen = 0.95;

/// A point in steps of the grid.
template <int N>
std::array<double, N> in_steps(const detail::CellPlace<N>& place) noexcept {
  std::array<double, N> at;
  for (int a = 0; a < N; ++a) at[a] = static_cast<double>(place.base[a]) + place.share[a];
  return at;
}

/// Searches the nearest active tile in shells around a point.
template <int N>
class NearestTile {
 public:
  NearestTile(const detail::TilePropagation& propagation, const TileGrid<N>& grid, const std::array<double, N>& at)
      : propagation_(propagation), grid_(grid), at_(at) {
    for (int a = 0; a < N; ++a)
      centre_[a] = std::min(static_cast<std::ptrdiff_t>(at[a]), static_cast<std::ptrdiff_t>(grid_.size(a)) - 1);
  }

  /// Reports progress. Returns false if no tile is active.
  bool find(PickReport<N>& report, const Progress& progress) {
    std::ptrdiff_t most = 0;
    for (int a = 0; a < N; ++a)
      most = std::max({most, centre_[a], static_cast<std::ptrdiff_t>(grid_.size(a)) - 1 - centre_[a]});
    for (radius_ = 0; radius_ <= most; ++radius_) {
      // Lower bound of the distance of the tiles of this shell.
      const double least = static_cast<double>(std::max<std::ptrdiff_t>(0, radius_ - 1));
      if (report.found && least * least > square_) break;
      detail::report_progress(progress, kNearestShare * static_cast<double>(radius_) / static_cast<double>(most + 1));
      std::array<std::ptrdiff_t, N> index = centre_;
      look(N - 1, false, index, report);
    }
    report.distance = std::sqrt(square_);
    return report.found;
  }

 private:
  /// Visits all tiles of the shell with these indices along the axes above `axis`. `on_shell`: these indices are on the
  /// shell already.
  void look(int axis, bool on_shell, std::array<std::ptrdiff_t, N>& index, PickReport<N>& report) {
    if (axis < 0) return weigh(index, report);
    const auto step_to = [&](std::ptrdiff_t d) {
      index[axis] = centre_[axis] + d;
      look(axis - 1, on_shell || d == -radius_ || d == radius_, index, report);
    };
    const std::ptrdiff_t first = std::max(-radius_, -centre_[axis]);
    const std::ptrdiff_t last = std::min(radius_, static_cast<std::ptrdiff_t>(grid_.size(axis)) - 1 - centre_[axis]);
    if (on_shell || radius_ <= reach_below(axis)) {
      for (std::ptrdiff_t d = first; d <= last; ++d) step_to(d);
      return;
    }
    // No lower axis can reach the shell.
    if (first == -radius_) step_to(first);
    if (last == radius_ && radius_ > 0) step_to(last);
  }

  /// Maximum distance of tiles along the axes below `axis`; -1: there are no such axes.
  [[nodiscard]] std::ptrdiff_t reach_below(int axis) const noexcept {
    std::ptrdiff_t reach = -1;
    for (int a = 0; a < axis; ++a)
      reach = std::max({reach, centre_[a], static_cast<std::ptrdiff_t>(grid_.size(a)) - 1 - centre_[a]});
    return reach;
  }

  void weigh(const std::array<std::ptrdiff_t, N>& index, PickReport<N>& report) {
    double square = 0;
    std::array<std::size_t, N> at;
    for (int a = 0; a < N; ++a) {
      const auto low = static_cast<double>(index[a]);
      const double off = std::max({0.0, low - at_[a], at_[a] - low - 1.0});
      square += off * off;
      at[a] = static_cast<std::size_t>(index[a]);
    }
    const TileNumber tile = grid_.number(at);
    if (report.found && (square > square_ || (square == square_ && tile > report.tile))) return;
    if (!propagation_.is_active(propagation_.signature(tile))) return;
    report.found = true;
    report.tile = tile;
    report.at = at;
    square_ = square;
  }

  const detail::TilePropagation& propagation_;
  const TileGrid<N>& grid_;
  std::array<double, N> at_;
  std::array<std::ptrdiff_t, N> centre_;
  std::ptrdiff_t radius_ = 0;
  double square_ = 0;
};

/// The label of the allowed component with the vertex nearest to a point; none if no component is allowed. Vertices
/// that rounding has moved outside of the grid count as on its border.
template <int N, class Real>
Index nearest_component(const Contour<N, Real>& contour, const ComponentLabels& labels,
                        const detail::GridLocator<N>& locator, const std::type_identity_t<std::array<double, N>>& at,
                        const std::vector<bool>& allowed, const Progress& progress) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const detail::NearestItem nearest =
      detail::nearest_item(contour.vertices.size(), progress, [&](std::size_t v) -> double {
        if (labels.vertices[v] == kNoComponent || !allowed[labels.vertices[v]]) return kNowhere;
        std::array<double, N> world;
        for (int a = 0; a < N; ++a) world[a] = static_cast<double>(contour.vertices[v][a]);
        detail::CellPlace<N> place;
        if (!locator.find_nearest(world, place)) return kNowhere;
        const auto here = in_steps(place);
        double square = 0;
        for (int a = 0; a < N; ++a) square += (here[a] - at[a]) * (here[a] - at[a]);
        return square;
      });
  if (nearest.item != detail::NearestItem::kNone) return labels.vertices[nearest.item];
  const auto first = std::find(allowed.begin(), allowed.end(), true);
  return first == allowed.end() ? kNoComponent : static_cast<Index>(first - allowed.begin());
}

/// Options for a contour with the same simplices whose vertices lie off the corners of tiles.
ExtractOptions inside_edges(const ExtractOptions& options, const Progress& progress) {
  ExtractOptions inside = options;
  inside.epsilon = 0.25;
  inside.normals = Normals::none;
  inside.work.progress = progress;
  return inside;
}

/// By component, whether it has a simplex in one of these tiles. `inside`: the same simplices on a grid with steps of
/// 1, with vertices away from the ends of edges. So no simplex lies in a face of its tile, and its centroid is inside
/// the tile, even if samples equal the isovalue, and for any coordinates of the image.
template <int N>
std::vector<bool> components_in(const Contour<N, double>& inside, const ComponentLabels& labels,
                                const TileGrid<N>& grid, const std::vector<TileNumber>& tiles,
                                const Progress& progress) {
  // Differs only if the caller's estimator is not deterministic.
  if (inside.simplices.size() != labels.simplices.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("the same contour has {} simplices in one pass and {} in the "
                                                        "next; expected an estimator whose results do not change",
                                                        labels.simplices.size(), inside.simplices.size()));
  std::vector<bool> result(labels.count);
  const auto look_at = [&](std::size_t s) {
    if (result[labels.simplices[s]]) return;
    std::array<double, N> middle{};
    for (const Index v : inside.simplices[s])
      for (int a = 0; a < N; ++a) middle[a] += inside.vertices[v][a] / N;
    std::array<std::size_t, N> at;
    for (int a = 0; a < N; ++a) at[a] = std::min(static_cast<std::size_t>(middle[a]), grid.size(a) - 1);
    if (std::binary_search(tiles.begin(), tiles.end(), grid.number(at))) result[labels.simplices[s]] = true;
  };
  detail::in_parts(inside.simplices.size(), progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) look_at(s);
  });
  return result;
}

/// By component, whether it is allowed.
using Choose = detail::FunctionRef<std::vector<bool>(const ComponentLabels& labels, const Progress& progress)>;

/// The component of a contour nearest to a point, among those that `choose(labels, progress)` allows. Reports progress
/// from kExtracted on.
template <int N, class Real>
Contour<N, Real> nearest_part(const Contour<N, Real>& contour, const detail::GridLocator<N>& locator,
                              const std::type_identity_t<std::array<double, N>>& at, const ExtractOptions& options,
                              std::uint64_t& components, Choose choose) {
  using detail::part_of;
  const Progress& progress = options.work.progress;
  const ComponentLabels labels =
      label_components(contour, {options.work.threads, part_of(progress, kExtracted, kLabelled)});
  const std::vector<bool> allowed = choose(labels, part_of(progress, kLabelled, 0.5 * (kLabelled + kChosen)));
  components = static_cast<std::uint64_t>(std::count(allowed.begin(), allowed.end(), true));
  std::vector<bool> keep(labels.count);
  const Index nearest =
      nearest_component(contour, labels, locator, at, allowed, part_of(progress, 0.5 * (kLabelled + kChosen), kChosen));
  if (nearest != kNoComponent) keep[nearest] = true;
  return select_components(contour, labels, keep, {options.work.threads, part_of(progress, kChosen, 1.0)});
}

template <int N>
std::array<double, N> place_in_grid(const detail::GridLocator<N>& locator, const Grid<N>& grid,
                                    const std::type_identity_t<std::array<double, N>>& point) {
  detail::CellPlace<N> place;
  if (locator.find(point, place)) return in_steps(place);
  std::array<double, N> first, last;
  for (int a = 0; a < N; ++a) {
    first[a] = grid.axes[a][0];
    last[a] = grid.axes[a][grid.axes[a].size() - 1];
  }
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("the point ({}) is not in the image; expected one from ({:.6g}) to ({:.6g}){}",
                          fmt::join(point, ", "), fmt::join(first, ", "), fmt::join(last, ", "),
                          grid.has_world_map() ? ", mapped to the world as the image is" : ""));
}

constexpr auto kChooseAll = [](const ComponentLabels& labels, const Progress& /*progress*/) {
  return std::vector<bool>(labels.count, true);
};

/// The tiles of the component at the tile nearest to a point.
template <int N>
struct ReachedTiles {
  PickReport<N> report = {};
  TileGrid<N> grid;
  std::vector<TileNumber> tiles = {};   ///< ascending
  std::vector<TileNumber> around = {};  ///< tiles beside them, if missing values may separate them
};

/// Searches the nearest active tile and propagates from it. `with_around`: whether to list the tiles around.
template <int N>
ReachedTiles<N> reach_tiles(const detail::TilePropagation& propagation, const TileGrid<N>& grid,
                            const std::array<double, N>& at, const WorkOptions& work, bool with_around) {
  ReachedTiles<N> reached{.grid = grid};
  if (grid.count() == 0 || !NearestTile<N>(propagation, grid, at).find(reached.report, work.progress)) return reached;
  bool at_missing = false;
  reached.tiles =
      propagation.run({reached.report.tile}, detail::PropagationRule::crossed_faces, Neighbourhood::faces, work.threads,
                      detail::part_of(work.progress, kNearestShare, kPropagated), &at_missing);
  std::sort(reached.tiles.begin(), reached.tiles.end());
  reached.report.tiles = reached.tiles.size();
  if (at_missing && with_around)
    reached.around = propagation.beside(reached.tiles, detail::PropagationRule::crossed_faces, Neighbourhood::all);
  return reached;
}

/// Extractions from an image, for work that is compiled once for all value types.
template <int N, class Real>
struct Extractors {
  /// Contour in these tiles; null: in all.
  detail::FunctionRef<Contour<N, Real>(const ExtractOptions& options, const std::vector<TileNumber>* tiles)> contour;
  /// On a grid with steps of 1, in double precision.
  detail::FunctionRef<Contour<N, double>(const ExtractOptions& options, const std::vector<TileNumber>* tiles)> on_steps;
  /// An empty contour with names and units.
  detail::FunctionRef<Contour<N, Real>(const ExtractOptions& options)> nothing;
};

/// The component in the tiles reached, from contours of the image.
template <int N, class Real>
PickedComponent<N, Real> extract_reached(const ReachedTiles<N>& reached, bool in_tiles,
                                         const detail::GridLocator<N>& locator, const std::array<double, N>& at,
                                         const ExtractOptions& options, const Extractors<N, Real>& extractors) {
  PickReport<N> found = reached.report;
  ExtractOptions rest = options;
  rest.work.progress = detail::part_of(options.work.progress, kPropagated, kExtracted);
  if (!found.found) {
    if (!options.close) {
      auto nothing = extractors.nothing(rest);
      detail::tell(options.work.progress, 1.0);
      return {std::move(nothing), found};
    }
    // The whole contour consists of caps: take the component of the nearest vertex.
    auto nearest =
        nearest_part<N, Real>(extractors.contour(rest, nullptr), locator, at, options, found.components, kChooseAll);
    return {std::move(nearest), found};
  }
  // If missing values separate the tiles around an edge, a vertex on it is doubled for the components on either side.
  // It comes first in one component and last in the others (split_nonmanifold.hpp), so all tiles around it are needed.
  std::vector<TileNumber> looked_at = reached.tiles;
  looked_at.insert(looked_at.end(), reached.around.begin(), reached.around.end());
  std::sort(looked_at.begin(), looked_at.end());
  const std::vector<TileNumber>* const chosen = in_tiles ? &looked_at : nullptr;
  const auto allowed = [&](const ComponentLabels& labels, const Progress& progress) {
    if (in_tiles && reached.around.empty()) return kChooseAll(labels, progress);
    const Progress extracting = detail::part_of(progress, 0.0, 0.9);
    return components_in(extractors.on_steps(inside_edges(options, extracting), chosen), labels, reached.grid,
                         reached.tiles, detail::part_of(progress, 0.9, 1.0));
  };
  auto nearest =
      nearest_part<N, Real>(extractors.contour(rest, chosen), locator, at, options, found.components, allowed);
  return {std::move(nearest), found};
}

/// The contour in these tiles; null: in all.
template <class Real, Value T, int N>
Contour<N, Real> extract_in(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                            const std::vector<TileNumber>* tiles) {
  if constexpr (N <= 4)
    if (tiles != nullptr) return extract<Real>(image, isovalue, *choose_tiles(image, *tiles), options);
  return extract<Real>(image, isovalue, options);
}

template <Value T, int N>
Contour<N, double> extract_on_steps(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                                    const std::vector<TileNumber>* tiles) {
  const Image<T, N> on_steps_of_1(image.data(), Grid<N>::unit(image.grid().sizes()), image.strides());
  return extract_in<double>(on_steps_of_1, isovalue, options, tiles);
}

}  // namespace

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> PickedComponent<N, Real> extract_component(
    const Image<T, N>& image, double isovalue, const std::type_identity_t<std::array<double, N>>& point,
    const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  const detail::GridLocator<N> locator(image.grid());
  const std::array<double, N> at = place_in_grid(locator, image.grid(), point);
  const bool in_tiles = !detail::kIsTileByTile<N> && !options.close;
  const detail::TilePropagation propagation(detail::SampleView<T>(image), isovalue);
  const ReachedTiles<N> reached =
      reach_tiles<N>(propagation, TileGrid<N>(image.grid().sizes()), at, options.work, in_tiles);
  const auto contour = [&](const ExtractOptions& with, const std::vector<TileNumber>* tiles) {
    return extract_in<Real>(image, isovalue, with, tiles);
  };
  const auto on_steps = [&](const ExtractOptions& with, const std::vector<TileNumber>* tiles) {
    return extract_on_steps(image, isovalue, with, tiles);
  };
  const auto nothing = [&](const ExtractOptions& with) {
    return extract<Real>(Image<T, N>(image).part(N - 1, 0, 1), isovalue, with);
  };
  return extract_reached<N, Real>(reached, in_tiles, locator, at, options, {contour, on_steps, nothing});
}

#define TEGL_INSTANTIATE_REAL(T, N, Real)                          \
  template PickedComponent<N, Real> extract_component<Real, T, N>( \
      const Image<T, N>&, double, const std::array<double, N>&, const ExtractOptions&);
#define TEGL_INSTANTIATE_DIMENSIONS(T, N) \
  TEGL_INSTANTIATE_REAL(T, N, float)      \
  TEGL_INSTANTIATE_REAL(T, N, double)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_REAL

}  // namespace tegl
