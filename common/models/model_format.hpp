// ModelFormat: the formats of models that are read, by the ending of a file's name. Thread: any. Cost:
// O(bytes of the name).
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace runstone {

enum class ModelFormat : std::uint8_t { obj, stl, ply, gltf, glb };

/// The axis of a file that points up. The axes of a file are right-handed.
enum class ModelUp : std::uint8_t { y, z };

/// Returns the format by the ending of a path, upper and lower case being equal, or nullopt if it has
/// no ending of a model: .obj, .stl, .ply, .gltf or .glb.
std::optional<ModelFormat> model_format_of(std::string_view path);

/// Returns the axis that points up in most files of a format: z in .stl and .ply, y in others. glTF
/// fixes it, and so do exporters of .obj by convention. Makers of .stl and .ply have no rule.
ModelUp usual_up(ModelFormat format);

}  // namespace runstone
