// A struct as scripts see it. Each field is declared once, beside the member of a T, or the function of one, that it
// shows; the declaration checks what a script gives, reads it into a T, and makes the table that a call returns and the
// properties of a class.
#pragma once

#include "lua/binding/module/module.hpp"
#include "lua/binding/schema/member.hpp"

#include <cmath>
#include <functional>

namespace cdem::script {

template <class T>
class Record {
public:
  struct Entry {
    Entry(Field declared) : field(std::move(declared)) {} // the caller reads it, or adds the value

    // A function of a T: for what scripts get alone. Required there, unless it gives an optional or a Value.
    template <class Get, class = std::enable_if_t<!std::is_member_object_pointer_v<Get>>>
    Entry(Field declared, Get get)
        : field(std::move(declared)), input(false),
          always(is_always<std::decay_t<std::invoke_result_t<Get, const T&>>>),
          value([get](const T& x) { return as_value(std::invoke(get, x)); }) {}

    template <class M, class Of, class = std::enable_if_t<std::is_object_v<M>>>
    Entry(Field declared, M Of::*member)
        : field(std::move(declared)), always(is_always<M>),
          value([member, as = field](const T& x) { return shown(x.*member, as); }),
          read([member, as = field](const Arguments& a, T& x) { cdem::script::read(a, as, x.*member); }) {
      if constexpr (std::is_default_constructible_v<T>)
        if (field.own_standard)
          field.standard_value = value(T());
    }

    // A struct within a T, perhaps none, or a list of them.
    template <class M, class Of, class Inner>
    Entry(Field declared, M Of::*member, const Record<Inner>& inner)
        : field(std::move(declared)), always(is_always<M>), value([member, &inner](const T& x) -> Value {
            if constexpr (std::is_same_v<M, Inner>)
              return inner(x.*member);
            else if constexpr (is_optional<M>)
              return x.*member ? Value(inner(*(x.*member))) : Value();
            else
              return inner.list(x.*member);
          }),
          read([member, name = field.name, &inner](const Arguments& a, T& x) {
            if constexpr (std::is_same_v<M, Inner> || is_optional<M>) {
              if (const auto given = a.record(name))
                x.*member = inner.read(*given);
            } else {
              for (const Arguments& given : a.records(name))
                (x.*member).push_back(inner.read(given));
            }
          }) {}

    Field field;
    bool input = true;  // scripts give it, too
    bool always = true; // there, in a table that a call returns
    std::function<Value(const T&)> value{};
    std::function<void(const Arguments&, T&)> read{};

  private:
    template <class M>
    static constexpr bool is_always = !(is_optional<M> || std::is_same_v<M, Value>);
  };

  Record(std::string name, std::string doc, std::vector<Entry> entries)
      : name_(std::move(name)), doc_(std::move(doc)), entries_(std::move(entries)) {}
  Record(std::vector<Entry> entries) : entries_(std::move(entries)) {} // that scripts give, or a class shows

  // What a script gives.
  std::vector<Field> fields() const {
    std::vector<Field> fields;
    for (const Entry& entry : entries_)
      if (entry.input)
        fields.push_back(entry.field);
    return fields;
  }
  // Members of what is left out stay as they are.
  void read(const Arguments& a, T& x) const {
    for (const Entry& entry : entries_)
      if (entry.read)
        entry.read(a, x);
  }
  T read(const Arguments& a) const {
    T x{};
    read(a, x);
    return x;
  }

  // What a call returns, without fields that have no value.
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
    for (const Entry& entry : entries_) {
      type.fields.push_back(entry.field);
      // with a default that is not the struct's a table of the user's may lack it
      const bool left_out = !entry.field.own_standard && !entry.field.standard_value.is_nil();
      type.fields.back().must = entry.field.must || (entry.value && entry.always && !left_out);
    }
    return type;
  }

  // The same as lists with an entry for each row.
  template <class Rows>
  Table columns(const Rows& rows) const {
    Table table;
    for (const Entry& entry : entries_) {
      Values column;
      for (const T& row : rows)
        column.push_back(entry.value(row));
      table.named[entry.field.name] = Table::list(std::move(column));
    }
    return table;
  }
  RecordType of_columns() const {
    RecordType type = *this;
    for (Field& field : type.fields)
      field.type = list_type(field.type, 0);
    return type;
  }

  // As properties of a class whose objects hold a T.
  template <class Holder>
  void add_to(Class& shows, T Holder::*held) const {
    for (const Entry& entry : entries_)
      if (entry.value)
        shows.property(entry.field.name, entry.field.type.lua_type() + (entry.always ? "" : "?"),
                       entry.field.unit_text, entry.field.doc_text,
                       [held, value = entry.value](const Holder& self) { return value(self.*held); });
  }

private:
  std::string name_, doc_;
  std::vector<Entry> entries_;
};

inline std::optional<double> if_finite(double x) {
  return std::isfinite(x) ? std::optional<double>(x) : std::nullopt;
}

} // namespace cdem::script
