// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of tiles whose ambiguities are resolved freely: of all (signature, resolution) pairs, or of a seeded
// sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>

#include "base/lattice.hpp"
#include "tegl/facets/facets.hpp"

namespace tegl::gen {

/// What the certified tiles are. Sums over all signatures: each class counts as often as its orbit is long.
struct ResolutionFigures {
  std::uint64_t classes = 0;         ///< of signatures; 0 for a sample
  std::uint64_t pairs = 0;           ///< (signature, resolution of its ambiguous polygons), signatures of all orbits
  std::uint64_t pairs_by_class = 0;  ///< the same for one signature of each class; for a sample its size
  std::uint64_t orbits = 0;          ///< pairs up to all symmetries of the tile
  std::uint64_t tiles = 0;           ///< built and certified
  std::uint64_t non_spherical = 0;   ///< even n: pairs with a component of Sigma that is no sphere
  std::uint64_t classes_with_non_spherical = 0;  ///< classes of which some resolution has one
  std::uint64_t simplices = 0;                   ///< in all certified tiles
  std::uint64_t max_simplices = 0;               ///< of a tile
  std::array<std::uint64_t, 3> by_filling{};     ///< facets of all certified tiles, by facets::Filling
  std::map<int, std::uint64_t> euler{};          ///< Euler characteristic of a component of Sigma -> components
};

/// Called now and then, from any thread but never from two at a time, with how much is done: 0 to 1.
using Progress = std::function<void(double)>;

/// For every class of signatures under all symmetries of a tile, every resolution (low or high) of its ambiguous
/// polygons, up to the symmetries that keep the signature: what is built moves with them as long as no larger face is
/// joined, so one tile of each orbit is built and stands for all. What is not spherical is filled in both ways: two
/// tiles. All tiles are certified with what they have in their faces (facets::TileCertifier). n = 2 to 4. `threads`: 0
/// = one per processor. Errors: CertificateFailed, naming signature, resolution and fault.
[[nodiscard]] ResolutionFigures certify_all_resolutions(TileKind kind, int n, unsigned threads,
                                                        const Progress& progress = {});

/// Tiles number 0 to `count` - 1 of those that `seed` gives: signature and choice of every face of dimension 2 or more,
/// the tile's own among them, at random; half of the signatures uniformly, of the others some with fewer high or fewer
/// low corners. Number and seed alone decide. n = 2 to 6. Errors: as above.
[[nodiscard]] ResolutionFigures certify_sample(TileKind kind, int n, std::uint64_t count, std::uint64_t seed,
                                               unsigned threads, const Progress& progress = {});

/// The lattice of a tile of a kind, numbered as everywhere in the generator.
[[nodiscard]] facets::FaceLattice face_lattice(TileKind kind, int n);

/// The ambiguous faces of dimension 2: those whose boundary changes sign more than twice. By index, ascending.
[[nodiscard]] std::vector<std::uint32_t> ambiguous_polygons(const facets::FaceLattice& lattice,
                                                            facets::Signature signature);

}  // namespace tegl::gen
