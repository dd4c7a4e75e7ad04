#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/begin_cracks.hpp"
#include "libcdem/fracture/faces_of_chunk.hpp"

#include <algorithm>

namespace cdem {
namespace {

using geom::Mat3;

// J/m3.
double elastic_energy(const Elastic& m, const Mat3& s) {
  const double trace = s.trace();
  return (s.squaredNorm() - m.poissons_ratio / (1 + m.poissons_ratio) * trace * trace) /
         (4 * m.shear_modulus());
}

bool is_larger(const Stress& a, const Stress& b) {
  const double x = matrix(a).squaredNorm(), y = matrix(b).squaredNorm();
  return x != y ? x > y : std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end());
}

} // namespace

void relieve(const Model& model, State& state, BegunCracks& begun, Range chunks, const CrackingStep& step) {
  std::vector<BegunCracks::Relief>& all = begun.reliefs;
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.tet != b.tet ? a.tet < b.tet : is_larger(a.change, b.change);
  });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.tet == b.tet; }),
            all.end());
  std::int64_t chunk = 0;
  for (const BegunCracks::Relief& relief : all) {
    while (relief.tet >= model.mesh.chunks[chunk].tets.end)
      ++chunk;
    const Elastic& material = model.bodies[model.blocks[model.mesh.chunks[chunk].block].body].material;
    const Mat3 before = matrix(mesh_stress(model, state, relief.tet)), change = matrix(relief.change),
               after = before + change;
    const double taken = elastic_energy(material, before) - elastic_energy(material, after);
    if (!(taken > 0)) // relief of a face beside, not of this tet
      continue;
    set_mesh_stress(model, state, relief.tet,
                    {after(0, 0), after(1, 1), after(2, 2), after(0, 1), after(1, 2), after(0, 2)});
    if (chunk < chunks.begin || chunk >= chunks.end)
      continue;
    const Mat3 f = Mat3::Identity() + displacement_gradient(model, state.displacement, relief.tet);
    // Half a step's work of what is taken has gone into no store.
    const double work =
        -0.5 * step.moved_for * change.cwiseProduct(rate_of_strain(model, state, relief.tet)).sum();
    const double energy = tet_volume(model, relief.tet) * f.determinant() * (taken + work);
    if (!begun.relieved.empty() && begun.relieved.back().first == chunk)
      begun.relieved.back().second += energy;
    else
      begun.relieved.emplace_back(chunk, energy);
  }
  all.clear();
}

} // namespace cdem
