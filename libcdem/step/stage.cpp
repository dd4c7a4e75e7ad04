#include "libcdem/step/stage.hpp"

#include "libcdem/contact/contact_bounds.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/contact/places.hpp"
#include "libcdem/contact/search.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/interface/spring_forces.hpp"
#include "libcdem/model/add_meshes.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/parallel/huge_pages.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/rigid/motion.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/row_sums.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr std::int64_t poll_every = 16;
// Steps between looks at which faces a flow meets: they turn by next to nothing in between.
constexpr std::int64_t flow_every = 100;
static_assert(watch_every % flow_every == 0, "a stage that goes on looks anew where it did when it was left");
// Steps between looks at which units have left their place.
constexpr std::int64_t look_every = 50;
static_assert(watch_every % look_every == 0, "as above");
constexpr double seconds_between_reports = 0.1;
// Chunks a thread must have before a further one is worth its two barriers a step: about half a millisecond of work.
constexpr std::int64_t chunks_per_thread = 32;
// The same where contacts are looked for, which is most of the work of a pile.
constexpr std::int64_t touching_chunks_per_thread = 6;

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

std::string where(const Model& model, int node) {
  const geom::Vec3& x = model.node_position[node];
  const Block& block = model.blocks[block_of(model, node)];
  return fmt::format("block {} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g}) m", block.id,
                     model.bodies[block.body].name, x.x(), x.y(), x.z());
}

} // namespace

namespace {

// What a step goes through from end to end.
void ask_for_huge_pages_of(const Model& model, const State& state, const Workspace& work) {
  ask_for_huge_pages(state.displacement);
  ask_for_huge_pages(state.velocity);
  ask_for_huge_pages(state.stress);
  ask_for_huge_pages(state.faces);
  ask_for_huge_pages(model.mesh.batches);
  ask_for_huge_pages(model.mesh.faces);
  ask_for_huge_pages(model.mesh.shares);
  ask_for_huge_pages(model.node_position);
  ask_for_huge_pages(model.node_mass);
  ask_for_huge_pages(work.partial);
}

} // namespace

int useful_threads(const Model& model, int threads) {
  const auto chunks = static_cast<std::int64_t>(model.chunks.size());
  const std::int64_t each = model.surface.empty() ? chunks_per_thread : touching_chunks_per_thread;
  return static_cast<int>(std::clamp<std::int64_t>(chunks / each, 1, threads));
}

double relative_residual(const NodeSums& sums) {
  const double reference = sums.applied2 > 0 ? sums.applied2 : sums.reaction2;
  if (reference > 0)
    return std::sqrt(sums.residual2 / reference);
  return sums.residual2 > 0 ? 1.0 : std::isnan(sums.residual2) ? sums.residual2 : 0.0;
}

void leave_from_here(const StageContext& context) {
  context.last_good = context.state;
  if (!context.moment)
    return;
  Moment moment;
  moment.breaks = context.log.breaks.size();
  moment.broken_tension_before = context.log.broken_tension;
  moment.broken_shear_before = context.log.broken_shear;
  if (context.beside)
    moment.beside = context.beside();
  *context.moment = std::move(moment);
  if (context.keeper)
    context.keeper->marked();
}

Stage::Stage(const StageContext& context, std::string kind, double run_away)
    : work(context.model, context.state, context.conditions), context_(context),
      threads_(useful_threads(context.model, context.threads)), kind_(std::move(kind)), run_away_(run_away),
      broken_tension_before_(context.log.broken_tension), broken_shear_before_(context.log.broken_shear),
      start_(std::chrono::steady_clock::now()), told_(start_) {
  context_.threads = threads_.threads();
  ask_for_huge_pages_of(context_.model, context_.state, work);
  start_spring_forces(context_.model, context_.state, work);
  if (const Moment* from = context_.from) {
    context_.last_good = context_.state;
    if (context_.moment)
      *context_.moment = *from;
    step = told_step_ = from->step;
    broken_tension_before_ = from->broken_tension_before;
    broken_shear_before_ = from->broken_shear_before;
    work.spring_force = from->spring_force;
    work.stretch = from->stretch;
    start_ -= std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(from->wall_time));
  } else {
    leave_from_here(context_);
  }
  if (!context_.model.surface.empty())
    row_sums_ = all_row_sums(context_.model);
}

void Stage::mark(std::vector<double> carried, const std::vector<Node>& previous_force) {
  Moment& moment = **context_.moment;
  if (moment.step == step)
    return;
  moment.step = step;
  moment.breaks = context_.log.breaks.size();
  moment.wall_time = wall_time();
  moment.carried = std::move(carried);
  moment.previous_force = previous_force;
  moment.spring_force = work.spring_force;
  moment.stretch = work.stretch;
  if (context_.beside)
    moment.beside = context_.beside();
  // Contacts are looked for anew here, as by a stage that goes on: which pairs sleep is not saved.
  if (!context_.model.surface.empty()) {
    const std::vector<double> pace = std::move(work.contact.pace); // how thick skins are changes no force
    work.contact = {};
    start_contact(context_.model, work.contact);
    work.contact.pace = pace;
    std::fill(work.contact_force.begin(), work.contact_force.end(), Node{});
  }
  if (context_.keeper)
    context_.keeper->marked();
}

Stage::~Stage() {
  catch_up();
}

void Stage::moved(double time_step) {
  work.strain_step = time_step;
  work.contact.step += time_step;
  work.contact.due = true;
}

double Stage::meet() {
  const Model& model = context_.model;
  const ContactSums sums = contact_forces(model, context_.state, work, context_.threads);
  context_.state.spent.friction += sums.friction;
  context_.log.deepest_contact = std::max(context_.log.deepest_contact, sums.depth);
  context_.log.deepest_over_height = std::max(context_.log.deepest_over_height, sums.depth_over_height);
  if (sums.deepest > 1)
    refuse_depth(sums.deepest_source, sums.deepest_target);
  return contact_time_step(model, context_.state, work, row_sums_);
}

void Stage::refuse_depth(int source_triangle, int target_triangle) const {
  const Model& model = context_.model;
  const State& state = context_.state;
  const ContactTriangle &source = model.surface.triangles[source_triangle],
                        &target = model.surface.triangles[target_triangle];
  const geom::Vec3 x = place_of(model, state, source.nodes[0]);
  throw SolutionError(fmt::format("stage {} ({}), step {}: {} has gone too deep into {} near ({:.6g}, "
                                  "{:.6g}, {:.6g}) m, more than a quarter of "
                                  "a tet's height; it is too fast for this contact: give the contact a "
                                  "larger normal_stiffness, the model a "
                                  "finer mesh, or let it fall less far",
                                  context_.number, kind_, step, block_name(model, source.block),
                                  block_name(model, target.block), x.x(), x.y(), x.z()));
}

double Stage::wall_time() const {
  return seconds(std::chrono::steady_clock::now() - start_);
}

void Stage::catch_up() {
  try {
    context_.state.spent.friction +=
        contact_forces(context_.model, context_.state, work, context_.threads).friction;
  } catch (const SolutionError&) { // the next step meets it again, and says so
  }
  const auto meshes = static_cast<std::int64_t>(context_.model.mesh.chunks.size());
  if (work.strain_step > 0)
    for_chunks(meshes, context_.threads, [&](std::int64_t c) {
      if (context_.model.blocks[context_.model.mesh.chunks[c].block].rigid < 0)
        mesh_forces(context_.model, context_.state, work, c, false);
    });
  // Broken faces slide to where the nodes are too; the next step finds nothing left to do.
  if (work.strain_step > 0)
    for (const FaceSums& sums : work.face_sums) {
      context_.state.spent.friction += sums.friction;
      context_.state.spent.breaking += sums.breaking;
      context_.state.spent.damping += sums.damping;
      if (sums.hands_over) // what is handed over now is looked for where things stand now
        work.contact.pieces_due = work.contact.due = true;
    }
  work.strain_step = 0;
}

void Stage::keep_state() {
  watch();
  // Pieces are told apart anew when a face is handed over, and here: a run that goes on from a checkpoint does so too.
  if (!context_.state.face_slip.empty())
    work.contact.pieces_due = true;
  catch_up();
  context_.last_good = context_.state;
}

NodeSums Stage::total() const {
  NodeSums sum;
  const auto add = [&](const NodeSums& s) {
    sum.residual2 += s.residual2;
    sum.applied2 += s.applied2;
    sum.reaction2 += s.reaction2;
    sum.stiffness += s.stiffness;
    sum.inertia += s.inertia;
    sum.kinetic += s.kinetic;
    sum.external += s.external;
    sum.damping += s.damping;
  };
  for (const NodeSums& s : work.node_sums)
    add(s);
  for (const NodeSums& s : work.rigid_sums)
    add(s);
  return sum;
}

void Stage::record_breaks() {
  EnergyLedger& spent = context_.state.spent;
  broken_in_step_ = 0;
  for (const SpringSums& sums : work.spring_sums) {
    spent.friction += sums.friction;
    spent.breaking += sums.breaking;
    for (const BreakEvent& event : sums.broken) {
      const BondPoint& point = context_.model.points[event.point];
      const Interface& interface = context_.model.interfaces[point.interface];
      BreakRow row;
      row.stage = context_.number;
      row.step = step;
      row.time = context_.state.time;
      row.mode = event.mode;
      row.place = context_.model.point_position[event.point];
      row.normal = point.normal;
      row.area = point.area;
      row.normal_traction = event.normal_traction;
      row.shear_traction = event.shear_traction;
      row.block_a = context_.model.blocks[interface.block_a].id;
      row.block_b = context_.model.blocks[interface.block_b].id;
      context_.log.breaks.push_back(row);
      ++(event.mode == BondMode::broken_tension ? context_.log.broken_tension : context_.log.broken_shear);
      ++broken_in_step_;
    }
  }
}

void Stage::record_face_breaks() {
  const Model& model = context_.model;
  for (std::size_t c = 0; c < work.face_sums.size(); ++c) {
    const FaceSums& sums = work.face_sums[c];
    const MeshChunk& chunk = model.mesh.chunks[c];
    context_.state.spent.friction += sums.friction;
    context_.state.spent.breaking += sums.breaking;
    context_.state.spent.damping += sums.damping;
    work.contact.pieces_due = work.contact.pieces_due || sums.hands_over;
    for (const FaceBreak& broken : sums.broken) {
      const FaceSpringPlace at{chunk.face_batches.begin + broken.spring / (3 * lanes),
                               static_cast<int>(broken.spring / lanes % 3),
                               static_cast<int>(broken.spring % lanes)};
      BreakRow row;
      row.stage = context_.number;
      row.step = step;
      row.time = context_.state.time;
      row.mode = broken.mode;
      row.place = face_point(model, chunk, at);
      row.normal = broken.normal;
      row.area = model.mesh.faces[at.batch].area[at.lane];
      row.normal_traction = broken.normal_traction;
      row.shear_traction = broken.shear_traction;
      row.block_a = row.block_b = model.blocks[chunk.block].id;
      std::copy(std::begin(broken.slip), std::end(broken.slip),
                slip_of(context_.state, at.batch, at.lane).value[at.point]);
      context_.log.breaks.push_back(row);
      ++(broken.mode == BondMode::broken_tension ? context_.log.broken_tension : context_.log.broken_shear);
      ++broken_in_step_;
    }
  }
}

void Stage::watch_astray() const {
  const Model& model = context_.model;
  for (std::size_t c = 0; c < work.face_sums.size(); ++c) {
    if (work.face_sums[c].astray < 0)
      continue;
    const MeshChunk& chunk = model.mesh.chunks[c];
    const int lane = static_cast<int>(work.face_sums[c].astray % lanes);
    const std::int64_t batch = chunk.face_batches.begin + work.face_sums[c].astray / lanes;
    const std::string& body = model.bodies[model.blocks[chunk.block].body].name;
    throw SolutionError(fmt::format(
        "stage {} ({}), step {}: the sides of a broken face have slid past each other by more than its size, "
        "{:.3g} m, and still press, in {}; pieces that come loose need contacts = {{ {{\"{}\", \"{}\", "
        "cdem.coulomb{{...}}}} }} in cdem.model",
        context_.number, kind_, step, std::sqrt(3 * model.mesh.faces[batch].area[lane]),
        where(model, face_nodes(model.mesh, chunk, batch, lane).a[0]), body, body));
  }
}

void Stage::record_history(const StepReport& report) {
  if (!context_.log.probes.empty())
    catch_up();
  HistoryRow row;
  row.stage = context_.number;
  row.step = context_.state.step;
  row.time = context_.state.time;
  row.residual = report.residual;
  row.kinetic = report.sums.kinetic;
  row.external = context_.state.spent.external;
  row.broken_tension = context_.log.broken_tension;
  row.broken_shear = context_.log.broken_shear;
  for (const Probe& probe : context_.log.probes)
    row.probes.push_back(value_at(context_.model, context_.state, probe.field, probe.place));
  context_.log.add(std::move(row));
}

void Stage::look_at_units() {
  if (context_.log.watches.empty())
    return;
  double velocity = std::numeric_limits<double>::quiet_NaN();
  for (const Flow& flow : context_.conditions.flows)
    velocity = std::fmax(velocity, flow.velocity(context_.state.time));
  for (Watch& watch : context_.log.watches)
    look(context_.model, context_.state, velocity, watch);
}

void Stage::after_step(const StepReport& report) {
  EnergyLedger& spent = context_.state.spent;
  record_breaks();
  record_face_breaks();
  spent.external += report.sums.external;
  spent.external_peak = std::max(spent.external_peak, std::abs(spent.external));
  spent.damping += report.sums.damping;
  ++step;
  ++context_.state.step;
  threads_.stepped();
  context_.threads = threads_.threads();
  // Sums over all forces and one over all velocities: a NaN anywhere shows here in the step it appears.
  if (!std::isfinite(report.sums.residual2) || !std::isfinite(report.sums.kinetic) ||
      !std::isfinite(report.sums.reaction2))
    watch();
  if (step % watch_every == 0)
    keep_state();
  if (!work.resolved.flows.empty() && step % flow_every == 0) {
    refresh_flows(context_.model, context_.state, work.resolved);
    update_external(work.resolved, context_.state.time);
  }
  if (context_.log.due(context_.state.step))
    record_history(report);
  if (follows_pieces)
    watch_astray();
  if (step % look_every == 0)
    look_at_units();
  // Not between the keeping of a state and its mark: the two would be of different moments.
  if (step % poll_every == 0 && !can_be_left()) {
    Keeper* const keeper = context_.keeper;
    if (context_.observer.stop_requested()) {
      if (keeper)
        keeper->write(true);
      throw Interrupted();
    }
    if (keeper && keeper->wanted())
      keeper->write(false);
    if (seconds(std::chrono::steady_clock::now() - told_) > seconds_between_reports)
      tell(report, false);
  }
  if (step == 1 || (context_.from && step == context_.from->step + 1))
    tell(report, false);
}

void Stage::finish(const StepReport& report) {
  keep_state();
  look_at_units();
  record_history(report);
  tell(report, true);
}

void Stage::tell(const StepReport& report, bool last) {
  const auto now = std::chrono::steady_clock::now();
  Progress progress = report.goals;
  progress.stage = context_.number;
  progress.kind = kind_;
  if (note)
    progress.note = note();
  progress.step = step;
  progress.residual = report.residual;
  progress.time = context_.state.time;
  progress.broken_tension = context_.log.broken_tension - context_.log.told_tension;
  progress.broken_shear = context_.log.broken_shear - context_.log.told_shear;
  const double since = seconds(now - told_);
  progress.steps_per_second = since > 0 ? static_cast<double>(step - told_step_) / since : 0;
  if (progress.time_goal > 0 && progress.time > 0)
    progress.seconds_left = seconds(now - start_) * (progress.time_goal / progress.time - 1);
  progress.last = last;
  if (last) {
    context_.log.told_tension = context_.log.broken_tension;
    context_.log.told_shear = context_.log.broken_shear;
  }
  context_.observer.progress(progress);
  told_ = now;
  told_step_ = step;
}

void Stage::watch() const {
  const Model& model = context_.model;
  const State& state = context_.state;
  const auto fail = [&](const std::string& what, int node, const std::string& advice) {
    throw SolutionError(fmt::format("stage {} ({}), step {}: {} in {}; {}", context_.number, kind_, step,
                                    what, where(model, node), advice));
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
  for (int node = 0; node < static_cast<int>(model.node_position.size()); ++node) {
    const Node& u = state.displacement[node];
    const Node& v = state.velocity[node];
    if (!std::isfinite(u.x + u.y + u.z) || !std::isfinite(v.x + v.y + v.z))
      fail("displacement, velocity or force is not a number", node, "look at loads and stiffnesses there");
    const double moved = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    if (moved > run_away_)
      fail(fmt::format("run-away displacement of {:.3g} m (model {:.3g} m across)", moved, model.length),
           node, "is this part held by supports, and can it carry its load?");
  }
  for (int node = 0; node < static_cast<int>(work.force.size()); ++node)
    if (!std::isfinite(work.force[node].x + work.force[node].y + work.force[node].z))
      fail("displacement, velocity or force is not a number", node, "look at loads and stiffnesses there");
  for (std::size_t i = 0; i < model.mesh.tet_slot.size(); ++i) {
    double sum = 0;
    for (const auto& component : state.stress[model.mesh.tet_slot[i] / lanes].component)
      sum += component[model.mesh.tet_slot[i] % lanes];
    if (!std::isfinite(sum))
      fail("stress is not a number", model.tets[static_cast<std::size_t>(model.mesh.first_tet) + i][0],
           "look at loads and stiffnesses there");
  }
  for (int tet = 0; tet < static_cast<int>(model.tets.size()); ++tet) {
    if (model.blocks[model.tet_block[tet]].rigid >= 0)
      continue;
    const geom::Mat3 f = geom::Mat3::Identity() + displacement_gradient(model, state.displacement, tet);
    if (f.determinant() <= 0)
      fail("an element is turned inside out", model.tets[tet][0],
           model.blocks[model.tet_block[tet]].meshed
               ? "the load there crushes the mesh"
               : "the load there is beyond what small strain can carry");
  }
}

} // namespace cdem
