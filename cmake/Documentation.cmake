# The target `docs`: pages of the libraries' headers and the folders' READMEs, in docs/html of the build folder.
# Any warning of doxygen fails it.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()

set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/docs)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_FILE_PATTERNS *.hpp *.md)
set(DOXYGEN_FILTER_PATTERNS "*.hpp=awk -f cmake/doxygen_filter.awk"
    "*.md=awk -v root='${PROJECT_SOURCE_DIR}' -f cmake/doxygen_readme.awk")
set(DOXYGEN_IMAGE_PATH apps/scenes solver/studies)

set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)

# Macros of Kokkos that stand in signatures.
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_PREDEFINED KOKKOS_FUNCTION= KOKKOS_INLINE_FUNCTION=inline KOKKOS_FORCEINLINE_FUNCTION=inline
    KOKKOS_RESTRICT=)

get_target_property(kernel_headers myowave_kernels HEADER_SET)
get_target_property(solver_headers myowave_solver HEADER_SET)
file(GLOB_RECURSE pages CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} apps/*.md bench/*.md cmake/*.md kernels/*.md solver/*.md
     tests/*.md)
doxygen_add_docs(docs README.md CONTRIBUTING.md ${pages} ${kernel_headers} ${solver_headers}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Writing ${PROJECT_BINARY_DIR}/docs/html")
