# cmake -DSOURCE=<project> -DVERSION=<of project()> -P version.cmake: CITATION.cff and the newest heading of
# CHANGELOG.md name the version of CMakeLists.txt; the heading may also be Unreleased.
cmake_minimum_required(VERSION 3.25)

file(STRINGS ${SOURCE}/CITATION.cff line REGEX "^version:")
if(NOT line STREQUAL "version: ${VERSION}")
  message(SEND_ERROR "CITATION.cff: expected \"version: ${VERSION}\", found \"${line}\"")
endif()

# Brackets would join the elements of a list.
file(READ ${SOURCE}/CHANGELOG.md changes)
string(REGEX MATCH "\n## \\[([^]]*)\\]" heading "${changes}")
if(NOT CMAKE_MATCH_1 STREQUAL "Unreleased" AND NOT CMAKE_MATCH_1 STREQUAL VERSION)
  message(SEND_ERROR "CHANGELOG.md: expected Unreleased or ${VERSION}, found \"${CMAKE_MATCH_1}\"")
endif()
