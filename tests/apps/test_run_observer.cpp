#include "apps/cdem/progress/run_observer.hpp"
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace cdem::app;
using Catch::Matchers::Contains;
using testing::read_file;
using testing::TempFolder;
using testing::write_file;

TEST_CASE("a stage that goes on from a checkpoint ends with the time that all its steps took") {
  const TempFolder folder;
  write_file(folder / "plate/case.lua", "-- a case\n");
  OutputFolder output(folder / "results", folder / "plate/case.lua", "a run");
  RunObserver observer(ProgressStyle::none, &output);
  cdem::Progress progress;
  progress.stage = 2;
  progress.kind = "run";
  progress.step = 149001; // the first since
  progress.steps_per_second = 3;
  progress.wall_time = 40;
  observer.progress(progress);
  progress.step = 150000;
  progress.steps_per_second = 3500;
  progress.wall_time = 43;
  progress.last = true;
  observer.progress(progress);
  CHECK_THAT(read_file(folder / "results/cdem.log"), Contains("stage 2 run: 150,000 steps in 43 s,"));
}

TEST_CASE("the closing line of a run that goes on counts what came before") {
  RunObserver observer(ProgressStyle::none, nullptr);
  CHECK(observer.in_all().empty());
  observer.goes_on(3, 1000, 2);
  cdem::Progress progress;
  progress.stage = 1;
  progress.broken_tension = 1;
  progress.broken_shear = 200;
  progress.last = true;
  observer.progress(progress);
  CHECK(observer.in_all() == "1,204 broken (4 tension, 1,200 shear), 2 warnings; ");
}
