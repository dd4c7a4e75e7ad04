// Arguments against their declaration.
#include "lua/binding/schema/schema.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

[[noreturn]] void wrong_type(const std::string& path, const Value& given, const Type& type) {
  std::string advice;
  const bool wants_number = type.kind == Kind::number || type.kind == Kind::integer;
  if (wants_number && given.get<std::string>())
    advice = "write it without quotes";
  else if (type.kind == Kind::vec3 && given.is_number())
    advice = "write all three, e.g. {0, 0, " + describe(given) + "}";
  else if (type.kind == Kind::list && !given.is_nil() && !given.table())
    advice = "put it in braces: {" + describe(given) + "}";
  else if (type.kind == Kind::text && given.is_number())
    advice = "write it in quotes, or tostring(...) around it";
  else if (type.kind == Kind::record && !type.fields.empty() &&
           (given.get<std::string>() || given.is_number()))
    advice = "name the values: { " + type.fields.front().name + " = value, ... }";
  throw InputError(path, describe(given), type.words(), advice);
}

std::vector<std::string> names_of(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  names.reserve(fields.size());
  for (const Field& f : fields)
    names.push_back(f.name);
  return names;
}

double checked_number(const Value& given, const Type& type, const std::string& path) {
  if (!given.is_number())
    wrong_type(path, given, type);
  const double x = given.number();
  if (!std::isfinite(x))
    throw InputError(path, describe(given), "a finite number",
                     "look for a division by zero before this line");
  if (!type.range.holds(x))
    throw InputError(path, describe(given), type.range.text());
  const std::string unit = type.length ? " m" : "";
  if (type.length && type.range.low == 0 && type.range.low_open && x < least_length)
    throw InputError(path, describe(given),
                     "from " + number_text(least_length) + " to " + number_text(largest_length) + unit);
  if (std::abs(x) > type.largest)
    throw InputError(path, describe(given),
                     "from " + number_text(-type.largest) + " to " + number_text(type.largest) + unit);
  return x;
}

std::int64_t checked_integer(const Value& given, const Type& type, const std::string& path) {
  const double x = checked_number(given, type, path);
  if (x != std::floor(x))
    throw InputError(path, describe(given), "a whole number");
  constexpr double most = 9e15; // numbers above have no last digit
  if (std::abs(x) > most)
    throw InputError(path, describe(given), "from " + number_text(-most) + " to " + number_text(most));
  return static_cast<std::int64_t>(x);
}

void no_names(const Table& table, const std::string& path, const std::string& words) {
  if (!table.named.empty())
    throw InputError(path + ": " + table.named.begin()->first + ": no such key; must be " + words);
  if (!table.odd_keys.empty())
    throw InputError(path + ": " + table.odd_keys);
}

std::string joined_path(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

bool takes(const Type& type, const std::string& class_name) {
  return (type.kind == Kind::object &&
          ("|" + type.name + "|").find("|" + class_name + "|") != std::string::npos) ||
         (type.kind == Kind::place && class_name == "Selection") ||
         (type.or_object && type.object == class_name);
}

// An object under a name that takes none of its class: another name of the same call may.
void require_own_name(const Value& given, const Field& field, const std::vector<Field>& fields,
                      const std::string& path) {
  const auto object = given.object();
  if (!object || takes(field.type, object->class_name()))
    return;
  for (const Field& other : fields)
    if (takes(other.type, object->class_name()))
      throw InputError(path, describe(given), field.type.words(), "write " + other.name + " = for it");
}

std::shared_ptr<Table> checked_record(const Value& given, const std::vector<Field>& fields,
                                      const std::string& path) {
  static const Table nothing;
  const Table* table = given.is_nil() ? &nothing : given.table();
  if (!table)
    wrong_type(path.empty() ? "argument" : path, given, record_type(fields));
  const std::string in = path.empty() ? "" : path + ": ";
  const std::vector<std::string> names = names_of(fields);
  if (!table->odd_keys.empty())
    throw InputError(in + table->odd_keys);
  for (const auto& [name, value] : table->named) {
    const auto old = std::find_if(fields.begin(), fields.end(), [&n = name](const Field& field) {
      return !n.empty() && field.old_name == n;
    });
    if (old != fields.end() && table->named.count(old->name) > 0)
      throw InputError(in + name + " and " + old->name + ": the same; give " + old->name + " alone");
    if (old == fields.end() && std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(in + name + ": no such key" + which_there_are(name, names, "Allowed"));
  }
  if (!table->items.empty())
    throw InputError(in + describe(table->items[0]) +
                     ": a value without a name; write name = value. Allowed: " + joined(names));
  auto out = std::make_shared<Table>();
  for (const Field& field : fields) {
    auto it = table->named.find(field.name);
    if (it == table->named.end())
      it = table->named.find(field.old_name);
    if (it != table->named.end()) {
      require_own_name(it->second, field, fields, joined_path(path, it->first));
      out->named[field.name] = check_value(it->second, field.type, joined_path(path, it->first));
    } else if (field.must)
      throw InputError(in + field.name + ": missing; must be " + field.type.words() +
                       (field.unit_text.empty() ? "" : " (" + field.unit_text + ")") +
                       (field.type.range.text().empty() ? "" : " " + field.type.range.text()));
    else if (!field.standard_value.is_nil())
      out->named[field.name] = field.standard_value;
  }
  return out;
}

Value checked_vec3(const Value& given, const Type& type, const std::string& path) {
  const Table* table = given.table();
  if (!table)
    wrong_type(path, given, type);
  no_names(*table, path, type.words());
  if (table->items.size() != 3)
    throw InputError(path, describe(given), type.words());
  Values out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string item = path + "[" + std::to_string(i + 1) + "]";
    Type component = number_type();
    component.range = type.range;
    component.largest = type.largest;
    component.length = type.length;
    if (type.whole)
      out.emplace_back(static_cast<double>(checked_integer(table->items[i], component, item)));
    else
      out.emplace_back(checked_number(table->items[i], component, item));
  }
  return Table::list(std::move(out));
}

Value checked_list(const Value& given, const Type& type, const std::string& path) {
  const Table* table = given.table();
  if (!table)
    wrong_type(path, given, type);
  // A list of tables written with one table only: { shape = ..., } instead of { { shape = ..., } }.
  if (table->items.empty() && !table->named.empty() && type.items[0].kind == Kind::record)
    throw InputError(path + ": must be a list of tables; write one more pair of braces: { { " +
                     table->named.begin()->first + " = ... } }");
  std::shared_ptr<Table> named; // what stands beside the items
  if (type.fields.empty()) {
    no_names(*table, path, type.words());
  } else {
    Table beside = *table;
    beside.items.clear();
    named = checked_record(Value(std::move(beside)), type.fields, path);
  }
  if (table->items.size() < type.min_items)
    throw InputError(path, describe(given), "a list of at least " + geom::counted(type.min_items, "item"));
  Values out;
  out.reserve(table->items.size());
  for (std::size_t i = 0; i < table->items.size(); ++i)
    out.push_back(check_value(table->items[i], type.items[0], path + "[" + std::to_string(i + 1) + "]"));
  if (!named)
    return Table::list(std::move(out));
  named->items = std::move(out);
  return Value(std::move(*named));
}

Value checked_named(const Value& given, const Type& type, const std::string& path) {
  const Table* table = given.table();
  if (!table || !table->items.empty() || !table->odd_keys.empty() || table->named.empty())
    wrong_type(path, given, type);
  Table out;
  for (const auto& [name, item] : table->named)
    out.named[name] = check_value(item, type.items[0], path + "." + name);
  return Value(std::move(out));
}

Value checked_tuple(const Value& given, const Type& type, const std::string& path) {
  const Table* table = given.table();
  if (!table || table->items.size() != type.items.size())
    wrong_type(path, given, type);
  no_names(*table, path, type.words());
  Values out;
  for (std::size_t i = 0; i < type.items.size(); ++i)
    out.push_back(check_value(table->items[i], type.items[i], path + "[" + std::to_string(i + 1) + "]"));
  return Table::list(std::move(out));
}

Value checked_place(const Value& given, const Type& type, const std::string& path) {
  const auto object = given.object();
  const bool selection = object && std::string(object->class_name()) == "Selection";
  if (given.get<std::string>() || given.reference() || selection)
    return given;
  const Table* table = given.table();
  if (!table)
    wrong_type(path, given, type);
  no_names(*table, path, type.words());
  if (table->items.empty())
    throw InputError(path, "{}", "at least one place");
  for (std::size_t i = 0; i < table->items.size(); ++i) {
    const Value& item = table->items[i];
    const std::string item_path = path + "[" + std::to_string(i + 1) + "]";
    if (item.table())
      throw InputError(item_path, describe(item), "one place, not a list of places");
    checked_place(item, type, item_path);
  }
  return given;
}

Value checked_plain(const Value& given, const Type& type, const std::string& path) {
  if (given.object() || given.reference())
    throw InputError(path, describe(given), type.words());
  if (const Table* table = given.table()) {
    if (!table->odd_keys.empty())
      throw InputError(path + ": " + table->odd_keys);
    for (std::size_t i = 0; i < table->items.size(); ++i)
      checked_plain(table->items[i], type, path + "[" + std::to_string(i + 1) + "]");
    for (const auto& [name, entry] : table->named)
      checked_plain(entry, type, path + "." + name);
  }
  return given;
}

// A cdem.Record as it is; a list of {time, value} as one that holds its first and last values.
Value checked_over_time(const Value& given, const Type& type, const std::string& path) {
  if (given.table()->items.empty())
    return Value(*checked_record(given, type.fields, path));
  Values times, values;
  const Value pairs = checked_list(given, list_type(tuple_type({number_type(), number_type()}), 2), path);
  for (const Value& pair : pairs.table()->items) {
    times.push_back(pair.table()->items[0]);
    values.push_back(pair.table()->items[1]);
  }
  return Table{{"times", Table::list(std::move(times))},
               {"values", Table::list(std::move(values))},
               {"outside", "hold"}};
}

} // namespace

Value check_value(const Value& given, const Type& type, const std::string& path) {
  switch (type.kind) {
  case Kind::number:
    return checked_number(given, type, path);
  case Kind::integer:
    return checked_integer(given, type, path);
  case Kind::vec3:
    return checked_vec3(given, type, path);
  case Kind::list:
    return checked_list(given, type, path);
  case Kind::tuple:
    return checked_tuple(given, type, path);
  case Kind::record:
    return Value(*checked_record(given, type.fields, path));
  case Kind::named:
    return checked_named(given, type, path);
  case Kind::place:
    return checked_place(given, type, path);
  case Kind::plain:
    return checked_plain(given, type, path);
  case Kind::flag:
    if (!given.get<bool>())
      wrong_type(path, given, type);
    return given;
  case Kind::text:
    if (!given.get<std::string>())
      wrong_type(path, given, type);
    return given;
  case Kind::function: {
    if (type.or_number && given.is_number())
      return checked_number(given, type, path);
    if (type.or_vec3 && given.table())
      return checked_vec3(given, type, path);
    if (type.or_object && given.object() && given.object()->class_name() == type.object)
      return given;
    if (type.or_record && given.table())
      return checked_over_time(given, type, path);
    if (!given.reference())
      wrong_type(path, given, type);
    return given;
  }
  case Kind::scalar:
    if (!given.get<bool>() && !given.get<std::string>() && !given.is_number())
      wrong_type(path, given, type);
    return given;
  case Kind::object: {
    const auto object = given.object();
    if (!object || !takes(type, object->class_name()))
      wrong_type(path, given, type);
    return given;
  }
  case Kind::choice: {
    const std::string* name = given.get<std::string>();
    if (!name)
      wrong_type(path, given, type);
    if (std::find(type.choices.begin(), type.choices.end(), *name) == type.choices.end()) {
      const std::string near = nearest(*name, type.choices);
      throw InputError(path, describe(given), type.words(),
                       near.empty() ? "" : "did you mean \"" + near + "\"?");
    }
    return given;
  }
  }
  return given;
}

Arguments check(const Value& given, const std::vector<Field>& fields) {
  return Arguments(checked_record(given, fields, ""));
}

Value named_in_order(const Values& given, const std::vector<Field>& fields) {
  if (given.size() > fields.size()) {
    bool extra = false;
    for (std::size_t i = fields.size(); i < given.size(); ++i)
      extra = extra || !given[i].is_nil();
    if (extra)
      throw InputError(geom::counted(given.size(), "argument") + ": takes " +
                       (fields.empty() ? "none" : "(" + joined(names_of(fields)) + ")"));
  }
  Table named;
  for (std::size_t i = 0; i < std::min(given.size(), fields.size()); ++i)
    if (!given[i].is_nil())
      named.named[fields[i].name] = given[i];
  return Value(std::move(named));
}

} // namespace cdem::script
