#include "libcdem/memory_needed.hpp"

#include "libgeom/polyhedron/polyhedron.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Bytes of a tet: of a mesh whose tets share nodes (323 and 341 measured), of one whose tets have nodes of their own and
// springs between them (1547), and of blocks (967 of small strain, 968 of those that move far, 961 of Voronoi cells).
constexpr double of_mesh = 340, of_bonded_mesh = 1550, of_blocks = 970;
// Cutting over building: the old blocks and the new ones are there at once (1.29 and 1.64 measured, nothing being cut).
constexpr double cutting = 1.65;

// Number of tetrahedra in the star mesh of a block, or in a mesh of zones of this size (m).
double tets_of(const geom::Polyhedron& block, double zone_size) {
  if (zone_size > 0)
    return 6 * std::sqrt(2.0) * geom::mass_properties(block).volume / std::pow(zone_size, 3);
  double tets = 0;
  for (const geom::PolyhedronFace& face : block.faces)
    tets += static_cast<double>(face.loop.size());
  return tets;
}

} // namespace

double memory_to_build(const ModelSpec& spec) {
  double bytes = 0;
  for (const BodySpec& body : spec.bodies) {
    for (const geom::Polyhedron& block : body.shape.blocks)
      bytes += of_blocks * tets_of(block, body.zone_size);
    const bool own_nodes = !body.bonding.none() && !body.bonding.is_cohesive();
    for (const geom::TetMesh& mesh : body.meshes)
      bytes += (own_nodes && body.bonding.everywhere ? of_bonded_mesh : of_mesh) *
               static_cast<double>(mesh.tets.size());
  }
  return bytes;
}

double memory_to_cut(std::int64_t block_tets) {
  return cutting * of_blocks * static_cast<double>(block_tets);
}

std::string memory_warning(const std::string& what, double bytes, double limit, int ranks) {
  if (!(bytes > limit))
    return "";
  const auto shown = [](double of) {
    return of < 1e9 ? fmt::format("{:.0f} MB", of / 1e6) : fmt::format("{:.2g} GB", of / 1e9);
  };
  return fmt::format(
      "{} takes some {} of memory{}, which may take {} (--memory, or the memory of the machine): {}", what,
      shown(bytes), ranks > 1 ? fmt::format(" in each of {} ranks", ranks) : " in this process", shown(limit),
      ranks > 1 ? "start fewer ranks on a machine, with more threads each, or take machines with more memory"
                : "make the mesh coarser, or take a machine with more memory");
}

} // namespace cdem
