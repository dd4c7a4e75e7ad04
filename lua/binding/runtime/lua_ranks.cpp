// Lua's own functions in a script that several ranks run. Rank 0 asks the clock, the random seed and the system, and
// sends the answers to the others. Rank 0 opens a file; the others open a copy of its content in memory, so that
// reading, writing and seeking are the same on all. A single process uses none of this.
#include "lua/binding/runtime/lua_library.hpp"

#include "libcdem/ranks/ranks.hpp"
#include "lua/binding/replay/led.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <lua.hpp>
#include <memory>
#include <random>
#include <sys/mman.h>
#include <unistd.h>

namespace cdem::script {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// What the others need to know of a file that rank 0 can open: what it holds, or why it cannot be opened.
Value look_into(const std::string& path, const std::string& mode) {
  std::error_code none;
  if (mode.front() != 'w' && std::filesystem::is_character_file(path, none) && path != "/dev/null")
    return Table{{"error", path + ": a device may never end, and all ranks are told what a file holds; take "
                                  "math.random, or run the script on one rank"},
                 {"number", ENODEV}};
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), mode.c_str()));
  if (!file)
    return Table{{"error", path + ": " + std::strerror(errno)}, {"number", errno}};
  std::string content;
  if (mode.front() != 'w') {
    const std::unique_ptr<std::FILE, Close> in(std::fopen(path.c_str(), "rb"));
    std::string part(std::size_t{1} << 16, '\0');
    while (in) {
      const std::size_t count = std::fread(part.data(), 1, part.size(), in.get());
      if (count == 0)
        break;
      content.append(part, 0, count);
    }
  }
  return Table{{"content", content}};
}

// A name under which a copy in memory can be opened until `file` is closed.
class Copy {
public:
  explicit Copy(const std::string& content) : file_(memfd_create("cdem", MFD_CLOEXEC)) {
    for (std::size_t done = 0; done < content.size();) {
      const auto count = ::write(file_, content.data() + done, content.size() - done);
      if (count <= 0)
        throw std::bad_alloc();
      done += static_cast<std::size_t>(count);
    }
  }
  ~Copy() { close(file_); }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  std::string name() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
  int file_;
};

bool is_mode(const std::string& mode) { // as the library sees it
  std::size_t i = mode.empty() || std::strchr("rwa", mode[0]) == nullptr ? 0 : 1;
  if (i == 0)
    return false;
  i += i < mode.size() && mode[i] == '+' ? 1 : 0;
  i += i < mode.size() && mode[i] == 'b' ? 1 : 0;
  return i == mode.size();
}

// The library's function, below its `arguments` values, one of which is the name of the file.
int call_with_file(lua_State* L, const std::string& path, const std::string& mode, int name_index) {
  const Value looked = led("io.open", [&] { return look_into(path, mode); });
  const auto& known = looked.table()->named;
  if (const auto error = known.find("error"); error != known.end()) {
    lua_pushnil(L);
    push(L, error->second);
    push(L, known.at("number"));
    return 3;
  }
  std::unique_ptr<Copy> copy;
  if (!ranks().leads()) {
    copy = std::make_unique<Copy>(*known.at("content").get<std::string>());
    const std::string name = copy->name();
    lua_pushlstring(L, name.data(), name.size());
    lua_replace(L, name_index);
  }
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

// io.open and io.lines of trusted scripts, which may name any file. Upvalue 1: the library's own.
int open_anywhere(lua_State* L) {
  const std::string path = luaL_checkstring(L, 1), mode = luaL_optstring(L, 2, "r");
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  return guarded(L, "io.open", [&] { return library_open(L, path, mode); });
}

int lines_anywhere(lua_State* L) {
  const char* const path = luaL_checkstring(L, 1); // not of standard input
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  return guarded(L, "io.lines", [&] { return library_lines(L, path); });
}

// Upvalues: the library's function and its name. Rank 0 alone calls it, all have what it gives.
int ask_leader(lua_State* L) {
  const std::string name = lua_tostring(L, lua_upvalueindex(2));
  return guarded(L, name.c_str(), [&] {
    const Value told = led(name, [&]() -> Value {
      lua_pushvalue(L, lua_upvalueindex(1));
      lua_insert(L, 1);
      const int status = lua_pcall(L, lua_gettop(L) - 1, LUA_MULTRET, 0);
      Values results;
      for (int i = 1; i <= lua_gettop(L); ++i)
        results.push_back(to_value(L, i));
      Table all = Table::list(std::move(results));
      all.named["failed"] = status != LUA_OK;
      return all;
    });
    lua_settop(L, 0);
    for (const Value& result : told.table()->items)
      push(L, result);
    if (*told.table()->named.at("failed").get<bool>())
      lua_error(L);
    return lua_gettop(L);
  });
}

// os.time of now; of a table it is the same everywhere, and sets the table's fields right.
int time_of_leader(lua_State* L) {
  if (lua_isnoneornil(L, 1))
    return ask_leader(L);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

// math.randomseed without a seed takes one from chance.
int seed_of_leader(lua_State* L) {
  if (lua_gettop(L) == 0)
    guarded(L, "math.randomseed", [&] {
      const Value seed = led("math.randomseed", []() -> Value {
        std::random_device chance;
        return Table::list({static_cast<std::int64_t>(chance()), static_cast<std::int64_t>(chance())});
      });
      for (const Value& part : seed.table()->items)
        push(L, part);
      return 0;
    });
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

// Writing to a file and closing it: where it fails on rank 0 it has failed for all. Upvalues as of ask_leader.
int write_as_leader(lua_State* L) {
  const std::string name = lua_tostring(L, lua_upvalueindex(2));
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET); // what is wrong with its arguments is so on all
  return guarded(L, name.c_str(), [&] {
    const bool failed = lua_gettop(L) >= 2 && lua_isnil(L, 1);
    const Value told = led(name, [&]() -> Value {
      return failed ? Value(Table::list({to_value(L, 2), to_value(L, 3)})) : Value();
    });
    if (const Table* why = told.table()) {
      lua_settop(L, 0);
      lua_pushnil(L);
      for (const Value& part : why->items)
        push(L, part);
    }
    return lua_gettop(L);
  });
}

int refuse(lua_State* L) {
  return luaL_error(L, "%s: not with several ranks, which would not all get the same; run the script on one",
                    lua_tostring(L, lua_upvalueindex(2)));
}

// In the table on top of the stack.
void replace_named(lua_State* L, const std::string& library, const char* name, lua_CFunction wrapper) {
  if (lua_getfield(L, -1, name) != LUA_TFUNCTION) {
    lua_pop(L, 1);
    return;
  }
  lua_pushstring(L, (library + name).c_str());
  lua_pushcclosure(L, wrapper, 2);
  lua_setfield(L, -2, name);
}

} // namespace

int library_open(lua_State* L, const std::string& path, const std::string& mode) {
  if (with_others() && is_mode(mode))
    return call_with_file(L, path, mode, 2);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

int library_lines(lua_State* L, const std::string& path) {
  if (with_others()) {
    const int results = call_with_file(L, path, "r", 2);
    if (results == 3 && lua_isnil(L, -3)) {
      lua_pop(L, 1);
      return lua_error(L);
    }
    return results;
  }
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

void use_calls_of_ranks(lua_State* L, bool unsafe) {
  if (ranks().alone())
    return;
  lua_getglobal(L, "os");
  replace_named(L, "os.", "time", time_of_leader);
  for (const char* const name : {"clock", "date"})
    replace_named(L, "os.", name, ask_leader);
  if (unsafe)
    for (const char* const name : {"execute", "getenv", "remove", "rename", "tmpname"})
      replace_named(L, "os.", name, ask_leader);
  lua_pop(L, 1);
  lua_getglobal(L, "math");
  replace_named(L, "math.", "randomseed", seed_of_leader);
  lua_pop(L, 1);
  luaL_getmetatable(L, LUA_FILEHANDLE);
  lua_getfield(L, -1, "__index");
  for (const char* const name : {"write", "flush", "close"})
    replace_named(L, "file:", name, write_as_leader);
  lua_pop(L, 2);
  lua_getglobal(L, "io");
  if (unsafe) {
    replace_named(L, "io.", "open", open_anywhere);
    replace_named(L, "io.", "lines", lines_anywhere);
    for (const char* const name : {"popen", "read", "input"}) // standard input is that of rank 0
      replace_named(L, "io.", name, refuse);
    lua_pushnil(L);
    lua_setfield(L, -2, "stdin");
  }
  lua_pop(L, 1);
}

} // namespace cdem::script
