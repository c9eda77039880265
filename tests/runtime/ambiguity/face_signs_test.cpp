// SPDX-License-Identifier: BSD-3-Clause
//
// Batched decisions on the faces of many tiles (face_signs.hpp, cube_words.hpp) against single decisions.
#include "ambiguity/face_signs.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ambiguity/connected_sides.hpp"
#include "ambiguity/cube_lists.hpp"
#include "ambiguity/cube_words.hpp"
#include "ambiguity/face_estimator.hpp"
#include "ambiguity/saddle.hpp"
#include "builder4_lookup.hpp"
#include "only_targets.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/tesseract_fill.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {
namespace {

/// A kind of samples, with an isovalue.
struct Kind {
  const char* name;
  std::function<double(std::mt19937_64&)> sample;
  double isovalue;
  bool is_sure;  ///< the batch must decide all faces: no case is within rounding errors, or nothing is rounded
};

double uniform(std::mt19937_64& random) { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }

std::vector<Kind> kinds() {
  using Random = std::mt19937_64;
  const auto pick = [](std::vector<double> values) {
    return [values = std::move(values)](Random& random) { return values[random() % values.size()]; };
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {
      {"noise", [](Random& random) { return static_cast<double>(static_cast<float>(uniform(random))); }, 0.0, true},
      {"noise in doubles", uniform, 0.1, true},
      {"masks", pick({0.0, 1.0}), 0.5, true},
      {"bytes", [](Random& random) { return static_cast<double>(random() % 256); }, 128.0, true},
      {"bytes beside a fraction", [](Random& random) { return static_cast<double>(random() % 4); }, 1.3, false},
      {"few whole numbers", [](Random& random) { return static_cast<double>(random() % 5) - 2.0; }, 0.0, true},
      {"zeros of both signs", pick({-0.0, 0.0, -1.0, 1.0}), 0.0, true},
      {"tenths", [](Random& random) { return 0.1 * static_cast<double>(random() % 5); }, 0.2, false},
      {"next to each other", [](Random& random) { return 1.0 + static_cast<double>(random() % 5) * 0x1p-52; },
       1.0 + 0x1p-51, false},
      {"of all sizes",
       [](Random& random) { return std::ldexp(uniform(random), static_cast<int>(random() % 2000) - 1000); }, 0.0,
       false},
      {"large beside small",
       [](Random& random) { return std::ldexp(uniform(random), static_cast<int>(random() % 40)); }, 0.1, false},
      {"tiny", [](Random& random) { return std::ldexp(uniform(random), -1060); }, 0.0, false},
      {"round-off beside whole numbers", pick({-1e-60, 1e-60, -1.0, 1.0}), 0.0, false},
      {"as small as the smallest floats", [](Random& random) { return std::ldexp(uniform(random), -147); }, 0.0, false},
      {"huge", pick({-1.7e308, -1.6e308, 1.6e308, 1.7e308}), 0.0, false},
      {"infinite", pick({-kInfinity, kInfinity, -1.0, 1.0}), 0.0, false},
  };
}

template <int N>
FaceBlock<N> random_block(const Kind& kind, std::size_t tiles, std::mt19937_64& random) {
  FaceBlock<N> block;
  block.tiles = tiles;
  for (auto& row : block.samples) {
    row.fill(0.0);
    for (std::size_t i = 0; i <= tiles; ++i) row[i] = kind.sample(random);
  }
  return block;
}

/// The values at the corners of a face of tile `bit`, in the face's own order.
template <int N>
std::vector<double> face_values(const FaceBlock<N>& block, std::size_t bit, unsigned axes, unsigned base) {
  std::vector<double> values;
  for (unsigned corner = 0; corner < 1u << N; ++corner)
    if ((corner & ~axes) == base) values.push_back(block.samples[corner >> 1][bit + (corner & 1u)]);
  return values;
}

/// Face numbers as documented in face_signs.hpp.
template <int N>
unsigned number_of(unsigned axes, unsigned base) {
  const unsigned across = ((1u << N) - 1) & ~axes;
  if (N == 4 && across == 0) return kTesseractFace;
  if (N == 3 && across == 0) return kFirstCube<3>;
  const auto axis = static_cast<unsigned>(std::countr_zero(across));
  if (std::popcount(across) == 1) return (N == 3 ? 0 : kFirstCube<4>)+2 * axis + (base >> axis & 1u);
  unsigned number = 0;
  while (kTesseractSquares[number].axes != axes || kTesseractSquares[number].base != base) ++number;
  return number;
}

template <int N>
void for_all_faces(const std::function<void(unsigned axes, unsigned base, unsigned number)>& visit) {
  for (unsigned axes = 0; axes < 1u << N; ++axes)
    for (unsigned base = 0; base < 1u << N; ++base)
      if ((axes & base) == 0 && std::popcount(axes) >= 2) visit(axes, base, number_of<N>(axes, base));
}

bool is_ambiguous(const std::vector<double>& square, double isovalue) {
  const auto high = [&](std::size_t v) { return square[v] >= isovalue; };
  return high(0) == high(3) && high(1) == high(2) && high(0) != high(1);
}

template <int N>
void compare_means(const Kind& kind) {
  std::mt19937_64 random(1);
  for (const std::size_t tiles : {64, 64, 1, 7, 8, 9, 63}) {
    FaceBlock<N> block = random_block<N>(kind, tiles, random);
    decide_by_means(block, kind.isovalue);
    EXPECT_EQ(block.unsure >> (tiles - 1) >> 1, 0u) << "of tiles that there are not";
    for (std::size_t bit = 0; bit < tiles; ++bit) {
      EXPECT_TRUE(!kind.is_sure || (block.unsure >> bit & 1u) == 0) << kind.name;
      if ((block.unsure >> bit & 1u) != 0) continue;
      for_all_faces<N>([&](unsigned axes, unsigned base, unsigned number) {
        const auto values = face_values(block, bit, axes, base);
        ASSERT_EQ((block.high[bit] >> number & 1u) != 0, is_mean_high(values, kind.isovalue))
            << kind.name << ", axes " << axes << ", base " << base;
      });
    }
  }
}

template <int N>
void compare_saddles(const Kind& kind) {
  std::mt19937_64 random(2);
  for (const std::size_t tiles : {64, 64, 64, 1, 7, 8, 9, 63}) {
    FaceBlock<N> block = random_block<N>(kind, tiles, random);
    decide_by_saddles(block, kind.isovalue);
    EXPECT_EQ(block.unsure >> (tiles - 1) >> 1, 0u) << "of tiles that there are not";
    for (std::size_t bit = 0; bit < tiles; ++bit) {
      EXPECT_TRUE(!kind.is_sure || (block.unsure >> bit & 1u) == 0) << kind.name;
      if ((block.unsure >> bit & 1u) != 0) continue;
      for_all_faces<N>([&](unsigned axes, unsigned base, unsigned number) {
        const auto values = face_values(block, bit, axes, base);
        const bool is_high = (block.high[bit] >> number & 1u) != 0;
        if (values.size() == 4 && is_ambiguous(values, kind.isovalue)) {
          ASSERT_EQ(is_high, square_is_high_exactly({values[0], values[1], values[2], values[3]}, kind.isovalue))
              << kind.name << ", axes " << axes << ", base " << base;
        } else if (values.size() == 16) {
          ASSERT_EQ(is_high, is_mean_high(values, kind.isovalue)) << kind.name;
        }
      });
    }
  }
}

TEST(FaceSigns, MeansAreThoseOfEachFaceByItself) {
  test::with_all_targets([] {
    for (const Kind& kind : kinds()) {
      compare_means<3>(kind);
      compare_means<4>(kind);
    }
  });
}

TEST(FaceSigns, SaddlesAreThoseOfEachSquareByItself) {
  test::with_all_targets([] {
    for (const Kind& kind : kinds()) {
      compare_saddles<3>(kind);
      compare_saddles<4>(kind);
    }
  });
}

/// The table entry of a cube with decided squares.
unsigned entry_of(unsigned signature, unsigned high_squares) {
  unsigned entry = tables::kTile3Resolved.first_entry[signature], bit = 1;
  for (unsigned q = 0; q < 6; ++q) {
    if ((tables::kTile3Resolved.ambiguous_squares[signature] >> q & 1u) == 0) continue;
    if ((high_squares >> q & 1u) != 0) entry += bit;
    bit *= 2;
  }
  return entry;
}

using Cube = std::array<double, 8>;

/// `cube`: the samples of the next cube.
void compare_joins(const Kind& kind, const std::function<Cube(std::mt19937_64&)>& cube) {
  std::mt19937_64 random(3);
  std::size_t asked = 0, joined = 0, unsure = 0;
  for (int round = 0; round < 300; ++round) {
    JoinQuestions questions;
    std::array<tile::Choice, JoinQuestions::kMost> expected;
    for (int i = 0; i < 64; ++i) {
      const Cube values = cube(random);
      const CubeDecision decision = decide_cube_exactly(values, kind.isovalue);
      const CubeJoin& join = cube_joins()[entry_of(signature_of(values, kind.isovalue), decision.high_squares)];
      if (join.pairs == 0) {
        ASSERT_EQ(decision.centre, tile::Choice::separate);
      } else if (join.pairs == 1) {
        for (std::size_t e = 0; e < 8; ++e) questions.ends[e][questions.count] = values[join.corners[e]];
        questions.sign[questions.count] = join.high ? 1.0 : -1.0;
        expected[questions.count++] = decision.centre;
      }
    }
    answer(questions, kind.isovalue);
    for (std::size_t q = 0; q < questions.count; ++q, ++asked) {
      const auto found = questions.answers[q];
      const auto by_sign = questions.sign[q] > 0.0 ? tile::Choice::high : tile::Choice::low;
      unsure += found == JoinQuestions::unsure ? 1 : 0;
      joined += expected[q] != tile::Choice::separate ? 1 : 0;
      ASSERT_TRUE(found == JoinQuestions::unsure ||
                  (found == JoinQuestions::yes ? by_sign : tile::Choice::separate) == expected[q])
          << kind.name;
    }
  }
  if (kind.is_sure) {
    EXPECT_EQ(unsure, 0u) << kind.name;
    EXPECT_GT(asked, 100u) << kind.name;
    EXPECT_GT(joined, 0u) << kind.name;
  }
}

TEST(FaceSigns, JoinsInCubesAreThoseOfEachCubeByItself) {
  test::with_all_targets([] {
    for (const Kind& kind : kinds())
      compare_joins(kind, [&](std::mt19937_64& random) {
        Cube values;
        for (double& value : values) value = kind.sample(random);
        return values;
      });
  });
}

/// The hyperdeterminant of a form a yz + b xz + c xy is 0, whatever its origin, so that only rounding decides its sign.
TEST(FaceSigns, JoinsInCubesThatRoundingCouldDecideAreUnsure) {
  const auto degenerate = [](std::mt19937_64& random) {
    const double a = uniform(random), b = uniform(random), c = uniform(random);
    const std::array<double, 3> origin = {0.5 + 0.5 * uniform(random), 0.5 + 0.5 * uniform(random),
                                          0.5 + 0.5 * uniform(random)};
    Cube values;
    for (unsigned v = 0; v < 8; ++v) {
      const double x = (v & 1u) - origin[0], y = (v >> 1 & 1u) - origin[1], z = (v >> 2) - origin[2];
      values[v] = a * y * z + b * x * z + c * x * y;
    }
    return values;
  };
  test::with_all_targets([&] { compare_joins({"degenerate", uniform, 0.0, false}, degenerate); });
}

/// Against the parts of the contours in the cubes, for random signatures and centres of squares and cubes.
void expect_sides_connected_by_contours() {
  std::mt19937_64 random(1);
  std::size_t connected = 0, with_spheres = 0;
  ResolvedTesseract tesseract;
  for (int i = 0; i < 2000; ++i) {
    BoundarySides sides;
    std::vector<ResolvedKey> keys(1 + random() % (BoundarySides::kMost / 2));
    for (ResolvedKey& key : keys) {
      key.signature = static_cast<std::uint16_t>(1 + random() % 0xfffe);
      key.squares = static_cast<std::uint32_t>(random()) & 0xffffffu;
      const auto decided = static_cast<std::uint8_t>(random()), high = static_cast<std::uint8_t>(random());
      key.high_cubes = decided & high;
      key.low_cubes = static_cast<std::uint8_t>(decided & ~high);
      sides.add(key.signature, key.squares, key.high_cubes);
      sides.add(~std::uint32_t{key.signature}, ~key.squares, key.low_cubes);
    }
    find_connected(sides);
    for (std::size_t j = 0; j < keys.size(); ++j) {
      const unsigned high = sides.apart[2 * j], low = sides.apart[2 * j + 1];
      const std::span<const ResolvedTesseract::Component> components =
          tesseract.find_sigma(ResolvedTesseract::lists_of(keys[j]));
      ASSERT_EQ(high == 0 && low == 0, components.size() == 1)
          << "signature " << keys[j].signature << ", squares " << keys[j].squares;
      connected += components.size() == 1 ? 1 : 0;
      if (high == 0 || high == BoundarySides::kScattered || low != 0) continue;
      // one component more than spheres around corners, each on the edges at the corner
      ASSERT_EQ(components.size(), static_cast<std::size_t>(std::popcount(high)) + 1);
      std::uint32_t around = 0;
      for (const ResolvedTesseract::Component& component : components) {
        if (component.triangles != 4 || component.vertices >> 32 != 0) continue;
        for (unsigned v = 0; v < 16; ++v) {
          std::uint64_t edges = 0;
          for (unsigned axis = 0; axis < 4; ++axis) edges |= std::uint64_t{1} << edge_number(4, axis, v);
          around |= component.vertices == edges ? 1u << v : 0u;
        }
      }
      ASSERT_EQ(around & high, high) << "signature " << keys[j].signature << ", squares " << keys[j].squares;
      ++with_spheres;
    }
  }
  EXPECT_GT(connected, 10'000u);
  EXPECT_GT(with_spheres, 1'000u);
}

TEST(BoundarySides, AreConnectedIfTheContourBetweenThemIs) {
  test::with_all_targets(expect_sides_connected_by_contours);
}

/// Expects that the open cubes are those with one pair of edges, or with more: `entries` by number among the active
/// tiles.
void expect_open(const OpenCubes& open, bool has_one_pair, const std::vector<unsigned>& entries,
                 const CubesOfWord& cubes) {
  std::size_t i = 0;
  for (unsigned number = 0; number < entries.size(); ++number) {
    const unsigned pairs = cube_joins()[entries[number]].pairs;
    if ((cubes.ambiguous >> number & 1u) == 0 || pairs == 0 || (pairs == 1) != has_one_pair) continue;
    ASSERT_LT(i, open.count);
    EXPECT_EQ(open.numbers[i], number);
    EXPECT_EQ(open.places[i], cubes.at[number] % kWordBits);
    EXPECT_EQ(open.entries[i++], entries[number]);
  }
  EXPECT_EQ(i, open.count);
}

void expect_variants_of_each_cube() {
  std::mt19937_64 random(6);
  std::size_t with_one = 0, with_more = 0;
  for (int round = 0; round < 12'000; ++round) {
    const RowTable& table = variant_table<3>(round % 2 == 0 ? Triangulation::compact : Triangulation::barycentric).rows;
    const auto rule = static_cast<CentreRule>(round / 2 % 3);
    alignas(64) std::array<std::uint8_t, kWordBits> high;
    for (std::uint8_t& faces : high) faces = static_cast<std::uint8_t>(random() & 127u);
    // active tiles, from few to all
    CubesOfWord cubes{random() | (round % 5 == 0 ? ~Word{0} : random()), 0, nullptr, nullptr};
    if (round % 7 == 0) cubes.active &= random() & random();
    if (cubes.active == 0) continue;
    std::array<std::uint16_t, 2 * kWordBits> at{}, keys;
    for (std::uint16_t& key : keys) key = static_cast<std::uint16_t>(1 + random() % 254);
    unsigned count = 0;
    for (unsigned place = 0; place < kWordBits; ++place)
      if ((cubes.active >> place & 1u) != 0) at[count++] = static_cast<std::uint16_t>(64 * (round % 3) + place);
    for (unsigned i = 0; i < count; ++i) cubes.ambiguous |= Word{ambiguous_signatures<3>()[keys[i]]} << i;
    if (cubes.ambiguous == 0) continue;
    const auto before = keys;
    cubes.at = at.data();
    cubes.keys = keys.data();
    CubesByPairs open;
    choose_variants(high.data(), table.variants, rule, cubes, open);
    std::int32_t simplices = 0, own_vertices = 0;
    std::vector<unsigned> entries(count);
    for (unsigned i = 0; i < keys.size(); ++i) {
      if (i >= count || (cubes.ambiguous >> i & 1u) == 0) {
        ASSERT_EQ(before[i], keys[i]) << i;
        continue;
      }
      const unsigned faces = high[at[i] % kWordBits];
      entries[i] = entry_of(before[i], faces & 63u);
      const Variant& variant = table.variant(entries[i], rule == CentreRule::by_bit ? 1 + (faces >> 6) : 0);
      ASSERT_EQ(variant.key, keys[i]) << i;
      simplices += variant.more_simplices;
      own_vertices += variant.more_own_vertices;
    }
    EXPECT_EQ(simplices, cubes.more_simplices);
    EXPECT_EQ(own_vertices, cubes.more_own_vertices);
    if (rule != CentreRule::by_joins) continue;
    expect_open(open.with_one, true, entries, cubes);
    expect_open(open.with_more, false, entries, cubes);
    with_one += open.with_one.count;
    with_more += open.with_more.count;
  }
  EXPECT_GT(with_one, 1000u);
  EXPECT_GT(with_more, 30u);
}

TEST(CubeWords, VariantsAreThoseOfEachCubeByItself) { test::with_all_targets(expect_variants_of_each_cube); }

TEST(CubeWords, BytesAreThoseOfTheTables) {
  const builders::CubeBytes& bytes = builders::kCubeBytes;
  for (unsigned signature = 0; signature < 256; ++signature) {
    ASSERT_EQ(tables::kTile3Resolved.first_entry[signature],
              bytes.first_low[signature] + 256u * bytes.first_high[signature]);
    ASSERT_EQ(tables::kTile3Resolved.ambiguous_squares[signature], bytes.ambiguous[signature]);
    for (unsigned high = 0; high < 64; ++high) {  // the steps of cube_words.cpp
      unsigned bits = high & bytes.ambiguous[signature];
      for (unsigned step = 0; step < 3; ++step) {
        const unsigned moved = bits & bytes.moved[step][signature];
        bits = (bits ^ moved) | moved >> (1u << step);
      }
      ASSERT_EQ(ResolvedCubes::entry(signature, high), tables::kTile3Resolved.first_entry[signature] + bits);
    }
  }
  for (unsigned entry = 0; entry < 8 * bytes.with_more.size(); ++entry) {
    const unsigned pairs = entry < cube_joins().size() ? cube_joins()[entry].pairs : 0;
    ASSERT_EQ(pairs == 1, (bytes.with_one_pair[entry / 8] >> entry % 8 & 1) != 0);
    ASSERT_EQ(pairs > 1, (bytes.with_more[entry / 8] >> entry % 8 & 1) != 0);
  }
}

/// All signatures and sets of high squares of a cube, eight cubes at a time.
void expect_lists_of_each_cube(CubeListTable::Content content, Triangulation triangulation) {
  const ResolvedCubes& cubes = ResolvedCubes::instance(triangulation);
  const bool by_centre = content == CubeListTable::Content::by_centre;
  const bool with_joins = content == CubeListTable::Content::with_joins;
  std::mt19937_64 random(9);
  std::vector<WantedLists> wanted(256 * 64 / 8);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i] = {0, 0, static_cast<unsigned>(random() & 255u)};
    for (unsigned f = 0; f < 8; ++f) {
      wanted[i].signatures |= (8 * i + f) % 256 << (8 * f);
      wanted[i].squares |= ((8 * i + f) / 256 | (random() & 192u)) << (8 * f);  // the last two bits have no meaning
    }
  }
  std::vector<FoundLists> found(wanted.size());
  find_lists(CubeListTable::instance(content, triangulation), wanted, found.data());
  for (unsigned i = 0; i < found.size(); ++i)
    for (unsigned f = 0; f < 8; ++f) {
      const unsigned entry = ResolvedCubes::entry((8 * i + f) % 256, (8 * i + f) / 256);
      const bool takes_second = (wanted[i].second >> f & 1u) != 0;
      const auto centre = takes_second ? tile::Choice::high : tile::Choice::low;
      const unsigned list = ResolvedCubes::list_of_entry(entry, by_centre ? centre : tile::Choice::separate);
      if (!(with_joins && takes_second)) {
        ASSERT_EQ(list, found[i].wanted[f]);
        ASSERT_EQ(cubes.own_vertices(list) != 0, (found[i].with_vertices >> f & 1u) != 0);
      }
      const unsigned pairs = cube_joins()[entry].pairs;
      const bool has_choice = by_centre ? ResolvedCubes::at_entry(entry).has_choice != 0 : with_joins && pairs == 1;
      ASSERT_EQ(has_choice, (found[i].with_choice >> f & 1u) != 0);
      ASSERT_EQ(with_joins && pairs > 1, (found[i].with_pairs >> f & 1u) != 0);
      if (with_joins) {
        ASSERT_EQ(entry, found[i].second[f]);
      }
    }
}

TEST(CubeLists, AreThoseOfEachCubeByItself) {
  using Content = CubeListTable::Content;
  for (const auto triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Content content : {Content::separate, Content::by_centre, Content::with_joins})
      test::with_all_targets([&] { expect_lists_of_each_cube(content, triangulation); });
}

}  // namespace
}  // namespace tegl::detail
