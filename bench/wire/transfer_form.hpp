// TransferForm: one way to send a chunk. The chunk is ready in the form in which its owner keeps
// it, and the buffers are warm, so that a call times coding alone.
//   dense             a u16 for each voxel
//   dense_zstd        the same under zstd 3
//   luanti_light      eight of Luanti's blocks with the light of the chunk; param2 is 0
//                     (luanti_form.hpp)
//   luanti            the same with 0 for light
//   minecraft         eight of Minecraft's sections in one zlib stream (palette_form.hpp)
//   raw, packed, coded our chunk bytes
// All hold the same voxels. The bytes of frames and chunk keys are not counted.
#pragma once
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "bench/worlds/lit_chunk.hpp"

namespace runstone::bench {

struct TransferForm {
  std::string_view name;
  std::function<void()> encode;                   // into bytes of its own
  std::function<void()> decode;                   // decodes those bytes into what a receiver keeps
  std::function<std::size_t()> bytes;             // of the last encode
  std::function<std::vector<Material>()> voxels;  // of the last decode, x fastest, then y, then z
  std::function<std::vector<std::uint8_t>()> light;  // likewise; empty if the form carries none
};

/// Returns all names, in the order above.
std::span<const std::string_view> transfer_form_names();

/// Returns one of each form. `chunk` must outlive them. Requires materials below 2^15, as
/// Minecraft's ids are.
std::vector<TransferForm> make_transfer_forms(const LitChunk& chunk);

}  // namespace runstone::bench
