// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of tiles with freely resolved ambiguities: of all (signature, resolution) pairs, or of a seeded
// sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "base/lattice.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::gen {

/// Figures of the certified tiles. Unless stated otherwise, a class counts as often as its orbit has signatures.
struct ResolutionFigures {
  std::uint64_t classes = 0;         ///< classes of signatures; 0 for a sample
  std::uint64_t pairs = 0;           ///< pairs (signature, resolution of its ambiguous polygons), over all signatures
  std::uint64_t pairs_by_class = 0;  ///< such pairs with one signature per class; for a sample its size
  std::uint64_t orbits = 0;          ///< orbits of pairs under all symmetries of the tile
  std::uint64_t tiles = 0;           ///< tiles built and certified
  std::uint64_t non_spherical = 0;   ///< even n: pairs with a non-spherical component of Sigma
  std::uint64_t classes_with_non_spherical = 0;  ///< classes with such a pair
  std::uint64_t simplices = 0;                   ///< total of all certified tiles
  std::uint64_t max_simplices = 0;               ///< maximum over the tiles
  std::array<std::uint64_t, 3> by_filling{};     ///< facets of all tiles: simplex, cone, side (tile::Filling)
  std::map<int, std::uint64_t> euler{};  ///< Euler characteristic of a component of Sigma -> number of components
};

/// Progress callback: receives the fraction done, 0 to 1. Called from any thread, one call at a time.
using Progress = std::function<void(double)>;

/// Certifies, for every class of signatures under all symmetries of a tile, every resolution (low or high) of its
/// ambiguous polygons. The construction commutes with the symmetries that keep the signature, provided that no larger
/// face is joined. So one tile per orbit of resolutions is built and represents the orbit. A tile with a non-spherical
/// component is filled in both ways: two tiles. All tiles are certified with the contours in their faces
/// (tile::TileCertifier). n = 2 to 4. `threads`: 0 = one per processor. Errors: CertificateFailed, with signature,
/// resolution and fault.
[[nodiscard]] ResolutionFigures certify_all_resolutions(TileKind kind, int n, unsigned threads,
                                                        const Progress& progress = {});
/// The same for a tile of any shape, with its classes under any group of its symmetries. With `single_signatures` each
/// pair is built. At most 24 of the lattice's polygons may be ambiguous at once.
[[nodiscard]] ResolutionFigures certify_all_resolutions(const tile::FaceLattice& lattice, const TileClasses& of_tile,
                                                        unsigned threads, const Progress& progress = {});

/// Certifies every signature of a tile of any shape, all faces resolved by one alternative. `pairs` counts signatures.
/// Errors: CertificateFailed, with signature and fault.
[[nodiscard]] ResolutionFigures certify_all_signatures(const tile::FaceLattice& lattice, tile::Alternative alternative,
                                                       unsigned threads, const Progress& progress = {});

/// Certifies the tiles number 0 to `count` - 1 of the random sequence of `seed`. A tile is a random signature and a
/// random choice for every face of dimension 2 or more, the tile included. Half of the signatures are uniform; of the
/// others some have fewer high or fewer low corners. A tile depends on number and seed only. Lattices of 2 to 6
/// dimensions. Errors: CertificateFailed, with signature, resolution and fault.
[[nodiscard]] ResolutionFigures certify_sample(const tile::FaceLattice& lattice, std::uint64_t count,
                                               std::uint64_t seed, unsigned threads, const Progress& progress = {});
[[nodiscard]] ResolutionFigures certify_sample(TileKind kind, int n, std::uint64_t count, std::uint64_t seed,
                                               unsigned threads, const Progress& progress = {});

/// Receives a signature, its ambiguous polygons, and the set of those with a high centre.
using TakeResolution =
    std::function<void(Signature signature, const std::vector<std::uint32_t>& polygons, std::uint32_t high)>;

/// Calls `take` for one pair (signature, resolution of its ambiguous polygons) of each orbit of such pairs under all
/// symmetries of a tile: the pairs that certify_all_resolutions builds. n = 2 to 4.
void for_each_resolution(TileKind kind, int n, const TakeResolution& take);

/// The face lattice of a tile of a kind, in the generator's numbering.
[[nodiscard]] tile::FaceLattice face_lattice(TileKind kind, int n);

/// The ambiguous faces of dimension 2, whose boundary changes sign more than twice. Indices, ascending.
[[nodiscard]] std::vector<std::uint32_t> ambiguous_polygons(const tile::FaceLattice& lattice, Signature signature);

}  // namespace tegl::gen
