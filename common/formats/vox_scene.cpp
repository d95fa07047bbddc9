#include "common/formats/vox_scene.hpp"

#include <map>
#include <set>

namespace runstone {
namespace {

/// A node whose children are visited.
struct VoxVisit {
  std::int32_t id = 0;
  const VoxNode* node = nullptr;
  VoxPlace place;  // of what is below the node, in the scene
  std::size_t next = 0;
};

/// Returns the first node that is no child: 0 in files of MagicaVoxel.
std::int32_t root_of(const VoxFile& file) {
  if (file.nodes.contains(0)) return 0;
  std::set<std::int32_t> children;
  for (const auto& [id, node] : file.nodes) {
    if (node.kind != VoxNode::Kind::shape)
      children.insert(node.children.begin(), node.children.end());
  }
  for (const auto& [id, node] : file.nodes) {
    if (!children.contains(id)) return id;
  }
  return file.nodes.begin()->first;
}

/// Returns the models of a file without a scene graph: a row along x.
std::vector<PlacedVoxModel> row_of_models(const VoxFile& file) {
  std::vector<PlacedVoxModel> out;
  std::int32_t x = 0;
  for (std::size_t i = 0; i < file.models.size(); ++i) {
    const VoxModel& model = file.models[i];
    out.push_back({i, {{}, {x + model.x / 2, model.y / 2, model.z / 2}}});
    x += model.x + 1;
  }
  return out;
}

}  // namespace

std::optional<VoxPlace> composed(const VoxPlace& outer, const VoxPlace& inner) {
  VoxPlace out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = outer.turn.from[i];
    out.turn.from[i] = inner.turn.from[from];
    out.turn.sign[i] = static_cast<std::int8_t>(outer.turn.sign[i] * inner.turn.sign[from]);
    const std::int64_t at =
        std::int64_t{outer.shift[i]} + std::int64_t{outer.turn.sign[i]} * inner.shift[from];
    if (at < -kWorldLimit || at > kWorldLimit) return std::nullopt;
    out.shift[i] = static_cast<std::int32_t>(at);
  }
  return out;
}

Result<std::vector<PlacedVoxModel>> placed_models(const VoxFile& file) {
  if (file.nodes.empty()) return row_of_models(file);
  std::vector<PlacedVoxModel> out;
  std::vector<VoxVisit> path;
  std::set<std::int32_t> on_path;
  std::size_t visited = 0;
  std::size_t parent_at = 0;  // offset of the chunk that names the next node
  const auto enter = [&](std::int32_t id, const VoxPlace& place) -> Result<void> {
    const auto found = file.nodes.find(id);
    if (found == file.nodes.end())
      return fail(ErrorCode::bad_value, "vox: the scene names a node that does not exist",
                  parent_at);
    const VoxNode& node = found->second;
    if (on_path.contains(id))
      return fail(ErrorCode::bad_value, "vox: nodes of the scene form a cycle", node.offset);
    if (++visited > kVoxNodesMax)
      return fail(ErrorCode::limit_exceeded, "vox: the scene visits more than 65536 nodes",
                  node.offset);
    if (node.is_hidden || file.hidden_layers.contains(node.layer)) return {};
    if (node.kind == VoxNode::Kind::shape) {
      if (node.children.empty()) return {};
      const std::int32_t model = node.children.front();
      if (model < 0 || static_cast<std::size_t>(model) >= file.models.size())
        return fail(ErrorCode::bad_value, "vox: the scene names a model that does not exist",
                    node.offset);
      out.push_back({static_cast<std::size_t>(model), place});
      return {};
    }
    const auto inside = composed(place, node.place);
    if (!inside)
      return fail(ErrorCode::bad_value, "vox: the scene reaches out of the world", node.offset);
    path.push_back({id, &node, *inside});
    on_path.insert(id);
    return {};
  };
  if (const auto entered = enter(root_of(file), {}); !entered) return failure(entered.error());
  while (!path.empty()) {
    VoxVisit& top = path.back();
    if (top.next == top.node->children.size()) {
      on_path.erase(top.id);
      path.pop_back();
      continue;
    }
    parent_at = top.node->offset;
    const std::int32_t child = top.node->children[top.next++];
    const VoxPlace place = top.place;
    if (const auto entered = enter(child, place); !entered) return failure(entered.error());
  }
  return out;
}

}  // namespace runstone
