#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/process/failure.hpp"

#include <catch2/catch.hpp>

using namespace cdem::app;
using Catch::Matchers::Contains;

TEST_CASE("settings are split at the first equals sign") {
  const auto settings = settings_of({"pressure=24e6", "title=a=b"});
  CHECK(settings.at("pressure") == "24e6");
  CHECK(settings.at("title") == "a=b");
}

TEST_CASE("settings without a name, a value or given twice are refused") {
  CHECK_THROWS_AS(settings_of({"pressure"}), UsageError);
  CHECK_THROWS_AS(settings_of({"=1"}), UsageError);
  CHECK_THROWS_AS(settings_of({"pressure="}), UsageError);
  CHECK_THROWS_WITH(settings_of({"a=1", "a=2"}), Contains("--set a is given twice"));
}

TEST_CASE("a sweep runs every combination, the last name changing fastest") {
  const auto runs = combinations_of({"a=1,2", "b=x,y,z"});
  REQUIRE(runs.size() == 6);
  CHECK(runs[0] == std::map<std::string, std::string>{{"a", "1"}, {"b", "x"}});
  CHECK(runs[2] == std::map<std::string, std::string>{{"a", "1"}, {"b", "z"}});
  CHECK(runs[3] == std::map<std::string, std::string>{{"a", "2"}, {"b", "x"}});
}

TEST_CASE("a sweep of more runs than anybody means is refused") {
  std::string values = "0";
  for (int i = 1; i < 400; ++i)
    values += "," + std::to_string(i);
  CHECK(combinations_of({"a=" + values}).size() == 400);
  CHECK_THROWS_AS(combinations_of({"a=" + values, "b=" + values}), UsageError);
  CHECK_THROWS_AS(combinations_of({"a=1,,2"}), UsageError);
}

TEST_CASE("whole numbers outside their range are refused with the range") {
  CHECK(whole_number("--threads", "4", 1, 1024) == 4);
  for (const std::string text : {"0", "1025", "-1", "2.5", "two", "", "99999999999999999999"})
    CHECK_THROWS_WITH(whole_number("--threads", text, 1, 1024),
                      Contains("--threads = ") && Contains("from 1 to 1024"));
}

TEST_CASE("sizes and ranges of a picture") {
  CHECK(size_value("--size", "1600x1200") == std::array<int, 2>{1600, 1200});
  CHECK(size_value("--size", "800") == std::array<int, 2>{800, 0});
  CHECK(range_value("--range", "-1e-3,2") == std::array<double, 2>{-1e-3, 2});
  for (const std::string text : {"1600x", "x", "8x8", "1x2x3", "axb"})
    CHECK_THROWS_AS(size_value("--size", text), UsageError);
  for (const std::string text : {"1", "2,1", "1,1", "nan,1", "0,inf", "a,b", "1,2,3"})
    CHECK_THROWS_AS(range_value("--range", text), UsageError);
}
