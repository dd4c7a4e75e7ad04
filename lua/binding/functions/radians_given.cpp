#include "lua/binding/functions/radians_given.hpp"

#include "lua/binding/schema/angles.hpp"

#include <algorithm>
#include <cmath>

namespace cdem::script {

namespace {

bool all_within(const std::vector<double>& angles, double largest) {
  return std::all_of(angles.begin(), angles.end(), [&](double x) { return std::abs(x) <= largest + 1e-3; });
}

bool some_broken(const std::vector<double>& angles) {
  return std::any_of(angles.begin(), angles.end(), [](double x) { return x != std::floor(x); });
}

void say_degrees(Session& session, const std::string& what) {
  session.warn(what +
               ": so small that they look like radians; angles are in degrees, math.deg(x) makes them of "
               "radians");
}

} // namespace

void warn_of_radians(Session& session, const std::string& what, const std::vector<double>& dips,
                     const std::vector<double>& dip_directions) {
  if (all_within(dips, 0.5 * pi) && all_within(dip_directions, 2 * pi) && some_broken(dips))
    say_degrees(session, what);
}

void warn_of_radians(Session& session, const std::string& what, const std::vector<double>& angles) {
  if (all_within(angles, 2 * pi) && some_broken(angles))
    say_degrees(session, what);
}

} // namespace cdem::script
