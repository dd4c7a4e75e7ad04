// What the wrappers of gmsh share: one operation at a time, failures as our own errors, solids in and out.
// gmsh is one global thing per process that stays "busy" after an error: every operation therefore starts it,
// works and shuts it down, so that a failure leaves nothing behind. It throws std::string.
#pragma once

#include "libgeom/core/error.hpp"
#include "libgeom/solid/solid.hpp"

#include <mutex>
#include <streambuf>

namespace geom {

using Pieces = std::vector<std::pair<int, int>>; // (dimension, tag) in gmsh's model

// Holds gmsh for one operation; what it or OpenCASCADE says on std::cout is dropped, and what gmsh changes of
// the process, the number of OpenMP threads and the locale, is put back.
class GmshSession {
public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

private:
  std::lock_guard<std::mutex> lock_;
  std::streambuf* cout_;
  std::string locale_;
  int threads_;
};

// Runs body in a session; every failure of gmsh arrives as an InputError that says what was being done.
template <class Body>
auto in_session(const std::string& what, Body body) {
  try {
    const GmshSession session;
    return body();
  } catch (const std::string& message) {
    throw InputError(what + ": the geometry kernel cannot do it: " + message);
  } catch (const std::exception&) {
    throw;
  } catch (...) { // OpenCASCADE's failures are no std::exception
    throw InputError(what + ": the geometry kernel cannot do it");
  }
}

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

// A file with a fixed name in a private folder. gmsh also reads FILE.opt beside each FILE it opens, a script that can
// run commands: what it opens must stand where no one else can put such a file.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& ending);                       // no file yet
  TemporaryFile(const std::string& ending, const std::string& to_be_read); // a copy
  const std::string& path() const { return path_; }

private:
  PrivateFolder folder_;
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
Solid store(const std::string& what); // the model's volumes; throws InputError when there are none

void require_place(const std::string& field, const Vec3&);    // finite, within max_coordinate
void require_length(const std::string& field, double length); // min_length .. max_coordinate

} // namespace geom
