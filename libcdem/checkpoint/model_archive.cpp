#include "libcdem/checkpoint/model_archive.hpp"

#include "libcdem/model/known_of_model.hpp"
#include "libcdem/results/earlier_log.hpp"

#include <algorithm>

namespace cdem {

template <>
struct Flat<TetBatch> : std::bool_constant<sizeof(TetBatch) == (4 * 4 + 11 * 8) * lanes> {};
template <>
struct Flat<SpringEnd> : std::bool_constant<sizeof(SpringEnd) == 4> {};
template <>
struct Flat<MeshBatch> : std::bool_constant<sizeof(MeshBatch) == 4 * 2 * lanes> {};

CDEM_ARCHIVE(Elastic, youngs_modulus, poissons_ratio, density, viscosity, stiffness_damping)
CDEM_ARCHIVE(HoekBrown, sigma_ci, m_b, s, exponent)
CDEM_ARCHIVE(Plasticity, cohesion, friction_angle, dilation_angle, tensile_strength, residual_cohesion,
             residual_friction_angle, residual_tensile_strength, softening_strain, curve, residual_curve)
CDEM_ARCHIVE(PlasticLaws, laws, regions, others)
CDEM_ARCHIVE(StrengthScatter, modulus, reference_volume, seed)
CDEM_ARCHIVE(RateEffect, reference_rate, exponent, change_rate, exponent_above, fracture_energy)

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

CDEM_ARCHIVE(Joint, bonded, glued, cohesion, friction_angle, tensile_strength, softening, g1, g2,
             thickness_ratio, thickness, kn, ks, stiffness_damping, restitution, scatter, rate, law, curve)
CDEM_ARCHIVE(RegionLaws, joints, regions, by_regions)
CDEM_ARCHIVE(Bonding, kind, everywhere, between_regions, regions, stiffness_ratio, shear_ratio)
CDEM_ARCHIVE(Body, name, material, joint, bonding, element, zone_size, region_laws, set_joint, units,
             glued_joint, plasticity)
CDEM_ARCHIVE(geom::PolyhedronFace, loop, cut, glued)
CDEM_ARCHIVE(geom::Polyhedron, vertices, faces)
CDEM_ARCHIVE(geom::MassProperties, volume, centroid, inertia)
CDEM_ARCHIVE(geom::Box, min, max)
CDEM_ARCHIVE(Block, id, parent, generation, body, unit, meshed, zoned, rigid, shape, mass, size, first_size,
             node_begin, node_end, tet_begin, tet_end)
CDEM_ARCHIVE(Interface, id, block_a, face_a, block_b, face_b, normal, joint, thickness, kn, ks, origin,
             may_break, strength, point_begin, point_end, frame, triangle_begin, triangle_end)
CDEM_ARCHIVE(InterfaceFrame, nodes_a, nodes_b, along_a, along_b, along, size, area, renewed)
CDEM_ARCHIVE(BondPoint, node_a, node_b, weight_a, weight_b, normal, kn_area, ks_area, area, interface,
             one_to_one)
CDEM_ARCHIVE(BlockChunk, blocks, nodes, batches)
CDEM_ARCHIVE(RigidBody, block, mass, inertia, inverse_inertia, principal, axes)
CDEM_ARCHIVE(FaceBatch, kn, area, place_a, place_b)
CDEM_ARCHIVE(FaceStrengthBatch, tensile_strength, cohesion, tan_friction, joint)
CDEM_ARCHIVE(FaceSideBatch, tet, beyond_tet, face, place, beyond)
CDEM_ARCHIVE(MeshChunk, block, blocks, stars, nodes, inner_end, others, tets, batches, face_batches, faces,
             side_batches, partial, share_begin)
CDEM_ARCHIVE(BoundaryTriangle, nodes, tet, block, face)
CDEM_ARCHIVE(FaceTets, tet_a, tet_b)

template <class A>
void archive(A& a, MeshData& x) {
  auto& [first_node, first_tet, batches, faces, face_tets, strength, sides, chunks, tet_slot, others,
         original, region, freed, plastic_law, share_begin, shares, boundary, named] = x;
  static_cast<void>(named); // places for conditions, which come from the script
  archive_all(a, first_node, first_tet, batches, faces, face_tets, strength, sides, chunks, tet_slot, others,
              original, region, freed, plastic_law, share_begin, shares, boundary);
}

CDEM_ARCHIVE(ContactTriangle, nodes, block, tet, face, mate, left, area, height, compliance)
CDEM_ARCHIVE(ContactEdge, nodes, triangles, corner)
CDEM_ARCHIVE(BlockPairLaw, blocks, joint)
CDEM_ARCHIVE(ContactSurface, triangles, edges, block_begin, usual_height, original, joint, within, left_by,
             pairs)
CDEM_ARCHIVE(Model, bodies, joints, blocks, pair_joint, node_position, node_mass, gravitational_mass, tets,
             tet_block, batches, interfaces, frames, points, point_position, point_apart, bond_triangles,
             bond_begin, spring_ends, outer_faces, mesh, surface, rigid, chunks, point_chunks, box, built_box,
             length, tolerance, next_id)
CDEM_ARCHIVE(BreakRow, stage, step, time, mode, place, normal, area, normal_traction, shear_traction, block_a,
             block_b)
CDEM_ARCHIVE(HistoryRow, stage, step, time, residual, kinetic, external, broken_tension, broken_shear, probes)
CDEM_ARCHIVE(Probe, name, field, place, crack, body, on)
CDEM_ARCHIVE(Departure, unit, step, time, velocity, displacement, place, share)
CDEM_ARCHIVE(Watch, leaves, blocks, numbers, touched, start, gone, left, tet_start, tet_left)
CDEM_ARCHIVE(EscapeRow, stage, step, time, text)
CDEM_ARCHIVE(RunLog, breaks, history, probes, watches, escapes, unmet, broken_tension, broken_shear,
             told_tension, told_shear, deepest_contact, deepest_over_height, one_way, every)

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
  go_back(then, last_step, breaks, one_way);
  archive(a, then);
}

void read(Reader& a, RunLog& log) {
  archive(a, log);
}

} // namespace cdem
