// SPDX-License-Identifier: BSD-3-Clause
//
// Inconsistent contours and labels, as files and callers may supply them: every function that takes one refuses it,
// without reading out of bounds.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "errors.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/elements.hpp"
#include "tegl/measure.hpp"
#include "tegl/normals.hpp"
#include "tegl/project.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"

namespace tegl::test {
namespace {

using Any = Contour<4, float>;

/// A tetrahedron, and a vertex in no simplex.
Any tetrahedron() {
  Any contour;
  contour.vertices = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}, {5, 5, 5, 5}};
  contour.simplices = {{0, 1, 2, 3}};
  return contour;
}

ComponentLabels no_labels() { return {}; }

SimplifyOptions<4> to_half() {
  SimplifyOptions<4> options;
  options.ratio = 0.5;
  return options;
}

using Calls = std::vector<std::pair<std::string, std::function<void(const Any&)>>>;

/// Functions that convert one contour to another and copy normals and attributes, with `others` in addition.
Calls all_that_make_contours(Calls others) {
  static const std::vector<Hyperplane<4>> hyperplanes = {Hyperplane<4>::across(3, 0.5)};
  const Calls calls = {
      {"slice", [](const Any& c) { slice(c, Hyperplane<4>::across(3, 0.5)); }},
      {"slice by a hyperplane", [](const Any& c) { slice(c, Hyperplane<4>::across(1, 0.5)); }},
      {"slice_stack", [](const Any& c) { slice_stack(c, hyperplanes); }},
      {"Scrubber", [](const Any& c) { const Scrubber<4, float> scrubber(c); }},
      {"project", [](const Any& c) { project(c); }},
      {"outline", [](const Any& c) { outline(c); }},
      {"simplify", [](const Any& c) { simplify(c, to_half()); }},
  };
  others.insert(others.end(), calls.begin(), calls.end());
  return others;
}

/// Functions that look up vertices by number.
Calls all_that_follow_vertices() {
  static const std::vector<double> at = {0.5};
  return all_that_make_contours({
      {"label_components", [](const Any& c) { label_components(c); }},
      {"components", [](const Any& c) { components(c, no_labels()); }},
      {"split_components", [](const Any& c) { split_components(c, no_labels()); }},
      {"select_components", [](const Any& c) { select_components(c, no_labels(), {}); }},
      {"measure", [](const Any& c) { tegl::measure(c); }},
      {"measure_cuts", [](const Any& c) { measure_cuts(c, at); }},
      {"elements", [](const Any& c) { elements(c); }},
      {"elements_by_cell",
       [](const Any& c) {
         elements_by_cell(c, Grid<4>::unit({9, 9, 9, 9}));
       }},
      {"flat_normals", [](const Any& c) { flat_normals(c); }},
      {"geometric_normals", [](const Any& c) { geometric_normals(c); }},
      {"deviation from", [](const Any& c) { deviation(c, tetrahedron()); }},
      {"deviation to", [](const Any& c) { deviation(tetrahedron(), c); }},
      {"deviation of nothing", [](const Any& c) { deviation(Any(), c); }},
      {"track", [](const Any& c) { track(c); }},
  });
}

/// Functions that copy normals and attributes.
Calls all_that_carry_attributes() {
  return all_that_make_contours({
      {"split_components", [](const Any& c) { split_components(c, label_components(c)); }},
      {"select_components", [](const Any& c) { select_components(c, label_components(c), {true}); }},
      {"add_component_attribute", [](const Any& c) { (void)add_component_attribute(c, label_components(c)); }},
      {"elements", [](const Any& c) { elements(c); }},
  });
}

TEST(UnsoundContours, VertexNumbersOutOfRangeAreRefused) {
  for (const Index number : {Index{5}, Index{100000000}, std::numeric_limits<Index>::max()}) {
    Any contour = tetrahedron();
    contour.simplices[0][2] = number;
    for (const auto& [name, call] : all_that_follow_vertices()) {
      SCOPED_TRACE(name);
      expect_error(ErrorCode::InvalidArgument,
                   "simplex 0 has vertex number " + std::to_string(number) + "; expected less than 5",
                   [&call = call, &contour] { call(contour); });
    }
  }
}

TEST(UnsoundContours, NormalsAndAttributesOfAnotherNumberAreRefused) {
  for (const auto& [name, call] : all_that_carry_attributes()) {
    SCOPED_TRACE(name);
    const auto expect_refusal = [&call = call](const std::string& message, const std::function<void(Any&)>& spoil) {
      Any contour = tetrahedron();
      spoil(contour);
      expect_error(ErrorCode::InvalidArgument, message, [&] { call(contour); });
    };
    expect_refusal("attribute 'a' has 1 values of width 3; expected 5 vertices", [](Any& c) {
      c.vertex_attributes.push_back({"a", "", 3, {1.0}});
    });
    expect_refusal("attribute 'a' has 0 values of width 0", [](Any& c) {
      c.vertex_attributes.push_back({"a", "", 0, {}});
    });
    expect_refusal("attribute 'b' has 5 values of width 2; expected 1 simplices", [](Any& c) {
      c.simplex_attributes.push_back({"b", "", 2, {1.0, 2.0, 3.0, 4.0, 5.0}});
    });
    expect_refusal("1 normals for 5 vertices", [](Any& c) { c.normals.push_back({1, 0, 0, 0}); });
  }
}

TEST(UnsoundLabels, AreRefused) {
  const Any contour = tetrahedron();
  const auto expect_refusal = [&](const std::string& message, const std::function<void(ComponentLabels&)>& spoil) {
    ComponentLabels labels = label_components(contour);
    spoil(labels);
    const std::vector<bool> keep(labels.count < 9 ? labels.count : 1, true);
    expect_error(ErrorCode::InvalidArgument, message, [&] { components(contour, labels); });
    expect_error(ErrorCode::InvalidArgument, message, [&] { split_components(contour, labels); });
    expect_error(ErrorCode::InvalidArgument, message, [&] { select_components(contour, labels, keep); });
    expect_error(ErrorCode::InvalidArgument, message, [&] { (void)add_component_attribute(contour, labels); });
  };
  expect_refusal("vertex 4 in no simplex has the label 100000000", [](auto& l) { l.vertices[4] = 100000000; });
  expect_refusal("vertex 4 in no simplex has the label 0", [](auto& l) { l.vertices[4] = 0; });
  expect_refusal("its vertex 1 the label", [](auto& l) { l.vertices[1] = kNoComponent; });
  expect_refusal("simplex 0 has the label 7; expected less than 1", [](auto& l) { l.simplices[0] = 7; });
  expect_refusal("3 components of 1 simplices", [](auto& l) { l.count = 3; });
  expect_refusal("4294967295 components", [](auto& l) { l.count = kNoComponent; });
  expect_refusal("simplex 0 has the label 0; expected less than 0", [](auto& l) { l.count = 0; });
  expect_refusal("labels for 4 vertices; expected 5", [](auto& l) { l.vertices.pop_back(); });
  expect_refusal("labels for 0 simplices; expected 1", [](auto& l) { l.simplices.clear(); });
}

TEST(UnsoundContours, CoordinatesThatAreNotFiniteAreRefused) {
  static const std::vector<double> at = {0.5};
  for (const float x : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Any contour = tetrahedron();
    contour.vertices[2][1] = x;
    const auto refuses = [&](const auto& work) {
      expect_error(ErrorCode::InvalidArgument, "a coordinate of vertex 2 is", work);
    };
    refuses([&] { components(contour, label_components(contour)); });
    refuses([&] { tegl::measure(contour); });
    refuses([&] { measure_cuts(contour, at); });
    refuses([&] { elements(contour); });
    refuses([&] { track(contour); });
    refuses([&] { deviation(contour, tetrahedron()); });
    refuses([&] { deviation(tetrahedron(), contour); });
    for (const auto& [name, call] : all_that_make_contours({})) {
      SCOPED_TRACE(name);
      refuses([&call = call, &contour] { call(contour); });
    }
  }
}

TEST(UnsoundLabels, OfAComponentWithoutSimplicesAreRefused) {
  Any contour = tetrahedron();
  contour.simplices.push_back({0, 1, 3, 2});
  ComponentLabels labels = label_components(contour);
  labels.count = 2;
  expect_error(ErrorCode::InvalidArgument, "component 1 of 2 has no simplex", [&] { components(contour, labels); });
}

}  // namespace
}  // namespace tegl::test
