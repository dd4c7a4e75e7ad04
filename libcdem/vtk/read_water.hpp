// Water from the files of other programs (OpenFOAM's foamToVTK, DualSPHysics, ...) on a regular grid: .vti, .vtu, .vts, .vtr
// and legacy .vtk. Each file is read in a child process under limits.
#pragma once

#include "libcdem/water/recorded_water.hpp"

#include <string>
#include <vector>

namespace cdem {

struct WaterFiles {
  std::vector<std::string> paths;
  std::vector<double> times; // s, one for each
};

// The files that a .pvd lists, with their times. Throws geom::InputError where it is damaged, lists nothing, gives no time, or
// names a file outside its folder.
WaterFiles water_files_of(const std::string& pvd);

struct WaterArrays {
  std::string velocity;           // m/s, three components, at points or in cells
  std::string pressure, fraction; // one component each; "": none
  double pressure_factor = 1;     // Pa in a unit of the file
  double cell = 0;                // m, of the grid; 0: of an image its own, else the mean size of the cells
  int same_along = -1;            // axis along which the water is the same everywhere; -1: none
  geom::Vec3 shift = geom::Vec3::Zero(); // m, added to the coordinates
};

// Grid, times and frames of a record. Throws geom::InputError, which names the file, for one that VTK cannot read, an array
// that is not there or has nan, and a grid that is not that of the first file.
WaterRecord read_water(const WaterFiles&, const WaterArrays&);

} // namespace cdem
