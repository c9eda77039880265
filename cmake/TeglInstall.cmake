# Install rules and the package that find_package(tegl) reads.
#
# Components: core (always: tegl::tegl, with the tables inside) and io (tegl::io), where it was built.
# Whatever the libraries link privately has to be found by users of a static build; which packages that are
# is read off the targets, so that the list cannot go stale.
include(CMakePackageConfigHelpers)

set(tegl_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tegl)

# tegl_needed_packages(out target...): the find_dependency() lines for what the targets link.
function(tegl_needed_packages out)
  set(packages "")
  foreach(target IN LISTS ARGN)
    foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
      get_target_property(libraries ${target} ${property})
      if(NOT libraries)
        continue()
      endif()
      foreach(library IN LISTS libraries)
        string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
        if(library MATCHES "^fmt::")
          list(APPEND packages "fmt")
        elseif(library MATCHES "^Eigen3::")
          list(APPEND packages "Eigen3 3.4")
        elseif(library MATCHES "^TBB::")
          list(APPEND packages "TBB")
        elseif(library MATCHES "^hwy::")
          list(APPEND packages "hwy")
        elseif(library MATCHES "^(assimp::|meshoptimizer::|nlohmann_json::|TinyGLTF::|netCDF::)")
          string(REGEX REPLACE "::.*" "" package "${library}")
          list(APPEND packages "${package}")
        elseif(library MATCHES "^ZLIB::")
          list(APPEND packages "ZLIB")
        elseif(library MATCHES "^(hdf5::|HDF5::)")
          list(APPEND packages "HDF5 COMPONENTS C")
        elseif(library MATCHES "^Threads::")
          list(APPEND packages "Threads")
        endif()
      endforeach()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  list(SORT packages)
  set(lines "")
  foreach(package IN LISTS packages)
    string(APPEND lines "find_dependency(${package})\n")
  endforeach()
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

# tegl_install_component(component targets...): libraries and programs, exported as tegl::<name>.
function(tegl_install_component component)
  install(TARGETS ${ARGN} EXPORT tegl-${component}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(EXPORT tegl-${component} NAMESPACE tegl:: DESTINATION ${tegl_cmake_dir} FILE tegl-${component}.cmake)
endfunction()

set(tegl_core_targets tegl tegl_facets)
if(TARGET tegl_tables)
  list(APPEND tegl_core_targets tegl_tables)
endif()
tegl_needed_packages(tegl_core_dependencies ${tegl_core_targets})
tegl_install_component(core ${tegl_core_targets})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/tegl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.hpp" PATTERN "io.hpp" EXCLUDE PATTERN "series.hpp" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/generator/include/tegl/facets DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tegl)

set(tegl_io_dependencies "")
if(TEGL_BUILD_IO)
  tegl_needed_packages(tegl_io_dependencies tegl_io)
  tegl_install_component(io tegl_io)
  install(FILES ${PROJECT_SOURCE_DIR}/runtime/include/tegl/io.hpp ${PROJECT_SOURCE_DIR}/runtime/include/tegl/series.hpp
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tegl)
  set_target_properties(tegl_io PROPERTIES EXPORT_NAME io)
endif()

# Shared builds: a version on the libraries, and programs that find them wherever the prefix is moved.
install(TARGETS gen RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(BUILD_SHARED_LIBS)
  file(RELATIVE_PATH tegl_bin_to_lib ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  foreach(target ${tegl_core_targets} tegl_io gen tegl_cli)
    if(TARGET ${target})
      set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN;$ORIGIN/${tegl_bin_to_lib}")
    endif()
  endforeach()
  set_target_properties(${tegl_core_targets} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0)
  if(TARGET tegl_io)
    set_target_properties(tegl_io PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0)
  endif()
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/teglConfig.cmake.in ${PROJECT_BINARY_DIR}/teglConfig.cmake
  INSTALL_DESTINATION ${tegl_cmake_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/teglConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/teglConfig.cmake ${PROJECT_BINARY_DIR}/teglConfigVersion.cmake
  DESTINATION ${tegl_cmake_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
