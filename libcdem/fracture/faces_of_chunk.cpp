#include "libcdem/fracture/faces_of_chunk.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {

geom::Mat3 rate_of_strain(const Model& model, const State& state, int tet) {
  const geom::Mat3 f = geom::Mat3::Identity() + displacement_gradient(model, state.displacement, tet);
  const geom::Mat3 rate = displacement_gradient(model, state.velocity, tet) * f.inverse();
  return 0.5 * (rate + rate.transpose());
}

geom::Mat3 FacesOfChunk::stress(int face) const {
  return 0.5 * (matrix(mesh_stress(model, state, tets(face).tet_a)) +
                matrix(mesh_stress(model, state, tets(face).tet_b)));
}

FaceFrame FacesOfChunk::frame(int face, double behind) const {
  const auto since = [&](int node) { return geom::Vec3(behind * velocity_of(state, node)); };
  return face_frame(
      nodes(face), [&](int node) { return geom::Vec3(place_of(model, state, node) - since(node)); },
      [&](int node) { return geom::Vec3(vec(state.displacement[node]) - since(node)); });
}

double FacesOfChunk::strain_rate(int face) const {
  return 0.5 * (rate_of_strain(model, state, tets(face).tet_a).norm() +
                rate_of_strain(model, state, tets(face).tet_b).norm());
}

geom::Mat3 FacesOfChunk::rise(int face, double time) const {
  const auto rate = [&](int tet) {
    return matrix(elastic_stress(body.material, rate_of_strain(model, state, tet)));
  };
  return 0.5 * time * (rate(tets(face).tet_a) + rate(tets(face).tet_b));
}

} // namespace cdem
