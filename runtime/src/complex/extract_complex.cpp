// SPDX-License-Identifier: BSD-3-Clause
//
// Writes contours of complexes: positions and normals of vertices, and simplices with their orientation.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/contour_room.hpp"
#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "complex/complex_caps.hpp"
#include "complex/contour_numbers.hpp"
#include "complex/edge_alpha.hpp"
#include "complex/point_gradients.hpp"
#include "complex/vertex_mean.hpp"
#include "kernel/split_nonmanifold.hpp"
#include "tegl/complex.hpp"
#include "tegl/error.hpp"

namespace tegl {

namespace detail {
namespace {

/// Vertices are between points: if these are in the range of Real, vertices are, too.
template <class Real, int N>
void check_range(const Complex<N>& complex) {
  constexpr Real kMost = std::numeric_limits<Real>::max();
  if (ComplexAccess::largest_coordinate(complex) <= double{kMost}) return;
  for (std::size_t p = 0; p < complex.points().size(); ++p)
    for (std::size_t i = 0; i < N; ++i)
      if (const double x = complex.points()[p][i]; std::abs(x) > double{kMost})
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("point {}: coordinate {} is {}; expected {} to {}, the range of {} vertices", p, i, x,
                                -kMost, kMost, sizeof(Real) == 4 ? "float" : "double"));
}

/// The points of cells that have vertices at places other than the mean of edges' points: these need the gradients at
/// all corners.
template <int N>
std::vector<Index> corners_of_sides(const Complex<N>& complex, const ContourNumbers& numbers) {
  using Kind = PolytopeBlock::InnerVertex::Kind;
  std::vector<Index> points;
  for (std::size_t b = 0; b < numbers.blocks().size(); ++b) {
    const CellGroup& group = ComplexAccess::cells(complex).groups[numbers.blocks()[b].group];
    const CellCases& cases = numbers.cases(numbers.blocks()[b].group);
    for (const ActiveCell& cell : numbers.blocks()[b].cells)
      if (const tables::CellList& list = cases.of(cell.signature, cell.variant).list();
          list.side_vertices > 0 || list.collar_vertices > 0)
        points.insert(points.end(), group.cell(cell.cell), group.cell(cell.cell) + group.corner_count);
  }
  for (const CubePoint& point : numbers.points_in_cubes())
    points.insert(points.end(), point.corners.begin(), point.corners.end());
  for (const PolytopeBlock& block : numbers.polytopes())
    for (const PolytopeBlock::InnerVertex& vertex : block.own_vertices)
      if (vertex.kind == Kind::inwards || vertex.kind == Kind::collar) {
        const std::span<const Index> corners = ComplexAccess::cells(complex).polytopes.points_of(vertex.cell);
        points.insert(points.end(), corners.begin(), corners.end());
      }
  return points;
}

/// Writes to memory that holds the contour and its caps.
template <int N, class Real, class I>
class ComplexWriter {
 public:
  /// `gradients`: null if the contour gets no normals. The arguments must outlive this object.
  ComplexWriter(const Complex<N>& complex, const ContourNumbers& numbers, const PointGradients<N>* gradients,
                std::span<const Period<N>> periods, double isovalue, const ExtractOptions& options,
                const ContourRoom<N, Real, I>& contour)
      : complex_(complex),
        cells_(ComplexAccess::cells(complex)),
        signs_(ComplexAccess::signs(complex)),
        numbers_(numbers),
        gradients_(gradients),
        periods_(periods),
        isovalue_(isovalue),
        epsilon_(options.epsilon),
        is_layered_(ComplexAccess::is_layered(complex)),
        descends_(options.direction == GradientDirection::descent),
        contour_(contour) {}

  void write_edge_points(const WorkOptions& work) {
    const EdgeEnds* const ends = numbers_.edge_ends().data();
    const std::size_t count = numbers_.edge_ends().size();
    if (is_layered_ || gradients_ != nullptr || !periods_.empty()) {
      for_each_item(count, work.threads, work.progress, [&](std::size_t i) { write_edge_point(ends[i], i); });
      return;
    }
    const Point* const points = complex_.points().data();
    const double* const values = complex_.values().data();
    Vertex* const vertices = contour_.vertices.data();
    const double isovalue = isovalue_, epsilon = epsilon_;
    for_each_item(count, work.threads, work.progress, [=](std::size_t i) {
      constexpr std::size_t kAhead = 16;
      if (i + kAhead < count) {  // larger ends are further apart than smaller ones
        __builtin_prefetch(points + ends[i + kAhead][1]);
        __builtin_prefetch(values + ends[i + kAhead][1]);
      }
      const auto [p, q] = ends[i];
      vertices[i] = point_on_edge<Real>(points[p], points[q], alpha_of(values[p], values[q], isovalue, epsilon));
    });
  }

  void write_polygon_centres(const WorkOptions& work) {
    const auto& polygons = numbers_.polygons();
    const std::size_t first = numbers_.edge_ends().size();
    for_each_item(numbers_.points_in_cubes().size(), work.threads, nullptr,
                  [&](std::size_t i) { write_in_cube(numbers_.points_in_cubes()[i], first); });
    for_each_item(numbers_.loops().size(), work.threads, nullptr, [&](std::size_t i) {
      const LoopPoint& loop = numbers_.loops()[i];
      Mean mean(*this);
      for (const Index v : loop.vertices) mean.add_vertex(v);
      write(first + loop.number, mean);
    });
    for_each_item(polygons.size(), work.threads, work.progress, [&](std::size_t i) {
      if (polygons[i].back() == kInCube || polygons[i].back() == kInFacet) return;
      Mean mean(*this);
      for (const Index v : polygons[i])
        if (v != kNoPoint) mean.add_vertex(v);
      write(first + i, mean);
    });
  }

  void write_cells(const WorkOptions& work) {
    for_each_block(
        numbers_.blocks().size(), 1, work.threads, work.progress, [&](std::size_t b, std::size_t, std::size_t) {
          if (numbers_.cases(numbers_.blocks()[b].group).is_plain()) return write_plain_cells(b);
          numbers_.for_each_cell(b, [&](const ActiveCell& cell, std::uint64_t first, const CellContour& contour,
                                        const ContourNumbers::CellVertices& vertices) {
            const std::size_t group = numbers_.blocks()[b].group;
            const bool is_inverted = (signs_[group][cell.cell >> 6] >> (cell.cell & 63u) & 1u) != 0;
            write_simplices(is_inverted, first, contour, vertices);
            const Index* const corners = cells_.groups[group].cell(cell.cell);
            write_own_points(numbers_.cases(group), cell.variant, corners, contour, vertices);
          });
        });
  }

  /// The simplices and barycentres of polygons and polyhedra.
  void write_polytopes(const WorkOptions& work) {
    const std::vector<PolytopeBlock>& blocks = numbers_.polytopes();
    for_each_item(blocks.size(), work.threads, work.progress, [&](std::size_t b) {
      if constexpr (N == 4) return write_prisms(b);
      const PolytopeBlock& block = blocks[b];
      auto* simplex = contour_.simplices.data() + numbers_.first_simplex_of_polytopes(b);
      auto own = static_cast<Index>(numbers_.first_of_polytopes(b));
      std::vector<Index> vertices;
      std::uint32_t from = 0;
      for (const PolytopeBlock::Piece& piece : block.pieces) {
        vertices.clear();
        for (; from < piece.end; ++from) vertices.push_back(block.numbers[block.vertices[from]]);
        const bool is_inverted = (signs_.back()[piece.cell >> 6] >> (piece.cell & 63u) & 1u) != 0;
        simplex = write_piece(vertices, piece.is_coned, own, is_inverted != descends_, simplex);
        if (piece.is_coned) write_barycentre(vertices, own++);
      }
    });
  }

  /// Writes caps after the contour.
  void write_caps(const ComplexCaps<N>& caps) {
    std::size_t v = numbers_.size().vertices;
    const std::size_t end = v + caps.vertex_count();
    for (const Index p : caps.corners()) {
      for (std::size_t i = 0; i < N; ++i) contour_.vertices[v][i] = static_cast<Real>(complex_.points()[p][i]);
      if (gradients_ != nullptr) contour_.normals[v] = normal_of(gradients_->at(p));
      ++v;
    }
    auto between = caps.between().begin();
    for (std::size_t j = 0; v < end; ++j, ++v) {
      Mean mean(*this);
      for (const CapVertex point : caps.points_of(j))
        if (point.is_corner())
          mean.add_corner(static_cast<Index>(point.number()));
        else
          mean.add_vertex(static_cast<Index>(point.number()));
      write(v, mean);
      if (between == caps.between().end() || between->added != j) continue;
      const Point &corner = complex_.points()[between->corner], at_mean = near(corner, mean.mean());
      for (std::size_t i = 0; i < N; ++i)
        contour_.vertices[v][i] = static_cast<Real>(corner[i] + between->weight * (at_mean[i] - corner[i]));
      keep_inside(contour_.vertices[v]);
      ++between;
    }
    auto* numbers = contour_.simplices.data() + numbers_.size().simplices;
    for (const auto& simplex : caps.simplices()) {
      for (std::size_t k = 0; k < N; ++k) (*numbers)[k] = caps.number(simplex[k]);
      ++numbers;
    }
  }

 private:
  using Point = std::array<double, N>;
  using Vertex = std::array<Real, N>;

  /// The mean of points. Its normal is the mean of their normals.
  class Mean {
   public:
    explicit Mean(const ComplexWriter& writer) : writer_(writer) {}
    /// Adds a vertex on an edge.
    void add_vertex(Index v) noexcept {
      add(widened_point<N>(writer_.contour_.vertices[v]));
      for (const Index end : writer_.numbers_.edge_ends()[v]) mean_.add_layer(writer_.complex_.points()[end][N - 1]);
      if (writer_.gradients_ != nullptr) mean_.add_normal(writer_.contour_.normals[v]);
    }
    /// Adds a corner of a cell.
    void add_corner(Index p) noexcept {
      add(writer_.complex_.points()[p]);
      mean_.add_layer(writer_.complex_.points()[p][N - 1]);
      if (writer_.gradients_ != nullptr) mean_.add_normal(writer_.normal_of(writer_.gradients_->at(p)));
    }
    [[nodiscard]] Point mean() const noexcept { return mean_.mean(); }
    [[nodiscard]] Vertex normal() const noexcept { return PointGradients<N>::template unit<Real>(mean_.normal()); }
    [[nodiscard]] Vertex place() const noexcept {
      Vertex vertex = mean_.place(writer_.is_layered_);
      writer_.keep_inside(vertex);
      return vertex;
    }

   private:
    void add(const Point& point) noexcept {
      if (!first_) first_ = point;
      mean_.add(writer_.near(*first_, point));
    }

    const ComplexWriter& writer_;
    VertexMean<N, Real> mean_;
    std::optional<Point> first_;
  };

  /// The place of a point nearest to another, modulo the periods.
  [[nodiscard]] Point near(const Point& to, Point point) const noexcept {
    if (!periods_.empty()) move_near<N>(periods_, to, point);
    return point;
  }
  /// Moves a vertex into the periods.
  void keep_inside(Vertex& vertex) const noexcept {
    if (periods_.empty()) return;
    Point point = widened_point<N>(vertex);
    move_inside<N, Real>(periods_, point);
    for (std::size_t i = 0; i < N; ++i) vertex[i] = static_cast<Real>(point[i]);
  }

  void write(std::size_t number, const Mean& mean) const noexcept {
    contour_.vertices[number] = mean.place();
    if (gradients_ != nullptr) contour_.normals[number] = mean.normal();
  }

  /// The normal along a gradient, on the side of the direction.
  [[nodiscard]] Vertex normal_of(Point gradient) const noexcept {
    if (descends_)
      for (double& x : gradient) x = -x;
    return PointGradients<N>::template unit<Real>(gradient);
  }

  void write_edge_point(const EdgeEnds& ends, std::size_t number) const noexcept {
    const Point &from = complex_.points()[ends[0]], to = near(from, complex_.points()[ends[1]]);
    const double alpha = alpha_of(complex_.values()[ends[0]], complex_.values()[ends[1]], isovalue_, epsilon_);
    Vertex& vertex = contour_.vertices[number];
    vertex = point_on_edge<Real>(from, to, alpha);
    keep_inside(vertex);
    if (is_layered_ && from[N - 1] != to[N - 1]) keep_between(ends[0], ends[1], vertex);
    if (gradients_ == nullptr) return;
    const Point &at_from = gradients_->at(ends[0]), &at_to = gradients_->at(ends[1]);
    Point gradient;
    for (std::size_t i = 0; i < N; ++i) gradient[i] = (1.0 - alpha) * at_from[i] + alpha * at_to[i];
    contour_.normals[number] = normal_of(gradient);
  }

  /// Writes the simplices of a segment, or of a loop as a cone from `apex` or a fan from its first vertex. Returns the
  /// end of what it has written.
  static std::array<I, N>* write_piece(std::span<const Index> vertices, bool is_coned, Index apex, bool flip,
                                       std::array<I, N>* simplex) noexcept {
    if constexpr (N == 2) {
      *simplex++ = {vertices[flip ? 1 : 0], vertices[flip ? 0 : 1]};
    } else if constexpr (N == 3) {
      const std::size_t size = vertices.size(), first = is_coned ? 0 : 1;
      for (std::size_t i = first; i + (is_coned ? 0 : 1) < size; ++i) {
        const Index from = vertices[i], to = vertices[(i + 1) % size];
        *simplex++ = {is_coned ? apex : vertices[0], flip ? to : from, flip ? from : to};
      }
    }
    return simplex;
  }

  /// The tetrahedra of a block of prisms over polyhedra, and the cells' own vertices.
  void write_prisms(std::size_t b) const {
    const PolytopeBlock& block = numbers_.polytopes()[b];
    auto* simplex = contour_.simplices.data() + numbers_.first_simplex_of_polytopes(b);
    std::size_t i = 0;
    for (const PolytopeBlock::Piece& piece : block.pieces) {
      const bool is_inverted = (signs_.back()[piece.cell >> 6] >> (piece.cell & 63u) & 1u) != 0;
      for (; i < piece.end; ++i, ++simplex) {
        for (std::size_t k = 0; k < N; ++k) (*simplex)[k] = numbers_.prism_vertex(b, block.tetrahedra[i][k]);
        if (is_inverted != descends_) std::swap((*simplex)[N - 1], (*simplex)[N - 2]);
      }
    }
    using Kind = PolytopeBlock::InnerVertex::Kind;
    auto number = static_cast<Index>(numbers_.first_of_polytopes(b));
    std::vector<Index> vertices;
    for (const PolytopeBlock::InnerVertex& own : block.own_vertices) {
      vertices.clear();
      for (std::uint32_t v = own.first_vertex; v < own.vertices_end; ++v)
        vertices.push_back(numbers_.prism_vertex(b, block.inner_vertices[v]));
      std::sort(vertices.begin(), vertices.end());
      Mean mean(*this);
      for (const Index v : vertices) mean.add_vertex(v);
      for (std::uint32_t v = own.first_corner; v < own.corners_end; ++v) mean.add_corner(block.inner_corners[v]);
      write(number, mean);
      if (const bool is_collar = own.kind == Kind::collar; is_collar || own.kind == Kind::inwards)
        contour_.vertices[number] = inwards(cells_.polytopes.points_of(own.cell), mean, is_collar ? 0.25 : 0.5);
      ++number;
    }
  }

  /// The barycentre of a loop. Ascending vertices, so that the sum does not depend on the cell's numbering.
  void write_barycentre(std::vector<Index>& vertices, Index number) const noexcept {
    std::sort(vertices.begin(), vertices.end());
    Mean mean(*this);
    for (const Index v : vertices) mean.add_vertex(v);
    write(number, mean);
  }

  /// The simplices of a block of cells whose vertices are all on edges.
  void write_plain_cells(std::size_t b) const noexcept {
    const ActiveBlock& block = numbers_.blocks()[b];
    const CellCases& cases = numbers_.cases(block.group);
    const std::uint64_t* const inverted = signs_[block.group].data();
    const Index* vertices = numbers_.crossings(b).data();
    auto* simplex = contour_.simplices.data() + numbers_.first_simplex(b);
    for (const ActiveCell& cell : block.cells) {
      const CellCases::Case& of = cases.of_signature(cell.signature);
      const bool is_inverted = (inverted[cell.cell >> 6] >> (cell.cell & 63u) & 1u) != 0;
      const std::uint8_t* ordinal = cases.ordinals(of, is_inverted != descends_);
      for (unsigned i = 0; i < of.simplices; ++i, ++simplex)
        for (unsigned k = 0; k < N; ++k) (*simplex)[k] = vertices[*ordinal++];
      vertices += of.crossings;
    }
  }

  void write_simplices(bool is_inverted, std::uint64_t first, const CellContour& contour,
                       const ContourNumbers::CellVertices& vertices) const noexcept {
    // the tables face high
    const bool flip = (contour.reverses() != is_inverted) != descends_;
    for (unsigned i = 0; i < contour.list().simplex_count; ++i) {
      auto& simplex = contour_.simplices[first + i];
      for (unsigned k = 0; k < N; ++k) simplex[k] = vertices[contour.vertex(i, k)];
      if (flip) std::swap(simplex[N - 1], simplex[N - 2]);
    }
  }

  void write_own_points(const CellCases& cases, std::uint32_t variant, const Index* corners, const CellContour& contour,
                        const ContourNumbers::CellVertices& vertices) const noexcept {
    const tables::CellTable& table = cases.table();
    const tables::CellList& list = contour.list();
    for (unsigned j = list.shared_vertices; j < list.added(); ++j) {
      const std::uint64_t mask = contour.mask(j);
      const Index number = vertices[table.edge_count + j];
      const bool is_side = j >= unsigned{list.shared_vertices} + list.cone_vertices;
      if (is_side && has_rays(cases, variant)) {
        write_side(cases, corners, mask, number);
        continue;
      }
      std::array<Index, 32> points;  // ascending, so that the sum does not depend on the cell's numbering
      std::size_t count = 0;
      for (std::uint64_t edges = mask >> table.corner_count; edges != 0; edges &= edges - 1)
        points[count++] = vertices[static_cast<std::size_t>(std::countr_zero(edges))];
      std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
      Mean mean(*this);
      for (std::size_t i = 0; i < count; ++i) mean.add_vertex(points[i]);
      for (std::uint32_t v = 0; v < table.corner_count; ++v)
        if ((mask >> v & 1u) != 0) mean.add_corner(corners[v]);
      write(number, mean);
      const bool is_collar = j >= list.added() - list.collar_vertices;
      if (is_side) contour_.vertices[number] = inwards({corners, table.corner_count}, mean, is_collar ? 0.25 : 0.5);
    }
  }

  /// Whether side vertices are where a cube or a tesseract of an image has them.
  [[nodiscard]] static bool has_rays(const CellCases& cases, std::uint32_t variant) noexcept {
    if (N == 3) return cases.resolved() != nullptr && variant > 1;
    return cases.built() != nullptr && cases.built()->is_of_image(variant);
  }

  /// The place in the unit cube of a side vertex, on a ray on which the interpolant has the isovalue.
  [[nodiscard]] std::array<double, N> place_on_ray(const CellCases& cases, std::uint64_t mask,
                                                   std::array<double, std::size_t{1} << N> values) const noexcept {
    if constexpr (N == 3) {
      return cases.resolved()->place(mask, values, epsilon_);
    } else if constexpr (N == 4) {
      return BuiltCells::place(mask, values, isovalue_, epsilon_);
    } else {
      return {};  // squares have no side vertices
    }
  }

  /// A side vertex of a cube or a tesseract: its place in the unit cube, mapped by the multilinear map of the corners.
  void write_side(const CellCases& cases, const Index* corners, std::uint64_t mask, Index number) const noexcept {
    std::array<double, std::size_t{1} << N> values;
    for (std::size_t v = 0; v < values.size(); ++v) values[v] = complex_.values()[corners[v]];
    write_inside<N>(corners, place_on_ray(cases, mask, values), number);
  }

  /// A vertex in a hexahedron between two cells. `first`: number of the first shared vertex.
  void write_in_cube(const CubePoint& of, std::size_t first) const noexcept {
    std::array<double, 8> values;
    for (std::size_t v = 0; v < 8; ++v) values[v] = complex_.values()[of.corners[v]];
    const std::array<double, 3> place = ResolvedCells::place_in_cube(of.mask, values, isovalue_, epsilon_);
    write_inside<3>(of.corners.data(), place, static_cast<Index>(first + of.number));
  }

  /// A vertex at a place in the unit cube of dimension K. Corners beyond a seam are taken from the first one's side.
  template <int K>
  void write_inside(const Index* corners, const std::array<double, K>& place, Index number) const noexcept {
    constexpr std::size_t kLast = (std::size_t{1} << K) - 1;
    const Point& first = complex_.points()[corners[0]];
    Point point{}, gradient{};
    for (std::size_t v = 0; v <= kLast; ++v) {
      double weight = 1.0;
      for (std::size_t a = 0; a < K; ++a) weight *= (v >> a & 1u) != 0 ? place[a] : 1.0 - place[a];
      const Point corner = near(first, complex_.points()[corners[v]]);
      for (std::size_t i = 0; i < N; ++i) {
        point[i] += weight * corner[i];
        if (gradients_ != nullptr) gradient[i] += weight * gradients_->at(corners[v])[i];
      }
    }
    Vertex& vertex = contour_.vertices[number];
    for (std::size_t i = 0; i < N; ++i) vertex[i] = static_cast<Real>(point[i]);
    keep_inside(vertex);
    if (is_layered_) keep_between(corners[0], corners[kLast], vertex);
    if (gradients_ != nullptr) contour_.normals[number] = normal_of(gradient);
  }

  /// Moves a vertex off the layers of two points.
  void keep_between(Index p, Index q, Vertex& vertex) const noexcept {
    detail::keep_between(complex_.points()[p][N - 1], complex_.points()[q][N - 1], vertex);
  }

  /// A part of the way from a point to the cell's centre.
  [[nodiscard]] Vertex inwards(std::span<const Index> corners, const Mean& point, double part) const noexcept {
    Mean centre(*this);
    for (const Index corner : corners) centre.add_corner(corner);
    const Point a = point.mean(), b = near(a, centre.mean());
    Vertex vertex = part_of_way<Real>(a, b, part);
    keep_inside(vertex);
    if (is_layered_) keep_between(corners.front(), corners.back(), vertex);
    return vertex;
  }

  const Complex<N>& complex_;
  const CellGroups& cells_;
  const CellSigns& signs_;
  const ContourNumbers& numbers_;
  const PointGradients<N>* gradients_;
  std::span<const Period<N>> periods_;
  double isovalue_, epsilon_;
  bool is_layered_, descends_;
  ContourRoom<N, Real, I> contour_;
};

/// Writes normals and positions of vertices, and simplices.
template <class Real, class I, int N>
void write_contour(const Complex<N>& complex, const NumberedContour<N>& numbered, double isovalue,
                   const ExtractOptions& options, const Surroundings<N>& around, const Progress& progress,
                   const ContourRoom<N, Real, I>& room) {
  const ContourNumbers& numbers = numbered.numbers();
  const unsigned threads = options.work.threads;
  const double start = options.normals == Normals::none ? 0.0 : 0.5;
  std::optional<PointGradients<N>> gradients;
  if (options.normals != Normals::none) {
    std::vector<Index> others = corners_of_sides(complex, numbers);
    if (const auto* const caps = numbered.caps())
      others.insert(others.end(), caps->corners().begin(), caps->corners().end());
    const WorkOptions work{threads, part_of(progress, 0.0, start)};
    if (around.gradient)
      gradients.emplace(complex, numbers.edge_ends(), others, around.gradient, work);
    else
      gradients.emplace(complex, numbers.edge_ends(), others, work);
  }
  const Progress rest = part_of(progress, start, 1.0);
  ComplexWriter<N, Real, I> writer(complex, numbers, gradients ? &*gradients : nullptr, around.periods, isovalue,
                                   options, room);
  writer.write_edge_points({threads, part_of(rest, 0.0, 0.25)});
  writer.write_polygon_centres({threads, part_of(rest, 0.25, 0.4)});
  writer.write_cells({threads, part_of(rest, 0.4, 1.0)});
  writer.write_polytopes({threads, nullptr});
  if (numbered.caps() != nullptr) writer.write_caps(*numbered.caps());
}

/// Writes a numbered contour. `touching`: vertices at which it may touch itself beside missing values.
template <class Real, int N>
Contour<N, Real> contour_of(const Complex<N>& complex, const NumberedContour<N>& numbered,
                            const std::vector<Index>& touching, double isovalue, const ExtractOptions& options,
                            const Surroundings<N>& around, const Progress& progress) {
  Contour<N, Real> contour;
  const ContourSize size = numbered.size();
  contour.direction = options.direction;
  contour.vertices.resize(size.vertices);
  contour.simplices.resize(size.simplices);
  if (options.normals != Normals::none) contour.normals.resize(size.vertices);
  write_contour<Real, Index, N>(complex, numbered, isovalue, options, around, progress,
                                {contour.vertices, contour.simplices, contour.normals});
  contour.periods = around.periods;
  if (!touching.empty()) split_nonmanifold<N, Real>(contour, touching, std::numeric_limits<Index>::max());
  return contour;
}

}  // namespace

template <class Real, int N>
Extraction<N, Real> extract_in(const Complex<N>& complex, double isovalue, const ExtractOptions& options,
                               const Surroundings<N>& around) {
  check_complex_options(isovalue, options);
  check_range<Real>(complex);
  Extraction<N, Real> result;
  const Progress& progress = options.work.progress;
  const NumberedContour<N> numbered(complex, isovalue, options, around.active, around.border,
                                    part_of(progress, 0.0, 0.6), result.stats);
  std::vector<Index> touching;
  if (around.keys == nullptr) {
    touching = numbered.touching(ComplexAccess::cells(complex));
  } else {
    *around.keys = {numbered.numbers().edge_ends(), numbered.numbers().polygons(),
                    static_cast<std::size_t>(numbered.numbers().size().vertices)};
    if (numbered.caps() != nullptr) around.keys->corners = numbered.caps()->corners();
  }
  if (around.simplices != nullptr)
    *around.simplices = numbered.numbers().simplices_by_cell(ComplexAccess::cells(complex));
  if (around.caps != nullptr && numbered.caps() != nullptr) *around.caps = numbered.caps()->by_facet();
  Stopwatch watch;
  result.contour =
      contour_of<Real>(complex, numbered, touching, isovalue, options, around, part_of(progress, 0.6, 1.0));
  watch.add_to(result.stats.generate_seconds);
  return result;
}

}  // namespace detail

template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_with_stats(const Complex<N>& complex, double isovalue,
                                                                          const ExtractOptions& options) {
  return detail::extract_in<Real>(complex, isovalue, options, detail::Surroundings<N>());
}

template <int N, Coordinate Real, VertexNumber I>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_into(const Complex<N>& complex, double isovalue,
                                                              const ContourRoom<N, Real, I>& room,
                                                              const ExtractOptions& options) {
  detail::check_complex_options(isovalue, options);
  detail::check_range<Real>(complex);
  const bool with_normals = options.normals != Normals::none;
  ExtractedSize result;
  const detail::NumberedContour<N> numbered(complex, isovalue, options, nullptr, nullptr,
                                            detail::part_of(options.work.progress, 0.0, 0.6), result.stats);
  detail::check_room(room, result.size = numbered.size(), with_normals);
  detail::Stopwatch watch;
  const Progress writing = detail::part_of(options.work.progress, 0.6, 1.0);
  if (const auto touching = numbered.touching(detail::ComplexAccess::cells(complex)); touching.empty()) {
    detail::write_contour<Real, I, N>(complex, numbered, isovalue, options, {}, writing, room);
  } else {
    const auto contour = detail::contour_of<Real, N>(complex, numbered, touching, isovalue, options, {}, writing);
    detail::check_room(room, result.size = {contour.vertices.size(), contour.simplices.size()}, with_normals);
    detail::copy_contour(contour, room);
  }
  watch.add_to(result.stats.generate_seconds);
  return result;
}

#define TEGL_INSTANTIATE_INTO(N, Real, I)                                                                    \
  template ExtractedSize extract_into<N, Real, I>(const Complex<N>&, double, const ContourRoom<N, Real, I>&, \
                                                  const ExtractOptions&);
#define TEGL_INSTANTIATE_COMPLEX(N)                                                                               \
  template Extraction<N, float> detail::extract_in<float, N>(const Complex<N>&, double, const ExtractOptions&,    \
                                                             const detail::Surroundings<N>&);                     \
  template Extraction<N, double> detail::extract_in<double, N>(const Complex<N>&, double, const ExtractOptions&,  \
                                                               const detail::Surroundings<N>&);                   \
  template Extraction<N, float> extract_with_stats<float, N>(const Complex<N>&, double, const ExtractOptions&);   \
  template Extraction<N, double> extract_with_stats<double, N>(const Complex<N>&, double, const ExtractOptions&); \
  TEGL_INSTANTIATE_INTO(N, float, std::uint32_t)                                                                  \
  TEGL_INSTANTIATE_INTO(N, float, std::uint64_t)                                                                  \
  TEGL_INSTANTIATE_INTO(N, double, std::uint32_t)                                                                 \
  TEGL_INSTANTIATE_INTO(N, double, std::uint64_t)
TEGL_INSTANTIATE_COMPLEX(2)
TEGL_INSTANTIATE_COMPLEX(3)
TEGL_INSTANTIATE_COMPLEX(4)
#undef TEGL_INSTANTIATE_COMPLEX
#undef TEGL_INSTANTIATE_INTO

}  // namespace tegl
