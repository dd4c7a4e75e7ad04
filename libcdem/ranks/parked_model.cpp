#include "libcdem/ranks/parked_model.hpp"

#include "libcdem/parallel/pages.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <linux/magic.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <fcntl.h>

namespace cdem {
namespace {

constexpr std::size_t least_array = std::size_t{1} << 20, least_model = std::size_t{16} << 20; // bytes
const char* const name = "cdem-model-";

// The bytes of an array, and those that stay this rank's own. `at`: of its first page in the file.
struct Array {
  const char* data = nullptr;
  std::size_t bytes = 0, at = 0;
  Range own;
};

// What a step goes through from end to end stays with its owner, on large pages.
std::vector<Array> arrays_of(const Model& model, const StateShares& shares) {
  std::vector<Array> arrays;
  const auto add = [&](const auto& array, Range own = {}) {
    const std::size_t entry = sizeof array[0], bytes = array.size() * entry;
    if (bytes < least_array)
      return;
    const std::size_t at =
        arrays.empty() ? 0 : arrays.back().at + (arrays.back().bytes / page_size() + 2) * page_size();
    const auto size = static_cast<std::int64_t>(entry);
    arrays.push_back(
        {reinterpret_cast<const char*>(array.data()), bytes, at, {own.begin * size, own.end * size}});
  };
  const Range nodes = shares.nodes(), points = shares.points(), batches = shares.own(shares.batch_begin()),
              faces = shares.own(shares.face_begin());
  add(model.node_position, nodes);
  add(model.node_mass, nodes);
  add(model.gravitational_mass);
  add(model.tets);
  add(model.tet_block);
  add(model.points, points);
  add(model.point_position);
  add(model.bond_triangles);
  add(model.bond_begin, nodes);
  add(model.spring_ends);
  const MeshData& mesh = model.mesh;
  add(mesh.batches, batches);
  add(mesh.faces, faces);
  add(mesh.face_tets);
  add(mesh.strength, faces);
  add(mesh.sides);
  add(mesh.tet_slot);
  add(mesh.others);
  add(mesh.original);
  add(mesh.region);
  add(mesh.freed);
  add(mesh.plastic_law);
  add(mesh.share_begin);
  add(mesh.shares);
  add(mesh.boundary);
  add(model.surface.triangles);
  add(model.surface.edges);
  add(model.surface.original);
  return arrays;
}

// The whole pages of an array on both sides of the rank's own part.
std::array<Pages, 2> pages_of_others(const Array& array) {
  return {Pages(array.data, 0, array.own.begin),
          Pages(array.data, array.own.end, static_cast<std::int64_t>(array.bytes))};
}

bool all_parked(const std::vector<Array>& arrays) {
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> mapped;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(name) != std::string::npos) {
      std::istringstream words(line);
      std::uintptr_t begin = 0, end = 0;
      char dash = 0;
      words >> std::hex >> begin >> dash >> end;
      mapped.emplace_back(begin, end);
    }
  const auto is_mapped = [&](const Pages& pages) {
    return pages.size() == 0 || std::any_of(mapped.begin(), mapped.end(), [&](const auto& range) {
             return range.first <= pages.begin && pages.begin < range.second;
           });
  };
  return std::all_of(arrays.begin(), arrays.end(), [&](const Array& array) {
    const auto [before, after] = pages_of_others(array);
    return is_mapped(before.size() > 0 ? before : after);
  });
}

bool is_on_disk(const std::filesystem::path& folder) {
  struct statfs system {};
  return statfs(folder.c_str(), &system) == 0 && system.f_type != TMPFS_MAGIC && system.f_type != RAMFS_MAGIC;
}

class File {
public:
  explicit File(int number) : number_(number) {}
  ~File() {
    if (number_ >= 0)
      close(number_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number() const { return number_; }

private:
  int number_;
};

// With a page to spare, as the arrays of another rank may begin elsewhere in theirs.
std::size_t size_of_file(const std::vector<Array>& arrays) {
  return arrays.back().at + arrays.back().bytes + 2 * page_size();
}

bool write_at(int file, const Array& array) {
  const std::size_t place = array.at + in_page(array.data);
  for (std::size_t done = 0; done < array.bytes;) {
    const ssize_t wrote =
        pwrite(file, array.data + done, array.bytes - done, static_cast<off_t>(place + done));
    if (wrote <= 0)
      return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

// The path of a file with the arrays; "": it could not be written.
std::string written(const std::vector<Array>& arrays) {
  std::error_code none;
  for (const std::filesystem::path& folder :
       {std::filesystem::temp_directory_path(none), std::filesystem::path("/var/tmp")}) {
    if (folder.empty() || !is_on_disk(folder))
      continue;
    std::string path = (folder / (std::string(name) + "XXXXXX")).string();
    const File file(mkostemp(path.data(), O_CLOEXEC));
    if (file.number() < 0)
      continue;
    if (ftruncate(file.number(), static_cast<off_t>(size_of_file(arrays))) == 0 &&
        std::all_of(arrays.begin(), arrays.end(), [&](const Array& a) { return write_at(file.number(), a); }))
      return path;
    unlink(path.c_str());
  }
  return "";
}

// Maps these pages of an array where the file holds the same.
void take_pages(const Array& array, const Pages& pages, int file, const char* content) {
  if (pages.size() == 0)
    return;
  const std::size_t at = array.at + (pages.data() - array.data) + in_page(array.data); // in the file
  if (std::memcmp(pages.data(), content + at, pages.size()) == 0)
    (void)mmap(pages.data(), pages.size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED, file,
               static_cast<off_t>(at));
}

void take(const std::vector<Array>& arrays, const std::string& path) {
  const File file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0)
    return;
  const std::size_t size = size_of_file(arrays);
  void* const mapped = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
  if (mapped == MAP_FAILED)
    return;
  for (const Array& array : arrays)
    for (const Pages& pages : pages_of_others(array))
      take_pages(array, pages, file.number(), static_cast<const char*>(mapped));
  munmap(mapped, size);
}

// Two processes with the same name of this see the same files and the same memory.
std::string machine() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  return host.data() + (" " + boot);
}

} // namespace

void park(const Model& model, const StateShares& shares) {
  const std::vector<Array> arrays = arrays_of(model, shares);
  std::size_t bytes = 0;
  for (const Array& array : arrays)
    bytes += array.bytes;
  double needed = bytes >= least_model && !all_parked(arrays) ? 1 : 0;
  ranks().largest(&needed, 1);
  if (needed == 0)
    return;
  const std::vector<std::string> machines = ranks().gather(machine());
  const auto leader = static_cast<int>(std::find(machines.begin(), machines.end(), machines[ranks().rank()]) -
                                       machines.begin());
  const bool leads = leader == ranks().rank();
  const std::string own = leads ? written(arrays) : "";
  const std::string path = ranks().gather(own)[leader];
  if (!path.empty())
    take(arrays, path);
  (void)ranks().gather(""); // all have opened it
  if (leads && !own.empty())
    unlink(own.c_str());
}

} // namespace cdem
