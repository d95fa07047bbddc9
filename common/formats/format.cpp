#include "common/formats/format.hpp"

#include <algorithm>

#include "common/formats/height_map.hpp"
#include "common/formats/litematic_reader.hpp"
#include "common/formats/look_material.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_region.hpp"
#include "common/formats/model_formats.hpp"
#include "common/formats/mts.hpp"
#include "common/formats/npy.hpp"
#include "common/formats/qb.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_reader.hpp"
#include "common/formats/schematic_writer.hpp"
#include "common/formats/vox.hpp"

namespace runstone {
namespace {

constexpr Format kFormats[] = {
    {"luanti", "map.sqlite", read_luanti_block, material_of_luanti_world_node, nullptr, false},
    {"sponge", ".schem", read_schematic, material_of_schematic_block, write_schem, true,
     write_schem_with},
    {"mcedit", ".schematic", read_schematic, material_of_schematic_block},
    {"litematica", ".litematic", read_litematic, material_of_schematic_block, write_litematic},
    {"minecraft", ".mca", read_minecraft_region, material_of_minecraft_block},
    {"magicavoxel", ".vox", read_vox, material_of_look, write_vox},
    {"qubicle", ".qb", read_qb, material_of_look},
    {"luanti schematic", ".mts", read_mts, material_of_luanti_node, write_mts},
    {"height map", ".png", read_height_map, material_of_look, write_height_map},
    {"numpy", ".npy", read_npy, material_of_look, write_npy},
    {"numpy archive", ".npz", read_npz, material_of_look, write_npz},
    {"glTF", ".glb", nullptr, nullptr, write_glb, true, write_glb_with, &kGlbFormat},
    {"glTF as text", ".gltf", nullptr, nullptr, write_gltf, true, write_gltf_with, &kGltfFormat},
    {"wavefront", ".obj", nullptr, nullptr, write_obj, true, write_obj_with, &kObjFormat},
    {"polygon file", ".ply", nullptr, nullptr, write_ply, true, write_ply_with, &kPlyFormat},
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

bool has_ending(std::string_view path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  path.remove_prefix(path.size() - ending.size());
  return std::equal(path.begin(), path.end(), ending.begin(),
                    [](char a, char b) { return lower(a) == lower(b); });
}

std::span<const Format> formats() { return kFormats; }

const Format* format_of_file(std::string_view path) {
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [&](const Format& format) { return has_ending(path, format.file_ending); });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace runstone
