// The texture units that the passes of the terrain use.
#pragma once
#include "client/render/gl_handle.hpp"
#include "client/render/quad_buffer.hpp"

namespace runstone {

/// MaterialTextures::bind() takes the first two units.
inline constexpr GLint kMaterialUnit = 0, kQuadUnit = 2, kFieldUnit = 3, kNoiseUnit = 4,
                       kShadowUnit = 5, kDepthUnit = 6;
static_assert(kDepthUnit < QuadBuffer::kShapeUnit);
/// TextureArray::bind() takes two units. A fragment shader has at least 16.
inline constexpr GLint kTextureUnit = 14;
static_assert(QuadBuffer::kShapeUnit < kTextureUnit && kTextureUnit + 1 < 16);

}  // namespace runstone
