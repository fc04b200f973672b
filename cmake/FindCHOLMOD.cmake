# CHOLMOD of SuiteSparse: its own CMake package (SuiteSparse >= 7), else the headers and libraries that distributions
# install. Defines the target SuiteSparse::CHOLMOD, and without a package CHOLMOD_SUITESPARSE_VERSION.
find_package(CHOLMOD CONFIG QUIET)
if(TARGET SuiteSparse::CHOLMOD)
  set(CHOLMOD_FOUND TRUE)
  return()
endif()

find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
find_library(CHOLMOD_CONFIG_LIBRARY suitesparseconfig)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR)
if(CHOLMOD_FOUND)
  file(STRINGS ${CHOLMOD_INCLUDE_DIR}/SuiteSparse_config.h numbers REGEX "define SUITESPARSE_(MAIN|SUB)_VERSION")
  string(REGEX MATCHALL "[0-9]+" numbers "${numbers}")
  list(JOIN numbers "." CHOLMOD_SUITESPARSE_VERSION)
  add_library(SuiteSparse::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(SuiteSparse::CHOLMOD PROPERTIES
    IMPORTED_LOCATION "${CHOLMOD_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}")
  if(CHOLMOD_CONFIG_LIBRARY)
    set_property(TARGET SuiteSparse::CHOLMOD PROPERTY INTERFACE_LINK_LIBRARIES "${CHOLMOD_CONFIG_LIBRARY}")
  endif()
endif()
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY CHOLMOD_CONFIG_LIBRARY)
