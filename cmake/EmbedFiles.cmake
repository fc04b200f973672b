# cmake -DOUTPUT=<file.cpp> -DROOT=<project> -DFILES=<file>|<file>... -P EmbedFiles.cmake: text files as the C++ source of
# myowave::apps::embedded_file (apps/base/embedded_files.hpp). Markdown is named by its path from the root, since every room has
# a README.md; other files by their names without folder.
cmake_minimum_required(VERSION 3.25)

set(source "// Written by cmake/EmbedFiles.cmake.\n#include \"apps/base/embedded_files.hpp\"\n
std::string_view myowave::apps::embedded_file(std::string_view name) {\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  cmake_path(GET file FILENAME name)
  if(name MATCHES "\\.md$")
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${ROOT} OUTPUT_VARIABLE name)
  endif()
  if(name IN_LIST names)
    message(FATAL_ERROR "two embedded files are named ${name}; the second is ${file}")
  endif()
  list(APPEND names ${name})
  file(READ "${file}" content)
  string(APPEND source "  if (name == \"${name}\") return R\"embedded(${content})embedded\";\n")
endforeach()
string(APPEND source "  return {};\n}\n")
file(WRITE "${OUTPUT}" "${source}")
