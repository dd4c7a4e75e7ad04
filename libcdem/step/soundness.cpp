#include "libcdem/step/soundness.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/results/deformation.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/errors.hpp"

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numeric>

namespace cdem {
namespace {

std::string in_words(const StageStep& at) {
  return fmt::format("stage {} ({}), step {}", at.stage, at.kind, at.step);
}

std::string where(const Model& model, int node) {
  const geom::Vec3& x = model.node_position[node];
  const Block& block = model.blocks[block_of(model, node)];
  return fmt::format("block {} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g}) m", block.id,
                     model.bodies[block.body].name, x.x(), x.y(), x.z());
}

// What is looked at: all of a model, or a rank's share.
struct Part {
  Range nodes, star_tets, mesh_tets;
};

Part whole(const Model& model) {
  const auto nodes = static_cast<std::int64_t>(model.node_position.size()),
             tets = static_cast<std::int64_t>(model.tets.size()),
             first = static_cast<std::int64_t>(small_strain_tets(model));
  return {{0, nodes}, {0, first}, {first, tets}};
}

Part share(const Model& model, const Partition& of) {
  Part part{of.nodes(), {}, {}};
  const Range chunks = of.chunks(), meshes = of.mesh_chunks();
  if (const std::int64_t end = std::min(chunks.end, of.stars); chunks.begin < end)
    part.star_tets = {model.blocks[model.chunks[chunks.begin].blocks.begin].tet_begin,
                      model.blocks[model.chunks[end - 1].blocks.end - 1].tet_end};
  if (meshes.size() > 0)
    part.mesh_tets = {model.mesh.chunks[meshes.begin].tets.begin, model.mesh.chunks[meshes.end - 1].tets.end};
  return part;
}

// Looks at eight tets at once. The padding of a last batch counts too: where this is false, tets are looked at one by one.
bool is_finite(const StressBatch& stress) {
  double sums[lanes] = {};
  for (const auto& component : stress.component)
    for (int lane = 0; lane < lanes; ++lane)
      sums[lane] += component[lane];
  return std::isfinite(std::accumulate(std::begin(sums), std::end(sums), 0.0));
}

// The volume is so far above zero that rounding cannot hide a tet that is turned inside out. Other tets are looked at by
// their deformation, which takes longer.
bool stands_upright(const Model& model, const State& state, const geom::Tet& tet) {
  constexpr double far = 1e-6;
  const geom::Vec3 x0 = place_of(model, state, tet[0]), e1 = place_of(model, state, tet[1]) - x0,
                   e2 = place_of(model, state, tet[2]) - x0, e3 = place_of(model, state, tet[3]) - x0;
  const double six_volume = e1.dot(e2.cross(e3));
  return six_volume > 0 &&
         six_volume * six_volume > far * far * e1.squaredNorm() * e2.squaredNorm() * e3.squaredNorm();
}

void require_sound_part(const Model& model, const State& state, double run_away, const StageStep& at,
                        const Part& part) {
  const auto fail = [&](const std::string& what, int node, const std::string& advice) {
    throw SolutionError(fmt::format("{}: {} in {}; {}", in_words(at), what, where(model, node), advice));
  };
  for (std::size_t i = 0; i < model.rigid.size(); ++i) {
    const RigidState& rigid = state.rigid[i];
    if (!std::isfinite(vec(rigid.centroid).sum() + vec(rigid.velocity).sum() +
                       vec(rigid.angular_momentum).sum()))
      fail("force on a rigid body is not a number", model.blocks[model.rigid[i].block].node_begin,
           "look at loads and contacts there");
    if (!std::isfinite(rigid.rotation[0]))
      fail("a rigid body turns by a radian or more in a step", model.blocks[model.rigid[i].block].node_begin,
           "use a smaller time_step");
  }
  for (auto node = static_cast<int>(part.nodes.begin); node < part.nodes.end; ++node) {
    const Node& u = state.displacement[node];
    const Node& v = state.velocity[node];
    if (!std::isfinite(u.x + u.y + u.z) || !std::isfinite(v.x + v.y + v.z))
      fail("displacement, velocity or force is not a number", node, "look at loads and stiffnesses there");
    const double moved = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    const bool told = !state.escaped.empty() && state.escaped[node] != 0; // step/escape.hpp
    if (moved > run_away && !told)
      fail(fmt::format("run-away displacement of {:.3g} m (model {:.3g} m across)", moved, model.length),
           node,
           "is this part held by supports, does it fall off what it lies on, and can it carry its load?");
  }
  std::int64_t finite = -1; // batch of stresses
  for (std::int64_t tet = part.mesh_tets.begin; tet < part.mesh_tets.end; ++tet) {
    const int slot = model.mesh.tet_slot[tet - model.mesh.first_tet];
    if (slot / lanes != finite && is_finite(state.stress[slot / lanes]))
      finite = slot / lanes;
    if (slot / lanes == finite)
      continue;
    double sum = 0;
    for (const auto& component : state.stress[slot / lanes].component)
      sum += component[slot % lanes];
    if (!std::isfinite(sum))
      fail("stress is not a number", model.tets[tet][0], "look at loads and stiffnesses there");
  }
  for (const Range& tets : {part.star_tets, part.mesh_tets})
    for (auto tet = static_cast<int>(tets.begin); tet < tets.end; ++tet) {
      if (stands_upright(model, state, model.tets[tet]) || model.blocks[model.tet_block[tet]].rigid >= 0)
        continue;
      const geom::Mat3 f = geom::Mat3::Identity() + displacement_gradient(model, state.displacement, tet);
      if (f.determinant() <= 0)
        fail("an element is turned inside out", model.tets[tet][0],
             model.blocks[model.tet_block[tet]].meshed
                 ? "the load there crushes the mesh"
                 : "the load there is beyond what small strain can carry");
    }
}

} // namespace

void require_sound(const Model& model, const State& state, double run_away, const StageStep& at) {
  require_sound_part(model, state, run_away, at, whole(model));
  if (const char* field = field_with_nan(state))
    throw SolutionError(fmt::format("{}: {} of the state is not a number somewhere; look at loads and laws",
                                    in_words(at), field));
}

bool share_is_sound(const Model& model, const State& state, const Workspace& work, double run_away) {
  const std::string nobody_reads_it;
  try {
    require_sound_part(model, state, run_away, {0, nobody_reads_it, 0}, share(model, work.part()));
  } catch (const SolutionError&) {
    return false;
  }
  // Not field_with_nan: it would bring back the pages of others. What is no number anywhere is soon none at a node.
  const Range points = work.shared->shares().points();
  return std::none_of(model.interfaces.begin(), model.interfaces.end(), [&](const Interface& interface) {
    return departure(model, state, interface, points) > 1;
  });
}

void require_neighbours(const Model& model, const State& state, const StageStep& at) {
  for (const Interface& interface : model.interfaces)
    if (departure(model, state, interface) > 1) {
      const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
      throw SolutionError(fmt::format("{}: blocks {} and {} of small strain have left each other by more "
                                      "than their face's size ({}): such "
                                      "blocks meet nothing new; give body \"{}\" element = \"finite_volume\"",
                                      in_words(at), a.id, b.id, where(model, b.node_begin),
                                      model.bodies[b.body].name));
    }
}

void require_kept_energy(const Model& model, const State& state, const Escape& escape, const StageStep& at) {
  const double open = energy(model, state).balance_error();
  if (open > broken_balance)
    throw SolutionError(fmt::format(
        "{}: run-away displacement of {}, now at ({:.6g}, {:.6g}, {:.6g}) m and {:.3g} m/s, with the energy "
        "balance open by {:.3g} %: it gained its speed from no load; take a smaller safety or time_step",
        in_words(at), escape.name, escape.place.x(), escape.place.y(), escape.place.z(), escape.speed,
        100 * open));
}

std::string in_words(const Escape& escape, const State& state, const StageStep& at) {
  return fmt::format("stage {} ({}): {} has left the model at {:.6g} s, at ({:.6g}, {:.6g}, {:.6g}) m and "
                     "{:.3g} m/s; {}the rest goes on; look whether it falls off its ground",
                     at.stage, at.kind, escape.name, state.time, escape.place.x(), escape.place.y(),
                     escape.place.z(), escape.speed, escape.held ? "it is held there and " : "");
}

void require_followed(const Model& model, const Workspace& work, const StageStep& at) {
  for (std::size_t c = 0; c < work.face_sums.size(); ++c) {
    if (work.face_sums[c].astray < 0)
      continue;
    const MeshChunk& chunk = model.mesh.chunks[c];
    const int lane = static_cast<int>(work.face_sums[c].astray % lanes);
    const std::int64_t batch = chunk.face_batches.begin + work.face_sums[c].astray / lanes;
    const std::string& body = model.bodies[model.blocks[chunk.block].body].name;
    throw SolutionError(fmt::format(
        "{}: the sides of a broken face have slid past each other by more than its size, "
        "{:.3g} m, and still press, in {}; pieces that come loose need contacts = {{ {{\"{}\", \"{}\", "
        "cdem.coulomb{{...}}}} }} in cdem.model",
        in_words(at), std::sqrt(3 * model.mesh.faces[batch].area[lane]),
        where(model, face_nodes(model.mesh, chunk, batch, lane).a[0]), body, body));
  }
}

void refuse_depth(const Model& model, const State& state, int source_triangle, int target_triangle,
                  const StageStep& at) {
  const ContactTriangle &source = model.surface.triangles[source_triangle],
                        &target = model.surface.triangles[target_triangle];
  const geom::Vec3 x = place_of(model, state, source.nodes[0]);
  throw SolutionError(fmt::format("{}: {} has gone too deep into {} near ({:.6g}, "
                                  "{:.6g}, {:.6g}) m, more than a quarter of "
                                  "a tet's height; it is too fast for this contact: give the contact a "
                                  "larger normal_stiffness, the model a "
                                  "finer mesh, or let it fall less far",
                                  in_words(at), block_name(model, source.block),
                                  block_name(model, target.block), x.x(), x.y(), x.z()));
}

} // namespace cdem
