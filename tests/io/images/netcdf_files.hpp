// SPDX-License-Identifier: BSD-3-Clause
//
// Writes netCDF files for the tests with the netCDF library.
#pragma once

#include <gtest/gtest.h>
#include <netcdf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tegl::test {

/// A file being defined; every call must succeed. The destructor writes the file.
class NcWriter {
 public:
  explicit NcWriter(const std::filesystem::path& path, int format = 0) {
    ok(nc_create(path.c_str(), NC_CLOBBER | format, &id_));
  }
  ~NcWriter() { ok(nc_close(id_)); }
  NcWriter(const NcWriter&) = delete;
  NcWriter& operator=(const NcWriter&) = delete;

  int dimension(const std::string& name, std::size_t size) {
    int dimension = 0;
    ok(nc_def_dim(id_, name.c_str(), size, &dimension));
    return dimension;
  }
  int variable(const std::string& name, nc_type type, const std::vector<int>& dimensions) {
    int variable = 0;
    ok(nc_def_var(id_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &variable));
    return variable;
  }
  void text(int variable, const std::string& name, const std::string& value) {
    ok(nc_put_att_text(id_, variable, name.c_str(), value.size(), value.data()));
  }
  void number(int variable, const std::string& name, nc_type type, const std::vector<double>& values) {
    ok(nc_put_att_double(id_, variable, name.c_str(), type, values.size(), values.data()));
  }
  /// Ends the definitions; values follow.
  void end() { ok(nc_enddef(id_)); }
  void values(int variable, const std::vector<double>& values) { ok(nc_put_var_double(id_, variable, values.data())); }
  void values(int variable, const std::vector<std::size_t>& count, const std::vector<double>& values) {
    const std::vector<std::size_t> start(count.size(), 0);
    ok(nc_put_vara_double(id_, variable, start.data(), count.data(), values.data()));
  }
  [[nodiscard]] int id() const { return id_; }
  static void ok(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }

 private:
  int id_ = -1;
};

}  // namespace tegl::test
