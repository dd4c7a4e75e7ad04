#include "libcdem/results/free_surface.hpp"

#include "libcdem/load/water_table.hpp"
#include "libcdem/water/plain_water.hpp"
#include "libcdem/water/water_over_bed.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cdem {
namespace {

using geom::Vec3;

constexpr int cells_along = 120;     // the longer side of the rectangle
constexpr int net_stride = 10;       // cells between lines that are drawn
constexpr int halvings = 30;         // of the edge that the water line crosses
constexpr int arrows_along = 16;     // the longer side
constexpr int arrows_over_depth = 8; // in a section, over the height of the box

// With a surface at nan where the field is not known: files have a box and times, which may be smaller than those of the model.
WaterPoint asked(const WaterField& water, const Vec3& place, double time) {
  try {
    return seen_at(water, place, time);
  } catch (const geom::InputError&) {
    WaterPoint unknown;
    unknown.surface = std::nan("");
    return unknown;
  }
}

class SheetOfField {
public:
  SheetOfField(const WaterField& water, double time, const geom::Box& box)
      : water_(water), time_(time), top_(box.max.z()) {
    const Vec3 size = box.size();
    const double cell = std::max({size.x(), size.y(), 1e-6 * size.norm()}) / cells_along;
    for (int axis = 0; axis < 2; ++axis) {
      const int cells = std::max(1, static_cast<int>(std::ceil(size[axis] / cell - 1e-9)));
      sheet_.origin[axis] = box.min[axis];
      sheet_.cell[axis] = std::max(size[axis], cell) / cells;
      sheet_.size[axis] = cells + 1;
    }
  }

  WaterSheet make() {
    sample();
    if (sheet_.points.empty())
      return dry_ ? std::move(sheet_) : WaterSheet();
    for (int j = 0; j + 1 < sheet_.size[1]; ++j)
      for (int i = 0; i + 1 < sheet_.size[0]; ++i) {
        triangle({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
        triangle({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
      }
    for (int j = 0; j < sheet_.size[1]; ++j)
      for (int i = 0; i < sheet_.size[0]; ++i) {
        if (i + 1 < sheet_.size[0] && drawn_line(j, sheet_.size[1]))
          net_line(number(i, j), number(i + 1, j));
        if (j + 1 < sheet_.size[1] && drawn_line(i, sheet_.size[0]))
          net_line(number(i, j), number(i, j + 1));
      }
    return std::move(sheet_);
  }

private:
  int number(int i, int j) const { return i + j * sheet_.size[0]; }
  bool wet(int grid) const { return point_[grid] >= 0; }
  static bool drawn_line(int line, int lines) { return line % net_stride == 0 || line + 1 == lines; }
  Vec3 place(int grid) const {
    const int row = grid / sheet_.size[0], column = grid % sheet_.size[0];
    return {sheet_.origin[0] + column * sheet_.cell[0], sheet_.origin[1] + row * sheet_.cell[1], top_};
  }
  int add(const Vec3& x, const WaterPoint& water) {
    const Vec3& surface = sheet_.points.emplace_back(x.x(), x.y(), water.surface);
    // Over a model that lies below the surface, the field was asked deeper.
    const bool deeper = x.z() < water.surface;
    sheet_.velocity.push_back(deeper ? asked(water_, surface, time_).velocity : water.velocity);
    return static_cast<int>(sheet_.points.size()) - 1;
  }

  void sample() {
    const int n = sheet_.size[0] * sheet_.size[1];
    point_.assign(n, -1);
    unknown_.assign(n, false);
    sheet_.height.assign(n, std::nan(""));
    for (int grid = 0; grid < n; ++grid)
      if (const WaterPoint water = asked(water_, place(grid), time_); std::isfinite(water.surface)) {
        point_[grid] = add(place(grid), water);
        sheet_.height[grid] = water.surface;
      } else {
        unknown_[grid] = std::isnan(water.surface);
        dry_ = dry_ || unknown_[grid] || water.surface < 0;
      }
  }

  // The last wet point of the edge from a wet to a dry point of the grid.
  int shore(int from, int to) {
    const auto [known, is_new] = shore_.try_emplace({from, to}, -1);
    if (!is_new)
      return known->second;
    Vec3 in = place(from), out = place(to);
    WaterPoint last = asked(water_, in, time_);
    for (int i = 0; i < halvings; ++i) {
      const Vec3 middle = 0.5 * (in + out);
      const WaterPoint water = asked(water_, middle, time_);
      const bool is_wet = std::isfinite(water.surface);
      (is_wet ? in : out) = middle;
      if (is_wet)
        last = water;
    }
    return known->second = add(in, last);
  }

  void triangle(const std::array<int, 3>& grid) {
    std::vector<int> around, ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = grid[k], b = grid[(k + 1) % 3];
      if (wet(a))
        around.push_back(point_[a]);
      if (wet(a) != wet(b))
        around.push_back(ends.emplace_back(wet(a) ? shore(a, b) : shore(b, a)));
    }
    // The edge of what is known is no water line.
    if (ends.size() == 2 && std::none_of(grid.begin(), grid.end(), [&](int g) { return unknown_[g]; }))
      sheet_.shore.push_back({ends[0], ends[1]});
    for (std::size_t i = 2; i < around.size(); ++i)
      sheet_.triangles.push_back({around[0], around[i - 1], around[i]});
  }

  void net_line(int a, int b) {
    if (wet(a) && wet(b))
      sheet_.net.push_back({point_[a], point_[b]});
    else if (wet(a))
      sheet_.net.push_back({point_[a], shore(a, b)});
    else if (wet(b))
      sheet_.net.push_back({point_[b], shore(b, a)});
  }

  const WaterField& water_;
  double time_, top_;
  WaterSheet sheet_;
  bool dry_ = false;          // at some point of the grid
  std::vector<bool> unknown_; // of each point of the grid
  std::vector<int> point_;    // of the sheet, at each wet point of the grid; -1: dry
  std::map<std::array<int, 2>, int> shore_;
};

void add_arrows_on_surface(WaterSheet& sheet) {
  const int stride = std::max(1, std::max(sheet.size[0], sheet.size[1]) / arrows_along);
  std::map<std::array<int, 2>, bool> taken;
  for (std::size_t p = 0; p < sheet.points.size(); ++p) {
    const double i = (sheet.points[p].x() - sheet.origin[0]) / sheet.cell[0],
                 j = (sheet.points[p].y() - sheet.origin[1]) / sheet.cell[1];
    const std::array<int, 2> at{static_cast<int>(std::lround(i)), static_cast<int>(std::lround(j))};
    const bool on_grid = std::abs(i - at[0]) < 1e-6 && std::abs(j - at[1]) < 1e-6;
    if (on_grid && at[0] % stride == stride / 2 && at[1] % stride == stride / 2 && !taken[at]) {
      taken[at] = true;
      sheet.arrows.push_back({sheet.points[p], sheet.velocity[p]});
    }
  }
}

void add_arrows_in_section(const WaterField& water, double time, const geom::Box& box, const WaterWish& wish,
                           WaterSheet& sheet) {
  const Vec3 along = Vec3::UnitZ().cross(wish.normal);
  if (!(along.norm() > 1e-6 * wish.normal.norm())) // a level plane
    return;
  const Vec3 a = along.normalized(), size = box.size();
  const double reach = size.head<2>().norm(), step = std::max(size.x(), size.y()) / arrows_along;
  const Vec3 middle = *wish.point + (box.centre() - *wish.point).dot(a) * a;
  for (double s = -0.5 * reach + 0.5 * step; s < 0.5 * reach; s += step) {
    Vec3 x = middle + s * a;
    if (x.x() < box.min.x() || x.x() > box.max.x() || x.y() < box.min.y() || x.y() > box.max.y())
      continue;
    x.z() = box.max.z();
    const double surface = asked(water, x, time).surface;
    if (!std::isfinite(surface))
      continue;
    for (int k = 0; k < arrows_over_depth; ++k) {
      x.z() = box.min.z() + (k + 0.5) * size.z() / arrows_over_depth;
      if (x.z() < surface)
        sheet.arrows.push_back({x, asked(water, x, time).velocity});
    }
  }
}

} // namespace

WaterSheet free_surface(const WaterField& water, double time, const geom::Box& box, const WaterWish& wish) {
  WaterSheet sheet = SheetOfField(water, time, box).make();
  if (!sheet.points.empty() && wish.velocity) {
    if (wish.point)
      add_arrows_in_section(water, time, box, wish, sheet);
    else
      add_arrows_on_surface(sheet);
  }
  return sheet;
}

namespace {

// Water at rest in joints, below a level or a table.
class StandingWater final : public WaterField {
public:
  StandingWater(std::optional<double> level, std::shared_ptr<const WaterTable> table)
      : level_(level), table_(std::move(table)) {}
  WaterPoint at(const Vec3& place, double) const override {
    WaterPoint point;
    const std::optional<double> z = table_ ? table_->height(place) : level_;
    point.surface = z.value_or(std::nan("")); // the table ends before
    return point;
  }
  double density() const override { return 0; }
  double gravity() const override { return standard_water_gravity; }
  bool has_dynamic_pressure() const override { return false; }
  bool has_pressure() const override { return false; }

private:
  std::optional<double> level_;
  std::shared_ptr<const WaterTable> table_;
};

} // namespace

void add_water(const Conditions& conditions, const WaterWish& wish, Snapshot& snapshot) {
  std::vector<const WaterField*> fields;
  std::vector<StandingWater> standing; // several sets of joints may have the same
  const std::vector<StillWater>& still = conditions.still_waters;
  for (auto water = still.begin(); water != still.end(); ++water)
    if (std::none_of(still.begin(), water, [&](const StillWater& before) {
          return before.level == water->level && before.table == water->table;
        }))
      standing.emplace_back(water->level, water->table);
  if (wish.shown) {
    for (const Flow& flow : conditions.flows)
      if (flow.water && std::find(fields.begin(), fields.end(), flow.water.get()) == fields.end())
        fields.push_back(flow.water.get());
    for (const StandingWater& water : standing)
      fields.push_back(&water);
  }
  if (fields.empty() || snapshot.points.empty())
    return;
  const SnapshotField* moved = nullptr;
  for (const SnapshotField& field : snapshot.point_fields)
    if (field.name == "displacement" && field.values.size() == 3 * snapshot.points.size())
      moved = &field;
  geom::Box box;
  for (const geom::Triangle& triangle : snapshot.surface)
    for (const int p : triangle) {
      box.extend(snapshot.points[p]);
      if (moved)
        box.extend(snapshot.points[p] + Eigen::Map<const Vec3>(moved->values.data() + 3 * p));
    }
  for (const WaterField* const field : fields)
    if (WaterSheet sheet = free_surface(*field, snapshot.time, box, wish); sheet.size[0] > 0)
      snapshot.water.push_back(std::move(sheet));
}

} // namespace cdem
