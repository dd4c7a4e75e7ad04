// Errors that reach a user. Each carries what one clear line needs: field, value, allowed range, what to do.
// The script layer adds file and line; the command line maps the type to an exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace geom {

// Bad input: a value the user gave cannot be used.
class InputError : public std::runtime_error {
public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const std::string& field, const std::string& value, const std::string& allowed,
             const std::string& advice = {})
      : std::runtime_error(field + " = " + value + ": must be " + allowed +
                           (advice.empty() ? std::string() : "; " + advice)) {}
};

// "1 block", "3 blocks"; "2 bodies" where the plural is given.
template <class Count>
std::string counted(Count count, const std::string& one, const std::string& more) {
  return std::to_string(count) + " " + (count == 1 ? one : more);
}
template <class Count>
std::string counted(Count count, const std::string& one) {
  return counted(count, one, one + "s");
}

} // namespace geom
