#include "libgeom/solid/gmsh_session.hpp"

#include "libgeom/core/check.hpp"

#include <gmsh.h>

#include <cerrno>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include <omp.h>
#include <unistd.h>

namespace geom {
namespace {

std::mutex& one_at_a_time() {
  static std::mutex one;
  return one;
}

// Puts an environment variable back as it was.
class Variable {
public:
  explicit Variable(const char* name) : name_(name) {
    if (const char* value = std::getenv(name))
      value_ = value;
  }
  ~Variable() {
    if (value_)
      setenv(name_, value_->c_str(), 1);
    else
      unsetenv(name_);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

private:
  const char* name_;
  std::optional<std::string> value_;
};

} // namespace

GmshSession::GmshSession()
    : lock_(one_at_a_time()), cout_(std::cout.rdbuf(nullptr)), locale_(std::setlocale(LC_ALL, nullptr)),
      threads_(omp_get_max_threads()) {
  // gmsh loads libraries from the one folder and takes the other for its home.
  for (const char* name : {"GMSHPLUGINSHOME", "GMSH_HOME"})
    unsetenv(name);
  const Variable path("PATH"), python_path("PYTHONPATH"); // gmsh adds a folder to them, each time
  const Variable home("HOME");                            // FLTK keeps a file of its own there
  const PrivateFolder no_home;
  setenv("HOME", no_home.path().c_str(), 1);
  gmsh::initialize(0, nullptr, false); // false: no options of the user's home
  for (const auto& [name, value] :
       {std::pair<const char*, double>{"General.Terminal", 0},
        {"General.NumThreads", 1},
        {"Geometry.OCCParallel", 0},
        {"Geometry.OCCUnionUnify", 1},
        {"Geometry.OCCImportLabels", 0}}) // for labels, the files that a STEP file names would be read too
    gmsh::option::setNumber(name, value);
}

GmshSession::~GmshSession() {
  try {
    gmsh::finalize();
  } catch (...) { // nothing is left to be done about it
  }
  omp_set_num_threads(threads_);
  std::setlocale(LC_ALL, locale_.c_str());
  std::cout.rdbuf(cout_);
  std::cout.clear();
}

PrivateFolder::PrivateFolder() : path_((std::filesystem::temp_directory_path() / "cdem-XXXXXX").string()) {
  if (!mkdtemp(path_.data())) // mode 0700
    throw std::runtime_error("cannot make a temporary folder " + path_ + ": " + std::strerror(errno));
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

TemporaryFile::TemporaryFile(const std::string& ending) : path_(folder_.path() + "/file" + ending) {}

TemporaryFile::TemporaryFile(const std::string& ending, const std::string& to_be_read)
    : TemporaryFile(ending) {
  std::error_code failed;
  std::filesystem::copy_file(to_be_read, path_, failed);
  if (failed)
    throw std::runtime_error("cannot copy " + to_be_read + " to the temporary " + path_ + ": " +
                             failed.message());
}

Pieces load(const Solid& solid) {
  const TemporaryFile file(".brep");
  std::ofstream(file.path()) << solid.brep();
  Pieces pieces;
  gmsh::model::occ::importShapes(file.path(), pieces, true, "brep");
  return pieces;
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
