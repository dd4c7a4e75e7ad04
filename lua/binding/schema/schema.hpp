// What a bound function takes: fields with type, unit, range, default and a sentence. The same declaration
// checks the arguments (schema_check.cpp), writes the editor annotations (annotations.cpp) and the reference
// page (reference.cpp), so the three cannot drift apart.
#pragma once

#include "lua/binding/schema/value.hpp"

#include <optional>

namespace cdem::script {

enum class Kind {
  flag,     // boolean
  integer,  // whole number
  number,   // finite number
  text,     // string
  choice,   // one of a few strings
  vec3,     // three numbers
  list,     // items of one type
  tuple,    // items of given types, in order
  record,   // table with its own fields
  named,    // table of items of one type under names of the user's
  function, // Lua function
  object,   // something made by the module
  place,    // where: side, name, selection, predicate, or a list of these
  scalar,   // string, number or boolean
  plain,    // scalar or table of plain values
};

// "A|B" as a message or a type says it.
std::string with_or(std::string names, const std::string& between);

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;

  bool holds(double x) const;
  std::string text() const; // "> 0", "in (-1, 0.5)", "" when unlimited
};

// Limits beyond which nothing a model is made of lies. Without them the squares and products of geometry overflow, and
// counts taken from lengths lose their meaning.
inline constexpr double largest_quantity = 1e60; // in SI units, and components of directions
inline constexpr double largest_length = 1e8;    // m
inline constexpr double least_length = 1e-9;     // m, of what must be above zero

// Values strictly between the two are allowed, and hardly meant in this unit: the call warns of them with the hint.
struct Doubt {
  double above, below;
  std::string hint;
};

struct Field;

struct Type {
  Kind kind = Kind::number;
  Range range{};      // integer, number, and every component of vec3
  bool whole = false; // vec3 of whole numbers
  double largest =
      std::numeric_limits<double>::infinity(); // of a number's magnitude; what has a unit has a limit
  bool length = false;                         // in m
  std::vector<Doubt> doubts{};                 // number; vec3: of its length
  std::vector<std::string> choices{};          // choice
  bool or_number = false; // function: a finite number in the range will do, for one that does not vary
  bool or_vec3 = false;   // function: three finite numbers will do
  bool or_record = false; // function: a table over time will do, a cdem.Record or a list of {time, value}
  bool or_object = false; // function: an object of the class `object` will do, for one that does not vary
  std::string object{};   // class, with or_object
  std::string
      name{}; // object: class, or "A|B" for either; function: its parameters, e.g. "(time: number): number"
  std::vector<Type> items{};   // list, named: one; tuple: one per place
  std::size_t min_items = 0;   // list
  std::vector<Field> fields{}; // record, or_record; list: values with a name beside its items

  std::string lua_type() const; // as LuaCATS writes it
  std::string words() const;    // as a message says it: "a number", "a list of numbers"
};

struct Field {
  std::string name;
  Type type;
  std::string unit_text{}, doc_text{};
  bool must = false;
  Value standard_value{};      // default; nil when there is none
  std::string old_name{};      // that the last release knew, still taken; empty: none
  bool own_standard = false;   // the default is that of the struct that it is read into
  bool radians_inside = false; // of a number in degrees
  bool is_output = false;      // text: a file that the call writes

  Field& unit(std::string text);
  Field& doc(std::string text);
  Field& required();
  Field& standard(Value value);
  Field& standard(); // that of the struct that it is read into (module/record.hpp)
  Field& in_degrees();
  Field& output();                         // a file that the call writes, in the output folder
  Field& above(double low);                // > low
  Field& at_least(double low);             // >= low
  Field& up_to(double high);               // <= high, beside a low
  Field& between(double low, double high); // in (low, high)
  Field& within(double low, double high);  // in [low, high]
  Field& from(double low, double high);    // in [low, high)
  Field& beside(std::vector<Field> named); // of a list: { name = value, item, ... }
  Field& doubted(double above, double below, std::string hint);
  Field& formerly(std::string old_name);
};

// Fields by type.
Field flag(std::string name);
Field integer(std::string name);
Field number(std::string name, std::string unit = "");
Field text(std::string name);
Field choice(std::string name, std::vector<std::string> choices);
Field vec3(std::string name, std::string unit = "");
Field ivec3(std::string name);
Field box(std::string name); // { min, max }, m
Field object(std::string name, std::string class_name);
Field place(std::string name);
Field function(std::string name, std::string signature);
Field number_or_function(std::string name, std::string signature);
Field function_or_record(std::string name, std::string signature,
                         std::vector<Field> fields); // times, values, ...
Field vec3_or_function(std::string name, std::string signature);
Field object_or_function(std::string name, std::string class_name, std::string signature);
Field scalar(std::string name);
Field plain(std::string name);
Field record(std::string name, std::vector<Field> fields);
Field list(std::string name, Type item, std::size_t min_items = 1);
Field named(std::string name, Type item); // { any_name = item, ... }, one at least

std::vector<Field> operator+(std::vector<Field>, const std::vector<Field>&); // one after the other

// Types for the items of a list.
Type number_type();
Type text_type();
Type scalar_type();
Type vec3_type();
Type object_type(std::string class_name);
Type record_type(std::vector<Field> fields);
Type object_or_function_type(std::string class_name, std::string signature);
Type tuple_type(std::vector<Type> items);
Type list_type(Type item, std::size_t min_items = 1);

// Checked arguments. A name that was not declared is a mistake of ours: assert.
class Arguments {
public:
  Arguments() : table_(std::make_shared<Table>()) {}
  explicit Arguments(std::shared_ptr<Table> checked) : table_(std::move(checked)) {}

  bool has(const std::string& name) const { return table_->named.count(name) > 0; }
  const Value& value(const std::string& name) const; // nil when absent
  bool flag(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  int count(const std::string& name) const; // an integer that an int holds; InputError for a larger one
  double number(const std::string& name) const;
  std::optional<double> optional_number(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  std::string text_or(const std::string& name, const std::string& otherwise) const;
  geom::Vec3 vec3(const std::string& name) const;
  std::optional<geom::Vec3> optional_vec3(const std::string& name) const;
  geom::Box box(const std::string& name) const;
  std::array<int, 3> ivec3(const std::string& name) const;
  const Values& list(const std::string& name) const; // empty when absent
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  std::vector<Arguments> records(const std::string& name) const;
  std::optional<Arguments> record(const std::string& name) const;
  std::shared_ptr<Reference> function(const std::string& name) const; // null when absent
  template <class T>
  std::shared_ptr<T> object(const std::string& name) const {
    return std::dynamic_pointer_cast<T>(value(name).object());
  }
  const Table& table() const { return *table_; }
  std::string canonical() const { return canonical_text(Value(*table_)); }

private:
  std::shared_ptr<Table> table_;
};

geom::Vec3 to_vec3(const Value&); // of a checked vec3

// Checks a table against fields and fills defaults in. Throws geom::InputError naming the field (path such as
// "bodies[2].material"), its value, what is allowed and what to do.
Arguments check(const Value& given, const std::vector<Field>& fields);
// Arguments given in order, as the table that check() takes.
Value named_in_order(const Values& given, const std::vector<Field>& fields);
// What a call is warned of once check() has passed its arguments: old names, values that are doubted. One line each.
std::vector<std::string> remarks_on(const Value& given, const std::vector<Field>& fields);
// One value against one type; returns it as Arguments reads it.
Value check_value(const Value& given, const Type& type, const std::string& path);

} // namespace cdem::script
