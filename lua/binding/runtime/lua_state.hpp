// The Lua interpreter of a script. Only engine.cpp and lua_*.cpp include it.
#pragma once

#include "lua/binding/module/module.hpp"
#include "lua/binding/session/session.hpp"

#include <atomic>
#include <deque>
#include <exception>
#include <map>
#include <set>
#include <thread>

struct lua_State;

namespace cdem::script {

class LuaState;

// A function or method as the script sees it.
struct Bound {
  const Function* function;
  std::string shown;  // "cdem.elastic", "model:fix"
  const Class* owner; // of a method; null for a function
};

class LuaState {
public:
  explicit LuaState(Session&);
  ~LuaState();
  LuaState(const LuaState&) = delete;
  LuaState& operator=(const LuaState&) = delete;

  static LuaState& of(lua_State* L); // the one L (or the coroutine L) belongs to

  // Compiles and runs text, leaving `results` values on the stack. Throws what the script ended with.
  void run(const std::string& text, const std::string& chunk_name, int results = 0);
  // Calls the function below `arguments` values on L's stack, as lua_call; errors come out as C++ exceptions.
  void call(lua_State* L, int arguments, int results);

  std::string where(lua_State* L) const; // "case.lua:12" of the innermost line of the script; "" outside
  // Raises a Lua error for the C++ exception being handled, with place and the call's name in front, and
  // keeps its type for the caller of the script. To be called inside a catch block; the error is raised by
  // the caller with lua_error after the block has been left.
  std::string message_of_current_exception(lua_State* L, const std::string& shown);
  [[noreturn]] void throw_error(lua_State* L, int status); // from the message on top of the stack

  lua_State* main = nullptr;
  lua_State* current = nullptr; // the coroutine a bound function was called from
  Session& session;
  bool
  stop_wanted(); // the user has asked to stop; the first time, a checkpoint is written where that is possible
  bool interrupted = false; // from now on every hook and every protected call ends
  std::deque<Bound> bound;
  std::map<const void*, const Class*> metatables; // of our objects; a script cannot forge one
  std::shared_ptr<LuaState*> alive; // emptied at the end, for references that outlive the interpreter
  std::size_t memory = 0;           // bytes held by Lua
  static constexpr std::size_t most_memory = std::size_t{4} << 30;
  std::size_t memory_limit = most_memory;
  // For who waits for the script from another thread: looks so far, and the function of ours that runs.
  std::atomic<unsigned> looks{0};
  std::atomic<const Bound*> running{nullptr};
  static constexpr int hook_interval = 10000; // instructions between looks at stop_requested

private:
  enum class ErrorKind { script, file, solution };
  [[noreturn]] static void throw_kind(ErrorKind, const std::string& message);
  static void end_unless_all_fail(ErrorKind, const std::string& message);
  std::map<std::string, ErrorKind>
      kinds_;                // by message, so that an error passed on by a script keeps its type
  bool holds_stops_ = false; // the function that runs now is asked in the middle of a change
  std::thread::id thread_;
  friend class LuaReference;
};

// lua_convert.cpp
Value to_value(lua_State* L, int index);
void push(lua_State* L, const Value&);
std::shared_ptr<Reference> make_reference(lua_State* L, int index);

// lua_module.cpp: pushes the `cdem` table.
void push_module(lua_State* L);

// lua_sandbox.cpp: opens the libraries, all of them or the safe part, with require "cdem" and print.
void open_libraries(lua_State* L, bool unsafe);

} // namespace cdem::script
