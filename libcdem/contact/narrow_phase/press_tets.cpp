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

TetMotion motion_of(const TetContacts& of, int t) {
  const geom::Tet& nodes = of.tets[t].nodes;
  std::array<geom::Vec3, 4> gone; // m
  geom::Vec3 mean = geom::Vec3::Zero();
  for (int k = 0; k < 4; ++k) {
    const Node &now = of.place[nodes[k]], &then = of.place_at_first[nodes[k]];
    gone[k] = {now.x - then.x, now.y - then.y, now.z - then.z};
    mean += 0.25 * gone[k];
  }
  double swing2 = 0;
  for (const geom::Vec3& here : gone)
    swing2 = std::max(swing2, (here - mean).squaredNorm());
  TetMotion motion;
  for (int axis = 0; axis < 3; ++axis)
    motion.drift[axis] = static_cast<float>(mean[axis]);
  motion.swing = static_cast<float>(std::sqrt(swing2));
  return motion;
}

const TetMotion& moved(TetContacts& of, int t) {
  if (of.moved_at[t] != of.steps) {
    of.moved[t] = motion_of(of, t);
    of.moved_at[t] = of.steps;
  }
  return of.moved[t];
}

// m, that two tetrahedra may still go past each other; the paths of both say less of those that move together.
double still_allowed(TetContacts& of, std::size_t p) {
  const TetPairMotion& then = of.motion[p];
  constexpr float rounding = 1e-6F; // of lengths kept as floats
  const TetMotion &a = moved(of, of.a[p]), &b = moved(of, of.b[p]);
  float past2 = 0, size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float past = b.drift[axis] - a.drift[axis] - then.drift[axis];
    past2 += past * past;
    size += std::abs(a.drift[axis]) + std::abs(b.drift[axis]) + std::abs(then.drift[axis]);
  }
  return then.allowed - (std::sqrt(past2) + a.swing + b.swing + then.swings + rounding * size);
}

void sleep_until(TetContacts& of, std::size_t near, double until) {
  of.until[of.near[near]] = of.near_until[near] = rounded_down(until);
}

// allowed: m, that the two may go past each other before they are looked at again.
void fall_asleep(TetContacts& of, std::size_t near, double allowed) {
  const auto p = static_cast<std::size_t>(of.near[near]);
  of.motion[p] = {};
  if (!(allowed > 0)) {
    sleep_until(of, near, 0);
    return;
  }
  const TetMotion &a = moved(of, of.a[p]), &b = moved(of, of.b[p]);
  for (int axis = 0; axis < 3; ++axis)
    of.motion[p].drift[axis] = b.drift[axis] - a.drift[axis];
  of.motion[p].swings = a.swing + b.swing;
  of.motion[p].allowed = rounded_down(allowed);
  sleep_until(of, near, of.path[of.a[p]] + of.path[of.b[p]] + allowed);
}

// Whether the pair sleeps on.
bool sleeps_on(TetContacts& of, std::size_t near) {
  constexpr double worth_while = 0.05; // of what it was allowed
  const auto p = static_cast<std::size_t>(of.near[near]);
  if (!(of.motion[p].allowed > 0))
    return false;
  const double left = still_allowed(of, p);
  if (left < worth_while * of.motion[p].allowed)
    return false;
  sleep_until(of, near, of.path[of.a[p]] + of.path[of.b[p]] + left);
  return true;
}

// Whether the pair of an old contact may touch.
bool is_pair(const TetContacts& of, const Contact& c) {
  const int a = of.number[c.source], b = of.number[c.target];
  const auto begin = std::lower_bound(of.a.begin(), of.a.end(), a) - of.a.begin(),
             end = std::upper_bound(of.a.begin(), of.a.end(), a) - of.a.begin();
  const auto found = std::lower_bound(of.b.begin() + begin, of.b.begin() + end, b);
  return a >= 0 && b >= 0 && found != of.b.begin() + end && *found == b &&
         of.until[found - of.b.begin()] < TetContacts::never;
}

Question question_of(const State& state, ContactWork& work) {
  TetContacts& of = *work.tet_contacts;
  find_awake(of.path.data(), of.near_until.data(), of.near_a.data(), of.near_b.data(), of.near.size(),
             of.awake.data());
  if (work.looks_at_all)
    for (std::size_t i = 0; i < of.near.size(); ++i)
      of.awake[i / contact_rows_per_chunk] |= std::uint64_t{1} << (i % contact_rows_per_chunk);
  Question question;
  auto old = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                  [](const Contact& c) { return c.kind != Contact::tets; });
  const auto tets_of = [](const Contact& c) { return std::pair<int, int>(c.source, c.target); };
  const auto keep_before = [&](const std::pair<int, int>& pair) {
    for (; old != state.contacts.end() && tets_of(*old) < pair; ++old)
      if (of.fresh && !is_pair(of, *old))
        question.ended.push_back(&*old);
      else
        question.asleep.emplace_back(question.asked.size(), &*old);
  };
  for (std::size_t word = 0; word < of.awake.size(); ++word)
    for (std::uint64_t bits = of.awake[word]; bits != 0; bits &= bits - 1) {
      const std::size_t near = word * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      if (!work.looks_at_all && sleeps_on(of, near))
        continue;
      const std::pair<int, int> tets(of.tets[of.near_a[near]].tet, of.tets[of.near_b[near]].tet);
      keep_before(tets);
      Asked asked{near};
      if (old != state.contacts.end() && tets_of(*old) == tets)
        asked.before = &*old++;
      question.asked.push_back(asked);
    }
  keep_before({std::numeric_limits<int>::max(), 0});
  return question;
}

// Goes through some pairs in order.
class Pressing {
public:
  Pressing(const Model& model, const State& state, const ContactWork& work, TetChunk& out)
      : model_(model), state_(state), work_(work), of_(*work.tet_contacts), out_(out) {}

  void operator()(const Question& question, std::size_t begin, std::size_t end) {
    asked_ = question.asked.data() + begin;
    const std::size_t count = end - begin;
    phi0_.resize(count);
    deepest_.assign(count, 0.0);
    result_.assign(count, {-1, 0});
    std::vector<std::size_t> pressed, others, meet, come;
    for (std::size_t i = 0; i < count; ++i) {
      const Contact* const before = asked_[i].before;
      phi0_[i] = before ? before->reference_penetration : of_.slack[of_.near[asked_[i].near]];
      (before && before->effective_penetration() > 0 ? pressed : others).push_back(i);
    }
    press(pressed);
    for (const std::size_t i : pressed)
      if (!(energy(i) > 0))
        others.push_back(i);
    look(others, find_parted);
    for (const std::size_t i : others)
      if (deepest_[i] >= 0)
        meet.push_back(i);
    look(meet, find_deepest);
    for (const std::size_t i : meet)
      if (deepest_[i] > phi0_[i])
        come.push_back(i);
    press(come);
    auto asleep = std::partition_point(question.asleep.begin(), question.asleep.end(),
                                       [&](const auto& one) { return one.first < begin; });
    for (std::size_t i = 0; i < count; ++i) {
      for (; asleep != question.asleep.end() && asleep->first == begin + i; ++asleep)
        out_.contacts.push_back(*asleep->second);
      finish(i);
    }
    if (end == question.asked.size())
      for (; asleep != question.asleep.end(); ++asleep)
        out_.contacts.push_back(*asleep->second);
  }

  // What all pairs that slept have to say, one by one: threads may not share a tetrahedron's motion.
  const std::vector<double>& allowed() const { return allowed_; }

private:
  const SurfaceTet& first(std::size_t i) const { return of_.tets[of_.near_a[asked_[i].near]]; }
  const SurfaceTet& second(std::size_t i) const { return of_.tets[of_.near_b[asked_[i].near]]; }
  double energy(std::size_t i) const {
    return result_[i].first >= 0 ? batches_[result_[i].first].energy[result_[i].second] : 0;
  }

  template <class Kernel>
  void look(const std::vector<std::size_t>& at, const Kernel& kernel) {
    std::vector<TetPairView> views((at.size() + lanes - 1) / lanes);
    for (std::size_t k = 0; k < lanes * views.size(); ++k) {
      const std::size_t i = at[std::min(k, at.size() - 1)];
      views[k / lanes].set(static_cast<int>(k % lanes), first(i).nodes, second(i).nodes);
    }
    kernel(of_.place.data(), views.data(), static_cast<std::int64_t>(views.size()));
    for (std::size_t k = 0; k < at.size(); ++k)
      deepest_[at[k]] = views[k / lanes].deepest[k % lanes];
  }

  void press(const std::vector<std::size_t>& at) {
    const std::size_t before = batches_.size(), more = (at.size() + lanes - 1) / lanes;
    batches_.resize(before + more);
    for (std::size_t k = 0; k < lanes * more; ++k) {
      const std::size_t i = at[std::min(k, at.size() - 1)];
      TetPairPress& batch = batches_[before + k / lanes];
      const int lane = static_cast<int>(k % lanes);
      batch.of.set(lane, first(i).nodes, second(i).nodes);
      batch.phi0[lane] = phi0_[i];
      batch.stiffness[lane] = law_of(i).corner;
      result_[i] = {static_cast<int>(before + k / lanes), lane};
    }
    press_pairs(of_.place.data(), batches_.data() + before, static_cast<std::int64_t>(more));
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

  void finish(std::size_t i) {
    const SurfaceTet &a = first(i), &b = second(i);
    const Contact* const before = asked_[i].before;
    const double slack = of_.slack[of_.near[asked_[i].near]];
    Contact c(Contact::tets, a.tet);
    c.target = c.fragment = b.tet;
    if (before)
      c = *before;
    double energy = this->energy(i);
    if (energy > 0) {
      const Push push(*this, batches_[result_[i].first], result_[i].second);
      if (!before) {
        c.normal = push.normal;
        c.reference_penetration = slack;
        if (deepest_[i] - slack > -1.5 * push.slid.dot(push.normal)) { // it did not come within the step
          c.reference_penetration = deepest_[i];
          energy = 0;
        }
      }
      if (energy > 0) {
        allowed_.push_back(0);
        act(push, before, energy, law_of(i).law, std::min(a.size.height, b.size.height), c);
        return;
      }
    }
    if (before && before->effective_penetration() > 0)
      lose(*before, law_of(i).law);
    if (!(deepest_[i] > slack)) {
      allowed_.push_back(trusted * slack - deepest_[i]);
      return;
    }
    allowed_.push_back(trusted * std::min(c.reference_penetration - deepest_[i], deepest_[i] - slack));
    c.depth = c.reference_penetration;
    c.shear = geom::Vec3::Zero();
    c.damping = 0;
    out_.contacts.push_back(c);
  }

  // The two sides of a contact that presses.
  struct Push {
    Push(const Pressing& of, const TetPairPress& batch, int lane) {
      geom::Vec3 sum = geom::Vec3::Zero();
      for (int k = 0; k < 8; ++k) {
        node[k] = batch.of.node[k][lane];
        corner[k] = {batch.force[k][0][lane], batch.force[k][1][lane], batch.force[k][2][lane]};
        if (k < 4)
          sum += corner[k];
      }
      force = sum.norm();
      normal = sum / force;
      geom::Vec3 velocity = geom::Vec3::Zero(); // m/s, of the first past the second
      for (int k = 0; k < 8; ++k) {
        weight[k] = corner[k].dot(normal) / force;
        velocity += weight[k] * velocity_of(of.state_, node[k]);
        compliance += weight[k] * weight[k] / moving_mass(of.model_, of.state_)[node[k]];
      }
      slid = of.work_.step * velocity;
    }
    std::array<int, 8> node{};
    std::array<geom::Vec3, 8> corner;  // N
    std::array<double, 8> weight{};    // of the first they sum up to 1, of the second to -1
    double force = 0, compliance = 0;  // N, 1/kg
    geom::Vec3 normal, slid;           // unit, on the first; m
  };

  void act(const Push& push, const Contact* before, double energy, ContactLaw law, double height, Contact& c) {
    // The spring that has this force and energy.
    const double pressed = 2 * energy / push.force;
    law.kn = push.force / pressed;
    c.stiffness = law.kn;
    if (!(before && work_.step == 0)) {
      ContactMotion motion;
      motion.normal = push.normal;
      motion.depth = c.reference_penetration + pressed;
      motion.slid = push.slid;
      if (work_.restitution && law.damping_ratio > 0)
        set_approach(push, motion);
      const ContactLoss loss = advance(c, law, motion);
      out_.friction += loss.friction;
      out_.damping += loss.damping;
    }
    const double stiffness = 1.5 * law.kn * (1 + law.damping_ratio) + law.ks;
    const geom::Vec3 more = c.damping * c.normal + c.shear;
    TetPairForce at;
    at.block = block_;
    at.node = push.node;
    for (int k = 0; k < 8; ++k) {
      at.force[k] = push.corner[k] + push.weight[k] * more;
      at.stiffness[k] = std::abs(push.weight[k]) * stiffness;
    }
    out_.forces.push_back(at);
    out_.contacts.push_back(c);
    out_.depth = std::max(out_.depth, pressed);
    out_.depth_over_height = std::max(out_.depth_over_height, pressed / height);
  }

  // As for semi-springs: by the speed that the contact's own force can turn round in a step.
  void set_approach(const Push& push, ContactMotion& motion) const {
    const double closing = -push.slid.dot(push.normal),
                 reversed = work_.step * work_.step * push.force * push.compliance;
    const auto part = [&](double way) {
      return std::abs(way) < reversed ? way / reversed : std::copysign(1.0, way);
    };
    motion.approach = part(closing);
    motion.held_at_most = motion.approach <= -1 ? 1 : std::abs(part(2 * closing));
  }

  // What its shear force and its damping stored is lost; its potential has given back what it had.
  void lose(const Contact& c, ContactLaw law) {
    law.kn = c.stiffness;
    if (law.ks > 0)
      out_.friction += 0.5 * c.shear.squaredNorm() / law.ks;
    if (law.damping_ratio > 0)
      out_.damping += stored_by_damping(c, law);
  }

  const Model& model_;
  const State& state_;
  const ContactWork& work_;
  const TetContacts& of_;
  TetChunk& out_;
  const Asked* asked_ = nullptr;
  std::vector<TetPairPress> batches_;
  std::vector<std::pair<int, int>> result_; // batch and lane of the force; -1: none was asked for
  std::vector<double> phi0_, deepest_, allowed_; // m
  int block_ = -1;                               // whose law is known
  const Joint* joint_ = nullptr;
  double tan_friction_ = 0;
};

} // namespace

std::vector<TetChunk> press_tets(const Model& model, const State& state, ContactWork& work, int threads) {
  if (!work.tet_contacts) {
    std::vector<TetChunk> found(1);
    for (const Contact& c : state.contacts)
      if (c.kind == Contact::tets)
        found[0].friction += energy(c, law_of(model, c));
    return found;
  }
  TetContacts& of = *work.tet_contacts;
  const Question question = question_of(state, work);
  std::vector<Range> chunks = split(static_cast<std::int64_t>(question.asked.size()), pairs_per_chunk);
  if (chunks.empty())
    chunks.emplace_back(); // for contacts that sleep
  std::vector<TetChunk> found(chunks.size());
  std::vector<std::vector<double>> allowed(chunks.size());
  for_chunks(static_cast<std::int64_t>(chunks.size()), threads, [&](std::int64_t i) {
    Pressing pressing(model, state, work, found[i]);
    pressing(question, static_cast<std::size_t>(chunks[i].begin), static_cast<std::size_t>(chunks[i].end));
    allowed[i] = pressing.allowed();
  });
  std::size_t asked = 0;
  for (const std::vector<double>& of_chunk : allowed)
    for (const double may_go : of_chunk)
      fall_asleep(of, question.asked[asked++].near, may_go);
  for (const Contact* const c : question.ended)
    found[0].friction += energy(*c, law_of(model, *c));
  of.fresh = false;
  return found;
}

} // namespace cdem
