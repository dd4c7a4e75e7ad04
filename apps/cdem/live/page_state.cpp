#include "apps/cdem/live/page_state.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace cdem::app {
namespace {

using Json = nlohmann::ordered_json;

using std::chrono::milliseconds;

constexpr std::size_t most_lines = 300, most_samples = 1000;
constexpr milliseconds longest_wait_for_frame{1000}, longest_wait_for_page{2000};

} // namespace

PageState::PageState(std::string name, std::string stop, std::vector<ShownFile> files)
    : name_(std::move(name)), stop_(std::move(stop)), files_(std::move(files)) {}

void PageState::progress(const Progress& progress, const std::string& line, double fraction,
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

void PageState::line(const std::string& line) {
  const std::lock_guard lock(one_at_a_time_);
  line_ = line;
}

void PageState::add_line(const std::string& line) {
  const std::lock_guard lock(one_at_a_time_);
  log_.push_back(line);
  if (log_.size() > most_lines)
    log_.pop_front();
}

void PageState::frame(std::string png, std::vector<std::string> fields, const FrameWish& drawn) {
  const std::lock_guard lock(one_at_a_time_);
  png_ = std::move(png);
  fields_ = std::move(fields);
  drawn_ = drawn;
  ++frame_;
  changed_.notify_all();
}

void PageState::refuse(const std::string& line) {
  add_line(line);
  const std::lock_guard lock(one_at_a_time_);
  wish_ = drawn_;
  ++frame_;
  changed_.notify_all();
}

bool PageState::stop() {
  const std::lock_guard lock(one_at_a_time_);
  changed_.notify_all();
  return !std::exchange(stopping_, true);
}

void PageState::ended(const std::string& text) {
  const std::lock_guard lock(one_at_a_time_);
  end_ = text;
  ended_ = true;
  changed_.notify_all();
}

std::string PageState::status(int seen) {
  std::unique_lock lock(one_at_a_time_);
  was_read_ = true;
  changed_.wait_for(lock, longest_wait_for_frame, [&] { return frame_ != seen || ended_; });
  Json all;
  all["case"] = name_;
  all["line"] = line_;
  all["fraction"] = fraction_;
  all["seconds_left"] = seconds_left_;
  all["stop"] = stop_;
  all["stopping"] = stopping_;
  all["ended"] = ended_ ? Json{{"text", end_}} : Json(nullptr);
  all["frame"] = frame_;
  all["fields"] = fields_;
  all["files"] = Json::array();
  for (const ShownFile& file : files_)
    all["files"].push_back({{"name", file.name}, {"steps", file.steps}});
  all["shown"] = {{"file", drawn_.file},
                  {"step", drawn_.step},
                  {"colour", drawn_.colour},
                  {"range", drawn_.range ? Json(*drawn_.range) : Json(nullptr)},
                  {"deformation", drawn_.deformation},
                  {"view", drawn_.view},
                  {"up", drawn_.up},
                  {"turn", drawn_.turn},
                  {"tilt", drawn_.tilt},
                  {"zoom", drawn_.zoom},
                  {"shift", drawn_.shift}};
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
  end_was_read_ = end_was_read_ || ended_;
  changed_.notify_all();
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string PageState::frame() const {
  const std::lock_guard lock(one_at_a_time_);
  return png_;
}

FrameWish PageState::wish() const {
  const std::lock_guard lock(one_at_a_time_);
  return wish_;
}

bool PageState::wish(const std::map<std::string, std::string>& words) {
  const std::lock_guard lock(one_at_a_time_);
  if (!wish_.take(words, fields_, files_))
    return false;
  wished_ = true;
  changed_.notify_all();
  return true;
}

bool PageState::wishes_changed() {
  const std::lock_guard lock(one_at_a_time_);
  return std::exchange(wished_, false);
}

void PageState::wait_for_wish(milliseconds longest) {
  std::unique_lock lock(one_at_a_time_);
  changed_.wait_for(lock, longest, [&] { return wished_ || stopping_; });
}

bool PageState::stops() const {
  const std::lock_guard lock(one_at_a_time_);
  return stopping_;
}

bool PageState::was_read() const {
  const std::lock_guard lock(one_at_a_time_);
  return was_read_;
}

void PageState::wait_until_end_was_read() const {
  std::unique_lock lock(one_at_a_time_);
  if (was_read_)
    changed_.wait_for(lock, longest_wait_for_page, [&] { return end_was_read_; });
}

} // namespace cdem::app
