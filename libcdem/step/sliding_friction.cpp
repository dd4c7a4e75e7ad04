#include "libcdem/step/sliding_friction.hpp"

#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/model.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/state/state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdem {
namespace {

bool deforms(const Model& model, int block) {
  return model.blocks[block].meshed && model.blocks[block].rigid < 0;
}

} // namespace

void SlidingFriction::look(const Model& model, const State& state, const std::vector<char>& broken,
                           double time) {
  if (std::exchange(blocks, model.blocks.size()) != model.blocks.size())
    of_blocks.clear(); // they have other numbers
  std::map<int, BlockMotion> motions;
  const auto velocity = [&](int block, const geom::Vec3& place) -> geom::Vec3 {
    const auto [entry, fresh] = motions.try_emplace(block);
    BlockMotion& motion = entry->second;
    if (fresh)
      motion = motion_of(model, state, model.blocks[block]);
    return motion.velocity + motion.spin.cross(place - motion.centroid);
  };
  std::map<std::array<int, 2>, Sums> now;
  for (const Contact& c : state.contacts) {
    if (c.kind == Contact::tets || !(c.effective_penetration() > 0))
      continue;
    const auto [source, target] = blocks_of(model, c);
    if (source == target || broken[source] || broken[target] ||
        !(deforms(model, source) || deforms(model, target)))
      continue;
    const ContactLaw law = law_of(model, c);
    const ContactArms arms = arms_of(model, state, c);
    geom::Vec3 place = geom::Vec3::Zero();
    for (int i = 0; i < 4; ++i)
      if (arms.on_source[i] != 0)
        place += arms.on_source[i] * place_of(model, state, arms.source[i]);
    const auto along = [&](const geom::Vec3& v) -> geom::Vec3 { return v - v.dot(c.normal) * c.normal; };
    const geom::Vec3 v = along(velocity(source, place) - velocity(target, place)),
                     w = along(velocity_past(state, arms));
    const double normal = time * std::max(0.0, normal_force(c, law)), limit = law.tan_friction * normal;
    Sums& sums = now[std::array<int, 2>{std::min(source, target), std::max(source, target)}];
    sums.law += (source < target ? limit : -limit) * v;
    sums.done -= time * c.shear.dot(v);
    sums.path += limit * v.norm();
    sums.slip += normal * v.squaredNorm();
    sums.contact += normal * v.dot(w);
    sums.span +=
        limit * std::cbrt(std::min(model.blocks[source].mass.volume, model.blocks[target].mass.volume));
  }
  for (const auto& [pair, sums] : now) {
    if (!std::isfinite(sums.path))
      continue;
    Sums& all = of_blocks[pair];
    if (sums.path > 0.01 * all.path)
      ++all.looks;
    all.law += sums.law;
    all.done += sums.done;
    all.path += sums.path;
    all.slip += sums.slip;
    all.contact += sums.contact;
    all.span += sums.span;
    all.time += time;
  }
}

} // namespace cdem
