// cdem view: saved files in a page that a browser of this machine shows.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/live/saved_view.hpp"
#include "apps/cdem/process/interrupt.hpp"

#include <cstdio>

namespace cdem::app {

ExitCode view(const std::filesystem::path& path) {
  if (!is_there(path))
    throw script::FileError(path.string() + ": no such file or folder");
  const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
  const std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  SavedView page(name, saved_files(path));
  std::printf("%s is shown at %s (Ctrl-C ends it)\n", path.c_str(), page.url().c_str());
  std::fflush(stdout);
  page.show([] { return interrupt::requested(); });
  return interrupt::requested() ? interrupt::exit_code() : ExitCode::success;
}

} // namespace cdem::app
