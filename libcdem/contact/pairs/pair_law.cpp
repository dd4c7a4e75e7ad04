#include "libcdem/contact/pairs/pair_law.hpp"

#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

constexpr int most_turns = 60;       // of Newton's method for the depth at which a force is taken over
constexpr double same_force = 1e-12; // of it
constexpr int turns_of_scale = 3;
constexpr double rim_over_height = 1e-3;
constexpr double most_scale = 100;

Vec3 vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

double damping_ratio_of(const Joint& joint) {
  const double e2 = joint.restitution * joint.restitution;
  return (1 - e2) / (1 + e2);
}

// What all pairs of a body have in common.
struct LawOfBody {
  const Joint* joint = nullptr;
  double tan_friction = 0, damping_ratio = 0;

  LawOfBody() = default;
  LawOfBody(const Model& model, int block, double most_friction)
      : joint(contact_joint(model, block, block)),
        tan_friction(std::min(geom::portable::tan(joint->friction_angle), most_friction)),
        damping_ratio(damping_ratio_of(*joint)) {}

  TetLaw between(const TetSize& a, const TetSize& b, double step, double scale) const {
    const ContactStiffness stiffness = contact_stiffness(*joint, a.compliance + b.compliance);
    const double face = 0.5 * scale * (a.area + b.area);
    TetLaw law;
    law.kappa = stiffness.normal * face / 12;
    law.ks = stiffness.shear * face / 3;
    law.tan_friction = tan_friction;
    law.step = step;
    law.damping_ratio = damping_ratio;
    law.damping = damping_ratio * std::sqrt(stiffness.normal * face * a.mass * b.mass / (a.mass + b.mass));
    law.rim = rim_over_height * 0.5 * (a.height + b.height);
    return law;
  }
};

TetSize size_in(const PairContacts& pairs, int tet) {
  return {pairs.size[tet], pairs.area[tet], pairs.compliance[tet], pairs.mass[tet]};
}

struct Batch { // of the pairs of one call
  std::vector<std::int32_t> row;
  std::vector<double> offset, shear;
  std::vector<TetLaw> law;
  std::vector<TetPressure*> out;

  explicit Batch(std::size_t n) : row(n), offset(n), shear(3 * n), law(n), out(n) {}
  void set(std::size_t i, const TetContact& c) {
    offset[i] = c.offset;
    for (int axis = 0; axis < 3; ++axis)
      shear[3 * i + axis] = c.shear[axis];
  }
};

void press(const PairContacts& pairs, const Node* velocity, int threads, const Batch& batch) {
  constexpr std::int64_t at_a_time = 256;
  const auto n = static_cast<std::int64_t>(batch.row.size());
  for_chunks((n + at_a_time - 1) / at_a_time, threads, [&](std::int64_t chunk) {
    const std::int64_t i = chunk * at_a_time;
    const PairsOfTets some{pairs.place.data(), pairs.a.data(), pairs.b.data(), pairs.open.data(), batch.row.data() + i,
                           std::min(at_a_time, n - i)};
    cdem::press(some, velocity, batch.offset.data() + i, batch.law.data() + i, batch.shear.data() + 3 * i,
                batch.out.data() + i);
  });
}

// The offset at which each pair carries the normal part of the force of a face, N: by Newton's method within bounds, since a corner
// that comes in adds its force at once. On the way in, it carries more than that; deepest: m, of corners and edges at offset 0.
void solve_offsets(const PairContacts& pairs, const std::vector<Vec3>& force,
                   const std::vector<double>& deepest, int threads, Batch& batch,
                   std::vector<TetPressure>& now) {
  std::vector<double> carries_more = batch.offset, carries_less = deepest;
  std::vector<char> done(force.size(), 0);
  for (int turn = 0; turn < most_turns; ++turn) {
    press(pairs, nullptr, threads, batch);
    bool all_done = true;
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (done[i])
        continue;
      const double wanted = force[i].dot(vector_of(now[i].normal)), missing = wanted - now[i].pressing;
      double& offset = batch.offset[i];
      (missing < 0 ? carries_more : carries_less)[i] = offset;
      done[i] = static_cast<char>(std::abs(missing) <= same_force * std::abs(wanted));
      if (done[i])
        continue;
      all_done = false;
      const double next = now[i].stiffness > 0 ? offset - missing / now[i].stiffness : carries_less[i];
      const double low = std::min(carries_more[i], carries_less[i]), high = std::max(carries_more[i], carries_less[i]);
      offset = next > low && next < high ? next : 0.5 * (low + high);
    }
    if (all_done)
      break;
  }
  press(pairs, nullptr, threads, batch);
}

// Each pair takes over the force of a face: its offset becomes that at which it carries the normal part, its shear force is the
// rest, and it is as stiff as it must be to store what the face did.
void take_over_forces(const PairContacts& pairs, const Batch& all, const std::vector<std::size_t>& which,
                      int threads, const std::vector<FoundPair*>& found) {
  Batch batch(which.size());
  std::vector<TetPressure> now(which.size());
  std::vector<Vec3> force;
  for (std::size_t i = 0; i < which.size(); ++i) {
    batch.row[i] = all.row[which[i]];
    batch.law[i] = all.law[which[i]];
    batch.out[i] = &now[i];
    force.push_back(found[i]->contact.shear);
  }
  const PairsOfTets some{pairs.place.data(), pairs.a.data(), pairs.b.data(), pairs.open.data(),
                         batch.row.data(),   static_cast<std::int64_t>(which.size())};
  std::vector<double> depth(which.size());
  deepest_in_each_other(some, batch.offset.data(), depth.data()); // offsets are 0
  for (std::size_t i = 0; i < which.size(); ++i)
    batch.offset[i] = depth[i] - 2 * force[i].norm() / batch.law[i].kappa;
  const auto shear_of = [&](std::size_t i) {
    const Vec3 n = vector_of(now[i].normal);
    return Vec3(force[i] - force[i].dot(n) * n);
  };
  const auto stored = [&](std::size_t i) { // J
    const double ks = batch.law[i].ks;
    return now[i].stored + (ks > 0 ? 0.5 * shear_of(i).squaredNorm() / ks : 0);
  };
  solve_offsets(pairs, force, depth, threads, batch, now);
  for (int turn = 0; turn < turns_of_scale; ++turn) {
    for (std::size_t i = 0; i < which.size(); ++i) {
      TetContact& c = found[i]->contact;
      const double wanted = c.taken_over > 0 ? stored(i) / c.taken_over : 1;
      const double scale = std::clamp(c.scale * wanted, 1.0, most_scale), more = scale / c.scale;
      c.scale = scale;
      batch.law[i].kappa *= more;
      batch.law[i].ks *= more;
      batch.offset[i] = depth[i] - 2 * (depth[i] - batch.offset[i]) / more;
    }
    solve_offsets(pairs, force, depth, threads, batch, now);
  }
  for (std::size_t i = 0; i < which.size(); ++i) {
    TetContact& c = found[i]->contact;
    found[i]->breaking = c.taken_over - (now[i].pressing > 0 ? stored(i) : 0);
    c.taken_over = -1;
    c.offset = batch.offset[i];
    c.depth = now[i].depth;
    c.stored = now[i].stored;
    c.shear = now[i].pressing > 0 ? shear_of(i) : Vec3(Vec3::Zero());
  }
}

} // namespace

bool pairs_within(const Model& model, const ContactWork& work, int block) {
  const Block& b = model.blocks[block];
  return work.broken[block] && b.meshed && !b.convex() && b.rigid < 0 && contact_joint(model, block, block);
}

TetSize size_of(const Model& model, int tet) {
  const geom::Tet& nodes = model.tets[tet];
  const auto x = [&](int k) -> const Vec3& { return model.node_position[nodes[k]]; };
  TetSize size;
  const Vec3 a = x(1) - x(0), b = x(2) - x(0), c = x(3) - x(0);
  for (const Vec3& twice : {Vec3(a.cross(b)), Vec3(b.cross(c)), Vec3(c.cross(a)), Vec3((b - a).cross(c - a))})
    size.area += twice.norm() / 8;
  const double volume = a.dot(b.cross(c)) / 6;
  const int block = model.tet_block[tet];
  // Flat ones count as semi-springs at them do.
  size.height = std::max(3 * volume / size.area, model.surface.usual_height[block] / 3);
  size.mass = model.bodies[model.blocks[block].body].material.density * volume;
  size.compliance = size.height / model.bodies[model.blocks[block].body].material.youngs_modulus;
  return size;
}

double first_offset(const PairContacts& pairs, std::int32_t row) {
  return pairs.in_place[row] ? drawn_in * 0.5 * (pairs.size[pairs.a[row]] + pairs.size[pairs.b[row]]) : 0;
}

void press_pairs(const Model& model, const ContactWork& work, const std::vector<std::int32_t>& rows,
                 const std::vector<std::int32_t>& which, int threads, std::vector<FoundPair>& found) {
  const PairContacts& pairs = *work.pairs;
  Batch batch(rows.size());
  batch.row = rows;
  LawOfBody law;
  int block = -1;
  std::vector<std::size_t> taking_over;
  std::vector<FoundPair*> of_taking_over;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int a = pairs.a[rows[i]], b = pairs.b[rows[i]];
    if (const int here = model.tet_block[pairs.tets[a]]; here != block) {
      block = here;
      law = LawOfBody(model, block, work.most_friction);
    }
    FoundPair& to = found[which[i]];
    batch.law[i] = law.between(size_in(pairs, a),
                               size_in(pairs, b), work.step,
                               to.contact.scale);
    batch.out[i] = &to.pressure;
    to.shear_stiffness = batch.law[i].ks;
    if (to.contact.taken_over >= 0) {
      taking_over.push_back(i);
      of_taking_over.push_back(&to);
    }
  }
  if (!taking_over.empty())
    take_over_forces(pairs, batch, taking_over, threads, of_taking_over);
  for (std::size_t i = 0; i < taking_over.size(); ++i) {
    batch.law[taking_over[i]].kappa *= of_taking_over[i]->contact.scale;
    batch.law[taking_over[i]].ks *= of_taking_over[i]->contact.scale;
    of_taking_over[i]->shear_stiffness = batch.law[taking_over[i]].ks;
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    batch.set(i, found[which[i]].contact);
  press(pairs, pairs.velocity.data(), threads, batch);
}

namespace {

// Contacts by themselves, without lists.
struct Alone {
  std::vector<Node> place, velocity;
  std::vector<std::int32_t> a, b;
  std::vector<std::uint8_t> open;
  std::vector<TetPressure> pressure;
  Batch batch;

  Alone(const Model& model, const State& state, const std::vector<TetContact>& contacts, double lag)
      : pressure(contacts.size()), batch(contacts.size()) {
    if (contacts.empty())
      return;
    const std::vector<std::uint8_t> planes = open_planes(model, state);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const TetContact& c = contacts[i];
      for (const int tet : {c.a, c.b}) {
        open.push_back(planes[tet - model.mesh.first_tet]);
        for (const int at : model.tets[tet]) {
          place.push_back(node(place_of(model, state, at) - lag * velocity_of(state, at)));
          velocity.push_back(state.velocity[at]);
        }
      }
      a.push_back(static_cast<std::int32_t>(2 * i));
      b.push_back(static_cast<std::int32_t>(2 * i + 1));
      batch.row[i] = static_cast<std::int32_t>(i);
      batch.out[i] = &pressure[i];
      batch.law[i] = LawOfBody(model, model.tet_block[c.a], std::numeric_limits<double>::infinity())
                         .between(size_of(model, c.a), size_of(model, c.b), -lag, c.scale);
      batch.set(i, c);
    }
    const PairsOfTets all{place.data(), a.data(), b.data(), open.data(), batch.row.data(),
                          static_cast<std::int64_t>(contacts.size())};
    cdem::press(all, lag != 0 ? velocity.data() : nullptr, batch.offset.data(), batch.law.data(),
                batch.shear.data(), batch.out.data());
  }
};

} // namespace

FoundPair pressure_of(const Model& model, const State& state, const TetContact& c, double lag) {
  const Alone alone(model, state, {c}, lag);
  return {c, alone.pressure[0], alone.batch.law[0].ks, 0, true};
}

double stored_in_pairs(const Model& model, const State& state, double lag) {
  const Alone alone(model, state, state.tet_contacts, lag);
  double sum = 0;
  for (std::size_t i = 0; i < state.tet_contacts.size(); ++i) {
    if (!(state.tet_contacts[i].normal > 0))
      continue;
    sum += alone.pressure[i].stored;
    if (const double ks = alone.batch.law[i].ks; ks > 0)
      sum += 0.5 * vector_of(alone.pressure[i].shear).squaredNorm() / ks;
  }
  return sum;
}

} // namespace cdem
