// SPDX-License-Identifier: BSD-3-Clause
//
// Components against a breadth-first search, against `check`, and against analytic fields.
#include "tegl/components.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <queue>

#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

/// Labels by breadth-first search from the smallest unlabelled vertex.
template <int N, class Real>
ComponentLabels labels_by_search(const Contour<N, Real>& contour) {
  std::vector<std::vector<Index>> stars(contour.vertices.size());
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (const Index v : contour.simplices[s]) stars[v].push_back(static_cast<Index>(s));
  ComponentLabels labels;
  labels.vertices.assign(contour.vertices.size(), kNoComponent);
  labels.simplices.assign(contour.simplices.size(), kNoComponent);
  for (Index start = 0; start < contour.vertices.size(); ++start) {
    if (stars[start].empty() || labels.vertices[start] != kNoComponent) continue;
    std::queue<Index> front({start});
    labels.vertices[start] = labels.count;
    for (; !front.empty(); front.pop())
      for (const Index s : stars[front.front()]) {
        labels.simplices[s] = labels.count;
        for (const Index v : contour.simplices[s])
          if (labels.vertices[v] == kNoComponent) {
            labels.vertices[v] = labels.count;
            front.push(v);
          }
      }
    ++labels.count;
  }
  return labels;
}

bool same(const ComponentLabels& a, const ComponentLabels& b) {
  return a.count == b.count && a.vertices == b.vertices && a.simplices == b.simplices;
}

/// Noise whose contour has many components, closed at the border or not.
template <int N>
Contour<N, double> noise_contour(std::size_t samples, std::uint64_t seed, bool close) {
  ExtractOptions options;
  options.close = close;
  return extract<double>(view_of(noise<float, N>(samples, seed)), N == 5 ? 0.93 : 0.85, options);
}

template <int N>
void expect_labels_of_search(std::size_t samples) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << " in " << N << "D");
    const auto contour = noise_contour<N>(samples, seed, false);
    const ComponentLabels labels = label_components(contour);
    EXPECT_GT(labels.count, 5u);
    EXPECT_TRUE(same(labels, labels_by_search(contour)));
  }
}

TEST(Components, AreThoseOfABreadthFirstSearch) {
  expect_labels_of_search<2>(40);
  expect_labels_of_search<3>(16);
  expect_labels_of_search<4>(8);
  expect_labels_of_search<5>(4);
}

/// Compares by bytes: -0 differs from 0.
template <int N>
bool same_bytes(const std::vector<Component<N>>& a, const std::vector<Component<N>>& b) {
  const auto equal = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof(x)) == 0; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const Component<N>& x, const Component<N>& y) {
    return x.label == y.label && x.vertices == y.vertices && x.simplices == y.simplices && equal(x.size, y.size) &&
           x.content == y.content && equal(x.centroid, y.centroid) && equal(x.lowest, y.lowest) &&
           equal(x.highest, y.highest) && x.euler == y.euler && x.boundary_simplices == y.boundary_simplices;
  });
}

template <int N>
void expect_same_for_any_threads(std::size_t samples) {
  const auto contour = noise_contour<N>(samples, 7, true);
  const ComponentLabels labels = label_components(contour, {1, {}});
  const std::vector<Component<N>> described = components(contour, labels, {1, {}});
  for (unsigned threads = 2; threads <= 4; ++threads)
    for (int turn = 0; turn < 5; ++turn) {
      ASSERT_TRUE(same(label_components(contour, {threads, {}}), labels)) << threads << " threads in " << N << "D";
      ASSERT_TRUE(same_bytes(components(contour, labels, {threads, {}}), described)) << threads << " threads";
    }
}

TEST(Components, AreTheSameForAnyNumberOfThreads) {
  expect_same_for_any_threads<2>(300);
  expect_same_for_any_threads<3>(24);
  expect_same_for_any_threads<4>(9);
}

/// The properties of each component against a separate contour of it, and of all components against the whole.
template <int N>
void expect_parts_make_up_the_whole(std::size_t samples, bool close) {
  SCOPED_TRACE(testing::Message() << N << "D" << (close ? ", closed" : ""));
  const auto contour = noise_contour<N>(samples, 11, close);
  const MeshReport whole = expect_oriented_manifold(contour);
  const ComponentLabels labels = label_components(contour);
  ASSERT_EQ(labels.count, whole.components);
  const auto parts = split_components(contour, labels);
  const std::vector<Component<N>> described = components(contour, labels);
  ASSERT_EQ(parts.size(), labels.count);
  ASSERT_EQ(described.size(), labels.count);
  std::int64_t euler = 0;
  std::uint64_t boundary = 0;
  double size = 0;
  double content = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const MeshReport part = expect_oriented_manifold(parts[i]);
    const Component<N>& component = described[i];
    EXPECT_EQ(component.label, i);
    EXPECT_EQ(part.components, 1u);
    EXPECT_EQ(component.vertices, part.vertices);
    EXPECT_EQ(component.simplices, part.simplices);
    EXPECT_EQ(component.euler, part.euler);
    EXPECT_EQ(component.boundary_simplices, part.boundary_simplices);
    EXPECT_NEAR(component.size, test::measure(parts[i]), 1e-11 * component.size);
    ASSERT_EQ(component.content.has_value(), part.boundary_simplices == 0);
    if (component.content) {
      EXPECT_NEAR(*component.content, enclosed_content(parts[i]), 1e-9);
    }
    euler += component.euler;
    boundary += component.boundary_simplices;
    size += component.size;
    content += component.content.value_or(0);
  }
  EXPECT_EQ(euler, whole.euler);
  EXPECT_EQ(boundary, whole.boundary_simplices);
  const Measures<N> measures = tegl::measure(contour);
  EXPECT_NEAR(size, measures.size, 1e-12 * size);
  if (close) {
    EXPECT_NEAR(content, measures.content.value(), 1e-11 * std::abs(content));
  }
}

TEST(Components, MakeUpTheWhole) {
  for (const bool close : {false, true}) {
    expect_parts_make_up_the_whole<2>(30, close);
    expect_parts_make_up_the_whole<3>(10, close);
    expect_parts_make_up_the_whole<4>(6, close);
  }
  expect_parts_make_up_the_whole<5>(3, false);
}

TEST(Components, OfAShellWithABallInsideAreThreeSpheres) {
  // High between the radii 0.5 and 0.8, and within 0.25.
  const auto image = sample_field<double>(centred_grid<3>(50, 1.0), [](const Point<3>& x) {
    const double r = std::hypot(x[0] - 0.1, x[1], x[2]);
    return std::max(0.15 - std::abs(r - 0.65), 0.25 - r);
  });
  const auto contour = extract<double>(image.view(), 0.0);
  const auto found = components(contour, label_components(contour));
  ASSERT_EQ(found.size(), 3u);
  const auto content = [](double r) { return Ball<3>{{}, r}.content(); };
  const std::array<double, 3> expected = {content(0.8), -content(0.5), content(0.25)};  // by their lowest vertices
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].euler, 2);
    EXPECT_NEAR(found[i].content.value(), expected[i], 0.02 * std::abs(expected[i]));
    EXPECT_NEAR(found[i].centroid[0], 0.1, 2e-3);
    EXPECT_NEAR(found[i].centroid[2], 0.0, 2e-3);
  }
  EXPECT_NEAR(found[0].highest[0], 0.9, 2e-3);
  EXPECT_NEAR(found[0].lowest[1], -0.8, 2e-3);
}

TEST(Components, OfA4dContourHaveALifetime) {
  const auto image = sample_field<float>(centred_grid<4>(20, 2.0), [](const Point<4>& x) {
    return std::max(Ball<4>{{-1, 0, 0, -1}, 0.7}(x), Ball<4>{{1, 0, 0, 0.9}, 0.8}(x));
  });
  const auto contour = extract<double>(image.view(), 0.0);
  auto found = components(contour, label_components(contour));
  ASSERT_EQ(found.size(), 2u);
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.size < b.size; });
  EXPECT_NEAR(found[0].time_span(), 1.4, 0.05);
  EXPECT_NEAR(found[1].lowest[3], 0.1, 0.05);
  EXPECT_NEAR(found[1].content.value(), (Ball<4>{{}, 0.8}).content(), 0.2);
  EXPECT_EQ(found[0].euler, 0);  // a 3-sphere
}

TEST(Components, WithTheOtherDirectionEncloseTheSame) {
  const auto image = sample_field<float>(centred_grid<3>(20, 1.5), Ball<3>{});
  ExtractOptions options;
  options.direction = GradientDirection::ascent;
  const auto contour = extract<float>(image.view(), 0.0, options);
  EXPECT_NEAR(components(contour, label_components(contour))[0].content.value(), Ball<3>{}.content(), 0.1);
}

TEST(Components, KeepNormalsAttributesNamesAndUnits) {
  ExtractOptions options;
  options.normals = Normals::differences;
  auto image = noise<float, 3>(10, 5);
  image.grid.axes[1].name = "lat";
  image.grid.axes[1].unit = "mm";
  auto contour = extract<double>(image.view(), 0.85, options);
  Attribute place{"place", "m", 3, {}};
  for (const auto& vertex : contour.vertices) place.values.insert(place.values.end(), vertex.begin(), vertex.end());
  contour.vertex_attributes = {place};
  Attribute number{"number", "", 1, {}};
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) number.values.push_back(static_cast<double>(s));
  contour.simplex_attributes = {number};
  const ComponentLabels labels = label_components(contour);
  std::size_t simplices = 0;
  for (const auto& part : split_components(contour, labels)) {
    EXPECT_EQ(part.axis_names[1], "lat");
    EXPECT_EQ(part.axis_units[1], "mm");
    ASSERT_EQ(part.normals.size(), part.vertices.size());
    ASSERT_EQ(part.vertex_attributes.size(), 1u);
    EXPECT_EQ(part.vertex_attributes[0].unit, "m");
    for (std::size_t v = 0; v < part.vertices.size(); ++v)
      for (std::size_t a = 0; a < 3; ++a) ASSERT_EQ(part.vertex_attributes[0].values[3 * v + a], part.vertices[v][a]);
    ASSERT_EQ(part.simplex_attributes[0].values.size(), part.simplices.size());
    for (std::size_t s = 0; s < part.simplices.size(); ++s, ++simplices) {
      const auto& original = contour.simplices[static_cast<std::size_t>(part.simplex_attributes[0].values[s])];
      for (std::size_t j = 0; j < 3; ++j) {
        ASSERT_EQ(part.vertices[part.simplices[s][j]], contour.vertices[original[j]]);
        ASSERT_EQ(part.normals[part.simplices[s][j]], contour.normals[original[j]]);
      }
    }
  }
  EXPECT_EQ(simplices, contour.simplices.size());
}

TEST(Components, SelectedAreThoseAndNoOthers) {
  const auto contour = noise_contour<3>(12, 9, false);
  const ComponentLabels labels = label_components(contour);
  const auto found = components(contour, labels);
  std::vector<bool> keep(labels.count);
  double kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    keep[i] = found[i].boundary_simplices == 0;
    if (keep[i]) kept += found[i].size;
  }
  const auto closed = select_components(contour, labels, keep);
  const MeshReport report = expect_closed_manifold(closed);
  EXPECT_EQ(report.components, static_cast<std::size_t>(std::count(keep.begin(), keep.end(), true)));
  EXPECT_GT(report.components, 0u);
  EXPECT_NEAR(test::measure(closed), kept, 1e-10);
  const auto all = select_components(contour, labels, std::vector<bool>(labels.count, true));
  EXPECT_EQ(all.vertices, contour.vertices);
  EXPECT_EQ(all.simplices, contour.simplices);
  EXPECT_TRUE(select_components(contour, labels, std::vector<bool>(labels.count, false)).vertices.empty());
}

/// Two segments along axis 1, at 0 and at 3.
Contour<2, double> two_segments() {
  Contour<2, double> contour;
  contour.vertices = {{0.0, 0.0}, {0.0, 1.0}, {3.0, 0.0}, {3.0, 1.0}};
  contour.simplices = {{0, 1}, {2, 3}};
  return contour;
}

TEST(Components, NearestToAPointHasTheNearestVertex) {
  Contour<2, double> contour = two_segments();
  const ComponentLabels labels = label_components(contour);
  EXPECT_EQ(nearest_component(contour, labels, {1.0, 0.0}).label, 0u);
  EXPECT_EQ(nearest_component(contour, labels, {1.5, 0.0}).label, 0u);  // as near as the other one
  EXPECT_EQ(nearest_component(contour, labels, {1.5, 0.0}).distance, 1.5);
  EXPECT_EQ(nearest_component(contour, labels, {2.0, 0.0}).label, 1u);
  EXPECT_EQ(nearest_component(contour, labels, {2.0, 3.0}, {1.0, 2.0}).distance, std::sqrt(2.0));
  contour.vertices[3] = {3.0, 40.0};
  EXPECT_EQ(nearest_component(contour, labels, {0.0, 21.0}).label, 1u);
  EXPECT_EQ(nearest_component(contour, labels, {0.0, 21.0}, {0.1, 1.0}).label, 0u);
  // across the seam the other one is nearer
  contour.periods = {{{4.0, 0.0}, {0.25, 0.0}, 0.0}};
  EXPECT_EQ(nearest_component(contour, labels, {-0.75, 0.0}).label, 1u);
  EXPECT_EQ(nearest_component(contour, labels, {7.25, 0.0}).distance, 0.25);
  EXPECT_EQ(nearest_component(Contour<2, double>(), ComponentLabels(), {1.0, 0.0}).label, kNoComponent);
}

TEST(Components, NearestToAPointIsThatOfAllDistances) {
  const Contour<3, double> contour = noise_contour<3>(9, 5, false);
  const ComponentLabels labels = label_components(contour);
  ASSERT_GT(labels.count, 5u);
  for (const std::array<double, 3>& point : {std::array{4.1, 4.2, 4.3}, {0.3, 7.5, 2.0}, {30.0, 1.0, -8.0}}) {
    const auto square = [&](Index v) {
      double sum = 0;
      for (std::size_t a = 0; a < 3; ++a)
        sum += (contour.vertices[v][a] - point[a]) * (contour.vertices[v][a] - point[a]);
      return sum;
    };
    Index nearest = contour.simplices[0][0];
    for (Index v = 0; v < contour.vertices.size(); ++v)
      if (square(v) < square(nearest)) nearest = v;
    const NearestComponent found = nearest_component(contour, labels, point);
    EXPECT_EQ(found.label, labels.vertices[nearest]);
    EXPECT_EQ(found.distance, std::sqrt(square(nearest)));
  }
}

TEST(Components, NearestToAPointIsModuloObliquePeriods) {
  // shares of these periods, rounded, are not those of the nearest repetition
  Contour<2, double> contour;
  contour.vertices = {{0.0, 0.0}, {0.01, 0.0}, {0.3, 0.1}, {0.31, 0.1}};
  contour.simplices = {{0, 1}, {2, 3}};
  contour.periods = {{{1.0, 0.0}, {1.0, -3.0}, 0.0}, {{0.9, 0.3}, {0.0, 1.0 / 0.3}, 0.0}};
  const ComponentLabels labels = label_components(contour);
  for (const std::array<double, 2>& steps : {std::array{1.0, 1.0}, {1.0, 0.2}, {0.1, 1.0}})
    for (int at = 0; at < 400; ++at) {
      const std::array point = {0.05 * (at % 20) + 0.002, 0.03 * (at / 20) - 0.1};
      double nearest = std::numeric_limits<double>::infinity();
      Index label = kNoComponent;
      for (Index v = 0; v < 4; ++v)
        for (int i = -15; i <= 15; ++i)
          for (int k = -15; k <= 15; ++k) {
            const double x = (contour.vertices[v][0] + i + 0.9 * k - point[0]) / steps[0];
            const double y = (contour.vertices[v][1] + 0.3 * k - point[1]) / steps[1];
            if (std::hypot(x, y) >= nearest - 1e-9) continue;
            nearest = std::hypot(x, y);
            label = labels.vertices[v];
          }
      const NearestComponent found = nearest_component(contour, labels, point, steps);
      EXPECT_NEAR(found.distance, nearest, 1e-8) << point[0] << ' ' << point[1];
      EXPECT_EQ(found.label, label) << point[0] << ' ' << point[1];
    }
}

TEST(Components, NearestToAPointBesideOneObliquePeriodIsOrthogonal) {
  // a strip along (1, 0.5): its share does not depend on y
  Contour<2, double> contour = two_segments();
  contour.periods = {{{1.0, 0.5}, {1.0, 0.0}, 0.0}};
  const ComponentLabels labels = label_components(contour);
  EXPECT_NEAR(nearest_component(contour, labels, {0.0, 20.0}, {1.0, 1.0}).distance, std::hypot(8.0, 15.0), 1e-9);
}

TEST(Components, NearestToAPointWhoseDistanceOverflowsIsTheFirst) {
  Contour<2, double> contour = two_segments();
  contour.vertices.insert(contour.vertices.begin(), {9.0, 9.0});  // in no simplex
  contour.simplices = {{1, 2}, {3, 4}};
  const ComponentLabels labels = label_components(contour);
  const NearestComponent found = nearest_component(contour, labels, {1e200, 0.0});
  EXPECT_EQ(found.label, 0u);
  EXPECT_TRUE(std::isinf(found.distance));
  EXPECT_EQ(nearest_component(contour, labels, {1.0, 0.0}, {1e-300, 1.0}).label, 0u);
}

TEST(Components, NearestToAPointNamesWrongNumbers) {
  const Contour<2, double> contour = two_segments();
  const ComponentLabels labels = label_components(contour);
  const double nan = std::nan("");
  expect_error(ErrorCode::InvalidArgument, "(1, nan)", [&] { nearest_component(contour, labels, {1.0, nan}); });
  expect_error(ErrorCode::InvalidArgument, "steps of (1, 0)", [&] {
    nearest_component(contour, labels, {1.0, 0.0}, {1.0, 0.0});
  });
  expect_error(ErrorCode::InvalidArgument, "labels for 0 vertices", [&] {
    nearest_component(contour, ComponentLabels(), {1.0, 0.0});
  });
}

TEST(Components, AttributeHasTheLabels) {
  auto contour = noise_contour<3>(8, 3, false);
  contour.vertices.push_back({0, 0, 0});  // in no simplex
  const ComponentLabels labels = label_components(contour);
  EXPECT_EQ(labels.vertices.back(), kNoComponent);
  contour = add_component_attribute(std::move(contour), labels);
  contour = add_component_attribute(std::move(contour), labels);  // does not add it twice
  ASSERT_EQ(contour.vertex_attributes.size(), 1u);
  ASSERT_EQ(contour.simplex_attributes.size(), 1u);
  EXPECT_EQ(contour.vertex_attributes[0].name, "component");
  EXPECT_EQ(contour.vertex_attributes[0].values.back(), -1);
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    ASSERT_EQ(contour.simplex_attributes[0].values[s], labels.simplices[s]);
}

TEST(Components, OfNothingAreNone) {
  const Contour<4, float> nothing;
  const ComponentLabels labels = label_components(nothing);
  EXPECT_EQ(labels.count, 0u);
  EXPECT_TRUE(components(nothing, labels).empty());
  EXPECT_TRUE(split_components(nothing, labels).empty());
}

TEST(Components, RepeatingAVertexConnectAllTheSame) {
  Contour<3, double> contour;
  contour.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  contour.simplices = {{0, 0, 2}};
  const ComponentLabels labels = label_components(contour);
  EXPECT_EQ(labels.count, 1u);
  EXPECT_EQ(labels.vertices[2], 0u);
  EXPECT_EQ(labels.vertices[1], kNoComponent);
  EXPECT_EQ(components(contour, labels)[0].size, 0.0);
}

TEST(Components, WrongArgumentsAreNamed) {
  auto contour = noise_contour<3>(6, 1, false);
  const ComponentLabels labels = label_components(contour);
  expect_error(ErrorCode::InvalidArgument, "1 choices of components",
               [&] { select_components(contour, labels, std::vector<bool>(1)); });
  ComponentLabels other = labels;
  other.simplices.pop_back();
  expect_error(ErrorCode::InvalidArgument, "simplices; expected", [&] { components(contour, other); });
  other = labels;
  other.simplices[0] = labels.count;
  expect_error(ErrorCode::InvalidArgument, "simplex 0 has the label", [&] { split_components(contour, other); });
  auto odd = contour;
  odd.vertex_attributes = {Attribute{"p", "", 2, Buffer<double>(3)}};
  expect_error(ErrorCode::InvalidArgument, "attribute 'p'", [&] { split_components(odd, labels); });
  contour.simplices[2][1] = 1u << 30;
  expect_error(ErrorCode::InvalidArgument, "1073741824", [&] { label_components(contour); });
}

TEST(Components, CanBeCancelled) {
  const auto contour = noise_contour<3>(8, 2, false);
  const ComponentLabels labels = label_components(contour);
  const Progress stop = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { label_components(contour, {1, stop}); });
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { components(contour, labels, {2, stop}); });
  double last = 0;
  label_components(contour, {2, [&](double fraction) {
                               EXPECT_GE(fraction, last);
                               last = fraction;
                               return true;
                             }});
  EXPECT_EQ(last, 1.0);
}

}  // namespace
}  // namespace tegl::test
