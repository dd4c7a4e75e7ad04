#include "libgeom/placement/rest.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr int sweeps = 60;          // over all impulses, at most
constexpr double enough = 1e-3;     // of s: when no impulse changes by more, they are found
constexpr double still_part = 0.03; // of s: a smaller motion is rest
constexpr double smaller = 0.3;     // s after rest, over s before
constexpr double tilt = 0.07;       // of gravity, 4 degrees: what rests does so with a margin
constexpr int tilts = 4;            // ways it is tilted, by turns
constexpr double skin_steps = 3;    // of s: how far the lists of near features reach beyond a step
constexpr double presses = 0.02;    // of the weight
constexpr int pushes = 10;          // at most, to the clear distance

struct Motion {
  Vec3 shift, turn; // m; the turn times the radius of gyration
  double norm() const { return std::sqrt(shift.squaredNorm() + turn.squaredNorm()); }
};

// One direction at a point of the body, in which an impulse acts.
struct Row {
  Vec3 shift, turn;
  double mass = 0; // inverse: motion along the direction per impulse
  double impulse = 0;

  Row(const Vec3& direction, const Vec3& arm, double gyration)
      : shift(direction), turn(arm.cross(direction) / gyration),
        mass(shift.squaredNorm() + turn.squaredNorm()) {}
  double along(const Motion& v) const { return shift.dot(v.shift) + turn.dot(v.turn); }
  void push(Motion& v, double to) {
    v.shift += (to - impulse) * shift;
    v.turn += (to - impulse) * turn;
    impulse = to;
  }
};

struct Contact {
  Row normal, first, second; // the last two along the face
  double room = 0;           // m, until it touches
};

Contact contact(const Touch& touch, const Vec3& centroid, const RestOptions& options) {
  const Vec3 &n = touch.normal, arm = touch.point - centroid;
  const Vec3 t = (std::abs(n.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY()).cross(n).normalized();
  return {Row(n, arm, options.gyration), Row(t, arm, options.gyration),
          Row(n.cross(t), arm, options.gyration), touch.gap - options.clear};
}

Motion step(std::vector<Contact>& contacts, std::vector<std::pair<Row, double>>& bounds,
            const RestOptions& options, const Vec3& pull, double s) {
  Motion v{pull, Vec3::Zero()};
  for (int k = 0; k < sweeps; ++k) {
    double most = 0;
    const auto press = [&](Row& row, double room) {
      const double before = row.impulse;
      row.push(v, std::max(0., before - (row.along(v) + room) / row.mass));
      most = std::max(most, std::abs(row.impulse - before));
    };
    for (auto& [row, room] : bounds)
      press(row, room);
    for (Contact& c : contacts) {
      press(c.normal, std::max(c.room, -s));
      if (c.normal.impulse == 0 && c.first.impulse == 0 && c.second.impulse == 0)
        continue;
      double a = c.first.impulse - c.first.along(v) / c.first.mass;
      double b = c.second.impulse - c.second.along(v) / c.second.mass;
      const double held = options.friction * c.normal.impulse, square = a * a + b * b;
      if (square > held * held) {
        const double part = held / std::sqrt(square);
        a *= part;
        b *= part;
      }
      c.first.push(v, a);
      c.second.push(v, b);
    }
    if (most < enough * s)
      break;
  }
  return v;
}

// Returns how far a point of the body may have gone.
double move(Pose& pose, const Motion& v, double gyration, double radius) {
  const Vec3 turn = v.turn / gyration;
  pose.translation += v.shift;
  if (turn.norm() > 0)
    pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()) * pose.rotation)
                        .normalized()
                        .toRotationMatrix();
  return v.shift.norm() + turn.norm() * radius;
}

// Which of the others carry a body at rest, from the impulses of one more step. of: the other of each contact.
std::vector<char> carriers(std::vector<Contact>& contacts, const std::vector<std::size_t>& of,
                           std::size_t others, const RestOptions& options, double s) {
  std::vector<std::pair<Row, double>> no_bounds;
  for (Contact& c : contacts) // what pushes it out of another does not carry it
    c.room = std::max(0., c.room);
  step(contacts, no_bounds, options, s * options.down, s);
  std::vector<double> impulse(others, 0);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    impulse[of[i]] += contacts[i].normal.impulse;
  std::vector<char> carry(others);
  for (std::size_t i = 0; i < others; ++i)
    carry[i] = impulse[i] > presses * s ? 1 : 0;
  return carry;
}

std::vector<Contact> contacts_of(const std::vector<Touch>& touches, const Vec3& centroid,
                                 const RestOptions& options) {
  std::vector<Contact> contacts;
  contacts.reserve(touches.size());
  for (const Touch& touch : touches)
    contacts.push_back(contact(touch, centroid, options));
  return contacts;
}

} // namespace

Rest come_to_rest(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions& options) {
  Rest rest{start, false, {}};
  const Vec3 aside = options.down.unitOrthogonal(), other = options.down.cross(aside);
  int held = 0; // steps in a row
  double s = options.step, gone = std::numeric_limits<double>::infinity(), skin = 0, radius = 0;
  for (const Vec3& x : shape.corners)
    radius = std::max(radius, x.norm());
  std::vector<NearFeatures> near(others.size());
  std::vector<Touch> touches;
  std::vector<std::size_t> of; // the other of each touch
  for (int k = 0; k < options.steps; ++k) {
    const Features body = moved(shape, rest.pose);
    const double reach = 2 * s + options.clear;
    if (gone > skin) {
      skin = skin_steps * s;
      gone = 0;
      for (std::size_t i = 0; i < others.size(); ++i)
        near[i] = NearFeatures(body, *others[i], reach + skin);
    }
    touches.clear();
    of.clear();
    for (std::size_t i = 0; i < others.size(); ++i) {
      near[i].touches(body, *others[i], reach, touches);
      of.resize(touches.size(), i);
    }
    std::vector<Contact> contacts = contacts_of(touches, rest.pose.translation, options);
    std::vector<std::pair<Row, double>> bounds;
    for (const Plane& plane : options.bounds)
      bounds.emplace_back(Row(plane.normal, Vec3::Zero(), options.gyration),
                          plane.level(rest.pose.translation));

    const Vec3& by = k % 2 == 0 ? aside : other;
    const Vec3 down = (options.down + (k % tilts < 2 ? tilt : -tilt) * by).normalized();
    const Motion v = step(contacts, bounds, options, s * down, s);
    gone += move(rest.pose, v, options.gyration, radius);
    if ((rest.pose.translation - start.translation).norm() > options.way)
      break;
    held = v.norm() < still_part * s ? held + 1 : 0;
    if (held < tilts)
      continue;
    held = 0;
    if (s <= options.last_step) {
      rest.still = true;
      contacts = contacts_of(touches, rest.pose.translation, options);
      rest.carried_by = carriers(contacts, of, others.size(), options, s);
      break;
    }
    s = std::max(smaller * s, options.last_step);
  }
  return rest;
}

Pose pushed_clear(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions& options) {
  Pose pose = start;
  RestOptions smooth = options;
  smooth.friction = 0;
  smooth.clear = 1.001 * options.clear;
  std::vector<std::pair<Row, double>> no_bounds;
  for (int k = 0; k < pushes; ++k) {
    const Features body = moved(shape, pose);
    const double reach = 2 * options.clear;
    std::vector<Touch> touches;
    for (const Features* other : others)
      NearFeatures(body, *other, reach).touches(body, *other, reach, touches);
    if (std::all_of(touches.begin(), touches.end(),
                    [&](const Touch& touch) { return touch.gap >= options.clear; }))
      break;
    std::vector<Contact> contacts = contacts_of(touches, pose.translation, smooth);
    move(pose, step(contacts, no_bounds, smooth, Vec3::Zero(), options.clear), options.gyration, 0);
  }
  return pose;
}

} // namespace geom
