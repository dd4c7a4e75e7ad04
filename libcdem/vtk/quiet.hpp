// VTK prints what goes wrong itself, over several lines. Where we ask for its error codes and say it in one, it is held
// quiet for as long as this lives.
#pragma once

namespace cdem {

class Quiet {
public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  int before_;
};

} // namespace cdem
