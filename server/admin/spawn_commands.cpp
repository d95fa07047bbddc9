#include "server/admin/spawn_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/core/world_pos.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/world/environment/world_border.hpp"

namespace runstone {
namespace {

constexpr CommandRule kSpawnKeepers = needs(Right::administer);

std::string spawn_text(const WorldPos& at) {
  return fmt::format("{:.1f} {:.1f} {:.1f}", at.x, at.y, at.z);
}

/// Returns the sentence of the answer about the ground that is kept clear.
std::string kept_text(const CommandCall& call) {
  const Decided<ProtectedBox>* box = call.rights().find_box(kSpawnBox);
  if (box == nullptr) return "; no ground is kept clear (spawn keep-clear R)";
  const VoxelPos at = voxel_of_point(call.world().spawn());
  const bool has_spawn = box->value.box.contains(at);
  return "; the box " + std::string(kSpawnBox) + " protects " + ground_text(box->value.box) +
         (has_spawn ? "" : ", which does not hold the spawn (spawn keep-clear R moves it)");
}

void show_spawn(const CommandCall& call) {
  call.answer("the spawn is at " + spawn_text(call.world().spawn()) + kept_text(call));
}

Result<SpawnCommand, std::string> parse_spawn_here(WordReader& reader) {
  reader.expect_end("spawn here");
  return reader.result(SpawnCommand{});
}

Result<SpawnCommand, std::string> parse_spawn_at(WordReader& reader) {
  SpawnCommand command;
  command.at = reader.position("spawn");
  reader.expect_end("spawn X Y Z");
  return reader.result(command);
}

void set_spawn(const CommandCall& call, const SpawnCommand& command) {
  WorldPos at;
  if (command.at) {
    at = {command.at->x + 0.5, static_cast<double>(command.at->y), command.at->z + 0.5};
  } else {
    const auto online = call.world().people().online();
    const auto caller = std::ranges::find_if(online, [&](const OnlinePlayer& player) {
      return call.caller.actor.key && player.key == *call.caller.actor.key;
    });
    if (caller == online.end())
      return call.refuse("spawn here is for players: spawn X Y Z names a place");
    at = caller->at;
  }
  const auto is_in_world = [](double c) { return std::isfinite(c) && std::abs(c) < kWorldLimit; };
  if (!is_in_world(at.x) || !is_in_world(at.y) || !is_in_world(at.z))
    return call.refuse("spawn: that place is outside the world");
  const auto& border = call.world().border();
  if (border && !holds_voxel(*border, voxel_of_point(at)))
    return call.refuse("spawn: that place is beyond the border of this world: " +
                       border_text(*border));
  call.world().set_spawn(at, call.now);
  call.answer("the spawn is at " + spawn_text(at) +
              " for players who join from now on and were not here before" + kept_text(call));
}

Result<std::int64_t, std::string> parse_keep_clear(WordReader& reader) {
  const std::int64_t radius = reader.number("spawn keep-clear", 0, kSpawnRadiusMax);
  reader.expect_end("spawn keep-clear R");
  return reader.result(radius);
}

void keep_clear(const CommandCall& call, const std::int64_t& wanted) {
  const auto radius = static_cast<std::int32_t>(wanted);
  const Decided<ProtectedBox>* old = call.rights().find_box(kSpawnBox);
  if (old != nullptr && old->value.owner)
    return call.refuse("a player owns a protected box \"" + std::string(kSpawnBox) +
                       "\": give it another owner or remove it first (unprotect " + kSpawnBox +
                       ")");
  if (radius == 0) {
    if (old == nullptr) return call.refuse("no ground is kept clear");
    return call.change_rights(Unprotect{kSpawnBox}, "the ground around the spawn is free");
  }
  const VoxelPos at = voxel_of_point(call.world().spawn());
  const auto low = [&](std::int32_t c) { return std::max(c - radius, -kWorldLimit); };
  const auto high = [&](std::int32_t c) { return std::min(c + radius + 1, kWorldLimit); };
  ProtectedBox box = old == nullptr ? ProtectedBox{} : old->value;
  box.name = kSpawnBox;
  box.box = {{low(at.x), -kWorldLimit, low(at.z)}, {high(at.x), kWorldLimit, high(at.z)}};
  box.priority = kSpawnBoxPriority;
  call.change_rights(Protect{box},
                     "the ground around the spawn is kept clear: " + ground_text(box.box) +
                         "; who has the right build_protected edits there");
}

constexpr std::array<CommandRow, 4> kSpawnRows = {{
    {"spawn", kSpawnKeepers,
     "spawn                     where new players begin, and the ground that is kept clear",
     alone<show_spawn>()},
    {"spawn here", kSpawnKeepers, "spawn here                let new players begin where you are",
     parsed_by<parse_spawn_here, set_spawn>()},
    {"spawn keep-clear", kSpawnKeepers,
     "spawn keep-clear R        protect the columns up to R voxels around the spawn; 0: none",
     parsed_by<parse_keep_clear, keep_clear>()},
    {"spawn X", kSpawnKeepers, "spawn X Y Z               let new players begin there",
     parsed_by<parse_spawn_at, set_spawn>()},
}};

}  // namespace

std::span<const CommandRow> spawn_commands() { return kSpawnRows; }

}  // namespace runstone
