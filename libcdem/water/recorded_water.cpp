#include "libcdem/water/recorded_water.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double dry = -std::numeric_limits<double>::infinity();
constexpr int filled_layers = 3; // of grid points outside of the cells, from the cells on

void check_record(const WaterRecord& r) {
  geom::require_positive("density", r.density, "kg/m3");
  geom::require_positive("gravity", r.gravity, "m/s2");
  if (r.frames.empty() || r.frames.size() != r.times.size())
    throw geom::InputError("times", fmt::format("{} for {} files", r.times.size(), r.frames.size()),
                           "one time for each file, and at least one file");
  for (std::size_t i = 0; i < r.times.size(); ++i) {
    if (!std::isfinite(r.times[i]))
      throw geom::InputError(fmt::format("times[{}]", i + 1), fmt::format("{:g}", r.times[i]),
                             "a finite time (s)");
    if (i > 0 && !(r.times[i] > r.times[i - 1]))
      throw geom::InputError(fmt::format("times[{}]", i + 1), fmt::format("{:g}", r.times[i]),
                             fmt::format("later than the time before, {:g} s", r.times[i - 1]),
                             "files go in the order of their times");
  }
}

} // namespace

RecordedWater::RecordedWater(WaterRecord record) : record_(std::move(record)) {
  check_record(record_);
  with_pressure_ = !record_.frames[0].pressure.empty();
  const bool with_fraction = !record_.frames[0].fraction.empty();
  with_surface_ = with_fraction || record_.level;
  for (std::size_t frame = 0; frame < record_.frames.size(); ++frame) {
    fill_unknown(record_.frames[frame]);
    if (with_fraction)
      find_surface(frame);
    else
      surface_.emplace_back(columns(), record_.level.value_or(std::numeric_limits<double>::infinity()));
  }
  find_accelerations();
}

std::size_t RecordedWater::number(int i, int j, int k) const {
  return static_cast<std::size_t>(i) +
         static_cast<std::size_t>(record_.size[0]) *
             (static_cast<std::size_t>(j) +
              static_cast<std::size_t>(record_.size[1]) * static_cast<std::size_t>(k));
}

// The mean of known neighbours along the axes, a layer of points at a time; what is farther away stays at rest, and dry.
void RecordedWater::fill_unknown(WaterFrame& f) const {
  if (f.known.empty())
    return;
  const auto& n = record_.size;
  for (int layer = 0; layer < filled_layers; ++layer) {
    const std::vector<char> known = f.known;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const std::size_t here = number(i, j, k);
          if (known[here])
            continue;
          int count = 0;
          geom::Vec3 velocity = geom::Vec3::Zero();
          double pressure = 0, fraction = 0;
          for (const auto& [a, b, c] : {std::array<int, 3>{i - 1, j, k},
                                        {i + 1, j, k},
                                        {i, j - 1, k},
                                        {i, j + 1, k},
                                        {i, j, k - 1},
                                        {i, j, k + 1}}) {
            if (a < 0 || b < 0 || c < 0 || a >= n[0] || b >= n[1] || c >= n[2] || !known[number(a, b, c)])
              continue;
            const std::size_t next = number(a, b, c);
            ++count;
            velocity += f.velocity[next];
            pressure += f.pressure.empty() ? 0 : f.pressure[next];
            fraction += f.fraction.empty() ? 0 : f.fraction[next];
          }
          if (count == 0)
            continue;
          f.known[here] = 1;
          f.velocity[here] = velocity / count;
          if (!f.pressure.empty())
            f.pressure[here] = pressure / count;
          if (!f.fraction.empty())
            f.fraction[here] = fraction / count;
        }
  }
}

// And what goes on above it.
void RecordedWater::find_surface(std::size_t frame) {
  WaterFrame& f = record_.frames[frame];
  const auto& n = record_.size;
  std::vector<double>& surface = surface_.emplace_back(columns(), dry);
  for (int j = 0; j < n[1]; ++j)
    for (int i = 0; i < n[0]; ++i) {
      int top = n[2] - 1; // the highest point in water
      while (top >= 0 && !(f.fraction[number(i, j, top)] >= 0.5))
        --top;
      if (top < 0)
        continue;
      const double below = f.fraction[number(i, j, top)];
      double z = record_.origin.z() + top * record_.spacing.z();
      if (top + 1 < n[2])
        z += (below - 0.5) / (below - f.fraction[number(i, j, top + 1)]) * record_.spacing.z();
      surface[number(i, j, 0)] = z;
      for (int k = top + 1; k < n[2]; ++k) {
        f.velocity[number(i, j, k)] = f.velocity[number(i, j, top)];
        if (with_pressure_)
          f.pressure[number(i, j, k)] =
              record_.density * record_.gravity * (z - record_.origin.z() - k * record_.spacing.z());
      }
    }
}

void RecordedWater::find_accelerations() {
  const auto& n = record_.size;
  const std::size_t frames = record_.frames.size();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const std::size_t before = frame == 0 ? 0 : frame - 1, after = std::min(frame + 1, frames - 1);
    const std::vector<geom::Vec3>& u = record_.frames[frame].velocity;
    std::vector<geom::Vec3>& a = acceleration_.emplace_back(u.size(), geom::Vec3::Zero());
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const std::size_t here = number(i, j, k);
          if (after > before)
            a[here] = (record_.frames[after].velocity[here] - record_.frames[before].velocity[here]) /
                      (record_.times[after] - record_.times[before]);
          const std::array<int, 3> at{i, j, k};
          for (int axis = 0; axis < 3; ++axis) {
            std::array<int, 3> low = at, high = at;
            low[axis] = std::max(0, at[axis] - 1);
            high[axis] = std::min(n[axis] - 1, at[axis] + 1);
            if (high[axis] > low[axis])
              a[here] += u[here][axis] / ((high[axis] - low[axis]) * record_.spacing[axis]) *
                         (u[number(high[0], high[1], high[2])] - u[number(low[0], low[1], low[2])]);
          }
        }
  }
}

geom::Box RecordedWater::box() const {
  geom::Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const bool one = record_.size[axis] == 1;
    const double inf = std::numeric_limits<double>::infinity();
    box.min[axis] = one ? -inf : record_.origin[axis];
    box.max[axis] = one ? inf : record_.origin[axis] + (record_.size[axis] - 1) * record_.spacing[axis];
  }
  return box;
}

void RecordedWater::require_known(const geom::Vec3& place, double time) const {
  const geom::Box known = box();
  const geom::Vec3 slack = 1e-6 * record_.spacing;
  const bool beside = (place.head<2>().array() < (known.min - slack).head<2>().array()).any() ||
                      (place.head<2>().array() > (known.max + slack).head<2>().array()).any();
  if (beside || place.z() < known.min.z() - slack.z() || !place.allFinite())
    throw geom::InputError(fmt::format(
        "water of files at {} m: it is known from {} to {} m; shift the files or the model, or write a "
        "larger box",
        geom::place_text(place), geom::place_text(known.min), geom::place_text(known.max)));
  const std::vector<double>& t = record_.times;
  const double rounding = 1e-9 * (std::abs(t.front()) + std::abs(t.back()));
  if (t.size() > 1 && !(time >= t.front() - rounding && time <= t.back() + rounding))
    throw geom::InputError(
        fmt::format("water of files at {:g} s: it is known from {:g} to {:g} s; write more times, or "
                    "shift them",
                    time, t.front(), t.back()));
}

std::array<RecordedWater::Corner, 8> RecordedWater::corners(const geom::Vec3& place) const {
  std::array<int, 3> low{}, high{};
  geom::Vec3 part = geom::Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (record_.size[axis] == 1)
      continue;
    const double at = std::clamp((place[axis] - record_.origin[axis]) / record_.spacing[axis], 0.0,
                                 static_cast<double>(record_.size[axis] - 1));
    low[axis] = std::min(static_cast<int>(at), record_.size[axis] - 2);
    high[axis] = low[axis] + 1;
    part[axis] = at - low[axis];
  }
  std::array<Corner, 8> all;
  for (int c = 0; c < 8; ++c) {
    std::array<int, 3> at{};
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = (c >> axis) & 1;
      at[axis] = upper ? high[axis] : low[axis];
      share *= upper ? part[axis] : 1 - part[axis];
    }
    all[c] = {number(at[0], at[1], at[2]), number(at[0], at[1], 0), share};
  }
  return all;
}

RecordedWater::Here RecordedWater::in_frame(std::size_t frame, const geom::Vec3& place) const {
  const WaterFrame& f = record_.frames[frame];
  // The surface first: between wet columns, as far as the nearest column is wet.
  Here here;
  double wet = 0, most = -1;
  bool nearest_is_wet = false;
  double surface = 0;
  const std::array<Corner, 8> over_bed = corners({place.x(), place.y(), record_.origin.z()});
  for (const Corner& c : over_bed) {
    const double z = surface_[frame][c.column];
    if (c.share > most) {
      most = c.share;
      nearest_is_wet = z > dry;
    }
    if (z > dry && c.share > 0) {
      surface += c.share * z;
      wet += c.share;
    }
  }
  here.surface = nearest_is_wet ? surface / wet : dry;
  if (!nearest_is_wet)
    return here;
  geom::Vec3 x = place;
  x.z() = std::min(x.z(), here.surface);
  for (const Corner& c : corners(x)) {
    here.velocity += c.share * f.velocity[c.point];
    here.acceleration += c.share * acceleration_[frame][c.point];
    if (with_pressure_)
      here.pressure += c.share * f.pressure[c.point];
  }
  return here;
}

WaterPoint RecordedWater::at(const geom::Vec3& place, double time) const {
  require_known(place, time);
  const std::vector<double>& t = record_.times;
  const auto next = std::upper_bound(t.begin() + 1, t.end() - (t.size() > 1 ? 1 : 0), time);
  const std::size_t second = t.size() > 1 ? static_cast<std::size_t>(next - t.begin()) : 0;
  const std::size_t first = second > 0 ? second - 1 : 0;
  const double part = second > first ? std::clamp((time - t[first]) / (t[second] - t[first]), 0.0, 1.0) : 0.0;
  Here a = in_frame(first, place), b = second > first ? in_frame(second, place) : a;
  if (!(a.surface > dry)) // one of them is dry: the nearer in time
    a.surface = part < 0.5 ? dry : b.surface;
  if (!(b.surface > dry))
    b.surface = part < 0.5 ? a.surface : dry;
  WaterPoint point;
  point.surface = std::isfinite(a.surface) && std::isfinite(b.surface)
                      ? a.surface + part * (b.surface - a.surface)
                      : (part < 0.5 ? a.surface : b.surface);
  if (!(point.surface > dry))
    return point;
  point.velocity = a.velocity + part * (b.velocity - a.velocity);
  point.acceleration = a.acceleration + part * (b.acceleration - a.acceleration);
  if (place.z() <= point.surface) {
    if (with_pressure_)
      point.pressure = a.pressure + part * (b.pressure - a.pressure);
    else if (with_surface_)
      point.pressure = record_.density * record_.gravity * (point.surface - place.z());
  }
  return point;
}

} // namespace cdem
