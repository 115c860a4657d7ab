# cmake -DFOLDER=web -DOUTPUT=web_files.cpp -P embed_web_files.cmake: the files of a folder as one C++ source, what
# apps/view/web_files.h declares.
file(GLOB names RELATIVE ${FOLDER} ${FOLDER}/*)
set(arrays "")
set(rows "")
set(number 0)
foreach(name IN LISTS names)
  if(IS_DIRECTORY ${FOLDER}/${name})
    continue()
  endif()
  file(READ ${FOLDER}/${name} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND arrays "constexpr unsigned char kFile${number}[] = {${bytes}0};\n")
  string(APPEND rows "    {\"${name}\", {reinterpret_cast<const char*>(kFile${number}), sizeof(kFile${number}) - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
set(text "// Made from web/ by embed_web_files.cmake.
#include \"view/web_files.h\"

namespace arris::view {
namespace {

${arrays}
const WebFile kFiles[] = {
${rows}};

}  // namespace

std::span<const WebFile> web_files() {
  return kFiles;
}

}  // namespace arris::view
")
file(WRITE ${OUTPUT} "${text}")
