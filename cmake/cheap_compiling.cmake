# What makes a build cheap and changes no result.

# gcc tidies its memory up every few megabytes; half a gigabyte later is soon enough and saves a tenth.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(cdem_options INTERFACE --param=ggc-min-expand=1000 --param=ggc-min-heapsize=524288)
endif()

# ccache takes precompiled headers only when told that they may be told apart by their contents.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$")
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${CMAKE_CXX_COMPILER_LAUNCHER})
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
endif()

# The headers of cmake/precompiled.hpp, and of those named, compiled once for a target.
function(cdem_precompile target)
  target_precompile_headers(${target} PRIVATE <cmake/precompiled.hpp> ${ARGN})
endfunction()

# For targets in which a run spends no time: -O3 takes half as long again as -O1.
function(cdem_compile_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Compiles the sources of a folder together, at most `most` at a time: the headers they share are read once. So names in
# their unnamed namespaces must differ within a folder. Wrappers of large libraries stay alone.
option(CDEM_COMPILE_TOGETHER "compile the sources of a folder together" ON)
# clang-tidy spends most of its time in the headers of others, so it sees many sources at once.
option(CDEM_LINT "for clang-tidy: compile the sources of a folder and of those below it together" OFF)
function(cdem_compile_together target most)
  if(NOT CDEM_COMPILE_TOGETHER)
    return()
  endif()
  set(large "CGAL/|voro\\+\\+|gmsh|vtk|CLI/|nlohmann/|httplib|lua[.]hpp")
  if(CDEM_LINT)
    set(most 1000)
    set(large "CGAL/|voro\\+\\+|vtk|CLI/|nlohmann/|httplib")
  endif()
  get_target_property(sources ${target} SOURCES)
  set(folder_before "")
  foreach(source IN LISTS sources)
    get_filename_component(source ${source} ABSOLUTE)
    if(NOT EXISTS ${source})
      continue() # generated
    endif()
    file(STRINGS ${source} wrapped REGEX "^#include *[<\"](${large})")
    if(wrapped)
      continue()
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    if(CDEM_LINT)
      string(REGEX REPLACE "^(libcdem/[^/]+|libgeom|lua|apps)(/.*)?$" "\\1" folder ${folder})
      string(REGEX REPLACE "^libcdem/(bolt|integrate|joint|material|parallel|state)$" "libcdem" folder ${folder})
    endif()
    if(NOT folder STREQUAL folder_before)
      set(folder_before ${folder})
      set(count 0)
    endif()
    math(EXPR group "${count} / ${most}")
    math(EXPR count "${count} + 1")
    string(REPLACE "/" "_" name ${folder})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
