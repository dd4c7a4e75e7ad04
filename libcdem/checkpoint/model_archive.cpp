#include "libcdem/checkpoint/model_archive.hpp"

#include "libcdem/model/known_of_model.hpp"

#include <algorithm>

namespace cdem {

// Every binding names every member in order. A member that is new to a struct is added to its line here.
// NOLINTBEGIN(readability-identifier-length)
template <>
struct Flat<TetBatch> : std::bool_constant<sizeof(TetBatch) == (4 * 4 + 11 * 8) * lanes> {};
template <>
struct Flat<SpringEnd> : std::bool_constant<sizeof(SpringEnd) == 4> {};
template <>
struct Flat<MeshBatch> : std::bool_constant<sizeof(MeshBatch) == 4 * 2 * lanes> {};

template <class A>
void archive(A& a, Elastic& x) {
  auto& [youngs_modulus, poissons_ratio, density, viscosity, stiffness_damping] = x;
  archive_all(a, youngs_modulus, poissons_ratio, density, viscosity, stiffness_damping);
}

template <class A>
void archive(A& a, HoekBrown& x) {
  auto& [sigma_ci, m_b, s, exponent] = x;
  archive_all(a, sigma_ci, m_b, s, exponent);
}

template <class A>
void archive(A& a, Plasticity& x) {
  auto& [cohesion, friction_angle, dilation_angle, tensile_strength, residual_cohesion,
         residual_friction_angle, residual_tensile_strength, softening_strain, curve, residual_curve] = x;
  archive_all(a, cohesion, friction_angle, dilation_angle, tensile_strength, residual_cohesion,
              residual_friction_angle, residual_tensile_strength, softening_strain, curve, residual_curve);
}

template <class A>
void archive(A& a, PlasticLaws& x) {
  auto& [laws, regions, others] = x;
  archive_all(a, laws, regions, others);
}

template <class A>
void archive(A& a, StrengthScatter& x) {
  auto& [modulus, reference_volume, seed] = x;
  archive_all(a, modulus, reference_volume, seed);
}

template <class A>
void archive(A& a, RateEffect& x) {
  auto& [reference_rate, exponent, change_rate, exponent_above, fracture_energy] = x;
  archive_all(a, reference_rate, exponent, change_rate, exponent_above, fracture_energy);
}

// By the number of the law in the list, then its own members.
template <class A, std::size_t i = 0>
void archive_law(A& a, JointLaw& x, std::size_t which) {
  if constexpr (i < std::variant_size_v<JointLaw>) {
    if (i != which)
      return archive_law<A, i + 1>(a, x, which);
    if constexpr (A::reading)
      x.template emplace<i>();
    if constexpr (i > 0)
      std::get<i>(x).each_member([&](auto& member) { archive(a, member); });
  } else {
    Reader::refuse();
  }
}

template <class A>
void archive(A& a, JointLaw& x) {
  auto which = static_cast<std::uint8_t>(x.index());
  archive(a, which);
  archive_law(a, x, which);
}

template <class A>
void archive(A& a, Joint& x) {
  auto& [bonded, glued, cohesion, friction_angle, tensile_strength, softening, g1, g2, thickness_ratio,
         thickness, kn, ks, stiffness_damping, restitution, scatter, rate, law, curve] = x;
  archive_all(a, bonded, glued, cohesion, friction_angle, tensile_strength, softening, g1, g2,
              thickness_ratio, thickness, kn, ks, stiffness_damping, restitution, scatter, rate, law, curve);
}

template <class A>
void archive(A& a, RegionLaws& x) {
  auto& [joints, regions] = x;
  archive_all(a, joints, regions);
}

template <class A>
void archive(A& a, Bonding& x) {
  auto& [kind, everywhere, between_regions, regions, stiffness_ratio, shear_ratio] = x;
  archive_all(a, kind, everywhere, between_regions, regions, stiffness_ratio, shear_ratio);
}

template <class A>
void archive(A& a, Body& x) {
  auto& [name, material, joint, bonding, element, zone_size, region_laws, set_joint, glued_joint,
         plasticity] = x;
  archive_all(a, name, material, joint, bonding, element, zone_size, region_laws, set_joint, glued_joint,
              plasticity);
}

template <class A>
void archive(A& a, geom::PolyhedronFace& x) {
  auto& [loop, cut, glued] = x;
  archive_all(a, loop, cut, glued);
}

template <class A>
void archive(A& a, geom::Polyhedron& x) {
  auto& [vertices, faces] = x;
  archive_all(a, vertices, faces);
}

template <class A>
void archive(A& a, geom::MassProperties& x) {
  auto& [volume, centroid, inertia] = x;
  archive_all(a, volume, centroid, inertia);
}

template <class A>
void archive(A& a, geom::Box& x) {
  auto& [min, max] = x;
  archive_all(a, min, max);
}

template <class A>
void archive(A& a, Block& x) {
  auto& [id, parent, generation, body, meshed, zoned, rigid, shape, mass, size, first_size, node_begin,
         node_end, tet_begin, tet_end] = x;
  archive_all(a, id, parent, generation, body, meshed, zoned, rigid, shape, mass, size, first_size,
              node_begin, node_end, tet_begin, tet_end);
}

template <class A>
void archive(A& a, Interface& x) {
  auto& [id, block_a, face_a, block_b, face_b, normal, joint, thickness, kn, ks, origin, may_break, strength,
         point_begin, point_end, frame, triangle_begin, triangle_end] = x;
  archive_all(a, id, block_a, face_a, block_b, face_b, normal, joint, thickness, kn, ks, origin, may_break,
              strength, point_begin, point_end, frame, triangle_begin, triangle_end);
}

template <class A>
void archive(A& a, InterfaceFrame& x) {
  auto& [nodes_a, nodes_b, along_a, along_b, along, size, area, renewed] = x;
  archive_all(a, nodes_a, nodes_b, along_a, along_b, along, size, area, renewed);
}

template <class A>
void archive(A& a, BondPoint& x) {
  auto& [node_a, node_b, weight_a, weight_b, normal, kn_area, ks_area, area, interface, one_to_one] = x;
  archive_all(a, node_a, node_b, weight_a, weight_b, normal, kn_area, ks_area, area, interface, one_to_one);
}

template <class A>
void archive(A& a, OuterFace& x) {
  auto& [block, face, boundary, normal, area, node_area] = x;
  archive_all(a, block, face, boundary, normal, area, node_area);
}

template <class A>
void archive(A& a, BlockChunk& x) {
  auto& [blocks, nodes, batches] = x;
  archive_all(a, blocks, nodes, batches);
}

template <class A>
void archive(A& a, RigidBody& x) {
  auto& [block, mass, inertia, inverse_inertia, principal, axes] = x;
  archive_all(a, block, mass, inertia, inverse_inertia, principal, axes);
}

template <class A>
void archive(A& a, FaceBatch& x) {
  auto& [kn, area, place_a, place_b] = x;
  archive_all(a, kn, area, place_a, place_b);
}

template <class A>
void archive(A& a, FaceStrengthBatch& x) {
  auto& [tensile_strength, cohesion, tan_friction, joint] = x;
  archive_all(a, tensile_strength, cohesion, tan_friction, joint);
}

template <class A>
void archive(A& a, FaceSideBatch& x) {
  auto& [tet, face, place, beyond] = x;
  archive_all(a, tet, face, place, beyond);
}

template <class A>
void archive(A& a, MeshChunk& x) {
  auto& [block, blocks, stars, nodes, inner_end, others, tets, batches, face_batches, faces, side_batches,
         partial, share_begin] = x;
  archive_all(a, block, blocks, stars, nodes, inner_end, others, tets, batches, face_batches, faces,
              side_batches, partial, share_begin);
}

template <class A>
void archive(A& a, BoundaryTriangle& x) {
  auto& [nodes, tet, block, face] = x;
  archive_all(a, nodes, tet, block, face);
}

template <class A>
void archive(A& a, FaceTets& x) {
  auto& [tet_a, tet_b] = x;
  archive_all(a, tet_a, tet_b);
}

template <class A>
void archive(A& a, MeshData& x) {
  auto& [first_node, first_tet, batches, faces, face_tets, strength, sides, chunks, tet_slot, others,
         original, region, freed, plastic_law, share_begin, shares, boundary, named] = x;
  static_cast<void>(named); // places for conditions, which come from the script
  archive_all(a, first_node, first_tet, batches, faces, face_tets, strength, sides, chunks, tet_slot, others,
              original, region, freed, plastic_law, share_begin, shares, boundary);
}

template <class A>
void archive(A& a, ContactTriangle& x) {
  auto& [nodes, block, tet, face, mate, area, height, compliance] = x;
  archive_all(a, nodes, block, tet, face, mate, area, height, compliance);
}

template <class A>
void archive(A& a, ContactEdge& x) {
  auto& [nodes, triangles, corner] = x;
  archive_all(a, nodes, triangles, corner);
}

template <class A>
void archive(A& a, BlockPairLaw& x) {
  auto& [blocks, joint] = x;
  archive_all(a, blocks, joint);
}

template <class A>
void archive(A& a, ContactSurface& x) {
  auto& [triangles, edges, block_begin, usual_height, original, joint, left_by, pairs] = x;
  archive_all(a, triangles, edges, block_begin, usual_height, original, joint, left_by, pairs);
}

template <class A>
void archive(A& a, Model& x) {
  auto& [bodies, joints, blocks, pair_joint, node_position, node_mass, gravitational_mass, tets, tet_block,
         batches, interfaces, frames, points, point_position, point_apart, bond_triangles, bond_begin,
         spring_ends, outer_faces, mesh, surface, rigid, chunks, point_chunks, box, length, tolerance,
         next_id] = x;
  archive_all(a, bodies, joints, blocks, pair_joint, node_position, node_mass, gravitational_mass, tets,
              tet_block, batches, interfaces, frames, points, point_position, point_apart, bond_triangles,
              bond_begin, spring_ends, outer_faces, mesh, surface, rigid, chunks, point_chunks, box, length,
              tolerance, next_id);
}

template <class A>
void archive(A& a, BreakRow& x) {
  auto& [stage, step, time, mode, place, normal, area, normal_traction, shear_traction, block_a, block_b] = x;
  archive_all(a, stage, step, time, mode, place, normal, area, normal_traction, shear_traction, block_a,
              block_b);
}

template <class A>
void archive(A& a, HistoryRow& x) {
  auto& [stage, step, time, residual, kinetic, external, broken_tension, broken_shear, probes] = x;
  archive_all(a, stage, step, time, residual, kinetic, external, broken_tension, broken_shear, probes);
}

template <class A>
void archive(A& a, Probe& x) {
  auto& [name, field, place, crack, body, on] = x;
  archive_all(a, name, field, place, crack, body, on);
}

template <class A>
void archive(A& a, Departure& x) {
  auto& [unit, step, time, velocity, displacement, place, share] = x;
  archive_all(a, unit, step, time, velocity, displacement, place, share);
}

template <class A>
void archive(A& a, Watch& x) {
  auto& [leaves, blocks, touched, start, gone, left, tet_start, tet_left] = x;
  archive_all(a, leaves, blocks, touched, start, gone, left, tet_start, tet_left);
}

template <class A>
void archive(A& a, EscapeRow& x) {
  auto& [stage, step, time, text] = x;
  archive_all(a, stage, step, time, text);
}

template <class A>
void archive(A& a, RunLog& x) {
  auto& [breaks, history, probes, watches, escapes, unmet, broken_tension, broken_shear, told_tension,
         told_shear, deepest_contact, deepest_over_height, one_way, every] = x;
  archive_all(a, breaks, history, probes, watches, escapes, unmet, broken_tension, broken_shear, told_tension,
              told_shear, deepest_contact, deepest_over_height, one_way, every);
}
// NOLINTEND(readability-identifier-length)

void write(Writer& a, const Model& model) {
  archive_const(a, model);
}

void read(Reader& a, Model& model) {
  archive(a, model);
}

std::uint64_t hash(const Model& model) {
  Hasher a;
  archive_const(a, model);
  return a.value();
}

std::uint64_t fingerprint(const Model& model) {
  RawHasher a;
  archive_const(a, model);
  return a.value();
}

void write(Writer& a, const State& state) {
  for (const StateField& field : fields(const_cast<State&>(state))) {
    archive_const(a, std::string(field.row.name));
    archive_const(a, static_cast<std::uint64_t>(field.bytes));
    a.raw(field.data, field.bytes);
  }
}

void read(Reader& a, State& state) {
  const std::size_t count = fields(state).size();
  for (std::size_t i = 0; i < count; ++i) {
    const StateField field = fields(state)[i];
    std::string name;
    std::uint64_t bytes = 0;
    archive_all(a, name, bytes);
    if (name != field.row.name || bytes > a.left() || (bytes != field.bytes && !field.resize))
      Reader::refuse();
    if (field.resize && !field.resize(static_cast<std::size_t>(bytes)))
      Reader::refuse();
    a.raw(fields(state)[i].data, static_cast<std::size_t>(bytes));
  }
}

void write(Writer& a, const RunLog& log, std::int64_t last_step, std::size_t breaks,
           const OneWayEnergies& one_way) {
  RunLog then = log;
  then.one_way = one_way;
  then.breaks.resize(std::min(breaks, then.breaks.size()));
  then.broken_tension = then.broken_shear = 0;
  for (const BreakRow& row : then.breaks)
    ++(row.mode == BondMode::broken_tension ? then.broken_tension : then.broken_shear);
  const auto later = [&](const HistoryRow& row) { return row.step > last_step; };
  then.history.erase(std::remove_if(then.history.begin(), then.history.end(), later), then.history.end());
  const auto escaped_later = [&](const EscapeRow& row) { return row.step > last_step; };
  then.escapes.erase(std::remove_if(then.escapes.begin(), then.escapes.end(), escaped_later),
                     then.escapes.end());
  for (Watch& watch : then.watches)
    watch = watch_at(watch, last_step);
  archive(a, then);
}

void read(Reader& a, RunLog& log) {
  archive(a, log);
}

} // namespace cdem
