// Words for ModelChoices: `voxels 512 up z hollow` of commands and scripts, and the options of
// programs, which have two dashes before them. Thread: any.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/models/model_choices.hpp"

namespace runstone {

struct ModelWord {
  std::string_view name;
  std::string_view values;  // what stands behind it; empty: nothing
  bool has_value() const { return !values.empty(); }
};

inline constexpr ModelWord kVoxelsWord{"voxels", kModelVoxelsRange};
inline constexpr ModelWord kVoxelsPerMetreWord{"voxels-per-metre", kVoxelsPerMetreRange};
inline constexpr ModelWord kSurfaceWord{"surface", "none, thin, thick or all"};
inline constexpr ModelWord kHollowWord{"hollow", ""};
inline constexpr ModelWord kFillOverlapsWord{"fill-overlaps", ""};
inline constexpr ModelWord kUpWord{"up", "y or z"};
/// Commands that place a build have a `turn` of their own, with the same values.
inline constexpr ModelWord kTurnWord{"turn", "0, 90, 180 or 270"};
inline constexpr std::array<ModelWord, 7> kModelWords = {
    kVoxelsWord, kVoxelsPerMetreWord, kSurfaceWord, kHollowWord, kFillOverlapsWord, kUpWord,
    kTurnWord};

/// Returns the word of this name, or null if there is none.
const ModelWord* model_word(std::string_view name);

/// Makes a choice. `value` is the text behind the word, or empty for a word without one. Of
/// `voxels` and `voxels-per-metre` the last one counts. Fails with what is expected, such as "a
/// whole number from 1 to 4096 is expected"; then nothing is changed.
Result<void, std::string> choose_by_word(const ModelWord& word, std::string_view value,
                                         ModelChoices& choices);

}  // namespace runstone
