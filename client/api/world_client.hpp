// WorldClient: joins a server and keeps a replica of the world around the player: the same session,
// replica and network as runstone-client, without a window. The loop of a program:
//
//   auto client = WorldClient::connect({.server = "localhost", .name = "ada"});
//   for (each frame) {
//     client->step();
//     for (WorldEvent& event : client->drain(16)) ...;  // mesh chunks, hear of edits
//     ... client->move(place); client->submit(edit); ...
//   }
//
// A program that handles these events alone keeps no mesh that is out of date: a chunk is reported
// when it changes, and when a neighbour arrives, changes or leaves. While terrain loads, a chunk is
// reported once all neighbours are there that the server will send, so that it is meshed once.
//
// Threads:
//   - The calls of one client are made by one thread at a time. Two clients do not share anything.
//   - The library has a thread for the network, and one for the cache if there is one. They call
//     WorldClientOptions::wake and nothing else of the program.
//   - What MeshSource, chunk() and mesh_materials() return may be read by any thread.
//   - No call waits for the network or a disk, except connect() with files, wait() and close(), and
//     the step() that meets a server for the first time and keeps its key in a file.
//   - step() and close() wait for the threads of the library when they end. So wake must not wait
//     for a thread that may be in a call of the client, for example for a mutex that it holds.
//
// Errors are results with words. No input of a server, of files or of the caller aborts the
// program, and no call throws, except std::bad_alloc. The library writes no log.
//
// Bounds: chunks and edits by WorldClientOptions::memory_mib; events of the network by 16 MiB,
// beyond which the server is held back; events that were not drained by the newest 4,096 of each
// kind, and those of edits of others by 1,048,576 chunks that they name; edits of this client by
// kEditsWaitingMax. Events of edits of this client and of removed chunks are never dropped.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/api/mesh_source.hpp"
#include "client/api/world_client_options.hpp"
#include "client/api/world_event.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/core/world_pos.hpp"

namespace runstone {

struct EditDescriptor;  // common/edits/descriptor/edit_descriptor.hpp, of runstone::edits
struct MaterialRow;     // common/core/material_row.hpp, of runstone::core
struct MeshMaterials;   // common/mesh/mesh_materials.hpp, of runstone::mesh

/// Why a call did nothing. `text` is a line for the player.
struct ClientRefusal {
  ErrorCode code = ErrorCode::bad_value;
  std::string text;
};

/// Where a player stands and looks.
struct ClientPlace {
  WorldPos at;               // of the eye
  double yaw_degrees = 0;    // 0 looks along +z; grows towards +x
  double pitch_degrees = 0;  // -90 .. 90; positive looks up
};

struct PlayerInfo {
  AuthorId author = 0;
  std::string name;
  std::string role;  // empty: the server did not name it
  std::optional<ClientPlace> place;
};

/// The open world, as its server describes it.
struct ClientWorld {
  std::array<std::uint8_t, 16> id{};
  std::int32_t chunk_edge = 0;        // voxels
  std::int32_t y_min = 0, y_max = 0;  // edits may cover voxels with y_min <= y < y_max
  std::uint64_t edit_volume_max = 0;  // voxels of an edit
  WorldPos spawn;
  AuthorId author = 0;             // this player
  std::string name;                // of this player
  std::string server_fingerprint;  // of the server's key, in words for a comparison
};

enum class ConnectionState : std::uint8_t {
  connecting,  // there is no open world; attempts to connect go on
  open,
  ended,  // close() was called, or the server refused this client for good
};

/// Edits of this client that wait for an answer or are not known to be on disk.
inline constexpr std::size_t kEditsWaitingMax = 16'384;
/// The value of `action` for the first edit of a new action.
inline constexpr EditNumber kNewAction = UINT64_MAX;

class WorldClient {
 public:
  /// Starts connecting, and returns at once: WorldOpened or ConnectionLost tells the outcome. After
  /// a loss the client connects again by itself. Fails with words if an option is wrong, or if the
  /// key file, the file of authorities or the cache cannot be used.
  static Result<WorldClient, std::string> connect(WorldClientOptions options);
  /// Calls close().
  ~WorldClient();
  WorldClient(WorldClient&&) noexcept;
  /// Calls close() first.
  WorldClient& operator=(WorldClient&&) noexcept;

  /// Handles what has arrived and sends what is due. Call it every frame, and every 10 ms where
  /// there are no frames. Takes a few milliseconds at most, with a password a quarter of a second
  /// when it joins; has_more() returns true if something is left.
  void step();
  /// Returns true if another step() has something to do at once.
  bool has_more() const;
  /// Waits until step() has something to do, `milliseconds` at most. For programs without frames.
  void wait(unsigned milliseconds);
  /// Returns the events since the last call, in their order, and `chunks_max` of the chunks that
  /// have to be meshed at most: those with edits of this player first, then the nearest ones. The
  /// others are kept.
  std::vector<WorldEvent> drain(std::size_t chunks_max = SIZE_MAX);
  /// Returns the number of chunks that have to be meshed: those that drain() has not returned yet,
  /// and those that wait for a neighbour.
  std::size_t outdated_count() const;

  ConnectionState state() const;
  /// Returns nullopt before the first WorldOpened. Stays over a lost connection.
  const std::optional<ClientWorld>& world() const;
  /// Returns true if the world is open, and all chunks around the player have arrived.
  bool is_complete() const;

  /// Moves the player, and the view with it. A server that a client joins for the first time begins
  /// at the spawn, and later where the player left; place() says where. Fails before the first
  /// WorldOpened, and for numbers that are not finite or outside of the world.
  Result<void, ClientRefusal> move(const ClientPlace& place);
  /// Returns the place of the player: the last move(), or where the server has the player begin.
  const ClientPlace& place() const;
  /// Changes the radii of the view, as in WorldClientOptions. Fails above 64.
  Result<void, ClientRefusal> set_view_radii(std::uint8_t horizontal, std::uint8_t vertical);

  /// Shows an edit at once and sends it to the server. EditConfirmed or EditRejected tells the
  /// outcome, also after a lost connection. There is none for edits that are open when the client
  /// ends. Edits with the same `action` are undone as one: pass kNewAction with the first, and the
  /// number of the first with the others. 0: the edit is an action by itself. Fails
  ///   - with bad_value before the first WorldOpened and after the end;
  ///   - with the error of validate() for an invalid edit, and with not_found for a material that the
  ///     world lacks or a chunk that the server cannot send;
  ///   - with unknown_kind for an edit without voxels;
  ///   - with not_permitted if the player may not make it, as far as the client knows;
  ///   - with limit_exceeded if the edit is larger than the world allows, if the budget of the
  ///     player does not suffice yet (wait_us()), or if kEditsWaitingMax edits or events of edits
  ///     wait.
  Result<EditNumber, ClientRefusal> submit(const EditDescriptor& edit, EditNumber action = 0);
  /// Returns how long the budget of the player needs until it suffices for the edit. 0: it does.
  TimeUs wait_us(const EditDescriptor& edit) const;

  /// Sends a line to everybody. Fails unless a world is open, and if the server has no chat or the
  /// line is empty, too long or not UTF-8.
  Result<void, ClientRefusal> chat(std::string_view line);
  /// Sends a command, such as "undo". CommandDone has the answer. Fails unless a world is open,
  /// while another command runs or its answer was not drained, if the text is empty, too long or
  /// not UTF-8, and if the server accepts no commands.
  Result<void, ClientRefusal> command(std::string_view text);

  /// Return null or nullopt if the chunk is not shown.
  std::shared_ptr<const RunChunk> chunk(ChunkCoord at) const;
  std::optional<MeshSource> mesh_source(ChunkCoord at) const;
  std::optional<Material> material_at(VoxelPos at) const;
  /// Returns the chunks that are shown, ascending.
  std::vector<ChunkCoord> chunks() const;

  /// Returns the materials by id. Empty before the first WorldOpened.
  const std::vector<MaterialRow>& materials() const;
  /// Cost: O(materials).
  std::optional<Material> find_material(std::string_view name) const;
  /// Returns what the meshers read of the materials. Never null.
  std::shared_ptr<const MeshMaterials> mesh_materials() const;

  /// Returns the other players in the world, ascending by author.
  std::vector<PlayerInfo> players() const;

  /// Sends what is queued and a goodbye, and ends the threads. Waits a second at most for the
  /// network, and for the cache to be written. Chunks stay readable. Does nothing if it was called.
  void close();

 private:
  struct State;
  explicit WorldClient(std::unique_ptr<State> state);
  void close_if_any() noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
