// SPDX-License-Identifier: BSD-3-Clause
//
// Time of contours on lattices, beside cubic samples and beside the lattice's complex; or on curved grids and with
// periodic axes, beside the plain contour: a gyroid with equally many samples, one thread, processor time, several runs
// taken in turn, of lattices the minimum. In 4D a sum of waves, a small ball, and noise in an eighth of the samples,
// also with the memory beyond image and contour.
//
//     lattice_bench [SAMPLES_ALONG_AXIS] [RUNS]
//     lattice_bench 4d [SAMPLES_ALONG_AXIS] [RUNS]
//     lattice_bench curved [SAMPLES_ALONG_AXIS] [RUNS]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "memory.hpp"
#include "tegl/curved.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"
#include "timing.hpp"

namespace {

using namespace tegl;

struct Case {
  std::string name;
  std::function<ExtractStats()> run;
  ExtractStats best = {};
  double seconds = std::numeric_limits<double>::infinity();
};

/// Measures all cases in turn.
void measure_in_turn(std::vector<Case>& cases, int runs) {
  for (int run = 0; run < runs; ++run)
    for (Case& each : cases) {
      const double start = bench::worked_seconds();
      const ExtractStats stats = each.run();
      const double seconds = bench::worked_seconds() - start;
      if (seconds >= each.seconds) continue;
      each.seconds = seconds;
      each.best = stats;
    }
}

/// Samples of a gyroid in a box of equal volume per sample; `layer`: distance of layers in steps; 1: not staggered.
std::vector<float> gyroid(std::size_t n, double layer, double size = 50.0) {
  std::vector<float> values;
  const double step = size / static_cast<double>(n) / std::cbrt(layer);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const double half = layer < 1.0 && k % 2 == 1 ? 0.5 : 0.0;
        const double x = step * (static_cast<double>(i) + half), y = step * (static_cast<double>(j) + half);
        const double z = step * layer * static_cast<double>(k);
        values.push_back(
            static_cast<float>(std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x)));
      }
  return values;
}

/// The coordinates of axis `axis` in an array along `axes` axes: those of the samples, moved by waves.
std::vector<double> coordinates(std::size_t n, int axis, int axes) {
  std::vector<double> values;
  const double turn = 12.0 / static_cast<double>(n);
  const std::size_t layers = axes > 2 ? n : 1;
  for (std::size_t k = 0; k < layers; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const std::array<double, 3> index = {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        const auto a = static_cast<std::size_t>(axis);
        values.push_back(index[a] + 2.0 * std::sin(turn * index[(a + 1) % 3]));
      }
  return values;
}

/// Curved coordinates of all axes, in arrays along `axes` axes; `rounded`: to float.
std::vector<CurvedAxis> curved_axes(std::size_t n, int axes, bool rounded) {
  std::vector<CurvedAxis> curved;
  for (int axis = 0; axis < axes; ++axis) {
    curved.push_back({axis, (1u << axes) - 1, coordinates(n, axis, axes)});
    for (double& x : curved.back().values) x = rounded ? static_cast<double>(static_cast<float>(x)) : x;
  }
  return curved;
}

/// Numbers in memory as coordinates of all axes, in place: `pitch` numbers from a sample to the next one, `step` from
/// the coordinate of an axis to that of the next one.
template <class T>
std::vector<CurvedAxis> in_place(const std::vector<T>& numbers, std::size_t samples, std::size_t pitch,
                                 std::size_t step) {
  std::vector<CurvedAxis> curved;
  for (std::size_t axis = 0; axis < 3; ++axis)
    curved.push_back({static_cast<int>(axis),
                      7,
                      {},
                      "",
                      "",
                      CurvedPoints::in_place(numbers.data() + axis * step, samples, 1, pitch)});
  return curved;
}

/// Coordinates of three axes in one array: side by side, or one array after the other.
template <class T>
std::vector<T> in_one_array(const std::vector<CurvedAxis>& curved, bool side_by_side) {
  const std::size_t samples = curved[0].size();
  std::vector<T> numbers(3 * samples);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < samples; ++i)
      numbers[side_by_side ? 3 * i + a : a * samples + i] = static_cast<T>(curved[a].values[i]);
  return numbers;
}

/// The first number of each line of 64 bytes that the vertices of a contour on a unit grid need of an array with
/// `bytes` bytes per sample, in the order of the vertices.
template <class T>
std::vector<const T*> needed_lines(const Contour<3, double>& contour, std::size_t n, const T* numbers,
                                   std::size_t bytes) {
  const std::size_t samples_per_line = 64 / bytes, numbers_per_line = 64 / sizeof(T);
  std::vector<const T*> lines;
  std::vector<bool> is_needed(n * n * n / samples_per_line + 1);
  for (const auto& vertex : contour.vertices) {
    std::size_t first = 0, second = 0;
    for (std::size_t a = 3; a-- > 0;) {
      first = first * n + static_cast<std::size_t>(std::floor(vertex[a]));
      second = second * n + static_cast<std::size_t>(std::ceil(vertex[a]));
    }
    for (const std::size_t at : {first, second}) {
      const std::size_t line = at / samples_per_line;
      if (is_needed[line]) continue;
      is_needed[line] = true;
      lines.push_back(numbers + line * numbers_per_line);
    }
  }
  return lines;
}

/// Reads a value of each of the lines, which are requested ahead.
template <class T>
double read_lines(const std::vector<const T*>& lines) {
  constexpr std::size_t kAhead = 24;
  double sum = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    __builtin_prefetch(lines[std::min(i + kAhead, lines.size() - 1)]);
    sum += static_cast<double>(*lines[i]);
  }
  return sum;
}

struct Grids {
  const char* name;
  std::function<std::size_t()> run;  ///< returns the number of vertices
  std::size_t vertices = 0;
  std::vector<double> seconds = {};
};

/// Contours on curved grids and with periodic axes beside the plain one.
int measure_curved(std::size_t n, int runs) {
  ExtractOptions options;
  options.work.threads = 1;
  const Grid<3> grid = Grid<3>::unit({n, n, n});
  const std::vector<float> values = gyroid(n, 1.0, 26.0);
  const Image<float, 3> image(values.data(), grid);
  const std::vector<CurvedAxis> two = curved_axes(n, 2, false), three = curved_axes(n, 3, false);
  const std::vector<CurvedAxis> two_by_points = by_points(curved_axes(n, 2, true), 1);
  const std::vector<CurvedAxis> rounded = curved_axes(n, 3, true);
  const std::vector<CurvedAxis> floats = by_points(rounded, 1), doubles = by_points(three, 1);
  const std::vector<float> points_of_floats = in_one_array<float>(rounded, true);
  const std::vector<float> arrays_of_floats = in_one_array<float>(rounded, false);
  const std::vector<double> points_of_doubles = in_one_array<double>(three, true);
  const std::size_t samples = n * n * n;
  const std::vector<CurvedAxis> floats_in_place = in_place(points_of_floats, samples, 3, 1);
  const std::vector<CurvedAxis> doubles_in_place = in_place(points_of_doubles, samples, 3, 1);
  const std::vector<CurvedAxis> three_of_floats = in_place(arrays_of_floats, samples, 1, samples);
  const Contour<3, double> plain = extract<double>(image, 0.01, options);
  std::array<std::vector<const double*>, 3> lines;
  for (std::size_t a = 0; a < 3; ++a) lines[a] = needed_lines(plain, n, three[a].values.data(), sizeof(double));
  const auto float_lines = needed_lines(plain, n, floats[0].points.floats(), 4 * sizeof(float));
  const auto double_lines = needed_lines(plain, n, doubles[0].points.doubles(), 4 * sizeof(double));
  const auto curved = [&](const std::vector<CurvedAxis>& axes) {
    return extract_curved(image, axes, 0.01, options).vertices.size();
  };
  const auto periodic = [&](std::vector<int> axes) {
    return extract_periodic(image, sample_periods<3>(grid, axes), 0.01, options).vertices.size();
  };
  std::vector<Grids> cases = {{"plain", [&] { return extract(image, 0.01, options).vertices.size(); }},
                              {"two coordinates in 2D arrays", [&] { return curved(two); }},
                              {"two, by points (float)", [&] { return curved(two_by_points); }},
                              {"three, by points (float)", [&] { return curved(floats); }},
                              {"three, by points (double)", [&] { return curved(doubles); }},
                              {"three, in place, 12 bytes a sample", [&] { return curved(floats_in_place); }},
                              {"three, in place, 24 bytes a sample", [&] { return curved(doubles_in_place); }},
                              {"three coordinates in 3D arrays (float)", [&] { return curved(three_of_floats); }},
                              {"three coordinates in 3D arrays", [&] { return curved(three); }},
                              {"reading the lines of the three arrays once",
                               [&] {
                                 double sum = 0.0;
                                 for (const auto& of_axis : lines) sum += read_lines(of_axis);
                                 return std::isfinite(sum) ? plain.vertices.size() : 0;
                               }},
                              {"reading the lines of the points (float) once",
                               [&] { return std::isfinite(read_lines(float_lines)) ? plain.vertices.size() : 0; }},
                              {"reading the lines of the points (double) once",
                               [&] { return std::isfinite(read_lines(double_lines)) ? plain.vertices.size() : 0; }},
                              {"last axis periodic", [&] { return periodic({2}); }},
                              {"first axis periodic", [&] { return periodic({0}); }},
                              {"all axes periodic", [&] {
                                 return periodic({0, 1, 2});
                               }}};
  const auto measure = [&](Grids& each, bool is_rehearsal) {
    const double start = bench::worked_seconds();
    each.vertices = each.run();
    if (!is_rehearsal) each.seconds.push_back(bench::worked_seconds() - start);
  };
  for (int run = 0; run <= runs; ++run)
    for (Grids& each : cases) measure(each, run == 0);
  // apart, as the contour after it would take longer
  cases.push_back({"storing three arrays by points (float)", [&] { return by_points(rounded, 1)[0].size(); }});
  for (int run = 0; run <= runs; ++run) measure(cases.back(), run == 0);
  cases.push_back({"finding folds of three arrays",
                   [&] { return static_cast<std::size_t>(find_folds<3>(grid, three, options.work).cells); }});
  for (int run = 0; run <= runs; ++run) measure(cases.back(), run == 0);
  for (Grids& each : cases) std::sort(each.seconds.begin(), each.seconds.end());
  const auto median = [](const Grids& of) { return of.seconds[of.seconds.size() / 2]; };
  std::printf("| %zu^3 samples | vertices | median, ms | minimum, ms | median by the plain one | minimum by it |\n", n);
  std::printf("|---|---|---|---|---|---|\n");
  for (const Grids& each : cases)
    std::printf("| %s | %zu | %.1f | %.1f | %.2f | %.2f |\n", each.name, each.vertices, 1e3 * median(each),
                1e3 * each.seconds.front(), median(each) / median(cases.front()),
                each.seconds.front() / cases.front().seconds.front());
  return 0;
}

/// A field of four coordinates, sampled at n^4 places.
struct Field4 {
  const char* name;
  std::size_t n;
  std::function<double(const std::array<double, 4>&)> value;
};

/// The samples of a field on a lattice, or on a cubic grid, with steps of equal volume around the origin.
std::vector<float> sampled(const Field4& field, std::optional<Lattice> lattice) {
  const std::size_t layers = lattice == Lattice::fcc_in_time ? 2 : 3;
  const double layer = lattice ? layer_step(*lattice) : 1.0, step = std::pow(layer, -0.25);
  std::vector<float> values;
  std::array<std::size_t, 4> i{};
  for (i[3] = 0; i[3] < field.n; ++i[3])
    for (i[2] = 0; i[2] < field.n; ++i[2])
      for (i[1] = 0; i[1] < field.n; ++i[1])
        for (i[0] = 0; i[0] < field.n; ++i[0]) {
          std::array<double, 4> x;
          for (std::size_t a = 0; a < 4; ++a) {
            const double half = lattice && a < layers && i[layers] % 2 == 1 ? 0.5 : 0.0;
            const double at = static_cast<double>(i[a]) + half - 0.5 * static_cast<double>(field.n);
            x[a] = at * step * (lattice && a == layers ? layer : 1.0);
          }
          values.push_back(static_cast<float>(field.value(x)));
        }
  return values;
}

/// The most memory of a contour beyond the image and the contour, in bytes.
double working_memory(const std::function<Extraction<4, float>()>& extract) {
  bench::give_back_memory();
  const std::uint64_t before = bench::memory_bytes("VmRSS");
  bench::reset_peak_memory();
  const Extraction<4, float> result = extract();
  const std::size_t contour = sizeof(result.contour.vertices[0]) * result.contour.vertices.size() +
                              sizeof(result.contour.simplices[0]) * result.contour.simplices.size();
  return static_cast<double>(bench::memory_bytes("VmHWM")) - static_cast<double>(before) - static_cast<double>(contour);
}

/// Contours of one field in 4D.
void measure_field(const Field4& field, int runs) {
  ExtractOptions options;
  options.work.threads = 1;
  options.triangulation = Triangulation::compact;
  const Grid<4> grid = Grid<4>::unit({field.n, field.n, field.n, field.n});
  std::vector<Case> cases;
  std::vector<double> memory;
  const std::vector<float> cubic = sampled(field, {});
  const std::vector<float> d4 = sampled(field, Lattice::d4), fcc = sampled(field, Lattice::fcc_in_time);
  const auto add = [&](const std::string& name, std::function<Extraction<4, float>()> extract) {
    memory.push_back(working_memory(extract));
    cases.push_back({std::string(field.name) + ", " + name, [extract] { return extract().stats; }});
  };
  const auto add_lattice = [&](Lattice lattice, const std::vector<float>& values) {
    const Image<float, 4> image(values.data(), grid);
    const std::string name(name_of(lattice));
    add(name, [=] { return extract_lattice_with_stats(image, lattice, 0.01, options); });
    add(name + ", complex", [=] { return extract_with_stats(lattice_complex(image, lattice), 0.01, options); });
  };
  add("cubic", [&] { return extract_with_stats(Image<float, 4>(cubic.data(), grid), 0.01, options); });
  add_lattice(Lattice::d4, d4);
  add_lattice(Lattice::fcc_in_time, fcc);
  measure_in_turn(cases, runs);
  const auto samples = static_cast<double>(cubic.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
    std::printf("| %s | %zu | %zu | %.2f | %.3f | %.3f | %.1f | %.2f |\n", cases[i].name.c_str(), cubic.size(),
                static_cast<std::size_t>(cases[i].best.active_tiles), 1e3 * cases[i].seconds,
                1e9 * cases[i].best.classify_seconds / samples, 1e9 * cases[i].seconds / samples,
                1e9 * cases[i].seconds / static_cast<double>(cases[i].best.active_tiles), memory[i] / samples);
}

/// Contours in 4D.
int measure_4d(std::size_t n, int runs) {
  std::printf(
      "| contour | samples | active cells | ms | classify, ns per sample | ns per sample | ns per active cell | "
      "working "
      "memory, bytes per sample |\n|---|---|---|---|---|---|---|---|\n");
  const double turn = 2.0 * std::numbers::pi / 20.0;
  measure_field({"waves", n,
                 [&](const std::array<double, 4>& x) {
                   double sum = 0.0;
                   for (std::size_t a = 0; a < 4; ++a) sum += std::sin(turn * x[a]) * std::cos(turn * x[(a + 1) % 4]);
                   return sum;
                 }},
                runs);
  measure_field({"a small ball", n,
                 [](const std::array<double, 4>& x) { return 2.5 - std::hypot(std::hypot(x[0], x[1], x[2]), x[3]); }},
                runs);
  std::mt19937 random(1);
  measure_field(
      {"noise", n * 3 / 5,
       [&](const std::array<double, 4>&) { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }},
      runs);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "curved")
    return measure_curved(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 256,
                          argc > 3 ? std::max(1, std::atoi(argv[3])) : 15);
  if (argc > 1 && std::string_view(argv[1]) == "4d")
    return measure_4d(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 40,
                      argc > 3 ? std::max(1, std::atoi(argv[3])) : 5);
  const std::size_t n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 192;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 7;
  ExtractOptions options;
  options.work.threads = 1;
  const Grid<3> grid = Grid<3>::unit({n, n, n});
  const std::vector<float> cubic = gyroid(n, 1.0);
  const std::vector<float> fcc = gyroid(n, layer_step(Lattice::fcc)), bcc = gyroid(n, layer_step(Lattice::bcc));
  const Image<float, 3> cubic_image(cubic.data(), grid), fcc_image(fcc.data(), grid), bcc_image(bcc.data(), grid);
  const Complex<3> complex = lattice_complex(fcc_image, Lattice::fcc);
  std::vector<Case> cases = {
      {"cubic", [&] { return extract_with_stats(cubic_image, 0.01, options).stats; }},
      {"fcc", [&] { return extract_lattice_with_stats(fcc_image, Lattice::fcc, 0.01, options).stats; }},
      {"bcc", [&] { return extract_lattice_with_stats(bcc_image, Lattice::bcc, 0.01, options).stats; }},
      {"fcc, complex", [&] { return extract_with_stats(complex, 0.01, options).stats; }}};
  measure_in_turn(cases, runs);
  std::printf(
      "| %zu^3 samples | active cells | ms | classify, ns per sample | ns per active cell |\n|---|---|---|---|---|\n",
      n);
  const auto samples = static_cast<double>(n * n * n);
  for (const Case& each : cases)
    std::printf("| %s | %zu | %.1f | %.3f | %.1f |\n", each.name.c_str(),
                static_cast<std::size_t>(each.best.active_tiles), 1e3 * each.seconds,
                1e9 * each.best.classify_seconds / samples,
                1e9 * each.seconds / static_cast<double>(each.best.active_tiles));
}
