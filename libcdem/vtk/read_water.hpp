// Water from the files of other programs (OpenFOAM's foamToVTK, DualSPHysics, ...) on a regular grid: .vti, .vtu, .vts, .vtr
// and legacy .vtk. Each file is read in a child process under limits.
//
// Values of cells become values at points as means, and values at points become values of the grid by interpolation. With a
// water fraction a, cells and points count by max(0, 2 a - 1): the wind over the water adds nothing. The pressure goes this way
// as the head p + rho g z. Beside a bed, where means are one-sided, still water is therefore exact on any mesh.
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
  double density = 1025, gravity = standard_water_gravity; // kg/m3, m/s2
  geom::Vec3 shift = geom::Vec3::Zero();                   // m, added to the coordinates
};

// A whole record but for its level. Throws geom::InputError, which names the file, for one that VTK cannot read, an array
// that is not there or has nan, and a grid that is not that of the first file.
WaterRecord read_water(const WaterFiles&, const WaterArrays&);

} // namespace cdem
