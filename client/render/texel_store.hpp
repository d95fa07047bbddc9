// TexelStore: one large buffer on the GPU, divided into ranges, that shaders read as a buffer
// texture. Its size doubles when it becomes full. The contents then move piece by piece, a piece
// with each add(), so that no call copies the whole buffer:
//   - The move begins when less than a quarter is free.
//   - Shaders read the old buffer until all texels were copied. Texels that are written meanwhile
//     go to both buffers.
//   - A piece is large enough that the move ends before the old buffer is full. If no free range of
//     the old buffer is large enough all the same, the rest is copied at once.
// Thread: the GL thread.
#pragma once
#include <cstddef>
#include <cstdint>

#include "client/render/gl_handle.hpp"
#include "client/render/range_allocator.hpp"

namespace runstone {

class TexelStore {
 public:
  /// `format` is GL_R32UI or GL_RG32UI, and `texel_bytes` its size.
  TexelStore(GLenum format, std::uint32_t texel_bytes, std::uint32_t texels);

  /// Copies `count` texels into a free range and returns its first texel. Throws
  /// std::runtime_error if the driver allows no larger buffer texture. Requires count > 0. Cost:
  /// O(count), or O(texels of the buffer) if the rest of a move is copied at once.
  std::uint32_t add(const void* texels, std::uint32_t count);
  /// Overwrites texels. Requires a range inside the buffer.
  void write(std::uint32_t first, const void* texels, std::uint32_t count);
  void remove(std::uint32_t first, std::uint32_t count) { ranges_.give_back(first, count); }

  GLuint texture() const { return texture_.get(); }
  std::uint64_t used_bytes() const { return std::uint64_t{ranges_.used()} * texel_bytes_; }
  /// Returns the texels that the buffer holds, and true while they move to a larger one.
  std::uint32_t capacity() const { return ranges_.capacity(); }
  bool is_moving() const { return static_cast<bool>(next_); }

 private:
  /// Makes the larger buffer. Requires that none is there.
  void begin_move(std::uint64_t texels);
  /// Copies texels to the larger buffer, and takes it into use if it has all of them.
  void move(std::uint32_t texels);
  void write_to(const GlBuffer& buffer, std::uint32_t first, const void* texels,
                std::uint32_t count) const;

  const GLenum format_;
  const std::uint32_t texel_bytes_;
  std::uint32_t texels_max_ = 0;  // that the driver allows
  RangeAllocator ranges_;         // of buffer_
  GlBuffer buffer_;
  GlTexture texture_;                        // of buffer_
  GlBuffer next_;                            // to which the texels move; none if they do not move
  std::uint32_t next_size_ = 0, moved_ = 0;  // texels
};

}  // namespace runstone
