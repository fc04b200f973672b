# cmake -DOUTPUT=<file.cpp> -DROOT=<project> -DFILES=<file>|<file>... -P EmbedFiles.cmake: text files as the C++ source of
# myowave::apps::embedded_file (apps/base/embedded_files.hpp). A README.md takes the name of its folder.
cmake_minimum_required(VERSION 3.25)

set(source "// Written by cmake/EmbedFiles.cmake.\n#include \"apps/base/embedded_files.hpp\"\n
std::string_view myowave::apps::embedded_file(std::string_view name) {\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  if(name STREQUAL "README.md")
    get_filename_component(folder "${file}" DIRECTORY)
    get_filename_component(name "${folder}" NAME)
    if(folder STREQUAL ROOT)
      set(name myowave)
    endif()
    string(APPEND name ".md")
  endif()
  file(READ "${file}" content)
  string(APPEND source "  if (name == \"${name}\") return R\"embedded(${content})embedded\";\n")
endforeach()
string(APPEND source "  return {};\n}\n")
file(WRITE "${OUTPUT}" "${source}")
