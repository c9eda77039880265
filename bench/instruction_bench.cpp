// SPDX-License-Identifier: BSD-3-Clause
//
// Fixed inputs for instruction counts. `instruction_bench --list` names the small ones, which are monitored,
// `instruction_bench --list-large` those whose counts explain times, and `instruction_bench NAME` runs one. valgrind
// counts the instructions inside the function tegl_measured (see bench/instructions), so generating the field does not
// count.
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fields.hpp"
#include "run.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/elements.hpp"
#include "tegl/incidence.hpp"
#include "tegl/measure.hpp"
#include "tegl/project.hpp"
#include "tegl/sample.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/seed_set.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"
#include "usage.hpp"

/// The counted function: it has a C name so that valgrind finds it, and no tail call, which would leave it before the
/// work begins.
extern "C" [[gnu::noinline]] void tegl_measured(const std::function<void()>& work) {
  work();
  asm volatile("" : : : "memory");
}

namespace tegl::bench {
namespace {

using NamedCase = std::pair<std::string, std::function<void()>>;

const WorkOptions kOneThread{1, {}};  ///< the division of work among several threads varies

/// Keeps a result alive up to this point.
template <class T>
void use(const T& result) {
  asm volatile("" : : "g"(&result) : "memory");
}

/// Calls tegl_measured through a pointer opaque to the compiler, which then makes no clones of it for its callers.
void measured(const std::function<void()>& work) {
  void (*volatile function)(const std::function<void()>&) = tegl_measured;
  function(work);
}

/// Counts one extraction and prints its size: samples, active tiles, simplices.
template <Value T, int N>
void count_extract(const Image<T, N>& image, double isovalue, const ExtractOptions& base) {
  const ExtractOptions options = with_threads(base, 1);
  ExtractStats stats;
  std::size_t simplices = 0;
  // Excludes the one-time initialisation of estimators from the count.
  if (options.ambiguity != Ambiguity::low) {
    const OwnedImage<float, N> noise = make_field<N>("noise", 4);
    count(noise.view(), 0.0, options);
  }
  measured([&] {
    const auto extraction = extract_with_stats(image, isovalue, options);
    stats = extraction.stats;
    simplices = extraction.contour.simplices.size();
  });
  std::size_t samples = 1;
  for (int a = 0; a < N; ++a) samples *= image.size(a);
  std::printf("samples %zu active %zu simplices %zu\n", samples, std::size_t{stats.active_tiles}, simplices);
}

template <int N>
NamedCase extract_case(const std::string& field, std::size_t samples, const std::string& suffix = "",
                       const ExtractOptions& options = {}) {
  return {"extract " + field + " " + std::to_string(samples) + "^" + std::to_string(N) + suffix, [=] {
            const OwnedImage<float, N> image = make_field<N>(field, samples);
            count_extract(image.view(), 0.0, options);
          }};
}

/// 8-bit integers: the narrowest classification.
void count_bytes() {
  const auto field = make_field<3>("metaballs", 96);
  OwnedImage<std::uint8_t, 3> image{field.grid, std::vector<std::uint8_t>(field.values.size())};
  for (std::size_t i = 0; i < field.values.size(); ++i)
    image.values[i] = static_cast<std::uint8_t>(field.values[i] >= 0.0F ? 200 : 50);
  count_extract(image.view(), 128.0, ExtractOptions{});
}

void count_slice() {
  const auto image = make_field<4>("balls", 24);
  const auto contour = extract(image.view(), 0.0, with_threads(ExtractOptions{}, 1));
  measured([&] { use(slice(contour, Hyperplane<4>::across(3, 11.3), kOneThread)); });
}

void count_slice_image() {
  const auto image = make_field<4>("balls", 32);
  const ExtractOptions options = with_threads(ExtractOptions{}, 1);
  measured([&] { use(slice_image(image.view(), 0.0, Hyperplane<4>::across(3, 14.3), options)); });
}

void count_check() {
  const auto image = make_field<3>("sphere", 40);
  const auto contour = extract(image.view(), 0.0, with_threads(ExtractOptions{}, 1));
  measured([&] { use(check(contour, kOneThread)); });
}

void count_sample() {
  const auto image = make_field<4>("balls", 16);
  const auto contour = extract<double>(image.view(), 0.0, with_threads(ExtractOptions{}, 1));
  measured([&] { use(sample(image.view(), contour, "value", "", kOneThread)); });
}

/// The simplified contour and the original one, each to the other.
void count_deviation() {
  const auto image = make_field<4>("balls", 8);
  const auto contour = extract<double>(image.view(), 0.0, with_threads(ExtractOptions{}, 1));
  SimplifyOptions<4> half;
  half.ratio = 0.5;
  half.measure = false;
  half.work = kOneThread;
  const auto simple = simplify(contour, half).contour;
  DeviationOptions<4> options;
  options.work = kOneThread;
  measured([&] { use(deviation(contour, simple, options)); });
}

/// Seeds out of so many tiles with different values that trees are given up by blocks.
void count_seeds() {
  const auto image = make_field<3>("metaballs", 48);
  SeedSetOptions options;
  options.work = kOneThread;
  measured([&] { use(find_seeds(image.view(), options)); });
}

/// An operation on a 4D contour. `work(contour)` returns its result.
template <class Work>
NamedCase operation_case(const std::string& name, std::size_t samples, const Work& work) {
  return {name + " balls " + std::to_string(samples) + "^4", [=] {
            const auto image = make_field<4>("balls", samples);
            const auto contour = extract<double>(image.view(), 0.0, with_threads(ExtractOptions{}, 1));
            measured([&] { use(work(contour)); });
          }};
}

/// Operations on contours, on one thread.
std::vector<NamedCase> operation_cases() {
  using Contour4 = Contour<4, double>;
  const auto cuts = [] {
    std::vector<Hyperplane<4>> all;
    for (int i = 0; i < 10; ++i) all.push_back(Hyperplane<4>::across(3, 2.3 + i));
    return all;
  };
  TrackOptions tracking;
  tracking.work = kOneThread;
  SimplifyOptions<4> half;
  half.ratio = 0.5;
  half.measure = false;
  half.work = kOneThread;
  return {
      operation_case("check", 16, [](const Contour4& c) { return check(c, kOneThread); }),
      operation_case("label_components", 16, [](const Contour4& c) { return label_components(c, kOneThread); }),
      operation_case("components", 16,
                     [](const Contour4& c) { return components(c, label_components(c, kOneThread), kOneThread); }),
      operation_case("measure", 16, [](const Contour4& c) { return measure(c, kOneThread); }),
      operation_case("measure_cuts", 16,
                     [](const Contour4& c) { return measure_cuts(c, even_times(1.0, 14.0, 200), kOneThread); }),
      operation_case("slice_stack", 16, [=](const Contour4& c) { return slice_stack(c, cuts(), kOneThread); }),
      operation_case("scrubber", 16,
                     [](const Contour4& c) { return Scrubber<4, double>(c, Hyperplane<4>{}, kOneThread).cut(7.3); }),
      operation_case("track", 16, [=](const Contour4& c) { return track(c, tracking); }),
      operation_case("project", 16, [](const Contour4& c) { return project(c, {}, kOneThread); }),
      operation_case("outline", 16, [](const Contour4& c) { return outline(c, {}, kOneThread); }),
      operation_case("elements", 16, [](const Contour4& c) { return elements(c, kOneThread); }),
      operation_case("simplify", 8, [=](const Contour4& c) { return simplify(c, half); }),
      operation_case("incidence", 16, [](const Contour4& c) { return Incidence<4>(c, kOneThread); }),
      operation_case(
          "split_components", 16,
          [](const Contour4& c) { return split_components(c, label_components(c, kOneThread), kOneThread); }),
      {"deviation balls 8^4", count_deviation},
      {"sample balls 16^4", count_sample},
      {"find_seeds metaballs 48^3", count_seeds},
  };
}

std::vector<NamedCase> cases_of_extract() {
  ExtractOptions barycentric;
  barycentric.triangulation = Triangulation::barycentric;
  ExtractOptions closed;
  closed.close = true;
  const auto by = [](Ambiguity ambiguity) {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    return options;
  };
  const ExtractOptions normals = with_normals(ExtractOptions{}, true);
  return {
      extract_case<2>("empty", 512),
      extract_case<2>("gyroid", 512),
      extract_case<2>("noise", 200),
      extract_case<3>("empty", 96),
      extract_case<3>("metaballs", 96),
      extract_case<3>("gyroid", 64),
      extract_case<3>("noise", 32),
      extract_case<3>("gyroid", 48, " closed", closed),
      extract_case<4>("empty", 32),
      extract_case<4>("balls", 32),
      extract_case<4>("sphere", 20),
      extract_case<4>("noise", 10),
      extract_case<4>("sphere", 20, " barycentric", barycentric),
      extract_case<3>("metaballs", 96, " normals", normals),
      extract_case<3>("gyroid", 64, " normals", normals),
      extract_case<3>("noise", 32, " normals", normals),
      extract_case<4>("balls", 32, " normals", normals),
      extract_case<2>("noise", 200, " mean", by(Ambiguity::mean)),
      extract_case<3>("gyroid", 64, " mean", by(Ambiguity::mean)),
      extract_case<3>("gyroid", 64, " saddle", by(Ambiguity::saddle)),
      extract_case<3>("noise", 32, " mean", by(Ambiguity::mean)),
      extract_case<3>("noise", 32, " saddle", by(Ambiguity::saddle)),
      extract_case<4>("balls", 32, " mean", by(Ambiguity::mean)),
      extract_case<4>("balls", 32, " saddle", by(Ambiguity::saddle)),
      extract_case<4>("noise", 10, " mean", by(Ambiguity::mean)),
      extract_case<4>("noise", 10, " saddle", by(Ambiguity::saddle)),
      {"extract metaballs 96^3 uint8", count_bytes},
      {"slice balls 24^4", count_slice},
      {"slice_image balls 32^4", count_slice_image},
      {"check sphere 40^3", count_check},
  };
}

std::vector<NamedCase> all_cases() {
  std::vector<NamedCase> all = cases_of_extract();
  for (NamedCase& operation : operation_cases()) all.push_back(std::move(operation));
  return all;
}

/// The cases of bench/side_by_side with at most an eighth of its samples.
std::vector<NamedCase> large_cases() {
  const ExtractOptions normals = with_normals(ExtractOptions{}, true);
  return {
      extract_case<3>("metaballs", 256),
      extract_case<3>("gyroid", 256),
      extract_case<3>("noise", 96),
      extract_case<3>("metaballs", 256, " normals", normals),
      extract_case<3>("gyroid", 256, " normals", normals),
      extract_case<3>("noise", 96, " normals", normals),
      extract_case<2>("metaballs", 2048),
      extract_case<2>("gyroid", 2048),
      extract_case<2>("noise", 1024),
      extract_case<4>("balls", 48),
      extract_case<4>("sphere", 48),
      extract_case<4>("noise", 20),
  };
}

int run(const std::string& name) {
  for (const auto& [option, cases] : {std::pair{"--list", all_cases()}, {"--list-large", large_cases()}}) {
    for (const auto& [known, work] : cases) {
      if (name == option) std::printf("%s\n", known.c_str());
      if (name == known) {
        work();
        return 0;
      }
    }
    if (name == option) return 0;
  }
  std::fprintf(stderr, "no case '%s'; --list and --list-large name them\n", name.c_str());
  return 2;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  try {
    constexpr const char* kUsage = "instruction_bench --list | --list-large | NAME";
    if (tegl::bench::tells_usage(argc, argv, kUsage)) return 0;
    if (argc == 2) return tegl::bench::run(argv[1]);
    std::fprintf(stderr, "usage: %s\n", kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "instruction_bench: %s\n", error.what());
    return 1;
  }
}
