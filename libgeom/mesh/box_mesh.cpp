#include "libgeom/mesh/box_mesh.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"

namespace geom {
namespace {

// A cell's corners by the bits of their number: x, y, z. Each tet walks from corner 0 to corner 7 along the
// axes in one of their six orders; odd orders have two corners swapped, so that volumes are positive.
constexpr int cell_tets[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                 {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};

} // namespace

TetMesh box_mesh(const Vec3& size, const std::array<int, 3>& divisions, double jitter, std::uint64_t seed) {
  require_positive("size", size);
  double tets = 6;
  for (const int n : divisions) {
    if (n < 1)
      throw InputError("divisions", std::to_string(n), "three whole numbers from 1");
    tets *= n;
  }
  if (tets > max_tets)
    throw InputError("divisions", text(Vec3(divisions[0], divisions[1], divisions[2])),
                     "such that there are at most 20 million tetrahedra");
  require_between("jitter", jitter, 0, max_box_jitter);

  const int nx = divisions[0], ny = divisions[1], nz = divisions[2];
  const Vec3 cell = size.cwiseQuotient(Vec3(nx, ny, nz));
  TetMesh mesh;
  mesh.nodes.reserve(static_cast<std::size_t>(nx + 1) * (ny + 1) * (nz + 1));
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        // On the upper faces exactly, whatever n * (size / n) rounds to.
        Vec3 x(i == nx ? size.x() : i * cell.x(), j == ny ? size.y() : j * cell.y(),
               k == nz ? size.z() : k * cell.z());
        if (jitter > 0 && i > 0 && j > 0 && k > 0 && i < nx && j < ny && k < nz)
          for (int axis = 0; axis < 3; ++axis)
            x[axis] += jitter * cell[axis] *
                       (2 * uniform(seed, mesh.nodes.size(), static_cast<std::uint64_t>(axis)) - 1);
        mesh.nodes.push_back(x);
      }
  mesh.tets.reserve(static_cast<std::size_t>(tets));
  const auto node = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (const auto& corners : cell_tets) {
          Tet tet{};
          for (std::size_t c = 0; c < 4; ++c)
            tet[c] = node(i + (corners[c] & 1), j + (corners[c] >> 1 & 1), k + (corners[c] >> 2));
          mesh.tets.push_back(tet);
        }
  mesh.region.assign(mesh.tets.size(), 0);
  return mesh;
}

} // namespace geom
