// STL surfaces and mesh files: what is right comes in whole, what is wrong is named.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "tests/libgeom/mesh_files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <cstring>
#include <fstream>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

namespace {

std::vector<std::array<Vec3, 3>> box_triangles() {
  const Polyhedron p = make_box({0, 0, 0}, {1, 2, 3});
  std::vector<std::array<Vec3, 3>> out;
  for (const PolyhedronFace& face : p.faces)
    for (std::size_t i = 2; i < face.loop.size(); ++i)
      out.push_back({p.vertices[face.loop[0]], p.vertices[face.loop[i - 1]], p.vertices[face.loop[i]]});
  return out;
}

std::string text_stl(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::ostringstream out;
  out << "solid box\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : t)
      out << "vertex " << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
  return out.str();
}

std::string binary_stl(const std::vector<std::array<Vec3, 3>>& triangles) {
  std::string out(84 + 50 * triangles.size(), '\0');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  std::memcpy(&out[80], &count, 4);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i) {
        const auto x = static_cast<float>(triangles[t][c][i]);
        std::memcpy(&out[84 + 50 * t + 12 + 12 * c + 4 * static_cast<std::size_t>(i)], &x, 4);
      }
  return out;
}

struct Stl {
  TemporaryFolder folder;
  std::string operator()(const std::string& bytes) const {
    std::ofstream(folder / "part.stl", std::ios::binary) << bytes;
    return folder / "part.stl";
  }
};

} // namespace

TEST_CASE("a closed STL surface, text or binary, becomes a solid of its volume that can be meshed") {
  const Stl write;
  for (const std::string& bytes : {text_stl(box_triangles()), binary_stl(box_triangles())}) {
    const Solid solid = make_solid(read_stl(write(bytes), 0.5));
    CHECK(mass_properties(solid).volume == Approx(6 * 0.125).epsilon(1e-6));
    CHECK(volume(mesh_solid(solid, {0.3})) == Approx(0.75).epsilon(1e-6));
  }
}

TEST_CASE("an STL with all normals inward is turned outward") {
  const Stl write;
  auto triangles = box_triangles();
  for (auto& t : triangles)
    std::swap(t[0], t[1]);
  CHECK(mass_properties(make_solid(read_stl(write(text_stl(triangles))))).volume == Approx(6).epsilon(1e-6));
}

TEST_CASE("an STL that is no closed surface is refused with the place") {
  const Stl write;
  auto open = box_triangles();
  open.pop_back();
  CHECK_THAT(refusal([&] { read_stl(write(text_stl(open))); }),
             Contains("it is open: 3 edges belong to one triangle only"));
  auto flipped = box_triangles();
  std::swap(flipped[0][0], flipped[0][1]);
  CHECK_THAT(refusal([&] { read_stl(write(text_stl(flipped))); }), Contains("point different ways near ("));
  auto two = box_triangles();
  for (const auto& t : box_triangles())
    two.push_back({t[0] + Vec3(9, 0, 0), t[1] + Vec3(9, 0, 0), t[2] + Vec3(9, 0, 0)});
  CHECK_THAT(refusal([&] { read_stl(write(text_stl(two))); }), Contains("it holds several"));
  std::string nan = text_stl(box_triangles());
  nan.replace(nan.find("vertex ") + 7, 1, "nan");
  CHECK_THAT(refusal([&] { read_stl(write(nan)); }), Contains("triangle 1 has a corner at {nan"));
  CHECK_THAT(refusal([&] { read_stl(write("not a surface")); }),
             Contains("neither a text nor a whole binary one"));
  CHECK_THAT(refusal([&] { read_stl(write(binary_stl(box_triangles()).substr(0, 300))); }),
             Contains("must be an STL file"));
  CHECK_THAT(refusal([&] { read_stl(write.folder / "none.stl"); }), Contains("an existing STL file"));
}

TEST_CASE("a gmsh file gives its tets, and what is wrong in one is named") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes) {
    std::ofstream(folder / "part.msh") << bytes;
    return read_mesh(folder / "part.msh");
  };
  const TetMesh one = read(msh("0 1 0", "4 2 0 1 1 2 3 4"));
  CHECK(one.tets.size() == 1);
  CHECK(volume(one) == Approx(1. / 6));
  CHECK_THAT(refusal([&] { read(msh("0 nan 0", "4 2 0 1 1 2 3 4")); }),
             Contains("every coordinate must be a finite number"));
  CHECK_THAT(refusal([&] { read(msh("0 1 0", "4 2 0 1 2 1 3 4")); }), Contains("is inverted"));
  CHECK_THAT(refusal([&] { read(msh("1 1 0", "2 2 0 1 1 2 3")); }),
             Contains("no tetrahedra; a mesh of volume elements is needed"));
  CHECK_THAT(refusal([&] { read_mesh(folder / "none.msh"); }), Contains("an existing mesh file"));
  CHECK_THAT(refusal([&] { read("no mesh at all\n"); }), Contains("its first line must be $MeshFormat"));
  CHECK_THAT(refusal([&] { read("$MeshFormat\nnonsense\n"); }), Contains("part.msh"));
  CHECK_THAT(refusal([&] { read(msh("0 1 0", "5 2 0 1 1 2 3 4 1 2 3 4")); }),
             Contains("not tetrahedra with four nodes"));
  CHECK(read(msh("0 1 0", "4 2 0 1 1 2 3 4")).tets.size() == 1); // and reading goes on
}

TEST_CASE("gmsh, Medit, Nastran, I-deas and VTK files give their tets") {
  const TemporaryFolder folder;
  for (const auto& [name, text] : one_tet_files()) {
    INFO(name);
    std::ofstream(folder / name) << text;
    const TetMesh mesh = read_mesh(folder / name);
    CHECK(mesh.tets.size() == 1);
    CHECK(volume(mesh) == Approx(1. / 6));
  }
}

TEST_CASE("a script of gmsh's passed off as a mesh runs nothing") {
  const TemporaryFolder folder;
  const std::string trace = folder / "trace";
  for (const std::string ending :
       {".msh", ".mesh", ".bdf", ".unv", ".vtk", ".geo", ".inp", ".txt", ".MSH", ""}) {
    const std::string path = folder / ("script" + ending);
    std::ofstream(path) << "SystemCall \"touch " << trace << "\";\n";
    CHECK_FALSE(refusal([&] { read_mesh(path); }).empty());
    CHECK_FALSE(std::ifstream(trace).good());
  }
  const std::string step = folder / "script.step", stl = folder / "script.stl";
  for (const std::string& path : {step, stl})
    std::ofstream(path) << "SystemCall \"touch " << trace << "\";\n";
  CHECK_THROWS_AS(read_step(step), InputError);
  CHECK_THROWS_AS(read_stl(stl), InputError);
  CHECK_FALSE(std::ifstream(trace).good());
}

TEST_CASE("gmsh reads no file but the one that is named: no options beside it, none of the home folder") {
  const TemporaryFolder folder, home;
  const std::string trace = folder / "trace";
  const auto script = [&](const std::string& path) {
    std::ofstream(path) << "SystemCall \"touch " << trace << "\";\n";
  };
  for (const std::string name : {".gmshrc", ".gmsh-options", ".gmsh-solver"})
    script(home / name);
  for (const char* variable : {"HOME", "GMSH_HOME", "GMSHPLUGINSHOME"})
    setenv(variable, (home / "").c_str(), 1);
  const std::string before = std::getenv("PATH");
  for (const auto& [name, text] : one_tet_files()) {
    INFO(name);
    const std::filesystem::path path = folder / name, stem = std::filesystem::path(path).replace_extension();
    std::ofstream(path) << text;
    for (const char* ending : {".opt", ".geo", ".geo.opt"}) {
      script(path.string() + ending);
      script(stem.string() + ending);
    }
    CHECK(read_mesh(path).tets.size() == 1);
    CHECK_FALSE(std::ifstream(trace).good());
  }
  const std::string step = folder / "box.step";
  write_step(box({1, 1, 1}, {0, 0, 0}), step);
  for (const char* other : {".opt", ".geo", ".geo.opt"})
    script(step + other);
  script(folder / "box.opt");
  CHECK(mass_properties(read_step(step)).volume == Approx(1));
  CHECK_FALSE(std::ifstream(trace).good());
  CHECK(std::getenv("PATH") == before);
}

TEST_CASE("what is said about a file names the file, not the copy that was read") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.mesh", "a.step"}) {
    std::ofstream(folder / name) << "nonsense\n";
    const std::string said = refusal([&] {
      if (name == "a.step")
        read_step(folder / name);
      else
        read_mesh(folder / name);
    });
    CHECK_THAT(said, Contains((folder / name)) && !Contains("cdem-XXXXXX") && !Contains("/file."));
  }
}
