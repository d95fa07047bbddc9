// Model bytes: a model as bytes between the program that reads models (runstone-read-model) and the one
// that started it. They are never stored: both programs are of one build. Numbers are little-endian,
// and floats are IEEE 754.
//   "RSMB", u8 version (1), u8 flags (1 texture places, 2 colours, 4 material of each triangle)
//   u32 positions, u32 triangles, u32 materials, u32 textures, u32 notices
//   f64 metres per unit, 0 if the format says none
//   f32[3] each position     f32[2] each texture place     u8[4] each colour
//   u32[3] each triangle     u32 the material of each triangle
//   a material: u8 bytes of its name, the name, u8[4] colour, u32 texture + 1 (0: none)
//   a texture:  u32 width, u32 height, u8[4] each texel
//   a notice:   u16 bytes of the text, the text
// The decoder trusts none of it: a parser of foreign files may be taken over by a file. Thread: any.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/models/model.hpp"

namespace runstone {

inline constexpr std::size_t kModelNoticesMax = 32;
inline constexpr std::size_t kModelNoticeBytesMax = 256;

/// A model, and what its reader could not read of the file.
struct ReadModel {
  Model model;
  /// One printable line each, such as "the texture wood.png is missing: its material is plain".
  std::vector<std::string> notices;
};

/// Takes the next bytes. Returns false if they cannot be written.
using ModelByteSink = std::function<bool(ByteView)>;
/// Fills the whole span with the next bytes. Returns false if there are not so many.
using ModelByteSource = std::function<bool(std::span<std::uint8_t>)>;

/// Gives the bytes of a model to the sink, at most 64 KiB at a time. Returns false if the sink does.
/// Requires a valid model and notices within their limits. Cost: O(bytes).
bool encode_model(const ReadModel& read, const ModelByteSink& sink);

/// Decodes a model and validates it. Takes bytes from the source only as far as the model goes. Fails
/// if
///   - the source ends before the model, with truncated;
///   - the model takes more than `bytes_max` bytes, before memory is taken for it;
///   - validate() rejects the model, or a notice is no printable line within the limits.
/// Memory: the model, and 64 KiB. Cost: O(bytes).
Result<ReadModel> decode_model(const ModelByteSource& source, std::size_t bytes_max);

}  // namespace runstone
