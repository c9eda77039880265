// SPDX-License-Identifier: BSD-3-Clause
//
// Certifies many resolutions of tiles on several threads. Figures are sums, so their order does not matter.
#include "filling/resolutions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "tegl/tile/tile_certifier.hpp"

namespace tegl::gen {

namespace {

using tile::Alternative;
using tile::Choice;
using tile::FaceLattice;
using tile::Fault;
using tile::TileCertifier;

std::string text_of(const FaceLattice& lattice, Signature signature, const tile::Resolution& resolution, Fault fault) {
  std::string choices;
  for (std::size_t f = 0; f < resolution.choices.size(); ++f)
    if (lattice.faces()[f].dim >= 2) choices += "slh"[static_cast<std::size_t>(resolution.choices[f])];
  return fmt::format("signature {}, faces resolved {} (s separate, l low, h high), {} alternative: {}", signature,
                     choices, resolution.alternative == Alternative::low ? "low" : "high", tile::name_of(fault));
}

/// State of one thread: a certifier and its sums.
class Worker {
 public:
  explicit Worker(const FaceLattice& lattice) : certifier_(lattice), choices_(lattice.faces().size()) {}

  std::vector<Choice>& choices() { return choices_; }
  [[nodiscard]] const ResolutionFigures& figures() const { return figures_; }

  /// Certifies one tile and counts each component of its Sigma `weight` times. True if a component is not a sphere.
  bool certify(Signature signature, Alternative alternative, std::uint64_t weight) {
    const tile::Resolution resolution{choices_, alternative};
    const Fault fault = certifier_.certify(signature, resolution);
    const FaceLattice& lattice = certifier_.lattice();
    if (fault != Fault::none) throw Error(ErrorCode::CertificateFailed, text_of(lattice, signature, resolution, fault));
    const tile::TileFacets& tile = certifier_.tile();
    std::uint64_t simplices = 0;
    for (const tile::Facet& facet : tile.facets) simplices += facet.simplices.size();
    figures_.tiles += 1;
    figures_.simplices += simplices;
    figures_.max_simplices = std::max(figures_.max_simplices, simplices);
    for (const tile::Facet& facet : tile.facets) ++figures_.by_filling[static_cast<std::size_t>(facet.filling)];
    bool others = false;
    for (const int euler : tile.sigma_euler) {
      if (weight > 0) figures_.euler[euler] += weight;
      // For a Sigma of odd dimension the Euler characteristic is always 0 and identifies nothing.
      others |= lattice.dim() % 2 == 0 && lattice.dim() > 2 && euler != 2;
    }
    return others;
  }

  /// Counts a pair that represents `alike` resolutions of its signature, whose orbit has `orbit` signatures.
  void count_pair(std::uint64_t orbit, std::uint64_t alike, bool non_spherical) {
    figures_.pairs += orbit * alike;
    figures_.pairs_by_class += alike;
    figures_.orbits += 1;
    if (non_spherical) figures_.non_spherical += orbit * alike;
  }

 private:
  TileCertifier certifier_;
  std::vector<Choice> choices_;
  ResolutionFigures figures_;
};

void add(ResolutionFigures& to, const ResolutionFigures& more) {
  to.orbits += more.orbits;
  to.pairs += more.pairs, to.pairs_by_class += more.pairs_by_class, to.tiles += more.tiles;
  to.non_spherical += more.non_spherical, to.simplices += more.simplices;
  to.max_simplices = std::max(to.max_simplices, more.max_simplices);
  for (std::size_t k = 0; k < to.by_filling.size(); ++k) to.by_filling[k] += more.by_filling[k];
  for (const auto& [euler, count] : more.euler) to.euler[euler] += count;
}

/// Calls `work(worker, unit)` for all units on several threads and adds up the figures.
template <class Work>
ResolutionFigures on_threads(const FaceLattice& lattice, std::uint64_t units, unsigned threads,
                             const Progress& progress, const Work& work) {
  std::mutex guard;
  std::uint64_t done = 0;
  ResolutionFigures total;
  const auto one = [&](Worker& worker, std::uint64_t unit) {
    work(worker, unit);
    if (!progress) return;
    const std::lock_guard lock(guard);
    progress(static_cast<double>(++done) / static_cast<double>(units));
  };
  in_parallel(
      units, 1, threads, [&] { return Worker(lattice); }, one,
      [&](const Worker& worker) { add(total, worker.figures()); });
  return total;
}

/// The resolutions of one signature up to its stabiliser, as permutations of the ambiguous polygons. A resolution is a
/// bit set of the polygons with a high centre.
class ResolutionOrbits {
 public:
  ResolutionOrbits(const FaceLattice& lattice, Signature signature, const std::vector<std::uint32_t>& polygons,
                   const std::vector<TileSymmetry>& elements) {
    for (const TileSymmetry& g : elements) {
      const auto image = [&g](Signature corners) {
        Signature moved = 0;
        for (std::size_t c = 0; c < g.corner.size(); ++c) moved |= ((corners >> c) & 1u) << g.corner[c];
        return moved;
      };
      if (g.inverts || image(signature) != signature) continue;
      std::vector<std::size_t> to;
      for (const std::uint32_t f : polygons) {
        const std::uint32_t moved = lattice.find(image(lattice.faces()[f].corners)).value();
        to.push_back(
            static_cast<std::size_t>(std::lower_bound(polygons.begin(), polygons.end(), moved) - polygons.begin()));
      }
      // One table per byte, so that three look-ups map a set.
      Permutation& permutation = permutations_.emplace_back();
      for (std::size_t byte = 0; byte < permutation.size(); ++byte)
        for (std::uint32_t value = 0; value < 256; ++value)
          for (std::size_t i = 8 * byte; i < std::min(polygons.size(), 8 * byte + 8); ++i)
            if (((value >> (i - 8 * byte)) & 1u) != 0) permutation[byte][value] |= std::uint32_t{1} << to[i];
    }
  }

  /// Length of the resolution's orbit if it is the orbit's smallest element, else 0.
  [[nodiscard]] std::uint64_t length_if_smallest(std::uint32_t resolution) const {
    std::uint64_t keep = 0;
    for (const Permutation& p : permutations_) {
      const std::uint32_t moved =
          p[0][resolution & 0xffu] | p[1][resolution >> 8 & 0xffu] | p[2][resolution >> 16 & 0xffu];
      if (moved < resolution) return 0;
      keep += moved == resolution ? 1 : 0;
    }
    return permutations_.size() / keep;
  }

 private:
  using Permutation = std::array<std::array<std::uint32_t, 256>, 3>;
  std::vector<Permutation> permutations_;
};

/// A range of resolutions of one class's signature.
struct Unit {
  std::size_t index;  ///< index of the class
  std::uint64_t begin, end;
};

/// Random numbers (splitmix64); each `number` has its own sequence.
class Sequence {
 public:
  using result_type = std::uint64_t;
  Sequence(std::uint64_t seed, std::uint64_t number) : state_(seed) { state_ = (*this)() ^ (number * kStep); }
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }
  result_type operator()() {
    std::uint64_t z = state_ += kStep;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  std::uint64_t state_;
};

}  // namespace

FaceLattice face_lattice(TileKind kind, int n) {
  switch (kind) {
    case TileKind::simplex:
      return FaceLattice::simplex(n);
    case TileKind::octahedron:
      return FaceLattice::octahedron(n);
    case TileKind::cube:
      return FaceLattice::cube(n);
    case TileKind::other:
      break;
  }
  throw Error(ErrorCode::Internal, "the face lattice of a tile of no kind");
}

std::vector<std::uint32_t> ambiguous_polygons(const FaceLattice& lattice, Signature signature) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t f = 0; f < lattice.faces().size(); ++f) {
    const tile::Face& face = lattice.faces()[f];
    if (face.dim != 2) continue;
    const auto changes = std::count_if(face.faces.begin(), face.faces.end(), [&](std::uint32_t edge) {
      return std::popcount(signature & lattice.faces()[edge].corners) == 1;
    });
    if (changes > 2) result.push_back(f);
  }
  return result;
}

ResolutionFigures certify_all_resolutions(TileKind kind, int n, unsigned threads, const Progress& progress) {
  if (n < 2 || n > kMaxEnumeratedDim)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("all resolutions in dimension {}: expected 2 to {}", n, kMaxEnumeratedDim));
  const Lattice tiles(kind, n);
  return certify_all_resolutions(face_lattice(kind, n), tile_classes(tiles.tile(n)), threads, progress);
}

ResolutionFigures certify_all_resolutions(const FaceLattice& lattice, const TileClasses& of_tile, unsigned threads,
                                          const Progress& progress) {
  constexpr std::uint64_t kUnit = 4096;
  const Transversal& classes = of_tile.classes;
  // ambiguous polygons and orbits of each class; split resolutions into units
  std::vector<std::vector<std::uint32_t>> ambiguous;
  std::vector<ResolutionOrbits> orbits;
  std::vector<Unit> units;
  for (std::size_t c = 0; c < classes.representatives.size(); ++c) {
    ambiguous.push_back(ambiguous_polygons(lattice, classes.representatives[c]));
    orbits.emplace_back(lattice, classes.representatives[c], ambiguous[c], of_tile.symmetries);
    const std::uint64_t resolutions = std::uint64_t{1} << ambiguous[c].size();
    for (std::uint64_t begin = 0; begin < resolutions; begin += kUnit)
      units.push_back({c, begin, std::min(resolutions, begin + kUnit)});
  }
  std::vector<std::atomic<bool>> with_others(classes.representatives.size());
  // one tile per orbit of resolutions; non-spherical ones with both alternatives
  const auto work = [&](Worker& worker, std::uint64_t number) {
    const auto& [c, begin, end] = units[number];
    const std::uint64_t orbit = classes.orbit_length[c];
    for (std::uint64_t r = begin; r < end; ++r) {
      const std::uint64_t alike = orbits[c].length_if_smallest(static_cast<std::uint32_t>(r));
      if (alike == 0) continue;
      std::fill(worker.choices().begin(), worker.choices().end(), Choice::separate);
      for (std::size_t i = 0; i < ambiguous[c].size(); ++i)
        worker.choices()[ambiguous[c][i]] = ((r >> i) & 1u) != 0 ? Choice::high : Choice::low;
      const bool others = worker.certify(classes.representatives[c], Alternative::low, orbit * alike);
      if (others) worker.certify(classes.representatives[c], Alternative::high, 0);
      if (others) with_others[c] = true;
      worker.count_pair(orbit, alike, others);
    }
  };
  ResolutionFigures figures = on_threads(lattice, units.size(), threads, progress, work);
  figures.classes = classes.representatives.size();
  for (const auto& others : with_others) figures.classes_with_non_spherical += others ? 1 : 0;
  return figures;
}

void for_each_resolution(TileKind kind, int n, const TakeResolution& take) {
  const Lattice tiles(kind, n);
  const FaceLattice lattice = face_lattice(kind, n);
  const TileClasses of_tile = tile_classes(tiles.tile(n));
  for (const std::uint32_t signature : of_tile.classes.representatives) {
    const std::vector<std::uint32_t> polygons = ambiguous_polygons(lattice, signature);
    const ResolutionOrbits orbits(lattice, signature, polygons, of_tile.symmetries);
    for (std::uint64_t r = 0; r < std::uint64_t{1} << polygons.size(); ++r)
      if (orbits.length_if_smallest(static_cast<std::uint32_t>(r)) != 0)
        take(signature, polygons, static_cast<std::uint32_t>(r));
  }
}

ResolutionFigures certify_all_signatures(const FaceLattice& lattice, Alternative alternative, unsigned threads,
                                         const Progress& progress) {
  const auto work = [alternative](Worker& worker, std::uint64_t signature) {
    worker.count_pair(1, 1, worker.certify(signature, alternative, 1));
  };
  return on_threads(lattice, lattice.faces().back().corners + 1, threads, progress, work);
}

ResolutionFigures certify_sample(const FaceLattice& lattice, std::uint64_t count, std::uint64_t seed, unsigned threads,
                                 const Progress& progress) {
  const std::uint64_t unit = lattice.dim() < 5 ? 256 : 1;
  const auto work = [&](Worker& worker, std::uint64_t number) {
    for (std::uint64_t i = number * unit; i < std::min(count, (number + 1) * unit); ++i) {
      Sequence random(seed, i);
      // With half of the corners high, nearly all components of a tile of dimension 5 or more are connected. Half of
      // the tiles therefore get fewer high or fewer low corners, so that the sample includes tiles with several
      // components.
      Signature signature = random();
      if (const std::uint64_t dice = random(); (dice & 1u) != 0) {
        for (std::uint64_t times = dice >> 1 & 3u; times > 0; --times) signature &= random();
        if ((dice & 8u) != 0) signature = ~signature;
      }
      signature &= lattice.faces().back().corners;
      for (std::size_t f = 0; f < lattice.faces().size(); ++f)
        worker.choices()[f] = lattice.faces()[f].dim < 2 ? Choice::separate : static_cast<Choice>(random() % 3);
      const Alternative alternative = (random() & 1u) != 0 ? Alternative::high : Alternative::low;
      worker.count_pair(1, 1, worker.certify(signature, alternative, 1));
    }
  };
  return on_threads(lattice, (count + unit - 1) / unit, threads, progress, work);
}

ResolutionFigures certify_sample(TileKind kind, int n, std::uint64_t count, std::uint64_t seed, unsigned threads,
                                 const Progress& progress) {
  return certify_sample(face_lattice(kind, n), count, seed, threads, progress);
}

}  // namespace tegl::gen
