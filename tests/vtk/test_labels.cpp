#include "libcdem/vtk/chart_axis.hpp"
#include "libcdem/vtk/colour_map.hpp"
#include "libcdem/vtk/labels.hpp"
#include "libgeom/core/error.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace cdem;
using Catch::Matchers::Contains;

namespace {
const double nan_value = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("a unit prefix keeps the largest shown number between 0.1 and 1000") {
  const auto shown = [](const std::string& unit, double largest) {
    const DisplayUnit u = display_unit(unit, largest);
    INFO(unit << " " << largest);
    CHECK(largest * u.factor >= 0.1 * (1 - 1e-12));
    return u.text;
  };
  CHECK(shown("m", 0.45e-3) == "mm");
  CHECK(shown("m", 46.6e-6) == "\u00b5m");
  CHECK(shown("m", 2.5) == "m");
  CHECK(shown("m", 2500) == "m"); // lengths stop at metres
  CHECK(shown("Pa", 30e6) == "MPa");
  CHECK(shown("Pa", 0.7e6) == "MPa");
  CHECK(shown("Pa", 5e3) == "kPa");
  CHECK(shown("Pa", 110e6) == "MPa");
  CHECK(shown("Pa", 0.9e9) == "MPa");
  CHECK(shown("Pa", 30e9) == "GPa");
  CHECK(shown("m/s", 3e-3) == "mm/s");
  CHECK(shown("m/s2", 9.81) == "m/s\u00b2");
  CHECK(shown("1", 0.3).empty());
  CHECK(shown("1", 3e-4) == "10^{\u22126}"); // 300
  CHECK(shown("m2", 2e-5) == "10^{\u22126} m\u00b2");
}

TEST_CASE("a field of zeros keeps its unit") {
  CHECK(display_unit("m", 0).text == "m");
  CHECK(display_unit("m", 0).factor == 1);
}

TEST_CASE("ticks are round, inside the range and evenly spaced") {
  for (const auto& range :
       std::vector<std::array<double, 2>>{{-0.45, 0.45}, {0, 1}, {-31.7, 12}, {1e-9, 7e-9}, {99, 101}}) {
    INFO(range[0] << " " << range[1]);
    const std::vector<double> ticks = round_ticks(range[0], range[1], 6);
    const double span = range[1] - range[0], step = ticks.at(1) - ticks.at(0);
    CHECK(ticks.size() >= 3);
    CHECK(ticks.size() <= 7);
    CHECK(ticks.front() >= range[0] - 1e-9 * span);
    CHECK(ticks.back() <= range[1] + 1e-9 * span);
    const double lead = step / std::pow(10., std::floor(std::log10(step * (1 + 1e-9))));
    CHECK((std::abs(lead - 1) < 1e-6 || std::abs(lead - 2) < 1e-6 || std::abs(lead - 2.5) < 1e-6 ||
           std::abs(lead - 5) < 1e-6));
    for (std::size_t i = 1; i < ticks.size(); ++i)
      CHECK(ticks[i] - ticks[i - 1] == Approx(step).epsilon(1e-9));
  }
}

TEST_CASE("tick labels have the same decimals, a minus sign, and read back as the ticks") {
  CHECK(tick_labels({-0.5, 0, 0.5}) == std::vector<std::string>{"\u22120.5", "0.0", "0.5"});
  CHECK(tick_labels({0, 2.5, 5}) == std::vector<std::string>{"0.0", "2.5", "5.0"});
  CHECK(tick_labels({0, 20000, 40000}) == std::vector<std::string>{"0", "20000", "40000"});
  CHECK(tick_labels({0.25, 0.5}) == std::vector<std::string>{"0.25", "0.50"});
}

TEST_CASE("powers of ten carry the labels of a log axis") {
  const LogTicks ticks = log_ticks(1e-6, 1);
  CHECK(ticks.major.size() == 7);
  CHECK(ticks.minor.size() == 6 * 8);
  CHECK(power_of_ten(-6) == "10^{\u22126}");
  CHECK(power_of_ten(3) == "10^{3}");
}

TEST_CASE("a wide log axis ends on powers of ten, a short one on 1, 2 or 5") {
  const ChartAxis wide = chart_axis({3e-6, 0.7}, true, false, 6, {}, "y_range");
  CHECK(wide.low == Approx(1e-6));
  CHECK(wide.high == Approx(1));
  const ChartAxis brief = chart_axis({0.005, 0.1}, true, false, 6, {}, "x_range");
  CHECK(brief.low == Approx(0.005));
  CHECK(brief.high == Approx(0.1));
  CHECK(brief.labels == std::vector<std::string>{"0.005", "0.01", "0.02", "0.05", "0.1"});
  CHECK(brief.place(0.005) == Approx(0).margin(1e-12));
  CHECK(brief.place(0.1) == Approx(1));
}

TEST_CASE("an axis passes over what it cannot show") {
  const double infinity = std::numeric_limits<double>::infinity();
  const ChartAxis axis = chart_axis({nan_value, infinity, -5, 0, 10, 1000}, true, false, 6, {}, "y_range");
  CHECK(axis.low == Approx(10));
  CHECK(axis.high == Approx(1000));
  const ChartAxis none = chart_axis({0, 0}, true, false, 6, {}, "y_range");
  CHECK(none.low > 0);
  CHECK(none.high > none.low);
}

TEST_CASE("an axis range that cannot be used is refused") {
  using Range = std::array<double, 2>;
  CHECK_THROWS_WITH(chart_axis({}, true, false, 6, Range{0, 1}, "y_range"),
                    Contains("y_range") && Contains("> 0"));
  CHECK_THROWS_WITH(chart_axis({}, false, false, 6, Range{2, 1}, "x_range"),
                    Contains("x_range") && Contains("lower"));
  CHECK_THROWS_AS(chart_axis({}, false, false, 6, Range{nan_value, 1}, "x_range"), geom::InputError);
}

TEST_CASE("nearest names") {
  const std::vector<std::string> known = {"displacement.x", "displacement.y", "stress.xx", "von_mises"};
  CHECK(nearest_names("displacment.x", known).at(0) == "displacement.x");
  CHECK(nearest_names("vonmises", known).at(0) == "von_mises");
  CHECK(nearest_names("stress", known).at(0) == "stress.xx");
  CHECK(nearest_names("temperature", known).empty());
}

TEST_CASE("zero takes the middle colour of a map with two sides") {
  for (const std::vector<double>& values : {std::vector<double>{-1, 3}, {-3, 1}, {-2, 2}}) {
    const ColourScale scale = colour_scale(values, false, "auto", {});
    CHECK(scale.map == "blue_white_red");
    CHECK(scale.low == values[0]); // the bar shows the range of the values, no more
    CHECK(scale.high == values[1]);
    CHECK(scale(values[-values[0] > values[1] ? 0 : 1]) ==
          map_colour("blue_white_red", -values[0] > values[1] ? 0 : 1));
    CHECK(scale(0) == map_colour("blue_white_red", 0.5));
  }
  const ColourScale given = colour_scale({-1, 3}, false, "auto", std::array<double, 2>{-1, 3});
  CHECK(given.low == -1);
  CHECK(given.high == 3);
  CHECK(given(0) == map_colour("blue_white_red", 0.5));
  CHECK(given(3) == map_colour("blue_white_red", 1));
}

TEST_CASE("values of one sign take a map with one side over their own range") {
  const ColourScale scale = colour_scale({2, 5}, false, "auto", {});
  CHECK(scale.map == "viridis");
  CHECK(scale.low == 2);
  CHECK(scale.high == 5);
  CHECK(colour_scale({-1e-9, 1}, false, "auto", {}).map == "viridis"); // round-off is no change of sign
  const ColourScale constant = colour_scale({7, 7}, false, "auto", {});
  CHECK(constant.low < 7);
  CHECK(constant.high > 7);
}

TEST_CASE("a colour map or range that cannot be used is refused") {
  CHECK_THROWS_WITH(colour_scale({1}, false, "jet", {}),
                    Contains("colour_map = \"jet\"") && Contains("viridis"));
  CHECK_THROWS_AS(colour_scale({1}, false, "auto", std::array<double, 2>{1, 1}), geom::InputError);
  CHECK_THROWS_AS(colour_scale({1}, false, "auto", std::array<double, 2>{0, nan_value}), geom::InputError);
}

TEST_CASE("an axis in an SI unit is shown with the prefix that keeps its labels short") {
  const auto axis = [](double high, const std::string& unit) {
    return chart_axis({0, high}, false, false, 5, std::array<double, 2>{0, high}, "x_range", unit);
  };
  CHECK(axis(2e-4, "m").unit == "mm");
  CHECK(axis(2e-4, "m").labels == std::vector<std::string>{"0.00", "0.05", "0.10", "0.15", "0.20"});
  CHECK(axis(2e-4, "m").major.back() == Approx(2e-4)); // places stay in metres
  CHECK(axis(2e-4, "m").multiplier.empty());
  CHECK(axis(5e6, "Pa").unit == "MPa");
  CHECK(axis(4e3, "Pa").unit == "kPa");
  CHECK(axis(40, "m").unit == "m");
  CHECK(axis(0.02, "s").unit == "ms");
  CHECK(axis(4e6, "kPa").unit.empty()); // scaled by whoever gave it
  CHECK(axis(4e6, "kPa").multiplier == "\u00d710^{6}");
  CHECK(axis(1e-4, "").multiplier == "\u00d710^{\u22126}");
  CHECK(chart_axis({1e-6, 1}, true, false, 5, {}, "x_range", "m").unit.empty()); // powers of ten
}

TEST_CASE("the unit of a label stands in brackets at its end") {
  CHECK(unit_of_label("opening (m)") == "m");
  CHECK(unit_of_label("force / area (Pa)") == "Pa");
  CHECK(unit_of_label("step").empty());
  CHECK(unit_of_label("").empty());
  CHECK(unit_of_label("f(x) of it").empty());
  CHECK(with_unit("crack (tip) opening (m)", "mm") == "crack (tip) opening (mm)");
}
