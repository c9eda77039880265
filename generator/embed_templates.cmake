# Writes a C++ source with the texts of templates as string literals, so that `gen` is one self-contained program:
#   cmake -DFOLDER=templates -DNAMES=a.hpp,b.cpp -DOUT=templates_data.cpp -P embed_templates.cmake
# Template NAME is the file FOLDER/NAME.in.
string(REPLACE "," ";" names "${NAMES}")
set(text "// Written by embed_templates.cmake.
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include \"base/error.hpp\"
#include \"builders/templates.hpp\"

namespace tegl::gen {

std::string_view template_text(std::string_view name) {
  using Text = std::pair<std::string_view, std::string_view>;
  static constexpr std::array kTexts{
")
foreach(name IN LISTS names)
  file(READ ${FOLDER}/${name}.in content)
  string(APPEND text "Text{\"${name}\", R\"template~(${content})template~\"},\n")
endforeach()
string(APPEND text "  };
  for (const auto& [known, text] : kTexts)
    if (known == name) return text;
  throw Error(ErrorCode::Internal, \"no template \" + std::string(name));
}

}  // namespace tegl::gen
")
file(WRITE ${OUT} "${text}")
