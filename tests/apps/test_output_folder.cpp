#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/results/output_folder.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/runtime/engine.hpp"
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <unistd.h>

using namespace cdem::app;
using Catch::Matchers::Contains;
using cdem::script::FileError;
using testing::read_file;
using testing::TempFolder;
using testing::write_file;
namespace fs = std::filesystem;

namespace {

// A script, and a run of it that writes the named files.
struct Case {
  TempFolder folder;
  fs::path script = folder / "plate/case.lua", results = folder / "results/plate";
  Case() { write_file(script, "-- a case\n"); }

  void run(const std::vector<std::string>& names, ExitCode code = ExitCode::success) const {
    OutputFolder output(results, script, "a run");
    for (const auto& name : names) {
      output.will_write(results / name);
      write_file(results / name, "result " + name);
    }
    output.finish(code, code == ExitCode::success ? "" : "case.lua:1: wrong");
  }
};

// root may do everything: as root, the rest of the test is somebody else's.
class WithoutRoot {
public:
  WithoutRoot() {
    if (geteuid() == 0)
      REQUIRE(seteuid(65534) == 0);
  }
  ~WithoutRoot() {
    if (getuid() == 0 && seteuid(0) != 0)
      std::abort();
  }
  WithoutRoot(const WithoutRoot&) = delete;
  WithoutRoot& operator=(const WithoutRoot&) = delete;
};

} // namespace

TEST_CASE("a case is named after its folder, its script and its settings") {
  CHECK(case_name("/home/a/plate/case.lua", {}) == "plate");
  CHECK(case_name("/home/a/plate/beam.lua", {}) == "plate-beam");
  CHECK(case_name("/home/a/plate/case.lua", {{"pressure", "24e6"}, {"cohesion", "8e6"}}) ==
        "plate-cohesion=8e6,pressure=24e6");
  CHECK(case_name("/case.lua", {}) == "case");
}

TEST_CASE("names that need cleaning stay apart") {
  const std::string a = case_name("/x/plate/case.lua", {{"mode", "a/b"}}),
                    b = case_name("/x/plate/case.lua", {{"mode", "a b"}});
  CHECK_THAT(a, Catch::Matchers::StartsWith("plate-mode=a_b-"));
  CHECK(a != b);
  CHECK(a.find('/') == std::string::npos);
  CHECK(case_name("/x/plate/case.lua", {{"text", std::string(1000, 'y')}}).size() < 200);
}

TEST_CASE("a run leaves its script, its log and the list of its files") {
  const Case c;
  c.run({"ux.png", "series/a.vtu"});
  CHECK(read_file(c.results / "case.lua") == "-- a case\n");
  const auto files = files_of_run_log(c.results / run_log_name);
  REQUIRE(files.size() == 3);
  CHECK(files[0].name == "case.lua");
  CHECK(files[1].name == "series/a.vtu");
  CHECK(files[1].bytes == std::string("result series/a.vtu").size());
  CHECK(summary_of_run_log(c.results / run_log_name).exit_code == 0);
}

TEST_CASE("the next run takes the old results away, and nothing else") {
  const Case c;
  c.run({"ux.png", "series/a.vtu", "report.md"});
  write_file(c.results / "notes.txt", "mine");
  write_file(c.results / "report.md", "my remarks on the report");
  c.run({"uy.png"});
  CHECK_FALSE(fs::exists(c.results / "ux.png"));
  CHECK_FALSE(fs::exists(c.results / "series"));
  CHECK(fs::exists(c.results / "uy.png"));
  CHECK(read_file(c.results / "notes.txt") == "mine");
  CHECK(read_file(c.results / "report.md.edited") == "my remarks on the report");
  write_file(c.results / "uy.png", "painted over");
  c.run({"uy.png"});
  CHECK(read_file(c.results / "uy.png.edited") == "painted over");
  CHECK(read_file(c.results / "uy.png") == "result uy.png");
}

TEST_CASE("the first file of a run may lie in a folder of the last one, or have the name of it") {
  const Case place;
  place.run({"frames/1.png"});
  for (const std::string name : {"frames/1.png", "frames", "frames/1.png"}) {
    OutputFolder output(place.results, place.script, "a run");
    cdem::script::Files files(place.script, place.results, {}, false);
    files.will_write = [&](const fs::path& file) { output.will_write(file); };
    const fs::path file = files.to_write(name);
    REQUIRE(fs::is_directory(file.parent_path()));
    write_file(file, "result");
    output.finish(ExitCode::success, "");
  }
}

TEST_CASE("a run that fails before it produces anything leaves the old results") {
  const Case c;
  c.run({"ux.png"});
  c.run({}, ExitCode::bad_input);
  CHECK(fs::exists(c.results / "ux.png"));
  CHECK(summary_of_run_log(c.results / run_log_name).exit_code == 0);
  const RunLogSummary failed = summary_of_run_log(c.results / "failed.log");
  CHECK(failed.exit_code == 2);
  CHECK(failed.error == "case.lua:1: wrong");
  SECTION("and the next good run clears that log away") {
    c.run({"ux.png"});
    CHECK_FALSE(fs::exists(c.results / "failed.log"));
  }
}

TEST_CASE("a run that fails after its first result replaces the old ones") {
  const Case c;
  c.run({"ux.png"});
  c.run({"initial.png"}, ExitCode::solution_failed);
  CHECK_FALSE(fs::exists(c.results / "ux.png"));
  CHECK(fs::exists(c.results / "initial.png"));
  CHECK(summary_of_run_log(c.results / run_log_name).exit_code == 3);
}

TEST_CASE("results of a run that was killed are known by what it announced") {
  const Case c;
  {
    OutputFolder output(c.results, c.script, "a run");
    output.will_write(c.results / "ux.png");
    write_file(c.results / "ux.png", "half a picture");
    output.log("a sign of life"); // and no finish()
  }
  CHECK_FALSE(summary_of_run_log(c.results / run_log_name).exit_code);
  c.run({"uy.png"});
  CHECK_FALSE(fs::exists(c.results / "ux.png"));
}

TEST_CASE("folders that are not ours are refused and left as they are") {
  const Case c;
  const auto make = [&](const fs::path& folder) { OutputFolder(folder, c.script, "a run"); };
  write_file(c.results / "thesis.txt", "years of work");
  CHECK_THROWS_WITH(make(c.results), Contains("not results of cdem") && Contains("--output"));
  write_file(c.results / "cdem.log", "a log of somebody else\n");
  CHECK_THROWS_AS(make(c.results), FileError);
  CHECK(read_file(c.results / "thesis.txt") == "years of work");
  CHECK_THROWS_WITH(make(c.script), Contains("is a file"));
  CHECK_THROWS_WITH(make(c.script / "below"), Contains("cannot be made"));
  CHECK_THROWS_WITH(make(c.script.parent_path()), Contains("holds the script itself"));
  CHECK_THROWS_WITH(make(c.folder.path()), Contains("holds the script itself"));
}

TEST_CASE("an empty folder is taken") {
  const Case c;
  fs::create_directories(c.results);
  c.run({"ux.png"});
  CHECK(fs::exists(c.results / "ux.png"));
}

TEST_CASE("two runs at once cannot share a folder") {
  const Case c;
  OutputFolder first(c.results, c.script, "a run");
  CHECK_THROWS_WITH(OutputFolder(c.results, c.script, "another"), Contains("in use by another run"));
}

TEST_CASE("a folder or file without permission is named with the reason") {
  TempFolder folder;
  fs::permissions(folder.path(), fs::perms(0755));
  const fs::path closed = folder / "closed", read_only = folder / "read_only",
                 unreadable = folder / "unreadable";
  write_file(closed / "out/cdem.log", run_log_head);
  write_file(closed / "case.lua", "");
  write_file(unreadable / "cdem.log", run_log_head);
  write_file(folder / "case.lua", "");
  fs::create_directories(read_only);
  fs::permissions(unreadable / "cdem.log", fs::perms(0));
  fs::permissions(read_only, fs::perms(0555));
  fs::permissions(closed, fs::perms(0));
  const WithoutRoot somebody;
  const auto says = [](const std::function<void()>& act) -> std::string {
    try {
      act();
    } catch (const FileError& error) {
      return error.what();
    } catch (const fs::filesystem_error& error) { // told of as a file error too
      return error.what();
    }
    return "";
  };
  const auto denied = Contains("Permission denied");
  CHECK_THAT(says([&] { info(closed / "out"); }), denied);
  CHECK_THAT(says([&] { info(unreadable); }), denied);
  CHECK_THAT(says([&] { resume({{}, closed / "out"}); }), denied);
  CHECK_THAT(says([&] { resume({{}, unreadable}); }), denied);
  CHECK_THAT(says([&] { require_script(closed / "case.lua"); }), denied);
  for (const fs::path& place : {closed, closed / "out", read_only, read_only / "out", unreadable})
    CHECK_THAT(says([&] { OutputFolder(place, folder / "case.lua", "a run"); }), denied);
  const cdem::script::Files files(folder / "case.lua", read_only, {}, false);
  CHECK_THAT(says([&] { files.to_read("closed/case.lua"); }), denied);
  CHECK_THAT(says([&] { files.to_read("unreadable/cdem.log"); }), denied);
  CHECK_THAT(says([&] { files.to_write("new/x"); }), denied);
  CHECK_THAT(says([&] { cdem::script::write_file(read_only / "x", ""); }), denied);
}
