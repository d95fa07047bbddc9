#include "server/admin/log_line.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a line of the log says when, who, why, what, where and of which material", "[server]") {
  const MaterialTable materials = default_material_table();
  const auto stone = materials.find("stone");
  REQUIRE(stone);
  EditRecord record;
  record.version = {2, 9120};
  record.time_us = 1'795'305'462'000'000;
  record.edit = {FillBox{{{1, 2, -3}, {5, 6, 7}}}, {}, *stone};
  CHECK(log_line(record, "ana #3", materials) ==
        "9120 2026-11-21T23:57:42Z ana #3 player box 1 2 -3 to 4 5 6 := stone");
  record.edit = {
      SetVoxel{{7, 8, 9}}, {}, static_cast<Material>(materials.size())};  // a material nobody knows
  record.cause = Cause::undo;
  record.subject = 9100;
  CHECK(log_line(record, "#5", materials) ==
        "9120 2026-11-21T23:57:42Z #5 undo of 9100 voxel 7 8 9");
}
