// Models of triangles: .glb, .gltf, .obj with .mtl, and .ply: out. The rows of the table of formats
// that hand a build to common/model_writers.
#pragma once
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// Write a build with the default choices of ModelWriting. Fail as the writers of
/// model_writers.hpp do. The name of a material is world_name_of(). An .obj names no
/// file of materials.
Result<void> write_glb(const FileBuild& build, const FormatSink& sink);
Result<void> write_gltf(const FileBuild& build, const FormatSink& sink);
Result<void> write_obj(const FileBuild& build, const FormatSink& sink);
Result<void> write_ply(const FileBuild& build, const FormatSink& sink);

/// Returns the next coarser level of detail of a build (common/model_writers/coarser_build.hpp),
/// which has the name and the origin of the build. Its materials are cubes. Fails as
/// coarser_build() does. Requires can_be_coarser().
Result<FileBuild> coarser_level(const FileBuild& build);
/// Write a build with the choices of FileWriting::model. Otherwise they are as those above.
Result<void> write_glb_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink);
Result<void> write_gltf_with(const FileBuild& build, const FileWriting& writing,
                             const FormatSink& sink);
Result<void> write_obj_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink);
Result<void> write_ply_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink);

extern const TriangleFormat kGlbFormat, kGltfFormat, kObjFormat, kPlyFormat;

}  // namespace runstone
