#include "libcdem/load/gone_body.hpp"

#include "libcdem/model/model.hpp"
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

void refuse_gone(const Model& model, const Conditions& conditions) {
  const auto refuse = [&](const auto& of_a_kind) {
    for (const auto& condition : of_a_kind)
      if (is_gone(model, condition.on))
        throw geom::InputError("on", condition.on.text, "a body of which something is left",
                               "all of \"" + condition.on.body + "\" has been removed");
  };
  refuse(conditions.fixes);
  refuse(conditions.tractions);
  refuse(conditions.forces);
  refuse(conditions.flows);
  refuse(conditions.crack_pressures);
}

} // namespace cdem
