// A file that cannot be read or written; the message names it and the reason.
#pragma once

#include <stdexcept>

namespace cdem {

class FileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace cdem
