// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of variables of classic netCDF files, which are read without the library, against what the library reads.
#include "images/netcdf_file.hpp"

#include <variant>
#include <vector>

#include "images/netcdf_files.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

/// A classic file with a variable in one piece and one or two with records.
void write_records(const fs::path& path, int format, nc_type type, bool alone) {
  NcWriter file(path, format);
  const int t = file.dimension("t", NC_UNLIMITED);
  const int y = file.dimension("y", 3);
  const int x = file.dimension("x", 5);
  const int whole = file.variable("whole", type, {y, x});
  const int records = file.variable("records", type, {t, y, x});
  const int others = alone ? -1 : file.variable("others", NC_SHORT, {t, x});
  file.end();
  file.values(whole, counting<double>(15, 1));
  file.values(records, {4, 3, 5}, counting<double>(60, 20));
  if (!alone) file.values(others, {4, 5}, counting<double>(20, 100));
}

/// Compares a slab with what the netCDF library reads.
void expect_slab(const io_detail::NcFile& file, int library, const io_detail::NcVariable& variable,
                 const io_detail::NcSlab& slab) {
  std::size_t count = 1;
  for (const std::size_t size : slab.count) count *= size;
  std::vector<double> expected(count);
  ASSERT_EQ(nc_get_vara_double(library, variable.id, slab.start.data(), slab.count.data(), expected.data()), NC_NOERR);
  std::visit(
      [&](const auto& values) {
        EXPECT_EQ(std::vector<double>(values.begin(), values.end()), expected) << variable.name;
      },
      file.values(variable, slab));
}

/// Compares all slabs of all variables.
void expect_slabs(const fs::path& path) {
  const io_detail::NcFile file(path, {});
  int library = -1;
  ASSERT_EQ(nc_open(path.c_str(), NC_NOWRITE, &library), NC_NOERR);
  for (const io_detail::NcVariable& variable : file.variables()) {
    std::vector<io_detail::NcSlab> slabs = {{}};
    for (const std::size_t size : variable.sizes) {
      std::vector<io_detail::NcSlab> longer;
      for (const io_detail::NcSlab& slab : slabs)
        for (std::size_t first = 0; first < size; ++first)
          for (std::size_t count = 1; count <= size - first; ++count) {
            longer.push_back(slab);
            longer.back().start.push_back(first);
            longer.back().count.push_back(count);
          }
      slabs = std::move(longer);
    }
    EXPECT_GT(slabs.size(), 50U) << variable.name;
    for (const io_detail::NcSlab& slab : slabs) expect_slab(file, library, variable, slab);
  }
  nc_close(library);
}

TEST(NetCdf, AnySlabOfAClassicFileIsWhatTheLibraryReads) {
  TempDir dir;
  for (const int format : {0, NC_64BIT_OFFSET, NC_64BIT_DATA})
    for (const nc_type type : {NC_BYTE, NC_SHORT, NC_INT, NC_FLOAT, NC_DOUBLE})
      for (const bool alone : {false, true}) {
        SCOPED_TRACE(testing::Message() << "format " << format << " type " << type << (alone ? " alone" : ""));
        write_records(dir / "a.nc", format, type, alone);
        expect_slabs(dir / "a.nc");
      }
}

}  // namespace
}  // namespace tegl::test
