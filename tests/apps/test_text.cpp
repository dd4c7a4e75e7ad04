#include "apps/cdem/text/text.hpp"

#include <catch2/catch.hpp>

using namespace cdem::app;

TEST_CASE("durations read naturally at every length") {
  CHECK(duration_text(0.42) == "0.4 s");
  CHECK(duration_text(12.4) == "12 s");
  CHECK(duration_text(59.6) == "1 min 00 s");
  CHECK(duration_text(185) == "3 min 05 s");
  CHECK(duration_text(2 * 3600 + 7 * 60) == "2 h 07 min");
  CHECK(duration_text(3 * 86400 + 4 * 3600) == "3 d 4 h");
}

TEST_CASE("counts have a comma every three digits") {
  CHECK(count_text(0) == "0");
  CHECK(count_text(999) == "999");
  CHECK(count_text(1000) == "1,000");
  CHECK(count_text(-1234567) == "-1,234,567");
}

TEST_CASE("a table is as wide as its widest cells") {
  CHECK(table_text({{"a", "bb"}, {"long", "c"}, {"x"}}) == "  a     bb\n  long  c\n  x\n");
}
