#include "libgeom/placement/armour_layer.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/placement/laying.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

namespace geom {
namespace {

constexpr double far = 1e30;

constexpr double catch_up =
    0.2; // of the height: how far a unit may be laid off the two below for the density
constexpr double usual_gap = 2e-5; // of the height
constexpr int most_spacings = 6;
constexpr int units_times_spacings = 2000; // at most: a large layer has its density sooner
// Between walls every unit can lean on three things, as a rule: where some do not, the layer is laid again.
constexpr int most_attempts = 4;
constexpr int units_times_attempts = 240;
constexpr std::uint64_t next_seed = std::uint64_t{1} << 32;
constexpr double density_tolerance = 0.01;
constexpr double not_at_rest = 1; // error of the density that it counts for

// The slope's own axes, as rows: along the contour, up the slope, out of it.
Mat3 slope_frame(const Vec3& normal) {
  const Vec3 across = Vec3::UnitZ().cross(normal);
  const Vec3 level = across.norm() > 1e-6 ? Vec3(across.normalized()) : Vec3(-Vec3::UnitY());
  Mat3 frame;
  frame << level.transpose(), normal.cross(level).transpose(), normal.transpose();
  return frame;
}

constexpr std::uint64_t widths = 1000;

// m, over all directions, of a unit about its centroid.
double mean_half_width(const TetMesh& unit) {
  double sum = 0;
  for (std::uint64_t k = 0; k < widths; ++k) {
    const Vec3 direction = random_rotation(0, k).row(0);
    double most = 0;
    for (const Vec3& x : unit.nodes)
      most = std::max(most, direction.dot(x));
    sum += most;
  }
  return sum / widths;
}

int spacings_tried(int count) {
  return std::clamp(units_times_spacings / count, 2, most_spacings);
}

int attempts_made(int count, const LayerOptions& options) {
  return options.walls && options.nudges > 0 ? std::clamp(units_times_attempts / count, 1, most_attempts) : 1;
}

struct Pattern {
  Spacing spacing;
  int columns = 0;
};

void check(const LayerOptions& options, int count) {
  if (count < 1)
    throw InputError("count", std::to_string(count), "at least 1");
  require_between("layers", options.layers, 1, max_layers);
  if (count < options.layers)
    throw InputError("count", std::to_string(count), "at least as many as there are layers");
  require_block_count("count", std::to_string(count), count, "place fewer units");
  require_between("density", options.density, 0.05, 1.5);
  if (options.columns && *options.columns < 1)
    throw InputError("columns", std::to_string(*options.columns), "at least 1");
  require_between("attitudes", options.attitudes, 1, 1000000);
  require_between("nudges", options.nudges, 0, 100000);
  require_between("play", options.play, 0, 1);
}

// To the next centimetre above: what is asked for is then enough.
std::string centimetres(double metres) {
  return text(std::ceil(metres * 100 - 1e-6) / 100);
}

Pattern choose_pattern(const Pile& pile, int count, const LayerOptions& options,
                       const Eigen::Vector2d& room) {
  Pattern pattern;
  pattern.spacing.rows = nominal_diameter(pile) / std::sqrt(2 * options.density);
  pattern.spacing.across = 2 * pattern.spacing.rows;
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
                     "they need " +
                         centimetres(pile.height + (pattern.columns - 0.5) * pattern.spacing.across) +
                         " m along the contour, and the ground (or the region given) has " +
                         centimetres(room.x()) + " m; make it wider");
  if (count > most_rows * pattern.columns)
    throw InputError(
        "count", std::to_string(count),
        "at most " + text(most_rows * pattern.columns) + ": " + text(most_rows) + " rows of " +
            std::to_string(pattern.columns),
        "the rows need " +
            centimetres(pile.height + (std::ceil(count / static_cast<double>(pattern.columns)) - 1) *
                                          pattern.spacing.rows) +
            " m up the slope, and the ground (or the region given) has " + centimetres(room.y()) +
            " m; make it longer, or lay more columns");
  return pattern;
}

// Lays rows from the toe, each unit one spacing above where the two below it have come to lie. Returns the density.
double lay_rows(Pile& pile, int count, const Pattern& pattern, const Vec3& first, Laying& laying,
                const Laying* before, LayerProgress& now) {
  const int lower = laying.lower_units();
  for (int i = 0; i < count; ++i) {
    const int row = i / pattern.columns, column = i % pattern.columns;
    const bool to_the_left = (row + now.layer) % 2 == 1;
    const double shift = to_the_left ? -0.25 : 0.25;
    Laying::Site site;
    site.unit = lower + i;
    double level = 0;
    for (const int beside : {0, to_the_left ? -1 : 1}) {
      if (column + beside < 0 || column + beside >= pattern.columns) {
        site.end = beside;
      } else if (row > 0) {
        site.below.push_back(site.unit - pattern.columns + beside);
        level += laying.place(site.below.back()).y();
      }
    }
    const double up =
        row == 0 ? first.y() : level / static_cast<double>(site.below.size()) + pattern.spacing.rows;
    site.place =
        Vec3(first.x() + (column - 0.5 * (pattern.columns - 1) + shift) * pattern.spacing.across, up, 0);
    const double behind = first.y() + row * pattern.spacing.rows - up;
    site.wanted = up + std::clamp(behind, -catch_up * pile.height, catch_up * pile.height);
    laying.lay(site, before);
    now.laid = site.unit + 1;
  }
  now.doing = "come to rest together";
  laying.rest_together(lower + pattern.columns);
  pile.poses.resize(lower);
  std::vector<double> rows; // m up the slope, means of full ones
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    pile.poses.push_back(laying.pose(lower + i));
    sum += laying.place(lower + i).y();
    if ((i + 1) % pattern.columns == 0) {
      rows.push_back(sum / pattern.columns);
      sum = 0;
    }
  }
  const double apart = rows.size() > 1 ? (rows.back() - rows.front()) / static_cast<double>(rows.size() - 1)
                                       : pattern.spacing.rows;
  const double dn = nominal_diameter(pile);
  return dn * dn / (pattern.spacing.across * apart);
}

// In the middle of the pile, away from its edges; none where it is too small to have one.
std::optional<PileMeasures> measured(const Pile& pile, const Ground& ground) {
  std::vector<Surface> units;
  units.reserve(pile.poses.size());
  for (const TetMesh& mesh : meshes(pile))
    units.push_back(surface_of(mesh));
  try {
    return measure_pile(units, ground.surface(), pile.height, volume(pile.unit));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Where a layer goes.
struct Site {
  const Ground& ground;
  Mat3 frame;           // of the slope
  double gap = 0;       // m
  Eigen::Vector2d room; // m, along the contour and up the slope
  Vec3 first;           // m, in the slope's axes: the middle of the lowest row
};

// A layer with its attitudes, and how far its density is off, as a part of the one asked for.
struct Candidate {
  std::unique_ptr<Laying> laying;
  double error = far;
  Pattern pattern;

  // Units that are not where they are to be.
  std::size_t faults(int count) const {
    const Laying::Rested& rested = laying->rested();
    return rested.still ? rested.leaning.size() + rested.put_back.size() : static_cast<std::size_t>(count);
  }
};

std::optional<Laying::Between> walls_of(const Pile& pile, const Pattern& pattern, const Site& site,
                                        const LayerOptions& options) {
  if (!options.walls)
    return std::nullopt;
  const double half =
      (0.5 * (pattern.columns - 1) + 0.25) * pattern.spacing.across + mean_half_width(pile.unit);
  return Laying::Between{site.first.x() - half, site.first.x() + half};
}

void reposition(Candidate& layer, LayerProgress& now) {
  now.doing = "repositioned";
  layer.laying->reposition_unsupported(layer.laying->lower_units() + layer.pattern.columns,
                                       [&](int left) { now.unsupported = left; });
}

// Units that lean on the row below stand closer than the pattern: its places along the contour are widened until the
// density is the one asked for.
Candidate lay_to_density(Pile& pile, int count, const Site& site, const LayerOptions& options,
                         LayerProgress& now, const std::function<void()>& poll) {
  Candidate best;
  double widening = 1;
  const Pattern as_asked = choose_pattern(pile, count, options, site.room);
  const double widest = std::clamp(
      (site.room.x() - pile.height) / ((as_asked.columns - 0.5) * as_asked.spacing.across), 1., 1.4);
  for (int i = 0; i < now.spacings && best.error > density_tolerance; ++i) {
    now.spacing = i + 1;
    now.laid = 0;
    now.unsupported = 0;
    now.doing = "laid";
    Pattern pattern = as_asked;
    pattern.spacing.across *= widening;
    auto laying = std::make_unique<Laying>(pile, site.ground, site.frame, site.gap, options, pattern.spacing,
                                           walls_of(pile, pattern, site, options), std::vector<Pose>(), poll);
    const double by_rows = lay_rows(pile, count, pattern, site.first, *laying, best.laying.get(), now);
    const auto middle = measured(pile, site.ground);
    const double density = middle ? middle->packing_density : by_rows;
    const double error = std::abs(density / options.density - 1) +
                         (laying->rested().still || options.nudges == 0 ? 0 : not_at_rest);
    if (error < best.error)
      best = {std::move(laying), error, pattern};
    widening = std::clamp(widening * density / options.density, 0.8, widest);
  }
  reposition(best, now);
  return best;
}

// With the spacing of the layer below, whose units do not move.
Candidate lay_over(Pile& pile, int count, const Pattern& pattern, const Site& site,
                   const LayerOptions& options, LayerProgress& now, const std::function<void()>& poll) {
  now.spacing = now.spacings = 1;
  now.unsupported = 0;
  now.doing = "laid";
  const std::vector<Pose> under(pile.poses);
  Candidate layer{std::make_unique<Laying>(pile, site.ground, site.frame, site.gap, options, pattern.spacing,
                                           walls_of(pile, pattern, site, options), under, poll),
                  0, pattern};
  lay_rows(pile, count, pattern, site.first, *layer.laying, nullptr, now);
  reposition(layer, now);
  return layer;
}

bool better(const Candidate& one, const Candidate& other, int count) {
  const std::size_t faults = one.faults(count), other_faults = other.faults(count);
  return faults < other_faults ? one.error <= std::max(density_tolerance, other.error)
                               : faults == other_faults && one.error < other.error;
}

} // namespace

Layer place_layer(const TetMesh& unit, int count, const Ground& ground, const LayerOptions& options) {
  check(options, count);
  require_one_part(unit);
  Layer layer;
  Pile& pile = layer.pile = pile_of(unit);
  const double gap = options.gap.value_or(usual_gap * pile.height);
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
  const Site site{ground, frame, gap, room.size().head<2>(),
                  Vec3(room.centre().x(), room.min.y() + bounding_radius(pile.unit), 0)};
  LayerProgress now;
  now.layers = options.layers;
  const auto poll = [&] {
    if (options.tell)
      options.tell(now);
  };
  layer.at_rest = true;
  Pattern pattern; // of the lowest layer, once it is laid
  for (int k = 0; k < options.layers; ++k) {
    now.layer = k + 1;
    const int own_count = count / options.layers + (k < count % options.layers ? 1 : 0);
    const std::vector<Pose> under = pile.poses;
    Candidate best;
    LayerOptions own = options;
    now.attempts = attempts_made(own_count, options);
    for (int i = 0; i < now.attempts && (i == 0 || best.faults(own_count) > 0); ++i) {
      now.attempt = i + 1;
      now.spacings = spacings_tried(own_count);
      pile.poses = under;
      Candidate one = k == 0 ? lay_to_density(pile, own_count, site, own, now, poll)
                             : lay_over(pile, own_count, pattern, site, own, now, poll);
      layer.attempts = std::max(layer.attempts, now.attempt);
      layer.trials += now.spacing;
      if (i == 0 || better(one, best, own_count))
        best = std::move(one);
      own.seed += next_seed;
    }
    if (k == 0)
      pattern = best.pattern;
    pile.poses = under;
    for (int i = 0; i < own_count; ++i)
      pile.poses.push_back(best.laying->pose(static_cast<int>(under.size()) + i));
    const Laying::Rested& rested = best.laying->rested();
    layer.at_rest = layer.at_rest && rested.still;
    layer.leaning.insert(layer.leaning.end(), rested.leaning.begin(), rested.leaning.end());
    layer.put_back.insert(layer.put_back.end(), rested.put_back.begin(), rested.put_back.end());
  }
  layer.measures = measured(pile, ground);
  if (layer.measures)
    layer.density = layer.measures->packing_density / options.layers;
  return layer;
}

} // namespace geom
