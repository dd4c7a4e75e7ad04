#include "lua/binding/schema/schema.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cdem::script {

bool Range::holds(double x) const {
  return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

std::string with_or(std::string names, const std::string& between) {
  for (std::size_t at = 0; (at = names.find('|', at)) != std::string::npos; at += between.size())
    names.replace(at, 1, between);
  return names;
}

std::string Range::text() const {
  const bool has_low = low > -std::numeric_limits<double>::infinity();
  const bool has_high = high < std::numeric_limits<double>::infinity();
  if (has_low && has_high)
    return std::string("in ") + (low_open ? "(" : "[") + number_text(low) + ", " + number_text(high) +
           (high_open ? ")" : "]");
  if (has_low)
    return (low_open ? "> " : ">= ") + number_text(low);
  if (has_high)
    return (high_open ? "< " : "<= ") + number_text(high);
  return {};
}

namespace {

// Of kinds that have one name whatever they hold: as LuaCATS writes it, and as a message says it.
struct KindName {
  Kind kind;
  const char *lua, *words;
};
constexpr KindName kind_names[] = {
    {Kind::flag, "boolean", "true or false"},
    {Kind::integer, "integer", "a whole number"},
    {Kind::number, "number", "a number"},
    {Kind::text, "string", "a string"},
    {Kind::place, "cdem.Place",
     "a side (\"x-\" .. \"z+\"), a name, a cdem.select.* value, a function(x, y, "
     "z), or a list of these"},
    {Kind::scalar, "string|number|boolean", "a string, a number or a boolean"},
    {Kind::plain, "any", "a plain value"}};

const KindName* name_of(Kind kind) {
  const auto found = std::find_if(std::begin(kind_names), std::end(kind_names),
                                  [&](const KindName& name) { return name.kind == kind; });
  return found == std::end(kind_names) ? nullptr : found;
}

} // namespace

std::string Type::lua_type() const {
  if (const KindName* one = name_of(kind))
    return one->lua;
  switch (kind) {
  case Kind::vec3:
    return "number[]";
  case Kind::list: {
    const std::string item = items[0].lua_type();
    const bool compound = item.find('|') != std::string::npos;
    const std::string list = (compound ? "(" + item + ")" : item) + "[]";
    return fields.empty() ? list : list + "|" + record_type(fields).lua_type();
  }
  case Kind::named:
    return "table<string, " + items[0].lua_type() + ">";
  case Kind::function:
    return (or_number   ? "number|fun"
            : or_vec3   ? "number[]|fun"
            : or_object ? "cdem." + object + "|fun"
            : or_record ? "cdem.Record|number[][]|fun"
                        : "fun") +
           name;
  case Kind::object:
    return "cdem." + with_or(name, "|cdem.");
  case Kind::choice: {
    std::string out;
    for (const std::string& c : choices)
      out += (out.empty() ? "\"" : "|\"") + c + "\"";
    return out;
  }
  case Kind::tuple: {
    std::string out = "[";
    for (const Type& item : items)
      out += (out.size() > 1 ? ", " : "") + item.lua_type();
    return out + "]";
  }
  case Kind::record: {
    std::string out = "{";
    for (const Field& f : fields)
      out += (out.size() > 1 ? ", " : "") + f.name + (f.must ? ": " : "?: ") + f.type.lua_type();
    return out + "}";
  }
  default:
    return "any";
  }
}

std::string Type::words() const {
  if (const KindName* one = name_of(kind))
    return one->words;
  switch (kind) {
  case Kind::vec3:
    return whole ? "three whole numbers {x, y, z}" : "three numbers {x, y, z}";
  case Kind::list:
    return "a list, each item " + items[0].words() +
           (fields.empty() ? "" : ", and " + fields[0].name + " = " + fields[0].type.words());
  case Kind::tuple: {
    std::string out;
    for (const Type& item : items)
      out += (out.empty() ? "" : ", ") + item.words();
    return "{" + out + "}";
  }
  case Kind::record:
    return "a table with named values";
  case Kind::named:
    return "{ name = " + items[0].words() + ", ... }";
  case Kind::function:
    return or_number   ? "a number or a function"
           : or_vec3   ? "three numbers {x, y, z} or a function"
           : or_object ? "a " + object + " or a function"
           : or_record ? "a function of time, a cdem.Record, or a list { {time, value}, ... }"
                       : "a function";
  case Kind::object:
    return "a cdem." + with_or(name, " or a cdem.");
  case Kind::choice: {
    std::string out;
    for (const std::string& c : choices)
      out += (out.empty() ? "\"" : ", \"") + c + "\"";
    return choices.size() == 1 ? out : "one of " + out;
  }
  default:
    return "a value";
  }
}

namespace {

void limit(Type& type, bool length) {
  type.length = length;
  type.largest = length ? largest_length : largest_quantity;
  for (Type& item : type.items)
    limit(item, length);
}

} // namespace

Field& Field::unit(std::string text) {
  unit_text = std::move(text);
  if (!unit_text.empty())
    limit(type, unit_text == "m");
  return *this;
}
Field& Field::doc(std::string text) {
  doc_text = std::move(text);
  return *this;
}
Field& Field::required() {
  must = true;
  return *this;
}
Field& Field::standard(Value value) {
  standard_value = std::move(value);
  return *this;
}
Field& Field::standard() {
  own_standard = true;
  return *this;
}
Field& Field::in_degrees() {
  radians_inside = true;
  return unit("deg");
}
Field& Field::output() {
  is_output = true;
  doc_text += doc_text.empty() ? "in the output folder" : "; in the output folder";
  return *this;
}
Field& Field::above(double low) {
  type.range.low = low;
  type.range.low_open = true;
  return *this;
}
Field& Field::at_least(double low) {
  type.range.low = low;
  type.range.low_open = false;
  return *this;
}
Field& Field::up_to(double high) {
  type.range.high = high;
  return *this;
}
Field& Field::between(double low, double high) {
  type.range = {low, high, true, true};
  return *this;
}
Field& Field::within(double low, double high) {
  type.range = {low, high, false, false};
  return *this;
}
Field& Field::from(double low, double high) {
  type.range = {low, high, false, true};
  return *this;
}
Field& Field::beside(std::vector<Field> named) {
  type.fields = std::move(named);
  return *this;
}
Field& Field::doubted(double above, double below, std::string hint) {
  type.doubts.push_back({above, below, std::move(hint)});
  return *this;
}
Field& Field::formerly(std::string given) {
  old_name = std::move(given);
  return *this;
}

namespace {
Type of(Kind kind) {
  Type type;
  type.kind = kind;
  return type;
}
Field with(std::string name, Type type) {
  return Field{std::move(name), std::move(type)};
}
} // namespace

Field flag(std::string name) {
  return with(std::move(name), of(Kind::flag));
}
Field integer(std::string name) {
  return with(std::move(name), of(Kind::integer));
}
Field number(std::string name, std::string unit) {
  return with(std::move(name), of(Kind::number)).unit(std::move(unit));
}
Field text(std::string name) {
  return with(std::move(name), of(Kind::text));
}
Field vec3(std::string name, std::string unit) {
  Field field = with(std::move(name), of(Kind::vec3));
  field.type.largest = largest_quantity;
  return field.unit(std::move(unit));
}
Field place(std::string name) {
  return with(std::move(name), of(Kind::place));
}
Field scalar(std::string name) {
  return with(std::move(name), of(Kind::scalar));
}
Field named(std::string name, Type item) {
  Type type = of(Kind::named);
  type.items = {std::move(item)};
  return with(std::move(name), std::move(type));
}
Field plain(std::string name) {
  return with(std::move(name), of(Kind::plain));
}
Field object(std::string name, std::string class_name) {
  return with(std::move(name), object_type(std::move(class_name)));
}
Field record(std::string name, std::vector<Field> fields) {
  return with(std::move(name), record_type(std::move(fields)));
}
Field box(std::string name) {
  return record(std::move(name), {vec3("min").unit("m").required(), vec3("max").unit("m").required()});
}
Field list(std::string name, Type item, std::size_t min_items) {
  return with(std::move(name), list_type(std::move(item), min_items));
}
Field choice(std::string name, std::vector<std::string> choices) {
  Type type = of(Kind::choice);
  type.choices = std::move(choices);
  return with(std::move(name), std::move(type));
}
Field ivec3(std::string name) {
  Type type = of(Kind::vec3);
  type.whole = true;
  return with(std::move(name), std::move(type));
}
Field number_or_function(std::string name, std::string signature) {
  Field field = function(std::move(name), std::move(signature));
  field.type.or_number = true;
  return field;
}

Type object_or_function_type(std::string class_name, std::string signature) {
  Type type;
  type.kind = Kind::function;
  type.or_object = true;
  type.object = std::move(class_name);
  type.name = std::move(signature);
  return type;
}
Field object_or_function(std::string name, std::string class_name, std::string signature) {
  Field field;
  field.name = std::move(name);
  field.type = object_or_function_type(std::move(class_name), std::move(signature));
  return field;
}
Field function_or_record(std::string name, std::string signature, std::vector<Field> fields) {
  Field field = function(std::move(name), std::move(signature));
  field.type.or_record = true;
  field.type.fields = std::move(fields);
  return field;
}

Field vec3_or_function(std::string name, std::string signature) {
  Field field = function(std::move(name), std::move(signature));
  field.type.or_vec3 = true;
  return field;
}

Field function(std::string name, std::string signature) {
  Type type = of(Kind::function);
  type.name = std::move(signature);
  return with(std::move(name), std::move(type));
}

std::vector<Field> operator+(std::vector<Field> fields, const std::vector<Field>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

Type number_type() {
  return of(Kind::number);
}
Type text_type() {
  return of(Kind::text);
}
Type scalar_type() {
  return of(Kind::scalar);
}
Type vec3_type() {
  return of(Kind::vec3);
}
Type object_type(std::string class_name) {
  Type type = of(Kind::object);
  type.name = std::move(class_name);
  return type;
}
Type record_type(std::vector<Field> fields) {
  Type type = of(Kind::record);
  type.fields = std::move(fields);
  return type;
}
Type tuple_type(std::vector<Type> items) {
  Type type = of(Kind::tuple);
  type.items = std::move(items);
  return type;
}
Type list_type(Type item, std::size_t min_items) {
  Type type = of(Kind::list);
  type.items.push_back(std::move(item));
  type.min_items = min_items;
  return type;
}

const Value& Arguments::value(const std::string& name) const {
  static const Value nil;
  const auto it = table_->named.find(name);
  return it == table_->named.end() ? nil : it->second;
}
bool Arguments::flag(const std::string& name) const {
  const bool* x = value(name).get<bool>();
  assert(x && "flags that are read have a default");
  return *x;
}
namespace {

void require_int(const std::string& name, double x) {
  constexpr double most = std::numeric_limits<int>::max();
  if (!(std::abs(x) <= most))
    throw geom::InputError(name, number_text(x), "at most " + number_text(most));
}

} // namespace

int Arguments::count(const std::string& name) const {
  require_int(name, static_cast<double>(integer(name)));
  return static_cast<int>(integer(name));
}
std::int64_t Arguments::integer(const std::string& name) const {
  const std::int64_t* x = value(name).get<std::int64_t>();
  assert(x);
  return *x;
}
double Arguments::number(const std::string& name) const {
  assert(value(name).is_number());
  return value(name).number();
}
std::optional<double> Arguments::optional_number(const std::string& name) const {
  return has(name) ? std::optional<double>(number(name)) : std::nullopt;
}
const std::string& Arguments::text(const std::string& name) const {
  const std::string* x = value(name).get<std::string>();
  assert(x);
  return *x;
}
std::string Arguments::text_or(const std::string& name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}
geom::Vec3 Arguments::vec3(const std::string& name) const {
  return to_vec3(value(name));
}
std::optional<geom::Vec3> Arguments::optional_vec3(const std::string& name) const {
  return has(name) ? std::optional<geom::Vec3>(vec3(name)) : std::nullopt;
}
geom::Box Arguments::box(const std::string& name) const {
  const Arguments given = *record(name);
  geom::Box box;
  box.min = given.vec3("min");
  box.max = given.vec3("max");
  return box;
}
std::array<int, 3> Arguments::ivec3(const std::string& name) const {
  const geom::Vec3 x = vec3(name);
  for (int i = 0; i < 3; ++i)
    require_int(name + "[" + std::to_string(i + 1) + "]", x[i]);
  return {static_cast<int>(x[0]), static_cast<int>(x[1]), static_cast<int>(x[2])};
}
const Values& Arguments::list(const std::string& name) const {
  static const Values empty;
  const Table* table = value(name).table();
  return table ? table->items : empty;
}
std::vector<double> Arguments::numbers(const std::string& name) const {
  std::vector<double> out;
  for (const Value& x : list(name))
    out.push_back(x.number());
  return out;
}
std::vector<std::string> Arguments::texts(const std::string& name) const {
  std::vector<std::string> out;
  for (const Value& x : list(name))
    out.push_back(*x.get<std::string>());
  return out;
}
std::vector<Arguments> Arguments::records(const std::string& name) const {
  std::vector<Arguments> out;
  for (const Value& x : list(name))
    out.emplace_back(std::make_shared<Table>(*x.table()));
  return out;
}
std::optional<Arguments> Arguments::record(const std::string& name) const {
  if (!has(name))
    return std::nullopt;
  return Arguments(std::make_shared<Table>(*value(name).table()));
}
std::shared_ptr<Reference> Arguments::function(const std::string& name) const {
  return value(name).reference();
}

geom::Vec3 to_vec3(const Value& value) {
  const Table* table = value.table();
  assert(table && table->items.size() == 3);
  return {table->items[0].number(), table->items[1].number(), table->items[2].number()};
}

} // namespace cdem::script
