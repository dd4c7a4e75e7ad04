# What `cmake --install` gives a C++ program (docs/cpp.md): libgeom and libcdem (libcdem_vtk: libcdem/vtk), the headers
# that are public, find_package(cdem) and pkg-config.
include(CMakePackageConfigHelpers)

# The headers that a program includes. With them go all that they include.
set(public_headers
    libgeom/assembly/builders.hpp libgeom/assembly/discs.hpp libgeom/assembly/edit.hpp libgeom/mesh/box_mesh.hpp
    libgeom/mesh/read_mesh.hpp libgeom/meshing/solid_mesh.hpp libgeom/assembly/tet_blocks.hpp
    libgeom/placement/armour_layer.hpp libgeom/placement/drop_grid.hpp libgeom/placement/pile_measures.hpp
    libgeom/solid/armour_units.hpp libgeom/solid/read_stl.hpp libgeom/solid/solid.hpp
    libcdem/simulation.hpp libcdem/results/contact_points.hpp libcdem/results/crack_surface.hpp
    libcdem/results/crack_tip.hpp libcdem/results/deformation.hpp libcdem/results/overlap.hpp
    libcdem/results/process_zone.hpp libcdem/results/units.hpp
    libcdem/vtk/chart.hpp libcdem/vtk/files.hpp libcdem/vtk/film.hpp libcdem/vtk/picture.hpp)

# `headers` with the headers of ours that they include, and so on.
function(cdem_with_included headers result)
  set(found)
  while(headers)
    list(POP_FRONT headers header)
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"lib")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
      if(NOT included IN_LIST found AND NOT included IN_LIST headers)
        list(APPEND headers ${included})
      endif()
    endforeach()
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

# Names, not the targets that were found: a program that links libcdem needs neither CGAL nor VTK to be found.
set(geom_uses voro++ gmsh gmp mpfr ${OpenMP_CXX_FLAGS})
set(cdem_uses fmt xxhash ${OpenMP_CXX_FLAGS})
foreach(kind SHARED STATIC)
  set(s)
  if(kind STREQUAL "STATIC")
    set(s _static)
  endif()
  cdem_public_library(geom ${kind} OBJECTS geom packing USES ${geom_uses})
  cdem_public_library(cdem ${kind} OBJECTS mechanics PUBLIC public_geom${s} USES ${cdem_uses})
endforeach()
cdem_with_included("${public_headers}" headers)
foreach(header IN LISTS headers)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${include_folder}/${folder})
endforeach()

# find_package(cdem)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/cdem)
configure_package_config_file(cmake/cdemConfig.cmake.in cmake/cdemConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(cmake/cdemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/cdemConfig.cmake ${PROJECT_BINARY_DIR}/cmake/cdemConfigVersion.cmake
        DESTINATION ${config_folder})
install(EXPORT cdem NAMESPACE cdem:: FILE cdemTargets.cmake DESTINATION ${config_folder})

# pkg-config; relative to the file, so that the tree may be moved.
file(RELATIVE_PATH from_pkgconfig /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
function(cdem_pkg_config name library text requires uses)
  list(TRANSFORM uses REPLACE "^([^-])" "-l\\1")
  list(JOIN uses " " uses)
  configure_file(cmake/pkgconfig.pc.in pkgconfig/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
cdem_pkg_config(cdem-geom geom "blocks, solids and meshes for cdem" eigen3 "${geom_uses}")
cdem_pkg_config(cdem cdem "${PROJECT_DESCRIPTION}" cdem-geom "${cdem_uses}")
cdem_pkg_config(cdem-vtk cdem_vtk "ParaView files and pictures of cdem" cdem "")
