// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of marching_cubes that tegl.contour lacks: masks of cubes, the maximum range of samples around each vertex,
// and the removal of degenerate triangles.
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::python {

namespace {

using Word = std::uint64_t;
constexpr std::size_t kAtOnce = sizeof(Word);  ///< bytes of a word, one per tile
constexpr Word kOnes = 0x0101010101010101;
static_assert(std::endian::native == std::endian::little, "the lowest byte of a word is the first in memory");

/// Pointer to a sample.
template <class T>
const T* place_of(const Image<T, 3>& image, const std::array<std::size_t, 3>& index) noexcept {
  std::ptrdiff_t at = 0;
  for (std::size_t a = 0; a < 3; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * image.strides()[a];
  return image.data() + at;
}

/// Compares samples with a level in the samples' own type.
template <class T>
class AtLeast {
 public:
  explicit AtLeast(double level) {
    if constexpr (std::is_floating_point_v<T>) {
      limit_ = static_cast<T>(level);
      if (static_cast<double>(limit_) < level) limit_ = std::nextafter(limit_, std::numeric_limits<T>::infinity());
    } else {
      constexpr double kBeyond = 4e9;  // beyond the range of all integer types used
      limit_ = static_cast<std::int64_t>(std::ceil(std::clamp(level, -kBeyond, kBeyond)));
    }
  }
  /// 1: at or above the level; 2: missing; 0: below.
  std::uint8_t operator()(T value) const noexcept {
    if constexpr (std::is_floating_point_v<T>)
      return static_cast<std::uint8_t>((value >= limit_ ? 1 : 0) | (value != value ? 2 : 0));
    else
      return value >= limit_ ? 1 : 0;
  }

 private:
  std::conditional_t<std::is_floating_point_v<T>, T, std::int64_t> limit_;
};

/// The active tiles of a 3D image within a mask, slab by slab (a slab lies between two layers of the last axis).
template <class T>
class MaskedTiles {
 public:
  /// `mask`: one truth value per sample; a tile is included if the value at its highest corner is true.
  MaskedTiles(const Image<T, 3>& image, const Image<std::uint8_t, 3>& mask, double level)
      : image_(image),
        mask_(mask),
        grid_(image.grid().sizes()),
        at_least_(level),
        pitch_(image.size(0) + 2 * kAtOnce),
        found_(image.size(2) - 1) {}

  std::vector<TileNumber> find() {
    constexpr std::size_t kLeastSlabs = 8;  // the first layer of a part is classified twice
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found_.size(), kLeastSlabs), [this](const auto& part) {
      std::array<std::vector<std::uint8_t>, 2> layers;
      for (auto& layer : layers) layer.resize(pitch_ * image_.size(1), 0);
      classify(part.begin(), layers[part.begin() % 2]);
      for (std::size_t k = part.begin(); k < part.end(); ++k) {
        classify(k + 1, layers[(k + 1) % 2]);
        find_in_slab(k, layers[0], layers[1]);
      }
    });
    std::size_t count = 0;
    for (const auto& slab : found_) count += slab.size();
    std::vector<TileNumber> result;
    result.reserve(count);
    for (const auto& slab : found_) result.insert(result.end(), slab.begin(), slab.end());
    return result;
  }

 private:
  void classify(std::size_t k, std::vector<std::uint8_t>& layer) const {
    const std::ptrdiff_t stride = image_.strides()[0];
    const std::size_t size = image_.size(0);
    for (std::size_t j = 0; j < image_.size(1); ++j) {
      const T* const samples = place_of(image_, {0, j, k});
      std::uint8_t* const out = layer.data() + j * pitch_;
      std::size_t i = 0;
      // Blocks of fixed length, which compilers vectorise.
      constexpr std::size_t kBlock = 16;
      for (; stride == 1 && i + kBlock <= size; i += kBlock) {
        std::array<std::uint8_t, kBlock> block;
        for (std::size_t b = 0; b < kBlock; ++b) block[b] = at_least_(samples[i + b]);
        std::memcpy(out + i, block.data(), kBlock);
      }
      for (; i < size; ++i) out[i] = at_least_(samples[static_cast<std::ptrdiff_t>(i) * stride]);
    }
  }

  static Word load(const std::uint8_t* from) noexcept {
    Word word;
    std::memcpy(&word, from, sizeof(word));
    return word;
  }

  void find_in_slab(std::size_t k, const std::vector<std::uint8_t>& one, const std::vector<std::uint8_t>& other) {
    std::vector<std::uint8_t> mask(pitch_, 0);
    const std::size_t tiles = image_.size(0) - 1;
    for (std::size_t j = 0; j + 1 < image_.size(1); ++j) {
      const std::uint8_t* const wanted = place_of(mask_, {1, j + 1, k + 1});
      const std::ptrdiff_t stride = mask_.strides()[0];
      for (std::size_t i = 0; i < tiles; ++i) mask[i] = wanted[static_cast<std::ptrdiff_t>(i) * stride];
      const std::array<const std::uint8_t*, 4> rows = {one.data() + j * pitch_, one.data() + (j + 1) * pitch_,
                                                       other.data() + j * pitch_, other.data() + (j + 1) * pitch_};
      const TileNumber first = grid_.number({0, j, k});
      // eight tiles per word: active if some corners are high, not all, and none is missing
      for (std::size_t i = 0; i < tiles; i += kAtOnce) {
        const Word chosen = load(mask.data() + i);
        if (chosen == 0) continue;
        Word any = 0, all = ~Word{0};
        for (const std::uint8_t* const row : rows)
          for (const std::size_t end : {i, i + 1}) {
            const Word samples = load(row + end);
            any |= samples;
            all &= samples;
          }
        for (Word active = chosen & any & ~all & ~(any >> 1) & kOnes; active != 0; active &= active - 1)
          found_[k].push_back(first + i + static_cast<unsigned>(std::countr_zero(active)) / 8);
      }
    }
  }

  const Image<T, 3>& image_;
  const Image<std::uint8_t, 3>& mask_;
  TileGrid<3> grid_;
  AtLeast<T> at_least_;
  std::size_t pitch_;  ///< bytes per row of samples, padded for words that extend beyond it
  std::vector<std::vector<TileNumber>> found_;
};

Image<std::uint8_t, 3> view_of_mask(const py::array& mask, const std::array<std::size_t, 3>& sizes) {
  if (mask.ndim() != 3 || mask.itemsize() != 1)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("the mask has {} axes and {} bytes for a value; expected 3 and 1", mask.ndim(), mask.itemsize()));
  Image<std::uint8_t, 3>::Strides strides;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<py::ssize_t>(a);
    if (static_cast<std::size_t>(mask.shape(axis)) != sizes[a])
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("the mask has {} values along axis {}; expected {}", mask.shape(axis), a, sizes[a]));
    strides[a] = mask.strides(axis);
  }
  return {static_cast<const std::uint8_t*>(mask.data()), Grid<3>::unit(sizes), strides};
}

/// The contour of a 3D image in the tiles whose highest corner is true in the mask, as if all other tiles had a missing
/// corner.
std::unique_ptr<AnyContour> extract_masked(const AnyImage& image, const py::array& mask, double level,
                                           const py::dict& arguments) {
  const auto* const views = std::get_if<ViewsOf<3>>(&image.view);
  if (views == nullptr) throw Error(ErrorCode::UnsupportedData, "masks of cubes are for 3D images");
  Call call(py::none{});
  const ExtractOptions options = extract_options(arguments, call);
  return std::visit(
      [&]<class T>(const Image<T, 3>& view) {
        const auto chosen = view_of_mask(mask, view.grid().sizes());
        return call.run([&] {
          const auto tiles = choose_tiles(view, MaskedTiles<T>(view, chosen, level).find());
          auto result = std::make_unique<AnyContour>();
          *result = {extract<float>(view, level, *tiles, options), level};
          return result;
        });
      },
      *views);
}

/// The maximum range of samples over the tiles that contain a point, border included.
template <class T>
float range_around(const Image<T, 3>& image, const std::array<float, 3>& point) {
  std::array<std::size_t, 3> first;
  std::array<std::size_t, 3> count;  // number of tiles: 1 or 2
  for (std::size_t a = 0; a < 3; ++a) {
    const auto last_tile = static_cast<double>(image.size(static_cast<int>(a)) - 2);
    const auto at = static_cast<double>(point[a]);
    const double low = std::clamp(std::ceil(at) - 1.0, 0.0, last_tile);
    first[a] = static_cast<std::size_t>(low);
    count[a] = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, last_tile) - low) + 1;
  }
  // Each sample is read once: ranges along axis 0, of these along axis 1, of these along axis 2.
  struct Range {
    T least, greatest;
    void add(const Range& other) noexcept {
      if (other.least < least || least != least) least = other.least;  // NaN is ignored
      if (other.greatest > greatest || greatest != greatest) greatest = other.greatest;
    }
  };
  std::array<Range, 27> ranges;
  const auto at = [](std::size_t i, std::size_t j, std::size_t k) { return i + 3 * (j + 3 * k); };
  const T* const start = place_of(image, first);
  const auto& strides = image.strides();
  for (std::size_t k = 0; k <= count[2]; ++k)
    for (std::size_t j = 0; j <= count[1]; ++j) {
      const T* const row =
          start + static_cast<std::ptrdiff_t>(j) * strides[1] + static_cast<std::ptrdiff_t>(k) * strides[2];
      for (std::size_t i = 0; i <= count[0]; ++i) {
        const T value = row[static_cast<std::ptrdiff_t>(i) * strides[0]];
        ranges[at(i, j, k)] = {value, value};
      }
      for (std::size_t i = 0; i < count[0]; ++i) ranges[at(i, j, k)].add(ranges[at(i + 1, j, k)]);
    }
  double result = 0.0;
  for (std::size_t k = 0; k <= count[2]; ++k)
    for (std::size_t j = 0; j < count[1]; ++j)
      for (std::size_t i = 0; i < count[0]; ++i) {
        ranges[at(i, j, k)].add(ranges[at(i, j + 1, k)]);
        if (k == 0) continue;
        Range tile = ranges[at(i, j, k - 1)];
        tile.add(ranges[at(i, j, k)]);
        const double range = static_cast<double>(tile.greatest) - static_cast<double>(tile.least);
        if (range > result) result = range;
      }
  return static_cast<float>(result);
}

py::array ranges_around(const AnyImage& image, const AnyContour& contour) {
  const auto* const vertices = std::get_if<Contour<3, float>>(&contour.contour);
  if (vertices == nullptr || image.view.index() != 1)
    throw Error(ErrorCode::UnsupportedData, "ranges around vertices are for 3D contours of single precision");
  Buffer<float> result(vertices->vertices.size());
  {
    const py::gil_scoped_release release;
    constexpr std::size_t kGrain = 4096;
    std::visit(
        [&](const auto& view) {
          tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.size(), kGrain), [&](const auto& part) {
            for (std::size_t v = part.begin(); v < part.end(); ++v)
              result[v] = range_around(view, vertices->vertices[v]);
          });
        },
        std::get<1>(image.view));
  }
  return owned(std::move(result));
}

using Faces = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// For each vertex the first vertex at the same position, by a hash table with open addressing.
template <class Real>
std::vector<std::int32_t> first_in_place(const py::detail::unchecked_reference<Real, 2>& vertices) {
  const auto count = static_cast<std::size_t>(vertices.shape(0));
  const std::size_t room = std::bit_ceil(2 * count + 1);
  std::vector<std::int32_t> slots(room, -1);
  std::vector<std::int32_t> result(count);
  const auto row = [&](std::size_t v) {
    const auto at = static_cast<py::ssize_t>(v);
    return std::array<Real, 3>{vertices(at, 0), vertices(at, 1), vertices(at, 2)};
  };
  for (std::size_t v = 0; v < count; ++v) {
    const std::array<Real, 3> place = row(v);
    Word hash = 0;
    for (const Real x : place)
      hash = (std::rotl(hash, 23) ^ std::bit_cast<Word>(static_cast<double>(x) + 0.0)) * 0x9e3779b97f4a7c15;
    std::size_t slot = (hash >> 20) & (room - 1);
    while (slots[slot] >= 0 && row(static_cast<std::size_t>(slots[slot])) != place) slot = (slot + 1) & (room - 1);
    if (slots[slot] < 0) slots[slot] = static_cast<std::int32_t>(v);
    result[v] = slots[slot];
  }
  return result;
}

/// Returns (kept, faces): merges vertices at equal positions, drops triangles with two equal corners, then unused
/// vertices. `kept` holds the numbers of the remaining vertices; `faces` the remaining triangles by their new numbers.
template <class Real>
py::tuple weld(const py::array_t<Real>& vertices, const Faces& faces) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3 || faces.ndim() != 2 || faces.shape(1) != 3)
    throw Error(ErrorCode::InvalidArgument, "vertices and faces have other shapes than (#V, 3) and (#F, 3)");
  const auto places = vertices.template unchecked<2>();
  Buffer<std::int32_t> kept;
  Buffer<std::array<std::int32_t, 3>> proper;
  {
    const std::span<const std::array<std::int32_t, 3>> all(
        reinterpret_cast<const std::array<std::int32_t, 3>*>(faces.data()), static_cast<std::size_t>(faces.shape(0)));
    const py::gil_scoped_release release;
    // merge vertices, drop degenerate triangles
    const std::vector<std::int32_t> first = first_in_place<Real>(places);
    std::vector<std::int32_t> number(first.size(), -1);
    for (const auto& face : all) {
      std::array<std::int32_t, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = first.at(static_cast<std::size_t>(face[c]));
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      proper.push_back(corners);
      for (const std::int32_t corner : corners) number[static_cast<std::size_t>(corner)] = 0;
    }
    // number the vertices in use
    for (std::size_t v = 0; v < number.size(); ++v)
      if (number[v] == 0) {
        number[v] = static_cast<std::int32_t>(kept.size());
        kept.push_back(static_cast<std::int32_t>(v));
      }
    for (auto& face : proper)
      for (std::int32_t& corner : face) corner = number[static_cast<std::size_t>(corner)];
  }
  return py::make_tuple(owned(std::move(kept)), owned(std::move(proper)));
}

}  // namespace

void bind_marching_cubes(py::module_& m) {
  m.def("extract_masked", &extract_masked, py::arg("image"), py::arg("mask"), py::arg("level"), py::arg("options"),
        doc::choose_tiles);
  m.def("ranges_around", &ranges_around, py::arg("image"), py::arg("contour"),
        "For each vertex the largest range of samples of a tile that it lies in; the vertices in steps of the grid.");
  m.def(
      "weld",
      [](const py::array& vertices, const Faces& faces) {
        return py::isinstance<py::array_t<float>>(vertices) ? weld<float>(vertices, faces)
                                                            : weld<double>(vertices, faces);
      },
      py::arg("vertices"), py::arg("faces"),
      "(kept, faces): numbers of the vertices that are left when those in one place become one, and the triangles "
      "without those that have two equal corners.");
}

}  // namespace tegl::python
