#include "client/render/fxaa_painter.hpp"

namespace runstone {
namespace {

constexpr const char* kFxaaVertexShader =
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "  gl_Position = vec4(p, 0.0, 1.0);\n"
    "}\n";

// The four corners around a pixel give the direction of an edge. Pixels in an even neighbourhood
// stay as they are. If the wider mix reaches beyond the edge, the narrow one is taken.
constexpr const char* kFxaaFragmentShader =
    "uniform sampler2D picture;\n"
    "uniform vec2 texel;\n"
    "out vec4 fragment;\n"
    "float luma(vec3 c) { return dot(c, vec3(0.299, 0.587, 0.114)); }\n"
    "vec3 colour_at(vec2 at) { return textureLod(picture, at, 0.0).rgb; }\n"
    "void main() {\n"
    "  vec2 at = gl_FragCoord.xy * texel;\n"
    "  vec3 middle = colour_at(at);\n"
    "  float nw = luma(colour_at(at + vec2(-0.5, 0.5) * texel));\n"
    "  float ne = luma(colour_at(at + vec2(0.5, 0.5) * texel));\n"
    "  float sw = luma(colour_at(at + vec2(-0.5, -0.5) * texel));\n"
    "  float se = luma(colour_at(at + vec2(0.5, -0.5) * texel));\n"
    "  float m = luma(middle);\n"
    "  float least = min(m, min(min(nw, ne), min(sw, se)));\n"
    "  float most = max(m, max(max(nw, ne), max(sw, se)));\n"
    "  if (most - least < max(0.03, 0.10 * most)) {\n"
    "    fragment = vec4(middle, 1.0);\n"
    "    return;\n"
    "  }\n"
    "  vec2 along = vec2(sw + se - nw - ne, nw + sw - ne - se);\n"
    "  float even = max((nw + ne + sw + se) * 0.03125, 0.0078125);\n"
    "  float steep = 1.0 / (min(abs(along.x), abs(along.y)) + even);\n"
    "  along = clamp(along * steep, -8.0, 8.0) * texel;\n"
    "  vec3 narrow = 0.5 * (colour_at(at - along / 6.0) + colour_at(at + along / 6.0));\n"
    "  vec3 wide = 0.5 * narrow + 0.25 * (colour_at(at - along * 0.5) +\n"
    "                                     colour_at(at + along * 0.5));\n"
    "  float w = luma(wide);\n"
    "  fragment = vec4(w < least || w > most ? narrow : wide, 1.0);\n"
    "}\n";

}  // namespace

FxaaPainter::FxaaPainter()
    : program_(link_program("fxaa", kFxaaVertexShader, kFxaaFragmentShader)),
      array_(GlVertexArray::make()) {}

void FxaaPainter::draw(const FrameTarget& picture) {
  glUseProgram(program_.get());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture.colour());
  glUniform1i(glGetUniformLocation(program_.get(), "picture"), 0);
  glUniform2f(glGetUniformLocation(program_.get(), "texel"),
              1.0F / static_cast<float>(picture.width()),
              1.0F / static_cast<float>(picture.height()));
  glBindVertexArray(array_.get());
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace runstone
