# The libraries that tegl::io needs, found here and not in runtime/io, as whether it is built depends on them: with
# TEGL_BUILD_IO=ON one that is missing is an error, with AUTO tegl::io is left out. Sets TEGL_BUILD_IO to ON or OFF.
#
# HDF5 is linked by its path, so that users of an installed tegl::io need not its package's CMake files.
find_package(netCDF QUIET)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_search_module(TEGL_HDF5 QUIET hdf5 hdf5-serial)
endif()
find_package(ZLIB QUIET)
find_package(EXPAT QUIET)
find_package(nlohmann_json QUIET)

# What is missing, each with the Debian package that has it.
set(tegl_io_missing "")
foreach(need "netCDF_FOUND|netCDF|libnetcdf-dev" "PkgConfig_FOUND|pkg-config|pkg-config"
    "TEGL_HDF5_FOUND|HDF5 (by pkg-config)|libhdf5-dev" "ZLIB_FOUND|zlib|zlib1g-dev" "EXPAT_FOUND|Expat|libexpat1-dev"
    "nlohmann_json_FOUND|nlohmann_json|nlohmann-json3-dev")
  string(REPLACE "|" ";" need "${need}")
  list(POP_FRONT need found name package)
  if(NOT ${found})
    list(APPEND tegl_io_missing "${name} (Debian: ${package})")
  endif()
endforeach()
list(JOIN tegl_io_missing ", " tegl_io_missing)

if(tegl_io_missing STREQUAL "")
  set(TEGL_BUILD_IO ON)
elseif(TEGL_BUILD_IO STREQUAL "AUTO")
  message(STATUS "tegl: no target tegl::io (file formats). Not found: ${tegl_io_missing}")
  set(TEGL_BUILD_IO OFF)
else()
  message(FATAL_ERROR "TEGL_BUILD_IO=${TEGL_BUILD_IO} (file formats, tegl::io) needs packages that were not found: "
    "${tegl_io_missing}. Install it, or configure with -DTEGL_BUILD_IO=OFF.")
endif()
