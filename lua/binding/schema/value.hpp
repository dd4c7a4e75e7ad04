// Values that pass between a script and the toolkit, as plain C++: the binding files include these and never a Lua
// header.
#pragma once

#include "libgeom/core/types.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cdem::script {

class Value;
using Values = std::vector<Value>;

// A Lua table: items 1..n and named entries, the latter in alphabetical order because Lua's own order is not
// reproducible. odd_keys describes keys that are neither (holes, fractions, booleans).
struct Table;

// Something of ours that a script holds: a material, an assembly, a model.
class Object {
public:
  virtual ~Object() = default;
  virtual const char* class_name() const = 0; // name of its Class in the module
  virtual std::string shown() const { return std::string("cdem.") + class_name(); } // in messages
};

// Something of the script's that we hold: a function, or the table model.memory.
class Reference {
public:
  virtual ~Reference() = default;
  virtual Values call(const Values& arguments) const = 0; // errors of the script arrive as ScriptError
  virtual Value copy() const = 0;        // plain copy of a table; InputError for anything not plain
  virtual std::string place() const = 0; // where a function was written: "case.lua:12"
};

class Value {
public:
  using Data = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::shared_ptr<Table>,
                            std::shared_ptr<Object>, std::shared_ptr<Reference>>;

  Value() = default;
  Value(bool x) : data_(x) {}
  Value(int x) : data_(static_cast<std::int64_t>(x)) {}
  Value(std::int64_t x) : data_(x) {}
  Value(double x) : data_(x) {}
  Value(const char* x) : data_(std::string(x)) {}
  Value(std::string x) : data_(std::move(x)) {}
  Value(Table x);
  Value(std::shared_ptr<Reference> x) : data_(std::move(x)) {}
  template <class T, class = std::enable_if_t<std::is_base_of_v<Object, T>>>
  Value(std::shared_ptr<T> x) : data_(std::static_pointer_cast<Object>(std::move(x))) {}
  Value(const geom::Vec3& x);
  Value(const geom::Box& x);  // { min, max }
  Value(const geom::Mat3& x); // rows
  template <std::size_t n>
  Value(const std::array<double, n>& x);

  bool is_nil() const { return std::holds_alternative<std::monostate>(data_); }
  bool is_number() const {
    return std::holds_alternative<std::int64_t>(data_) || std::holds_alternative<double>(data_);
  }
  template <class T>
  const T* get() const {
    return std::get_if<T>(&data_);
  }
  const Table* table() const;
  std::shared_ptr<Object> object() const;
  std::shared_ptr<Reference> reference() const;
  double number() const; // of an integer or a float

  const Data& data() const { return data_; }

private:
  Data data_;
};

struct Table {
  Values items;
  std::map<std::string, Value> named;
  std::string odd_keys;

  Table() = default;
  Table(std::initializer_list<std::pair<const std::string, Value>> entries) : named(entries) {}
  static Table list(Values values);
};

template <std::size_t n>
Value::Value(const std::array<double, n>& x) {
  *this = Value(Table::list(Values(x.begin(), x.end())));
}

// What C++ has as a script gets it: an absent optional as nil, a vector as a list, any integer.
template <class T>
Value as_value(const T& x) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    return Value(static_cast<std::int64_t>(x));
  else
    return Value(x);
}
template <class T>
Value as_value(const std::optional<T>& x) {
  return x ? as_value(*x) : Value();
}
template <class T>
Value as_value(const std::vector<T>& x) {
  Values items;
  for (const T& item : x)
    items.push_back(as_value(item));
  return Table::list(std::move(items));
}

// A number as a person would write it: shortest text that reads back to the same double.
std::string number_text(double x);
// One line for messages: 12, 0.5, "text", {0.3, 0.3}, function, cdem.Material. Long tables are shortened.
std::string describe(const Value&);
// The whole value, unambiguous and in a fixed order: what a call's arguments are hashed by. Objects stand by
// their class; functions by the word alone: where they were written depends on the folder one stands in, and a mended
// script may have moved them.
std::string canonical_text(const Value&);
std::uint64_t fnv1a(const std::string& text);

} // namespace cdem::script
