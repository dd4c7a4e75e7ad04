// The examples of the reference page. Each file of lua/examples is a script of its own, which the tests run; a line
// "-- example: NAME ..." begins the example of one function, and what stands before the first is for all of them.
#include "lua/binding/module/embedded.hpp"
#include "lua/binding/module/topics.hpp"

#include <algorithm>
#include <map>
#include <sstream>

namespace cdem::script {

namespace {

constexpr const char* marker = "-- example: ";

struct Examples {
  std::map<std::string, std::string> preambles; // by topic
  std::map<std::string, std::string> by_name;
};

// No blank line at the beginning, one end of line at the end.
std::string without_blank_ends(const std::string& text) {
  const auto first = text.find_first_not_of('\n');
  if (first == std::string::npos)
    return "";
  return text.substr(first, text.find_last_not_of('\n') - first + 1) + "\n";
}

Examples read_examples() {
  Examples out;
  for (int i = 0; i < embedded_example_count; ++i) {
    std::string topic = embedded_examples[i].name;
    topic.resize(topic.rfind('.'));
    std::istringstream lines(embedded_examples[i].text);
    std::vector<std::string> names; // one example may serve several functions
    std::string text;
    const auto keep = [&] {
      if (names.empty())
        out.preambles[topic] = without_blank_ends(text);
      for (const std::string& name : names)
        out.by_name[name] = without_blank_ends(text);
      text.clear();
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind(marker, 0) != 0) {
        text += line + "\n";
        continue;
      }
      keep();
      names.clear();
      std::istringstream words(line.substr(std::string(marker).size()));
      for (std::string name; words >> name;)
        names.push_back(name);
    }
    keep();
  }
  return out;
}

const Examples& all() {
  static const Examples examples = read_examples();
  return examples;
}

std::string found(const std::map<std::string, std::string>& texts, const std::string& name) {
  const auto it = texts.find(name);
  return it == texts.end() ? "" : it->second;
}

} // namespace

std::string example_preamble(const std::string& topic) {
  return found(all().preambles, topic);
}

std::string example_of(const std::string& name) {
  return found(all().by_name, name);
}

std::vector<std::string> examples() {
  std::vector<std::string> out;
  for (const auto& [name, text] : all().by_name)
    out.push_back(name);
  return out;
}

} // namespace cdem::script
