# cmake -DOUTPUT=<file.cpp> -DFILES=<file>|<file>... -P EmbedFiles.cmake: text files as the C++ source of
# myowave::apps::embedded_file (apps/embedded_files.hpp).
cmake_minimum_required(VERSION 3.25)

set(source "// Written by cmake/EmbedFiles.cmake.\n#include \"apps/embedded_files.hpp\"\n
std::string_view myowave::apps::embedded_file(std::string_view name) {\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" content)
  string(APPEND source "  if (name == \"${name}\") return R\"embedded(${content})embedded\";\n")
endforeach()
string(APPEND source "  return {};\n}\n")
file(WRITE "${OUTPUT}" "${source}")
