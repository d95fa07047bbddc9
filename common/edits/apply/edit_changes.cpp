#include "common/edits/apply/edit_changes.hpp"

#include "common/edits/apply/run_patch.hpp"

namespace runstone {

void write_changes(RunChunk& chunk, std::span<const Change> changes, ApplyScratch& scratch) {
  if (changes.empty()) return;
  scratch.runs.clear();
  scratch.areas.clear();
  plan_patch(chunk, changes, scratch.areas, scratch.runs);
  write_patch(chunk, scratch.areas, scratch.runs, cheaper_write(chunk, scratch.areas),
              scratch.whole);
}

}  // namespace runstone
