// Behaviour: what a bot does. It sees the ground and says which edit comes next and where the bot stands; when edits are due is
// the bot's business. Seeded: the same seed and the same ground give the same edits. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "client/bots/ground.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// idle: stands there. walk: goes round its site. run_away: straight away from its site, for ever. build: houses on its site, voxel by
/// voxel. brush: spheres and strokes on its site. grief: digs, covers and cuts across the sites of all. join_storm: looks at
/// its site, leaves and comes back.
enum class BotRole : std::uint8_t { idle, walk, run_away, build, brush, grief, join_storm };
std::optional<BotRole> bot_role(std::string_view name);

/// Voxels along x and z of the ground that one bot has to itself.
inline constexpr std::int32_t kSiteSide = 48;

/// Where a bot of a fleet belongs. Sites lie in a square grid around the spawn, without touching.
struct BotPlace {
  WorldPos spawn;
  std::size_t index = 0, count = 1;  // which site, of how many
};
/// Corner of smallest x and z of a site; y is the spawn's.
VoxelPos site_corner(const BotPlace& place);

class Behaviour {
 public:
  virtual ~Behaviour() = default;
  /// Where the bot stands after `seconds`; its view is around it.
  virtual WorldPos position(double seconds) const = 0;
  /// The next edit; nothing if what it depends on is not loaded, or if this role edits nothing.
  virtual std::optional<EditDescriptor> next_edit(const Ground& ground) = 0;
};

/// `materials` must outlive the behaviour and have one that is not empty.
std::unique_ptr<Behaviour> make_behaviour(BotRole role, const BotPlace& place,
                                          const MaterialTable& materials, std::uint64_t seed);

}  // namespace runstone
