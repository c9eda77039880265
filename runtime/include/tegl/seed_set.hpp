// SPDX-License-Identifier: BSD-3-Clause
//
// Seed sets: few tiles from which the active tiles of any isovalue are found by going from neighbour to neighbour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tegl/active_tiles.hpp"
#include "tegl/error.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// Which tiles are neighbours of a tile. In 2D the first two are the same.
enum class Neighbourhood : std::uint8_t {
  faces,            ///< F: they share an (N-1)-face
  faces_and_edges,  ///< F+E: they share an edge at least
  all,              ///< F+E+V: they share a corner at least, all 3^N - 1
};
/// "faces", "faces-and-edges", "all".
std::string_view neighbourhood_name(Neighbourhood neighbourhood) noexcept;

/// How seeds are found. All except `cover` come from the literature; docs/seed-sets.md compares them and their sizes.
enum class SeedMethod : std::uint8_t {
  cover,                 ///< ours: a cover of the components of active tiles over all isovalues; by far the fewest
  whole1,                ///< Hung 2005: tiles whose range does not lie in that of a neighbour, one of each group
  whole2_disjoint_sets,  ///< of these, those not covered by neighbours of other sets (Hung 2005, 3.4.4)
  whole2,                ///< of these, those not covered by neighbours that do not depend on them (Hung 2005, 3.4.2)
  volume_thinning,       ///< Itoh, Yamaguchi, Koyamada 1996: a skeleton that joins all extrema
  sweeping,              ///< Bajaj, Pascucci, Schikore 1996: tiles not covered by the neighbours before them in a scan
  climbing,  ///< the same authors: tiles not covered by those before them, in an order that grows from seeds
};
/// "cover", "whole1", ...
std::string_view seed_method_name(SeedMethod method) noexcept;
/// All methods, in the order of the enumeration.
std::vector<SeedMethod> seed_methods();

/// How seeds are found.
struct SeedSetOptions {
  SeedMethod method = SeedMethod::cover;             ///< by which method
  Neighbourhood neighbourhood = Neighbourhood::all;  ///< which tiles seeds reach
  /// All axes, the one that a scan runs along first; empty: 0, 1, ... `cover` does not depend on it.
  std::vector<int> scan_order = {};
  /// volume_thinning alone: whether tiles of one value, which are never active, stay in the skeleton as published.
  bool keep_constant_tiles = false;
  /// How many threads read the image; all else is done by one.
  unsigned threads = 0;
  Progress progress = {};  ///< see Progress
};

/// Tiles that meet every component of active tiles at every isovalue: any two neighbours that are active belong to one
/// component, in the sense of `neighbourhood`.
struct SeedSet {
  SeedMethod method = SeedMethod::cover;             ///< found by this method
  Neighbourhood neighbourhood = Neighbourhood::all;  ///< for these neighbours
  std::vector<TileNumber> tiles = {};                ///< ascending
  /// Active where least[i] < T <= greatest[i].
  std::vector<double> least = {}, greatest = {};  ///< of each tile's corners
};

/// What a seed set costs.
struct SeedSetStats {
  std::uint64_t tiles = 0;           ///< of the image
  std::uint64_t constant_tiles = 0;  ///< of one value, or with a missing corner: never active
  std::uint64_t groups = 0;          ///< of neighbours with one range
  std::uint64_t whole1 = 0;          ///< groups that lie in no neighbour's range: some smallest seed set is of these
  std::uint64_t lower_bound = 0;     ///< see seed_lower_bound; of `cover` alone, and 0 if `reduced`
  /// `cover` alone: too many tiles were left to choose from all of them, as in large images of measured floats, and it
  /// chose from fewer (docs/seed-sets.md). The three numbers above are 0 then.
  bool reduced = false;
};

/// Finds seeds. Tiles with missing values are never active and no seeds. An image without active tiles has none.
/// Time and memory: about linear in tiles for all but `whole2`, which is so where neighbouring tiles have similar
/// ranges. Errors: TooLarge for 2^32 tiles
/// and more, InvalidArgument for a scan order that is no permutation of the axes, Cancelled. Deterministic.
template <Value T, int N>
SeedSet find_seeds(const Image<T, N>& image, const SeedSetOptions& options = {}, SeedSetStats* stats = nullptr);

/// A number that no seed set with this neighbourhood can be smaller than: so many components of active tiles, at
/// isovalues of their own, of which no tile meets two. It is found greedily, and in images with
/// too many tiles to choose from at some isovalues only: a larger one may exist. Errors: as find_seeds.
template <Value T, int N>
std::uint64_t seed_lower_bound(const Image<T, N>& image, const SeedSetOptions& options = {});

}  // namespace tegl
