// Arguments against their declaration, without Lua.
#include "libgeom/core/error.hpp"
#include "lua/binding/schema/schema.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace cdem::script;
using Catch::Matchers::Contains;

namespace {

const std::vector<Field> fields{
    number("ratio").between(-1, 0.5).required(),
    integer("count").at_least(1).standard(3),
    text("name"),
    flag("open").standard(false),
    choice("axes", {"x", "xy", "xyz"}),
    vec3("size").above(0),
    ivec3("divisions").at_least(1),
    list("values", number_type(), 2),
    list("rows", record_type({number("x").required(), text("label")})),
    list("pairs", tuple_type({text_type(), number_type()}), 0).beside({number("default").above(0)}),
    function("call", "()"),
    place("on")};

std::string error_for(Table table) {
  if (table.named.count("ratio") == 0)
    table.named["ratio"] = 0.25;
  try {
    check(Value(std::move(table)), fields);
  } catch (const geom::InputError& error) {
    return error.what();
  }
  return "no error";
}

Value list_of(Values values) {
  return Table::list(std::move(values));
}

} // namespace

TEST_CASE("good arguments come through, defaults are filled in", "[lua]") {
  const Arguments a =
      check(Value(Table{{"ratio", 0}, {"size", list_of({1, 2.5, 3})}, {"name", "a"}}), fields);
  CHECK(a.number("ratio") == 0);
  CHECK(a.integer("count") == 3);
  CHECK(a.vec3("size") == geom::Vec3(1, 2.5, 3));
  CHECK(a.text("name") == "a");
  CHECK_FALSE(a.flag("open"));
  CHECK_FALSE(a.has("axes"));
}

TEST_CASE("a list may take named values beside its items", "[lua]") {
  Table pairs{{"default", 2}};
  const auto given = [&] { return Value(Table{{"ratio", 0}, {"pairs", Value(pairs)}}); };
  CHECK(check(given(), fields).record("pairs")->number("default") == 2);
  CHECK(check(given(), fields).list("pairs").empty());
  pairs.items.push_back(list_of({"a", 3}));
  CHECK(check(given(), fields).list("pairs").size() == 1);
  CHECK(check(given(), fields).record("pairs")->number("default") == 2);
  CHECK_THAT(error_for({{"pairs", Value(Table{{"defualt", 2}})}}),
             Contains("pairs: defualt: no such key; did you mean default?"));
  CHECK_THAT(error_for({{"pairs", Value(Table{{"default", -1}})}}),
             Contains("pairs.default = -1: must be > 0"));
  CHECK_THAT(error_for({{"pairs", 3}}), Contains("and default = a number"));
}

TEST_CASE("an unknown key names the nearest right one and lists those allowed", "[lua]") {
  CHECK(error_for({{"cuont", 3}}) ==
        "cuont: no such key; did you mean count? Allowed: ratio, count, name, open, axes, size, divisions, "
        "values, rows, pairs, call, on");
  CHECK_THAT(error_for({{"banana", 3}}), Contains("banana: no such key. Allowed: ratio"));
}

TEST_CASE("a missing argument says what it must be", "[lua]") {
  try {
    check(Value(), fields);
    FAIL("must throw");
  } catch (const geom::InputError& error) {
    CHECK(std::string(error.what()) == "ratio: missing; must be a number in (-1, 0.5)");
  }
}

TEST_CASE("open ends of a range are not in it", "[lua]") {
  for (const double wrong : {-1.0, 0.5, 7.0})
    CHECK_THAT(error_for({{"ratio", wrong}}), Contains("must be in (-1, 0.5)"));
  for (const double right : {-0.999, 0.0, 0.4999})
    CHECK(error_for({{"ratio", right}}) == "no error");
  CHECK(error_for({{"count", 1}}) == "no error");
  CHECK(error_for({{"count", 0}}) == "count = 0: must be >= 1");
}

TEST_CASE("values that are not finite are refused", "[lua]") {
  CHECK_THAT(error_for({{"ratio", std::nan("")}}), Contains("ratio = nan: must be a finite number"));
  CHECK_THAT(error_for({{"ratio", -HUGE_VAL}}), Contains("ratio = -inf: must be a finite number"));
  CHECK_THAT(error_for({{"size", list_of({1, std::nan(""), 1})}}), Contains("size[2] = nan"));
  CHECK_THAT(error_for({{"values", list_of({1, HUGE_VAL})}}), Contains("values[2] = inf"));
}

TEST_CASE("a wrong type is named with what to do", "[lua]") {
  CHECK(error_for({{"ratio", "0.3"}}) == "ratio = \"0.3\": must be a number; write it without quotes");
  CHECK(error_for({{"ratio", true}}) == "ratio = true: must be a number");
  CHECK(error_for({{"count", 2.5}}) == "count = 2.5: must be a whole number");
  CHECK(error_for({{"name", 3}}) ==
        "name = 3: must be a string; write it in quotes, or tostring(...) around it");
  CHECK(error_for({{"open", "yes"}}) == "open = \"yes\": must be true or false");
  CHECK_THAT(error_for({{"size", 2}}), Contains("three numbers {x, y, z}; write all three"));
  CHECK_THAT(error_for({{"size", list_of({1, 2})}}), Contains("size = {1, 2}: must be three numbers"));
  CHECK(error_for({{"size", list_of({1, 2, 0})}}) == "size[3] = 0: must be > 0");
  CHECK(error_for({{"divisions", list_of({1, 1.5, 1})}}) == "divisions[2] = 1.5: must be a whole number");
  CHECK_THAT(error_for({{"values", 3}}), Contains("put it in braces: {3}"));
  CHECK_THAT(error_for({{"values", list_of({3})}}), Contains("a list of at least 2 items"));
  CHECK_THAT(error_for({{"call", 3}}), Contains("must be a function"));
  CHECK(error_for({{"axes", "zyx"}}).rfind("axes = \"zyx\": must be one of \"x\", \"xy\", \"xyz\"", 0) == 0);
}

TEST_CASE("errors inside lists and tables give the path", "[lua]") {
  CHECK(error_for({{"rows", list_of({Table{{"x", 1}}, Table{{"x", "1"}}})}}) ==
        "rows[2].x = \"1\": must be a number; write it without quotes");
  CHECK_THAT(error_for({{"rows", list_of({Table{{"x", 1}, {"lable", "a"}}})}}),
             Contains("rows[1]: lable: no such key; did you mean label?"));
  CHECK_THAT(error_for({{"rows", Table{{"x", 1}}}}), Contains("one more pair of braces"));
  CHECK_THAT(error_for({{"pairs", list_of({list_of({"a"})})}}), Contains("pairs[1] = {\"a\"}"));
  CHECK(error_for({{"pairs", list_of({list_of({"a", 1})})}}) == "no error");
}

TEST_CASE("a list with a hole is refused, never shortened", "[lua]") {
  Table holed = Table::list({1, 2});
  holed.odd_keys = "item 4: a list has items 1, 2, 3 ... without holes";
  CHECK_THAT(error_for({{"values", holed}}), Contains("values: item 4: a list has items 1, 2, 3"));
  CHECK_THAT(error_for({{"values", list_of({1, Value(), 3})}}),
             Contains("values[2] = nil: must be a number"));
}

TEST_CASE("the hash of arguments tells them apart and does not depend on order", "[lua]") {
  const auto hash = [](Table t) { return fnv1a(canonical_text(Value(std::move(t)))); };
  CHECK(hash({{"a", 1}, {"b", 2}}) == hash({{"b", 2}, {"a", 1}}));
  CHECK(hash({{"a", 1}}) != hash({{"a", 2}}));
  CHECK(hash({{"a", 0.1}}) != hash({{"a", std::nextafter(0.1, 1)}}));
  CHECK(hash({{"a", "1"}}) != hash({{"a", 1}}));
  // Published values of FNV-1a, 64 bit.
  CHECK(fnv1a("") == 0xcbf29ce484222325ULL);
  CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cULL);
  CHECK(fnv1a("foobar") == 0x85944171f73967e8ULL);
}
