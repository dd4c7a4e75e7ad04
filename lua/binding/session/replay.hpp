// Passes the calls of a script through the journal, and keeps the data of a session for its checkpoints.
#pragma once

#include "lua/binding/replay/journal.hpp"
#include "lua/binding/session/settings.hpp"

#include "libcdem/step/checkpoint_writer.hpp"

#include <chrono>
#include <functional>
#include <set>

namespace cdem::script {

struct Session;

class Checkpoints final : public CheckpointWriter {
public:
  explicit Checkpoints(Session& session) : session_(session) {}

  // Takes the journal of the file and begins to replay. Throws FileError; InputError when the script has changed.
  void load(const std::filesystem::path& file, const std::string& script_text);
  void begin(const std::string& script_text); // of a run from the start

  bool keeps() const { return keeps_; } // calls are recorded
  bool replaying() const { return replaying_; }
  bool resumed() const { return resumed_; }
  // Nothing is shown: what is replayed was shown before.
  bool silent() const { return replaying_; }
  double elapsed_before() const { return elapsed_before_; } // s, of the runs that this one goes on from

  // One call of the script: recorded, or answered from the journal. number: of the model it is called on, 0: none.
  Value call(const std::string& name, Replay, int model, const std::function<std::uint64_t()>& hash,
             const std::function<Value()>& body);
  // A piece of source that the script loads; when replayed it must be the same.
  void source(const std::string& name, const std::string& text);
  // A stage: `solve` runs it, callbacks by the names under which call_back recorded them.
  using Callbacks = std::map<std::string, std::shared_ptr<Reference>>;
  Value stage(const std::string& kind, std::uint64_t hash, const Callbacks&,
              const std::function<Value()>& solve);
  // A callback of the running stage.
  Values call_back(const std::string& name, const Reference&, const Values& arguments);
  // Lua code of the script that is called between stages: what it calls is recorded.
  void listen(const std::function<void()>& body);

  void ask() { asked_ = true; } // model:checkpoint: after the running call
  // The running call may have changed a model, or has solved something: a mended script does not do it again.
  void keep_call() { keep_call_ = true; }

  // Writes a checkpoint of before the running call, which keeps by itself what of it has been done.
  void keep_before_call();
  // A file of the run that was stopped, not of an earlier one: it was written since the checkpoint.
  bool is_of_stopped_run(const std::filesystem::path& file) const;
  std::string command() const; // by which the user goes on

  void marked() override {
    mark_ = journal_.size();
    mark_steps_ = steps();
  }
  bool wanted() override;
  void write(bool stopping) override;
  // The user wants to stop and Lua is running: writes one, where a call is running once it has been left.
  void stop();
  void stop_in_call(); // from another thread: the script hangs in Lua, where no call has changed anything yet
  // The script has ended with an error: writes one from which it goes on when it has been mended, if something was
  // solved. It is of the end of the last stage, or where the stage can be left in which a callback has failed.
  void fail();
  // The script has ended: all that was to be replayed must have been. A finished run needs no checkpoint any more.
  void end();

private:
  struct Flags {
    bool in_call = false; // of anything but a stage: a checkpoint would be of half a call
    bool paused = false;  // calls go past the journal
    bool in_stage = false;
  };
  class With; // sets the flags for a while

  Event take();
  void go_live();
  void record(const Event&);
  void record_end(const Event&); // of a stage
  std::int64_t steps() const;    // of all models so far
  bool may_write() const { return keeps_ && !replaying_ && !journal_.full() && !stopped_; }
  // A checkpoint of now; script_hash 0: the script may have changed when it goes on.
  std::string content(std::size_t journal_size, std::uint64_t script_hash) const;
  void gather_models();                 // to rank 0, before it writes
  bool put(const std::string& content); // false: it could not be written, as the user was told
  void keep_unfinished();               // of the running stage, in which a callback has failed
  void keep_solved();                   // what fail() writes
  [[noreturn]] void went_another_way(const std::string& now, const Event& then);
  [[noreturn]] void refuse(const std::string& text);
  Value recorded(const std::string& name, Replay, int model, const std::function<std::uint64_t()>& hash,
                 const std::function<Value()>& body);
  void stop_if_wanted(); // Interrupted
  Value solve_recorded(const std::string& kind, const std::function<Value()>& solve);
  std::filesystem::path path_of(std::uint64_t serial) const;

  Session& session_;
  Journal journal_;
  Flags flags_;
  bool keeps_ = false, replaying_ = false, resumed_ = false, in_replayed_callback_ = false, asked_ = false;
  bool stopped_ = false, told_ = false, told_full_ = false, keep_call_ = false, mended_ = false;
  std::size_t mark_ = 0; // of the journal, where the running stage can be left
  // Steps of all models when the running stage began, and where it can be left.
  std::int64_t begin_steps_ = 0, mark_steps_ = 0;
  std::size_t kept_ = 0;   // of the journal, behind the last call that is not done again by a mended script
  std::string unfinished_; // checkpoint of a stage that a callback has ended, until the script goes on
  bool failed_stage_ = false; // the last event: a stage that moved its model and that its script ended
  int stages_ = 0;            // begun so far
  int solved_ = 0;            // ended well
  bool swept_ = false;        // or a call that keeps by itself what it has done
  int asked_wanted_ = 0;
  std::uint64_t serial_ = 0, script_hash_ = 0;
  double elapsed_before_ = 0;
  std::string refused_; // once a replay has failed, every further call fails with it
  struct SavedModel {
    int number = 0;
    std::string saved;
    using SavedFile = std::pair<std::pair<double, std::int64_t>, std::string>; // time, step, name
    std::vector<std::pair<std::string, std::vector<SavedFile>>> series;
  };
  template <class A>
  friend void archive(A&, SavedModel&);
  std::vector<SavedModel> models_; // until the replay ends
  std::filesystem::path from_;
  std::filesystem::file_time_type from_time_{};
  std::set<std::string> written_; // names of checkpoints so far
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace cdem::script
