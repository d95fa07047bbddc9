#include "server/admin/log_line.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command.hpp"

using namespace runstone;

TEST_CASE("a line of the log has time, author, cause, kind, place and material", "[server]") {
  const MaterialTable materials = default_material_table();
  const auto stone = materials.find("stone");
  REQUIRE(stone);
  EditRecord record;
  record.version = {2, 9120};
  record.time_us = 1'795'305'462'000'000;
  record.edit = {FillBox{{{1, 2, -3}, {5, 6, 7}}}, {}, *stone};
  CHECK(log_line(record, "ana #3", materials) ==
        "9120 2026-11-21T23:57:42Z ana #3 player box 1 2 -3 to 4 5 6 := stone");
  const auto unknown = static_cast<Material>(materials.size());
  record.edit = {SetVoxel{{7, 8, 9}}, {}, unknown};
  CHECK(log_line(record, "#5", materials) == "9120 2026-11-21T23:57:42Z #5 player voxel 7 8 9");
}

TEST_CASE("the edit of an undo, redo or rollback is called restored in the log", "[server]") {
  // Such an edit is a paste, whatever the kind of the edit that it takes back.
  const MaterialTable materials = default_material_table();
  EditRecord record;
  record.version = {2, 9120};
  record.time_us = 1'795'305'462'000'000;
  record.edit = {SetVoxel{{7, 8, 9}}, {}, 1};
  record.subject = 9100;
  const std::string begin = "9120 2026-11-21T23:57:42Z #5 ";
  for (const Cause cause : {Cause::undo, Cause::redo, Cause::rollback}) {
    record.cause = cause;
    CHECK(log_line(record, "#5", materials) ==
          begin + std::string(name_of(cause)) + " of 9100 restored 7 8 9");
  }
}
