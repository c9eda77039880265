// SPDX-License-Identifier: BSD-3-Clause
//
// Projections of 4D contours to 3D, and their outlines (silhouettes).
//
// The outline is the set where the line of sight is tangent to the contour, that is, orthogonal to its normal.
// Classifying tetrahedra as near or far would give the outline of the simplices: jagged, with a fold wherever the
// diagonal of a nonplanar quadrilateral changes from one time to the next. Instead the normals at the vertices are
// interpolated, as is usual for silhouettes of surfaces. The outline is then the zero set of a function that is linear
// on each tetrahedron, that is, a cut with the function as a coordinate. closed_cut.cpp proves that the cut of a
// manifold is a manifold.
//
// Based on: A. Hertzmann and D. Zorin, Illustrating smooth surfaces, 2000 (outlines by interpolated normals);
// M. Liversage, thesis, 1994, section 10.2.
#include "tegl/project.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "cut/hyperplane_family.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/eigen.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using detail::HyperplaneFamily;

constexpr const char* kCancelledProject = "projecting was cancelled";

/// The points and heights of a projected contour.
template <class Real>
struct View {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> flat;  ///< points before perspective; empty without it
  std::vector<double> heights;
  bool is_right_handed = true;
  double least = 0.0;                                ///< minimum height
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of the bounding box of the points; only with perspective
};

void check_projection(const Projection& projection) {
  if (!(projection.eye_distance >= 0.0) || !std::isfinite(projection.eye_distance))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("eye at the distance {}; expected 0 or more", projection.eye_distance));
}

/// Perspective: moves the points towards the middle of their bounding box, by more at greater height.
template <class Real>
void draw_towards_middle(View<Real>& view, double distance) {
  if (distance == 0.0 || view.points.empty()) return;
  Eigen::Vector3d low = view.points[0];
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& point : view.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  view.middle = 0.5 * (low + high);
  view.least = *std::min_element(view.heights.begin(), view.heights.end());
  view.flat = view.points;
  for (std::size_t v = 0; v < view.points.size(); ++v)
    view.points[v] =
        view.middle + (view.points[v] - view.middle) * (distance / (distance + (view.heights[v] - view.least)));
}

/// Whether a tetrahedron is on the far side: its normal, directed towards low values, has a positive height component.
/// Tetrahedra that are edge-on, up to rounding, count as far.
template <class Real>
bool is_far(const View<Real>& view, const std::array<Index, 4>& simplex, bool flip) {
  Eigen::Matrix3d edges;
  double size = 1.0;
  for (int j = 0; j < 3; ++j) {
    edges.col(j) = view.points[simplex[j + 1]] - view.points[simplex[0]];
    size *= edges.col(j).norm();
  }
  constexpr double kRounding = 64.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const double volume = flip ? -edges.determinant() : edges.determinant();
  return volume >= -kRounding * size;
}

template <class Real>
View<Real> view_of(const Contour<4, Real>& contour, const Projection& projection, const WorkOptions& work) {
  check_projection(projection);
  detail::require_unwrapped(contour, "project");
  detail::require_sound(contour);
  const HyperplaneFamily<4> family(projection.direction);
  const HyperplaneFrame<4> frame = frame_of(Hyperplane<4>{projection.direction, 0.0});
  const Eigen::Vector4d up = as_eigen(frame.up);
  View<Real> view;
  view.is_right_handed = frame.is_right_handed;
  view.points.resize(contour.vertices.size());
  view.heights.resize(contour.vertices.size());
  detail::for_each_item(contour.vertices.size(), work.threads, work.progress, [&](std::size_t v) {
    const auto& vertex = contour.vertices[v];
    std::array<double, 4> x;
    std::copy(vertex.begin(), vertex.end(), x.begin());
    const std::array<double, 3> y = family.within(x);
    view.points[v] = {y[0], y[1], y[2]};
    view.heights[v] = family.is_across_axis() ? family.height(vertex) : up.dot(Eigen::Vector4d(x.data()));
  });
  draw_towards_middle(view, projection.eye_distance);
  return view;
}

void replace(std::vector<Attribute>& attributes, Attribute attribute) {
  std::erase_if(attributes, [&](const Attribute& other) { return other.name == attribute.name; });
  attributes.push_back(std::move(attribute));
}

/// Vertex attribute with the heights.
template <class Real>
Attribute height_attribute(const Contour<4, Real>& contour, const Projection& projection, const View<Real>& view) {
  const HyperplaneFamily<4> family(projection.direction);
  Attribute height{"height", "", 1, {}};
  if (family.is_across_axis()) {
    constexpr const char* kLetters = "xyzt";
    const auto axis = static_cast<std::size_t>(family.dropped_axis());
    height.name = contour.axis_names[axis].empty() ? std::string(1, kLetters[axis]) : contour.axis_names[axis];
    height.unit = contour.axis_units[axis];
  }
  height.values.assign(view.heights.begin(), view.heights.end());
  return height;
}

/// Copies the names and units of the axes that the frame keeps.
template <class Real>
void name_axes(const Contour<4, Real>& contour, const Projection& projection, std::array<std::string, 3>& names,
               std::array<std::string, 3>& units) {
  const HyperplaneFamily<4> family(projection.direction);
  for (int i = 0; i < 3; ++i) {
    if (!family.keeps_axis(i)) continue;
    const int a = i < family.dropped_axis() ? i : i + 1;
    names[i] = contour.axis_names[a];
    units[i] = contour.axis_units[a];
  }
}

using VertexNormals = std::vector<Eigen::Vector4d>;

/// Vertices whose tetrahedra all have zero volume (this happens if samples equal the isovalue) get the sum of
/// neighbouring normals.
template <class Real>
void fill_from_neighbours(const Contour<4, Real>& contour, VertexNormals& normals) {
  double sum = 0.0;
  for (const Eigen::Vector4d& normal : normals) sum += normal.norm();
  constexpr double kNone = 1e-12;
  const double least = kNone * sum / std::max(1.0, static_cast<double>(normals.size()));
  constexpr int kMostRounds = 8;  // a vertex farther from all nonzero tetrahedra counts as edge-on
  for (int round = 0; round < kMostRounds; ++round) {
    VertexNormals more(normals.size(), Eigen::Vector4d::Zero());
    bool any = false;
    for (const auto& simplex : contour.simplices)
      for (const Index v : simplex) {
        if (normals[v].norm() > least) continue;
        any = true;
        for (const Index other : simplex)
          if (normals[other].norm() > least) more[v] += normals[other];
      }
    if (!any) return;
    for (std::size_t v = 0; v < normals.size(); ++v)
      if (normals[v].norm() <= least) normals[v] = more[v];
  }
}

/// By vertex, the sum of the normals of its tetrahedra, in the order of these. `incidence`: null if it is not known.
template <class Real>
VertexNormals vertex_normals(const Contour<4, Real>& contour, const detail::IncidenceData<4>* incidence,
                             const WorkOptions& work) {
  Buffer<detail::PointOf<4>> of_simplices(contour.simplices.size());
  detail::for_each_item(
      of_simplices.size(), work.threads, detail::part_of(work.progress, 0.0, 0.3),
      [&](std::size_t s) { of_simplices[s] = detail::normal_vector_of<4>(detail::corners_of(contour, s)); });
  detail::Stars made;
  if (incidence == nullptr)
    made = detail::make_stars<4>(detail::flat_rows(std::span<const std::array<Index, 4>>(contour.simplices)),
                                 contour.vertices.size(), work.threads, detail::part_of(work.progress, 0.3, 0.6));
  const detail::Stars& stars = incidence != nullptr ? incidence->stars : made;
  VertexNormals normals(contour.vertices.size());
  detail::for_each_item(normals.size(), work.threads, detail::part_of(work.progress, 0.6, 1.0), [&](std::size_t v) {
    normals[v].setZero();
    for (const Index s : stars.of(v)) normals[v] += Eigen::Vector4d(of_simplices[s].data());
  });
  return normals;
}

/// By vertex, the cosine between the line of sight and its normal (the sum of the normals of its tetrahedra), directed
/// towards low values: negative on the near side, positive on the far side. Values within rounding of 0 count as far,
/// as for tetrahedra.
template <class Real>
std::vector<double> along_sight(const Contour<4, Real>& contour, const detail::IncidenceData<4>* incidence,
                                const Projection& projection, const View<Real>& view, const WorkOptions& work) {
  const HyperplaneFrame<4> frame = frame_of(Hyperplane<4>{projection.direction, 0.0});
  const Eigen::Vector4d up = as_eigen(frame.up);
  const Eigen::Matrix<double, 4, 3> axes = as_eigen(frame.axes).transpose();
  VertexNormals normals = vertex_normals(contour, incidence, {work.threads, detail::part_of(work.progress, 0.0, 0.8)});
  fill_from_neighbours(contour, normals);
  std::vector<double> result(normals.size());
  detail::for_each_item(normals.size(), work.threads, detail::part_of(work.progress, 0.8, 1.0), [&](std::size_t v) {
    Eigen::Vector4d sight = up;
    if (projection.eye_distance > 0.0)
      sight = axes * (view.flat[v] - view.middle) + up * (projection.eye_distance + view.heights[v] - view.least);
    const double size = normals[v].norm() * sight.norm();
    constexpr double kRounding = 64.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    double cosine = size > 0.0 ? normals[v].dot(sight) / size : 0.0;
    if (contour.direction == GradientDirection::ascent) cosine = -cosine;
    result[v] = std::abs(cosine) > kRounding ? cosine : kRounding;
  });
  return result;
}

}  // namespace

template <Coordinate Real>
ProjectedContour<Real> project(const Contour<4, Real>& contour, const Projection& projection, const WorkOptions& work) {
  const View<Real> view = view_of(contour, projection, {work.threads, detail::part_of(work.progress, 0.0, 0.4)});
  ProjectedContour<Real> result;
  result.vertices.resize(view.points.size());
  detail::for_each_item(view.points.size(), work.threads, {}, [&](std::size_t v) {
    const Eigen::Vector3d& point = view.points[v];
    result.vertices[v] = {static_cast<Real>(point[0]), static_cast<Real>(point[1]), static_cast<Real>(point[2])};
  });
  result.tetrahedra = contour.simplices;
  name_axes(contour, projection, result.axis_names, result.axis_units);
  result.vertex_attributes = contour.vertex_attributes;
  replace(result.vertex_attributes, height_attribute(contour, projection, view));
  result.simplex_attributes = contour.simplex_attributes;
  Attribute side{"side", "", 1, {}};
  const bool flip = view.is_right_handed == (contour.direction == GradientDirection::ascent);
  side.values.resize(contour.simplices.size());
  detail::for_each_item(contour.simplices.size(), work.threads, detail::part_of(work.progress, 0.4, 1.0),
                        [&](std::size_t s) { side.values[s] = is_far(view, contour.simplices[s], flip) ? 1.0 : -1.0; });
  replace(result.simplex_attributes, std::move(side));
  return result;
}

namespace {

template <Coordinate Real>
Contour<3, Real> outline_with(const Contour<4, Real>& contour, const detail::IncidenceData<4>* incidence,
                              const Projection& projection, const WorkOptions& work) {
  detail::tell(work.progress, 0.0, kCancelledProject);
  const View<Real> view = view_of(contour, projection, {work.threads, detail::part_of(work.progress, 0.0, 0.2)});
  const std::vector<double> sides =
      along_sight(contour, incidence, projection, view, {work.threads, detail::part_of(work.progress, 0.2, 0.6)});
  // The projected contour with the side function as last coordinate; the outline is its cut at 0.
  Contour<4, double> raised;
  raised.vertices.resize(view.points.size());
  for (std::size_t v = 0; v < view.points.size(); ++v)
    raised.vertices[v] = {view.points[v][0], view.points[v][1], view.points[v][2], sides[v]};
  raised.simplices = contour.simplices;
  raised.direction = contour.direction;
  raised.vertex_attributes = contour.vertex_attributes;
  replace(raised.vertex_attributes, height_attribute(contour, projection, view));
  raised.simplex_attributes = contour.simplex_attributes;
  detail::tell(work.progress, 0.65, kCancelledProject);
  Contour<3, double> cut =
      slice(raised, Hyperplane<4>::across(3, 0.0), {work.threads, detail::part_of(work.progress, 0.65, 0.9)});
  Contour<3, Real> result;
  result.direction = contour.direction;
  name_axes(contour, projection, result.axis_names, result.axis_units);
  for (const auto& vertex : cut.vertices)
    result.vertices.push_back(
        {static_cast<Real>(vertex[0]), static_cast<Real>(vertex[1]), static_cast<Real>(vertex[2])});
  result.simplices = std::move(cut.simplices);
  result.vertex_attributes = std::move(cut.vertex_attributes);
  result.simplex_attributes = std::move(cut.simplex_attributes);
  // The cut has the orientation of the contour in the raised space, where the far side is up.
  if (!view.is_right_handed)
    for (auto& simplex : result.simplices) std::swap(simplex[1], simplex[2]);
  detail::tell(work.progress, 1.0, kCancelledProject);
  return result;
}

}  // namespace

template <Coordinate Real>
Contour<3, Real> outline(const Contour<4, Real>& contour, const Projection& projection, const WorkOptions& work) {
  return outline_with<Real>(contour, nullptr, projection, work);
}

template <Coordinate Real>
Contour<3, Real> outline(const Contour<4, Real>& contour, const Incidence<4>& incidence, const Projection& projection,
                         const WorkOptions& work) {
  detail::require_vertices(contour);
  detail::require_incidence<4>(incidence.data(),
                               detail::flat_rows(std::span<const std::array<Index, 4>>(contour.simplices)),
                               contour.vertices.size());
  return outline_with<Real>(contour, &incidence.data(), projection, work);
}

template ProjectedContour<float> project(const Contour<4, float>&, const Projection&, const WorkOptions&);
template ProjectedContour<double> project(const Contour<4, double>&, const Projection&, const WorkOptions&);
template Contour<3, float> outline(const Contour<4, float>&, const Projection&, const WorkOptions&);
template Contour<3, double> outline(const Contour<4, double>&, const Projection&, const WorkOptions&);
template Contour<3, float> outline(const Contour<4, float>&, const Incidence<4>&, const Projection&,
                                   const WorkOptions&);
template Contour<3, double> outline(const Contour<4, double>&, const Incidence<4>&, const Projection&,
                                    const WorkOptions&);

}  // namespace tegl
