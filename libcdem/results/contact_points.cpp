#include "libcdem/results/contact_points.hpp"

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {

std::vector<ContactPoint> contact_points(const Model& model, const State& state) {
  std::vector<ContactPoint> points;
  for (const Contact& contact : state.contacts) {
    const double depth = contact.effective_penetration();
    if (!(depth > 0))
      continue;
    const ContactArms arms = arms_of(model, state, contact);
    ContactPoint point;
    for (int i = 0; i < 4; ++i)
      if (arms.on_source[i] != 0)
        point.place += arms.on_source[i] * place_of(model, state, arms.source[i]);
    point.normal = (law_of(model, contact).kn * depth + contact.damping) * contact.normal;
    point.shear = contact.shear;
    point.depth = depth;
    const auto [source, target] = blocks_of(model, contact);
    point.source_block = model.blocks[source].id;
    point.target_block = model.blocks[target].id;
    point.source_body = model.blocks[source].body;
    point.target_body = model.blocks[target].body;
    point.edge = contact.kind == Contact::edge;
    points.push_back(point);
  }
  return points;
}

} // namespace cdem
