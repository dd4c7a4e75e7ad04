// Abaqus input files: nodes, linear tetrahedra, element sets. Includes, parts that are instanced elsewhere and other volume
// elements are refused.
#include "libgeom/core/error.hpp"
#include "libgeom/core/text_table.hpp"
#include "libgeom/mesh/read_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <sstream>
#include <unordered_map>

namespace geom {
namespace {

std::vector<std::string> words_of(const std::string& line) { // between commas, upper case, without blanks
  std::vector<std::string> words(1);
  for (const char c : line)
    if (c == ',')
      words.emplace_back();
    else if (c != ' ' && c != '\t' && c != '\r' && c != '"')
      words.back() += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  while (words.size() > 1 && words.back().empty())
    words.pop_back();
  return words;
}

class InpReader {
public:
  InpReader(const std::string& text, const std::string& path) : in_(text), path_(path) {}

  TetMesh read(std::vector<CellLabels>& labels) {
    for (std::string line; std::getline(in_, line);) {
      ++line_;
      if (line.rfind("**", 0) == 0 || line.find_first_not_of(" \t\r") == std::string::npos)
        continue;
      if (line[0] == '*')
        begin(words_of(line));
      else if (keyword_ == "*NODE")
        add_node(words_of(line));
      else if (keyword_ == "*ELEMENT" && is_tet_)
        add_tet(words_of(line));
      else if (keyword_ == "*ELSET")
        add_to_set(words_of(line));
    }
    label(labels);
    return std::move(mesh_);
  }

private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError("file \"" + path_ + "\": line " + std::to_string(line_) + ": " + why);
  }

  std::int64_t whole(const std::string& word) const {
    const auto x = plain_number(word);
    if (!x || !(std::abs(*x) <= 1e15) || *x != std::floor(*x))
      refuse("\"" + word.substr(0, 30) + "\": must be a whole number");
    return static_cast<std::int64_t>(*x);
  }

  std::string option(const std::vector<std::string>& words, const std::string& name) const {
    for (const std::string& word : words)
      if (word.rfind(name + "=", 0) == 0)
        return word.substr(name.size() + 1);
    return "";
  }

  void begin(const std::vector<std::string>& words) {
    keyword_ = words[0];
    set_.clear();
    if (keyword_ == "*INCLUDE")
      refuse("*INCLUDE: must be one whole file; write it without includes");
    if (keyword_ == "*INSTANCE" && ++instances_ > 1)
      refuse("more than one *INSTANCE: parts placed several times are not read; write a flat input file");
    if (keyword_ == "*ELEMENT") {
      const std::string type = option(words, "TYPE");
      is_tet_ = type == "C3D4" || type == "C3D4H" || type == "DC3D4";
      if (!is_tet_ && (type.rfind("C3D", 0) == 0 || type.rfind("DC3D", 0) == 0))
        refuse("TYPE=" + type + ": must be C3D4; mesh it with linear tetrahedra");
      set_ = option(words, "ELSET");
    } else if (keyword_ == "*ELSET") {
      set_ = option(words, "ELSET");
      generates_ = std::find(words.begin(), words.end(), "GENERATE") != words.end();
    } else if (keyword_ == "*SOLIDSECTION") {
      sections_.push_back(option(words, "ELSET"));
    }
  }

  void add_node(const std::vector<std::string>& words) {
    if (words.size() < 4)
      refuse("a node has a number and three coordinates");
    Vec3 x;
    for (int i = 0; i < 3; ++i) {
      const auto value = plain_number(words[static_cast<std::size_t>(i) + 1]);
      if (!value)
        refuse("\"" + words[static_cast<std::size_t>(i) + 1].substr(0, 30) + "\": must be a number");
      x[i] = *value;
    }
    nodes_[whole(words[0])] = x;
  }

  void add_tet(const std::vector<std::string>& words) {
    if (words.size() != 5)
      refuse("a C3D4 has a number and four nodes");
    Tet tet{};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::int64_t node = whole(words[c + 1]);
      const auto at = nodes_.find(node);
      if (at == nodes_.end())
        refuse("node " + std::to_string(node) + " is not there");
      const auto [place, added] = node_of_.try_emplace(node, static_cast<int>(mesh_.nodes.size()));
      if (added)
        mesh_.nodes.push_back(at->second);
      tet[c] = place->second;
    }
    const std::int64_t number = whole(words[0]);
    if (!tet_of_.try_emplace(number, mesh_.tets.size()).second)
      refuse("element " + std::to_string(number) + " stands there twice");
    mesh_.tets.push_back(tet);
    if (!set_.empty())
      add(number);
  }

  void add_to_set(const std::vector<std::string>& words) {
    if (generates_) {
      const std::int64_t from = whole(words[0]), to = words.size() > 1 ? whole(words[1]) : from,
                         by = words.size() > 2 ? whole(words[2]) : 1;
      if (by < 1 || to < from || (to - from) / by > static_cast<std::int64_t>(max_tets))
        refuse("a generated set goes from a number up to another by 1 or more");
      for (std::int64_t n = from; n <= to; n += by)
        add(n);
      return;
    }
    for (const std::string& word : words) {
      if (plain_number(word)) {
        add(whole(word));
      } else if (const auto other = sets_.find(word); other != sets_.end() && word != set_) {
        const std::vector<std::int64_t> members = other->second;
        for (const std::int64_t n : members)
          add(n);
      } else if (word != set_) {
        refuse("\"" + word.substr(0, 30) + "\": no element set of this name stands above");
      }
    }
  }

  void add(std::int64_t element) {
    std::vector<std::int64_t>& members = sets_[set_];
    if (members.empty())
      order_.push_back(set_);
    members.push_back(element);
  }

  // The sets as labels: a tet has the number of the first set that holds it; 0 in none.
  CellLabels labels_of(const std::string& name, const std::vector<std::string>& sets) const {
    CellLabels labels{name, std::vector<std::int64_t>(mesh_.tets.size(), 0), {{0, "in no set"}}};
    std::int64_t number = 0;
    for (const std::string& set : sets) {
      labels.names[++number] = set;
      const auto members = sets_.find(set);
      for (const std::int64_t element :
           members == sets_.end() ? std::vector<std::int64_t>() : members->second)
        if (const auto tet = tet_of_.find(element); tet != tet_of_.end() && labels.values[tet->second] == 0)
          labels.values[tet->second] = number;
    }
    return labels;
  }

  void label(std::vector<CellLabels>& labels) const {
    if (!sections_.empty())
      labels.push_back(labels_of("sections", sections_));
    if (!order_.empty())
      labels.push_back(labels_of("sets", order_));
  }

  std::istringstream in_;
  const std::string& path_;
  int line_ = 0, instances_ = 0;
  std::string keyword_, set_;
  bool is_tet_ = false, generates_ = false;
  std::unordered_map<std::int64_t, Vec3> nodes_;
  std::unordered_map<std::int64_t, int> node_of_;
  std::unordered_map<std::int64_t, std::size_t> tet_of_;
  std::map<std::string, std::vector<std::int64_t>> sets_;
  std::vector<std::string> order_, sections_; // names of sets as they come
  TetMesh mesh_;
};

} // namespace

TetMesh read_inp(const std::string& text, const std::string& path, std::vector<CellLabels>& labels) {
  TetMesh mesh = InpReader(text, path).read(labels);
  if (mesh.tets.empty())
    throw InputError("file \"" + path + "\": has no C3D4 elements; mesh it with linear tetrahedra");
  return mesh;
}

} // namespace geom
