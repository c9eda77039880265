# Configures, builds and runs SOURCE in the fresh folder BINARY; see CMakeLists.txt for the arguments.
file(REMOVE_RECURSE ${BINARY})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G ${GENERATOR}
  -D CMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
  -D CMAKE_CXX_FLAGS=${FLAGS} ${ARGUMENTS}
  COMMAND_ERROR_IS_FATAL ANY)
set(programs consumer consumer_eigen)
if(WITH_IO)
  list(APPEND programs consumer_io)
endif()
# All of tegl takes a quarter of an hour of processor time. A share of it shows that the sources and flags are right: what
# the consumer compiles, a source of each library, and the steps to its programs, counted but not run.
if(SHARE AND NOT DEFINED ENV{TEGL_FULL_TOPOLOGY})
  set(objects CMakeFiles/consumer.dir/main.cpp.o CMakeFiles/consumer_eigen.dir/main_eigen.cpp.o
    tegl/runtime/CMakeFiles/tegl.dir/src/base/memory.cpp.o)
  if(WITH_IO)
    list(APPEND objects CMakeFiles/consumer_io.dir/main_io.cpp.o
      tegl/runtime/io/CMakeFiles/tegl_io.dir/base/named_path.cpp.o)
  endif()
  execute_process(COMMAND ${MAKE_PROGRAM} -C ${BINARY} ${objects} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${MAKE_PROGRAM} -C ${BINARY} -n ${programs} OUTPUT_VARIABLE steps COMMAND_ERROR_IS_FATAL ANY)
  if(NOT steps MATCHES "\\[([0-9]+)/[0-9]+\\] Linking CXX executable consumer")
    message(FATAL_ERROR "no steps lead to the consumer: ${steps}")
  endif()
  list(LENGTH objects count)
  message("${count} sources compiled, the other steps (about ${CMAKE_MATCH_1}) only planned; TEGL_FULL_TOPOLOGY=1 runs them")
  return()
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BINARY} --parallel 2 --target ${programs} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${BINARY}/consumer COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${BINARY}/consumer_eigen COMMAND_ERROR_IS_FATAL ANY)
if(WITH_IO)
  execute_process(COMMAND ${BINARY}/consumer_io ${DATA} ${BINARY}/cut.ply COMMAND_ERROR_IS_FATAL ANY)
  if(NOT EXISTS ${BINARY}/cut.ply)
    message(FATAL_ERROR "consumer_io reported success, but ${BINARY}/cut.ply is not there")
  endif()
endif()
