// Semi-edges that broken faces bring: those of the pieces, as if they had never been one.
#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/broad_phase/contact_fragments.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/geometry/semi_edges.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/boxes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

constexpr double width = 0.4; // m

cdem::Joint rough(double friction_angle) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = friction_angle * degree;
  return joint;
}

// Two cubes, one on top of the other: one body of which all bonds between them are broken and handed over...
System broken_in_two(double friction_angle = 20) {
  geom::TetMesh mesh = geom::box_mesh({width, width, 2 * width}, {2, 2, 4});
  mesh.region.clear();
  for (const geom::Tet& tet : mesh.tets) {
    double z = 0;
    for (const int node : tet)
      z += mesh.nodes[node].z() / 4;
    mesh.region.push_back(z > width ? 1 : 0);
  }
  cdem::Bonding between;
  between.between_regions = true;
  System s(
      build({meshed("cubes", mesh, between, soft_rock(1e9))}, {{"cubes", "cubes", rough(friction_angle)}}));
  each_face(s.model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    cdem::slips_of(s.state, batch);
    for (auto& point : s.state.faces[batch].mode)
      point[lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
    s.state.faces[batch].handed_over[lane] = 1;
  });
  return s;
}

// ... or two bodies. The second is built a little higher, and stands where the first one's half does.
System never_one(double friction_angle = 20) {
  const double gap = 0.1;
  const geom::TetMesh lower = geom::box_mesh({width, width, width}, {2, 2, 2});
  geom::TetMesh upper = lower;
  for (Vec3& x : upper.nodes)
    x.z() += width + gap;
  System s(build({meshed("lower", lower, {}, soft_rock(1e9)), meshed("upper", upper, {}, soft_rock(1e9))},
                 {{"lower", "upper", rough(friction_angle)}}));
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    if (s.model.node_position[i].z() > width + 0.5 * gap)
      s.state.displacement[i].z = -gap;
  return s;
}

Vec3 place(const System& s, int node) {
  return s.model.node_position[node] + vec(s.state.displacement[node]);
}

// Per node.
std::vector<char> is_upper(const System& s) {
  std::vector<char> upper(s.model.node_position.size());
  for (const geom::Tet& tet : s.model.tets) {
    double z = 0;
    for (const int node : tet)
      z += place(s, node).z() / 4;
    for (const int node : tet)
      upper[node] = static_cast<char>(z > width);
  }
  return upper;
}

// The crack's edges crossed and apart by `gap`: the upper cube, edge down, falls on the edge of the lower one, away from
// all nodes, with `speed` along their common normal.
Vec3 cross_edges(System& s, double gap, double speed) {
  const std::vector<char> upper = is_upper(s);
  Vec3 normal = Vec3(0, 1, 1).normalized();
  const Vec3 lower_edge(0.27 * width, width, width), upper_edge(0.29 * width, 0, width);
  const Mat3 turn = rotation(normal, 75 * degree);
  for (std::size_t i = 0; i < upper.size(); ++i)
    if (upper[i]) {
      const int n = static_cast<int>(i);
      const Vec3 to = lower_edge + gap * normal + turn * (place(s, n) - upper_edge);
      s.state.displacement[i] = node(to - s.model.node_position[i]);
      s.state.velocity[i] = node(-speed * normal);
    }
  return normal;
}

struct Impact {
  Vec3 momentum = Vec3::Zero(); // of the upper cube, afterwards
  double along = 0;             // of it, along the common normal
  int edges = 0, springs = 0;   // contacts at most
};

Impact impact(System s, double duration) {
  const std::vector<char> upper = is_upper(s);
  const Vec3 normal = cross_edges(s, 1e-3, 1);
  Impact result;
  cdem::RunOptions options;
  options.time_step = 2e-6;
  options.duration = duration;
  options.callback_every = 20;
  options.callback = [&] {
    int edges = 0;
    for (const cdem::Contact& c : s.state.contacts)
      edges += c.kind == cdem::Contact::edge ? 1 : 0;
    result.edges = std::max(result.edges, edges);
    result.springs = std::max(result.springs, static_cast<int>(s.state.contacts.size()) - edges);
  };
  s.run(options);
  for (std::size_t i = 0; i < upper.size(); ++i)
    if (upper[i])
      result.momentum += s.model.node_mass[i] * vec(s.state.velocity[i]);
  result.along = result.momentum.dot(normal);
  return result;
}

using Segment = std::array<double, 6>; // ends in order, m, to a micrometre

std::vector<Segment> edges_of(System s) {
  cdem::ContactWork work;
  cdem::start_contact(s.model, work);
  cdem::tell_of_bonds(s.model, s.state, work.search.told_due);
  cdem::find_contact_fragments(s.model, s.state, work.fragments);
  const std::vector<cdem::ContactEdge> edges = cdem::find_semi_edges(s.model, s.state, work.fragments).all;
  CHECK(std::is_sorted(edges.begin(), edges.end(),
                       [](const auto& a, const auto& b) { return a.id() < b.id(); }));
  const auto rounded = [](const Vec3& x) {
    return std::array<double, 3>{std::round(1e6 * x.x()), std::round(1e6 * x.y()), std::round(1e6 * x.z())};
  };
  std::vector<Segment> segments;
  for (const cdem::ContactEdge& e : edges) {
    auto from = rounded(place(s, e.nodes[0])), to = rounded(place(s, e.nodes[1]));
    if (to < from)
      std::swap(from, to);
    segments.push_back({from[0], from[1], from[2], to[0], to[1], to[2]});
  }
  std::sort(segments.begin(), segments.end());
  return segments;
}

} // namespace

TEST_CASE("semi-edges: a body broken in two has those of its two pieces", "[contact][edges][fracture]") {
  const std::vector<Segment> edges = edges_of(broken_in_two());
  CHECK(edges.size() == 2 * 12 * 2); // cubes, two cells along an edge
  CHECK(edges == edges_of(never_one()));
}

TEST_CASE("semi-edges: broken faces bring none before they are handed over, and the outside keeps its own",
          "[contact][edges][fracture]") {
  System s = broken_in_two();
  for (cdem::FaceStateBatch& faces : s.state.faces)
    std::fill(std::begin(faces.handed_over), std::end(faces.handed_over), std::uint8_t{0});
  CHECK(edges_of(s).size() == (8 + 4 * 2) * 2); // of the whole prism
}

TEST_CASE("semi-edges: a crack that ends inside gives edges to its mouth only",
          "[contact][edges][fracture]") {
  // Broken where y < width / 2: the mouth runs along three sides of the prism.
  System s = broken_in_two();
  each_face(s.model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
    double y = 0;
    for (const int n : face_nodes(s.model.mesh, chunk, batch, lane).a)
      y += s.model.node_position[n].y() / 3;
    if (y < 0.5 * width)
      return;
    s.state.faces[batch].handed_over[lane] = 0;
    for (auto& point : s.state.faces[batch].mode)
      point[lane] = static_cast<std::uint8_t>(cdem::BondMode::intact);
  });
  // Two edges for each of the mouth's four segments: two along y = 0, one at each side.
  CHECK(edges_of(s).size() == (8 + 4 * 2) * 2 + 2 * 4);
}

TEST_CASE(
    "semi-edges: where more faces are handed over, those found before and the new ones are those found anew",
    "[contact][edges][fracture]") {
  System s = broken_in_two();
  const auto found = [&](double up_to, std::vector<cdem::EdgesOfBroken> known) { // m, of y
    each_face(s.model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
      double y = 0;
      for (const int n : face_nodes(s.model.mesh, chunk, batch, lane).a)
        y += s.model.node_position[n].y() / 3;
      s.state.faces[batch].handed_over[lane] = y < up_to ? 1 : 0;
    });
    cdem::ContactWork work;
    cdem::start_contact(s.model, work);
    cdem::tell_of_bonds(s.model, s.state, work.search.told_due);
    cdem::find_contact_fragments(s.model, s.state, work.fragments);
    return cdem::find_semi_edges(s.model, s.state, work.fragments, std::move(known));
  };
  std::vector<cdem::EdgesOfBroken> known;
  std::size_t fewest = std::numeric_limits<std::size_t>::max(), most = 0;
  for (const double part : {0.3, 0.6, 1.0, 0.4}) {
    cdem::SurfaceEdges now = found(part * width, std::move(known));
    const cdem::SurfaceEdges anew = found(part * width, {});
    REQUIRE(now.all.size() == anew.all.size());
    for (std::size_t e = 0; e < now.all.size(); ++e) {
      CHECK(now.all[e].id() == anew.all[e].id());
      CHECK(now.all[e].triangles == anew.all[e].triangles);
      CHECK(now.all[e].nodes == anew.all[e].nodes);
    }
    fewest = std::min(fewest, now.all.size());
    most = std::max(most, now.all.size());
    known = std::move(now.of_broken);
  }
  CHECK(fewest < most);
}

TEST_CASE("semi-edges: pieces of a broken body that meet edge on edge part as bodies never bonded do",
          "[contact][edges][fracture]") {
  const double phi = GENERATE(0.0, 20.0);
  const Impact pieces = impact(broken_in_two(phi), 0.05), bodies = impact(never_one(phi), 0.05);
  const double before = rock().density * width * width * width; // kg m/s
  CHECK(pieces.edges == 0); // tetrahedra of one body press on each other instead
  INFO("along " << pieces.along / before << " and " << bodies.along / before);
  CHECK(pieces.along > -0.5 * before); // they have met
  // The potential of tetrahedra is softer than semi-edges at a sharp edge, and as elastic.
  CHECK((pieces.momentum - bodies.momentum).norm() < 0.03 * before);
}
