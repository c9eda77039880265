// SPDX-License-Identifier: BSD-3-Clause
//
// Malicious XML files of VTK: small files that name much data, or that need much time, stack or memory to parse; and
// sound files that end early. None may be read, print or need more than a second and twice the file plus 64 MiB.
#include "hostile/refused_files.hpp"

namespace tegl::test {
namespace {

void as_vtk_image(const fs::path& path) { read_image(path); }
void as_vtk_cells(const fs::path& path) { read_cell_mesh(std::array{path}); }

/// An image of 2 x 2 x 2 with an array in appended data.
std::string image_file(const std::string& attributes, const std::string& extent, const std::string& array,
                       const std::string& data, const std::string& encoding = "raw") {
  return "<VTKFile type=\"ImageData\" " + attributes + "><ImageData WholeExtent=\"" + extent +
         "\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"" + extent +
         "\"><PointData><DataArray type=\"Float64\" Name=\"f\" format=\"appended\" " + array +
         "/></PointData></Piece></ImageData><AppendedData encoding=\"" + encoding + "\">\n_" + data +
         "\n</AppendedData></VTKFile>";
}

template <class... Numbers>
std::string numbers(Numbers... all) {
  std::string bytes;
  ((bytes += bytes_of(std::vector<std::uint64_t>{static_cast<std::uint64_t>(all)})), ...);
  return bytes;
}

TEST(HostileVtk, SizesOfDataAreCheckedBeforeMemoryIsTaken) {
  TempDir dir;
  const std::string wide = "header_type=\"UInt64\"", zlib = wide + " compressor=\"vtkZLibDataCompressor\"";
  const std::string eight = "0 1 0 1 0 1", sound = numbers(64) + std::string(64, '\0');
  const std::string huge = "0 99999 0 99999 0 999";
  const auto bomb = [](std::uint64_t blocks, std::uint64_t size, std::uint64_t last, const std::string& block) {
    return numbers(blocks, size, last, block.size()) + block;
  };
  const std::string packed = compressed(std::string(64, '\0'), true);
  struct Wrong {
    std::string bytes;
    std::vector<std::string> parts;
    ErrorCode code = ErrorCode::MalformedFile;
  };
  const std::vector<Wrong> all = {
      {image_file(wide, eight, "offset=\"1000000\"", sound), {"offset 1000000", "behind the end"}},
      {image_file(wide, eight, "offset=\"18446744073709551615\"", sound), {"offset 18446744073709551615"}},
      {image_file(wide, eight, "offset=\"-1\"", sound), {"offset='-1'"}},
      {image_file(wide, eight, "", sound), {"offset=''"}},
      {image_file(wide, eight, "offset=\"8\"", sound), {"'f' has 0 bytes; expected 64"}},
      {image_file(wide, eight, "offset=\"0\"", numbers(std::uint64_t{1} << 60)), {"1152921504606846976 bytes"}},
      {image_file(wide, huge, "offset=\"0\"", numbers(80'000'000'000'000)), {"80000000000000 bytes"}},
      {image_file(wide, huge, "offset=\"0\"", sound), {"64 bytes; expected 80000000000000"}},
      {image_file(wide, eight, "offset=\"0\" NumberOfComponents=\"1152921504606846976\"", sound),
       {"components"},
       ErrorCode::VariableNotFound},
      {image_file(wide, "0 1 0 1 0 99999999999999", "offset=\"0\"", sound), {"whole numbers in ascending order"}},
      {image_file(wide, "0 1099511627776 0 1099511627776 0 1", "offset=\"0\"", sound), {"f.vti"}, ErrorCode::TooLarge},
      {image_file(wide, "1 0 0 1 0 1", "offset=\"0\"", sound), {"ascending order"}},
      {image_file(wide, "0 1 0 1", "offset=\"0\"", sound), {"4 numbers; expected 6"}},
      {image_file(zlib, eight, "offset=\"0\"", bomb(std::uint64_t{1} << 61, 64, 0, packed)), {"compressed blocks"}},
      {image_file(zlib, eight, "offset=\"0\"", bomb(1, std::uint64_t{1} << 62, 0, packed)), {"expected 64"}},
      {image_file(zlib, eight, "offset=\"0\"", bomb(1, 64, 128, packed)), {"the last of 128"}},
      {image_file(zlib, huge, "offset=\"0\"", bomb(1, 80'000'000'000'000, 0, packed)), {"80000000000000 bytes"}},
      {image_file(zlib, eight, "offset=\"0\"", bomb(1, 64, 0, std::string(20, 'x'))), {"block 0 of 1 is damaged"}},
      {image_file(zlib, eight, "offset=\"0\"", numbers(1, 64, 0, 1 << 20) + packed), {"1048576 bytes or more"}},
      {image_file(wide, eight, "offset=\"0\"", "????", "base64"), {"'?' in base64"}},
      {image_file(wide, eight, "offset=\"0\"", "QUFB", "base64"), {"ends before the number of its bytes"}},
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    write_file(dir / "f.vti", all[i].bytes);
    expect_file_refused(dir / "f.vti", all[i].code, all[i].parts, as_vtk_image);
  }
  write_file(dir / "f.vti", image_file(wide, eight, "offset=\"0\"", sound));
  EXPECT_NO_THROW(as_vtk_image(dir / "f.vti"));  // the file without a fault
}

TEST(HostileVtk, XmlThatNeedsMuchIsRefused) {
  TempDir dir;
  const auto repeated = [](const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
  };
  const std::string entities =
      "<!DOCTYPE VTKFile [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]>"
      "<VTKFile type=\"&b;\"/>";
  const std::vector<std::pair<std::string, std::string>> all = {
      {entities, "document type"},
      {repeated("<a>", 100'000), "nested more than 64 deep"},
      {"<VTKFile>" + repeated("<a/>", 300'000), "more than 200000 elements"},
      {"<VTKFile a=\"" + std::string(9 << 20, 'x') + "\"/>", "a tag or comment of more than"},
      {"<VTKFile><!--" + std::string(9 << 20, 'x'), "a tag or comment of more than"},
      {"<VTKFile type=\"ImageData\">\xff\xfe</VTKFile>", "line 1"},
      {"<VTKFile type=\"ImageData\"><ImageData>text<Piece/>more</ImageData></VTKFile>", "text in two places"},
  };
  for (const auto& [bytes, part] : all) {
    write_file(dir / "f.vti", bytes);
    expect_file_refused(dir / "f.vti", ErrorCode::MalformedFile, {part}, as_vtk_image);
  }
}

/// Every third byte is enough: arrays have values of 1 to 8 bytes.
TEST(HostileVtk, FilesThatEndEarlyAreRefused) {
  TempDir dir;
  const fs::path seeds = TEGL_SOURCE_DIR "/tests/io/seeds";
  for (const char* const name : {"vtk_ascii.vti", "vtk_binary_zlib.vti", "vtk_base64_zlib.vtr", "vtk_ascii.vtu",
                                 "vtk_raw_zlib.vtu", "vtk_base64.vts", "vtk_polyhedra.vtu", "vtk_listed_faces.vtu"}) {
    SCOPED_TRACE(name);
    const std::string whole = read_file(seeds / name);
    const bool is_image = std::string(name).ends_with(".vti") || std::string(name).ends_with(".vtr");
    // After the data come only end tags, which readers of appended data do not need.
    const std::size_t end = std::min(whole.rfind("</VTKFile>"), whole.rfind("</AppendedData>") - 8);
    for (std::size_t size = 1; size < end; size += 3) {
      write_file(dir / name, whole.substr(0, size));
      EXPECT_THAT(error_of([&] { is_image ? as_vtk_image(dir / name) : as_vtk_cells(dir / name); }).what(),
                  testing::HasSubstr(name))
          << size << " of " << whole.size();
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace tegl::test
