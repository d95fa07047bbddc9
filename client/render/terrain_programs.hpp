// TerrainPrograms: the programs that draw the faces of the terrain, one for each quality, pass and
// variant. A program is made when it is first used. Thread: the GL thread.
#pragma once
#include <array>
#include <cstddef>
#include <string>

#include "client/render/frame_look.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

/// The variants of a program: bits that add what not every chunk needs.
struct TerrainVariant {
  static constexpr unsigned kInField = 1;    // it reads the light field
  static constexpr unsigned kFine = 2;       // grain and joints are seen
  static constexpr unsigned kInFog = 4;      // a part of the chunk is in the fog
  static constexpr unsigned kTile = 8;       // it is a part of a tile, without shadows
  static constexpr unsigned kFade = 16;      // it appears or dissolves
  static constexpr unsigned kTextured = 32;  // the world has textures
  static constexpr unsigned kHoles = 64;     // shapes, whose faces may have holes
  static constexpr unsigned kGlossy = 128;   // some of its faces mirror sun and sky
  static constexpr std::size_t kCount = 256;
};

struct TerrainProgram {
  GlProgram gl;
  // The uniforms of a chunk. `edge` is that of a part of a tile.
  GLint origin = -1, pattern = -1, scale = -1, edge = -1, drawn = -1;
  GLint first_vertex = -1;  // as QuadBuffer::draw() takes it
  int cascade = -1;         // of the last chunk in this pass; -1: none
};

class TerrainPrograms {
 public:
  /// `variant` has bits of TerrainVariant. Throws std::runtime_error with the driver's log if a
  /// shader does not compile.
  TerrainProgram& of(Quality quality, bool is_transparent, unsigned variant);

 private:
  // By quality and pass.
  std::array<std::array<std::array<TerrainProgram, TerrainVariant::kCount>, 2>, 3> programs_;
};

/// The definition of the variants that draw transparent faces.
inline constexpr const char* kLiquidVariant = "#define RUNSTONE_LIQUID\n";

/// Returns the definitions of texture_glsl.hpp.
std::string texture_definitions(bool is_textured, bool has_holes, bool has_all_holes);

}  // namespace runstone
