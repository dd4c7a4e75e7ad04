// Runs a program as a user would, in a folder of its own, and tells what came of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace testing {

// Removed with all it holds when the test ends.
class TempFolder {
public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

void write_file(const std::filesystem::path&, const std::string& text); // makes its folder
std::string read_file(const std::filesystem::path&);
std::vector<std::string> lines_of(const std::string&);

// At a terminal a key is pressed when the program is ready for it.
struct Key {
  std::string wait_for; // printed since the key before
  std::string press;
  double pause = 0; // s, before it is pressed
};

struct Start {
  std::filesystem::path folder; // current folder of the program
  std::string input;            // on its stdin, when that is no terminal
  std::vector<Key> keys;        // typed at the terminal
  int signal = 0;               // sent once `signal_after` has been printed
  std::string signal_after;
  bool terminal = false; // stdin, stdout and stderr are one terminal
  int columns = 80;
  std::vector<std::string> environment; // "NAME=value"
  double limit = 60;                    // s, then it is killed and `timed_out` set
};

struct Outcome {
  int exit_code = -1; // 128 + signal when one ended it
  bool timed_out = false;
  std::string out, err;    // of a terminal: all in `out`
  double seconds = 0;      // wall clock
  double after_signal = 0; // s, from the signal to the end
  double peak_memory = 0;  // bytes
};

Outcome run_program(const std::vector<std::string>& command, const Start&);

// The cdem that was built with this test.
Outcome run_cdem(const std::vector<std::string>& arguments, const Start&);

// Says so and is true where ranks cannot be started: there is no mpirun, or cdem was built without MPI.
bool no_mpirun();

} // namespace testing
