#include "libcdem/water/slope_water.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double most_kept = 1.2e8; // cells times frames, 2 GB
constexpr double wet_depth = 1e-3;  // of still water: thinner films neither load nor count as run-up

double bed_at(const std::vector<std::array<double, 2>>& bed, double x) {
  std::size_t i = 1;
  while (i + 1 < bed.size() && x > bed[i][0])
    ++i;
  const double part = (x - bed[i - 1][0]) / (bed[i][0] - bed[i - 1][0]);
  return bed[i - 1][1] + part * (bed[i][1] - bed[i - 1][1]);
}

// The nearest cell with more than a film of water, for each cell; the one towards the sea of two. None: the number of cells.
std::vector<std::size_t> nearest_wet(const ShallowWater& water) {
  const std::size_t n = water.h.size();
  const double film = wet_depth * water.still_depth;
  std::vector<std::size_t> nearest(n);
  std::size_t before = n, after = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (water.h[i] > film)
      before = i;
    nearest[i] = before;
  }
  for (std::size_t i = n; i-- > 0;) {
    if (water.h[i] > film)
      after = i;
    if (after < n && (nearest[i] == n || after - i < i - nearest[i]))
      nearest[i] = after;
  }
  return nearest;
}

// Between frames, s: the time that a long wave takes over a cell at the foot, whatever the duration. So the frames follow
// the scale of the problem.
double frame_of(const SlopeGiven& g) {
  return g.cell / std::sqrt(g.gravity * (g.level - g.bed[0][1]));
}

void check_slope(const SlopeGiven& g) {
  geom::require_positive("duration", g.duration, "s");
  geom::require_positive("cell", g.cell);
  geom::require_positive("density", g.density, "kg/m3");
  geom::require_positive("gravity", g.gravity, "m/s2");
  geom::require_between("friction", g.friction, 0, 10);
  if (g.bed.size() < 2)
    throw geom::InputError("bed", fmt::format("{} points", g.bed.size()), "at least two points {x, z} (m)");
  for (std::size_t i = 1; i < g.bed.size(); ++i)
    if (!(g.bed[i][0] > g.bed[i - 1][0]))
      throw geom::InputError(fmt::format("bed[{}]", i + 1), fmt::format("{:g}", g.bed[i][0]),
                             fmt::format("beyond the x of the point before, {:g} m", g.bed[i - 1][0]),
                             "points go from the sea up the slope");
  if (const double depth = g.level - g.bed[0][1]; !(depth > 0))
    throw geom::InputError("bed[1]", fmt::format("{:g}", g.bed[0][1]),
                           fmt::format("below the level of still water, {:g} m", g.level),
                           fmt::format("the depth there would be {:g} m", depth));
  const double cells = (g.bed.back()[0] - g.bed[0][0]) / g.cell;
  if (!(cells >= 10 && cells <= 20000))
    throw geom::InputError(
        "cell", fmt::format("{:g}", g.cell),
        fmt::format("one that gives 10 to 20000 cells over {:g} m", g.bed.back()[0] - g.bed[0][0]));
  if (const double longest = most_kept / cells * frame_of(g); g.duration > longest)
    throw geom::InputError("duration", fmt::format("{:g}", g.duration),
                           fmt::format("at most {:.3g} s with this cell", longest),
                           "the solution would take more than 2 GB; a cell twice as large takes a quarter");
  if (!(geom::Vec3(g.direction.x(), g.direction.y(), 0).norm() > 0))
    throw geom::InputError("direction", geom::text(g.direction), "a vector with a horizontal part");
}

} // namespace

SlopeWater::SlopeWater(const SlopeGiven& given) : given_(given) {
  check_slope(given_);
  frame_ = frame_of(given_);
  along_ = geom::Vec3(given_.direction.x(), given_.direction.y(), 0).normalized();
  const auto n =
      static_cast<std::size_t>(std::ceil((given_.bed.back()[0] - given_.bed[0][0]) / given_.cell - 1e-9));
  ShallowWater water;
  water.cell = given_.cell;
  water.gravity = given_.gravity;
  water.friction = given_.friction;
  if (given_.entering) // the last frame lies beyond the duration, where the waves may be unknown
    water.entering = [this](double time) { return given_.entering(std::min(time, given_.duration)); };
  for (std::size_t i = 0; i < n; ++i) {
    bed_.push_back(bed_at(given_.bed, given_.bed[0][0] + (static_cast<double>(i) + 0.5) * given_.cell));
    water.bed.push_back(bed_.back());
    water.h.push_back(std::max(0.0, given_.level - bed_.back()));
    water.q.push_back(0);
  }
  water.still_depth = water.h[0];
  run_up_ = run_down_ = given_.level;
  compute(water);
  given_.entering = nullptr;
}

void SlopeWater::compute(ShallowWater& water) {
  const int frames = static_cast<int>(std::ceil(given_.duration / frame_));
  keep(water);
  for (int i = 0; i < frames; ++i) {
    double left = frame_;
    while (left > 1e-12 * frame_) {
      double dt = water.longest_step();
      dt = dt >= left ? left : std::min(dt, 0.5 * left);
      water.step((i + 1) * frame_ - left, dt);
      left -= dt;
    }
    keep(water);
  }
}

void SlopeWater::keep(const ShallowWater& water) {
  const std::vector<std::size_t> nearest = nearest_wet(water);
  std::vector<double>&surface = surface_.emplace_back(), &u = u_.emplace_back();
  double line = -std::numeric_limits<double>::infinity();
  bool joined = true; // to the sea
  for (std::size_t i = 0; i < bed_.size(); ++i) {
    const std::size_t wet = nearest[i];
    // All is dry: as low as the foot.
    const double there = wet < bed_.size() ? bed_[wet] + water.h[wet] : bed_[0];
    surface.push_back(std::min(bed_[i] + water.h[i], there));
    u.push_back(wet < bed_.size() ? water.velocity(wet) : 0);
    joined = joined && wet == i;
    if (joined)
      line = surface[i];
  }
  run_up_ = std::max(run_up_, line);
  run_down_ = std::min(run_down_, line);
}

SlopeWater::Column SlopeWater::column(std::size_t frame, double s) const {
  const double at =
      std::clamp((s - given_.bed[0][0]) / given_.cell - 0.5, 0.0, static_cast<double>(bed_.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(at), bed_.size() - 2);
  const double part = at - static_cast<double>(i);
  const auto here = [&](const std::vector<double>& of) { return of[i] + part * (of[i + 1] - of[i]); };
  return {here(surface_[frame]), here(bed_), here(u_[frame])};
}

SlopeWater::Where SlopeWater::where(const geom::Vec3& place, double time) const {
  if (!(time >= 0 && time <= given_.duration * (1 + 1e-9)))
    throw geom::InputError(
        fmt::format("water on the slope at {:g} s: it is known from 0 to {:g} s; give a longer "
                    "duration",
                    time, given_.duration));
  const double s = (place - given_.origin).dot(along_);
  const std::vector<std::array<double, 2>>& line = given_.bed;
  if (!(s >= line.front()[0] - 1e-6 * given_.cell && s <= line.back()[0] + 1e-6 * given_.cell))
    throw geom::InputError(fmt::format(
        "water on the slope at {}, {:g} m along its bed: it is known from {:g} to {:g} m; let the bed go "
        "on beyond the bodies",
        geom::place_text(place), s, line.front()[0], line.back()[0]));
  const double at = time / frame_;
  const std::size_t i = std::min(static_cast<std::size_t>(at), surface_.size() - 2);
  return {s, i, std::min(1.0, at - static_cast<double>(i))};
}

bool SlopeWater::is_dry(const geom::Vec3& place, double time) const {
  const auto [s, i, part] = where(place, time);
  const Column a = column(i, s), b = column(i + 1, s);
  return a.surface + part * (b.surface - a.surface) <= a.bed;
}

WaterPoint SlopeWater::at(const geom::Vec3& place, double time) const {
  const auto [s, i, part] = where(place, time);
  const auto mix = [part = part](double a, double b) { return a + part * (b - a); };
  const double g = given_.gravity;
  const Column a = column(i, s), b = column(i + 1, s);
  WaterPoint point;
  const double surface = mix(a.surface, b.surface), bed = a.bed;
  point.surface = surface;
  point.pressure = std::max(0.0, given_.density * g * (surface - place.z()));
  const double u = mix(a.u, b.u);
  // Slopes of bed and surface, rates, over a cell to both sides.
  const double d = given_.cell;
  const Column al = column(i, s - d), ar = column(i, s + d), bl = column(i + 1, s - d),
               br = column(i + 1, s + d);
  const double bed_slope = (ar.bed - al.bed) / (2 * d);
  double w_top = u * bed_slope, along = 0, surface_slope = 0;
  if (a.wet() && b.wet() && al.wet() && ar.wet() && bl.wet() && br.wet()) {
    surface_slope = (mix(ar.surface, br.surface) - mix(al.surface, bl.surface)) / (2 * d);
    w_top = (b.surface - a.surface) / frame_ + u * surface_slope;
    along = (b.u - a.u) / frame_ + u * (mix(ar.u, br.u) - mix(al.u, bl.u)) / (2 * d);
  }
  point.surface_slope = surface_slope * along_;
  point.pressure_gradient = given_.density * g * (point.surface_slope - geom::Vec3::UnitZ());
  const double height = std::clamp(surface > bed ? (place.z() - bed) / (surface - bed) : 0.0, 0.0, 1.0);
  point.velocity = u * along_ + (u * bed_slope + height * (w_top - u * bed_slope)) * geom::Vec3::UnitZ();
  point.acceleration = along * (along_ + bed_slope * (1 - height) * geom::Vec3::UnitZ());
  return point;
}

} // namespace cdem
