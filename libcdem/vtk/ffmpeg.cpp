#include "libcdem/vtk/ffmpeg.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace cdem {
namespace {

// Signals of a pipe whose reader has ended are errors of write() here, not the end of the program.
class WithoutPipeSignal {
public:
  WithoutPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~WithoutPipeSignal() { std::signal(SIGPIPE, before_); }
  WithoutPipeSignal(const WithoutPipeSignal&) = delete;
  WithoutPipeSignal& operator=(const WithoutPipeSignal&) = delete;

private:
  void (*before_)(int);
};

bool write_all(int file, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR)
      return false;
    done += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  return true;
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t n = read(file, part.data(), part.size());
    if (n > 0)
      text.append(part.data(), static_cast<std::size_t>(n));
    else if (n == 0 || errno != EINTR)
      return text;
  }
}

std::string last_line(const std::string& text) {
  std::istringstream in(text);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty())
      last = line;
  return last;
}

} // namespace

bool has_ffmpeg() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (!folder.empty() && access((folder + "/ffmpeg").c_str(), X_OK) == 0)
      return true;
  return false;
}

std::string write_with_ffmpeg(const std::vector<std::string>& png_frames, int frames_per_second,
                              const std::string& path) {
  std::array<int, 2> in{}, errors{};
  if (pipe2(in.data(), O_CLOEXEC) != 0)
    return std::strerror(errno);
  if (pipe2(errors.data(), O_CLOEXEC) != 0) {
    close(in[0]);
    close(in[1]);
    return std::strerror(errno);
  }
  const std::string rate = std::to_string(frames_per_second);
  // H.264 halves the colours' resolution, so that sides must be even: white fills up. faststart: a browser shows it while
  // it loads. The file's name has an ending of its own while it is written, so the format is said.
  std::vector<std::string> words{
      "ffmpeg",      "-hide_banner", "-loglevel",  "error",
      "-nostdin",    "-y",           "-f",         "image2pipe",
      "-c:v",        "png",          "-framerate", rate,
      "-i",          "pipe:0",       "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
      "-c:v",        "libx264",      "-pix_fmt",   "yuv420p",
      "-crf",        "18",           "-threads",   "2",
      "-movflags",   "+faststart",   "-f",         "mp4",
      "file:" + path};
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, errors[1], STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "ffmpeg", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  close(in[0]);
  close(errors[1]);
  if (failed != 0) {
    close(in[1]);
    close(errors[0]);
    return std::strerror(failed);
  }
  std::string said;
  std::thread listener([&] { said = read_all(errors[0]); });
  {
    const WithoutPipeSignal without_signal;
    for (const std::string& frame : png_frames) {
      std::ifstream file(frame, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      if (!write_all(in[1], bytes))
        break; // it has ended, and says why
    }
    close(in[1]);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  listener.join();
  close(errors[0]);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return "";
  return said.empty() ? "it ended early" : last_line(said);
}

} // namespace cdem
