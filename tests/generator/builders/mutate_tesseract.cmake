# Writes a copy of the emitted builder of the tesseract, with its arrays, with one fault, in a namespace of its own:
#   cmake -DFOLDER=tables -DFAULT=swapped_frame -DIN=lists -DFROM=text -DTO=text -DOUT=folder -P mutate_tesseract.cmake
# Replaces the first FROM in builder4.hpp, builder4.cpp or builder4_lists.cpp (IN: header, source or lists) by TO, and
# writes OUT/FAULT.hpp, OUT/FAULT.cpp and OUT/FAULT_lists.cpp.
file(READ ${FOLDER}/builder4.hpp header)
file(READ ${FOLDER}/builder4.cpp source)
file(READ ${FOLDER}/builder4_lists.cpp lists)
string(FIND "${${IN}}" "${FROM}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "builder4: no '${FROM}' in the ${IN}; expected it for the fault ${FAULT}")
endif()
string(LENGTH "${FROM}" length)
string(SUBSTRING "${${IN}}" 0 ${at} before)
math(EXPR rest "${at} + ${length}")
string(SUBSTRING "${${IN}}" ${rest} -1 after)
set(${IN} "${before}${TO}${after}")
foreach(text header source lists)
  string(REPLACE "namespace tegl::builders" "namespace tegl::builders::${FAULT}" ${text} "${${text}}")
  string(REPLACE "\"builder4.hpp\"" "\"${FAULT}.hpp\"" ${text} "${${text}}")
endforeach()
file(WRITE ${OUT}/${FAULT}.hpp "${header}")
file(WRITE ${OUT}/${FAULT}.cpp "${source}")
file(WRITE ${OUT}/${FAULT}_lists.cpp "${lists}")
