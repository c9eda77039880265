// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one 4D polytope: a prism over a polyhedron, in space and time, or another one that is given by its
// facets.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "ambiguity/lone_pair.hpp"
#include "base/disjoint_sets.hpp"
#include "polytope/loops.hpp"
#include "polytope/solid_facets.hpp"
#include "regions/cube_frame.hpp"
#include "regions/face_fillings.hpp"
#include "regions/facet_regions.hpp"
#include "regions/sigma_pieces.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// The vertex of a loop in a facet at which its fan of triangles starts, as a place in the loop; none: a cone from its
/// barycentre. Both cells at a facet have the same fan: at an end of a prism by the order of the edges, elsewhere by
/// the numbers of the points. `points`: at the corners of the cell. `loop`: edges of the facet.
[[nodiscard]] std::optional<std::size_t> fan_of_loop(const PolytopeRules& rules, const SolidFacet& facet,
                                                     std::span<const std::uint8_t> loop, const Index* points);

/// What is special about a cell of Polytopes::entangled, or beside one.
struct EntangledSolid {
  bool is_one = false;  ///< spheres are coned from their barycentres: a diagonal may be in the other cell as well
  /// Whether a loop in a facet is coned in any case; null: none is. `loop`: edges of the facet.
  std::function<bool(const SolidFacet& facet, std::span<const std::uint8_t> loop)> is_coned = nullptr;
};

/// Builds the contours of 4D polytopes, one after the other. In each facet they are the contour of the 3D cell there,
/// which is the same in any cell with the facet. Components of Sigma that are spheres are coned: in
/// compact contours from one of their vertices if every triangle in a facet with that vertex has it, otherwise from
/// their barycentre. Others are filled with copies of the regions of one side, moved towards the centre of the cell.
/// Such a copy passes the spheres beside its region: it is a copy of the region with everything behind them.
class SolidCell {
 public:
  /// A vertex of the cell: on its edges, then (first_shared) shared ones, cones, corners and centres of regions.
  using Local = std::uint16_t;
  static constexpr Local kSides = 32768, kCollars = 49152, kNone = 65535;
  using Tetrahedron = std::array<Local, 4>;

  /// A vertex that is not on an edge.
  struct Inner {
    std::vector<Local>
        points{};             ///< edges and corners whose mean it is; of a hexahedron's own, all crossed edges there
    std::uint16_t facet = 0;  ///< of shared ones
    bool is_in_cube = false;  ///< a hexahedron's own
    std::uint32_t mask = 0;   ///< of these: corners (bit v) and edges (bit 8 + e) of the cube of images
  };

  /// `rules` must outlive this object.
  explicit SolidCell(const PolytopeRules& rules);

  /// Builds the contour of an active cell with these points and values at its corners.
  void build(const PolytopeFaces& shape, const Index* points, const double* values, EntangledSolid entangled = {});

  /// With their positive sides towards high corners if the cell is not inverted.
  [[nodiscard]] const std::vector<Tetrahedron>& tetrahedra() const noexcept { return tetrahedra_; }
  [[nodiscard]] const std::vector<SolidFacet>& facets() const noexcept { return facets_; }
  [[nodiscard]] Local first_shared() const noexcept { return static_cast<Local>(shape_->edges().size()); }
  [[nodiscard]] Local first_cone() const noexcept { return first_cone_; }
  [[nodiscard]] Local first_corner() const noexcept { return first_corner_; }
  [[nodiscard]] const std::vector<Inner>& shared() const noexcept { return shared_; }  ///< from first_shared()
  [[nodiscard]] const std::vector<Inner>& cones() const noexcept { return cones_; }    ///< from first_cone()
  [[nodiscard]] const std::vector<Inner>& sides() const noexcept { return sides_; }    ///< from kSides
  /// From kCollars: half as far from their places as `sides`.
  [[nodiscard]] const std::vector<Inner>& collars() const noexcept { return collars_; }

 private:
  using Triangle = std::array<Local, 3>;
  using Square = std::array<Local, 4>;
  using Piece = SigmaPiece<Local>;
  using Component = std::vector<Piece>;
  using Components = std::map<Index, Component>;
  /// A contour in a hexahedron, as the hexahedron's frame sees it.
  struct CubeContour {
    CubeFrame frame;
    std::uint16_t list;
    Local first_own;
  };
  /// A tunnel in an octahedron: a ring of four quadrilaterals with the barycentres from `first_own` on.
  struct Tunnel {
    LonePair pair;
    Local first_own;
  };

  // Sigma
  void load(const PolytopeFaces& shape);
  void add_contour(std::size_t f);
  void add_loop(std::size_t f, std::span<const std::uint8_t> loop);
  void add_filling(std::size_t f, unsigned signature);
  void add_cube(std::size_t f, unsigned signature);
  [[nodiscard]] std::optional<LonePair> tunnel_in(std::size_t f, std::span<const double> values) const noexcept;
  void add_tunnel(std::size_t f, const LonePair& pair, std::span<const std::uint8_t> loop);
  [[nodiscard]] Local in_facet(std::size_t f, std::uint8_t a, std::uint8_t b) const noexcept;
  [[nodiscard]] Local on_edge(std::size_t f, unsigned p, unsigned q) const noexcept;
  [[nodiscard]] Local corner_of(std::size_t f, unsigned v) const noexcept;
  [[nodiscard]] std::vector<Local> points_of(std::size_t f, const CubeFrame& frame, std::uint32_t mask) const;
  [[nodiscard]] bool has_tunnel(std::size_t f) const noexcept;

  // filling
  [[nodiscard]] bool is_in_facet(Local edge, std::size_t f) const noexcept;
  [[nodiscard]] Local apex_of(const Component& component, const std::vector<Local>& vertices);
  void add_sphere(const Component& component, const std::vector<Local>& vertices);
  [[nodiscard]] Tetrahedron cone_of(const Piece& piece, Local apex) const noexcept;
  void copy_regions(bool high, Components& components);
  void pass_spheres(bool high, DisjointSets& sets, const std::vector<Index>& passing, Components& components);
  void copy_past_spheres(bool high, Index region, DisjointSets& sets, DisjointSets& behind,
                         const Components& components);
  void add_copies(std::vector<Tetrahedron> copies, const Component& boundary, bool collars);

  // regions
  [[nodiscard]] DisjointSets find_regions(bool high);
  void add_regions(std::size_t f, bool high);
  void add_parts(std::size_t f, std::size_t face, bool high, RegionSides<Local>& sides) const;
  void add_cube_regions(std::size_t f, bool high);
  void add_ring(std::size_t f, const RegionSides<Local>& sides);
  [[nodiscard]] Local first_centre() const noexcept {
    return static_cast<Local>(first_corner_ + shape_->corner_count());
  }
  /// Above all vertices of regions.
  [[nodiscard]] Local regions_end() const noexcept { return static_cast<Local>(first_centre() + centres_.size()); }
  [[nodiscard]] bool is_in_square(Local v, const Square& square) const noexcept;
  [[nodiscard]] Local add_centre(std::vector<Local> points);

  const PolytopeRules& rules_;
  FaceFillings fillings_;  ///< of hexahedra, by fixed rules
  const ResolvedCubes& cubes_;
  const CubeRegions& regions_of_;
  Loops loops_;
  const PolytopeFaces* shape_ = nullptr;
  std::vector<SolidFacet> facets_;
  std::vector<bool> is_in_facet_;  ///< by facet and edge
  // The current cell:
  Local first_cone_ = 0, first_corner_ = 0;
  const Index* points_ = nullptr;
  const double* values_ = nullptr;
  EntangledSolid entangled_;
  Component sigma_;
  std::vector<Tetrahedron> tetrahedra_, regions_;
  std::vector<Inner> shared_, cones_, sides_, collars_;
  std::vector<std::optional<CubeContour>> contours_;  ///< by facet
  std::vector<std::optional<Tunnel>> tunnels_;        ///< by facet
  std::vector<std::vector<Local>> centres_;
  std::vector<bool> is_high_;                     ///< corners, while regions are found
  std::map<Square, std::vector<Triangle>> fans_;  ///< by corners of the quadrilateral: its triangles, sorted
  std::vector<std::uint16_t> around_;             ///< by vertex of a sphere: number of its triangles
};

}  // namespace tegl::detail
