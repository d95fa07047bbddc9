#include "tests/support/codec/chunks_message.hpp"
#include "tests/unit/client/script/script_bench.hpp"

using namespace runstone;
using runstone::test::ScriptBench;

namespace {

/// A bench whose replica shows one chunk of edge 16: material 5 below y = 4.
struct ToolScript : ScriptBench {
  ToolScript() {
    host.world.set_view({1, {0, 0, 0}, 1, 1});
    static_cast<void>(host.world.open({16, 5, 77, 3, 0, 0, 0}));
    ChunkSnapshot snapshot;
    snapshot.key = {0, {0, 0, 0}};
    snapshot.chunk.voxels = uniform_chunk(Extent::cube(16), kEmpty, AxisOrder::xzy);
    fill(snapshot.chunk.voxels, 0, 16 * 16 * 4, 5);
    snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
    host.world.receive(test::chunks_of(std::move(snapshot)), {1000, 1100, 1200});
  }
  std::string error_of(std::string_view text) {
    const auto parsed = parse_script(text, "s.txt");
    return parsed ? "" : parsed.error().message();
  }
};

}  // namespace

TEST_CASE_METHOD(ToolScript, "a script clicks with a tool, its parameters and the held material",
                 "[bots]") {
  run("tool sphere\nparam radius 2\nparam mask empty\nhold sand\naim 3 3 3 +y\nuse\nuse clear");
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[0].edit ==
        EditDescriptor{FillSphere{{3, 4, 3}, 2}, {MaskKind::only_empty, 0}, 2});
  CHECK(host.edits[1].edit ==
        EditDescriptor{FillSphere{{3, 3, 3}, 2}, {MaskKind::only_empty, 0}, kEmpty});
}

TEST_CASE_METHOD(ToolScript, "a script keeps and takes hotbars by their names", "[bots]") {
  run("hotbar keep red walls\nhotbar take roofs");
  CHECK(runner->failures().empty());
  CHECK(host.hotbars == std::vector<std::string>{"keep red walls", "take roofs"});
  run("hotbar forget roofs");
  CHECK(runner->failures().size() == 1);
  CHECK(error_of("hotbar eat roofs").find("none of keep, take, forget") != std::string::npos);
  CHECK(error_of("hotbar keep").find("expected NAME") != std::string::npos);
}

TEST_CASE_METHOD(ToolScript, "a script draws a stroke, and one click of it is a sphere", "[bots]") {
  run("tool stroke\nhold sand\naim 3 3 3 +y\npress\naim 6 3 3 +y\ndrag\naim 6 3 9 +y\nrelease\n"
      "aim 1 3 1 +y\nuse");
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[0].edit ==
        EditDescriptor{FillStroke{{{3, 4, 3}, {6, 4, 3}, {6, 4, 9}}, 2}, {}, 2});
  CHECK(host.edits[1].edit == EditDescriptor{FillSphere{{1, 4, 1}, 2}, {}, 2});
}

TEST_CASE_METHOD(ToolScript, "a script adds boxes to the selection and removes them", "[bots]") {
  run("select 0 3 0 2 3 0\nselect add 6 3 0 6 3 0\nselect remove 1 3 0 2 9 9\nselection fill sand\n"
      "selection grow all 2\nselection grow all -2\nselection clear");
  CHECK(runner->failures().empty());
  const auto fill = [](std::int32_t x, Material material) {
    return EditDescriptor{FillBox{{{x, 3, 0}, {x + 1, 4, 1}}}, {}, material};
  };
  REQUIRE(host.edits.size() == 4);
  CHECK(host.edits[0].edit == fill(0, 2));
  CHECK(host.edits[1].edit == fill(6, 2));
  CHECK(host.edits[2].edit == fill(0, kEmpty));
  CHECK(host.edits[3].edit == fill(6, kEmpty));
  CHECK(error_of("select more 0 3 0 2 3 0").find("more") != std::string::npos);
}

TEST_CASE_METHOD(ToolScript, "a script keeps and drops voxels of the selection by a filter",
                 "[bots]") {
  run("select 0 0 0 3 7 3\nselection keep above 1\nselection drop below 3\nselection fill sand");
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 1);
  const auto* const paste = std::get_if<Paste>(&host.edits[0].edit.shape);
  REQUIRE(paste != nullptr);
  CHECK(paste->at == VoxelPos{0, 3, 0});
  CHECK(paste->clipboard->touched() == 4 * 5 * 4);
  CHECK(error_of("selection keep").find("expected FILTER") != std::string::npos);
  run("select 0 0 0 3 7 3\nselection keep is");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures().front().find("where: column 3") != std::string::npos);
}

TEST_CASE_METHOD(ToolScript, "a script selects, copies, turns and pastes", "[bots]") {
  run("select 0 3 0 2 3 0\nselection grow +z 1\nselection copy\nselection shift +x 4\n"
      "selection fill sand\nselection replace sand stone\nselection stack +y 2\nselection clear\n"
      "rotate 1\nmirror z\ntool paste\naim 8 3 8 +y\nuse\nselect none\nselection clear");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:15: edit refused: nothing is selected");
  REQUIRE(host.edits.size() == 5);
  CHECK(host.edits[0].edit == EditDescriptor{FillBox{{{4, 3, 0}, {7, 4, 2}}}, {}, 2});
  CHECK(host.edits[1].edit ==
        EditDescriptor{FillBox{{{4, 3, 0}, {7, 4, 2}}}, {MaskKind::only_material, 2}, 5});
  CHECK(kind_of(host.edits[2].edit) == EditKind::paste);
  CHECK(host.edits[3].edit == EditDescriptor{FillBox{{{4, 3, 0}, {7, 4, 2}}}, {}, kEmpty});
  const auto* paste = std::get_if<runstone::Paste>(&host.edits[4].edit.shape);
  REQUIRE(paste != nullptr);
  // The clipboard itself was turned.
  CHECK(paste->orientation == Orientation{});
  CHECK(paste->clipboard->extent() == Extent{2, 1, 3});
  CHECK(paste->at == VoxelPos{7, 4, 7});  // 2 by 3 voxels with the place in their middle
}

TEST_CASE_METHOD(ToolScript, "a script types the texts of a tool", "[bots]") {
  run("tool mix\ntext pattern air where below 3\nplaces 0 2 0 3 3 3\napply\n"
      "text pattern air, \napply\ntext colour red");
  REQUIRE(host.edits.size() == 1);
  const auto* paste = std::get_if<runstone::Paste>(&host.edits[0].edit.shape);
  REQUIRE(paste != nullptr);
  CHECK(paste->at == VoxelPos{0, 2, 0});
  CHECK(paste->clipboard->touched() == 16);
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:6: edit refused: pattern: column 5: found the end but "
                                 "expected a material",
                                 "s.txt:7: edit refused: the tool mix has no text colour"});
}

TEST_CASE_METHOD(ToolScript, "a script names the file of the clipboard", "[bots]") {
  run("clipboard load my castle.schem");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:1: this client reads no files");
  run("clipboard save a.vox");
  CHECK(runner->failures().back() == "s.txt:1: this client writes no files");
}

TEST_CASE_METHOD(ToolScript, "a script says how a model becomes voxels", "[bots]") {
  const auto step = [&](std::string_view text) {
    const auto parsed = parse_script(text, "s.txt");
    INFO((parsed ? "" : parsed.error().message()));
    REQUIRE(parsed);
    return std::get<script::FileOfClipboard>(parsed->commands.at(0).step);
  };
  script::FileOfClipboard read =
      step("clipboard load my statue.STL voxels 512 up z turn 90 surface thin  # a comment");
  CHECK(read.file == "my statue.STL");
  CHECK(read.model.voxels == 512);
  CHECK(read.model.up == ModelUp::z);
  CHECK(read.model.quarters == 1);
  CHECK(read.model.surface == SurfaceMode::separating_6);
  CHECK(step("clipboard load a.glb").model == ModelChoices());
  CHECK(step("clipboard load a.glb voxels-per-metre 2.5").model.voxels_per_metre == 2.5);
  CHECK(step("clipboard load a.obj of b.schem").file == "a.obj of b.schem");
  CHECK(step("clipboard load a.schem voxels 3").file == "a.schem voxels 3");
  CHECK(step("clipboard save a.glb hollow").file == "a.glb hollow");

  CHECK(error_of("clipboard load a.glb voxels 5000") ==
        "s.txt:1: voxels \"5000\": a whole number from 1 to 4096 is expected");
  CHECK(error_of("clipboard load a.glb voxels") ==
        "s.txt:1: expected a whole number from 1 to 4096");
  CHECK(error_of("clipboard load a.glb wide") == "s.txt:1: unexpected \"wide\"");
  CHECK(error_of("clipboard load a.glb hollow surface none") ==
        "s.txt:1: a.glb: neither its inside nor its surface is wanted");
}

TEST_CASE_METHOD(ToolScript, "a script sets symmetry and previews", "[bots]") {
  run("symmetry x 5.5 0 0\nhold sand\naim 3 3 3 +y\nuse\nsymmetry none\npreview off\naim look\n"
      "screenshot a.png\nuse");
  CHECK_FALSE(host.tools.is_preview_shown());
  CHECK(host.previews == 1);
  REQUIRE(host.edits.size() == 1);
  CHECK(bounding_box(host.edits[0].edit) == VoxelBox{{3, 4, 3}, {9, 5, 4}});
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:9: edit refused: nothing is in reach");
}

TEST_CASE_METHOD(ToolScript, "a script gives the places of a tool by numbers", "[bots]") {
  run("tool box\nhold sand\nplaces 1 2 3 4 5 6\napply\nplaces clear 1 2 3 1 2 3\napply\n"
      "tool extrude\nparam voxels 1\nplaces face +y 3 3 3\napply\nplaces none\napply");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:12: edit refused: no places are typed");
  REQUIRE(host.edits.size() == 3);
  CHECK(host.edits[0].edit == EditDescriptor{FillBox{{{1, 2, 3}, {5, 6, 7}}}, {}, 2});
  CHECK(host.edits[1].edit == EditDescriptor{FillBox{{{1, 2, 3}, {2, 3, 4}}}, {}, kEmpty});
  CHECK(kind_of(host.edits[2].edit) == EditKind::paste);
}

TEST_CASE_METHOD(ToolScript, "a script sets the text of a tool to the rest of the line", "[bots]") {
  run("tool text\ntext text Up # 2\ntext font Some/Font");
  CHECK(runner->failures().empty());
  CHECK(host.tools.tool().texts()[0].text == "Up # 2");
  CHECK(host.tools.tool().texts()[1].text == "Some/Font");
  run("text text");
  CHECK(host.tools.tool().texts()[0].text.empty());
}

TEST_CASE_METHOD(ToolScript, "a script turns the clipboard by any angle and scales it", "[bots]") {
  run("select 0 3 0 9 3 0\nselection copy\nturn y 45\nturn x 0 200");
  CHECK(runner->failures().empty());
  CHECK(host.tools.clipboard().build->sides() == VoxelPos{16, 2, 16});
  CHECK(error_of("turn y 400").find("DEGREES") != std::string::npos);
  CHECK(error_of("turn y 45 5").find("PERCENT") != std::string::npos);
}

TEST_CASE_METHOD(ToolScript, "the edits of a tool wait for the edit budget, and are made once",
                 "[bots]") {
  host.budget_from_us = 1'500'000;
  load("tool box\naim 1 3 1 +y\nuse\naim 2 3 2 +y\nuse");
  runner->step(1'000'000);
  CHECK(host.edits.empty());
  runner->step(1'500'000);
  CHECK(host.edits.size() == 1);
  CHECK(runner->finished());
}

TEST_CASE_METHOD(ToolScript, "wrong commands of the tools are found", "[bots]") {
  CHECK(error_of("aim 1 2 3 up").find("none of -x, +x") != std::string::npos);
  CHECK(error_of("selection eat").find("nothing to do with the selection") != std::string::npos);
  CHECK(error_of("symmetry y 1 2 3").find("none of none, x, z") != std::string::npos);
  CHECK(error_of("places 1 2").find("expected Z") != std::string::npos);
  CHECK(error_of("places face up 1 2 3").find("none of -x, +x") != std::string::npos);
  CHECK(error_of("preview maybe").find("none of on, off") != std::string::npos);
  CHECK(error_of("rotate 4").find("QUARTERS") != std::string::npos);
  for (const char* line : {"tool saw", "param radius 3", "tool sphere\nparam radius 99",
                           "tool sphere\nparam mask glass", "hold glass"}) {
    run(line);
    CAPTURE(line);
    CHECK(runner->failures().size() == 1);
  }
}
