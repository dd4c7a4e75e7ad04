#include "libcdem/load/gone_body.hpp"

#include "libcdem/model/model.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>

namespace cdem {

bool is_gone(const Model& model, const Selection& on) {
  if (on.body.empty())
    return false;
  const auto named = std::find_if(model.bodies.begin(), model.bodies.end(),
                                  [&](const Body& body) { return body.name == on.body; });
  if (named == model.bodies.end())
    return false; // never was
  const auto body = static_cast<int>(named - model.bodies.begin());
  return std::none_of(model.blocks.begin(), model.blocks.end(),
                      [&](const Block& block) { return block.body == body; });
}

bool is_gone(const Model& model, const Flow& flow) {
  return std::all_of(flow.on.begin(), flow.on.end(), [&](const Selection& on) { return is_gone(model, on); });
}

void require_places(const Model& model, const Conditions& conditions) {
  const auto require = [&](const Selection& on, const char* what, const auto& selected) {
    if (is_gone(model, on))
      throw geom::InputError("on", on.text, "a body of which something is left",
                             "all of \"" + on.body + "\" has been removed");
    if (selected(model, on).empty())
      throw geom::InputError(
          "on", on.text, std::string("a place that holds ") + what,
          "nothing of the model lies there; sides are those of the box in which it was made, from " +
              geom::shown(model.built_box.min) + " to " + geom::shown(model.built_box.max) + " m");
  };
  const auto require_nodes = [&](const auto& of_a_kind) {
    for (const auto& condition : of_a_kind)
      require(condition.on, "nodes", selected_nodes);
  };
  const auto require_faces = [&](const auto& of_a_kind) {
    for (const auto& condition : of_a_kind)
      require(condition.on, "outer faces", selected_outer_faces);
  };
  require_nodes(conditions.fixes);
  require_nodes(conditions.forces);
  require_faces(conditions.tractions);
  for (const Flow& flow : conditions.flows)
    for (const Selection& on : flow.on)
      require(on, "outer faces", selected_outer_faces);
  require_faces(conditions.quiets);
  require_faces(conditions.free_fields);
}

} // namespace cdem
