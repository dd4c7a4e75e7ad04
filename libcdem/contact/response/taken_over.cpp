#include "libcdem/contact/response/taken_over.hpp"

#include "libcdem/contact/response/contact_point.hpp"

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

Contact* contact_of(std::vector<Contact>& contacts, int triangle, int corner, int fragment) {
  Contact like(Contact::spring, 3 * triangle + corner);
  like.fragment = fragment;
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), like,
                                      [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return found != contacts.end() && key(*found) == key(like) ? &*found : nullptr;
}

double stored(const Model& model, const Contact& c) {
  return energy(c, law_of(model, c));
}

// force: N, on the source. Returns the energy that the contact stores more, J.
double add_force(const Model& model, Contact& c, const geom::Vec3& force, double stiffness) {
  const double before = stored(model, c), kn = law_of(model, c).kn;
  const double had = kn * c.effective_penetration(), gets = std::max(0.0, force.dot(c.normal));
  if (gets > 0) {
    c.stiffness = (had + gets) * (had + gets) / (had * had / kn + gets * gets / stiffness);
    c.reference_penetration = c.depth - (had + gets) / c.stiffness;
  }
  c.shear += force - force.dot(c.normal) * c.normal;
  return stored(model, c) - before;
}

} // namespace

double take_over(const Model& model, State& state, const ContactWork& work, const FaceToTakeOver& of) {
  const ContactSurface& s = model.surface;
  const int a = triangle_of(s, of);
  if (a < 0 || work.fragment.empty())
    return of.left.energy;
  const int b = s.triangles[a].mate;
  std::array<std::array<Contact*, 2>, 3> touching; // per corner of the face, on side a and b
  int all = 0;
  for (int corner = 0; corner < 3; ++corner) {
    touching[corner] = {contact_of(state.contacts, a, corner, work.fragment[b]),
                        // outward_b() turns the corners 1 and 2 round
                        contact_of(state.contacts, b, (3 - corner) % 3, work.fragment[a])};
    all +=
        static_cast<int>(touching[corner][0] != nullptr) + static_cast<int>(touching[corner][1] != nullptr);
  }
  double lost = of.left.energy;
  geom::Vec3 rest = geom::Vec3::Zero(); // N, of corners at which nothing touches
  double rest_stiffness = 0;
  const auto add = [&](int corner, int side, const geom::Vec3& force, double stiffness) {
    lost -= add_force(model, *touching[corner][side], side == 0 ? force : geom::Vec3(-force), stiffness);
  };
  for (int corner = 0; corner < 3; ++corner) {
    const int here =
        static_cast<int>(touching[corner][0] != nullptr) + static_cast<int>(touching[corner][1] != nullptr);
    if (here == 0) {
      rest += of.left.force[corner];
      rest_stiffness += of.left.stiffness;
    }
    for (int side = 0; side < 2; ++side)
      if (touching[corner][side])
        add(corner, side, of.left.force[corner] / here, of.left.stiffness / here);
  }
  if (rest_stiffness > 0)
    for (int corner = 0; corner < 3; ++corner)
      for (int side = 0; side < 2; ++side)
        if (touching[corner][side])
          add(corner, side, rest / all, rest_stiffness / all);
  return lost;
}

} // namespace cdem
