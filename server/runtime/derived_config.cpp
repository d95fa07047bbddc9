#include "server/runtime/derived_config.hpp"

#include <asio/ip/address.hpp>

#include "common/os/host_port.hpp"
#include "protocol/default_port.hpp"
#include "server/admin/reserved_names.hpp"
#include "server/admin/server_address.hpp"
#include "server/world/people/chat_state.hpp"

namespace runstone {
namespace {

// The loads under way for each worker. They are enough that no worker waits for the world strand,
// and few enough that chunks to be encoded do not wait for loads.
constexpr std::size_t kLoadsPerWorker = 4;
// The number of connections beyond sessions_max that may be in the handshake.
constexpr std::size_t kHandshakesMax = 64;
constexpr std::size_t kKib = 1024;
constexpr TimeUs kUsPerMs = 1'000, kUsPerSecond = 1'000'000;

/// Returns the address in links. A public address without a port gets that of the server. Without a
/// public address, only that of a server for this machine is known.
std::string link_address(const ServerConfig& config, std::uint16_t port) {
  if (const auto set = parse_host_port(config.public_address, port)) return to_string(*set);
  const auto listen = parse_listen_address(config.listen, kDefaultPort);
  if (!listen) return "HOST";
  asio::error_code error;
  const auto address = asio::ip::make_address(listen->host, error);
  const bool is_local = listen->host == "localhost" || (!error && address.is_loopback());
  return to_string(HostPort{is_local ? listen->host : "HOST", port});
}

}  // namespace

WorldConfig world_config_of(const ServerConfig& config, const WorldMeta& meta, std::uint16_t port) {
  WorldConfig world;
  world.world_id = meta.world_id;
  world.chunk_edge = meta.chunk_edge;
  world.heights = {-static_cast<std::int32_t>(config.depth_max),
                   static_cast<std::int32_t>(config.height_max)};
  world.border = config.border;
  world.spawn = meta.spawn;
  world.materials = meta.materials;
  world.server_keys = key_pair_of(meta.server_key_seed);
  world.sessions_max = config.sessions_max;
  world.sessions_per_key = config.sessions_per_key;
  world.sessions_per_address = config.sessions_per_address;
  world.range_seats_percent = config.range_seats_percent;
  world.names_per_key = config.names_per_key;
  world.names_per_address = config.names_per_address;
  world.reserved_names = folded_reserved_names(config.reserved_names);
  world.operators = config.operators;
  world.link_address = link_address(config, port);
  if (!config.store.empty()) {
    world.may_be_followed = true;
    world.player_address = player_address_of(config, port);
    world.page_address = config.page_address;
    world.move_to_builders = config.standby && config.move_to_builders;
  }
  world.view_radius_max = static_cast<std::uint8_t>(config.view_radius_max);
  world.tile_levels_max = static_cast<std::uint8_t>(config.tile_levels_max);
  if (world.tile_levels_max == 0) world.features &= ~kFeatureTiles;
  world.view_interval_us = static_cast<TimeUs>(config.view_interval_ms) * kUsPerMs;
  world.loads_in_flight_max = kLoadsPerWorker * config.worker_threads;
  world.edit_volume_max = config.edit_volume_max;
  world.reach_max = static_cast<double>(config.reach_max);
  world.speed_max = static_cast<double>(config.speed_max);
  world.edit_budget = config.builder_budget;
  world.chunk_loads = chunk_load_budget(config.chunk_loads_per_second);
  world.budgets_per_address = config.budgets_per_address;
  world.chat_budget = chat_budget(config.chat_per_minute);
  world.library = {config.builds_max, config.builds_mib << 20, config.build_mib << 20,
                   config.builds_per_player, config.builds_mib_per_player << 20};
  world.message_of_the_day = config.message_of_the_day;
  world.idle_us_max = static_cast<TimeUs>(config.idle_s) * kUsPerSecond;
  world.preferred_encoding = config.encoding;
  world.digest_check_interval_us = static_cast<TimeUs>(config.digest_check_ms) * kUsPerMs;
  world.digest_check_chunks = config.digest_check_chunks;
  world.memory = memory_limits_of(config.memory_mib << 20);
  world.snapshots.stack_bytes_max = world.memory.stack_bytes_max;
  world.snapshots.edits_max = config.snapshot_edits;
  world.snapshots.interval_us = static_cast<TimeUs>(config.snapshot_s) * kUsPerSecond;
  // A stop begins no snapshot in the last quarter of stop_s. In that time it completes the snapshots
  // that it has begun, and frees the memory.
  world.stop_us_max = static_cast<TimeUs>(config.stop_s) * kUsPerSecond * 3 / 4;
  return world;
}

NetLimits net_limits_of(const ServerConfig& config) {
  NetLimits limits;
  limits.send.control_bytes = config.control_queue_kib * kKib;
  limits.send.edit_bytes = config.edit_queue_kib * kKib;
  limits.send.chunk_bytes = config.chunk_queue_kib * kKib;
  limits.log_addresses = config.log_addresses;
  limits.bytes_per_second = config.session_kib_per_second * kKib;
  limits.server_bytes_per_second = config.server_kib_per_second * kKib;
  limits.read_bytes_per_second = config.read_kib_per_second * kKib;
  limits.read_bytes_per_address = limits.read_bytes_per_second * config.budgets_per_address;
  limits.connections_max = config.sessions_max + kHandshakesMax;
  limits.connections_per_second = config.connections_per_second;
  limits.handshakes_per_address = config.handshakes_per_address;
  limits.messages_per_second = config.messages_per_second;
  limits.message_burst = 2 * config.messages_per_second;
  return limits;
}

}  // namespace runstone
