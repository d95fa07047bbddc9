#include "server/world/veil/veiled_messages.hpp"

#include "common/core/assert.hpp"

namespace runstone {

VeiledCommit veiled_commit(const OrderedBatch& batch, std::span<const ShownEdit> shown) {
  RUNSTONE_ASSERT(shown.size() == batch.commit.edits.size());
  VeiledCommit out;
  out.epoch = batch.commit.epoch;
  out.edits.resize(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const OrderedEdit& ordered = batch.commit.edits[i];
    VeiledEdit& edit = out.edits[i];
    edit.ordered.seq = ordered.seq;
    edit.ordered.op = ordered.op;
    edit.ordered.cause = ordered.cause;
    edit.ordered.submitted_us = ordered.submitted_us;
    edit.ordered.ordered_us = ordered.ordered_us;
    edit.ordered.subject = ordered.subject;
    edit.has_edit = shown[i].form == ShownForm::descriptor;
    if (edit.has_edit) {
      edit.ordered.edit = ordered.edit;
      edit.ordered.previous = shown[i].previous;
    }
    for (const ShownPatch& patch : shown[i].patches)
      edit.patches.push_back({patch.key.at, patch.before.seq, patch.patch});
  }
  return out;
}

VeilPatches veil_patches(std::span<const ShownPatch> patches) {
  RUNSTONE_ASSERT(!patches.empty());
  VeilPatches out;
  out.version = patches.front().after;
  for (const ShownPatch& patch : patches) {
    RUNSTONE_ASSERT(patch.after == out.version);
    out.patches.push_back({patch.key.at, patch.before.seq, patch.patch});
  }
  return out;
}

}  // namespace runstone
