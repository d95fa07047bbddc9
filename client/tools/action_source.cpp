#include "client/tools/action_source.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "client/build/cut_edit.hpp"
#include "client/build/joined_source.hpp"
#include "client/tools/pattern_source.hpp"

namespace runstone {
namespace {

class BuildPasteSource final : public EditSource {
 public:
  BuildPasteSource(const BuildPaste& paste, const EditLimits& limits)
      : voxels_(paste.empty == EmptyCells::skipped ? paste.build->solid() : paste.build->touched()),
        edits_(paste.build, paste.at, paste.mask, paste.empty, paste_limits(limits)) {}

  SourceStep next() override {
    auto edit = edits_.next();
    return edit ? SourceStep::of(*std::move(edit)) : SourceStep::done();
  }
  std::uint64_t voxels() const override { return voxels_; }

 private:
  const std::uint64_t voxels_;
  PasteSource edits_;
};

bool clears(const EditDescriptor& edit) {
  return edit.material == kEmpty && !std::holds_alternative<Paste>(edit.shape);
}

}  // namespace

ToolAction paste_of_build(BuildPaste paste, const EditLimits& limits) {
  ToolAction out;
  if (auto whole = whole_clipboard(*paste.build, paste.empty, paste_limits(limits))) {
    out.edits.push_back({Paste{paste.at, std::move(whole), {}}, paste.mask, kEmpty});
  } else {
    out.pastes.push_back(std::move(paste));
  }
  return out;
}

bool is_small(const ToolAction& action, const EditLimits& limits) {
  return action.pastes.empty() && !action.pattern && !action.cleared &&
         std::none_of(action.edits.begin(), action.edits.end(),
                      [&](const EditDescriptor& edit) { return needs_cut(edit, limits); });
}

bool clears_at_end(const ToolAction& action) {
  if (action.cleared) return true;
  return !action.edits.empty() && clears(action.edits.back()) &&
         (!action.pastes.empty() || !clears(action.edits.front()));
}

std::unique_ptr<EditSource> source_of(const ToolAction& action, const EditLimits& limits) {
  auto out = std::make_unique<JoinedSource>();
  if (action.pattern) out->add(std::make_unique<PatternSource>(action.pattern, limits));
  for (const BuildPaste& paste : action.pastes)
    out->add(std::make_unique<BuildPasteSource>(paste, limits));
  bool needs_barrier = clears_at_end(action) && !action.cleared;
  for (const EditDescriptor& edit : action.edits) {
    const bool is_behind = needs_barrier && clears(edit);
    if (is_behind) needs_barrier = false;
    out->add(cut_edit(edit, limits), is_behind ? PartOrder::after_all_before : PartOrder::free);
  }
  if (action.cleared) {
    out->add(std::make_unique<BuildPasteSource>(*action.cleared, limits),
             PartOrder::after_all_before);
  }
  return out;
}

}  // namespace runstone
