// What a user is warned of: what a model is asked that it can do but that hardly anybody means. Each line is told once.
#pragma once

#include "libcdem/load/initial_stress.hpp"
#include "libcdem/simulated_model.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

class Warnings {
public:
  explicit Warnings(const SimulatedModel& of)
      : of_(of), model_(of.model), conditions_(of.conditions), log_(of.log) {}

  void tell(const std::string& line);
  void before_stage();
  void of_initial_stress(const InitialStress&); // when it has been given
  void of_distant_table(const std::shared_ptr<const WaterTable>&);
  void of_open_water(const StillWater&);
  void of_joined_pieces(const Selection& turns_rigid);
  void of_shared_place(const std::string& asks, const geom::Vec3& place); // asks: who wants a value there
  void of_lost_probes();                                                  // when rock has been removed
  void of_falling_forces(); // of an excavation, before a relaxation
  // Looks which flows wet a face between these times of a run, s.
  void look_for_dry_flows(double begin, double end);
  // Flows of water that has reached no face in any run so far, in words.
  std::vector<std::string> dry_flows() const;

private:
  void of_loads_on_supports();
  void of_held_records();
  void of_unstressed_rock();
  void of_stress_jumps();
  void of_uneven_bed(const Flow&);

  const SimulatedModel& of_;
  const Model& model_;
  const Conditions& conditions_;
  const RunLog& log_;
  std::set<std::string> told_;
  // Initial stresses that the script has given before the first stage, and the blocks of each.
  struct GivenStress {
    InitialStress field;
    std::vector<char> has; // of each block
  };
  std::vector<GivenStress> given_stress_;
  struct SeenFlow {
    std::pair<const WaterField*, std::string> flow; // the field, and where it acts
    double begin;                                   // s, of the first run
    std::string line;                               // empty: its water has reached a face
  };
  std::vector<SeenFlow> seen_flows_;
};

} // namespace cdem
