// TexelStore: one large buffer on the GPU, divided into ranges, that shaders read as a buffer
// texture. It doubles when it is full. Thread: the GL thread.
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
  /// std::runtime_error if the driver allows no larger buffer texture. Requires count > 0.
  std::uint32_t add(const void* texels, std::uint32_t count);
  /// Overwrites texels. Requires a range inside the buffer.
  void write(std::uint32_t first, const void* texels, std::uint32_t count);
  void remove(std::uint32_t first, std::uint32_t count) { ranges_.give_back(first, count); }

  GLuint texture() const { return texture_.get(); }
  std::uint64_t used_bytes() const { return std::uint64_t{ranges_.used()} * texel_bytes_; }

 private:
  void grow(std::uint32_t texels);

  const GLenum format_;
  const std::uint32_t texel_bytes_;
  RangeAllocator ranges_;
  GlBuffer buffer_;
  GlTexture texture_;
};

}  // namespace runstone
