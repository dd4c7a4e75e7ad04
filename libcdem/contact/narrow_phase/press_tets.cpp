#include "libcdem/contact/narrow_phase/press_tets.hpp"

#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/narrow_phase/push_directions.hpp"
#include "libcdem/contact/narrow_phase/tet_question.hpp"
#include "libcdem/contact/response/contact_law.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/contact/response/tet_push.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace cdem {
namespace {

constexpr std::int64_t pairs_per_chunk = 32 * lanes;
// Part of the way between an overlap and its phi0 for which the pair sleeps: strain changes the heights of tetrahedra.
constexpr double trusted = 0.9;

// allowed: m, that the two may go past each other before they are looked at again; 0: they stay awake.
void fall_asleep(TetContacts& of, std::size_t near, double allowed) {
  const float may_go = rounded_down(allowed);
  if (!(may_go > 0) && !(of.near.allowed[near] > 0))
    return;
  of.near.set(near, of.paths, may_go);
  of.pairs.set(static_cast<std::size_t>(of.place_of_near[near]), of.paths, may_go);
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
  Pressing(const Model& model, const State& state, const ContactWork& work, const TetQuestion& question,
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
    const bool all_exactly = forgets_overlaps(state_, work_);
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

  TetChunk finish(const PushDirections& directions) {
    find_pushes(directions);
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

  geom::Vec3 force_at(std::size_t i, int corner) const {
    const auto& [batch, lane] = result_[i];
    const auto& f = batches_[batch].force[corner];
    return {f[0][lane], f[1][lane], f[2][lane]};
  }

  geom::Vec3 force_on_first(std::size_t i) const {
    return force_at(i, 0) + force_at(i, 1) + force_at(i, 2) + force_at(i, 3);
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

  // By the depth to which the step's motion takes it, as its own forces work.
  bool came_within_step(std::size_t i) const {
    if (!(energy(i) > 0))
      return true;
    const auto& [batch, lane] = result_[i];
    double power = 0; // W
    for (int k = 0; k < 8; ++k)
      power += force_at(i, k).dot(velocity_of(state_, batches_[batch].of.node[k][lane]));
    return deepest_[i] * force_on_first(i).norm() <= -1.5 * work_.step * power;
  }

  double height(std::size_t i) const { return std::min(first(i).size.height, second(i).size.height); } // m
  // m, depth at which one corner with its edges would have the pair's energy.
  double as_one_corner(std::size_t i) const {
    const auto& [batch, lane] = result_[i];
    return std::sqrt(8.0 / 3 * energy(i) / batches_[batch].stiffness[lane]);
  }
  // Whether the depth that is told is the true one.
  bool is_deep(std::size_t i) const { return as_one_corner(i) > 0.1 * height(i); }

  void find_pushes(const PushDirections& directions) {
    std::vector<std::size_t> deep;
    for (std::size_t batch = 0; batch < n_batches_; ++batch)
      for (auto& axis : pushes_[batch].normal)
        std::fill_n(axis, lanes, 0.0);
    for (std::size_t i = 0; i < end_ - begin_; ++i) {
      const auto& [batch, lane] = result_[i];
      if (!(energy(i) > 0))
        continue;
      if (is_deep(i))
        deep.push_back(i);
      const geom::Vec3 n = directions.of(begin_ + i);
      for (int axis = 0; axis < 3; ++axis)
        pushes_[batch].normal[axis][lane] = n[axis];
    }
    look(deep, find_deepest);
    cdem::find_pushes(of_.place.data(), state_.velocity.data(),
                      work_.damps && work_.knows_motions ? moving_mass(model_, state_).data() : nullptr,
                      work_.step, batches_.get(), pushes_.get(), static_cast<std::int64_t>(n_batches_));
  }

  TetPairLaw law_of(std::size_t i) {
    const SurfaceTet &a = first(i), &b = second(i);
    if (block_ != a.block) {
      block_ = a.block;
      joint_ = contact_joint(model_, block_, block_);
      has_regions_ = !model_.bodies[model_.blocks[block_].body].region_laws.empty();
      tan_friction_ = geom::portable::tan(joint_->friction_angle);
    }
    const double tan_friction = has_regions_ ? friction_within(model_, *joint_, a.tet, b.tet) : tan_friction_;
    return tet_pair_law(model_, *joint_, std::min(tan_friction, work_.options.most_friction), block_, a.size,
                        b.size);
  }

  void finish_pair(std::size_t i) {
    const Contact* const before = asked_[i].before;
    Contact c(Contact::tets, first(i).tet);
    c.target = c.fragment = second(i).tet;
    if (before)
      c = *before;
    c.reference_penetration = phi0_[i];
    if (energy(i) > 0) {
      allowed_.push_back(0);
      act(i, law_of(i), c);
      return;
    }
    if (before && before->effective_penetration() > 0)
      lose(*before, law_of(i).law);
    // An overlap is forgotten in the same steps whatever sleeps.
    const bool forgets = forgets_overlaps(state_, work_) || !(c.reference_penetration > 0);
    if (!(deepest_[i] > 0) && (forgets || !before)) {
      allowed_.push_back(-deepest_[i]);
      return;
    }
    if (forgets_overlaps(state_, work_))
      c.reference_penetration = std::min(c.reference_penetration, deepest_[i]);
    allowed_.push_back(trusted * (c.reference_penetration - deepest_[i]));
    c.depth = c.reference_penetration;
    c.shear = geom::Vec3::Zero();
    c.damping = c.at_rest = 0;
    out_.contacts.push_back(c);
  }

  void act(std::size_t i, const TetPairLaw& of_pair, Contact& c) {
    const Contact* const before = asked_[i].before;
    const auto& [batch, lane] = result_[i];
    const TetPairPress& press = batches_[batch];
    const TetPairPush& push = pushes_[batch];
    const double energy = press.energy[lane], force = push.force[lane];
    ContactLaw law = of_pair.law;
    // The spring that has this force and energy; where the forces of the two cancel, one that has the energy.
    const bool presses = force > 0;
    const double pressed = presses ? 2 * energy / force : std::sqrt(2 * energy / of_pair.corner);
    law.kn = presses ? force / pressed : of_pair.corner;
    if (!presses) {
      if (before)
        lose(*before, law);
      c.stiffness = law.kn;
      c.depth = c.reference_penetration + pressed;
      c.shear = geom::Vec3::Zero();
      c.damping = c.at_rest = 0;
    } else if (!(before && work_.step == 0)) {
      ContactMotion motion;
      motion.normal = {push.normal[0][lane], push.normal[1][lane], push.normal[2][lane]};
      if (!before)
        c.normal = motion.normal;
      motion.depth = c.reference_penetration + pressed;
      motion.slid = {push.slid[0][lane], push.slid[1][lane], push.slid[2][lane]};
      motion.turned = push.turned[lane];
      motion.in_relaxation = !work_.damps;
      const double closing = push.closing[lane];
      if (work_.damps && law.damps)
        set_approach(c, law, closing, force * push.compliance[lane], motion);
      const double damping = c.damping;
      if (damping > 0) // stores the same in the spring of now
        c.damping *= std::sqrt(law.kn / c.stiffness);
      const double jump = 0.5 * (damping - c.damping) * closing; // J
      const ContactLoss loss = advance(c, law, motion);
      out_.friction.push_back(loss.friction);
      out_.damping.push_back(loss.damping + jump);
      c.stiffness = law.kn;
    }
    const double whole = force_on_first(i).norm();                                 // N
    const double stiffness = 1.5 * whole / (2 * energy) * (1 + law.damping_ratio); // 1/m, over the force
    const double more = presses ? 1 + c.damping / force : 1;
    TetPairForce& at = out_.forces.emplace_back();
    at.block = block_;
    for (int k = 0; k < 8; ++k) {
      const double weight = presses ? push.weight[k][lane] : 0;
      at.node[k] = press.of.node[k][lane];
      at.force[k] = more * force_at(i, k) + weight * c.shear;
      // Where forces cancel, the spring is soft and the potential is not.
      at.stiffness[k] =
          std::max(push.length[k][lane] * stiffness, of_pair.corner) + std::abs(weight) * law.ks;
    }
    out_.contacts.push_back(c);
    const double depth = is_deep(i) ? deepest_[i] - phi0_[i] : as_one_corner(i);
    out_.depth = std::max(out_.depth, depth);
    if (depth / height(i) > out_.depth_over_height) {
      out_.depth_over_height = depth / height(i);
      out_.deepest = {static_cast<int>(c.source), c.target};
    }
  }

  // As for semi-springs: by the acceleration that the contact's own force gives the two tetrahedra.
  void set_approach(const Contact& c, const ContactLaw& law, double closing, double acceleration,
                    ContactMotion& motion) const {
    motion.step = work_.step;
    motion.acceleration = acceleration;
    motion.omega_step = work_.step * std::sqrt(acceleration / pressed_now(c, motion));
    motion.approach = part_of(closing, work_.step * reversible_speed(c, motion, part_at_rest(c)));
    motion.held_at_most = part_held(law.damping_ratio, closing, 0, work_.step * work_.step * acceleration);
  }

  // What its shear force and its damping stored is lost; its potential has given back what it had.
  void lose(const Contact& c, ContactLaw law) {
    law.kn = c.stiffness;
    if (law.ks > 0)
      out_.friction.push_back(0.5 * c.shear.squaredNorm() / law.ks -
                              0.5 * c.shear.dot(slid_by_middles(model_, state_, work_.step, c)));
    if (law.damps)
      out_.damping.push_back(stored_by_damping(c, law));
  }

  const Model& model_;
  const State& state_;
  const ContactWork& work_;
  const TetContacts& of_;
  const TetQuestion& question_;
  std::size_t begin_, end_;
  const AskedPair* asked_;
  TetChunk out_;
  // Each pair presses twice at most. Not set to 0: that would cost as much as what is written.
  std::unique_ptr<TetPairPress[]> batches_{new TetPairPress[2 * pairs_per_chunk / lanes]};
  std::unique_ptr<TetPairPush[]> pushes_{new TetPairPush[2 * pairs_per_chunk / lanes]};
  std::size_t n_batches_ = 0;
  std::vector<std::pair<int, int>> result_;      // batch and lane of the force; -1: none was asked for
  std::vector<double> phi0_, deepest_, allowed_; // m
  int block_ = -1;                               // whose law is known
  const Joint* joint_ = nullptr;
  bool has_regions_ = false; // some of them have a law of their own
  double tan_friction_ = 0;
};

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
  const TetQuestion question = tet_question(state, work);
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
  const PushDirections directions(of, question, force);
  for_chunks(n_chunks, threads, [&](std::int64_t i) { found[i] = pressing[i].finish(directions); });
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
