// SPDX-License-Identifier: BSD-3-Clause
//
// Every reader against damaged files: a small sound file of each format, with bytes flipped, overwritten or cut off
// at random places. Reading must succeed or throw tegl::Error, and print nothing. Seeds are fixed; a failing case is
// named by its seed. TEGL_FUZZ_ROUNDS sets another number of rounds.
#include <cstdlib>
#include <functional>

#include "io_support.hpp"
#include "netcdf_files.hpp"
#include "nifti_files.hpp"

namespace tegl::test {
namespace {

/// One to eight flips, overwritten bytes or numbers, or a cut; mostly in the first bytes, where headers are.
std::string damaged(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % std::max<std::size_t>(1, n)); };
  for (std::size_t i = 1 + below(8); i > 0 && !bytes.empty(); --i) {
    const std::size_t range = below(3) != 0 ? std::min<std::size_t>(bytes.size(), 600) : bytes.size();
    char& byte = bytes[below(range)];
    switch (below(6)) {
      case 0:
        byte = static_cast<char>(byte ^ 1 << below(8));
        break;
      case 1:
        byte = static_cast<char>(random());
        break;
      case 2:
        byte = "\x00\xff\x7f\x80"[below(4)];
        break;
      case 3:
        byte = "0123456789- .\n"[below(14)];
        break;
      case 4:
        bytes.insert(below(range), 1 + below(4), "9\xff\0\n"[below(4)]);
        break;
      default:
        if (below(4) == 0) bytes.resize(below(bytes.size()));
        break;
    }
  }
  return bytes;
}

std::size_t rounds() {
  const char* text = std::getenv("TEGL_FUZZ_ROUNDS");
  return text == nullptr ? 300 : static_cast<std::size_t>(std::atoll(text));
}

void fuzz(const std::string& name, const std::string& sound, const std::function<void(const fs::path&)>& read,
          const std::function<std::string(const std::string&)>& wrap = {}) {
  SCOPED_TRACE(name);
  TempDir dir;
  const fs::path path = dir / name;
  write_file(path, wrap ? wrap(sound) : sound);
  ASSERT_NO_THROW(read(path));
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::size_t errors = 0;
  for (std::size_t seed = 0; seed < rounds(); ++seed) {
    std::mt19937_64 random(seed);
    const std::string bytes = damaged(sound, random);
    write_file(path, wrap ? wrap(bytes) : bytes);
    if (std::getenv("TEGL_FUZZ_KEEP") != nullptr)  // leaves the case that crashed
      fs::copy_file(path, fs::path(std::getenv("TEGL_FUZZ_KEEP")) / name, fs::copy_options::overwrite_existing);
    try {
      read(path);
    } catch (const Error& error) {
      ++errors;
      EXPECT_THAT(error.what(), testing::HasSubstr(dir.path().string())) << "seed " << seed;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "seed " << seed << ": no tegl::Error, but " << error.what();
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_GT(errors, rounds() / 10);
}

void read_as_image(const fs::path& path) { read_image(path); }
void read_as_mesh(const fs::path& path) { read_mesh(path); }
std::string gzipped(const std::string& bytes) { return compressed(bytes); }

TEST(Fuzz, Nifti) {
  auto header = NiftiHeader({5, 4, 3, 2}, 4, 16).sform({0, -2, 0, 1, 2, 0, 0, 2, 0, 0, 2, 3}).scaling(2, 1);
  const std::string file = header.bytes() + bytes_of(counting<std::int16_t>(120));
  fuzz("a.nii", file, read_as_image);
  fuzz("b.nii.gz", file, read_as_image, gzipped);
  fuzz("c.nii.gz", compressed(file), read_as_image);
}

TEST(Fuzz, Nrrd) {
  const std::string header =
      "NRRD0004\n# comment\ntype: short\ndimension: 4\nsizes: 3 4 5 2\nspace: LPS\nkinds: domain domain domain list\n"
      "space directions: (1,2,0) (0,3,-1) (0.5,0,4) none\nspace origin: (10,20,30)\nendian: little\n"
      "labels: \"x\" \"y\" \"z\" \"t\"\nkey:=value\nencoding: ";
  const std::string data = bytes_of(counting<std::int16_t>(120));
  std::string text;
  for (int i = 0; i < 120; ++i) text += std::to_string(i) + " ";
  fuzz("a.nrrd", header + "raw\n\n" + data, read_as_image);
  fuzz("b.nrrd", header + "gzip\n\n" + compressed(data), read_as_image);
  fuzz("c.nrrd", header + "ascii\n\n" + text, read_as_image);
}

TEST(Fuzz, MetaImage) {
  const std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\nAnatomicalOrientation = RAI\n";
  const std::string end = "DimSize = 3 4 10\nElementType = MET_SHORT\nElementDataFile = LOCAL\n";
  const std::string data = bytes_of(counting<std::int16_t>(120));
  const std::string zipped = compressed(data, true);
  fuzz("a.mha", header + end + data, read_as_image);
  fuzz("b.mha",
       header + "CompressedData = True\nCompressedDataSize = " + std::to_string(zipped.size()) + "\n" + end + zipped,
       read_as_image);
}

std::string netcdf_bytes(int format) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc", format);
    const int t = file.dimension("time", NC_UNLIMITED);
    const int y = file.dimension("y", 3);
    const int x = file.dimension("x", 4);
    const int xv = file.variable("x", NC_FLOAT, {x});
    const int v = file.variable("v", NC_SHORT, {t, y, x});
    file.number(v, "scale_factor", NC_DOUBLE, {0.5});
    file.number(v, "_FillValue", NC_SHORT, {-1});
    file.text(v, "units", "K");
    file.end();
    file.values(xv, {1, 2, 4, 8});
    file.values(v, {2, 3, 4}, std::vector<double>(24, 3));
  }
  return read_file(dir / "a.nc");
}

TEST(Fuzz, NetCdfClassic) {
  for (const int format : {0, NC_64BIT_OFFSET, NC_64BIT_DATA}) fuzz("a.nc", netcdf_bytes(format), read_as_image);
  fuzz("b.nc.gz", netcdf_bytes(0), read_as_image, gzipped);
}

TEST(Fuzz, NetCdf4) { fuzz("a.nc", netcdf_bytes(NC_NETCDF4), read_as_image); }

std::string mesh_bytes(const Mesh& mesh, const std::string& name) {
  TempDir dir;
  write_mesh(mesh, dir / name);
  return read_file(dir / name);
}

Mesh mesh_with_attributes(int dim, int space_dim) {
  Mesh mesh = random_mesh(dim, space_dim, 20, 30, 1, true);
  add_attributes(mesh, 2);
  return mesh;
}

TEST(Fuzz, Ply) {
  fuzz("a.ply", mesh_bytes(random_mesh(2, 3, 20, 30, 1), "a.ply"), read_as_mesh);
  fuzz("d.ply", mesh_bytes(mesh_with_attributes(2, 3), "a.ply"), read_as_mesh);
  fuzz("b.ply", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.ply"), read_as_mesh);
  fuzz("c.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
       read_as_mesh);
}

TEST(Fuzz, Obj) {
  fuzz("a.obj", mesh_bytes(random_mesh(2, 3, 20, 30, 1, true), "a.obj"), read_as_mesh);
  fuzz("b.obj", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.obj"), read_as_mesh);
  fuzz("c.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvn 0 0 1\r\nf 1//1 -2//-1 \\\r\n3/1/1\r\nl 1 2 3 # end\r\n",
       read_as_mesh);
}

TEST(Fuzz, Gltf) {
  fuzz("a.gltf", mesh_bytes(random_mesh(2, 3, 20, 30, 1), "a.gltf"), read_as_mesh);
  fuzz("b.glb", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.glb"), read_as_mesh);
  fuzz("c.gltf", mesh_bytes(mesh_with_attributes(2, 3), "a.gltf"), read_as_mesh);
}

TEST(Fuzz, VtkHdf) {
  fuzz("a.vtkhdf", mesh_bytes(random_mesh(3, 4, 20, 30, 1), "a.vtkhdf"), read_as_mesh);
  fuzz("b.vtkhdf", mesh_bytes(mesh_with_attributes(3, 4), "a.vtkhdf"), read_as_mesh);
}

}  // namespace
}  // namespace tegl::test
