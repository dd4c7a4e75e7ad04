// Blocks as one mesh: it fills the blocks, and neighbours share their faces whether or not these match.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/parts.hpp"
#include "libgeom/meshing/joined_mesh.hpp"

#include <catch2/catch.hpp>

using geom::Vec3;

namespace {

geom::Assembly cells(int count) {
  geom::VoronoiOptions options;
  options.size = {1, 0.8, 1.2};
  options.count = count;
  return geom::voronoi(options);
}

geom::Assembly wall() {
  geom::BrickOptions options;
  options.size = {2, 0.25, 1};
  options.brick = {0.5, 0.25, 0.25};
  return geom::bricks(options);
}

// A block of which two smaller ones, apart from each other, cover a part of the top.
geom::Assembly two_on_one() {
  return {{geom::make_box({0, 0, 0}, {1, 1, 0.4}), geom::make_box({0.1, 0.2, 0.4}, {0.45, 0.7, 0.8}),
           geom::make_box({0.55, 0.1, 0.4}, {1.2, 0.9, 0.9})}};
}

// Cuts that end within the rock: faces of one block meet several of its neighbours.
geom::Assembly jointed() {
  geom::JointSet steep, flat;
  steep.dip = 1.1;
  steep.dip_direction = 0.4;
  steep.spacing = 0.3;
  flat.dip = 0.3;
  flat.dip_direction = 2;
  flat.spacing = 0.35;
  geom::PlaneCutOptions part;
  part.inside = geom::Box{{0, 0, 0}, {1, 0.5, 0.6}};
  return geom::cut_by_plane(geom::cut_by_joints(geom::grid({1, 0.8, 1.2}, {1, 1, 1}), {steep, flat}),
                            geom::Plane::through({0.5, 0.4, 0.5}, {1, 1, 0.2}), part);
}

double outer_area(const geom::TetMesh& mesh) {
  double sum = 0;
  for (const geom::OuterFace& face : geom::outer_faces(mesh)) {
    const Vec3& x = mesh.nodes[face.nodes[0]];
    sum += 0.5 * (mesh.nodes[face.nodes[1]] - x).cross(mesh.nodes[face.nodes[2]] - x).norm();
  }
  return sum;
}

struct Case {
  const char* name;
  geom::Assembly shape;
  double outside; // m2
};

std::vector<Case> cases() {
  const double box = 2 * (0.8 + 0.96 + 1.2), bricks = 2 * (2 * 0.25 + 2 * 1 + 0.25);
  // The lid of 0.2 x 0.8 m beyond the edge of the large block is outside on both sides.
  const double alone = 2 * (1 + 0.4 + 0.4) + 2 * (0.35 * 0.5 + 0.4 * 0.85) + 2 * (0.65 * 0.8 + 0.5 * 1.45);
  return {{"cells", cells(40), box},
          {"wall", wall(), bricks},
          {"two on one", two_on_one(), alone - 2 * 0.35 * 0.5 - 2 * 0.45 * 0.8},
          {"jointed", jointed(), box}};
}

} // namespace

TEST_CASE("the mesh of joined blocks fills each of them, and is outside only where the assembly is",
          "[joined_mesh]") {
  for (const Case& c : cases()) {
    INFO(c.name);
    const geom::DividedFaces faces = geom::divided_faces(c.shape.blocks, 1e-8);
    for (const double zone : {0.0, 0.15}) {
      const geom::TetMesh mesh = zone > 0 ? geom::joined_mesh(c.shape.blocks, faces, zone)
                                          : geom::joined_mesh(c.shape.blocks, faces);
      std::vector<double> volume(c.shape.blocks.size(), 0);
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const geom::Tet& n = mesh.tets[t];
        const Vec3& x = mesh.nodes[n[0]];
        volume[mesh.region[t]] +=
            (mesh.nodes[n[1]] - x).dot((mesh.nodes[n[2]] - x).cross(mesh.nodes[n[3]] - x)) / 6;
      }
      for (std::size_t b = 0; b < volume.size(); ++b)
        CHECK(volume[b] == Approx(geom::mass_properties(c.shape.blocks[b]).volume).epsilon(1e-6));
      CHECK(outer_area(mesh) == Approx(c.outside).epsilon(1e-6));
      CHECK(geom::count_parts(mesh) == 1);
    }
  }
}
