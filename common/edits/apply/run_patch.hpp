// Run patch: a list of changes turned into edit areas (thesis 7.3.3): which runs go and which come in their
// place. An area is a maximal group of neighbouring runs that the edit replaces; every other run is kept as
// it is. So the areas follow from the chunk before and after alone, whoever found the changes. Internal to
// edits.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/edits/apply/apply_scratch.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Appends the areas of `changes` (ascending, disjoint, not empty) to `areas`, and the runs that come in,
/// area by area, to `runs`. `first` of an area counts in the new run list. O(changes * log(runs between) +
/// runs replaced).
void plan_patch(const RunChunk& chunk, std::span<const Change> changes,
                std::vector<EditArea>& areas, std::vector<Run>& runs);

/// Two ways to write a patch. Same result; the run counts decide which is cheaper.
enum class PatchWrite : std::uint8_t {
  pieces,  // splice area by area: each moves the runs behind it
  whole,   // copy the kept runs between the areas and splice once
};

PatchWrite cheaper_write(const RunChunk& chunk, std::span<const EditArea> areas);

/// Replaces the areas of the chunk by `runs`. `scratch` is used by PatchWrite::whole.
void write_patch(RunChunk& chunk, std::span<const EditArea> areas, std::span<const Run> runs,
                 PatchWrite how, std::vector<Run>& scratch);

}  // namespace runstone
