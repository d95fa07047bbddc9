#include "client/panels/rollback_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/text.hpp"

namespace runstone {
namespace {

/// Returns a box as commands take it: two corners, both inside.
std::string box_text(const VoxelBox& box) {
  return fmt::format("box {} {} {} {} {} {}", box.min.x, box.min.y, box.min.z, box.max.x - 1,
                     box.max.y - 1, box.max.z - 1);
}

VoxelBox box_around(const WorldPos& at, int radius) {
  const auto side = [radius](double v) {
    const double middle = std::floor(v);
    const auto within = [](double w) {
      return static_cast<std::int32_t>(std::clamp(w, -1.0 * kWorldLimit, 1.0 * kWorldLimit));
    };
    return std::pair{within(middle - radius), within(middle + radius + 1)};
  };
  const auto [x0, x1] = side(at.x);
  const auto [y0, y1] = side(at.y);
  const auto [z0, z1] = side(at.z);
  return {{x0, y0, z0}, {x1, y1, z1}};
}

}  // namespace

std::string preview_command(const RollbackChoice& choice, const WorldPos& eye,
                            const std::optional<VoxelBox>& selection) {
  std::string out = "rollback preview";
  if (choice.author) out += fmt::format(" author #{}", *choice.author);
  out += fmt::format(" since {}m", choice.minutes);
  if (choice.area == RollbackArea::around_me) out += " " + box_text(box_around(eye, choice.radius));
  if (choice.area == RollbackArea::selection) out += " " + box_text(selection.value());
  return out;
}

std::string RollbackControl::refuse(std::string why) {
  has_succeeded_ = false;
  answer_ = {why};
  return why;
}

std::string RollbackControl::give(RollbackPhase phase, const std::string& command) {
  if (const auto given = session_.command(command); !given) return refuse(given.error().what);
  has_succeeded_ = false;
  answer_.clear();
  phase_ = phase;
  is_waiting_ = true;
  ghosts_.set({});
  return {};
}

std::string RollbackControl::preview(const std::string& filters) {
  return ask("rollback preview " + filters);
}

std::string RollbackControl::ask(const std::string& command) {
  std::string refusal = give(RollbackPhase::previewing, command);
  if (refusal.empty()) preview_.clear();
  return refusal;
}

void RollbackControl::forget() {
  preview_.clear();
  phase_ = RollbackPhase::idle;
  ghosts_.set({});
}

std::string RollbackControl::carry_out(const RollbackOrder& order, const WorldPos& eye,
                                       const std::optional<VoxelBox>& selection) {
  if (const auto* chosen = std::get_if<PreviewRollback>(&order)) {
    if (chosen->choice.area == RollbackArea::selection && !selection)
      return refuse("nothing is selected");
    return ask(preview_command(chosen->choice, eye, selection));
  }
  if (preview_.empty()) return refuse("there is no preview of a rollback");
  if (std::holds_alternative<ApplyRollback>(order))
    return give(RollbackPhase::applying, "rollback apply " + preview_);
  if (std::holds_alternative<UndoRollback>(order))
    return give(RollbackPhase::undoing, "rollback undo " + preview_);
  std::string refusal = give(RollbackPhase::idle, "rollback cancel " + preview_);
  if (refusal.empty()) preview_.clear();
  return refusal;
}

void RollbackControl::show(const RestorePreview& preview) {
  preview_ = preview.preview;
  voxels_ = preview.voxels;
  chunks_ = preview.chunks;
  is_cut_ = preview.is_cut;
  phase_ = preview_.empty() ? RollbackPhase::idle : RollbackPhase::previewed;
  ghosts_.set(preview.edits);
}

void RollbackControl::take_answer() {
  is_waiting_ = false;
  has_succeeded_ = session_.command_ok();
  answer_.clear();
  for (const std::string& line : session_.command_lines())
    answer_.push_back(with_unseen_replaced(line));
  if (phase_ == RollbackPhase::previewing) {
    phase_ = RollbackPhase::idle;
    if (has_succeeded_ && session_.restore_preview()) show(*session_.restore_preview());
  } else if (phase_ == RollbackPhase::applying) {
    phase_ = has_succeeded_ ? RollbackPhase::applied : RollbackPhase::idle;
  } else {
    phase_ = RollbackPhase::idle;
  }
}

bool RollbackControl::step() {
  bool has_changed = false;
  if (is_waiting_ && !session_.commanding()) {
    take_answer();
    has_changed = true;
  }
  // Another run of the server gives the ids of previews anew.
  if (std::exchange(connections_, session_.connect_count()) != session_.connect_count()) {
    forget();
    has_changed = true;
  }
  // A preview whose command was typed into the chat.
  const auto& typed = session_.restore_preview();
  if (!is_waiting_ && typed && !session_.commanding() && session_.command_ok() &&
      typed->preview != preview_) {
    answer_.clear();
    show(*typed);
    has_changed = true;
  }
  if (!session_.replica().opened() || session_.replica().past()) return has_changed;
  return ghosts_.step(session_.replica(), kChunksPerStep) || has_changed;
}

void RollbackControl::fill(RollbackState& state) const {
  state.phase = phase_;
  state.answer = answer_;
  state.voxels = voxels_;
  state.chunks = chunks_;
  state.placed = ghosts_.placed_voxels();
  state.removed = ghosts_.removed_voxels();
  state.is_cut = is_cut_ || ghosts_.is_cut() || ghosts_.missing_chunks() != 0;
}

std::span<const GhostChunk> RollbackControl::ghosts() const {
  if (session_.replica().past()) return {};
  return ghosts_.ghosts();
}

}  // namespace runstone
