#include "libcdem/procedure/fictitious_masses.hpp"

#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/integrate/row_sums.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Part of the Gershgorin limit that a unit step uses; the rest covers the bound's round-off and closing contacts.
constexpr double step_safety = 0.95;

double mass_for(double row_sum) { // N/m -> kg for a unit step
  return row_sum / (4 * step_safety * step_safety);
}

} // namespace

FictitiousMasses::FictitiousMasses(const Model& model, const std::vector<ResolvedBolt>& bolts)
    : row_sums_(all_row_sums(model)) {
  add_bolt_row_sums(bolts, row_sums_);
  mass_ = row_sums_;
  add_contact_row_sums(model, mass_);
  for (double& mass : mass_)
    mass = mass_for(mass);
}

void FictitiousMasses::follow(const Model& model, const ContactLoads& contact) {
  for (const auto& [node, block] : contact.touched) {
    if (model.blocks[block].rigid >= 0)
      continue;
    const double least = mass_for(row_sums_[node] + contact.stiffness[node]);
    if (!(least > mass_[node]))
      continue;
    mass_[node] = least;
    raise(node);
  }
}

void FictitiousMasses::raise(int node) {
  is_raised_.resize(mass_.size());
  if (is_raised_[node])
    return;
  is_raised_[node] = 1;
  raised_.push_back(node);
}

void FictitiousMasses::add_to(std::vector<double>& loop_state) const {
  loop_state.push_back(static_cast<double>(raised_.size()));
  for (const int node : raised_)
    loop_state.insert(loop_state.end(), {static_cast<double>(node), mass_[node]});
}

std::size_t FictitiousMasses::take(const std::vector<double>& loop_state, std::size_t from) {
  const auto end = static_cast<double>(loop_state.size() - from - 1) / 2;
  const double count = loop_state.at(from++);
  for (double i = 0; i < std::min(count, end); ++i, from += 2) {
    const double node = loop_state.at(from);
    if (!(node >= 0 && node < static_cast<double>(mass_.size())))
      continue;
    raise(static_cast<int>(node));
    mass_[static_cast<std::size_t>(node)] = loop_state.at(from + 1);
  }
  return from;
}

} // namespace cdem
