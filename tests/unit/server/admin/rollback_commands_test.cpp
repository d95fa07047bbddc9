#include "server/admin/rollback_commands.hpp"

#include <catch2/catch.hpp>
#include <string>

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

TEST_CASE("a line of the log about new materials has their ids and names", "[server]") {
  AddedMaterials added{35, {}};
  for (int i = 0; i < 8; ++i) added.rows.push_back({"m" + std::to_string(i), {0, 0, 0, 255}, {}});
  EditRecord record;
  record.version = {2, 9120};
  record.time_us = 1'795'305'462'000'000;
  record.cause = Cause::materials;
  const std::string begin = "9120 2026-11-21T23:57:42Z the server materials 35 m0, 36 m1, ";
  const auto line_of = [&] {
    record.edit = materials_edit(added);
    return log_line(record, "the server", MaterialTable());
  };
  CHECK(line_of().starts_with(begin));
  CHECK(line_of().ends_with(", 42 m7"));
  added.rows.push_back({"m8", {0, 0, 0, 255}, {}});
  CHECK(line_of().ends_with(", 42 m7 and 1 more"));
}
