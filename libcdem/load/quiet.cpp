#include "libcdem/load/quiet.hpp"

#include "libcdem/material/wave_speeds.hpp"
#include "libgeom/core/error.hpp"

namespace cdem {
namespace {

const Elastic& material_at(const Model& model, const OuterFace& face) {
  return model.bodies[model.blocks[face.block].body].material;
}

} // namespace

geom::Mat3 wave_impedance(const Elastic& m, const geom::Vec3& normal) {
  const geom::Mat3 along = normal * normal.transpose();
  return m.density * (dilatational_speed(m) * along + shear_speed(m) * (geom::Mat3::Identity() - along));
}

std::vector<int> add_dashpots(const Model& model, const Selection& on, const char* call, Dashpots& dashpots) {
  std::vector<int> faces = selected_outer_faces(model, on);
  for (const int f : faces) {
    const OuterFace& face = model.outer_faces[f];
    const Block& block = model.blocks[face.block];
    if (block.rigid >= 0)
      throw geom::InputError("on", on.text, "faces of bodies that deform",
                             std::string(call) + ": body \"" + model.bodies[block.body].name +
                                 "\" is rigid, no wave passes through it");
    const geom::Mat3 impedance = wave_impedance(material_at(model, face), face.normal);
    each_face_node(model, face, [&](int node, double area) {
      dashpots.try_emplace(node, geom::Mat3::Zero()).first->second += area * impedance;
    });
  }
  return faces;
}

std::vector<std::pair<int, geom::Vec3>> entering_wave(const Model& model, const std::vector<int>& faces,
                                                      const Quiet& quiet) {
  std::vector<std::pair<int, geom::Vec3>> pattern;
  for (const int f : faces) {
    const OuterFace& face = model.outer_faces[f];
    const geom::Vec3 traction =
        2 * (wave_impedance(material_at(model, face), face.normal) * quiet.velocity + quiet.stress);
    each_face_node(model, face, [&](int node, double area) { pattern.emplace_back(node, area * traction); });
  }
  return pattern;
}

} // namespace cdem
