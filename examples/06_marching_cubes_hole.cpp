// SPDX-License-Identifier: BSD-3-Clause
//
// Example 6: the hole of "marching cubes". The original table has one entry for each of 15 classes under rotations and
// the exchange of high and low. This exchange is not a symmetry of ambiguous faces: of two neighbouring tiles, one may
// cut off the high corners of the common face and the other the low ones. The generator builds that table, counts the
// pairs of neighbours that leave a hole, and draws one: a tile of type 10 above one of type 3 of Lorensen and Cline
// (1987), as in M. Liversage, thesis, 1994, figure 7.3.
//
//   06_marching_cubes_hole [PICTURE.svg]
#include <cstdio>
#include <fstream>

#include <filling/pairs.hpp>
#include <pictures/picture.hpp>
#include <symmetry/transversal.hpp>

using namespace tegl::gen;

int main(int argc, char** argv) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);

  // One entry per signature, in two ways: by the rule that depends on each face only, and by classes.
  std::vector<TileContour> consistent;
  for (Signature s = 0; s < 256; ++s) consistent.push_back(builder.build(s));
  const std::vector<TileContour> by_class = contours_by_class(builder, GroupKind::Rotations, true);

  const PairFigures good = certify_pairs(builder, consistent), bad = certify_pairs(builder, by_class);
  std::printf("consistent table: %llu of %llu pairs of neighbours leave a hole\n",
              static_cast<unsigned long long>(good.unmatched), static_cast<unsigned long long>(good.pairs));
  std::printf("table by class:   %llu of %llu pairs of neighbours leave a hole\n",
              static_cast<unsigned long long>(bad.unmatched), static_cast<unsigned long long>(bad.pairs));

  // Searches for a pair as in the thesis's figure: below, the complement of two corners on a face's diagonal; above,
  // two opposite edges.
  const auto classes = transversal(3, group(3, GroupKind::Rotations, true));
  const auto type_of = [&](Signature s) { return classes.representatives[classes.class_of[s]]; };
  constexpr int kUp = 2;
  for (Signature below = 0; below < 256; ++below)
    for (Signature above = 0; above < 256; ++above) {
      if (type_of(below) != 6 || type_of(above) != 60) continue;  // types 3 and 10
      if (lattice.tile(3).restrict_to(2 * kUp + 1, below) != lattice.tile(3).restrict_to(2 * kUp, above)) continue;
      const auto open = open_simplices(builder, by_class[below], by_class[above], kUp);
      if (open.empty()) continue;

      std::printf("for example signature %llu below %llu: %zu open edges\n", static_cast<unsigned long long>(below),
                  static_cast<unsigned long long>(above), open.size());
      Picture picture;
      picture.title = "A hole between two tiles";
      picture.tiles = {{&lattice.tile(3), below, &by_class[below], {0, 0, 0}},
                       {&lattice.tile(3), above, &by_class[above], {0, 0, 1}}};
      for (const LocalSimplex& edge : open) {
        const Place a = place_of(lattice.tile(3), {}, edge[0]), b = place_of(lattice.tile(3), {}, edge[1]);
        std::printf("  (%g, %g, %g) - (%g, %g, %g)\n", a[0], a[1], a[2], b[0], b[1], b[2]);
        picture.marks.push_back({a, b});
      }
      if (argc > 1) {
        std::ofstream file(argv[1]);
        file << to_svg(picture);
        if (!file.flush()) return 1;
      }
      return good.unmatched == 0 && bad.unmatched > 0 && open.size() == 4 ? 0 : 1;
    }
  return 1;  // no such pair
}
