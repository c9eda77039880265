// SPDX-License-Identifier: BSD-3-Clause
//
// STL through assimp. STL repeats a vertex for every triangle that has it, and so does assimp; vertices with
// equal coordinates, bit by bit, become one (assimp's own joining has an absolute tolerance, which closes what is
// open).
#include <array>
#include <bit>
#include <unordered_map>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "common.hpp"
#include "mesh_formats.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Bits = std::array<std::uint32_t, 3>;

struct BitsHash {
  std::size_t operator()(const Bits& bits) const noexcept {
    std::uint64_t hash = 0;
    for (const std::uint32_t part : bits) hash = (hash ^ part) * 0x9E3779B97F4A7C15U ^ hash >> 29;
    return static_cast<std::size_t>(hash);
  }
};

/// Numbers the vertices in the order in which they are met.
class Joiner {
 public:
  explicit Joiner(Mesh& mesh) : mesh_(mesh) {}

  Index number_of(const aiVector3D& point) {
    // + 0 makes -0 and 0 the same.
    const Bits bits = {std::bit_cast<std::uint32_t>(point.x + 0.0F), std::bit_cast<std::uint32_t>(point.y + 0.0F),
                       std::bit_cast<std::uint32_t>(point.z + 0.0F)};
    const auto [found, is_new] = numbers_.emplace(bits, static_cast<Index>(numbers_.size()));
    if (is_new)
      for (const float value : {point.x, point.y, point.z}) mesh_.coordinates.push_back(value);
    return found->second;
  }

 private:
  Mesh& mesh_;
  std::unordered_map<Bits, Index, BitsHash> numbers_;
};

}  // namespace

Mesh read_stl(const fs::path& path, ReadProgress& progress) {
  constexpr std::size_t kStlTriangle = 50;  // bytes; in text it takes more
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr) fail(ErrorCode::MalformedFile, path, "cannot be read ({})", importer.GetErrorString());
  Mesh mesh;
  Joiner joiner(mesh);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    if ((part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      for (unsigned corner = 0; corner < 3; ++corner)
        mesh.simplices.push_back(joiner.number_of(part.mVertices[part.mFaces[f].mIndices[corner]]));
      progress.add_rows(f, kStlTriangle);
    }
  }
  if (mesh.simplices.empty()) fail(ErrorCode::UnsupportedData, path, "no triangles; expected a surface");
  mesh.axis_names.resize(3);
  mesh.axis_units.resize(3);
  return mesh;
}

}  // namespace tegl::io_detail
