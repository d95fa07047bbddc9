// Pattern: what a builder types to say which material each voxel of a box gets, such as
// `70% stone, 30% moss where is dirt and exposed`. A mix chooses materials, and a filter chooses
// voxels. This file has the form in which a pattern is kept, and its text; docs/client.md describes
// the language. Names of materials are kept as typed, because only the world knows them
// (bound_mix.hpp, bound_filter.hpp).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace runstone {

/// The bytes of a pattern, as it is typed and as text_of() writes it.
inline constexpr std::size_t kPatternBytesMax = 1024;
/// The parentheses and the `not` around a part of a pattern.
inline constexpr std::uint32_t kPatternDepthMax = 16;
inline constexpr std::int32_t kMixWeightMax = 10'000;
/// The voxels across a clump.
inline constexpr std::int32_t kClumpSizeMax = 256;

/// A name of a material, and where it stands in the text. Equal names are equal wherever they
/// stand.
struct NamedMaterial {
  std::string name;
  std::uint32_t column = 0;
  friend bool operator==(const NamedMaterial& a, const NamedMaterial& b) {
    return a.name == b.name;
  }
};

enum class MixKind : std::uint8_t {
  material,  // one material
  list,      // a part for each voxel by itself, by the weights
  clumps,    // as a list, but neighbours up to about `size` voxels away tend to get the same part
  height,    // from the first part at the height `low` to the last one at `high`
  distance,  // from the first part `low` voxels from the middle to the last one at `high` voxels
};

struct Mix {
  MixKind kind = MixKind::material;
  NamedMaterial material;   // of `material`
  std::int32_t size = 0;    // of `clumps`, 1 .. kClumpSizeMax
  std::int32_t low = 0;     // of `height` and `distance`
  std::int32_t high = 0;    // above `low`
  std::vector<Mix> parts;   // of all kinds but `material`; at least two of a gradient
  std::int32_t weight = 0;  // as a part of a list or of clumps; 0: all parts weigh the same
  friend bool operator==(const Mix&, const Mix&) = default;
};

enum class FilterKind : std::uint8_t {
  is,        // the voxel is one of `materials`
  on,        // the voxel below it is
  under,     // the voxel above it is
  beside,    // one of its four neighbours at the same height is
  exposed,   // one of its six neighbours is air
  solid,     // the voxel is not air
  above,     // the voxel lies higher than `number`
  below,     // the voxel lies lower than `number`
  noise,     // `number` percent of all voxels, in clumps of `size` voxels
  all,       // all of `parts` hold
  any,       // one of `parts` holds
  negation,  // the only part does not hold
};

/// A condition for a voxel, called filter. (Mask is the simpler condition of the protocol.)
struct VoxelFilter {
  FilterKind kind = FilterKind::solid;
  std::vector<NamedMaterial> materials;  // at least one of `is`, `on`, `under` and `beside`
  std::int32_t number = 0;               // of `above`, `below` and `noise`
  std::int32_t size = 0;                 // of `noise`, 1 .. kClumpSizeMax
  /// At least two of `all` and `any`, none of which has the kind of the whole.
  std::vector<VoxelFilter> parts;
  friend bool operator==(const VoxelFilter&, const VoxelFilter&) = default;
};

struct Pattern {
  Mix mix;
  std::optional<VoxelFilter> filter;  // nullopt: every voxel
  friend bool operator==(const Pattern&, const Pattern&) = default;
};

/// A mistake in the text of a pattern.
struct PatternError {
  std::uint32_t column = 0;  // in characters, from 1
  std::string what;
  std::string message() const;  // "column 7: found "," but expected a material"
  friend bool operator==(const PatternError&, const PatternError&) = default;
};

/// Returns true if the word has a meaning of its own, so that a material of that name stands in
/// quotes.
bool is_pattern_keyword(std::string_view word);
/// Returns true if the character may stand in a name without quotes, at its beginning or behind it.
bool is_bare_name_character(char c, bool is_first);

/// Returns the canonical text, which the parser reads back to an equal value.
std::string text_of(const Mix& mix);
std::string text_of(const VoxelFilter& filter);
std::string text_of(const Pattern& pattern);

/// Returns the parts of a text to be shown one beside the other: the kind of a mix that is no list,
/// its parts, and the conditions that all must hold.
std::vector<std::string> chips_of(const Mix& mix);
std::vector<std::string> chips_of(const VoxelFilter& filter);
std::vector<std::string> chips_of(const Pattern& pattern);

}  // namespace runstone
