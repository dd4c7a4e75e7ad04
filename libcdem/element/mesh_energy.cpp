// Elastic energy of meshes half a step ago, where velocities stand: the stress less what the velocity has added to it since,
//   sigma - dt (lambda tr(D) I + 2 G D),   sigma : C^-1 : sigma = (sigma : sigma - nu / (1 + nu) tr(sigma)^2) / 2G,
// eight tets at a time. The sums go in the order of the tets.
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

struct TetsWithEnergy {
  int node[4][lanes];
  double stress[6][lanes];
  double jump[9][lanes]; // m3/s, velocity_jumps, column by column
  double lambda[lanes], shear[lanes], poisson[lanes];
  double moves[lanes]; // 1; 0: of a rigid body, whose stress stands still
  double energy[lanes];
};

// J / 2 of face_jumps.hpp, summed over the freed faces of each tet of a mesh, m3/s; empty where there are none.
std::vector<geom::Mat3> velocity_jumps(const Model& model, const State& state,
                                       const std::vector<Node>& position) {
  std::vector<geom::Mat3> jumps(
      model.mesh.sides.empty() ? 0 : model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet),
      geom::Mat3::Zero());
  each_side(model.mesh, [&](int tet, int face, const geom::Triangle& own, const geom::Triangle& beyond) {
    if (!holds(state.faces[face / lanes].stage[face % lanes]))
      return;
    geom::Vec3 jump = geom::Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      jump += (vec(state.velocity[beyond[i]]) - vec(state.velocity[own[i]])) / 3;
    const geom::Vec3 x0 = vec(position[own[0]]);
    const geom::Vec3 area = 0.5 * (vec(position[own[1]]) - x0).cross(vec(position[own[2]]) - x0);
    jumps[tet - model.mesh.first_tet] += 0.5 * jump * area.transpose();
  });
  return jumps;
}

// Takes off the stress what has been added to it in `lag` seconds.
CDEM_INLINE void take_back(const Node* place, const Node* velocity, double lag, const TetsWithEnergy& t,
                           Oct (&s)[6]) {
  Vec x[4], v[4];
  for (int k = 0; k < 4; ++k) {
    x[k] = simd::gather(place, t.node[k]);
    v[k] = simd::gather(velocity, t.node[k]);
  }
  const Vec e1 = minus(x[1], x[0]), e2 = minus(x[2], x[0]), e3 = minus(x[3], x[0]);
  const Vec c[3] = {cross(e2, e3), cross(e3, e1), cross(e1, e2)};
  const Oct six_volume = dot(e1, c[0]), volume = six_volume / 6.0;
  Vec g[4];
  for (int k = 1; k < 4; ++k)
    g[k] = {c[k - 1].x / six_volume, c[k - 1].y / six_volume, c[k - 1].z / six_volume};
  g[0] = {-(g[1].x + g[2].x + g[3].x), -(g[1].y + g[2].y + g[3].y), -(g[1].z + g[2].z + g[3].z)};
  Vec column[3]; // of grad v
  const auto sum = [&](Oct Vec::*of_v, Oct Vec::*of_g) {
    return v[0].*of_v * g[0].*of_g + v[1].*of_v * g[1].*of_g + v[2].*of_v * g[2].*of_g +
           v[3].*of_v * g[3].*of_g;
  };
  Oct Vec::*const axes[3] = {&Vec::x, &Vec::y, &Vec::z};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      column[j].*axes[i] = lag * (sum(axes[i], axes[j]) + simd::load(t.jump[3 * j + i]) / volume);
  const Oct moves = simd::load(t.moves), shear = simd::load(t.shear),
            mean = simd::load(t.lambda) * (column[0].x + (column[1].y + column[2].z));
  s[0] -= moves * (mean + shear * (column[0].x + column[0].x));
  s[1] -= moves * (mean + shear * (column[1].y + column[1].y));
  s[2] -= moves * (mean + shear * (column[2].z + column[2].z));
  s[3] -= moves * (shear * (column[1].x + column[0].y));
  s[4] -= moves * (shear * (column[2].y + column[1].z));
  s[5] -= moves * (shear * (column[2].x + column[0].z));
}

// now, then: places, m.
CDEM_INLINE void energy_kernel(const Node* now, const Node* then, const Node* velocity, double lag,
                               TetsWithEnergy* t) {
  Oct s[6];
  for (int c = 0; c < 6; ++c)
    s[c] = simd::load(t->stress[c]);
  if (lag != 0)
    take_back(now, velocity, lag, *t, s);
  Vec x[4];
  for (int k = 0; k < 4; ++k)
    x[k] = simd::gather(then, t->node[k]);
  const Vec e1 = minus(x[1], x[0]), e2 = minus(x[2], x[0]), e3 = minus(x[3], x[0]);
  const Oct volume = dot(e1, cross(e2, e3)) / 6.0;
  const Oct xx = s[0] * s[0], yy = s[1] * s[1], zz = s[2] * s[2], xy = s[3] * s[3], yz = s[4] * s[4],
            xz = s[5] * s[5];
  const Oct squares = (((xx + xz) + (yy + xz)) + ((xy + xy) + (yz + yz))) + zz, trace = s[0] + (s[1] + s[2]),
            poisson = simd::load(t->poisson),
            work = (squares - poisson / (1.0 + poisson) * trace * trace) / (2.0 * simd::load(t->shear));
  simd::store(t->energy, 0.5 * work * volume);
}

} // namespace

double mesh_elastic_energy(const Model& model, const State& state, double lag) {
  if (model.mesh.empty())
    return 0;
  const std::vector<Node> now = present_places(model, state);
  std::vector<Node> then = displacement_ago(state, lag);
  for (std::size_t i = 0; i < then.size(); ++i)
    add(then[i], model.node_position[i]);
  const std::vector<geom::Mat3> jumps = velocity_jumps(model, state, now);
  const int first = model.mesh.first_tet, end = static_cast<int>(model.tets.size());
  double energy = 0;
  TetsWithEnergy t{};
  for (int begin = first; begin < end; begin += lanes) {
    for (int lane = 0; lane < lanes; ++lane) {
      const int tet = std::min(begin + lane, end - 1);
      const Block& block = model.blocks[model.tet_block[tet]];
      const Elastic& material = model.bodies[block.body].material;
      for (int k = 0; k < 4; ++k)
        t.node[k][lane] = model.tets[tet][k];
      const Stress stress = tet_stress(model, state, tet);
      for (int c = 0; c < 6; ++c)
        t.stress[c][lane] = stress[c];
      if (!jumps.empty())
        for (int i = 0; i < 9; ++i)
          t.jump[i][lane] = jumps[tet - first].data()[i];
      t.lambda[lane] = material.lame_lambda();
      t.shear[lane] = material.shear_modulus();
      t.poisson[lane] = material.poissons_ratio;
      t.moves[lane] = block.rigid >= 0 ? 0 : 1;
    }
    simd::best<energy_kernel>(now.data(), then.data(), state.velocity.data(), lag, &t);
    for (int lane = 0; lane < std::min(lanes, end - begin); ++lane)
      energy += t.energy[lane];
  }
  return energy;
}

} // namespace cdem
