// What a long run tells while it goes on, and how it is asked to stop.
#pragma once

#include <cstdint>
#include <string>

namespace cdem {

struct Snapshot;

struct Progress {
  int stage = 0;                   // number of the solving call, from 1
  std::string kind;                // "relax", "run", ...
  std::string note;                // of the stage's own, "flow 12.3 m/s"
  bool trial = false;              // one of a search: what breaks in it does not break in the model
  std::string counts = "step";     // what steps are: "run" of a sweep, "unit" laid
  bool preparing = false;          // nothing is solved yet, results of an earlier run stand
  std::int64_t step = 0;           // within the stage
  std::int64_t max_steps = 0;      // limit, 0 when there is none
  double residual = 0;             // out-of-balance force norm over applied force norm
  double residual_goal = 0;        // 0 when the stage has none
  double kinetic_ratio = 0;        // kinetic energy over its peak, of a stage that waits for rest
  double kinetic_ratio_goal = 0;   // 0 when the stage does not
  double time = 0;                 // s, real-time stages
  double time_start = 0;           // s, when the stage began
  double time_goal = 0;            // s, 0 when the stage has none
  std::int64_t broken_tension = 0; // spring points broken so far in this stage
  std::int64_t broken_shear = 0;
  double steps_per_second = 0;
  double wall_time =
      0;             // s, of the stage so far; of a resumed one before it was stopped too, as its steps are
  bool last = false; // the stage ends here
  std::string times; // "elements 71 %, bonds 20 %", of the last: where the time of its steps went
};

// What the thread that runs a script is about, for who waits for it to stop: a stage comes to a step, what is saved
// comes to its end, as does a model that becomes another one, and anything else may take for ever.
enum class Activity { script, stage, saving, changing };

class Observer {
public:
  virtual ~Observer() = default;
  // Called at the first and last step of a stage and about ten times a second in between, from the calling thread.
  virtual void progress(const Progress&) {}
  // A line for the log: what the script prints, results of a stage.
  virtual void message(const std::string&) {}
  // A line that a user must see even of a quiet run.
  virtual void warning(const std::string& line) { message(line); }
  // The same of the machine or the ranks: it belongs to no report, which is the same for every number of them.
  virtual void warning_of_machine(const std::string& line) { warning(line); }
  // What an earlier run came to that this one goes on from: spring points broken in stages that had ended, warnings.
  virtual void goes_on(std::int64_t /*broken_tension*/, std::int64_t /*broken_shear*/,
                       std::int64_t /*warnings*/) {}
  // Asked every few steps; true: view() is given what a picture shows of the model as it is. Looking changes no bit.
  // Several ranks must be told the same, since all of them give their share.
  virtual bool wants_view() { return false; }
  virtual std::string wanted_field() { return ""; } // "stress.xx"; of several ranks the first is asked
  virtual void view(const Snapshot&) {}
  // Polled every few steps: true ends the stage cleanly by throwing Interrupted.
  virtual bool stop_requested() { return false; }
  // Gives back what it was about before.
  virtual Activity doing(Activity) { return Activity::script; }
};

// Tells an observer, which may be null, for as long as it lives.
class Doing {
public:
  Doing(Observer* observer, Activity now)
      : observer_(observer), before_(observer ? observer->doing(now) : Activity::script) {}
  ~Doing() {
    if (observer_)
      observer_->doing(before_);
  }
  Activity before() const { return before_; }
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

private:
  Observer* observer_;
  Activity before_;
};

} // namespace cdem
