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
constexpr double slack_ratio = 0.005;
// Of what parts an overlap from its phi0 or from its end: strain changes the heights of tetrahedra.
constexpr double trusted = 0.9;

struct Asked {
  int pair = 0;
  const Contact* before = nullptr; // null: there was none
};

// What stands in State of pairs that sleep stays, and is set between the others.
struct Question {
  std::vector<const Contact*> ended; // their pairs are none any more
  std::vector<Asked> asked;
  std::vector<std::pair<std::size_t, const Contact*>> asleep; // before which of `asked`
};

Question question_of(const State& state, const ContactWork& work) {
  const TetContacts& of = *work.tet_contacts;
  Question question;
  auto old = std::partition_point(state.contacts.begin(), state.contacts.end(),
                                  [](const Contact& c) { return c.kind != Contact::tets; });
  const auto keep_before = [&](const std::pair<int, int>& pair) {
    for (; old != state.contacts.end() && std::pair<int, int>(old->source, old->target) < pair; ++old)
      if (of.fresh)
        question.ended.push_back(&*old);
      else
        question.asleep.emplace_back(question.asked.size(), &*old);
  };
  for (std::size_t word = 0; word < of.awake.size(); ++word)
    for (std::uint64_t bits = of.awake[word]; bits != 0; bits &= bits - 1) {
      const std::size_t p = word * contact_rows_per_chunk + static_cast<std::size_t>(__builtin_ctzll(bits));
      const std::pair<int, int> tets(of.tets[of.a[p]].tet, of.tets[of.b[p]].tet);
      keep_before(tets);
      Asked asked{static_cast<int>(p)};
      if (old != state.contacts.end() && std::pair<int, int>(old->source, old->target) == tets)
        asked.before = &*old++;
      question.asked.push_back(asked);
    }
  keep_before({std::numeric_limits<int>::max(), 0});
  return question;
}

// Goes through some pairs in order.
class Pressing {
public:
  Pressing(const Model& model, const State& state, ContactWork& work, TetChunk& out)
      : model_(model), state_(state), work_(work), of_(*work.tet_contacts), out_(out) {}

  void operator()(const Question& question, std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    phi0_.assign(count, 0.0);
    deepest_.assign(count, 0.0);
    std::vector<std::size_t> pressed, others;
    for (std::size_t i = 0; i < count; ++i) {
      const Contact* const before = question.asked[begin + i].before;
      if (before)
        phi0_[i] = before->reference_penetration;
      (before && before->effective_penetration() > 0 ? pressed : others).push_back(i);
    }
    const auto asked = [&](std::size_t i) -> const Asked& { return question.asked[begin + i]; };
    result_.assign(count, {-1, 0});
    evaluate(asked, pressed, press_pairs);
    for (const std::size_t i : pressed)
      if (batches_[result_[i].first].energy[result_[i].second] <= 0)
        others.push_back(i);
    const std::size_t first = batches_.size();
    evaluate(asked, others, find_deepest);
    for (const std::size_t i : others)
      deepest_[i] = batches_[result_[i].first].deepest[result_[i].second];
    batches_.resize(first); // what does not press is known by its depth
    std::vector<std::size_t> come;
    for (const std::size_t i : others) {
      result_[i] = {-1, 0};
      if (deepest_[i] > 0 && (!asked(i).before || deepest_[i] > phi0_[i]))
        come.push_back(i);
    }
    evaluate(asked, come, press_pairs);
    auto asleep = std::lower_bound(question.asleep.begin(), question.asleep.end(), begin,
                                   [](const auto& one, std::size_t place) { return one.first < place; });
    if (begin == 0)
      asleep = question.asleep.begin();
    const auto keep_until = [&](std::size_t place) {
      for (; asleep != question.asleep.end() && asleep->first <= place; ++asleep)
        out_.contacts.push_back(*asleep->second);
    };
    for (std::size_t i = 0; i < count; ++i) {
      keep_until(begin + i);
      finish(asked(i), i);
    }
    if (end == question.asked.size())
      keep_until(end);
  }

private:
  template <class Ask, class Kernel>
  void evaluate(const Ask& asked, const std::vector<std::size_t>& which, const Kernel& kernel) {
    const std::size_t first = batches_.size(), more = (which.size() + lanes - 1) / lanes;
    batches_.resize(first + more);
    for (std::size_t i = 0; i < lanes * more; ++i) {
      const std::size_t place = which[std::min(i, which.size() - 1)];
      const int p = asked(place).pair;
      TetPairBatch& batch = batches_[first + i / lanes];
      const int lane = static_cast<int>(i % lanes);
      const SurfaceTet &a = of_.tets[of_.a[p]], &b = of_.tets[of_.b[p]];
      for (int k = 0; k < 4; ++k) {
        batch.node[k][lane] = model_.tets[a.tet][k];
        batch.node[4 + k][lane] = model_.tets[b.tet][k];
      }
      batch.phi0[lane] = phi0_[place];
      batch.stiffness[lane] = law_of(a, b).corner;
      if (i < which.size())
        result_[place] = {static_cast<int>(first + i / lanes), lane};
    }
    if (more > 0)
      kernel(of_.place.data(), batches_.data() + first, static_cast<std::int64_t>(more));
  }

  TetPairLaw law_of(const SurfaceTet& a, const SurfaceTet& b) {
    if (block_ != a.block) {
      block_ = a.block;
      joint_ = contact_joint(model_, block_, block_);
      tan_friction_ = std::min(geom::portable::tan(joint_->friction_angle), work_.most_friction);
    }
    return tet_pair_law(model_, *joint_, tan_friction_, block_, a.size, b.size);
  }

  bool had_a_node_in_common(const SurfaceTet& a, const SurfaceTet& b) const {
    const std::vector<int>& original = model_.surface.original;
    for (const int m : model_.tets[a.tet])
      for (const int n : model_.tets[b.tet])
        if (original[m] == original[n])
          return true;
    return false;
  }

  void finish(const Asked& asked, std::size_t i) {
    const int p = asked.pair;
    const SurfaceTet &a = of_.tets[of_.a[p]], &b = of_.tets[of_.b[p]];
    const Contact* const before = asked.before;
    Contact c(Contact::tets, a.tet);
    c.target = c.fragment = b.tet;
    if (before)
      c = *before;
    const double gone = of_.path[of_.a[p]] + of_.path[of_.b[p]];
    const auto [place, lane] = result_[i];
    double energy = place >= 0 ? batches_[place].energy[lane] : 0;
    of_.until[p] = 0;
    if (energy > 0) {
      const Push push(*this, batches_[place], lane);
      if (!before) {
        const double closing = -push.slid.dot(push.normal);
        c.normal = push.normal;
        if (had_a_node_in_common(a, b))
          c.reference_penetration = deepest_[i] + slack_ratio * std::min(a.size.height, b.size.height);
        else if (deepest_[i] > 1.5 * closing)
          c.reference_penetration = deepest_[i];
        if (c.reference_penetration > 0)
          energy = 0;
      }
      if (energy > 0) {
        press(push, before, energy, law_of(a, b).law, std::min(a.size.height, b.size.height), c);
        return;
      }
    }
    if (before && before->effective_penetration() > 0)
      lose(*before, law_of(a, b).law);
    if (!(deepest_[i] > 0)) {
      of_.until[p] = rounded_down(gone - deepest_[i]);
      return;
    }
    const double waits = trusted * std::min(c.reference_penetration - deepest_[i], deepest_[i]);
    if (waits > 0)
      of_.until[p] = rounded_down(gone + waits);
    c.depth = c.reference_penetration;
    c.shear = geom::Vec3::Zero();
    c.damping = 0;
    out_.contacts.push_back(c);
  }

  // The two sides of a contact that presses.
  struct Push {
    Push(const Pressing& of, const TetPairBatch& batch, int lane) {
      geom::Vec3 sum = geom::Vec3::Zero();
      for (int k = 0; k < 8; ++k) {
        node[k] = batch.node[k][lane];
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

  void press(const Push& push, const Contact* before, double energy, ContactLaw law, double height, Contact& c) {
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
  TetContacts& of_;
  TetChunk& out_;
  std::vector<TetPairBatch> batches_;
  std::vector<std::pair<int, int>> result_; // batch and lane of the force; -1: none was asked for
  std::vector<double> phi0_, deepest_;      // m
  int block_ = -1;                          // whose law is known
  const Joint* joint_ = nullptr;
  double tan_friction_ = 0;
};

} // namespace

std::vector<TetChunk> press_tets(const Model& model, const State& state, ContactWork& work, int threads) {
  std::vector<TetChunk> found;
  if (!work.tet_contacts) {
    found.resize(1);
    for (const Contact& c : state.contacts)
      if (c.kind == Contact::tets)
        found[0].friction += energy(c, law_of(model, c));
    return found;
  }
  TetContacts& of = *work.tet_contacts;
  find_awake(of.path.data(), of.until.data(), of.a.data(), of.b.data(), of.a.size(), of.awake.data());
  if (work.looks_at_all)
    for (std::size_t p = 0; p < of.a.size(); ++p)
      of.awake[p / contact_rows_per_chunk] |= std::uint64_t{1} << (p % contact_rows_per_chunk);
  const Question question = question_of(state, work);
  const auto count = static_cast<std::int64_t>(question.asked.size());
  const std::vector<Range> chunks = split(count, pairs_per_chunk);
  found.resize(std::max<std::size_t>(1, chunks.size()));
  if (chunks.empty())
    Pressing(model, state, work, found[0])(question, 0, 0);
  for_chunks(static_cast<std::int64_t>(chunks.size()), threads, [&](std::int64_t i) {
    Pressing(model, state, work, found[i])(question, static_cast<std::size_t>(chunks[i].begin),
                                           static_cast<std::size_t>(chunks[i].end));
  });
  for (const Contact* const c : question.ended)
    found[0].friction += energy(*c, law_of(model, *c));
  of.fresh = false;
  return found;
}

} // namespace cdem
