#include "libcdem/contact/narrow_phase/press_tets.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/narrow_phase/rows_asleep.hpp"
#include "libcdem/contact/response/contact_law.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/contact/response/tet_potential.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace cdem {
namespace {

constexpr std::int64_t pairs_per_chunk = 32 * lanes;
// Of what parts an overlap from its phi0 or from its end: strain changes the heights of tetrahedra.
constexpr double trusted = 0.9;

struct Asked {
  std::size_t near = 0;            // of TetContacts::near
  const Contact* before = nullptr; // null: there was none
};

// What stands in State of pairs that sleep stays, and is set between the others.
struct Question {
  std::vector<const Contact*> ended; // their pairs may not touch any more
  std::vector<Asked> asked;
  std::vector<std::pair<std::size_t, const Contact*>> asleep; // before which of `asked`
};

// allowed: m, that the two may go past each other before they are looked at again.
void fall_asleep(TetContacts& of, std::size_t near, double allowed) {
  const float may_go = rounded_down(allowed);
  const auto p = static_cast<std::size_t>(of.place_of_near[near]);
  of.near.set(near, of.paths, may_go);
  of.pairs.set(p, of.paths, may_go);
}

// Whether an old contact goes on: its pair may touch. One too far apart to be a pair is forgotten as in finish_pair.
bool goes_on(const TetContacts& of, const Contact& c, bool forgets) {
  const int p = of.pair_of(static_cast<int>(c.source), c.target);
  return p >= 0 ? of.may_touch[p] != 0 : !forgets && c.reference_penetration > 0;
}

Question question_of(const State& state, ContactWork& work) {
  TetContacts& of = *work.tet_contacts;
  find_awake(of.paths, of.near, of.awake);
  if (work.looks_at_all)
    for (std::size_t i = 0; i < of.near.count(); ++i)
      of.awake[i / contact_rows_per_chunk] |= std::uint64_t{1} << (i % contact_rows_per_chunk);
  Question question;
  auto old = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                  [](const Contact& c) { return c.kind != Contact::tets; });
  const auto tets_of = [](const Contact& c) { return std::pair<int, int>(c.source, c.target); };
  const bool forgets = relaxes(state, work);
  const auto keep_before = [&](const std::pair<int, int>& pair) {
    for (; old != state.contacts.end() && tets_of(*old) < pair; ++old)
      if ((of.fresh || forgets) && !goes_on(of, *old, forgets))
        question.ended.push_back(&*old);
      else
        question.asleep.emplace_back(question.asked.size(), &*old);
  };
  for (std::size_t word = 0; word < of.awake.size(); ++word)
    for (std::uint64_t bits = of.awake[word]; bits != 0; bits &= bits - 1) {
      const std::size_t near =
          word * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      const std::pair<int, int> tets(of.tets[of.near.a[near]].tet, of.tets[of.near.b[near]].tet);
      keep_before(tets);
      Asked asked{near};
      if (old != state.contacts.end() && tets_of(*old) == tets)
        asked.before = &*old++;
      question.asked.push_back(asked);
    }
  keep_before({std::numeric_limits<int>::max(), 0});
  return question;
}

// rad/s, of a tetrahedron.
geom::Vec3 spin_of(const Model& model, const State& state, const geom::Tet& nodes) {
  const auto side = [&](int k) -> geom::Vec3 {
    return place_of(model, state, nodes[k]) - place_of(model, state, nodes[0]);
  };
  const auto faster = [&](int k) -> geom::Vec3 {
    return velocity_of(state, nodes[k]) - velocity_of(state, nodes[0]);
  };
  const geom::Vec3 a = side(1), b = side(2), c = side(3);
  return 0.5 / a.dot(b.cross(c)) *
         (b.cross(c).cross(faster(1)) + c.cross(a).cross(faster(2)) + a.cross(b).cross(faster(3)));
}

// m, of the first tetrahedron past the second in a step, by their middles.
geom::Vec3 slid_by_middles(const Model& model, const State& state, double step, const Contact& c) {
  geom::Vec3 velocity = geom::Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    velocity += 0.25 * (velocity_of(state, model.tets[static_cast<int>(c.source)][k]) -
                        velocity_of(state, model.tets[c.target][k]));
  return step * velocity;
}

// Goes through some pairs in order.
class Pressing {
public:
  Pressing(const Model& model, const State& state, const ContactWork& work, const Question& question,
           std::size_t begin, std::size_t end)
      : model_(model), state_(state), work_(work), of_(*work.tet_contacts), question_(question),
        begin_(begin), end_(end), asked_(question.asked.data() + begin) {}

  // force: N, on the first tetrahedron of each pair of the question that presses.
  void press(geom::Vec3* force) {
    const std::size_t count = end_ - begin_;
    phi0_.resize(count);
    deepest_.assign(count, 0.0);
    result_.assign(count, {-1, 0});
    std::vector<std::size_t> pressed, others, meet, come;
    for (std::size_t i = 0; i < count; ++i) {
      const Contact* const before = asked_[i].before;
      phi0_[i] = before ? before->reference_penetration : 0;
      (before && before->effective_penetration() > 0 ? pressed : others).push_back(i);
    }
    press(pressed);
    for (const std::size_t i : pressed)
      if (!(energy(i) > 0))
        others.push_back(i);
    look(others, bound_deepest);
    // What is known is that they overlap by no more than this: often that is enough.
    const bool all_exactly = relaxes(state_, work_);
    for (const std::size_t i : others)
      if (deepest_[i] > (asked_[i].before && !all_exactly ? phi0_[i] : 0))
        meet.push_back(i);
    look(meet, find_deepest);
    for (const std::size_t i : meet)
      if (deepest_[i] > phi0_[i])
        come.push_back(i);
    press(come);
    for (const std::size_t i : come)
      if (!asked_[i].before && !came_within_step(i)) {
        phi0_[i] = deepest_[i];
        result_[i] = {-1, 0};
      }
    for (std::size_t i = 0; i < count; ++i)
      if (energy(i) > 0)
        force[begin_ + i] = force_on_first(i);
  }

  // direction: unit, of each pair of the question that presses; 0: none.
  TetChunk finish(const geom::Vec3* direction) {
    direction_ = direction + begin_;
    const std::size_t count = end_ - begin_;
    out_.contacts.reserve(count);
    out_.forces.reserve(lanes * n_batches_);
    allowed_.reserve(count);
    auto asleep = std::partition_point(question_.asleep.begin(), question_.asleep.end(),
                                       [&](const auto& one) { return one.first < begin_; });
    for (std::size_t i = 0; i < count; ++i) {
      for (; asleep != question_.asleep.end() && asleep->first == begin_ + i; ++asleep)
        out_.contacts.push_back(*asleep->second);
      finish_pair(i);
    }
    if (end_ == question_.asked.size())
      for (; asleep != question_.asleep.end(); ++asleep)
        out_.contacts.push_back(*asleep->second);
    return std::move(out_);
  }

  // m, that each of the pairs may go before it is looked at again.
  const std::vector<double>& allowed() const { return allowed_; }

private:
  const SurfaceTet& first(std::size_t i) const { return of_.tets[of_.near.a[asked_[i].near]]; }
  const SurfaceTet& second(std::size_t i) const { return of_.tets[of_.near.b[asked_[i].near]]; }
  double energy(std::size_t i) const {
    return result_[i].first >= 0 ? batches_[result_[i].first].energy[result_[i].second] : 0;
  }

  geom::Vec3 force_on_first(std::size_t i) const {
    const auto& [batch, lane] = result_[i];
    geom::Vec3 f = geom::Vec3::Zero();
    for (int k = 0; k < 4; ++k)
      f += geom::Vec3(batches_[batch].force[k][0][lane], batches_[batch].force[k][1][lane],
                      batches_[batch].force[k][2][lane]);
    return f;
  }

  template <class Kernel>
  void look(const std::vector<std::size_t>& at, const Kernel& kernel) {
    const std::size_t full = (at.size() + lanes - 1) / lanes;
    std::array<TetPairView, pairs_per_chunk / lanes> views;
    for (std::size_t k = 0; k < lanes * full; ++k) {
      const std::size_t i = at[std::min(k, at.size() - 1)];
      views[k / lanes].set(static_cast<int>(k % lanes), first(i).nodes, second(i).nodes);
    }
    kernel(of_.place.data(), views.data(), static_cast<std::int64_t>(full));
    for (std::size_t k = 0; k < at.size(); ++k)
      deepest_[at[k]] = views[k / lanes].deepest[k % lanes];
  }

  void press(const std::vector<std::size_t>& at) {
    const std::size_t before = n_batches_, more = (at.size() + lanes - 1) / lanes;
    n_batches_ += more;
    for (std::size_t k = 0; k < lanes * more; ++k) {
      const std::size_t i = at[std::min(k, at.size() - 1)];
      TetPairPress& batch = batches_[before + k / lanes];
      const int lane = static_cast<int>(k % lanes);
      batch.of.set(lane, first(i).nodes, second(i).nodes);
      batch.phi0[lane] = phi0_[i];
      batch.stiffness[lane] = law_of(i).corner;
      result_[i] = {static_cast<int>(before + k / lanes), lane};
    }
    press_pairs(of_.place.data(), batches_.get() + before, static_cast<std::int64_t>(more));
  }

  bool came_within_step(std::size_t i) const {
    const auto& [batch, lane] = result_[i];
    if (!(energy(i) > 0))
      return true;
    const Push push(*this, batches_[batch], lane, force_on_first(i).stableNormalized());
    return deepest_[i] <= 1.5 * push.closing;
  }

  TetPairLaw law_of(std::size_t i) {
    const SurfaceTet &a = first(i), &b = second(i);
    if (block_ != a.block) {
      block_ = a.block;
      joint_ = contact_joint(model_, block_, block_);
      tan_friction_ = std::min(geom::portable::tan(joint_->friction_angle), work_.most_friction);
    }
    return tet_pair_law(model_, *joint_, tan_friction_, block_, a.size, b.size);
  }

  void finish_pair(std::size_t i) {
    const SurfaceTet &a = first(i), &b = second(i);
    const Contact* const before = asked_[i].before;
    Contact c(Contact::tets, a.tet);
    c.target = c.fragment = b.tet;
    if (before)
      c = *before;
    c.reference_penetration = phi0_[i];
    if (const double energy = this->energy(i); energy > 0) {
      const Push push(*this, batches_[result_[i].first], result_[i].second, direction_[i]);
      if (!before)
        c.normal = push.normal;
      allowed_.push_back(0);
      act(push, before, energy, law_of(i), std::min(a.size.height, b.size.height), c);
      return;
    }
    if (before && before->effective_penetration() > 0)
      lose(*before, law_of(i).law);
    // An overlap is forgotten in the same steps whatever sleeps.
    const bool forgets = relaxes(state_, work_) || !(c.reference_penetration > 0);
    if (!(deepest_[i] > 0) && (forgets || !before)) {
      allowed_.push_back(-deepest_[i]);
      return;
    }
    if (relaxes(state_, work_))
      c.reference_penetration = std::min(c.reference_penetration, deepest_[i]);
    allowed_.push_back(trusted * (c.reference_penetration - deepest_[i]));
    c.depth = c.reference_penetration;
    c.shear = geom::Vec3::Zero();
    c.damping = 0;
    out_.contacts.push_back(c);
  }

  // The two sides of a contact that presses.
  struct Push {
    Push(const Pressing& of, const TetPairPress& batch, int lane, const geom::Vec3& direction) {
      geom::Vec3 all = geom::Vec3::Zero();
      for (int k = 0; k < 8; ++k) {
        node[k] = batch.of.node[k][lane];
        corner[k] = {batch.force[k][0][lane], batch.force[k][1][lane], batch.force[k][2][lane]};
        if (k < 4)
          all += corner[k];
      }
      whole = all.norm();
      if (all.dot(direction) > 0) {
        normal = direction;
        force = all.dot(normal);
      }
      double work = 0;                       // W
      geom::Vec3 place = geom::Vec3::Zero(); // m, between what presses on the two
      for (int k = 0; k < 8; ++k) {
        work += corner[k].dot(velocity_of(of.state_, node[k]));
        if (force > 0)
          place +=
              (k < 4 ? 0.5 : -0.5) / force * corner[k].dot(normal) * place_of(of.model_, of.state_, node[k]);
        if (force > 0 && of.work_.restitution)
          compliance +=
              corner[k].squaredNorm() / (force * force) / moving_mass(of.model_, of.state_)[node[k]];
      }
      if (!(force > 0))
        return;
      closing = -of.work_.step * work / force;
      geom::Vec3 velocity = geom::Vec3::Zero(); // m/s, of the first past the second
      for (const int tet : {0, 1}) {
        const geom::Tet nodes = {node[4 * tet], node[4 * tet + 1], node[4 * tet + 2], node[4 * tet + 3]};
        const std::array<double, 4> at = within_tet(of.model_, of.state_, nodes, place);
        for (int k = 0; k < 4; ++k) {
          weight[4 * tet + k] = tet == 0 ? at[k] : -at[k];
          velocity += weight[4 * tet + k] * velocity_of(of.state_, nodes[k]);
        }
        turned += 0.5 * of.work_.step * spin_of(of.model_, of.state_, nodes).dot(normal);
      }
      slid = of.work_.step * (velocity - velocity.dot(normal) * normal) - closing * normal;
    }
    std::array<int, 8> node{};
    std::array<geom::Vec3, 8> corner; // N
    std::array<double, 8> weight{}; // of the shear force: of the first they sum up to 1, of the second to -1
    double whole = 0, force = 0, compliance = 0; // N, N along the normal, 1/kg
    geom::Vec3 normal = geom::Vec3::UnitZ();     // unit, on the first
    geom::Vec3 slid = geom::Vec3::Zero();        // m
    double closing = 0, turned = 0; // m, in the step, as the potential works; rad, about the normal
  };

  void act(const Push& push, const Contact* before, double energy, const TetPairLaw& of_pair, double height,
           Contact& c) {
    ContactLaw law = of_pair.law;
    // The spring that has this force and energy; where the forces of the two cancel, one that has the energy.
    const bool presses = push.force > 0;
    const double pressed = presses ? 2 * energy / push.force : std::sqrt(2 * energy / of_pair.corner);
    law.kn = presses ? push.force / pressed : of_pair.corner;
    if (!presses) {
      if (before)
        lose(*before, law);
      c.stiffness = law.kn;
      c.depth = c.reference_penetration + pressed;
      c.shear = geom::Vec3::Zero();
      c.damping = 0;
    } else if (!(before && work_.step == 0)) {
      ContactMotion motion;
      motion.normal = push.normal;
      motion.depth = c.reference_penetration + pressed;
      motion.slid = push.slid;
      motion.turned = push.turned;
      if (work_.restitution && law.damping_ratio > 0)
        set_approach(push, motion);
      const double damping = c.damping;
      if (damping > 0) // stores the same in the spring of now
        c.damping *= std::sqrt(law.kn / c.stiffness);
      const double jump = 0.5 * (damping - c.damping) * push.closing; // J
      const ContactLoss loss = advance(c, law, motion);
      out_.friction.push_back(loss.friction);
      out_.damping.push_back(loss.damping + jump);
      c.stiffness = law.kn;
    }
    const double stiffness = 1.5 * push.whole / (2 * energy) * (1 + law.damping_ratio); // 1/m, over the force
    const double more = presses ? 1 + c.damping / push.force : 1;
    TetPairForce at;
    at.block = block_;
    at.node = push.node;
    for (int k = 0; k < 8; ++k) {
      at.force[k] = more * push.corner[k] + push.weight[k] * c.shear;
      // Where forces cancel, the spring is soft and the potential is not.
      at.stiffness[k] =
          std::max(push.corner[k].norm() * stiffness, of_pair.corner) + std::abs(push.weight[k]) * law.ks;
    }
    out_.forces.push_back(at);
    out_.contacts.push_back(c);
    // The depth at which one corner would have this energy; where that is much, the true one.
    double depth = std::sqrt(4 * energy / of_pair.corner);
    if (depth > 0.1 * height) {
      TetPairView pair;
      for (int lane = 0; lane < lanes; ++lane)
        pair.set(lane, {push.node[0], push.node[1], push.node[2], push.node[3]},
                 {push.node[4], push.node[5], push.node[6], push.node[7]});
      find_deepest(of_.place.data(), &pair, 1);
      depth = pair.deepest[0] - c.reference_penetration;
    }
    out_.depth = std::max(out_.depth, depth);
    if (depth / height > out_.depth_over_height) {
      out_.depth_over_height = depth / height;
      out_.deepest = {static_cast<int>(c.source), c.target};
    }
  }

  // As for semi-springs: by the speed that the contact's own force can turn round in a step.
  void set_approach(const Push& push, ContactMotion& motion) const {
    const double reversed = work_.step * work_.step * push.force * push.compliance;
    const auto part = [&](double way) {
      return std::abs(way) < reversed ? way / reversed : std::copysign(1.0, way);
    };
    motion.approach = part(push.closing);
    motion.held_at_most = motion.approach <= -1 ? 1 : std::abs(part(2 * push.closing));
  }

  // What its shear force and its damping stored is lost; its potential has given back what it had.
  void lose(const Contact& c, ContactLaw law) {
    law.kn = c.stiffness;
    if (law.ks > 0)
      out_.friction.push_back(0.5 * c.shear.squaredNorm() / law.ks -
                              0.5 * c.shear.dot(slid_by_middles(model_, state_, work_.step, c)));
    if (law.damping_ratio > 0)
      out_.damping.push_back(stored_by_damping(c, law));
  }

  const Model& model_;
  const State& state_;
  const ContactWork& work_;
  const TetContacts& of_;
  const Question& question_;
  std::size_t begin_, end_;
  const Asked* asked_;
  const geom::Vec3* direction_ = nullptr;
  TetChunk out_;
  // Each pair presses twice at most. Not set to 0: that would cost as much as what is written.
  std::unique_ptr<TetPairPress[]> batches_{new TetPairPress[2 * pairs_per_chunk / lanes]};
  std::size_t n_batches_ = 0;
  std::vector<std::pair<int, int>> result_;      // batch and lane of the force; -1: none was asked for
  std::vector<double> phi0_, deepest_, allowed_; // m
  int block_ = -1;                               // whose law is known
  const Joint* joint_ = nullptr;
  double tan_friction_ = 0;
};

// In what direction each pair presses on its first tetrahedron, unit. Where a corner or an edge comes near an inner plane of the
// body that it stands in, that plane is the nearest and pushes it aside, and the tetrahedron beyond pushes it back; and an edge is
// that of several tetrahedra, each with one plane of the surface. So friction goes by the direction of all that presses from about
// the same side on one of the two.
std::vector<geom::Vec3> directions_of(const TetContacts& of, const Question& question,
                                      const std::vector<geom::Vec3>& force) {
  constexpr double same_side = 0.5; // cosine
  std::vector<int> begin(of.tets.size() + 1, 0), pairs;
  const auto tets = [&](std::size_t i) {
    const std::size_t near = question.asked[i].near;
    return std::array<int, 2>{of.near.a[near], of.near.b[near]};
  };
  std::vector<std::size_t> pressing;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (force[i].squaredNorm() > 0) {
      pressing.push_back(i);
      for (const int tet : tets(i))
        ++begin[tet + 1];
    }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  pairs.resize(2 * pressing.size());
  std::vector<int> end(begin.begin(), begin.end() - 1);
  for (const std::size_t i : pressing)
    for (const int tet : tets(i))
      pairs[end[tet]++] = static_cast<int>(i);
  std::vector<double> length(force.size(), 0.0); // N
  for (const std::size_t i : pressing)
    length[i] = force[i].norm();
  std::vector<geom::Vec3> direction(force.size(), geom::Vec3::Zero());
  for (const std::size_t i : pressing) {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (const int tet : tets(i)) {
      geom::Vec3 of_tet = geom::Vec3::Zero();
      const double side = tet == tets(i)[0] ? 1 : -1;
      for (int p = begin[tet]; p < begin[tet + 1]; ++p) {
        const geom::Vec3 more = (tets(pairs[p])[0] == tet ? side : -side) * force[pairs[p]];
        if (more.dot(force[i]) > same_side * length[pairs[p]] * length[i])
          of_tet += more;
      }
      sum += of_tet.stableNormalized();
    }
    direction[i] = sum.stableNormalized();
  }
  return direction;
}

} // namespace

std::vector<TetChunk> press_tets(const Model& model, const State& state, ContactWork& work, int threads) {
  if (!work.tet_contacts) {
    std::vector<TetChunk> found(1);
    for (const Contact& c : state.contacts)
      if (c.kind == Contact::tets)
        found[0].friction.push_back(energy(c, law_of(model, c)));
    return found;
  }
  TetContacts& of = *work.tet_contacts;
  const Question question = question_of(state, work);
  std::vector<Range> chunks = split(static_cast<std::int64_t>(question.asked.size()), pairs_per_chunk);
  if (chunks.empty())
    chunks.emplace_back(); // for contacts that sleep
  std::vector<TetChunk> found(chunks.size());
  std::vector<Pressing> pressing;
  pressing.reserve(chunks.size());
  for (const Range& chunk : chunks)
    pressing.emplace_back(model, state, work, question, static_cast<std::size_t>(chunk.begin),
                          static_cast<std::size_t>(chunk.end));
  const auto n_chunks = static_cast<std::int64_t>(chunks.size());
  std::vector<geom::Vec3> force(question.asked.size(), geom::Vec3::Zero());
  for_chunks(n_chunks, threads, [&](std::int64_t i) { pressing[i].press(force.data()); });
  const std::vector<geom::Vec3> direction = directions_of(of, question, force);
  for_chunks(n_chunks, threads, [&](std::int64_t i) { found[i] = pressing[i].finish(direction.data()); });
  std::size_t asked = 0;
  for (const Pressing& of_chunk : pressing)
    for (const double may_go : of_chunk.allowed())
      fall_asleep(of, question.asked[asked++].near, may_go);
  for (const Contact* const c : question.ended)
    found[0].friction.push_back(energy(*c, law_of(model, *c)));
  of.fresh = false;
  return found;
}

} // namespace cdem
