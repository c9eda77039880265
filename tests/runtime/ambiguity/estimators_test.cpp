// SPDX-License-Identifier: BSD-3-Clause
//
// Ambiguity resolved from the data: the contours of each estimator, on noise of every value type, against tiles built
// one by one; and contours are closed manifolds, equal from every entry point.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "active.hpp"
#include "ambiguity/face_estimator.hpp"
#include "caps.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/active_tiles.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::test {
namespace {

constexpr Ambiguity kEstimated[] = {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider,
                                    Ambiguity::custom};

const char* name_of(Ambiguity ambiguity) {
  constexpr const char* kNames[] = {"low", "high", "mean", "saddle", "squares", "decider", "custom"};
  return kNames[static_cast<int>(ambiguity)];
}

/// Options with this estimator; `custom` decides by the parity of the position and a hash of the values.
ExtractOptions with(Ambiguity ambiguity) {
  ExtractOptions options;
  options.ambiguity = ambiguity;
  if (ambiguity == Ambiguity::custom)
    options.estimator.choose = [](const AmbiguousFace& face) {
      std::size_t hash = face.axes();
      for (const std::size_t i : face.base()) hash = hash * 31 + i;
      return static_cast<tile::Choice>(hash * 2654435761u / 1024 % 3);
    };
  return options;
}

template <int N>
Grid<N> odd_grid(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a)
    grid.axes[a] = Axis::uniform(samples + static_cast<std::size_t>(a % 3), -0.7 * a, 0.5 + 0.25 * a);
  return grid;
}

/// A straightforward mean of a face's corners.
bool has_high_mean(std::span<const double> values, double isovalue) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum >= isovalue * static_cast<double>(values.size());
}

template <int N, class Real>
void expect_same_bytes(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  EXPECT_TRUE(std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end()));
  EXPECT_TRUE(std::equal(a.simplices.begin(), a.simplices.end(), b.simplices.begin(), b.simplices.end()));
  EXPECT_TRUE(std::equal(a.normals.begin(), a.normals.end(), b.normals.begin(), b.normals.end()));
}

/// A straightforward choice by mean, squares or decider, for faces of dimension 2 or more.
tile::Choice simple_choice(Ambiguity ambiguity, std::span<const double> values, double isovalue) {
  if (values.size() > 4 && ambiguity != Ambiguity::mean) return tile::Choice::separate;
  bool is_high = has_high_mean(values, isovalue);
  if (values.size() == 4 && ambiguity == Ambiguity::decider) {
    const double one = (values[0] - isovalue) * (values[3] - isovalue);
    const double other = (values[1] - isovalue) * (values[2] - isovalue);
    is_high = values[0] >= isovalue ? one >= other : other >= one;
  }
  return is_high ? tile::Choice::high : tile::Choice::low;
}

/// The contour built tile by tile by FacetBuilder with simple_choice for every face. Vertices are identified by
/// the face of the grid that contains them and their number there; their positions have no meaning.
template <Value T, int N>
Contour<N, float> by_tiles(const OwnedImage<T, N>& image, double isovalue, Ambiguity ambiguity) {
  tile::FacetBuilder builder(tile::FaceLattice::cube(N));
  const auto& faces = builder.lattice().faces();
  std::map<std::array<std::size_t, N + 2>, Index> numbers;
  Contour<N, float> contour;
  const auto sizes = image.grid.sizes();
  std::vector<tile::Choice> choices(faces.size());
  for_each_sample<N>(image.grid, [&](std::size_t, const std::array<std::size_t, N>& base) {
    for (int a = 0; a < N; ++a)
      if (base[a] + 1 == sizes[a]) return;
    std::array<double, std::size_t{1} << N> values;
    std::uint64_t signature = 0;
    for (unsigned v = 0; v < values.size(); ++v) {
      auto at = base;
      for (int a = 0; a < N; ++a) at[a] += v >> a & 1u;
      values[v] = static_cast<double>(image.view()(at));
      if (values[v] >= isovalue) signature |= std::uint64_t{1} << v;
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      std::vector<double> corners;
      for (std::uint64_t rest = faces[f].corners; rest != 0; rest &= rest - 1)
        corners.push_back(values[static_cast<std::size_t>(std::countr_zero(rest))]);
      choices[f] = simple_choice(ambiguity, corners, isovalue);
    }
    const tile::TileFacets& tile = builder.build(signature, {.choices = choices});
    std::vector<Index> ids(tile.vertices.size());
    for (const tile::Facet& facet : tile.facets)
      for (const tile::Simplex& simplex : facet.simplices) {
        std::array<Index, N> to;
        for (int j = 0; j < N; ++j) {
          const tile::Vertex& vertex = tile.vertices[simplex[j]];
          const std::uint64_t corners = faces[vertex.face].corners;
          const auto least = static_cast<std::size_t>(std::countr_zero(corners));
          std::array<std::size_t, N + 2> name{};
          for (int a = 0; a < N; ++a) name[a] = base[a] + (least >> a & 1u);
          name[N] = least ^ (63u - static_cast<std::size_t>(std::countl_zero(corners)));
          name[N + 1] = vertex.number;
          const auto [found, is_new] = numbers.try_emplace(name, static_cast<Index>(numbers.size()));
          if (is_new) contour.vertices.push_back({});
          to[j] = found->second;
        }
        contour.simplices.push_back(to);
      }
  });
  return contour;
}

/// The layers of an image in memory.
template <Value T, int N>
FunctionLayers<T, N> layers_of(const OwnedImage<T, N>& image) {
  std::size_t size = 1;
  for (int a = 0; a < N - 1; ++a) size *= image.grid.axes[a].size();
  return {image.grid, [&image, size](std::size_t k, T* to) {
            std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(k * size), size, to);
          }};
}

template <int N, class Real>
struct Collector final : ContourSink<N, Real> {
  Contour<N, Real> contour;
  void add_vertices(std::span<const std::array<Real, N>> part) override {
    contour.vertices.insert(contour.vertices.end(), part.begin(), part.end());
  }
  void add_normals(std::span<const std::array<Real, N>> part) override {
    contour.normals.insert(contour.normals.end(), part.begin(), part.end());
  }
  void add_simplices(std::span<const std::array<std::uint64_t, N>> part) override {
    for (const auto& simplex : part) {
      auto& to = contour.simplices.emplace_back();
      for (int j = 0; j < N; ++j) to[j] = static_cast<Index>(simplex[j]);
    }
  }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    contour.simplices[simplex][corner] = static_cast<Index>(vertex);
  }
};

/// Decides by the samples around a face, and counts inconsistent arguments.
template <Value T, int N>
struct Neighbourhood {
  const OwnedImage<T, N>& image;
  std::atomic<std::size_t> wrong = 0, asked = 0;

  Estimator estimator(std::size_t reach) {
    return {[this, reach](const AmbiguousFace& face) { return choose(face, static_cast<std::ptrdiff_t>(reach)); },
            reach};
  }
  tile::Choice choose(const AmbiguousFace& face, std::ptrdiff_t reach) {
    ++asked;
    if (face.image_dim() != N || face.dim() != std::popcount(face.axes()) ||
        face.values().size() != std::size_t{1} << face.dim())
      ++wrong;
    double sum = 0;
    for (int a = 0; a < N; ++a)
      for (const std::ptrdiff_t way : {-reach, reach + static_cast<std::ptrdiff_t>(face.axes() >> a & 1u)}) {
        std::array<std::ptrdiff_t, N> steps{};
        steps[a] = way;
        std::array<std::size_t, N> at;
        for (int b = 0; b < N; ++b)
          at[b] = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
              static_cast<std::ptrdiff_t>(face.base()[static_cast<std::size_t>(b)]) + steps[b], 0,
              static_cast<std::ptrdiff_t>(image.grid.axes[b].size()) - 1));
        const double value = face.sample(steps);
        if (value != static_cast<double>(image.view()(at))) ++wrong;
        sum += value;
      }
    for (std::size_t v = 0; v < face.values().size(); ++v) {
      std::array<std::ptrdiff_t, N> steps{};
      for (int a = 0, bit = 0; a < N; ++a)
        if ((face.axes() >> a & 1u) != 0) steps[a] = static_cast<std::ptrdiff_t>(v >> bit++ & 1u);
      if (face.sample(steps) != face.values()[v]) ++wrong;
    }
    return sum >= face.isovalue() * 2 * N ? tile::Choice::high : tile::Choice::low;
  }
};

}  // namespace

template <class Kind>
class Estimators : public ::testing::Test {};
template <class T, int N>
struct Kind {
  using Value = T;
  static constexpr int kDim = N;
};
using Kinds = ::testing::Types<Kind<std::uint8_t, 2>, Kind<float, 2>, Kind<std::int8_t, 3>, Kind<std::uint16_t, 3>,
                               Kind<std::int16_t, 3>, Kind<std::int32_t, 3>, Kind<float, 3>, Kind<double, 3>,
                               Kind<std::uint8_t, 4>, Kind<float, 4>>;
TYPED_TEST_SUITE(Estimators, Kinds);

TYPED_TEST(Estimators, GiveClosedManifoldsOnNoise) {
  constexpr int N = TypeParam::kDim;
  const auto image = noise<typename TypeParam::Value, N>(odd_grid<N>(N == 2 ? 70 : N == 3 ? 17 : 3), 5);
  for (const Ambiguity ambiguity : kEstimated)
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
      for (const bool close : {false, true}) {
        SCOPED_TRACE(std::string(name_of(ambiguity)) + (close ? ", closed" : "") +
                     (triangulation == Triangulation::compact ? ", compact" : ", barycentric"));
        ExtractOptions options = with(ambiguity);
        options.triangulation = triangulation;
        options.close = close;
        const auto contour = extract(image.view(), noise_isovalue<typename TypeParam::Value>(), options);
        EXPECT_EQ(contour.normals.size(), options.normals != Normals::none ? contour.vertices.size() : 0);
        if (close)
          expect_closed_manifold(contour);
        else
          expect_oriented_manifold(contour);
      }
}

TYPED_TEST(Estimators, DrawWhatTilesWithTheChoicesOfTheRuleAre) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  for (const std::uint64_t seed : {1u, 2u}) {
    const auto image = seed == 1 ? noise<T, N>(odd_grid<N>(N == 2   ? 40
                                                           : N == 3 ? 9
                                                                    : 4),
                                               seed)
                                 : coarse_noise<T, N>(odd_grid<N>(N == 2   ? 40
                                                                  : N == 3 ? 9
                                                                           : 4),
                                                      seed, 4);
    const double isovalue = seed == 1 ? noise_isovalue<T>() : 2.0;
    for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::squares, Ambiguity::decider}) {
      SCOPED_TRACE(name_of(ambiguity));
      const MeshReport expected = check(by_tiles(image, isovalue, ambiguity));
      const MeshReport found = check(extract(image.view(), isovalue, with(ambiguity)));
      EXPECT_EQ(found.euler, expected.euler);
      EXPECT_EQ(found.components, expected.components);
    }
  }
}

TYPED_TEST(Estimators, GiveTheSameBytesFromEveryEntryPoint) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  const auto image = noise<T, N>(odd_grid<N>(N == 2 ? 70 : N == 3 ? 17 : 5), 9);
  const double isovalue = noise_isovalue<T>();
  for (const Ambiguity ambiguity : kEstimated)
    for (const bool close : {false, true}) {
      SCOPED_TRACE(std::string(name_of(ambiguity)) + (close ? ", closed" : ""));
      ExtractOptions options = with(ambiguity);
      options.close = close;
      options.work.threads = 1;
      const auto contour = extract(image.view(), isovalue, options);
      options.work.threads = 4;
      expect_same_bytes(extract(image.view(), isovalue, options), contour);
      const ContourSize size = count(image.view(), isovalue, options);
      EXPECT_EQ(size.vertices, contour.vertices.size());
      EXPECT_EQ(size.simplices, contour.simplices.size());
      Contour<N, float> into;
      into.vertices.resize(size.vertices);
      into.simplices.resize(size.simplices);
      extract_into(image.view(), isovalue, ContourRoom<N, float>{into.vertices, into.simplices}, options);
      expect_same_bytes(into, contour);
      Collector<N, float> collector;
      auto layers = layers_of(image);
      extract_streamed(layers, isovalue, collector, options);
      expect_same_bytes(collector.contour, contour);
      const auto active = build_active_tiles(image.view(), ActiveMethod::interval_tree);
      expect_same_bytes(extract(image.view(), isovalue, *active, options), contour);
      MemoryFile file;
      active->save(file);
      expect_same_bytes(extract(image.view(), isovalue, *load_active_tiles(file, image.view()), options), contour);
      if constexpr (N > 2)
        for (const double at : {0.3, 0.5}) {
          const double where = image.grid.axes[N - 1][1] + at * image.grid.axes[N - 1].step();
          const auto direct = slice_image(image.view(), isovalue, Hyperplane<N>::across(N - 1, where), options);
          expect_same_bytes(direct, slice(contour, Hyperplane<N>::across(N - 1, where)));
        }
    }
}

TYPED_TEST(Estimators, OfTheCallersThatTakeTheMeanGiveItsBytes) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  const auto image = noise<T, N>(odd_grid<N>(N == 2 ? 70 : N == 3 ? 17 : 5), 10);
  ExtractOptions options = with(Ambiguity::custom);
  options.estimator.choose = [](const AmbiguousFace& face) {
    return has_high_mean(face.values(), face.isovalue()) ? tile::Choice::high : tile::Choice::low;
  };
  expect_same_bytes(extract(image.view(), noise_isovalue<T>(), options),
                    extract(image.view(), noise_isovalue<T>(), with(Ambiguity::mean)));
}

TYPED_TEST(Estimators, OfTheCallersSeeWhatIsAroundAFace) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  const auto image = noise<T, N>(odd_grid<N>(N == 2 ? 40 : N == 3 ? 11 : 6), 11);
  const double isovalue = noise_isovalue<T>();
  Neighbourhood<T, N> around{image};
  ExtractOptions options = with(Ambiguity::custom);
  for (const std::size_t reach : {0, 2}) {
    around.asked = around.wrong = 0;
    options.estimator = around.estimator(reach);
    const auto contour = extract(image.view(), isovalue, options);
    expect_oriented_manifold(contour);
    Collector<N, float> collector;
    auto layers = layers_of(image);
    extract_streamed(layers, isovalue, collector, options);
    expect_same_bytes(collector.contour, contour);
    EXPECT_GT(around.asked, 0u);
    EXPECT_EQ(around.wrong, 0u);
    // Estimators see fewer samples around tiles beside the slice, which do not affect it.
    if constexpr (N > 2)
      for (int axis = 0; axis < N; ++axis) {
        const Axis& across = image.grid.axes[axis];
        const double where = across[2] + 0.4 * across.step();
        const auto direct = slice_image(image.view(), isovalue, Hyperplane<N>::across(axis, where), options);
        EXPECT_EQ(direct.simplices.size(), slice(contour, Hyperplane<N>::across(axis, where)).simplices.size());
      }
  }
}

TYPED_TEST(Estimators, CloseContoursUpToMissingValues) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  if constexpr (std::is_floating_point_v<T>) {
    const auto image = noise_with_missing<T, N>(odd_grid<N>(N == 2 ? 14 : N == 3 ? 7 : 4), 33, N == 4 ? 0.01 : 0.05);
    for (const Ambiguity ambiguity : kEstimated) {
      SCOPED_TRACE(name_of(ambiguity));
      expect_closed_up_to_missing_values<double>(image.view(), 0.4, with(ambiguity));
    }
  } else {
    const auto image = coarse_noise<T, N>(odd_grid<N>(N == 2 ? 14 : N == 3 ? 7 : 4), 34, 3);
    for (const Ambiguity ambiguity : kEstimated) {
      SCOPED_TRACE(name_of(ambiguity));
      ExtractOptions options = with(ambiguity);
      options.close = true;
      expect_closed_manifold(extract(image.view(), 1.0, options));
    }
  }
}

TEST(Mean, IsComparedWithTheIsovalueExactly) {
  // The mean differs from the isovalue 1 by 2^-60, which sums of doubles do not resolve, for any order of the corners.
  const double tiny = 0x1p-58;
  for (unsigned turn = 0; turn < 4; ++turn) {
    for (const double sign : {-1.0, 1.0}) {
      std::array<double, 4> corners{1e17, -1e17, sign * tiny, 4.0};
      std::rotate(corners.begin(), corners.begin() + turn, corners.end());
      EXPECT_EQ(detail::is_mean_high(corners, 1.0), sign > 0) << turn;
    }
  }
  EXPECT_TRUE(detail::is_mean_high(std::array<double, 4>{1.0, 0.0, 0.0, 1.0}, 0.5));
  const double huge = std::numeric_limits<double>::max();
  EXPECT_TRUE(detail::is_mean_high(std::array<double, 4>{huge, huge, huge, -huge}, 0.1));
  EXPECT_FALSE(detail::is_mean_high(std::array<double, 4>{huge, -huge, -huge, -huge}, 0.1));
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(detail::is_mean_high(std::array<double, 4>{-infinity, 1.0, 1.0, 1.0}, 0.1));
  EXPECT_TRUE(detail::is_mean_high(std::array<double, 4>{-infinity, 1.0, 1.0, infinity}, 0.1));
}

TEST(EstimatorsOfTheCaller, ThatThrowEndTheExtraction) {
  const auto image = noise<float, 3>(std::size_t{12}, 1);
  ExtractOptions options = with(Ambiguity::custom);
  options.estimator.choose = [](const AmbiguousFace&) -> tile::Choice { throw std::domain_error("no opinion"); };
  for (const unsigned threads : {1u, 4u}) {
    options.work.threads = threads;
    EXPECT_THROW(extract(image.view(), 0.5, options), std::domain_error);
    EXPECT_THROW(count(image.view(), 0.5, options), std::domain_error);
  }
}

/// An estimator whose choice changes with each call, whatever the face.
ExtractOptions with_changing_answers() {
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.work.threads = 1;
  options.estimator.choose = [calls = std::make_shared<std::atomic<std::uint64_t>>(0)](const AmbiguousFace&) {
    return static_cast<tile::Choice>((++*calls * 0x9e3779b97f4a7c15u >> 33) % 3);
  };
  return options;
}

/// All vertex numbers are in range, so nothing was written elsewhere; or the error names the fault. Returns true after
/// an error.
template <Value T, int N>
bool is_found_out(const OwnedImage<T, N>& image, const ExtractOptions& options) {
  try {
    const auto contour = extract<double>(image.view(), 0.5, options);
    for (const auto& simplex : contour.simplices)
      for (const Index v : simplex) EXPECT_LT(v, contour.vertices.size());
    return false;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("gave different results for the same face"), std::string::npos)
        << error.what();
    return true;
  }
}

TEST(EstimatorsOfTheCaller, ThatAnswerDifferentlyForTheSameFaceAreReportedAndOverwriteNothing) {
  int reported = 0;
  for (const bool close : {false, true}) {
    ExtractOptions options = with_changing_answers();
    options.close = close;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      EXPECT_TRUE((is_found_out(noise<float, 4>(std::size_t{6}, seed), options)));
      auto missing = noise<float, 4>(std::size_t{6}, seed);
      missing.values[missing.values.size() / 2] = std::numeric_limits<float>::quiet_NaN();
      EXPECT_TRUE((is_found_out(missing, options)));
      auto missing3 = noise<float, 3>(std::size_t{12}, seed);
      missing3.values[missing3.values.size() / 2] = std::numeric_limits<float>::quiet_NaN();
      EXPECT_TRUE((is_found_out(missing3, options)));
      is_found_out(noise<float, 2>(std::size_t{20}, seed), options);
      is_found_out(noise<float, 3>(std::size_t{12}, seed), options);
    }
    reported += is_found_out(noise<float, 5>(std::size_t{3}, 1), options) ? 1 : 0;
  }
  EXPECT_GT(reported, 0);
}

TEST(EstimatorsOfTheCaller, ThatThrowOnlyWhenAskedAgainReachTheCaller) {
  const auto image = noise<float, 4>(std::size_t{6}, 1);
  ExtractOptions options = with(Ambiguity::custom);
  options.work.threads = 1;
  std::size_t calls = 0;
  options.estimator.choose = [&](const AmbiguousFace&) {
    ++calls;
    return tile::Choice::high;
  };
  count(image.view(), 0.5, options);
  const std::size_t least = calls + calls / 2;
  calls = 0;
  options.estimator.choose = [&](const AmbiguousFace&) {
    if (++calls > least) throw std::domain_error("no opinion");
    return tile::Choice::high;
  };
  EXPECT_THROW(extract(image.view(), 0.5, options), std::domain_error);
}

TEST(EstimatorsOfTheCaller, AreToBeThere) {
  const auto image = noise<float, 3>(std::size_t{4}, 1);
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  expect_error(ErrorCode::InvalidArgument, "estimator", [&] { extract(image.view(), 0.5, options); });
}

TEST(BarycentricContoursOf4dImages, AreTheSameFromEveryEntryPoint) {
  const auto image = noise<float, 4>(std::array<std::size_t, 4>{4, 3, 4, 3}, 12);
  const auto active = build_active_tiles(image.view(), ActiveMethod::interval_tree);
  for (const Ambiguity ambiguity : kEstimated)
    for (const bool close : {false, true}) {
      SCOPED_TRACE(std::string(name_of(ambiguity)) + (close ? ", closed" : ""));
      ExtractOptions options = with(ambiguity);
      options.triangulation = Triangulation::barycentric;
      options.close = close;
      options.work.threads = 1;
      options.normals = Normals::differences;
      const auto contour = extract(image.view(), 0.5, options);
      options.work.threads = 4;
      expect_same_bytes(extract(image.view(), 0.5, options), contour);
      expect_same_bytes(extract(image.view(), 0.5, *active, options), contour);
      const ContourSize size = count(image.view(), 0.5, options);
      EXPECT_EQ(size.vertices, contour.vertices.size());
      EXPECT_EQ(size.simplices, contour.simplices.size());
      Contour<4, float> into;
      into.vertices.resize(size.vertices);
      into.normals.resize(size.vertices);
      into.simplices.resize(size.simplices);
      extract_into(image.view(), 0.5, ContourRoom<4, float>{into.vertices, into.simplices, into.normals}, options);
      expect_same_bytes(into, contour);
      const std::span<std::array<Index, 4>> little(into.simplices.data(), size.simplices - 1);
      expect_error(ErrorCode::InvalidArgument, "tegl::count returns the number", [&] {
        extract_into(image.view(), 0.5, ContourRoom<4, float>{into.vertices, little, into.normals}, options);
      });
      for (int axis = 0; axis < 4; ++axis) {
        const double where = 1.4;
        expect_same_bytes(slice_image(image.view(), 0.5, Hyperplane<4>::across(axis, where), options),
                          slice(contour, Hyperplane<4>::across(axis, where)));
      }
    }
}

TEST(BarycentricContoursOf4dImages, HaveTheTopologyOfCompactOnes) {
  for (const std::uint64_t seed : {13u, 14u}) {
    const auto image = noise<std::uint8_t, 4>(std::array<std::size_t, 4>{3, 4, 3, 4}, seed);
    for (const Ambiguity ambiguity : kEstimated) {
      SCOPED_TRACE(name_of(ambiguity));
      ExtractOptions options = with(ambiguity);
      const MeshReport compact = check(extract(image.view(), 128.0, options));
      options.triangulation = Triangulation::barycentric;
      const MeshReport barycentric = check(extract(image.view(), 128.0, options));
      EXPECT_EQ(barycentric.euler, compact.euler);
      EXPECT_EQ(barycentric.components, compact.components);
    }
  }
}

ExtractOptions barycentric_by(Ambiguity ambiguity, bool close) {
  ExtractOptions options = with(ambiguity);
  options.triangulation = Triangulation::barycentric;
  options.close = close;
  return options;
}

TEST(BarycentricContoursOf4dImages, AreStreamedWithTheSameBytes) {
  for (const double missing : {0.0, 0.02}) {
    const auto image = noise_with_missing<float, 4>(Grid<4>::unit({4, 3, 4, 6}), 15, missing);
    for (const Ambiguity ambiguity : kEstimated)
      for (const bool close : {false, true}) {
        SCOPED_TRACE(std::string(name_of(ambiguity)) + (close ? ", closed" : "") + (missing > 0 ? ", missing" : ""));
        ExtractOptions options = barycentric_by(ambiguity, close);
        options.normals = Normals::differences;
        const auto contour = extract(image.view(), 0.5, options);
        if (missing > 0 || !close)
          expect_oriented_manifold(contour);
        else
          expect_closed_manifold(contour);
        for (const unsigned threads : {1u, 4u}) {
          options.work.threads = threads;
          Collector<4, float> collector;
          auto layers = layers_of(image);
          const ContourSize size = extract_streamed(layers, 0.5, collector, options).size;
          expect_same_bytes(collector.contour, contour);
          EXPECT_EQ(size.vertices, contour.vertices.size());
          EXPECT_EQ(size.simplices, contour.simplices.size());
        }
        const ContourSize size = count(image.view(), 0.5, options);
        EXPECT_EQ(size.vertices, contour.vertices.size());
        EXPECT_EQ(size.simplices, contour.simplices.size());
      }
  }
}

TEST(BarycentricContoursOf4dImages, AreStreamedWithAnEstimatorThatLooksFarther) {
  const auto image = noise<float, 4>(std::array<std::size_t, 4>{4, 3, 4, 7}, 16);
  for (const std::size_t reach : {1, 3}) {
    Neighbourhood<float, 4> around{image};
    ExtractOptions options = barycentric_by(Ambiguity::custom, false);
    options.estimator = around.estimator(reach);
    const auto contour = extract(image.view(), 0.5, options);
    Collector<4, float> collector;
    auto layers = layers_of(image);
    extract_streamed(layers, 0.5, collector, options);
    expect_same_bytes(collector.contour, contour);
    EXPECT_GT(around.asked, 0u);
    EXPECT_EQ(around.wrong, 0u);
  }
}

TEST(BarycentricContoursOf4dImages, HaveTheTopologyOfCompactOnesNextToMissingValuesAndInChosenTiles) {
  for (const std::uint64_t seed : {17u, 18u, 19u}) {
    const auto image = noise_with_missing<float, 4>(Grid<4>::unit({4, 4, 4, 4}), seed, 0.02);
    const auto whole = noise<float, 4>(std::size_t{4}, seed);
    std::vector<TileNumber> tiles;
    for (TileNumber tile = 0; tile < 27 * 3; ++tile)
      if ((tile * 2654435761u >> 7) % 3 != 0) tiles.push_back(tile);
    const auto chosen = choose_tiles(whole.view(), tiles);
    // For images with missing values, only tiles without missing corners.
    std::erase_if(tiles, [&](TileNumber tile) {
      const std::size_t first = tile % 3 + tile / 3 % 3 * 4 + tile / 9 % 3 * 16 + tile / 27 * 64;
      for (unsigned v = 0; v < 16; ++v)
        if (std::isnan(image.values[first + (v & 1u) + (v >> 1 & 1u) * 4 + (v >> 2 & 1u) * 16 + (v >> 3) * 64]))
          return true;
      return false;
    });
    const auto holes = choose_tiles(image.view(), tiles);
    for (const Ambiguity ambiguity : kEstimated) {
      SCOPED_TRACE(std::string(name_of(ambiguity)) + ", seed " + std::to_string(seed));
      const ExtractOptions barycentric_options = barycentric_by(ambiguity, false), compact_options = with(ambiguity);
      const auto expect_alike = [](const Contour<4, double>& found, const Contour<4, double>& compact) {
        expect_oriented_manifold(found);
        const MeshReport a = check(found), b = check(compact);
        EXPECT_EQ(a.components, b.components);
        EXPECT_EQ(a.euler, b.euler);
        EXPECT_GT(found.simplices.size(), 0u);
      };
      expect_alike(extract<double>(image.view(), 0.5, barycentric_options),
                   extract<double>(image.view(), 0.5, compact_options));
      expect_alike(extract<double>(whole.view(), 0.5, *chosen, barycentric_options),
                   extract<double>(whole.view(), 0.5, *chosen, compact_options));
      expect_alike(extract<double>(image.view(), 0.5, *holes, barycentric_options),
                   extract<double>(image.view(), 0.5, *holes, compact_options));
      expect_closed_up_to_missing_values<double>(image.view(), 0.5, barycentric_options);
    }
  }
}

}  // namespace tegl::test
