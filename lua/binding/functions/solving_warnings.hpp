// What a solving call tells of, before it begins and after it has ended, and what ends it.
#pragma once

#include "lua/binding/session/model_object.hpp"

namespace cdem::script {

std::string three_digits(double);                // for messages
std::string place_text(const geom::Vec3& place); // to four digits, likewise

// Where no load, moved support or the like acts. kind: of the stage.
void warn_if_nothing_acts(Session&, const ModelObject&, const std::string& kind);

// Flat or tiny elements that shorten the time step of a stage in real time; once, until others do.
void warn_of_slivers(Session&, ModelObject&);

// When a model is made: the process zones of what softens, with a warning where faces are too large for them.
void note_process_zones(Session&, ModelObject&);

// After a stage: what small strain cannot hold, what left the model, which laws acted on nothing so far.
void warn_after_stage(Session&, ModelObject&, const Stage&);
// For when the script ends: flows whose water has reached nothing.
void note_dry_flows(ModelObject&);

// After a stage: warns of an energy balance that is open by more than 1 %, and of energies that cannot be
// (results/one_way_energies.hpp) by more than that; throws SolutionError from 10 %.
void check_energy(Session&, ModelObject&, const Stage&);

// "contact of "a" and "b"", or "joint of "a"" between its own blocks.
std::string shown_pair(const std::string& body_a, const std::string& body_b);

// Where what comes next takes more memory than a rank may. Not in the report, which is the same for any number of ranks. All
// ranks call it together. what: "building this model"; bytes: in each rank.
void warn_of_memory(const Session&, const std::string& what, double bytes);

// Does each of several acts on a model, or none: what is refused half-way must leave the model as the journal knows it, or
// a mended script cannot go on from there. act(simulation, number from 0).
template <class Act>
void all_or_none(const Session& session, ModelObject& model, std::size_t count, const Act& act) {
  const auto each = [&](Simulation& simulation) {
    for (std::size_t i = 0; i < count; ++i)
      act(simulation, i);
  };
  if (count > 1 && !session.checkpoints.replaying()) {
    Simulation trial = model.simulation.copy();
    each(trial);
  }
  each(model.simulation);
}

} // namespace cdem::script
