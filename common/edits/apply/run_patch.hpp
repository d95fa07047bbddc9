// Run patch: a list of changes in the form of edit areas (thesis 7.3.3), which name the runs to
// remove and the runs that replace them. An area is a maximal group of neighbouring runs that the
// edit replaces; every other run is kept. So the areas depend only on the chunk before and after,
// not on the way in which the changes were found. Internal to edits.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/edits/apply/apply_scratch.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Appends the areas of `changes` to `areas`, and their new runs, area by area, to `runs`. Requires
/// ascending, disjoint, non-empty changes. `first` of an area counts in the new run list. Cost:
/// O(changes * log(runs between) + runs replaced).
void plan_patch(const RunChunk& chunk, std::span<const Change> changes,
                std::vector<EditArea>& areas, std::vector<Run>& runs);

/// The two ways to write a patch. Their results are equal, and the run counts decide which is
/// cheaper.
enum class PatchWrite : std::uint8_t {
  pieces,  // splice area by area: each splice moves the runs behind it
  whole,   // copy the kept runs between the areas and splice once
};

PatchWrite cheaper_write(const RunChunk& chunk, std::span<const EditArea> areas);

/// Replaces the areas of the chunk by `runs`. PatchWrite::whole uses `scratch`.
void write_patch(RunChunk& chunk, std::span<const EditArea> areas, std::span<const Run> runs,
                 PatchWrite how, std::vector<Run>& scratch);

}  // namespace runstone
