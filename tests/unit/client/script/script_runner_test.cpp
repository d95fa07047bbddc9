#include "tests/unit/client/script/script_bench.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/formats/shape_names.hpp"

using namespace runstone;
using runstone::test::FakeScriptHost;
using runstone::test::ScriptBench;

TEST_CASE_METHOD(ScriptBench, "positions may be absolute, from the player or from the surface",
                 "[bots]") {
  run("set 1 2 3 stone\nset ~ ~-1 ~+2 stone\nset -4 ^+1 5 stone\nset -0.5 1.9 2.5 sand");
  REQUIRE(host.edits.size() == 4);
  CHECK(host.edits[0].edit == EditDescriptor{SetVoxel{{1, 2, 3}}, {}, 5});
  CHECK(host.edits[1].edit == EditDescriptor{SetVoxel{{10, 19, 32}}, {}, 5});
  CHECK(host.edits[2].edit == EditDescriptor{SetVoxel{{-4, 8, 5}}, {}, 5});
  CHECK(host.edits[3].edit == EditDescriptor{SetVoxel{{-1, 1, 2}}, {}, 2});
  CHECK(runner->failures().empty());
}

TEST_CASE_METHOD(ScriptBench, "box corners may come in any order and are both included", "[bots]") {
  run("box 5 2 3 1 4 3 stone empty\nsphere 1 2 3 4 air only:sand");
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[0].edit ==
        EditDescriptor{FillBox{{{1, 2, 3}, {6, 5, 4}}}, {MaskKind::only_empty, 0}, 5});
  CHECK(host.edits[1].edit ==
        EditDescriptor{FillSphere{{1, 2, 3}, 4}, {MaskKind::only_material, 2}, 0});
}

TEST_CASE_METHOD(ScriptBench, "a stroke has the points of its command", "[bots]") {
  run("stroke 2 stone 1 2 3 1.5 9.25 -0.5 solid");
  REQUIRE(host.edits.size() == 1);
  CHECK(host.edits[0].edit ==
        EditDescriptor{FillStroke{{{1, 2, 3}, {1, 9, -1}}, 2}, {MaskKind::only_solid, 0}, 5});
  run("stroke 2 stone 1 2 3 1.5 2 3");  // two places in one voxel
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0].find("stroke repeats a point") != std::string::npos);
}

TEST_CASE_METHOD(ScriptBench, "a paste has the copied voxels, turned as the command says",
                 "[bots]") {
  run("copy a 5 2 ~ 1 4 3 solid\ncopy b 0 0 0 0 0 1\ncopy a 0 0 0 0 0 0\n"
      "paste b ~ 7 -2 rotate 1 mirror x rotate -1 only:sand\npaste a 1 2 3\n");
  CHECK(runner->failures().empty());
  REQUIRE(host.copied.size() == 3);
  CHECK(host.copied[0] == VoxelBox{{1, 2, 3}, {6, 5, 31}});
  REQUIRE(host.edits.size() == 2);
  // A quarter turn, a mirror along x and the quarter turn back are a mirror along z.
  CHECK(host.edits[0].edit.mask == Mask{MaskKind::only_material, 2});
  const auto& b = std::get<runstone::Paste>(host.edits[0].edit.shape);
  CHECK(b.at == VoxelPos{10, 7, -2});
  CHECK(b.clipboard->extent() == Extent{1, 1, 2});
  CHECK(b.clipboard->at({0, 0, 0}) == kEmpty);
  CHECK(b.clipboard->at({0, 0, 1}) == Material{5});
  const auto& a = std::get<runstone::Paste>(host.edits[1].edit.shape);  // the newer one
  CHECK(a.at == VoxelPos{1, 2, 3});
  CHECK(a.clipboard->extent() == Extent{1, 1, 1});
}

namespace {

/// Material 5 is stairs that ascend to the north, 6 to 8 those to the east, south and west.
MaterialTable script_stairs() {
  MaterialTable table;
  for (const char* name :
       {"a", "b", "c", "d", "minecraft:oak_stairs", "minecraft:oak_stairs[facing=east]",
        "minecraft:oak_stairs[facing=south]", "minecraft:oak_stairs[facing=west]"}) {
    MaterialInfo info;
    info.name = name;
    REQUIRE(table.add(std::move(info)));
  }
  return table;
}

}  // namespace

TEST_CASE_METHOD(ScriptBench, "a paste turns the materials with the cells", "[bots]") {
  static_cast<void>(host.tools.set_materials(script_stairs()));
  run("copy a 0 0 0 0 0 0\npaste a 1 2 3 rotate 1\npaste a 1 2 3 mirror z\n");
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 2);
  // To the left: north goes to west.
  const auto& left = std::get<runstone::Paste>(host.edits[0].edit.shape);
  CHECK(left.clipboard->at({0, 0, 0}) == Material{8});
  const auto& mirrored = std::get<runstone::Paste>(host.edits[1].edit.shape);
  CHECK(mirrored.clipboard->at({0, 0, 0}) == Material{7});
}

TEST_CASE_METHOD(ScriptBench, "place lays a material as the look means", "[bots]") {
  static_cast<void>(host.tools.set_materials(script_stairs()));
  host.hit = RayHit{{4, 5, 6}, 1, Direction::pos_y, 3};
  run("place stone");  // the look of the host is south
  REQUIRE(host.edits.size() == 1);
  CHECK(host.edits[0].edit == EditDescriptor{SetVoxel{{4, 6, 6}}, {}, 7});
}

TEST_CASE_METHOD(ScriptBench, "fences that a script sets, fills, places or digs join", "[bots]") {
  MaterialTable table;
  for (const char* name :
       {"minecraft:stone", "minecraft:oak_fence", "minecraft:oak_fence[east=true]",
        "minecraft:oak_fence[west=true]", "minecraft:oak_fence[south=true]",
        "minecraft:oak_fence[east=true,west=true]"}) {
    MaterialInfo info;
    info.name = name;
    info.shape = shape_of_material_name(name).value_or(Shape{});
    REQUIRE(table.add(std::move(info)));
  }
  static_cast<void>(host.tools.set_materials(table));  // "sand" is a fence, "stone" joins its south
  host.voxels[{0, 0, 0}] = 2;
  run("set 1 0 0 sand");
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[0].edit == EditDescriptor{SetVoxel{{1, 0, 0}}, {}, 4});
  CHECK(host.edits[0].part == ActionPart::first);
  CHECK(host.edits[1].edit == EditDescriptor{SetVoxel{{0, 0, 0}}, {MaskKind::only_material, 2}, 3});
  CHECK(host.edits[1].part == ActionPart::next);
  // A material whose name has states is placed without joins.
  host.edits.clear();
  run("set 1 0 0 stone");
  REQUIRE(host.edits.size() == 1);
  CHECK(host.edits[0].edit.material == 5);
  host.edits.clear();
  run("box 1 0 0 3 0 0 sand");
  REQUIRE(host.edits.size() == 2);
  const auto& row = std::get<runstone::Paste>(host.edits[0].edit.shape);
  CHECK(row.clipboard->at({0, 0, 0}) == Material{6});
  CHECK(row.clipboard->at({2, 0, 0}) == Material{4});
  host.edits.clear();
  host.voxels[{0, 0, 0}] = 3;
  host.voxels[{1, 0, 0}] = 4;
  host.hit = RayHit{{1, 0, 0}, 4, Direction::pos_y, 2};
  host.takes = false;  // the neighbour that is refused is no failure of its own
  run("dig");
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[1].edit == EditDescriptor{SetVoxel{{0, 0, 0}}, {MaskKind::only_material, 3}, 2});
  CHECK(runner->failures().size() == 1);
}

TEST_CASE_METHOD(ScriptBench, "a solid copy leaves the voxels alone where it is empty", "[bots]") {
  run("copy a 0 0 0 1 0 0 solid\npaste a 1 2 3\n");
  REQUIRE(host.edits.size() == 1);
  CHECK(std::get<runstone::Paste>(host.edits[0].edit.shape).clipboard->touched() == 1);
}

TEST_CASE_METHOD(ScriptBench, "a box of any size is a large action, for whose end the script waits",
                 "[bots]") {
  load("box 0 0 0 199 99 199 stone\nset 1 2 3 stone");
  runner->step(0);
  REQUIRE(host.actions.size() == 1);
  CHECK(host.edits.empty());
  CHECK_FALSE(runner->finished());
  host.ended_action = Result<void, std::string>();
  runner->step(1'000);
  CHECK(runner->finished());
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 1);
  host.ended_action = Result<void, std::string>(failure("cancelled"));
  run("box 0 0 0 199 99 199 stone");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:1: edit refused: cancelled");
}

TEST_CASE_METHOD(ScriptBench,
                 "a copy that fails and a paste of an unknown clipboard end the script", "[bots]") {
  run("copy a 1001 0 0 1002 0 0\nset 1 2 3 stone");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:1: cannot copy \"a\": it is far");
  run("paste a 1 2 3\nset 1 2 3 stone");
  REQUIRE(runner->failures().size() == 1);
  CHECK(runner->failures()[0] == "s.txt:1: nothing was copied as \"a\"");
  CHECK(host.edits.empty());
}

TEST_CASE_METHOD(ScriptBench, "an edit waits until the edit budget suffices", "[bots]") {
  host.budget_from_us = 1'500'000;
  load("set 1 2 3 stone\nset 1 2 4 stone");
  runner->step(1'000'000);
  CHECK(host.edits.empty());
  CHECK(runner->due_us() == 1'500'000);
  runner->step(1'500'000);
  CHECK(host.edits.size() == 2);
  CHECK(runner->finished());
}

TEST_CASE_METHOD(ScriptBench, "antialiasing sets how edges are smoothed", "[bots]") {
  run("antialiasing fxaa");
  CHECK(host.antialiasing == Antialiasing::fxaa);
  const auto wrong = parse_script("antialiasing smooth", "s");
  REQUIRE_FALSE(wrong.has_value());
  CHECK(wrong.error().message().find("expected auto, off, fxaa or msaa") != std::string::npos);
}

TEST_CASE_METHOD(ScriptBench, "time sets the time of day", "[bots]") {
  run("time 18:00");
  CHECK(host.time_of_day == 0.75);
  CHECK_FALSE(parse_script("time 25:00", "s").has_value());
  CHECK_FALSE(parse_script("time", "s").has_value());
}

TEST_CASE_METHOD(ScriptBench, "look takes degrees, and lookat takes a place", "[bots]") {
  run("look 90 -45");
  CHECK(host.yaw == Approx(std::numbers::pi / 2));
  CHECK(host.pitch == Approx(-std::numbers::pi / 4));
  run("lookat 20 30 30");  // along +x, 45 degrees up
  CHECK(host.yaw == Approx(std::numbers::pi / 2));
  CHECK(host.pitch == Approx(std::numbers::pi / 4));
}

TEST_CASE_METHOD(ScriptBench, "a walk takes the time of its speed and ends at its destination",
                 "[bots]") {
  load("walk 14 20 30 2\nquit");
  runner->step(1'000'000);
  CHECK_FALSE(runner->finished());
  CHECK(runner->due_us().has_value());
  runner->step(2'000'000);
  CHECK(host.at.x == Approx(12));
  runner->step(2'999'999);
  CHECK_FALSE(runner->finished());
  runner->step(3'000'001);
  CHECK(runner->finished());
  CHECK(host.at == WorldPos{14, 20, 30});
}

TEST_CASE_METHOD(
    ScriptBench,
    "roaming goes to and fro while the script goes on, and a burst stays where it began",
    "[bots]") {
  load("roam ~10 ~ ~ 10\nburst 4 1 0 1 stone\nmove 0 0 0\nwait 1");
  runner->step(1'000'000);
  CHECK(host.at == WorldPos{10, 20, 30});
  CHECK(runner->due_us().value() < 1'100'000);
  runner->step(1'400'000);
  CHECK(host.at.x == Approx(14));
  runner->step(2'000'000);
  CHECK(host.at == WorldPos{20, 20, 30});
  runner->step(2'300'000);
  CHECK(host.at.x == Approx(17));
  runner->step(3'500'000);  // at most one turning point per step
  CHECK(host.at == WorldPos{10, 20, 30});
  runner->step(4'000'000);
  REQUIRE(host.edits.size() == 4);
  for (const auto& edit : host.edits)
    CHECK(edit.edit == EditDescriptor{SetVoxel{{10, 20, 30}}, {}, 5});
  CHECK(host.at == WorldPos{0, 0, 0});
  runner->step(4'500'000);
  CHECK(host.at == WorldPos{0, 0, 0});
  runner->step(5'000'000);
  CHECK(runner->finished());
}

TEST_CASE_METHOD(ScriptBench, "digging and placing go through the picked voxel", "[bots]") {
  host.hit = RayHit{{4, 5, 6}, 3, Direction::pos_y, 2};
  run("dig\nplace sand");
  REQUIRE(host.edits.size() == 2);
  CHECK(host.edits[0].edit == EditDescriptor{SetVoxel{{4, 5, 6}}, {}, kEmpty});
  CHECK(host.edits[1].edit == EditDescriptor{SetVoxel{{4, 6, 6}}, {}, 2});
  host.hit.reset();
  run("dig\nplace sand");
  CHECK(host.edits.size() == 2);
  CHECK(runner->failures().size() == 2);
}

TEST_CASE_METHOD(ScriptBench, "waiting for seconds and for states blocks until then", "[bots]") {
  load("wait 1.5\nwait loaded\nwait horizon\nwait durable\nwait synced");
  host.is_loaded = host.is_horizon_seen = host.is_durable = false;
  runner->step(100);
  CHECK(runner->due_us() == 1'500'100);
  runner->step(1'500'100);
  CHECK_FALSE(runner->finished());
  host.is_loaded = true;
  runner->step(1'550'000);
  CHECK_FALSE(runner->finished());
  host.is_horizon_seen = true;
  runner->step(1'600'000);
  host.is_durable = true;
  runner->step(1'700'000);
  CHECK_FALSE(runner->finished());
  host.pongs = 1;
  runner->step(1'800'000);
  CHECK_FALSE(runner->finished());
  host.pongs = 2;
  runner->step(1'900'000);
  CHECK(runner->finished());
  CHECK(runner->failures().empty());
}

TEST_CASE_METHOD(ScriptBench, "a state that is not reached is a failure, and the script goes on",
                 "[bots]") {
  load("wait loaded 2\nquit");
  host.is_loaded = false;
  runner->step(0);
  runner->step(2'000'000);
  CHECK(runner->finished());
  CHECK(runner->failures() == std::vector<std::string>{"s.txt:1: not loaded in time"});
}

TEST_CASE_METHOD(ScriptBench, "nothing runs before the world is open", "[bots]") {
  host.open = false;
  load("set 1 2 3 stone");
  runner->step(0);
  CHECK(host.edits.empty());
  host.open = true;
  runner->step(1);
  CHECK(host.edits.size() == 1);
}

TEST_CASE_METHOD(ScriptBench, "failed expectations are recorded by line, and the script goes on",
                 "[bots]") {
  host.voxels[{1, 2, 3}] = 5;
  run("expect 1 2 3 stone\nexpect 1 2 4 stone\nexpect 2000 2 3 stone\nset 1 1 1 sand");
  REQUIRE(runner->failures().size() == 2);
  CHECK(runner->failures()[0] == "s.txt:2: expected stone at 1 2 4, found material 0");
  CHECK(runner->failures()[1] == "s.txt:3: expected stone at 2000 2 3, but its chunk is not here");
  CHECK(host.edits.size() == 1);
}

TEST_CASE_METHOD(ScriptBench, "a command that cannot run ends the script", "[bots]") {
  run("set 1 2 3 unobtainium\nset 1 2 3 stone");
  CHECK(host.edits.empty());
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:1: the world has no material \"unobtainium\""});
  run("set 2000 ^ 3 stone\nset 1 2 3 stone");
  CHECK(host.edits.empty());
  run("box 0 0 0 5000 1 1 stone\nset 1 2 3 stone");
  CHECK(host.edits.empty());
  CHECK(runner->failures().size() == 1);
}

TEST_CASE_METHOD(ScriptBench, "an edit that the client refuses is a failure with its reason",
                 "[bots]") {
  host.takes = false;
  run("set 1 2 3 stone\nexpect 1 2 3 air");
  CHECK(runner->finished());
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:1: edit refused: the past cannot be edited"});
}

TEST_CASE_METHOD(ScriptBench, "a repeat runs its body N times, also when it is nested or empty",
                 "[bots]") {
  run("repeat 3\n"
      "set 1 1 1 sand\n"
      "repeat 2\n"
      "set 2 2 2 stone\n"
      "end\n"
      "end\n"
      "repeat 0\n"
      "set 9 9 9 sand\n"
      "end\n"
      "repeat 5\n"
      "end");
  CHECK(host.edits.size() == 9);
  CHECK(std::count_if(host.edits.begin(), host.edits.end(),
                      [](const auto& e) { return e.edit.material == 5; }) == 6);
}

TEST_CASE_METHOD(ScriptBench, "a step runs a bounded number of commands", "[bots]") {
  load("repeat 1000\nlook 0 0\nend");
  int turns = 0;
  for (; !runner->finished(); ++turns) runner->step(turns);
  CHECK(turns > 5);
}

TEST_CASE_METHOD(ScriptBench, "the edits of a burst are due by its rate, whatever the host does",
                 "[bots]") {
  load("burst 5 100 3 42 stone");
  runner->step(1'000'000);
  CHECK(host.edits.size() == 1);
  CHECK(runner->due_us() == 1'010'000);
  host.takes = false;  // refused edits do not delay the burst
  host.at = {500, 500, 500};
  runner->step(1'035'000);  // late: three edits are due
  REQUIRE(host.edits.size() == 4);
  CHECK(host.edits[1].due_us == 1'010'000);
  CHECK(host.edits[2].due_us == 1'020'000);
  CHECK(host.edits[3].due_us == 1'030'000);
  CHECK(host.edits[3].now_us == 1'035'000);
  runner->step(1'040'000);
  CHECK(runner->finished());
  CHECK(runner->failures().empty());
  for (const auto& submitted : host.edits) {
    const VoxelPos at = std::get<SetVoxel>(submitted.edit.shape).at;
    CHECK(std::abs(at.x - 10) <= 3);
    CHECK(std::abs(at.y - 20) <= 3);
    CHECK(std::abs(at.z - 30) <= 3);
  }
  const auto first = host.edits;
  host.edits.clear();
  host.at = {10, 20, 30};
  load("burst 5 100 3 42 stone");
  runner->step(0);
  runner->step(1'000'000);
  REQUIRE(host.edits.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(host.edits[i].edit == first[i].edit);
}

TEST_CASE_METHOD(ScriptBench,
                 "a script waits for a screenshot, which fails if the client draws nothing",
                 "[bots]") {
  load("screenshot a.png\nquit");
  host.picture.reset();
  runner->step(0);
  CHECK_FALSE(runner->finished());
  host.picture.emplace();
  runner->step(1);
  CHECK(runner->finished());
  CHECK(host.files == std::vector<std::string>{"a.png"});
  host.draws = false;
  run("screenshot b.png\ndigests good\ndigests bad");
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:1: no screenshot: this client draws nothing",
                                 "s.txt:3: bad: cannot be written: No space left on device"});
}

TEST_CASE_METHOD(ScriptBench,
                 "a screenshot that cannot be written is a failure with its reason, and the script "
                 "goes on",
                 "[bots]") {
  load("look 0 0\nscreenshot nosuch/a.png\nset 1 1 1 sand");
  host.picture.reset();
  runner->step(0);
  CHECK(runner->failures().empty());
  host.picture = failure(std::string("nosuch/a.png: cannot be written: Permission denied"));
  runner->step(1);
  CHECK(runner->finished());
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:2: nosuch/a.png: cannot be written: Permission denied"});
  CHECK(host.edits.size() == 1);
}

TEST_CASE(
    "a command waits for its answer, and a refused command is a failure, and the script goes on",
    "[bots]") {
  const auto script = *parse_script(
      "command rollback preview author #3  # all\nset 1 2 3 stone\nundo\nset 1 2 3 sand\n", "t");
  FakeScriptHost host;
  host.is_commanding = true;
  ScriptRunner runner(script, host);
  runner.step(1'000'000);
  CHECK(host.commands == std::vector<std::string>{"rollback preview author #3  # all"});
  CHECK(host.edits.empty());
  host.is_commanding = false;
  runner.step(1'100'000);
  CHECK(host.commands.back() == "undo");
  CHECK(host.edits.size() == 2);
  CHECK(runner.failures().empty());

  FakeScriptHost refusing;
  refusing.is_command_ok = false;
  ScriptRunner again(script, refusing);
  again.step(1'000'000);
  CHECK(refusing.edits.size() == 2);
  REQUIRE(again.failures().size() == 2);
  CHECK(again.failures()[1] == "t:3: the server refused \"undo\"");
}

TEST_CASE_METHOD(ScriptBench, "commands for the server wait for a lost connection", "[bots]") {
  const std::string command = GENERATE(as<std::string>{}, "undo", "command list", "say hello",
                                       "travel 7", "rollback apply");
  CAPTURE(command);
  host.is_connected = false;
  load(command + "\nset 1 2 3 stone\n");
  runner->step(1'000'000);
  const auto sent = [&] {
    return host.commands.size() + host.said.size() + host.travels.size() + host.input.size();
  };
  CHECK(sent() == 0);
  CHECK(runner->due_us() == 121'000'000);
  host.is_connected = true;
  runner->step(5'000'000);
  CHECK(sent() == 1);
  CHECK(runner->finished());
  CHECK(runner->failures().empty());
  CHECK(host.edits.size() == 1);

  host.is_connected = false;
  load(command);
  runner->step(1'000'000);
  runner->step(121'000'000);
  CHECK(runner->finished());
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:1: the connection did not come back in time"});
}

TEST_CASE_METHOD(ScriptBench,
                 "a command whose answer is lost is a failure that says so, and is not sent again",
                 "[bots]") {
  host.is_commanding = true;
  load("undo\nset 1 2 3 stone\n");
  runner->step(1'000'000);
  host.is_commanding = host.is_connected = host.is_command_ok = false;
  host.is_answer_lost = true;
  runner->step(2'000'000);
  CHECK(host.commands.size() == 1);
  CHECK(runner->finished());
  CHECK(host.edits.size() == 1);
  CHECK(runner->failures() ==
        std::vector<std::string>{"s.txt:1: the connection ended before the answer to \"undo\" "
                                 "came: the server may have carried it out or not"});
}

TEST_CASE_METHOD(ScriptBench, "a journey that a lost connection ended begins again", "[bots]") {
  host.is_travelling = true;
  load("travel 7\nset 1 2 3 stone\n");
  runner->step(1'000'000);
  host.is_travelling = host.is_connected = false;
  runner->step(2'000'000);
  CHECK(host.edits.empty());
  host.is_travelling = host.is_connected = true;
  ++host.connection_count;
  runner->step(3'000'000);
  CHECK(host.travels.size() == 2);
  host.is_travelling = false;
  runner->step(4'000'000);
  CHECK(runner->finished());
  CHECK(host.edits.size() == 1);
}

TEST_CASE_METHOD(ScriptBench, "the lowest coordinate of the world lies inside", "[bots]") {
  run("set -536870912 2 -536870912 stone\nmove -536870912 0 536870911.5");
  CHECK(runner->failures().empty());
  REQUIRE(host.edits.size() == 1);
  CHECK(host.edits[0].edit == EditDescriptor{SetVoxel{{-536870912, 2, -536870912}}, {}, 5});
  for (const char* outside : {"set 536870912 2 3 stone", "set 1 ~-536870912 3 stone"}) {
    host.at = {10, -20, 30};
    run(outside);
    REQUIRE(runner->failures().size() == 1);
    CHECK(runner->failures()[0].find("lies outside the world") != std::string::npos);
  }
}

TEST_CASE("say sends a line, and wait chat waits for one, but not for ever", "[bots]") {
  const auto script = *parse_script(
      "say hello  # all\nwait chat 2.5 <ana> hi #1\nsay bye\nwait chat 1 nothing\nsay end\n", "t");
  FakeScriptHost host;
  ScriptRunner runner(script, host);
  runner.step(1'000'000);
  CHECK(host.said == std::vector<std::string>{"hello  # all"});
  CHECK(runner.due_us() == 3'500'000);
  host.heard = {"<bea> hi", "<ana> hi #1"};
  runner.step(1'100'000);
  CHECK(host.heard.empty());
  CHECK(host.said.back() == "bye");
  runner.step(2'100'000);
  CHECK(runner.finished());
  CHECK(host.said.back() == "end");
  CHECK(runner.failures() == std::vector<std::string>{"t:4: nobody wrote \"nothing\" in time"});

  FakeScriptHost refusing;
  refusing.refusal = "no world is open";
  ScriptRunner again(script, refusing);
  again.step(1'000'000);
  CHECK(again.failures() ==
        std::vector<std::string>{"t:1: the line is not sent: no world is open"});

  for (const char* bad : {"say", "say   ", "wait chat", "wait chat hello", "wait chat 5"})
    CHECK_FALSE(parse_script(bad, "t").has_value());
  CHECK_FALSE(parse_script("say " + std::string(513, 'a'), "t").has_value());
}

TEST_CASE("a command of too many bytes, or none, is a mistake of the script", "[bots]") {
  CHECK_FALSE(parse_script("command", "t").has_value());
  CHECK_FALSE(parse_script("command " + std::string(1025, 'a'), "t").has_value());
  CHECK(parse_script("command " + std::string(1024, 'a'), "t").has_value());
  CHECK_FALSE(parse_script("undo 2", "t").has_value());
}

TEST_CASE("travel waits until the moment is here, and a refused travel ends the script", "[bots]") {
  const auto script = *parse_script("travel -2\nset 1 2 3 stone\ntravel 7\nset 1 2 3 sand\n", "t");
  FakeScriptHost host;
  host.is_travelling = true;
  ScriptRunner runner(script, host);
  runner.step(1'000'000);
  REQUIRE(host.travels.size() == 1);
  CHECK(host.travels[0].to == HistoryTarget::time);
  CHECK(host.travels[0].utc_us == 3'000'000);
  CHECK(host.edits.empty());
  host.is_travelling = false;
  host.refusal = "no such edit";
  runner.step(1'100'000);
  CHECK(runner.finished());
  CHECK(host.edits.empty());
  REQUIRE(runner.failures().size() == 1);
  CHECK(runner.failures()[0] == "t:1: no such moment: no such edit");
}

TEST_CASE_METHOD(ScriptBench, "keys, text and clicks reach the client in their order",
                 "[client_script]") {
  load(
      "interface on\nkey ctrl+z\ntype Grüße an alle\nclick 12 40\ninterface off\n"
      "inspect runs on\ninspect wireframe off\n");
  host.is_handling = true;
  runner->step(0);
  runner->step(1);
  CHECK(host.input == std::vector<std::string>{"on", "press ctrl+Z"});  // the next one waits
  host.is_handling = false;
  runner->step(2);
  CHECK(runner->finished());
  CHECK(host.input == std::vector<std::string>{"on", "press ctrl+Z", "type Grüße an alle",
                                               "click 12 40", "off", "runs on", "wireframe off"});
}

TEST_CASE("wrong keys and places of clicks are found before the script runs", "[client_script]") {
  for (const char* line : {"key ctrl+", "key nosuch", "type", "click 3", "click -1 4", "interface",
                           "inspect", "inspect runs", "inspect quads on", "inspect runs maybe"}) {
    CAPTURE(line);
    CHECK_FALSE(parse_script(line, "s.txt").has_value());
  }
}
