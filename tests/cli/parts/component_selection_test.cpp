// SPDX-License-Identifier: BSD-3-Clause
//
// The conditions of `tegl components --select`, and the tables and units of reports.
#include "input/component_selection.hpp"

#include <gmock/gmock.h>

#include "base/table.hpp"
#include "base/units.hpp"
#include "errors.hpp"

namespace tegl::cli {
namespace {

/// A component of size 12, x from -1 to 2, y from 0 to 5, t from 3 to 7; open.
ComponentFacts facts() {
  ComponentFacts result;
  result.label = 4;
  result.rank = 2;
  result.vertices = 100;
  result.simplices = 180;
  result.size = 12;
  result.euler = -2;
  result.boundary = 6;
  result.lowest = {-1, 0, 3};
  result.highest = {2, 5, 7};
  result.centroid = {0.5, 2, 6};
  return result;
}

bool holds(const std::string& condition) { return ComponentSelection(condition, {"x", "lat", "t"})(facts()); }

TEST(ComponentSelection, ComparesQuantitiesWithNumbers) {
  for (const char* condition : {"size > 10", "size>=12", "size<=12", "size = 12", "size==12", "size != 3", "area < 1e2",
                                "label=4", "rank <= 2", "vertices=100", "simplices=180", "euler<-1", "boundary>5",
                                "x.min = -1", "lat.max=5", "t.span=4", "t.centroid > 5.9", "LAT.max=5", "SIZE > 1"})
    EXPECT_TRUE(holds(condition)) << condition;
  for (const char* condition : {"size > 12", "size<12", "size!=12", "t.span > 4", "euler >= 0", "label = 3"})
    EXPECT_FALSE(holds(condition)) << condition;
}

TEST(ComponentSelection, AsksForRangesAlongAxes) {
  for (const char* condition : {"t contains 3", "t contains 7", "t contains 6.5", "t meets 7..9", "t meets -1e1..3",
                                "t within 3..7", "lat within -1..5.5", "y contains 1"})
    EXPECT_TRUE(holds(condition)) << condition;
  for (const char* condition : {"t contains 2.9", "t meets 7.1..9", "t within 3.1..7", "x contains 2.5"})
    EXPECT_FALSE(holds(condition)) << condition;
}

TEST(ComponentSelection, JoinsConditionsAsPeopleExpect) {
  for (const char* condition :
       {"size > 10 and t contains 5", "size > 100 or open", "not closed", "not (size > 100 or closed)",
        "size > 10 or size > 100 and closed", "not size > 100 and open", "((open))", "not not open"})
    EXPECT_TRUE(holds(condition)) << condition;
  for (const char* condition : {"size > 10 and closed", "(size > 10 or size > 100) and closed", "not open"})
    EXPECT_FALSE(holds(condition)) << condition;
}

TEST(ComponentSelection, OfAnOpenOneComparesNoContent) {
  EXPECT_FALSE(holds("content > 0"));
  EXPECT_FALSE(holds("content <= 0"));
  EXPECT_TRUE(holds("not content > 0"));
  ComponentFacts closed = facts();
  closed.content = -3;
  EXPECT_TRUE(ComponentSelection("content < 0", {"x", "y", "z"})(closed));
}

TEST(ComponentSelection, RefusesWhatItDoesNotUnderstandAndSaysWhere) {
  const auto refused = [](const std::string& condition, const std::string& message) {
    test::expect_error(ErrorCode::InvalidArgument, message, [&] { holds(condition); });
  };
  refused("", "ends; expected one of label, rank");
  refused("sise > 3", "has 'sise' at 1; expected one of label, rank");
  refused("size", "ends; expected <, <=");
  refused("size > ", "ends; expected a number");
  refused("size > big", "has 'big' at 8; expected a number");
  refused("size > nan", "expected a number");
  refused("size > 3 4", "has '4' at 10; expected 'and', 'or' or the end");
  refused("(size > 3", "ends; expected ')'");
  refused("size > 3)", "has ')' at 9");
  refused("t", "expected 'contains NUMBER'");
  refused("t > 3", "has '>' at 3; expected 'contains NUMBER'");
  refused("t meets 3", "expected a range, as in 2.5..7");
  refused("t meets 7..3", "from low to high");
  refused("t.middle > 3", "expected one of");
  refused("w contains 3", "an axis, x, lat, t");
  refused("size > 3 and", "ends; expected one of");
  refused("size ~ 3", "has '~' at 6; expected <");
  refused(std::string(10000, '('), "no more than 100 levels");
}

TEST(Table, AlignsColumnsAndQuotesCells) {
  const Table table{{"a", "long"}, {{"123", "µ"}, {"4", "x,\"y\""}}};
  EXPECT_EQ(table.to_text(10), "    a   long\n  123      µ\n    4  x,\"y\"\n");
  EXPECT_EQ(table.to_text(1), "    a  long\n  123     µ\n");
  EXPECT_EQ(table.to_csv(), "a,long\n123,µ\n4,\"x,\"\"y\"\"\"\n");
  EXPECT_EQ(exact_number(0.1), "0.1");
}

TEST(Units, FollowFromThoseOfTheAxes) {
  EXPECT_EQ(measure_unit({"mm", "mm", "mm"}, 2), "mm^2");
  EXPECT_EQ(measure_unit({"mm", "mm"}, 1), "mm");
  EXPECT_EQ(measure_unit({"", ""}, 1), "");
  EXPECT_EQ(measure_unit({"mm", "mm", "s"}, 2), std::nullopt);
  EXPECT_EQ(content_unit({"mm", "mm", "mm", "s"}), "mm^3 s");
  EXPECT_EQ(content_unit({"m/s", "m/s"}), "(m/s)^2");
  EXPECT_EQ(content_unit({"", ""}), "");
  EXPECT_EQ(content_unit({"mm", ""}), std::nullopt);
  EXPECT_EQ(with_unit("3", "mm"), "3 mm");
  EXPECT_EQ(with_unit("3", ""), "3");
  EXPECT_EQ(measure_name(3, 4), "3-volume");
  EXPECT_EQ(measure_name(3, 3), "volume");
}

}  // namespace
}  // namespace tegl::cli
