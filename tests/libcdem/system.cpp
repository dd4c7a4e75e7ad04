#include "tests/libcdem/system.hpp"

#include "libcdem/first_model.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/build/build_model.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/stage_context.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

namespace testing {

cdem::Elastic rock() {
  cdem::Elastic m;
  m.youngs_modulus = 30e9;
  m.poissons_ratio = 0.25;
  m.density = 2500;
  return m;
}

cdem::Joint rock_joint() {
  cdem::Joint j;
  j.cohesion = 8e6;
  j.friction_angle = 30 * degree;
  j.tensile_strength = 5e6;
  return j;
}

cdem::BodySpec body(std::string name, geom::Assembly shape, const cdem::Elastic& material,
                    const cdem::Joint& joint) {
  return {std::move(name), std::move(shape), material, joint, {}, {}, cdem::Element::small_strain};
}

cdem::BodySpec meshed(std::string name, geom::TetMesh mesh, const cdem::Bonding& bonding,
                      const cdem::Elastic& material, const cdem::Joint& joint) {
  return {std::move(name), {}, material, joint, {std::move(mesh)}, bonding, cdem::Element::finite_volume};
}

cdem::Simulation simulation(geom::Assembly shape, const cdem::Elastic& material, const cdem::Joint& joint,
                            std::shared_ptr<cdem::Observer> observer) {
  cdem::ModelSpec spec;
  spec.bodies.push_back(body("body", std::move(shape), material, joint));
  return cdem::Simulation(spec, 1, std::move(observer));
}

cdem::Simulation bonded_column(const std::array<int, 3>& divisions, int threads,
                               std::shared_ptr<cdem::Observer> observer) {
  cdem::Bonding bonding;
  bonding.everywhere = true;
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = 3e5;
  joint.cohesion = 6e5;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("column", geom::box_mesh({0.3, 0.3, 0.8}, divisions, 0.15), bonding, rock(), joint)};
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(cdem::Selection::side("z-")));
  return s;
}

cdem::Simulation units_over_floor(geom::TetMesh floor, std::vector<geom::TetMesh> units,
                                  const cdem::Elastic& material, int threads,
                                  std::shared_ptr<cdem::Observer> observer) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", std::move(floor), {}, material), meshed("units", {}, {}, material)};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].meshes = std::move(units);
  cdem::Joint friction;
  friction.bonded = false;
  friction.friction_angle = 35 * degree;
  spec.pairs = {{"floor", "units", friction}, {"units", "units", friction}};
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity());
  return s;
}

cdem::Model build(const std::vector<cdem::BodySpec>& bodies, const std::vector<cdem::PairSpec>& pairs) {
  return cdem::first_model({bodies, pairs});
}

cdem::Selection at_place(const geom::Vec3& x) {
  return cdem::Selection::where([x](const geom::Vec3& y) { return (x - y).norm() < 1e-9 * (1 + x.norm()); },
                                "a place");
}

std::array<bool, 3> axes(const std::string& names) {
  return {names.find('x') != std::string::npos, names.find('y') != std::string::npos,
          names.find('z') != std::string::npos};
}

cdem::Fix fixed(const cdem::Selection& on, const std::string& names) {
  cdem::Fix fix;
  fix.on = on;
  fix.axes = axes(names);
  return fix;
}

cdem::Traction traction(const cdem::Selection& on, const geom::Vec3& stress) {
  cdem::Traction traction;
  traction.on = on;
  traction.stress = stress;
  return traction;
}

std::vector<cdem::Traction> on_six_sides(const geom::Mat3& stress) {
  std::vector<cdem::Traction> tractions;
  for (const char* side : {"x-", "x+", "y-", "y+", "z-", "z+"})
    tractions.push_back(
        traction(cdem::Selection::side(side), (side[1] == '+' ? 1 : -1) * stress.col(side[0] - 'x')));
  return tractions;
}

cdem::Gravity gravity(const geom::Vec3& acceleration) {
  cdem::Gravity gravity;
  gravity.acceleration = acceleration;
  return gravity;
}

System::System(cdem::Model m) : model(std::move(m)), state(cdem::initial_state(model)), last_good(state) {}

namespace {

// Into the file that ranks.sh names: it compares what one process and several end with.
void note(const char* kind, const cdem::State& state) {
  const char* const file = std::getenv("CDEM_NOTE_HASHES");
  if (file && cdem::ranks().leads())
    std::ofstream(file, std::ios::app) << Catch::getResultCapture().getCurrentTestName() << ": " << kind
                                       << ' ' << state.step << ' ' << cdem::hash(state) << '\n';
}

} // namespace

cdem::StageContext System::next_stage() {
  cdem::StageContext context{model, state, conditions, log, last_good, observer, threads, ++stage};
  context.changing = &model;
  return context;
}

cdem::RelaxResult System::relax(double residual, bool breaking) {
  cdem::RelaxOptions options;
  options.residual = residual;
  options.breaking = breaking;
  options.max_steps = 100000;
  const cdem::RelaxResult result = cdem::relax(next_stage(), options);
  note("relax", state);
  return result;
}

cdem::RunResult System::run(const cdem::RunOptions& options) {
  const cdem::RunResult result = cdem::run(next_stage(), options);
  note("run", state);
  return result;
}

void System::hold(const cdem::Selection& on, const std::string& names) {
  conditions.fixes.push_back(fixed(on, names));
}

geom::Vec3 centre(const cdem::Model& model, const cdem::OuterFace& face) {
  if (face.boundary < 0)
    return geom::face_centroid(model.blocks[face.block].shape, face.face);
  const geom::Triangle& t = model.mesh.boundary[face.boundary].nodes;
  return (model.node_position[t[0]] + model.node_position[t[1]] + model.node_position[t[2]]) / 3;
}

void System::load_all_faces(const geom::Mat3& stress) {
  for (const cdem::OuterFace& face : model.outer_faces)
    conditions.tractions.push_back(traction(at_place(centre(model, face)), stress * face.normal));
}

void System::adopt(cdem::Model&& m, cdem::State&& s) {
  model = std::move(m);
  state = std::move(s);
}

std::vector<geom::Vec3> System::net_forces() const {
  cdem::Workspace work(model, state, conditions);
  cdem::update_external(work.resolved, state.time);
  cdem::start_spring_forces(model, state, work.bond);
  std::vector<geom::Vec3> forces;
  for (const cdem::Node& f : cdem::net_forces(model, state, work, 1))
    forces.push_back(vec(f));
  return forces;
}

std::vector<geom::Vec3> System::advance_springs(std::vector<cdem::FaceBreak>& broken) {
  cdem::Workspace work(model, state, conditions);
  for (std::size_t c = 0; c < model.mesh.chunks.size(); ++c) {
    cdem::mesh_forces(model, state, work, static_cast<std::int64_t>(c), true);
    const std::int64_t first = model.mesh.chunks[c].face_batches.begin;
    for (const cdem::FaceBreak& row : work.face_sums[c].broken) {
      const std::int64_t lane = row.spring % cdem::lanes, batch = row.spring / cdem::lanes;
      cdem::FaceSlip slip = slip_of(state, first + batch / 3, static_cast<int>(lane));
      std::copy(std::begin(row.slip), std::end(row.slip), slip.value[batch % 3]);
      std::copy(std::begin(row.shear), std::end(row.shear), slip.shear[batch % 3]);
      slips_of(state, first + batch / 3).set(static_cast<int>(lane), slip);
      broken.push_back(row);
    }
  }
  return net_forces();
}

double System::out_of_balance() const {
  const cdem::ResolvedConditions r = cdem::resolve(model, state, conditions);
  double residual = 0, applied = 0, reaction = 0;
  const std::vector<geom::Vec3> forces = net_forces();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const auto held =
        std::find_if(r.held.begin(), r.held.end(), [&](const cdem::HeldNode& h) { return h.node == int(i); });
    const geom::Vec3 free = held == r.held.end() ? geom::Vec3(1, 1, 1) : vec(held->free);
    const geom::Vec3 load = r.external.empty() ? geom::Vec3(0, 0, 0) : vec(r.external[i]);
    residual += forces[i].cwiseProduct(free).squaredNorm();
    applied += load.cwiseProduct(free).squaredNorm();
    reaction += forces[i].cwiseProduct(geom::Vec3::Ones() - free).squaredNorm();
  }
  return std::sqrt(residual / (applied > 0 ? applied : reaction));
}

Momentum momentum(const System& s, Places places) {
  Momentum m;
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i) {
    const geom::Vec3 p = s.model.node_mass[i] * vec(s.state.velocity[i]);
    geom::Vec3 x = s.model.node_position[i];
    if (places == Places::present)
      x += vec(s.state.displacement[i]);
    m.linear += p;
    m.angular += x.cross(p);
  }
  return m;
}

geom::Mat3 hooke(const cdem::Elastic& m, const geom::Mat3& h) {
  const double E = m.youngs_modulus, nu = m.poissons_ratio;
  const geom::Mat3 strain = 0.5 * (h + h.transpose());
  return E / (1 + nu) * (strain + nu / (1 - 2 * nu) * strain.trace() * geom::Mat3::Identity());
}

geom::Mat3 tet_stress(const System& s, int tet) {
  const int block = s.model.tet_block[tet];
  if (s.model.blocks[block].meshed)
    return cdem::matrix(cdem::tet_stress(s.model, s.state, tet));
  return hooke(s.model.bodies[s.model.blocks[block].body].material,
               cdem::displacement_gradient(s.model, s.state.displacement, tet)) +
         cdem::matrix(s.state.initial_stress[tet]);
}

double stress_error(const System& s, const geom::Mat3& expected) {
  double error = 0;
  for (int tet = 0; tet < static_cast<int>(s.model.tets.size()); ++tet)
    error = std::max(error, (tet_stress(s, tet) - expected).norm());
  return error / expected.norm();
}

double traction_error(const System& s, const geom::Mat3& expected) {
  double error = 0;
  for (int p = 0; p < static_cast<int>(s.model.points.size()); ++p)
    error =
        std::max(error, (cdem::traction(s.model, s.state, p) - expected * s.model.points[p].normal).norm());
  return error / expected.norm();
}

geom::Mat3 symmetric(double xx, double yy, double zz, double xy, double yz, double xz) {
  geom::Mat3 m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

geom::Mat3 rotation(const geom::Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

} // namespace testing
