// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of measured and simulated data, closed at the border and simplified. Skipped if the folder with the files
// does not exist.
#include <filesystem>
#include <ostream>
#include <string>
#include <variant>

#include "ambiguity/variants.hpp"
#include "caps.hpp"
#include "distance_oracle.hpp"
#include "simplified.hpp"
#include "tegl/deviation.hpp"
#include "tegl/io.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

struct File {
  const char* path;
  double isovalue;
  bool has_missing = false;
  double along_z = 0.5;  ///< position of the part: 0 at the first sample, 1 at the last
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.path; }

class RealFile : public ::testing::TestWithParam<File> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(path())) GTEST_SKIP() << "no shared data";
  }
  static std::filesystem::path path() { return std::filesystem::path(TEGL_SHARED_DATA_DIR) / GetParam().path; }

  /// Calls work(image) with a part of the file's image with these numbers of samples along each spatial axis and in
  /// time.
  template <class Work>
  static void with_part(std::size_t of_3d, std::size_t of_4d, std::size_t times, const Work& work) {
    const ReadImageResult input = read_image(path());
    const auto of_image = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      if constexpr (N == 3 || N == 4) {
        Image<T, N> image = owned.view();
        for (int a = 0; a < N; ++a) {
          const std::size_t size = std::min(image.size(a), N == 3 ? of_3d : (a == 3 ? times : of_4d));
          const double at = a == 2 ? GetParam().along_z : 0.5;
          image = image.part(a, static_cast<std::size_t>(at * static_cast<double>(image.size(a) - size)), size);
        }
        work(image);
      } else {
        FAIL() << "an image in " << N << " dimensions; expected 3 or 4";
      }
    };
    std::visit([&](const auto& typed) { std::visit(of_image, typed); }, input.image);
  }
};

using ClosedFile = RealFile;

TEST_P(ClosedFile, IsWatertightWithCapsInTheBorder) {
  with_part(24, 11, 5, []<Value T, int N>(const Image<T, N>& image) {
    for (const ExtractOptions& options : variants()) {
      SCOPED_TRACE(describe(options));
      if (GetParam().has_missing) {
        expect_closed_up_to_missing_values<double>(image, GetParam().isovalue, options);
        EXPECT_EQ(check(extract<double>(image, GetParam().isovalue, options)).bad_links, 0u);
      } else {
        expect_closed_at_border<double>(image, GetParam().isovalue, options);
        expect_closed_at_border<float>(image, GetParam().isovalue, options);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(RealData, ClosedFile,
                         ::testing::Values(File{"classic/fuel_64x64x64_uint8.nhdr", 20},
                                           File{"classic/neghip_64x64x64_uint8.nhdr", 60},
                                           File{"classic/silicium_98x34x34_uint8.nhdr", 120},
                                           File{"classic/hydrogen_atom_128x128x128_uint8.nhdr", 15},
                                           File{"ct_mri/headsq_quarter_64x64x93_uint16.nhdr", 1150},
                                           File{"fourd/viscous_fingers_64x64x64x24_float.nhdr", 30, false, 1.0},
                                           File{"fourd/ocean_atlas_subset.nc.gz", 20, true}));

using SimplifiedFile = RealFile;

/// If axes have units other than the first's, measures lengths in steps, so that all axes count.
template <int N, class Real>
void in_steps(Contour<N, Real>& contour, const Grid<N>& grid) {
  Eigen::Matrix<double, N, 1> factors;
  for (int a = 0; a < N; ++a) {
    const Axis& axis = grid.axes[a];
    factors[a] = std::abs(static_cast<double>(axis.size() - 1) / (axis[axis.size() - 1] - axis[0]));
  }
  scale_axes(contour, factors);
}

TEST_P(SimplifiedFile, KeepsManifoldAndBorderWithinItsBound) {
  with_part(16, 9, 5, []<Value T, int N>(const Image<T, N>& image) {
    auto contour = extract<double>(image, GetParam().isovalue);
    in_steps(contour, image.grid());
    const MeshReport before = check(contour);
    ASSERT_GT(before.simplices, 400u);
    for (const SimplifyMethod method : kMethods) {
      SCOPED_TRACE(name(method));
      SimplifyOptions<N> options;
      options.method = method;
      options.ratio = 0.3;
      const auto [result, stats] = simplify(contour, options);
      expect_same_topology(before, check(result));
      EXPECT_LT(result.simplices.size(), contour.simplices.size() * 3 / 4);
      EXPECT_EQ(border_points(result), border_points(contour));
      EXPECT_GE(*stats.error_of_original, sampled_deviation(contour, result, 100, 1));
      EXPECT_GE(*stats.error_of_result, sampled_deviation(result, contour, 100, 2));
      EXPECT_LE(*stats.error(), 3.0);  // in steps: samples of these data are that rough
    }
  });
}

/// A slice of a part of a 4D file: across an axis, with given numbers of samples along the other two from given starts;
/// and largest errors, ascending, after the automatic scale.
struct FileCut {
  const char* path;
  double isovalue;
  int axis;
  double at;
  std::size_t first, size;
  std::vector<double> errors;
};
std::ostream& operator<<(std::ostream& out, const FileCut& cut) { return out << cut.path; }

class CutOfAFile : public ::testing::TestWithParam<FileCut> {
 protected:
  void SetUp() override {
    const FileCut& cut = GetParam();
    const auto path = std::filesystem::path(TEGL_SHARED_DATA_DIR) / cut.path;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
    const ReadImageResult input = read_image(path);
    std::visit(
        [&](const auto& owned) {
          auto part = owned.view();
          for (int a = 0, parts = 0; parts < 2; ++a) {
            if (a == cut.axis) continue;
            part = part.part(a, cut.first, std::min(cut.size, part.size(a) - cut.first));
            ++parts;
          }
          contour_ = slice_image_across<double>(part, cut.isovalue, cut.axis, cut.at);
        },
        std::get<AnyImageN<4>>(input.image));
    ASSERT_GT(contour_.simplices.size(), 2000u);
  }
  [[nodiscard]] const Contour<3, double>& contour() const { return contour_; }
  [[nodiscard]] SimplifyOptions<3> scaled_options() const {
    SimplifyOptions<3> options;
    options.scale = automatic_scale(contour_);
    return options;
  }
  [[nodiscard]] double share(const Contour<3, double>& result) const {
    return static_cast<double>(result.simplices.size()) / static_cast<double>(contour_.simplices.size());
  }

 private:
  Contour<3, double> contour_;
};

/// A largest error is reached in several rounds and never abandoned in favour of the input; a larger one leaves fewer
/// simplices. A count equal to the one left by an error is reached exactly, with hardly more error (caused by thin
/// parts removed too early); a smaller count has a larger error.
TEST_P(CutOfAFile, HasFewerSimplicesTheLargerTheErrorIsAndHardlyMoreErrorByCount) {
  const MeshReport before = check(contour());
  double last = 0.99, last_by_count = 0.0;
  for (const double most : GetParam().errors) {
    SCOPED_TRACE(most);
    SimplifyOptions<3> options = scaled_options();
    options.max_error = most;
    const auto [result, stats] = simplify(contour(), options);
    expect_same_topology(before, check(result));
    EXPECT_LE(*stats.error(), most * (1 + 1e-9));
    EXPECT_GT(*stats.error(), 0.3 * most);
    EXPECT_EQ(stats.end, SimplifyEnd::error);
    EXPECT_LE(stats.rounds, 10u);
    EXPECT_LT(share(result), last + 0.01);
    last = share(result);

    options.max_error.reset();
    options.count = stats.simplices_after;
    const auto [by_count, found] = simplify(contour(), options);
    expect_same_topology(before, check(by_count));
    EXPECT_EQ(found.end, SimplifyEnd::count);
    EXPECT_LE(by_count.simplices.size(), *options.count);
    EXPECT_GT(by_count.simplices.size() + 3, *options.count);
    EXPECT_LT(*found.error(), 1.5 * *stats.error());
    EXPECT_GT(*found.error(), 0.9 * last_by_count);
    last_by_count = *found.error();
  }
  EXPECT_LT(last, 0.5);
}

/// With both goals, simplification ends at the count if the error permits it, and otherwise as with the error only.
TEST_P(CutOfAFile, EndsAtTheFirstOfTwoGoals) {
  SimplifyOptions<3> options = scaled_options();
  options.max_error = GetParam().errors.back();
  const auto [by_error, alone] = simplify(contour(), options);
  options.count = alone.simplices_after + alone.simplices_after / 10;
  const SimplifyStats stats = simplify(contour(), options).stats;
  EXPECT_EQ(stats.end, SimplifyEnd::count);
  EXPECT_LE(*stats.error(), *options.max_error * (1 + 1e-9));
  EXPECT_LE(stats.simplices_after, *options.count);
  EXPECT_GE(stats.simplices_after, alone.simplices_after);
  options.count = alone.simplices_after / 2;
  const auto by_both = simplify(contour(), options);
  EXPECT_EQ(by_both.contour.simplices, by_error.simplices);
  EXPECT_EQ(by_both.stats.end, SimplifyEnd::error);
}

TEST_P(CutOfAFile, StaysAsItIsWhereNothingIsToGo) {
  SimplifyOptions<3> all;
  all.ratio = 1.0;
  SimplifyOptions<3> exact;
  exact.max_error = 0.0;
  for (const SimplifyOptions<3>& options : {all, exact})
    for (const SimplifyMethod method : kMethods) {
      SimplifyOptions<3> with_method = options;
      with_method.method = method;
      const auto [result, stats] = simplify(contour(), with_method);
      EXPECT_EQ(result.vertices, contour().vertices);
      EXPECT_EQ(result.simplices, contour().simplices);
      EXPECT_EQ(stats.error(), 0.0);
      EXPECT_EQ(stats.end, options.ratio ? SimplifyEnd::count : SimplifyEnd::error);
    }
}

constexpr const char* kViscousFingers = "fourd/viscous_fingers_64x64x64x24_float.nhdr";
constexpr const char* kOcean = "fourd/ocean_atlas_subset.nc.gz";

INSTANTIATE_TEST_SUITE_P(RealData, CutOfAFile,
                         ::testing::Values(FileCut{kViscousFingers, 30, 0, 20.5, 20, 20, {0.003, 0.05}},
                                           FileCut{kViscousFingers, 30, 3, 7.3, 20, 16, {0.02}},
                                           FileCut{kOcean, 20, 3, 4350.0, 0, 40, {0.3, 0.7}}));

/// The bound may exceed the distance for rough contours, but not by much.
TEST_P(SimplifiedFile, HasABoundNearToADistanceThatIsReached) {
  with_part(22, 10, 5, []<Value T, int N>(const Image<T, N>& image) {
    auto contour = extract<double>(image, GetParam().isovalue);
    in_steps(contour, image.grid());
    SimplifyOptions<N> options;
    options.ratio = 0.3;
    options.measure = false;
    const auto result = simplify(contour, options).contour;
    for (const Deviation& way : {deviation(contour, result), deviation(result, contour)}) {
      EXPECT_GE(way.bound, way.least);
      EXPECT_LE(way.bound, 2.0 * way.least);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(RealData, SimplifiedFile,
                         ::testing::Values(File{"classic/neghip_64x64x64_uint8.nhdr", 60},
                                           File{"classic/silicium_98x34x34_uint8.nhdr", 120},
                                           File{"ct_mri/headsq_quarter_64x64x93_uint16.nhdr", 1150},
                                           File{"fourd/viscous_fingers_64x64x64x24_float.nhdr", 30, false, 1.0},
                                           File{"fourd/ocean_atlas_subset.nc.gz", 20, true}));

}  // namespace
}  // namespace tegl::test
