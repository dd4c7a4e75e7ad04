// Members of structs as scripts give and get them: read() and shown() by the type of the member. Angles are in degrees in
// scripts and in radians inside; an enumerator is the choice at its place.
#pragma once

#include "lua/binding/schema/angles.hpp"
#include "lua/binding/schema/schema.hpp"

#include <algorithm>
#include <cassert>
#include <type_traits>

namespace cdem::script {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class M>
Value shown(const M& x, const Field& field) {
  if constexpr (is_optional<M>)
    return x ? shown(*x, field) : Value();
  else if constexpr (std::is_enum_v<M>)
    return field.type.choices.at(static_cast<std::size_t>(x));
  else if constexpr (std::is_same_v<M, double>)
    return field.radians_inside ? degrees(x) : x;
  else
    return as_value(x);
}

// A member of what is left out stays as it is.
template <class M>
void read(const Arguments& a, const Field& field, M& x) {
  const std::string& name = field.name;
  if (!a.has(name))
    return;
  if constexpr (is_optional<M>) {
    read(a, field, x.emplace());
  } else if constexpr (std::is_enum_v<M>) {
    const std::vector<std::string>& all = field.type.choices;
    x = static_cast<M>(std::find(all.begin(), all.end(), a.text(name)) - all.begin());
  } else if constexpr (std::is_same_v<M, bool>) {
    x = a.flag(name);
  } else if constexpr (std::is_same_v<M, int>) {
    x = a.count(name);
  } else if constexpr (std::is_integral_v<M>) {
    x = static_cast<M>(a.integer(name));
  } else if constexpr (std::is_same_v<M, double>) {
    x = field.radians_inside ? radians(a.number(name)) : a.number(name);
  } else if constexpr (std::is_same_v<M, std::string>) {
    x = a.text(name);
  } else if constexpr (std::is_same_v<M, geom::Vec3>) {
    x = a.vec3(name);
  } else if constexpr (std::is_same_v<M, Value>) {
    x = a.value(name);
  } else if constexpr (std::is_same_v<M, geom::Box>) {
    x = a.box(name);
  } else if constexpr (std::is_same_v<M, std::vector<double>>) {
    x = a.numbers(name);
  } else if constexpr (std::is_same_v<M, std::vector<std::string>>) {
    x = a.texts(name);
  } else if constexpr (std::is_same_v<M, std::vector<geom::Vec3>>) {
    for (const Value& item : a.list(name))
      x.push_back(to_vec3(item));
  } else if constexpr (std::is_same_v<M, std::vector<std::array<double, 2>>>) {
    for (const Value& item : a.list(name))
      x.push_back({item.table()->items[0].number(), item.table()->items[1].number()});
  } else {
    assert(false && "a member that scripts get alone");
  }
}

} // namespace cdem::script
