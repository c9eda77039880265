# Writes a copy of an emitted builder with one fault, in a namespace of its own inside of the builder's:
#   cmake -DFOLDER=tables -DNAME=builder3_edges -DFAULT=swapped_map -DIN=.cpp -DFROM=text -DTO=text -DOUT=folder
#         -P mutate.cmake
# Replaces the first FROM in FOLDER/NAME<IN> by TO, and writes OUT/FAULT.hpp, OUT/FAULT.cpp and, if the builder has
# arrays in a file of their own, OUT/FAULT_lists.cpp. If IN is .glsl or .wgsl, it writes only OUT/FAULT<IN>.
set(endings .hpp .cpp)
if(IN MATCHES "^\\.(glsl|wgsl)$")
  set(endings ${IN})
elseif(EXISTS ${FOLDER}/${NAME}_lists.cpp)
  list(APPEND endings _lists.cpp)
endif()
foreach(ending IN LISTS endings)
  file(READ ${FOLDER}/${NAME}${ending} text)
  if(ending STREQUAL IN)
    string(FIND "${text}" "${FROM}" at)
    if(at EQUAL -1)
      message(FATAL_ERROR "${NAME}${ending}: no '${FROM}'; expected it for the fault ${FAULT}")
    endif()
    string(LENGTH "${FROM}" length)
    string(SUBSTRING "${text}" 0 ${at} before)
    math(EXPR rest "${at} + ${length}")
    string(SUBSTRING "${text}" ${rest} -1 after)
    set(text "${before}${TO}${after}")
  endif()
  string(REGEX REPLACE "namespace (tegl::[a-z:]+)" "namespace \\1::${FAULT}" text "${text}")
  string(REPLACE "\"${NAME}.hpp\"" "\"${FAULT}.hpp\"" text "${text}")
  file(WRITE ${OUT}/${FAULT}${ending} "${text}")
endforeach()
