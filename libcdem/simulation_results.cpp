// What a Simulation tells of itself.
#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/model/unit_order.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/ranks/looks.hpp"
#include "libcdem/results/drawn_surface.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/results/fragments.hpp"
#include "libcdem/results/free_surface.hpp"
#include "libcdem/results/make_snapshot.hpp"
#include "libcdem/results/units.hpp"
#include "libcdem/simulation_impl.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/support_forces.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

const Model& Simulation::model() const {
  return impl_->model;
}
const State& Simulation::state() const {
  return impl_->whole();
}
const Conditions& Simulation::conditions() const {
  return impl_->conditions;
}
const RunLog& Simulation::log() const {
  return impl_->log;
}

const SlidingFriction& Simulation::sliding() const {
  return impl_->sliding;
}

std::vector<Fragment> Simulation::fragments() const {
  return cdem::fragments(impl_->model, impl_->whole(),
                         resolve(impl_->model, impl_->whole(), impl_->conditions));
}

ContactSummary Simulation::contacts() const {
  return {static_cast<std::int64_t>(impl_->whole().contacts.size()), impl_->log.deepest_contact,
          impl_->log.deepest_over_height};
}

std::vector<Slivers> Simulation::slivers() const {
  static KnownOfModel<std::vector<Slivers>> known;
  return *known.of(impl_->model, [&] { return find_slivers(impl_->model); });
}

std::vector<std::array<std::string, 2>> Simulation::unmet() const {
  std::vector<std::array<std::string, 2>> names;
  for (const auto& [a, b] : impl_->log.unmet)
    names.push_back({impl_->model.bodies[a].name, impl_->model.bodies[b].name});
  return names;
}

ModelCounts Simulation::counts() const {
  const Model& m = impl_->model;
  ModelCounts c;
  c.bodies = static_cast<std::int64_t>(m.bodies.size());
  c.blocks = static_cast<std::int64_t>(m.blocks.size());
  c.nodes = static_cast<std::int64_t>(m.node_position.size());
  c.tets = static_cast<std::int64_t>(m.tets.size());
  c.interfaces = static_cast<std::int64_t>(m.interfaces.size());
  c.bonds = static_cast<std::int64_t>(m.points.size());
  std::int64_t* const by_mode[] = {&c.intact, &c.broken_tension, &c.broken_shear, &c.contacts};
  for (const std::uint8_t mode : impl_->whole().bond_mode)
    ++*by_mode[mode];
  each_face_spring(m.mesh, [&](const MeshChunk&, const FaceSpringPlace& at) {
    ++c.bonds;
    const std::uint8_t mode = impl_->whole().faces[at.batch].mode[at.point][at.lane];
    ++*by_mode[mode];
    if (!impl_->whole().cohesive.empty())
      c.damaged += mode == 0 && impl_->whole().cohesive[at.batch * lanes + at.lane].damage[at.point] > 0;
  });
  for (std::size_t p = 0; p < impl_->whole().bond_damage.size(); ++p)
    c.damaged += impl_->whole().bond_damage[p] > 0 && impl_->whole().bond_mode[p] == 0;
  return c;
}

double Simulation::time() const {
  return impl_->kept.time;
}
double Simulation::residual() const {
  return impl_->last_residual;
}
double Simulation::stable_time_step() const {
  return cdem::stable_time_step(impl_->model);
}
double Simulation::rigid_time_step(const std::string& body) const {
  const Model& model = impl_->model;
  if (model.surface.empty())
    return std::numeric_limits<double>::infinity();
  std::vector<RigidBody> units;
  for (const int block : units_of_body(model, body))
    units.push_back(rigid_shape(model, block).body);
  return cdem::rigid_time_step(model, units, 1);
}
int Simulation::stage() const {
  return impl_->stage;
}
std::int64_t Simulation::steps() const {
  return impl_->kept.step;
}
EnergyLedger Simulation::energy() const {
  return cdem::energy(impl_->model, impl_->whole());
}
std::uint64_t Simulation::state_hash() const {
  return hash(impl_->whole());
}
FieldValue Simulation::max(const std::string& field, const Selection& on) const {
  check_field(field); // before the others are asked for their shares
  const auto list = values(impl_->model, impl_->whole(), field, on);
  return *std::max_element(list.begin(), list.end(),
                           [](const auto& a, const auto& b) { return a.value < b.value; });
}

FieldValue Simulation::min(const std::string& field, const Selection& on) const {
  check_field(field); // before the others are asked for their shares
  const auto list = values(impl_->model, impl_->whole(), field, on);
  return *std::min_element(list.begin(), list.end(),
                           [](const auto& a, const auto& b) { return a.value < b.value; });
}

double Simulation::mean(const std::string& field, const Selection& on) const {
  check_field(field);
  return mean_value(impl_->model, impl_->whole(), field, on);
}

double Simulation::at(const std::string& field, const geom::Vec3& place) const {
  check_field(field);
  const double value = value_at(impl_->model, impl_->whole(), field, place);
  impl_->warnings.of_shared_place("at \"" + field + "\"", place);
  return value;
}

Unbalance Simulation::unbalance(std::optional<double> reference) const {
  Impl& s = *impl_;
  Workspace work(s.model, s.whole(), s.conditions, s.seen->contacts);
  update_external(work.resolved, s.whole().time, &s.whole().velocity);
  return cdem::unbalance(s.model, work.resolved, net_forces(s.model, s.whole(), work, s.threads),
                         s.conditions.gravity, reference);
}

geom::Vec3 Simulation::reaction(const Selection& on) const {
  Impl& s = *impl_;
  return cdem::reaction(s.model, s.whole(), s.conditions, s.threads, *s.seen, on);
}

std::vector<Simulation::BlockRow> Simulation::blocks() const {
  Impl& s = *impl_;
  std::vector<BlockRow> rows;
  for (const int b : blocks_by_id(s.model)) {
    const Block& block = s.model.blocks[b];
    rows.push_back({block.id, block.parent, block.generation, s.model.bodies[block.body].name,
                    block.mass.centroid, shown_centroid_displacement(s.model, s.whole(), b),
                    block.mass.volume, block_stress(s.model, s.whole(), b)});
  }
  return rows;
}

int Simulation::body_number(const std::string& body, const std::string& field) const {
  const std::vector<Body>& bodies = impl_->model.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].name == body)
      return static_cast<int>(i);
  refuse_body(field, body, impl_->model);
}

std::size_t Simulation::watch(const std::string& body, double leaves) {
  Impl& s = *impl_;
  Watch watch = start_watch(s.model, s.whole(), body, leaves);
  if (s.watches == s.log.watches.size()) // else it has been restored
    s.log.watches.push_back(std::move(watch));
  return s.watches++;
}

std::vector<std::string> Simulation::dry_flows() const {
  return impl_->warnings.dry_flows();
}

void Simulation::probe(const std::string& name, const std::string& field, const geom::Vec3& place) {
  value_at(impl_->model, impl_->whole(), field, place); // throws for a wrong field or place
  for (const Probe& probe : impl_->log.probes)
    if (probe.name == name)
      throw geom::InputError("name", "\"" + name + "\"", "unique among the probes");
  impl_->warnings.of_shared_place("probe \"" + name + "\"", place);
  impl_->log.probes.push_back({name, field, place});
}

namespace {

// One column of the history for each of the quantities of a record, such as "x" of "reaction.".
void add_columns(RunLog& log, const Probe& record, const std::vector<std::string>& quantities) {
  std::vector<Probe> columns(quantities.size(), record);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i].name += "_" + quantities[i];
    columns[i].crack += quantities[i];
    for (const Probe& probe : log.probes)
      if (probe.name == columns[i].name)
        throw geom::InputError("name", "\"" + record.name + "\"", "one that gives new columns",
                               "the history has \"" + probe.name + "\"");
  }
  log.probes.insert(log.probes.end(), columns.begin(), columns.end());
}

} // namespace

void Simulation::record_reaction(const std::string& name, const std::string& on) {
  if (selected_nodes(impl_->model, place_of_support(impl_->model, on)).empty())
    throw geom::InputError("on", on, "a side of the model's box (\"x-\" .. \"z+\") or the name of a body");
  add_columns(impl_->log, {name, "", geom::Vec3::Zero(), "reaction.", -1, on}, {"x", "y", "z"});
}

void Simulation::record_momentum(const std::string& name, const std::string& body) {
  add_columns(impl_->log, {name, "", geom::Vec3::Zero(), "momentum.", body_number(body), body},
              {"x", "y", "z"});
}

void Simulation::record_cracks(const std::string& name, const std::string& body) {
  add_columns(impl_->log, {name, "", geom::Vec3::Zero(), "", body.empty() ? -1 : body_number(body)},
              crack_quantities());
}

CracksByBody Simulation::cracks() const {
  return cdem::cracks(impl_->model, impl_->whole());
}

std::vector<JointSum> Simulation::joints(const JointChoice& choice) const {
  return joint_sums(impl_->model, impl_->whole(), choice);
}

Snapshot Simulation::joint_picture(const JointChoice& choice, const std::string& title) const {
  Snapshot snapshot = joint_surface(impl_->model, impl_->whole(), choice, title);
  add_outline(impl_->model, impl_->whole(), snapshot);
  return snapshot;
}

JIntegral Simulation::j_integral(const std::string& body, JFront front,
                                 const std::vector<JDomain>& domains) const {
  Impl& s = *impl_;
  if (body.empty() && s.model.bodies.size() > 1)
    throw geom::InputError("body: left out: the model has several bodies; name the one with the crack");
  front.body = body.empty() ? 0 : body_number(body);
  ResolvedConditions conditions = resolve(s.model, s.whole(), s.conditions);
  update_external(conditions, s.whole().time, &s.whole().velocity);
  return cdem::j_integral(s.model, s.whole(), conditions, front, domains);
}

const Elastic& Simulation::material(const std::string& body) const {
  return impl_->model.bodies[body_number(body)].material;
}

std::vector<FragmentMotion> Simulation::fragment_motions() const {
  return cdem::fragment_motions(impl_->model, impl_->whole(),
                                resolve(impl_->model, impl_->whole(), impl_->conditions));
}

Snapshot Simulation::picture_snapshot(const PictureWish& wish, const std::string& title) const {
  const State& state = needs_whole(wish) ? impl_->whole() : impl_->kept;
  if (state.parted)
    agree_on_look(Look::surface);
  Snapshot shown = make_picture_snapshot(impl_->model, state, wish, title);
  add_water(impl_->conditions, wish.water, shown);
  return shown;
}

std::shared_ptr<void> Simulation::show_lead() const {
  State& state = impl_->kept;
  if (!state.parted)
    return nullptr;
  agree_on_look(Look::state_on_rank_0);
  struct Shown {
    State& state;
    std::shared_ptr<const StateShares> parted;
    std::vector<Contact> contacts;
    ~Shown() {
      state.contacts = std::move(contacts);
      state.parted = std::move(parted);
    }
  };
  auto shown = std::shared_ptr<Shown>(new Shown{state, state.parted, state.contacts});
  state.parted->gather_on_lead(state);
  state.parted.reset();
  return shown;
}

Snapshot Simulation::snapshot(const std::string& title, const WaterWish& water) const {
  Snapshot all = make_snapshot(impl_->model, impl_->whole(), title);
  add_water(impl_->conditions, water, all);
  return all;
}

Snapshot Simulation::last_good_snapshot(const std::string& title) const {
  return make_snapshot(impl_->model, impl_->last_good, title);
}

} // namespace cdem
