// Fragments by size, with their motion: as tables and as a file. The chart is in charts.cpp.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/model_object.hpp"

#include "lua/binding/functions/picture_fields.hpp"

namespace cdem::script {

namespace {

Value fragments(Session&, ModelObject& model, const Arguments&) {
  Values rows;
  for (const FragmentMotion& f : model.simulation.fragment_motions()) {
    Table row{{"volume", f.volume},
              {"centroid", f.centroid},
              {"tets", f.tets},
              {"held", f.held},
              {"diameter", f.diameter},
              {"mass", f.mass},
              {"centre", f.centre},
              {"velocity", geom::Vec3(f.momentum / f.mass)},
              {"momentum", f.momentum},
              {"angular_momentum", f.angular_momentum},
              {"kinetic_energy", f.kinetic},
              {"translation_energy", f.translation},
              {"rotation_energy", f.rotation},
              {"rest_energy", f.rest()}};
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
  m.records.push_back(
      {"FragmentMotion",
       "A piece of a model that unbroken bonds hold together, as it is and as it moves.",
       {number("volume").unit("m3").required(), vec3("centroid").unit("m").required().doc("undeformed"),
        integer("tets").required(), flag("held").required().doc("some node of it is held"),
        text("body").doc("nil where parts of several bodies hang together"),
        number("diameter").unit("m").required().doc("of the sphere with its volume"),
        number("mass").unit("kg").required(), vec3("centre").unit("m").required().doc("of mass, now"),
        vec3("velocity").unit("m/s").required().doc("of the centre"), vec3("momentum").unit("N s").required(),
        vec3("angular_momentum").unit("N m s").required().doc("about its own centre"),
        number("kinetic_energy").unit("J").required().doc("the three below together"),
        number("translation_energy").unit("J").required(),
        number("rotation_energy").unit("J").required().doc("of the rigid spin with its angular momentum"),
        number("rest_energy").unit("J").required().doc("vibration")}});
  Class& model = m.the_class("Model");
  model
      .add("fragments", "Pieces that unbroken bonds hold together, with their size and motion.", {},
           fragments, "cdem.FragmentMotion[]", "largest first")
      .ordered();
  model.add("save_fragments",
            "Writes a row for each fragment, the largest first: number of its body from 1 (0: parts of "
            "several), tets, held, volume, diameter, mass, centre, momentum, angular momentum, energies.",
            {text("file").required().doc("ends in .csv; in the output folder")}, save_fragments);
}

} // namespace cdem::script
