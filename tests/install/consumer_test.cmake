# Configures, builds and runs SOURCE in the fresh folder BINARY; see CMakeLists.txt for the arguments.
file(REMOVE_RECURSE ${BINARY})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G ${GENERATOR}
  -D CMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
  -D CMAKE_CXX_FLAGS=${FLAGS} ${ARGUMENTS}
  COMMAND_ERROR_IS_FATAL ANY)
set(programs consumer)
if(WITH_IO)
  list(APPEND programs consumer_io)
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BINARY} --parallel 2 --target ${programs} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${BINARY}/consumer COMMAND_ERROR_IS_FATAL ANY)
if(WITH_IO)
  execute_process(COMMAND ${BINARY}/consumer_io ${DATA} ${BINARY}/cut.ply COMMAND_ERROR_IS_FATAL ANY)
  if(NOT EXISTS ${BINARY}/cut.ply)
    message(FATAL_ERROR "consumer_io reported success, but ${BINARY}/cut.ply is not there")
  endif()
endif()
