#include "libcdem/water/recorded_water.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/place_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double on_bed = -std::numeric_limits<double>::infinity(); // bottom of a layer
constexpr int filled_layers = 3; // of grid points outside of the cells, from the cells on
constexpr double no_air = 1e-9;  // share of air where water has its water fraction

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
  water_up_to_ = with_fraction ? on_bed : record_.level.value_or(std::numeric_limits<double>::infinity());
  for (WaterFrame& frame : record_.frames) {
    const std::vector<char> known = frame.known;
    fill_unknown(frame);
    const double level = record_.level.value_or(std::numeric_limits<double>::infinity());
    std::vector<Layers>& layers = layers_.emplace_back(columns(), Layers{{on_bed, level}});
    if (!with_fraction)
      continue;
    for (int j = 0; j < record_.size[1]; ++j)
      for (int i = 0; i < record_.size[0]; ++i)
        layers[number(i, j, 0)] = find_layers(frame, known, i, j);
    continue_over_dry(frame, known, layers);
  }
  find_accelerations();
}

std::size_t RecordedWater::number(int i, int j, int k) const {
  return static_cast<std::size_t>(i) +
         static_cast<std::size_t>(record_.size[0]) *
             (static_cast<std::size_t>(j) +
              static_cast<std::size_t>(record_.size[1]) * static_cast<std::size_t>(k));
}

// The mean of known neighbours along the axes, a layer of points at a time; what is farther away stays at rest, and dry. Water
// counts and air does not. The pressure of a neighbour is brought to the height of the point first, so that still water stays
// what it is beside a bed.
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
          double pressure = 0, fraction = 0, shares = 0;
          for (const auto& [a, b, c] : {std::array<int, 3>{i - 1, j, k},
                                        {i + 1, j, k},
                                        {i, j - 1, k},
                                        {i, j + 1, k},
                                        {i, j, k - 1},
                                        {i, j, k + 1}}) {
            if (a < 0 || b < 0 || c < 0 || a >= n[0] || b >= n[1] || c >= n[2] || !known[number(a, b, c)])
              continue;
            const std::size_t next = number(a, b, c);
            const double share = f.fraction.empty() ? 1 : std::max(no_air, f.fraction[next]);
            ++count;
            shares += share;
            velocity += share * f.velocity[next];
            if (!f.pressure.empty())
              pressure += share * (f.pressure[next] + weight() * (c - k) * record_.spacing.z());
            fraction += f.fraction.empty() ? 0 : f.fraction[next];
          }
          if (count == 0)
            continue;
          f.known[here] = 1;
          f.velocity[here] = velocity / shares;
          if (!f.pressure.empty())
            f.pressure[here] = pressure / shares;
          if (!f.fraction.empty())
            f.fraction[here] = fraction / count;
        }
  }
}

// From the water fraction; and what goes on above each layer, and a point below one that hangs in the air. Water that
// fill_unknown alone has put into the ground is no layer; known: before it.
RecordedWater::Layers RecordedWater::find_layers(WaterFrame& f, const std::vector<char>& known, int i,
                                                 int j) const {
  const int points = record_.size[2];
  const double step = record_.spacing.z();
  const auto at = [&](int k) { return number(i, j, k); };
  const auto wet = [&](int k) { return f.fraction[at(k)] >= 0.5; };
  const auto is_known = [&](int k) { return known.empty() || known[at(k)]; };
  const auto in_air = [&](int k) { return k >= 0 && k < points && !wet(k) && is_known(k); };
  const auto height = [&](int k) { return record_.origin.z() + k * step; };
  // From the wet point k to the dry one beside it, in steps.
  const auto crossing = [&](int k, int beside) {
    const double here = f.fraction[at(k)];
    return (here - 0.5) / (here - f.fraction[at(beside)]);
  };
  Layers layers;
  for (int k = 0; k < points; ++k) {
    if (!wet(k))
      continue;
    const int first = k;
    bool in_ground = !is_known(k);
    for (; k + 1 < points && wet(k + 1); ++k)
      in_ground = in_ground && !is_known(k + 1);
    if (in_ground)
      continue;
    layers.push_back({in_air(first - 1) ? height(first) - crossing(first, first - 1) * step : on_bed,
                      height(k) + (k + 1 < points ? crossing(k, k + 1) * step : 0)});
    if (in_air(first - 1) && (first < 2 || !wet(first - 2))) {
      f.velocity[at(first - 1)] = f.velocity[at(first)];
      if (with_pressure_)
        f.pressure[at(first - 1)] = 0;
    }
    for (int above = k + 1; above < points && !wet(above); ++above) {
      f.velocity[at(above)] = f.velocity[at(k)];
      if (with_pressure_)
        f.pressure[at(above)] = weight() * (layers.back().top - height(above));
    }
  }
  return layers;
}

// The surface of the nearest column that has water on its bed, no higher than the bed; the velocity goes on with it, and the
// pressure is hydrostatic.
void RecordedWater::continue_over_dry(WaterFrame& f, const std::vector<char>& known,
                                      std::vector<Layers>& layers) const {
  const auto& n = record_.size;
  const double lowest = record_.origin.z(), step = record_.spacing.z();
  const auto bed_of = [&](std::size_t column) {
    int k = 0;
    while (k < n[2] && !known.empty() && !known[column + k * columns()])
      ++k;
    return k < n[2] ? lowest + k * step : std::numeric_limits<double>::infinity();
  };
  const auto go_on = [&](std::size_t column, std::size_t from) {
    const double top = std::min(layers[from].front().top, bed_of(column));
    const double up_to = layers[column].empty() ? -on_bed : layers[column].front().bottom - step;
    layers[column].insert(layers[column].begin(), {on_bed, top, true});
    for (int k = 0; k < n[2] && lowest + k * step < up_to; ++k) {
      f.velocity[column + k * columns()] = f.velocity[from + k * columns()];
      if (with_pressure_)
        f.pressure[column + k * columns()] = weight() * (top - (lowest + k * step));
    }
  };
  std::vector<std::size_t> source(columns(), columns()), reached; // reached: from the water outwards
  for (std::size_t column = 0; column < columns(); ++column)
    if (!layers[column].empty() && layers[column].front().bottom == on_bed) {
      source[column] = column;
      reached.push_back(column);
    }
  if (reached.empty())
    for (Layers& column : layers)
      column.insert(column.begin(), {on_bed, lowest, true});
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::size_t here = reached[next];
    const int i = static_cast<int>(here) % n[0], j = static_cast<int>(here) / n[0];
    for (const auto& [a, b] :
         {std::pair(i - 1, j), std::pair(i + 1, j), std::pair(i, j - 1), std::pair(i, j + 1)}) {
      if (a < 0 || b < 0 || a >= n[0] || b >= n[1] || source[number(a, b, 0)] != columns())
        continue;
      const std::size_t beside = number(a, b, 0);
      source[beside] = source[here];
      go_on(beside, source[here]);
      reached.push_back(beside);
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

std::optional<RecordedWater::AtTop> RecordedWater::reaches_top() const {
  const int last = record_.size[2] - 1;
  if (last == 0 || record_.frames[0].fraction.empty())
    return {};
  const double top = record_.origin.z() + last * record_.spacing.z();
  for (std::size_t frame = 0; frame < layers_.size(); ++frame)
    for (std::size_t column = 0; column < columns(); ++column)
      if (const Layer& layer = layers_[frame][column].back(); !layer.dry && layer.top >= top) {
        const std::size_t i = column % record_.size[0];
        const std::size_t j = column / record_.size[0];
        return AtTop{record_.times[frame],
                     {record_.origin.x() + static_cast<double>(i) * record_.spacing.x(),
                      record_.origin.y() + static_cast<double>(j) * record_.spacing.y(), top}};
      }
  return {};
}

void RecordedWater::require_known(const geom::Vec3& place, double time) const {
  const geom::Box known = box();
  const geom::Vec3 slack = 1e-6 * record_.spacing;
  const bool beside = (place.head<2>().array() < (known.min - slack).head<2>().array()).any() ||
                      (place.head<2>().array() > (known.max + slack).head<2>().array()).any();
  const bool above = place.z() > known.max.z() + slack.z() && place.z() <= water_up_to_;
  if (beside || above || place.z() < known.min.z() - slack.z() || !place.allFinite())
    throw geom::InputError(fmt::format(
        "water of files at {}: it is known from {} to {}; shift the files or the model, or write a "
        "larger box{}",
        geom::place_text(place), geom::place_text(known.min), geom::place_text(known.max),
        above && !with_surface_ ? ", or give the level or the water fraction, which say where it ends" : ""));
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
    geom::Vec3 share, rise = geom::Vec3::Zero(); // of the corner along each axis; 1/m
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = (c >> axis) & 1;
      at[axis] = upper ? high[axis] : low[axis];
      share[axis] = upper ? part[axis] : 1 - part[axis];
      if (record_.size[axis] > 1)
        rise[axis] = (upper ? 1 : -1) / record_.spacing[axis];
    }
    all[c] = {number(at[0], at[1], at[2]), number(at[0], at[1], 0), share.prod(),
              geom::Vec3(rise[0] * share[1] * share[2], share[0] * rise[1] * share[2],
                         share[0] * share[1] * rise[2])};
  }
  return all;
}

RecordedWater::Here RecordedWater::in_frame(std::size_t frame, const geom::Vec3& place) const {
  const WaterFrame& f = record_.frames[frame];
  // The layer first: that of the nearest column, between it and those of other columns that meet it.
  Here here;
  const std::array<Corner, 8> over_bed = corners({place.x(), place.y(), record_.origin.z()});
  const Corner& nearest = *std::max_element(
      over_bed.begin(), over_bed.end(), [](const Corner& a, const Corner& b) { return a.share < b.share; });
  for (const Layer& layer : layers_[frame][nearest.column])
    if (layer.bottom <= place.z())
      here.layer = layer;
  double wet = 0, surface = 0;
  geom::Vec3 wet_gradient = geom::Vec3::Zero(), surface_gradient = geom::Vec3::Zero();
  for (const Corner& c : over_bed) {
    const Layers& layers = layers_[frame][c.column];
    const auto layer = std::find_if(layers.rbegin(), layers.rend(),
                                    [&](const Layer& other) { return other.meets(here.layer); });
    if (layer == layers.rend())
      continue;
    wet += c.share;
    surface += c.share * layer->top;
    wet_gradient += c.share_gradient;
    surface_gradient += c.share_gradient * layer->top;
  }
  WaterPoint& water = here.water;
  if (std::isfinite(here.layer.top)) {
    here.layer.top = surface / wet;
    water.surface_slope = (surface_gradient - here.layer.top * wet_gradient) / wet;
    water.surface_slope.z() = 0;
  }
  geom::Vec3 x = place;
  x.z() = std::min(x.z(), here.layer.top);
  for (const Corner& c : corners(x)) {
    water.velocity += c.share * f.velocity[c.point];
    water.acceleration += c.share * acceleration_[frame][c.point];
    if (with_pressure_) {
      water.pressure += c.share * f.pressure[c.point];
      water.pressure_gradient += c.share_gradient * f.pressure[c.point];
    }
  }
  return here;
}

RecordedWater::Moment RecordedWater::moment(double time) const {
  const std::vector<double>& t = record_.times;
  const auto next = std::upper_bound(t.begin() + 1, t.end() - (t.size() > 1 ? 1 : 0), time);
  const std::size_t second = t.size() > 1 ? static_cast<std::size_t>(next - t.begin()) : 0;
  const std::size_t first = second > 0 ? second - 1 : 0;
  return {first, second,
          second > first ? std::clamp((time - t[first]) / (t[second] - t[first]), 0.0, 1.0) : 0};
}

bool RecordedWater::is_dry(const geom::Vec3& place, double time) const {
  require_known(place, time);
  const Moment now = moment(time);
  return in_frame(now.part < 0.5 ? now.first : now.second, place).layer.dry;
}

WaterPoint RecordedWater::at(const geom::Vec3& place, double time) const {
  require_known(place, time);
  auto [first, second, part] = moment(time);
  Here a = in_frame(first, place), b = second > first ? in_frame(second, place) : a;
  if (!a.layer.meets(b.layer)) { // one of them has another layer: the nearer in time
    a = part < 0.5 ? a : b;
    b = a;
    part = 0;
  }
  WaterPoint point;
  const auto mix = [part = part](const auto& early, const auto& late) {
    return std::decay_t<decltype(early)>(early + part * (late - early));
  };
  point.surface = std::isfinite(a.layer.top) ? mix(a.layer.top, b.layer.top) : a.layer.top;
  point.velocity = mix(a.water.velocity, b.water.velocity);
  point.acceleration = mix(a.water.acceleration, b.water.acceleration);
  point.surface_slope = mix(a.water.surface_slope, b.water.surface_slope);
  if (with_pressure_)
    point.pressure_gradient = mix(a.water.pressure_gradient, b.water.pressure_gradient);
  else if (with_surface_)
    point.pressure_gradient = weight() * (point.surface_slope - geom::Vec3::UnitZ());
  if (place.z() <= point.surface)
    point.pressure = with_pressure_  ? mix(a.water.pressure, b.water.pressure)
                     : with_surface_ ? weight() * (point.surface - place.z())
                                     : 0;
  return point;
}

} // namespace cdem
