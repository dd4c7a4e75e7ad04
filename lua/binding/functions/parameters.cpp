// cdem.parameter: a value of the script that --set can change.
#include "lua/binding/module/module.hpp"
#include "lua/binding/session/session.hpp"
#include "lua/binding/text/csv.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace cdem::script {

namespace {

using geom::InputError;

std::string type_of(const Value& value) {
  if (value.get<bool>())
    return "boolean";
  if (value.get<std::int64_t>())
    return "integer";
  if (value.get<double>())
    return "number";
  if (value.get<std::string>())
    return "string";
  return "list";
}

[[noreturn]] void cannot_read(const std::string& name, const std::string& typed, const std::string& type) {
  std::string wanted = "a number, e.g. 24e6";
  if (type == "integer")
    wanted = "a whole number, as its default is one (a default with a point, 3.0, makes it a number)";
  else if (type == "boolean")
    wanted = "true or false";
  throw InputError("--set " + name + "=" + typed + ": must be " + wanted);
}

Value read_scalar(const std::string& name, const std::string& typed, const std::string& type) {
  const std::string text = trimmed(typed);
  if (type == "string")
    return typed;
  if (type == "boolean") {
    if (text == "true" || text == "yes")
      return true;
    if (text == "false" || text == "no")
      return false;
    cannot_read(name, typed, type);
  }
  double x = 0;
  const char* begin = text.c_str() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* end = text.c_str() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, x);
  if (error != std::errc() || stop != end || !std::isfinite(x))
    cannot_read(name, typed, type);
  if (type == "number")
    return x;
  if (x != std::floor(x) || std::abs(x) > 9e15)
    cannot_read(name, typed, type);
  return static_cast<std::int64_t>(x);
}

Value read(const std::string& name, const std::string& typed, const std::string& type,
           const Value& standard) {
  if (type != "list")
    return read_scalar(name, typed, type);
  std::string text = trimmed(typed);
  if (text.size() >= 2 && (text.front() == '{' || text.front() == '[') &&
      (text.back() == '}' || text.back() == ']'))
    text = text.substr(1, text.size() - 2);
  // Whole numbers in the default of a list do not make it a list of whole numbers: {1, 2.5} is common.
  std::string item_type = type_of(standard.table()->items.front());
  if (item_type == "integer")
    item_type = "number";
  Values items;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    items.push_back(read_scalar(name, trimmed(text.substr(begin, end - begin)), item_type));
    begin = end + 1;
  }
  return Table::list(std::move(items));
}

std::string plain_text(const Value& value) {
  const std::string* text = value.get<std::string>();
  return text ? *text : describe(value);
}

void check_choice(const std::string& label, const Value& value, const Values& choices) {
  if (choices.empty())
    return;
  std::vector<std::string> names;
  for (const Value& c : choices) {
    if (c.is_number() && value.is_number() && c.number() == value.number())
      return;
    if (canonical_text(c) == canonical_text(value))
      return;
    names.push_back(plain_text(c));
  }
  const std::string near = value.get<std::string>() ? did_you_mean(plain_text(value), names) : "";
  throw InputError(label + " = " + describe(value) + ": must be one of " + joined(names) + near);
}

void check_range(const std::string& label, const Value& value, const Range& range) {
  if (const Table* table = value.table()) {
    for (std::size_t i = 0; i < table->items.size(); ++i)
      check_range(label + "[" + std::to_string(i + 1) + "]", table->items[i], range);
    return;
  }
  if (!value.is_number())
    return;
  if (!std::isfinite(value.number()))
    throw InputError(label, describe(value), "a finite number");
  if (!range.holds(value.number()))
    throw InputError(label, describe(value), range.text());
}

Value parameter(Session& session, Object*, const Arguments& arguments) {
  const std::string name = arguments.text("name");
  const Value standard = arguments.value("default");
  for (const Parameter& p : session.parameters)
    if (p.info.name == name)
      throw InputError("name = \"" + name + "\": declared twice");
  if (name.empty() || name.find_first_of("= ,") != std::string::npos)
    throw InputError("name", "\"" + name + "\"", "a word, e.g. \"pressure\"");
  if (!session.stages.empty())
    throw InputError("name = \"" + name +
                     "\": declared after the first solving call; move it to the top of the script, "
                     "so that a misspelt --set is noticed before anything is solved");
  if (const Table* table = standard.table()) {
    if (table->items.empty() || !table->named.empty())
      throw InputError("default", describe(standard),
                       "a number, a string, a boolean or a list with at least one item");
    for (const Value& item : table->items)
      if (item.table())
        throw InputError("default", describe(standard), "a list of numbers, strings or booleans");
  }
  std::string type = type_of(standard);
  if (arguments.has("type")) {
    const std::string& wanted = arguments.text("type");
    if (wanted != type && !(wanted == "number" && type == "integer"))
      throw InputError("default", describe(standard), "a " + wanted + ", as type says");
    type = wanted;
  }
  Range range;
  if (arguments.has("range")) {
    const auto limits = arguments.numbers("range");
    if (limits.size() != 2 || limits[0] > limits[1])
      throw InputError("range", describe(arguments.value("range")), "{lowest, highest}");
    if (type == "string" || type == "boolean")
      throw InputError("range: a " + type + " has none; use choices");
    range.low = limits[0];
    range.high = limits[1];
  }
  check_range("default", standard, range);
  check_choice("default", standard, arguments.list("choices"));

  Value value = standard;
  if (type == "number" && standard.is_number())
    value = standard.number();
  const auto typed = session.settings.set.find(name);
  if (typed != session.settings.set.end()) {
    const std::string& unit = arguments.text_or("unit", "");
    try {
      value = read(name, typed->second, type, standard);
      check_range("--set " + name, value, range);
    } catch (const InputError& error) {
      throw InputError(error.what() + (unit.empty() ? std::string() : "; it is in " + unit));
    }
    check_choice("--set " + name, value, arguments.list("choices"));
  }
  ParameterInfo info;
  info.name = name;
  info.type = type;
  info.default_text = plain_text(standard);
  info.value_text = plain_text(value);
  info.range_text = range.text();
  if (arguments.has("choices")) {
    std::vector<std::string> names;
    for (const Value& c : arguments.list("choices"))
      names.push_back(plain_text(c));
    info.range_text = "one of " + joined(names);
  }
  info.unit = arguments.text_or("unit", "");
  info.doc = arguments.text_or("doc", "");
  session.parameters.push_back({info, value});
  return value;
}

} // namespace

void bind_parameters(Module& m) {
  m.add(
      "parameter",
      "Declares a value that the command line can change with --set name=value, and returns it. Its type is "
      "that of the default: number, integer, string, boolean or list. Parameters come before the first "
      "solving call.",
      {text("name").required().doc("a word, as in --set pressure=24e6"),
       plain("default").required().doc("value without --set; its type is the parameter's"),
       choice("type", {"number", "integer", "string", "boolean", "list"})
           .doc("only needed to let an integer default take any number"),
       list("range", number_type(), 2).doc("{lowest, highest} allowed, for numbers and every item of a list"),
       list("choices", scalar_type()).doc("the values allowed"), text("unit").doc("e.g. \"Pa\""),
       text("doc").doc("one sentence, shown by `cdem check`")},
      parameter, "any", "the value");
}

} // namespace cdem::script
