// A folder with the scripts of a test, in which cdem runs.
#pragma once

#include "tests/apps/support/child.hpp"

#include <initializer_list>

namespace testing {

struct CaseFolder {
  struct File {
    std::string name, text; // "plate/case.lua"
  };
  TempFolder folder;
  Start start;
  explicit CaseFolder(std::initializer_list<File> files) {
    start.folder = folder.path();
    for (const File& file : files)
      write_file(folder / file.name, file.text);
  }
  // signal: sent once `after` has been printed; 0: what `start` says.
  Outcome cdem(const std::vector<std::string>& arguments, int signal = 0,
               const std::string& after = "") const {
    Start with = start;
    if (signal != 0) {
      with.signal = signal;
      with.signal_after = after;
    }
    return run_cdem(arguments, with);
  }
  Outcome operator()(const std::vector<std::string>& arguments) const { return cdem(arguments); }
};

// A case script of a plate that is shaken and breaks; it reports the hash of the state, the largest velocity and the number
// of breaks. In it `steps` is a parameter.
inline std::string shaken_plate(const std::string& size, const std::string& divisions, int steps) {
  return R"(local cdem = require "cdem"
local steps = cdem.parameter{ name = "steps", default = )" +
         std::to_string(steps) + R"( }
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 6e5, friction_angle = 30, tensile_strength = 2e5 }
local model = cdem.model{ bodies = { { shape = cdem.grid{ size = )" +
         size + ", divisions = " + divisions + R"( },
  material = rock, joint = joint, name = "plate" } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {2e5, 2.5e5, 0} }
print "begins"
model:relax{ max_steps = 250 }
local most = 0
model:run{ steps = steps, every = 200, callback = function() most = math.max(most, model:max("velocity.y")) end }
cdem.report{ { name = "hash", value = model.state_hash }, { name = "most", value = most },
  { name = "breaks", value = #model:breaks() } }
)";
}

} // namespace testing
