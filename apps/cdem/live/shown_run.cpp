#include "apps/cdem/live/shown_run.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace cdem::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_lines = 300, most_samples = 1000, longest_word = 200;

} // namespace

ShownRun::ShownRun(std::string name, bool can_stop) : name_(std::move(name)), can_stop_(can_stop) {}

void ShownRun::progress(const Progress& progress, const std::string& line, double fraction,
                        double seconds_left) {
  const std::lock_guard lock(one_at_a_time_);
  line_ = line;
  fraction_ = fraction;
  seconds_left_ = progress.last ? -1 : seconds_left;
  if (progress.stage != stage_) {
    broken_before_ += broken_in_stage_;
    stage_ = progress.stage;
  }
  broken_in_stage_ = static_cast<double>(progress.broken_tension + progress.broken_shear);
  if (calls_++ % stride_ != 0)
    return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  samples_.push_back({seconds, progress.residual_goal > 0 ? progress.residual : std::nan(""),
                      progress.kinetic_ratio_goal > 0 ? progress.kinetic_ratio : std::nan(""),
                      broken_before_ + broken_in_stage_});
  if (samples_.size() < most_samples)
    return;
  for (std::size_t i = 0; 2 * i < samples_.size(); ++i) // every second one stays
    samples_[i] = samples_[2 * i];
  samples_.resize((samples_.size() + 1) / 2);
  stride_ *= 2;
}

void ShownRun::add_line(const std::string& line) {
  const std::lock_guard lock(one_at_a_time_);
  log_.push_back(line);
  if (log_.size() > most_lines)
    log_.pop_front();
}

void ShownRun::frame(std::string png, std::vector<std::string> fields, const FrameWish& drawn) {
  const std::lock_guard lock(one_at_a_time_);
  png_ = std::move(png);
  fields_ = std::move(fields);
  drawn_ = drawn;
  ++frame_;
}

bool ShownRun::stop() {
  const std::lock_guard lock(one_at_a_time_);
  return !std::exchange(stopping_, true);
}

void ShownRun::ended(const std::string& text) {
  const std::lock_guard lock(one_at_a_time_);
  end_ = text;
  ended_ = true;
}

std::string ShownRun::status() {
  const std::lock_guard lock(one_at_a_time_);
  Json all;
  all["case"] = name_;
  all["line"] = line_;
  all["fraction"] = fraction_;
  all["seconds_left"] = seconds_left_;
  all["can_stop"] = can_stop_;
  all["stopping"] = stopping_;
  all["ended"] = ended_ ? Json{{"text", end_}} : Json(nullptr);
  all["frame"] = frame_;
  all["fields"] = fields_;
  all["shown"] = {{"colour", drawn_.colour},
                  {"view", drawn_.view},
                  {"up", drawn_.up},
                  {"deformation", drawn_.deformation}};
  all["log"] = log_;
  Json charts = Json::array();
  const auto add = [&](const char* name, bool log, double Sample::*value) {
    Json x = Json::array(), y = Json::array();
    bool any = false;
    for (const Sample& sample : samples_) {
      x.push_back(sample.seconds);
      y.push_back(std::isfinite(sample.*value) ? Json(sample.*value) : Json(nullptr));
      any = any || sample.*value > 0;
    }
    if (any)
      charts.push_back({{"name", name}, {"x_label", "computing (s)"}, {"log", log}, {"x", x}, {"y", y}});
  };
  add("out-of-balance force over applied force", true, &Sample::residual);
  add("kinetic energy over its peak", true, &Sample::kinetic);
  add("spring points broken", false, &Sample::broken);
  all["charts"] = charts;
  was_read_ = true;
  end_was_read_ = end_was_read_ || ended_;
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ShownRun::frame() const {
  const std::lock_guard lock(one_at_a_time_);
  return png_;
}

FrameWish ShownRun::wish() const {
  const std::lock_guard lock(one_at_a_time_);
  return wish_;
}

bool ShownRun::wish(const std::map<std::string, std::string>& wishes) {
  static const std::vector<std::string> views{"front", "back", "left", "right", "top", "bottom", "iso"};
  const std::lock_guard lock(one_at_a_time_);
  FrameWish next = wish_;
  for (const auto& [name, value] : wishes) {
    if (value.size() > longest_word)
      return false;
    if (name == "colour" &&
        (value.empty() || std::find(fields_.begin(), fields_.end(), value) != fields_.end()))
      next.colour = value;
    else if (name == "view" && std::find(views.begin(), views.end(), value) != views.end())
      next.view = value;
    else if (name == "up" && (value == "y" || value == "z"))
      next.up = value;
    else if (name == "deformation") {
      char* end = nullptr;
      next.deformation = std::strtod(value.c_str(), &end);
      if (value.empty() || *end != '\0' || !(std::abs(next.deformation) <= 1e9))
        return false;
    } else {
      return false;
    }
  }
  wish_ = next;
  wished_ = true;
  return true;
}

bool ShownRun::wishes_changed() {
  const std::lock_guard lock(one_at_a_time_);
  return std::exchange(wished_, false);
}

bool ShownRun::was_read() const {
  const std::lock_guard lock(one_at_a_time_);
  return was_read_;
}

bool ShownRun::end_was_read() const {
  const std::lock_guard lock(one_at_a_time_);
  return end_was_read_;
}

} // namespace cdem::app
