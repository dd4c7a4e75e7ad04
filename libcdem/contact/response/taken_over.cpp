#include "libcdem/contact/response/taken_over.hpp"

#include <algorithm>

namespace cdem {

double take_over(const Model& model, State& state, std::int64_t face, const FaceLeft& left) {
  const FaceTets& tets = model.mesh.face_tets[face];
  TetContact c;
  c.a = std::min(tets.tet_a, tets.tet_b);
  c.b = std::max(tets.tet_a, tets.tet_b);
  c.shear = left.force[0] + left.force[1] + left.force[2];
  if (c.a != tets.tet_a)
    c.shear = -c.shear;
  if (c.shear.isZero(0))
    return left.energy;
  c.taken_over = left.energy;
  state.tet_contacts.insert(std::lower_bound(state.tet_contacts.begin(), state.tet_contacts.end(), c), c);
  return 0;
}

} // namespace cdem
