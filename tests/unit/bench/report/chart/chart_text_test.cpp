// Text in charts: the chart stays valid XML whatever a name contains.
#include "tests/bench/report/chart/chart_text.hpp"

#include <catch2/catch.hpp>

using namespace runstone::bench::chart;

TEST_CASE("text is escaped for tags and attributes alike", "[chart]") {
  CHECK(escaped("a < b && c > \"d\" 'e'") ==
        "a &lt; b &amp;&amp; c &gt; &quot;d&quot; &#39;e&#39;");
  CHECK(escaped("64\xC2\xB3, \xC2\xB5s \xF0\x9F\x98\x80") ==
        "64\xC2\xB3, \xC2\xB5s \xF0\x9F\x98\x80");
}

TEST_CASE("bytes that are no UTF-8 or no XML become replacement characters", "[chart]") {
  const std::string replacement = "\xEF\xBF\xBD";
  CHECK(escaped("a\xFF"
                "b") == "a" + replacement + "b");
  CHECK(escaped("\xC3") == replacement);                                      // cut off
  CHECK(escaped("\xC0\xAF") == replacement + replacement);                    // overlong
  CHECK(escaped("\xE0\x80\xAF") == replacement + replacement + replacement);  // overlong
  // half of a surrogate pair
  CHECK(escaped("\xED\xA0\x80") == replacement + replacement + replacement);
  CHECK(escaped("\xF5\x80\x80\x80").size() == 4 * replacement.size());  // beyond Unicode
  CHECK(escaped("\xC3<") == replacement + "&lt;");  // consumes nothing behind it
  CHECK(escaped(std::string_view("\0\x1B", 2)) == replacement + replacement);
  CHECK(escaped("\xEF\xBF\xBF") == replacement);
  CHECK(escaped("\t\n") == "\t\n");
}

TEST_CASE("text is cut to a width, at characters, with an ellipsis", "[chart]") {
  const std::string ellipsis = "\xE2\x80\xA6";
  CHECK(shortened("short", 12, 100) == "short");
  const std::string cut = shortened("a name that is much too long", 12, 80);
  CHECK(cut.ends_with(ellipsis));
  CHECK(cut.size() > 8);
  CHECK(width_of(cut, 12) <= 80);
  // 2 bytes each, and 3.
  CHECK(shortened("\xC2\xB5\xC2\xB5\xC2\xB5\xC2\xB5\xC2\xB5\xC2\xB5", 12, 30).size() % 2 == 1);
  CHECK(shortened("name", 12, 0) == ellipsis);
  CHECK(shortened("name", 12, -5) == ellipsis);
  CHECK(width_of("wide", 24) == Approx(2 * width_of("wide", 12)));
  CHECK(width_of("lil", 12) < width_of("www", 12));
}
