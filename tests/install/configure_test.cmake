# What users of tegl get to read from CMake: SOURCE, the consumer, is configured and not built, below the fresh folder
# BINARY, with the tegl of TEGL_SOURCE or of the prefix PREFIX.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${BINARY})

# configure(name expected_status expected_output arguments...): `expected_status`: succeeds or fails; the output, its
# lines joined, has to match.
function(configure name expected_status expected_output)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY}/${name} -G ${GENERATOR}
    -D CMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -D CMAKE_CXX_COMPILER=${COMPILER} ${ARGN}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  set(is succeeds)
  if(status)
    set(is fails)
  endif()
  string(REGEX REPLACE "[ \n]+" " " text "${output}${errors}")
  if(NOT is STREQUAL expected_status OR NOT text MATCHES "${expected_output}")
    message(FATAL_ERROR "${name} ${is} and should be one that ${expected_status}, with '${expected_output}':\n${output}${errors}")
  endif()
endfunction()

if(WITH_IO)
  configure(fetch_content succeeds "Build files have been written" -DCONSUMER_USES=FetchContent -DTEGL_SOURCE=${TEGL_SOURCE}
    -DCONSUMER_WITH_IO=ON)
endif()
# Without the libraries of the file formats: the core alone, and a word about the rest.
set(without_netcdf -DCONSUMER_USES=add_subdirectory -DTEGL_SOURCE=${TEGL_SOURCE} -DCMAKE_DISABLE_FIND_PACKAGE_netCDF=ON)
configure(core_only succeeds "no target tegl::io [^.]*\\. Not found: netCDF \\(Debian: libnetcdf-dev\\)" ${without_netcdf})
configure(io_forced fails "TEGL_BUILD_IO=ON [^:]*tegl::io[^:]* needs packages that were not found: netCDF \\(Debian: libnetcdf-dev\\)"
  ${without_netcdf} -DTEGL_BUILD_IO=ON)
# A package without file formats: what is installed, less that component.
if(PREFIX)
  file(GLOB_RECURSE config ${PREFIX}/*/teglConfig.cmake)
  get_filename_component(installed "${config}" DIRECTORY)
  file(COPY ${installed}/ DESTINATION ${BINARY}/without_io)
  file(REMOVE ${BINARY}/without_io/tegl-io.cmake)
  configure(no_component fails "has no component io: it was built or installed without file formats"
    -Dtegl_DIR=${BINARY}/without_io -DCONSUMER_WITH_IO=ON)
endif()
