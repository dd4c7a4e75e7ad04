// A Simulation's answers on its cracks, joints and pieces.
#include "libcdem/results/crack_surface.hpp"
#include "libcdem/results/drawn_surface.hpp"
#include "libcdem/simulation_impl.hpp"

namespace cdem {

CracksByBody Simulation::cracks() const {
  return cdem::cracks(impl_->model, impl_->whole());
}

void Simulation::record_cracks(const std::string& name, const std::string& body) {
  const int number = body.empty() ? -1 : body_number(body);
  for (const std::string& quantity : crack_quantities()) {
    const std::string column = name + "_" + quantity;
    for (const Probe& probe : impl_->log.probes)
      if (probe.name == column)
        throw geom::InputError("name", "\"" + name + "\"", "one that gives new columns",
                               "the history has \"" + column + "\"");
  }
  for (const std::string& quantity : crack_quantities())
    impl_->log.probes.push_back({name + "_" + quantity, "", geom::Vec3::Zero(), quantity, number});
}

Snapshot Simulation::crack_surface(bool damaged, const std::string& title) const {
  return cdem::crack_surface(impl_->model, impl_->whole(), impl_->log.breaks, damaged, title);
}

std::vector<JointSum> Simulation::joints(const JointChoice& choice) const {
  return joint_sums(impl_->model, impl_->whole(), choice);
}

std::vector<std::pair<std::string, JointPoint>> Simulation::joint_points(const JointChoice& choice) const {
  return cdem::joint_points(impl_->model, impl_->whole(), choice);
}

Snapshot Simulation::joint_surface(const JointChoice& choice, const std::string& title) const {
  return cdem::joint_surface(impl_->model, impl_->whole(), choice, title);
}

Snapshot Simulation::joint_picture(const JointChoice& choice, const std::string& title) const {
  Snapshot snapshot = joint_surface(choice, title);
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

} // namespace cdem
