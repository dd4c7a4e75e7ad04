#include "lua/binding/functions/solving_warnings.hpp"

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/memory_needed.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/results/deformation.hpp"
#include "libcdem/results/one_way_energies.hpp"
#include "libcdem/results/overlap.hpp"
#include "libcdem/results/process_zone.hpp"
#include "libcdem/state/ledger.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/sliding_friction.hpp"
#include "lua/binding/schema/angles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem::script {

namespace {

constexpr double small_strain = 0.01;
constexpr double small_turn = 1;        // degree
constexpr double small_departure = 0.1; // of a face's size
// An open energy balance is told of again when it has grown by this.
constexpr double tell_again = 1.5;
// Depth over an element's height: deeper contacts are a likely cause of an open energy balance.
constexpr double deep_contact = 0.05;

std::string of_stage(const Stage& stage) {
  return "stage " + std::to_string(stage.number) + " (" + stage.kind + "): ";
}

// One line a stage, of what small strain cannot hold (results/deformation.hpp says why these limits).
void warn_of_large_deformation(Session& session, const ModelObject& model, const Stage& stage) {
  const Deformation d = largest_deformation(model.simulation.model(), model.simulation.state());
  std::string found;
  if (d.strain > small_strain)
    found = "block " + std::to_string(d.strain_block) + " is strained by " + three_digits(100 * d.strain) +
            " % (more than 1 %)";
  if (degrees(d.turn) > small_turn)
    found += (found.empty() ? "block " : ", block ") + std::to_string(d.turn_block) + " has turned by " +
             three_digits(degrees(d.turn)) + " degrees (more than 1), a false strain of " +
             three_digits(50 * d.turn * d.turn) + " %";
  if (d.departure > small_departure)
    found += (found.empty() ? "block " : ", block ") + std::to_string(d.departure_block) +
             " has left a neighbour by " + three_digits(100 * d.departure) +
             " % of their face's size, and meets nothing new";
  if (!found.empty())
    session.warn(of_stage(stage) + "beyond small strain: " + found);
}

// A relaxation that did not converge.
bool stopped_short(const Value& result) {
  const Table* const table = result.table();
  if (!table)
    return false;
  const auto found = table->named.find("converged");
  const bool* const converged = found == table->named.end() ? nullptr : found->second.get<bool>();
  return converged && !*converged;
}

struct Cause {
  std::string what, advice;
};

// The likeliest reason of an open balance, by what has happened in the model so far.
Cause likely_cause(const ModelObject& model) {
  const Simulation& simulation = model.simulation;
  const ContactSummary contacts = simulation.contacts();
  const Deformation d = largest_deformation(simulation.model(), simulation.state());
  if (degrees(d.turn) > small_turn)
    return {"blocks of small strain that turn", "leave element = \"small_strain\" out"};
  if (contacts.deepest_over_height > deep_contact)
    return {"contacts up to " + three_digits(contacts.deepest_over_height) +
                " of an element's height deep, where faces and edges change over",
            "take stiffer contacts, a smaller safety, or damping"};
  if (contacts.deepest > 0)
    return {"contacts that open and close or change over from face to face",
            "take a smaller safety, softer contacts, or damping"};
  const std::vector<std::uint8_t>& modes = simulation.state().bond_mode;
  if (!simulation.log().breaks.empty() ||
      !std::all_of(modes.begin(), modes.end(), [](std::uint8_t mode) { return is_intact(mode); }))
    return {"broken or dry joints that open and close within a step", "take a smaller safety"};
  return {"a time step too near the stable one", "take a smaller safety or time_step"};
}

std::string avoiding(const Slivers& s) {
  return s.elements ? "take another mesh size there, a simpler solid, element = \"rigid\", or mass_scaling "
                      "where all is slow"
         : s.cut    ? "give cdem.cut_by_joints a larger smallest (m), which joins thinner blocks to a "
                      "neighbour, or take "
                      "another seed or spacing, cuts that stay clear of corners, or element = \"rigid\""
                    : "take another seed or more relaxations of cdem.voronoi, another seed or spacing of "
                      "cdem.cut_by_joints, cuts that stay clear of corners, or element = \"rigid\"";
}

} // namespace

std::string place_text(const geom::Vec3& x) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", x.x(), x.y(), x.z());
  return text;
}

std::string three_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

std::string shown_pair(const std::string& body_a, const std::string& body_b) {
  return body_a == body_b ? "joint of \"" + body_a + "\""
                          : "contact of \"" + body_a + "\" and \"" + body_b + "\"";
}

void warn_if_nothing_acts(Session& session, const ModelObject& model, const std::string& kind) {
  if (!model.simulation.anything_acts())
    session.warn(
        kind + ": nothing acts on the model: no load, no support that moves it, no initial stress; it stays "
               "as it is");
}

void warn_of_slivers(Session& session, ModelObject& model) {
  if (session.checkpoints.replaying())
    return;
  std::string all;
  for (const Slivers& s : model.simulation.slivers()) {
    const std::string unit = s.elements ? "element" : "block";
    all += (all.empty() ? "" : "; ") + std::to_string(s.count) + " of " + std::to_string(s.of) + " " + unit +
           "s of \"" + s.body + "\" need a time step of " + three_digits(s.step) + " s; the others allow " +
           three_digits(s.other_step) + " s. The worst is " + unit + " " + std::to_string(s.worst) + " at " +
           place_text(s.place) + " m, " + three_digits(s.height_over_size) +
           " of its size high: " + avoiding(s);
  }
  if (!all.empty() && all != model.told_slivers)
    session.warn(all);
  model.told_slivers = all;
}

void note_process_zones(Session& session, ModelObject& model) {
  std::string coarse;
  for (const ProcessZone& zone : cdem::process_zones(model.simulation.model())) {
    const std::string found = "process zone E' G_I / T^2 of " + zone.of + ": " + three_digits(zone.length) +
                              " m; faces of " + three_digits(zone.face_size) + " m";
    model.notes->process_zones.push_back(found + ", " + three_digits(zone.faces_in_zone()) +
                                         " in the cohesive zone; at most " +
                                         three_digits(zone.largest_face_size) + " m serves");
    if (!zone.resolved())
      coarse += (coarse.empty() ? "" : "; ") + found + " leave " + three_digits(zone.faces_in_zone()) +
                " in its cohesive zone, fewer than " + three_digits(least_faces_in_zone) +
                ": strength and energy will depend on the mesh; take faces of at most " +
                three_digits(zone.largest_face_size) + " m, or a larger fracture_energy_1";
  }
  if (!coarse.empty())
    session.warn(coarse);
}

void note_dry_flows(ModelObject& model) {
  for (const std::string& line : model.simulation.dry_flows())
    model.notes->at_end.push_back("model " + std::to_string(model.number) + ": " + line);
}

namespace {

// Tells once of two bodies that slide with less friction than their law gives.
void warn_of_sliding(Session& session, ModelObject& model, const Stage& stage) {
  const SlidingFriction& sliding = model.simulation.sliding();
  const std::vector<Block>& blocks = model.simulation.model().blocks;
  if (stage.kind != "run" || sliding.blocks != blocks.size())
    return;
  const double least = 1e-3 * model.simulation.energy().scale(); // J
  for (const auto& [pair, sums] : sliding.of_blocks) {
    const double law = sums.law.norm();
    std::array<int, 2> bodies{blocks[pair[0]].body, blocks[pair[1]].body};
    std::sort(bodies.begin(), bodies.end());
    if (sums.slides() && law > least && sums.done < 0.985 * law &&
        std::find(sliding.told.begin(), sliding.told.end(), bodies) == sliding.told.end()) {
      sliding.told.push_back(bodies);
      const std::string advice =
          !sums.joint ? "the contact a restitution of 0.5 or less, or the materials stiffness_damping"
                      : "the materials a stiffness_damping of 0.05 h sqrt(density / youngs_modulus), h the "
                        "size of a block; blocks of small strain have none: leave their element out";
      session.warn(
          of_stage(stage) + shown_pair(model.body_names[bodies[0]], model.body_names[bodies[1]]) +
          ": they slide, and friction has done " + three_digits(sums.done / law) +
          " of the work that its law asks for: while a sole vibrates or bounces, the slip of some of its "
          "points reverses and others stick; start the load slowly or with model:relax, and give " +
          advice);
    }
  }
}

// Contacts that end deep leave bodies within each other with nothing between them.
void warn_of_free_overlap(Session& session, ModelObject& model, const Stage& stage) {
  constexpr double least = 0.01;              // of a block's volume
  constexpr std::int64_t steps_between = 500; // looks cost as much as some steps
  if (model.simulation.steps() < model.looked_for_overlap + steps_between)
    return;
  model.looked_for_overlap = model.simulation.steps();
  const cdem::Model& of = model.simulation.model();
  const FreeOverlap found =
      free_overlap(of, model.simulation.state(), std::max(least, tell_again * model.told_overlap));
  if (found.a < 0)
    return;
  model.told_overlap = found.part;
  session.warn(of_stage(stage) + block_name(of, found.a) + " and " + block_name(of, found.b) +
               ": they overlap by " + three_digits(100 * found.part) +
               " % of the smaller one without a contact between them: they have passed into each other; give "
               "the contact a larger normal_stiffness");
}

} // namespace

void warn_after_stage(Session& session, ModelObject& model, const Stage& stage) {
  warn_of_large_deformation(session, model, stage);
  warn_of_sliding(session, model, stage);
  warn_of_free_overlap(session, model, stage);
  model.notes->at_end.clear();
  note_dry_flows(model);
  for (const auto& [a, b] : model.simulation.unmet())
    model.notes->at_end.push_back(
        shown_pair(a, b) +
        ": they had no interface and never touched, so that the law acted on nothing; look at " +
        (a == b ? "their places" : "their places and names, or leave it out"));
  if (const double share = model.simulation.excavation_kept(); share > 0 && !model.trial)
    model.notes->at_end.push_back(
        "model " + std::to_string(model.number) +
        ": forces of an excavation were still kept in its last stage, up to " + three_digits(share) +
        " of their size: the results are those of rock that they support; model:relax_excavation{} "
        "lets them go, and a stage after it shows what follows");
}

// The ledger has to close: what is stored and spent is the work of the loads. Where it closes, energies that cannot be
// (results/one_way_energies.hpp) tell that two errors hide each other in it. The larger of the two is told. A relaxation
// that stopped short of its balance is told of anyway.
void check_energy(Session& session, ModelObject& model, const Stage& stage) {
  if (stopped_short(stage.result))
    return;
  const EnergyLedger energy = model.simulation.energy();
  const ImpossibleEnergy impossible =
      cdem::impossible_energy(energy, model.simulation.time(), model.simulation.log().one_way);
  const double open = energy.balance_error(), worst = std::max(open, impossible.part);
  if (worst <= open_balance || (worst <= broken_balance && worst < tell_again * model.told_open))
    return;
  model.told_open = worst;
  const double gained = energy.total() - energy.external;
  const std::string percent = three_digits(100 * worst) + " % of the largest energy in the ledger (";
  const std::string found =
      of_stage(stage) + (worst > open
                             ? impossible.what + " by " + percent + three_digits(impossible.energy) +
                                   " J at " + three_digits(impossible.time) + " s"
                             : "the energy balance is open by " + percent + three_digits(std::abs(gained)) +
                                   " J " + (gained > 0 ? "gained" : "lost"));
  const Cause cause =
      worst > open && impossible.of_breaking
          ? Cause{"faces of cohesive bodies that begin to crack while they are pressed, with the energy that "
                  "their law stores (theory, section 22)",
                  "a smaller safety changes nothing; model:cracks() tells what cracks have taken"}
          : likely_cause(model);
  const std::string why = "); most likely from " + cause.what + ": " + cause.advice;
  if (worst > broken_balance)
    throw SolutionError(found + why);
  session.warn(found + ", more than 1 %" + why);
}

void warn_of_memory(const Session& session, const std::string& what, double bytes) {
  const EngineSettings& settings = session.settings;
  if (settings.memory == 0 || session.checkpoints.silent())
    return;
  double least = -static_cast<double>(settings.memory); // of any machine
  ranks().largest(&least, 1);
  const std::string text = memory_warning(what, bytes, -least, ranks().size());
  if (!text.empty() && settings.observer)
    settings.observer->warning_of_machine((session.where ? session.where() + ": " : "") + "warning: " + text);
}

} // namespace cdem::script
