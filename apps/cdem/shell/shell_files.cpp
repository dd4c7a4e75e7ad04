#include "apps/cdem/shell/shell_files.hpp"

#include "apps/cdem/shell/completion.hpp"
#include "apps/cdem/shell/manual_pages.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <fstream>

namespace cdem::app {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::error_code ignored; // the file tells
  std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out)
    throw script::FileError('"' + file.string() + "\" cannot be written");
}

} // namespace

void write_shell_files(const Declared& all, const std::filesystem::path& folder) {
  for (const auto& [file, text] : manual_pages(all))
    write(folder / "man/man1" / file, text);
  write(folder / "bash-completion/completions/cdem", bash_completion(all));
  write(folder / "zsh/site-functions/_cdem", zsh_completion(all));
}

} // namespace cdem::app
