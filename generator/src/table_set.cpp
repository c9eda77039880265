// SPDX-License-Identifier: BSD-3-Clause
#include "tegl/gen/table_set.hpp"

#include <map>
#include <set>

#include "tegl/gen/counting.hpp"
#include "tegl/gen/symmetry.hpp"
#include "tegl/gen/transversal.hpp"

namespace tegl::gen {

namespace {

/// Both alternatives of one triangulation, certified and compared; returns the low-connected one.
std::vector<TileContour> certified_low(const ContourBuilder& low, const ContourBuilder& high,
                                       std::vector<CertifiedFigures>& figures) {
  CertifiedFigures of_low, of_high;
  auto contours = certified_contours(low, of_low);
  check_inversion(low.dim(), contours, certified_contours(high, of_high));
  figures.push_back(of_low);
  figures.push_back(of_high);
  return contours;
}

}  // namespace

Layout preferred_layout(int dim, Triangulation triangulation) {
  return dim == 4 && triangulation == Triangulation::barycentric ? Layout::by_class : Layout::flat;
}

TableSet make_table_set(const TableRequest& request) {
  const CubeLattice lattice(request.dim);
  TableSet set;
  set.dim = request.dim;
  set.command = request.command;
  const auto elements = group(request.dim, GroupKind::Full, false);
  set.group_order = elements.size();
  set.orbits = transversal(request.dim, elements).representatives.size();
  for (const Triangulation t : request.triangulations) {
    const ContourBuilder low(lattice, request.dim, Alternative::low, t);
    const ContourBuilder high(lattice, request.dim, Alternative::high, t);
    const auto contours = certified_low(low, high, set.figures);
    set.tiles.push_back(
        make_tile_tables(low, contours, request.layout ? request.layout(t) : preferred_layout(request.dim, t)));
    for (const Alternative a : {Alternative::low, Alternative::high}) {
      const RegionStyle style = t == Triangulation::compact ? RegionStyle::fan : RegionStyle::cone;
      set.regions.push_back(make_region_tables(RegionBuilder(lattice, request.dim - 1, a, t, style), t, a));
    }
  }
  return set;
}

std::vector<CertifiedFigures> certify_all(int dim) {
  const CubeLattice lattice(dim);
  std::vector<CertifiedFigures> figures;
  for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
    certified_low(ContourBuilder(lattice, dim, Alternative::low, t), ContourBuilder(lattice, dim, Alternative::high, t),
                  figures);
  return figures;
}

std::vector<std::uint32_t> ambiguous_faces(const CubeLattice& lattice, int dim, Alternative alternative,
                                           Signature signature) {
  // The faces of each dimension as sets of corners, each with its own signature; shared ones count once.
  std::vector<std::uint32_t> result(static_cast<std::size_t>(dim) + 1, 0);
  std::map<Signature, Signature> level;  // corners of the face -> its signature in its own frame
  std::map<Signature, std::vector<std::uint8_t>> corners_of;
  std::vector<std::uint8_t> all;
  for (std::uint32_t v = 0; v < lattice.tile(dim).corner_count(); ++v) all.push_back(static_cast<std::uint8_t>(v));
  level[lattice.tile(dim).full()] = signature;
  corners_of[lattice.tile(dim).full()] = all;
  for (int k = dim; k >= 2; --k) {
    const Tile& tile = lattice.tile(k);
    const ContourBuilder builder(lattice, k, alternative, Triangulation::barycentric);
    std::map<Signature, Signature> next;
    for (const auto& [set, own] : level) {
      const auto contour = builder.build(own);
      const bool open =
          contour.facets.size() > 1 || (k == 4 && contour.facets.size() == 1 && contour.facets[0].boundary_euler != 2);
      result[static_cast<std::size_t>(k)] += open ? 1 : 0;
      const auto corners = corners_of[set];
      for (std::uint32_t f = 0; f < tile.faces.size(); ++f) {
        std::vector<std::uint8_t> of_face;
        Signature face_set = 0;
        for (const std::uint8_t v : tile.faces[f].corner) {
          of_face.push_back(corners[v]);
          face_set |= 1u << corners[v];
        }
        next[face_set] = tile.restrict_to(f, own);
        corners_of[face_set] = of_face;
      }
    }
    level = std::move(next);
  }
  return result;
}

}  // namespace tegl::gen
