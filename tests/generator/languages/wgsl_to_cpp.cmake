# Rewrites WGSL declarations as C++ ones, so that a host compiler runs what a shader would: functions, constants, arrays
# and locals of type u32 are all that the emitted tables have. Expressions and statements stay as they are.
#   cmake -DIN=table.wgsl -DOUT=table.inc -P wgsl_to_cpp.cmake
file(READ ${IN} text)
string(REGEX REPLACE "fn ([a-z0-9_]+)\\(" "static u32 \\1(" text "${text}")
string(REGEX REPLACE "([a-z_]+) : u32([,)])" "u32 \\1\\2" text "${text}")
string(REGEX REPLACE "\\) -> u32 {" ") {" text "${text}")
string(REGEX REPLACE "const ([A-Za-z0-9_]+) : u32 =" "const u32 \\1 =" text "${text}")
string(REGEX REPLACE "const ([a-z0-9_]+) : array<u32, ([0-9]+)> = array<u32, [0-9]+>\\(([^)]*)\\)"
       "const u32 \\1[\\2] = {\\3}" text "${text}")
string(REGEX REPLACE "let ([a-z]+) =" "const u32 \\1 =" text "${text}")
string(REGEX REPLACE "var ([a-z]+) =" "u32 \\1 =" text "${text}")
file(WRITE ${OUT} "${text}")
