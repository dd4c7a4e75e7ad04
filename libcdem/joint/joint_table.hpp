// A law given by numbers: straight between the rows of two tables, and straight on beyond the last row.
//
//   closing   {closure (m), pressure (Pa)}      closure < 0: faces apart, pressure < 0: pulled together
//   shear     {pressure (Pa), strength (Pa)}
//
// Faces that have opened beyond the first row of `closing` have parted: from then on nothing pulls them together.
#pragma once

#include "libcdem/joint/joint_spring.hpp"

#include <array>
#include <limits>
#include <vector>

namespace cdem {

struct JointTable : NoDilation {
  using Rows = std::vector<std::array<double, 2>>;
  Rows closing; // rising in both columns, with a row {0, 0}; empty: linear with the stiffness of the spring
  Rows shear;   // pressures rising, strengths not falling and >= 0, from pressure 0 on

  // The row that the segment at x ends with; column: of x.
  static std::size_t segment(const Rows& rows, double x, int column) {
    std::size_t i = 1;
    while (i + 1 < rows.size() && x > rows[i][column])
      ++i;
    return i;
  }
  static double slope(const Rows& rows, std::size_t i) {
    return (rows[i][1] - rows[i - 1][1]) / (rows[i][0] - rows[i - 1][0]);
  }
  static double value(const Rows& rows, double x) {
    const std::size_t i = segment(rows, x, 0);
    return rows[i - 1][1] + slope(rows, i) * (x - rows[i - 1][0]);
  }
  // Integral of the straight lines from 0 to x.
  static double integral(const Rows& rows, double x) {
    double sum = 0;
    const auto piece = [&](double from, double to) {
      sum += 0.5 * (to - from) * (value(rows, from) + value(rows, to));
    };
    double at = 0;
    if (x > 0) {
      for (const auto& row : rows)
        if (row[0] > at && row[0] < x) {
          piece(at, row[0]);
          at = row[0];
        }
    } else {
      for (auto row = rows.rbegin(); row != rows.rend(); ++row)
        if ((*row)[0] < at && (*row)[0] > x) {
          piece(at, (*row)[0]);
          at = (*row)[0];
        }
    }
    piece(at, x);
    return sum;
  }

  double pressure(const JointSpring& spring, double closure) const {
    return closing.empty() ? spring.kn * closure : value(closing, closure);
  }
  double closure(const JointSpring& spring, double pressure) const {
    if (closing.empty())
      return pressure / spring.kn;
    const std::size_t i = segment(closing, pressure, 1);
    return closing[i - 1][0] + (pressure - closing[i - 1][1]) / slope(closing, i);
  }
  double stored(const JointSpring& spring, double closure) const {
    return closing.empty() ? 0.5 * spring.kn * closure * closure : integral(closing, closure);
  }
  bool holds(double opening, double parted) const {
    return !closing.empty() && std::max(opening, parted) <= -closing.front()[0];
  }
  double pull(const JointSpring&, double opening, double parted) const {
    return holds(opening, parted) ? -value(closing, -opening) : 0;
  }
  double stored_pull(const JointSpring&, double opening, double parted) const {
    return holds(opening, parted) ? integral(closing, -opening) : 0;
  }
  double strength(const JointSpring&, double pressure, double) const {
    return std::max(0.0, value(shear, pressure));
  }
  double friction_left(const JointSpring&) const { return shear.back()[1] / shear.back()[0]; }

  void validate() const {
    check(closing, "normal", true);
    bool origin = closing.empty();
    for (const auto& row : closing)
      origin = origin || (row[0] == 0 && row[1] == 0);
    if (!origin)
      throw geom::InputError("normal", "without a row {0, 0}", "rows that pass through {0, 0}",
                             "faces that just touch carry nothing");
    if (shear.empty())
      throw geom::InputError("shear", "{}", "at least two rows {pressure (Pa), strength (Pa)}");
    check(shear, "shear", false);
    require_of_joint(shear.front()[0] == 0, "shear[1]", shear.front()[0],
                     "a first row {0, strength without pressure}");
    require_of_joint(shear.front()[1] >= 0, "shear[1]", shear.front()[1], "a strength >= 0 Pa");
  }
  void validate(const JointSpring& spring) const {
    for (std::size_t i = 1; i < closing.size(); ++i) {
      char most[64];
      std::snprintf(most, sizeof most, "at most %g Pa/m, the stiffness of the spring", spring.kn);
      require_of_joint(slope(closing, i) <= spring.kn * (1 + 1e-9),
                       ("normal[" + std::to_string(i + 1) + "]: slope").c_str(), slope(closing, i), most,
                       "raise normal_stiffness, or lower thickness_ratio");
    }
  }
  template <class Visit>
  void each_member(const Visit& visit) {
    visit(closing);
    visit(shear);
  }

private:
  static void check(const Rows& rows, const char* name, bool strictly) {
    if (rows.size() == 1)
      throw geom::InputError(name, "one row", "at least two rows");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string row = std::string(name) + "[" + std::to_string(i + 1) + "]";
      for (const double x : rows[i])
        require_of_joint(std::isfinite(x), row.c_str(), x, "two finite numbers");
      if (i == 0)
        continue;
      char before[64];
      std::snprintf(before, sizeof before, "above the %g of the row before", rows[i - 1][0]);
      require_of_joint(rows[i][0] > rows[i - 1][0], row.c_str(), rows[i][0], before, "rows rise");
      std::snprintf(before, sizeof before, "%s the %g of the row before", strictly ? "above" : "at least",
                    rows[i - 1][1]);
      require_of_joint(strictly ? rows[i][1] > rows[i - 1][1] : rows[i][1] >= rows[i - 1][1], row.c_str(),
                       rows[i][1], before,
                       strictly ? "rows rise" : "a strength that falls with pressure is none");
    }
  }
};

} // namespace cdem
