// Where the topology changes, every field of the state is found where the table of State says.
#include "tests/libcdem/cohesive_concrete.hpp"

#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/state/table.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace testing;
using geom::Vec3;

namespace {

geom::TetMesh moved(geom::TetMesh mesh, const Vec3& by) {
  for (Vec3& x : mesh.nodes)
    x += by;
  return mesh;
}

// One body of every kind, far apart: blocks whose joints soften, soil that yields, rock with springs, a cohesive bar with
// rate effect, a rigid mesh; damped where anything is.
cdem::Model zoo() {
  cdem::Elastic damped = rock();
  damped.stiffness_damping = 1e-6;
  cdem::BodySpec wall =
      body("wall", geom::grid({1, 1, 1}, {2, 2, 2}), damped, concrete_joint(cdem::Softening::linear));
  cdem::BodySpec soil = meshed("soil", moved(geom::box_mesh({1, 1, 1}, {2, 2, 2}), {10, 0, 0}), {}, damped);
  cdem::Plasticity yields;
  yields.cohesion = 1e5;
  soil.plasticity.laws = {yields};
  soil.plasticity.others = 0;
  cdem::BodySpec plate = body("plate", geom::translated(geom::grid({1, 1, 1}, {2, 2, 1}), {-10, 0, 0}));
  plate.element = cdem::Element::small_strain;
  cdem::Bonding springs;
  springs.everywhere = true;
  cdem::BodySpec weak = meshed("weak", moved(geom::box_mesh({1, 1, 1}, {2, 2, 2}), {20, 0, 0}), springs);
  cdem::BodySpec bar = concrete_body(moved(geom::box_mesh({1, 0.3, 0.3}, {6, 2, 2}), {30, 0, 0}));
  bar.joint.rate.reference_rate = 1e-6;
  bar.joint.rate.exponent = 0.018;
  cdem::BodySpec stone = meshed("stone", moved(geom::box_mesh({1, 1, 1}, {1, 1, 1}), {40, 0, 0}));
  stone.element = cdem::Element::rigid;
  return build({wall, plate, soil, weak, bar, stone});
}

// Every number of every array is another one.
void number_all(const cdem::Model& model, cdem::State& state) {
  double next = 1;
  cdem::each_field(
      [&](const cdem::FieldRow& row, auto& field) {
        if constexpr (cdem::is_array<decltype(field)>) {
          if (row.need == cdem::FieldNeed::later)
            field.assign(cdem::entries_of(row, model).value_or(3), cdem::first_entry(field));
          using Entry = std::remove_reference_t<decltype(field[0])>;
          if constexpr (std::is_same_v<Entry, std::uint8_t>) {
            for (std::size_t i = 0; i < field.size(); ++i)
              field[i] = static_cast<std::uint8_t>(i % 2);
          } else if constexpr (std::is_same_v<Entry, cdem::ExcavationForce>) {
            field.clear(); // one on each node
            for (std::size_t node = 0; node < model.node_position.size(); ++node)
              field.push_back({static_cast<std::int64_t>(node), next++, next++, next++, 1, 0.5, 2, 3});
          } else if constexpr (!std::is_same_v<Entry, cdem::FaceStateBatch> &&
                               !std::is_same_v<Entry, cdem::Contact>) {
            auto* number = reinterpret_cast<double*>(field.data());
            for (std::size_t i = 0; i < field.size() * sizeof(Entry) / sizeof(double); ++i)
              number[i] = next++;
          }
        } else if constexpr (std::is_same_v<std::remove_reference_t<decltype(field)>, cdem::EnergyLedger>) {
          field.friction = next++;
        } else {
          field = static_cast<std::remove_reference_t<decltype(field)>>(next++);
        }
      },
      state);
  cdem::each_face(model.mesh, [&](const cdem::MeshChunk& chunk, std::int64_t batch, int lane) {
    cdem::FaceStateBatch& face = state.faces[batch];
    if (model.bodies[model.blocks[chunk.block].body].bonding.is_cohesive()) {
      face.preloaded[lane] = static_cast<std::uint8_t>((batch + lane) % 2);
      return;
    }
    if ((batch + lane) % 3 == 0) {
      face.mode[1][lane] = static_cast<std::uint8_t>(cdem::BondMode::broken_shear);
      cdem::FaceSlip slip = cdem::slip_of(state, batch, lane);
      slip.value[1][0] = next++;
      cdem::slips_of(state, batch).set(lane, slip);
    }
  });
}

template <class T>
bool same(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

std::map<std::pair<int, int>, std::int64_t> faces_by_tets(const cdem::Model& model) {
  std::map<std::pair<int, int>, std::int64_t> faces;
  cdem::each_face(model.mesh, [&](const cdem::MeshChunk&, std::int64_t batch, int lane) {
    const cdem::FaceTets& tets = model.mesh.face_tets[batch * cdem::lanes + lane];
    faces[{tets.tet_a, tets.tet_b}] = batch * cdem::lanes + lane;
  });
  return faces;
}

// The sum of the first numbers of the entries.
template <class Entry>
double sum_of(const std::vector<Entry>& entries) {
  double sum = 0;
  for (const Entry& entry : entries)
    if constexpr (std::is_same_v<Entry, cdem::Node>)
      sum += entry.x;
    else if constexpr (std::is_same_v<Entry, double>)
      sum += entry;
    else if constexpr (std::is_same_v<Entry, cdem::ExcavationForce>)
      sum += entry.x;
  return sum;
}

} // namespace

TEST_CASE("freeing nodes carries every field of all bodies over as its table says", "[carry]") {
  const cdem::Model model = zoo();
  cdem::State state = cdem::initial_state(model);
  // Some nodes first, so that faces are there to be carried.
  const auto some = [](const cdem::Model& of, double from, double to) {
    std::vector<char> nodes(of.node_position.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = of.node_position[i].x() > from && of.node_position[i].x() < to;
    return nodes;
  };
  const cdem::Freed before = cdem::split_nodes(model, state, some(model, 30.1, 30.5));
  cdem::State from = before.state;
  number_all(before.model, from);
  const cdem::Freed freed = cdem::split_nodes(before.model, from, some(before.model, 30.4, 30.9));
  REQUIRE(freed.model.node_position.size() > before.model.node_position.size());

  const std::vector<int>& old_node = freed.old_node;
  const auto old_faces = faces_by_tets(before.model), faces = faces_by_tets(freed.model);
  REQUIRE(faces.size() > old_faces.size());
  int looked_at = 0;
  cdem::each_field(
      [&](const cdem::FieldRow& row, const auto& was, const auto& now) {
        INFO(row.name);
        ++looked_at;
        if constexpr (cdem::is_array<decltype(was)>) {
          using Entry = std::remove_cv_t<std::remove_reference_t<decltype(was[0])>>;
          if (row.place == cdem::FieldPlace::node) {
            REQUIRE(now.size() == (was.empty() ? 0 : old_node.size()));
            if (row.carried == cdem::FieldCarried::divided) {
              CHECK(sum_of(now) == Approx(sum_of(was)).epsilon(1e-12));
              return;
            }
            bool all = true;
            for (std::size_t i = 0; i < now.size(); ++i)
              if constexpr (std::is_same_v<Entry, cdem::Node>)
                all = all && vec(now[i]) == vec(was[old_node[i]]);
              else
                all = all && same(now[i], was[old_node[i]]);
            CHECK(all);
          } else if (row.place == cdem::FieldPlace::excavation) {
            CHECK(now.size() == old_node.size()); // a node that is divided shares its force
            CHECK(sum_of(now) == Approx(sum_of(was)).epsilon(1e-12));
          } else if (row.place == cdem::FieldPlace::face) {
            REQUIRE(!now.empty());
            bool all = true;
            for (const auto& [tets, face] : old_faces)
              all = all && same(now[faces.at(tets)], was[face]);
            CHECK(all);
          } else if (row.place != cdem::FieldPlace::face_batch && row.place != cdem::FieldPlace::slip) {
            CHECK(same(was, now));
          }
        } else {
          CHECK(same(was, now));
        }
      },
      from, freed.state);
  CHECK(looked_at > 30);
  for (const auto& [tets, face] : old_faces) {
    const std::int64_t now = faces.at(tets);
    const cdem::FaceStateBatch &a = from.faces[face / cdem::lanes], &b = freed.state.faces[now / cdem::lanes];
    const auto old_lane = static_cast<int>(face % cdem::lanes), lane = static_cast<int>(now % cdem::lanes);
    CHECK(a.mode[1][old_lane] == b.mode[1][lane]);
    CHECK(a.stage[old_lane] == b.stage[lane]);
    CHECK(a.preloaded[old_lane] == b.preloaded[lane]);
    CHECK(cdem::slip_of(from, face / cdem::lanes, old_lane).value[1][0] ==
          cdem::slip_of(freed.state, now / cdem::lanes, lane).value[1][0]);
  }
}

TEST_CASE("a model rebuilt of the same blocks has the same state, field by field", "[carry]") {
  const cdem::Model built = zoo();
  std::vector<char> nodes(built.node_position.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = built.node_position[i].x() > 30.2 && built.node_position[i].x() < 30.6;
  const cdem::Freed freed = cdem::split_nodes(built, cdem::initial_state(built), nodes);
  cdem::State from = freed.state;
  number_all(freed.model, from);
  std::vector<cdem::Successor> all;
  for (int b = 0; b < static_cast<int>(freed.model.blocks.size()); ++b)
    all.push_back(cdem::whole_block(freed.model, b));
  const cdem::Rebuilt rebuilt = cdem::rebuild(freed.model, from, all, {}, cdem::MayBreak::all);
  cdem::each_field(
      [&](const cdem::FieldRow& row, const auto& was, const auto& now) {
        INFO(row.name);
        if (row.place == cdem::FieldPlace::slip || row.place == cdem::FieldPlace::face_batch)
          return;
        if constexpr (cdem::is_array<decltype(was)>) {
          using Entry = std::remove_cv_t<std::remove_reference_t<decltype(was[0])>>;
          if constexpr (std::is_same_v<Entry, cdem::Node>) { // its fourth number is nobody's
            REQUIRE(was.size() == now.size());
            bool equal = true;
            for (std::size_t i = 0; i < now.size(); ++i)
              equal = equal && vec(now[i]) == vec(was[i]);
            CHECK(equal);
          } else if (row.place == cdem::FieldPlace::tet_batch) { // of the tets that are there
            REQUIRE(was.size() == now.size());
            const auto* a = reinterpret_cast<const double*>(was.data());
            const auto* b = reinterpret_cast<const double*>(now.data());
            constexpr std::size_t batch = sizeof(Entry) / sizeof(double);
            bool equal = true;
            for (const int slot : freed.model.mesh.tet_slot)
              for (std::size_t i = static_cast<std::size_t>(slot) / cdem::lanes * batch;
                   i < (static_cast<std::size_t>(slot) / cdem::lanes + 1) * batch; i += cdem::lanes)
                equal = equal && a[i + slot % cdem::lanes] == b[i + slot % cdem::lanes];
            CHECK(equal);
          } else if (row.place == cdem::FieldPlace::face) {
            bool equal = was.size() == now.size() && !was.empty();
            for (const auto& [tets, face] : faces_by_tets(freed.model))
              equal = equal && same(was[face], now[face]);
            CHECK(equal);
          } else {
            CHECK(same(was, now));
          }
        } else {
          CHECK(same(was, now));
        }
      },
      from, rebuilt.state);
}
