#include "client/render/texel_store.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace runstone {

TexelStore::TexelStore(GLenum format, std::uint32_t texel_bytes, std::uint32_t texels)
    : format_(format), texel_bytes_(texel_bytes), texture_(GlTexture::make()) {
  grow(texels);
}

std::uint32_t TexelStore::add(const void* texels, std::uint32_t count) {
  auto first = ranges_.take(count);
  if (!first) {
    // The doubled buffer has a free range of at least `count` texels at its end.
    grow(std::max(2 * ranges_.capacity(), ranges_.capacity() + count));
    first = ranges_.take(count);
  }
  write(*first, texels, count);
  return *first;
}

void TexelStore::write(std::uint32_t first, const void* texels, std::uint32_t count) {
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_.get());
  glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(first) * texel_bytes_,
                  static_cast<GLsizeiptr>(count) * texel_bytes_, texels);
}

void TexelStore::grow(std::uint32_t texels) {
  GLint texels_max = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels_max);
  if (texels > static_cast<std::uint32_t>(texels_max))
    throw std::runtime_error("the OpenGL driver allows no buffer texture of this size");
  GlBuffer next = GlBuffer::make();
  glBindBuffer(GL_TEXTURE_BUFFER, next.get());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(texels) * texel_bytes_, nullptr,
               GL_DYNAMIC_DRAW);
  if (buffer_) {
    glBindBuffer(GL_COPY_READ_BUFFER, buffer_.get());
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_TEXTURE_BUFFER, 0, 0,
                        static_cast<GLsizeiptr>(ranges_.capacity()) * texel_bytes_);
  }
  buffer_ = std::move(next);
  glBindTexture(GL_TEXTURE_BUFFER, texture_.get());
  glTexBuffer(GL_TEXTURE_BUFFER, format_, buffer_.get());
  ranges_.grow(texels);
}

}  // namespace runstone
