// What a mesh's nodes and tetrahedra are numbered like is nobody's choice: it must not decide where a body lands.
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

using namespace testing;
using geom::Vec3;

namespace {

std::vector<int> permutation(std::size_t n, std::uint64_t seed) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = n; i > 1; --i)
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(geom::uniform(seed, i, 0) * static_cast<double>(i))]);
  return order;
}

geom::TetMesh renumbered(const geom::TetMesh& mesh, std::uint64_t seed) {
  if (seed == 0)
    return mesh;
  const std::vector<int> nodes = permutation(mesh.nodes.size(), seed),
                         tets = permutation(mesh.tets.size(), seed + 1);
  geom::TetMesh out;
  out.nodes.resize(mesh.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out.nodes[nodes[i]] = mesh.nodes[i];
  for (const int t : tets) {
    geom::Tet tet = mesh.tets[t];
    for (int& node : tet)
      node = nodes[node];
    std::rotate(tet.begin(), tet.begin() + 1, tet.begin() + 3); // of the same handedness
    out.tets.push_back(tet);
    out.region.push_back(mesh.region[t]);
  }
  return out;
}

struct Landing {
  Vec3 velocity, displacement;
};

// A brick falls askew on a rough plate with a spin of friction, and slides over its triangles.
Landing landing(cdem::Element element, std::uint64_t seed) {
  geom::TetMesh plate = geom::box_mesh({2, 2, 0.2}, {4, 4, 1}),
                brick = geom::box_mesh({0.5, 0.3, 0.2}, {3, 2, 2});
  for (Vec3& x : plate.nodes)
    x += Vec3(-1, -1, -0.2);
  const geom::Mat3 turn = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(0.4, Vec3::UnitY()) *
                           Eigen::AngleAxisd(0.5, Vec3::UnitZ()))
                              .toRotationMatrix();
  double lowest = 1;
  for (Vec3& x : brick.nodes) {
    x = turn * x;
    lowest = std::min(lowest, x.z());
  }
  for (Vec3& x : brick.nodes)
    x.z() += 1e-3 - lowest;
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 30 * degree;
  law.normal_stiffness = 1e9;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("plate", renumbered(plate, seed)), meshed("brick", renumbered(brick, seed))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].element = element;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("plate")));
  s.gravity(gravity());
  s.initial_velocity(cdem::Selection::of_body("brick"), {1.5, 0.7, -2});
  cdem::RunOptions options;
  options.duration = 0.05;
  options.safety = 0.3;
  s.run(options);
  Landing l;
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    l.velocity[i] = s.mean(std::string("velocity.") + axes[i], cdem::Selection::of_body("brick"));
    l.displacement[i] = s.mean(std::string("displacement.") + axes[i], cdem::Selection::of_body("brick"));
  }
  return l;
}

} // namespace

TEST_CASE("the numbering of a mesh does not decide where a body lands", "[contact]") {
  for (const auto element : {cdem::Element::rigid, cdem::Element::finite_volume}) {
    const Landing first = landing(element, 0);
    for (const std::uint64_t seed : {11, 22, 33}) {
      const Landing other = landing(element, seed);
      INFO((element == cdem::Element::rigid ? "rigid " : "deformable ")
           << seed << " velocity " << first.velocity.transpose() << " / " << other.velocity.transpose());
      CHECK((other.velocity - first.velocity).norm() < 1e-6 * first.velocity.norm());
      CHECK((other.displacement - first.displacement).norm() < 1e-6 * first.displacement.norm());
    }
  }
}
