// SPDX-License-Identifier: BSD-3-Clause
//
// Operations on contours call their progress functions often enough that Ctrl-C is handled without a noticeable delay,
// at any phase. Bounds are shares of the total CPU time.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "errors.hpp"
#include "fields.hpp"
#include "progress_probe.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/elements.hpp"
#include "tegl/extract.hpp"
#include "tegl/incidence.hpp"
#include "tegl/io.hpp"
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

struct Operation {
  std::string name;
  std::function<void(const Progress&)> run;
  double share = 0.1;  ///< maximum gap as a share of the total
};

/// A contour of noise with very many components, handles and events: the worst case.
class ProgressGaps : public testing::Test {
 protected:
  static constexpr int kN = 4;
  static constexpr std::size_t kSize = 14;

  static void SetUpTestSuite() {
    image_ = new OwnedImage<float, kN>(noise<float, kN>(kSize, 1));
    contour_ = new Contour<kN, float>(extract<float>(image_->view(), 0.5));
    labels_ = new ComponentLabels(label_components(*contour_));
    surface_ = new Contour<3, float>(extract<float>(view_of(noise<float, 3>(16, 2)), 0.5));
  }
  static void TearDownTestSuite() {
    delete std::exchange(image_, nullptr);
    delete std::exchange(contour_, nullptr);
    delete std::exchange(labels_, nullptr);
    delete std::exchange(surface_, nullptr);
  }

  static std::vector<double> times() { return even_times(0.0, kSize - 1.0, 40); }
  static std::vector<Hyperplane<4>> hyperplanes() {
    std::vector<Hyperplane<4>> result;
    for (const double t : times()) result.push_back(Hyperplane<4>::across(3, t));
    return result;
  }

  static void simplify_surface(SimplifyMethod method, unsigned threads, const Progress& progress) {
    SimplifyOptions<3> options;
    options.method = method;
    options.ratio = 0.5;
    options.measure = false;
    options.work = {threads, progress};
    simplify(*surface_, options);
  }

  static std::vector<Operation> operations(unsigned threads) {
    const auto work = [threads](const Progress& progress) { return WorkOptions{threads, progress}; };
    const auto follow = [threads](std::vector<double> at, const Progress& progress) {
      TrackOptions options;
      options.times = std::move(at);
      options.work = {threads, progress};
      track(*contour_, options);
    };
    return {
        {"check", [work](const Progress& p) { check(*contour_, work(p)); }},
        {"label_components", [work](const Progress& p) { label_components(*contour_, work(p)); }, 0.4},
        {"components", [work](const Progress& p) { components(*contour_, *labels_, work(p)); }},
        {"split_components", [work](const Progress& p) { split_components(*contour_, *labels_, work(p)); }, 0.3},
        {"select_components",
         [work](const Progress& p) {
           select_components(*contour_, *labels_, std::vector<bool>(labels_->count, true), work(p));
         },
         0.3},
        {"measure", [work](const Progress& p) { measure(*contour_, work(p)); }, 0.2},
        {"measure_cuts", [work](const Progress& p) { measure_cuts(*contour_, times(), work(p)); }, 0.2},
        {"slice_stack", [work](const Progress& p) { slice_stack(*contour_, hyperplanes(), work(p)); }},
        {"Scrubber",
         [work](const Progress& p) { const Scrubber<kN, float> built(*contour_, Hyperplane<kN>{}, work(p)); }, 0.6},
        {"project", [work](const Progress& p) { project(*contour_, {}, work(p)); }, 0.6},
        // the outline itself, which in noise has as many simplices as the contour, is made between two calls
        {"outline", [work](const Progress& p) { outline(*contour_, {}, work(p)); }, 0.9},
        {"Incidence", [work](const Progress& p) { const Incidence<kN> found(*contour_, work(p)); }, 0.6},
        {"deviation",
         [threads](const Progress& p) {
           DeviationOptions<3> options;
           options.work = {threads, p};
           deviation(*surface_, *surface_, options);
         },
         0.4},
        {"find_seeds",
         [threads](const Progress& p) {
           SeedSetOptions options;
           options.work = {threads, p};
           find_seeds(image_->view(), options);
         },
         0.4},
        {"elements", [work](const Progress& p) { elements(*contour_, work(p)); }, 0.2},
        {"sample", [work](const Progress& p) { sample(image_->view(), *contour_, "v", "", work(p)); }, 0.3},
        {"track", [follow](const Progress& p) { follow({}, p); }},
        {"track with samples", [follow](const Progress& p) { follow(times(), p); }},
        {"simplify", [=](const Progress& p) { simplify_surface(SimplifyMethod::quadric, threads, p); }, 0.35},
        {"simplify by curvature", [=](const Progress& p) { simplify_surface(SimplifyMethod::facets, threads, p); },
         0.35},
        {"simplify by distance", [=](const Progress& p) { simplify_surface(SimplifyMethod::vertices, threads, p); },
         0.35},
    };
  }

  static inline OwnedImage<float, kN>* image_ = nullptr;
  static inline Contour<kN, float>* contour_ = nullptr;
  static inline ComponentLabels* labels_ = nullptr;
  static inline Contour<3, float>* surface_ = nullptr;
};

void expect_sound(const ProgressProbe& probe) {
  EXPECT_FALSE(probe.falls());
  EXPECT_TRUE(probe.is_within_bounds());
  EXPECT_EQ(probe.last_fraction(), 1.0);
}

TEST_F(ProgressGaps, AreShortAndFractionsRiseToOne) {
  for (const Operation& operation : operations(1)) {
    SCOPED_TRACE(operation.name);
    // Other programs on the machine sometimes evict caches; a gap that repeats is the operation's own.
    ProgressProbe probe;
    for (int attempt = 0; attempt < 3 && (attempt == 0 || probe.longest_share() > operation.share); ++attempt) {
      probe.watch(operation.run);
      expect_sound(probe);
    }
    EXPECT_LE(probe.longest_share(), operation.share)
        << "of " << probe.seconds() << " s, after the fraction " << probe.longest_after();
  }
}

TEST_F(ProgressGaps, AndSoDoTheyWithSeveralThreads) {
  for (const Operation& operation : operations(3)) {
    SCOPED_TRACE(operation.name);
    ProgressProbe probe;
    probe.watch(operation.run);
    expect_sound(probe);
  }
}

TEST_F(ProgressGaps, AnyCallCanEndTheWork) {
  for (const unsigned threads : {1u, 3u})
    for (const Operation& operation : operations(threads)) {
      SCOPED_TRACE(testing::Message() << operation.name << ", " << threads << " threads");
      std::size_t calls = 2;
      if (threads == 1) {
        calls = 0;
        operation.run([&](double) { return ++calls > 0; });
        ASSERT_GE(calls, 3u);
      }
      // With several threads the number of calls varies; the first two always occur.
      for (const std::size_t last : {std::size_t{1}, (calls + 1) / 2, calls}) {
        std::size_t seen = 0;
        expect_error(ErrorCode::Cancelled, "cancelled", [&] { operation.run([&](double) { return ++seen < last; }); });
        EXPECT_EQ(seen, last) << "nobody asks again";
      }
    }
}

/// Also for files of every format that can hold the contour, in text and binary.
TEST_F(ProgressGaps, OfReadingFilesAreShort) {
  const auto surface = extract<float>(view_of(noise<float, 3>(48, 3)), 0.5);
  // A .gltf is parsed as one text, so its gaps are not limited.
  const std::vector<std::pair<std::string, double>> files = {
      {"gaps.ply", 0.5}, {"gaps.glb", 0.5}, {"gaps.gltf", 1.0}, {"gaps.vtkhdf", 0.5}};
  for (const auto& [name, share] : files) {
    SCOPED_TRACE(name);
    const auto path = std::filesystem::path(testing::TempDir()) / name;
    write_mesh(surface, path);
    ProgressProbe probe;
    for (int attempt = 0; attempt < 3 && (attempt == 0 || probe.longest_share() > share); ++attempt) {
      probe.watch([&](const Progress& progress) { read_mesh(path, {.work = {.progress = progress}}); });
      expect_sound(probe);
    }
    if (share < 1) {
      EXPECT_LE(probe.longest_share(), share) << "of " << probe.seconds() << " s, after " << probe.longest_after();
    }
    std::size_t seen = 0;
    expect_error(ErrorCode::Cancelled, "cancelled", [&] {
      read_mesh(path, {.work = {.progress = [&](double fraction) { return ++seen > 0 && fraction < 0.3; }}});
    });
    EXPECT_GT(seen, 1u);
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace tegl::test
