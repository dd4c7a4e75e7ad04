// Checkpoints of a run as files: two in turn, so that one is whole whatever happens while the other is written.
#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/checkpoint/file.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/session/model_object.hpp"

#include <algorithm>
#include <array>

namespace cdem::script {

namespace fs = std::filesystem;

namespace {

struct Head {
  std::uint64_t run = 0;
  std::uint64_t serial = 0;
  std::string script, version;
  std::uint64_t script_hash = 0; // 0: of a script that failed and may be mended
  std::map<std::string, std::string> set;
  bool unsafe = false;
};

CDEM_ARCHIVE(Head, run, serial, script, version, script_hash, set, unsafe)

Head read_head(const std::string& content) {
  Reader a(content);
  Head head;
  archive(a, head);
  return head;
}

std::string name_of(std::uint64_t serial) {
  return serial % 2 == 1 ? "checkpoint_1.cdem" : "checkpoint_2.cdem";
}

} // namespace

CDEM_ARCHIVE(Checkpoints::SavedModel, number, saved, series)

CheckpointInfo newest_checkpoint(const fs::path& folder, std::uint64_t run) {
  CheckpointInfo newest;
  std::string wrong;
  for (const std::uint64_t turn : {1, 2}) {
    const fs::path file = folder / name_of(turn);
    std::error_code error;
    if (!fs::exists(file, error))
      continue;
    try {
      const Head head = read_head(read_saved(file, SavedKind::checkpoint));
      if (run != 0 && head.run != run)
        wrong = file.string() + ": of another run than the log beside it; nothing can go on from it here";
      else if (newest.file.empty() || head.serial > newest.serial)
        newest = {file, head.script, head.set, head.unsafe, head.serial};
    } catch (const FileError& bad) {
      wrong = bad.what();
    } catch (const geom::InputError& bad) {
      wrong = file.string() + ": " + bad.what();
    }
  }
  if (newest.file.empty())
    throw FileError(
        wrong.empty()
            ? folder.string() +
                  ": no checkpoint; one is written every few minutes and by Ctrl-C while a model is solved, "
                  "and taken away when a run has ended well"
            : wrong);
  return newest;
}

fs::path Checkpoints::path_of(std::uint64_t serial) const {
  return session_.files.output() / name_of(serial);
}

void Checkpoints::begin(const std::string& script_text) {
  keeps_ = !session_.settings.check_only && !session_.settings.script.empty();
  script_hash_ = fnv1a(script_text);
}

void Checkpoints::load(const fs::path& file, const std::string& script_text) {
  begin(script_text);
  const std::string content =
      led_bytes("checkpoint", [&] { return read_saved(file, SavedKind::checkpoint); });
  Reader a(content);
  Head head;
  std::string journal;
  archive_all(a, head, elapsed_before_, session_.warnings, journal, models_);
  mended_ = head.script_hash == 0;
  if (!mended_ && head.script_hash != script_hash_)
    throw geom::InputError(
        "has changed since its checkpoint was written; put it back as it was, or start over "
        "with cdem run");
  if (head.set != session_.settings.set)
    throw geom::InputError("resume: other --set values than when the checkpoint was written");
  serial_ = head.serial;
  from_ = file;
  if (ranks().leads())
    from_time_ = fs::last_write_time(file);
  resumed_ = replaying_ = true;
  journal_.load(std::move(journal));
  if (!journal_.replaying())
    go_live();
}

void Checkpoints::go_live() {
  if (!replaying_)
    return;
  for (SavedModel& model : models_) {
    const auto index = static_cast<std::size_t>(model.number - 1);
    const auto object = index < session_.models.size() ? session_.models[index].lock() : nullptr;
    if (!object)
      continue; // nothing holds it any more
    try {
      object->simulation.restore(model.saved);
    } catch (const geom::InputError& error) {
      refuse("resume: model " + std::to_string(model.number) + ": " + error.what());
    }
    for (auto& [file, entries] : model.series)
      for (auto& [moment, name] : entries)
        object->series[(session_.files.output() / file).string()].push_back(
            {moment.first, moment.second, name});
  }
  models_.clear();
  std::array<std::int64_t, 2> broken{};
  for (const auto& known : session_.models)
    if (const auto object = known.lock()) {
      object->simulation.set_replaying(false);
      broken[0] += object->simulation.log().told_tension;
      broken[1] += object->simulation.log().told_shear;
    }
  if (session_.settings.observer)
    session_.settings.observer->goes_on(broken[0], broken[1],
                                        static_cast<std::int64_t>(session_.warnings.size()));
  replaying_ = false;
  kept_ = journal_.size();
  last_ = std::chrono::steady_clock::now();
  session_.message("goes on from " + from_.string() +
                   (session_.stages.empty() ? "" : ", stage " + std::to_string(session_.stages.size())));
}

bool Checkpoints::wanted() {
  const double minutes = session_.settings.checkpoint_minutes;
  if (minutes <= 0)
    return false;
  const bool due =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - last_).count() >= 60 * minutes;
  constexpr int asked_each = 8; // the ranks agree now and then only: it takes a message
  if (!with_others())
    return due;
  return ++asked_wanted_ % asked_each == 0 && agreed(due && ranks().leads() ? 1 : 0) > 0;
}

std::string Checkpoints::content(std::size_t journal_size, std::uint64_t script_hash) const {
  Head head;
  head.run = session_.settings.run;
  head.serial = serial_ + 1;
  head.script = fs::absolute(session_.settings.script).lexically_normal().string();
  head.version = CDEM_VERSION;
  head.script_hash = script_hash;
  head.set = session_.settings.set;
  head.unsafe = session_.settings.unsafe;
  std::vector<SavedModel> models;
  for (const auto& known : session_.models)
    if (const auto object = known.lock()) {
      SavedModel saved;
      saved.number = object->number;
      saved.saved = object->simulation.save();
      for (const auto& [path, entries] : object->series) {
        saved.series.push_back({fs::path(path).lexically_relative(session_.files.output()).string(), {}});
        for (const SeriesEntry& entry : entries)
          saved.series.back().second.emplace_back(std::pair(entry.time, entry.step), entry.file);
      }
      models.push_back(std::move(saved));
    }
  const std::string journal = journal_.text(journal_size);
  Writer a;
  archive_const(a, head);
  archive_const(a, session_.elapsed());
  archive_const(a, session_.warnings);
  archive_const(a, journal);
  archive_const(a, models);
  return a.take();
}

bool Checkpoints::put(const std::string& content) {
  const std::uint64_t serial = serial_ + 1;
  const std::string name = name_of(serial);
  last_ = std::chrono::steady_clock::now();
  try {
    write_saved(session_.files.to_write(name), SavedKind::checkpoint, content);
  } catch (const FileError& error) {
    session_.warn(std::string("no checkpoint: ") + geom::plain_reason(error));
    return false;
  }
  written_.insert(name);
  serial_ = serial;
  last_ = std::chrono::steady_clock::now();
  return true;
}

std::string Checkpoints::command() const {
  return resume_command(session_.settings.output, session_.settings.unsafe);
}

void Checkpoints::gather_models() {
  for (const auto& known : session_.models)
    if (const auto object = known.lock())
      object->simulation.gather_to_save();
}

void Checkpoints::write(bool stopping) {
  if (!may_write() || flags_.in_call || stages_ == 0)
    return;
  stopped_ = stopping;
  if (with_others()) // else Lua is busy in a callback, before which they were gathered
    gather_models();
  const Doing saves(session_.settings.observer.get(), Activity::saving);
  const Value put_down = led("checkpoint", [&]() -> Value {
    return put(content(flags_.in_stage ? mark_ : journal_.size(), script_hash_));
  });
  last_ = std::chrono::steady_clock::now();
  if (!*put_down.get<bool>())
    return;
  if (stopping || !told_)
    session_.message("checkpoint; to go on: " + command());
  told_ = true;
}

void Checkpoints::keep_before_call() {
  if (!may_write())
    return;
  led_act("checkpoint", [&] { put(content(journal_.size(), script_hash_)); });
  swept_ = true;
}

bool Checkpoints::is_of_stopped_run(const fs::path& file) const {
  std::error_code error;
  const auto time = fs::last_write_time(file, error);
  return resumed_ && !error && time >= from_time_;
}

void Checkpoints::keep_unfinished() {
  if (!may_write() || !flags_.in_stage || !(solved_ > 0 || resumed_ || mark_steps_ > begin_steps_))
    return;
  gather_models();
  if (ranks().leads())
    unfinished_ = content(mark_, 0);
}

void Checkpoints::fail() {
  led_act("checkpoint", [&] { keep_solved(); });
}

void Checkpoints::keep_solved() {
  if (!may_write() || !refused_.empty())
    return;
  const Doing saves(session_.settings.observer.get(), Activity::saving);
  try {
    if (unfinished_.empty()) {
      if (failed_stage_ || (solved_ == 0 && !swept_ && !resumed_))
        return;
      unfinished_ = content(kept_, 0);
    }
    if (put(unfinished_))
      session_.message("what was solved is kept: mend the script, then go on with " + command());
  } catch (const std::exception& error) { // that of the script matters more
    session_.warn(std::string("no checkpoint: ") + geom::plain_reason(error));
  }
}

void Checkpoints::stop() {
  write(true);
}

void Checkpoints::stop_in_call() {
  if (ranks().alone())
    flags_.in_call = false;
  write(true);
}

void Checkpoints::stop_if_wanted() {
  const auto& observer = session_.settings.observer;
  if (!observer || !observer->stop_requested())
    return;
  stop();
  throw Interrupted();
}

void Checkpoints::end() {
  if (!refused_.empty())
    throw geom::InputError(refused_);
  if (replaying_)
    refuse("resume: the script ends before it comes to where its checkpoint was written; has a file that it "
           "reads "
           "changed? Start over with cdem run");
  if (ranks().leads() && (resumed_ || !written_.empty()))
    for (const std::uint64_t turn : {1, 2}) {
      std::error_code none;
      fs::remove(path_of(turn), none);
    }
}

} // namespace cdem::script
