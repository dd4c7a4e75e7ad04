# Libraries for C++ programs (docs/cpp.md), made of the objects that the program is made of. A build with sanitizers makes
# none.
set(include_folder ${CMAKE_INSTALL_INCLUDEDIR}/cdem)

# Wide vectors would change the alignment of Eigen's types, and with it the layout of ours, in programs that are
# compiled for wider registers than the libraries are.
set(public_definition EIGEN_MAX_ALIGN_BYTES=16)

# cdem_public_library(<name> <STATIC|SHARED> OBJECTS <targets> PUBLIC <libraries> USES <libraries>)
function(cdem_public_library name kind)
  if(CDEM_SANITIZE)
    return()
  endif()
  cmake_parse_arguments(of "" "" "OBJECTS;PUBLIC;USES" ${ARGN})
  set(target public_${name})
  if(kind STREQUAL "STATIC")
    string(APPEND target _static)
  endif()
  list(TRANSFORM of_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  add_library(${target} ${kind} ${of_OBJECTS})
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name} LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH $ORIGIN
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  string(REGEX REPLACE "^public_" "" exported ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${exported})
  target_compile_features(${target} INTERFACE cxx_std_17)
  target_compile_definitions(${target} INTERFACE ${public_definition})
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${include_folder}>)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${of_PUBLIC} PRIVATE ${of_USES})
  if(kind STREQUAL "SHARED")
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  install(TARGETS ${target} EXPORT cdem)
endfunction()
