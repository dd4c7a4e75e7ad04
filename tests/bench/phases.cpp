#include "tests/bench/phases.hpp"

#include "libcdem/results/energy.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bench {

using namespace cdem;

namespace {

struct LastProgress : Observer {
  std::string times;
  void progress(const Progress& p) override {
    if (p.last)
      times = p.times;
  }
};

} // namespace

std::int64_t steps_of_whole(std::size_t tets, double seconds) {
  constexpr double tet_steps = 60e6; // a second
  return 1 + static_cast<std::int64_t>(seconds * tet_steps / static_cast<double>(tets));
}

void print_head_of_phases(const char* title) {
  std::printf("\n%s; one thread\n%-24s %9s %8s %9s %10s %9s %8s\n", title, "", "", "steps", "broken",
              "steps/s", "of whole", "contacts");
}

Phases::Phases(std::string label, Model built)
    : model(std::move(built)), state(initial_state(model)), label_(std::move(label)) {}

void Phases::run(const char* name, std::int64_t most_steps, const std::function<bool()>& ends) {
  if (stage_ == 0)
    start_ = energy(model, state).total();
  const std::size_t before = log.breaks.size();
  RunOptions options;
  options.steps = most_steps;
  options.callback_every = ask_every;
  const Stopwatch watch(1);
  options.stop = ends;
  LastProgress observer;
  StageContext context{model, state, conditions, log, last_good_, observer, 1, ++stage_};
  context.changing = &model;
  context.restart_point = &restart_point_;
  const RunResult r = cdem::run(context, options);
  const double rate = static_cast<double>(r.steps) / watch.seconds();
  whole_ = whole_ > 0 ? whole_ : rate;
  const EnergyLedger now = energy(model, state);
  const double most = std::max(start_, now.external_peak), open = now.total() - now.external - start_;
  std::printf("%-24s %9s %8lld %9zu %10.1f %9.3f %8zu  energy open by %.0e; %s\n", label_.c_str(), name,
              static_cast<long long>(r.steps), log.breaks.size() - before, rate, rate / whole_,
              state.contacts.size(), most > 0 ? open / most : 0, observer.times.c_str());
  std::fflush(stdout);
}

} // namespace bench
