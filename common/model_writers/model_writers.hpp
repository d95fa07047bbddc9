// Writers of triangles: a build as .glb, .gltf, .obj with .mtl, or .ply. What the build shows is
// written: the faces of voxels towards empty and untouched cells, towards the outside of the build,
// and between two materials as in the client (mesh/visibility.hpp). Faces are joined to rectangles
// (common/mesh/rdm). Voxels with a shape have the faces of their boxes or planes
// (common/mesh/shapes). docs/models.md describes the files.
//
// Axes are those of a world: x east, y up, z south, right-handed; in a .ply x east, y north, z up,
// as most of these files are read (usual_up()). Triangles wind counter-clockwise seen from outside.
// The lowest corner of the build is at 0, and its place in a world stands beside the model. Equal
// builds with equal sections give equal bytes.
//
// Each writer requires a material for each palette entry of the build, a side of a voxel that is
// finite and above 0, and at most kModelLevelsMax levels. It fails, before anything is written,
// with:
//   - bad_value if the build shows no face;
//   - limit_exceeded if the file becomes larger than the format allows, or if 128^3 voxels have too
//     many faces of shapes. An .obj finds the latter while it is written.
// It fails with io_failed if the sink returns false. Cost: a number of passes of ModelWalk: one for
// .obj, two for .glb and .gltf, three for .ply. Memory: that of ModelWalk, and what is named below.
// Thread: any.
#pragma once
#include <cstdint>

#include "common/core/result.hpp"
#include "common/model_writers/model_output.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

/// The sizes of files. A .glb names its size in 32 bits. A .gltf is one text with its buffer, and
/// programs in browsers read no longer texts.
inline constexpr std::uint64_t kGlbBytesMax = 0xffff'ffff;
inline constexpr std::uint64_t kGltfBytesMax = 500'000'000;
/// The vertices and the triangles of a .ply: other programs number them with 32 bits and a sign.
inline constexpr std::uint64_t kPlyCountMax = 0x7fff'ffff;

/// Writes binary glTF 2.0: a node for each region, with a primitive for each material in it. Levels
/// of detail are further trees of such nodes, to which MSFT_lod at the root refers.
/// The material of a plant is double-sided, and each of its planes is one rectangle.
/// Memory: 36 bytes for each primitive, and ModelLevels. Fails with limit_exceeded as that does.
Result<void> write_glb_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink);
/// Writes the glTF 2.0 of write_glb_model() as JSON, which holds its buffer as base64.
Result<void> write_gltf_model(const WrittenBuild& source, const ModelWriting& writing,
                              const ModelSink& sink);
/// Writes a Wavefront .obj. It names `writing.material_file`, which write_mtl_model() writes.
/// Memory: 8.6 MB, 40 bytes for each vertex between regions, and 72 bytes for each vertex of a
/// region that lies between the corners of voxels.
Result<void> write_obj_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink);
/// Writes the materials of an .obj of the same source. Cost: O(materials).
Result<void> write_mtl_model(const WrittenBuild& source, const ModelSink& sink);
/// Writes a binary, little-endian .ply whose vertices have normals and colours.
Result<void> write_ply_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink);

}  // namespace runstone
