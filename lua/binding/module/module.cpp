#include "lua/binding/module/module.hpp"
#include "lua/binding/module/topics.hpp"

#include <algorithm>
#include <cassert>

namespace cdem::script {

Class& Module::the_class(const std::string& name) {
  const auto it =
      std::find_if(classes.begin(), classes.end(), [&](const Class& c) { return c.name == name; });
  assert(it != classes.end());
  return *it;
}

Function& Module::add(std::string name, std::string doc, std::vector<Field> fields,
                      decltype(Function::body) body, std::string returns, std::string returns_doc) {
  functions.push_back({std::move(name), std::move(doc), std::move(fields), std::move(body),
                       std::move(returns), std::move(returns_doc)});
  return functions.back();
}

Function& Function::ordered() {
  in_order = true;
  return *this;
}

Function& Function::ordered_or_named() {
  named_too = true;
  return ordered();
}

Function& Function::replayed(Replay how) {
  replay = how;
  return *this;
}

Function& Function::by_rank_0() {
  led = true;
  return *this;
}

namespace {

struct Declared {
  Module module;
  std::vector<Topic> topics;
};

std::string lower(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter);
  return text;
}

// Names of all functions and methods.
std::vector<std::string> names_in(const Module& m) {
  std::vector<std::string> out;
  for (const Function& f : m.functions)
    out.push_back("cdem." + f.name);
  for (const Class& c : m.classes)
    for (const Function& f : c.methods)
      out.push_back(lower(c.name) + ":" + f.name);
  return out;
}

// What a topic's files declare is what was not there before.
void declare(Declared& all, const char* file, const char* title,
             std::initializer_list<void (*)(Module&)> binders) {
  const std::vector<std::string> before = names_in(all.module);
  const std::size_t classes_before = all.module.classes.size();
  for (const auto bind : binders)
    bind(all.module);
  Topic topic{file, title};
  for (const std::string& name : names_in(all.module))
    if (std::find(before.begin(), before.end(), name) == before.end())
      topic.names.push_back(name);
  for (std::size_t i = classes_before; i < all.module.classes.size(); ++i)
    topic.classes.push_back(all.module.classes[i].name);
  all.topics.push_back(std::move(topic));
}

const Declared& declared() {
  static const Declared all = [] {
    Declared d;
    declare(d, "parameters", "Parameters of a script", {bind_parameters});
    declare(d, "materials", "Materials and joints", {bind_materials, bind_hoek_brown, bind_joint_laws});
    declare(d, "shapes", "Assemblies of blocks", {bind_shapes, bind_discs});
    declare(d, "solids", "Free-form solids", {bind_solids, bind_surfaces});
    declare(d, "armour_units", "Armour units", {bind_armour_units});
    declare(d, "meshes", "Meshes of tetrahedra", {bind_tet_meshes});
    declare(d, "piles", "Piles of units", {bind_piles});
    declare(d, "selections", "Selections", {bind_selections});
    declare(d, "models", "Models", {bind_model});
    declare(d, "conditions", "Supports, loads and changes", {bind_conditions});
    declare(d, "ground", "Stress and water in the ground", {bind_in_situ, bind_water, bind_water_table});
    declare(d, "solving", "Solving", {bind_solving});
    declare(d, "safety", "Factor of safety", {bind_stability});
    declare(d, "settling", "Settling", {bind_settling});
    declare(d, "fracture", "Cutting and crack growth", {bind_fracture});
    declare(d, "bolts", "Bolts", {bind_bolts});
    declare(d, "flow", "Flow and waves", {bind_water_fields, bind_flow});
    declare(d, "earthquakes", "Earthquakes", {bind_waves});
    declare(d, "results", "Results", {bind_measures});
    declare(d, "cracks", "Cracks", {bind_cracks, bind_j_integral});
    declare(d, "joints", "Joints", {bind_joints});
    declare(d, "fragments", "Fragments and units", {bind_fragments, bind_units});
    declare(d, "files", "Files and pictures", {bind_output, bind_films});
    declare(d, "checkpoints", "Saved states", {bind_checkpoints});
    declare(d, "charts", "Charts", {bind_charts, bind_stereonets});
    declare(d, "reports", "Reports, tables and sweeps", {bind_report, bind_tables, bind_sweep});
    return d;
  }();
  return all;
}

} // namespace

const Module& module() {
  return declared().module;
}

const std::vector<Topic>& topics() {
  return declared().topics;
}

} // namespace cdem::script
