// Fragments by size, with their motion: as tables and as a file. The chart is in charts.cpp.
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"

#include "lua/binding/functions/picture_fields.hpp"

namespace cdem::script {

namespace {

const Record<FragmentMotion> fragment_motion{
    "FragmentMotion",
    "A piece of a model that unbroken bonds hold together, as it is and as it moves.",
    {{number("volume", "m3"), &FragmentMotion::volume},
     {vec3("centroid", "m").doc("undeformed"), &FragmentMotion::centroid},
     {integer("tets"), &FragmentMotion::tets},
     {flag("held").doc("some node of it is held"), &FragmentMotion::held},
     {text("body").doc("nil where parts of several bodies hang together")},
     {number("diameter", "m").doc("of the sphere with its volume"), &FragmentMotion::diameter},
     {number("mass", "kg"), &FragmentMotion::mass},
     {vec3("centre", "m").doc("of mass, now"), &FragmentMotion::centre},
     {vec3("velocity", "m/s").doc("of the centre"),
      [](const FragmentMotion& f) { return geom::Vec3(f.momentum / f.mass); }},
     {vec3("momentum", "N s"), &FragmentMotion::momentum},
     {vec3("angular_momentum", "N m s").doc("about its own centre"), &FragmentMotion::angular_momentum},
     {number("kinetic_energy", "J").doc("the three below together"), &FragmentMotion::kinetic},
     {number("translation_energy", "J"), &FragmentMotion::translation},
     {number("rotation_energy", "J").doc("of the rigid spin with its angular momentum"),
      &FragmentMotion::rotation},
     {number("rest_energy", "J").doc("vibration"), &FragmentMotion::rest}}};

Value fragments(Session&, ModelObject& model, const Arguments&) {
  Values rows;
  for (const FragmentMotion& f : model.simulation.fragment_motions()) {
    Table row = fragment_motion(f);
    if (f.body >= 0)
      row.named["body"] = model.body_names[static_cast<std::size_t>(f.body)];
    rows.emplace_back(std::move(row));
  }
  return Table::list(std::move(rows));
}

Value save_fragments(Session& session, ModelObject& model, const Arguments& a) {
  require_ending(a.text("file"), ".csv");
  const std::vector<FragmentMotion> list = model.simulation.fragment_motions();
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  const auto add = [&](const std::string& name, const auto& get) {
    std::vector<double> values;
    values.reserve(list.size());
    for (const FragmentMotion& f : list)
      values.push_back(get(f));
    columns.emplace_back(name, std::move(values));
  };
  const auto add_vector = [&](const std::string& name, const auto& get) {
    for (int axis = 0; axis < 3; ++axis)
      add(name + "_" + "xyz"[axis], [&](const FragmentMotion& f) { return get(f)[axis]; });
  };
  // By number, as a file of numbers has no names; 0: parts of several bodies.
  add("body", [](const auto& f) { return f.body + 1.0; });
  add("tets", [](const auto& f) { return static_cast<double>(f.tets); });
  add("held", [](const auto& f) { return f.held ? 1.0 : 0.0; });
  add("volume", [](const auto& f) { return f.volume; });
  add("diameter", [](const auto& f) { return f.diameter; });
  add("mass", [](const auto& f) { return f.mass; });
  add_vector("centre", [](const auto& f) -> const geom::Vec3& { return f.centre; });
  add_vector("momentum", [](const auto& f) -> const geom::Vec3& { return f.momentum; });
  add_vector("angular_momentum", [](const auto& f) -> const geom::Vec3& { return f.angular_momentum; });
  add("kinetic_energy", [](const auto& f) { return f.kinetic; });
  add("translation_energy", [](const auto& f) { return f.translation; });
  add("rotation_energy", [](const auto& f) { return f.rotation; });
  add("rest_energy", [](const auto& f) { return f.rest(); });
  if (!session.settings.check_only)
    write_file(session.files.to_write(a.text("file")), csv(columns));
  return {};
}

} // namespace

void bind_fragments(Module& m) {
  m.records.push_back(fragment_motion);
  Class& model = m.the_class("Model");
  model.add(
      "fragments",
      "Pieces that unbroken bonds hold together, with their size and motion. Held ones, such as a floor, "
      "are listed too, with `held`, and a floor is often the first: the first that is not held is the "
      "largest piece that is free.",
      {}, fragments, "cdem.FragmentMotion[]", "largest first");
  model.add("save_fragments",
            "Writes a row for each fragment, the largest first: number of its body from 1 (0: parts of "
            "several), tets, held, volume, diameter, mass, centre, momentum, angular momentum, energies.",
            {text("file").required().doc("ends in .csv").output()}, save_fragments);
}

} // namespace cdem::script
