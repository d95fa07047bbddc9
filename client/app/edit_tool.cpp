#include "client/app/edit_tool.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace runstone {
namespace {

constexpr const char* kNothingInReach = "nothing is in reach";

}  // namespace

std::optional<RayHit> EditTool::pick() const {
  return runstone::pick(session_.replica(), player_.eye(), player_.direction(), kReach);
}

Result<void, std::string> EditTool::remove(TimeUs now_us) {
  const auto hit = pick();
  if (!hit) return failure(kNothingInReach);
  return submit({SetVoxel{hit->voxel}, {}, kEmpty}, now_us, now_us);
}

Result<void, std::string> EditTool::place(TimeUs now_us) {
  const auto hit = pick();
  if (!hit) return failure(kNothingInReach);
  const auto at = place_against(*hit);
  if (!at || player_.is_in(*at)) return failure("you stand there: step back first");
  return submit({SetVoxel{*at}, {}, player_.held()}, now_us, now_us);
}

Result<void, std::string> EditTool::submit(const EditDescriptor& edit, TimeUs due_us,
                                           TimeUs now_us) {
  const auto seq = session_.submit(edit, due_us, now_us);
  if (seq) {
    recorder_.submitted(*seq, due_us);
    return {};
  }
  if (session_.replica().local_edits().all().size() >= kLocalEditsMax) {
    recorder_.not_submitted();
  } else {
    ++refused_;
  }
  std::string why = session_.refusal_text(edit, seq.error());
  spdlog::warn("edit refused: {}", why);
  return Unexpected<std::string>{std::move(why)};
}

}  // namespace runstone
