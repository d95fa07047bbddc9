// TexelStore: one large texture on the GPU, divided into ranges of texels, that shaders read by
// number. It has two dimensions, rows of kTexelRow texels one after another, because OpenGL ES 3.0
// and WebGL 2 have no buffer textures. Its size doubles when it becomes full. The contents then
// move row by row, some with each add(), so that no call copies the whole texture:
//   - The move begins when less than a quarter is free.
//   - Shaders read the old texture until all texels were copied. Texels that are written meanwhile
//     go to both textures.
//   - A piece is large enough that the move ends before the old texture is full. If no free range
//     of it is large enough nevertheless, the rest is copied at once.
// Thread: the GL thread.
#pragma once
#include <cstddef>
#include <cstdint>

#include "client/render/gl_handle.hpp"
#include "client/render/range_allocator.hpp"

namespace runstone {

/// The texels of a row, a width that every driver allows.
inline constexpr std::uint32_t kTexelRow = 2048;

static_assert(kTexelRow == 1U << 11);  // RUNSTONE_TEXEL_GLSL has these numbers

/// In GLSL: the place of a texel in the texture of a store, by its number.
#define RUNSTONE_TEXEL_GLSL "ivec2 texel_place(int i) { return ivec2(i & 2047, i >> 11); }\n"

enum class TexelFormat : std::uint8_t {
  r32,   // one word of 32 bits, read by a usampler2D
  rg32,  // two
};

class TexelStore {
 public:
  /// Its first size is `texels`, rounded up to whole rows.
  TexelStore(TexelFormat format, std::uint32_t texels);

  /// Copies `count` texels into a free range and returns its first texel. Throws
  /// std::runtime_error if the driver allows no larger texture. Requires count > 0. Leaves another
  /// texture and, if texels move, another framebuffer for reading bound. Cost: O(count), or
  /// O(texels of the texture) if the rest of a move is copied at once.
  std::uint32_t add(const void* texels, std::uint32_t count);
  /// Overwrites texels. Requires a range inside the texture.
  void write(std::uint32_t first, const void* texels, std::uint32_t count);
  void remove(std::uint32_t first, std::uint32_t count) { ranges_.give_back(first, count); }

  /// Returns a texture of the target GL_TEXTURE_2D, valid until the next add().
  GLuint texture() const { return texture_.get(); }
  std::uint64_t used_bytes() const { return std::uint64_t{ranges_.used()} * texel_bytes(); }
  /// Returns the texels that the texture holds, and true while they move to a larger one.
  std::uint32_t capacity() const { return ranges_.capacity(); }
  bool is_moving() const { return static_cast<bool>(next_); }

 private:
  std::uint32_t texel_bytes() const { return format_ == TexelFormat::r32 ? 4 : 8; }
  /// Makes the larger texture. Requires that none is there.
  void begin_move(std::uint64_t texels);
  /// Copies rows with at least so many texels to the larger texture, and takes it into use if it
  /// has all of them.
  void move(std::uint64_t texels);
  void write_to(const GlTexture& texture, std::uint32_t first, const void* texels,
                std::uint32_t count) const;

  const TexelFormat format_;
  std::uint64_t texels_max_ = 0;  // that the driver allows
  RangeAllocator ranges_;         // of texture_
  GlTexture texture_;
  GlBuffer unpack_;                          // through which texels are copied
  GlTexture next_;                           // to which the texels move; none if they do not move
  GlFramebuffer source_;                     // from which they are copied: texture_
  std::uint32_t next_size_ = 0, moved_ = 0;  // texels, whole rows
};

}  // namespace runstone
