// SPDX-License-Identifier: BSD-3-Clause
//
// Seed sets: small sets of tiles from which all active tiles of any isovalue are reached by steps between neighbours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tegl/active_tiles.hpp"
#include "tegl/image.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Which tiles count as neighbours of a tile. In 2D `faces` and `faces_and_edges` are the same.
enum class Neighbourhood : std::uint8_t {
  faces,            ///< F: tiles that share an (N-1)-face
  faces_and_edges,  ///< F+E: tiles that share at least an edge
  all,              ///< F+E+V: all 3^N - 1 tiles that share at least a corner
};
/// "faces", "faces-and-edges", "all".
[[nodiscard]] std::string_view name_of(Neighbourhood neighbourhood) noexcept;

/// Methods to find seeds. All except `cover` come from the literature; docs/seed-sets.md compares their sizes.
enum class SeedMethod : std::uint8_t {
  cover,   ///< ours: a cover of the components of active tiles over all isovalues; by far the fewest
  whole1,  ///< Hung 2005: tiles whose range does not lie in a neighbour's range, one per group of equal ranges
  whole2_disjoint_sets,  ///< Hung 2005, 3.4.4: `whole1` tiles that neighbours of other sets do not cover
  whole2,                ///< Hung 2005, 3.4.2: `whole1` tiles that no independent neighbours cover
  volume_thinning,       ///< Itoh, Yamaguchi, Koyamada 1996: a skeleton that connects all extrema
  sweeping,              ///< Bajaj, Pascucci, Schikore 1996: tiles not covered by earlier neighbours in scan order
  climbing,  ///< the same authors: tiles not covered by earlier neighbours, in an order that grows from seeds
};
/// "cover", "whole1", ...
[[nodiscard]] std::string_view name_of(SeedMethod method) noexcept;
/// All methods, in the order of the enumeration.
[[nodiscard]] std::vector<SeedMethod> seed_methods();

/// Options of find_seeds.
struct SeedSetOptions {
  SeedMethod method = SeedMethod::cover;             ///< how seeds are found
  Neighbourhood neighbourhood = Neighbourhood::all;  ///< the neighbours that seeds propagate to
  /// All axes, fastest first; empty: 0, 1, ... `cover` does not depend on it.
  std::vector<int> scan_order = {};
  /// Only for volume_thinning: keeps constant tiles in the skeleton, as published. They are never active.
  bool keep_constant_tiles = false;
  /// Number of threads, and progress. Threads read the image and, for `cover` of many different values, find the first
  /// trees, which is most of its work; the other work is sequential. The result does not depend on them.
  WorkOptions work = {};
};

/// Counts of one find_seeds.
struct SeedSetStats {
  std::uint64_t tiles = 0;           ///< tiles of the image
  std::uint64_t constant_tiles = 0;  ///< tiles of one value or with a missing corner: never active
  std::uint64_t groups = 0;          ///< groups of neighbouring tiles with equal range
  std::uint64_t whole1 = 0;       ///< groups not inside a neighbour's range; some smallest seed set consists of these
  std::uint64_t lower_bound = 0;  ///< see seed_lower_bound; only for `cover`, 0 if `reduced`
  /// Only for `cover`: the number of candidate tiles was too large, as in large images of measured floats, and `cover`
  /// chose from a subset (docs/seed-sets.md). `groups`, `whole1` and `lower_bound` are 0 then.
  bool reduced = false;
};

/// A set of tiles that contains a tile of every component of active tiles, at every isovalue. A component is connected
/// by steps between active neighbours, as `neighbourhood` defines them.
struct SeedSet {
  SeedMethod method = SeedMethod::cover;             ///< the method that found the seeds
  Neighbourhood neighbourhood = Neighbourhood::all;  ///< the neighbours they propagate to
  std::vector<TileNumber> tiles = {};                ///< ascending
  /// Tile i is active if least[i] < T <= greatest[i].
  std::vector<double> least = {}, greatest = {};  ///< minimum and maximum over each tile's corners
  SeedSetStats stats = {};                        ///< counts of find_seeds
};

/// Finds a seed set. Tiles with missing values are never active and never seeds. An image without active tiles has an
/// empty seed set. Time and memory: about linear in the number of tiles; for `whole2` only if neighbouring tiles have
/// similar ranges. Errors: TooLarge for 2^32 tiles or more, InvalidArgument for a scan order that is not a permutation
/// of the axes, Cancelled. Deterministic.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] SeedSet find_seeds(const Image<T, N>& image, const SeedSetOptions& options = {});

/// A lower bound of the size of any seed set with this neighbourhood: a number of components of active tiles, possibly
/// at different isovalues, no two of which share a tile. It is found greedily, and in images with too many candidate
/// tiles at a sample of isovalues only: a larger bound may exist. Errors: as find_seeds.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::uint64_t seed_lower_bound(const Image<T, N>& image, const SeedSetOptions& options = {});

}  // namespace tegl
