# Install rules and the package that find_package(tegl) reads, from an installation or from the build tree itself.
#
# Components of the package: core (always: tegl::tegl, with the tables inside) and io (tegl::io), if it is built.
# Components of `cmake --install --component`: these two, `program` (tegl, its manual page, completions and data) and
# `generator` (gen). Whatever the libraries link privately has to be found by users of a static build; which packages
# that are is read off the targets, so that the list cannot go stale.
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
        elseif(library MATCHES "^TBB::")
          list(APPEND packages "TBB")
        elseif(library MATCHES "^hwy::")
          list(APPEND packages "hwy")
        elseif(library MATCHES "^(meshoptimizer::|nlohmann_json::|TinyGLTF::|netCDF::)")
          string(REGEX REPLACE "::.*" "" package "${library}")
          list(APPEND packages "${package}")
        elseif(library MATCHES "^EXPAT::")
          list(APPEND packages "EXPAT")
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

# tegl_build_before_install(component targets FILES files...): `cmake --install` builds nothing, and a build of single
# targets, as by scripts/demo, leaves out others that are installed. Those whose files are missing are built first.
# Without a missing file the build tree is not touched: another user may run the installation.
function(tegl_build_before_install component)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FILES")
  list(JOIN arg_FILES "\" \"" files)
  list(JOIN arg_UNPARSED_ARGUMENTS " " targets)
  install(CODE "
foreach(file IN ITEMS \"${files}\")
  if(NOT EXISTS \"\${file}\")
    message(STATUS \"Not built yet: \${file}. Building the targets ${targets}\")
    execute_process(COMMAND \"${CMAKE_COMMAND}\" --build \"${CMAKE_BINARY_DIR}\" --config \"\${CMAKE_INSTALL_CONFIG_NAME}\"
      --target ${targets} COMMAND_ERROR_IS_FATAL ANY)
    break()
  endif()
endforeach()" COMPONENT ${component})
endfunction()

# tegl_install_component(component targets...): libraries, exported as tegl::<name> to the installation and to the build
# tree.
function(tegl_install_component component)
  set(files ${ARGN})
  list(TRANSFORM files REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  tegl_build_before_install(${component} ${ARGN} FILES ${files})
  install(TARGETS ${ARGN} EXPORT tegl-${component}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
  install(EXPORT tegl-${component} NAMESPACE tegl:: DESTINATION ${tegl_cmake_dir} FILE tegl-${component}.cmake
    COMPONENT ${component})
  export(EXPORT tegl-${component} NAMESPACE tegl:: FILE ${PROJECT_BINARY_DIR}/tegl-${component}.cmake)
endfunction()

set(tegl_core_targets tegl tegl_tile)
if(TARGET tegl_tables)
  list(APPEND tegl_core_targets tegl_tables)
endif()
tegl_needed_packages(tegl_core_dependencies ${tegl_core_targets})
tegl_install_component(core ${tegl_core_targets})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/tegl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core
  FILES_MATCHING PATTERN "*.hpp" PATTERN io.hpp EXCLUDE PATTERN io EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tile/include/tegl/tile DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tegl
  COMPONENT core)

set(tegl_io_dependencies "")
# An earlier configuration of this folder may have had the file formats.
file(REMOVE ${PROJECT_BINARY_DIR}/tegl-io.cmake)
if(TEGL_BUILD_IO)
  set_target_properties(tegl_io PROPERTIES EXPORT_NAME io)
  tegl_needed_packages(tegl_io_dependencies tegl_io)
  tegl_install_component(io tegl_io)
  install(FILES ${PROJECT_SOURCE_DIR}/runtime/include/tegl/io.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tegl COMPONENT io)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/tegl/io DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tegl COMPONENT io)
endif()

if(NOT CMAKE_CROSSCOMPILING)
  tegl_build_before_install(generator gen FILES $<TARGET_FILE:gen>)
endif()
install(TARGETS gen RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT generator)
if(TEGL_BUILD_APPS)
  set(tegl_reference_dir ${PROJECT_BINARY_DIR}/apps/cli)
  if(NOT CMAKE_CROSSCOMPILING)
    tegl_build_before_install(program tegl_cli tegl_cli_reference FILES $<TARGET_FILE:tegl_cli> ${tegl_reference_dir}/tegl.1)
    install(FILES ${tegl_reference_dir}/tegl.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
    install(FILES ${tegl_reference_dir}/completion/tegl DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
      COMPONENT program)
    install(FILES ${tegl_reference_dir}/completion/_tegl DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
      COMPONENT program)
    install(FILES ${tegl_reference_dir}/completion/tegl.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
      COMPONENT program)
  endif()
  install(TARGETS tegl_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(FILES ${PROJECT_SOURCE_DIR}/examples/data/ocean_temperature.nc DESTINATION ${CMAKE_INSTALL_DATADIR}/tegl
    COMPONENT program)
endif()

# Shared builds: a version on the libraries, and programs that find them wherever the prefix is moved.
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
  DESTINATION ${tegl_cmake_dir} COMPONENT core)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT core)
