#include "libcdem/results/process_zone.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <cmath>
#include <map>

namespace cdem {
namespace {

struct Face {
  double size = 0, length = 0; // m
};

double median(std::vector<Face>& faces, double Face::*value) {
  const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
  std::nth_element(faces.begin(), middle, faces.end(),
                   [&](const Face& a, const Face& b) { return a.*value < b.*value; });
  return *middle.*value;
}

double plane_modulus(const Elastic& m) {
  return m.youngs_modulus / (1 - m.poissons_ratio * m.poissons_ratio);
}

std::string in_words(const Body& body, int law) {
  std::string name = "\"" + body.name + "\"";
  if (law < 0)
    return name;
  const auto [a, b] = body.region_laws.regions[law];
  return name + (a == b ? ", region " + std::to_string(a + 1)
                        : ", regions " + std::to_string(a + 1) + " and " + std::to_string(b + 1));
}

// By name, in the order they are met.
class Zones {
public:
  void add(const std::string& of, const Face& face) {
    const auto [at, fresh] = place_.emplace(of, names_.size());
    if (fresh) {
      names_.push_back(of);
      faces_.emplace_back();
    }
    faces_[at->second].push_back(face);
  }
  std::vector<ProcessZone> all() {
    std::vector<ProcessZone> zones;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      ProcessZone zone;
      zone.of = names_[i];
      zone.length = median(faces_[i], &Face::length);
      zone.face_size = median(faces_[i], &Face::size);
      zone.largest_face_size = cohesive_zone * zone.length / least_faces_in_zone;
      zones.push_back(std::move(zone));
    }
    return zones;
  }

private:
  std::map<std::string, std::size_t> place_;
  std::vector<std::string> names_;
  std::vector<std::vector<Face>> faces_;
};

void add_interfaces(const Model& model, Zones& zones) {
  for (const Interface& i : model.interfaces) {
    const Joint joint = joint_of(model, i);
    if (joint.softening == Softening::none || !i.may_break)
      continue;
    double area = 0;
    for (int p = i.point_begin; p < i.point_end; ++p)
      area += model.points[p].area;
    const Body &a = model.bodies[model.blocks[i.block_a].body],
               &b = model.bodies[model.blocks[i.block_b].body];
    const double modulus = 2 / (1 / plane_modulus(a.material) + 1 / plane_modulus(b.material));
    zones.add(
        &a == &b ? "\"" + a.name + "\"" : "\"" + a.name + "\" and \"" + b.name + "\"",
        {std::sqrt(area), process_zone_length(modulus, joint.fracture_energy_1, joint.tensile_strength)});
  }
}

bool softens(const Body& body) {
  const auto soft = [](const Joint& joint) { return joint.softening != Softening::none; };
  return body.bonding.is_cohesive() && (soft(body.joint) || std::any_of(body.region_laws.joints.begin(),
                                                                        body.region_laws.joints.end(), soft));
}

void add_mesh_faces(const Model& model, Zones& zones) {
  const MeshData& mesh = model.mesh;
  if (std::none_of(model.bodies.begin(), model.bodies.end(), softens))
    return;
  const std::vector<int> neighbours = mesh_neighbours(model);
  const auto& x = model.node_position;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const int other = neighbours[i] / 4, own = static_cast<int>(i / 4);
    if (neighbours[i] < 0 || other < own)
      continue;
    const Body& body = model.bodies[model.blocks[model.tet_block[mesh.first_tet + own]].body];
    const int a = mesh.region[own], b = mesh.region[other];
    if (!softens(body) || !body.bonding.bonds(a, b))
      continue;
    std::array<geom::Vec3, 3> corners;
    for (int k = 0; k < 3; ++k)
      corners[k] = x[model.tets[mesh.first_tet + own][geom::tet_faces[i % 4][k]]];
    const int law = body.region_laws.between(a, b);
    const Joint& joint = body.joint_of(law); // the mean strength, where it scatters
    if (joint.softening == Softening::none)
      continue;
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    zones.add(in_words(body, law), {std::sqrt(4 * area / std::sqrt(3.0)),
                                    process_zone_length(plane_modulus(body.material), joint.fracture_energy_1,
                                                        joint.tensile_strength)});
  }
}

} // namespace

double process_zone_length(double modulus, double fracture_energy, double tensile_strength) {
  return modulus * fracture_energy / (tensile_strength * tensile_strength);
}

std::vector<ProcessZone> process_zones(const Model& model) {
  Zones zones;
  add_interfaces(model, zones);
  add_mesh_faces(model, zones);
  return zones.all();
}

} // namespace cdem
