#include "common/formats/block_materials.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/block_assembler.hpp"

namespace runstone {

void BlockMaterials::note(const ForeignPiece& piece) {
  std::vector<bool> occurs(piece.blocks.size() + 1);
  for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i)
    occurs[piece.voxels.runs.material(i)] = true;
  for (std::size_t i = 0; i < piece.blocks.size() && bytes_ <= kForeignBlockBytesMax; ++i) {
    const ForeignBlock& block = piece.blocks[i];
    if (occurs[i + 1] && ids_.try_emplace(block, kEmpty).second)
      bytes_ += sizeof(block) + block.name.size() + block.states.size();
  }
}

Result<MaterialTable> BlockMaterials::make_table() {
  if (bytes_ > kForeignBlockBytesMax) {
    return fail(ErrorCode::limit_exceeded,
                "the names and states of the blocks take more than 64 MiB");
  }
  std::vector<MaterialInfo> infos;           // of ids_, in its order
  std::map<std::string, MaterialInfo> kept;  // by name; not chosen by the map
  for (const auto& [block, id] : ids_) {
    MaterialInfo info = format_.material_of(block, keep_all_);
    const auto mapped =
        map_ != nullptr ? map_->apply({row_of(info), block.states}, applied_) : std::nullopt;
    if (mapped) {
      info = {mapped->name, mapped->colour, mapped->visibility, std::nullopt,
              mapped->body, mapped->look,   mapped->shape};
    } else if (map_ != nullptr) {
      kept.try_emplace(info.name, info);
    }
    infos.push_back(std::move(info));
  }
  MaterialTable table;
  std::size_t next = 0;
  for (auto& [block, id] : ids_) {
    MaterialInfo& info = infos[next++];
    if (info.visibility == Visibility::empty) continue;
    if (const auto known = table.find(info.name)) {
      id = *known;
      continue;
    }
    const auto same = kept.find(info.name);
    const bool is_kept = same != kept.end() && same->second.visibility != Visibility::empty;
    const auto added = table.add(is_kept ? same->second : std::move(info));
    if (!added) return failure(added.error());
    id = *added;
  }
  return table;
}

RunChunk BlockMaterials::resolve(const ForeignPiece& piece) const {
  std::vector<Material> to(piece.blocks.size() + 1, kEmpty);
  for (std::size_t i = 0; i < piece.blocks.size(); ++i) {
    const auto known = ids_.find(piece.blocks[i]);
    if (known != ids_.end()) to[i + 1] = known->second;
  }
  return with_materials(piece.voxels, to);
}

}  // namespace runstone
