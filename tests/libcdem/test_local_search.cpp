// A search of a broken body leaves as they were: rows far from new surface, and those of a fragment with itself.
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "tests/libcdem/boxes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace testing;

namespace {

constexpr double width = 0.4, height = 3.2, cell = 0.2; // m

void leave_to_contact(System& s, const std::function<bool(const cdem::FaceNodes&)>& which) {
  each_face(s.model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
    if (!which(face_nodes(s.model.mesh, chunk, batch, lane)))
      return;
    cdem::slips_of(s.state, batch);
    for (auto& point : s.state.faces[batch].mode)
      point[lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_tension);
    s.state.faces[batch].handed_over[lane] = 1;
  });
}

// A column of bonded tetrahedra, cut across at a quarter of its height.
constexpr double cut_at = 0.25 * height; // m
System column() {
  cdem::Bonding everywhere;
  everywhere.everywhere = true;
  System s(
      build({meshed("column",
                    geom::box_mesh({width, width, height}, {static_cast<int>(std::lround(width / cell)), 2,
                                                            static_cast<int>(std::lround(height / cell))}),
                    everywhere, soft_rock())},
            {{"column", "column", friction(20)}}));
  leave_to_contact(s, [&](const cdem::FaceNodes& nodes) {
    return std::all_of(nodes.a.begin(), nodes.a.end(),
                       [&](int node) { return std::abs(s.model.node_position[node].z() - cut_at) < 1e-9; });
  });
  return s;
}

// The upper quarter folded down along one side: the longer fragment lies against itself.
void fold(System& s) {
  constexpr double gap = 1e-6; // m
  for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
    if (const double z = s.model.node_position[i].z(); z > 0.75 * height)
      s.state.displacement[i] = node({width + gap, 0, 2 * (0.75 * height - z)});
}

bool of_one_fragment(const cdem::ContactRow& row) {
  return row.source_mover == row.mover;
}

// Rows of semi-springs that were found anew have not been looked at.
struct Rows {
  int kept = 0, renewed = 0;

  void add(const cdem::ContactRow& row) { ++(row.reach > 0 ? kept : renewed); }
};

} // namespace

TEST_CASE("local search: rows far from new surface stay", "[contact][fracture]") {
  System s = column();
  cdem::ContactWork work;
  cdem::start_contact(s.model, work);
  cdem::contact_forces(s.model, s.state, work, 1);
  const std::size_t before = work.rows[cdem::Contact::spring].size();
  CHECK(before == 16); // the triangles at the cut, each with those across
  bool one = false;    // more of the surface at the other end of the longer fragment
  leave_to_contact(s, [&](const cdem::FaceNodes& nodes) {
    const bool first = !one && s.model.node_position[nodes.a[0]].z() > 0.9 * height;
    one = one || first;
    return first;
  });
  REQUIRE(one);
  work.fragments_due = true;
  REQUIRE(cdem::search_contacts(s.model, s.state, work, 1));
  Rows at_cut;
  for (const cdem::ContactRow& row : work.rows[cdem::Contact::spring])
    if (s.model.node_position[s.model.surface.triangles[row.source].nodes[0]].z() < 2 * cut_at)
      at_cut.add(row);
  CHECK(at_cut.renewed == 0);
  CHECK(at_cut.kept == static_cast<int>(before));
}

TEST_CASE("local search: a fragment that moved past others keeps its rows with itself",
          "[contact][fracture]") {
  System s = column();
  fold(s);
  cdem::ContactWork work;
  cdem::start_contact(s.model, work);
  cdem::contact_forces(s.model, s.state, work, 1);
  const auto of_springs = [&] {
    std::array<Rows, 2> rows; // of two fragments, of one with itself
    for (const cdem::ContactRow& row : work.rows[cdem::Contact::spring])
      rows[of_one_fragment(row)].add(row);
    return rows;
  };
  const auto before = of_springs();
  CHECK(before[0].kept == 16); // the triangles at the cut, each with those across
  CHECK(before[1].kept > 20);
  std::fill(work.left.begin(), work.left.end(), 0);
  REQUIRE(cdem::search_contacts(s.model, s.state, work, 1));
  const auto after = of_springs();
  CHECK(after[0].renewed == before[0].kept);
  CHECK(after[0].kept == 0);
  CHECK(after[1].renewed == 0);
  CHECK(after[1].kept == before[1].kept);
}
