// SPDX-License-Identifier: BSD-3-Clause
//
// A streamed contour equals the contour in memory: vertices and simplices with equal numbers, for any division into
// parts. Errors on the way reach the caller.
#include "kernel/stream.hpp"

#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "collector.hpp"
#include "fields.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

/// The layers of an image in memory; counts the requests.
template <Value T, int N>
class ImageLayers final : public LayerReader<T, N> {
 public:
  explicit ImageLayers(const OwnedImage<T, N>& image) : image_(image) {
    for (int a = 0; a < N - 1; ++a) size_ *= image.grid.axes[a].size();
  }
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return image_.grid; }
  void read(std::size_t k, T* to) override {
    EXPECT_EQ(k, next_++) << "layers come in order, each once";
    std::copy_n(image_.values.begin() + static_cast<std::ptrdiff_t>(k * size_), size_, to);
  }

 private:
  const OwnedImage<T, N>& image_;
  std::size_t size_ = 1;
  std::size_t next_ = 0;
};

template <int N, class Real>
void expect_equal(const Collector<N, Real>& streamed, const Contour<N, Real>& contour) {
  ASSERT_EQ(streamed.vertices.size(), contour.vertices.size());
  ASSERT_EQ(streamed.simplices.size(), contour.simplices.size());
  ASSERT_EQ(streamed.normals.size(), contour.normals.size());
  for (std::size_t v = 0; v < contour.normals.size(); ++v)
    ASSERT_EQ(std::memcmp(&streamed.normals[v], &contour.normals[v], sizeof(Real) * N), 0) << "normal " << v;
  if (!contour.vertices.empty()) {
    EXPECT_EQ(
        std::memcmp(streamed.vertices.data(), contour.vertices.data(), contour.vertices.size() * sizeof(Real) * N), 0);
  }
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (std::size_t j = 0; j < N; ++j) ASSERT_EQ(streamed.simplices[s][j], contour.simplices[s][j]) << s << ' ' << j;
}

/// Noise with a share of missing samples if the type supports them.
template <Value T, int N>
OwnedImage<T, N> holey_noise(const std::array<std::size_t, N>& sizes, std::uint64_t seed, unsigned missing_percent) {
  if constexpr (std::is_floating_point_v<T>)
    return noise_with_missing<T, N>(Grid<N>::unit(sizes), seed, missing_percent / 100.0);
  else
    return noise<T, N>(sizes, seed);
}

template <class Real, Value T, int N>
std::size_t expect_streamed(const OwnedImage<T, N>& image, const ExtractOptions& options) {
  const auto contour = extract<Real>(image.view(), noise_isovalue<T>(), options);
  std::size_t replaced = 0;
  for (const std::size_t batch : {1, 2, 3, 100}) {
    SCOPED_TRACE(testing::Message() << "slabs at a time: " << batch);
    ImageLayers<T, N> layers(image);
    detail::LayerRing<T, N> ring(layers);
    detail::LayerSource<T, N> source(ring, noise_isovalue<T>(), options.epsilon);
    Collector<N, Real> collector;
    detail::StreamOutput<N, Real> output(collector, options.normals != Normals::none);
    const detail::ExtractPlan plan{
        .max_vertices = ~std::uint64_t{0}, .batch = batch, .keeps_tiles = batch != 2 && batch != 100};
    detail::extract_to<N, Real>(source, image.grid, detail::generated_tables<N>(options), options, plan, output);
    expect_equal(collector, contour);
    EXPECT_EQ(output.size().vertices, contour.vertices.size());
    EXPECT_EQ(output.size().simplices, contour.simplices.size());
    replaced = collector.replaced;
  }
  return replaced;
}

template <class Real, Value T, int N>
void expect_streamed_in_all_ways(const std::array<std::size_t, N>& sizes) {
  std::uint64_t seed = 7;
  std::size_t replaced = 0;
  for (const unsigned missing : {0u, 5u, 30u})
    for (const bool close : {false, true})
      for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
        SCOPED_TRACE(testing::Message() << missing << " % missing, close " << close << ", triangulation "
                                        << static_cast<int>(triangulation));
        ExtractOptions options;
        options.close = close;
        options.triangulation = triangulation;
        options.ambiguity = seed % 2 == 0 ? Ambiguity::low : Ambiguity::high;
        options.work.threads = 1 + static_cast<unsigned>(seed % 3);
        options.normals = seed % 4 < 2 ? Normals::differences : Normals::none;
        replaced += expect_streamed<Real>(holey_noise<T, N>(sizes, seed++, missing), options);
      }
  if (std::is_floating_point_v<T> && N > 2) {
    EXPECT_GT(replaced, 0u) << "candidates that span parts were to be tested";
  }
}

TEST(Streamed, IsTheContourInMemoryIn2d) {
  expect_streamed_in_all_ways<float, float, 2>({70, 9});
  expect_streamed_in_all_ways<double, std::uint8_t, 2>({3, 20});
}
TEST(Streamed, IsTheContourInMemoryIn3d) {
  expect_streamed_in_all_ways<float, float, 3>({66, 5, 9});
  expect_streamed_in_all_ways<double, std::int16_t, 3>({9, 8, 7});
}
TEST(Streamed, IsTheContourInMemoryIn4d) {
  expect_streamed_in_all_ways<float, float, 4>({7, 5, 4, 6});
  expect_streamed_in_all_ways<double, double, 4>({4, 4, 4, 5});
}

TEST(Streamed, ThroughThePublicFunction) {
  const auto image = noise<float, 4>({9, 8, 7, 6}, 3);
  const auto contour = extract<float>(image.view(), noise_isovalue<float>());
  ImageLayers<float, 4> layers(image);
  Collector<4, float> collector;
  const auto [size, stats] = extract_streamed<float>(layers, noise_isovalue<float>(), collector);
  expect_equal(collector, contour);
  EXPECT_EQ(size.simplices, contour.simplices.size());
  EXPECT_EQ(stats.tiles, 8u * 7 * 6 * 5);
}

/// Layers in memory of their own: no layer beyond the current ones may be accessed.
TEST(Streamed, HasTheNormalsOfTheWholeImage) {
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.normals = Normals::differences;
    options.close = close;
    const auto image = holey_noise<float, 3>({90, 70, 40}, 11, close ? 0 : 1);
    const auto contour = extract<float>(image.view(), noise_isovalue<float>(), options);
    ASSERT_EQ(contour.normals.size(), contour.vertices.size());
    ImageLayers<float, 3> layers(image);
    Collector<3, float> collector;
    extract_streamed<float>(layers, noise_isovalue<float>(), collector, options);
    expect_equal(collector, contour);
  }
}

TEST(Streamed, NormalsForASinkThatTakesNoneAreAnError) {
  struct Plain final : ContourSink<3, float> {
    void add_vertices(std::span<const Vertex> /*vertices*/) override {}
    void add_simplices(std::span<const Simplex> /*simplices*/) override {}
    void replace_corner(std::uint64_t /*simplex*/, int /*corner*/, std::uint64_t /*vertex*/) override {}
  };
  const auto image = noise<float, 3>(9, 3);
  ImageLayers<float, 3> layers(image);
  Plain sink;
  ExtractOptions options;
  options.normals = Normals::differences;
  try {
    extract_streamed<float>(layers, noise_isovalue<float>(), sink, options);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
  }
}

TEST(Streamed, WithoutTilesIsEmpty) {
  const auto image = noise<float, 3>({9, 1, 7}, 3);
  ImageLayers<float, 3> layers(image);
  Collector<3, float> collector;
  EXPECT_EQ(extract_streamed<float>(layers, noise_isovalue<float>(), collector).size.vertices, 0u);
}

/// Vertex numbers beyond 2^32 without that many vertices: the sink starts at a large number.
TEST(Streamed, NumbersPassTwoToTheThirtyTwo) {
  constexpr std::uint64_t kBefore = (std::uint64_t{1} << 32) - 5;
  Collector<3, float> collector;
  detail::StreamOutput<3, float> output(collector, false);
  const detail::RowShape<3> shape({4, 4, 4});
  const detail::Counter<3> counter(shape, detail::generated_tables<3>({}), nullptr, detail::RankReaders::none);
  const detail::NonmanifoldCollector<3> none(shape, counter);
  const auto write = [&](std::uint64_t first, std::uint64_t end, std::uint64_t first_simplex) {
    const detail::ContourPart part{first, end, first_simplex, first_simplex + 1, 0.5};
    const auto room = output.open(part);
    for (std::uint64_t v = first; v < end; ++v) room.vertices[v - first] = {};
    // As written by the kernel: modulo 2^32.
    room.simplices[0] = {static_cast<Index>(first), static_cast<Index>(end - 2), static_cast<Index>(end - 1)};
    output.close(part, none);
  };
  write(kBefore, kBefore + 3, 0);
  write(kBefore + 3, kBefore + 10, 1);
  ASSERT_EQ(collector.simplices.size(), 2u);
  EXPECT_EQ(collector.simplices[0], (std::array<std::uint64_t, 3>{kBefore, kBefore + 1, kBefore + 2}));
  EXPECT_EQ(collector.simplices[1], (std::array<std::uint64_t, 3>{kBefore + 3, kBefore + 8, kBefore + 9}));
}

TEST(Streamed, ErrorsOfTheReaderReachTheCaller) {
  const auto image = noise<float, 3>({9, 9, 30}, 3);
  FunctionLayers<float, 3> layers(image.grid, [&](std::size_t k, float* to) {
    if (k == 17) throw Error(ErrorCode::MalformedFile, "layer 17 cannot be read");
    std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(81 * k), 81, to);
  });
  Collector<3, float> collector;
  EXPECT_THROW(extract_streamed<float>(layers, noise_isovalue<float>(), collector), Error);
}

TEST(Streamed, CanBeCancelled) {
  const auto image = noise<float, 3>({300, 300, 9}, 3);
  ImageLayers<float, 3> layers(image);
  Collector<3, float> collector;
  ExtractOptions options;
  int calls = 0;
  options.work.progress = [&](double) { return ++calls < 4; };
  try {
    extract_streamed<float>(layers, noise_isovalue<float>(), collector, options);
    FAIL() << "was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
  EXPECT_EQ(calls, 4) << "asked once a slab";
}

}  // namespace
}  // namespace tegl::test
