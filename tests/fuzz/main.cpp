// cdem_fuzz TARGET [options and folders of libFuzzer]; without a target it lists them.
#include "tests/fuzz/targets.hpp"

#include "libcdem/step/errors.hpp"
#include "libcdem/vtk/file_error.hpp"
#include "libgeom/core/error.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <unistd.h>

namespace fuzz {

namespace {

Target chosen;
std::string folder;

void remove_folder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

} // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> all = {
      {"stl", read_stl},     {"mesh", read_mesh}, {"step", read_step},     {"child_answer", child_answer},
      {"saved", saved_file}, {"state", state},    {"model", cut_model},    {"journal", journal},
      {"pile", pile},        {"csv", csv},        {"arguments", arguments}};
  return all;
}

std::string as_file(const std::string& name, const std::string& bytes) {
  const std::string path = folder + "/" + name;
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  return path;
}

} // namespace fuzz

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const auto found = *argc > 1 ? fuzz::targets().find((*argv)[1]) : fuzz::targets().end();
  if (found == fuzz::targets().end()) {
    std::fputs("usage: cdem_fuzz TARGET [libFuzzer's options and folders]; targets:\n", stderr);
    for (const auto& [name, target] : fuzz::targets())
      std::fprintf(stderr, "  %s\n", name.c_str());
    std::exit(2);
  }
  fuzz::chosen = found->second;
  for (int i = 1; i + 1 < *argc; ++i)
    (*argv)[i] = (*argv)[i + 1];
  --*argc;
  std::string name = (std::filesystem::temp_directory_path() / "cdem-fuzz-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    std::exit(2);
  fuzz::folder = name;
  std::atexit(fuzz::remove_folder);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    fuzz::chosen(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const geom::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos)
      std::abort(); // a message is one line
  } catch (const cdem::FileError&) {
  } catch (const cdem::SolutionError&) {
  } catch (const cdem::Interrupted&) {
  } catch (const std::bad_alloc&) {
  }
  return 0;
}
