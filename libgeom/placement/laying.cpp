#include "libgeom/placement/laying.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr double unreached = 1e30;

constexpr std::uint64_t stands_tried = 300;
constexpr std::size_t stands_wanted = 16;
constexpr std::size_t attitudes_tried = 24; // half of the family, half any
constexpr double own_turn = 0.05;           // of an attitude of the family when it first comes up, radians
constexpr double more_turn = 0.3;           // and when it comes up again
constexpr std::size_t rested_tries = 10;    // at least; more while none of them is at rest
constexpr std::size_t at_once = 10;         // tries that come to rest on as many threads
constexpr double no_worse = 0.1;            // of the cost, with another spacing

// Over the height: from where on, and how finely, places up the slope are tried.
constexpr double lowest_place = -0.3, highest_place = 1.5, place_step = 0.05;
constexpr double highest_on_units =
    0.1; // the same on a layer below: behind its top row the bare slope is lower
constexpr double on_slope =
    0.03; // over the height: how far from the bare slope a lowered unit still is on it

constexpr double sliding = 0.2;      // coefficient of friction, on the way
constexpr double steeper = 0.1;      // friction over the slope's gradient, of what stands on it by itself
constexpr double lowest_rest = -0.4; // over the height: how far below its place a unit slides

constexpr double to_wall = 0.3; // over the height: how far beyond the play a unit at the end of a row may be

constexpr double way = 1.5; // over the height: how far a unit may go

int carriers(const Rest& rest) {
  return static_cast<int>(std::count(rest.carried_by.begin(), rest.carried_by.end(), 1));
}

constexpr double alike = 15 * M_PI / 180;
constexpr double neighbours = 1.3; // over the height: how far apart

// Every use has random numbers of its own.
constexpr std::uint64_t turn_id = std::uint64_t{1} << 42, any_id = std::uint64_t{1} << 43,
                        stand_id = std::uint64_t{1} << 44;

// Better too far down the slope, where units are keyed, than too far up.
double astray(double up) {
  return std::max(up, -0.5 * up);
}

// Without its underside, which in a thin ground is as near as the upper one.
Surface upper_side(const Surface& ground) {
  Surface side{ground.points, {}};
  for (std::size_t i = 0; i < ground.triangles.size(); ++i) {
    const TrianglePoints t = ground.corners(i);
    if ((t[1] - t[0]).cross(t[2] - t[0]).z() > 0)
      side.triangles.push_back(ground.triangles[i]);
  }
  return side;
}

// Radius of gyration of a solid with the same inertia about all axes.
double gyration_of(const Pile& pile) {
  const MassProperties solid = mass_properties(pile.unit);
  return std::sqrt(solid.inertia.trace() / (3 * solid.volume));
}

} // namespace

Laying::Laying(const Pile& pile, const Ground& ground, const Mat3& frame, double gap,
               const LayerOptions& options, const Spacing& spacing, std::optional<Between> walls,
               const std::vector<Pose>& lower, std::function<void()> poll)
    : shape_(surface_of(pile.unit)), features_(features_of(shape_)),
      ground_features_(features_of(upper_side(ground.surface()))), ground_(ground), frame_(frame), gap_(gap),
      height_(pile.height), radius_(bounding_radius(pile.unit)), gyration_(gyration_of(pile)),
      options_(options), ground_profile_(ground.surface(), frame), walls_(walls), poll_(std::move(poll)) {
  if (walls)
    wall_features_ = {wall(walls->low, 1), wall(walls->high, -1)};
  for (const Mat3& rotation : attitudes_for(shape_, spacing, options.attitudes, options.seed))
    family_.emplace_back(frame.transpose() * rotation);
  stands_ = stands();
  for (const Pose& pose : lower)
    laid_.push_back(laid_at(pose, 0));
  sites_.resize(lower.size());
  lower_units_ = static_cast<int>(lower.size());
}

Surface Laying::surface_at(const Pose& pose) const {
  Surface surface = shape_;
  for (Vec3& x : surface.points)
    x = pose(x);
  return surface;
}

// m along the normal, of the slope at a place.
double Laying::ground_level(const Vec3& place) const {
  const Vec3 x = frame_.transpose() * Vec3(place.x(), place.y(), 0);
  const auto z = ground_.height(x.x(), x.y());
  return z ? frame_.row(2).dot(Vec3(x.x(), x.y(), *z)) : 0;
}

// Bodies that a unit may meet before it comes to rest.
Laying::Near Laying::on_the_way(const Vec3& centroid, int except) const {
  return near(centroid, 2 * radius_ + (way + roll) * height_, except);
}

Laying::Near Laying::near(const Vec3& centroid, double reach, int except) const {
  Near found;
  for (const Laid& other : laid_)
    if (&other - laid_.data() != except && (other.pose.translation - centroid).norm() < reach)
      found.push_back(&other);
  return found;
}

// A plane along the normal and up the slope, larger than any pile.
Features Laying::wall(double at, double facing) const {
  const double wide = 1e4 * radius_;
  Surface plane;
  const Vec3 centre = at * frame_.row(0), up = wide * frame_.row(1), out = facing * wide * frame_.row(2);
  plane.points = {centre + up, centre + out, centre - up, centre - out};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  return features_of(plane);
}

bool Laying::within_walls(const Surface& surface) const {
  return !walls_ || std::all_of(surface.points.begin(), surface.points.end(), [&](const Vec3& x) {
    const double along = frame_.row(0).dot(x);
    return along >= walls_->low + 0.995 * gap_ && along <= walls_->high - 0.995 * gap_;
  });
}

Laying::Between Laying::room(const Site& site) const {
  const double play = options_.play * height_, more = walls_ ? to_wall * height_ : 0;
  return {-play - (site.end < 0 ? more : 0), play + (site.end > 0 ? more : 0)};
}

// Coefficient of friction of what rests on the slope by itself.
double Laying::standing() const {
  const double steep = portable::tan(portable::acos(std::min(1., std::abs(frame_(2, 2)))));
  return std::max(options_.friction, steep + steeper);
}

RestOptions Laying::resting(double friction) const {
  RestOptions options;
  options.friction = friction;
  options.clear = gap_;
  options.step = 0.03 * height_;
  options.last_step = std::min(gap_, 1e-3 * height_);
  options.probe = 5e-3 * height_;
  options.gyration = gyration_;
  options.steps = options_.nudges;
  options.way = way * height_;
  return options;
}

// Units put down in random attitudes on a plane as steep as the slope.
std::vector<Mat3> Laying::stands() const {
  const double wide = 20 * radius_;
  const Vec3 along = wide * frame_.row(0), up = wide * frame_.row(1);
  Surface plane;
  plane.points = {along, up, -along, -up};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Features bare = features_of(plane);
  const RestOptions resting = this->resting(standing());
  std::vector<Mat3> found;
  for (std::uint64_t k = 0; k < stands_tried && found.size() < stands_wanted; ++k) {
    Pose start{random_rotation(options_.seed, stand_id + k), Vec3::Zero()};
    double low = 0;
    for (const Vec3& x : shape_.points)
      low = std::min(low, frame_.row(2).dot(start.rotation * x));
    start.translation = (gap_ - low) * frame_.row(2);
    const Rest rest = come_to_rest(features_, start, {&bare}, resting);
    if (rest.still)
      found.push_back(rest.pose.rotation);
  }
  return found;
}

std::vector<Mat3> Laying::attitudes(const Site& site) const {
  const auto id = static_cast<std::uint64_t>(site.unit);
  std::vector<Mat3> all;
  for (std::size_t k = 0; k < stands_.size(); ++k)
    all.push_back(stands_[(id + k) % stands_.size()]);
  if (site.below.empty() && !all.empty())
    return all;
  for (std::size_t k = 0; k < attitudes_tried; ++k) {
    const auto draw = [&](std::uint64_t i) {
      return 2 * uniform(options_.seed, turn_id + id, 3 * k + i) - 1;
    };
    const Mat3& own = family_[(id + k) % family_.size()];
    all.push_back(k < attitudes_tried / 2 ? turned(own, (k < family_.size() ? own_turn : more_turn) *
                                                            Vec3(draw(0), draw(1), draw(2)))
                                          : random_rotation(options_.seed, any_id + id, 3 * k));
  }
  return all;
}

// As far down the slope as the unit comes down to the ground, from a little below its place on.
Laying::Try Laying::lowered(const Mat3& rotation, const Site& site) const {
  const Profile profile(surface_at({rotation, Vec3::Zero()}), frame_);
  double bare = 0, left = 0, right = 0; // m, of the centroid over a bare plane, between walls
  for (const Vec3& x : shape_.points) {
    const Vec3 at = frame_ * (rotation * x);
    bare = std::max(bare, -at.z());
    left = std::max(left, -at.x());
    right = std::max(right, at.x());
  }
  double along = site.place.x();
  if (walls_)
    along = std::max(std::min(along, walls_->high - gap_ - right), walls_->low + gap_ + left);
  Try best{{rotation, Vec3::Zero()}, unreached};
  const double highest = lower_units_ > 0 ? highest_on_units : highest_place;
  for (double up = site.below.empty() ? 0 : lowest_place; up < highest; up += place_step) {
    Vec3 place(along, site.place.y() + up * height_, 0);
    const Vec3 offset(place.x(), place.y(), 0);
    double nearest = clearance(profile, offset, ground_profile_, unreached);
    if (nearest == unreached) // beside the ground
      continue;
    for (const Laid& other : laid_)
      nearest = std::min(nearest, clearance(profile, offset, other.profile, nearest));
    place.z() = gap_ - nearest;
    const double over = (place.z() - ground_level(place) - bare) / height_;
    const double cost = astray(place.y() - site.wanted) / height_ + 3 * std::max(0., over - on_slope);
    if (cost < best.cost)
      best = {{rotation, frame_.transpose() * place}, cost};
    if (over <= on_slope)
      break;
  }
  return best;
}

Laying::Try Laying::rested(const Try& first, const Site& site, const Near& near) const {
  std::vector<const Features*> others{&ground_features_};
  for (const Laid* other : near)
    others.push_back(&other->features);
  for (const Features& wall : wall_features_)
    others.push_back(&wall);
  RestOptions options = resting(sliding), held = resting(site.below.empty() ? standing() : options_.friction);
  held.way = roll * height_;
  Pose pose = first.pose;
  const bool lowest_row = site.below.empty(), held_on_units = lowest_row && lower_units_ > 0;
  if (!lowest_row || held_on_units) {
    const Vec3 across = frame_.row(0), up = frame_.row(1);
    const Between room = this->room(site);
    const double lowest = held_on_units ? -options_.play : lowest_rest;
    options.bounds = {{across, site.place.x() + room.low},
                      {-across, -site.place.x() - room.high},
                      {up, site.place.y() + lowest * height_}};
    pose = come_to_rest(features_, pose, others, options).pose;
  }
  if (held_on_units)
    held.bounds = options.bounds;
  Rest rest = come_to_rest(features_, pose, others, held);
  rest.pose = pushed_clear(features_, rest.pose, others, held);
  return {rest.pose, cost(rest, site, near), rest.still && carriers(rest) >= carriers_wanted(site)};
}

int Laying::carriers_wanted(const Site& site) {
  return site.below.empty() ? 1 : least_carriers;
}

double Laying::cost(const Rest& rest, const Site& site, const Near& near) const {
  const Features body = moved(features_, rest.pose);
  std::vector<Touch> touches;
  const auto touched = [&](const Features& other) {
    touches.clear();
    NearFeatures(body, other, 2 * gap_).touches(body, other, 2 * gap_, touches);
    return !touches.empty();
  };
  const auto below = [&](const Laid* other) {
    return std::any_of(site.below.begin(), site.below.end(), [&](int i) { return &laid_[i] == other; });
  };
  const bool on_ground = touched(ground_features_);
  int unkeyed = static_cast<int>(site.below.size()), like = 0;
  for (const Laid* other : near) {
    const Pose& there = other->pose;
    if ((there.translation - rest.pose.translation).norm() < neighbours * height_ &&
        Eigen::AngleAxisd(there.rotation.transpose() * rest.pose.rotation).angle() < alike)
      ++like;
    if (below(other) && touched(other->features))
      --unkeyed;
  }
  const Vec3 at = frame_ * rest.pose.translation;
  const Between room = this->room(site);
  const double off = at.x() - site.place.x(), beside = std::max({0., off - room.high, room.low - off});
  const double high = std::max(0., at.z() - ground_level(at) - 0.5 * height_);
  return (rest.still ? 0 : 1) + (on_ground ? 0 : 0.5) + 0.3 * unkeyed +
         0.2 * std::max(0, carriers_wanted(site) - carriers(rest)) + 0.1 * like +
         (astray(at.y() - site.wanted) + 3 * beside + 2 * high) / height_;
}

bool Laying::clear(const Pose& pose, const Near& near) const {
  const Surface here = surface_at(pose);
  const double asked = 0.995 * gap_;
  return within_walls(here) && distance(here, ground_.surface(), gap_) >= asked &&
         std::all_of(near.begin(), near.end(),
                     [&](const Laid* other) { return distance(here, other->surface, gap_) >= asked; });
}

// What was lowered along a steep flank may be nearer to it than the gap.
Pose Laying::raised(Pose pose, const Near& near) const {
  while (!clear(pose, near))
    pose.translation += 0.5 * gap_ * frame_.row(2).transpose();
  return pose;
}

// The first of them that is within the walls; none has the cost `unreached`.
Laying::Try Laying::first_to_fit(const std::vector<Try>& lowered) const {
  const auto fits = std::find_if(lowered.begin(), lowered.end(), [&](const Try& t) {
    return t.cost < unreached && within_walls(surface_at(t.pose));
  });
  return fits == lowered.end() ? Try{lowered.front().pose, unreached} : *fits;
}

// The pose of lowest cost of the first tries, and of more of them until one is good; the cost `unreached` where none is clear.
Laying::Try Laying::best_at_rest(const std::vector<Try>& lowered, const Site& site) const {
  Try best{lowered.front().pose, unreached};
  std::vector<Try> rested(at_once);
  for (std::size_t first = 0; first < lowered.size(); first += at_once) {
    if ((first >= rested_tries && best.good) || lowered[first].cost == unreached)
      break;
    const std::size_t count = std::min(at_once, lowered.size() - first);
    poll_();
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t i = 0; i < count; ++i) {
      const Try& start = lowered[first + i];
      rested[i] = {start.pose, unreached};
      if (start.cost == unreached)
        continue;
      const Near around = on_the_way(start.pose.translation);
      const Try one = this->rested(start, site, around);
      if (clear(one.pose, around))
        rested[i] = one;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (rested[i].cost < best.cost)
        best = rested[i];
  }
  return best;
}

void Laying::lay(const Site& site, const Laying* before) {
  std::vector<Try> tries;
  Try best{{}, unreached};
  if (before != nullptr && options_.nudges > 0) {
    const Laid& there = before->laid_[site.unit];
    tries = {lowered(there.pose.rotation, site)};
    best = best_at_rest(tries, site);
    if (there.cost < unreached && best.cost <= there.cost + no_worse) {
      sites_.push_back(site);
      laid_.push_back(laid_at(best.pose, best.cost));
      return;
    }
  }
  const std::vector<Mat3> rotations = attitudes(site);
  tries.resize(rotations.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < rotations.size(); ++i)
    tries[i] = lowered(rotations[i], site);
  std::stable_sort(tries.begin(), tries.end(), [](const Try& a, const Try& b) { return a.cost < b.cost; });
  if (tries.front().cost == unreached)
    throw InputError(
        "unit " + std::to_string(site.unit + 1) +
        " of the layer: there is no ground where it is to lie; give a larger ground, or a region "
        "within it");
  const Try fits = first_to_fit(tries);
  if (options_.nudges > 0)
    if (const Try one = best_at_rest(tries, site); one.cost < best.cost)
      best = one;
  if (best.cost == unreached && fits.cost == unreached)
    throw InputError(
        "unit " + std::to_string(site.unit + 1) +
        " of the layer: it fits between the walls in none of its attitudes; ask for more columns or "
        "a lower density, or leave the walls out");
  sites_.push_back(site);
  if (best.cost == unreached)
    best.pose = raised(fits.pose, near(fits.pose.translation, 2 * radius_ + height_));
  laid_.push_back(laid_at(best.pose, best.cost));
}

Laying::Laid Laying::laid_at(const Pose& pose, double cost) const {
  Surface surface = surface_at(pose);
  Profile profile(surface, frame_);
  return {pose, cost, moved(features_, pose), std::move(surface), std::move(profile)};
}

} // namespace geom
