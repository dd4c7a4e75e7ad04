#include "lua/binding/functions/physical_fields.hpp"

#include <limits>

namespace cdem::script {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

}

Field modulus_field(std::string name) { // softer than gelatine, stiffer than diamond
  const char* const hint = "Rock has 1e9 to 1e11";
  return number(std::move(name), "Pa").above(0).doubted(0, 1e5, hint).doubted(1e13, unlimited, hint);
}

Field strength_field(std::string name) { // weaker than loose soil
  return number(std::move(name), "Pa").at_least(0).doubted(0, 1e3, "Rock has 1e5 to 1e8");
}

Field rock_strength_field(std::string name) { // weaker than stiff clay
  return number(std::move(name), "Pa").above(0).doubted(0, 1e5, "Rock has 5e6 to 3e8");
}

Field fracture_energy_field(std::string name) {
  return number(std::move(name), "J/m2")
      .above(0)
      .doubted(0, 0.3, "Rock and concrete have 10 to 300; 0.1 N/mm is 100");
}

Field friction_field(std::string name) { // the radians of any usual angle are fewer
  return number(std::move(name))
      .from(0, 90)
      .in_degrees()
      .doubted(0, 1.5, "Rock has 20 to 50; math.deg(x) makes degrees of radians");
}

Field joint_stiffness_field(std::string name) {
  return number(std::move(name), "Pa/m").above(0).doubted(0, 1e5, "Joints in rock have 1e8 to 1e12");
}

Field density_field(std::string name) { // lighter than any solid, heavier than any metal
  const char* const hint = "Rock has 2000 to 3000";
  return number(std::move(name), "kg/m3").above(0).doubted(0, 10, hint).doubted(3e4, unlimited, hint);
}

Field water_density_field(std::string name) {
  const char* const hint = "Fresh water has 1000, sea water 1025";
  return number(std::move(name), "kg/m3").above(0).doubted(0, 500, hint).doubted(2000, unlimited, hint);
}

Field water_weight_field(std::string name) { // lighter than any liquid: perhaps the density
  const char* const hint = "Water has 9810, its density times 9.81";
  return number(std::move(name), "N/m3")
      .above(0)
      .standard(9810.0)
      .doubted(0, 5e3, hint)
      .doubted(2e4, unlimited, hint);
}

Field softening_strain_field() {
  return number("softening_strain")
      .above(0)
      .doc("equivalent plastic strain at which the residual strength is reached, linearly; without fracture "
           "energy, so that what it dissipates depends on the size of the elements");
}

} // namespace cdem::script
