// Files of shapes. gmsh and OpenCASCADE read theirs in a child process: a crash of the child is an InputError.
#include "tests/fuzz/targets.hpp"

#include "libcdem/vtk/read_vtk_mesh.hpp"
#include "libcdem/vtk/read_water.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/solid/gmsh_session.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "libgeom/solid/read_surface.hpp"

#include <array>
#include <stdexcept>

namespace fuzz {

void read_stl(const std::string& bytes) {
  geom::read_stl(as_file("part.stl", bytes));
}

void read_dxf(const std::string& bytes) {
  geom::read_surface(as_file("ground.dxf", bytes), 1, geom::max_surface_triangles);
}

void read_polygons(const std::string& bytes) {
  static const std::array<const char*, 4> endings = {".obj", ".off", ".ply", ".ts"};
  if (bytes.empty())
    return;
  const std::size_t which = static_cast<unsigned char>(bytes[0]) % endings.size();
  geom::read_surface(as_file(std::string("part") + endings[which], bytes.substr(1)), 1,
                     geom::max_surface_triangles);
}

void read_vtk(const std::string& bytes) {
  cdem::read_vtk_mesh(as_file("part.vtk", bytes), "");
}

void read_water(const std::string& bytes) {
  static const std::array<const char*, 3> endings = {".vti", ".vtk", ".vtu"};
  if (bytes.empty())
    return;
  const std::size_t which = static_cast<unsigned char>(bytes[0]) % endings.size();
  cdem::WaterArrays wish;
  wish.velocity = "U";
  wish.pressure = "p";
  cdem::read_water({{as_file(std::string("water") + endings[which], bytes.substr(1))}, {0}}, wish);
}

void read_mesh(const std::string& bytes) {
  static const std::array<const char*, 5> endings = {".msh", ".mesh", ".bdf", ".unv", ".inp"};
  if (bytes.empty())
    return;
  const std::size_t which = static_cast<unsigned char>(bytes[0]) % endings.size();
  geom::read_mesh(as_file(std::string("part") + endings[which], bytes.substr(1)));
}

void read_step(const std::string& bytes) {
  geom::read_step(as_file("part.step", bytes));
}

void child_answer(const std::string& bytes) {
  const auto unpacked = [&](auto value) {
    try {
      geom::Unpacker in(bytes);
      unpack(in, value);
      in.end();
    } catch (const std::runtime_error&) { // refused
    }
    return value;
  };
  geom::validate(unpacked(geom::TetMesh()), "child");
  unpacked(geom::BlockMesh());
  unpacked(geom::Solid());
  unpacked(std::vector<geom::BlockMesh>());
  unpacked(geom::MassProperties());
}

} // namespace fuzz
