#include "libcdem/contact/response/taken_over.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/contact/response/tet_potential.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>

namespace cdem {
namespace {

// The triangle on side a of an inner face of a block; -1: the surface has none.
int triangle_of(const ContactSurface& s, const FaceToTakeOver& of) {
  if (s.triangles.empty())
    return -1;
  const auto begin = s.triangles.begin() + s.block_begin[of.block],
             end = s.triangles.begin() + s.block_begin[of.block + 1];
  const auto found =
      std::partition_point(begin, end, [&](const ContactTriangle& t) { return t.face < of.face; });
  return found != end && found->face == of.face ? static_cast<int>(found - s.triangles.begin()) : -1;
}

// That of the two tetrahedra; a new one where they have none.
Contact& contact_of(std::vector<Contact>& contacts, int tet, int other) {
  Contact like(Contact::tets, std::min(tet, other));
  like.target = like.fragment = std::max(tet, other);
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), like,
                                      [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return found != contacts.end() && key(*found) == key(like) ? *found : *contacts.insert(found, like);
}

// The two tetrahedra of a contact, side by side for eight values of phi0.
class PairAt {
public:
  PairAt(const Model& model, const State& state, const Contact& c, double stiffness) {
    for (int k = 0; k < 8; ++k) {
      const geom::Vec3 x =
          place_of(model, state, model.tets[k < 4 ? static_cast<int>(c.source) : c.target][k % 4]);
      place_[k] = {x.x(), x.y(), x.z(), 0};
      std::fill_n(batch_.of.node[k], lanes, k);
    }
    std::fill_n(batch_.stiffness, lanes, stiffness);
  }
  double deepest() {
    find_deepest(place_.data(), &batch_.of, 1);
    return batch_.of.deepest[0];
  }
  // Between two values, in equal steps.
  void press(double from, double to) {
    for (int lane = 0; lane < lanes; ++lane)
      batch_.phi0[lane] = from + (to - from) * lane / (lanes - 1);
    press_pairs(place_.data(), &batch_, 1);
  }
  double phi0(int lane) const { return batch_.phi0[lane]; }
  double energy(int lane) const { return batch_.energy[lane]; }
  geom::Vec3 force(int lane) const { // N, on the first
    geom::Vec3 sum = geom::Vec3::Zero();
    for (int k = 0; k < 4; ++k)
      sum += geom::Vec3(batch_.force[k][0][lane], batch_.force[k][1][lane], batch_.force[k][2][lane]);
    return sum;
  }

private:
  std::array<Node, 8> place_;
  TetPairPress batch_{};
};

// Gives the contact this normal force, N, by its phi0: the larger that is, the smaller the force.
void set_force(PairAt& pair, double force, Contact& c) {
  double high = std::max(pair.deepest(), c.reference_penetration), low = high, way = 0;
  pair.press(low, high);
  for (way = 1e-6 * (1 + std::abs(high)); pair.force(0).norm() < force && way < 1; way *= 8) {
    low = high - way;
    pair.press(low, high);
  }
  for (int i = 0; i < 18; ++i) {
    int lane = 0;
    while (lane + 1 < lanes - 1 && pair.force(lane + 1).norm() >= force)
      ++lane;
    low = pair.phi0(lane);
    high = pair.phi0(lane + 1);
    pair.press(low, high);
  }
  if (const double found = pair.force(0).norm(); found > 0 && pair.energy(0) > 0) {
    const double pressed = 2 * pair.energy(0) / found;
    c.reference_penetration = pair.phi0(0);
    c.depth = c.reference_penetration + pressed;
    c.stiffness = found / pressed;
    c.normal = pair.force(0) / found;
  }
}

} // namespace

double take_over(const Model& model, State& state, const ContactWork& work, const FaceToTakeOver& of) {
  const ContactSurface& s = model.surface;
  const int t = triangle_of(s, of);
  if (t < 0)
    return of.left.energy;
  const ContactTriangle& side = s.triangles[t];
  const int other = s.triangles[side.mate].tet;
  geom::Vec3 force = geom::Vec3::Zero(); // N, on side a
  for (const geom::Vec3& at_corner : of.left.force)
    force += at_corner;
  const double pressing = -force.dot(unit_normal(corners_of(model, state, side.nodes)));
  if (!(pressing > 0) || !touches_itself(model, work, side.block))
    return of.left.energy;
  Contact& c = contact_of(state.contacts, side.tet, other);
  if (static_cast<int>(c.source) != side.tet)
    force = -force;
  const ContactLaw law = law_of(model, c);
  const double before = c.effective_penetration() > 0 ? energy(c, law) : 0,
               has = c.effective_penetration() * law.kn;
  const Joint& joint = *contact_joint(model, side.block, side.block);
  PairAt pair(model, state, c,
              tet_pair_law(model, joint, 0, side.block, tet_size(model, static_cast<int>(c.source)),
                           tet_size(model, c.target))
                  .corner);
  set_force(pair, has + pressing, c);
  c.shear += force - force.dot(c.normal) * c.normal;
  return of.left.energy - energy(c, law_of(model, c)) + before;
}

} // namespace cdem
