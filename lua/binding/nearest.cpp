#include "lua/binding/nearest.hpp"

namespace cdem::script {

std::string joined(const std::vector<std::string>& names, const std::string& separator) {
  std::string out;
  for (const std::string& name : names)
    out += (out.empty() ? "" : separator) + name;
  return out;
}

} // namespace cdem::script
