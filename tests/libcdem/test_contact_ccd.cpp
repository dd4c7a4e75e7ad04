// Contact of two convex bodies beside libccd: whether they touch, and how deep.
#include "libcdem/contact/contact_forces.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <ccd/ccd.h>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

using Points = std::vector<Vec3>; // of a convex body

Vec3 draw(std::uint64_t id, std::uint64_t first) {
  return {geom::uniform(5, id, first), geom::uniform(5, id, first + 1), geom::uniform(5, id, first + 2)};
}

void farthest(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* place) {
  const Vec3 along(direction->v[0], direction->v[1], direction->v[2]);
  const auto& points = *static_cast<const Points*>(body);
  const Vec3* best = &points[0];
  for (const Vec3& x : points)
    if (x.dot(along) > best->dot(along))
      best = &x;
  ccdVec3Set(place, best->x(), best->y(), best->z());
}

void middle(const void* body, ccd_vec3_t* place) {
  Vec3 sum = Vec3::Zero();
  const auto& points = *static_cast<const Points*>(body);
  for (const Vec3& x : points)
    sum += x / static_cast<double>(points.size());
  ccdVec3Set(place, sum.x(), sum.y(), sum.z());
}

ccd_t settings() {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = farthest;
  ccd.center1 = ccd.center2 = middle;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-8;
  ccd.mpr_tolerance = 1e-8;
  return ccd;
}

bool intersect(const Points& a, const Points& b) {
  const ccd_t ccd = settings();
  return ccdMPRIntersect(&a, &b, &ccd) != 0;
}

struct Penetration {
  double depth = 0;
  Vec3 direction = Vec3::Zero(); // unit: b goes that way to part from a
};

// The shortest way apart (expanding polytope); none when they do not meet.
std::optional<Penetration> penetration(const Points& a, const Points& b) {
  const ccd_t ccd = settings();
  ccd_real_t depth = 0;
  ccd_vec3_t direction, place;
  if (ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &place) != 0)
    return std::nullopt;
  return Penetration{depth, Vec3(direction.v[0], direction.v[1], direction.v[2])};
}

// By portal refinement, of a face on a face.
Penetration of_faces(const Points& a, const Points& b) {
  const ccd_t ccd = settings();
  ccd_real_t depth = 0;
  ccd_vec3_t direction, place;
  REQUIRE(ccdMPRPenetration(&a, &b, &ccd, &depth, &direction, &place) == 0);
  return {depth, Vec3(direction.v[0], direction.v[1], direction.v[2])};
}

// A tet not far from regular, a cube or a sheared box, about 1 m, turned anyhow.
geom::TetMesh shape(std::uint64_t id) {
  geom::TetMesh mesh;
  if (id % 3 == 0) {
    mesh.nodes = {{0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}, {-0.5, 0.5, -0.5}, {0.5, -0.5, -0.5}};
    for (std::size_t i = 0; i < 4; ++i)
      mesh.nodes[i] += 0.2 * (draw(id, 10 + 3 * i) - Vec3::Constant(0.5));
    mesh.tets = {{0, 1, 2, 3}};
    mesh.region = {0};
    const Vec3 a = mesh.nodes[1] - mesh.nodes[0], b = mesh.nodes[2] - mesh.nodes[0],
               c = mesh.nodes[3] - mesh.nodes[0];
    if (a.dot(b.cross(c)) < 0)
      std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  } else {
    mesh = geom::box_mesh({0.8, 0.8, 0.8}, {1, 1, 1});
    Mat3 shear = Mat3::Identity();
    if (id % 3 == 2)
      shear += 0.25 * (Mat3() << draw(id, 30), draw(id, 33), draw(id, 36)).finished();
    for (Vec3& x : mesh.nodes)
      x = shear * (x - Vec3::Constant(0.4));
  }
  const Mat3 turn = rotation(draw(id, 50) - Vec3::Constant(0.5), 6 * geom::uniform(5, id, 60));
  for (Vec3& x : mesh.nodes)
    x = turn * x;
  return mesh;
}

// The two built far from each other; the second one then goes to where it is asked for.
class Pair {
public:
  Pair(const geom::TetMesh& a, geom::TetMesh b) : a_(a.nodes), b_(b.nodes), system_(build(a, std::move(b))) {}

  const Points& a() const { return a_; }
  Points b(const Vec3& shift) const {
    Points moved = b_;
    for (Vec3& x : moved)
      x += shift;
    return moved;
  }

  std::vector<cdem::Contact> contacts(const Vec3& shift) {
    for (std::size_t i = 0; i < system_.state.displacement.size(); ++i)
      if (block_of(system_.model, static_cast<int>(i)) == 1)
        system_.state.displacement[i] = node(shift - away);
    cdem::State state = system_.state;
    cdem::Workspace work(system_.model, state, system_.conditions);
    contact_forces(system_.model, state, work.contact, 1);
    return state.contacts;
  }

private:
  static System build(const geom::TetMesh& a, geom::TetMesh b) {
    for (Vec3& x : b.nodes)
      x += away;
    cdem::Joint joint;
    joint.bonded = false;
    joint.friction_angle = 0.5;
    return System(testing::build({meshed("a", a), meshed("b", std::move(b))}, {{"a", "b", joint}}));
  }

  inline static const Vec3 away{10, 0, 0};
  Points a_, b_;
  System system_;
};

} // namespace

TEST_CASE("contact: two convex bodies touch when libccd says that they intersect", "[contact][ccd]") {
  // m: where corners stand in by two hundredths of an edge of a metre the first springs, and as deep as edges still cross.
  const double depth = 0.025, gap = 0.005;
  int looked_at = 0, by_edges = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Pair pair(shape(2 * i), shape(2 * i + 1 + i / 3));
    const Vec3 start = 0.5 * (draw(i, 100) - Vec3::Constant(0.5));
    const auto in = penetration(pair.a(), pair.b(start));
    REQUIRE(in);
    const Vec3 apart = start + (in->depth + gap) * in->direction,
               touching = start + (in->depth - depth) * in->direction;
    // Now and then the polytope ends at another face than the nearest.
    const auto now = penetration(pair.a(), pair.b(touching));
    if (intersect(pair.a(), pair.b(apart)) || !now || std::abs(now->depth - depth) > 1e-5)
      continue;
    const auto contacts = pair.contacts(touching);
    INFO("pair " << i);
    CHECK_FALSE(contacts.empty());
    CHECK(pair.contacts(apart).empty());
    ++looked_at;
    by_edges += std::all_of(contacts.begin(), contacts.end(),
                            [](const cdem::Contact& c) { return c.kind == cdem::Contact::edge; })
                    ? 1
                    : 0;
    // Nothing is deeper than the shortest way apart.
    for (const cdem::Contact& c : contacts)
      CHECK(c.depth < now->depth + 1e-5);
  }
  CHECK(looked_at > 200);
  CHECK(by_edges > 20);
  CHECK(by_edges < looked_at - 20);
}

TEST_CASE("contact: a face pressed into a face stands as deep as libccd says", "[contact][ccd]") {
  const geom::TetMesh below = [] {
    geom::TetMesh mesh = geom::box_mesh({2, 2, 1}, {1, 1, 1});
    for (Vec3& x : mesh.nodes)
      x -= Vec3(1, 1, 1);
    return mesh;
  }();
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Mat3 yaw = rotation({0, 0, 1}, 6 * geom::uniform(5, i, 70)),
               turn = rotation(draw(i, 71) - Vec3::Constant(0.5), 6 * geom::uniform(5, i, 75));
    geom::TetMesh slab = below, cube = geom::box_mesh({0.6, 0.6, 0.6}, {1, 1, 1});
    for (Vec3& x : slab.nodes)
      x = turn * x;
    const double depth = 0.002 + 0.02 * geom::uniform(5, i, 76);
    for (Vec3& x : cube.nodes)
      x = turn * (yaw * (x - Vec3(0.3, 0.3, 0)) + Vec3(0, 0, -depth));
    Pair pair(slab, cube);
    const Penetration in = of_faces(pair.a(), pair.b(Vec3::Zero()));
    CHECK(in.depth == Approx(depth).epsilon(1e-5));
    int springs = 0; // of the face; those of the faces around it stand in from the edges
    for (const cdem::Contact& c : pair.contacts(Vec3::Zero())) {
      CHECK(c.depth < in.depth * (1 + 1e-5));
      if (c.depth < in.depth * (1 - 1e-5))
        continue;
      CHECK(c.normal.dot(in.direction) == Approx(1).epsilon(1e-5));
      ++springs;
    }
    CHECK(springs == 6); // three for each triangle of the face
  }
}
