#include "lua/binding/text/nearest.hpp"

namespace cdem::script {

std::string joined(const std::vector<std::string>& names, const std::string& separator) {
  std::string out;
  for (const std::string& name : names)
    out += (out.empty() ? "" : separator) + name;
  return out;
}

std::string which_there_are(const std::string& wrong, const std::vector<std::string>& names,
                            const std::string& intro) {
  const std::string near = did_you_mean(wrong, names);
  return (near.empty() ? ". " : near + " ") + intro + ": " + joined(names);
}

} // namespace cdem::script
