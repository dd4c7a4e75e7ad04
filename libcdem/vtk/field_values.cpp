#include "libcdem/vtk/field_values.hpp"

#include "libcdem/vtk/labels.hpp"
#include "libcdem/vtk/picture.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace cdem {
namespace {

std::vector<std::string> component_names(const SnapshotField& field) {
  switch (field.components) {
  case 1:
    return {};
  case 3:
    if (field.name.find("principal") != std::string::npos)
      return {"1", "2", "3"};
    return {"x", "y", "z", "magnitude"};
  case 6:
    return {"xx", "yy", "zz", "xy", "yz", "xz"};
  default: {
    std::vector<std::string> names;
    for (int c = 1; c <= field.components; ++c)
      names.push_back(std::to_string(c));
    return names;
  }
  }
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string symbol_of(const std::string& name, const std::string& component) {
  static const std::map<std::string, std::string> letters = {
      {"displacement", "u"},          {"velocity", "v"},    {"acceleration", "a"}, {"stress", "\u03c3"},
      {"principal_stress", "\u03c3"}, {"strain", "\u03b5"}, {"force", "F"},        {"traction", "t"}};
  if (name == "von_mises")
    return "\u03c3_{vM}";
  const auto letter = letters.find(name);
  std::string symbol = letter == letters.end() ? name : letter->second;
  std::replace(symbol.begin(), symbol.end(), '_', ' ');
  if (component == "magnitude")
    return "|" + symbol + "|";
  if (component.empty())
    return symbol;
  return letter == letters.end() ? symbol + " " + component : symbol + "_{" + component + "}";
}

// Von Mises stress; s: stress in the order xx yy zz xy yz xz.
double von_mises(const double* s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

template <class Value>
std::vector<double> gather(std::size_t count, const Value& value) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = value(i);
  return values;
}

[[noreturn]] void unknown_field(const Snapshot& snapshot, const std::string& field) {
  const std::vector<std::string> known = picture_fields(snapshot);
  std::vector<std::string> offer = nearest_names(field, known);
  const std::string lead = offer.empty() ? "one of " : "a field of this result; did you mean ";
  if (offer.empty())
    offer = known;
  std::string list;
  for (const std::string& name : offer)
    list += (list.empty() ? "" : ", ") + name;
  throw geom::InputError("colour", '"' + field + '"',
                         known.empty() ? "left empty: this result has no fields"
                                       : lead + list + (lead[0] == 'a' ? "?" : ""));
}

} // namespace

const SnapshotField* find_field(const std::vector<SnapshotField>& fields, const std::string& name) {
  const auto it =
      std::find_if(fields.begin(), fields.end(), [&](const SnapshotField& f) { return f.name == name; });
  return it == fields.end() ? nullptr : &*it;
}

const SnapshotField* displacement_of(const std::vector<SnapshotField>& point_fields) {
  const SnapshotField* field = find_field(point_fields, "displacement");
  return field && field->components == 3 ? field : nullptr;
}

std::vector<std::string> picture_fields(const Snapshot& snapshot) {
  std::vector<std::string> names;
  for (const auto* fields : {&snapshot.point_fields, &snapshot.cell_fields})
    for (const SnapshotField& field : *fields) {
      const std::vector<std::string> components = component_names(field);
      if (components.empty())
        names.push_back(field.name);
      for (const std::string& component : components)
        names.push_back(field.name + "." + component);
    }
  const SnapshotField* stress = find_field(snapshot.cell_fields, "stress");
  if (stress && stress->components == 6 && !find_field(snapshot.cell_fields, "von_mises"))
    names.push_back("von_mises");
  return names;
}

void leave_plain(const Snapshot& snapshot, const std::vector<int>& bodies, FieldValues& field) {
  const SnapshotField* const body = find_field(snapshot.cell_fields, "body");
  if (bodies.empty() || !body)
    return;
  for (std::size_t t = 0; t < snapshot.surface.size(); ++t) {
    const auto of = static_cast<int>(body->values[static_cast<std::size_t>(snapshot.surface_tet[t])]);
    if (std::find(bodies.begin(), bodies.end(), of) == bodies.end())
      continue;
    if (!field.on_points)
      field.values[t] = std::nan("");
    else
      for (const int point : snapshot.surface[t])
        field.values[static_cast<std::size_t>(point)] = std::nan("");
  }
}

void leave_inside(const Snapshot& snapshot, FieldValues& field) {
  if (!field.on_points)
    return;
  std::vector<char> shown(field.values.size(), 0);
  for (const geom::Triangle& triangle : snapshot.surface)
    for (const int point : triangle)
      shown[static_cast<std::size_t>(point)] = 1;
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (!shown[i])
      field.values[i] = std::nan("");
}

FieldValues field_values(const Snapshot& snapshot, const std::string& name) {
  const auto dot = name.find('.');
  const std::string base = name.substr(0, dot);
  std::string component = dot == std::string::npos ? std::string() : name.substr(dot + 1);

  FieldValues result;
  const SnapshotField* field = find_field(snapshot.point_fields, base);
  result.on_points = field != nullptr;
  if (!field)
    field = find_field(snapshot.cell_fields, base);
  bool mises = false;
  if (!field && name == "von_mises") {
    field = find_field(snapshot.cell_fields, "stress");
    mises = field && field->components == 6;
  }
  if (!field || (!mises && base == "von_mises" && field->components != 1))
    unknown_field(snapshot, name);

  const std::vector<std::string> components = component_names(*field);
  if (component.empty() && field->components == 3 && components.back() == "magnitude")
    component = "magnitude";
  const auto place = std::find(components.begin(), components.end(), component);
  if (!mises && (components.empty() ? !component.empty() : place == components.end()))
    unknown_field(snapshot, name);

  result.symbol = mises ? symbol_of("von_mises", {}) : symbol_of(base, component);
  result.unit = field->unit;
  result.integer = field->integer;
  result.names = field->names;
  result.id =
      field->integer && (ends_with(base, "_id") || base == "body" || base == "unit" || base == "fragment");

  if (field->values.empty() && !snapshot.surface.empty())
    throw std::logic_error("the field " + base + " is named in this result, but has no values");
  const auto n = static_cast<std::size_t>(field->components);
  const std::size_t chosen = components.empty() ? 0 : static_cast<std::size_t>(place - components.begin());
  const auto value = [&](std::size_t row) {
    const double* v = field->values.data() + row * n;
    if (mises)
      return von_mises(v);
    if ((base == "unit" || base == "fragment") && v[0] == 0) // all of its body, such as the ground: no colour
      return std::nan("");
    return component == "magnitude" ? std::hypot(v[0], v[1], v[2]) : v[chosen];
  };
  if (result.on_points)
    result.values = gather(snapshot.points.size(), value);
  else
    result.values = gather(snapshot.surface.size(), [&](std::size_t t) {
      return value(static_cast<std::size_t>(snapshot.surface_tet[t]));
    });
  return result;
}

} // namespace cdem
