#include "client/panels/rollback_control.hpp"

#include <catch2/catch.hpp>

#include "common/mesh_materials/mesh_materials_of.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::session_bench {
namespace {

/// A session whose server shows what rollbacks would change, with one chunk in view.
struct RollbackClient : SessionBench {
  RollbackClient() {
    greet();
    Welcome welcome = server.make_welcome();
    welcome.features = kFeatureCommands | kFeatureRestorePreview;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    receive(SessionAccepted{6, 0});
    static_cast<void>(sent());
    control.set_materials(mesh_materials_of(welcome.materials));
    receive(Message(chunks_of(server.world.snapshot({0, 0, 0}))));
  }
  /// Returns the command that was sent since the last call.
  CommandRequest command() {
    const auto commands = take<CommandRequest>(sent());
    REQUIRE(commands.size() == 1);
    return commands[0];
  }
  void answer(const CommandRequest& command, const std::string& line, bool is_ok) {
    receive(CommandOutput{command.id, {line}, true, is_ok});
    step();
  }
  void answer_preview(const CommandRequest& command, const std::string& id) {
    RestorePreview preview;
    preview.command = command.id;
    preview.preview = id;
    preview.voxels = 3;
    preview.chunks = 1;
    preview.edits = {set({1, 2, 3}, 5), set({4, 4, 4}, 6)};
    receive(preview);
    answer(command, "preview " + id + ": would take back 1 edit", true);
  }
  void step() {
    for (int i = 0; i < 20; ++i) control.step();
  }
  RollbackState state() const {
    RollbackState out;
    control.fill(out);
    return out;
  }
  RollbackControl control{session};
};

const WorldPos kEye{10.5, 20.9, -3.2};

}  // namespace

TEST_CASE("the command of a preview has author, age and area", "[client_app]") {
  RollbackChoice choice;
  CHECK(preview_command(choice, kEye, {}) == "rollback preview since 60m");
  choice.author = 7;
  choice.minutes = 5;
  choice.area = RollbackArea::around_me;
  choice.radius = 2;
  CHECK(preview_command(choice, kEye, {}) ==
        "rollback preview author #7 since 5m box 8 18 -6 12 22 -2");
  choice.area = RollbackArea::selection;
  CHECK(preview_command(choice, kEye, VoxelBox{{1, 2, 3}, {4, 5, 6}}) ==
        "rollback preview author #7 since 5m box 1 2 3 3 4 5");
}

TEST_CASE("a rollback is previewed with ghosts, applied, and taken back", "[client_app]") {
  RollbackClient client;
  CHECK(client.control.carry_out(PreviewRollback{}, kEye, {}).empty());
  const CommandRequest preview = client.command();
  CHECK(preview.text == "rollback preview since 60m");
  CHECK(client.control.is_busy());
  CHECK(client.state().phase == RollbackPhase::previewing);
  client.answer_preview(preview, "p1");
  CHECK_FALSE(client.control.is_busy());
  CHECK(client.state().phase == RollbackPhase::previewed);
  CHECK(client.state().voxels == 3);
  CHECK(client.state().placed == 2);
  CHECK(client.control.ghosts().size() == 1);
  CHECK(client.control.carry_out(ApplyRollback{}, kEye, {}).empty());
  client.step();
  CHECK(client.control.ghosts().empty());
  const CommandRequest apply = client.command();
  CHECK(apply.text == "rollback apply p1");
  client.answer(apply, "rollback p1 done", true);
  CHECK(client.state().phase == RollbackPhase::applied);
  CHECK(client.state().answer == std::vector<std::string>{"rollback p1 done"});
  CHECK(client.control.carry_out(UndoRollback{}, kEye, {}).empty());
  const CommandRequest undo = client.command();
  CHECK(undo.text == "rollback undo p1");
  client.answer(undo, "undo of rollback 9 done", true);
  CHECK(client.state().phase == RollbackPhase::idle);
}

TEST_CASE("a refused preview says why, and nothing can be applied", "[client_app]") {
  RollbackClient client;
  CHECK(client.control.carry_out(PreviewRollback{}, kEye, {}).empty());
  client.answer(client.command(), "this command needs the right roll_back", false);
  CHECK(client.state().phase == RollbackPhase::idle);
  CHECK_FALSE(client.control.has_succeeded());
  CHECK(client.state().answer.at(0) == "this command needs the right roll_back");
  CHECK(client.control.carry_out(ApplyRollback{}, kEye, {}) == "there is no preview of a rollback");
  CHECK(client.sent().empty());
  RollbackChoice choice;
  choice.area = RollbackArea::selection;
  CHECK(client.control.carry_out(PreviewRollback{choice}, kEye, {}) == "nothing is selected");
}

TEST_CASE("a preview that was typed into the chat has ghosts, too", "[client_app]") {
  RollbackClient client;
  REQUIRE(client.session.command("rollback preview since 1h").has_value());
  client.answer_preview(client.command(), "p4");
  CHECK(client.state().phase == RollbackPhase::previewed);
  CHECK(client.control.ghosts().size() == 1);
  CHECK(client.control.carry_out(ForgetRollback{}, kEye, {}).empty());
  CHECK(client.command().text == "rollback cancel p4");
  client.step();
  CHECK(client.control.ghosts().empty());
}

TEST_CASE("a preview that would change nothing has no ghosts", "[client_app]") {
  RollbackClient client;
  CHECK(client.control.preview("author ann").empty());
  const CommandRequest preview = client.command();
  CHECK(preview.text == "rollback preview author ann");
  RestorePreview nothing;
  nothing.command = preview.id;
  client.receive(nothing);
  client.answer(preview, "nothing to do", true);
  CHECK(client.control.has_succeeded());
  CHECK(client.state().phase == RollbackPhase::idle);
  CHECK(client.control.ghosts().empty());
}

}  // namespace runstone::test::session_bench
