// Values between Lua and C++.
#include "lua/binding/runtime/lua_state.hpp"

#include "libgeom/core/error.hpp"

#include <lua.hpp>

namespace cdem::script {

// Holds a Lua value through the registry. Outliving the interpreter is allowed; use after its end is an
// error.
class LuaReference final : public Reference {
public:
  LuaReference(lua_State* L, int index) : alive_(LuaState::of(L).alive) {
    if (lua_isfunction(L, index)) {
      lua_Debug info;
      lua_pushvalue(L, index);
      lua_getinfo(L, ">S", &info);
      place_ = info.linedefined > 0 ? std::string(info.short_src) + ":" + std::to_string(info.linedefined)
                                    : std::string(info.short_src);
    }
    lua_pushvalue(L, index);
    key_ = luaL_ref(L, LUA_REGISTRYINDEX);
  }
  ~LuaReference() override {
    if (*alive_)
      luaL_unref((*alive_)->main, LUA_REGISTRYINDEX, key_);
  }
  LuaReference(const LuaReference&) = delete;
  LuaReference& operator=(const LuaReference&) = delete;

  Values call(const Values& arguments) const override {
    LuaState& state = interpreter();
    lua_State* L = state.current;
    luaL_checkstack(L, static_cast<int>(arguments.size()) + 8, "callback");
    const int top = lua_gettop(L);
    push_self(L);
    for (const Value& argument : arguments)
      push(L, argument);
    state.call(L, static_cast<int>(arguments.size()), LUA_MULTRET);
    Values results;
    for (int i = top + 1; i <= lua_gettop(L); ++i)
      results.push_back(to_value(L, i));
    lua_settop(L, top);
    return results;
  }

  Value copy() const override {
    lua_State* L = interpreter().current;
    push_self(L);
    Value value = to_value(L, -1);
    lua_pop(L, 1);
    return value;
  }

  std::string place() const override { return place_; }

  void push_self(lua_State* L) const { lua_rawgeti(L, LUA_REGISTRYINDEX, key_); }

private:
  LuaState& interpreter() const {
    if (!*alive_)
      throw std::logic_error("a Lua function was called after the script had ended");
    return **alive_;
  }

  std::shared_ptr<LuaState*> alive_;
  int key_ = LUA_NOREF;
  std::string place_;
};

namespace {

constexpr int deepest_table = 32;

std::string key_text(lua_State* L, int index) {
  if (lua_isinteger(L, index))
    return "item " + std::to_string(lua_tointeger(L, index)) + ": a list has items 1, 2, 3 ... without holes";
  if (lua_isnumber(L, index))
    return "key " + number_text(lua_tonumber(L, index)) + ": keys are names or 1, 2, 3 ...";
  return std::string("key of type ") + luaL_typename(L, index) + ": keys are names or 1, 2, 3 ...";
}

Value convert(lua_State* L, int index, int depth);

Value convert_table(lua_State* L, int index, int depth) {
  if (depth > deepest_table)
    throw geom::InputError("table nested more than " + std::to_string(deepest_table) +
                           " deep; does it contain itself?");
  luaL_checkstack(L, 4, "nested tables");
  Table table;
  const auto length = static_cast<lua_Integer>(lua_rawlen(L, index));
  table.items.resize(static_cast<std::size_t>(length));
  lua_pushnil(L);
  while (lua_next(L, index)) {
    const int value = lua_gettop(L);
    if (lua_isinteger(L, -2) && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= length)
      table.items[static_cast<std::size_t>(lua_tointeger(L, -2) - 1)] = convert(L, value, depth + 1);
    else if (lua_type(L, -2) == LUA_TSTRING)
      table.named[lua_tostring(L, -2)] = convert(L, value, depth + 1);
    else if (table.odd_keys.empty())
      table.odd_keys = key_text(L, value - 1);
    lua_pop(L, 1);
  }
  return table;
}

// Something of Lua's that is no plain value: a file, a coroutine.
class Foreign final : public Object {
public:
  explicit Foreign(std::string type) : type_(std::move(type)) {}
  const char* class_name() const override { return type_.c_str(); }
  std::string shown() const override { return "a " + type_; }

private:
  std::string type_;
};

Value convert(lua_State* L, int index, int depth) {
  switch (lua_type(L, index)) {
  case LUA_TNIL:
    return {};
  case LUA_TBOOLEAN:
    return lua_toboolean(L, index) != 0;
  case LUA_TNUMBER:
    if (lua_isinteger(L, index))
      return static_cast<std::int64_t>(lua_tointeger(L, index));
    return static_cast<double>(lua_tonumber(L, index));
  case LUA_TSTRING: {
    std::size_t size = 0;
    const char* text = lua_tolstring(L, index, &size);
    return std::string(text, size);
  }
  case LUA_TTABLE:
    return convert_table(L, lua_absindex(L, index), depth);
  case LUA_TFUNCTION:
    return make_reference(L, lua_absindex(L, index));
  case LUA_TUSERDATA: {
    LuaState& state = LuaState::of(L);
    if (lua_getmetatable(L, index)) {
      const bool ours = state.metatables.count(lua_topointer(L, -1)) > 0;
      lua_pop(L, 1);
      if (ours) {
        const auto& object = *static_cast<std::shared_ptr<Object>*>(lua_touserdata(L, index));
        return object ? Value(object) : Value();
      }
    }
    break;
  }
  default:
    break;
  }
  return std::static_pointer_cast<Object>(std::make_shared<Foreign>(luaL_typename(L, index)));
}

} // namespace

Value to_value(lua_State* L, int index) {
  return convert(L, index, 0);
}

std::shared_ptr<Reference> make_reference(lua_State* L, int index) {
  return std::make_shared<LuaReference>(L, lua_absindex(L, index));
}

void push(lua_State* L, const Value& value) {
  luaL_checkstack(L, 4, "results");
  if (const auto* flag = value.get<bool>()) {
    lua_pushboolean(L, *flag);
  } else if (const auto* integer = value.get<std::int64_t>()) {
    lua_pushinteger(L, *integer);
  } else if (const auto* number = value.get<double>()) {
    lua_pushnumber(L, *number);
  } else if (const auto* text = value.get<std::string>()) {
    lua_pushlstring(L, text->data(), text->size());
  } else if (const Table* table = value.table()) {
    lua_createtable(L, static_cast<int>(table->items.size()), static_cast<int>(table->named.size()));
    for (std::size_t i = 0; i < table->items.size(); ++i) {
      push(L, table->items[i]);
      lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
    for (const auto& [name, entry] : table->named) {
      lua_pushlstring(L, name.data(), name.size());
      push(L, entry);
      lua_rawset(L, -3);
    }
  } else if (const auto reference = value.reference()) {
    static_cast<const LuaReference&>(*reference).push_self(L);
  } else if (auto object = value.object()) {
    const std::string metatable = std::string("cdem.") + object->class_name();
    auto* place = lua_newuserdatauv(L, sizeof(std::shared_ptr<Object>), 0);
    new (place) std::shared_ptr<Object>(std::move(object));
    luaL_setmetatable(L, metatable.c_str());
  } else {
    lua_pushnil(L);
  }
}

} // namespace cdem::script
