// Files that are cut, flipped or forged: each gives a sound mesh or solid or one line with its name, and nothing of
// what gmsh and OpenCASCADE do on them reaches this process.
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/solid/read_stl.hpp"
#include "libgeom/solid/read_surface.hpp"
#include "libgeom/solid/solid.hpp"
#include "tests/libgeom/dxf_files.hpp"
#include "tests/libgeom/mesh_files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/vtk/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cctype>
#include <fstream>
#include <random>
#include <sstream>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

namespace {

// One change: cut off, a bit flipped, a number replaced by one that counts or names far too much, a line twice.
std::string spoiled(const std::string& text, std::mt19937_64& random) {
  std::string out = text;
  const std::size_t at = random() % text.size();
  switch (random() % 5) {
  case 0:
    return out.substr(0, at);
  case 1:
    out[at] = static_cast<char>(out[at] ^ (1 << (random() % 7)));
    return out;
  case 2:
  case 3: {
    static const char* const forged[] = {"-1",        "0",          "2147483647",           "4294967296",
                                         "999999999", "-999999999", "18446744073709551615", "nan",
                                         "1e308",     "5"};
    std::size_t begin = at;
    while (begin < out.size() && !std::isdigit(static_cast<unsigned char>(out[begin])))
      ++begin;
    std::size_t end = begin;
    while (end < out.size() && std::isdigit(static_cast<unsigned char>(out[end])))
      ++end;
    return out.replace(begin, end - begin, forged[random() % std::size(forged)]);
  }
  default: {
    const std::size_t begin = text.rfind('\n', at), end = text.find('\n', at);
    if (begin != std::string::npos && end != std::string::npos)
      out.insert(end, text.substr(begin, end - begin));
    return out;
  }
  }
}

template <class Read>
void spoil(const std::string& name, const std::string& text, int times, const Read& read) {
  const TemporaryFolder folder;
  const std::string path = folder / name;
  std::mt19937_64 random(7);
  for (int i = 0; i < times; ++i) {
    const std::string bytes = spoiled(text, random);
    std::ofstream(path, std::ios::binary) << bytes;
    INFO(name << " " << i << "\n" << bytes.substr(0, 2000));
    const std::string said = refusal([&] { read(path); });
    if (!said.empty()) {
      CHECK_THAT(said, Contains(name));
      CHECK(said.find('\n') == std::string::npos);
    }
  }
}

} // namespace

TEST_CASE("a damaged mesh file gives a sound mesh or one line with its name") {
  for (const auto& [name, text] : one_tet_files())
    spoil(name, text, 60, [](const std::string& path) {
      const TetMesh mesh = read_mesh(path);
      validate(mesh, path);
    });
}

TEST_CASE("a damaged STEP file gives a solid or one line with its name") {
  const TemporaryFolder folder;
  write_step(cut(box({2, 2, 2}, {0, 0, 0}), {cylinder({1, 1, -1}, {0, 0, 4}, 0.5)}), folder / "part.step");
  std::ostringstream text;
  text << std::ifstream(folder / "part.step").rdbuf();
  spoil("part.step", text.str(), 60, [](const std::string& path) { mass_properties(read_step(path)); });
}

TEST_CASE("a damaged STL file gives a surface or one line with its name") {
  std::ostringstream text;
  text << "solid a\n";
  for (const char* corners :
       {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "0 0 0 0 0 1 0 1 0", "1 0 0 0 1 0 0 0 1"}) {
    std::istringstream in(corners);
    text << "facet normal 0 0 0\nouter loop\n";
    for (int x = 0, y = 0, z = 0; in >> x >> y >> z;)
      text << "vertex " << x << ' ' << y << ' ' << z << '\n';
    text << "endloop\nendfacet\n";
  }
  text << "endsolid a\n";
  spoil("part.stl", text.str(), 300, [](const std::string& path) { read_stl(path); });
}

TEST_CASE("a damaged DXF file gives a surface or one line with its name") {
  for (const std::string& text : {dxf_faces(), dxf_polyface(), dxf_mesh()})
    spoil("part.dxf", text, 200,
          [](const std::string& path) { read_surface(path, 1, max_surface_triangles); });
}

TEST_CASE("counts that say far more than the file holds end in one line") {
  const TemporaryFolder folder;
  const auto refuses = [&](const std::string& name, std::string text, const std::string& from,
                           const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    std::ofstream(folder / name) << text.replace(at, from.size(), to);
    INFO(name << ": " << to);
    const std::string said = refusal([&] { read_mesh(folder / name); });
    CHECK_THAT(said, Contains(name));
    CHECK(said.find('\n') == std::string::npos);
  };
  const std::string inp = one_tet_files().back().second;
  for (const char* count : {"-1", "2147483647", "99999999999999"}) {
    const std::string n = count;
    refuses("a.msh", msh4, "$Nodes\n1 4 1 4", "$Nodes\n1 " + n + " 1 4");
    refuses("a.msh", msh4, "$Nodes\n1 4 1 4", "$Nodes\n" + n + " 4 1 4");
    refuses("a.msh", msh4, "3 1 0 4\n", "3 1 0 " + n + "\n");
    refuses("a.msh", msh4, "$Elements\n1 1 1 1", "$Elements\n" + n + " 1 1 1");
    refuses("a.msh", msh4, "3 1 4 1\n", "3 1 4 " + n + "\n");
    refuses("a.inp", inp, "7, 1, 2, 3, 4", "7, 1, 2, 3, " + n);
    refuses("a.inp", inp, "7, 7, 1", "7, " + n + ", 1");
  }
}
