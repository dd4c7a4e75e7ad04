// Files of a model: ParaView, pictures.
#include "lua/binding/functions/joint_choice.hpp"
#include "lua/binding/functions/model_picture.hpp"
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libcdem/results/contact_points.hpp"
#include "libcdem/results/crack_surface.hpp"
#include "libcdem/vtk/block_marks.hpp"
#include "libcdem/vtk/field_values.hpp"
#include "libcdem/vtk/pieces.hpp"
#include "libcdem/vtk/section.hpp"
#include "libcdem/vtk/water_line.hpp"
#include "libcdem/vtk/without_bodies.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace cdem::script {

namespace {

namespace fs = std::filesystem;

void add_to_series(Session& session, ModelObject& model, const std::string& name, const fs::path& path,
                   const Snapshot& snapshot) {
  const fs::path series = session.files.to_write(name);
  auto& entries = model.series[series.string()];
  const std::string file = path.lexically_relative(series.parent_path()).generic_string();
  const auto same = [&](const SeriesEntry& e) { // .vtu or .pvtu
    return fs::path(e.file).replace_extension() == fs::path(file).replace_extension();
  };
  entries.erase(std::remove_if(entries.begin(), entries.end(), same), entries.end());
  entries.push_back({snapshot.time, snapshot.step, file});
  write_pvd(series.string(), entries);
}

// The path of a file of so many cells; of the pieces that it becomes where they are more than the limit each is allowed.
fs::path to_write(const Session& session, const std::string& name, std::size_t cells, std::size_t limit) {
  const std::size_t pieces = fs::path(name).extension() == ".vtu" ? number_of_pieces(cells, limit) : 1;
  if (pieces == 1)
    return session.files.to_write(name);
  session.files.to_write(list_of_pieces(name));
  for (std::size_t piece = 0; piece < pieces; ++piece)
    session.files.to_write(piece_path(name, piece));
  return session.files.would_write(name);
}

Value save(Session& session, ModelObject& model, const Arguments& a) {
  require_one_of(a.text("file"), {".vtu", ".vtkhdf"});
  if (a.has("series")) {
    require_ending(a.text("series"), ".pvd");
    if (fs::path(a.text("file")).extension() != ".vtu")
      throw geom::InputError(
          "file", describe(a.value("file")), "a name ending in .vtu",
          "ParaView's .pvd lists no .vtkhdf; it shows files x_1.vtkhdf, x_2.vtkhdf, ... as a series "
          "by their names");
  }
  if (session.settings.check_only)
    return {};
  const Snapshot snapshot = model.simulation.snapshot(model.title(session));
  const auto limit = static_cast<std::size_t>(a.integer("cells_per_file"));
  // A series is of one kind of file, so that ParaView shows each with its own fields.
  const auto add = [&](const char* what, const std::string& file) {
    if (!a.has("series"))
      return;
    const std::string& name = a.text("series");
    add_to_series(session, model, name.substr(0, name.size() - 4) + what + ".pvd", file, snapshot);
  };
  const std::string &name = a.text("file"), bonds = bonds_path(name), contacts = contacts_path(name),
                    water = water_path(name);
  add("", write_vtu(snapshot, to_write(session, name, snapshot.tets.size(), limit), limit));
  add("_bonds",
      write_bonds(snapshot, to_write(session, bonds, snapshot.bonds.triangles.size(), limit), limit));
  if (!model.simulation.model().surface.empty()) {
    const std::vector<ContactPoint> points =
        cdem::contact_points(model.simulation.model(), model.simulation.state());
    add("_contacts",
        write_contacts(points, snapshot, to_write(session, contacts, points.size(), limit), limit));
  }
  if (!snapshot.water.empty()) {
    const std::string path = session.files.to_write(water).string();
    write_water(snapshot, path);
    add("_water", path);
  }
  return {};
}

// make: returns the Snapshot whose bonds are written.
template <class Make>
Value save_surface(Session& session, ModelObject& model, const Arguments& a, const Make& make) {
  require_one_of(a.text("file"), {".vtp", ".vtu"});
  if (a.has("series"))
    require_ending(a.text("series"), ".pvd");
  if (session.settings.check_only)
    return {};
  const Snapshot surface = make();
  led_act("surface", [&] {
    const fs::path path = session.files.to_write(a.text("file"));
    write_surface(surface, path.string());
    if (a.has("series"))
      add_to_series(session, model, a.text("series"), path, surface);
  });
  return {};
}

Value save_cracks(Session& session, ModelObject& model, const Arguments& a) {
  return save_surface(session, model, a, [&] {
    return cdem::crack_surface(model.simulation.model(), model.simulation.state(),
                               model.simulation.log().breaks, a.flag("damaged"), model.title(session));
  });
}

Value save_joints(Session& session, ModelObject& model, const Arguments& a) {
  const JointChoice choice = joint_choice(model, a);
  return save_surface(session, model, a, [&] {
    return cdem::joint_surface(model.simulation.model(), model.simulation.state(), choice,
                               model.title(session));
  });
}

const Record<PictureOptions> model_view{
    {{number("deformation").standard().doc("displacements are drawn this many times larger; 0: undeformed"),
      &PictureOptions::deformation},
     {list("plain", text_type(), 0).doc("names of bodies that are drawn without colour, such as a floor")},
     {list("hidden", text_type(), 0).doc("names of bodies that are left out, such as a wall")},
     {number("opacity").within(0.05, 1).standard().doc(
          "of the blocks; below 1 broken interfaces inside show through"),
      &PictureOptions::opacity},
     {flag("edges").standard().doc("outlines of the blocks"), &PictureOptions::edges},
     {record("section", {vec3("point", "m").required(), vec3("normal").required()})
          .doc("a plane: the cut through the undeformed blocks is drawn in place of their faces")},
     {flag("arrows").standard(false).doc("displacement of the blocks that are shown")},
     {flag("crosses").standard(false).doc(
         "principal stresses of the blocks that are shown, pressure and tension in two colours")},
     {list("joint_sets", text_type(), 0).doc("with joints: the sets that are drawn; all when left out")},
     {flag("joints").standard(false).doc(
         "the joints alone, within the outline of the bodies, as lines where they are square to the picture; "
         "colour is then \"slip\", \"opening\", "
         "\"utilisation\", \"normal_traction\", \"shear_traction\", \"water_pressure\", \"mode\" or "
         "\"set\"")},
     {flag("bolts").standard(true).doc("bolts, drawn over the blocks and coloured by their tension")},
     {flag("water").standard(true).doc(
         "free surface of the water that loads the model (model:flow with water, and the level or table of "
         "model:water), as a transparent sheet that tints no coloured body, and the line where it cuts the "
         "bodies; in a section its line")},
     {flag("water_velocity")
          .standard(false)
          .doc("velocity of that water as arrows: on its free surface, or in the section where that is "
               "upright")},
     {flag("broken_bonds").standard().doc("broken interfaces, coloured by how they broke"),
      &PictureOptions::broken_bonds}}};

PictureOptions picture_options(const Arguments& a) {
  PictureOptions options = view_options(a);
  model_view.read(a, options);
  return options;
}

// Bolts over the blocks, coloured by the tension in four steps up to the largest.
void add_bolts(const Simulation& simulation, PictureOptions& options) {
  constexpr std::array<Colour, 4> colours{
      Colour{0.55, 0.55, 0.6}, {0.16, 0.5, 0.73}, {0.95, 0.65, 0.1}, {0.8, 0.1, 0.1}};
  const std::vector<Simulation::BoltRow> rows = simulation.bolts();
  double most = 0;
  for (const auto& row : rows)
    most = std::max(most, row.tension);
  for (std::size_t step = 0; step < colours.size(); ++step) { // the legend in the order of the tension
    bool told = most == 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (rows[i].bolt != rows[i - 1].bolt)
        continue;
      const double tension = std::max(0.0, 0.5 * (rows[i - 1].tension + rows[i].tension));
      const auto own = most > 0 ? std::min<std::size_t>(3, static_cast<std::size_t>(4 * tension / most)) : 0;
      if (own != step)
        continue;
      Polyline line;
      line.points = {rows[i - 1].place, rows[i].place};
      line.colour = colours[step];
      line.width = 5;
      if (!told)
        line.label = "bolts to " + three_digits(0.25e-3 * most * static_cast<double>(step + 1)) + " kN";
      told = true;
      options.polylines.push_back(std::move(line));
    }
  }
}

// Of all that is shown.
Snapshot without_hidden(const Snapshot& all, const std::vector<int>& hidden) {
  Snapshot shown = without_bodies(all, hidden);
  if (shown.tets.empty())
    throw geom::InputError("hidden: holds every body; leave one to draw");
  return shown;
}

void add_lines(const std::vector<Polyline>& lines, PictureOptions& options) {
  options.polylines.insert(options.polylines.end(), lines.begin(), lines.end());
}

void add_marks(const Snapshot& shown, const Arguments& a, PictureOptions& options) {
  if (a.flag("arrows"))
    add_lines(displacement_arrows(shown, options), options);
  if (a.flag("crosses"))
    add_lines(stress_crosses(shown, options), options);
}

Snapshot section_with_water(const Snapshot& all, const CutPlane& plane, PictureOptions& options) {
  Snapshot section = section_of(all, plane);
  add_lines(water_in_section(all.water, plane), options);
  add_lines(water_arrows_in(section, all.water), options);
  return section;
}

void require_together(const Arguments& a) {
  static const std::set<std::string> of_joints{"slip", "opening", "utilisation", "normal_traction",
                                               "shear_traction"};
  if (!a.flag("joints") && of_joints.count(a.text_or("colour", "")) > 0)
    throw geom::InputError(
        "colour", describe(a.value("colour")), "a field of blocks",
        "add joints = true, which draws the joints alone and knows this field; blocks have "
        "joint_slip and joint_utilisation");
  const auto section = a.record("section");
  if (a.flag("joints") && (section || a.flag("arrows") || a.flag("crosses") || !a.list("hidden").empty()))
    throw geom::InputError(
        "joints: draws the joints alone, without section, arrows, crosses or hidden; leave these out");
  if (section && !(section->vec3("normal").norm() > 0))
    throw geom::InputError("section.normal", geom::text(section->vec3("normal")), "a direction, not zero");
}

} // namespace

Value model_picture(Session& session, ModelObject& model, const Arguments& a) {
  require_drawing(a.text("file"));
  require_together(a);
  PictureOptions options = picture_options(a);
  const geom::Vec3 gravity = model.simulation.conditions().gravity.value_or(Gravity()).acceleration;
  if (!a.has("up") && std::abs(gravity.z()) > std::max(std::abs(gravity.x()), std::abs(gravity.y())))
    options.up = "z";
  for (const Value& body : a.list("plain"))
    options.plain.push_back(model.simulation.body_number(*body.get<std::string>(), "plain"));
  std::vector<int> hidden;
  for (const Value& body : a.list("hidden"))
    hidden.push_back(model.simulation.body_number(*body.get<std::string>(), "hidden"));
  WaterWish water;
  water.shown = a.flag("water") && !a.flag("joints") && !session.settings.check_only;
  water.velocity = a.flag("water_velocity");
  if (const auto section = a.record("section")) {
    water.point = section->vec3("point");
    water.normal = section->vec3("normal");
  }
  const bool inside = a.flag("joints") || a.record("section"); // else the surface is all that it shows
  const std::string title = session.settings.check_only ? "" : model.title(session);
  PictureWish wish;
  wish.field = options.field;
  wish.stress = a.flag("crosses");
  wish.broken_bonds = options.broken_bonds;
  wish.water = water;
  if (session.settings.check_only) {
    if (options.field.empty())
      return {};
    if (water.point)
      field_values(model.simulation.snapshot(title, WaterWish()), options.field);
    else if (!a.flag("joints"))
      field_values(without_hidden(model.simulation.picture_snapshot(wish, title), hidden), options.field);
    else if (model.simulation.counts().interfaces > 0) // others may come in a stage that cuts
      field_values(joints_of(model.simulation.joint_picture({a.texts("joint_sets"), Selection()}, title)),
                   options.field);
    return {};
  }
  // Every rank has its part in what is drawn, and the first draws it.
  if (a.flag("bolts"))
    add_bolts(model.simulation, options);
  const std::shared_ptr<void> whole = inside ? model.simulation.show_lead() : nullptr;
  const Snapshot surface = inside ? Snapshot() : model.simulation.picture_snapshot(wish, title);
  led_act("picture", [&] {
    Snapshot shown;
    if (a.flag("joints"))
      shown = joints_of(model.simulation.joint_picture({a.texts("joint_sets"), Selection()}, title));
    else if (water.point)
      shown = section_with_water(without_hidden(model.simulation.snapshot(title, water), hidden),
                                 {*water.point, water.normal}, options);
    else
      shown = without_hidden(surface, hidden);
    if (inside)
      options.broken_bonds = false;
    add_marks(shown, a, options);
    draw(session, a.text("file"), [&](const std::string& path) { render(shown, options, path); });
  });
  return {};
}

std::vector<Field> model_picture_fields() {
  std::vector<Field> fields = view_fields("field to colour by, e.g. \"displacement.x\", \"stress.yy\", "
                                          "\"von_mises\", \"block_id\", \"fragment\"; "
                                          "plain blocks when left out",
                                          "z where gravity acts along z, else y");
  std::vector<Field> own = model_view.fields();
  fields.insert(fields.begin() + 2, own.front()); // how it is deformed
  own.erase(own.begin());
  return fields + own;
}

void bind_output(Module& m) {
  Class& model = m.the_class("Model");
  model
      .add("save",
           "Writes the model for ParaView: the blocks to the file, the bonds beside it (result.vtu, "
           "result_bonds.vtu). Bodies that move far have a file of the contacts that carry "
           "(result_contacts.vtu: points with force on the source body, normal_force, shear_force, depth, "
           "bodies and blocks). Water that loads the model has a file of its free surface (result_water.vtu: "
           "velocity at corners).",
           {text("file").required().doc("ends in .vtu, or .vtkhdf for programs that read HDF5").output(),
            text("series").doc("ends in .pvd: a time series this file is added to; run.pvd has "
                               "run_bonds.pvd, run_contacts.pvd and run_water.pvd beside it. One axis: time "
                               "where it rises from file to file, else steps"),
            integer("cells_per_file")
                .at_least(1)
                .standard(static_cast<std::int64_t>(usual_cells_per_file))
                .doc("a .vtu of more cells is written in pieces, result/result_0.vtu, result/result_1.vtu, "
                     "..., and result.pvtu takes its place")},
           save)
      .by_rank_0();
  model.add("save_cracks",
            "Writes broken faces for ParaView as a surface, midway between their sides: displacement at "
            "corners; mode (1 tension, 2 shear), damage, opening, slip, time of the last break (nan where it "
            "is not known) and body (its number from 0; -1 between two) of faces.",
            {text("file").required().doc("ends in .vtp, or .vtu for programs that know no .vtp").output(),
             flag("damaged").standard(false).doc("faces that soften and have not broken too (mode 0)"),
             text("series").doc("ends in .pvd: a time series this file is added to")},
            save_cracks);
  std::vector<Field> joint_file{
      text("file").required().doc("ends in .vtp, or .vtu for programs that know no .vtp").output(),
      text("series").doc("ends in .pvd: a time series this file is added to")};
  for (const Field& field : joint_choice_fields())
    joint_file.push_back(field);
  model.add("save_joints",
            "Writes joints between blocks for ParaView as a surface: displacement at corners; set (number in "
            "the alphabetical order of all sets, from 1; 0: none), mode (0 bonded, 1 broken in tension, 2 in "
            "shear, 3 contact), normal_traction, shear_traction, water_pressure, utilisation, opening, slip "
            "and parted (1: left to contact) of faces.",
            joint_file, save_joints);
  model.add("picture", "Draws the model, without a display.", model_picture_fields(), model_picture);
}

} // namespace cdem::script
