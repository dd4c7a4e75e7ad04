// The libraries a script gets. By default: no commands, no foreign code, no bytecode, no introspection of the
// interpreter; files only where Files allows; `require` only of cdem and of .lua files beside the script.
#include "lua/binding/lua_state.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace cdem::script {

namespace {

int raise(lua_State* L, const std::string& message) {
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

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

// --- protected calls that an interrupt passes through
// --------------------------------------------------------

int rethrow_interrupt(lua_State* L) {
  if (LuaState::of(L).interrupted)
    return raise(L, "stopped by the user");
  return 0;
}

int finish_pcall(lua_State* L, int status, lua_KContext extra) {
  rethrow_interrupt(L);
  if (status != LUA_OK && status != LUA_YIELD) {
    lua_pushboolean(L, 0);
    lua_pushvalue(L, -2);
    return 2;
  }
  return lua_gettop(L) - static_cast<int>(extra);
}

int safe_pcall(lua_State* L) {
  luaL_checkany(L, 1);
  lua_pushboolean(L, 1);
  lua_insert(L, 1);
  const int status = lua_pcallk(L, lua_gettop(L) - 2, LUA_MULTRET, 0, 0, finish_pcall);
  return finish_pcall(L, status, 0);
}

// Upvalue 1: the script's message handler. It is left out for an interrupt: it would run inside the hook that
// raised it, where no hook can end it.
int handle_message(lua_State* L) {
  if (LuaState::of(L).interrupted)
    return 1;
  lua_settop(L, 1);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, 1, 1);
  return 1;
}

int safe_xpcall(lua_State* L) {
  const int n = lua_gettop(L);
  luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_pushvalue(L, 2);
  lua_pushcclosure(L, handle_message, 1);
  lua_replace(L, 2);
  lua_pushboolean(L, 1);
  lua_pushvalue(L, 1);
  lua_rotate(L, 3, 2);
  const int status = lua_pcallk(L, n - 2, LUA_MULTRET, 2, 2, finish_pcall);
  return finish_pcall(L, status, 2);
}

// Calls the library's own function (upvalue 1), then lets an interrupt that it caught go on.
int then_rethrow(lua_State* L) {
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  rethrow_interrupt(L);
  return lua_gettop(L);
}

// --- base
// ----------------------------------------------------------------------------------------------------

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

// --- files
// ---------------------------------------------------------------------------------------------------

// Upvalue 1: the library's io.open.
int open_file(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1), mode = luaL_optstring(L, 2, "r");
  return guarded(L, "io.open", [&] {
    const Files& files = LuaState::of(L).session.files;
    if (mode.empty() || std::strchr("rwa", mode[0]) == nullptr)
      throw geom::InputError("mode", "\"" + mode + "\"", "r, w, a, r+, w+ or a+, with b after it or not");
    const bool writes = mode.find_first_of("wa+") != std::string::npos;
    std::string path;
    try {
      path = (writes ? files.to_write(name) : files.to_read(name)).string();
    } catch (const FileError& error) { // as io.open does: nil and a text
      lua_pushnil(L);
      lua_pushstring(L, error.what());
      return 2;
    }
    lua_settop(L, 0);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_pushlstring(L, path.data(), path.size());
    lua_pushlstring(L, mode.data(), mode.size());
    lua_call(L, 2, LUA_MULTRET);
    return lua_gettop(L);
  });
}

int lines_of_file(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1);
  return guarded(L, "io.lines", [&] {
    const std::string path = LuaState::of(L).session.files.to_read(name).string();
    lua_pushlstring(L, path.data(), path.size());
    lua_replace(L, 1);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
  });
}

// io.write: whole lines to the log; what stands after the last newline waits in the upvalue.
int write_text(lua_State* L) {
  std::string text = lua_tostring(L, lua_upvalueindex(1));
  for (int i = 1; i <= lua_gettop(L); ++i) {
    std::size_t size = 0;
    const char* part = luaL_checklstring(L, i, &size);
    text.append(part, size);
  }
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    LuaState::of(L).session.message(text.substr(0, end));
    text.erase(0, end + 1);
  }
  lua_pushlstring(L, text.data(), text.size());
  lua_replace(L, lua_upvalueindex(1));
  return 0;
}

// --- require
// -------------------------------------------------------------------------------------------------

// require "name": a .lua file beside the script, dots for folders. Upvalue 1: what has been loaded.
int require_beside(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1);
  lua_settop(L, 1);
  if (lua_getfield(L, lua_upvalueindex(1), name.c_str()) != LUA_TNIL)
    return 1;
  lua_pop(L, 1);
  std::string text, file;
  guarded(L, "require", [&] {
    for (const char c : name)
      if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.'))
        throw geom::InputError("name", "\"" + name + "\"", "letters, digits, _ and -, with dots for folders");
    const Session& session = LuaState::of(L).session;
    file = name;
    for (char& c : file)
      c = c == '.' ? '/' : c;
    file += ".lua";
    const auto path = session.files.to_read(file);
    text = read_file(path);
    file = shown_name(path);
    return 0;
  });
  const std::string chunk = "@" + file;
  if (luaL_loadbufferx(L, text.data(), text.size(), chunk.c_str(), "t") != LUA_OK)
    return lua_error(L);
  lua_pushlstring(L, name.data(), name.size());
  lua_call(L, 1, 1);
  if (lua_isnil(L, -1)) {
    lua_pop(L, 1);
    lua_pushboolean(L, 1);
  }
  lua_pushvalue(L, -1);
  lua_setfield(L, lua_upvalueindex(1), name.c_str());
  return 1;
}

// --- opening
// -------------------------------------------------------------------------------------------------

void open_library(lua_State* L, const char* name, lua_CFunction open) {
  luaL_requiref(L, name, open, 1);
  lua_pop(L, 1);
}

void replace_with(lua_State* L, const char* name, lua_CFunction wrapper) { // of the table on top
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, wrapper, 1);
  lua_setfield(L, -2, name);
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

void restrict_libraries(lua_State* L) {
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
  lua_register(L, "pcall", safe_pcall);
  lua_register(L, "xpcall", safe_xpcall);
  // The same random numbers in every run, unless the script seeds them itself.
  lua_getglobal(L, "math");
  lua_getfield(L, -1, "randomseed");
  lua_pushinteger(L, 1);
  lua_call(L, 1, 0);
  lua_pop(L, 1);
  lua_getglobal(L, "coroutine");
  replace_with(L, "resume", then_rethrow);
  replace_with(L, "close", then_rethrow);
  lua_pop(L, 1);
}

} // namespace cdem::script
