#include "libgeom/solid/gmsh_session.hpp"

#include "libgeom/core/check.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <sstream>

// Of gmsh_entries.sh. Programs that are linked with gmsh itself, as through the public libraries, have none.
extern "C" {
struct GmshEntry {
  const char* name;
  void** address;
};
extern const GmshEntry gmsh_entries[] __attribute__((weak)); // ends with one without a name
extern const char gmsh_library[] __attribute__((weak));
}

namespace geom {
namespace {

// Folder of the session in this process, which is a child that makes only one.
std::string& session_folder() {
  static std::string path;
  return path;
}

std::string next_file(const std::string& ending) {
  static int count = 0;
  return session_folder() + "/file" + std::to_string(++count) + ending;
}

} // namespace

void load_gmsh() {
  static const bool loaded = [] {
    const GmshEntry* entry = gmsh_entries;
    if (!entry)
      return true;
    void* const library = dlopen(gmsh_library, RTLD_LAZY | RTLD_LOCAL);
    if (!library)
      throw std::runtime_error(std::string("cannot load the geometry kernel: ") + dlerror());
    for (; entry->name; ++entry)
      *entry->address = dlsym(library, entry->name);
    return true;
  }();
  static_cast<void>(loaded);
}

void start_gmsh(const PrivateFolder& folder) {
  session_folder() = folder.path();
  // gmsh loads libraries from the one folder and takes the other for its home.
  for (const char* name : {"GMSHPLUGINSHOME", "GMSH_HOME"})
    unsetenv(name);
  for (const char* name : {"HOME", "TMPDIR"})
    setenv(name, folder.path().c_str(), 1);
  gmsh::initialize(0, nullptr, false); // false: no options of the user's home
  for (const auto& [name, value] :
       {std::pair<const char*, double>{"General.Terminal", 0},
        {"General.NumThreads", 1},
        {"Geometry.OCCParallel", 0},
        {"Geometry.OCCUnionUnify", 1},
        {"Geometry.OCCImportLabels", 0}}) // for labels, the files that a STEP file names would be read too
    gmsh::option::setNumber(name, value);
}

PrivateFolder::PrivateFolder() : path_((std::filesystem::temp_directory_path() / "cdem-XXXXXX").string()) {
  if (!mkdtemp(path_.data())) // mode 0700
    throw std::runtime_error("cannot make a temporary folder " + path_ + ": " + std::strerror(errno));
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

TemporaryFile::TemporaryFile(const std::string& ending) : path_(next_file(ending)) {}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

TemporaryFile::TemporaryFile(const std::string& ending, const std::string& to_be_read)
    : TemporaryFile(ending) {
  std::error_code failed;
  std::filesystem::copy_file(to_be_read, path_, failed);
  if (failed)
    throw std::runtime_error("cannot copy " + to_be_read + " to the temporary " + path_ + ": " +
                             failed.message());
}

void set_mesh_options() {
  // Delaunay (1), not HXT (10): HXT's mesh differs from run to run, even on one thread.
  for (const auto& [name, value] : {std::pair<const char*, double>{"Mesh.Algorithm", 6},
                                    {"Mesh.Algorithm3D", 1},
                                    {"Mesh.MaxNumThreads1D", 1},
                                    {"Mesh.MaxNumThreads2D", 1},
                                    {"Mesh.MaxNumThreads3D", 1},
                                    {"Mesh.Optimize", 1},
                                    {"Mesh.MeshSizeExtendFromBoundary", 0},
                                    {"Mesh.MeshSizeFromPoints", 0}})
    gmsh::option::setNumber(name, value);
}

void pack(std::string& out, const MassProperties& x) {
  pack(out, x.volume);
  pack(out, x.centroid);
  pack(out, x.inertia);
}

void unpack(Unpacker& in, MassProperties& x) {
  unpack(in, x.volume);
  unpack(in, x.centroid);
  unpack(in, x.inertia);
}

void pack(std::string& out, const TetMesh& x) {
  pack(out, x.nodes);
  pack(out, x.tets);
  pack(out, x.region);
}

void unpack(Unpacker& in, TetMesh& x) {
  unpack(in, x.nodes);
  unpack(in, x.tets);
  unpack(in, x.region);
  if (x.region.size() != x.tets.size())
    Unpacker::refuse();
}

void pack(std::string& out, const BlockMesh& x) {
  pack(out, x.nodes);
  pack(out, x.tets);
  pack(out, x.fans);
  pack(out, x.fan_tets);
}

void unpack(Unpacker& in, BlockMesh& x) {
  unpack(in, x.nodes);
  unpack(in, x.tets);
  unpack(in, x.fans);
  unpack(in, x.fan_tets);
}

void pack(std::string& out, const Solid& x) {
  pack(out, x.brep());
  pack(out, x.regions());
}

void unpack(Unpacker& in, Solid& x) {
  std::string brep;
  int regions = 0;
  unpack(in, brep);
  unpack(in, regions);
  x = Solid(std::move(brep), regions);
}

Pieces load(const Solid& solid) {
  const TemporaryFile file(".brep");
  std::ofstream(file.path()) << solid.brep();
  Pieces pieces;
  gmsh::model::occ::importShapes(file.path(), pieces, true, "brep");
  return pieces;
}

MetNodes::MetNodes() {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, ignored;
  gmsh::model::mesh::getNodes(tags, coordinates, ignored, -1, -1, false, false);
  for (std::size_t i = 0; i < tags.size(); ++i)
    place_.emplace(tags[i], Eigen::Map<const Vec3>(&coordinates[3 * i]));
}

int MetNodes::number(std::size_t tag, const std::string& what) {
  const auto [node, added] = number_.try_emplace(tag, static_cast<int>(points.size()));
  if (added) {
    const auto at = place_.find(tag);
    if (at == place_.end())
      throw InputError(what + ": an element names node " + std::to_string(tag) + ", which is not there");
    points.push_back(at->second);
  }
  return node->second;
}

// The model's volumes as a value.
Solid store(const std::string& what) {
  gmsh::model::occ::synchronize();
  Pieces volumes;
  gmsh::model::getEntities(volumes, 3);
  if (volumes.empty())
    throw InputError(what + ": nothing is left");
  const TemporaryFile file(".brep");
  gmsh::write(file.path());
  std::ostringstream text;
  text << std::ifstream(file.path()).rdbuf();
  return {text.str(), static_cast<int>(volumes.size())};
}

Pieces load_all(const std::vector<Solid>& solids, std::size_t from) {
  Pieces all;
  for (std::size_t i = from; i < solids.size(); ++i) {
    const Pieces pieces = load(solids[i]);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

void require_place(const std::string& field, const Vec3& x) {
  require_finite(field, x);
  if (!(x.cwiseAbs().maxCoeff() <= max_coordinate))
    throw InputError(field, text(x), "within 100 km of the origin");
}

void require_length(const std::string& field, double x) {
  if (!(x >= min_length && x <= max_coordinate))
    throw InputError(field, text(x), "from 0.1 mm to 100 km");
}

} // namespace geom
