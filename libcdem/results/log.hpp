// What a run leaves behind besides its state: breaks, histories, probes, units that left. Rows as the script reads
// them.
#pragma once

#include "libcdem/results/one_way_energies.hpp"
#include "libcdem/results/snapshot.hpp"
#include "libcdem/results/watch.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

// One broken bond.
struct BreakRow {
  int stage = 0;
  std::int64_t step = 0;                 // within the stage
  double time = 0;                       // s
  BondMode mode = BondMode::intact;      // broken_tension or broken_shear
  geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed
  geom::Vec3 normal = geom::Vec3::Zero();
  double area = 0;                                // m2
  double normal_traction = 0, shear_traction = 0; // Pa at breaking, tension positive
  std::int64_t block_a = 0, block_b = 0;          // ids
};

struct HistoryRow {
  int stage = 0;
  std::int64_t step = 0;                             // over all stages
  double time = 0;                                   // s
  double residual = 0;                               // out-of-balance force norm over applied force norm
  double kinetic = 0;                                // J
  double external = 0;                               // J, work of the loads so far
  std::int64_t broken_tension = 0, broken_shear = 0; // spring points so far
  std::vector<double> probes;
};

struct Probe {
  std::string name, field;
  geom::Vec3 place; // m, undeformed
  // The quantity of cracks (results/cracks.hpp), and the body; -1: all bodies. Empty: the field at the place.
  std::string crack = {};
  int body = -1;
  // For "reaction.x" or "momentum.z" in `crack`: the side of the support, or the body.
  std::string on = {};
};

// A piece that has left the model (step/escape.hpp).
struct EscapeRow {
  int stage = 0;
  std::int64_t step = 0; // over all stages
  double time = 0;       // s
  std::string text;      // what the user was told
};

struct RunLog {
  std::vector<BreakRow> breaks;
  std::vector<HistoryRow> history;
  std::vector<Probe> probes;
  std::vector<Watch> watches;
  std::vector<EscapeRow> escapes;
  // Bodies, smaller first, for which a law was given and that have had neither interface nor contact so far.
  std::vector<std::array<int, 2>> unmet;
  std::int64_t broken_tension = 0, broken_shear = 0;
  std::int64_t told_tension = 0, told_shear = 0; // of these: told of when earlier stages ended

  // Largest values of all contacts so far: depth, m, and depth over the height of the lower of the two tets.
  double deepest_contact = 0, deepest_over_height = 0;

  OneWayEnergies one_way; // of the ledger after every step

  std::int64_t every = 10; // steps between samples

  // A sample is due at this step (over all stages).
  bool due(std::int64_t step) const { return step % every == 0; }
  // Thins the history by halves when it grows beyond 20000 rows, so that its length stays bounded and even.
  void add(HistoryRow row);
};

// Leaves the first breaks only.
void forget_breaks(RunLog&, std::size_t left);

} // namespace cdem
