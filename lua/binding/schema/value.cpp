#include "lua/binding/schema/value.hpp"

#include <charconv>
#include <cmath>

namespace cdem::script {

Value::Value(Table x) : data_(std::make_shared<Table>(std::move(x))) {}

Value::Value(const geom::Box& x) : Value(Table{{"min", x.min}, {"max", x.max}}) {}
Value::Value(const geom::Mat3& x)
    : Value(Table::list({geom::Vec3(x.row(0)), geom::Vec3(x.row(1)), geom::Vec3(x.row(2))})) {}
Value::Value(const geom::Vec3& x) : Value(Table::list({x.x(), x.y(), x.z()})) {}

const Table* Value::table() const {
  const auto* pointer = get<std::shared_ptr<Table>>();
  return pointer ? pointer->get() : nullptr;
}

std::shared_ptr<Object> Value::object() const {
  const auto* pointer = get<std::shared_ptr<Object>>();
  return pointer ? *pointer : nullptr;
}

std::shared_ptr<Reference> Value::reference() const {
  const auto* pointer = get<std::shared_ptr<Reference>>();
  return pointer ? *pointer : nullptr;
}

double Value::number() const {
  if (const auto* integer = get<std::int64_t>())
    return static_cast<double>(*integer);
  return std::get<double>(data_);
}

Table Table::list(Values values) {
  Table table;
  table.items = std::move(values);
  return table;
}

std::string number_text(double x) {
  if (std::isnan(x))
    return "nan";
  if (std::isinf(x))
    return x > 0 ? "inf" : "-inf";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, end.ptr);
}

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + '"';
}

// limit: characters of a table after which a message is shortened; 0 means all of it.
std::string text_of(const Value& value, std::size_t limit) {
  if (const auto* flag = value.get<bool>())
    return *flag ? "true" : "false";
  if (const auto* integer = value.get<std::int64_t>())
    return std::to_string(*integer);
  if (const auto* number = value.get<double>())
    return number_text(*number);
  if (const auto* text = value.get<std::string>()) {
    if (limit > 0 && text->size() > limit)
      return quoted(text->substr(0, limit) + "...");
    return quoted(*text);
  }
  if (const Table* table = value.table()) {
    std::string out = "{";
    const auto add = [&](const std::string& entry) { out += (out.size() > 1 ? ", " : "") + entry; };
    const auto full = [&] { return limit > 0 && out.size() > limit; };
    for (const Value& item : table->items) {
      if (full())
        break;
      add(text_of(item, limit));
    }
    for (const auto& [name, entry] : table->named) {
      if (full())
        break;
      add(name + " = " + text_of(entry, limit));
    }
    if (full())
      add("...");
    return out + "}";
  }
  if (const auto object = value.object())
    return object->shown();
  if (value.reference())
    return "function";
  return "nil";
}

} // namespace

std::string describe(const Value& value) {
  return text_of(value, 60);
}

std::string canonical_text(const Value& value) {
  return text_of(value, 0);
}

// Fowler, Noll, Vo: FNV-1a, 64 bit.
std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

} // namespace cdem::script
