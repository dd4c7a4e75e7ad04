// The libraries a script gets. By default: no commands, no foreign code, no bytecode, no introspection of the
// interpreter; files only where Files allows; `require` only of cdem and of .lua files beside the script.
#include "lua/binding/runtime/lua_library.hpp"

#include <algorithm>
#include <lua.hpp>

namespace cdem::script {

int raise(lua_State* L, const std::string& message) {
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

void replace_with(lua_State* L, const char* name, int (*wrapper)(lua_State*)) {
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, wrapper, 1);
  lua_setfield(L, -2, name);
}

namespace {

int refused(lua_State* L) {
  const std::string name = lua_tostring(L, lua_upvalueindex(1));
  const std::string place = LuaState::of(L).where(L);
  return raise(L, (place.empty() ? "" : place + ": ") + name +
                      ": not available to scripts; run with --unsafe to allow it");
}

void set_refused(lua_State* L, const char* library, const char* name) {
  lua_pushfstring(L, "%s%s%s", library, *library ? "." : "", name);
  lua_pushcclosure(L, refused, 1);
  lua_setfield(L, -2, name);
}

int print(lua_State* L) {
  std::string line;
  const int n = lua_gettop(L);
  for (int i = 1; i <= n; ++i) {
    std::size_t size = 0;
    const char* text = luaL_tolstring(L, i, &size);
    line += (i > 1 ? "\t" : "") + std::string(text, size);
    lua_pop(L, 1);
  }
  LuaState::of(L).session.message(line);
  return 0;
}

// setmetatable without finalisers: Lua runs them with hooks off, so that one could never be interrupted.
int set_metatable(lua_State* L) {
  if (lua_type(L, 2) == LUA_TTABLE) {
    lua_pushliteral(L, "__gc");
    if (lua_rawget(L, 2) != LUA_TNIL)
      return raise(L, LuaState::of(L).where(L) +
                          ": setmetatable: __gc: not available to scripts; run with --unsafe "
                          "to allow it");
    lua_pop(L, 1);
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, 1);
  return 1;
}

// load(chunk, name, mode, env) with mode "t" whatever was asked.
int load_text(lua_State* L) {
  const int n = std::max(lua_gettop(L), 3);
  lua_settop(L, n);
  lua_pushliteral(L, "t");
  lua_replace(L, 3);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, n, LUA_MULTRET);
  return lua_gettop(L);
}

void open_library(lua_State* L, const char* name, lua_CFunction open) {
  luaL_requiref(L, name, open, 1);
  lua_pop(L, 1);
}

// A table with only the named functions of a library.
void keep_only(lua_State* L, const char* library, std::initializer_list<const char*> names) {
  lua_getglobal(L, library);
  lua_newtable(L);
  for (const char* name : names) {
    lua_getfield(L, -2, name);
    lua_setfield(L, -2, name);
  }
  lua_pushvalue(L, -1);
  lua_setglobal(L, library);
  lua_remove(L, -2);
}

// The metatable on top of the stack, out of a script's reach: a changed __gc of a file would run with hooks off, and
// even while the interpreter ends.
void lock_metatable(lua_State* L) {
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);
}

void restrict_libraries(lua_State* L) {
  luaL_getmetatable(L, LUA_FILEHANDLE);
  lock_metatable(L);
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lock_metatable(L);
  lua_pop(L, 1);

  lua_pushglobaltable(L);
  replace_with(L, "load", load_text);
  replace_with(L, "setmetatable", set_metatable);
  for (const char* name : {"dofile", "loadfile"})
    set_refused(L, "", name);
  lua_pop(L, 1);

  keep_only(L, "os", {"time", "clock", "date", "difftime"});
  for (const char* name : {"execute", "exit", "getenv", "remove", "rename", "tmpname", "setlocale"})
    set_refused(L, "os", name);
  lua_pop(L, 1);

  keep_only(L, "io", {"open", "lines", "type", "close"});
  replace_with(L, "open", open_file);
  replace_with(L, "lines", lines_of_file);
  lua_pushliteral(L, "");
  lua_pushcclosure(L, write_text, 1);
  lua_setfield(L, -2, "write");
  for (const char* name : {"popen", "tmpfile", "input", "output", "read"})
    set_refused(L, "io", name);
  lua_pop(L, 1);

  keep_only(L, "debug", {"traceback"});
  for (const char* name : {"debug", "gethook", "getinfo", "getlocal", "getmetatable", "getregistry",
                           "getupvalue", "getuservalue", "setcstacklimit", "sethook", "setlocal",
                           "setmetatable", "setupvalue", "setuservalue", "upvalueid", "upvaluejoin"})
    set_refused(L, "debug", name);
  lua_pop(L, 1);

  lua_getglobal(L, "string");
  set_refused(L, "string", "dump");
  lua_pop(L, 1);

  // `package` and `require` are made anew: the library's searchers would load files from anywhere.
  lua_newtable(L);
  lua_newtable(L);
  lua_pushvalue(L, -1);
  lua_setfield(L, -3, "loaded");
  push_module(L);
  lua_setfield(L, -2, "cdem");
  lua_pushcclosure(L, require_beside, 1);
  lua_setglobal(L, "require");
  for (const char* name : {"loadlib", "searchpath"})
    set_refused(L, "package", name);
  lua_setglobal(L, "package");
}

// Before all others but that of what is preloaded; `package` is on top.
void add_searcher(lua_State* L, lua_CFunction searcher) {
  lua_getfield(L, -1, "searchers");
  for (lua_Integer i = luaL_len(L, -1); i >= 2; --i) {
    lua_rawgeti(L, -1, i);
    lua_rawseti(L, -2, i + 1);
  }
  lua_pushcfunction(L, searcher);
  lua_rawseti(L, -2, 2);
  lua_pop(L, 1);
}

} // namespace

void open_libraries(lua_State* L, bool unsafe) {
  if (unsafe) {
    luaL_openlibs(L);
    lua_getglobal(L, "package");
    lua_getfield(L, -1, "loaded");
    push_module(L);
    lua_setfield(L, -2, "cdem");
    lua_pop(L, 1);
    const std::string folder = LuaState::of(L).session.files.script_folder().string();
    lua_getfield(L, -1, "path");
    const std::string path = folder + "/?.lua;" + lua_tostring(L, -1);
    lua_pop(L, 1);
    lua_pushlstring(L, path.data(), path.size());
    lua_setfield(L, -2, "path");
    add_searcher(L, search_sources);
    lua_pop(L, 1);
  } else {
    open_library(L, LUA_GNAME, luaopen_base);
    open_library(L, LUA_COLIBNAME, luaopen_coroutine);
    open_library(L, LUA_TABLIBNAME, luaopen_table);
    open_library(L, LUA_STRLIBNAME, luaopen_string);
    open_library(L, LUA_UTF8LIBNAME, luaopen_utf8);
    open_library(L, LUA_MATHLIBNAME, luaopen_math);
    open_library(L, LUA_OSLIBNAME, luaopen_os);
    open_library(L, LUA_IOLIBNAME, luaopen_io);
    open_library(L, LUA_DBLIBNAME, luaopen_debug);
    restrict_libraries(L);
  }
  lua_register(L, "print", print);
  // The same random numbers in every run, unless the script seeds them itself.
  lua_getglobal(L, "math");
  lua_getfield(L, -1, "randomseed");
  lua_pushinteger(L, 1);
  lua_call(L, 1, 0);
  lua_pop(L, 1);
  use_interruptible_calls(L);
  use_calls_of_ranks(L, unsafe);
}

} // namespace cdem::script
