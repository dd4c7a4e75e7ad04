// Films: of pictures that a script has drawn, and of a model while it is solved.
//
// The frames of a film are one of the model's series, by the name of the film, so that a checkpoint keeps them. A frame is
// named by the model's steps: a stage that is resumed takes those since its checkpoint again, under the same names.
#include "lua/binding/functions/films.hpp"
#include "lua/binding/functions/model_picture.hpp"
#include "lua/binding/functions/picture_fields.hpp"
#include "lua/binding/module/module.hpp"

#include "libcdem/vtk/film.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem::script {

namespace {

using geom::InputError;

void require_film(const std::string& file) {
  require_one_of(file, {".ogv", ".mp4"});
}

std::string frames_folder(const std::string& file) {
  return file.substr(0, file.rfind('.'));
}

Value film_of_pictures(Session& session, Object*, const Arguments& a) {
  require_film(a.text("file"));
  if (session.settings.check_only)
    return {};
  std::vector<std::string> frames;
  for (const Value& frame : a.list("frames"))
    frames.push_back(session.files.to_read(*frame.get<std::string>()).string());
  write_film(frames, a.count("frames_per_second"), session.files.to_write(a.text("file")).string());
  return {};
}

// As many decimals as multiples of the interval have.
std::string time_text(double time, double interval) {
  int decimals = 0;
  for (double part = interval; decimals < 6 && std::abs(part - std::round(part)) > 1e-6 * part; part *= 10)
    ++decimals;
  char text[64];
  std::snprintf(text, sizeof text, "t = %.*f s", decimals, time);
  return text;
}

void take_frame(Session& session, ModelObject& model, const Film& film) {
  const Simulation& simulation = model.simulation;
  char number[32];
  std::snprintf(number, sizeof number, "/%09lld.png", static_cast<long long>(simulation.steps()));
  const std::string name = frames_folder(film.file) + number;
  auto frame = std::make_shared<Table>();
  for (const Field& field : model_picture_fields())
    if (film.frame.has(field.name))
      frame->named[field.name] = film.frame.value(field.name);
  frame->named["file"] = name;
  if (!film.frame.has("title"))
    frame->named["title"] = film.when.steps > 0 ? "step " + std::to_string(simulation.steps())
                                                : time_text(simulation.time(), film.when.seconds);
  if (const geom::Box box = simulation.model().box; !film.frame.has("fit") && !film.frame.has("camera"))
    frame->named["fit"] = box;
  model_picture(session, model, Arguments(frame));
  auto& frames = model.series[session.files.would_write(film.file).string()];
  const auto same = [&](const SeriesEntry& entry) { return entry.file == name; };
  frames.erase(std::remove_if(frames.begin(), frames.end(), same), frames.end());
  frames.push_back({simulation.time(), simulation.steps(), name});
}

Value film_of_model(Session& session, ModelObject& model, const Arguments& a) {
  model.require_idle("film");
  require_film(a.text("file"));
  if (a.has("every") == a.has("steps"))
    throw InputError("every, steps: give one of them: seconds of the model, or steps between frames");
  if (a.numbers("size").back() == 0)
    throw InputError("size", describe(a.value("size")), "a width and a height, which all frames share");
  for (const auto& other : session.filmed)
    for (const Film& taken : other->films)
      if (frames_folder(taken.file) == frames_folder(a.text("file")))
        throw InputError("file", describe(a.value("file")),
                         "another name than that of a film that is taken already");
  Film film{a.text("file"), a, {}, a.count("frames_per_second")};
  film.when.steps = a.has("steps") ? a.integer("steps") : 0;
  film.when.seconds = a.optional_number("every").value_or(0);
  if (!session.checkpoints.replaying())
    take_frame(session, model, film);
  if (session.settings.check_only)
    return {};
  model.films.push_back(film);
  if (model.films.size() == 1)
    session.filmed.push_back(session.held(model));
  return {};
}

std::vector<Field> film_fields() {
  std::vector<Field> fields = model_picture_fields();
  fields.front() = text("file").required().doc("ends in .ogv, or in .mp4 where ffmpeg is installed").output();
  for (Field& field : fields)
    if (field.name == "deformation")
      field.standard(1.0);
    else if (field.name == "fit")
      field.doc("a box that all frames show: that of the undeformed model when left out");
    else if (field.name == "size")
      field.doc("{width, height} in pixels");
    else if (field.name == "title")
      field.doc("the time or the step when left out");
  fields.insert(fields.begin() + 1,
                {number("every", "s").above(0).doc("of the model, between frames; relaxations take none"),
                 integer("steps").at_least(1).doc("instead: steps between frames, in relaxations too"),
                 integer("frames_per_second").within(1, 120).standard(12)});
  return fields;
}

} // namespace

std::vector<TimedLook> film_looks(Session& session, ModelObject& model) {
  std::vector<TimedLook> looks;
  for (const Film& film : model.films) {
    looks.push_back(film.when);
    looks.back().look = [&session, &model, film] { take_frame(session, model, film); };
  }
  return looks;
}

void bind_films(Module& m) {
  m.the_class("Model")
      .add("film",
           "Takes a film while the model is solved: a picture now and every so often in the stages that "
           "follow "
           "(model:run, relax and settle). The film is written when the script ends, fails or is stopped, "
           "and goes on "
           "when it is resumed; its frames stay in a folder of its name. Give `range` where colours show a "
           "field, so "
           "that they mean the same in all frames.",
           film_fields(), film_of_model)
      .replayed(Replay::again);
  m.add("film", "A film from pictures of one size: Ogg/Theora, or H.264 by the program ffmpeg.",
        {text("file").required().doc("ends in .ogv, or in .mp4 where ffmpeg is installed").output(),
         list("frames", text_type()).required().doc("names of the pictures, in order"),
         integer("frames_per_second").within(1, 120).standard(12)},
        film_of_pictures)
      .replayed(Replay::recorded)
      .by_rank_0();
}

} // namespace cdem::script
