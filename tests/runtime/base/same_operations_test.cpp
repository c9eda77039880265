// SPDX-License-Identifier: BSD-3-Clause
//
// The results of operations on contours, and of the search for seeds, do not depend on the number of threads: equal
// bytes for 1 to 4 threads.
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include <gmock/gmock.h>

#include "fields.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/elements.hpp"
#include "tegl/extract.hpp"
#include "tegl/incidence.hpp"
#include "tegl/measure.hpp"
#include "tegl/project.hpp"
#include "tegl/sample.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/seed_set.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"

namespace tegl::test {
namespace {

/// The bytes of results, in a row.
class Bytes {
 public:
  /// Numbers, and arrays of them. No structures: these may have bytes without meaning.
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T number) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(number);
    all_.insert(all_.end(), bytes.begin(), bytes.end());
  }
  template <class T, std::size_t Size>
  void add(const std::array<T, Size>& row) {
    for (const T& item : row) add(item);
  }
  template <class T>
  void add(const std::optional<T>& item) {
    add(item.has_value());
    if (item) add(*item);
  }
  void add(const Attribute& attribute) { add_all(attribute.values); }
  template <class Rows>
  void add_all(const Rows& rows) {
    add(rows.size());
    for (const auto& row : rows) add(row);
  }
  template <int N, class Real>
  void add(const Contour<N, Real>& contour) {
    add_all(contour.vertices);
    add_all(contour.simplices);
    add_all(contour.normals);
    add_all(contour.vertex_attributes);
    add_all(contour.simplex_attributes);
  }
  template <int N>
  void add(const Elements<N>& elements) {
    add_all(elements.centroids);
    add_all(elements.normals);
    add_all(elements.measures);
    add_all(elements.counts);
    add_all(elements.attributes);
  }
  bool operator==(const Bytes&) const = default;
  [[nodiscard]] std::size_t size() const { return all_.size(); }

 private:
  std::vector<char> all_;
};

/// Calls make(bytes, work) with 1 to 4 threads and with all of the machine.
template <class Make>
void expect_same_bytes(const char* what, const Make& make) {
  Bytes expected;
  make(expected, WorkOptions{1, {}});
  EXPECT_GT(expected.size(), 64u) << what;
  for (const unsigned threads : {2u, 3u, 4u, 0u}) {
    Bytes found;
    make(found, WorkOptions{threads, {}});
    EXPECT_TRUE(found == expected) << what << ": " << threads << " threads";
  }
}

/// Large enough for several blocks of each loop; open at the border, with normals and attributes.
template <int N>
const Contour<N, double>& contour_of_noise() {
  static const Contour<N, double> contour = [] {
    const auto image = noise<float, N>(N == 4 ? 14 : N == 3 ? 40 : 300, 5);
    ExtractOptions options;
    options.normals = Normals::differences;
    options.work.threads = 1;
    Contour<N, double> result = extract<double>(image.view(), 0.6, options);
    Attribute& attribute = result.vertex_attributes.emplace_back(Attribute{"number", "", 1, {}});
    for (std::size_t v = 0; v < result.vertices.size(); ++v) attribute.values.push_back(static_cast<double>(v % 101));
    return result;
  }();
  return contour;
}

void add_report(Bytes& bytes, const MeshReport& report) {
  for (const auto count :
       {&MeshReport::vertices, &MeshReport::unused_vertices, &MeshReport::simplices, &MeshReport::components,
        &MeshReport::boundary_simplices, &MeshReport::nonmanifold_simplices, &MeshReport::bad_links,
        &MeshReport::orientation_conflicts, &MeshReport::degenerate_simplices})
    bytes.add(report.*count);
  bytes.add(report.euler);
}

template <int N>
void add_components(Bytes& bytes, const std::vector<Component<N>>& all) {
  for (const Component<N>& component : all) {
    bytes.add(component.vertices);
    bytes.add(component.simplices);
    bytes.add(component.size);
    bytes.add(component.content);
    bytes.add(component.centroid);
    bytes.add(component.lowest);
    bytes.add(component.highest);
    bytes.add(component.euler);
    bytes.add(component.boundary_simplices);
  }
}

template <int N>
void add_measures(Bytes& bytes, const Measures<N>& all) {
  bytes.add(all.size);
  bytes.add(all.content);
  bytes.add(all.centroid);
  bytes.add(all.lowest);
  bytes.add(all.highest);
  bytes.add(all.boundary_simplices);
  bytes.add(all.open_simplices);
}

void add_graph(Bytes& bytes, const TrackGraph& graph) {
  for (const TrackEvent& event : graph.events) {
    bytes.add(event.time);
    bytes.add(event.vertex);
    bytes.add(event.euler_change);
    bytes.add(static_cast<int>(event.kind));
    bytes.add_all(event.in);
    bytes.add_all(event.out);
  }
  for (const TrackSegment& segment : graph.segments) {
    bytes.add(segment.track);
    bytes.add(segment.size_at_start);
    bytes.add(segment.size_at_end);
    bytes.add(segment.euler_at_start);
    bytes.add(segment.euler_at_end);
    for (const TrackSample& sample : segment.samples) {
      bytes.add(sample.measure);
      bytes.add(sample.content);
      bytes.add(sample.centroid);
    }
  }
  for (const TrackHandle& handle : graph.handles) bytes.add(handle.vertex);
  bytes.add_all(graph.simplex_segments);
}

template <class T>
class SameOperations : public testing::Test {};
using OperationDimensions =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SameOperations, OperationDimensions);

TYPED_TEST(SameOperations, OfCheckComponentsMeasuresAndElements) {
  constexpr int N = TypeParam::value;
  const Contour<N, double>& contour = contour_of_noise<N>();
  expect_same_bytes("check", [&](Bytes& bytes, const WorkOptions& work) { add_report(bytes, check(contour, work)); });
  expect_same_bytes("components", [&](Bytes& bytes, const WorkOptions& work) {
    const ComponentLabels labels = label_components(contour, work);
    bytes.add_all(labels.vertices);
    bytes.add_all(labels.simplices);
    add_components(bytes, components(contour, labels, work));
  });
  expect_same_bytes("measure",
                    [&](Bytes& bytes, const WorkOptions& work) { add_measures(bytes, measure(contour, work)); });
  expect_same_bytes("elements", [&](Bytes& bytes, const WorkOptions& work) { bytes.add(elements(contour, work)); });
  expect_same_bytes("elements_by_cell", [&](Bytes& bytes, const WorkOptions& work) {
    std::array<std::size_t, N> sizes;
    sizes.fill(N == 4 ? 14 : N == 3 ? 40 : 300);
    bytes.add(elements_by_cell(contour, Grid<N>::unit(sizes), work));
  });
}

TYPED_TEST(SameOperations, OfValuesAtVertices) {
  constexpr int N = TypeParam::value;
  const Contour<N, double>& contour = contour_of_noise<N>();
  const auto image = noise<float, N>(N == 4 ? 14 : N == 3 ? 40 : 300, 6);
  expect_same_bytes("sample", [&](Bytes& bytes, const WorkOptions& work) {
    bytes.add(sample(image.view(), contour, "value", "", work));
  });
}

TYPED_TEST(SameOperations, OfTracks) {
  constexpr int N = TypeParam::value;
  const Contour<N, double>& contour = contour_of_noise<N>();
  expect_same_bytes("track", [&](Bytes& bytes, const WorkOptions& work) {
    TrackOptions options;
    options.times = even_times(0.0, 13.0, 7);
    options.label_simplices = true;
    options.work = work;
    add_graph(bytes, track(contour, options));
  });
}

TYPED_TEST(SameOperations, OfAnIncidenceAndThoseThatTakeIt) {
  constexpr int N = TypeParam::value;
  const Contour<N, double>& contour = contour_of_noise<N>();
  const auto add_all = [&](Bytes& bytes, const WorkOptions& work, const auto&... incidence) {
    const ComponentLabels labels = label_components(contour, work);
    add_report(bytes, check(contour, incidence..., work));
    add_components<N>(bytes, components(contour, labels, incidence..., work));
    add_measures<N>(bytes, measure(contour, incidence..., work));
    TrackOptions options;
    options.times = even_times(0.0, 13.0, 7);
    options.label_simplices = true;
    options.work = work;
    add_graph(bytes, track(contour, incidence..., options));
    if constexpr (N == 4) bytes.add(outline(contour, incidence..., Projection{}, work));
  };
  Bytes without;
  add_all(without, {1, {}});
  for (const unsigned threads : {1u, 2u, 4u}) {
    Bytes with;
    add_all(with, {threads, {}}, Incidence<N>(contour, {threads, {}}));
    EXPECT_TRUE(with == without) << threads << " threads";
  }
  expect_same_bytes("Incidence", [&](Bytes& bytes, const WorkOptions& work) {
    const Incidence<N> incidence(contour, work);
    EXPECT_TRUE(incidence.fits(contour));
    for (Index v = 0; v < incidence.vertex_count(); ++v) bytes.add_all(incidence.around(v));
    for (Index s = 0; s < incidence.simplex_count(); ++s) bytes.add(incidence.across(s));
  });
}

TYPED_TEST(SameOperations, RefuseTheIncidenceOfAnotherContour) {
  constexpr int N = TypeParam::value;
  const Contour<N, double>& contour = contour_of_noise<N>();
  const auto expect_refused = [&](const Contour<N, double>& other) {
    const Incidence<N> incidence(contour);
    EXPECT_FALSE(incidence.fits(other));
    const ComponentLabels labels = label_components(other);
    const auto is_refused = [](const auto& call) {
      try {
        call();
      } catch (const Error& error) {
        return error.code() == ErrorCode::InvalidArgument &&
               std::string_view(error.what()).find("incidence") != std::string_view::npos;
      }
      return false;
    };
    EXPECT_TRUE(is_refused([&] { (void)check(other, incidence); }));
    EXPECT_TRUE(is_refused([&] { (void)components(other, labels, incidence); }));
    EXPECT_TRUE(is_refused([&] { (void)measure(other, incidence); }));
    EXPECT_TRUE(is_refused([&] { (void)track(other, incidence); }));
    if constexpr (N == 4) {
      EXPECT_TRUE(is_refused([&] { (void)outline(other, incidence); }));
    }
  };
  Contour<N, double> other = contour;
  std::swap(other.simplices[0], other.simplices[1]);
  expect_refused(other);
  other = contour;
  other.simplices.pop_back();
  expect_refused(other);
  other = contour;
  other.vertices.push_back(other.vertices.back());
  other.normals.push_back(other.normals.back());
  other.vertex_attributes[0].values.push_back(0.0);
  expect_refused(other);
}

TYPED_TEST(SameOperations, OfSimplificationAndDeviation) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(N == 4 ? 4 : N == 3 ? 8 : 60, 5);
  const Contour<N, double> contour = extract<double>(image.view(), 0.6);
  expect_same_bytes("simplify", [&](Bytes& bytes, const WorkOptions& work) {
    SimplifyOptions<N> options;
    options.ratio = 0.7;
    options.work = work;
    const Contour<N, double> simple = simplify(contour, options).contour;
    bytes.add(simple);
    DeviationOptions<N> measuring;
    measuring.work = work;
    const Deviation from = deviation(contour, simple, measuring);
    bytes.add(from.bound);
    bytes.add(from.least);
    bytes.add_all(from.of_from);
    bytes.add_all(from.of_to);
  });
}

template <int N>
void expect_same_cuts() {
  const Contour<N, double>& contour = contour_of_noise<N>();
  Hyperplane<N> oblique;
  oblique.normal.fill(1.0);
  oblique.offset = N == 4 ? 26.0 : 60.0;
  // vertices lie on the third
  const std::vector<Hyperplane<N>> planes = {Hyperplane<N>::across(N - 1, 5.3), oblique, Hyperplane<N>::across(0, 7.0)};
  expect_same_bytes("slice", [&](Bytes& bytes, const WorkOptions& work) {
    for (const Hyperplane<N>& plane : planes) bytes.add(slice(contour, plane, work));
  });
  expect_same_bytes("slice_stack", [&](Bytes& bytes, const WorkOptions& work) {
    for (const auto& cut : slice_stack(contour, std::span<const Hyperplane<N>>(planes), work)) bytes.add(cut);
  });
  expect_same_bytes("Scrubber", [&](Bytes& bytes, const WorkOptions& work) {
    const Scrubber<N, double> scrubber(contour, planes[0], work);
    for (const double at : {1.5, 5.0, 7.25}) bytes.add(scrubber.cut(at));
  });
  expect_same_bytes("measure_cuts", [&](Bytes& bytes, const WorkOptions& work) {
    for (const CutMeasures& cut : measure_cuts(contour, even_times(0.0, 13.0, 100), work)) {
      bytes.add(cut.size);
      bytes.add(cut.content);
    }
  });
}

TEST(SameOperationsOfCuts, In3d) { expect_same_cuts<3>(); }
TEST(SameOperationsOfCuts, In4d) { expect_same_cuts<4>(); }

TEST(SameOperationsOfProjections, In4d) {
  const Contour<4, double>& contour = contour_of_noise<4>();
  Projection projection;
  projection.direction = {0.1, -0.2, 0.3, 1.0};
  projection.eye_distance = 30.0;
  expect_same_bytes("project", [&](Bytes& bytes, const WorkOptions& work) {
    const ProjectedContour<double> seen = project(contour, projection, work);
    bytes.add_all(seen.vertices);
    bytes.add_all(seen.tetrahedra);
    bytes.add_all(seen.vertex_attributes);
    bytes.add_all(seen.simplex_attributes);
  });
  expect_same_bytes("outline",
                    [&](Bytes& bytes, const WorkOptions& work) { bytes.add(outline(contour, projection, work)); });
}

void add_seeds(Bytes& bytes, const SeedSet& set) {
  bytes.add_all(set.tiles);
  bytes.add_all(set.least);
  bytes.add_all(set.greatest);
}

TEST(SameOperationsOfImages, SeedsByAllMethods) {
  const auto image = noise<float, 3>(20, 5);
  for (const SeedMethod method : seed_methods())
    expect_same_bytes("find_seeds", [&](Bytes& bytes, const WorkOptions& work) {
      SeedSetOptions options;
      options.method = method;
      options.work = work;
      add_seeds(bytes, find_seeds(image.view(), options));
    });
}

TEST(SameOperationsOfImages, SeedsOutOfManyTiles) {
  // smooth values, all different: more trees than are covered directly
  auto image = noise<float, 3>(48, 5);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const auto x = static_cast<double>(i % 48), y = static_cast<double>(i / 48 % 48), z = static_cast<double>(i / 2304);
    image.values[i] = static_cast<float>(std::sin(0.2 * x) * std::cos(0.13 * y) + std::sin(0.2 * y + 0.3) +
                                         std::sin(0.2 * z + 0.6) * std::cos(0.13 * x));
  }
  for (const Neighbourhood neighbourhood : {Neighbourhood::faces, Neighbourhood::all})
    expect_same_bytes("find_seeds", [&](Bytes& bytes, const WorkOptions& work) {
      SeedSetOptions options;
      options.neighbourhood = neighbourhood;
      options.work = work;
      const SeedSet set = find_seeds(image.view(), options);
      EXPECT_TRUE(set.stats.reduced);
      add_seeds(bytes, set);
    });
}

}  // namespace
}  // namespace tegl::test
