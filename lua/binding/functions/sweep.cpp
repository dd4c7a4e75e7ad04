// cdem.sweep: one script with many settings, as processes side by side.
#include "lua/binding/files/process_pool.hpp"
#include "lua/binding/files/sources.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace cdem::script {

namespace {

using geom::InputError;
namespace fs = std::filesystem;

std::string set_text(const Value& value) {
  if (const std::string* text = value.get<std::string>())
    return *text;
  if (const Table* table = value.table()) {
    std::string out;
    for (const Value& item : table->items)
      out += (out.empty() ? "" : ",") + set_text(item);
    return out;
  }
  return describe(value);
}

struct Case {
  Value set;
  std::vector<std::string> settings; // "name=value"
  std::string name;                  // of its folder: "case=1,depth=2"
};

std::vector<Case> read_cases(const Arguments& a) {
  std::vector<Case> cases;
  for (const Value& given : a.list("set")) {
    const std::string path = "set[" + std::to_string(cases.size() + 1) + "]";
    Case one;
    one.set = given;
    const Table* table = given.table();
    if (!table || !table->items.empty())
      throw InputError(path, describe(given), "a table of parameters, e.g. { pressure = 24e6 }");
    for (const auto& [name, value] : table->named) {
      if (value.table() && !value.table()->named.empty())
        throw InputError(path + "." + name, describe(value),
                         "a number, a string, a boolean or a list of these");
      one.settings.push_back(name + "=" + set_text(value));
      one.name += (one.name.empty() ? "" : ",") + one.settings.back();
    }
    for (char& c : one.name)
      if (!std::isalnum(static_cast<unsigned char>(c)) && std::string("=,._+-").find(c) == std::string::npos)
        c = '_';
    if (one.name.empty() || one.name[0] == '.' || one.name.size() > 120)
      one.name = "case_" + std::to_string(cases.size() + 1);
    const auto same = [&](const Case& other) { return other.name == one.name; };
    if (std::any_of(cases.begin(), cases.end(), same))
      one.name += "_" + std::to_string(cases.size() + 1);
    cases.push_back(std::move(one));
  }
  return cases;
}

std::string last_line(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error))
    return {};
  std::istringstream in(read_file(file));
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty())
      last = line;
  return last;
}

// What a failed run says it failed of; "" when it could not.
std::string error_line(const fs::path& console) {
  const std::string front = "cdem: error: ", line = last_line(console);
  return line.rfind(front, 0) == 0 ? line.substr(front.size()) : std::string();
}

// "run 2 of 3 (friction_angle = 85)"
std::string shown_run(const std::vector<Case>& cases, std::size_t index) {
  std::string settings;
  for (const std::string& setting : cases[index].settings) {
    const auto equals = setting.find('=');
    settings +=
        (settings.empty() ? " (" : ", ") + setting.substr(0, equals) + " = " + setting.substr(equals + 1);
  }
  return "run " + std::to_string(index + 1) + " of " + std::to_string(cases.size()) + settings +
         (settings.empty() ? "" : ")");
}

// The script goes on without the run, and a gap among its figures is easily overlooked.
void warn_of_failure(Session& session, const std::vector<Case>& cases, std::size_t index, const Job& job,
                     const fs::path& script) {
  const std::string what = "sweep: " + shown_run(cases, index);
  const std::string code = " failed with exit code " + std::to_string(job.exit_code);
  if (session.settings.check_only) {
    std::error_code none;
    const fs::path near = fs::proximate(script, none);
    std::string command = "cdem check " + (none ? script : near).string();
    for (const std::string& setting : cases[index].settings)
      command += " --set " + setting;
    session.warn(what + code + "; " + command + " tells why");
    return;
  }
  const std::string error = error_line(job.console);
  session.warn(what + code + (error.empty() ? "" : ": " + error) + "; its figures are empty");
}

Table figures_of(const fs::path& report) {
  Table figures;
  const Value all = read_report(read_file(report), report.string());
  const auto list =
      all.table() ? all.table()->named.find("figures") : std::map<std::string, Value>::const_iterator();
  if (all.table() && list != all.table()->named.end() && list->second.table())
    for (const Value& figure : list->second.table()->items) {
      const auto& named = figure.table()->named;
      if (named.count("name") && named.count("value"))
        figures.named[*named.at("name").get<std::string>()] = named.at("value");
    }
  return figures;
}

struct SweepResult {
  Value set;
  std::string output; // in the output folder
  int exit_code;
  double seconds;
  Value figures;
};

const Record<SweepResult> sweep_result{
    "SweepResult",
    "What one case of a sweep came to.",
    {{plain("set").required().doc("as given"), &SweepResult::set},
     {text("output").doc("its folder, in the output folder"), &SweepResult::output},
     {integer("exit_code").doc("0 when it succeeded"), &SweepResult::exit_code},
     {number("seconds", "s").doc("wall clock; 0 for a run that had ended before its sweep was stopped"),
      &SweepResult::seconds},
     {plain("figures").required().doc("values of its report by name; empty when it failed, and in a check"),
      &SweepResult::figures}}};

SweepResult result_of(Session& session, const Case& one, const Job& job, const fs::path& folder) {
  const fs::path report = folder / "report.json";
  std::error_code error;
  // A check writes none: what lies there is of an earlier run.
  const bool reported = !session.settings.check_only && job.exit_code == 0 && fs::exists(report, error);
  return {one.set, folder.lexically_relative(session.files.output()).string(), job.exit_code, job.seconds,
          reported ? figures_of(report) : Table()};
}

const char* const log_name = "cdem.log";

// The run has ended well before its sweep was stopped: it is not done again.
bool has_ended(const Session& session, const fs::path& folder) {
  const fs::path log = folder / log_name;
  return session.checkpoints.is_of_stopped_run(log) && last_line(log).rfind("ended with exit code 0", 0) == 0;
}

int jobs_at_a_time(const Arguments& a) {
  if (a.has("jobs"))
    return static_cast<int>(a.integer("jobs"));
  const auto processors = static_cast<std::int64_t>(std::thread::hardware_concurrency());
  return static_cast<int>(std::max<std::int64_t>(1, processors / a.integer("threads")));
}

// The runs that go side by side share what this one may take.
std::size_t memory_of_each(const Session& session, const Arguments& a, const std::vector<Case>& cases) {
  constexpr std::size_t least = std::size_t{64} << 20; // that --memory takes
  const std::size_t together = std::min(static_cast<std::size_t>(jobs_at_a_time(a)), cases.size());
  return std::max(least, session.settings.memory / std::max<std::size_t>(1, together));
}

std::vector<Job> make_jobs(const Session& session, const Arguments& a, const std::vector<Case>& cases,
                           const fs::path& script) {
  std::vector<Job> jobs;
  for (const Case& one : cases) {
    Job job;
    job.command = {session.settings.program, session.settings.check_only ? "check" : "run", script.string()};
    for (const std::string& setting : one.settings) {
      job.command.emplace_back("--set");
      job.command.push_back(setting);
    }
    if (session.settings.check_only) {
      job.console = "/dev/null";
    } else {
      // Beside the case's folder, which a run takes only when it is empty or holds results of cdem.
      job.console = session.files.to_write(one.name + ".console.txt");
      job.command.insert(job.command.end(),
                         {"--quiet", "--output", (session.files.output() / one.name).string(), "--threads",
                          std::to_string(a.integer("threads")), "--sources",
                          (session.files.output() / sources_folder).string()});
    }
    if (session.settings.memory > 0)
      job.command.insert(job.command.end(), {"--memory", std::to_string(memory_of_each(session, a, cases))});
    if (session.settings.unsafe)
      job.command.emplace_back("--unsafe");
    jobs.push_back(std::move(job));
  }
  return jobs;
}

// Before a sweep begins: a checkpoint to go on from, and the text that it runs, unless it goes on itself.
void keep(Session& session, const std::vector<Case>& cases, const std::vector<Job>& jobs,
          const fs::path& script) {
  const fs::path sources = session.files.output() / sources_folder;
  const bool goes_on = session.checkpoints.is_of_stopped_run(sources / script.filename());
  session.checkpoints.keep_before_call();
  const auto now = fs::file_time_type::clock::now();
  if (goes_on)
    fs::last_write_time(sources / script.filename(), now);
  else
    each_source(script, [&](const fs::path& name, const std::string& text) {
      write_file(session.files.to_write((sources_folder / name).string()), text);
    });
  for (std::size_t i = 0; i < jobs.size(); ++i)
    if (jobs[i].exit_code == 0)
      fs::last_write_time(session.files.output() / cases[i].name / log_name, now);
}

// Sweeps that this process is a run of, one within the other. A safe script cannot change the environment.
constexpr const char* depth_name = "CDEM_SWEEP_DEPTH";
constexpr int most_depth = 3;

int sweep_depth() {
  static const int depth = [] {
    const char* text = std::getenv(depth_name);
    return text ? std::clamp(std::atoi(text), 0, most_depth) : 0;
  }();
  return depth;
}

// Two scripts that sweep each other would fill the machine.
void begin_depth() {
  if (sweep_depth() >= most_depth)
    throw InputError(
        "sweep: " + std::to_string(most_depth) +
        " sweeps stand within each other already, and no more may; do two scripts sweep each other?");
  setenv(depth_name, std::to_string(sweep_depth() + 1).c_str(), 1);
}

Value sweep(Session& session, Object*, const Arguments& a) {
  const fs::path script = session.files.to_read(a.text("script"));
  if (!session.settings.script.empty() && fs::equivalent(script, session.settings.script))
    throw InputError("script", "\"" + a.text("script") + "\"", "another script",
                     "a script that sweeps itself would never end");
  if (session.settings.program.empty())
    throw InputError("sweep: only from the cdem program, which it starts for each case");
  begin_depth();
  session.check_set_names();
  const std::vector<Case> cases = read_cases(a);
  std::vector<Job> jobs = make_jobs(session, a, cases, script), rest;
  std::vector<std::size_t> number; // of each of the rest
  for (std::size_t i = 0; i < jobs.size(); ++i)
    if (has_ended(session, session.files.output() / cases[i].name)) {
      jobs[i].exit_code = 0;
    } else {
      rest.push_back(jobs[i]);
      number.push_back(i);
    }
  if (!session.settings.check_only)
    keep(session, cases, jobs, script);

  const auto& observer = session.settings.observer;
  const auto count = static_cast<std::int64_t>(jobs.size());
  auto done = static_cast<std::int64_t>(jobs.size() - rest.size());
  if (done > 0)
    session.message("sweep: " + std::to_string(done) + " of " + std::to_string(count) +
                    " runs had ended and stand");
  Progress progress;
  progress.kind = "sweep";
  progress.counts = "run";
  progress.max_steps = count;
  const auto start = std::chrono::steady_clock::now();
  const auto tell = [&](const Job& job) {
    const std::size_t index = number[static_cast<std::size_t>(&job - rest.data())];
    const Case& one = cases[index];
    jobs[index] = job;
    progress.step = ++done;
    progress.last = done == count;
    progress.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (observer)
      observer->progress(progress);
    std::ostringstream line;
    line.precision(3);
    line << "sweep " << done << "/" << count << ": " << one.name;
    if (job.exit_code == 0)
      line << (session.settings.check_only ? " checked in " : " done in ") << job.seconds << " s";
    else
      line << " failed with exit code " << job.exit_code;
    session.message(line.str());
    if (job.exit_code != 0)
      warn_of_failure(session, cases, index, job, script);
  };
  const auto stop = [&] { return observer && observer->stop_requested(); };
  const Doing solves(observer.get(), Activity::stage); // the runs save what they have when they are stopped
  if (!run_jobs(rest, jobs_at_a_time(a), stop, tell)) {
    session.message("runs that have ended stand; to go on: " + session.checkpoints.command());
    throw Interrupted();
  }

  session.checkpoints.keep_call();
  std::vector<SweepResult> results;
  for (std::size_t i = 0; i < jobs.size(); ++i)
    results.push_back(result_of(session, cases[i], jobs[i], session.files.output() / cases[i].name));
  return sweep_result.list(results);
}

} // namespace

void bind_sweep(Module& m) {
  m.records.push_back(sweep_result);
  m.add("sweep",
        "Runs a script with many settings, as processes side by side. Each has its own folder in the output "
        "folder. All of them run the script, and the files that it requires by a name in quotes, as they are "
        "when the sweep begins; the folder swept/ keeps these. If the sweep is stopped, `cdem resume` "
        "continues it: runs that have ended well are kept, the others begin again. A failed run gives a "
        "warning. Scripts that are swept may sweep others, three deep.",
        {text("script").required().doc("another .lua file beside this one"),
         list("set", plain("").type)
             .required()
             .doc("one table of parameters per case, e.g. { { case = 1 }, { case = 2 } }"),
         integer("jobs").within(1, 1024).doc(
             "cases at a time; as many as there are processors for when left out"),
         integer("threads").within(1, 1024).standard(1).doc("of each case")},
        sweep, "cdem.SweepResult[]", "in the order given")
      .replayed(Replay::recorded)
      .by_rank_0();
}

} // namespace cdem::script
