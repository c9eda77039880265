// SPDX-License-Identifier: BSD-3-Clause
//
// tile_intersections: random images of one tile, and how many of their contours intersect themselves. Simplices of
// different tiles never intersect, as each simplex lies in its tile. With --bias: the total content that the contours
// of noise and of its negative enclose.
//
//     tile_intersections --dimension 3 --ambiguity mean --positions log-uniform --tiles 100000 --shapes
//     tile_intersections --dimension 4 --ambiguity low --triangulation barycentric --searched --tiles 100000
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "five_intersections.hpp"
#include "run_program.hpp"
#include "support/interpolant_distance.hpp"
#include "support/nested_tiles.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"
#include "tile_pairs.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace {

using namespace tegl;

/// Absolute differences of the corners' values from the isovalue: all equal, so that points on edges are in the middle;
/// uniform in (0, 1]; or exp(uniform(-k, k)).
enum class Positions { middle, uniform, log_uniform };

struct Settings {
  int dimension = 3;
  Ambiguity ambiguity = Ambiguity::low;
  Triangulation triangulation = Triangulation::compact;
  std::uint64_t tiles = 100'000;
  Positions positions = Positions::uniform;
  double spread = std::log(1000.0) / 2;  ///< k
  unsigned threads = 0;
  std::uint64_t seed = 1994;
  bool lists = false;       ///< the tiles with intersections
  bool has_shapes = false;  ///< counts tiles of balls and others
  bool is_bias = false;
  bool is_nested = false;                 ///< only tiles that are filled by nested copies, with their random choices
  bool has_copies = false;                ///< only contours with copies of corners are tested
  bool is_searched = false;               ///< only signatures whose table entry is searched, not proved
  std::vector<std::uint64_t> signatures;  ///< the signatures to sample; if empty, all with a contour

  [[nodiscard]] ExtractOptions extraction() const {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    options.triangulation = triangulation;
    options.work.threads = 1;
    if (ambiguity == Ambiguity::custom) options.estimator.choose = random_choice;
    return options;
  }

 private:
  /// `custom`: separate, low or high at random, by a hash of the face's axes and values (splitmix64).
  static tile::Choice random_choice(const AmbiguousFace& face) {
    std::uint64_t hash = face.axes();
    for (const double value : face.values()) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) + 0x9e3779b97f4a7c15u;
      hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
      hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
      hash ^= hash >> 31;
    }
    return static_cast<tile::Choice>(hash % 3);
  }
};

struct Counts {
  std::uint64_t tiles = 0, active = 0, simplices = 0, hit = 0, pairs = 0, with_flat = 0, flat = 0;
  std::uint64_t exact = 0;                   ///< pairs of 5D that were decided by integers
  std::uint64_t others = 0, others_hit = 0;  ///< tiles with a component that is no ball

  void add(const Counts& other) {
    for (auto member : {&Counts::tiles, &Counts::active, &Counts::simplices, &Counts::hit, &Counts::pairs,
                        &Counts::with_flat, &Counts::flat, &Counts::exact, &Counts::others, &Counts::others_hit})
      this->*member += other.*member;
  }
};

double difference(const Settings& settings, std::mt19937_64& bits) {
  const double share = static_cast<double>(bits() >> 11) * 0x1p-53;
  if (settings.positions == Positions::middle) return 1.0;
  if (settings.positions == Positions::uniform) return 1.0 - share;
  return std::exp(settings.spread * (2.0 * share - 1.0));
}

template <int N>
Grid<N> unit_grid(std::size_t samples) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  return Grid<N>::unit(sizes);
}

template <int N>
std::string text_of(std::uint64_t tile, const std::array<double, std::size_t{1} << N>& values, std::uint64_t pairs,
                    std::uint64_t flat, double depth) {
  std::string text = fmt::format("tile {}: {} pairs, {} flat, depth {:.3g}; values", tile, pairs, flat, depth);
  for (const double value : values) text += fmt::format(" {:.17g}", value);
  return text + "\n";
}

/// Adds the signatures that the symmetries of the 4-cube map a signature to; returns their number.
std::size_t add_class(std::uint64_t signature, std::set<std::uint64_t>& signatures) {
  constexpr unsigned kAxes = 4, kCorners = 1u << kAxes;
  std::set<std::uint64_t> found;
  std::array<unsigned, kAxes> axes;
  std::iota(axes.begin(), axes.end(), 0u);
  do {
    for (unsigned reflected = 0; reflected < kCorners; ++reflected) {
      std::uint64_t image = 0;
      for (unsigned v = 0; v < kCorners; ++v) {
        unsigned corner = 0;
        for (unsigned a = 0; a < kAxes; ++a) corner |= (v >> a & 1u) << axes[a];
        image |= (signature >> v & 1u) << (corner ^ reflected);
      }
      found.insert(image);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  signatures.insert(found.begin(), found.end());
  return found.size();
}

/// The signatures of 4D whose table entry is not proved to be embedded, but searched, by the manifest of the tables.
std::vector<std::uint64_t> searched_signatures(const Settings& settings) {
  const bool is_low = settings.ambiguity == Ambiguity::low;
  if (settings.dimension != 4 || (!is_low && settings.ambiguity != Ambiguity::high))
    throw Error(ErrorCode::InvalidArgument, "--searched; expected --dimension 4 and --ambiguity low or high");
  constexpr const char* kManifest = TEGL_SOURCE_DIR "/generated/MANIFEST.json";
  std::ifstream in(kManifest);
  if (!in) throw Error(ErrorCode::FileNotFound, fmt::format("{}: cannot be read", kManifest));
  const char* triangulation = settings.triangulation == Triangulation::compact ? "compact" : "barycentric";
  std::set<std::uint64_t> found;
  std::size_t expected = 0;
  for (const nlohmann::json& tables : nlohmann::json::parse(in)) {
    if (tables.value("dim", 0) != 4) continue;
    for (const nlohmann::json& table : tables.at("certified")) {
      if (table.at("alternative") != (is_low ? "low" : "high") || table.at("triangulation") != triangulation) continue;
      expected += table.at("embedded_searched").get<std::size_t>();
      if (!table.contains("search")) continue;
      for (const nlohmann::json& entry : table.at("search").at("classes"))
        if (add_class(entry.at("signature").get<std::uint64_t>(), found) != entry.at("entries").get<std::size_t>())
          throw Error(ErrorCode::MalformedFile, fmt::format("{}: a class has another number of entries", kManifest));
    }
  }
  if (found.size() != expected)
    throw Error(ErrorCode::MalformedFile,
                fmt::format("{}: {} entries in the classes; expected {}", kManifest, found.size(), expected));
  if (found.empty()) throw Error(ErrorCode::InvalidArgument, "--searched: all entries of this table are proved");
  return {found.begin(), found.end()};
}

/// Tests the tiles first ... end - 1 with random numbers that depend on the number of the part only.
template <int N>
Counts count_part(const Settings& settings, std::uint64_t first, std::uint64_t end, std::string& list) {
  constexpr std::size_t kCorners = std::size_t{1} << N;
  constexpr std::uint64_t kActive = (std::uint64_t{1} << kCorners) - 2;  // signatures with a contour
  std::seed_seq seeds{settings.seed, settings.seed >> 32, first, first >> 32};
  std::mt19937_64 bits(seeds);
  ExtractOptions extraction = settings.extraction();
  [[maybe_unused]] test::NestedTiles nested(settings.triangulation);
  [[maybe_unused]] detail::ResolvedKey key;
  if (settings.is_nested)
    extraction.estimator.choose = [&](const AmbiguousFace& face) { return test::choice_of(key, face); };
  const Grid<N> grid = unit_grid<N>(2);
  [[maybe_unused]] std::conditional_t<(N < 5), bench::TilePairs<N>, int> all_pairs{};
  Counts counts;
  for (std::uint64_t tile = first; tile < end; ++tile) {
    // middle positions have no other freedom than the signature: all in turn
    const std::uint64_t number = settings.positions == Positions::middle ? tile : bits();
    if (settings.is_nested) key = nested(bits);
    const std::uint64_t signature = settings.is_nested ? key.signature
                                    : settings.signatures.empty()
                                        ? 1 + number % kActive
                                        : settings.signatures[number % settings.signatures.size()];
    std::array<double, kCorners> values;
    for (std::size_t v = 0; v < kCorners; ++v)
      values[v] = (signature >> v & 1u) != 0 ? difference(settings, bits) : -difference(settings, bits);
    const auto contour = extract<double>(Image<double, N>(values.data(), grid), 0.0, extraction);
    if (settings.has_copies &&
        std::none_of(contour.vertices.begin(), contour.vertices.end(), test::is_copy_of_corner<N, double>))
      continue;
    std::uint64_t pairs = 0, flat = 0;
    double depth = 0.0;
    if constexpr (N == 5) {
      const bench::FiveIntersections found = bench::FivePairs(contour).intersections();
      pairs = found.pairs.size();
      flat = found.flat;
      counts.exact += found.exact;
    } else if (!all_pairs.is_embedded(contour)) {
      IntersectionOptions<N> options;
      options.work.threads = 1;
      const Intersections<N> found = find_intersections(contour, options);
      pairs = found.pair_count;
      flat = found.flat;
      depth = found.depth;
    }
    const bool is_hit = pairs > 0;
    ++counts.tiles;
    counts.active += contour.simplices.empty() ? 0 : 1;
    counts.simplices += contour.simplices.size();
    counts.hit += is_hit ? 1 : 0;
    counts.pairs += pairs;
    counts.with_flat += flat > 0 ? 1 : 0;
    counts.flat += flat;
    if constexpr (N < 5) {
      if (settings.has_shapes) {
        const MeshReport report = check(contour, extraction.work);
        const bool is_other = report.euler != static_cast<std::int64_t>(report.components);
        counts.others += is_other ? 1 : 0;
        counts.others_hit += is_other && is_hit ? 1 : 0;
      }
    }
    if (settings.lists && (is_hit || flat > 0)) list += text_of<N>(tile, values, pairs, flat, depth);
  }
  return counts;
}

template <int N>
void count_tiles(const Settings& settings) {
  constexpr std::uint64_t kPart = 4096;
  const std::uint64_t parts = (settings.tiles + kPart - 1) / kPart;
  std::vector<Counts> counts(parts);
  std::vector<std::string> lists(parts);
  std::atomic<std::uint64_t> next = 0;
  std::exception_ptr failure;
  std::mutex of_failure;
  const auto work = [&] {
    try {
      for (std::uint64_t part = next++; part < parts; part = next++)
        counts[part] = count_part<N>(settings, part * kPart, std::min(settings.tiles, (part + 1) * kPart), lists[part]);
    } catch (...) {
      const std::scoped_lock lock(of_failure);
      if (!failure) failure = std::current_exception();
      next = parts;
    }
  };
  const double start = bench::worked_seconds();
  {
    const unsigned threads =
        settings.threads != 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  const double seconds = bench::worked_seconds() - start;
  Counts all;
  for (const Counts& part : counts) all.add(part);
  for (const std::string& list : lists) std::fputs(list.c_str(), stdout);
  fmt::print(
      "{} tiles, {} with simplices ({} simplices): {} with intersections ({} pairs), {} with flat simplices ({}), "
      "{:.1f} us of processor time per tile\n",
      all.tiles, all.active, all.simplices, all.hit, all.pairs, all.with_flat, all.flat,
      1e6 * seconds / static_cast<double>(std::max<std::uint64_t>(all.tiles, 1)));
  if constexpr (N == 5) fmt::print("{} pairs decided by integers\n", all.exact);
  if (settings.has_shapes)
    fmt::print("of balls only: {} tiles, {} with intersections; others: {} tiles, {} with intersections\n",
               all.tiles - all.others, all.hit - all.others_hit, all.others, all.others_hit);
}

/// The shares of the box that noise and its negative enclose, closed at the border.
template <int N>
void print_bias(const Settings& settings) {
  constexpr std::size_t kSamples = N == 3 ? 48 : 12;
  std::mt19937_64 bits(settings.seed);
  const double box = std::pow(static_cast<double>(kSamples - 1), N);
  std::vector<double> values(static_cast<std::size_t>(std::pow(static_cast<double>(kSamples), N) + 0.5));
  for (double& value : values) value = static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0;
  ExtractOptions options = settings.extraction();
  options.close = true;
  const auto share = [&] {
    const Image<double, N> image(values.data(), unit_grid<N>(kSamples));
    return measure(extract<double>(image, 0.0, options)).content.value_or(0.0) / box;
  };
  const double high = share();
  for (double& value : values) value = -value;
  const double low = share();
  fmt::print("noise of {} samples along each axis: encloses {:.4f} of the box, its negative {:.4f}, sum {:.4f}\n",
             kSamples, high, low, high + low);
}

constexpr const char* kUsage =
    "tile_intersections [options]: random images of one tile whose contours intersect themselves\n"
    "  --dimension 3|4|5         dimension of the image\n"
    "  --ambiguity NAME          low, high, mean, saddle, squares, decider or custom (random choices)\n"
    "  --triangulation NAME      compact or barycentric\n"
    "  --tiles N                 number of tiles; with middle positions, signatures in turn\n"
    "  --positions NAME          middle, uniform or log-uniform\n"
    "  --spread K                log-uniform: differences from the isovalue are exp(uniform(-K, K)); 3.45\n"
    "  --threads T               0: all of the machine\n"
    "  --seed S                  of the random numbers\n"
    "  --searched                4D low or high: only signatures whose table entry is searched, not proved\n"
    "  --nested                  4D custom: only tiles that are filled by nested copies, with random choices\n"
    "  --copies                  tests only contours with copies of corners inside the cell\n"
    "  --list                    lists the tiles with pairs or flat simplices, with their values\n"
    "  --shapes                  3D, 4D: counts tiles whose components all are balls, and others, separately\n"
    "  --bias                    3D, 4D, instead: what the contours of noise and of its negative enclose\n";

/// The position of a name in a list.
template <std::size_t kCount>
std::size_t choice(std::string_view option, std::string_view name, const std::array<const char*, kCount>& names) {
  for (std::size_t i = 0; i < kCount; ++i)
    if (name == names[i]) return i;
  std::string expected;
  for (const char* known : names) expected += fmt::format("{}{}", expected.empty() ? "" : ", ", known);
  throw Error(ErrorCode::InvalidArgument, fmt::format("{}: '{}'; expected one of {}", option, name, expected));
}

Settings parsed(int argc, char** argv) {
  constexpr std::array kAmbiguities = {"low", "high", "mean", "saddle", "squares", "decider", "custom"};
  static_assert(static_cast<int>(Ambiguity::custom) == 6);
  constexpr std::array kTriangulations = {"compact", "barycentric"};
  constexpr std::array kPositions = {"middle", "uniform", "log-uniform"};
  constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option == "--list" || option == "--shapes" || option == "--bias" || option == "--searched" ||
        option == "--copies" || option == "--nested") {
      (option == "--list"     ? settings.lists
       : option == "--shapes" ? settings.has_shapes
       : option == "--bias"   ? settings.is_bias
       : option == "--copies" ? settings.has_copies
       : option == "--nested" ? settings.is_nested
                              : settings.is_searched) = true;
      continue;
    }
    if (i + 1 == argc)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("'{}'; expected an option and its value; see --help", option));
    const std::string_view value = argv[++i];
    if (option == "--dimension")
      settings.dimension = bench::whole_number(option, value, 3, 5);
    else if (option == "--ambiguity")
      settings.ambiguity = static_cast<Ambiguity>(choice(option, value, kAmbiguities));
    else if (option == "--triangulation")
      settings.triangulation =
          choice(option, value, kTriangulations) == 0 ? Triangulation::compact : Triangulation::barycentric;
    else if (option == "--tiles")
      settings.tiles = bench::whole_number<std::uint64_t>(option, value, 1, kMost);
    else if (option == "--positions")
      settings.positions = static_cast<Positions>(choice(option, value, kPositions));
    else if (option == "--spread")
      settings.spread = bench::real_number(option, value, 0.001, 300.0);
    else if (option == "--threads")
      settings.threads = bench::whole_number(option, value, 0u, 1024u);
    else if (option == "--seed")
      settings.seed = bench::whole_number<std::uint64_t>(option, value, 0, std::numeric_limits<std::uint64_t>::max());
    else
      throw Error(ErrorCode::InvalidArgument, fmt::format("'{}'; expected an option; see --help", option));
  }
  if (settings.dimension == 5 && (settings.has_shapes || settings.is_bias))
    throw Error(ErrorCode::InvalidArgument, "--shapes, --bias; expected --dimension 3 or 4");
  if (settings.is_nested && (settings.dimension != 4 || settings.ambiguity != Ambiguity::custom || settings.is_bias ||
                             settings.positions == Positions::middle))
    throw Error(ErrorCode::InvalidArgument,
                "--nested; expected --dimension 4, --ambiguity custom and random positions, without --bias");
  if (settings.is_bias && (settings.is_searched || settings.lists || settings.has_shapes || settings.has_copies))
    throw Error(ErrorCode::InvalidArgument, "--bias; expected without --searched, --list, --shapes and --copies");
  return settings;
}

int run(int argc, char** argv) {
  if (bench::tells_usage(argc, argv, kUsage)) return 0;
  Settings settings = parsed(argc, argv);
  try {
    if (settings.is_searched) settings.signatures = searched_signatures(settings);
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::MalformedFile, fmt::format("the manifest of the tables: {}", error.what()));
  }
  if (settings.is_bias)
    settings.dimension == 3 ? print_bias<3>(settings) : print_bias<4>(settings);
  else
    settings.dimension == 3   ? count_tiles<3>(settings)
    : settings.dimension == 4 ? count_tiles<4>(settings)
                              : count_tiles<5>(settings);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return tegl::bench::run_program("tile_intersections", argc, argv, run); }
