#include "client/render/texel_store.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace runstone {
namespace {

/// The least number of texels that are copied for each texel that is added.
constexpr std::uint64_t kMovedPerAdded = 4;

}  // namespace

TexelStore::TexelStore(GLenum format, std::uint32_t texel_bytes, std::uint32_t texels)
    : format_(format), texel_bytes_(texel_bytes), texture_(GlTexture::make()) {
  GLint texels_max = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels_max);
  texels_max_ = static_cast<std::uint32_t>(texels_max);
  begin_move(texels);
  move(0);
}

std::uint32_t TexelStore::add(const void* texels, std::uint32_t count) {
  const std::uint32_t capacity = ranges_.capacity(), free = capacity - ranges_.used();
  if (!next_ && free < capacity / 4 && 2 * std::uint64_t{capacity} <= texels_max_)
    begin_move(2 * std::uint64_t{capacity});
  if (next_) {
    const std::uint64_t left = capacity - moved_;
    const std::uint64_t in_time = (left + free) / (free + 1);  // for each texel
    move(static_cast<std::uint32_t>(std::min(left, count * std::max(kMovedPerAdded, in_time))));
  }
  auto first = ranges_.take(count);
  if (!first && next_) {
    move(ranges_.capacity() - moved_);
    first = ranges_.take(count);
  }
  if (!first) {
    // The larger buffer has a free range of at least `count` texels at its end.
    const std::uint64_t least = std::uint64_t{capacity} + count;
    begin_move(std::max(least, std::min<std::uint64_t>(2 * least, texels_max_)));
    move(ranges_.capacity());
    first = ranges_.take(count);
  }
  write(*first, texels, count);
  return *first;
}

void TexelStore::write(std::uint32_t first, const void* texels, std::uint32_t count) {
  write_to(buffer_, first, texels, count);
  // The texels beyond those that were moved are copied later.
  if (next_ && first < moved_) write_to(next_, first, texels, count);
}

void TexelStore::write_to(const GlBuffer& buffer, std::uint32_t first, const void* texels,
                          std::uint32_t count) const {
  glBindBuffer(GL_TEXTURE_BUFFER, buffer.get());
  glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(first) * texel_bytes_,
                  static_cast<GLsizeiptr>(count) * texel_bytes_, texels);
}

void TexelStore::begin_move(std::uint64_t texels) {
  if (texels > texels_max_)
    throw std::runtime_error("the OpenGL driver allows no buffer texture of this size");
  next_ = GlBuffer::make();
  next_size_ = static_cast<std::uint32_t>(texels);
  moved_ = 0;
  glBindBuffer(GL_TEXTURE_BUFFER, next_.get());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(texels) * texel_bytes_, nullptr,
               GL_DYNAMIC_DRAW);
}

void TexelStore::move(std::uint32_t texels) {
  if (texels != 0) {
    glBindBuffer(GL_COPY_READ_BUFFER, buffer_.get());
    glBindBuffer(GL_TEXTURE_BUFFER, next_.get());
    const GLintptr from = static_cast<GLintptr>(moved_) * texel_bytes_;
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_TEXTURE_BUFFER, from, from,
                        static_cast<GLsizeiptr>(texels) * texel_bytes_);
    moved_ += texels;
  }
  if (moved_ != ranges_.capacity()) return;
  buffer_ = std::exchange(next_, {});
  glBindTexture(GL_TEXTURE_BUFFER, texture_.get());
  glTexBuffer(GL_TEXTURE_BUFFER, format_, buffer_.get());
  ranges_.grow(next_size_);
}

}  // namespace runstone
