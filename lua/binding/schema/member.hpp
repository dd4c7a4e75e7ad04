// Members of structs as scripts give and get them: read() and shown() by the type of the member. Angles are in degrees in
// scripts and in radians inside; an enumerator is the choice at its place, and so is a flag with two choices. A function
// is one of the script, or the number or vector that the script gives instead.
#pragma once

#include "lua/binding/schema/angles.hpp"
#include "lua/binding/schema/answers.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <type_traits>

namespace cdem::script {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
inline constexpr bool is_function = false;
template <class T>
inline constexpr bool is_function<std::function<T>> = true;

template <class M>
Value shown(const M& x, const Field& field) {
  if constexpr (is_optional<M>)
    return x ? shown(*x, field) : Value();
  else if constexpr (is_function<M>)
    return {}; // that scripts give alone
  else if constexpr (std::is_enum_v<M>)
    return field.type.choices.at(static_cast<std::size_t>(x));
  else if constexpr (std::is_same_v<M, bool>)
    return field.type.choices.empty() ? Value(x) : Value(field.type.choices.at(x));
  else if constexpr (std::is_same_v<M, double>)
    return field.radians_inside ? degrees(x) : x;
  else
    return as_value(x);
}

inline std::size_t choice_index(const Arguments& a, const Field& field) {
  const std::vector<std::string>& all = field.type.choices;
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), a.text(field.name)) - all.begin());
}

template <class M>
void read(const Arguments& a, const Field& field, M& x);

// in: places, and numbers.
template <class R, class... In>
void read(const Arguments& a, const Field& field, std::function<R(In...)>& x) {
  const auto function = a.function(field.name);
  if (function) {
    x = [function, field](In... in) {
      Values arguments;
      const auto add = [&](const auto& one) {
        if constexpr (std::is_same_v<std::decay_t<decltype(one)>, double>)
          arguments.emplace_back(one);
        else
          arguments.insert(arguments.end(), {one.x(), one.y(), one.z()});
      };
      (add(in), ...);
      if constexpr (std::is_same_v<R, double>)
        return number_answered(*function, field, arguments);
      else
        return vector_answered(*function, field, arguments);
    };
  } else if (a.has(field.name)) {
    R constant;
    read(a, field, constant);
    x = [constant](In...) { return constant; };
  }
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
    x = static_cast<M>(choice_index(a, field));
  } else if constexpr (std::is_same_v<M, bool>) {
    x = field.type.choices.empty() ? a.flag(name) : choice_index(a, field) == 1;
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
