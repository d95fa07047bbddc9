#include "client/app/clipboard_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "client/app/clipboard_transfer.hpp"
#include "common/materials/material_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

MaterialTable table_of_names(const std::vector<std::string>& names) {
  MaterialTable out;
  for (const std::string& name : names) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(out.add(std::move(info)));
  }
  return out;
}

/// A folder that is removed at the end.
struct ClipboardFolder {
  ClipboardFolder()
      : folder(std::filesystem::temp_directory_path() /
               ("runstone-clipboard-" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(folder);
  }
  ~ClipboardFolder() { std::filesystem::remove_all(folder); }
  ClipboardFolder(const ClipboardFolder&) = delete;
  ClipboardFolder& operator=(const ClipboardFolder&) = delete;
  std::string file() const { return (folder / "sub" / "clipboard.rsb").string(); }
  std::filesystem::path folder;
};

/// A bench that copied a voxel of each of two materials.
struct CopiedBench : ToolBench {
  CopiedBench() {
    show_flat();
    static_cast<void>(box.set_materials(table_of_names({"stone", "sand", "ice"})));
    predict({{SetVoxel{{0, 0, 0}}, {}, 2}, {SetVoxel{{2, 0, 0}}, {}, 3}});
    box.select(VoxelBox{{0, 0, 0}, {3, 1, 1}});
    REQUIRE(box.copy(replica, true));
  }
};

}  // namespace

TEST_CASE("the clipboard of a program is that of the next one, in another world, by names",
          "[client_app]") {
  const ClipboardFolder place;
  {
    CopiedBench bench;
    ClipboardFile file(place.file());
    REQUIRE(file.load(bench.box));  // there is no file yet
    REQUIRE(bench.box.clipboard().build);
    CHECK(file.step(bench.box).empty());
    REQUIRE(bench.box.rotate(1));
    CHECK(file.step(bench.box).empty());  // the newest one is written, at the latest at the end
  }
  CHECK(std::distance(std::filesystem::directory_iterator(place.folder / "sub"), {}) == 1);
  ToolBox box;
  {
    ClipboardFile file(place.file());
    REQUIRE(file.load(box));
    std::filesystem::remove(place.file());
    CHECK(file.step(box).empty());
  }
  CHECK_FALSE(std::filesystem::exists(place.file()));  // there was nothing new to write
  REQUIRE(box.set_materials(table_of_names({"clay", "ice", "sand"})).empty());
  const BuildPtr build = box.clipboard().build;
  REQUIRE(build);
  CHECK(build->sides() == VoxelPos{1, 1, 3});
  CHECK(build->at({0, 0, 2}) == Material{3});  // sand; a quarter turn takes +x to -z
  CHECK_FALSE(build->at({0, 0, 1}));           // the air was not copied
  CHECK(build->at({0, 0, 0}) == Material{2});  // ice
}

TEST_CASE("a world without a material of the clipboard does not change the file", "[client_app]") {
  const ClipboardFolder place;
  CopiedBench bench;
  {
    ClipboardFile file(place.file());
    CHECK(file.step(bench.box).empty());
  }
  ClipboardFile file(place.file());
  ToolBox poor;
  REQUIRE(file.load(poor));
  CHECK(poor.set_materials(table_of_names({"sand"})) ==
        "the nearest colours take the place of materials that this world lacks: ice");
  CHECK(file.step(poor).empty());
  ToolBox rich;
  REQUIRE(file.load(rich));
  CHECK(rich.set_materials(table_of_names({"ice", "sand"})).empty());
}

TEST_CASE("the clipboard goes through files of other programs", "[client_app]") {
  const ClipboardFolder place;
  const CopiedBench bench;
  std::filesystem::create_directories(place.folder);
  const std::string file = place.folder / "tower.schem";
  const auto wrote = write_clipboard(file, bench.box);
  INFO((wrote ? "" : wrote.error()));
  REQUIRE(wrote);
  ToolBox box;
  static_cast<void>(box.set_materials(table_of_names({"ice", "sand", "clay"})));
  const auto read = read_clipboard(file, box);
  REQUIRE(read);
  CHECK(read->empty());
  const BuildPtr build = box.clipboard().build;
  REQUIRE(build);
  const BuildPtr copied = bench.box.clipboard().build;
  REQUIRE(build->sides() == copied->sides());
  CHECK(build->touched() == copied->touched());
  CHECK(build->solid() == copied->solid());

  CHECK(write_clipboard(place.folder / "tower.exe", bench.box).error().find("endings are .rsb") !=
        std::string::npos);
  CHECK(write_clipboard(file, ToolBox()).error() ==
        "the clipboard is empty: copy a selection first");
  CHECK_FALSE(read_clipboard(place.folder / "none.schem", box));
  CHECK(box.clipboard().build == build);
}

TEST_CASE("a damaged clipboard is refused and stays on disk, and a bad folder is said",
          "[client_app]") {
  const ClipboardFolder place;
  std::filesystem::create_directories(place.folder / "sub");
  std::ofstream(place.file()) << "no build";
  CopiedBench bench;
  {
    ClipboardFile file(place.file());
    ToolBox box;
    const auto loaded = file.load(box);
    REQUIRE_FALSE(loaded);
    CHECK(loaded.error().find(place.file()) == 0);
    CHECK_FALSE(box.clipboard().build);
  }
  CHECK(std::filesystem::file_size(place.file()) == 8);
  std::filesystem::create_directories(place.folder / "pipe");
  const std::string pipe = place.folder / "pipe" / "clipboard.rsb";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  ToolBox box;
  CHECK(ClipboardFile(pipe).load(box).error() ==
        pipe + ": is a device, a pipe or a socket, and no file");
  ClipboardFile nowhere((place.folder / "sub" / "clipboard.rsb" / "no" / "folder").string());
  CHECK(nowhere.step(bench.box).empty());
  std::string failed;
  while (failed.empty()) failed = nowhere.step(bench.box);
  CHECK(failed.find("the clipboard is not kept: ") == 0);
  ClipboardFile none("");
  CHECK(none.load(bench.box));
  CHECK(none.step(bench.box).empty());
}

TEST_CASE("a typed path may be below the home folder, with blanks and quotes around it",
          "[client_app]") {
  const std::string home = std::getenv("HOME") == nullptr ? "~" : std::getenv("HOME");
  CHECK(typed_path("~/a b.schem") == home + "/a b.schem");
  CHECK(typed_path(" '/tmp/a b.vox' ") == "/tmp/a b.vox");
  CHECK(typed_path("a~/b.vox") == "a~/b.vox");
  CHECK(typed_path("  ").empty());
}

TEST_CASE("the clipboard goes to a file and back while the player goes on", "[client_app]") {
  const ClipboardFolder place;
  std::filesystem::create_directories(place.folder);
  const std::string file = place.folder / "tower.schem";
  CopiedBench bench;
  ClipboardTransfer transfer;
  const auto outcome = [&](ToolBox& tools) {
    std::optional<PlayerNotice> notice;
    while (!notice) notice = transfer.step(tools);
    return *notice;
  };
  REQUIRE_FALSE(transfer.begin({file, true}, bench.box));
  CHECK(transfer.state().text == "writing tower.schem");
  CHECK(transfer.begin({file, false}, bench.box)->text == "wait: writing tower.schem");
  CHECK(outcome(bench.box).text == "written: " + file);
  CHECK_FALSE(transfer.take_loaded());

  ToolBox box;
  static_cast<void>(box.set_materials(table_of_names({"ice", "sand"})));
  REQUIRE_FALSE(transfer.begin({file, false}, box));
  CHECK(transfer.state().text == "reading tower.schem");
  const PlayerNotice read = outcome(box);
  CHECK(read.text.starts_with("clipboard: tower.schem, 3 x 1 x 1"));
  CHECK(read.kind == NoticeKind::information);
  CHECK(transfer.take_loaded());
  CHECK_FALSE(transfer.take_loaded());
  CHECK_FALSE(transfer.is_busy());
  REQUIRE(box.clipboard().build);

  REQUIRE_FALSE(transfer.begin({place.folder / "none.vox", false}, box));
  const PlayerNotice missing = outcome(box);
  CHECK(missing.kind == NoticeKind::warning);
  CHECK(missing.text.find("none.vox") != std::string::npos);
  CHECK_FALSE(transfer.take_loaded());
  CHECK(transfer.begin({"tower.exe", false}, box)->kind == NoticeKind::warning);

  const auto before = box.clipboard().build;
  REQUIRE_FALSE(transfer.begin({file, false}, box));
  CHECK(transfer.state().can_stop);
  CHECK_FALSE(transfer.state().share);
  transfer.stop();
  CHECK(transfer.state().text == "stopping: tower.schem");
  CHECK_FALSE(transfer.state().can_stop);
  CHECK(outcome(box).text == "stopped: " + file + " was not read");
  CHECK_FALSE(transfer.take_loaded());
  CHECK(box.clipboard().build == before);
  transfer.stop();
  CHECK_FALSE(transfer.is_busy());
  CHECK(transfer.begin({file, true}, ToolBox())->text ==
        "the clipboard is empty: copy a selection first");
}

}  // namespace runstone::test
