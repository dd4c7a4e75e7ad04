#include "lua/binding/pile_object.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <nlohmann/json.hpp>

namespace cdem::script {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "cdem pile 1";

Json numbers(const geom::Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

geom::Vec3 vector_from(const Json& json) {
  const auto x = json.get<std::array<double, 3>>();
  return {x[0], x[1], x[2]};
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

std::string pile_text(const geom::Pile& pile) {
  Json json{{"format", format}, {"height", pile.height}};
  for (const char* const list : {"poses", "nodes", "tets", "regions"})
    json[list] = Json::array();
  for (const geom::Pose& pose : pile.poses)
    json["poses"].push_back(
        {{"centroid", numbers(pose.translation)},
         {"rotation",
          {numbers(pose.rotation.row(0)), numbers(pose.rotation.row(1)), numbers(pose.rotation.row(2))}}});
  for (const geom::Vec3& x : pile.unit.nodes)
    json["nodes"].push_back(numbers(x));
  for (const geom::Tet& tet : pile.unit.tets)
    json["tets"].push_back(tet);
  json["regions"] = pile.unit.region;
  if (!pile.unit.named.empty())
    json["faces"] = pile.unit.named;
  return json.dump() + "\n";
}

geom::Pile pile_from(const std::string& text, const std::string& source) {
  geom::Pile pile;
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != format)
      throw geom::InputError(source + ": format", json.at("format").dump(),
                             std::string("\"") + format + "\"");
    pile.height = json.at("height").get<double>();
    for (const Json& given : json.at("poses")) {
      geom::Pose pose;
      pose.translation = vector_from(given.at("centroid"));
      const Json& rows = given.at("rotation");
      for (std::size_t i = 0; i < 3; ++i)
        pose.rotation.row(static_cast<Eigen::Index>(i)) = vector_from(rows.at(i));
      pile.poses.push_back(pose);
    }
    for (const Json& node : json.at("nodes"))
      pile.unit.nodes.push_back(vector_from(node));
    pile.unit.tets = json.at("tets").get<std::vector<geom::Tet>>();
    pile.unit.region = json.at("regions").get<std::vector<int>>();
    if (json.contains("faces"))
      pile.unit.named = json.at("faces").get<geom::NamedFaces>();
  } catch (const Json::exception&) {
    throw geom::InputError(source + ": no pile; a file that pile:save{} wrote is needed");
  }
  if (pile.unit.region.size() != pile.unit.tets.size())
    throw geom::InputError(source + ": " + std::to_string(pile.unit.region.size()) + " regions for " +
                           std::to_string(pile.unit.tets.size()) + " tetrahedra; one for each is needed");
  if (pile.poses.empty())
    throw geom::InputError(source + ": the pile has no units");
  geom::validate(pile, source);
  if (!pile.unit.named.empty())
    require_outer_faces(pile.unit, source);
  return pile;
}

} // namespace cdem::script
