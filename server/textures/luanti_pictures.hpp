// LuantiPictures: the textures of a game or mod of Luanti. The definitions of nodes are found in
// its files in Lua by a scan that runs nothing: register_node("name", {tiles = {...}}) with plain
// texts, and register_stair_and_slab("name", "node", ...). What is made by code is not found.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "server/textures/side_pictures.hpp"

namespace runstone {

/// The nodes that files in Lua define, at most.
inline constexpr std::size_t kLuantiNodesMax = 65'536;

/// The nodes that scan_lua() found.
struct LuantiNodes {
  /// The tiles of each node by its name: +y, -y, +x, -x, +z, -z. A tile that is not plain text is
  /// empty.
  std::map<std::string, std::array<std::string, 6>> tiles;
  /// The node of which stairs and slabs with this name are made.
  std::map<std::string, std::string> stairs;
};

/// Adds the nodes that a text in Lua defines. The first definition of a node stays. Every text is
/// read. Cost: O(bytes).
void scan_lua(std::string_view text, LuantiNodes& nodes);

class LuantiPictures final : public PictureSource {
 public:
  /// `files`: the path of each picture by the name of its file.
  LuantiPictures(std::map<std::string, std::string> files, LuantiNodes nodes)
      : files_(std::move(files)), nodes_(std::move(nodes)) {}
  /// Reads the folder of a game or mod. Fails with one line if the folder cannot be read.
  static Result<std::unique_ptr<PictureSource>, std::string> open(const std::string& folder);

  const char* kind() const override { return "a game or mod of Luanti"; }
  SidePictures pictures_of(const MaterialInfo& material) override;

 private:
  const std::array<std::string, 6>* tiles_of(const std::string& node) const;
  /// Returns the pictures of a tile such as "a.png^b.png": those before the first part that is
  /// none.
  SidePicture picture_of(const std::string& tile) const;

  std::map<std::string, std::string> files_;
  LuantiNodes nodes_;
};

}  // namespace runstone
