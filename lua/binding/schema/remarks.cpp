// What a call is warned of by its declaration alone: old names of fields, and values that hardly anybody means in their
// unit.
#include "lua/binding/schema/schema.hpp"

namespace cdem::script {

namespace {

class Remarks {
public:
  std::vector<std::string> found;

  void of_fields(const Table& table, const std::vector<Field>& fields, const std::string& path) {
    for (const Field& field : fields) {
      if (const auto old = table.named.find(field.old_name); old != table.named.end()) {
        found.push_back(path + field.old_name + " is named " + field.name +
                        " now; the next release no longer knows the old name");
        of_value(old->second, field.type, field.unit_text, path + field.name);
      }
      if (const auto given = table.named.find(field.name); given != table.named.end())
        of_value(given->second, field.type, field.unit_text, path + field.name);
    }
  }

private:
  void of_value(const Value& value, const Type& type, const std::string& unit, const std::string& path) {
    const Table* const table = value.table();
    if (value.is_number())
      of_size(value, value.number(), type, unit, path);
    if (!table)
      return;
    if (type.kind == Kind::vec3 || type.or_vec3)
      of_size(value, to_vec3(value).norm(), type, unit, path);
    of_fields(*table, type.fields, path + ".");
    for (std::size_t i = 0; i < table->items.size() && !type.items.empty(); ++i)
      of_value(table->items[i], type.items[type.kind == Kind::tuple ? i : 0], unit,
               path + "[" + std::to_string(i + 1) + "]");
    if (type.kind == Kind::named)
      for (const auto& [name, item] : table->named)
        of_value(item, type.items[0], unit, path + "." + name);
  }

  // size: of a number, the length of a vector.
  void of_size(const Value& value, double size, const Type& type, const std::string& unit,
               const std::string& path) {
    for (const Doubt& doubt : type.doubts)
      if (size > doubt.above && size < doubt.below)
        found.push_back(path + " = " + describe(value) + ": is it in " + (unit == "deg" ? "degrees" : unit) +
                        "? " + doubt.hint);
  }
};

} // namespace

std::vector<std::string> remarks_on(const Value& given, const std::vector<Field>& fields) {
  Remarks remarks;
  if (const Table* const table = given.table())
    remarks.of_fields(*table, fields, "");
  return std::move(remarks.found);
}

} // namespace cdem::script
