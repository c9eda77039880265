// SPDX-License-Identifier: BSD-3-Clause
//
// operations [--threads T] [--repetitions R] [--only TEXT] FILE ISO [FILE ISO ...]: the cost of each operation on a 4D
// contour (with --only, of operations with TEXT in their names). Reports the minimum wall time of R (5) repetitions, or
// of fewer if these exceed 10 s in total, the minimum CPU time of all threads (which other work on the machine hardly
// influences), and the peak memory in addition to the image, the contour and the operation's input. Writes a Markdown
// table per file; bench/operations.py runs it with several numbers of threads and keeps the figures.
//
// To add an operation, add a line to `operations_on`, or to a function that it calls.
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "memory.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/elements.hpp"
#include "tegl/extract.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/incidence.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/project.hpp"
#include "tegl/sample.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

/// An operation: does its work and returns a short description of the result.
struct Operation {
  std::string name;
  std::function<std::string()> work;
  std::function<void()> prepare = {};  ///< called before each repetition, not measured
};

/// Input of the operations on a file.
template <Value T>
struct Subject {
  Image<T, 4> image;
  double isovalue;
  unsigned threads;
  Contour<4, double> contour;
  double first;  ///< time range of the contour: first, last
  double last;
  std::unique_ptr<Scrubber<4, double>> scrubber;  ///< made by the operation that builds it
  ComponentLabels labels;                         ///< made by the operation `label_components`
  Contour<4, double> simplified;                  ///< made by the operations `simplify`

  [[nodiscard]] WorkOptions work_options() const { return {threads, {}}; }
  [[nodiscard]] double time(double share) const { return first + share * (last - first); }
  /// Evenly spread times, none of which is a sample's.
  [[nodiscard]] std::vector<double> times(std::size_t count) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < count; ++i)
      result.push_back(time((static_cast<double>(i) + 0.4142) / static_cast<double>(count)));
    return result;
  }
};

std::string counted(std::size_t count, const char* what) { return fmt::format("{} {}", count, what); }

template <Value T>
void add_cuts(Subject<T>& subject, std::vector<Operation>& list) {
  list.push_back({"`slice` at one time", [&] {
                    const auto cut =
                        slice(subject.contour, Hyperplane<4>::across(3, subject.time(0.314)), subject.work_options());
                    return counted(cut.simplices.size(), "triangles");
                  }});
  list.push_back({"`slice` along x", [&] {
                    double x = 0;
                    for (const auto& vertex : subject.contour.vertices) x += vertex[0];
                    x /= static_cast<double>(subject.contour.vertices.size());
                    const auto cut = slice(subject.contour, Hyperplane<4>::across(0, x), subject.work_options());
                    return counted(cut.simplices.size(), "triangles");
                  }});
  list.push_back({"`slice_stack`, 100 times", [&] {
                    std::vector<Hyperplane<4>> hyperplanes;
                    for (const double t : subject.times(100)) hyperplanes.push_back(Hyperplane<4>::across(3, t));
                    const auto cuts = slice_stack(subject.contour, hyperplanes, subject.work_options());
                    std::size_t triangles = 0;
                    for (const auto& cut : cuts) triangles += cut.simplices.size();
                    return counted(triangles, "triangles");
                  }});
  list.push_back({"`Scrubber`: build", [&] {
                    subject.scrubber.reset();
                    subject.scrubber =
                        std::make_unique<Scrubber<4, double>>(subject.contour, Hyperplane<4>{}, subject.work_options());
                    return fmt::format("{:.1f} MB kept", static_cast<double>(subject.scrubber->memory()) * 1e-6);
                  }});
  list.push_back({"`Scrubber`: a cut",
                  [&] { return counted(subject.scrubber->cut(subject.time(0.314)).simplices.size(), "triangles"); }});
}

template <Value T>
void add_parts(Subject<T>& subject, std::vector<Operation>& list) {
  list.push_back({"`label_components`", [&] {
                    subject.labels = label_components(subject.contour, subject.work_options());
                    return counted(subject.labels.count, "components");
                  }});
  const auto label = [&] {  // for those that run alone
    if (subject.labels.vertices.empty()) subject.labels = label_components(subject.contour, subject.work_options());
  };
  list.push_back({"`components`", [&, label] {
                    label();
                    const auto found = components(subject.contour, subject.labels, subject.work_options());
                    std::uint64_t largest = 0;
                    for (const auto& component : found) largest = std::max(largest, component.simplices);
                    return fmt::format("the largest has {} tetrahedra", largest);
                  }});
  list.push_back({"`split_components`", [&, label] {
                    label();
                    return counted(split_components(subject.contour, subject.labels, subject.work_options()).size(),
                                   "contours");
                  }});
  list.push_back(
      {"`measure`", [&] { return fmt::format("size {:.6g}", measure(subject.contour, subject.work_options()).size); }});
  list.push_back({"`measure_cuts`, 1000 times", [&] {
                    const auto cuts = measure_cuts(subject.contour, subject.times(1000), subject.work_options());
                    return fmt::format("areas {:.6g} ... {:.6g}", cuts.front().size, cuts.back().size);
                  }});
}

template <Value T>
void add_tracks(Subject<T>& subject, std::vector<Operation>& list) {
  list.push_back({"`track`", [&] {
                    TrackOptions options;
                    options.work = subject.work_options();
                    const TrackGraph graph = track(subject.contour, options);
                    return fmt::format("{} events, {} tracks", graph.events.size(), graph.tracks.size());
                  }});
  list.push_back({"`track`, measured 100 times", [&] {
                    TrackOptions options;
                    options.work = subject.work_options();
                    options.times = subject.times(100);
                    return counted(track(subject.contour, options).segments.size(), "segments");
                  }});
}

/// Checks, components, measures and tracks of one contour: its incidence is found once, or by each of them.
template <Value T>
void add_several(Subject<T>& subject, std::vector<Operation>& list) {
  const auto all = [&](const auto&... incidence) {
    const WorkOptions work = subject.work_options();
    TrackOptions options;
    options.work = work;
    const ComponentLabels labels = label_components(subject.contour, work);
    const auto links = check(subject.contour, incidence..., work).bad_links;
    const auto parts = components(subject.contour, labels, incidence..., work).size();
    const double size = measure(subject.contour, incidence..., work).size;
    const auto events = track(subject.contour, incidence..., options).events.size();
    return fmt::format("{} bad links, {} components, size {:.6g}, {} events", links, parts, size, events);
  };
  list.push_back({"`Incidence`", [&] {
                    const Incidence<4> incidence(subject.contour, subject.work_options());
                    return counted(incidence.simplex_count(), "tetrahedra");
                  }});
  list.push_back({"`label_components`, `check`, `components`, `measure`, `track`", [all] { return all(); }});
  list.push_back({"the same with one `Incidence`",
                  [&, all] { return all(Incidence<4>(subject.contour, subject.work_options())); }});
}

template <Value T>
void add_fields(Subject<T>& subject, std::vector<Operation>& list) {
  list.push_back({"`sample` (the image itself)", [&] {
                    return counted(
                        sample(subject.image, subject.contour, "value", "", subject.work_options()).values.size(),
                        "values");
                  }});
  list.push_back({"`elements`", [&] {
                    const auto all = elements(subject.contour, subject.work_options());
                    return fmt::format("{} elements, not closed by {:.2g}", all.normals.size(),
                                       sum_of(all).closure_error());
                  }});
  list.push_back({"`elements_by_cell`", [&] {
                    const auto all = elements_by_cell(subject.contour, subject.image.grid(), subject.work_options());
                    return counted(all.normals.size(), "elements");
                  }});
  list.push_back({"`extract_facets`", [&] {
                    ExtractOptions options;
                    options.work.threads = subject.threads;
                    const auto facets = extract_facets<double>(subject.image, subject.isovalue, options);
                    return counted(facets.vertices.size(), "0-facets");
                  }});
  list.push_back({"`project`", [&] {
                    const auto seen = project(subject.contour, {}, subject.work_options());
                    return counted(seen.tetrahedra.size(), "tetrahedra");
                  }});
  list.push_back({"`outline`", [&] {
                    const auto seen = outline(subject.contour, {}, subject.work_options());
                    return counted(seen.simplices.size(), "triangles");
                  }});
}

template <Value T>
void add_simplification(Subject<T>& subject, std::vector<Operation>& list) {
  const auto simplified = [&](SimplifyMethod method, bool measure = false) {
    SimplifyOptions<4> options;
    options.method = method;
    options.ratio = 0.2;
    options.measure = measure;  // the row of `deviation` measures only the bound
    options.work = subject.work_options();
    options.scale = automatic_scale(subject.contour);
    subject.simplified = simplify(subject.contour, options).contour;
    return counted(subject.simplified.simplices.size(), "tetrahedra");
  };
  list.push_back({"`simplify` to a fifth, `facets`", [simplified] { return simplified(SimplifyMethod::facets); }});
  list.push_back({"`simplify` to a fifth, `vertices`", [simplified] { return simplified(SimplifyMethod::vertices); }});
  list.push_back({"`simplify` to a fifth, `quadric`", [simplified] { return simplified(SimplifyMethod::quadric); }});
  list.push_back({"`simplify` to a fifth, `quadric`, with its bound",
                  [simplified] { return simplified(SimplifyMethod::quadric, true); }});
  list.push_back({"`deviation` from the `quadric` one (`simplify`), and back",
                  [&] {
                    DeviationOptions<4> options;
                    options.work = subject.work_options();
                    options.scale = automatic_scale(subject.contour);
                    const Deviation from = deviation(subject.contour, subject.simplified, options);
                    const Deviation back = deviation(subject.simplified, subject.contour, options);
                    return fmt::format("at most {:.3g} and {:.3g}, at least {:.3g} and {:.3g}", from.bound, back.bound,
                                       from.least, back.least);
                  },
                  [&, simplified] {  // if it runs alone
                    if (subject.simplified.simplices.empty()) simplified(SimplifyMethod::quadric, true);
                  }});
}

template <Value T>
std::vector<Operation> operations_on(Subject<T>& subject) {
  std::vector<Operation> list;
  ExtractOptions options;
  options.work.threads = subject.threads;
  list.push_back({"`extract`", [&, options] {
                    return counted(extract<double>(subject.image, subject.isovalue, options).simplices.size(),
                                   "tetrahedra");
                  }});
  options.normals = tegl::Normals::differences;
  list.push_back({"`extract` with gradient normals", [&, options] {
                    return counted(extract<double>(subject.image, subject.isovalue, options).normals.size(), "normals");
                  }});
  list.push_back({"`check`", [&] {
                    const MeshReport report = check(subject.contour, subject.work_options());
                    return fmt::format("{} bad links, Euler characteristic {}", report.bad_links, report.euler);
                  }});
  add_cuts(subject, list);
  add_parts(subject, list);
  add_tracks(subject, list);
  add_several(subject, list);
  add_fields(subject, list);
  add_simplification(subject, list);
  return list;
}

std::string milliseconds(double seconds) {
  return seconds < 0.1 ? fmt::format("{:.2f} ms", seconds * 1e3) : fmt::format("{:.0f} ms", seconds * 1e3);
}

constexpr double kLongEnough = 10.0;  ///< seconds after which an operation is not repeated

/// Runs the operations and prints their table.
template <Value T>
void run(Subject<T>& subject, int repetitions, const std::string& only) {
  fmt::print("| operation | time | processor time | memory | result |\n|---|---|---|---|---|\n");
  for (const Operation& operation : operations_on(subject)) {
    if (operation.name.find(only) == std::string::npos) continue;
    double least = 0;
    double least_cpu = 0;
    double most_memory = 0;
    double all = 0;
    std::string result;
    // minima over the repetitions
    for (int r = 0; r < repetitions && all < kLongEnough; ++r) {
      if (operation.prepare) operation.prepare();
      malloc_trim(0);  // memory freed earlier must not count as in use
      reset_peak_memory();
      const std::uint64_t before = memory_bytes("VmRSS");
      const std::clock_t cpu_start = std::clock();
      const auto start = std::chrono::steady_clock::now();
      result = operation.work();
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
      all += seconds.count();
      const std::uint64_t peak = memory_bytes("VmHWM");
      least = r == 0 ? seconds.count() : std::min(least, seconds.count());
      least_cpu = r == 0 ? cpu : std::min(least_cpu, cpu);
      most_memory = std::max(most_memory, static_cast<double>(peak > before ? peak - before : 0));
    }
    fmt::print("| {} | {} | {} | {:.1f} MB | {} |\n", operation.name, milliseconds(least), milliseconds(least_cpu),
               most_memory * 1e-6, result);
    std::fflush(stdout);
  }
}

template <Value T>
void run_file(const Image<T, 4>& image, double isovalue, unsigned threads, int repetitions, const std::string& only) {
  ExtractOptions options;
  options.work.threads = threads;
  Subject<T> subject{image, isovalue, threads, extract<double>(image, isovalue, options), 0, 0, nullptr, {}, {}};
  if (subject.contour.vertices.empty()) throw Error(ErrorCode::InvalidArgument, "the contour is empty");
  const auto [least, most] = std::minmax_element(subject.contour.vertices.begin(), subject.contour.vertices.end(),
                                                 [](const auto& a, const auto& b) { return a[3] < b[3]; });
  subject.first = (*least)[3];
  subject.last = (*most)[3];
  fmt::print("{} tetrahedra, {} vertices; the contour takes {:.1f} MB\n\n", subject.contour.simplices.size(),
             subject.contour.vertices.size(),
             static_cast<double>(subject.contour.simplices.size() * sizeof(subject.contour.simplices[0]) +
                                 subject.contour.vertices.size() * sizeof(subject.contour.vertices[0])) *
                 1e-6);
  run(subject, repetitions, only);
}

int run_all(std::vector<std::string> arguments) {
  unsigned threads = 0;
  int repetitions = 5;
  std::string only;
  std::vector<std::string> rest;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--threads" && i + 1 < arguments.size())
      threads = static_cast<unsigned>(std::stoul(arguments[++i]));
    else if (arguments[i] == "--repetitions" && i + 1 < arguments.size())
      repetitions = std::stoi(arguments[++i]);
    else if (arguments[i] == "--only" && i + 1 < arguments.size())
      only = arguments[++i];
    else
      rest.push_back(arguments[i]);
  }
  if (rest.empty() || rest.size() % 2 != 0 || repetitions < 1) {
    fmt::print(stderr, "operations [--threads T] [--repetitions R] [--only TEXT] FILE ISO [FILE ISO ...]\n");
    return 2;
  }
  for (std::size_t i = 0; i < rest.size(); i += 2) {
    const ReadImageResult input = read_image(rest[i]);
    const double isovalue = std::stod(rest[i + 1]);
    fmt::print("\n### {} at {}\n\n", std::filesystem::path(rest[i]).filename().string(), rest[i + 1]);
    const auto of_image = [&]<Value T, int N>(const OwnedImage<T, N>& image) {
      if constexpr (N == 4)
        run_file(image.view(), isovalue, threads, repetitions, only);
      else
        throw Error(ErrorCode::UnsupportedData, fmt::format("{}: a {}D image; expected a 4D one", rest[i], N));
    };
    std::visit([&](const auto& typed) { std::visit(of_image, typed); }, input.image);
  }
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv,
                               "operations [--threads T] [--repetitions R] [--only TEXT] FILE ISO [FILE ISO ...]"))
    return 0;
  try {
    return tegl::bench::run_all({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "operations: {}\n", error.what());
    return 1;
  }
}
