#include "libgeom/placement/armour_layer.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/placement/lattice.hpp"
#include "libgeom/placement/lowering.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace geom {
namespace {

constexpr double far = 1e30;

constexpr double lean_way =
    0.35; // of the height: how far down the slope a unit may go to lean on the row below
constexpr int spacings_tried = 4;
constexpr double density_tolerance = 0.01;
constexpr std::uint64_t fitting_tries = 1000;
constexpr std::uint64_t fitting_id = std::uint64_t{1} << 42,
                        any_id = std::uint64_t{1} << 43; // of random numbers

// The slope's own axes, as rows: along the contour, up the slope, out of it.
Mat3 slope_frame(const Vec3& normal) {
  const Vec3 across = Vec3::UnitZ().cross(normal);
  const Vec3 level = across.norm() > 1e-6 ? Vec3(across.normalized()) : Vec3(-Vec3::UnitY());
  Mat3 frame;
  frame << level.transpose(), normal.cross(level).transpose(), normal.transpose();
  return frame;
}

struct Pattern {
  Spacing spacing;
  int columns = 0;
};

class Layer {
public:
  Layer(const Pile& pile, const Ground& ground, const Mat3& frame, double gap)
      : shape_(surface_of(pile.unit)), ground_(ground), frame_(frame), gap_(gap),
        ground_profile_(ground.surface(), frame) {}

  // Puts the unit of this rotation down at a place of the slope (in its axes); returns how high along the
  // normal its centroid then is.
  double lower(const Mat3& rotation, const Vec3& place) const {
    const Surface turned = moved({rotation, Vec3::Zero()});
    const Profile profile(turned, frame_);
    const Vec3 offset(place.x(), place.y(), 0);
    double room = clearance(profile, offset, ground_profile_, far);
    for (const Laid& other : laid_)
      room = std::min(room, clearance(profile, offset, other.profile, room));
    return gap_ - room;
  }

  // m along the normal, of the slope at a place.
  double level(const Vec3& place) const {
    const Vec3 x = frame_.transpose() * Vec3(place.x(), place.y(), 0);
    const auto z = ground_.height(x.x(), x.y());
    return z ? frame_.row(2).dot(Vec3(x.x(), x.y(), *z)) : 0;
  }
  // m, of the centroid over the slope, were the slope a bare plane.
  double bare_height(const Mat3& rotation) const {
    const Eigen::RowVector3d up = frame_.row(2) * rotation;
    double lowest = 0;
    for (const Vec3& x : shape_.points)
      lowest = std::min(lowest, up.dot(x));
    return gap_ - lowest;
  }

  // Raises a unit until it is clear of all others; lowered along a steep flank it may be nearer than the gap.
  Pose cleared(Pose pose) const {
    const Vec3 normal = frame_.row(2);
    for (int i = 0; i < 10000; ++i) {
      const Surface here = moved(pose);
      double room = distance(here, ground_.surface(), gap_);
      for (const Laid& other : laid_)
        room = std::min(room, distance(here, other.surface, gap_));
      if (room >= 0.999 * gap_)
        break;
      pose.translation += std::max(gap_ - room, 0.05 * gap_) * normal;
    }
    return pose;
  }

  void lay(const Pose& pose) {
    Surface here = moved(pose);
    Profile profile(here, frame_);
    laid_.push_back({std::move(here), std::move(profile)});
  }

private:
  struct Laid {
    Surface surface;
    Profile profile;
  };

  Surface moved(const Pose& pose) const {
    Surface surface = shape_;
    for (Vec3& x : surface.points)
      x = pose(x);
    return surface;
  }

  Surface shape_;
  const Ground& ground_;
  Mat3 frame_;
  double gap_;
  Profile ground_profile_;
  std::vector<Laid> laid_;
};

// Where a unit lies, in the slope's axes.
struct Lying {
  Mat3 rotation = Mat3::Identity();
  Vec3 place = Vec3::Zero(); // of the centroid
};

class Laying {
public:
  // family: attitudes relative to the slope's axes.
  Laying(const Layer& layer, const Mat3& frame, const LayerOptions& options, double height,
         const std::vector<Mat3>& family)
      : layer_(layer), options_(options), height_(height), sink_(frame * Vec3::UnitZ()) {
    for (const Mat3& rotation : family)
      family_.emplace_back(frame.transpose() * rotation);
  }

  Lying find(const Vec3& place, std::uint64_t unit) const {
    return nudged(first_try(place, unit), place, unit);
  }

private:
  // The unit's turn in the family; where that lies higher than on the bare slope, the lowest of many tries.
  Lying first_try(const Vec3& place, std::uint64_t unit) const {
    Lying best = lowered(varied(family_[unit % family_.size()], unit), place);
    const double allowed = layer_.level(place) + layer_.bare_height(best.rotation) + 0.05 * height_;
    for (std::uint64_t k = 0; k < fitting_tries && best.place.z() > allowed; ++k) {
      const auto draw = [&](std::uint64_t i) {
        return 2 * uniform(options_.seed, fitting_id + unit, 5 * k + i) - 1;
      };
      // The family as it is, then moved and turned a little, at last any attitude.
      const Mat3& own = family_[k % family_.size()];
      const double play = k < family_.size() ? 0 : options_.play * height_;
      const Mat3 rotation = k < family_.size()      ? own
                            : k < fitting_tries / 2 ? turned(own, 0.15 * Vec3(draw(2), draw(3), draw(4)))
                                                    : random_rotation(options_.seed, any_id + unit, 3 * k);
      const Lying other = lowered(rotation, place + play * Vec3(draw(0), draw(1), 0));
      if (other.place.z() < best.place.z())
        best = other;
    }
    return best;
  }
  // Turned by up to 5 degrees about any axis.
  Mat3 varied(const Mat3& rotation, std::uint64_t unit) const {
    Vec3 turn;
    for (std::uint64_t i = 0; i < 3; ++i)
      turn[static_cast<Eigen::Index>(i)] = 2 * uniform(options_.seed, unit, i) - 1;
    return turned(rotation, 5 * M_PI / 180 * turn / std::sqrt(3.));
  }
  static Mat3 turned(const Mat3& rotation, const Vec3& by) { // radians
    return by.norm() > 0 ? Mat3(Eigen::AngleAxisd(by.norm(), by.normalized()).toRotationMatrix() * rotation)
                         : rotation;
  }
  Lying lowered(const Mat3& rotation, const Vec3& place) const {
    return {rotation, {place.x(), place.y(), layer_.lower(rotation, place)}};
  }

  // Descent by trials whose size is halved after every tenth that found nothing lower.
  Lying nudged(Lying best, const Vec3& place, std::uint64_t unit) const {
    const double play = options_.play * height_;
    double size = 1;
    int vain = 0;
    for (int k = 0; k < options_.nudges; ++k) {
      const auto draw = [&](std::uint64_t i) {
        return 2 * uniform(options_.seed, unit, 3 + 5 * static_cast<std::uint64_t>(k) + i) - 1;
      };
      Vec3 to = best.place + size * play * Vec3(draw(0), draw(1), 0);
      to.x() = std::clamp(to.x(), place.x() - play, place.x() + play);
      to.y() = std::clamp(to.y(), place.y() - lean_way * height_, place.y() + play);
      const Mat3 rotation = turned(best.rotation, 0.5 * size * Vec3(draw(2), draw(3), draw(4)));
      const Lying other = lowered(rotation, to);
      if (sink_.dot(other.place) < sink_.dot(best.place)) {
        best = other;
        vain = 0;
      } else if (++vain == 20) {
        size *= 0.5;
        vain = 0;
      }
    }
    return best;
  }

  const Layer& layer_;
  const LayerOptions& options_;
  double height_;
  Vec3 sink_; // up, in the slope's axes
  std::vector<Mat3> family_;
};

void check(const LayerOptions& options, int count) {
  if (count < 1)
    throw InputError("count", std::to_string(count), "at least 1");
  require_block_count("count", std::to_string(count), count, "place fewer units");
  require_between("density", options.density, 0.05, 1.5);
  if (options.columns && *options.columns < 1)
    throw InputError("columns", std::to_string(*options.columns), "at least 1");
  require_between("attitudes", options.attitudes, 1, 1000000);
  require_between("nudges", options.nudges, 0, 100000);
  require_between("play", options.play, 0, 1);
}

// widening: of the spacing along the contour.
Pattern choose_pattern(const Pile& pile, int count, const LayerOptions& options, const Eigen::Vector2d& room,
                       double widening) {
  Pattern pattern;
  pattern.spacing.rows = nominal_diameter(pile) / std::sqrt(2 * options.density);
  pattern.spacing.across = 2 * widening * pattern.spacing.rows;
  // A row and the next, shifted by half a place, take columns + 1/2 places.
  const double most_columns = std::floor((room.x() - pile.height) / pattern.spacing.across + 0.5 + 1e-9);
  const double most_rows = std::floor((room.y() - pile.height) / pattern.spacing.rows + 1 + 1e-9);
  if (!(most_columns >= 1 && most_rows >= 1))
    throw InputError("region",
                     text(room.x()) + " m along the contour by " + text(room.y()) + " m up the slope",
                     "at least " + text(pile.height + 0.5 * pattern.spacing.across) + " m by " +
                         text(pile.height) + " m, room for one unit");
  pattern.columns = options.columns.value_or(static_cast<int>(std::min(most_columns, 1e6)));
  if (pattern.columns > most_columns)
    throw InputError("columns", std::to_string(pattern.columns), "at most " + text(most_columns),
                     "the region has no room for more along the contour");
  if (count > most_rows * pattern.columns)
    throw InputError("count", std::to_string(count),
                     "at most " + text(most_rows * pattern.columns) + ": " + text(most_rows) + " rows of " +
                         std::to_string(pattern.columns),
                     "a larger region takes more");
  return pattern;
}

// Lays rows from the toe, each one spacing above where the one below has come to lie. Returns the density.
double lay_rows(Pile& pile, int count, const Pattern& pattern, const Vec3& first, const Mat3& frame,
                Layer& layer, const Laying& laying) {
  double row_place = first.y(), toe = 0, top = 0, row_sum = 0;
  int full_rows = 0;
  pile.poses.clear();
  for (int i = 0; i < count; ++i) {
    const int row = i / pattern.columns, column = i % pattern.columns;
    const double shift = row % 2 == 0 ? -0.25 : 0.25;
    const Vec3 place(first.x() + (column - 0.5 * (pattern.columns - 1) + shift) * pattern.spacing.across,
                     row_place, 0);
    const Lying lying = laying.find(place, static_cast<std::uint64_t>(i));
    const Pose pose = layer.cleared({lying.rotation, frame.transpose() * lying.place});
    layer.lay(pose);
    pile.poses.push_back(pose);
    row_sum += lying.place.y();
    if (column + 1 < pattern.columns)
      continue;
    top = row_sum / pattern.columns;
    if (full_rows++ == 0)
      toe = top;
    row_sum = 0;
    row_place = top + pattern.spacing.rows;
  }
  const double rows = full_rows > 1 ? (top - toe) / (full_rows - 1) : pattern.spacing.rows;
  const double dn = nominal_diameter(pile);
  return dn * dn / (pattern.spacing.across * rows);
}

} // namespace

Pile place_layer(const TetMesh& unit, int count, const Ground& ground, const LayerOptions& options) {
  check(options, count);
  Pile pile = pile_of(unit);
  const double gap = options.gap.value_or(1e-3 * pile.height);
  require_positive("gap", gap);
  const PlanBox region = region_of(ground, options.region);
  const Mat3 frame = slope_frame(ground.normal(region));

  // The region's corners on the slope, in its axes.
  Box room;
  for (const double x : {region.min.x(), region.max.x()})
    for (const double y : {region.min.y(), region.max.y()}) {
      const Eigen::Vector2d inside = Eigen::Vector2d(x, y) + 1e-6 * (region.centre() - Eigen::Vector2d(x, y));
      const auto z = ground.height(inside.x(), inside.y());
      if (!z)
        throw InputError("region: its corner " + text(x) + ", " + text(y) +
                         " is beside the ground; keep the region on the slope");
      room.extend(frame * Vec3(inside.x(), inside.y(), *z));
    }
  // Units that lean on the row below stand closer than the pattern: its places along the contour are widened until
  // the density is the one asked for.
  const Surface shape = surface_of(pile.unit);
  const Vec3 first(room.centre().x(), room.min.y() + 0.5 * pile.height, 0);
  Pile best;
  double widening = 1, least_error = far;
  for (int i = 0; i < spacings_tried && least_error > density_tolerance; ++i) {
    const Pattern pattern = choose_pattern(pile, count, options, room.size().head<2>(), widening);
    Layer layer(pile, ground, frame, gap);
    const Laying laying(layer, frame, options, pile.height,
                        attitudes_for(shape, pattern.spacing, options.attitudes, options.seed));
    const double density = lay_rows(pile, count, pattern, first, frame, layer, laying);
    const double error = std::abs(density / options.density - 1);
    if (error < least_error) {
      least_error = error;
      best = pile;
    }
    widening = std::clamp(widening * density / options.density, 0.8, 1.4);
  }
  return best;
}

} // namespace geom
