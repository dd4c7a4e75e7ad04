// What the wrappers of gmsh share: each operation in a child process, failures as our own errors, solids in and out.
// gmsh has one global state per process. This state stays "busy" after an error. gmsh throws std::string, and changes
// the locale and the number of threads. gmsh and OpenCASCADE can crash on damaged files and odd shapes. So neither ever
// runs in this process.
#pragma once

#include "libgeom/child/bytes.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "libgeom/mesh/block_mesh.hpp"
#include "libgeom/mesh/read_mesh.hpp"
#include "libgeom/mesh/tet_mesh.hpp"
#include "libgeom/solid/solid.hpp"

#include <stdexcept>
#include <unordered_map>

namespace geom {

using Pieces = std::vector<std::pair<int, int>>; // (dimension, tag) in gmsh's model

// Packs and unpacks the results that the child of a session returns.
void pack(std::string& out, const MassProperties&);
void unpack(Unpacker&, MassProperties&);
void pack(std::string& out, const TetMesh&); // without names of faces
void unpack(Unpacker&, TetMesh&);
void pack(std::string& out, const MeshFile&);
void unpack(Unpacker&, MeshFile&);
void pack(std::string& out, const BlockMesh&);
void unpack(Unpacker&, BlockMesh&);
void pack(std::string& out, const Solid&);
void unpack(Unpacker&, Solid&);

// A folder that only this user can enter, deleted with all it holds. Throws std::runtime_error when the system's
// temporary folder cannot be written.
class PrivateFolder {
public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

// Loads gmsh's library into this process, once: programs that make no solid start six times as fast without it.
void load_gmsh();

// Starts gmsh in a child, with `folder` as its home and for TemporaryFile. The parent deletes the folder, so that a
// crash leaves none.
void start_gmsh(const PrivateFolder& folder);

// Runs body in a child with gmsh started; every failure of gmsh arrives as an InputError that says what was being done.
template <class Body>
auto in_session(const std::string& what, const ChildLimits& limits, Body body) {
  const PrivateFolder folder;
  load_gmsh();
  const std::string bytes = run_in_child(what, limits, [&] {
    try {
      start_gmsh(folder);
      std::string out;
      pack(out, body());
      return out;
    } catch (const std::string& message) {
      throw InputError(what + ": the geometry kernel cannot do it: " + message);
    } catch (const std::logic_error& error) { // of the standard library: a length or an index that cannot be
      throw InputError(what + ": " + limits.blame + ": " + plain_reason(error));
    }
  });
  decltype(body()) result{};
  Unpacker in(bytes);
  unpack(in, result);
  in.end();
  return result;
}
template <class Body>
auto in_session(const std::string& what, Body body) {
  return in_session(what, ChildLimits(), body);
}

// Inside a session, before a mesh is made: options that make one repeat, and leave its size to the caller.
void set_mesh_options();

// Inside a session: a file in its private folder, deleted at the end. gmsh also reads FILE.opt beside each FILE it opens, a script that can
// run commands: what it opens must stand where no one else can put such a file.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& ending);                       // no file yet
  TemporaryFile(const std::string& ending, const std::string& to_be_read); // a copy
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

// Reads a copy of the user's file: body(path of the copy). The copy, not the file, may be checked and then read:
// no other process can change it in between. Failures of gmsh name the user's file.
template <class Body>
auto with_copy(const std::string& user_file, const std::string& ending, Body body) {
  const TemporaryFile copy(ending, user_file);
  try {
    return body(copy.path());
  } catch (std::string& message) {
    for (auto at = message.find(copy.path()); at != std::string::npos;
         at = message.find(copy.path(), at + user_file.size()))
      message.replace(at, copy.path().size(), user_file);
    throw;
  }
}

// Inside a session only. `what` begins the messages.
Pieces load(const Solid&);
Pieces load_all(const std::vector<Solid>&, std::size_t from);
// The nodes of the model's mesh, numbered in the order they are met.
class MetNodes {
public:
  MetNodes();
  int number(std::size_t tag, const std::string& what); // throws InputError when there is no such node
  std::vector<Vec3> points;

private:
  std::unordered_map<std::size_t, Vec3> place_; // by tag
  std::unordered_map<std::size_t, int> number_;
};
// The tets of the mesh of the model, each volume a region, and the nodes they use in the order they are met.
TetMesh tets_of_volumes(const std::string& what);
Solid store(const std::string& what); // the model's volumes; throws InputError when there are none

void require_place(const std::string& field, const Vec3&);    // finite, within max_coordinate
void require_length(const std::string& field, double length); // min_length .. max_coordinate

} // namespace geom
