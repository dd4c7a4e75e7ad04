// A model as the script holds it: libcdem's Simulation with the names the script gave.
#pragma once

#include "lua/binding/objects/objects.hpp"
#include "lua/binding/session/film.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/vtk/files.hpp"
#include "libgeom/placement/pile.hpp"

#include <array>

namespace cdem::script {

using Columns = std::vector<std::pair<std::string, std::vector<double>>>; // of a table of numbers, by name

struct ModelObject final : Object {
  explicit ModelObject(Simulation given) : simulation(std::move(given)) {}

  Simulation simulation;
  int number = 1;     // in the order the script made them
  bool trial = false; // its stages are trials of a search
  std::vector<std::string> body_names;
  std::map<std::string, geom::Pile> piles; // of meshed bodies, as they were when the model was made
  std::vector<std::string> unjointed;      // bodies without a joint of their own
  std::map<std::string, std::vector<Selection>> places; // by model:select
  std::shared_ptr<ModelNotes> notes = std::make_shared<ModelNotes>();
  std::map<std::string, std::vector<SeriesEntry>> series; // by .pvd, in the order saved
  std::vector<Film> films;                                // taken while it is solved; their frames: series
  std::vector<std::shared_ptr<Reference>> after_stage;    // called with each stage that has ended
  std::shared_ptr<Reference> memory;                      // table model.memory
  mutable struct {
    Columns columns;
    std::string text;
  } written;               // of the history, as its file stands
  double told_open = 0;    // energy balance that the user was warned of
  double told_overlap = 0; // part of a block that another one without a contact to it lies in, likewise
  std::int64_t looked_for_overlap = 0; // step
  std::string told_slivers;
  int failing_since =
      0; // stage whose relaxation found that the model runs away; 0: none, or it has come to rest since
  bool solving = false;         // a callback of a stage may look and not touch
  double checked = 0;           // s, of runs that a check has passed
  mutable bool touched = false; // by the running call, which has asked require_idle

  const char* class_name() const override { return "Model"; }

  // s; in a check the time that its runs would have come to.
  double time() const { return simulation.time() + checked; }
  std::string title(const Session&) const; // "uniaxial_compression, stage 3 (relax)"
  // For what may change the model. Throws geom::InputError when called from a callback of a running stage.
  void require_idle(const char* call) const;
  // Throws geom::InputError when model.memory holds something a checkpoint could not.
  void check_memory() const;
  std::string history_name() const; // "history.csv", "history_2.csv" ..., in the folder "trials" for a trial
  void write_history(const Session&) const;
  void write_films(const Session&); // that have new frames
};

// The history as columns by name, in the order of the file.
Columns history_columns(const Simulation&);
// The name of a new history; what: what becomes of it.
std::string column_name(const Arguments&, const std::string& what = "it begins the names of columns");
std::string csv(const Columns&);
std::string csv_rows(const Columns&, std::size_t first); // from the row `first` on, without the names

} // namespace cdem::script
