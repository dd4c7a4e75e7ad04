// Where the time of a step goes.
#include "libcdem/step/step_times.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace cdem;
using Catch::Matchers::StartsWith;

TEST_CASE("the lines of a step share all of the time, each what has passed since the one before", "[step]") {
  StepTimes times;
  const auto wait = [](int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  };
  wait(60);
  times.end(StepLine::elements);
  wait(5);
  times.end(StepLine::bonds);
  wait(60);
  times.end(StepLine::elements);
  double sum = 0;
  for (std::size_t i = 0; i < step_lines; ++i)
    sum += times.share(static_cast<StepLine>(i));
  CHECK(sum == Approx(1));
  CHECK(times.share(StepLine::elements) > 0.5);
  CHECK(times.share(StepLine::bonds) > 0);
  CHECK(times.share(StepLine::watch) == 0);
  CHECK_THAT(times.text(), StartsWith("elements "));
}
