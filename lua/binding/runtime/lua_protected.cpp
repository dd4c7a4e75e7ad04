// Protected calls and coroutines that an interrupt passes through: a script can catch errors, not a Ctrl-C.
#include "lua/binding/runtime/lua_library.hpp"

#include <lua.hpp>

namespace cdem::script {

namespace {

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

} // namespace

void use_interruptible_calls(lua_State* L) {
  lua_register(L, "pcall", safe_pcall);
  lua_register(L, "xpcall", safe_xpcall);
  lua_getglobal(L, "coroutine");
  replace_with(L, "resume", then_rethrow);
  replace_with(L, "close", then_rethrow);
  lua_pop(L, 1);
}

} // namespace cdem::script
