#include "common/core/key_text.hpp"

namespace runstone {

std::string text_of(const VoxelPos& at) {
  return std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z);
}

std::string text_of(const ChunkKey& key) {
  std::string text =
      std::to_string(key.at.x) + "," + std::to_string(key.at.y) + "," + std::to_string(key.at.z);
  if (key.lod != 0) text += " lod=" + std::to_string(key.lod);
  return text;
}

std::string text_of(const Version& version) {
  return std::to_string(version.epoch) + ":" + std::to_string(version.seq);
}

}  // namespace runstone
