# Builds the preset `demo`, which scripts/demo builds: the program, compiled by clang. Nothing else compiles all of it by
# clang. Then makes and checks a contour.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "${command}: ${result}\n${out}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --preset demo --fresh -B ${BINARY} ${ARGUMENTS})
run(${CMAKE_COMMAND} --build ${BINARY} --target tegl_cli --parallel 2)
run(${BINARY}/bin/tegl contour ${DATA} --iso 20 -o ${BINARY}/demo.vtkhdf)
run(${BINARY}/bin/tegl check ${BINARY}/demo.vtkhdf)
