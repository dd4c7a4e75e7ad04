// Calls through the journal.
#include "lua/binding/session/replay.hpp"

#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/stop.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/session/session.hpp"

namespace cdem::script {

class Checkpoints::With {
public:
  With(Checkpoints& owner, Flags flags) : owner_(owner), before_(owner.flags_) { owner.flags_ = flags; }
  ~With() { owner_.flags_ = before_; }
  With(const With&) = delete;
  With& operator=(const With&) = delete;

private:
  Checkpoints& owner_;
  Flags before_;
};

namespace {

using Outcome = Event::Outcome;

// Runs body; an error that a script could catch is noted in the event and thrown on.
template <class Record>
Value noted(Event event, const std::function<Value()>& body, const Record& record) {
  const auto failed = [&](Outcome outcome, const std::exception& error) {
    event.outcome = outcome;
    event.value = std::string(error.what());
    record(event);
  };
  try {
    event.value = body();
  } catch (const SolutionError& error) {
    failed(Outcome::solution_error, error);
    throw;
  } catch (const ScriptError& error) {
    failed(Outcome::script_error, error);
    throw;
  } catch (const FileError& error) {
    failed(Outcome::file_error, error);
    throw;
  } catch (const geom::InputError& error) {
    failed(Outcome::input_error, error);
    throw;
  }
  record(event);
  return event.value;
}

const std::string require_name = "require ";

void throw_if_failed(const Event& event) {
  if (event.outcome == Outcome::value || event.outcome == Outcome::object)
    return;
  const auto* const said = event.value.get<std::string>();
  const std::string text = said ? *said : "failed as when its checkpoint was written";
  if (event.outcome == Outcome::solution_error)
    throw SolutionError(text);
  if (event.outcome == Outcome::script_error)
    throw ScriptError(text);
  if (event.outcome == Outcome::file_error)
    throw FileError(text);
  throw geom::InputError(text);
}

} // namespace

void Checkpoints::refuse(const std::string& text) {
  refused_ = text;
  throw geom::InputError(text);
}

void Checkpoints::went_another_way(const std::string& now, const Event& then) {
  refuse("resume: the script goes another way than when its checkpoint was written: it comes to " + now +
         (now == then.name ? " with other values" : " where it came to " + then.name + " then") +
         (mended_ ? "; what it did before it failed must stay as it was, or start over with cdem run"
                  : "; has a file that it reads changed? Start over with cdem run"));
}

Event Checkpoints::take() {
  Event event = journal_.take();
  if (!journal_.replaying() && !in_replayed_callback_)
    go_live();
  return event;
}

void Checkpoints::record(const Event& event) {
  journal_.record(event);
  unfinished_.clear();
  failed_stage_ = false;
}

// A stage that failed after some steps has left its model somewhere between: a mended script cannot begin it again.
void Checkpoints::record_end(const Event& end) {
  const bool well = end.outcome == Outcome::value, moved = steps() != begin_steps_;
  if (well) {
    record(end);
    ++solved_;
  } else {
    journal_.record(end);
    failed_stage_ = moved && end.outcome != Outcome::solution_error; // that one the script has caught
  }
  if (well || moved)
    kept_ = journal_.size();
}

std::int64_t Checkpoints::steps() const {
  std::int64_t sum = 0;
  for (const auto& known : session_.models)
    if (const auto object = known.lock())
      sum += object->simulation.steps();
  return sum;
}

Value Checkpoints::call(const std::string& name, Replay replay, int model,
                        const std::function<std::uint64_t()>& hash, const std::function<Value()>& body) {
  if (!refused_.empty())
    throw geom::InputError(refused_);
  if (!keeps_ || flags_.paused || replay == Replay::never)
    return body();
  Value result;
  try {
    result = recorded(name, replay, model, hash, body);
  } catch (const Interrupted&) { // by a function of the script that the call was given
    stop();
    throw;
  } catch (const geom::Stopped&) {
    stop();
    throw;
  }
  if (asked_) {
    asked_ = false;
    write(false);
  }
  if (!with_others() && !replaying_) // several ranks, for which it takes a message, look when a stage begins
    stop_if_wanted();
  return result;
}

Value Checkpoints::recorded(const std::string& name, Replay replay, int model,
                            const std::function<std::uint64_t()>& hash, const std::function<Value()>& body) {
  const With inside(*this, {true, true, flags_.in_stage});
  const Doing completes(session_.settings.observer.get(), Activity::saving);
  Event event;
  event.name = name;
  if (journal_.replaying()) {
    const Event then = journal_.peek();
    if (then.kind == Event::Kind::stage && model > 0 && name == "model:" + then.name) {
      flags_.paused = false;
      return body(); // comes to stage()
    }
    event.hash = hash();
    const bool mended_source = mended_ && name.rfind(require_name, 0) == 0;
    if (then.kind != Event::Kind::call || then.name != name || (then.hash != event.hash && !mended_source))
      went_another_way(name, then);
    take();
    throw_if_failed(then);
    if (then.outcome == Outcome::object)
      return body();
    if (replay == Replay::again)
      body();
    return then.value;
  }
  event.hash = hash();
  const int stages = stages_;
  keep_call_ = replay == Replay::again;
  Value result = noted(event, body, [&](const Event& done) {
    if (stages_ != stages)
      return;
    record(done);
    const bool well = done.outcome == Outcome::value || done.outcome == Outcome::object;
    if (well && keep_call_)
      kept_ = journal_.size();
  });
  if (journal_.full() && !told_full_) {
    told_full_ = true;
    session_.warn("from now on there are no checkpoints: the script has read too much from its models to "
                  "keep it all; read less in callbacks");
  }
  return result;
}

void Checkpoints::source(const std::string& name, const std::string& text) {
  call(
      require_name + name, Replay::recorded, 0, [&] { return fnv1a(text); }, [] { return Value(); });
}

Values Checkpoints::call_back(const std::string& name, const Reference& function, const Values& arguments) {
  if (!keeps_)
    return function.call(arguments);
  Event event;
  event.kind = Event::Kind::callback;
  event.name = name;
  event.value = Table::list(arguments);
  record(event);
  if (with_others() && may_write() && flags_.in_stage) // it may be busy when the user wants to stop
    gather_models();
  try {
    const With listening(*this, {false, false, flags_.in_stage});
    return function.call(arguments);
  } catch (const ScriptError&) {
    keep_unfinished();
    throw;
  } catch (const FileError&) {
    keep_unfinished();
    throw;
  }
}

void Checkpoints::listen(const std::function<void()>& body) {
  const With listening(*this, {false, false, flags_.in_stage});
  body();
}

Value Checkpoints::solve_recorded(const std::string& kind, const std::function<Value()>& solve) {
  const With inside(*this, {false, true, true});
  mark_ = journal_.size();
  begin_steps_ = mark_steps_ = steps();
  stop_if_wanted(); // stages may be shorter than the steps between looks
  if (wanted())
    write(false);
  Event end;
  end.kind = Event::Kind::stage_end;
  end.name = kind;
  try {
    return noted(end, solve, [&](const Event& done) { record_end(done); });
  } catch (const Interrupted&) {
    stopped_ = true; // the model is no longer where the stage can be left
    throw;
  }
}

Value Checkpoints::stage(const std::string& kind, std::uint64_t hash, const Callbacks& callbacks,
                         const std::function<Value()>& solve) {
  if (!keeps_)
    return solve();
  ++stages_;
  if (!journal_.replaying()) {
    Event begin;
    begin.kind = Event::Kind::stage;
    begin.name = kind;
    begin.hash = hash;
    record(begin);
    return solve_recorded(kind, solve);
  }
  const Event then = take();
  if (then.kind != Event::Kind::stage || then.name != kind || then.hash != hash)
    went_another_way("model:" + kind, then);
  while (journal_.replaying()) {
    if (journal_.peek().kind != Event::Kind::callback) {
      const Event end = take();
      if (end.kind != Event::Kind::stage_end)
        went_another_way("the end of model:" + kind, end);
      throw_if_failed(end);
      return end.value;
    }
    in_replayed_callback_ = true;
    const Event called = take();
    const auto callback = callbacks.find(called.name);
    if (callback == callbacks.end() || !callback->second || !called.value.table())
      went_another_way("model:" + kind, called);
    try {
      const With listening(*this, {false, false, true});
      callback->second->call(called.value.table()->items);
    } catch (const ScriptError&) { // it ended the stage, which comes next
      in_replayed_callback_ = false;
      const bool then_too = journal_.replaying() && journal_.peek().kind == Event::Kind::stage_end;
      if (!refused_.empty() || (mended_ && !then_too))
        throw;
    }
    in_replayed_callback_ = false;
  }
  go_live();
  return solve_recorded(kind, solve);
}

} // namespace cdem::script
