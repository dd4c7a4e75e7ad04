// A table that a call returns, made of a T: each field is declared once, beside the member of a T, or the function of one,
// that it shows.
#pragma once

#include "lua/binding/module/module.hpp"

#include <cmath>
#include <functional>

namespace cdem::script {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
class Record {
public:
  struct Entry {
    Entry(Field declared) : field(std::move(declared)) {} // the caller adds the value
    // Required, unless get gives an optional or a Value.
    template <class Get>
    Entry(Field declared, Get get)
        : field(std::move(declared)), value([get](const T& x) { return as_value(std::invoke(get, x)); }) {
      using Given = std::decay_t<std::invoke_result_t<Get, const T&>>;
      field.must = field.must || !(is_optional<Given> || std::is_same_v<Given, Value>);
    }
    Field field;
    std::function<Value(const T&)> value;
  };

  Record(std::string name, std::string doc, std::vector<Entry> entries)
      : name_(std::move(name)), doc_(std::move(doc)), entries_(std::move(entries)) {}

  // Without fields that have no value.
  Table operator()(const T& x) const {
    Table table;
    for (const Entry& entry : entries_)
      if (Value value = entry.value ? entry.value(x) : Value(); !value.is_nil())
        table.named[entry.field.name] = std::move(value);
    return table;
  }
  template <class Rows>
  Table list(const Rows& rows) const {
    Table table;
    for (const T& row : rows)
      table.items.emplace_back((*this)(row));
    return table;
  }
  operator RecordType() const {
    RecordType type{name_, doc_, {}};
    for (const Entry& entry : entries_)
      type.fields.push_back(entry.field);
    return type;
  }

private:
  std::string name_, doc_;
  std::vector<Entry> entries_;
};

inline std::optional<double> if_finite(double x) {
  return std::isfinite(x) ? std::optional<double>(x) : std::nullopt;
}

} // namespace cdem::script
