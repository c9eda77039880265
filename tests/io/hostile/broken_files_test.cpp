// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are missing, empty, folders, of the wrong kind or truncated, for every format: the error names the file.
#include <array>

#include "images/netcdf_files.hpp"
#include "images/nifti_files.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

const std::vector<std::string> kImageNames = {"a.nii", "a.nii.gz", "a.hdr", "a.nrrd",  "a.nhdr", "a.mha", "a.mhd",
                                              "a.nc",  "a.cdf",    "a.nc4", "a.nc.gz", "a.vti",  "a.vtr", "a.pvd"};
const std::vector<std::string> kMeshNames = {"a.ply", "a.gltf", "a.glb", "a.vtkhdf", "a.stl", "a.obj"};
const std::vector<std::string> kCellMeshNames = {"a.vtu", "a.vts", "a.pvd", "a.csv"};

/// Runs a check for every format; `read` reads the given file.
template <class Check>
void for_each_format(Check&& check) {
  for (const std::string& name : kImageNames) {
    SCOPED_TRACE(name);
    check(name, [](const fs::path& path) { read_image(path); });
  }
  for (const std::string& name : kMeshNames) {
    SCOPED_TRACE(name);
    check(name, [](const fs::path& path) { read_mesh(path); });
  }
  for (const std::string& name : kCellMeshNames) {
    SCOPED_TRACE(name);
    check(name, [](const fs::path& path) { read_cell_mesh(std::array{path}); });
  }
}

TEST(BrokenFiles, MissingFilesAreNotFound) {
  for_each_format([](const std::string& name, auto read) {
    TempDir dir;
    expect_error(ErrorCode::FileNotFound, {(dir / name).string(), "no such file"}, [&] { read(dir / name); });
  });
}

TEST(BrokenFiles, FoldersAreNotFiles) {
  for_each_format([](const std::string& name, auto read) {
    TempDir dir;
    fs::create_directory(dir / name);
    expect_error(ErrorCode::FileNotFound, {(dir / name).string(), "is a directory"}, [&] { read(dir / name); });
  });
}

TEST(BrokenFiles, EmptyFilesAreMalformed) {
  for_each_format([](const std::string& name, auto read) {
    TempDir dir;
    write_file(dir / name, "");
    expect_error(ErrorCode::MalformedFile, {(dir / name).string(), "is empty"}, [&] { read(dir / name); });
  });
}

TEST(BrokenFiles, GarbageIsMalformedAndNothingIsPrinted) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for_each_format([](const std::string& name, auto read) {
    TempDir dir;
    std::mt19937 random(1);
    std::string garbage(5000, '\0');
    for (char& c : garbage) c = static_cast<char>(random());
    write_file(dir / name, garbage);
    const Error error = error_of([&] { read(dir / name); });
    EXPECT_TRUE(error.code() == ErrorCode::MalformedFile || error.code() == ErrorCode::UnsupportedData) << error.what();
    EXPECT_THAT(error.what(), testing::HasSubstr((dir / name).string()));
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(BrokenFiles, OneFormatUnderAnothersName) {
  TempDir dir;
  const std::string nifti = NiftiHeader({4, 4, 4}, 2, 8).bytes() + std::string(64, 'x');
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\n\nabcd";
  for (const std::string name : {"a.nrrd", "a.mha", "a.nc"}) {
    write_file(dir / name, nifti);
    expect_unreadable(ErrorCode::MalformedFile, dir / name, {"expected"});
  }
  write_file(dir / "a.nii", nrrd);
  expect_unreadable(ErrorCode::MalformedFile, dir / "a.nii", {"NIfTI", "expected"});
  write_file(dir / "a.ply", nrrd);
  expect_error(ErrorCode::MalformedFile, {"a.ply", "'NRRD'; expected 'ply'"}, [&] { read_mesh(dir / "a.ply"); });
}

TEST(BrokenFiles, UnknownExtensionsAreReadByContentOrRefused) {
  TempDir dir;
  const std::string nifti = NiftiHeader({4, 4, 4}, 2, 8).bytes() + std::string(64, 'x');
  write_file(dir / "a.dat", "just text");
  expect_unreadable(ErrorCode::UnsupportedFormat, dir / "a.dat", {"'just tex'", ".nii", ".nrrd", ".mha", ".nc"});
  write_file(dir / "b.dat", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\n\nabcd");
  EXPECT_EQ(read_image(dir / "b.dat").info.format, "NRRD");
  expect_error(ErrorCode::UnsupportedFormat, {"b.dat", "'.dat'", ".vtkhdf"}, [&] { read_mesh(dir / "b.dat"); });
}

TEST(BrokenFiles, UnreadableFilesAreNotFound) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  TempDir dir;
  write_file(dir / "a.nii", "x");
  fs::permissions(dir / "a.nii", fs::perms::none);
  expect_unreadable(ErrorCode::FileNotFound, dir / "a.nii", {"Permission denied"});
}

TEST(BrokenFiles, VariableOfAFormatWithoutVariables) {
  TempDir dir;
  write_file(dir / "a.nii", NiftiHeader({4, 4, 4}, 2, 8).bytes() + std::string(64, 'x'));
  expect_error(ErrorCode::InvalidArgument, {"a.nii", "variable 'temp'"}, [&] {
    read_image(dir / "a.nii", {"temp", {}});
  });
}

TEST(BrokenFiles, MeshesThatContradictThemselvesAreNamed) {
  TempDir dir;
  const auto expect = [&](const std::string& body, const std::string& part, ErrorCode code = ErrorCode::MalformedFile) {
    SCOPED_TRACE(part);
    write_file(dir / "a.ply", body);
    expect_error(code, {"a.ply", part}, [&] { read_mesh(dir / "a.ply"); });
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const auto ascii = [&](const std::string& elements, const std::string& data) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + data;
  };
  const std::string one_face = "element vertex 3\n" + xyz + "element face 1\nproperty list uchar int vertex_indices\n";
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "vertex number 3; expected less than 3");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"), "vertex number -2");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n"), "vertex number 0.5");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n2 0 1\n"), "face 0 of 2 vertices");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n300 0 1\n"), "list of 300 numbers");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n"), "'one'; expected a number");
  expect(ascii(one_face, "0 0 0\n1 0 0\n0 1 0\n"), "PLY ends at byte");
  expect(ascii("element vertex 4000000000000\n" + xyz + "element face 0\nproperty list uchar int vertex_indices\n",
               "0 0 0"),
         "4000000000000 items of element 'vertex'");
  expect(ascii("element vertex 1\nproperty float x\nelement face 0\nproperty list uchar int vertex_indices\n", "0\n"),
         "without x, y and z");
  expect(ascii("element vertex 1\n" + xyz + "element face 1\nproperty int a\n", "0 0 0\n1\n"),
         "without a list vertex_indices");
  expect(ascii("element vertex 1\n" + xyz, "0 0 0\n"), "expected a mesh", ErrorCode::UnsupportedData);
  expect("ply\nformat ebcdic 1.0\nend_header\n", "'ebcdic'");
  expect("ply\nelement vertex 0\nend_header\n", "without a format line");
  expect("ply\nformat ascii 1.0\nelement vertex 0\n", "without 'end_header'");
  expect("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "'property float x'");
}

}  // namespace
}  // namespace tegl::test
