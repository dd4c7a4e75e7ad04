#include "lua/binding/runtime/module.hpp"

#include <algorithm>
#include <cassert>

namespace cdem::script {

Class& Module::the_class(const std::string& name) {
  const auto it =
      std::find_if(classes.begin(), classes.end(), [&](const Class& c) { return c.name == name; });
  assert(it != classes.end());
  return *it;
}

const Module& module() {
  static const Module all = [] {
    Module m;
    bind_parameters(m);
    bind_materials(m);
    bind_joint_laws(m);
    bind_shapes(m);
    bind_solids(m);
    bind_armour_units(m);
    bind_tet_meshes(m);
    bind_piles(m);
    bind_selections(m);
    bind_model(m);
    bind_conditions(m);
    bind_in_situ(m);
    bind_water(m);
    bind_solving(m);
    bind_stability(m);
    bind_settling(m);
    bind_fracture(m);
    bind_bolts(m);
    bind_flow(m);
    bind_waves(m);
    bind_measures(m);
    bind_cracks(m);
    bind_j_integral(m);
    bind_joints(m);
    bind_fragments(m);
    bind_units(m);
    bind_output(m);
    bind_checkpoints(m);
    bind_charts(m);
    bind_report(m);
    bind_tables(m);
    bind_sweep(m);
    return m;
  }();
  return all;
}

} // namespace cdem::script
