#include "tests/bench/report/thesis_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/temp_folder.hpp"

namespace runstone::bench {
namespace {

constexpr const char* kFolder = RUNSTONE_SOURCE_DIR "/tests/data/thesis";

TEST_CASE("the thesis' figures are read") {
  const auto data = ThesisData::read(kFolder);
  CHECK(data.doubt().empty());
  CHECK(data.value(1, "Grid", "total_mean") == 4.6556);
  CHECK(data.value(17, "RLE", "fps_mean") == 29.66);
  CHECK(data.chunk_size_ms(17, 128, "Grid") == 249249.7449);
  CHECK(std::isnan(data.value(1, "Grid", "no such metric")));
  CHECK(std::isnan(data.value(30, "Grid", "buffer_mean")));  // left out: a copy of another file
}

TEST_CASE("tables that are missing or broken are named, with the line") {
  const test::TempFolder folder;
  const auto none = ThesisData::read(folder / "");
  CHECK(none.doubt().find("thesis_results.csv cannot be read") != std::string::npos);
  CHECK(none.doubt().find("chunk_sizes.csv cannot be read") != std::string::npos);

  std::filesystem::copy(std::string(kFolder) + "/chunk_sizes.csv", folder / "chunk_sizes.csv");
  std::ofstream(folder / "thesis_results.csv")
      << "scenario,mesher,metric,value,unit\n1,Grid,a,2,ms\n1,Grid,b,many,ms\n";
  const auto broken = ThesisData::read(folder / "");
  CHECK(broken.doubt().find("thesis_results.csv is broken in line 3") != std::string::npos);
  CHECK(broken.doubt().find("chunk_sizes") == std::string::npos);
}

}  // namespace
}  // namespace runstone::bench
