#include "common/formats/model_formats.hpp"

#include "common/formats/file_writing.hpp"
#include "common/formats/material_match.hpp"
#include "common/materials/default_look.hpp"
#include "common/materials/visibility_as_cube.hpp"
#include "common/model_writers/coarser_build.hpp"
#include "common/model_writers/model_writers.hpp"

namespace runstone {
namespace {

WrittenBuild model_source(const FileBuild& build) {
  WrittenBuild source{*build.build, build.info, {}};
  for (const BuildMaterial& material : build.materials) {
    const MaterialRow& row = material.row;
    source.materials.push_back({world_name_of(material), row.colour, row.visibility,
                                row.look ? *row.look : default_look(row.name, row.body, row.shape),
                                row.shape, visibility_as_cube(row)});
  }
  return source;
}

Result<void> write_mtl(const FileBuild& build, const FormatSink& sink) {
  return write_mtl_model(model_source(build), sink);
}

}  // namespace

constexpr TriangleFormat kGlbFormat{{}, nullptr, true};
constexpr TriangleFormat kGltfFormat{{}, nullptr, true};
constexpr TriangleFormat kObjFormat{".mtl", write_mtl};
constexpr TriangleFormat kPlyFormat{};

Result<void> write_glb_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink) {
  return write_glb_model(model_source(build), writing.model, sink);
}
Result<void> write_gltf_with(const FileBuild& build, const FileWriting& writing,
                             const FormatSink& sink) {
  return write_gltf_model(model_source(build), writing.model, sink);
}
Result<void> write_obj_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink) {
  return write_obj_model(model_source(build), writing.model, sink);
}
Result<void> write_ply_with(const FileBuild& build, const FileWriting& writing,
                            const FormatSink& sink) {
  return write_ply_model(model_source(build), writing.model, sink);
}

Result<FileBuild> coarser_level(const FileBuild& build) {
  const auto made =
      coarser_build(model_source(build), build.build->memory_bytes() + kBuildBytesMax);
  if (!made) return failure(made.error());
  FileBuild out{build.info, made->build, {}};
  for (const std::uint16_t number : made->finer_numbers) {
    MaterialRow& row = out.materials.emplace_back(build.materials[number - 1U]).row;
    row.visibility = visibility_as_cube(row);
    row.shape = {};
  }
  const VoxelPos sides = out.build->sides();
  out.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                    static_cast<std::uint32_t>(sides.z)};
  return out;
}

Result<void> write_glb(const FileBuild& build, const FormatSink& sink) {
  return write_glb_with(build, {}, sink);
}
Result<void> write_gltf(const FileBuild& build, const FormatSink& sink) {
  return write_gltf_with(build, {}, sink);
}
Result<void> write_obj(const FileBuild& build, const FormatSink& sink) {
  return write_obj_with(build, {}, sink);
}
Result<void> write_ply(const FileBuild& build, const FormatSink& sink) {
  return write_ply_with(build, {}, sink);
}

}  // namespace runstone
