// Behaviour: what a bot does. It reads the ground, and returns the next edit and the position of
// the bot. The bot decides when edits are due. Seeded: the same seed and the same ground give the
// same edits. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "client/bots/ground_height.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The roles of bots:
///   - idle: stands still.
///   - walk: walks around its site.
///   - run_away: moves straight away from its site, without end.
///   - build: builds houses on its site, voxel by voxel.
///   - brush: draws spheres and strokes on its site.
///   - grief: digs, covers and cuts on the sites of all bots.
///   - join_storm: loads the view of its site, disconnects, and connects again.
enum class BotRole : std::uint8_t { idle, walk, run_away, build, brush, grief, join_storm };
/// Returns the role of this name, or nullopt if there is none.
std::optional<BotRole> bot_role(std::string_view name);

/// Side of a site: voxels along x and z of the ground of one bot.
inline constexpr std::int32_t kSiteSide = 48;

/// The site of a bot of a fleet. Sites form a square grid around the spawn and do not overlap.
struct BotPlace {
  WorldPos spawn;
  std::size_t index = 0, count = 1;  // index of the site; number of sites
};
/// Returns the corner of smallest x and z of a site. Its y is that of the spawn.
VoxelPos site_corner(const BotPlace& place);

class Behaviour {
 public:
  virtual ~Behaviour() = default;
  /// Returns the position of the bot after `seconds`. Its view is centred there.
  virtual WorldPos position(double seconds) const = 0;
  /// Returns the next edit. Returns nullopt if the ground that it needs is not loaded, or if the
  /// role makes no edits.
  virtual std::optional<EditDescriptor> next_edit(const GroundHeight& ground) = 0;
};

/// `materials` must outlive the behaviour and have a material that is not empty.
std::unique_ptr<Behaviour> make_behaviour(BotRole role, const BotPlace& place,
                                          const MaterialTable& materials, std::uint64_t seed);

}  // namespace runstone
