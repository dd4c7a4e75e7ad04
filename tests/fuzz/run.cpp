// One input of one target, and the folder that its files stand in.
#include "tests/fuzz/targets.hpp"

#include "libcdem/step/errors.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libgeom/core/error.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <unistd.h>

namespace fuzz {

namespace {

// Made at first use, removed when the program ends.
const std::string& folder() {
  static const struct Folder {
    std::string path = (std::filesystem::temp_directory_path() / "cdem-fuzz-XXXXXX").string();
    Folder() {
      if (mkdtemp(path.data()) == nullptr)
        throw std::runtime_error("no temporary folder");
    }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
  } made;
  return made.path;
}

} // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> all = {
      {"stl", read_stl},       {"dxf", read_dxf},     {"polygons", read_polygons},
      {"vtk", read_vtk},       {"water", read_water}, {"record", record},
      {"mesh", read_mesh},     {"step", read_step},   {"child_answer", child_answer},
      {"saved", saved_file},   {"state", state},      {"model", cut_model},
      {"journal", journal},    {"pile", pile},        {"csv", csv},
      {"arguments", arguments}};
  return all;
}

std::string as_file(const std::string& name, const std::string& bytes) {
  const std::string path = folder() + "/" + name;
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  return path;
}

void run(const Target& target, const std::string& bytes) {
  try {
    target(bytes);
  } catch (const geom::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos)
      std::abort(); // a message is one line
  } catch (const cdem::FileError&) {
  } catch (const cdem::SolutionError&) {
  } catch (const cdem::Interrupted&) {
  } catch (const std::bad_alloc&) {
  }
}

} // namespace fuzz
