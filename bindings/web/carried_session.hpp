// CarriedSession: a session with a server for a program that carries the frames itself, as
// JavaScript does with a WebSocket. It has the session and the replica of the clients, and makes
// the meshes of the chunks around the player. The program
//   - calls connected() when a connection is there, with random bytes, and disconnected() after it;
//   - passes each received message to receive();
//   - calls step() about every 10 ms, sends what next_frame() returns, and closes the connection if
//     wants_close() returns true;
//   - draws what next_mesh() returns.
// Shapes that are no cubes are meshed as in coarse levels of detail: as a cube if they fill at
// least half of their voxel, otherwise not at all. Distant ground is not requested. Pure:
// randomness and times are arguments. Times are microseconds of a steady clock. Thread: one.
// Bounds: those of the replica (client/replica), and kNoticesMax notices.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "client/replica/local_edits.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "client/session/client_session.hpp"
#include "client/stream/message_stream.hpp"
#include "common/collision/ray_walk.hpp"
#include "common/core/world_pos.hpp"
#include "common/mesh/chunk_mesher.hpp"

namespace runstone {

/// The greatest radius of a view, in chunks. The server may allow less.
inline constexpr std::uint8_t kCarriedRadiusMax = 32;

struct CarriedPlayer {
  KeySeed seed{};
  std::string name;
  std::string ticket;                       // an invite token; empty: none
  ClientInstance instance = 0;              // random, not 0
  std::uint8_t radius_h = 0, radius_v = 0;  // of the view, in chunks: kCarriedRadiusMax at most
};

/// The kinds of notices for the program. Their values are part of the interface for JavaScript.
enum class CarriedNoticeKind : std::uint8_t {
  opened = 1,     // the world is open, for the first time or again
  closed = 2,     // the server has ended the session; text: the reason
  refused = 3,    // as `closed`, but another attempt is pointless
  rejected = 4,   // number: the edit; text: the reason
  chat = 5,       // text: "name: line", or a line of the server
  materials = 6,  // there are more materials, or materials of another world
  durable = 7,    // number: an edit that is on disk
  unseen = 8,     // number: an edit whose answer was lost; the chunks show whether it was applied
  command = 9,    // the command has ended; number: 1 if it succeeded; text: its lines
};

struct CarriedNotice {
  CarriedNoticeKind kind = CarriedNoticeKind::opened;
  std::uint32_t number = 0;
  std::string text;
};

/// A mesh that replaces the one of its chunk. Null: the chunk has left the view, or has no faces.
struct CarriedMesh {
  ChunkCoord at;
  MeshPtr mesh;
};

class CarriedSession final : private MessageSink {
 public:
  explicit CarriedSession(const CarriedPlayer& player);

  /// Begins a connection. `nonce` must be fresh and random.
  void connected(const Nonce& nonce, TimeUs now_us);
  /// Takes bytes of the server. Fails if they break a rule of the protocol, or if there is no
  /// connection. The program then closes the connection.
  Result<void> receive(ByteView bytes, TimeUs now_us);
  void disconnected();
  /// Sends pings, poses and other due messages. Call it about every 10 ms.
  void step(TimeUs now_us);
  /// Returns the next frame to send, a message of a WebSocket, or an empty span if there is none.
  /// The bytes hold until the next call.
  ByteView next_frame();
  /// Returns true if the connection should be closed: the session has ended and everything was
  /// sent.
  bool wants_close() const;

  /// Moves the player, and the view with it. Before a world is open, the view moves when it opens.
  /// Requires a position within the world.
  void move(const WorldPos& eye, double yaw, double pitch);
  /// Shows an edit at once and sends it. Fails as ClientSession::offer() does, with words.
  Result<ClientSequence, std::string> edit(const EditDescriptor& edit, TimeUs now_us);
  Result<void, std::string> chat(std::string_view line);
  /// Sends a command, such as "undo". A notice has its output. Fails as ClientSession::command()
  /// does, with words.
  Result<void, std::string> command(std::string text);
  /// Queues a goodbye.
  void leave();

  /// Meshes the next chunk: an edited one, or the nearest to the player. Returns nullopt if all
  /// meshes are up to date, or wait for chunks.
  std::optional<CarriedMesh> next_mesh();
  /// Returns the oldest notice that was not taken.
  std::optional<CarriedNotice> next_notice();
  /// Returns the first voxel that a ray hits, or nullopt.
  std::optional<RayHit> pick(const WorldPos& eye, const LookDirection& look, double reach) const;

  const ClientSession& session() const { return session_; }
  std::size_t unmeshed_count() const { return planner_.dirty_count() + gone_.size(); }

  /// The greatest number of notices. Beyond it the oldest ones are dropped. It has room for the
  /// case that all kept edits become durable at once.
  static constexpr std::size_t kNoticesMax = 2 * kLocalEditsMax;

 private:
  void on_received(LinkReceived received) override;
  void queue_outgoing();
  void take_changes();
  /// Moves the view to the chunk of the eye. Does nothing before the first world.
  void centre_view(const WorldPos& eye);
  /// Returns the number of an edit: the sequence with which it was offered first.
  ClientSequence number_of(ClientSequence seq) const;
  void note_outcomes(const ReplicaChanges& changes);
  /// Adds the notice of the command if it has ended since the last call.
  void note_command_end();
  void note(CarriedNoticeKind kind, std::uint32_t number, std::string text);
  /// Requires an open world. Does nothing if the materials are those of the last call.
  void update_materials();

  ClientSession session_;
  View view_;
  LinkStats stats_;
  ConnectionNumber connection_ = 0;
  std::unique_ptr<MessageStream> stream_;  // null: there is no connection
  TimeUs now_us_ = 0;                      // the newest time passed in
  bool is_overfull_ = false;               // the queue of the stream
  Bytes frames_;                           // written by the stream, and not taken yet
  std::size_t frames_taken_ = 0;           // bytes of frames_

  std::uint64_t opened_ = 0;  // connect_count() of the newest notice
  std::optional<WorldId> world_;
  bool is_commanding_ = false;        // a command was sent, and its notice was not added
  std::optional<WorldPos> moved_to_;  // by the last move() for this world, or before there was one
  std::size_t material_count_ = 0;
  std::uint64_t shapes_number_ = 0;
  MeshMaterials materials_;
  MeshPlanner planner_{session_.replica()};
  ChunkMeshScratch scratch_;
  std::set<ChunkKey> drawn_;   // chunks for which next_mesh() returned a mesh
  std::deque<ChunkKey> gone_;  // those of them that left since
  std::deque<CarriedNotice> notices_;
  // Edits that the session offers again, as new ones. Bound: those that it keeps.
  std::set<ClientSequence> waiting_again_;            // numbers of those that were not offered yet
  std::map<ClientSequence, ClientSequence> numbers_;  // of the others, by their new sequence
};

}  // namespace runstone
