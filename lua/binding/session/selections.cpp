#include "lua/binding/session/selections.hpp"

#include "lua/binding/objects/objects.hpp"
#include "lua/binding/schema/answers.hpp"
#include "lua/binding/session/model_object.hpp"
#include "lua/binding/text/nearest.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem::script {

namespace {

std::vector<std::string> place_names(const ModelObject& model) {
  std::vector<std::string> names{"x-", "x+", "y-", "y+", "z-", "z+", "all"};
  for (const auto& [name, place] : model.places)
    names.push_back(name);
  names.insert(names.end(), model.body_names.begin(), model.body_names.end());
  return names;
}

std::vector<Selection> by_name(const ModelObject& model, const std::string& name, const std::string& key) {
  const auto given = model.places.find(name);
  if (given != model.places.end())
    return given->second;
  if (std::find(model.body_names.begin(), model.body_names.end(), name) != model.body_names.end())
    return {Selection::of_body(name)};
  if (name == "all")
    return {Selection::everything()};
  if (name.size() == 2 && name[0] >= 'x' && name[0] <= 'z' && (name[1] == '-' || name[1] == '+'))
    return {Selection::side(name)};
  const auto names = place_names(model);
  throw geom::InputError(key + " = \"" + name + "\": no such place" + which_there_are(name, names));
}

} // namespace

Selection predicate_selection(const std::shared_ptr<Reference>& function) {
  return Selection::where(
      [function](const geom::Vec3& x) {
        const Values at{x.x(), x.y(), x.z()};
        const Value answer = answer_of(*function, "function", at);
        if (const bool* yes = answer.get<bool>())
          return *yes;
        refuse_answer(*function, "function", at, answer, "true or false");
      },
      "function of " + function->place());
}

std::vector<Selection> selections(const ModelObject& model, const Value& place, const std::string& key) {
  if (const std::string* name = place.get<std::string>())
    return by_name(model, *name, key);
  if (const auto function = place.reference())
    return {predicate_selection(function)};
  if (const Table* table = place.table()) {
    std::vector<Selection> all;
    for (std::size_t i = 0; i < table->items.size(); ++i)
      for (Selection& s : selections(model, table->items[i], key + "[" + std::to_string(i + 1) + "]"))
        all.push_back(std::move(s));
    return all;
  }
  return {static_cast<const SelectionObject&>(*place.object()).selection};
}

Selection one_selection(const ModelObject& model, const Value& place, const std::string& key) {
  if (place.is_nil())
    return Selection::everything();
  std::vector<Selection> all = selections(model, place, key);
  if (all.size() != 1)
    throw geom::InputError(key, describe(place), "one place here, not several",
                           "use cdem.select.where with a function that is true in all of them");
  return all.front();
}

} // namespace cdem::script
