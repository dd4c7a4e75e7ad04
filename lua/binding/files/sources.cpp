#include "lua/binding/files/sources.hpp"

#include "lua/binding/files/files.hpp"

#include <algorithm>
#include <regex>
#include <set>
#include <vector>

namespace cdem::script {

namespace fs = std::filesystem;

fs::path file_of_module(const std::string& name) {
  std::string file = name;
  std::replace(file.begin(), file.end(), '.', '/');
  return file + ".lua";
}

void each_source(const fs::path& script,
                 const std::function<void(const fs::path& name, const std::string& text)>& keep) {
  static const std::regex require(R"(\brequire\s*\(?\s*["']([A-Za-z0-9_.-]+)["'])");
  const fs::path folder = fs::weakly_canonical(fs::absolute(script)).parent_path();
  std::set<fs::path> seen{script.filename()};
  std::vector<std::pair<fs::path, fs::path>> waiting{{script.filename(), script}}; // name, file
  while (!waiting.empty()) {
    const auto [name, file] = waiting.back();
    waiting.pop_back();
    const std::string text = read_file(file);
    keep(name, text);
    for (auto it = std::sregex_iterator(text.begin(), text.end(), require); it != std::sregex_iterator();
         ++it) {
      const fs::path module = file_of_module((*it)[1].str());
      std::error_code error;
      if (!module.is_absolute() && fs::is_regular_file(folder / module, error) && seen.insert(module).second)
        waiting.emplace_back(module, folder / module);
    }
  }
}

fs::path kept_source(const fs::path& sources, const fs::path& name, const fs::path& file) {
  std::error_code error;
  return !sources.empty() && fs::is_regular_file(sources / name, error) ? sources / name : file;
}

} // namespace cdem::script
