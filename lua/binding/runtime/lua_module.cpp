// The `cdem` table and the metatables of its classes, made from the module's declarations.
#include "lua/binding/module/embedded.hpp"
#include "lua/binding/replay/led.hpp"
#include "lua/binding/runtime/lua_state.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <lua.hpp>
#include <new>

namespace cdem::script {

namespace {

std::string shown_call(const Bound& bound) {
  std::string fields;
  for (const Field& f : bound.function->fields)
    if (f.must && fields.size() < 60)
      fields += (fields.empty() ? "" : ", ") + f.name + " = ...";
  return bound.shown + (fields.empty() ? "{ ... }" : "{ " + fields + " }");
}

// One table of named values; nil for a call without any.
Value read_arguments(lua_State* L, const Bound& bound, int first) {
  const Function& function = *bound.function;
  Values given;
  for (int i = first; i <= lua_gettop(L); ++i)
    given.push_back(to_value(L, i));
  const bool bare = function.fields.empty(); // counts() may also be written counts{}
  if (function.in_order || bare) {
    // max("displacement.x", "y+") may also be written max{ field = "displacement.x", on = "y+" }.
    const Table* named = given.size() == 1 ? given[0].table() : nullptr;
    if (named && named->items.empty() && (bare || (function.named_too && !named->named.empty())))
      return given[0];
    return named_in_order(given, function.fields);
  }
  if (given.size() > 1)
    throw geom::InputError("takes one table: " + shown_call(bound));
  Value argument = given.empty() ? Value() : given[0];
  if (!argument.is_nil() && !argument.table())
    throw geom::InputError("takes a table with named values, not " + describe(argument) + ": " +
                           shown_call(bound));
  return argument;
}

std::shared_ptr<Object> read_self(lua_State* L, const Bound& bound) {
  auto object = lua_gettop(L) >= 1 ? to_value(L, 1).object() : nullptr;
  if (!object || object->class_name() != bound.owner->name)
    throw geom::InputError("call it with a colon on a cdem." + bound.owner->name + ": " + bound.shown +
                           "(...)");
  return object;
}

// Through the journal, by which a resumed script is told the same again.
Value answer(Session& session, const Bound& bound, Object* self, const Arguments& arguments) {
  const auto* model = dynamic_cast<const ModelObject*>(self);
  Replay replay = bound.function->replay;
  if (replay == Replay::standard)
    replay = model ? Replay::recorded : Replay::never;
  const int number = model ? model->number : 0;
  return session.checkpoints.call(
      bound.shown, replay, number,
      [&] { return fnv1a(std::to_string(number) + " " + arguments.canonical()); },
      [&] {
        if (model)
          model->touched = false;
        const auto body = [&] { return bound.function->body(session, self, arguments); };
        // Rank 0 alone looks at the model then.
        const std::shared_ptr<void> whole =
            model && bound.function->led && with_others() ? model->simulation.show_lead() : nullptr;
        Value result = bound.function->led ? led(bound.shown, body) : body();
        if (model && model->touched)
          session.checkpoints.keep_call();
        return result;
      });
}

// Every function and method of the module comes through here.
int call_bound(lua_State* L) {
  const auto& bound = *static_cast<const Bound*>(lua_touserdata(L, lua_upvalueindex(1)));
  LuaState& state = LuaState::of(L);
  std::string message;
  try {
    struct Current { // callbacks run on the coroutine that made the call
      LuaState& state;
      lua_State* caller;
      const Bound* outer;
      ~Current() {
        state.current = caller;
        state.running = outer;
      }
    } current{state, state.current, state.running};
    state.current = L;
    state.running = &bound;
    std::shared_ptr<Object> self;
    if (bound.owner)
      self = read_self(L, bound);
    const Value given = read_arguments(L, bound, bound.owner ? 2 : 1);
    const Arguments arguments = check(given, bound.function->fields);
    // Before anything is computed, and in a check: a run shall not end at the name of its picture.
    for (const Field& field : bound.function->fields)
      if (field.is_output && arguments.has(field.name))
        state.session.files.would_write(arguments.text(field.name));
    for (const std::string& remark : remarks_on(given, bound.function->fields))
      state.session.warn(bound.shown + ": " + remark);
    const Value result = answer(state.session, bound, self.get(), arguments);
    lua_settop(L, 0);
    push(L, result);
    return 1;
  } catch (const std::exception&) {
    message = state.message_of_current_exception(L, bound.shown);
  }
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

const Class& class_of_upvalue(lua_State* L) {
  return *static_cast<const Class*>(lua_touserdata(L, lua_upvalueindex(1)));
}

std::vector<std::string> member_names(const Class& c) {
  std::vector<std::string> names;
  for (const Property& p : c.properties)
    names.push_back(p.name);
  for (const Function& f : c.methods)
    names.push_back(f.name);
  return names;
}

Object& object_at_1(lua_State* L) {
  return **static_cast<std::shared_ptr<Object>*>(lua_touserdata(L, 1));
}

std::string key_at_2(lua_State* L) {
  return lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : describe(to_value(L, 2));
}

// Upvalues: the class, its methods.
int index_object(lua_State* L) {
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL)
    return 1;
  const Class& c = class_of_upvalue(L);
  LuaState& state = LuaState::of(L);
  std::string message;
  try {
    if (c.item && lua_isinteger(L, 2)) {
      const std::int64_t i = lua_tointeger(L, 2);
      const Object& self = object_at_1(L);
      push(L, state.session.checkpoints.call(
                  c.name + "[i]", Replay::recorded, 0, [&] { return static_cast<std::uint64_t>(i); },
                  [&] { return i >= 1 && i <= c.length(self) ? c.item(self, i) : Value(); }));
      return 1;
    }
    const std::string key = key_at_2(L);
    for (const Property& p : c.properties) {
      if (p.name != key)
        continue;
      Object& self = object_at_1(L);
      const auto* model = dynamic_cast<const ModelObject*>(&self);
      const int number = model ? model->number : 0;
      push(L, state.session.checkpoints.call(
                  "model." + key, model && p.name != "memory" ? Replay::recorded : Replay::never, number,
                  [&] { return fnv1a(std::to_string(number)); }, [&] { return p.get(state.session, self); }));
      return 1;
    }
    throw geom::InputError(
        key + ": no such name" +
        (c.methods.empty() && c.properties.empty() ? "" : which_there_are(key, member_names(c), "It has")));
  } catch (const std::exception&) {
    message = state.message_of_current_exception(L, "cdem." + c.name);
  }
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

int set_in_object(lua_State* L) {
  const Class& c = class_of_upvalue(L);
  LuaState& state = LuaState::of(L);
  std::string message;
  try {
    const std::string key = key_at_2(L);
    std::vector<std::string> settable;
    for (const Property& p : c.properties) {
      if (!p.set)
        continue;
      settable.push_back(p.name);
      if (p.name == key) {
        p.set(state.session, object_at_1(L), to_value(L, 3));
        return 0;
      }
    }
    throw geom::InputError(key + ": cannot be set" +
                           (settable.empty() ? "" : "; only " + joined(settable) + " can"));
  } catch (const std::exception&) {
    message = state.message_of_current_exception(L, "cdem." + c.name);
  }
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

int length_of_object(lua_State* L) {
  const Class& c = class_of_upvalue(L);
  LuaState& state = LuaState::of(L);
  std::string message;
  try {
    const Object& self = object_at_1(L);
    // What has items grows while a model runs.
    push(L, state.session.checkpoints.call(
                "#" + c.name, c.item ? Replay::recorded : Replay::never, 0, [] { return std::uint64_t{0}; },
                [&] { return Value(c.length(self)); }));
    return 1;
  } catch (const std::exception&) {
    message = state.message_of_current_exception(L, "cdem." + c.name);
  }
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

int text_of_object(lua_State* L) {
  const Class& c = class_of_upvalue(L);
  const std::string text = c.text ? c.text(object_at_1(L)) : "cdem." + c.name;
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// A reset pointer rather than a destroyed one: a finaliser of the script may still see the object.
int collect_object(lua_State* L) {
  static_cast<std::shared_ptr<Object>*>(lua_touserdata(L, 1))->reset();
  return 0;
}

void push_bound(lua_State* L, const Function& function, std::string shown, const Class* owner) {
  LuaState& state = LuaState::of(L);
  state.bound.push_back({&function, std::move(shown), owner});
  lua_pushlightuserdata(L, &state.bound.back());
  lua_pushcclosure(L, call_bound, 1);
}

void make_class(lua_State* L, const Class& c) {
  LuaState& state = LuaState::of(L);
  luaL_newmetatable(L, ("cdem." + c.name).c_str());
  const int metatable = lua_gettop(L);
  state.metatables[lua_topointer(L, metatable)] = &c;
  auto* self = const_cast<void*>(static_cast<const void*>(&c));
  const auto set = [&](const char* name, lua_CFunction function) {
    lua_pushlightuserdata(L, self);
    lua_pushcclosure(L, function, 1);
    lua_setfield(L, metatable, name);
  };
  std::string variable = c.name;
  for (char& letter : variable)
    letter = static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter);
  lua_pushlightuserdata(L, self);
  lua_newtable(L);
  for (const Function& f : c.methods) {
    push_bound(L, f, variable + ":" + f.name, &c);
    lua_setfield(L, -2, f.name.c_str());
  }
  lua_pushcclosure(L, index_object, 2);
  lua_setfield(L, metatable, "__index");
  set("__newindex", set_in_object);
  set("__tostring", text_of_object);
  set("__gc", collect_object);
  if (c.length)
    set("__len", length_of_object);
  lua_pushboolean(L, 0);
  lua_setfield(L, metatable, "__metatable");
  lua_pop(L, 1);
}

// Unknown names of the module: cdem.elastics is an error at once, not a nil that is called later.
int unknown_name(lua_State* L) {
  LuaState& state = LuaState::of(L);
  std::vector<std::string> names;
  const std::string key = key_at_2(L), place = state.where(L);
  std::string inner; // cdem.solid.cylinder, where cdem.cylinder was written
  lua_pushnil(L);
  while (lua_next(L, 1)) {
    if (lua_type(L, -2) == LUA_TSTRING) {
      names.emplace_back(lua_tostring(L, -2));
      if (lua_istable(L, -1)) {
        lua_pushstring(L, key.c_str());
        if (lua_rawget(L, -2) != LUA_TNIL)
          inner = "; did you mean cdem." + names.back() + "." + key + "?";
        lua_pop(L, 1);
      }
    }
    lua_pop(L, 1);
  }
  const std::string message = (place.empty() ? "" : place + ": ") + "cdem." + key + ": no such name" +
                              (inner.empty() ? did_you_mean(key, names) : inner);
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

void set_unknown_name(lua_State* L) {
  lua_newtable(L);
  lua_pushcfunction(L, unknown_name);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
}

// The Lua side: each file is a function of the module that adds to it.
void add_embedded(lua_State* L, int module_index) {
  for (int i = 0; i < embedded_file_count; ++i) {
    const EmbeddedFile& file = embedded_files[i];
    const std::string text = file.text;
    // The name keeps these lines out of a script's error messages.
    if (luaL_loadbufferx(L, text.data(), text.size(), "=[cdem]", "t") != LUA_OK)
      lua_error(L);
    lua_pushvalue(L, module_index);
    lua_call(L, 1, 0);
  }
}

} // namespace

void push_module(lua_State* L) {
  const Module& all = module();
  for (const Class& c : all.classes)
    make_class(L, c);
  lua_newtable(L);
  const int table = lua_gettop(L);
  for (const Function& f : all.functions) {
    if (!f.body)
      continue; // defined on the Lua side
    const auto dot = f.name.find('.');
    push_bound(L, f, "cdem." + f.name, nullptr);
    if (dot == std::string::npos) {
      lua_setfield(L, table, f.name.c_str());
      continue;
    }
    const std::string group = f.name.substr(0, dot);
    if (lua_getfield(L, table, group.c_str()) == LUA_TNIL) {
      lua_pop(L, 1);
      lua_newtable(L);
      lua_pushvalue(L, -1);
      lua_setfield(L, table, group.c_str());
    }
    lua_insert(L, -2);
    lua_setfield(L, -2, f.name.substr(dot + 1).c_str());
    lua_pop(L, 1);
  }
  for (const Constant& c : all.constants) {
    push(L, c.value);
    lua_setfield(L, table, c.name.c_str());
  }
  add_embedded(L, table);
  for (const Function& f : all.functions) {
    const auto dot = f.name.find('.');
    if (dot == std::string::npos)
      continue;
    lua_getfield(L, table, f.name.substr(0, dot).c_str());
    set_unknown_name(L);
    lua_pop(L, 1);
  }
  set_unknown_name(L);
}

} // namespace cdem::script
