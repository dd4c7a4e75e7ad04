// Fields of physical quantities: unit, range, and the values that nothing in a model has. A number that is so small or so
// large was most likely meant in another unit (MPa, t/m3, radians), and the call warns of it.
#pragma once

#include "lua/binding/schema/schema.hpp"

namespace cdem::script {

Field modulus_field(std::string name);         // Pa, > 0
Field strength_field(std::string name);        // Pa, >= 0; 0: none
Field rock_strength_field(std::string name);   // Pa, > 0; uniaxial compression
Field fracture_energy_field(std::string name); // J/m2, > 0
Field friction_field(std::string name);        // deg, in [0, 90); 0: none
Field joint_stiffness_field(std::string name); // Pa/m, > 0
Field density_field(std::string name);         // kg/m3, > 0; of a solid
Field water_density_field(std::string name);   // kg/m3, > 0
Field water_weight_field(std::string name);    // N/m3, > 0, 9810 by default
Field softening_strain_field();                // of plasticity

} // namespace cdem::script
