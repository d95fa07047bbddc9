// WorldClient: joins a server and keeps a replica of the world around the player. It has the
// session, the replica and the network of runstone-client, without a window. The loop of a program:
//
//   auto client = WorldClient::connect({.server = "localhost", .name = "ada"});
//   for (each frame) {
//     client->step();
//     for (WorldEvent& event : client->drain(16)) ...;  // mesh chunks, handle outcomes of edits
//     ... client->move(place); client->submit(edit); ...
//   }
//
// A program that handles these events keeps no mesh that is out of date: a chunk is reported when
// it changes, and when a neighbour arrives, changes or leaves. While terrain loads, a chunk is
// reported as soon as all neighbours that the server will send are there, so it is meshed once.
//
// Threads:
//   - The calls of one client are made by one thread at a time. Two clients do not share anything.
//   - The library has a thread for the network, and a second one if there is a cache. These threads
//     call WorldClientOptions::wake and nothing else of the program.
//   - Any thread may read a MeshSource, and the results of chunk() and mesh_materials().
//   - No call waits for the network or a disk, except connect() with files, wait(), close(), and
//     the step() that saves the key of a new server in a file.
//   - step() and close() wait for the threads of the library when they end. So wake must not wait
//     for a thread that may be in a call of the client, for example for a mutex that it holds.
//
// Errors are results with words. No input of a server, of files or of the caller aborts the
// program, and no call throws, except std::bad_alloc. The library writes no log.
//
// Bounds:
//   - chunks and edits: WorldClientOptions::memory_mib;
//   - received messages: 16 MiB, beyond which the client stops reading from the server;
//   - events that were not drained: the newest 4,096 of each kind, and 1,048,576 chunks that events
//     of edits of others name;
//   - edits of this client: kEditsWaitingMax.
// Events of edits of this client and of removed chunks are never dropped.
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

/// The reason why a call did nothing. `text` is a line for the player.
struct ClientRefusal {
  ErrorCode code = ErrorCode::bad_value;
  std::string text;
};

/// The place of a player, and the direction in which the player looks.
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
  /// Starts to connect and returns at once. WorldOpened or ConnectionLost reports the outcome.
  /// After a loss the client connects again by itself. Fails with words if an option is wrong, or
  /// if the key file, the file of authorities or the cache cannot be used.
  static Result<WorldClient, std::string> connect(WorldClientOptions options);
  /// Calls close().
  ~WorldClient();
  WorldClient(WorldClient&&) noexcept;
  /// Calls close() first.
  WorldClient& operator=(WorldClient&&) noexcept;

  /// Handles received messages and sends due ones. Call it every frame, or every 10 ms in a program
  /// without frames. A call takes a few milliseconds at most. The call that joins with a password
  /// takes a quarter of a second.
  void step();
  /// Returns true if the last step() left messages for another step() at once.
  bool has_more() const;
  /// Waits until step() has something to do, at most `milliseconds`. It is for programs without
  /// frames.
  void wait(unsigned milliseconds);
  /// Returns the events since the last call, in their order, and at most `chunks_max` of the chunks
  /// that have to be meshed: chunks with edits of this player first, then the nearest ones. The
  /// other chunks are kept for later calls.
  std::vector<WorldEvent> drain(std::size_t chunks_max = SIZE_MAX);
  /// Returns the number of chunks that have to be meshed: chunks that drain() has not returned yet,
  /// and chunks that wait for a neighbour.
  std::size_t outdated_count() const;

  ConnectionState state() const;
  /// Returns the open world, or nullopt before the first WorldOpened. After a lost connection it
  /// returns the world as before.
  const std::optional<ClientWorld>& world() const;
  /// Returns true if the world is open, and all chunks around the player have arrived.
  bool is_complete() const;

  /// Moves the player, and the view with it. A player who is new to a server begins at the spawn,
  /// and later at the place where the player left. place() returns that place. Fails before the
  /// first WorldOpened, and for numbers that are not finite or lie outside of the world.
  Result<void, ClientRefusal> move(const ClientPlace& place);
  /// Returns the place of the player: the place of the last move(), or the place where the server
  /// lets the player begin.
  const ClientPlace& place() const;
  /// Changes the radii of the view, as in WorldClientOptions. Fails above 64.
  Result<void, ClientRefusal> set_view_radii(std::uint8_t horizontal, std::uint8_t vertical);

  /// Shows an edit at once and sends it to the server. EditConfirmed, EditRejected or EditUnseen
  /// reports the outcome, also after a lost connection. Edits that have no outcome when the client
  /// ends get none. One undo takes back all edits of one action. Pass kNewAction with the first
  /// edit of an action, and the number of the first edit with the others. With 0 the edit is an
  /// action by itself. Fails
  ///   - with bad_value before the first WorldOpened and after the end;
  ///   - with the error of validate() for an invalid edit, and with not_found for a material that
  ///     the world lacks or a chunk that the server cannot send;
  ///   - with unknown_kind for an edit without voxels;
  ///   - with not_permitted if the player may not make it, as far as the client knows;
  ///   - with limit_exceeded if the edit is larger than the world allows, if the budget of the
  ///     player does not suffice yet (wait_us()), or if kEditsWaitingMax edits or events of edits
  ///     wait.
  Result<EditNumber, ClientRefusal> submit(const EditDescriptor& edit, EditNumber action = 0);
  /// Returns the time until the budget of the player suffices for the edit, or 0 if it suffices
  /// now.
  TimeUs wait_us(const EditDescriptor& edit) const;

  /// Sends a line of the chat to all players. Fails if no world is open, if the server has no chat,
  /// or if the line is empty, too long or not UTF-8.
  Result<void, ClientRefusal> chat(std::string_view line);
  /// Sends a command, such as "undo". CommandDone has the answer. Fails if no world is open, if
  /// another command runs or its answer was not drained, if the text is empty, too long or not
  /// UTF-8, or if the server accepts no commands.
  Result<void, ClientRefusal> command(std::string_view text);

  /// These three calls return null or nullopt if the chunk is not shown.
  std::shared_ptr<const RunChunk> chunk(ChunkCoord at) const;
  std::optional<MeshSource> mesh_source(ChunkCoord at) const;
  std::optional<Material> material_at(VoxelPos at) const;
  /// Returns the chunks that are shown, ascending.
  std::vector<ChunkCoord> chunks() const;

  /// Returns the materials by id. Empty before the first WorldOpened.
  const std::vector<MaterialRow>& materials() const;
  /// Cost: O(materials).
  std::optional<Material> find_material(std::string_view name) const;
  /// Returns the properties of the materials that meshers read. The result is never null.
  std::shared_ptr<const MeshMaterials> mesh_materials() const;

  /// Returns the other players in the world, ascending by author.
  std::vector<PlayerInfo> players() const;

  /// Sends the queued messages and a goodbye, and ends the threads. Waits at most a second for the
  /// network, and until the cache is written. Chunks stay readable. A second call does nothing.
  void close();

 private:
  struct State;
  explicit WorldClient(std::unique_ptr<State> state);
  void close_if_any() noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
