// io.open, io.lines, io.write and require as scripts get them.
#include "lua/binding/runtime/lua_library.hpp"

#include "libgeom/core/error.hpp"
#include "lua/binding/files/sources.hpp"

#include <cctype>
#include <cstring>
#include <lua.hpp>

namespace cdem::script {

// Upvalue 1: the library's io.open.
int open_file(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1);
  std::string mode = luaL_optstring(L, 2, "r");
  return guarded(L, "io.open", [&] {
    Session& session = LuaState::of(L).session;
    const Files& files = session.files;
    if (mode.empty() || std::strchr("rwa", mode[0]) == nullptr)
      throw geom::InputError("mode", "\"" + mode + "\"", "r, w, a, r+, w+ or a+, with b after it or not");
    const bool writes = mode.find_first_of("wa+") != std::string::npos;
    std::string path;
    try {
      if (writes && session.settings.check_only) {
        files.would_write(name);
        path = "/dev/null";
      } else {
        path = (writes ? files.to_write(name) : files.to_read(name)).string();
      }
    } catch (const FileError& error) { // as io.open does: nil and a text
      lua_pushnil(L);
      lua_pushstring(L, error.what());
      return 2;
    }
    // A resumed script adds its lines anew to a file that was empty when it first began.
    if (mode[0] == 'a' && session.checkpoints.resumed() && session.appended.insert(path).second)
      mode[0] = 'w';
    lua_settop(L, 0);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_pushlstring(L, path.data(), path.size());
    lua_pushlstring(L, mode.data(), mode.size());
    return library_open(L, path, mode);
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
    return library_lines(L, path);
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

namespace {

struct Source {
  std::string text, shown; // shown: the user's own file, in messages
};

Source source_of(const Session& session, const std::string& name) {
  const std::filesystem::path file = file_of_module(name), beside = session.files.script_folder() / file;
  const std::filesystem::path kept = kept_source(session.settings.sources, file, {});
  if (!kept.empty())
    return {read_file(kept), shown_name(beside)};
  const std::filesystem::path path = session.files.to_read(file.string());
  return {read_file(path), shown_name(path)};
}

} // namespace

// A searcher of `package` for what a sweep kept, in scripts that have all of Lua.
int search_sources(lua_State* L) {
  const std::string name = luaL_checkstring(L, 1);
  const Session& session = LuaState::of(L).session;
  const std::filesystem::path file = file_of_module(name);
  std::string chunk, text;
  guarded(L, "require", [&] {
    if (const auto kept = kept_source(session.settings.sources, file, {}); !kept.empty()) {
      text = read_file(kept);
      chunk = "@" + shown_name(session.files.script_folder() / file);
    }
    return 0;
  });
  if (chunk.empty())
    return 0;
  if (luaL_loadbufferx(L, text.data(), text.size(), chunk.c_str(), "t") != LUA_OK)
    return lua_error(L);
  return 1;
}

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
    Session& session = LuaState::of(L).session;
    const Source source = source_of(session, name);
    text = source.text;
    session.checkpoints.source(name, text);
    file = source.shown;
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

} // namespace cdem::script
