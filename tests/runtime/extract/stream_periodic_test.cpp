// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed contours of images with periodic axes equal those in memory up to the numbers of vertices, for any division
// into parts. The memory that the seam takes is bounded by layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "collector.hpp"
#include "errors.hpp"
#include "extract/streamed_image.hpp"
#include "torus.hpp"

namespace tegl::test {
namespace {

/// Layers of an image in memory that record the order of requests.
template <int N>
class TorusLayers final : public LayerReader<float, N> {
 public:
  explicit TorusLayers(const OwnedImage<float, N>& image) : image_(image) {
    for (int a = 0; a < N - 1; ++a) size_ *= image.grid.axes[a].size();
  }
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return image_.grid; }
  void read(std::size_t k, float* to) override {
    requests.push_back(k);
    std::copy_n(image_.values.begin() + static_cast<std::ptrdiff_t>(k * size_), size_, to);
  }
  std::vector<std::size_t> requests;

 private:
  const OwnedImage<float, N>& image_;
  std::size_t size_ = 1;
};

/// The streamed contour as one in memory.
template <int N>
Contour<N, double> collected(Collector<N, double>&& sink, const Grid<N>& grid, const AxisPeriods<N>& periods) {
  Contour<N, double> contour;
  contour.vertices.assign(sink.vertices.begin(), sink.vertices.end());
  contour.normals.assign(sink.normals.begin(), sink.normals.end());
  for (const auto& simplex : sink.simplices) {
    auto& narrow = contour.simplices.emplace_back();
    for (int j = 0; j < N; ++j) narrow[j] = static_cast<Index>(simplex[j]);
  }
  contour.periods = contour_periods(grid, periods);
  return contour;
}

/// `batch`: slabs at a time; 0: as extract_streamed.
template <int N>
Contour<N, double> streamed(const OwnedImage<float, N>& image, const AxisPeriods<N>& periods, double isovalue,
                            const ExtractOptions& options, std::size_t batch = 0) {
  TorusLayers<N> layers(image);
  Collector<N, double> sink;
  if (batch == 0) {
    const ContourSize size = extract_streamed<double>(layers, isovalue, sink, options, periods).size;
    EXPECT_EQ(size.vertices, sink.vertices.size());
    EXPECT_EQ(size.simplices, sink.simplices.size());
  } else {
    detail::StreamedLayers<float, N, double> parts(layers, periods, options);
    const auto samples = parts.samples(isovalue);
    const auto output = parts.output(sink);
    detail::ExtractPlan plan = parts.plan();
    plan.batch = batch;
    detail::extract_to<N, double>(*samples, parts.grid(), detail::generated_tables<N>(options), options, plan, *output);
  }
  const std::set<std::size_t> different(layers.requests.begin(), layers.requests.end());
  EXPECT_EQ(different.size(), layers.requests.size()) << "a layer was read twice";
  return collected<N>(std::move(sink), image.grid, periods);
}

/// The simplices by the places of their corners; equal contours have equal ones.
template <int N>
std::multiset<std::array<std::array<double, N>, N>> by_places(const Contour<N, double>& contour) {
  std::multiset<std::array<std::array<double, N>, N>> result;
  for (const auto& simplex : contour.simplices) {
    std::array<std::array<double, N>, N> places;
    for (int j = 0; j < N; ++j) places[j] = contour.vertices[simplex[j]];
    result.insert(places);
  }
  return result;
}

/// Expects the same simplices in the same order, with one renumbering of all vertices.
template <int N>
void expect_renumbered(const Contour<N, double>& streamed, const Contour<N, double>& contour) {
  ASSERT_EQ(streamed.vertices.size(), contour.vertices.size());
  ASSERT_EQ(streamed.simplices.size(), contour.simplices.size());
  ASSERT_EQ(streamed.normals.size(), contour.normals.size());
  EXPECT_EQ(streamed.periods, contour.periods);
  constexpr Index kNone = ~Index{0};
  std::vector<Index> numbers(contour.vertices.size(), kNone), back(contour.vertices.size(), kNone);
  Index next = 0;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (int j = 0; j < N; ++j) {
      const Index v = contour.simplices[s][j], w = streamed.simplices[s][j];
      ASSERT_LT(w, numbers.size());
      if (numbers[v] == kNone && back[w] == kNone) {
        numbers[v] = w;
        back[w] = v;
        ++next;
        ASSERT_EQ(streamed.vertices[w], contour.vertices[v]) << "vertex " << v;
        if (!contour.normals.empty()) {
          ASSERT_EQ(streamed.normals[w], contour.normals[v]) << "normal " << v;
        }
      }
      ASSERT_EQ(numbers[v], w) << "simplex " << s;
      ASSERT_EQ(back[w], v) << "simplex " << s;
    }
  EXPECT_EQ(next, contour.vertices.size()) << "unused vertices";
}

template <int N>
OwnedImage<float, N> torus_noise(const std::array<std::size_t, N>& sizes, unsigned seed, double missing) {
  auto image = torus_image<N>(sizes, noise_of<N>(seed));
  std::mt19937 random(seed);
  for (float& value : image.values)
    if (std::uniform_real_distribution<double>()(random) < missing) value = std::numeric_limits<float>::quiet_NaN();
  return image;
}

template <int N>
void expect_streamed(const std::array<std::size_t, N>& sizes) {
  unsigned seed = 1;
  for (unsigned axes = 1; axes < 1u << N; ++axes)
    for (const Ambiguity ambiguity :
         {Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::decider, Ambiguity::saddle}) {
      ExtractOptions options;
      options.ambiguity = ambiguity;
      options.close = seed % 3 == 0;
      options.normals = seed % 2 == 0 ? Normals::differences : Normals::none;
      options.triangulation = seed % 4 < 2 ? Triangulation::compact : Triangulation::barycentric;
      options.work.threads = 1 + seed % 3;
      const std::size_t batch = std::array<std::size_t, 4>{0, 1, 2, 3}[seed % 4];
      SCOPED_TRACE(testing::Message() << N << "D, axes " << axes << ", seed " << seed
                                      << ", slabs at a time: " << batch);
      const auto image = torus_noise<N>(sizes, seed++, 0.0);
      const AxisPeriods<N> periods = periodic_along<N>(axes);
      expect_renumbered<N>(streamed<N>(image, periods, 0.1, options, batch),
                           extract_periodic<double>(image.view(), periods, 0.1, options));
    }
}

TEST(StreamedPeriodic, IsTheContourInMemoryRenumbered) {
  expect_streamed<2>({70, 9});
  expect_streamed<3>({66, 4, 7});
  expect_streamed<3>({5, 6, 3});
  expect_streamed<4>({4, 3, 5, 6});
}

template <int N>
void expect_streamed_beside_missing(const std::array<std::size_t, N>& sizes) {
  unsigned seed = 1;
  for (const double missing : {0.01, 0.03, 0.15})
    for (unsigned axes = 1; axes < 1u << N; ++axes)
      for (const std::size_t batch : {1, 2, 100}) {
        ExtractOptions options;
        options.close = seed % 2 == 0;
        options.normals = seed % 3 == 0 ? Normals::differences : Normals::none;
        SCOPED_TRACE(testing::Message() << N << "D, axes " << axes << ", seed " << seed << ", batch " << batch);
        const auto image = torus_noise<N>(sizes, seed++, missing);
        const AxisPeriods<N> periods = periodic_along<N>(axes);
        const auto contour = streamed<N>(image, periods, 0.0, options, batch);
        const auto in_memory = extract_periodic<double>(image.view(), periods, 0.0, options);
        const MeshReport report = check(contour);
        EXPECT_TRUE(is_manifold(report));
        EXPECT_EQ(report.unused_vertices, 0u);
        EXPECT_EQ(contour.vertices.size(), in_memory.vertices.size());
        EXPECT_EQ(contour.normals.size(), in_memory.normals.size());
        if (N < 4) {
          EXPECT_EQ(by_places<N>(contour), by_places<N>(in_memory));
        }
        EXPECT_EQ(report.components, check(in_memory).components);
        EXPECT_EQ(report.euler, check(in_memory).euler);
      }
}

TEST(StreamedPeriodic, BesideMissingValuesItIsAManifold) {
  expect_streamed_beside_missing<2>({8, 9});
  expect_streamed_beside_missing<3>({5, 4, 6});
  expect_streamed_beside_missing<4>({4, 5, 4, 4});
  expect_streamed_beside_missing<4>({4, 3, 5, 4});
}

TEST(StreamedPeriodic, HasTheEulerCharacteristicsOfTori) {
  const auto image = torus_image<3>({21, 20, 23}, gyroid);
  const auto cell = streamed<3>(image, all_periodic<3>(), 0.0, {}, 2);
  EXPECT_TRUE(is_closed(check(cell)));
  EXPECT_EQ(check(cell).euler, -8);
  const auto tube =
      torus_image<3>({12, 20, 20}, [](const auto& x) { return 0.3 - std::hypot(x[0] - 0.5, x[1] - 0.5); });
  const auto torus = streamed<3>(tube, {0.0, 0.0, 1.0}, 0.0, {});
  EXPECT_TRUE(is_closed(check(torus)));
  EXPECT_EQ(check(torus).euler, 0);
}

TEST(StreamedPeriodic, SeveralGiveEachContour) {
  const auto image = torus_noise<3>({9, 8, 40}, 5, 0.02);
  const std::array<double, 3> isovalues = {-0.2, 0.0, 0.3};
  ExtractOptions options;
  options.normals = Normals::differences;
  options.close = true;
  for (const AxisPeriods<3>& periods : {AxisPeriods<3>{1.0, 1.0, 1.0}, AxisPeriods<3>{0.0, 1.0, 0.0}}) {
    TorusLayers<3> layers(image);
    std::array<Collector<3, double>, 3> sinks;
    std::vector<StreamedContour<3, double>> contours;
    for (std::size_t i = 0; i < 3; ++i) contours.push_back({isovalues[i], &sinks[i]});
    const auto extracted = extract_streamed_several<double>(layers, contours, options, periods);
    EXPECT_EQ(layers.requests.size(), 40u);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto alone = streamed<3>(image, periods, isovalues[i], options);
      const auto one = collected<3>(std::move(sinks[i]), image.grid, periods);
      EXPECT_EQ(one.vertices, alone.vertices);
      EXPECT_EQ(one.normals, alone.normals);
      EXPECT_EQ(one.simplices, alone.simplices);
      EXPECT_EQ(extracted[i].size.simplices, alone.simplices.size());
    }
  }
}

TEST(StreamedPeriodic, RequestsTheLastLayerFirstOnlyForNormals) {
  const auto image = torus_image<2>({6, 5}, noise_of<2>(3));
  const auto requests = [&](Normals normals, const AxisPeriods<2>& periods) {
    TorusLayers<2> layers(image);
    Collector<2, double> sink;
    ExtractOptions options;
    options.normals = normals;
    extract_streamed<double>(layers, 0.0, sink, options, periods);
    return layers.requests;
  };
  using Order = std::vector<std::size_t>;
  EXPECT_EQ(requests(Normals::none, {1.0, 1.0}), (Order{0, 1, 2, 3, 4}));
  EXPECT_EQ(requests(Normals::differences, {1.0, 0.0}), (Order{0, 1, 2, 3, 4}));
  EXPECT_EQ(requests(Normals::differences, {0.0, 1.0}), (Order{4, 0, 1, 2, 3}));
}

TEST(StreamedPeriodic, BadPeriodsAreRefused) {
  const auto image = torus_image<2>({6, 5}, noise_of<2>(3));
  TorusLayers<2> layers(image);
  Collector<2, double> sink;
  for (const double period : {-1.0, 0.5, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(extract_streamed<double>(layers, 0.0, sink, {}, {period, 0.0}), Error);
  expect_error(ErrorCode::InvalidArgument, "the period of axis 1 (y) is 1.7, and the step across the seam, from 0.8",
               [&] {
                 extract_streamed<double>(layers, 0.0, sink, {}, {0.0, 1.7});
               });
  ExtractOptions custom;
  custom.ambiguity = Ambiguity::custom;
  EXPECT_THROW(extract_streamed<double>(layers, 0.0, sink, custom, {1.0, 0.0}), Error);
}

}  // namespace
}  // namespace tegl::test
