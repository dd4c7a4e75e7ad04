// Values read from a model: fields, means, interpolation, probes, histories, counts, snapshots.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// A square plate with u = G x exactly, under the tractions of C : sym G.
cdem::Simulation stretched(const geom::Mat3& gradient) {
  cdem::Simulation s = simulation(geom::grid({1, 1, 1}, {1, 1, 1}));
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double z : {0.0, 1.0}) {
        cdem::Fix corner;
        corner.on = at_place({x, y, z});
        corner.displacement = gradient * Vec3(x, y, z);
        s.fix(corner);
      }
  for (const cdem::Traction& traction : on_six_sides(hooke(rock(), gradient)))
    s.traction(traction);
  cdem::RelaxOptions options;
  options.residual = 1e-12;
  REQUIRE(s.relax(options).converged);
  return s;
}

} // namespace

TEST_CASE("fields and their means and places are those of a linear displacement", "[results]") {
  geom::Mat3 g;
  g << 3e-4, -1e-4, 2e-4, 5e-5, -4e-4, 1e-4, -5e-4, 3e-4, 1.5e-4;
  const cdem::Simulation s = stretched(g);
  const Vec3 place(0.3, 0.6, 0.1), u = g * place;
  CHECK(s.at("displacement.x", place) == Approx(u.x()).epsilon(1e-8));
  CHECK(s.at("displacement.magnitude", place) == Approx(u.norm()).epsilon(1e-8));
  CHECK(s.mean("displacement.y", cdem::Selection::side("z+")) ==
        Approx((g * Vec3(0.5, 0.5, 1)).y()).epsilon(1e-8));
  CHECK(s.max("displacement.x").value == Approx((g * Vec3(1, 0, 1)).x()).epsilon(1e-8));
  CHECK((s.max("displacement.x").place - Vec3(1, 0, 1)).norm() == 0);
  CHECK(s.min("displacement.x").value == Approx((g * Vec3(0, 1, 0)).x()).epsilon(1e-8));

  const geom::Mat3 stress = hooke(rock(), g);
  CHECK(s.mean("stress.xz") == Approx(stress(0, 2)).epsilon(1e-8));
  CHECK(s.at("stress.yy", place) == Approx(stress(1, 1)).epsilon(1e-8));
  const geom::Mat3 deviator = stress - stress.trace() / 3 * geom::Mat3::Identity();
  CHECK(s.mean("von_mises") == Approx(std::sqrt(1.5 * deviator.squaredNorm())).epsilon(1e-8));
  // Principal stresses by their invariants, the largest first.
  const double p1 = s.mean("principal_stress.1"), p2 = s.mean("principal_stress.2"),
               p3 = s.mean("principal_stress.3");
  CHECK(p1 >= p2);
  CHECK(p2 >= p3);
  CHECK(p1 + p2 + p3 == Approx(stress.trace()).epsilon(1e-8));
  CHECK(p1 * p1 + p2 * p2 + p3 * p3 == Approx(stress.squaredNorm()).epsilon(1e-8));
  CHECK(p1 * p2 * p3 == Approx(stress.determinant()).epsilon(1e-8));
}

TEST_CASE("a mean over a side weighs nodes by their area, not by their number", "[results]") {
  // One large block beside four small ones in its height: the displacement field is x = z.
  cdem::ModelSpec spec;
  spec.bodies = {body("large", geom::grid({1, 1, 1}, {1, 1, 1})),
                 body("small", geom::grid({1, 1, 0.2}, {4, 4, 1}, {0, 0, 1}))};
  spec.pairs = {{"large", "small", rock_joint()}};
  cdem::Simulation s(spec, 1, nullptr);
  s.initial_velocity(cdem::Selection::of_body("small"), {1, 0, 0});
  // Side x-: 1 m2 of the large block at rest, 0.2 m2 of the small ones at 1 m/s.
  CHECK(s.mean("velocity.x", cdem::Selection::side("x-")) == Approx(0.2 / 1.2).epsilon(1e-12));
  CHECK(s.mean("velocity.x") == Approx(0.2 / 1.2).epsilon(1e-12)); // by volume
}

TEST_CASE("histories hold the beginning of a run, every tenth step, probes and the breaks so far",
          "[results]") {
  cdem::Joint weak = rock_joint();
  weak.tensile_strength = 1e5;
  cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}), rock(), weak);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.probe("end", "velocity.x", {0.19, 0.05, 0.05});
  s.initial_velocity(cdem::Selection::in_box({{0.11, -1, -1}, {1, 1, 1}}), {1, 0, 0});
  cdem::RunOptions options;
  options.steps = 205;
  options.time_step = 1e-6; // else it falls once a bond is broken
  const double kinetic = s.energy().kinetic;
  const cdem::RunResult run = s.run(options);
  REQUIRE(s.log().probes.size() == 1);
  CHECK(s.log().probes[0].name == "end");
  REQUIRE(s.log().history.size() == 22); // the beginning, 20 and the last
  for (int i = 0; i <= 20; ++i) {
    CHECK(s.log().history[i].step == 10 * i);
    CHECK(s.log().history[i].stage == 1);
    CHECK(s.log().history[i].time == Approx(10 * i * run.time_step).epsilon(1e-12));
  }
  CHECK(s.log().history.front().probes.at(0) == 1);
  CHECK(s.log().history.front().kinetic == kinetic);
  CHECK(s.log().history.back().step == 205);
  CHECK(s.log().history.back().probes.at(0) == s.at("velocity.x", {0.19, 0.05, 0.05}));
  CHECK(s.log().history.back().broken_tension == run.broken_tension);
  CHECK(run.broken_tension == s.counts().broken_tension);
  CHECK(static_cast<std::int64_t>(s.log().breaks.size()) == run.broken_tension + run.broken_shear);
  CHECK(run.broken_tension > 0);
  CHECK(std::is_sorted(s.log().breaks.begin(), s.log().breaks.end(),
                       [](const auto& a, const auto& b) { return a.step < b.step; }));
  CHECK(s.time() == Approx(205 * run.time_step).epsilon(1e-12));
}

TEST_CASE("counts and block rows add up to the body", "[results]") {
  geom::VoronoiOptions cells;
  cells.size = {2, 1, 0.5};
  cells.count = 12;
  const cdem::Simulation s = simulation(geom::voronoi(cells));
  const cdem::ModelCounts c = s.counts();
  CHECK(c.blocks == 12);
  CHECK(c.bodies == 1);
  CHECK(c.bonds == c.intact + c.broken_tension + c.broken_shear + c.contacts);
  double volume = 0;
  for (const auto& row : s.blocks()) {
    volume += row.volume;
    CHECK(row.body == "body");
    CHECK(row.parent == -1);
    CHECK(row.generation == 0);
  }
  CHECK(volume == Approx(1).epsilon(1e-10));
  CHECK((s.model().box.size() - Vec3(2, 1, 0.5)).norm() < 1e-12);
}

TEST_CASE("a snapshot holds as many values as points and tets and bonds, and the tets fill the body",
          "[results]") {
  geom::VoronoiOptions cells;
  cells.count = 10;
  cdem::Simulation s = simulation(geom::voronoi(cells));
  const cdem::Snapshot shot = s.snapshot("title");
  CHECK(shot.title == "title");
  CHECK(static_cast<std::int64_t>(shot.points.size()) == s.counts().nodes);
  CHECK(static_cast<std::int64_t>(shot.tets.size()) == s.counts().tets);
  for (const cdem::SnapshotField& f : shot.point_fields)
    CHECK(f.values.size() == f.components * shot.points.size());
  for (const cdem::SnapshotField& f : shot.cell_fields)
    CHECK(f.values.size() == f.components * shot.tets.size());
  for (const cdem::SnapshotField& f : shot.bonds.point_fields)
    CHECK(f.values.size() == f.components * shot.bonds.points.size());
  for (const cdem::SnapshotField& f : shot.bonds.triangle_fields)
    CHECK(f.values.size() == shot.bonds.triangles.size());
  double volume = 0, surface = 0;
  for (const geom::Tet& t : shot.tets)
    volume += (shot.points[t[1]] - shot.points[t[0]])
                  .dot((shot.points[t[2]] - shot.points[t[0]]).cross(shot.points[t[3]] - shot.points[t[0]])) /
              6;
  CHECK(volume == Approx(1).epsilon(1e-10));
  // Volume again, from the outward surface triangles by the divergence theorem.
  for (const geom::Triangle& t : shot.surface)
    surface += shot.points[t[0]].dot(shot.points[t[1]].cross(shot.points[t[2]])) / 6;
  CHECK(surface == Approx(1).epsilon(1e-10));
}

TEST_CASE("a side selects, for block fields, the blocks that have a face on it", "[results]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 0.3}, {1, 1, 3}));
  s.fix(fixed(cdem::Selection::side("z-")));
  s.gravity(gravity());
  cdem::RelaxOptions options;
  options.residual = 1e-9;
  REQUIRE(s.relax(options).converged);
  // Balance of a block's first moment: its mean stress carries what is above its middle.
  const double weight = rock().density * 9.81;
  const cdem::Selection bottom = cdem::Selection::side("z-"), top = cdem::Selection::side("z+");
  CHECK(s.mean("stress.zz", bottom) == Approx(-weight * 0.25).epsilon(1e-6));
  CHECK(s.max("stress.zz", bottom).value == s.min("stress.zz", bottom).value);
  CHECK(s.mean("stress.zz", top) == Approx(-weight * 0.05).epsilon(1e-6));
  CHECK(s.min("stress.zz", cdem::Selection::side("x+")).value == Approx(-weight * 0.25).epsilon(1e-6));
}
