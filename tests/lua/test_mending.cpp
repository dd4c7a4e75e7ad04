// A script that fails after hours of solving loses nothing: it is mended and goes on behind what was solved.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string wrong = "model:picture{ file = 'end.png', color = 'stress.xx' }\n";
const std::string right = "model:picture{ file = 'end.png', colour = 'stress.xx', size = {64, 64} }\n";

const std::string solved =
    column("{8, 4, 4}", "{2, 1, 1}") +
    "local helper = require 'helper'\n"
    "local calls = 0\n"
    "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n"
    "model:relax{ residual = 1e-6 }\n"
    "model:initial_velocity{ velocity = {0.1, 0, 0} }\n"
    "model:run{ steps = 700, every = 50, callback = function() calls = calls + 1 end }\n";
const std::string told =
    "cdem.report{ { name = 'hash', value = model.state_hash }, { name = 'calls', value = calls },\n"
    "  { name = 'reach', value = model:max('displacement.x') * helper.factor } }\n";

struct Mended : Script {
  explicit Mended(const std::string& text) : Script(text) { write("helper.lua", "return { factor = 1 }"); }

  // What the stages of the next run cost: looks whether the user wants to stop, every 16 steps.
  int looks() {
    int count = 0;
    listener->stop = [&] {
      count += listener->activity == cdem::Activity::stage ? 1 : 0; // not behind calls
      return false;
    };
    listener->lines.clear();
    run();
    listener->stop = nullptr;
    return count;
  }
  void mend(const std::string& text) {
    write("case.lua", text);
    settings.resume = newest_checkpoint(settings.output).file;
  }
  bool checkpoint() const { return wrote("checkpoint_1.cdem") || wrote("checkpoint_2.cdem"); }
  std::string report() const {
    std::string all = read("report.json");
    const std::string own = folder.filename().string();
    for (auto at = all.find(own); at != std::string::npos; at = all.find(own))
      all.erase(at, own.size());
    return all;
  }
  std::string last_line() const { return listener->lines.empty() ? "" : listener->lines.back(); }
};

} // namespace

TEST_CASE("a script that failed behind its stages goes on when it is mended, and solves nothing again",
          "[checkpoint]") {
  Mended whole(solved + right + told);
  const int cost = whole.looks();
  REQUIRE(cost > 40);
  for (const std::string reads : {"", "print(model:max('velocity.x'))\nmodel:fix{ on = 'x+', axes = 'y' }\n"
                                      "model:save{ file = 'end.vtu', series = 'end.pvd' }\n"}) {
    Mended script(solved + reads + wrong + told);
    CHECK_THAT(script.error(), Contains("color: no such key; did you mean colour?"));
    CHECK_THAT(script.last_line(), Contains("mend the script, then go on with cdem resume ") &&
                                       Contains(script.settings.output.string()));
    script.mend(solved + reads + right + told);
    CHECK(script.looks() < 5);
    CHECK(script.report() == whole.report());
    CHECK(script.wrote("end.png"));
    CHECK_FALSE(script.checkpoint());
  }
}

TEST_CASE("a stage whose callback failed goes on where it can be left, with the mended callback",
          "[checkpoint]") {
  const auto text = [](const std::string& late) {
    return solved +
           "model:run{ steps = 1000, every = 50, callback = function()\n"
           "  calls = calls + 1\n  if model.steps > limit then " +
           late + " end\nend }\n" + told;
  };
  const std::string front = "local limit = 0\n", set = "limit = model.steps + 700\n";
  const auto script_with = [&](const std::string& late) {
    std::string all = text(late);
    return front + all.insert(all.rfind("model:run{ steps = 1000"), set);
  };
  Mended whole(script_with("model:max('velocity.x')"));
  const int cost = whole.looks();
  Mended script(script_with("model:max('velocity.xx')"));
  CHECK_THAT(script.error(), Contains("velocity.xx"));
  CHECK_THAT(script.last_line(), Contains("mend the script"));
  script.mend(script_with("model:max('velocity.x')"));
  CHECK(script.looks() < cost / 2); // of the last 400 steps; 600 are not made again
  CHECK(script.report() == whole.report());
}

TEST_CASE("what a mended script did before it failed must stay as it was, a file it requires may change",
          "[checkpoint]") {
  Mended script(solved + wrong + told);
  script.error();
  std::string other = solved;
  other.replace(other.find("steps = 700"), 11, "steps = 701");
  script.mend(other + right + told);
  const std::string error = script.error();
  CHECK_THAT(error, Contains("what it did before it failed must stay as it was"));
  CHECK(error.find('\n') == std::string::npos);
  CHECK(script.checkpoint());
  script.mend(solved + right + told);
  script.write("helper.lua", "return { factor = 2 }");
  CHECK(script.looks() < 5);
  Mended whole(solved + right + told);
  whole.write("helper.lua", "return { factor = 2 }");
  whole.run();
  CHECK(script.report() == whole.report());
}

TEST_CASE("a script may fail and be mended again and again", "[checkpoint]") {
  const std::string more = "model:run{ steps = 300 }\n", again = "print(helper.factor.more)\n";
  Mended whole(solved + right + more + told);
  whole.run();
  Mended script(solved + wrong + more + told);
  script.error();
  script.mend(solved + right + more + again + told);
  CHECK_THAT(script.error(), Contains("helper") || Contains("attempt to index"));
  script.mend(solved + right + more + told);
  CHECK(script.looks() < 5);
  CHECK(script.report() == whole.report());
}

TEST_CASE("a refused stage begins anew when its arguments are mended", "[checkpoint]") {
  const std::string refused = "model:run{ steps = 300, time_step = 1 }\n",
                    more = "model:run{ steps = 300 }\n";
  Mended whole(solved + more + told);
  whole.run();
  Mended script(solved + refused + told);
  CHECK_THAT(script.error(), Contains("time_step"));
  script.mend(solved + more + told);
  script.run();
  CHECK(script.report() == whole.report());
}

TEST_CASE("a file that is missing behind the stages can be brought, and the script goes on as it is",
          "[checkpoint]") {
  const std::string reads = "print(cdem.read_csv('late.csv').x[1])\n";
  Mended script(solved + reads + told);
  CHECK_THROWS_AS(script.run(), FileError);
  CHECK_THAT(script.last_line(), Contains("mend the script"));
  script.write("late.csv", "x\n12\n");
  script.settings.resume = newest_checkpoint(script.settings.output).file;
  CHECK(script.looks() < 5);
  CHECK(script.last_line() == "12.0");
}

TEST_CASE("a solution that failed as the script expected is behind it when it goes on", "[checkpoint]") {
  const std::string fails = "model:force{ on = 'x+', force = {1e12, 0, 0} }\n"
                            "print((pcall(model.run, model, { steps = 5000 })))\n";
  Mended whole(solved + fails + right + told);
  whole.run();
  REQUIRE_THAT(whole.listener->lines.front(), Contains("false"));
  Mended script(solved + fails + wrong + told);
  script.error();
  script.mend(solved + fails + right + told);
  CHECK(script.looks() < 5);
  CHECK(script.report() == whole.report());
}

TEST_CASE("a sweep behind the last stage is not run again by a mended script", "[checkpoint]") {
  const std::string sweep = "print(cdem.sweep{ script = 'one.lua', set = { { a = 1 } } }[1].exit_code)\n";
  Mended script(solved + sweep + wrong);
  script.write("one.lua", "");
  script.write("program", "#!/bin/sh\necho run >> " + (script.folder / "count").string() + "\n");
  fs::permissions(script.folder / "program", fs::perms::owner_all);
  script.settings.program = (script.folder / "program").string();
  CHECK_THAT(script.error(), Contains("color"));
  script.mend(solved + sweep + right);
  script.run();
  CHECK(read_file(script.folder / "count") == "run\n");
}

TEST_CASE("a script that fails with nothing solved, or in a check, leaves no checkpoint", "[checkpoint]") {
  Mended early(column() + wrong);
  CHECK_THAT(early.error(), Contains("color"));
  CHECK_FALSE(early.checkpoint());
  CHECK(early.listener->lines.empty());
  Mended first(column() +
               "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n"
               "model:run{ steps = 100, every = 10, callback = function() " +
               wrong + " end }");
  CHECK_THAT(first.error(), Contains("color"));
  CHECK_FALSE(first.checkpoint());
  Mended checked(solved + wrong);
  checked.settings.check_only = true;
  CHECK_THAT(checked.error(), Contains("color"));
  CHECK_FALSE(checked.checkpoint());
}

TEST_CASE("a call that is refused half-way leaves nothing behind, so that the mended script goes on",
          "[checkpoint]") {
  const std::string rock =
      column("{4, 1, 1}", "{4, 1, 1}") +
      "local helper = require 'helper'\nlocal calls = 0\nmodel:fix{ on = 'x-' }\n"
      "model:traction{ on = 'x+', stress = {1e5, 0, 0} }\nmodel:relax{ max_steps = 200 }\n";
  const auto bolts = [](const std::string& angles) {
    return "model:bolts{ pattern = { centre = {2, 0, 0.1}, axis = 'y', radius = 0.2, length = 0.5, at = "
           "{0.5}, "
           "angles = {" +
           angles + "} }, area = 5e-4 }\n";
  };
  const std::string dig =
      "model:remove{ on = {function(x) return x > 3 end, function(x) return x > FAR end} }\n";
  const auto dug = [&](const std::string& far) {
    std::string text = dig;
    return text.replace(text.find("FAR"), 3, far);
  };
  const std::string after = "model:relax{ max_steps = 200 }\n" + told;
  for (const auto& [bad, good] :
       {std::pair(bolts("20, 90, 270"), bolts("20, 90")), std::pair(dug("9"), dug("2"))}) {
    INFO(bad);
    Mended whole(rock + good + after);
    whole.run();
    Mended script(rock + bad + after);
    CHECK_FALSE(script.error().empty());
    script.mend(rock + good + after);
    CHECK(script.error() == "");
    CHECK(script.report() == whole.report());
  }
}
