#include "lua/binding/session/session.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem::script {

namespace {

std::filesystem::path output_folder(const EngineSettings& settings) {
  return settings.output.empty() ? std::filesystem::path("results") : settings.output;
}

// examples/plate/case.lua is the case "plate", examples/plate/coarse.lua "plate-coarse".
std::string case_name(const std::filesystem::path& script, const std::filesystem::path& output) {
  if (script.empty())
    return output.filename().string();
  const std::string folder =
      std::filesystem::absolute(script).lexically_normal().parent_path().filename().string();
  const std::string stem = script.stem().string();
  return stem == "case" ? folder : folder + "-" + stem;
}

const std::string warning_head = "warning: ";

class ObserverOfModels final : public Observer {
public:
  explicit ObserverOfModels(Session& session)
      : session_(session),
        to_(session.settings.observer ? session.settings.observer : std::make_shared<Observer>()) {}

  void progress(const Progress& now) override { to_->progress(now); }
  void message(const std::string& line) override { to_->message(line); }
  void warning(const std::string& line) override {
    session_.warn(line.rfind(warning_head, 0) == 0 ? line.substr(warning_head.size()) : line);
  }
  void warning_of_machine(const std::string& line) override { to_->warning_of_machine(line); }
  void goes_on(std::int64_t tension, std::int64_t shear, std::int64_t warnings) override {
    to_->goes_on(tension, shear, warnings);
  }
  bool wants_view() override { return to_->wants_view(); }
  std::string wanted_field() override { return to_->wanted_field(); }
  void view(const Snapshot& snapshot) override { to_->view(snapshot); }
  bool stop_requested() override { return to_->stop_requested(); }
  Activity doing(Activity now) override { return to_->doing(now); }

private:
  Session& session_;
  std::shared_ptr<Observer> to_;
};

} // namespace

Session::Session(EngineSettings given)
    : settings(std::move(given)), files(settings.script, output_folder(settings), settings.results,
                                        settings.unsafe, settings.sources.parent_path()) {
  files.will_write = settings.will_write;
  report.case_name = case_name(settings.script, files.output());
}

double Session::elapsed() const {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start;
  return checkpoints.elapsed_before() + since.count();
}

void Session::message(const std::string& line) const {
  if (checkpoints.silent() || (settings.check_only && !stages.empty()))
    return; // shown before; figures made of the empty results of solving calls
  if (settings.observer)
    settings.observer->message(line);
  else
    std::printf("%s\n", line.c_str());
}

bool Session::take_warning(const std::string& line) {
  // Told before, or among the warnings of the checkpoint.
  if (checkpoints.silent() || std::find(warnings.begin(), warnings.end(), line) != warnings.end())
    return false;
  warnings.push_back(line);
  return true;
}

std::shared_ptr<Observer> Session::observer_of_models() {
  return std::make_shared<ObserverOfModels>(*this);
}

void Session::warn(const std::string& text) {
  const std::string place = where ? where() : std::string();
  const std::string line = (place.empty() ? "" : place + ": ") + warning_head + text;
  if (!take_warning(line))
    return;
  if (settings.observer)
    settings.observer->warning(line);
  else
    std::fprintf(stderr, "%s\n", line.c_str());
}

std::shared_ptr<ModelObject> Session::held(const ModelObject& model) const {
  for (const auto& known : models)
    if (auto object = known.lock(); object.get() == &model)
      return object;
  return nullptr;
}

void Session::write_films() {
  const Doing saves(settings.observer.get(), Activity::saving);
  for (const auto& model : filmed)
    try {
      model->write_films(*this);
    } catch (const std::exception& error) {
      warn(std::string("film: ") + geom::plain_reason(error));
    }
}

void Session::write_report() {
  if (settings.check_only)
    return;
  report.warnings = warnings;
  report.relaxations.clear();
  for (const Stage& stage : stages)
    if (const Table* result = stage.result.table(); result && stage.kind == "relax") {
      Table row{{"stage", stage.number}, {"model", stage.model}};
      for (const char* const kept : {"verdict", "steps", "residual", "trial"})
        if (const auto found = result->named.find(kept); found != result->named.end())
          row.named.insert(*found);
      report.relaxations.push_back(std::move(row));
    }
  led_act("report", [&] {
    write_file(files.to_write("report.json"), report.json());
    write_file(files.to_write("report.md"), report.markdown());
  });
}

void Session::check_set_names() const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters)
    names.push_back(p.info.name);
  for (const auto& [name, value] : settings.set) {
    if (std::find(names.begin(), names.end(), name) != names.end())
      continue;
    throw geom::InputError("--set " + name + "=" + value + ": the script has no such parameter" +
                           (names.empty() ? "; it declares none" : which_there_are(name, names, "Declared")));
  }
}

} // namespace cdem::script
