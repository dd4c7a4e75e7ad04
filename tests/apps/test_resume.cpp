// cdem resume as a user meets it: after Ctrl-C, after kill -9 at any moment, with another number of threads, and where
// it cannot go on.
#include "tests/apps/support/case_folder.hpp"

#include <catch2/catch.hpp>
#include <csignal>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

// Large enough for two threads; it takes a second or so.
const std::string long_plate = shaken_plate("{2.7, 1, 0.05}", "{54, 20, 1}", 500);

struct PlaceToResume : CaseFolder {
  PlaceToResume() : CaseFolder({{"plate/case.lua", long_plate}}) {}
  fs::path results = folder / "results/plate";
};

std::string whole_report() {
  static const std::string report = [] {
    PlaceToResume place;
    REQUIRE(place.cdem({"run", "plate/case.lua", "--threads", "1"}).exit_code == 0);
    return read_file(place.results / "report.json");
  }();
  return report;
}

} // namespace

TEST_CASE("resume: after Ctrl-C and SIGTERM a run goes on with any number of threads to the same report") {
  for (const int signal : {SIGINT, SIGTERM}) {
    PlaceToResume place;
    const Outcome stopped =
        place.cdem({"run", "plate/case.lua", "--output", "results/plate"}, signal, "begins");
    CHECK(stopped.exit_code == 128 + signal);
    CHECK_THAT(stopped.out, Contains("checkpoint; to go on: cdem resume results/plate\n"));
    CHECK_FALSE(fs::exists(place.results / "report.json"));
    const Outcome ended = place.cdem({"resume", "results/plate", "--threads", signal == SIGINT ? "1" : "2"});
    CHECK_THAT(ended.err, !Contains("error"));
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, Contains("goes on from "));
    CHECK_THAT(ended.out, !Contains("begins"));
    CHECK(read_file(place.results / "report.json") == whole_report());
    const std::string log = read_file(place.results / "cdem.log");
    CHECK_THAT(log, Contains("begins") && Contains("\nresumed cdem ") && Contains("ended with exit code 0"));
    // It ended well: its checkpoints are gone, and the next run clears the folder of all it wrote.
    CHECK_THAT(place.cdem({"resume", "results/plate"}).err, Contains("no checkpoint"));
    CHECK(place.cdem({"run", "plate/case.lua", "--set", "steps=10", "--output", "results/plate"}).exit_code ==
          0);
    for (const auto& entry : fs::directory_iterator(place.results))
      CHECK_THAT(entry.path().filename().string(), !Contains("edited"));
  }
}

TEST_CASE("resume: a run that goes on ends as an unbroken one: its closing line, and no last good states") {
  const std::vector<std::string> run{"run",        "plate/case.lua", "--set",
                                     "steps=1500", "--output",       "results/plate"};
  const auto closing_line = [](const Outcome& outcome) {
    const std::string line = lines_of(outcome.out).back();
    CHECK_THAT(line, Contains(" broken (") && Contains("1 warning; results in "));
    return line;
  };
  PlaceToResume place;
  std::string text = long_plate;
  const std::string callback = "callback = function() ";
  text.insert(text.find(callback) + callback.size(), "if most == 0 then print 'shakes' end ");
  write_file(place.folder / "plate/case.lua", text);
  const std::string whole = closing_line(place.cdem(run));
  CHECK(place.cdem(run, SIGINT, "shakes").exit_code == 130);
  CHECK(fs::exists(place.results / "last_good.vtu"));
  const Outcome ended = place.cdem({"resume", "results/plate"});
  CHECK(ended.exit_code == 0);
  CHECK(closing_line(ended) == whole);
  for (const auto& entry : fs::directory_iterator(place.results))
    CHECK_THAT(entry.path().filename().string(), !StartsWith("last_good"));
}

TEST_CASE("resume: kill -9 at any moment leaves a whole checkpoint to go on from") {
  PlaceToResume place;
  // A checkpoint whenever the run looks: most of the time one is being written.
  std::vector<std::string> command{"run", "plate/case.lua", "--checkpoint-every", "1e-9"};
  int killed = 0;
  for (; killed < 4; ++killed) {
    const std::string first = killed == 0 ? "checkpoint" : "goes on";
    const Outcome outcome = place.cdem(command, SIGKILL, first);
    if (outcome.exit_code == 0)
      break;
    REQUIRE(outcome.exit_code == 128 + SIGKILL);
    command = {"resume", "results/plate", "--checkpoint-every", "1e-9"};
  }
  CHECK(killed == 4);
  const Outcome ended = place.cdem({"resume", "results/plate"});
  CHECK_THAT(ended.err, !Contains("error"));
  CHECK(ended.exit_code == 0);
  CHECK(read_file(place.results / "report.json") == whole_report());
}

TEST_CASE("resume: what cannot be gone on from is refused in one line") {
  PlaceToResume place;
  const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
    const Outcome outcome = place.cdem(arguments);
    CHECK(outcome.exit_code == code);
    CHECK_THAT(outcome.err, StartsWith("cdem: error: ") && Contains(says));
    CHECK(lines_of(outcome.err).size() == 1);
  };
  refused({"resume"}, 2, "FOLDER");
  refused({"resume", "nowhere"}, 4, "no such folder");
  refused({"resume", "plate"}, 2, "not the output folder of a run");
  refused({"resume", "plate/case.lua"}, 2, "not a folder");
  refused({"run", "plate/case.lua", "--checkpoint-every", "-1"}, 2, "--checkpoint-every -1");
  refused({"run", "plate/case.lua", "--checkpoint-every", "often"}, 2, "--checkpoint-every");
  REQUIRE(place.cdem({"run", "plate/case.lua"}, SIGINT, "begins").exit_code == 130);
  const fs::path file = place.results / "checkpoint_1.cdem";
  const std::string whole = read_file(file);
  write_file(file, whole.substr(0, whole.size() / 2));
  refused({"resume", "results/plate"}, 4, "damaged");
  write_file(file, "something else");
  refused({"resume", "results/plate"}, 4, "not a checkpoint");
  std::string other_format = whole;
  other_format[16] = 77; // the checksum tells before anybody trusts the number
  write_file(file, other_format);
  refused({"resume", "results/plate"}, 4, "checksum");
  write_file(file, whole);
  write_file(place.folder / "plate/case.lua", std::string(long_plate) + "-- one more line\n");
  refused({"resume", "results/plate"}, 2, "has changed since its checkpoint was written");
  fs::remove(place.folder / "plate/case.lua");
  refused({"resume", "results/plate"}, 4, "no such file");
  // None of this has cost the checkpoint.
  write_file(place.folder / "plate/case.lua", long_plate);
  CHECK(place.cdem({"resume", "results/plate"}).exit_code == 0);
  CHECK(read_file(place.results / "report.json") == whole_report());
}

TEST_CASE("resume: a run that was started with --unsafe goes on only when that is said again") {
  PlaceToResume place;
  write_file(place.folder / "plate/case.lua", std::string(long_plate) + "print(os.execute ~= nil)\n");
  REQUIRE(place.cdem({"run", "plate/case.lua", "--unsafe"}, SIGINT, "begins").exit_code == 130);
  const Outcome refused = place.cdem({"resume", "results/plate"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, StartsWith("cdem: error: ") && Contains("cdem resume results/plate --unsafe"));
  CHECK(lines_of(refused.err).size() == 1);
  const Outcome ended = place.cdem({"resume", "results/plate", "--unsafe"});
  CHECK(ended.exit_code == 0);
  CHECK_THAT(ended.out, Contains("\ntrue"));
  CHECK(read_file(place.results / "report.json") == whole_report());
}

TEST_CASE("resume: a script that failed after it had solved is mended and goes on, with --unsafe too") {
  const std::string wrong = "model:picture{ file = 'end.png', color = 'velocity.y' }\n";
  for (const bool unsafe : {false, true}) {
    PlaceToResume place;
    const std::vector<std::string> flag =
        unsafe ? std::vector<std::string>{"--unsafe"} : std::vector<std::string>{};
    const auto with_flag = [&](std::vector<std::string> words) {
      words.insert(words.end(), flag.begin(), flag.end());
      return words;
    };
    write_file(place.folder / "plate/case.lua", long_plate + wrong);
    const Outcome failed = place.cdem(with_flag({"run", "plate/case.lua"}));
    CHECK(failed.exit_code == 2);
    CHECK_THAT(failed.err, Contains("color: no such key; did you mean colour?"));
    const std::string command = std::string("cdem resume results/plate") + (unsafe ? " --unsafe" : "") + "\n";
    CHECK_THAT(failed.out, Contains("what was solved is kept: mend the script, then go on with " + command));
    write_file(place.folder / "plate/case.lua", std::string(long_plate) + "print 'mended'\n");
    const Outcome ended = place.cdem(with_flag({"resume", "results/plate"}));
    INFO(ended.err);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, Contains("mended") && !Contains("stage 1 relax") && !Contains("stage 2 run"));
    CHECK(read_file(place.results / "report.json") == whole_report());
    CHECK_THAT(read_file(place.results / "case.lua"), Contains("mended"));
    CHECK_FALSE(fs::exists(place.results / "checkpoint_1.cdem"));
  }
}

TEST_CASE("resume: a run goes on from whatever folder one stands in") {
  // Functions of the script and of a file that it requires, in calls and stages before the stop.
  std::string text = long_plate;
  const std::string begins = "print \"begins\"\n";
  text.replace(text.find(begins), begins.size(), "require 'parts.push' (model)\n" + begins);
  std::string whole;
  for (const auto& [stand, output] : std::vector<std::pair<std::string, std::string>>{
           {"job", "out"}, {"", "job/out"}, {"elsewhere", "../job/out"}, {"job/out", "."}}) {
    INFO(stand);
    PlaceToResume place;
    write_file(place.folder / "job/case.lua", text);
    write_file(place.folder / "job/parts/push.lua",
               "return function(model)\n"
               "  model:traction{ on = 'x+', stress = {1e3, 0, 0}, amplitude = function(t) return t end }\n"
               "  model:run{ steps = 5, every = 1, callback = function() end }\nend");
    fs::create_directories(place.folder / "elsewhere");
    const auto figures = [&] { // the warnings behind them name the script as it was typed
      const std::string report = read_file(place.folder / "job/out/report.json");
      CHECK_THAT(report, Contains("\"warnings\""));
      return report.substr(0, report.find("\"warnings\""));
    };
    place.start.folder = place.folder / "job";
    if (whole.empty()) {
      REQUIRE(place.cdem({"run", "case.lua", "--output", "out"}).exit_code == 0);
      whole = figures();
    }
    REQUIRE(place.cdem({"run", "case.lua", "--output", "out"}, SIGINT, "begins").exit_code == 130);
    place.start.folder = place.folder / stand;
    const Outcome ended = place.cdem({"resume", output});
    CHECK_THAT(ended.err, !Contains("error"));
    CHECK(ended.exit_code == 0);
    CHECK(figures() == whole);
  }
}

TEST_CASE("resume: a checkpoint of another run in the folder is refused") {
  PlaceToResume one, other;
  for (PlaceToResume* place : {&one, &other})
    CHECK(place->cdem({"run", "plate/case.lua", "--output", "results/plate"}, SIGINT, "begins").exit_code ==
          130);
  for (const std::string name : {"checkpoint_1.cdem", "checkpoint_2.cdem"}) {
    std::error_code none;
    fs::remove(one.results / name);
    fs::copy_file(other.results / name, one.results / name, none);
  }
  const Outcome refused = one.cdem({"resume", "results/plate"});
  CHECK(refused.exit_code == 4);
  CHECK_THAT(refused.err, Contains("of another run than the log beside it"));
  CHECK(lines_of(refused.err).size() == 1);
  CHECK(other.cdem({"resume", "results/plate"}).exit_code == 0);
}
