#include "apps/cdem/progress/line.hpp"

#include "apps/cdem/process/terminal.hpp"
#include "apps/cdem/text/text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cdem::app {

namespace {

constexpr int bar_width = 16;

std::string percent_text(double fraction) {
  return std::to_string(static_cast<int>(std::floor(100 * fraction))) + " %";
}

// Where the stage stands against what it is to reach.
std::string goal_text(const Progress& p) {
  std::string text;
  if (p.residual_goal > 0)
    text = "residual " + number_text(p.residual) + " -> " + number_text(p.residual_goal);
  else if (p.time_goal > 0)
    text = "time " + number_text(p.time) + " of " + number_text(p.time_goal) + " s";
  else if (p.time > 0)
    text = "time " + number_text(p.time) + " s";
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (p.kinetic_ratio_goal > 0)
    add("kinetic energy " + number_text(p.kinetic_ratio) + " -> " + number_text(p.kinetic_ratio_goal) +
        " of its peak");
  if (!p.note.empty())
    add(p.note);
  return text;
}

// Empty where nothing is counted any more: all units are laid and come to rest.
std::string rate_text(const Progress& p, const TimeLeft& left) {
  const double rate = left.steps_per_second();
  if (!(rate > 0) || (p.counts != Progress().counts && p.max_steps == 0))
    return {};
  return (rate < 10 ? number_text(rate) : count_text(std::llround(rate))) + " " + p.counts + "s/s";
}

std::string left_text(const TimeLeft& left) {
  return duration_text(left.seconds()) + (left.gives_up() ? " to its limit" : " left");
}

std::string step_text(const Progress& p) {
  if (p.counts == Progress().counts)
    return p.counts + " " + count_text(p.step);
  if (p.max_steps > 0)
    return p.counts + " " + count_text(p.step) + " of " + count_text(p.max_steps);
  return count_text(p.step) + " " + p.counts + "s";
}

std::string stage_text(const Progress& p) { // stage 0 is none: a sweep of the script, a layer laid
  return p.stage > 0 ? "stage " + std::to_string(p.stage) + " " + p.kind : p.kind;
}

struct Part {
  std::string text;
  int rank; // the highest goes first
};

std::string joined(const std::vector<Part>& parts) {
  std::string line;
  for (const auto& part : parts)
    line += (line.empty() ? "" : "  ") + part.text;
  return line;
}

} // namespace

std::string broken_text(std::int64_t tension, std::int64_t shear) {
  if (tension + shear == 0)
    return "0 broken";
  return count_text(tension + shear) + " broken (" + count_text(tension) + " tension, " + count_text(shear) +
         " shear)";
}

std::string live_line(const Progress& p, const TimeLeft& left, int columns) {
  std::vector<Part> parts = {{stage_text(p), 0}};
  const double fraction = left.fraction();
  if (fraction >= 0) {
    parts.push_back({bar_text(fraction, bar_width), 6});
    parts.push_back({percent_text(fraction), 2});
  }
  parts.push_back({step_text(p), 5});
  if (const std::string goal = goal_text(p); !goal.empty())
    parts.push_back({goal, 1});
  if (const auto broken = p.broken_tension + p.broken_shear; broken > 0)
    parts.push_back({count_text(broken) + " broken", 4});
  if (const std::string rate = rate_text(p, left); !rate.empty())
    parts.push_back({rate, 7});
  if (left.seconds() >= 0 && !p.last)
    parts.push_back({left_text(left), 3});

  const std::size_t room = static_cast<std::size_t>(std::max(columns, 1));
  std::string line = joined(parts);
  while (line.size() > room && parts.size() > 1) {
    parts.erase(std::max_element(parts.begin(), parts.end(),
                                 [](const Part& a, const Part& b) { return a.rank < b.rank; }));
    line = joined(parts);
  }
  return line.substr(0, room);
}

std::string plain_line(const Progress& p, const TimeLeft& left) {
  std::string line = stage_text(p) + ": " + step_text(p);
  if (const std::string goal = goal_text(p); !goal.empty())
    line += ", " + goal;
  if (const double fraction = left.fraction(); fraction >= 0)
    line += ", " + percent_text(fraction);
  if (p.broken_tension + p.broken_shear > 0)
    line += ", " + broken_text(p.broken_tension, p.broken_shear);
  if (const std::string rate = rate_text(p, left); !rate.empty())
    line += ", " + rate;
  if (left.seconds() >= 0)
    line += ", " + left_text(left);
  return line;
}

std::string stage_line(const Progress& p) {
  std::string line = stage_text(p) + ": " + count_text(p.step) + (p.step == 1 ? " step in " : " steps in ") +
                     duration_text(p.wall_time);
  if (p.residual_goal > 0)
    line += ", residual " + number_text(p.residual) + " (goal " + number_text(p.residual_goal) + ")";
  else if (p.time > 0)
    line += ", time " + number_text(p.time) + " s";
  return line + ", " + broken_text(p.broken_tension, p.broken_shear);
}

} // namespace cdem::app
