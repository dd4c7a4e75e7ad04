#include "lua/binding/runtime/engine.hpp"

#include "lua/binding/files/sources.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/runtime/lua_state.hpp"
#include "lua/binding/session/model_object.hpp"

#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/regular_file.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <lua.hpp>
#include <thread>

namespace cdem::script {

struct Engine::Impl {
  explicit Impl(EngineSettings settings) : session(std::move(settings)), lua(session) {}

  bool save_failed(); // the models whose stage has failed

  Session session;
  LuaState lua;
};

Engine::Engine(EngineSettings settings) : impl_(std::make_unique<Impl>(std::move(settings))) {
  if (!impl_->session.settings.script.empty())
    return;
  lua_State* L = impl_->lua.main;
  lua_getglobal(L, "require");
  lua_pushliteral(L, "cdem");
  impl_->lua.call(L, 1, 1);
  lua_setglobal(L, "cdem");
}

Engine::~Engine() = default;

void Engine::run_file() {
  Session& session = impl_->session;
  const std::filesystem::path& script = session.settings.script;
  const std::filesystem::path source = kept_source(session.settings.sources, script.filename(), script);
  std::string text = led_bytes("script", [&] {
    if (const std::string why = geom::why_not_regular(source); !why.empty())
      throw FileError(script.string() + ": " + why);
    return read_file(source);
  });
  if (text.rfind("\xef\xbb\xbf", 0) == 0)
    text.erase(0, 3);
  if (!text.empty() &&
      text[0] == '#') // first line of an executable script; its newline stays for the line numbers
    text.erase(0, std::min(text.find('\n'), text.size()));
  impl_->lua.interrupted = false;
  const auto in_script = [&](const auto& step) {
    try {
      step();
    } catch (const geom::InputError& wrong) {
      throw ScriptError(shown_name(script) + ": " + wrong.what());
    }
  };
  in_script([&] {
    if (session.settings.resume.empty())
      session.checkpoints.begin(text);
    else
      session.checkpoints.load(session.settings.resume, text);
  });
  try {
    impl_->lua.run(text, "@" + shown_name(script));
  } catch (const ScriptError&) {
    session.checkpoints.fail();
    session.write_films();
    throw;
  } catch (const FileError&) {
    session.checkpoints.fail();
    session.write_films();
    throw;
  } catch (const Interrupted&) {
    session.write_films();
    throw;
  }
  session.write_films();
  in_script([&] { session.check_set_names(); });
  in_script([&] { session.checkpoints.end(); });
  for (const auto& notes : session.notes)
    for (const std::string& line : notes->at_end)
      session.warn(line);
  if (!session.report.figures.empty() && session.report.warnings.size() < session.warnings.size())
    session.write_report(); // with the warnings that came after the last figure
}

std::string Engine::run_line(const std::string& text, bool& incomplete) {
  incomplete = false;
  LuaState& lua = impl_->lua;
  lua_State* L = lua.main;
  lua.interrupted = false;
  lua_settop(L, 0);
  const std::string chunk = "=repl";
  const std::string expression = "return " + text;
  if (luaL_loadbufferx(L, expression.data(), expression.size(), chunk.c_str(), "t") != LUA_OK) {
    lua_settop(L, 0);
    const int status = luaL_loadbufferx(L, text.data(), text.size(), chunk.c_str(), "t");
    if (status == LUA_ERRSYNTAX) {
      const std::string message = lua_tostring(L, -1);
      const std::string end = "<eof>";
      if (message.size() >= end.size() &&
          message.compare(message.size() - end.size(), end.size(), end) == 0) {
        lua_settop(L, 0);
        incomplete = true;
        return {};
      }
    }
    if (status != LUA_OK)
      lua.throw_error(L, status);
  }
  lua.call(L, 0, LUA_MULTRET);
  std::string out;
  const int results = lua_gettop(L);
  for (int i = 1; i <= results; ++i) {
    lua_getglobal(L, "require");
    lua_pushliteral(L, "cdem");
    lua.call(L, 1, 1);
    lua_getfield(L, -1, "describe");
    lua_pushvalue(L, i);
    lua.call(L, 1, 1);
    out += (i > 1 ? "\t" : "") + std::string(lua_tostring(L, -1));
    lua_pop(L, 2);
  }
  lua_settop(L, 0);
  return out;
}

namespace {

std::vector<std::string> names_in_table(lua_State* L, int index) {
  std::vector<std::string> names;
  lua_pushnil(L);
  while (lua_next(L, index)) {
    if (lua_type(L, -2) == LUA_TSTRING)
      names.emplace_back(lua_tostring(L, -2));
    lua_pop(L, 1);
  }
  return names;
}

// Names of what stands on top of the stack.
std::vector<std::string> member_names(LuaState& lua, lua_State* L, bool only_methods) {
  std::vector<std::string> names;
  if (lua_type(L, -1) == LUA_TTABLE)
    return names_in_table(L, lua_gettop(L));
  if (lua_type(L, -1) == LUA_TUSERDATA && lua_getmetatable(L, -1)) {
    const auto known = lua.metatables.find(lua_topointer(L, -1));
    lua_pop(L, 1);
    if (known == lua.metatables.end())
      return names;
    for (const Function& f : known->second->methods)
      names.push_back(f.name);
    for (const Property& p : known->second->properties)
      if (!only_methods)
        names.push_back(p.name);
  }
  return names;
}

} // namespace

std::vector<std::string> Engine::complete(const std::string& prefix) const {
  LuaState& lua = impl_->lua;
  lua_State* L = lua.main;
  const int top = lua_gettop(L);
  const auto is_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::vector<std::string> found;
  lua_pushglobaltable(L);
  std::size_t begin = 0;
  bool only_methods = false;
  for (std::size_t i = 0; i < prefix.size(); ++i) {
    if (is_name(prefix[i]))
      continue;
    if (prefix[i] != '.' && prefix[i] != ':')
      return lua_settop(L, top), found;
    // One more step down; raw, so that completing never runs code of the script.
    if (lua_type(L, -1) != LUA_TTABLE)
      return lua_settop(L, top), found;
    lua_pushlstring(L, prefix.data() + begin, i - begin);
    lua_rawget(L, -2);
    begin = i + 1;
    only_methods = prefix[i] == ':';
  }
  const std::string start = prefix.substr(begin);
  for (const std::string& name : member_names(lua, L, only_methods))
    if (name.compare(0, start.size(), start) == 0)
      found.push_back(prefix.substr(0, begin) + name);
  lua_settop(L, top);
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<ParameterInfo> Engine::parameters() const {
  std::vector<ParameterInfo> all;
  for (const Parameter& p : impl_->session.parameters)
    all.push_back(p.info);
  return all;
}

namespace {

// Stages of one kind that follow each other share a line.
std::string stage_lines(const std::vector<Stage>& stages, int model) {
  std::string out;
  for (std::size_t first = 0, last = 0; first < stages.size(); first = last) {
    const auto joins = [&](const Stage& s) {
      return s.model == stages[first].model && s.kind == stages[first].kind;
    };
    for (last = first; last < stages.size() && joins(stages[last]);)
      ++last;
    if (stages[first].model != model)
      continue;
    const std::string number = std::to_string(stages[first].number);
    out += (last - first == 1 ? "  stage " + number
                              : "  stages " + number + "-" + std::to_string(stages[last - 1].number)) +
           ": " + stages[first].kind + "\n";
  }
  return out;
}

} // namespace

std::string Engine::model_summary() const {
  const Session& session = impl_->session;
  std::string out;
  for (std::size_t i = 0; i < session.notes.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    out += "model " + std::to_string(number) + ": " + session.notes[i]->built + "\n";
    for (const std::string& line : session.notes[i]->process_zones)
      out += "  " + line + "\n";
    for (const std::string& line : session.notes[i]->advice)
      out += "  " + line + "\n";
    for (const std::string& line : session.notes[i]->apart)
      out += "  " + line + "\n";
    for (const std::string& line : session.notes[i]->conditions)
      out += "  " + line + "\n";
    out += stage_lines(session.stages, number);
  }
  return out;
}

std::string Engine::leave_stuck_script() {
  LuaState& lua = impl_->lua;
  impl_->session.checkpoints.stop_in_call();
  const Bound* const running = lua.running;
  const unsigned looks = lua.looks;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  if (lua.looks != looks) // it runs on: what it stands in cannot be read
    return running ? running->shown : "";
  const std::string place = lua.where(lua.main);
  return place + (running ? (place.empty() ? "" : ", ") + running->shown : "");
}

bool Engine::model_saved_after_failure() {
  const Value written = led("the last good state", [this]() -> Value { return impl_->save_failed(); });
  return *written.get<bool>();
}

bool Engine::Impl::save_failed() {
  bool written = false;
  for (const auto& model : session.failed) {
    const std::string name =
        model->number == 1 ? "last_good.vtu" : "last_good_" + std::to_string(model->number) + ".vtu";
    const std::string path = session.files.to_write(name).string();
    const Snapshot snapshot =
        model->simulation.last_good_snapshot(model->title(session) + ", last good state");
    write_vtu(snapshot, path);
    write_bonds(snapshot, session.files.to_write(bonds_path(name)).string());
    written = true;
  }
  return written;
}

} // namespace cdem::script
