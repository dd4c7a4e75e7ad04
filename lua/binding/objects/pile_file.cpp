#include "lua/binding/objects/pile_object.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "lua/binding/text/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cdem::script {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "cdem pile 1";

Json numbers(const geom::Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

std::string shown(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 30);
}

// What is wrong with the file, in one line.
[[noreturn]] void refuse(const std::string& source, const std::string& what) {
  throw geom::InputError(source + ": " + what +
                         "; a whole file that pile:save{} wrote is needed: write it anew");
}

// Where the text stops being JSON.
[[noreturn]] void refuse_at(const std::string& source, const std::string& text, std::size_t byte) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    refuse(source, "is empty");
  if (byte > text.find_last_not_of(" \t\r\n") + 1)
    refuse(source, "ends in the middle, after " + std::to_string(text.size()) + " bytes");
  // The word that holds the byte, or that ends before it.
  const std::string marks = ",:[]{} \t\r\n";
  const std::size_t last = text.find_last_not_of(marks, byte > 0 ? byte - 1 : 0);
  if (last == std::string::npos || text[0] != '{')
    refuse(source, "is no pile");
  const std::size_t begin = text.find_last_of(marks, last) + 1;
  const std::string word =
      text.substr(begin, std::min<std::size_t>(text.find_first_of(marks, begin) - begin, 30));
  if (Json::accept(word) || word.find('"') != std::string::npos)
    refuse(source, "cannot be read at byte " + std::to_string(byte));
  refuse(source, "\"" + word + "\" at byte " + std::to_string(begin + 1) + " is not a number");
}

// Reads the file's parts, each named as where it stands: "nodes[3]".
class PileReader {
public:
  explicit PileReader(const std::string& source) : source_(source) {}

  const Json& member(const Json& json, const char* key, const std::string& in = {}) const {
    const auto found = table(json, in.empty() ? "the whole" : in).find(key);
    if (found == json.end())
      refuse(source_, (in.empty() ? "" : in + ": ") + "\"" + key + "\" is missing");
    return *found;
  }
  const Json& table(const Json& json, const std::string& name) const {
    if (!json.is_object())
      refuse(source_, name + " is no table");
    return json;
  }
  const Json& list(const Json& json, const std::string& name, std::size_t length = 0) const {
    if (!json.is_array() || (length > 0 && json.size() != length))
      refuse(source_, name + " is not a list" + (length > 0 ? " of " + std::to_string(length) : ""));
    return json;
  }
  double number(const Json& json, const std::string& name) const {
    if (!json.is_number())
      refuse(source_, name + " = " + shown(json) + " is not a number");
    return json.get<double>();
  }
  int integer(const Json& json, const std::string& name) const {
    if (!json.is_number_integer())
      refuse(source_, name + " = " + shown(json) + " is not a whole number");
    return json.get<int>();
  }
  geom::Vec3 vector(const Json& json, const std::string& name) const {
    list(json, name, 3);
    return {number(json[0], name), number(json[1], name), number(json[2], name)};
  }
  void require(bool holds, const std::string& otherwise) const {
    if (!holds)
      refuse(source_, otherwise);
  }
  template <class Read>
  void each(const Json& json, const std::string& name, const Read& read) const {
    std::size_t index = 0;
    for (const Json& item : list(json, name))
      read(item, name + "[" + std::to_string(++index) + "]");
  }

private:
  const std::string& source_;
};

// Files of before tell of no numbers and pieces: their units are whole, and numbered in their order.
UnitNow read_unit(const PileReader& in, const Json& given, const std::string& name, std::size_t place) {
  UnitNow unit{static_cast<int>(place)};
  if (!given.contains("number"))
    return unit;
  unit.number = in.integer(given["number"], name + ".number");
  unit.pieces = in.integer(in.member(given, "pieces", name), name + ".pieces");
  unit.largest_piece = in.number(in.member(given, "largest_piece", name), name + ".largest_piece");
  in.require(unit.number >= 1 && unit.pieces >= 1 && unit.largest_piece > 0 && unit.largest_piece <= 1,
             name + ": number and pieces count from 1, and largest_piece is in (0, 1]");
  return unit;
}

void read_pile(const PileReader& in, const Json& json, geom::Pile& pile, std::vector<UnitNow>& units) {
  pile.height = in.number(in.member(json, "height"), "height");
  in.each(in.member(json, "poses"), "poses", [&](const Json& given, const std::string& name) {
    geom::Pose pose;
    pose.translation = in.vector(in.member(given, "centroid", name), name + ".centroid");
    const Json& rows = in.list(in.member(given, "rotation", name), name + ".rotation", 3);
    for (std::size_t i = 0; i < 3; ++i)
      pose.rotation.row(static_cast<Eigen::Index>(i)) = in.vector(rows[i], name + ".rotation");
    pile.poses.push_back(pose);
    units.push_back(read_unit(in, given, name, pile.poses.size()));
  });
  in.each(in.member(json, "nodes"), "nodes", [&](const Json& node, const std::string& name) {
    pile.unit.nodes.push_back(in.vector(node, name));
  });
  in.each(in.member(json, "tets"), "tets", [&](const Json& given, const std::string& name) {
    geom::Tet tet{};
    for (std::size_t i = 0; i < tet.size(); ++i)
      tet[i] = in.integer(in.list(given, name, tet.size())[i], name);
    pile.unit.tets.push_back(tet);
  });
  in.each(in.member(json, "regions"), "regions", [&](const Json& region, const std::string& name) {
    pile.unit.region.push_back(in.integer(region, name));
  });
  if (!json.contains("faces"))
    return;
  for (const auto& [name, given] : in.table(json["faces"], "faces").items()) {
    std::vector<int>& numbers = pile.unit.named[name];
    in.each(given, "faces." + name,
            [&](const Json& face, const std::string& place) { numbers.push_back(in.integer(face, place)); });
  }
}

void require_outer_faces(const geom::TetMesh& mesh, const std::string& source) {
  const int count = static_cast<int>(geom::outer_faces(mesh).size());
  for (const auto& [name, faces] : mesh.named)
    for (const int face : faces)
      if (face < 0 || face >= count)
        throw geom::InputError(source + ": faces \"" + name + "\"", std::to_string(face),
                               "the number of an outer face, below " + std::to_string(count));
}

} // namespace

PileObject::PileObject(geom::Pile given) : pile(std::move(given)) {
  for (std::size_t i = 0; i < pile.poses.size(); ++i)
    units.push_back({static_cast<int>(i) + 1});
}

std::string pile_text(const PileObject& given) {
  const geom::Pile& pile = given.pile;
  Json json{{"format", format}, {"height", pile.height}};
  for (const char* const list : {"poses", "nodes", "tets", "regions"})
    json[list] = Json::array();
  for (std::size_t i = 0; i < pile.poses.size(); ++i) {
    const geom::Pose& pose = pile.poses[i];
    const UnitNow& unit = given.units[i];
    json["poses"].push_back(
        {{"centroid", numbers(pose.translation)},
         {"rotation",
          {numbers(pose.rotation.row(0)), numbers(pose.rotation.row(1)), numbers(pose.rotation.row(2))}},
         {"number", unit.number},
         {"pieces", unit.pieces},
         {"largest_piece", unit.largest_piece}});
  }
  for (const geom::Vec3& x : pile.unit.nodes)
    json["nodes"].push_back(numbers(x));
  for (const geom::Tet& tet : pile.unit.tets)
    json["tets"].push_back(tet);
  json["regions"] = pile.unit.region;
  if (!pile.unit.named.empty())
    json["faces"] = pile.unit.named;
  return json.dump() + "\n";
}

std::shared_ptr<PileObject> pile_from(const std::string& text, const std::string& source) {
  Json json;
  try {
    json = Json::parse(shallow_json(text));
  } catch (const Json::parse_error& error) {
    refuse_at(source, text, error.byte);
  } catch (const TooDeepJson&) {
    refuse(source, "nests lists too deeply");
  } catch (const Json::exception&) { // a number beyond all doubles
    refuse(source, "holds a number that is too large");
  }
  const PileReader in(source);
  if (const Json& given = in.member(json, "format"); given != format)
    throw geom::InputError(source + ": format", shown(given), std::string("\"") + format + "\"");
  geom::Pile pile;
  std::vector<UnitNow> units;
  read_pile(in, json, pile, units);
  if (pile.unit.region.size() != pile.unit.tets.size())
    throw geom::InputError(source + ": " + std::to_string(pile.unit.region.size()) + " regions for " +
                           std::to_string(pile.unit.tets.size()) + " tetrahedra; one for each is needed");
  if (pile.poses.empty())
    throw geom::InputError(source + ": the pile has no units");
  geom::validate(pile, source);
  if (!pile.unit.named.empty())
    require_outer_faces(pile.unit, source);
  return std::make_shared<PileObject>(std::move(pile), std::move(units));
}

} // namespace cdem::script
