// Making, running and ending the interpreter; errors on their way between Lua and C++.
#include "lua/binding/runtime/lua_state.hpp"

#include "libcdem/step/errors.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "libgeom/core/stop.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/schema/schema.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <lua.hpp>
#include <new>

namespace cdem::script {

namespace {

void* allocate(void* user, void* block, std::size_t old_size, std::size_t new_size) {
  auto& state = *static_cast<LuaState*>(user);
  const std::size_t held = block ? old_size : 0; // without a block, old_size is a type tag
  if (new_size == 0) {
    std::free(block);
    state.memory -= held;
    return nullptr;
  }
  if (new_size > held && state.memory - held + new_size > state.memory_limit)
    return nullptr;
  void* moved = std::realloc(block, new_size);
  if (moved)
    state.memory += new_size - held;
  return moved;
}

void hook(lua_State* L, lua_Debug*) {
  LuaState& state = LuaState::of(L);
  const unsigned look = ++state.looks;
  // All ranks come here alike; they agree now and then only, as it takes a message.
  constexpr unsigned agreed_each = 64;
  if (with_others() && look % agreed_each != 0 && !state.interrupted)
    return;
  if (state.stop_wanted())
    luaL_error(L, "%s: stopped by the user", state.where(L).c_str());
}

// Makes a message out of whatever error value the script raised.
int text_of_error(lua_State* L) {
  if (lua_type(L, 1) == LUA_TSTRING || LuaState::of(L).interrupted)
    return 1;
  if (luaL_callmeta(L, 1, "__tostring") && lua_type(L, -1) == LUA_TSTRING)
    return 1;
  const std::string place = LuaState::of(L).where(L);
  lua_pushfstring(L, "%s%serror value is a %s; give error() a text", place.c_str(), place.empty() ? "" : ": ",
                  luaL_typename(L, 1));
  return 1;
}

// model.memory.key = value: what a checkpoint could not hold is refused in the line that assigns it.
int set_in_memory(lua_State* L) {
  LuaState& state = LuaState::of(L);
  std::string message;
  try {
    if (lua_type(L, 2) == LUA_TSTRING)
      check_value(to_value(L, 3), plain("").type, "model.memory." + std::string(lua_tostring(L, 2)));
    lua_rawset(L, 1);
    return 0;
  } catch (const std::exception&) {
    message = state.message_of_current_exception(L, "cdem.Model");
  }
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

// Guards the table on top of the stack. Lua calls the guard for new keys only; other changes are checked when a stage
// begins and ends.
void guard_memory(lua_State* L) {
  lua_newtable(L);
  lua_pushcfunction(L, set_in_memory);
  lua_setfield(L, -2, "__newindex");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
}

} // namespace

LuaState::LuaState(Session& given)
    : session(given), alive(std::make_shared<LuaState*>(this)), thread_(std::this_thread::get_id()) {
  if (session.settings.memory > 0)
    memory_limit = std::min(most_memory, session.settings.memory);
  main = lua_newstate(allocate, this);
  if (!main)
    throw std::bad_alloc();
  current = main;
  *static_cast<LuaState**>(lua_getextraspace(main)) = this;
  lua_sethook(main, hook, LUA_MASKCOUNT, hook_interval);
  session.where = [this] { return where(current); };
  session.new_memory = [this](const Value& table) {
    push(current, table);
    guard_memory(current);
    auto reference = make_reference(current, -1);
    lua_pop(current, 1);
    return reference;
  };
  session.collect_garbage = [this] { lua_gc(current, LUA_GCCOLLECT); };
  open_libraries(main, session.settings.unsafe);
  geom::set_stop_check([this] { return stop_wanted(); });
  geom::set_sharing([](const auto& run) { return led_bytes("geometry", run); });
}

LuaState::~LuaState() {
  *alive = nullptr;
  geom::set_stop_check({});
  geom::set_sharing({});
  session.where = nullptr;
  session.new_memory = nullptr;
  session.collect_garbage = nullptr;
  lua_close(main);
}

bool LuaState::stop_wanted() {
  const auto& observer = session.settings.observer;
  if (!holds_stops_ && observer && observer->stop_requested()) {
    if (!interrupted)
      session.checkpoints.stop();
    interrupted = true;
  }
  return interrupted;
}

LuaState& LuaState::of(lua_State* L) {
  return **static_cast<LuaState**>(lua_getextraspace(L));
}

std::string LuaState::where(lua_State* L) const {
  lua_Debug frame;
  for (int level = 0; lua_getstack(L, level, &frame); ++level) {
    lua_getinfo(L, "Sl", &frame);
    const bool ours = std::strncmp(frame.source, "=[", 2) == 0; // "=[C]" and the Lua side of the module
    if (!ours && frame.currentline > 0)
      return std::string(frame.source[0] == '@' || frame.source[0] == '=' ? frame.source + 1
                                                                          : frame.short_src) +
             ":" + std::to_string(frame.currentline);
  }
  return {};
}

namespace {

// "model:flow" before "flow: ...": the library names its calls too, for those that use it without scripts.
std::string after_name(const std::string& shown, const std::string& what) {
  const std::string name = shown.substr(shown.find_last_of(".:") + 1) + ": ";
  return what.compare(0, name.size(), name) == 0 ? what.substr(name.size()) : what;
}

} // namespace

// The script may catch no error that the other ranks do not have.
void LuaState::end_unless_all_fail(ErrorKind kind, const std::string& message) {
  if (all_fail_here())
    return;
  try {
    throw_kind(kind, message);
  } catch (...) {
    std::terminate();
  }
}

[[noreturn]] void LuaState::throw_kind(ErrorKind kind, const std::string& message) {
  switch (kind) {
  case ErrorKind::solution:
    throw SolutionError(message);
  case ErrorKind::file:
    throw FileError(message);
  default:
    throw ScriptError(message);
  }
}

namespace {

constexpr const char* no_memory =
    "not enough memory; use fewer blocks or fewer rows, or allow more with --memory";

} // namespace

std::string LuaState::message_of_current_exception(lua_State* L, const std::string& shown) {
  const std::string place = where(L);
  const std::string front = (place.empty() ? "" : place + ": ") + shown + ": ";
  std::string message;
  ErrorKind kind = ErrorKind::script;
  try {
    throw;
  } catch (const Interrupted& error) {
    interrupted = true;
    return (place.empty() ? "" : place + ": ") + error.what();
  } catch (const geom::Stopped& error) {
    interrupted = true;
    return (place.empty() ? "" : place + ": ") + error.what();
  } catch (const ScriptError& error) {
    return error.what(); // from a callback: has its own place
  } catch (const SolutionError& error) {
    kind = ErrorKind::solution;
    message = front + after_name(shown, error.what());
  } catch (const FileError& error) {
    kind = ErrorKind::file;
    message = front + error.what();
  } catch (const std::bad_alloc&) {
    message = front + no_memory;
  } catch (const std::length_error&) { // a list as long as no memory can hold
    message = front + no_memory;
  } catch (const std::exception& error) {
    message = front + after_name(shown, geom::plain_reason(error));
  }
  end_unless_all_fail(kind, message);
  if (kind != ErrorKind::script)
    kinds_[message] = kind;
  return message;
}

namespace {

std::string memory_text(std::size_t bytes) {
  const bool whole = (bytes >> 30) << 30 == bytes;
  return whole ? std::to_string(bytes >> 30) + " GiB" : std::to_string(bytes >> 20) + " MiB";
}

} // namespace

void LuaState::throw_error(lua_State* L, int status) {
  const char* text = lua_tostring(L, -1);
  std::string message = text ? text : "error without a message";
  lua_pop(L, 1);
  if (interrupted)
    throw Interrupted();
  if (status == LUA_ERRMEM)
    message = shown_name(session.settings.script) + ": the script's own tables and strings need more than " +
              memory_text(memory_limit) + "; keep less of them" +
              (memory_limit < most_memory ? ", or allow more with --memory" : "");
  const auto known = kinds_.find(message);
  const ErrorKind kind = known != kinds_.end() ? known->second : ErrorKind::script;
  end_unless_all_fail(kind, message);
  throw_kind(kind, message);
}

void LuaState::call(lua_State* L, int arguments, int results) {
  if (std::this_thread::get_id() != thread_)
    throw std::logic_error("a Lua function was called from a second thread");
  const int handler = lua_gettop(L) - arguments;
  lua_pushcfunction(L, text_of_error);
  lua_insert(L, handler);
  lua_State* const caller = current;
  current = L;
  const Doing callback(session.settings.observer.get(), Activity::script);
  holds_stops_ = callback.before() == Activity::changing;
  const int status = lua_pcall(L, arguments, results, handler);
  holds_stops_ = false;
  current = caller;
  lua_remove(L, handler);
  if (status != LUA_OK)
    throw_error(L, status);
  if (interrupted)
    throw Interrupted();
}

void LuaState::run(const std::string& text, const std::string& chunk_name, int results) {
  // Text only: precompiled chunks can crash the interpreter.
  const char* mode = session.settings.unsafe ? "bt" : "t";
  const int status = luaL_loadbufferx(main, text.data(), text.size(), chunk_name.c_str(), mode);
  if (status != LUA_OK)
    throw_error(main, status);
  call(main, 0, results);
}

} // namespace cdem::script
