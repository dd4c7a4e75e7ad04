// Tables as other programs write them: the same values whatever parts the cells, or one line that says why not.
#include "libgeom/assembly/discs.hpp"
#include "libgeom/core/text_table.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

// The values of a table with the columns "t" and "force", in a row.
std::vector<double> values(const std::string& text) {
  const TextTable table(text, "a.csv");
  std::vector<double> all;
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const char* name : {"t", "force"})
      all.push_back(table.number(row, table.find(name).value()));
  return all;
}

std::string refused(const std::string& text) {
  return testing::refusal([&] { values(text); });
}

} // namespace

TEST_CASE("a table has the same values whatever program wrote it", "[table]") {
  const std::vector<double> right{0, -1.5, 0.25, 2e-3};
  for (const char* text :
       {"t,force\n0,-1.5\n0.25,2e-3\n",                          // RFC 4180
        "\xef\xbb\xbft,force\r\n0,-1.5\r\n0.25,2e-3\r\n",        // a mark of UTF-8, ends of lines of Windows
        "t,force\r0,-1.5\r0.25,2e-3",                            // of old systems
        "t;force\n0;-1,5\n0,25;2e-3\n",                          // decimal comma
        "t;force\n0;-1.5\n0.25;2e-3\n",                          // semicolons with points
        "t\tforce\n0\t-1,5\n0,25\t2E-3\n",                       // tabs
        "t force\n0   -1.5\n 0.25 +2e-3\n",                      // blanks
        "sep=;\nt;force\n0;-1,5\n0,25;0,002\n",                  // Excel
        "t,force,\n0,-1.5,\n0.25,2e-3,\n,,\n",                   // an empty column and an empty row behind
        "t;force\n0;-1.5;;\n0.25;2e-3;;\n",                      // empty cells behind the rows
        "\"t\";\"force\"\n\"0\";\"-1,5\"\n\"0,25\";\"0,002\"\n", // quotes
        " T , Force \n 0 , -1.5 \n\n# a remark\n0.25,\xc2\xa0"
        "2e-3\n",                                               // capitals, blanks, remarks
        "FORCE;T\n-1,5;0\n2e-3;0,25\n",                         // another order
        "note,t,force\n\"of\nday 1\",0,-1.5\nb,0.25,2e-3\n"}) { // a break within quotes
    INFO(text);
    CHECK(refused(text) == "");
    CHECK(values(text) == right);
  }
}

TEST_CASE("a table that can mean two things is refused with line and column", "[table]") {
  CHECK_THAT(refused("t;force\n0;1,234\n"), Contains("line 2") && Contains("\"force\"") &&
                                                Contains("may be a decimal mark or stand between thousands"));
  CHECK_THAT(refused("t;force\n0;0,5\n1;1.234\n"), Contains("line 3") && Contains("decimal comma"));
  CHECK_THAT(refused("t;force\n0;1.234,5\n"), Contains("marks between thousands"));
  CHECK_THAT(refused("t;force\n0;1,234,567\n"), Contains("marks between thousands"));
  CHECK_THAT(refused("t,force\n0,1,5\n"),
             Contains("line 2 has 3 values: must be 2") && Contains("semicolons"));
  CHECK_THAT(refused("t,force\n0\n"), Contains("line 2 has 1 value: must be 2"));
  CHECK_THAT(refused("t,force\n\n# x\n0,1 2\n"), Contains("line 4") && Contains("\"1 2\": must be a number"));
  CHECK_THAT(refused("t,T,force\n0,1,2\n") + refused("t,force,Force\n1,2,3\n"),
             Equals("")); // exact names win
  CHECK_THAT(refused("T,t ,force\n0,1,2\n"), Equals(""));
  CHECK_THAT(refused("x,Force,FORCE,t\n0,1,2,3\n"), Contains("more than one column \"force\""));
  CHECK_THAT(refused("t,force\n0,\"1\n"), Contains("line 2: a quote is opened and never closed"));
  CHECK_THAT(refused("t,force\n0,\"1\"5\n"), Contains("line 2") && Contains("behind a closed quote"));
  CHECK_THAT(refused("\xff\xfet\0"), Contains("UTF-16"));
  CHECK_THAT(refused(std::string("t,force\n0,\0\n", 12)), Contains("no text"));
  CHECK_THAT(refused(""), Contains("is empty"));
}

TEST_CASE("a table without names has its columns by number, and an empty cell is nan", "[table]") {
  const TextTable table("0;0,5\n1;\n", "a.csv");
  CHECK(table.names().empty());
  REQUIRE(table.rows() == 2);
  CHECK(table.number(0, 1) == 0.5);
  CHECK(std::isnan(table.number(1, 1)));
}

TEST_CASE("discs are found under the names that surveys give their columns", "[discs][table]") {
  for (const char* text : {"ID,X,Y,Z,Dip,DipDir,Radius,Set\n7,1,2,3,30,90,1.5,a\n",
                           "\xef\xbb\xbfset;id;x (m);y (m);z (m);dip [deg];dip direction [deg];radius (m)\n"
                           "a;7;1,0;2;3;30,0;90;1,5\n"}) {
    const auto discs = read_discs(text, "dfn.csv");
    REQUIRE(discs.size() == 1);
    CHECK(discs[0].id == 7);
    CHECK(discs[0].centre == Vec3(1, 2, 3));
    CHECK(discs[0].radius == 1.5);
    CHECK(discs[0].dip_direction == Approx(std::acos(0.0)));
    CHECK(discs[0].set == "a");
  }
  // Another unit is another quantity.
  CHECK_THAT(testing::refusal([] {
               read_discs("id,x (ft),y,z,dip,dip_direction,radius,set\n1,0,0,0,30,90,1,a\n", "dfn.csv");
             }),
             Contains("no column \"x\""));
}
