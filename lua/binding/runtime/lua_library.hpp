// What the functions that replace Lua's own have in common. Only lua_*.cpp include it.
#pragma once

#include "lua/binding/runtime/lua_state.hpp"

namespace cdem::script {

int raise(lua_State* L, const std::string& message); // as a Lua error; does not return

// Runs body, which may throw; a C++ exception becomes a Lua error with the place in front.
template <class Body>
int guarded(lua_State* L, const char* shown, Body body) {
  std::string message;
  try {
    return body();
  } catch (const std::exception&) {
    message = LuaState::of(L).message_of_current_exception(L, shown);
  }
  return raise(L, message);
}

// Replaces the entry `name` of the table on top by `wrapper`, which gets the old one as its first upvalue.
void replace_with(lua_State* L, const char* name, int (*wrapper)(lua_State*));

// pcall, xpcall and coroutines that let an interrupt pass (lua_protected.cpp).
void use_interruptible_calls(lua_State* L);

// lua_ranks.cpp: the library's io.open or io.lines, which stands on the stack below its arguments, the first of which is
// the path.
int library_open(lua_State* L, const std::string& path, const std::string& mode);
int library_lines(lua_State* L, const std::string& path);
// What asks the clock, chance or the system, and what writes to files, in a script that several ranks run.
void use_calls_of_ranks(lua_State* L, bool unsafe);

// lua_files.cpp. Upvalue 1 of the first two: the library's own function; of write_text: an empty string; of
// require_beside: the table of what has been loaded.
int open_file(lua_State* L);
int lines_of_file(lua_State* L);
int write_text(lua_State* L);
int require_beside(lua_State* L);
int search_sources(lua_State* L);

} // namespace cdem::script
