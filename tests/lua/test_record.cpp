// Structs as scripts give and get them: one declaration checks, reads and shows each member.
#include "lua/binding/module/record.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;

namespace {

enum class Law { straight, curved };

struct Part {
  double length = 1;
  std::optional<int> count;
};

struct Whole {
  double angle = 0; // rad
  Law law = Law::curved;
  Part part;
  std::vector<Part> more;
  geom::Box box;
  std::vector<std::string> names;
  double found() const { return 2 * part.length; }
};

const Record<Part> part_record{
    {{number("length").above(0).standard().unit("m"), &Part::length}, {integer("count"), &Part::count}}};

const Record<Whole> whole_record{
    "Whole",
    "Of parts.",
    {{number("angle").within(0, 90).in_degrees(), &Whole::angle},
     {choice("law", {"straight", "curved"}).standard(), &Whole::law},
     {record("part", part_record.fields()), &Whole::part, part_record},
     {list("more", record_type(part_record.fields()), 0), &Whole::more, part_record},
     {box("box"), &Whole::box},
     {list("names", text_type()), &Whole::names},
     {number("found").unit("m"), &Whole::found}}};

Table given_whole() {
  return {{"angle", 30},
          {"part", Table{{"length", 3}}},
          {"more", Table::list({Table{{"count", 4}}})},
          {"box", Table{{"min", geom::Vec3(0, 0, 0)}, {"max", geom::Vec3(1, 2, 3)}}},
          {"names", Table::list({"a", "b"})}};
}

} // namespace

TEST_CASE("what a script gives is read into the members", "[lua]") {
  const Whole whole = whole_record.read(check(given_whole(), whole_record.fields()));
  CHECK(whole.angle == radians(30));
  CHECK(whole.law == Law::curved);
  CHECK(whole.part.length == 3);
  CHECK_FALSE(whole.part.count);
  REQUIRE(whole.more.size() == 1);
  CHECK(whole.more[0].length == 1);
  CHECK(whole.more[0].count == 4);
  CHECK(whole.box.max == geom::Vec3(1, 2, 3));
  CHECK(whole.names == std::vector<std::string>{"a", "b"});
}

TEST_CASE("what a call returns reads back to the same members", "[lua]") {
  const Table first = whole_record(whole_record.read(check(given_whole(), whole_record.fields())));
  CHECK(first.named.at("found").number() == 6);
  Table again = first;
  again.named.erase("found"); // scripts get it alone
  const Table second = whole_record(whole_record.read(check(Value(again), whole_record.fields())));
  CHECK(canonical_text(Value(first)) == canonical_text(Value(second)));
}

TEST_CASE("a table that a call returns has every member that is no option", "[lua]") {
  for (const Field& field : RecordType(whole_record).fields)
    CHECK(field.must);
  CHECK_FALSE(RecordType(part_record).fields[1].must);
}

TEST_CASE("rows become columns under the same names", "[lua]") {
  const Table columns = part_record.columns(std::vector<Part>{{1, 2}, {3, 4}});
  CHECK(describe(columns.named.at("length")) == "{1, 3}");
  CHECK(part_record.of_columns().fields[0].type.lua_type() == "number[]");
}

TEST_CASE("a member that varies takes a function of the script, or a number or vector", "[lua]") {
  struct Push {
    std::function<double(double)> size;
    std::function<geom::Vec3(const geom::Vec3&, double)> along;
    bool late = true;
  };
  struct Doubling final : Reference {
    Values call(const Values& given) const override { return {2 * given[0].number()}; }
    Value copy() const override { return {}; }
    std::string place() const override { return "case.lua:1"; }
  };
  const Record<Push> record{
      {{number_or_function("size", "(time: number): number").at_least(0).unit("N"), &Push::size},
       {vec3_or_function("along", "(x: number, y: number, z: number, time: number): number[]"), &Push::along},
       {choice("when", {"early", "late"}).standard(), &Push::late}}};
  const Push constant = record.read(
      check(Table{{"size", 3}, {"along", geom::Vec3(1, 2, 3)}, {"when", "early"}}, record.fields()));
  CHECK(constant.size(7) == 3);
  CHECK(constant.along(geom::Vec3(0, 0, 0), 7) == geom::Vec3(1, 2, 3));
  CHECK_FALSE(constant.late);
  const Value doubling(std::static_pointer_cast<Reference>(std::make_shared<Doubling>()));
  const Push varying = record.read(check(Table{{"size", doubling}, {"along", doubling}}, record.fields()));
  CHECK(varying.size(4) == 8);
  CHECK_THROWS_WITH(varying.size(-4), "size(-4) of case.lua:1 = -8: must be a finite number >= 0 N");
  CHECK_THROWS_WITH(varying.along(geom::Vec3(1, 2, 3), 4),
                    "along(1, 2, 3, 4) of case.lua:1 = 2: must be three finite numbers {x, y, z}");
  CHECK(varying.late);
  CHECK_FALSE(record.read(check(Table(), record.fields())).size);
}

TEST_CASE("every default that a struct gives is known", "[lua]") {
  const auto require_known = [](const std::string& call, const std::vector<Field>& fields) {
    for (const Field& field : fields) {
      INFO(call << ": " << field.name);
      CHECK((!field.own_standard || !field.standard_value.is_nil()));
    }
  };
  for (const Function& function : module().functions)
    require_known(function.name, function.fields);
  for (const Class& one : module().classes)
    for (const Function& function : one.methods)
      require_known(one.name + ":" + function.name, function.fields);
}
