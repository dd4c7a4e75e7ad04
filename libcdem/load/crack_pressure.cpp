#include "libcdem/load/crack_pressure.hpp"

#include "libcdem/model/selection.hpp"
#include "libcdem/parallel/exact_sum.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

using geom::Vec3;

// The part of a face that is wet.
double wet_part(const State& state, std::int64_t batch, int lane) {
  if (holds(state.faces[batch].stage[lane]))
    return 0;
  const auto& damage = state.cohesive[batch * lanes + lane].damage;
  return (damage[0] + damage[1] + damage[2]) / 3;
}

// A n, the mean of both sides; at: the place of a node.
template <class At>
Vec3 mean_area(const std::array<int, 3>& a, const std::array<int, 3>& b, const At& at) {
  const auto of = [&](const std::array<int, 3>& side) {
    return Vec3((at(side[1]) - at(side[0])).cross(at(side[2]) - at(side[0])));
  };
  return 0.25 * (of(a) + of(b));
}

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

double pressure_of(const CrackLoad& load, double time, double volume) {
  const CrackPressure& given = load.given;
  const double p = given.volume
                       ? std::max(0.0, given.bulk_modulus * (given.volume(time) - volume) / given.reservoir)
                       : given.pressure(time);
  if (!(p >= 0) || !std::isfinite(p))
    throw geom::InputError(given.volume ? "volume" : "pressure",
                           fmt::format("{:g} Pa at t = {:g} s", p, time), "a finite number >= 0");
  return p;
}

} // namespace

namespace {

void add_crack_volume(const Model& model, const State& state, const CrackLoad& load, Range chunks,
                      ExactSums<1>& volume) {
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    each_wet_face(state, chunk, load, [&](std::int64_t batch, int lane, double part) {
      const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
      Vec3 open = Vec3::Zero();
      for (int i = 0; i < 3; ++i)
        open += (vec(state.displacement[nodes.b[i]]) - vec(state.displacement[nodes.a[i]])) / 3;
      volume.add(0, part * mean_area(nodes.a, nodes.b, [&](int node) {
                             return place_of(model, state, node);
                           }).dot(open));
    });
  }
}

Range all_chunks(const Model& model) {
  return {0, static_cast<std::int64_t>(model.mesh.chunks.size())};
}

} // namespace

double crack_volume(const Model& model, const State& state, const CrackLoad& load) {
  ExactSums<1> volume;
  add_crack_volume(model, state, load, all_chunks(model), volume);
  return volume.value(0);
}

CrackLoad resolve(const Model& model, const State& state, const CrackPressure& given) {
  CrackLoad load;
  load.given = given;
  load.faces.assign(model.mesh.faces.size() * lanes, 0);
  bool any = false;
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive())
      return;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, batch, lane);
    Vec3 centre = Vec3::Zero();
    for (const int node : nodes.a)
      centre += model.node_position[node] / 3;
    if (selects_place(model, given.on, centre, chunk.block)) {
      load.faces[batch * lanes + lane] = 1;
      any = true;
    }
  });
  // Faces are known once their nodes are freed: those of a whole body come later.
  if (!any && std::none_of(model.bodies.begin(), model.bodies.end(),
                           [](const Body& body) { return body.bonding.is_cohesive(); }))
    throw geom::InputError("on", given.on.text, "a place in a cohesive body",
                           "joints between blocks with springs take model:water");
  load.pressure = load.before = pressure_of(load, state.time, crack_volume(model, state, load));
  return load;
}

void update_crack_pressures(const Model& model, const State& state, const SharedState* shared, double time,
                            std::vector<CrackLoad>& loads) {
  for (CrackLoad& load : loads) {
    ExactSums<1> volume;
    if (load.given.volume) {
      add_crack_volume(model, state, load, shared ? shared->part().mesh_chunks() : all_chunks(model), volume);
      if (shared)
        ranks().sum(volume.data(), ExactSums<1>::size());
    }
    load.before = load.pressure;
    load.pressure = pressure_of(load, time, volume.value(0));
  }
}

double add_crack_pressures(const Model& model, const State& state, const MeshChunk& chunk,
                           const std::vector<CrackLoad>& loads, const Node* position, const Node* velocity,
                           double step, Node* force) {
  double work = 0;
  for (const CrackLoad& load : loads)
    each_wet_face(state, chunk, load, [&](std::int64_t batch, int lane, double part) {
      const FaceBatch& face = model.mesh.faces[batch];
      std::array<int, 3> a, b;
      for (int i = 0; i < 3; ++i) {
        a[i] = face.place_a[i][lane];
        b[i] = face.place_b[i][lane];
      }
      const Vec3 third = part / 3 * mean_area(a, b, [&](int place) { return vec(position[place]); });
      const Vec3 push = load.pressure * third;
      for (int i = 0; i < 3; ++i) {
        Node &on_a = force[a[i]], &on_b = force[b[i]];
        on_a.x -= push.x();
        on_a.y -= push.y();
        on_a.z -= push.z();
        on_b.x += push.x();
        on_b.y += push.y();
        on_b.z += push.z();
        work +=
            0.5 * step * (load.before + load.pressure) * third.dot(vec(velocity[b[i]]) - vec(velocity[a[i]]));
      }
    });
  return work;
}

} // namespace cdem
