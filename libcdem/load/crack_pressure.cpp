#include "libcdem/load/crack_pressure.hpp"

#include "libcdem/bond/face_frame.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/selection.hpp"
#include "libcdem/parallel/exact_sum.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

using geom::Vec3;

double wet_part(const State& state, std::int64_t batch, int lane) {
  if (holds(state.faces[batch].stage[lane]))
    return 0;
  const auto& damage = state.cohesive[batch * lanes + lane].damage;
  return (damage[0] + damage[1] + damage[2]) / 3;
}

// A n, m2; at: the place of a node.
template <class At>
Vec3 mean_area(const FaceNodes& nodes, const At& at) {
  const auto of = [&](const geom::Triangle& side) {
    return Vec3((at(side[1]) - at(side[0])).cross(at(side[2]) - at(side[0])));
  };
  return 0.25 * (of(nodes.a) + of(nodes.b));
}

// visit(batch, lane, wet part)
template <class Visit>
void each_wet_face(const State& state, const MeshChunk& chunk, const CrackLoad& load, const Visit& visit) {
  for (int face = 0; face < chunk.faces; ++face) {
    const std::int64_t batch = chunk.face_batches.begin + face / lanes;
    const int lane = face % lanes;
    if (load.faces[batch * lanes + lane] == 0)
      continue;
    if (const double part = wet_part(state, batch, lane); part > 0)
      visit(batch, lane, part);
  }
}

struct CrackMeasures {
  ExactSums<2> sums;   // m3, volume; m2, wet area
  double thinnest = 0; // m2/kg, largest area of a wet face over the mass of a tet beside it
};

void measure(const Model& model, const State& state, const CrackLoad& load, Range chunks, CrackMeasures& to) {
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    const double density = model.bodies[model.blocks[chunk.block].body].material.density;
    each_wet_face(state, chunk, load, [&](std::int64_t batch, int lane, double part) {
      const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
      Vec3 opening = Vec3::Zero();
      for (int i = 0; i < 3; ++i)
        opening += (vec(state.displacement[nodes.b[i]]) - vec(state.displacement[nodes.a[i]])) / 3;
      const Vec3 area = mean_area(nodes, [&](int node) { return place_of(model, state, node); });
      to.sums.add(0, part * area.dot(opening));
      to.sums.add(1, part * area.norm());
      const FaceTets& tets = model.mesh.face_tets[batch * lanes + lane];
      for (const int tet : {tets.tet_a, tets.tet_b})
        to.thinnest = std::max(to.thinnest, area.norm() / (density * tet_volume(model, tet)));
    });
  }
}

double pressure_of(const CrackLoad& load, double time, double volume) {
  const CrackPressure& given = load.given;
  const double p = given.volume
                       ? std::max(0.0, given.bulk_modulus * (given.volume(time) - volume) / given.reservoir)
                       : given.pressure(time);
  if (!(p >= 0) || !std::isfinite(p))
    throw geom::InputError(given.volume ? "volume" : "pressure",
                           fmt::format("{:g} Pa at t = {:g} s", p, time), "a finite pressure >= 0",
                           "a fluid does not pull at the faces of a crack");
  return p;
}

} // namespace

void require_cracks(const Model& model, const Selection& on) {
  const MeshData& mesh = model.mesh;
  const std::vector<int> neighbours = mesh_neighbours(model);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const int tet = mesh.first_tet + static_cast<int>(i / 4), beyond = neighbours[i] / 4;
    const Bonding& bonding = model.bodies[model.blocks[model.tet_block[tet]].body].bonding;
    if (neighbours[i] < 0 || !bonding.is_cohesive() ||
        !bonding.bonds(mesh.region[i / 4], mesh.region[beyond]))
      continue;
    Vec3 centre = Vec3::Zero();
    for (const int corner : geom::tet_faces[i % 4])
      centre += model.node_position[model.tets[tet][corner]] / 3;
    if (selects_place(model, on, centre, model.tet_block[tet]))
      return;
  }
  throw geom::InputError(
      "on", on.text, "a place with inner faces of a cohesive body (bonds = \"cohesive\")",
      "water in the joints of blocks is model:water's, pressure on outer faces model:traction's");
}

double crack_volume(const Model& model, const State& state, const CrackLoad& load) {
  CrackMeasures measures;
  measure(model, state, load, {0, static_cast<std::int64_t>(model.mesh.chunks.size())}, measures);
  return measures.sums.value(0);
}

CrackLoad resolve(const Model& model, const State& state, const CrackPressure& given) {
  CrackLoad load;
  load.given = given;
  load.faces.assign(model.mesh.faces.size() * lanes, 0);
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive())
      return;
    Vec3 centre = Vec3::Zero();
    for (const int node : face_nodes(model.mesh, chunk, batch, lane).a)
      centre += model.node_position[node] / 3;
    load.faces[batch * lanes + lane] = selects_place(model, given.on, centre, chunk.block) ? 1 : 0;
  });
  load.pressure = pressure_of(load, state.time, given.volume ? crack_volume(model, state, load) : 0);
  return load;
}

void update_crack_pressures(const Model& model, const State& state, Range own, double time,
                            std::vector<CrackLoad>& loads) {
  for (CrackLoad& load : loads) {
    CrackMeasures measures;
    if (load.given.volume) {
      measure(model, state, load, own, measures);
      ranks().sum(measures.sums.data(), ExactSums<2>::size());
      ranks().largest(&measures.thinnest, 1);
      load.frequency2 =
          8 * load.given.bulk_modulus / load.given.reservoir * measures.sums.value(1) * measures.thinnest;
    }
    load.pressure = pressure_of(load, time, measures.sums.value(0));
  }
}

void add_crack_pressures(const Model& model, const State& state, const MeshChunk& chunk,
                         const std::vector<CrackLoad>& loads, const FaceMotion& motion, Node* force,
                         FaceSums& sums) {
  for (const CrackLoad& load : loads)
    each_wet_face(state, chunk, load, [&](std::int64_t batch, int lane, double part) {
      const FaceNodes at = places_of(model.mesh.faces[batch], lane);
      CrackPush to;
      to.nodes = face_nodes(model.mesh, chunk, batch, lane);
      to.push =
          load.pressure * part / 3 * mean_area(at, [&](int place) { return vec(motion.position[place]); });
      sums.applied2 += 6 * to.push.squaredNorm();
      for (int i = 0; i < 3; ++i) {
        add(force[at.a[i]], -to.push);
        add(force[at.b[i]], to.push);
        to.before += vec(motion.velocity[at.b[i]]) - vec(motion.velocity[at.a[i]]);
      }
      sums.pushes.push_back(to);
    });
}

double crack_work(const State& state, const std::vector<CrackPush>& pushes, double kick) {
  double work = 0;
  for (const CrackPush& of : pushes) {
    Vec3 after = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      after += vec(state.velocity[of.nodes.b[i]]) - vec(state.velocity[of.nodes.a[i]]);
    work += 0.5 * kick * of.push.dot(of.before + after);
  }
  return work;
}

double crack_time_step(const std::vector<CrackLoad>& loads, double stable) {
  double of_fluids = 0;
  for (const CrackLoad& load : loads)
    of_fluids += load.frequency2;
  return of_fluids > 0 ? 2 / std::sqrt(4 / (stable * stable) + of_fluids)
                       : std::numeric_limits<double>::infinity();
}

} // namespace cdem
