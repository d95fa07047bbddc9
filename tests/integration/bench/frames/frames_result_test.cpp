// The results as files and tables.
#include "bench/frames/frames_result.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/frames/frames_options.hpp"

using namespace runstone::bench;

namespace {

FramesRow row_of(const char* world, const char* mesher, std::size_t vertices, double p50_ms) {
  FramesRow row;
  row.world = world;
  row.mesher = mesher;
  row.path = "plain";
  row.vertices = vertices;
  row.triangles = vertices / 2;
  row.frames = 6;
  row.p50_ms = row.p90_ms = row.p99_ms = p50_ms;
  return row;
}

FramesResult sample() {
  FramesResult out;
  out.gl_renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  out.rows = {row_of("a", "culled", 2'000'000, 5), row_of("a", "rdm", 1'000'000, 3),
              row_of("b", "rdm", 0, 1), row_of("a", "rdm", 5'000'000, 100)};
  out.rows[1].seam_pixels = 1.5;
  out.rows[1].t_junctions = 12;
  out.rows[3].path = "product";
  out.skipped = {"b culled: too large"};
  return out;
}

std::size_t commas(const std::string& line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
}

}  // namespace

TEST_CASE("the fit over the plain rows gives the cost of vertices", "[frames]") {
  FramesResult result = sample();
  const auto exact = result.fit();
  REQUIRE(exact.has_value());
  CHECK(exact->intercept_ms == Approx(1));
  CHECK(exact->ms_per_million_vertices == Approx(2));
  CHECK(exact->r2 == Approx(1));
  result.rows[0].p50_ms = 3;  // 1, 3, 3 over 0, 1, 2
  const auto bent = result.fit();
  REQUIRE(bent.has_value());
  CHECK(bent->ms_per_million_vertices == Approx(1));
  CHECK(bent->intercept_ms == Approx(4.0 / 3));
  CHECK(bent->r2 == Approx(0.75));
  result.rows.erase(result.rows.begin(), result.rows.begin() + 2);
  CHECK_FALSE(result.fit().has_value());
}

TEST_CASE("rows are written as CSV, JSON and tables", "[frames]") {
  const FramesResult result = sample();
  std::ostringstream csv;
  write_csv(result, csv);
  std::istringstream lines(csv.str());
  std::string head, line;
  std::getline(lines, head);
  std::size_t count = 0;
  for (; std::getline(lines, line); ++count) CHECK(commas(line) == commas(head));
  CHECK(count == result.rows.size());
  CHECK(csv.str().find("a,rdm,plain,1000000,500000,0,6,3.0000,3.0000,3.0000,333.33,12,") !=
        std::string::npos);

  std::ostringstream text;
  write_json(result, text);
  const auto json = nlohmann::json::parse(text.str());
  CHECK(json.at("gl").at("software") == true);
  REQUIRE(json.at("rows").size() == 4);
  CHECK(json.at("rows").at(1).at("fps") == Approx(1000.0 / 3));
  CHECK(json.at("rows").at(1).at("seam_pixels") == 1.5);
  CHECK(json.at("rows").at(1).at("overdraw").is_null());
  CHECK(json.at("fit").at("r2") == Approx(1));
  CHECK(json.at("skipped").size() == 1);
  CHECK(json.at("machine").contains("commit"));

  std::ostringstream tables;
  write_tables(result, tables);
  // World b lacks the culled mesher, so the means are of a alone.
  CHECK(tables.str().find("Means over the 1 world") != std::string::npos);
  CHECK(tables.str().find("| rdm | 1000000 | 500000 | 0 | 3.00 |") != std::string::npos);
  CHECK(tables.str().find("| a | 200 | 333 | 10 |\n| b | – | 1000 | – |") != std::string::npos);
  CHECK(tables.str().find("The processor draws") != std::string::npos);
  CHECK(tables.str().find("skipped: b culled: too large") != std::string::npos);
}

TEST_CASE("a GPU is distinguished from software rendering", "[frames]") {
  FramesResult result;
  for (const char* name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe"}) {
    result.gl_renderer = name;
    CHECK(result.is_software());
  }
  result.gl_renderer = "Mesa Intel(R) UHD Graphics 620 (KBL GT2)";
  CHECK_FALSE(result.is_software());
}

TEST_CASE("a size is two sides in pixels", "[frames]") {
  int width = 1, height = 2;
  CHECK(parse_size("640x360", width, height));
  CHECK(width == 640);
  CHECK(height == 360);
  for (const char* text : {"", "640", "x360", "640x", "640x360x2", "640 x360", "-640x360", "8x360",
                           "640x8", "4097x16", "axb"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_size(text, width, height));
  }
  CHECK(width == 640);
  CHECK(height == 360);
}
