#include "common/core/hex.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

EditDescriptor lamp_at(VoxelPos at) { return {SetVoxel{at}, {}, SceneWorld::kLamp}; }

void tell_edit(Stage& stage, const EditDescriptor& edit) {
  stage.tell("edit " + to_hex(encode(edit)));
}

/// Tells the client to edit, and takes its request.
EditRequest request_of(Stage& stage, const EditDescriptor& edit) {
  tell_edit(stage, edit);
  EditRequest request = stage.wait_edit("no EditRequest");
  if (request.fault || request.edit != edit)
    throw SceneFailed{"EditRequest has another descriptor than the client was told"};
  if (request.client_seq == 0) throw SceneFailed{"EditRequest has the client sequence 0"};
  return request;
}

void join_and_load(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the edit");
}

void play_edit(Stage& stage) {
  join_and_load(stage);
  ClientSequence last = 0;
  for (std::int32_t i = 0; i < 3; ++i) {
    const EditRequest request = request_of(stage, lamp_at({i, 9, 15}));
    if (request.client_seq <= last) throw SceneFailed{"the client sequence does not ascend"};
    last = request.client_seq;
    const OrderedEdit ordered = stage.commit(request);
    stage.wait_line("applied " + std::to_string(ordered.seq));
    stage.player().send(Message(Durable{stage.world().epoch(), ordered.seq}));
  }
  stage.wait_same_voxels("after edits of its own");
}

void play_rejected_edit(Stage& stage) {
  join_and_load(stage);
  const EditRequest request = request_of(stage, lamp_at({3, 9, 3}));
  stage.player().send(
      Message(Reject{request.client_seq, RejectReason::not_permitted, "the ground is protected"}));
  stage.wait_line("rejected");
  stage.wait_same_voxels("after an edit that was rejected");
}

void play_overtaken_edit(Stage& stage) {
  join_and_load(stage);
  const EditRequest request = request_of(
      stage,
      {FillBox{{{2, 2, 2}, {12, 9, 12}}}, {MaskKind::only_solid, kEmpty}, SceneWorld::kGlass});
  // The server has ordered an edit of somebody else first.
  stage.commit(EditDescriptor{FillSphere{{8, 6, 8}, 4}, {}, SceneWorld::kBrick});
  const OrderedEdit ordered = stage.commit(request);
  stage.wait_line("applied " + std::to_string(ordered.seq));
  stage.wait_same_voxels("after an edit that another one came before");
}

void play_edit_offered_again(Stage& stage) {
  join_and_load(stage);
  const EditRequest lost = request_of(stage, lamp_at({5, 9, 5}));
  stage.cut();
  stage.join();
  const EditRequest again = stage.wait_edit("the edit without an answer is not offered again");
  if (again.client_seq != lost.client_seq || again.edit != lost.edit)
    throw SceneFailed{"the edit is offered again with another client sequence or descriptor"};
  const OrderedEdit ordered = stage.commit(again);
  stage.wait_line("applied " + std::to_string(ordered.seq));
  stage.wait_same_voxels("after an edit that was offered again");
}

void play_resolved_edit(Stage& stage) {
  join_and_load(stage);
  const EditRequest request = request_of(stage, lamp_at({5, 9, 5}));
  // The edit was applied, and its commit is lost with the connection.
  const OrderedEdit ordered = stage.world().order(stage.operation_of(request), request.edit);
  stage.cut();
  JoinSetup setup;
  setup.resolved = request.client_seq;
  stage.join(setup);
  const EditRequest again = stage.wait_edit("the edit without an answer is not offered again");
  if (again.client_seq != request.client_seq)
    throw SceneFailed{"the edit is offered again with another client sequence"};
  stage.player().send(
      Message(Reject{again.client_seq, RejectReason::already_resolved, "", ordered.seq}));
  stage.player().send(Message(Durable{stage.world().epoch(), ordered.seq}));
  stage.wait_same_voxels("after an edit that was applied and whose answer was lost");
  // It is not applied a second time, nor offered once more.
  stage.commit(EditDescriptor{SetVoxel{{5, 9, 5}}, {}, SceneWorld::kBrick});
  stage.wait_same_voxels("after the edit of somebody else");
  if (!stage.edits.empty()) throw SceneFailed{"the edit is offered once more"};
}

void play_lost_epoch(Stage& stage) {
  join_and_load(stage);
  stage.commit(EditDescriptor{FillSphere{{8, 5, 8}, 4}, {}, SceneWorld::kBrick});
  stage.wait_same_voxels("before the crash");
  stage.cut();
  stage.world().restart();
  // The sequence of the lost edit goes to another one.
  static_cast<void>(
      stage.world().order(Stage::kOther, {FillSphere{{4, 5, 4}, 3}, {}, SceneWorld::kGlass}));
  stage.join();
  stage.wait_same_voxels("after a crash of the server that lost an edit");
}

}  // namespace

std::vector<Scene> edit_scenes() {
  using enum Part;
  return {
      {"edit", "Editing", minimum, "sends edits with ascending client sequences and shows them",
       play_edit},
      {"rejected-edit", "Editing", minimum, "takes an edit back that the server rejects",
       play_rejected_edit},
      {"overtaken-edit", "Editing", minimum, "shows its edit on top of one that was ordered before",
       play_overtaken_edit},
      {"edit-offered-again", "After a reconnection", minimum,
       "offers an edit without an answer again, under its number", play_edit_offered_again},
      {"resolved-edit", "After a reconnection", minimum,
       "drops an edit that was resolved, and applies it once", play_resolved_edit},
      {"lost-epoch", "Epochs", minimum,
       "shows the world of the server after edits were lost in a crash", play_lost_epoch},
  };
}

}  // namespace runstone::conformance
