// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the functions that the readers and writers of all mesh formats share.
#include "base/mesh_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

ReadProgress::ReadProgress(const Progress& progress, const fs::path& path)
    : progress_(progress), path_(path), size_(size_of_file(path)) {
  tick(progress_, 0.0, path_);
}

void ReadProgress::add(std::uint64_t bytes) {
  constexpr std::uint64_t kTellEvery = std::uint64_t{1} << 20;
  done_ += bytes;
  if (done_ - told_ < kTellEvery) return;
  told_ = done_;
  tick(progress_, static_cast<double>(done_) / static_cast<double>(size_), path_);
}

void CopyLimit::add(std::uint64_t count, std::uint64_t bytes, std::string_view what) {
  std::uint64_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all) || __builtin_add_overflow(all, taken_, &all))
    all = std::numeric_limits<std::uint64_t>::max();
  taken_ = all;
  if (taken_ > most_)
    fail(ErrorCode::TooLarge, path_, "{} take {} bytes or more; expected at most {}, 64 times the file and 64 MiB",
         what, taken_, most_);
}

std::array<float, 3> float_position(const MeshView& mesh, std::size_t vertex, const fs::path& path) {
  std::array<float, 3> result{};
  const auto point = position(mesh, vertex);
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(std::abs(point[a]) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail(ErrorCode::UnsupportedData, path, "vertex {} has the coordinate {}; expected a value in the range of float",
           vertex, point[a]);
    result[a] = static_cast<float>(point[a]);
  }
  return result;
}

void flatten(Mesh& mesh, const fs::path& path) {
  for (std::size_t v = 0; v < mesh.coordinates.size() / 3; ++v)
    if (mesh.coordinates[3 * v + 2] != 0.0)
      fail(ErrorCode::MalformedFile, path, "vertex {} has z = {}; expected 0, as the file is marked as planar", v,
           mesh.coordinates[3 * v + 2]);
  for (MeshArray<double>* const rows : {&mesh.coordinates, &mesh.normals}) {
    const std::size_t count = rows->size() / 3;
    for (std::size_t v = 0; v < count; ++v) std::copy_n(rows->data() + 3 * v, 2, rows->data() + 2 * v);
    rows->resize(2 * count);
  }
  mesh.space_dim = 2;
}

void check_indices(const Mesh& mesh, const fs::path& path) {
  const std::size_t vertices = vertex_count(mesh);
  for (std::size_t i = 0; i < mesh.simplices.size(); ++i)
    if (mesh.simplices[i] >= vertices)
      fail(ErrorCode::MalformedFile, path, "simplex {} has vertex number {}; expected less than {}",
           i / (static_cast<std::size_t>(mesh.dim) + 1), mesh.simplices[i], vertices);
}

}  // namespace tegl::io_detail
