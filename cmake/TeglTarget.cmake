# Warnings and test registration, the same for every target of the project.

# TEGL_OWN_WARNINGS, if the caller sets it: options after these, which change them.
# Who builds the project only to use it is spared warnings: at -O3 GCC 12 has false alarms, of std::sort of short arrays
# for one. Tests, and builds where warnings are errors, have them all.
function(tegl_warnings target)
  if(NOT TEGL_BUILD_TESTS AND NOT TEGL_WERROR)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-aggressive-loop-optimizations -Wno-stringop-overflow)
    endif()
    return()
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
    ${TEGL_OWN_WARNINGS})
  # GCC 12 warns of overlapping copies in its own std::string (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(TEGL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
    # It also warns of copies that would end outside a string. That depends on the lengths of literals, such as the name
    # of the build folder, so these warnings must not end a build.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-error=array-bounds -Wno-error=stringop-overflow
        -Wno-error=stringop-overread)
    endif()
  endif()
endfunction()

# tegl_precompile(target headers...): with TEGL_PRECOMPILE_HEADERS, headers of others are read once per target and not once
# per source. Not under a compiler launcher: ccache, for one, could keep nothing then.
function(tegl_precompile target)
  if(TEGL_PRECOMPILE_HEADERS AND NOT TEGL_UNITY_BUILD AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <span>
      <string> <vector> ${ARGN})
  endif()
endfunction()

# tegl_unity(target [BATCH n] [ALONE sources...] [TOGETHER folders...]): with TEGL_UNITY_BUILD, the sources of a room (a
# folder) are compiled together, at most `n` (8) at a time. Headers are read once, and templates are instantiated once.
# ALONE: sources, or folders of sources, that are compiled by themselves; so are the sources that Highway compiles several
# times, and those with compile options of their own. TOGETHER: folders that count as one room.
function(tegl_unity target)
  if(NOT TEGL_UNITY_BUILD)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "BATCH" "ALONE;TOGETHER")
  if(NOT arg_BATCH)
    set(arg_BATCH 8)
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "\\.cpp$" OR IS_ABSOLUTE "${source}")
      continue()
    endif()
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(folder ${source} DIRECTORY)
    file(STRINGS ${path} several_targets REGEX "HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(several_targets OR source IN_LIST arg_ALONE OR folder IN_LIST arg_ALONE)
      set_property(SOURCE ${source} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
      continue()
    endif()
    if(folder IN_LIST arg_TOGETHER)
      list(GET arg_TOGETHER 0 folder)
    endif()
    string(MAKE_C_IDENTIFIER "${folder}" room)
    if(NOT DEFINED count_${room})
      set(count_${room} 0)
    endif()
    math(EXPR batch "${count_${room}} / ${arg_BATCH}")
    math(EXPR count_${room} "${count_${room}} + 1")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${room}_${batch})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Every source is an included file there, so GCC warns of anonymous namespaces. It has false alarms of
  # uninitialised values in functions this large; the preset dev has both warnings.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage -Wno-maybe-uninitialized)
  endif()
endfunction()

# tegl_release_level(level targets...): the optimisation level of targets in Release, for other code than loops over
# samples and simplices: higher levels compile for longer and make it no faster.
function(tegl_release_level level)
  if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    foreach(target IN LISTS ARGN)
      target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${level}>)
    endforeach()
  endif()
endfunction()

# An option of sources: in Release, GCC also inlines functions that another library could replace, as clang always does. For
# code that calls many small functions: 2 % fewer instructions for 4D noise by Ambiguity::mean.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(tegl_inlines_all $<$<CONFIG:Release>:-fno-semantic-interposition>)
endif()

# tegl_quick_compile(target): for tests in the development preset. They compile in three quarters of the time at -O1, and
# most of what they run is the library, at -O2.
function(tegl_quick_compile target)
  if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O1>)
  endif()
endfunction()

# tegl_quick_level(level targets...): the optimisation level of targets with TEGL_QUICK_BUILD, whatever the configuration.
# Clang compiles at -O0 in less than half of its time at -O1; GCC saves nothing.
function(tegl_quick_level level)
  if(TEGL_QUICK_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND level STREQUAL "-O1")
      set(level -O0)
    endif()
    foreach(target IN LISTS ARGN)
      target_compile_options(${target} PRIVATE ${level})
    endforeach()
  endif()
endfunction()

# tegl_test_precompile(target [level]): the same for a test program. All of them with the same level of tegl_quick_level share
# what one of them has read.
function(tegl_test_precompile target)
  if(NOT TEGL_PRECOMPILE_HEADERS OR CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  set(headers tegl_test_headers${ARGN})
  if(NOT TARGET ${headers})
    set(source ${PROJECT_BINARY_DIR}/tegl_test_headers.cpp)
    if(NOT EXISTS ${source})
      file(WRITE ${source} "int main() { return 0; }\n")
    endif()
    # A program, as tests are: objects of libraries have other flags.
    add_executable(${headers} EXCLUDE_FROM_ALL ${source})
    target_link_libraries(${headers} PRIVATE tegl::tegl Eigen3::Eigen GTest::gmock)
    tegl_quick_compile(${headers})
    if(ARGN)
      tegl_quick_level(${ARGN} ${headers})
    endif()
    target_precompile_headers(${headers} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
      <functional> <map> <random> <set> <string> <vector> <gtest/gtest.h> <gmock/gmock.h> <Eigen/Core>)
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

# tegl_define_where_used(macro text SOURCES sources...): defines the macro as a string for those sources that name it. The
# others compile to the same object files in every checkout, so that ccache has them for all checkouts at once.
function(tegl_define_where_used macro text)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES")
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(path ${source} ABSOLUTE)
    if(EXISTS ${path})
      file(STRINGS ${path} uses REGEX ${macro} LIMIT_COUNT 1)
      if(uses)
        set_property(SOURCE ${source} APPEND PROPERTY COMPILE_DEFINITIONS "${macro}=\"${text}\"")
      endif()
    endif()
  endforeach()
endfunction()

# tegl_add_test(name sources... LIBS libraries... [UNOPTIMISED]): a GoogleTest program, its cases known to ctest one by one.
# UNOPTIMISED: its own code is short of loops, and is not optimised with TEGL_QUICK_BUILD.
function(tegl_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "UNOPTIMISED" "TIMEOUT" "LIBS")
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} Eigen3::Eigen GTest::gmock GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  if(TEGL_UNITY_BUILD)
    # A source with definitions of its own would be compiled by itself.
    target_compile_definitions(${name} PRIVATE TEGL_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
      TEGL_SHARED_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")
  else()
    tegl_define_where_used(TEGL_SOURCE_DIR "${PROJECT_SOURCE_DIR}" SOURCES ${arg_UNPARSED_ARGUMENTS})
    tegl_define_where_used(TEGL_SHARED_DATA_DIR "${PROJECT_SOURCE_DIR}/../shared/data" SOURCES ${arg_UNPARSED_ARGUMENTS})
  endif()
  tegl_warnings(${name})
  tegl_quick_compile(${name})
  set(level)
  if(arg_UNOPTIMISED AND TEGL_QUICK_BUILD)
    set(level -O0)
    tegl_quick_level(${level} ${name})
  endif()
  tegl_unity(${name})
  tegl_test_precompile(${name} ${level})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${arg_TIMEOUT})
endfunction()
