// Answers that a script got, in order: results of calls that read or change a model, outcomes of stages, and callbacks
// that were called. A resumed script runs from its beginning and gets the same answers again, without solving anything,
// up to the point where its checkpoint was written. So its own variables come back as well.
#pragma once

#include "lua/binding/schema/value.hpp"

#include <optional>

namespace cdem::script {

// How a call is treated when a script is replayed.
enum class Replay {
  standard, // as `recorded` for a Model's methods and properties, as `never` for the others
  recorded, // its result is kept and given again: what reads or changes the state, writes a file, asks the clock
  again, // executed again, untried: a condition or name that the model keeps; whether it was refused is kept
  never, // executed again and not kept: depends on its arguments alone
};

struct Event {
  enum class Kind : std::uint8_t { call, stage, stage_end, callback };
  enum class Outcome : std::uint8_t { value, object, script_error, input_error, file_error, solution_error };
  Kind kind = Kind::call;
  Outcome outcome = Outcome::value; // object: a value that cannot be kept, so it is made again
  std::string name;                 // "model:max"; "relax"; "callback"
  std::uint64_t hash = 0;           // of the model's number and the arguments
  Value value{};                    // result, text of the error, or arguments of a callback
};

// A plain value as bytes: nothing of the script's own, of ours only piles.
std::string value_bytes(const Value&);
Value value_from(const std::string& bytes);

class Journal {
public:
  // Bytes after which nothing is kept any more and there are no checkpoints.
  static constexpr std::size_t most = std::size_t{512} << 20;

  void load(std::string text); // to be replayed
  bool replaying() const { return next_ < replay_end_; }
  Event peek() const;
  Event take();

  void record(Event);
  bool full() const { return full_; }
  std::size_t size() const { return text_.size(); }
  std::string text(std::size_t size) const { return text_.substr(0, size); }

private:
  std::string text_;
  std::size_t next_ = 0, replay_end_ = 0;
  bool full_ = false;
};

} // namespace cdem::script
