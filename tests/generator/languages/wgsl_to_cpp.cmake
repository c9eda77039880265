# Rewrites WGSL declarations as C++ ones, so that a host compiler runs what a shader would: functions, constants, arrays
# and locals of type u32 are all that the emitted tables have; builders also have structs, f32 and bool. Expressions and
# statements stay as they are.
#   cmake -DIN=table.wgsl -DOUT=table.inc -P wgsl_to_cpp.cmake
file(READ ${IN} text)
string(REGEX REPLACE "struct ([a-z0-9_]+) {([^}]*)}" "struct \\1 {\\2};" text "${text}")
string(REGEX REPLACE "\n  ([a-z_]+) : array<u32, ([0-9]+)>," "\n  u32 \\1[\\2];" text "${text}")
string(REGEX REPLACE "\n  ([a-z_]+) : u32," "\n  u32 \\1;" text "${text}")
string(REGEX REPLACE "fn ([a-z0-9_]+)\\(([^{)]*)\\) -> ([a-z0-9_]+) {" "static \\3 \\1(\\2) {" text "${text}")
string(REGEX REPLACE "([a-z_]+) : (u32|f32|bool)([,)])" "\\2 \\1\\3" text "${text}")
string(REGEX REPLACE "([a-z_]+) : array<f32, ([0-9]+)>([,)])" "std::array<f32, \\2> \\1\\3" text "${text}")
string(REGEX REPLACE "const ([A-Za-z0-9_]+) : u32 =" "const u32 \\1 =" text "${text}")
string(REGEX REPLACE "const ([a-z0-9_]+) : array<u32, ([0-9]+)> = array<u32, [0-9]+>\\(([^)]*)\\)"
       "const u32 \\1[\\2] = {\\3}" text "${text}")
string(REGEX REPLACE "let ([a-z]+) : f32 =" "const f32 \\1 =" text "${text}")
string(REGEX REPLACE "var ([a-z]+) : bool =" "bool \\1 =" text "${text}")
string(REGEX REPLACE "var ([a-z]+) : array<f32, ([0-9]+)> =" "std::array<f32, \\2> \\1 =" text "${text}")
string(REGEX REPLACE "var ([a-z]+) : ([a-z0-9_]+);" "\\2 \\1;" text "${text}")
string(REGEX REPLACE "let ([a-z]+) =" "const u32 \\1 =" text "${text}")
string(REGEX REPLACE "var ([a-z]+) =" "u32 \\1 =" text "${text}")
file(WRITE ${OUT} "${text}")
